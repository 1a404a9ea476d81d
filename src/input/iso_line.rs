//! The iso-line of a coverage field by marching squares, one connected part at a time.
//!
//! 1. A cell has the centres of four pixels as its corners. Where two inside corners face each other across two outside
//!    ones, the asymptotes of the bilinear interpolant decide whether they join (Nielson and Hamann 1991, "The
//!    asymptotic decider"). The two chords in such a cell then lie on opposite sides of the asymptotes and cannot cross.
//! 2. Runs of inside pixels (module `runs`) are united into parts by the same decisions, so that a part's iso-line bounds exactly that part.
//! 3. A loop is walked from the left end of every run, with the inside on the positive side: outer
//!    loops come out with positive area, holes with negative.
//!
//! Cost O(#pixels).

use rayon::prelude::*;

use super::coverage::Coverage;
use super::loose::Piece;
use super::runs::Runs;
use crate::math::Point;

/// The corners of a cell in positive order, relative to its first one.
const CORNERS: [(usize, usize); 4] = [(0, 0), (1, 0), (1, 1), (0, 1)];

/// A connected part of the drawing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Part {
    /// Its index among the parts.
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
    /// The inside pixels.
    runs: Runs,
    /// The part that each run belongs to.
    part_of: Vec<u32>,
    /// All parts, in the order of their first pixel.
    pub(super) parts: Vec<Part>,
}

impl<'a> Parts<'a> {
    /// Unites the inside pixels of `coverage` into parts.
    pub(super) fn of(coverage: &'a Coverage, threshold: f32) -> Self {
        let width = coverage.width;
        let runs = Runs::of(&coverage.values, width, |value| *value >= threshold);
        let components = runs.components(|row, column| saddle_joins(coverage, threshold, row * width + column));
        let measured: Vec<(f64, Point)> = runs
            .all()
            .par_iter()
            .with_min_len(64)
            .map(|run| {
                let (mut area, mut moment) = (0.0, 0.0);
                for (column, value) in run.columns().zip(&coverage.values[run.pixels(width)]) {
                    let value = f64::from(*value).min(1.0);
                    area += value;
                    moment += column as f64 * value;
                }
                // The frame takes the first row and column, and a centre is half a pixel off its pixel's corner.
                (area, Point::new(moment - 0.5 * area, (run.row() as f64 - 0.5) * area))
            })
            .collect();
        let nothing = |label: usize| Part {
            label: label as u32,
            area: 0.0,
            centroid: Point::zeros(),
            bounds: [[usize::MAX; 2], [0; 2]],
        };
        let mut parts: Vec<Part> = (0..components.count).map(nothing).collect();
        for ((run, label), (area, moment)) in runs.all().iter().zip(&components.label_of).zip(measured) {
            let part = &mut parts[*label as usize];
            part.area += area;
            part.centroid += moment;
            // Inside pixels never lie in the frame.
            let (first, last) = (run.columns().start - 1, run.columns().end - 2);
            let [low, high] = &mut part.bounds;
            *low = [low[0].min(first), low[1].min(run.row() - 1)];
            *high = [high[0].max(last), high[1].max(run.row() - 1)];
        }
        for part in &mut parts {
            part.centroid /= part.area;
        }
        Self {
            coverage,
            threshold,
            runs,
            part_of: components.label_of,
            parts,
        }
    }

    /// The part that a place in image coordinates means: that of its pixel, or the nearest not far away.
    pub(super) fn at(&self, place: Point) -> Option<usize> {
        let (width, height) = (self.coverage.width, self.coverage.height);
        let reach = (CLICK * (width as f64).hypot(height as f64)).max(2.0);
        // Casts saturate.
        let first_row = (place.y - reach).max(0.0) as usize;
        let rows = first_row..((place.y + reach + 2.0).max(0.0) as usize).min(height);
        let column = (place.x + 0.5).round().max(0.0) as usize;
        let distances = rows.flat_map(|row| self.runs.in_row(row)).map(|run| {
            let pixels = self.runs.all()[run];
            let nearest = column.clamp(pixels.columns().start, pixels.columns().end - 1);
            (run, (self.centre(pixels.row() * width + nearest) - place).norm())
        });
        let nearest = distances.min_by(|a, b| a.1.total_cmp(&b.1));
        nearest
            .filter(|(_, distance)| *distance <= reach)
            .map(|(run, _)| self.part_of[run] as usize)
    }

    /// How many columns and rows the picture has.
    pub(super) fn size(&self) -> [usize; 2] {
        [self.coverage.width - 2, self.coverage.height - 2]
    }

    /// The part that covers a pixel of the picture, if any does.
    pub(super) fn covering(&self, column: usize, row: usize) -> Option<usize> {
        let run = self.runs.at(column + 1, row + 1)?;
        Some(self.part_of[run] as usize)
    }

    /// The closed loops around a part: one of positive area, and one of negative area for each hole.
    pub(super) fn loops(&self, part: Part) -> Vec<Vec<Point>> {
        let [[_, top], [_, bottom]] = part.bounds;
        let width = self.coverage.width;
        let first = self.runs.in_row(top + 1).start;
        let own = first..self.runs.in_row(bottom + 1).end;
        // Whether the line has passed a run's left end.
        let mut visited = vec![false; own.len()];
        let mut loops = Vec::new();
        for run in own {
            if self.part_of[run] != part.label || visited[run - first] {
                continue;
            }
            // With the inside to its right on the page, the line runs up: out of the cell by the top side.
            let start = (self.runs.all()[run].pixels(width).start - 1, 0);
            let mut points = Vec::new();
            let mut at = start;
            loop {
                let (cell, side) = at;
                if side == 0
                    && let Some(passed) = self.runs.at((cell + 1) % width, cell / width)
                {
                    visited[passed - first] = true;
                }
                points.push(self.crossing(cell, side));
                at = self.next(cell, side);
                if at == start {
                    break;
                }
            }
            loops.push(points);
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
        corner_of(cell, corner, self.coverage.width)
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
            (true, false) if !saddle_joins(self.coverage, self.threshold, cell) => entry + 3,
            (true, _) => entry + 1,
            (false, true) => entry + 2,
            (false, false) => entry + 3,
        };
        (cell, exit % 4)
    }
}

fn corner_of(cell: usize, corner: usize, width: usize) -> usize {
    let (x, y) = CORNERS[corner % 4];
    cell + y * width + x
}

/// Whether the inside corners of a cell in which they face each other are joined.
fn saddle_joins(coverage: &Coverage, threshold: f32, cell: usize) -> bool {
    let value = |corner| f64::from(coverage.values[corner_of(cell, corner, coverage.width)]) - f64::from(threshold);
    // The bilinear interpolant at its saddle has the sign of this determinant over that of the alternating sum.
    let determinant = value(0) * value(2) - value(1) * value(3);
    determinant * (value(0) + value(2) - value(1) - value(3)) >= 0.0
}
