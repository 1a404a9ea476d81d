//! The edge of a cross-faded drawing, drawn beyond itself.
//!
//! Drawings that are cross-faded are cut by the blended silhouette, which lies between their outlines: where a drawing falls short of it, the colours of
//! the others alone would show, as slivers. What lies on the outline of a drawing is therefore drawn once more, beneath the drawing and wider by as far
//! as the silhouette can be away; the silhouette cuts what is too much.
//!
//! Limits: what is translucent, dashed or painted by nothing is not widened, since it would be seen through what is above it.

use rstar::RTree;
use rstar::primitives::Line;

use super::super::Camera;
use super::VectorShape;
use crate::input::{Fill, LineCap, LineJoin, Paint, Stroke, Subpath};
use crate::math::{Point, point};
use crate::outline::Outline;

/// How near to the outline an element's edge is part of it, as a fraction of the outline's diagonal: a pixel on drawings of 500.
const NEAR: f64 = 0.002;
/// What a drawing is widened by beyond what it may fall short by, in pixels: the soft edge of what is cut.
const MARGIN_PX: f64 = 1.0;
/// How many times its width a corner of a widened edge may reach: pointed corners stay pointed down to 29 degrees.
const MITER_LIMIT: f64 = 4.0;

/// What lies on the outline of an element.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Edge {
    painted: Painted,
    /// Which of its subpaths: others bound openings, which stay.
    subpaths: Vec<usize>,
}

/// What an element's edge is painted with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Painted {
    Filled,
    Lined,
}

/// What of the outline of a drawing the silhouette has, in pixels of the frame.
pub(super) struct DrawnOutline {
    segments: RTree<Line<[f64; 2]>>,
    near: f64,
}

impl DrawnOutline {
    /// The first `ring_count` rings of `outline`, the outer one first.
    pub(super) fn new(outline: &Outline, ring_count: usize, camera: &Camera) -> Self {
        let at = |p: Point| -> [f64; 2] { camera.to_pixels(p).into() };
        let edges = outline.rings().iter().take(ring_count).flat_map(|ring| ring.edges());
        let segments = edges.map(|(a, b)| Line::new(at(a), at(b))).collect();
        let (low, high) = point::bounding_box(outline.outer().points()).unwrap_or_default();
        Self {
            segments: RTree::bulk_load(segments),
            near: NEAR * (high - low).norm() * camera.scale(),
        }
    }

    /// What lies on the outline of an element where it was drawn; `None` for one inside, and one whose edge cannot be widened.
    pub(super) fn edge(&self, shape: &VectorShape) -> Option<Edge> {
        if shape.opacity < 1.0 {
            return None;
        }
        let (painted, reach) = match (&shape.stroke, &shape.fill) {
            (Some(line), _) if line.width > 0.0 => {
                let is_whole = is_opaque(&line.paint) && line.dashes.is_empty();
                (is_whole.then_some(Painted::Lined)?, 0.5 * line.width)
            }
            (_, Some(fill)) => (is_opaque(&fill.paint).then_some(Painted::Filled)?, 0.0),
            _ => return None,
        };
        let reach = reach + self.near;
        let is_near = |p: Point| {
            let nearest = self.segments.nearest_neighbor(p.into());
            nearest.is_some_and(|line| point::nearest_on_segment(p, line.from.into(), line.to.into()).1 <= reach)
        };
        let touches = |subpath: &Subpath| subpath.ends_and_middles().into_iter().any(is_near);
        let subpaths: Vec<usize> = (0..shape.subpaths.len())
            .filter(|&k| touches(&shape.subpaths[k]))
            .collect();
        (!subpaths.is_empty()).then_some(Edge { painted, subpaths })
    }
}

/// An element's edge alone, reaching `width_px` beyond it.
pub(super) fn widened(shape: &VectorShape, edge: &Edge, width_px: f64) -> Option<VectorShape> {
    let width = width_px + MARGIN_PX;
    let (stroke, is_closed) = match edge.painted {
        Painted::Lined => {
            let line = shape.stroke.as_ref()?;
            (
                Stroke {
                    width: line.width + 2.0 * width,
                    ..line.clone()
                },
                false,
            )
        }
        Painted::Filled => (line_of(shape.fill.as_ref()?, 2.0 * width), true),
    };
    let chosen = edge.subpaths.iter().filter_map(|&k| shape.subpaths.get(k));
    let mut subpaths: Vec<Subpath> = chosen.cloned().collect();
    for subpath in &mut subpaths {
        // What is filled is closed, said or not.
        subpath.is_closed |= is_closed;
    }
    Some(VectorShape {
        id: format!("{}~edge", shape.id),
        subpaths,
        fill: None,
        stroke: Some(stroke),
        opacity: shape.opacity,
    })
}

fn line_of(fill: &Fill, width: f64) -> Stroke {
    Stroke {
        paint: fill.paint.clone(),
        width,
        cap: LineCap::default(),
        join: LineJoin::Miter,
        miter_limit: MITER_LIMIT,
        dashes: Vec::new(),
        dash_offset: 0.0,
    }
}

fn is_opaque(paint: &Paint) -> bool {
    match paint {
        Paint::Solid([.., alpha]) => *alpha >= 1.0,
        Paint::Gradient(gradient) => gradient.stops.iter().all(|stop| stop.colour[3] >= 1.0),
    }
}
