//! The pictures of a layer registered to one another, on a mesh finer than the one that holds its shape.

use super::boundaries::Boundaries;
use super::drawn::is_found;
use super::spec::{LayerSpec, PoseShape};
use crate::math::Point;
use crate::mesh::{MeshPoint, Topology, subdivided};
use crate::pose::{Mapping, TextureMesh};
use crate::registration::{Embedded, register_textures};

/// The side of the fine mesh's triangles, in working pixels: half of it, and cross-fades are hardly more alike, for four times as many.
const SIDE_PX: f64 = 6.0;
/// Parts of a side of the mapping's triangles at most.
const MOST_PARTS: usize = 4;

/// The mesh for the pictures of a layer. `None` where nothing says more than the mapping: nothing is drawn inside, or no drawing becomes more like the
/// reference's.
pub(super) fn registered(layer: &LayerSpec, boundaries: &Boundaries, mapping: &Mapping) -> Option<TextureMesh> {
    let guide = boundaries.guide.as_ref()?;
    let drawn_on = layer.drawn_poses();
    let positions: Vec<&[Point]> = (drawn_on.iter())
        .map(|pose| mapping.poses.positions()[*pose].as_slice())
        .collect();
    let is_alike = |drawing: usize| {
        guide
            .registration
            .explained(drawing)
            .is_some_and(|explained| is_found(&explained))
    };
    let is_alike: Vec<bool> = (0..drawn_on.len()).map(is_alike).collect();
    let triangles = mapping.poses.topology().triangles();
    let reference = guide.reference;
    let own = &boundaries.appearances[reference];
    let side = median_side(triangles, positions[reference]) * own.scale();
    let parts = ((side / SIDE_PX).round() as usize).clamp(1, MOST_PARTS);
    let (fine, places) = subdivided(triangles, positions[reference].len(), parts);
    let fine = Topology::new(places.len(), fine).ok()?;
    let drawn = Embedded {
        triangles,
        fine: (&fine, &places),
        appearances: &boundaries.appearances,
        positions: &positions,
    };
    let registered = register_textures(&drawn, reference, &is_alike);
    if registered.iter().all(Option::is_none) {
        return None;
    }
    let shown = layer.shown_drawings();
    let anchors = |pose: usize| -> Vec<MeshPoint> {
        // What vanishes in a pose has no drawing there.
        let of_drawing = match layer.poses[pose].shape {
            PoseShape::Shrunk(_) => None,
            PoseShape::Drawn(_) | PoseShape::Deformed(_) => registered[shown[pose]].clone(),
        };
        of_drawing.unwrap_or_else(|| places.clone())
    };
    let anchors = (0..layer.poses.len()).map(anchors).collect();
    TextureMesh::new(fine, anchors)
}

/// The median length of the sides of some triangles.
fn median_side(triangles: &[[usize; 3]], positions: &[Point]) -> f64 {
    let sides = |t: &[usize; 3]| {
        (0..3)
            .map(|k| (positions[t[k]] - positions[t[(k + 1) % 3]]).norm())
            .collect::<Vec<_>>()
    };
    let mut lengths: Vec<f64> = triangles.iter().flat_map(sides).collect();
    let middle = lengths.len() / 2;
    if lengths.is_empty() {
        return 0.0;
    }
    *lengths.select_nth_unstable_by(middle, f64::total_cmp).1
}
