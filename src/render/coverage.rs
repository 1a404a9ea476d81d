//! How much of each pixel closed polygons cover.
//!
//! Polygons in pixel coordinates -> one number in [0, 1] a pixel, the exact area covered. Each edge adds, in every row
//! it crosses, the signed area to its right within the pixels it passes and the full height to all further pixels;
//! a running sum along the row turns these differences into winding number times area. Where polygons overlap the sum
//! is cut at 1; a hole is a polygon of the other orientation.
//!
//! Differences from a sampled mask: no staircase at any angle, 256 levels at the cost of one pass over the edges.
//! Cost: O(#edges + #pixels touched + #pixels). Limits: a polygon that overlaps a part of itself of the *other*
//! orientation is clear there.

use std::ops::Range;

use crate::math::Point;
use crate::outline::{Outline, Ring};

/// The covered area of each pixel of a grid.
#[derive(Debug, Clone)]
pub(crate) struct Coverage {
    areas: Vec<f32>,
}

impl Coverage {
    /// The coverage of a grid of `width` x `height` pixels by closed polygons in pixel coordinates: pixel (i, j) is the
    /// square from (i, j) to (i+1, j+1). Points must be finite.
    #[must_use]
    pub(crate) fn of<'a>(polygons: impl IntoIterator<Item = &'a [Point]>, width: usize, height: usize) -> Self {
        let mut rows = CoverageRows::new(width, 0..height);
        for polygon in polygons {
            edges(polygon).for_each(|[a, b]| rows.add_edge(a, b));
        }
        let mut areas = vec![0.0; width * height];
        for (row, areas) in areas.chunks_exact_mut(width.max(1)).enumerate() {
            rows.for_each_run(row, |columns, area| areas[columns].fill(area));
        }
        Self { areas }
    }

    /// The coverage of a grid by the inside of an outline, whose points `place` takes to pixels.
    #[must_use]
    pub(crate) fn of_outline(outline: &Outline, place: impl Fn(Point) -> Point, width: usize, height: usize) -> Self {
        let polygon = |ring: &Ring| -> Vec<Point> { ring.points().iter().map(|p| place(*p)).collect() };
        let polygons: Vec<Vec<Point>> = outline.rings().iter().map(polygon).collect();
        Self::of(polygons.iter().map(Vec::as_slice), width, height)
    }

    /// Row by row, the covered area of each pixel, in [0, 1].
    #[must_use]
    pub(crate) fn areas(&self) -> &[f32] {
        &self.areas
    }
}

/// The edges of a closed polygon, in its order.
pub(super) fn edges(polygon: &[Point]) -> impl Iterator<Item = [Point; 2]> + '_ {
    let next = polygon.iter().cycle().skip(1);
    polygon.iter().zip(next).map(|(a, b)| [*a, *b])
}

/// The coverage of some rows of a grid, while edges are added to it and after.
pub(super) struct CoverageRows {
    /// One column more than the grid, for what continues to its right.
    stride: usize,
    top: usize,
    bottom: usize,
    differences: Vec<f32>,
    /// A bit for each difference that is not 0, rows beginning with a new word: most are.
    touched: Vec<u64>,
}

impl CoverageRows {
    /// Rows of a grid `width` pixels wide that nothing covers.
    pub(super) fn new(width: usize, rows: Range<usize>) -> Self {
        let stride = width + 1;
        Self {
            stride,
            top: rows.start,
            bottom: rows.end,
            differences: vec![0.0; stride * rows.len()],
            touched: vec![0; stride.div_ceil(64) * rows.len()],
        }
    }

    /// Calls `each` with columns next to each other that are covered alike, from left to right through all of row `row`,
    /// counted from the first of these rows.
    pub(super) fn for_each_run(&self, row: usize, mut each: impl FnMut(Range<usize>, f32)) {
        let width = self.stride - 1;
        let differences = &self.differences[row * self.stride..][..width];
        let words = self.stride.div_ceil(64);
        let (mut start, mut sum) = (0, 0.0f32);
        for (word, bits) in self.touched[row * words..][..words].iter().enumerate() {
            let mut bits = *bits;
            while bits != 0 {
                let column = word * 64 + bits.trailing_zeros() as usize;
                bits &= bits - 1;
                if column >= width {
                    break;
                }
                if column > start {
                    each(start..column, sum.abs().min(1.0));
                }
                start = column;
                sum += differences[column];
            }
        }
        if start < width {
            each(start..width, sum.abs().min(1.0));
        }
    }

    /// Adds the part of an edge of a polygon that lies in these rows.
    pub(super) fn add_edge(&mut self, a: Point, b: Point) {
        if a.y == b.y {
            return;
        }
        // Positive polygons (x to y) run upwards, to lower y, on their left side.
        let (top, bottom, sign) = if a.y > b.y { (b, a, 1.0) } else { (a, b, -1.0) };
        let slope = (bottom.x - top.x) / (bottom.y - top.y);
        let first = top.y.max(self.top as f64);
        let last = bottom.y.min(self.bottom as f64);
        if first >= last {
            return;
        }
        let x_at = |y: f64| top.x + (y - top.y) * slope;
        let mut row = first as usize;
        let mut y = first;
        while y < last {
            let next = ((row + 1) as f64).min(last);
            self.add_piece(row - self.top, sign * (next - y), x_at(y), x_at(next));
            y = next;
            row += 1;
        }
    }

    /// Adds a piece of an edge within one row: its signed height and where it starts and ends.
    fn add_piece(&mut self, row: usize, height: f64, from: f64, to: f64) {
        let width = (self.stride - 1) as f64;
        let (left, right) = (from.min(to), from.max(to));
        if left >= width {
            return;
        }
        self.touch(
            row,
            left.max(0.0) as usize,
            (right.max(0.0).ceil() as usize).min(self.stride - 1),
        );
        let row = &mut self.differences[row * self.stride..(row + 1) * self.stride];
        if right <= 0.0 {
            row[0] += height as f32;
            return;
        }
        if left < 0.0 || right > width {
            // Rare: split at the border, so that what follows needs no bounds.
            let span = right - left;
            let outside_left = (-left).max(0.0) / span;
            let outside_right = (right - width).max(0.0) / span;
            row[0] += (height * outside_left) as f32;
            let inside = height * (1.0 - outside_left - outside_right);
            Self::add_inside(row, inside, left.max(0.0), right.min(width));
            return;
        }
        Self::add_inside(row, height, left, right);
    }

    /// Notes that columns `first` to `last` and the one after `first` may differ from the one before them.
    fn touch(&mut self, row: usize, first: usize, last: usize) {
        let words = self.stride.div_ceil(64);
        for column in first..=last.max(first + 1).min(self.stride - 1) {
            self.touched[row * words + column / 64] |= 1 << (column % 64);
        }
    }

    fn add_inside(row: &mut [f32], height: f64, left: f64, right: f64) {
        let first = left as usize;
        let last = (right.ceil() as usize).max(first + 1);
        if last == first + 1 {
            // Within one pixel: the area to the right of the piece's middle.
            let covered = height * (1.0 - (0.5 * (left + right) - first as f64));
            row[first] += covered as f32;
            if first + 1 < row.len() {
                row[first + 1] += (height - covered) as f32;
            }
            return;
        }
        // Across several pixels: a trapezoid in the first and last, constant growth between.
        let growth = height / (right - left);
        let mut before = 0.0;
        for (pixel, difference) in row.iter_mut().enumerate().take(last).skip(first) {
            // The integral of the height accumulated up to x, over this pixel.
            let (from, to) = (left.max(pixel as f64), right.min((pixel + 1) as f64));
            let (low, high) = (growth * (from - left), growth * (to - left));
            let area = 0.5 * (low + high) * (to - from) + high * ((pixel + 1) as f64 - to);
            *difference += (area - before) as f32;
            before = area;
        }
        if last < row.len() {
            row[last] += (height - before) as f32;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn polygon(points: &[[f64; 2]]) -> Vec<Point> {
        points.iter().copied().map(Point::from).collect()
    }

    #[test]
    fn a_square_between_pixels_covers_quarters() {
        let square = polygon(&[[0.5, 0.5], [2.5, 0.5], [2.5, 2.5], [0.5, 2.5]]);
        let coverage = Coverage::of([square.as_slice()], 4, 3);
        assert_eq!(
            coverage.areas(),
            [0.25, 0.5, 0.25, 0.0, 0.5, 1.0, 0.5, 0.0, 0.25, 0.5, 0.25, 0.0]
        );
    }

    #[test]
    fn a_hole_is_clear_and_an_overlap_is_full() {
        let outer = polygon(&[[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0]]);
        let hole = polygon(&[[1.0, 1.0], [1.0, 2.0], [2.0, 2.0], [2.0, 1.0]]);
        assert_eq!(Coverage::of([outer.as_slice(), hole.as_slice()], 3, 3).areas()[4], 0.0);
        assert_eq!(Coverage::of([outer.as_slice(), outer.as_slice()], 3, 3).areas()[4], 1.0);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]
        #[test]
        fn areas_sum_to_the_triangles_area_inside_the_grid(p in prop::array::uniform6(0.0..12.0f64)) {
            let triangle = polygon(&[[p[0], p[1]], [p[2], p[3]], [p[4], p[5]]]);
            let area = 0.5 * crate::math::point::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]).abs();
            let sum: f32 = Coverage::of([triangle.as_slice()], 12, 12).areas().iter().sum();
            prop_assert!((f64::from(sum) - area).abs() < 1e-4, "{sum} for {area}");
        }

        #[test]
        fn the_border_changes_nothing_inside(p in prop::array::uniform6(-9.0..15.0f64)) {
            let triangle = polygon(&[[p[0], p[1]], [p[2], p[3]], [p[4], p[5]]]);
            let moved: Vec<Point> = triangle.iter().map(|q| q + Point::new(10.0, 10.0)).collect();
            let (small, large) = (Coverage::of([triangle.as_slice()], 6, 6), Coverage::of([moved.as_slice()], 30, 30));
            for y in 0..6 {
                for x in 0..6 {
                    let difference = small.areas()[y * 6 + x] - large.areas()[(y + 10) * 30 + x + 10];
                    prop_assert!(difference.abs() < 1e-4);
                }
            }
        }
    }
}
