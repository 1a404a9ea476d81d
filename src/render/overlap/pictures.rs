//! What a region shows in every drawing: the drawing where it is seen, and elsewhere what others show of the same place.
//!
//! In a pose that lies over itself, what lies in front of the region is cut out of the picture, with the line around it, and filled from the drawings in
//! which that place is seen: those that do not lie over themselves first. Where none shows it, the nearest colours of the region go on.

use std::borrow::Cow;

use rayon::prelude::*;

use super::division::Division;
use super::rim::Rim;
use crate::input::{Drawing, Picture};
use crate::math::{Point, for_each_cell};
use crate::pose::Mapping;
use crate::render::coverage::Coverage;

/// By how much more than what lies in front is cut out, as a fraction of the drawing's diagonal: half a line.
const CUT_WIDER: f64 = 0.004;

pub(super) struct Pictures<'a> {
    pub(super) mapping: &'a Mapping,
    pub(super) division: &'a Division,
    /// With the poses that they are drawn on.
    pub(super) drawings: &'a [(&'a Drawing, usize)],
    /// By region.
    pub(super) rims: &'a [Vec<Rim>],
    /// By pose, the rings of its silhouette.
    pub(super) shown: &'a [Vec<Vec<Point>>],
    /// By region and drawing, once [`Self::with_hidden`] has found it: by pixel, whether something lies in front; `None` where nothing does anywhere.
    pub(super) hidden: Vec<Vec<Option<Vec<bool>>>>,
}

impl Pictures<'_> {
    /// Finds what is hidden of every region in every drawing.
    pub(super) fn with_hidden(mut self) -> Self {
        let of_region = |region: usize| {
            (0..self.drawings.len())
                .map(|drawing| self.found_hidden(region, drawing))
                .collect()
        };
        let hidden = (0..self.division.count).into_par_iter().map(of_region).collect();
        self.hidden = hidden;
        self
    }

    /// A region's picture of a drawing, and its rims there in source units; `painted` are the triangles that it is painted with.
    pub(super) fn of(&self, region: usize, drawing: usize, painted: &[usize]) -> (Cow<'_, Picture>, Vec<Vec<Point>>) {
        let (of, pose) = self.drawings[drawing];
        let rims = self.rims_at(region, pose);
        let Some(hidden) = &self.hidden[region][drawing] else {
            return (Cow::Borrowed(&of.picture), rims);
        };
        let mut picture = of.picture.clone();
        for (pixel, _) in picture.pixels.iter_mut().zip(hidden).filter(|(_, hidden)| **hidden) {
            *pixel = [0; 4];
        }
        // Those that lie over themselves last.
        let mut others: Vec<usize> = (0..self.drawings.len()).filter(|other| *other != drawing).collect();
        others.sort_by_key(|other| self.mapping.overlaps.depth(self.drawings[*other].1).is_some());
        let triangles = self.mapping.poses.topology().triangles();
        let positions = self.mapping.poses.positions();
        let size = [picture.width, picture.height];
        // What is painted last is seen.
        for &t in painted.iter().rev() {
            let corners = triangles[t].map(|v| picture.to_pixels(positions[pose][v]));
            for_each_cell(corners, size, |pixel, [u, v]| {
                if !hidden[pixel] || picture.pixels[pixel] != [0; 4] {
                    return;
                }
                for other in &others {
                    let hidden_there = &self.hidden[region][*other];
                    let (from, on) = self.drawings[*other];
                    let [a, b, c] = triangles[t].map(|v| from.picture.to_pixels(positions[on][v]));
                    let place = a + (b - a) * u + (c - a) * v;
                    let Some(there) = pixel_at(&from.picture, place) else {
                        continue;
                    };
                    let colour = from.picture.pixels[there];
                    if colour[3] == u8::MAX && hidden_there.as_ref().is_none_or(|hidden| !hidden[there]) {
                        picture.pixels[pixel] = colour;
                        return;
                    }
                }
            });
        }
        (Cow::Owned(picture), rims)
    }

    fn rims_at(&self, region: usize, pose: usize) -> Vec<Vec<Point>> {
        let positions = &self.mapping.poses.positions()[pose];
        self.rims[region]
            .iter()
            .map(|rim| rim.at(&self.shown[pose], positions))
            .collect()
    }

    /// By pixel of a drawing, whether something lies in front of the region there; `None` if nothing does anywhere.
    fn found_hidden(&self, region: usize, drawing: usize) -> Option<Vec<bool>> {
        let (of, pose) = self.drawings[drawing];
        let count = self.division.count;
        let in_front = (0..count).filter(|other| self.division.in_front[pose][other * count + region] > 0);
        let (width, height) = (of.picture.width, of.picture.height);
        let mut hidden: Option<Vec<bool>> = None;
        for other in in_front {
            let rings: Vec<Vec<Point>> = (self.rims_at(other, pose).into_iter())
                .map(|ring| ring.into_iter().map(|p| of.picture.to_pixels(p)).collect())
                .collect();
            let coverage = Coverage::of(rings.iter().map(Vec::as_slice), width, height);
            let hidden = hidden.get_or_insert_with(|| vec![false; width * height]);
            for (hidden, area) in hidden.iter_mut().zip(coverage.areas()) {
                *hidden |= *area > 0.0;
            }
        }
        let wider = (CUT_WIDER * of.outline.diagonal() * of.picture.pixels_per_unit).round() as usize;
        hidden.map(|hidden| widened(&hidden, width, wider))
    }
}

/// A mask grown by so many pixels along rows and columns.
fn widened(mask: &[bool], width: usize, by: usize) -> Vec<bool> {
    let height = mask.len().checked_div(width).unwrap_or(0);
    let mut across = vec![false; mask.len()];
    for (row, own) in across.chunks_exact_mut(width.max(1)).enumerate() {
        for column in (0..width).filter(|column| mask[row * width + column]) {
            own[column.saturating_sub(by)..column.saturating_add(by).saturating_add(1).min(width)].fill(true);
        }
    }
    let mut both = across.clone();
    for row in 0..height {
        for other in row.saturating_sub(by)..row.saturating_add(by).saturating_add(1).min(height) {
            for column in 0..width {
                both[row * width + column] |= across[other * width + column];
            }
        }
    }
    both
}

/// The pixel that holds a place in pixels.
fn pixel_at(picture: &Picture, place: Point) -> Option<usize> {
    let is_there =
        place.x >= 0.0 && place.y >= 0.0 && place.x < picture.width as f64 && place.y < picture.height as f64;
    is_there.then(|| place.y as usize * picture.width + place.x as usize)
}
