//! What a region shows in every drawing: the drawing where it is seen, and elsewhere what others show of the same place.
//!
//! In a pose that lies over itself, what lies in front of the region is cut out of the picture, with the line around it, and filled from the drawings in
//! which that place is seen: those that do not lie over themselves first. Where none shows it, the nearest colours of the region go on.

use std::borrow::Cow;

use rayon::prelude::*;

use super::regions::Regions;
use super::stretch::in_order;
use crate::input::{Drawing, Picture};
use crate::math::{Point, for_each_cell};
use crate::outline::Outline;
use crate::pose::Mapping;
use crate::render::coverage::Coverage;
use crate::render::nearest_seed::nearest_seeds;
use crate::render::texture::bleed;

/// A pixel is wholly covered from here on; only rounding is missing.
const WHOLLY: f32 = 0.999;
/// By how much more than what lies in front is cut out, as a fraction of the drawing's diagonal: half a line.
const CUT_WIDER: f64 = 0.004;

/// What the regions of a figure show in its drawings.
pub(crate) struct RegionPictures<'a> {
    mapping: &'a Mapping,
    regions: &'a Regions,
    /// With the poses that they are drawn on.
    drawings: &'a [(&'a Drawing, usize)],
    /// By region and drawing, by pixel, whether something lies in front; `None` where nothing does anywhere.
    hidden: Vec<Vec<Option<Vec<bool>>>>,
    /// By drawing, how much its pose stretches every triangle.
    stretches: Vec<Vec<f64>>,
}

impl<'a> RegionPictures<'a> {
    /// Every drawing was made on one pose. What is hidden of every region in every drawing is found at once.
    #[must_use]
    pub(crate) fn new(mapping: &'a Mapping, regions: &'a Regions, drawings: &'a [(&'a Drawing, usize)]) -> Self {
        let positions = mapping.poses.positions();
        let pictures = Self {
            mapping,
            regions,
            drawings,
            hidden: Vec::new(),
            stretches: (drawings.iter())
                .map(|(_, pose)| regions.rest().stretches(&positions[*pose]))
                .collect(),
        };
        let of_region = |region: usize| {
            (0..drawings.len())
                .map(|drawing| pictures.found_hidden(region, drawing))
                .collect()
        };
        let hidden = (0..regions.count()).into_par_iter().map(of_region).collect();
        Self { hidden, ..pictures }
    }

    /// A region's picture of a drawing cut out by the region's edge: what a frame at the drawing's pose shows of it where nothing lies in front.
    #[must_use]
    pub(crate) fn cut(&self, region: usize, drawing: usize) -> Picture {
        let mut picture = self.of(region, drawing).into_owned();
        cut(&mut picture, &self.coverage(region, drawing));
        picture
    }

    /// A region's picture of a drawing; beyond the region it shows whatever the drawing does.
    pub(super) fn of(&self, region: usize, drawing: usize) -> Cow<'_, Picture> {
        let (of, pose) = self.drawings[drawing];
        let Some(hidden) = &self.hidden[region][drawing] else {
            return Cow::Borrowed(&of.picture);
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
        let painted = self.regions.painted(region);
        // What is painted last is seen.
        for t in in_order(painted, &self.stretches[drawing]).into_iter().rev() {
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
        Self::go_on(&mut picture, hidden, &self.coverage(region, drawing));
        Cow::Owned(picture)
    }

    /// Lets the nearest colours of a region go on where something hides it and no drawing shows it.
    fn go_on(picture: &mut Picture, hidden: &[bool], covered: &Coverage) {
        let is_blank = |pixels: &[[u8; 4]], k: usize| hidden[k] && pixels[k] == [0; 4];
        let blank: Vec<usize> = (0..hidden.len())
            .filter(|k| covered.areas()[*k] > 0.0 && is_blank(&picture.pixels, *k))
            .collect();
        if blank.is_empty() {
            return;
        }
        let nearest = nearest_seeds(picture.width, picture.height, |k| {
            covered.areas()[k] >= WHOLLY && picture.pixels[k][3] == u8::MAX
        });
        if let Some(nearest) = nearest {
            for k in blank {
                picture.pixels[k] = picture.pixels[nearest[k] as usize];
            }
        }
    }

    /// How much of each pixel of a drawing a region covers.
    fn coverage(&self, region: usize, drawing: usize) -> Coverage {
        let (of, pose) = self.drawings[drawing];
        let to_pixels =
            |ring: Vec<Point>| -> Vec<Point> { ring.into_iter().map(|p| of.picture.to_pixels(p)).collect() };
        let rims = self.regions.rims_at(region, pose, self.mapping).into_iter();
        let rings: Vec<Vec<Point>> = rims.map(to_pixels).collect();
        Coverage::of(rings.iter().map(Vec::as_slice), of.picture.width, of.picture.height)
    }

    /// By pixel of a drawing, whether something lies in front of the region there; `None` if nothing does anywhere.
    fn found_hidden(&self, region: usize, drawing: usize) -> Option<Vec<bool>> {
        let (of, pose) = self.drawings[drawing];
        let order = self.regions.order();
        let count = order.region_count();
        let in_front = (0..count).filter(|other| order.in_front()[pose][other * count + region] > 0);
        let (width, height) = (of.picture.width, of.picture.height);
        let mut hidden: Option<Vec<bool>> = None;
        for other in in_front {
            let coverage = self.coverage(other, drawing);
            let hidden = hidden.get_or_insert_with(|| vec![false; width * height]);
            for (hidden, area) in hidden.iter_mut().zip(coverage.areas()) {
                *hidden |= *area > 0.0;
            }
        }
        let wider = (CUT_WIDER * of.outline.diagonal() * of.picture.pixels_per_unit).round() as usize;
        hidden.map(|hidden| widened(&hidden, width, wider))
    }
}

/// A picture cut out by its outline: what a frame at its pose shows.
#[must_use]
pub(crate) fn cut_out(picture: &Picture, outline: &Outline) -> Picture {
    let coverage = Coverage::of_outline(outline, |p| picture.to_pixels(p), picture.width, picture.height);
    let mut picture = picture.clone();
    cut(&mut picture, &coverage);
    picture
}

/// Cuts a picture out by what is covered, with colours at full strength up to the edge.
fn cut(picture: &mut Picture, coverage: &Coverage) {
    picture.pixels.resize(picture.width * picture.height, [0; 4]);
    bleed(&mut picture.pixels, picture.width, coverage);
    for (pixel, area) in picture.pixels.iter_mut().zip(coverage.areas()) {
        *pixel = pixel.map(|channel| (f32::from(channel) * area).round() as u8);
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
