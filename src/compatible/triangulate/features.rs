//! What lies inside the polygons and has to be met by the mesh: points that become vertices, paths that become chains
//! of edges.
//!
//! A path has as many points in every pose. Its ends lie inside, or on vertices of the polygons; it touches neither
//! itself nor anything else. That is proven here with exact predicates, before anything is built on it.

use super::TriangulateError;
use crate::math::{Point, predicate};
use crate::outline::Outline;

/// Where an end of a [`FeaturePath`] lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PathEnd {
    /// Inside: at the path's own first or last point.
    #[default]
    Inside,
    /// On a vertex of the polygons, which comes before the path's first point or after its last.
    Boundary {
        /// Which ring; 0 is the outer one.
        ring: usize,
        /// Which vertex of the ring.
        vertex: usize,
    },
}

/// A line inside the polygons that becomes a chain of edges.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FeaturePath {
    /// Its start and its end.
    pub ends: [PathEnd; 2],
    /// Its points inside, from start to end: #points x #poses.
    pub points: Vec<Vec<Point>>,
}

/// What lies inside the polygons.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Features {
    /// Points that become vertices: #points x #poses.
    pub points: Vec<Vec<Point>>,
    /// Lines that become chains of edges.
    pub paths: Vec<FeaturePath>,
}

/// One of [`Features`], by its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Feature {
    /// A point.
    Point(usize),
    /// A path.
    Path(usize),
}

impl std::fmt::Display for Feature {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Point(k) => write!(f, "interior landmark {k}"),
            Self::Path(k) => write!(f, "path {k}"),
        }
    }
}

/// The features as vertices of the mesh to be.
#[derive(Debug)]
pub(super) struct Numbered {
    pub(super) points: Vec<usize>,
    /// Each path from end to end, its ends on the boundary included.
    pub(super) paths: Vec<Vec<usize>>,
    /// The rings' vertices and the features' together.
    pub(super) count: usize,
}

/// Numbers the features after the vertices of `rings` and adds their places to `positions` (per pose).
///
/// # Errors
/// [`TriangulateError`] if a feature has not one place a pose, or a path has no edge or an end on no vertex.
pub(super) fn number(
    features: &Features,
    rings: &[Vec<usize>],
    positions: &mut [Vec<Point>],
) -> Result<Numbered, TriangulateError> {
    let mut count = positions[0].len();
    let mut add = |feature: Feature, places: &[Point]| {
        for (pose, positions) in positions.iter_mut().enumerate() {
            let place = places.get(pose).filter(|place| crate::math::point::is_finite(**place));
            positions.push(*place.ok_or(TriangulateError::FeatureOutside { feature, pose })?);
        }
        count += 1;
        Ok(count - 1)
    };
    let points = features
        .points
        .iter()
        .enumerate()
        .map(|(k, places)| add(Feature::Point(k), places))
        .collect::<Result<_, TriangulateError>>()?;
    let mut paths = Vec::with_capacity(features.paths.len());
    for (path, written) in features.paths.iter().enumerate() {
        let short = TriangulateError::PathShort { path };
        let end = |end: PathEnd| match end {
            PathEnd::Inside => Ok(None),
            PathEnd::Boundary { ring, vertex } => {
                let found = rings.get(ring).and_then(|ring| ring.get(vertex));
                found.map(|&v| Some(v)).ok_or(short.clone())
            }
        };
        let mut vertices: Vec<usize> = end(written.ends[0])?.into_iter().collect();
        for places in &written.points {
            vertices.push(add(Feature::Path(path), places)?);
        }
        vertices.extend(end(written.ends[1])?);
        if vertices.len() < 2 || vertices[0] == vertices[vertices.len() - 1] {
            return Err(short);
        }
        paths.push(vertices);
    }
    Ok(Numbered { points, paths, count })
}

/// Proves that every feature lies inside its polygon and that no two of them touch.
///
/// # Errors
/// [`TriangulateError::FeatureOutside`] or [`TriangulateError::FeaturesMeet`] with the pose.
pub(super) fn check(
    polygons: &[Outline],
    rings: &[Vec<usize>],
    numbered: &Numbered,
    positions: &[Vec<Point>],
) -> Result<(), TriangulateError> {
    let boundary: Vec<(usize, usize)> = rings
        .iter()
        .flat_map(|ring| (0..ring.len()).map(|k| (ring[k], ring[(k + 1) % ring.len()])))
        .collect();
    let links: Vec<(usize, usize, usize)> = numbered
        .paths
        .iter()
        .enumerate()
        .flat_map(|(path, vertices)| vertices.windows(2).map(move |w| (path, w[0], w[1])))
        .collect();
    for (pose, (polygon, p)) in polygons.iter().zip(positions).enumerate() {
        for (k, &vertex) in numbered.points.iter().enumerate() {
            let place = p[vertex];
            let on_edge = |&(a, b): &(usize, usize)| predicate::on_segment(place, p[a], p[b]);
            let first = Feature::Point(k);
            if !polygon.contains(place) || boundary.iter().any(on_edge) {
                return Err(TriangulateError::FeatureOutside { feature: first, pose });
            }
            if let Some(other) = numbered.points[..k].iter().position(|&other| p[other] == place) {
                let second = Feature::Point(other);
                return Err(TriangulateError::FeaturesMeet { first, second, pose });
            }
            if let Some(&(path, ..)) = links.iter().find(|&&(_, a, b)| on_edge(&(a, b))) {
                let second = Feature::Path(path);
                return Err(TriangulateError::FeaturesMeet { first, second, pose });
            }
        }
        for (k, &(path, a, b)) in links.iter().enumerate() {
            let first = Feature::Path(path);
            if !polygon.contains((p[a] + p[b]) * 0.5) || boundary.iter().any(|&edge| touch(p, (a, b), edge)) {
                return Err(TriangulateError::FeatureOutside { feature: first, pose });
            }
            if let Some(&(other, ..)) = links[..k].iter().find(|&&(_, c, d)| touch(p, (a, b), (c, d))) {
                let second = Feature::Path(other);
                return Err(TriangulateError::FeaturesMeet { first, second, pose });
            }
        }
    }
    Ok(())
}

/// Whether two edges share more than one common vertex.
fn touch(p: &[Point], (a, b): (usize, usize), (c, d): (usize, usize)) -> bool {
    if p[a] == p[b] || p[c] == p[d] {
        return true;
    }
    let (shared, end, other) = match () {
        () if a == c => (a, b, d),
        () if a == d => (a, b, c),
        () if b == c => (b, a, d),
        () if b == d => (b, a, c),
        () => return predicate::touch(p[a], p[b], p[c], p[d]),
    };
    end == other || predicate::folds_back(p[end], p[shared], p[other])
}
