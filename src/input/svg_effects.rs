//! What filters of a vector drawing paint beyond its outlines: soft shadows, glow, blur. Outlines are those of the geometry, and what
//! lies beyond is cut off, which has to be said.
//!
//! Nodes and outlines -> whether much is cut off. The drawing is painted small, filters and all; pixels that are seen and are no rim of
//! an outline are counted. Cost that of a small picture, for drawings with filters only.

use kurbo::Affine;

use super::InputError;
use super::bitmap::rows_inside;
use super::enclosure::depths;
use super::found::{FAINT, LEAST_SOFT};
use super::svg::rasterise;
use crate::math::Point;
use crate::outline::Outline;

/// The longer side of the picture that is looked at, in pixels.
const SIDE: f64 = 384.0;
/// Pixels beside an outline that belong to its rim: they are partly covered.
const RIM: u16 = 2;
/// Whether filters paint much beyond the outlines.
pub(super) fn are_cut(nodes: &[&usvg::Node], to_user: Affine, outlines: &[&Outline]) -> Result<bool, InputError> {
    if !nodes.iter().any(|node| has_filter(node)) {
        return Ok(false);
    }
    let boxes = nodes.iter().filter_map(|node| node.abs_layer_bounding_box());
    let boxes = boxes.map(|bbox| {
        let (left, top) = (f64::from(bbox.left()), f64::from(bbox.top()));
        to_user.transform_rect_bbox(kurbo::Rect::new(
            left,
            top,
            left + f64::from(bbox.width()),
            top + f64::from(bbox.height()),
        ))
    });
    let Some(bounds) = boxes.reduce(|a, b| a.union(b)) else {
        return Ok(false);
    };
    let corners = (Point::new(bounds.x0, bounds.y0), Point::new(bounds.x1, bounds.y1));
    let longer = bounds.width().max(bounds.height());
    if !(longer > 0.0 && longer.is_finite()) {
        return Ok(false);
    }
    let picture = rasterise(nodes, to_user, Some(corners), Some(SIDE / longer))?;
    let to_pixels = |p: Point| (p - picture.origin) * picture.pixels_per_unit;
    // What is too small to be an outline of pixels has no shadow that is seen, either.
    let small: Vec<Outline> = outlines
        .iter()
        .filter_map(|outline| outline.map(to_pixels).ok())
        .collect();
    let inside = rows_inside(&small.iter().collect::<Vec<_>>(), picture.width, picture.height);
    let beyond: Vec<bool> = inside.iter().map(|inside| !inside).collect();
    let far = depths(&beyond, picture.width, RIM);
    let seen = picture
        .pixels
        .iter()
        .zip(far)
        .filter(|(pixel, far)| f32::from(pixel[3]) >= 255.0 * FAINT && *far > RIM);
    let area = inside.iter().filter(|inside| **inside).count();
    Ok(seen.count() as f64 > LEAST_SOFT * area as f64)
}

fn has_filter(node: &usvg::Node) -> bool {
    match node {
        usvg::Node::Group(group) => !group.filters().is_empty() || group.children().iter().any(has_filter),
        _ => false,
    }
}
