//! The iso-line of a coverage field by marching squares, one connected part at a time.
//!
//! 1. A cell has the centres of four pixels as its corners. Where two inside corners face each other across two outside
//!    ones, the asymptotes of the bilinear interpolant decide whether they join (Nielson and Hamann 1991, "The
//!    asymptotic decider"). The two chords in such a cell then lie on opposite sides of the asymptotes and cannot cross.
//! 2. Inside pixels are united into parts by the same decisions, so that a part's iso-line bounds exactly that part.
//! 3. A loop is walked from every step from outside to inside along a row, with the inside on the positive side: outer
//!    loops come out with positive area, holes with negative.
//!
//! Cost O(#pixels).

use super::coverage::Coverage;
use super::loose::Piece;
use crate::math::Point;

/// The corners of a cell in positive order, relative to its first one.
const CORNERS: [(usize, usize); 4] = [(0, 0), (1, 0), (1, 1), (0, 1)];

/// A connected part of the drawing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Part {
    /// What its pixels are marked with.
    pub(super) label: u32,
    /// Sum of its coverages, in pixels.
    pub(super) area: f64,
    /// Its centroid, in image coordinates.
    pub(super) centroid: Point,
    /// Its first and last column and row, in image coordinates: `[[left, top], [right, bottom]]`.
    pub(super) bounds: [[usize; 2]; 2],
}

impl Part {
    pub(super) fn piece(&self) -> Piece {
        Piece {
            area: self.area,
            centroid: self.centroid,
        }
    }
}

/// How far from a part a place that names it may be, as a fraction of the picture's diagonal: a click beside a speck.
const CLICK: f64 = 0.02;

/// The parts of a field and the field's threshold.
#[derive(Debug)]
pub(super) struct Parts<'a> {
    coverage: &'a Coverage,
    threshold: f32,
    /// The part each pixel belongs to; 0 outside.
    labels: Vec<u32>,
    /// All parts, in the order of their first pixel.
    pub(super) parts: Vec<Part>,
}

impl<'a> Parts<'a> {
    /// Unites the inside pixels of `coverage` into parts.
    pub(super) fn of(coverage: &'a Coverage, threshold: f32) -> Self {
        let mut labels = vec![0; coverage.values.len()];
        let mut field = Self {
            coverage,
            threshold,
            labels: Vec::new(),
            parts: Vec::new(),
        };
        let mut open = Vec::new();
        for seed in 0..labels.len() {
            if labels[seed] != 0 || !field.inside(seed) {
                continue;
            }
            let label = field.parts.len() as u32 + 1;
            let (mut area, mut moment) = (0.0, Point::zeros());
            let mut bounds = [[usize::MAX; 2], [0; 2]];
            labels[seed] = label;
            open.push(seed);
            while let Some(pixel) = open.pop() {
                let value = f64::from(coverage.values[pixel]).min(1.0);
                area += value;
                moment += field.centre(pixel) * value;
                // Inside pixels never lie in the frame.
                let place = [pixel % coverage.width - 1, pixel / coverage.width - 1];
                for axis in 0..2 {
                    bounds[0][axis] = bounds[0][axis].min(place[axis]);
                    bounds[1][axis] = bounds[1][axis].max(place[axis]);
                }
                field.for_each_joined(pixel, |other| {
                    if labels[other] == 0 {
                        labels[other] = label;
                        open.push(other);
                    }
                });
            }
            field.parts.push(Part {
                label,
                area,
                centroid: moment / area,
                bounds,
            });
        }
        field.labels = labels;
        field
    }

    /// The part that a place in image coordinates means: that of its pixel, or the nearest not far away.
    pub(super) fn at(&self, place: Point) -> Option<usize> {
        let (width, height) = (self.coverage.width, self.coverage.height);
        let reach = (CLICK * (width as f64).hypot(height as f64)).max(2.0);
        // Casts saturate.
        let range = |middle: f64, end: usize| {
            let first = (middle - reach).max(0.0) as usize;
            first..((middle + reach + 2.0).max(0.0) as usize).min(end)
        };
        let pixels =
            range(place.y, height).flat_map(|row| range(place.x, width).map(move |column| row * width + column));
        let distances = pixels
            .filter(|pixel| self.labels[*pixel] != 0)
            .map(|pixel| (pixel, (self.centre(pixel) - place).norm()));
        let nearest = distances.min_by(|a, b| a.1.total_cmp(&b.1));
        nearest
            .filter(|(_, distance)| *distance <= reach)
            .map(|(pixel, _)| self.labels[pixel] as usize - 1)
    }

    /// How many columns and rows the picture has.
    pub(super) fn size(&self) -> [usize; 2] {
        [self.coverage.width - 2, self.coverage.height - 2]
    }

    /// The part that covers a pixel of the picture, if any does.
    pub(super) fn covering(&self, column: usize, row: usize) -> Option<usize> {
        let label = self.labels[(row + 1) * self.coverage.width + column + 1];
        (label as usize).checked_sub(1)
    }

    /// The closed loops around a part: one of positive area, and one of negative area for each hole.
    pub(super) fn loops(&self, part: Part) -> Vec<Vec<Point>> {
        let label = part.label;
        let [[left, top], [right, bottom]] = part.bounds;
        let (columns, width) = (right - left + 1, self.coverage.width);
        // Of the pixels in its box, row by row.
        let mut visited = vec![false; columns * (bottom - top + 1)];
        let place = |pixel: usize| (pixel / width - 1 - top) * columns + pixel % width - 1 - left;
        let mut loops = Vec::new();
        let rows = (top + 1)..(bottom + 2);
        for pixel in rows.flat_map(|row| (row * width + left + 1)..(row * width + right + 2)) {
            if self.labels[pixel] == label && !self.inside(pixel - 1) && !visited[place(pixel)] {
                // With the inside to its right on the page, the line runs up: out of the cell by the top side.
                let start = (pixel - 1, 0);
                let mut points = Vec::new();
                let mut at = start;
                loop {
                    let (cell, side) = at;
                    if side == 0 {
                        visited[place(cell + 1)] = true;
                    }
                    points.push(self.crossing(cell, side));
                    at = self.next(cell, side);
                    if at == start {
                        break;
                    }
                }
                loops.push(points);
            }
        }
        loops
    }

    fn inside(&self, pixel: usize) -> bool {
        self.coverage.values[pixel] >= self.threshold
    }

    /// The centre of a pixel of the framed field, in image coordinates.
    fn centre(&self, pixel: usize) -> Point {
        let (column, row) = (pixel % self.coverage.width, pixel / self.coverage.width);
        Point::new(column as f64 - 0.5, row as f64 - 0.5)
    }

    fn corner(&self, cell: usize, corner: usize) -> usize {
        let (x, y) = CORNERS[corner % 4];
        cell + y * self.coverage.width + x
    }

    /// Calls `found` for every inside pixel joined to an inside `pixel`. Inside pixels never lie in the frame.
    fn for_each_joined(&self, pixel: usize, mut found: impl FnMut(usize)) {
        let width = self.coverage.width;
        for other in [pixel - 1, pixel + 1, pixel - width, pixel + width] {
            if self.inside(other) {
                found(other);
            }
        }
        // Each of the four cells around the pixel, and the pixel opposite to it there.
        for (cell, opposite) in [
            (pixel, pixel + width + 1),
            (pixel - 1, pixel + width - 1),
            (pixel - width, pixel - width + 1),
            (pixel - width - 1, pixel - width - 1),
        ] {
            if self.inside(opposite) && self.saddle_joins(cell) {
                found(opposite);
            }
        }
    }

    /// Whether the inside corners of a cell in which they face each other are joined.
    fn saddle_joins(&self, cell: usize) -> bool {
        let value = |corner| f64::from(self.coverage.values[self.corner(cell, corner)]) - f64::from(self.threshold);
        // The bilinear interpolant at its saddle has the sign of this determinant over that of the alternating sum.
        let determinant = value(0) * value(2) - value(1) * value(3);
        determinant * (value(0) + value(2) - value(1) - value(3)) >= 0.0
    }

    /// Where the iso-line crosses a side of a cell.
    fn crossing(&self, cell: usize, side: usize) -> Point {
        // From the smaller index, so that both cells of the side find the same point.
        let (a, b) = (self.corner(cell, side), self.corner(cell, side + 1));
        let (a, b) = (a.min(b), a.max(b));
        let (low, high) = (f64::from(self.coverage.values[a]), f64::from(self.coverage.values[b]));
        let along = (f64::from(self.threshold) - low) / (high - low);
        self.centre(a) + (self.centre(b) - self.centre(a)) * along
    }

    /// Leaves a cell by `side` into its neighbour, and returns the neighbour with the side by which the line leaves it.
    fn next(&self, cell: usize, side: usize) -> (usize, usize) {
        let width = self.coverage.width;
        let cell = match side {
            0 => cell - width,
            1 => cell + 1,
            2 => cell + width,
            _ => cell - 1,
        };
        // The line enters by `entry`, with its first corner inside and its second outside.
        let entry = (side + 2) % 4;
        let facing = self.inside(self.corner(cell, entry + 2));
        let beside = self.inside(self.corner(cell, entry + 3));
        let exit = match (facing, beside) {
            (true, false) if !self.saddle_joins(cell) => entry + 3,
            (true, _) => entry + 1,
            (false, true) => entry + 2,
            (false, false) => entry + 3,
        };
        (cell, exit % 4)
    }
}
