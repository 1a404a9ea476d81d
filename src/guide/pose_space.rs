//! The pose space: places of poses, weights, deformed copies, reaching, and paths that become animations.
//!
//! # Places
//!
//! Every pose lies at a place `at` of the pose space, mostly in the plane. All poses have a place or none. Without places they are
//! laid out by how far their drawings are from one another; `new` writes such places into the scene file, where they can be changed. No two
//! poses lie at one place. In a scene with layers that gives no places, at least one layer has to be in all poses.
//!
//! A useful space has directions that mean something: to the right the figure leans right, upwards it is happier. The places are the only
//! thing that says so. A coordinate may have any scale, but both should have about the same.
//!
//! # Weights
//!
//! At a place between the poses each of them counts with a weight. The weights sum to 1; at the place of a pose its own weight is 1 and all others are 0.
//! Each of the five parts of the figure shows the weight of one pose of the walker over the plane: a line for every tenth, the thick one
//! for a half. The large dot is the pose, the small ones are the others:
//!
#![doc = include_str!("figures/weights.svg")]
//!
//! ```toml
//! [pose_space]
//! provider = "biharmonic"      # the smoothest weights in the plane; "rbf" works in any dimension
//! bounded = true               # weights stay between 0 and 1; false without it
//! walls = [ [[0.2, 0.0], [0.2, 0.6]] ]    # influence goes around these lines, not across them
//!
//! [[pose]]
//! name = "stand"
//! source = "stand.png"
//! at = [0.0, 0.0]
//!
//! [[pose]]
//! name = "run"
//! source = "run.png"
//! at = [1.0, 0.0]
//! ```
//!
//! Biharmonic weights, the default, need a plane. They level out far away from the poses: `epsilon` says how soon, 0.001 by default,
//! more for sooner. Bounds and walls are theirs alone. Radial weights (`provider = "rbf"`) work for poses with any number of coordinates, and go on
//! linearly beyond them; their `radial` function is `"b-spline"`, or `"thin-plate"`.
//!
//! Weights may be negative or above 1, most of all outside the region of the poses: there the character does more of what a pose does than
//! the pose itself. That is often wanted. Where it goes too far, `bounded = true` or a path that stays among the poses is the remedy, and
//! [`blending`](super::blending) has others.
//!
//! If the blend at a place is right, but wanted somewhere else, a pseudo-pose says so: the weights that are found at `from` are those at
//! `at`, and the space between follows.
//!
//! ```toml
//! [pose_space]
//! provider = "rbf"
//!
//! [[pose]]
//! name = "stand"
//! source = "stand.png"
//! at = [0.0, 0.0]
//!
//! [[pose]]
//! name = "run"
//! source = "run.png"
//! at = [1.0, 0.0]
//!
//! [[pseudo_pose]]
//! from = [0.4, 0.0]
//! at = [0.6, 0.0]
//! ```
//!
//! The weights of a place, or of a grid of places, are printed for other programs:
//!
//! ```text
//! inbetween weights cat/scene.toml --at 0.5,0.5 -o -
//! inbetween weights cat/scene.toml --grid 40x40 -o weights.csv
//! ```
//!
//! # Poses that are not drawn
//!
//! A pose can be a copy of another one that is bent by handles, as rigidly as the drawing can be bent. Each handle goes from a point of the
//! drawing to the place where it belongs; a handle whose two places are equal holds its point. One handle moves the whole figure. The copy is
//! a pose like any other, and copies of copies are possible:
//!
//! ```toml
//! [[pose]]
//! name = "stand"
//! source = "stand.png"
//! at = [0.0, 0.0]
//!
//! [[pose]]
//! name = "sway"
//! deform_of = "stand"
//! at = [1.0, 0.0]
//! handles = [
//!   { from = [211.0, 665.0], to = [211.0, 665.0] },
//!   { from = [320.0, 380.0], to = [378.0, 388.0] },
//! ]
//! ```
//!
//! A copy shows the same drawing, so nothing fades between it and its original, and nothing appears that is not drawn: a mouth that is
//! closed stays closed. A copy that would lie over itself is refused. In a scene with layers each handle names its `layer`.
//!
//! # Reaching
//!
//! Where in the space does the hand come to the cup? `reach` looks for the place whose drawing brings landmarks nearest to given points.
//! The search stays in the box of the poses, widened by a quarter of its diagonal to every side, so whatever it finds is made of your drawings:
//!
//! ```text
//! inbetween reach clown/scene.toml --handle left_hand=60,300
//! ```
//!
//! It prints the place, the weights there, how far the landmarks are from their targets, and where they come to lie.
//!
//! # Animation
//!
//! A path through the space is an animation. Without keys it visits all poses in their order, a second from each to the next, and starts
//! over. With keys it passes through each `at` at its `time`, in seconds, on a smooth curve whose velocity does not jump:
//!
//! ```toml
//! [animation]
//! fps = 24
//! loop = true
//! size = [480, 540]            # columns and rows; [1280, 720] without it
//! background = "white"         # "transparent" without it; "black", "#rrggbb", "#rrggbbaa"
//! keys = [
//!   { time = 0.0, at = [0.0, 0.0] },
//!   { time = 0.4, at = [1.0, 0.0] },
//!   { time = 0.6, at = [1.0, 0.0] },
//!   { time = 1.0, at = [0.0, 0.0] },
//! ]
//! ```
//!
//! Two equal keys in a row are a rest: the curve comes to rest at the first and leaves from the second. A loop whose last key lies where its first one
//! does ends there; any other loop takes the mean time between keys to return. With keys, `loop` is `false` unless the file says otherwise.
//! `turns` of a pose adds whole turns to its rotation, for a figure that spins on its way.
//!
//! # Spacing charts
//!
//! Where the drawings before a key lie is its `spacing`, as marks of an animator's chart: fractions of the way from the key before (0) to
//! this key (1), at even steps of the time between them.
//!
//! ```toml
//! [animation]
//! fps = 10
//! keys = [
//!   { time = 0.0, at = [0.0, 0.0] },
//!   { time = 0.5, at = [1.0, 0.0], spacing = [0.1, 0.3, 0.6, 0.85] },    # slow out of the first key and into this one
//! ]
//! ```
//!
//! Four marks make five steps: here a frame each, so frames 1 to 4 are at the marks. At other rates the way goes on between the marks along a smooth curve
//! that never turns back. The way is that of the path without the chart, by the curve's own parameter: the places passed are the
//! same, only the times differ, and even marks change nothing. Equal marks rest. Marks lie between 0 and 1 and do not decrease: an anticipation or an overshoot is
//! a place of its own, so give it a key. The first key has no spacing, nor has the way back of a loop that does not end where it begins.
//!
//! # On ones, twos and threes
//!
//! Drawn animation seldom has a drawing a frame. `hold` says for how many frames each is shown: 1, 2 or 3. A key may have a hold of its
//! own, in force from that key up to the next one:
//!
//! ```toml
//! [animation]
//! hold = 2                     # 1 without it
//! keys = [
//!   { time = 0.0, at = [0.0, 0.0] },
//!   { time = 1.0, at = [1.0, 0.0], hold = 1 },        # a quick part, on ones
//!   { time = 1.5, at = [0.0, 0.0] },
//! ]
//! ```
//!
//! Drawings are counted from the first frame. At a key with a hold of its own, and at the key after it, the count begins anew; other keys
//! leave it alone, so a path that was recorded, with keys at any time, plays evenly. The count may then pass over a key between two drawings: give
//! it a hold, and it is drawn. A key between two frames is at the later one. In a loop the count begins anew each time around.
//!
//! Numbered files are still one a frame, those of a drawing byte for byte the same; GIF, APNG and WebP show one picture for longer, and animated SVG
//! and Lottie jump from drawing to drawing. glTF and Spine have the held frames as keys, between which they move.
//!
//! Where weights are given instead of a place, no place is needed:
//!
//! ```text
//! inbetween frame cat/scene.toml --weights 0.5,0.5,0 -o half.png
//! ```
//!
//! The next chapter: [`blending`](super::blending).
