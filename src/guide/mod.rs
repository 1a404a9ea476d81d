//! The guide: from drawings to an animation, for those who draw and for those who program.
//!
//! `inbetween` takes several drawings of one character, made independently of one another, and makes the drawings between them. Every
//! chapter below is about one thing that an artist decides, in the order in which the decisions come up. The chapters use the command
//! and its scene file; whoever programs finds the same things as types in the last one.
//!
//! | chapter | what it answers |
//! |---|---|
//! | [`drawings`] | Which files can be read? What is taken for the figure? What happens to holes, loose parts and paper? |
//! | [`landmarks`] | What corresponds by itself, how is that seen, and how is it corrected? |
//! | [`pose_space`] | Where do poses lie, how much does each count at a place, and how does a path become an animation? |
//! | [`blending`] | How do shapes bend, how are colours mixed, and how fine is the mesh? |
//! | [`layers`] | How do parts lie over one another and hang on one another, and when does a drawing stay curves? |
//! | [`exports`] | What comes out, for which program, and how is it rendered on many computers? |
//! | [`explorer`] | How is all of this done with the pointer? |
//! | [`scene_file`] | Which keys has `scene.toml`? |
//! | [`shapes_in_space`] | How are 3D forms blended in the same way? |
//! | [`library`] | Which types do this in a program, and how fast are they? |
//!
//! # The first animation
//!
//! Two or more drawings are enough. Each shows the same character, alone on a transparent or plain background:
//!
//! ```text
//! inbetween new cat stand.png run.png jump.png
//! inbetween render cat/scene.toml -o cat.gif
//! ```
//!
//! `new` makes the folder `cat`, copies the drawings into it, maps them onto one another and writes `cat/scene.toml`: a list of poses,
//! each with a place in the plane. Poses that are alike come near one another. `render` plays what the scene file says; as long as it
//! says nothing else, that is a loop through all poses, a second from each to the next. Both tell what they found and what they left
//! out, a line a remark, each beginning with `note:`.
//!
//! Three more commands look closely at what was made of the drawings, since the first result is seldom right in everything:
//!
//! ```text
//! inbetween show cat/scene.toml -o cat.png
//! inbetween frame cat/scene.toml --at 0.3,0.1 -o between.png
//! inbetween explore cat/scene.toml
//! ```
//!
//! `show` explains in one picture how the drawings were matched, meshed and weighted. `frame` makes a single drawing at a place
//! between the poses. `explore` opens the scene in the browser, where everything can be changed with the pointer.
//!
//! # Words
//!
//! A *pose* is one drawing of the character, or a deformed copy of one. The *outline* of a pose is its closed boundary. A *landmark*
//! is a point that an artist names on several poses. The *mesh* is one triangulation that has a shape in every pose. The *pose space*
//! is the plane, or a space of any other dimension, in which the poses are laid out. The *weights* of a place are one number a pose,
//! with sum 1, that say how much each pose counts there. A *frame* is one finished picture.
//!
//! The figures of the guide are drawn by the example `figures` from the scenes of the repository's `data` folder, whose `README.md`
//! describes them.

pub mod drawings;

pub mod landmarks;

pub mod pose_space;

pub mod blending;

pub mod layers;

pub mod exports;

pub mod explorer;

pub mod scene_file;

pub mod shapes_in_space;

pub mod library;
