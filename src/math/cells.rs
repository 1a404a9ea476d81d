//! The cells of a grid in a triangle.

use super::point::{Point, cross};

/// Calls `visit` with every cell of a grid of `size` (columns, rows) whose middle is in a counter-clockwise triangle, and with its coordinates along the two sides from
/// the first corner. Corners are in cells: cell (i, j) is the square from (i, j) to (i + 1, j + 1). Triangles that are flat or turned have none.
pub(crate) fn for_each_cell([a, b, c]: [Point; 3], size: [usize; 2], mut visit: impl FnMut(usize, [f64; 2])) {
    /// Middles on an edge belong to both sides.
    const ON_EDGE: f64 = 1e-6;
    /// A triangle with less area, in cells, is flat.
    const FLAT: f64 = 1e-9;
    let (along, aside) = (b - a, c - a);
    let double_area = cross(along, aside);
    if double_area.is_nan() || double_area <= FLAT {
        return;
    }
    // Casts saturate.
    let cells = |low: f64, high: f64, count: usize| {
        let first = (low - 0.5).ceil().max(0.0) as usize;
        let last = (high - 0.5).floor();
        first..if last < 0.0 {
            0
        } else {
            (last as usize).saturating_add(1).min(count)
        }
    };
    for row in cells(a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y), size[1]) {
        for column in cells(a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x), size[0]) {
            let p = Point::new(column as f64 + 0.5, row as f64 + 0.5) - a;
            let u = cross(p, aside) / double_area;
            let v = cross(along, p) / double_area;
            if u >= -ON_EDGE && v >= -ON_EDGE && u + v <= 1.0 + ON_EDGE {
                visit(row * size[0] + column, [u, v]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_triangles_have_the_cells_of_their_square() {
        let corners = [[-1.0, 0.0], [3.0, 0.0], [3.0, 2.0], [-1.0, 2.0]].map(Point::from);
        let mut count = [0; 12];
        for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
            for_each_cell([corners[a], corners[b], corners[c]], [4, 3], |cell, [u, v]| {
                assert!(u + v < 1.0 + 1e-5);
                count[cell] += 1;
            });
        }
        assert!(
            count.iter().enumerate().all(|(k, n)| (*n > 0) == (k % 4 < 3 && k < 8)),
            "{count:?}"
        );
        for_each_cell([corners[0], corners[2], corners[1]], [4, 3], |_, _| unreachable!());
    }
}
