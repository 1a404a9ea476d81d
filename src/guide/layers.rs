//! Layers: parts that lie over one another, what they hang on, and drawings that stay curves.
//!
//! # When layers are needed
//!
//! A drawing is one outline, and its mesh is one surface: an arm that crosses the chest has no outline of its own, and what it hides is
//! nowhere. Draw the arm as a layer. It then has drawings, landmarks and a mesh of its own, and the body behind it is whole. Loose parts become
//! layers by themselves ([`drawings`](super::drawings)).
//!
//! # A scene with layers
//!
//! Layers are listed from back to front. Each pose says where its layers are drawn: either one SVG file, with an element a layer, or a file a layer.
//! A pose may lack some of them, but not all.
//!
//! ```toml
//! [[layer]]
//! name = "body"
//!
//! [[layer]]
//! name = "arm"
//! anchor = { layer = "body", at = "shoulder" }
//!
//! [[pose]]
//! name = "rest"
//! source = "rest.svg"
//! element = { body = "body", arm = "arm" }
//! at = [0.0, 0.0]
//!
//! [[pose]]
//! name = "behind"
//! source = { body = "behind-body.png", arm = "behind-arm.png" }
//! order = ["arm", "body"]
//! at = [-1.0, 0.0]
//!
//! [[landmark]]
//! name = "shoulder"
//! layer = "arm"
//! at = { rest = [228.0, 342.0], behind = [231.5, 337.4] }
//! ```
//!
//! - All layers share the pose space, the weights and the animation. A layer is blended among the poses that have it.
//! - Every landmark says which `layer` it is on.
//! - The drawings of all layers of a pose have the same coordinates: pictures of one size, or one SVG file.
//! - A place under `keep` or `drop` is one of all drawings of the pose: it names the loose parts that are there, on whatever layer. The largest part of
//!   a drawing is never dropped.
//!
//! # Anchors
//!
//! By itself every layer moves as its own drawings do, and between poses an arm would leave the shoulder. `anchor` ties it: the landmark, one of
//! the arm's own, lies at the same coordinates on the body's drawing, and in every frame the arm is moved so that both coincide. The arm
//! hangs on the shoulder wherever the body goes. A layer hangs on one other layer, at one point, and every pose that has it must have that other
//! layer. Chains are possible: a flower on the paw, the paw on the shoulder. The landmark of an anchor needs a place in every drawn pose that has the layer.
//!
//! # Order
//!
//! `order` of a pose lists the layers that it has from back to front, where that is not the order of the scene. The order of a frame is that of the drawing
//! that is seen most, so it changes at once, at a place where the layers should not lie over one another. A layer that some poses lack
//! fades there as a whole.
//!
//! To look at one layer, name it:
//!
//! ```text
//! inbetween show bear/scene.toml --layer arm -o arm.png
//! inbetween map bear/scene.toml --layer arm -o arm.json
//! ```
//!
//! # Curves
//!
//! SVG drawings stay curves: the mesh carries their control points, and a frame is a vector drawing again. Elements with the same
//! id in several drawings morph into one another, in geometry, fill, stroke, gradient and opacity, also where they have different
//! numbers of curves. Elements without a counterpart cross-fade; drawings without any common id cross-fade as a whole within one crisp
//! edge. The figure goes from one face to another, above as pixels, below as curves whose elements have the same ids:
//!
#![doc = include_str!("figures/curves.svg")]
//!
//! So give eyes, brows and mouth an id in your drawing program (Inkscape: object properties; Illustrator: the name of the layer or object),
//! the same in every drawing. The order of elements is kept; where drawings contradict one another, the one that is seen most decides.
//!
//! A layer is drawn as curves if all its drawings are SVG and have nothing that curves cannot say: filters, masks, clip paths that cut, patterns, blend
//! modes. If one has, the layer is drawn from its pixels, and a note names the element. The scene asks for pixels by
//!
//! ```toml
//! [texture]
//! drawing = "pixels"        # "curves" without it
//! ```
//!
//! Where the mesh is stretched a lot, carried lines may waver; a finer mesh or a landmark nearby helps. Cross-fades between curves are averaged as
//! the numbers stand in the file, whatever `blending` says.
//!
//! The next chapter: [`exports`](super::exports).
