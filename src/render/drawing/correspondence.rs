//! Which curve of one drawing becomes which of another.

use kurbo::CubicBez;

use super::strand::{Carriers, Strand};
use crate::input::{ArtElement, Subpath};
use crate::math::Point;

/// The strands of an element that `carriers.meshes.len()` drawings have.
pub(super) fn corresponding(elements: &[&ArtElement], carriers: &Carriers) -> Vec<Strand> {
    let Some(first) = elements.first() else {
        return Vec::new();
    };
    let count = elements
        .iter()
        .map(|element| element.subpaths.len())
        .min()
        .unwrap_or(0)
        .min(first.subpaths.len());
    (0..count)
        .map(|k| {
            let subpaths: Vec<&Subpath> = elements.iter().map(|element| &element.subpaths[k]).collect();
            let of_each: Vec<Vec<CubicBez>> = subpaths.iter().map(|subpath| cubics(subpath)).collect();
            let length = of_each.iter().map(Vec::len).min().unwrap_or(0);
            let curves: Vec<Vec<CubicBez>> = (0..length).map(|j| of_each.iter().map(|of| of[j]).collect()).collect();
            Strand::new(&curves, subpaths[0].is_closed, carriers)
        })
        .collect()
}

fn cubics(subpath: &Subpath) -> Vec<CubicBez> {
    let mut from = subpath.start;
    subpath
        .cubics
        .iter()
        .map(|&[a, b, c]| {
            let p = |p: Point| kurbo::Point::new(p.x, p.y);
            let cubic = CubicBez::new(p(from), p(a), p(b), p(c));
            from = c;
            cubic
        })
        .collect()
}
