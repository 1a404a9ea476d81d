//! What is known of a shape from the frame before, and the points of its path.

use super::Triangles;
use crate::math::{NotSingle, Point, SinglePrecision, point};
use crate::render::{FillRule, Subpath};

/// A subpath smaller than this, in pixels, is a point.
const LEAST_EXTENT: f64 = 1e-6;

/// A part of the frame before.
#[derive(Debug)]
pub(super) struct Known {
    /// Per subpath the steps of its curves.
    steps: Vec<Vec<usize>>,
    is_closed: Vec<bool>,
    /// Which subpaths were points.
    is_point: Vec<bool>,
    pub(super) rule: Option<FillRule>,
    pub(super) indices: Vec<u32>,
    /// For each vertex the point of the path that it is; empty if one is none.
    pub(super) sources: Vec<usize>,
}

impl Known {
    pub(super) fn of_fill(sampled: Sampled, rule: FillRule, triangles: Triangles) -> Self {
        Self {
            steps: sampled.steps,
            is_closed: sampled.is_closed,
            is_point: sampled.is_point,
            rule: Some(rule),
            indices: triangles.indices,
            sources: triangles.sources,
        }
    }

    pub(super) fn of_stroke(sampled: Sampled, indices: Vec<u32>) -> Self {
        Self {
            steps: sampled.steps,
            is_closed: sampled.is_closed,
            is_point: sampled.is_point,
            rule: None,
            indices,
            sources: Vec::new(),
        }
    }

    /// Whether its points are those of this path, too.
    pub(super) fn is_of(&self, sampled: &Sampled) -> bool {
        self.steps == sampled.steps && self.is_closed == sampled.is_closed && self.is_point == sampled.is_point
    }
}

/// The points of a path: each curve in equal steps of its parameter.
#[derive(Debug)]
pub(super) struct Sampled {
    steps: Vec<Vec<usize>>,
    pub(super) is_closed: Vec<bool>,
    /// Subpaths that are left out.
    pub(super) is_point: Vec<bool>,
    /// All points, subpath after subpath.
    pub(super) points: Vec<Point>,
    /// Where each subpath's points begin in `points`, and where the last ends.
    pub(super) starts: Vec<usize>,
    /// For lyon.
    pub(super) single: SinglePrecision,
}

impl Sampled {
    /// The points of a path whose coordinates are finite, with the steps of the frame before where they are enough.
    pub(super) fn new(subpaths: &[Subpath], tolerance: f64, known: Option<&Known>) -> Result<Self, NotSingle> {
        let mut steps: Vec<Vec<usize>> = Vec::new();
        for (k, subpath) in subpaths.iter().enumerate() {
            let needed = subpath.steps(tolerance);
            let before = known.and_then(|known| known.steps.get(k));
            let before = before.filter(|before| before.len() == needed.len());
            let enough = |(curve, &needed): (usize, &usize)| match before.map(|before| before[curve]) {
                Some(before) if before >= needed => before,
                _ => needed.next_power_of_two(),
            };
            steps.push(needed.iter().enumerate().map(enough).collect());
        }
        let (mut points, mut starts) = (Vec::new(), vec![0]);
        for (subpath, steps) in subpaths.iter().zip(&steps) {
            let mut own = subpath.polyline(steps);
            // A closed path ends where it begins: that is one point.
            if subpath.is_closed && own.len() > 1 && own.first() == own.last() {
                own.pop();
            }
            points.extend(own);
            starts.push(points.len());
        }
        let is_point = |subpath: &Subpath| point::diagonal(subpath.points()) < LEAST_EXTENT;
        Ok(Self {
            is_closed: subpaths.iter().map(|subpath| subpath.is_closed).collect(),
            is_point: subpaths.iter().map(is_point).collect(),
            single: SinglePrecision::fitting(&points)?,
            steps,
            points,
            starts,
        })
    }

    /// The subpaths that are drawn: where their points begin, the points, whether they are closed.
    pub(super) fn drawn(&self) -> impl Iterator<Item = (usize, &[Point], bool)> + '_ {
        let subpath = |k: usize| {
            let range = self.starts[k]..self.starts[k + 1];
            (range.start, &self.points[range], self.is_closed[k])
        };
        (0..self.is_point.len()).filter(|k| !self.is_point[*k]).map(subpath)
    }
}
