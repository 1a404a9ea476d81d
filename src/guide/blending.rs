//! Blending: how shapes bend, how colours are mixed, and how fine the mesh is.
//!
//! # Why a rigid blend
//!
//! If every vertex of the mesh moved along a straight line from pose to pose, whatever turns would shrink on the way. The figure shows a
//! straight snake that becomes a coiled one, above along straight lines, below by the blend of this crate, all in one scale. Each triangle's rotation and
//! its stretch are blended apart; then the mesh is fitted to them. Rotations are consistent over the whole mesh, so that turns beyond half a
//! turn, or beyond a whole one, come out as they were drawn:
//!
#![doc = include_str!("figures/rigid-blend.svg")]
//!
//! # Beyond the poses
//!
//! Where weights are negative or above 1, stretches are extrapolated. `stretch = "linear"`, the default, goes on as it began and may turn
//! triangles over far outside. `"limited"` keeps shapes near those of the poses while rotations go on. `"log"` never turns a triangle's own
//! stretch over, but grows faster and faster. Of the
//! head in `data/face`, turned to the right with the weights 1.8 and −0.8, linear stretch inverts hundreds of triangles, logarithmic
//! stretch about a hundred, limited stretch a handful.
//!
//! Frames with inverted triangles are counted and told of. `guard = "repair"` replaces each of them by the nearest shape in which every triangle keeps a
//! twentieth or so of its smallest area in any pose.
//!
//! ```toml
//! [blend]
//! stretch = "limited"       # "linear" without it, or "log"
//! guard = "repair"          # "off" without it
//! reference = "canonical"   # no pose is special; the name of a pose measures everything from that pose
//! ```
//!
//! # Certified frames
//!
//! What can be said of frames for certain is said where `--certify` asks for it:
//!
//! ```text
//! inbetween render cat/scene.toml -o cat.gif --certify
//! inbetween blend walker.json --weights 0.5,0.5,0,0,0 --certify -o half.json
//! ```
//!
//! `render` writes `cat.gif.certificates.jsonl` beside the output, a line a frame; `blend` adds `certificate` to its frame. Everything else that is written has the same bytes.
//!
//! | field | what it says |
//! |---|---|
//! | `positive` | every triangle of the frame's mesh has positive area, decided exactly |
//! | `simple` | the boundary of the mesh does not cross itself, decided exactly; boundaries that touch do not cross |
//! | `overlaps` | where poses lie over themselves, boundaries of different limbs may cross; here are the pairs that do, by name, `trunk` for what belongs to no limb |
//! | `largest_distortion` | how much more a triangle is stretched in one direction than across it, against the blend's reference: the largest of all triangles; 1 for none |
//! | `largest_area` | by which factor a triangle is larger or smaller than its reference: the largest of all triangles; 1 for none |
//! | `of_poses` | `distortion` and `area` of the poses, as geometric means by the frame's weights: the largest of all triangles |
//!
//! A frame whose two numbers are, but for rounding, no larger than those `of_poses` stays within the distortion of the drawings it is made of. Negative weights count as 0 in that mean. A triangle that
//! is turned over has the distortion of its mirror image; where a number is not finite, because a triangle has no area, it is `null`. The canonical reference has no size of its own and
//! is given that of the geometric mean of the poses.
//!
//! A line of `render` begins with the number of the frame, counted from 1 as in `--frames`, its place in the pose space, `at`, and its `weights`. In a scene of several layers
//! it says the worst of the layers that are seen in the frame, and `layers` what is true of each. If a frame is not positive or not simple, the exit code is 1 when all is written, and the error
//! names the frame, its place in the pose space, what is broken, where, and what helps. `guard = "repair"` makes frames positive; an outline that crosses itself is led apart by landmarks on the
//! parts that meet, or by a pose between.
//!
//! In the library [`Certifier`](crate::blend::Certifier) does the same, names every broken place, and proves that nothing folds between two frames whose vertices move in straight lines.
//!
//! # What stays in its place
//!
//! Rotations and stretches say nothing about where the figure is. By default its centroid moves in proportion to the weights. `anchor`
//! names a landmark that does so instead, exactly, or a list of landmarks that do so as far as the shape gives way, such as the feet of a
//! figure that stands on the ground:
//!
//! ```toml
//! [blend]
//! anchor = ["left_toe", { landmark = "right_toe", stiffness = 100.0 }]    # 10 where nothing is said
//!
//! [[landmark]]
//! name = "left_toe"
//! at = { stand = [120, 640] }
//!
//! [[landmark]]
//! name = "right_toe"
//! at = { stand = [190, 642] }
//!
//! [[region]]                # a shield, a skull: what should hardly change its form
//! landmark = "right_toe"
//! radius = 0.1              # along the mesh, as a fraction of the drawing's diagonal
//! stiffness = 20.0          # 1 without it
//! stretch_limit = 1.2       # stretched or squashed at most so many times more than in any pose; no limit without it
//! ```
//!
//! # Colours
//!
//! The pictures of all poses are warped to the shape of the frame and mixed by how much each counts, and the frame is cut out by the blended
//! outline, which stays as sharp as the drawings' own. Alphas are not cross-faded, so nothing turns translucent on the way.
//!
//! ```toml
//! [texture]
//! sharpness = 0.8           # from 0, colours are mixed like shapes, to 1, only the nearest drawing is seen; 0.5 without it
//! blending = "linear"       # the light of colours is averaged; "plain", their numbers in the file, without it
//! register = "off"          # "auto" without it, see below
//! sampling = "smooth"       # "nearest" for pixel art
//! ```
//!
//! Where two drawings have one line a few pixels apart, a frame between them has one line: pictures are registered to one another below the size of the
//! mesh's triangles. That is done where something is drawn inside and the drawings show the same character. Pixel art, and the meshes that are
//! exported for other programs, always have the pictures where the mesh has them.
//!
//! Three to five drawings that were coloured alike hardly need any setting here. If a frame shows two faces at once, raise `sharpness`, or better,
//! let the faces correspond by [`landmarks`](super::landmarks).
//!
//! # The mesh
//!
//! The mesh encloses every outline. `simplify` says how far its boundary may be from the outline, `edge_length` how long its edges should be,
//! both as fractions of the drawing's diagonal. Finer meshes bend more smoothly and take longer. Make `simplify` smaller where frills and
//! fingers lose their ink, and `edge_length` smaller where a thin part bends in a few corners.
//!
//! ```toml
//! [mesh]
//! simplify = 0.006          # 0.02 without it
//! edge_length = 0.04        # 0.05 without it
//! ```
//!
//! The next chapter: [`layers`](super::layers).
