//! Where everything stands on the sheet.

use super::canvas::Fit;
use super::labels::Area;
use super::{BORDER_PX, LEGEND_PX, SPACE_PX, TEXT_PX};
use crate::math::Point;
use crate::pose::Mapping;

/// Poses in one row, unless there are very many.
const COLUMNS: usize = 5;
/// Least and largest side of a pose's square, in pixels.
const CELL_PX: (f64, f64) = (370.0, 560.0);
/// The pixels of all squares of one panel together: poses are drawn smaller beyond.
const PANEL_PX: f64 = 2e7;
/// The space above a cell for the pose's name, and below it for a line of words, in pixels.
const HEAD_PX: f64 = 24.0;
const FOOT_PX: f64 = 30.0;
/// The space between two panels, in pixels.
const PANEL_GAP_PX: f64 = 14.0;
/// The height of a panel's heading, in pixels.
pub(super) const HEADING_PX: f64 = 2.2 * TEXT_PX;

/// The place of one pose in a panel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cell {
    /// Everything that belongs to the pose.
    pub(super) area: Area,
    /// Where its points go.
    pub(super) fit: Fit,
}

impl Cell {
    /// The upper left corner of the pose's name.
    pub(super) fn head(&self) -> [f64; 2] {
        [self.area.low.x + 6.0, self.area.low.y]
    }

    /// The middle of the line below the pose.
    pub(super) fn foot(&self) -> Point {
        Point::new(
            0.5 * (self.area.low.x + self.area.high.x),
            self.area.high.y - 0.5 * FOOT_PX,
        )
    }
}

/// The places of all parts.
#[derive(Debug)]
pub(super) struct Layout {
    pub(super) size: [u32; 2],
    pub(super) columns: usize,
    /// The upper left corners of the headings: outlines, meshes, pose space.
    pub(super) headings: [[f64; 2]; 3],
    pub(super) outlines: Vec<Cell>,
    pub(super) meshes: Vec<Cell>,
    /// The upper left corners of the pose space and of the legend.
    pub(super) space: [f64; 2],
    pub(super) legend: [f64; 2],
}

impl Layout {
    /// The layout for a mapping, with a legend of some height.
    pub(super) fn new(mapping: &Mapping, legend_height: f64) -> Self {
        let count = mapping.poses.len().max(1);
        let rows = if count <= COLUMNS * COLUMNS {
            count.div_ceil(COLUMNS)
        } else {
            (count as f64).sqrt() as usize
        };
        let columns = count.div_ceil(rows);
        let below = SPACE_PX + LEGEND_PX + 2.0 * BORDER_PX;
        let side = (below / columns as f64)
            .clamp(CELL_PX.0, CELL_PX.1)
            .min((PANEL_PX / count as f64).sqrt());
        let row_height = HEAD_PX + side + FOOT_PX;
        let panel_height = HEADING_PX + rows as f64 * row_height + PANEL_GAP_PX;
        let cells = |top: f64| -> Vec<Cell> {
            (mapping.poses.positions().iter().enumerate())
                .map(|(pose, positions)| {
                    let low = Point::new(
                        BORDER_PX + (pose % columns) as f64 * side,
                        top + HEADING_PX + (pose / columns) as f64 * row_height,
                    );
                    Cell {
                        area: Area {
                            low,
                            high: low + Point::new(side, row_height),
                        },
                        fit: Fit::new(positions, [low.x, low.y + HEAD_PX], side),
                    }
                })
                .collect()
        };
        let tops = [0.0, 1.0, 2.0].map(|k| BORDER_PX + k * panel_height);
        let space_top = tops[2] + HEADING_PX;
        let width = below.max(columns as f64 * side) + 2.0 * BORDER_PX;
        let height = space_top + SPACE_PX.max(legend_height) + BORDER_PX;
        Self {
            size: [width.ceil() as u32, height.ceil() as u32],
            columns,
            headings: tops.map(|top| [BORDER_PX, top]),
            outlines: cells(tops[0]),
            meshes: cells(tops[1]),
            space: [BORDER_PX, space_top],
            legend: [3.0 * BORDER_PX + SPACE_PX, space_top],
        }
    }
}
