//! Drawings: which files are read, what is taken for the figure, and what becomes of the rest.
//!
//! # Files
//!
//! A pose is read from a PNG, JPEG, WebP, GIF, BMP or TIFF picture, from an SVG drawing, or from a layered file (PSD, OpenRaster, Krita and Aseprite; see
//! [`layers`](super::layers)). A picture has at most 16,384 columns
//! and rows and 2²⁶ pixels in all. A drawing lies in the folder of its scene file or below it; `new` and `add` copy those that do not.
//! What one drawing shows is one character. Several pictures in one file are several poses:
//!
//! ```text
//! inbetween new imp sheet.png --cells 4x2
//! inbetween new cat walk.gif
//! ```
//!
//! A sheet gives a pose for every cell that is not empty. A sheet that is given alone, with a figure in each of at least four equal
//! cells, needs no `--cells`. Animated GIF, APNG and WebP files give a pose a frame; what is empty or repeats an earlier one is left out.
//! Drawings are taken in the order of the numbers in their names: `walk2` comes before `walk10`. In the scene file a pose names its
//! picture by `frame`, counted from 0, or by `cell`, column and row:
//!
//! ```toml
//! [input]
//! cells = [4, 2]        # columns and rows of the sheets
//!
//! [[pose]]
//! name = "wait"
//! source = "sheet.png"
//! cell = [0, 0]
//!
//! [[pose]]
//! name = "leap"
//! source = "leap.gif"
//! frame = 2
//! ```
//!
//! One more drawing for a scene that stands is added to it with its place in the pose space found, and with the landmarks of the other
//! poses carried onto it. Comments in the scene file stay where they are:
//!
//! ```text
//! inbetween add cat/scene.toml sneak.png
//! ```
//!
//! # What the figure is
//!
//! What belongs to the character in a picture is decided by evidence, and told in a note a pose:
//!
//! 1. If alpha varies over the picture, and what is opaque is not itself a sheet of paper, the figure is *cut out*: it is what is opaque.
//! 2. If the border of the picture is explained by a smooth field of colour with some noise, as paper under a lamp is, the figure is
//!    *painted*: it is what differs from that background, which is taken out. Small places inside that look like the background
//!    (eyes, teeth, collars) belong to the figure if a line frames them, or if something is drawn in them. Large openings in paint stay open.
//! 3. If what is drawn is thin and mostly encloses bare paper, the figure consists of *lines*: it is everything that they enclose.
//! 4. A picture with a background that is neither transparent nor plain is refused. It has to be cut out first.
//!
//! A page that lies on a table is looked for and used; a strip along a whole border, such as the shadow where a sheet leaves the scanner's
//! glass, is left out; a soft shadow or glow around the figure is cut off at its outline. A hard shadow that touches the figure counts
//! as drawn. Each of these is told of.
//!
//! Where the evidence is misread, the scene says what is right, for all poses or, with the same keys in a `[[pose]]`, for one:
//!
//! ```toml
//! [input]
//! figure = "lines"      # "alpha", "background"; without it, "auto"
//! gap = 0.02            # 0.01 without it, at most 0.2
//! paper = "clear"       # "keep" without it
//! threshold = 0.5       # this much without it
//! ```
//!
//! Gaps in lines are closed up to `gap`, a fraction of the drawing's diagonal. `paper = "clear"` makes the paper inside lines transparent,
//! with the same outline. `threshold` says how much of a pixel has to be covered for the outline to enclose it.
//!
//! A line that is open by more than `gap` is reported with its place and with the value that would close it. Both ends are looked at:
//! where two lines pass one another, a hand near a hip, nothing is closed.
//!
//! # Loose parts
//!
//! What lies apart from the body, a hat that floats, a spark, a drop of sweat, is a loose part. Parts are compared over the poses by
//! place, size, colour, elongation and the landmarks on them; what is one thing in several poses becomes a layer of its own and morphs by itself.
//! In the figure the body is grey and each loose part has a colour:
//!
#![doc = include_str!("figures/parts.svg")]
//!
//! A pose that lacks a part has it shrunk to a point, from which it grows: out of the part that it divides from, or in its own place.
//! Small parts that only one drawing has, and crowds of them, are dust; they are left out in a note. The layers of loose parts do not hang
//! together: a head that floats goes its own way from pose to pose, straight.
//!
//! ```toml
//! [input]
//! parts = "largest"     # loose parts are left out; "layers" without it
//! ```
//!
//! In a pose, `keep` and `drop` name parts by a place on each, in pixels of the picture or user units of the SVG file: `keep` those that
//! belong to the figure however small, `drop` those that do not. With `parts = "largest"`, `keep` takes single parts back.
//!
//! ```toml
//! [[pose]]
//! name = "startled"
//! source = "startled.png"
//! keep = [ [120, 80], [300.5, 42] ]
//! drop = [ [12, 700] ]
//! ```
//!
//! If the parts are to be edited, to hang on one another or to change their order, `separate` writes them as the layers of a scene
//! of its own, a picture a part and pose: PNG of bitmaps, SVG of vector drawings. Between poses, a part that only some of them have then
//! fades where it is instead of growing.
//!
//! ```text
//! inbetween separate cat/scene.toml -o cat-layers
//! ```
//!
//! # Parts that lie over one another
//!
//! An arm in front of the chest, legs that cross, a hand on the hip: there the outline of a drawing does not show where the parts end. If another
//! drawing shows them apart, they are found by what is drawn: the limbs of the drawing with the longest outline for its area, the *open* one, are sought in those whose outline is clearly
//! shorter. The mesh then lies over itself in these poses; frames are painted from back to front, each part cut out by its own edge, and what a
//! drawing hides is shown from those that show it. Where none does, the nearest colours go on; `separate` writes these parts as layers, too, for whoever wants to draw there
//! ([`layers`](super::layers#from-drawings-that-lie-over-themselves)).
//!
//! ```toml
//! [input]
//! overlaps = "refuse"   # outlines have to correspond as they are; "auto" without it
//! ```
//!
//! Landmarks help here as elsewhere: one in the middle of a hand, inside in both drawings, says which hand it is. More is said by naming the limb:
//!
//! ```toml
//! [[part]]
//! name = "arm"
//! at = { stand = [316, 96], walk = [112, 228] }     # its hand, roughly: where it is apart, and where it is seen
//! cut = { stand = [[228, 120], [238, 150]] }        # optional: a line across the figure where it begins
//!
//! [[pose]]
//! name = "stand"
//! source = "stand.png"
//!
//! [[pose]]
//! name = "walk"
//! source = "walk.png"
//! order = ["arm", "trunk", "limb 2"]                # from back to front, as far as it matters
//! ```
//!
//! - One of its places is in the open drawing, or in another that shows all parts apart. In any other pose the limb is sought near its place there, in front of what else
//!   lies there.
//! - Without a `cut` a limb begins where the figure widens. With one, it also does where nothing widens: half a tail, the lower part of a sleeve.
//! - `order` holds whatever the drawing shows. `trunk` is what belongs to no limb, `limb 1` and so on are limbs without a name, by their numbers under `limbs` in the mapping.
//! - A pose that is named here is looked at for overlapping parts even if its outline does not ask for it. If its limbs cannot be placed, it is refused, with the place where most is left
//!   unexplained. In a scene with layers a part says which `layer` it is on, and `order` is that of the layers.
//!
//! `inbetween map` writes which poses lie over themselves (`immersed`), how near every
//! triangle is there, and the limbs. What no drawing shows apart cannot be found, nor what lies within the open drawing's own silhouette: draw one pose with the arms away from
//! the body. Such a character is painted as pixels, its SVG drawings too; pixel art (`sampling = "nearest"`) is painted without the order of depth. Spine, glTF and the runtime file keep the order
//! ([`exports`](super::exports#meshes-of-figures-that-lie-over-themselves)).
//!
//! # Holes
//!
//! Holes that all poses have, such as the space between an arm on the hip and the body, are holes of the shape and correspond. Holes that
//! only some have are covered by the mesh and open and close in the texture. That is `holes = "match"` under `[input]`. With
//! `"keep"` every pose has to have equally many holes, and the scene is refused otherwise; with `"fill"` no hole is one of the shape, and
//! what is transparent in a drawing is transparent in its texture only.
//!
//! # SVG drawings
//!
//! The outline of an SVG drawing is the union of what is drawn, in the user units of its `viewBox`. A background that covers the page is left
//! out. CSS and its variables count. Text and embedded pictures are not drawn, and a note says so: convert text to paths before you
//! export. Masks and filters do not change the outline. Nothing outside the file is ever opened. Compressed files (SVGZ) are refused.
//! `element` of a pose names the id of an element whose outline is meant. Whether such a drawing stays curves is the matter of
//! [`layers`](super::layers).
//!
//! All drawings of a scene are taken to have units of one size. If one is drawn on a page with a `viewBox` of another scale, it looks too
//! small or too large beside the others; a note tells of it.
//!
//! # The canvas
//!
//! By default frames show all poses and the whole animation as large as they fit. With `camera = "drawing"` they show the canvas of the
//! drawings: a frame at a pose lies exactly over its drawing. Smaller pages are centred on the largest. Without a `size` frames are as large
//! as the canvas, so that a sprite of 32 x 32 pixels gives frames of 32 x 32; frames of a whole multiple show each pixel as a square of whole
//! pixels. For pixel art, colours are taken without smoothing:
//!
//! ```toml
//! [animation]
//! camera = "drawing"
//!
//! [texture]
//! sampling = "nearest"
//! sharpness = 1.0
//! ```
//!
//! With both, every frame shows the drawing that counts most, and has no colour that no drawing has.
//!
//! # What cannot be told
//!
//! What is as white as the paper belongs to the figure only if a line or paint encloses it. A figure on a background that is not plain has
//! to be cut out. What no drawing shows apart from what hides it is
//! stretched or faded, unless it is a [layer](super::layers) of its own.
//!
//! The next chapter: [`landmarks`](super::landmarks).
