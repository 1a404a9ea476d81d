//! The explorer: a scene in the browser, where everything is changed with the pointer.
//!
//! ```text
//! inbetween explore cat/scene.toml
//! inbetween explore walk1.png walk2.png walk3.png
//! inbetween explore walk.png --cells 4x2
//! ```
//!
//! The command prints an address, opens the browser there and serves the page until it is stopped with Ctrl-C. Only this machine can reach it, and
//! only with the secret that is part of the address. `--port` chooses the port, `--no-open` leaves the browser alone.
//!
//! # What it shows
//!
//! - **The plane.** Drag through it, and the figure follows. Drag a pose, and its weights are solved again under the pointer. Maps show how
//!   far each pose reaches, and where triangles would fold or stretch.
//! - **The picture.** A drag on the figure finds the place that brings a hand there, or bends a new pose out of the one that is shown. The point under the pointer is marked on
//!   all drawings at once, in a strip below that the key P puts away.
//! - **Matches.** A click puts a landmark on all drawings at once, some clicks a line. Match and mesh follow while either is dragged.
//! - **Drawings.** The sheet of each drawing is shown whole, paper and all, with what was taken for the figure: body, holes, loose parts, what is
//!   left out. A click on a part leaves it out or takes it back; a click elsewhere asks for what is drawn there. How the figure
//!   is told, which gaps are closed, whether paper counts and where its edge is stands beside it, for one drawing or for all.
//! - **The inspector** has the scene's settings and compares two of them side by side.
//! - **The timeline.** A gesture in the plane, recorded as it is made, becomes the animation's keys. Keys can be dragged in time.
//!
//! Every edit can be undone. It goes to the scene file at once, whose comments stay. "Copy as command" tells how to do the same in a script, and the
//! export of the page writes what `render` would.
//!
//! # Without a scene file
//!
//! Given drawings, the explorer begins a scene for them as `new` does, but in a temporary folder: nothing is written beside the drawings. "Save…"
//! names a folder, which gets the scene file and copies of the drawings that are not there yet, and from then on every edit. Until then
//! the drawings are looked at where they are, so what is painted over there is shown. If the command ends before, the scene stays in the temporary
//! folder that it named.
//!
//! # Keys
//!
//! The page works with the keyboard, landmarks and lines included, and with screen readers, in light and dark. The key ? lists the keys. Those
//! that are needed most:
//!
//! | key | what it does |
//! |---|---|
//! | arrows, with Shift finely | move through the plane |
//! | 1 … 9, Home | go to a pose, to the first one |
//! | Space; comma and full stop | play or pause; a frame back or on |
//! | R | record a gesture |
//! | V | picture, matches or drawings |
//! | M, O, W | mesh; onion skin; what the plane shows |
//! | B, held | compare |
//! | L | new landmarks are points or lines |
//! | Ctrl Z, with Shift again | undo, redo |
//! | C, E | copy as command, export |
//!
//! # How frames are painted
//!
//! The graphics card paints, by WebGL2; where there is none, the page does it itself. `?painter=card` or `?painter=processor` in the address asks for one of
//! them. The pixels are those of `inbetween frame` but for rounding: on the walker they differ by 0.06 and 0.04 of 255 on average. SVG drawings move as pixels, and
//! stand as the very curves that are exported. Pixel art is painted as squares at every zoom.
//!
//! `?bench` in the address measures it. Without a graphics card, on two cores that browser and server share, medians with the range of a dozen runs,
//! and the 95th percentile in brackets:
//!
//! | | walker, 379 vertices | the same with 1,997 |
//! |---|---|---|
//! | request to frame | 1.1 to 1.5 ms (2.2), 12 kB | 1.2 to 1.5 ms (3.0), 25 kB |
//! | painting a frame, 634 x 627 | 5.0 to 8.4 ms (10) | 6.0 to 9.6 ms (13) |
//! | frames a second while dragging | 60; 53 in a slow hour | 59 to 60; 55 in a slow hour |
//! | pointer to picture | 14 to 36 ms (49) | 15 to 34 ms (46) |
//!
//! A landmark that is moved shows its new match and mesh after a few tenths of a second on the walker, most of which is the registration of the drawings. With a
//! graphics card nothing has been measured; WebGL2 computed on the same processor paints 36 to 54 frames a second.
//!
//! The next chapter: [`scene_file`](super::scene_file).
