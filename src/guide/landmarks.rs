//! Landmarks: what corresponds by itself, how that is seen, and how it is corrected.
//!
//! # What corresponds by itself
//!
//! Every point of one drawing has to know its counterpart in all others. It is found without help, by the shape of the outlines, by the
//! colours along them, and by everything that is drawn inside: the drawing of one pose, the *reference*, is laid over each of the others and
//! bent as rigidly as possible until they agree, from coarse to fine. The outlines then follow what was found. In SVG drawings elements
//! with equal ids are carried into one another, too. In the figure what corresponds has one colour; the walker's scene has no landmark:
//!
#![doc = include_str!("figures/matched.svg")]
//!
//! The reference is chosen, or named by `reference = "stand"` at the top of the scene file. Take a pose in which all parts are seen.
//!
//! # Where it goes wrong
//!
//! - Small parts that differ much between drawings may be taken for one another.
//! - A shape with rotational symmetry, a star or a wheel, has several matches that are equally good.
//! - A head that turns out of the plane moves its features against its outline: what is on the outline in one drawing is inside in the
//!   next. It needs landmarks, or SVG elements with equal ids.
//! - Where the outline alone is drawn, a plain silhouette, its shape has to decide.
//!
//! A note names every pose in which less than half of what the reference shows was found. To see more:
//!
//! ```text
//! inbetween show cat/scene.toml -o cat.png
//! ```
//!
//! The upper part of the picture has the outlines of all poses with numbered points that correspond; the colour between two numbers says
//! how unlike the outlines are there. The middle has the meshes; what corresponds inside has one colour, and the thinnest triangles are
//! marked. The lower part is the pose space. What `show` prints beside it names the stretches that are least alike, where a landmark would
//! help most. In a scene with layers, `--layer` says which one is meant.
//!
//! # Points
//!
//! A landmark is one place on several poses, in pixels of a picture or user units of an SVG file:
//!
//! ```toml
//! [[landmark]]
//! name = "nose"
//! at = { stand = [120.5, 40.0], run = [131.0, 44.0] }
//! ```
//!
//! A landmark that lies deeper inside than a hundredth of the drawing's diagonal in every pose that names it becomes a vertex of the mesh
//! there. Any other is an outline landmark: it is put onto the nearest place of the outer outline, at most three hundredths of the diagonal
//! away, and is met exactly by the matching. Around the outline landmarks have to come in the same order in every pose; if they do not, the scene is refused with
//! the landmark's name, unless the drawing lies over itself there.
//!
//! Where [parts lie over one another](super::drawings#parts-that-lie-over-one-another), landmarks lead: a hand whose tip is marked takes its arm there, in front of the chest or
//! behind it. In such a pose they may come in any order, and one that is on the outline of the open drawing may lie inside. A pose whose landmarks lie so is
//! looked at for overlapping parts even if its outline does not ask for it.
//!
//! A pose may lack a landmark. On the outline it is then placed by the matching, inside by its place relative to the outlines of the poses that have
//! it. A landmark near the rim of a hole is snapped to
//! that rim, in every pose that has it: it says which hole of every pose is which, and how the rim is turned. A deformed copy takes none of its own: it carries those of the pose that it copies.
//!
//! One or two landmarks are often enough, at the places that `show` names. Landmarks also serve as names for other purposes: what
//! [`reach`](super::pose_space) takes hold of, what layers hang on ([`layers`](super::layers)), what stays on the ground and
//! what is stiff ([`blending`](super::blending)).
//!
//! # Lines
//!
//! With `path = true` a landmark is a line, and the mesh has edges along it. It keeps a crease, a belt or the edge of a sleeve in one
//! piece:
//!
//! ```toml
//! [[landmark]]
//! name = "belt"
//! path = true
//! at = { stand = [[88, 210], [120, 216], [151, 209]], run = [[97, 214], [131, 219]] }
//! ```
//!
//! Lines correspond by their length, and need not have equally many points. A line lies inside; it may start and end at the outer
//! outline. A line from outline to outline divides the shape, and everything that lies on one side of it has to lie on that side in every
//! pose. Lines may neither cross themselves nor one another.
//!
//! # Drawings that face the other way
//!
//! A pose that is drawn facing left while the others face right is reflected by `mirror = true`. `mirror = "auto"` reflects it where its
//! reflection clearly shows more of the reference than the drawing itself. Landmarks and handles are given on the drawing as it is in its file.
//! A note says where a pose would match better reflected.
//!
//! ```toml
//! [[pose]]
//! name = "look_back"
//! source = "look_back.png"
//! mirror = "auto"
//! ```
//!
//! # The mapping as a file
//!
//! `map` writes the result, one triangulation with a place of every vertex in every pose, as JSON; `check` proves that such a
//! file is valid or says what is broken; `blend` blends it. With `--report`, `map` says what every stage did and how long it took.
//! `triangulate` makes a mapping of polygons that correspond already.
//!
//! ```text
//! inbetween map cat/scene.toml -o cat.json --report
//! inbetween check cat.json
//! inbetween blend cat.json --weights 0.5,0.5,0 -o frame.json
//! ```
//!
//! The next chapter: [`pose_space`](super::pose_space).
