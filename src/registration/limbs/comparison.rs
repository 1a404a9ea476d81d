//! A pose beside what the reference's parts show of it where they are put.
//!
//! Places of the vertices -> by part, a picture of how much the reference differs from the pose wherever it covers it; and one number.
//!
//! A pose whose parts lie over one another is explained by whatever fits best at every place: what lies behind is not seen and costs nothing. What no
//! part covers costs the most, and what covers paper half of that.

use crate::appearance::{ByteImage, STEPS_PER_UNIT};
use crate::math::{Point, for_each_cell};
use crate::registration::lattice::Lattice;
use crate::registration::template::MOST_DIFFERENCE;

/// The side of a cell of the pictures, in working pixels: less than what they are blurred by.
pub(super) const CELL_PX: usize = 2;
/// A cell that a part does not cover.
pub(super) const BARE: u8 = u8::MAX;
/// The largest difference, in steps.
pub(super) const MOST: u8 = (MOST_DIFFERENCE * STEPS_PER_UNIT) as u8;
/// The blurred coverage from which a place of the reference is one of the figure, in steps.
const INSIDE: u8 = 50;
/// What covers paper costs this share of what differs most.
const OUTSIDE_SHARE: f64 = 0.5;

/// How much a part differs, in steps, by cell; [`BARE`] where it is not.
pub(super) type Layer = Vec<u8>;

/// Two drawings to be compared.
pub(super) struct Comparison<'a> {
    pub(super) lattice: &'a Lattice,
    reference: &'a ByteImage,
    pub(super) pose: &'a ByteImage,
    /// Cells across and down.
    pub(super) size: [usize; 2],
    /// By cell, whether its middle is in the pose's figure.
    pub(super) figure: Vec<bool>,
    /// How many these are, at least 1.
    pub(super) figure_cells: usize,
    /// How many the reference's figure has, at least 1.
    reference_cells: usize,
    /// By part, the triangles whose last corner, from the root on, it has.
    triangles: Vec<Vec<[usize; 3]>>,
}

impl<'a> Comparison<'a> {
    /// `part_of` has the part of every vertex, numbered from the root on, of `parts`. Both images are blurred alike.
    pub(super) fn new(
        lattice: &'a Lattice,
        (part_of, parts): (&[usize], usize),
        reference: &'a ByteImage,
        pose: &'a ByteImage,
    ) -> Self {
        let size = pose.size().map(|length| length.div_ceil(CELL_PX));
        let figure = figure_of(pose);
        let count = |figure: &[bool]| figure.iter().filter(|inside| **inside).count().max(1);
        let mut triangles = vec![Vec::new(); parts];
        for triangle in &lattice.triangles {
            let part = triangle.iter().map(|v| part_of[*v]).max().unwrap_or(0);
            triangles[part].push(*triangle);
        }
        Self {
            lattice,
            reference,
            pose,
            size,
            figure_cells: count(&figure),
            reference_cells: count(&figure_of(reference)),
            figure,
            triangles,
        }
    }

    /// How much larger the reference's figure has to be at least to have the pose's area: what is hidden there has none.
    pub(super) fn least_scale(&self) -> f64 {
        (self.figure_cells as f64 / self.reference_cells as f64).sqrt()
    }

    /// The cell that a place is in, or the nearest one.
    pub(super) fn cell_at(&self, p: Point) -> usize {
        // Casts saturate.
        let along = |value: f64, count: usize| ((value / CELL_PX as f64) as usize).min(count - 1);
        along(p.y, self.size[1]) * self.size[0] + along(p.x, self.size[0])
    }

    /// What a part shows where the vertices are at `places`.
    pub(super) fn layer(&self, part: usize, places: &[Point]) -> Layer {
        let mut layer = vec![BARE; self.figure.len()];
        for triangle in &self.triangles[part] {
            let source = triangle.map(|v| self.lattice.points[v]);
            let corners = triangle.map(|v| places[v] / CELL_PX as f64);
            for_each_cell(corners, self.size, |cell, [u, v]| {
                let from = source[0] + (source[1] - source[0]) * u + (source[2] - source[0]) * v;
                let shown = self.reference.pixel(from);
                if shown.coverage() >= INSIDE {
                    let differs = shown.difference(self.pose.pixel(middle(cell, self.size[0])));
                    layer[cell] = layer[cell].min(differs.min(u32::from(MOST)) as u8);
                }
            });
        }
        layer
    }

    /// What all parts show.
    pub(super) fn layers(&self, places: &[Point]) -> Vec<Layer> {
        (0..self.triangles.len()).map(|part| self.layer(part, places)).collect()
    }

    /// The least difference at every cell over the parts that `counts` says.
    pub(super) fn least(&self, layers: &[Layer], counts: impl Fn(usize) -> bool) -> Layer {
        let mut least = vec![BARE; self.figure.len()];
        for (_, layer) in layers.iter().enumerate().filter(|(part, _)| counts(*part)) {
            for (least, own) in least.iter_mut().zip(layer) {
                *least = (*least).min(*own);
            }
        }
        least
    }

    /// How badly the layers explain the pose: the mean over its figure, 0 for a drawing like the reference, at most 1.2 where nothing lies on the paper.
    pub(super) fn energy(&self, layers: &[Layer]) -> f64 {
        let least = self.least(layers, |_| true);
        let (mut inside, mut outside) = (0u64, 0u64);
        for (differs, in_figure) in least.iter().zip(&self.figure) {
            if *in_figure {
                inside += u64::from((*differs).min(MOST));
            } else if *differs != BARE {
                outside += 1;
            }
        }
        let sum = inside as f64 + OUTSIDE_SHARE * f64::from(MOST) * outside as f64;
        sum / (f64::from(STEPS_PER_UNIT) * self.figure_cells as f64)
    }
}

/// By cell, whether its middle is in the figure.
fn figure_of(image: &ByteImage) -> Vec<bool> {
    let size = image.size().map(|length| length.div_ceil(CELL_PX));
    (0..size[0] * size[1])
        .map(|cell| image.pixel(middle(cell, size[0])).coverage() >= INSIDE)
        .collect()
}

/// The middle of a cell, in working pixels.
pub(super) fn middle(cell: usize, columns: usize) -> Point {
    let half = 0.5 * CELL_PX as f64;
    Point::new(
        ((cell % columns) * CELL_PX) as f64 + half,
        ((cell / columns) * CELL_PX) as f64 + half,
    )
}
