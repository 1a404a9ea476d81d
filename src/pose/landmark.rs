//! Where an artist's landmarks are on every pose.

use crate::math::Point;

/// What a landmark marks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LandmarkKind {
    /// A point of the outer outline: it guides the matching.
    OnOutline,
    /// A point of a hole's rim: it guides the matching, and says which hole that is.
    OnRim,
    /// A point inside the shape: a vertex of the mesh.
    Inside,
    /// A line inside the shape: a chain of edges of the mesh.
    Line,
}

/// A landmark on every pose of a mapping.
#[derive(Debug, Clone, PartialEq)]
pub struct PlacedLandmark {
    /// Its name.
    pub name: String,
    /// What it marks.
    pub kind: LandmarkKind,
    /// Per pose one point, or the points of the line.
    pub at: Vec<Vec<Point>>,
    /// Per pose, whether the artist put it there; the program did otherwise.
    pub given: Vec<bool>,
}
