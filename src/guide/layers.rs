//! Layers: parts that lie over one another, what they hang on, and drawings that stay curves.
//!
//! # When layers are needed
//!
//! A drawing is one outline, and its mesh is one surface: an arm that crosses the chest has no outline of its own, and what it hides is
//! nowhere. Where other drawings show the arm apart, it is found by itself, as loose parts are ([`drawings`](super::drawings)). Where none does, or where you want to draw what is
//! hidden, draw the arm as a layer. It then has drawings, landmarks and a mesh of its own, and the body behind it is whole.
//!
//! # A scene with layers
//!
//! Layers are listed from back to front. Each pose says where its layers are drawn: either one SVG or layered file, with an element a layer, or a file a layer.
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
//! - The drawings of all layers of a pose have the same coordinates: pictures of one size, or one file.
//! - A place under `keep` or `drop` is one of all drawings of the pose: it names the loose parts that are there, on whatever layer. The largest part of
//!   a drawing is never dropped.
//!
//! # Layered files
//!
//! PSD, OpenRaster, Krita and Aseprite files hold the layers of a character already. A pose takes them by their path, the names of the groups that a layer is
//! in and its own with `/` between them. An element may be a group: its layers, composed.
//!
//! ```toml
//! [[layer]]
//! name = "body"
//!
//! [[layer]]
//! name = "arm"
//!
//! [[pose]]
//! name = "rest"
//! source = "hero.psd"
//! element = { body = "rest/body", arm = "rest/arms/left" }
//!
//! [[pose]]
//! name = "wave"
//! source = "hero.psd"
//! element = { body = "wave/body", arm = "wave/arms/left" }
//! ```
//!
//! - Coordinates are pixels of the file's canvas, for all its layers alike. What lies outside of the canvas is not seen.
//! - In a scene without layers `element` is one path; without it the drawing is everything that is visible in the file.
//! - An element that is named is drawn although it is hidden, since poses are hidden in turns while they are drawn. In it, hidden layers stay hidden.
//! - Masks, opacity and clipping count, those of the groups around an element too. Layers that are clipped by an element are drawn with it. Blend modes are
//!   normal and multiply; another is drawn as normal, and a note says so. Of an Aseprite file `frame = 2` names the frame.
//! - Adjustment and fill layers, live effects, vector masks and vector layers are not drawn; text counts as the pixels that the file keeps of it. A note names each such layer.
//! - Where two siblings have one name, the second from the back is called `name#2`.
//! - Colours are taken as they are stored, in RGB or grey with 8 or 16 bits a channel; CMYK, Lab and floating point are refused.
//!
//! `new` makes a scene of such a file, and says what it took for what:
//!
//! ```text
//! inbetween new hero hero.psd
//! inbetween new hero stand.psd run.psd
//! inbetween new hero hero.psd --layers part-groups
//! inbetween new hero hero.aseprite
//! ```
//!
//! | `--layers` | poses | parts | by itself |
//! |---|---|---|---|
//! | `pose-groups` | the outermost groups | what is in them | of one file with several groups |
//! | `part-groups` | layers of one name in the groups | the outermost groups | the same, where every group shows exactly one of several layers |
//! | `part-layers` | the files, or frames | the outermost layers and groups | of several files, and of a file with frames |
//! | `pose-layers` | the outermost layers and groups | none | of any other file: a flat list of layers |
//!
//! Parts of the same name correspond; a part that only some poses have appears and vanishes. If no two poses have a part in common, each pose is its whole drawing.
//! Hidden parts, empty layers, and layers that are one colour all over the canvas are left out, and so are layers beside groups that are poses or parts. A single group around
//! everything is passed through. Poses of frames are called after their tags; frames that repeat an earlier one are left out.
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
//! # From drawings that lie over themselves
//!
//! ```text
//! inbetween separate hero/scene.toml -o hero-layers
//! ```
//!
//! makes layers of drawings without any: of loose parts, and of parts that lie over one another in some of the drawings. Each of these becomes a picture a pose, of one size, with
//! what the others hide of it filled from the poses that show it, or else by its nearest colours: paint over that as you like. The layers are listed from back to front, a pose
//! that shows them otherwise has an `order`, and each hangs on the part that it joins (of several the one with the longest joint) by a landmark in the middle of the joint, called
//! `... joint`; landmarks called `... edge 1` and so on hold the edge together that it was cut along. Limbs that lie over nothing stay with the trunk. Landmarks go to the layer that they lie on; a line over several of them is left out, and a note says so, as it does
//! where a part joins several others or lies in front of itself by way of others. Drawings in curves are written as pixels, since curves cannot tell what hides from what is
//! hidden, and places are counted in these pixels.
//!
//! Frames at poses are those of the scene that was separated. In between the parts are matched anew, each by itself, so small differences are to be expected.
//!
//! # One layer alone
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
