//! The library: which types do what, stage by stage, and how fast they are.
//!
//! # A character
//!
//! [`Scene`](crate::scene::Scene) reads a scene file. [`Character`](crate::pipeline::Character) has everything that is computed once, is immutable, and
//! is asked for frames from any thread:
//!
//! ```
//! use inbetween::{export::png_bytes, scene::Scene};
//! use std::path::Path;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scene = Scene::open(Path::new("data/walker/scene.toml"))?;
//! let character = scene.character([96, 108], 1)?; // columns and rows; samples along a pixel's side
//! let frame = character.frame_at(&[0.5, 0.2])?; // a place of the pose space
//! let same = character.frame_of(&[0.5, 0.0, 0.5, 0.0, 0.0])?; // weights, one a pose
//! let third = character.frame(character.animation(), 2)?; // of the animation, counted from 0
//! assert_eq!([frame.width, same.width, third.width], [96; 3]);
//! let file: Vec<u8> = png_bytes(&frame)?;
//! # Ok(())
//! # }
//! ```
//!
//! Drawings need no file. [`CharacterSpec`](crate::pipeline::CharacterSpec) is a plain value: layers of poses, each a
//! [`Drawing`](crate::input::Drawing), and the options of every stage. A scene file is one way to make it, and this is another:
//!
//! ```
//! use inbetween::{Animation, BitmapOptions, Character, CharacterSpec, LayerSpec, PoseSpec, read_pixels};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A bar, wide or narrow; four bytes a pixel, red, green, blue, alpha.
//! let bar = |half: usize| {
//!     let alpha = |k: usize| if (32 - half..32 + half).contains(&(k % 64)) && (8..56).contains(&(k / 64)) { 255 } else { 0 };
//!     let pixels: Vec<u8> = (0..64 * 64).flat_map(|k| [200, 60, 40, alpha(k)]).collect();
//!     read_pixels([64, 64], &pixels, &BitmapOptions::default())
//! };
//! let poses = vec![PoseSpec::drawn("wide", bar(24)?), PoseSpec::drawn("narrow", bar(8)?)];
//! let places = vec![vec![0.0, 0.0], vec![1.0, 0.0]];
//! let animation = Animation::visiting(places.iter().map(Vec::as_slice), true)?;
//! let spec = CharacterSpec::new(vec![LayerSpec::new("bar", poses)]).with_places(places);
//! let character = Character::new(&spec, &animation, [64, 64])?;
//! let frame = character.frame_at(&[0.5, 0.0])?;
//! assert!(frame.pixels.iter().any(|pixel| pixel[3] == 255));
//! # Ok(())
//! # }
//! ```
//!
//! Options are set in one way everywhere: made with `default()`, or a specification with its `new` or the like, and then given what is wanted in
//! their fields, as in `let mut options = BlendOptions::default(); options.stretch = Stretch::Log;`. Later versions can add fields
//! without breaking what is written so.
//!
//! What the command does with drawings by itself is asked for here: [`with_loose_parts`](crate::pipeline::CharacterSpec::with_loose_parts) makes layers
//! of loose parts, [`with_facings`](crate::pipeline::CharacterSpec::with_facings) settles which way drawings face, and
//! [`on_canvas`](crate::pipeline::CharacterSpec::on_canvas) lets frames show the drawings' canvas. A character that is being edited is a
//! [`Build`](crate::pipeline::Build), whose `update` repeats only the stages that a change concerns.
//!
//! # Examples to copy
//!
//! Each of these files in `examples` has at most forty lines:
//!
//! | file | what it does |
//! |---|---|
//! | `two_drawings.rs` | two drawings in memory become a GIF in memory |
//! | `crowd.rs` | a hundred characters, each with weights of its own, in one call |
//! | `weight_provider.rs` | weights of one's own |
//! | `exporter.rs` | a format of one's own |
//! | `handles.rs` | a mesh bent by handles |
//!
//! `stages.rs` calls all stages of the walker one by one and draws what each makes; `vector_mesh.rs` turns frames of curves into triangles for an engine.
//!
//! # The stages by themselves
//!
//! A program that has outlines, or a mesh, or weights of its own, enters where they come in. Here are two shapes on their way to the shape
//! between them:
//!
//! ```
//! use inbetween::blend::{BlendOptions, RigidBlend};
//! use inbetween::compatible::{RefineOptions, SimplifyOptions, refine, simplify, triangulate};
//! use inbetween::matching::{MatchOptions, match_rings};
//! use inbetween::math::Point;
//! use inbetween::outline::{Outline, Ring};
//! use inbetween::pose::PoseSet;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let corner = [[0.0, 0.0], [9.0, 0.0], [9.0, 3.0], [3.0, 3.0], [3.0, 9.0], [0.0, 9.0]];
//! let bar = [[0.0, 0.0], [9.0, 0.0], [18.0, 0.0], [18.0, 3.0], [9.0, 3.0], [0.0, 3.0]];
//! let rings = [Ring::new(corner.map(Point::from))?, Ring::new(bar.map(Point::from))?];
//! // Which point of one is which of the other.
//! let matched = match_rings(&rings, &[], &MatchOptions::default())?;
//! // Polygons with corresponding vertices, one triangulation for both, and better triangles.
//! let outlines = rings.map(|ring| Outline::new(ring, Vec::new()));
//! let outlines = outlines.into_iter().collect::<Result<Vec<_>, _>>()?;
//! let simplified = simplify(&outlines, &[matched.correspondence], &[], &SimplifyOptions::default())?;
//! let (bare, _) = triangulate(&simplified.polygons, &[])?;
//! let (mesh, _) = refine(&bare, &RefineOptions::default())?;
//! // A mesh with a shape in every pose, factored once, blended often.
//! let names = ["corner", "bar"].map(str::to_owned);
//! let poses = PoseSet::new(mesh.topology, names.into_iter().zip(mesh.positions).collect())?;
//! let blend = RigidBlend::new(&poses, &BlendOptions::default())?;
//! let (mut scratch, mut positions) = (blend.scratch(), Vec::new());
//! let report = blend.blend(&[0.5, 0.5], &mut scratch, &mut positions)?;
//! assert_eq!((positions.len(), report.flipped), (blend.vertex_count(), 0));
//! # Ok(())
//! # }
//! ```
//!
//! | to do what | types |
//! |---|---|
//! | read a drawing | [`input::read_bitmap`](crate::input::read_bitmap), [`read_pixels`](crate::input::read_pixels), [`read_svg`](crate::input::read_svg) |
//! | map drawings, with all that the command does | [`pipeline::map_layer`](crate::pipeline::map_layer), which gives a [`Mapping`](crate::pose::Mapping) and a report of every stage |
//! | prove or store a mapping | [`Mapping::check`](crate::pose::Mapping::check), [`to_json`](crate::pose::Mapping::to_json), [`from_json`](crate::pose::Mapping::from_json) |
//! | weigh poses | [`BiharmonicWeights`](crate::weights::BiharmonicWeights), [`RbfWeights`](crate::weights::RbfWeights), or any [`WeightProvider`](crate::weights::WeightProvider) |
//! | blend shapes | [`RigidBlend`](crate::blend::RigidBlend); its [`blend_crowd`](crate::blend::RigidBlend::blend_crowd) for many characters |
//! | bend a shape | [`HandleDeformation`](crate::pose::HandleDeformation) |
//! | reach a place | [`pipeline::reach`](crate::pipeline::reach()) |
//! | paint | [`render::Painter`](crate::render::Painter), from [`Character::paint`](crate::pipeline::Character::paint) |
//! | get curves, or textured meshes | [`Character::draw`](crate::pipeline::Character::draw), [`Character::puppet`](crate::pipeline::Character::puppet) |
//! | write files | [`export`](crate::export): every writer takes anything that takes bytes |
//! | edit a scene file | [`scene`](crate::scene) |
//!
//! # What can be relied on
//!
//! - The library prints nothing, reads neither clock nor environment, and panics on no input. Only `input`, `scene` and `export` open files.
//! - The same input gives the same bytes for any number of threads. Parallel loops run in rayon's current pool; install one of your own to
//!   choose how many threads there are.
//! - Every stage has one error type that says what is wrong, where, and what to do.
//! - With a scratch of its own and positions that have held a frame before, a blend allocates nothing.
//!
//! # Features
//!
//! | feature | what it adds |
//! |---|---|
//! | none of them | the core: outlines to mappings, weights, blended vertices and painted frames; no file is opened |
//! | `images` | drawings in pixels, of files and of memory ([`read_bitmap`](crate::input::read_bitmap), [`read_pixels`](crate::input::read_pixels)) |
//! | `layered` | layered files: PSD, OpenRaster, Krita and Aseprite ([`LayeredFile`](crate::input::layered::LayeredFile)); takes `images` along |
//! | `svg` | SVG drawings ([`read_svg`](crate::input::read_svg)); takes `images` along |
//! | `export` | every writer ([`export`](crate::export)) |
//! | `shape3d` | Shape by Example in space ([`shape3d`](crate::shape3d)), with `export` its files |
//! | `scene` | scene files ([`scene`](crate::scene)); takes all of these but `layered` along |
//! | `cli` | the command; takes `scene` and `layered` along |
//! | `explorer` | `inbetween explore`; takes `cli` along |
//! | `kurbo`, `tiny_skia`, `lyon` | conversions to and from the paths of these crates ([`interop`](crate::interop)) |
//! | `lyon` with `export` | frames of curves as triangles for engines, too |
//!
//! All but the last two rows are on by default. A program that has outlines writes `default-features = false` and compiles linear algebra, a
//! triangulation and small crates; one that reads and writes pictures adds `features = ["images", "svg", "export"]`. Without
//! `svg` a drawing keeps the pixels that it was given, however large its frames are.
//!
//! # How fast
//!
//! On two cores of an AMD EPYC. What holds on other machines are the ratios to the two triangular solves of the crate faer, measured in the same run:
//!
//! | | time | beside faer's two solves |
//! |---|---|---|
//! | a frame of 2,000 vertices and 4 poses, from weights to vertices | 72 µs | 1.4 × |
//! | the same with 16 poses | 99 µs | 2.0 × |
//! | a frame of 10,000 vertices and 4 poses | 0.49 ms | 1.3 × |
//! | a crowd of 1,000 characters of 500 vertices, each with its own weights, two threads | 9 ms | |
//! | radial weights, 14 poses in 4 dimensions, a place of many | 0.14 µs | |
//! | the same, solved again after an edit | 8 µs | |
//! | a pose of 16 moved in the plane of biharmonic weights | 3 to 12 ms | |
//! | four drawings of 1,000 outline points, from pixels to the mesh, one thread | 0.10 s | |
//!
//! | | time | beside another program |
//! |---|---|---|
//! | a frame of 1920 × 1080 pixels, 510 triangles, four textures, one thread | 20 ms | 0.63 × what tiny-skia needs for one texture |
//! | the same on two threads | 12.5 ms | 0.39 × |
//! | weights and blend of 8 forms (6 pseudo-examples, 4 dimensions) of 4,005 values | 1.5 µs | 0.6 × NumPy's blend alone |
//! | weights and blend of 5 forms (2, 2) of 7,686 values | 1.8 µs | 0.6 × |
//!
//! Comparing what is drawn inside takes a few tenths of a second a drawing, once; silhouettes with nothing inside take a tenth of that. To repeat
//! the measurements: `cargo bench --bench blend`, `--bench weights`, `--bench raster`, `--bench shape`, `--bench stages`; `--bench instructions` counts
//! instructions instead of timing. The repository's `ARCHITECTURE.md` has the tables of every stage, and how costs grow.
