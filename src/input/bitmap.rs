//! Bitmaps: the sub-pixel outline of what is drawn, and its pixels without their background.
//!
//! Bytes of a PNG, JPEG, WebP, GIF or BMP file -> [`Drawing`].
//!
//! 1. Decode under limits; turn upright.
//! 2. Decide what of it is the figure, and how much of each pixel that covers (module `found`).
//! 3. Unite covered pixels into parts, take the largest, and follow the iso-line of coverage around it and its holes
//!    (module `iso_line`). Pixel `(i, j)` has its centre at `(i + 0.5, j + 0.5)`.
//! 4. Close pin-holes; take the paper out of the pixels along the edge, so that the character does not carry its fringe.
//!
//! Cost O(#pixels). Limits: background that shows through a painted figure and what is as white as the paper cannot always be told
//! apart (module `found` says how it is decided); [`HoleRule::Fill`] or an alpha channel settles it.

use std::path::Path;

use image::RgbaImage;
use rayon::prelude::*;

use super::coverage::Coverage;
use super::decode::{Decoded, decode, image_of_pixels};
use super::figure::{FigureKind, FigureRule, PaperRule};
use super::found::{Found, find};
use super::iso_line::{Part, Parts};
use super::{Drawing, InputError, InputNote, Picture};
use crate::math::Point;
use crate::outline::{Outline, Ring};

/// Largest area, in pixels, of a hole or loose part that counts as dirt.
const DIRT_AREA: f64 = 4.0;
/// Largest share of the drawing's area that a hole or loose part may have to count as dirt.
const DIRT_SHARE: f64 = 1e-4;
/// Smallest area, in pixels, of a drawing.
const SMALLEST_DRAWING: f64 = 4.0;
/// How far the threshold may be moved, in steps, when rounding makes the iso-line touch itself.
const THRESHOLD_STEPS: [f32; 5] = [0.0, 0.004, -0.004, 0.01, -0.01];

/// The widest gap that is closed, as a fraction of the diagonal: wider, the inside of letters would close.
const LARGEST_GAP: f64 = 0.2;

/// What becomes of holes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum HoleRule {
    /// They are part of the outline.
    #[default]
    Keep,
    /// They are closed, and the picture keeps its pixels there.
    Fill,
}

/// How a bitmap is read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BitmapOptions {
    /// How the figure is told from its sheet. Default: by evidence.
    pub figure: FigureRule,
    /// Widest gap in the lines of a line drawing that is closed, as a fraction of the drawing's diagonal. Default 0.01.
    pub gap: f64,
    /// What becomes of the paper inside a line drawing. Default: kept.
    pub paper: PaperRule,
    /// The coverage that counts as inside, strictly between 0 and 1. Default 0.5.
    pub threshold: f64,
    /// What becomes of holes. Default: kept.
    pub holes: HoleRule,
}

impl Default for BitmapOptions {
    fn default() -> Self {
        Self {
            figure: FigureRule::Auto,
            gap: 0.01,
            paper: PaperRule::Keep,
            threshold: 0.5,
            holes: HoleRule::Keep,
        }
    }
}

/// Reads the drawing in the file at `path`; see [`read_bitmap`].
///
/// # Errors
/// [`InputError::Unreadable`] with the path if it cannot be read, else as [`read_bitmap`].
pub fn open_bitmap(path: &Path, options: &BitmapOptions) -> Result<Drawing, InputError> {
    let bytes = std::fs::read(path).map_err(|source| InputError::Unreadable {
        path: path.to_owned(),
        source,
    })?;
    read_bitmap(&bytes, options)
}

/// The drawing in the bytes of an image file: the outline of its largest part, and its pixels.
///
/// The outline runs through the points where the coverage, interpolated between pixel centres, equals the threshold.
///
/// # Errors
/// [`InputError`] if the bytes are no image, the image is too large, or nothing is drawn in it.
pub fn read_bitmap(bytes: &[u8], options: &BitmapOptions) -> Result<Drawing, InputError> {
    check_options(options)?;
    outlined(decode(bytes)?, options)
}

/// The drawing in pixels that are in memory, of `size` columns and rows: row by row, red, green, blue and alpha, colours not
/// multiplied by alpha. Otherwise as [`read_bitmap`].
///
/// # Errors
/// [`InputError`] if there are not four bytes a pixel, or as [`read_bitmap`].
pub fn read_pixels(size: [usize; 2], rgba: &[u8], options: &BitmapOptions) -> Result<Drawing, InputError> {
    check_options(options)?;
    outlined(Decoded::exact(image_of_pixels(size, rgba)?), options)
}

fn check_options(options: &BitmapOptions) -> Result<(), InputError> {
    let threshold = options.threshold;
    // Written so that NaN fails too.
    if !(0.01..=0.99).contains(&threshold) {
        return Err(InputError::BadThreshold { threshold });
    }
    if !(0.0..=LARGEST_GAP).contains(&options.gap) {
        return Err(InputError::BadGap { gap: options.gap });
    }
    Ok(())
}

fn outlined(decoded: Decoded, options: &BitmapOptions) -> Result<Drawing, InputError> {
    let mut notes = decoded.notes();
    let image = decoded.image;
    let mut found = find(&image, decoded.fidelity, options)?;
    notes.append(&mut found.notes);
    let threshold = options.threshold;
    let mut refusal = None;
    for step in THRESHOLD_STEPS {
        let moved = (threshold as f32 + step).clamp(0.005, 0.995);
        match trace(&image, &found, moved, options.holes, &notes) {
            Err(InputError::Outline(error)) => refusal = refusal.or(Some(InputError::Outline(error))),
            settled => return settled,
        }
    }
    Err(refusal.expect("invariant: every step but a return leaves a refusal"))
}

fn trace(
    image: &RgbaImage,
    found: &Found,
    threshold: f32,
    hole_rule: HoleRule,
    taken: &[InputNote],
) -> Result<Drawing, InputError> {
    let coverage = Coverage::framed(&found.coverage, image.width() as usize, threshold);
    let parts = Parts::of(&coverage, threshold);
    let largest = largest_part(&parts.parts).ok_or(InputError::NothingDrawn {
        width: image.width() as usize,
        height: image.height() as usize,
        by_alpha: found.kept.is_none(),
    })?;
    let too_small = InputError::TooSmall {
        area: largest.area,
        x: largest.centroid.x,
        y: largest.centroid.y,
    };
    if largest.area < SMALLEST_DRAWING {
        return Err(too_small);
    }
    let dirt = DIRT_AREA.max(DIRT_SHARE * largest.area);
    let mut notes = taken.to_vec();
    note_parts(&parts.parts, largest, dirt, &mut notes);

    let mut outer = None;
    let mut holes = Vec::new();
    let (mut closed, mut closed_area) = (0, 0.0);
    for points in parts.loops(largest.label) {
        // A loop without three distinct points or without area bounds nothing.
        let Ok(ring) = Ring::new(points) else { continue };
        let area = ring.signed_area();
        if area > 0.0 {
            outer = Some(ring);
        } else if -area < dirt {
            (closed, closed_area) = (closed + 1, closed_area - area);
        } else {
            holes.push(ring);
        }
    }
    if closed > 0 {
        notes.push(InputNote::PinHolesClosed {
            count: closed,
            area: closed_area,
        });
    }
    if hole_rule == HoleRule::Fill && !holes.is_empty() {
        notes.push(InputNote::HolesFilled { count: holes.len() });
        holes.clear();
    }
    let outline = Outline::new(outer.ok_or(too_small)?, holes)?;
    let picture = without_background(image, found, (hole_rule == HoleRule::Fill).then_some(&outline));
    Ok(Drawing {
        outline,
        picture,
        art: None,
        notes,
        unit_px: 1.0,
    })
}

fn largest_part(parts: &[Part]) -> Option<Part> {
    parts.iter().copied().reduce(|a, b| if b.area > a.area { b } else { a })
}

fn note_parts(parts: &[Part], largest: Part, dirt: f64, notes: &mut Vec<InputNote>) {
    let (specks, loose): (Vec<Part>, Vec<Part>) = parts
        .iter()
        .filter(|part| part.label != largest.label)
        .partition(|part| part.area < dirt);
    let area = |parts: &[Part]| parts.iter().map(|part| part.area).sum();
    if let Some(most) = largest_part(&loose) {
        notes.push(InputNote::PartsLeftOut {
            count: loose.len(),
            area: area(&loose),
            place: most.centroid,
        });
    }
    if !specks.is_empty() {
        notes.push(InputNote::SpecksLeftOut {
            count: specks.len(),
            area: area(&specks),
        });
    }
}

/// The pixels, premultiplied, with the background taken out. Inside `filled`, if given, the background stays, unless the paper of a
/// line drawing is to be clear.
fn without_background(image: &RgbaImage, found: &Found, filled: Option<&Outline>) -> Picture {
    let (width, height) = (image.width() as usize, image.height() as usize);
    let mut pixels = vec![[0; 4]; width * height];
    let covered_by_fill = filled
        .filter(|_| found.kind == FigureKind::Painted)
        .map(|outline| rows_inside(outline, width, height));
    pixels
        .par_chunks_mut(width.max(1))
        .zip(image.as_raw().par_chunks(4 * width.max(1)))
        .enumerate()
        .for_each(|(y, (row, source))| {
            for (x, (pixel, source)) in row.iter_mut().zip(source.chunks_exact(4)).enumerate() {
                let [red, green, blue, alpha] = [source[0], source[1], source[2], source[3]];
                *pixel = match &found.kept {
                    None => {
                        let times_alpha = |c: u8| ((u16::from(c) * u16::from(alpha) + 127) / 255) as u8;
                        [times_alpha(red), times_alpha(green), times_alpha(blue), alpha]
                    }
                    Some((paper, kept)) => {
                        let index = y * width + x;
                        let is_filled = covered_by_fill.as_ref().is_some_and(|inside| inside[index]);
                        let share = if is_filled { 1.0 } else { f32::from(kept[index]) / 255.0 };
                        if share <= 0.0 {
                            continue;
                        }
                        // An edge pixel is a mixture of drawing and paper: take the paper's part out.
                        let behind = paper.at(x, y);
                        let unmixed = |c: u8, paper: f32| {
                            (f32::from(c) - (1.0 - share) * 255.0 * paper)
                                .clamp(0.0, 255.0 * share)
                                .round() as u8
                        };
                        [
                            unmixed(red, behind[0]),
                            unmixed(green, behind[1]),
                            unmixed(blue, behind[2]),
                            (255.0 * share).round() as u8,
                        ]
                    }
                };
            }
        });
    Picture {
        width,
        height,
        pixels,
        origin: Point::zeros(),
        pixels_per_unit: 1.0,
    }
}

/// Whether each pixel's centre lies inside the outline.
fn rows_inside(outline: &Outline, width: usize, height: usize) -> Vec<bool> {
    let mut crossings = vec![Vec::new(); height];
    for ring in outline.rings() {
        for (a, b) in ring.edges() {
            let (low, high) = (a.y.min(b.y), a.y.max(b.y));
            let first = (low - 0.5).ceil().max(0.0) as usize;
            for (row, row_crossings) in crossings.iter_mut().enumerate().skip(first) {
                let y = row as f64 + 0.5;
                // Half open, so that a vertex on the line counts once.
                if y >= high {
                    break;
                }
                if y >= low {
                    row_crossings.push(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
                }
            }
        }
    }
    let mut inside = vec![false; width * height];
    for (row, row_crossings) in crossings.iter_mut().enumerate() {
        row_crossings.sort_unstable_by(f64::total_cmp);
        for span in row_crossings.chunks_exact(2) {
            let first = (span[0] - 0.5).ceil().max(0.0) as usize;
            let end = ((span[1] - 0.5).ceil().max(0.0) as usize).min(width);
            inside[row * width + first.min(end)..row * width + end].fill(true);
        }
    }
    inside
}

#[cfg(test)]
mod tests;
