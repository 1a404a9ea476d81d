//! Whether a picture is a sheet of figures: cells of one size in columns and rows, a figure in each.
//!
//! Bytes of an image file -> columns and rows, or nothing. A sheet is only seen where there is no doubt: a drawing of one figure with
//! loose parts must never be cut up, while a sheet that is not seen costs the artist one option.
//!
//! 1. What is drawn is found as in any drawing, and divided into connected parts; dust is left aside.
//! 2. For every division of the picture into at least [`LEAST_CELLS`] equal cells: each part lies in one cell; no cell is empty but the last ones; each has
//!    one part that is most of it, and these are about equally large, fill the cells, and lie in their middles. The coarsest such division is the answer.
//!
//! Cost O(#pixels), then O(#divisions x #parts).

use super::InputError;
use super::bitmap::BitmapOptions;
use super::coverage::Coverage;
use super::decode::decode;
use super::found::find;
use super::iso_line::{Part, Parts};

/// Fewer figures may be a pair of eyes, or the dots of one drawing.
const LEAST_CELLS: usize = 4;
/// The most columns, and the most rows.
const MOST_A_SIDE: usize = 24;
/// The share of the largest part's area below which a part is dust, or a spark of some figure.
const DUST: f64 = 0.01;
/// The least share of what is drawn in a cell that its largest part has.
const LEAST_OF_CELL: f64 = 0.6;
/// How many times as large as the smallest figure the largest may be, in area; poses of one figure differ by less.
const AREA_RATIO: f64 = 2.0;
/// How much of a cell's width or height a figure takes at least.
const LEAST_FILL: f64 = 0.4;
/// How far the middle of a figure is from the middle of its cell at most, as a share of the cell.
const OFF_MIDDLE: f64 = 0.3;

/// How many columns and rows of cells the bytes of an image file show, each with a figure of its own; `None` for any other drawing.
///
/// # Errors
/// [`InputError`] if the bytes are no image, the image is too large, or nothing is drawn in it.
pub fn find_cells(bytes: &[u8]) -> Result<Option<[usize; 2]>, InputError> {
    let decoded = decode(bytes)?;
    let options = BitmapOptions::default();
    let found = find(&decoded.image, decoded.fidelity, &options)?;
    let threshold = options.threshold as f32;
    let coverage = Coverage::framed(found.coverage, decoded.image.width() as usize, threshold);
    let parts = Parts::of(&coverage, threshold);
    Ok(grid_of(&parts.parts, parts.size()))
}

/// The division of a picture of `size` whose cells have a figure each.
fn grid_of(parts: &[Part], size: [usize; 2]) -> Option<[usize; 2]> {
    let largest = parts.iter().map(|part| part.area).fold(0.0, f64::max);
    let parts: Vec<Part> = parts
        .iter()
        .copied()
        .filter(|part| part.area >= DUST * largest)
        .collect();
    let sides = |most: usize| 1..=most.min(MOST_A_SIDE);
    let mut grids: Vec<[usize; 2]> = sides(size[0])
        .flat_map(|columns| sides(size[1]).map(move |rows| [columns, rows]))
        .filter(|[columns, rows]| columns * rows >= LEAST_CELLS && (columns - 1) * rows <= parts.len())
        .collect();
    grids.sort_by_key(|[columns, rows]| (columns * rows, *rows));
    grids.into_iter().find(|grid| is_sheet(&parts, size, *grid))
}

fn is_sheet(parts: &[Part], size: [usize; 2], grid: [usize; 2]) -> bool {
    let cell: [f64; 2] = [0, 1].map(|axis| size[axis] as f64 / grid[axis] as f64);
    let mut cells: Vec<Vec<Part>> = vec![Vec::new(); grid[0] * grid[1]];
    for part in parts {
        let within = [0, 1].map(|axis| {
            let [low, high] = [part.bounds[0][axis], part.bounds[1][axis]].map(|edge| edge * grid[axis] / size[axis]);
            (low == high).then_some(low)
        });
        let [Some(column), Some(row)] = within else {
            return false;
        };
        cells[row * grid[0] + column].push(*part);
    }
    let used = cells
        .iter()
        .rposition(|cell| !cell.is_empty())
        .map_or(0, |last| last + 1);
    // Only the end of the last row may be empty.
    if used < LEAST_CELLS || used + grid[0] <= cells.len() {
        return false;
    }
    let mut areas: Vec<f64> = Vec::new();
    for (index, inside) in cells.iter().take(used).enumerate() {
        let Some(figure) = inside.iter().max_by(|a, b| a.area.total_cmp(&b.area)) else {
            return false;
        };
        let all: f64 = inside.iter().map(|part| part.area).sum();
        let place = [index % grid[0], index / grid[0]];
        let extents = [0, 1].map(|axis| (figure.bounds[1][axis] + 1 - figure.bounds[0][axis]) as f64 / cell[axis]);
        let is_in_middle = [0, 1].iter().all(|&axis| {
            let middle = 0.5 * (figure.bounds[0][axis] + figure.bounds[1][axis] + 1) as f64 / cell[axis];
            (middle - place[axis] as f64 - 0.5).abs() <= OFF_MIDDLE
        });
        if figure.area < LEAST_OF_CELL * all || !is_in_middle || extents[0].max(extents[1]) < LEAST_FILL {
            return false;
        }
        areas.push(figure.area);
    }
    let (least, most) = areas.iter().fold((f64::INFINITY, 0.0_f64), |(least, most), area| {
        (least.min(*area), most.max(*area))
    });
    most <= AREA_RATIO * least
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Point;

    /// A part that covers a box: left, top, width, height.
    fn part([left, top, width, height]: [usize; 4]) -> Part {
        Part {
            label: 0,
            area: (width * height) as f64,
            centroid: Point::zeros(),
            bounds: [[left, top], [left + width - 1, top + height - 1]],
        }
    }

    /// A figure in each of some cells of 50 x 60, the first ones; poses lean and crouch.
    fn figures(columns: usize, count: usize) -> Vec<Part> {
        let figure = |k: usize| {
            let (column, row) = (k % columns, k / columns);
            part([
                50 * column + 8 + 2 * (k % 4),
                60 * row + 6 + 5 * (k % 2),
                30,
                48 - 6 * (k % 2),
            ])
        };
        (0..count).map(figure).collect()
    }

    #[test]
    fn a_figure_a_cell_is_a_sheet() {
        assert_eq!(grid_of(&figures(4, 8), [200, 120]), Some([4, 2]));
        assert_eq!(grid_of(&figures(6, 6), [300, 60]), Some([6, 1]));
        // The last row is not full, and a figure has a spark.
        let mut unfull = figures(3, 8);
        unfull.push(part([41, 10, 6, 6]));
        assert_eq!(grid_of(&unfull, [150, 180]), Some([3, 3]));
    }

    #[test]
    fn one_figure_with_loose_parts_is_none() {
        let body = part([60, 50, 80, 140]);
        // Hat, sparks, a drop.
        let parts = [
            body,
            part([70, 10, 60, 30]),
            part([150, 20, 12, 12]),
            part([170, 30, 10, 10]),
        ];
        assert_eq!(grid_of(&parts, [200, 200]), None);
        // Two figures, three dots, scattered leaves, a figure that reaches into the next cell.
        assert_eq!(grid_of(&figures(2, 2), [100, 60]), None);
        assert_eq!(
            grid_of(
                &[part([10, 10, 20, 20]), part([40, 10, 20, 20]), part([70, 10, 20, 20])],
                [100, 40]
            ),
            None
        );
        let leaves = [[5, 5], [60, 30], [20, 70], [80, 85], [45, 50]].map(|[x, y]| part([x, y, 12, 10]));
        assert_eq!(grid_of(&leaves, [100, 100]), None);
        let mut wide = figures(4, 4);
        wide.push(part([40, 20, 20, 30]));
        assert_eq!(grid_of(&wide, [200, 60]), None);
        assert_eq!(grid_of(&[], [100, 100]), None);
    }
}
