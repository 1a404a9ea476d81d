//! Which samples of a grid each triangle covers.
//!
//! Triangles in sample coordinates -> spans of samples. Vertices are rounded once to a fine integer grid, after which
//! every decision is exact: a sample belongs to a triangle if its centre lies in it, and a centre on an edge belongs
//! to the triangle at whose left or upper side the edge is (half-open rule). Triangles that share an edge round it to
//! the same sample, so a mesh covers each centre exactly once: no seam, no double blending.
//!
//! Triangles that are not positive after rounding are left out; in a folded mesh what they hide is covered by their
//! positive neighbours.

use crate::math::Point;

/// How finely vertices are placed: parts of a sample. A 256th moves a vertex by at most 0.002 samples.
const PARTS: i64 = 256;
/// Vertices beyond this many samples from the grid's corner are moved there, so that products fit 64 bits. Larger
/// than any grid.
const FARTHEST: f64 = (1 << 21) as f64;

/// A run of samples in one row, covered by one triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Span {
    /// Which triangle.
    pub triangle: usize,
    /// The row.
    pub row: usize,
    /// The first column.
    pub start: usize,
    /// The column after the last.
    pub end: usize,
}

/// Vertices placed on a grid of samples.
#[derive(Debug, Clone)]
pub(crate) struct PlacedVertices {
    /// In parts of a sample.
    places: Vec<[i64; 2]>,
}

impl PlacedVertices {
    /// Places `positions`, in samples: sample (i, j) has its centre at (i + 1/2, j + 1/2).
    #[must_use]
    pub(crate) fn new(positions: &[Point]) -> Self {
        let place = |v: f64| (v.clamp(-FARTHEST, FARTHEST) * PARTS as f64).round() as i64;
        Self {
            places: positions.iter().map(|p| [place(p.x), place(p.y)]).collect(),
        }
    }

    /// Where a triangle was placed, in samples. Every sample of its spans lies in it, exactly.
    #[must_use]
    pub(crate) fn corners(&self, triangle: [usize; 3]) -> [Point; 3] {
        triangle.map(|v| {
            let [x, y] = self.places[v];
            Point::new(x as f64, y as f64) / PARTS as f64
        })
    }

    /// Twice the area of a triangle in parts of samples squared; not positive if it covers nothing.
    fn doubled_area(&self, triangle: [usize; 3]) -> i64 {
        let [a, b, c] = triangle.map(|v| self.places[v]);
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    }

    /// The area that `triangles` cover, in samples, beyond the grid's border, too.
    #[must_use]
    pub(crate) fn covered_area(&self, triangles: &[[usize; 3]]) -> f64 {
        let doubled: f64 = triangles.iter().map(|t| self.doubled_area(*t).max(0) as f64).sum();
        0.5 * doubled / (PARTS * PARTS) as f64
    }

    /// Calls `draw` for each span that `triangles` cover of `rows` of a grid `width` samples wide, triangle by triangle.
    pub(crate) fn for_each_span(
        &self,
        triangles: &[[usize; 3]],
        width: usize,
        rows: std::ops::Range<usize>,
        mut draw: impl FnMut(Span),
    ) {
        for (triangle, corners) in triangles.iter().enumerate() {
            let [a, b, c] = corners.map(|v| self.places[v]);
            let lowest = a[1].min(b[1]).min(c[1]);
            let highest = a[1].max(b[1]).max(c[1]);
            // Rows whose centres lie in [lowest, highest).
            let first = first_centre_from(lowest, 1).max(rows.start as i64);
            let end = first_centre_from(highest, 1).min(rows.end as i64);
            if first >= end || self.doubled_area(*corners) <= 0 {
                continue;
            }
            for row in first..end {
                let centre = row * PARTS + PARTS / 2;
                let (mut start, mut stop) = (i64::MAX, i64::MIN);
                for (p, q) in [(a, b), (b, c), (c, a)] {
                    let (p, q) = if p[1] <= q[1] { (p, q) } else { (q, p) };
                    if p[1] <= centre && centre < q[1] {
                        // The crossing is at numerator / rise; both triangles at this edge compute the same numbers.
                        let rise = q[1] - p[1];
                        let numerator = p[0] * rise + (centre - p[1]) * (q[0] - p[0]);
                        let column = first_centre_from(numerator, rise);
                        start = start.min(column);
                        stop = stop.max(column);
                    }
                }
                let start = start.max(0);
                let stop = stop.min(width as i64);
                if start < stop {
                    draw(Span {
                        triangle,
                        row: row as usize,
                        start: start as usize,
                        end: stop as usize,
                    });
                }
            }
        }
    }
}

/// The first sample whose centre is at or after `numerator / denominator` parts; the denominator is positive.
fn first_centre_from(numerator: i64, denominator: i64) -> i64 {
    let distance = numerator - PARTS / 2 * denominator;
    let step = PARTS * denominator;
    distance.div_euclid(step) + i64::from(distance.rem_euclid(step) != 0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn counts(triangles: &[[usize; 3]], positions: &[Point], side: usize) -> Vec<u32> {
        let mut counts = vec![0; side * side];
        // In two bands of rows, as several threads would.
        let placed = PlacedVertices::new(positions);
        for rows in [0..side / 3, side / 3..side] {
            placed.for_each_span(triangles, side, rows, |span| {
                for x in span.start..span.end {
                    counts[span.row * side + x] += 1;
                }
            });
        }
        counts
    }

    #[test]
    fn centres_on_the_border_count_left_and_above() {
        // Corners on sample centres: of 3 x 3 centres on or in the square, the left and upper 2 x 2 are inside.
        let positions = [[0.5, 0.5], [2.5, 0.5], [2.5, 2.5], [0.5, 2.5]].map(Point::from);
        let counts = counts(&[[0, 1, 2], [0, 2, 3]], &positions, 4);
        assert_eq!(counts, [1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
    }

    #[test]
    fn negative_triangles_and_far_vertices_are_harmless() {
        let positions = [[0.0, 0.0], [4.0, 0.0], [1e300, 1e300]].map(Point::from);
        assert_eq!(counts(&[[0, 2, 1]], &positions, 4).iter().sum::<u32>(), 0);
        // Between the diagonal and a parallel that leaves the grid at once.
        assert_eq!(
            counts(&[[0, 1, 2]], &positions, 4),
            [1, 1, 1, 1, 0, 1, 1, 1, 0, 0, 1, 1, 0, 0, 0, 1]
        );
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]
        /// A fan around an inner point, with many vertices on centres and edges along them.
        #[test]
        fn a_mesh_covers_each_centre_exactly_once(
            inner in (2..30i32, 2..30i32),
            corners in prop::collection::vec(0..8i32, 8),
        ) {
            let half = |v: i32| f64::from(v) / 2.0;
            // A convex ring around the grid of 16 samples, so that all centres are inside.
            let mut positions: Vec<Point> = (0..8)
                .map(|k| {
                    let angle = f64::from(k) * std::f64::consts::TAU / 8.0;
                    let radius = 30.0 + half(corners[k as usize]);
                    Point::new((8.0 + radius * angle.cos()).round(), (8.0 + radius * angle.sin()).round())
                })
                .collect();
            positions.push(Point::new(half(inner.0), half(inner.1)));
            let triangles: Vec<[usize; 3]> = (0..8).map(|k| [k, (k + 1) % 8, 8]).collect();
            let counts = counts(&triangles, &positions, 16);
            prop_assert!(counts.iter().all(|c| *c == 1), "{counts:?}");
        }
    }
}
