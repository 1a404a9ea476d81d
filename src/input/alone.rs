//! The pixels of one part of a picture, without those of the parts beside it.
//!
//! A part's outline runs through the half-covered pixels of its edge: those outside of it belong to the part whose outline is nearest, as
//! long as that is within [`EDGE_PX`]. Cost O(#pixels), and for each pixel of an edge that is near several parts O(#points of their
//! outlines).

use super::bitmap::rows_inside;
use super::{Drawing, Picture};
use crate::math::{Point, point};
use crate::outline::{ArcLength, Outline};

/// How far outside of its outline a part has pixels, at most: as far as edges are blurred by a scanner.
const EDGE_PX: f64 = 6.0;

impl Drawing {
    /// The drawing's pixels on its whole canvas, without those that belong to `others`, which are outlines of other parts of the same
    /// bitmap, and without specks. Only bitmaps are asked: a pixel is a source unit.
    #[must_use]
    pub fn picture_alone(&self, others: &[&Outline]) -> Picture {
        let [width, height] = {
            let size = self.canvas.size();
            // Casts saturate.
            [size.x.round() as usize, size.y.round() as usize]
        };
        let mut alone = Picture {
            width,
            height,
            pixels: vec![[0; 4]; width * height],
            origin: self.canvas.low,
            pixels_per_unit: 1.0,
        };
        let own_rows = rows_inside(&[&self.outline], width, height);
        let near: Vec<NearBy<'_>> = std::iter::once(&self.outline)
            .chain(others.iter().copied())
            .map(NearBy::new)
            .collect();
        let shift = (self.picture.origin - self.canvas.low).map(f64::round);
        for (row, pixels) in self.picture.pixels.chunks_exact(self.picture.width.max(1)).enumerate() {
            for (column, pixel) in pixels.iter().enumerate().filter(|(_, pixel)| pixel[3] > 0) {
                let (x, y) = (column as f64 + shift.x, row as f64 + shift.y);
                if x < 0.0 || y < 0.0 || x >= width as f64 || y >= height as f64 {
                    continue;
                }
                let index = y as usize * width + x as usize;
                if own_rows[index] || is_of_first(&near, Point::new(x + 0.5, y + 0.5)) {
                    alone.pixels[index] = *pixel;
                }
            }
        }
        alone
    }
}

/// An outline, and where it may have pixels.
struct NearBy<'a> {
    outline: &'a Outline,
    arcs: Vec<ArcLength>,
    low: Point,
    high: Point,
}

impl<'a> NearBy<'a> {
    fn new(outline: &'a Outline) -> Self {
        let (low, high) = point::bounding_box(outline.outer().points()).unwrap_or_default();
        Self {
            outline,
            arcs: outline.rings().iter().map(ArcLength::new).collect(),
            low: low - Point::repeat(EDGE_PX),
            high: high + Point::repeat(EDGE_PX),
        }
    }

    /// How far a place is from the outline, zero inside; `None` where it is out of reach.
    fn distance(&self, place: Point) -> Option<f64> {
        if place != place.sup(&self.low).inf(&self.high) {
            return None;
        }
        if self.outline.contains(place) {
            return Some(0.0);
        }
        let distances = self.arcs.iter().map(|arc| arc.nearest(place).1);
        Some(distances.fold(f64::INFINITY, f64::min)).filter(|distance| *distance <= EDGE_PX)
    }
}

/// Whether a place outside of the first outline is nearer to it than to any other.
fn is_of_first(near: &[NearBy<'_>], place: Point) -> bool {
    let Some((first, others)) = near.split_first() else {
        return false;
    };
    let Some(own) = first.distance(place) else {
        return false;
    };
    others
        .iter()
        .all(|other| other.distance(place).is_none_or(|distance| distance > own))
}

#[cfg(test)]
mod tests {
    use crate::input::{BitmapOptions, read_pixels};

    #[test]
    fn a_part_alone_has_its_edge_and_nothing_of_the_others() {
        // Two bars, three columns apart, with soft edges on the sides that face each other, and a speck.
        let alpha = |x: usize, y: usize| match x {
            4..20 | 24..30 if (5..35).contains(&y) => 255,
            20 | 23 if (5..35).contains(&y) => 90,
            38 if y == 2 => 255,
            _ => 0,
        };
        let rgba: Vec<u8> = (0..40 * 40)
            .flat_map(|k| [200, 30, 30, alpha(k % 40, k / 40)])
            .collect();
        let drawing = read_pixels([40, 40], &rgba, &BitmapOptions::default()).expect("two bars");
        let other = &drawing.parts[1].outline;
        let alone = drawing.picture_alone(&[other]);
        for y in 0..40 {
            for x in 0..40 {
                let expected = if (4..21).contains(&x) { alpha(x, y) } else { 0 };
                assert_eq!(alone.pixels[y * 40 + x][3], expected, "({x}, {y})");
            }
        }
    }
}
