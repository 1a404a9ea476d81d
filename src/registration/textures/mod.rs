//! Textures registered to one another on a mesh that already holds their shapes in correspondence.
//!
//! What the mesh leaves over (lines a few pixels apart, below the size of its triangles) is taken out by a smooth warp a pose, so that a cross-fade
//! shows one line where two drawings have one line. It is what the paper leaves to others (NWM, section 5: "we make no attempt to warp textures").
//!
//! [`Embedded`] drawings: a mesh that has all poses, and a finer one on it -> for every pose the places of the mesh that show there what the reference
//! shows at the vertices of the finer one.
//!
//! 1. The reference's pixels that the mesh covers, each with its fine triangle (`surface`), fewer of them where pictures are blurred.
//! 2. At each of four levels of the scale space, coarse to fine: the pose is seen through the mesh as the reference is, and what still differs
//!    moves the vertices, by a robust Gauss-Newton step on differences of all channels (Lucas and Kanade 1981, <https://doi.org/10.5555/1623264.1623280>)
//!    with a membrane between neighbours (Horn and Schunck 1981, <https://doi.org/10.1016/0004-3702(81)90024-2>) (`flow`).
//! 3. Where the warp bends more than it may, it is made smoother until no triangle can turn over at any weights that are not negative (`bending`).
//!
//! Cost: O(#pixels) a step and more for the scale space, about 150 ms a pose on one thread. Limit: what is further away than
//! about 18 working pixels (3 % of a figure unit) is not found; what only one drawing has stays where the mesh has it.

mod bending;
mod flow;
mod surface;

use std::sync::Arc;

use rayon::prelude::*;

use crate::appearance::Appearance;
use crate::math::Point;
use crate::mesh::{MeshPoint, PointLocator, Topology};
use flow::{Carrier, Flow};
use surface::Surface;

/// The drawings of a mesh's poses.
#[derive(Debug, Clone, Copy)]
pub struct Embedded<'a> {
    /// The mesh that has all poses.
    pub triangles: &'a [[usize; 3]],
    /// A finer mesh on it, and the place of each of its vertices.
    pub fine: (&'a Topology, &'a [MeshPoint]),
    /// What each drawing shows.
    pub appearances: &'a [Arc<Appearance>],
    /// For each drawing, #vertices positions of the mesh in source units.
    pub positions: &'a [&'a [Point]],
}

/// For each drawing the places of the mesh that show what the reference shows at the vertices of the fine mesh; `None` for the reference, for drawings
/// that `is_wanted` leaves out, and for those that the warp would make no more alike.
#[must_use]
pub fn register_textures(drawn: &Embedded, reference: usize, is_wanted: &[bool]) -> Vec<Option<Vec<MeshPoint>>> {
    let own = &drawn.appearances[reference];
    let in_pixels = |appearance: &Appearance, positions: &[Point]| -> Vec<Point> {
        positions.iter().map(|p| appearance.to_pixels(*p)).collect()
    };
    let coarse = in_pixels(own, drawn.positions[reference]);
    let (topology, places) = drawn.fine;
    let vertices: Vec<Point> = places.iter().map(|place| place.at(&coarse)).collect();
    let surface = Surface::new(topology, &vertices);
    let locator = PointLocator::new(drawn.triangles, &coarse);
    let carrier = Carrier {
        positions: &coarse,
        locator: &locator,
        places,
    };
    let flow = Flow::new(&surface, own, carrier);
    let of_pose = |pose: usize| {
        let appearance = &drawn.appearances[pose];
        let wanted = pose != reference && is_wanted.get(pose).copied().unwrap_or(false);
        wanted.then(|| flow.towards(appearance, &in_pixels(appearance, drawn.positions[pose])))?
    };
    (0..drawn.appearances.len()).into_par_iter().map(of_pose).collect()
}
