//! Bitmaps: the sub-pixel outline of what is drawn, and its pixels without their background.
//!
//! Bytes of a PNG, JPEG, WebP, GIF, BMP or TIFF file -> [`Drawing`].
//!
//! 1. Decode under limits; turn upright.
//! 2. Decide what of it is the figure, and how much of each pixel that covers (module `found`).
//! 3. Unite covered pixels into parts, and follow the iso-line of coverage around the largest, around the others that are no dirt (module
//!    `loose`), and around their holes (module `iso_line`). Pixel `(i, j)` has its centre at `(i + 0.5, j + 0.5)`.
//! 4. Close pin-holes; take the paper out of the pixels along the edge, so that the character does not carry its fringe.
//!
//! Cost O(#pixels). Limits: background that shows through a painted figure and what is as white as the paper cannot always be told
//! apart (module `found` says how it is decided); [`HoleRule::Fill`] or an alpha channel settles it.

use std::path::Path;

use image::RgbaImage;
use rayon::prelude::*;

use super::border_strip::border_strips;
use super::coverage::Coverage;
use super::decode::{Decoded, PictureChoice, count_frames, decode_chosen, image_of_pixels, upright_size};
use super::figure::{FigureKind, FigureRule, PaperRule};
use super::found::{Found, find};
use super::iso_line::{Part, Parts};
use super::loose::{Piece, choose, note_pieces};
use super::picture_file::premultiplied;
use super::{Canvas, Drawing, HoleRule, InputError, InputNote, LoosePart, PartOptions, Picture};
use crate::math::Point;
use crate::outline::{Outline, Ring};

/// Largest area, in pixels, of a hole or loose part that counts as dirt.
const DIRT_AREA: f64 = 4.0;
/// Largest share of the drawing's area that a hole or loose part may have to count as dirt.
const DIRT_SHARE: f64 = 1e-4;
/// Share of the drawing's area from which on a loose part is no dirt, however few pixels it has: sprites are a few hundred pixels.
const SPRITE_SHARE: f64 = 1.5e-3;
/// Smallest area, in pixels, of a drawing.
const SMALLEST_DRAWING: f64 = 4.0;
/// How far the threshold may be moved, in steps, when rounding makes the iso-line touch itself.
const THRESHOLD_STEPS: [f32; 5] = [0.0, 0.004, -0.004, 0.01, -0.01];

/// Clear pixels around the picture of a loose part: as far as colours are looked for at an edge.
const CROP_MARGIN: usize = 6;

/// The widest gap that is closed, as a fraction of the diagonal: wider, the inside of letters would close.
const LARGEST_GAP: f64 = 0.2;

/// How a bitmap is read.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
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
    /// Which loose parts belong to it. Default: those that are no dirt.
    pub parts: PartOptions,
    /// Which picture of the file is meant. Default: the only or first one.
    pub picture: PictureChoice,
    /// The path of the layer or group of a layered file that is meant, such as `group/layer`. Default: everything that is visible.
    pub element: Option<String>,
}

impl Default for BitmapOptions {
    fn default() -> Self {
        Self {
            figure: FigureRule::Auto,
            gap: 0.01,
            paper: PaperRule::Keep,
            threshold: 0.5,
            holes: HoleRule::Keep,
            parts: PartOptions::default(),
            picture: PictureChoice::default(),
            element: None,
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
    outlined(
        decode_chosen(bytes, options.picture, options.element.as_deref())?,
        options,
    )
}

/// How many pictures the bytes of an image file hold: more than one if it is animated, of which at most a hundred are counted.
///
/// # Errors
/// [`InputError`] if the bytes are no image, or it is too large.
pub fn frame_count(bytes: &[u8]) -> Result<usize, InputError> {
    count_frames(bytes)
}

/// How many columns and rows the picture that is meant in the bytes of an image file has, turned upright; only its header is read.
///
/// # Errors
/// [`InputError`] if the bytes are no image, or the image is too large.
pub fn bitmap_size(bytes: &[u8], choice: PictureChoice) -> Result<Point, InputError> {
    let [columns, rows] = upright_size(bytes, choice)?;
    Ok(Point::new(f64::from(columns), f64::from(rows)))
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
    let image = &decoded.image;
    let mut refusal = None;
    for step in THRESHOLD_STEPS {
        let moved = (options.threshold as f32 + step).clamp(0.005, 0.995);
        // Found once more where it has to be traced again, which is rare: to keep it meanwhile is memory for every large drawing.
        let found = find(image, decoded.fidelity, options)?;
        match trace(image, found, moved, options, decoded.notes()) {
            Err(InputError::Outline(error)) => refusal = refusal.or(Some(InputError::Outline(error))),
            settled => return settled,
        }
    }
    Err(refusal.expect("invariant: every step but a return leaves a refusal"))
}

fn trace(
    image: &RgbaImage,
    mut found: Found,
    threshold: f32,
    options: &BitmapOptions,
    mut notes: Vec<InputNote>,
) -> Result<Drawing, InputError> {
    notes.append(&mut found.notes);
    let measured = std::mem::take(&mut found.coverage);
    let coverage = Coverage::framed(measured, image.width() as usize, threshold);
    let parts = Parts::of(&coverage, threshold);
    let pieces: Vec<Piece> = parts.parts.iter().map(Part::piece).collect();
    // Of a sprite every pixel counts.
    let loose_dirt = |largest: f64| DIRT_AREA.min(SPRITE_SHARE * largest).max(DIRT_SHARE * largest);
    let strips = match found.kept {
        Some(_) => border_strips(&parts),
        // Whoever cut the figure out meant what is left.
        None => Vec::new(),
    };
    let chosen = choose(&pieces, &strips, &options.parts, loose_dirt, |place| parts.at(place))?;
    let Some(chosen) = chosen else {
        return Err(InputError::NothingDrawn {
            width: image.width() as usize,
            height: image.height() as usize,
            by_alpha: found.kept.is_none(),
        });
    };
    let largest = parts.parts[chosen.largest];
    let too_small = InputError::TooSmall {
        area: largest.area,
        x: largest.centroid.x,
        y: largest.centroid.y,
    };
    if largest.area < SMALLEST_DRAWING {
        return Err(too_small);
    }
    let dirt = DIRT_AREA.max(DIRT_SHARE * largest.area);
    if strips.iter().any(|strip| chosen.dropped.contains(strip)) {
        notes.push(InputNote::BorderStripLeftOut);
    }
    note_pieces(&pieces, &chosen, loose_dirt(largest.area), &mut notes);
    let outline = outline_of(&parts, largest, dirt, options.holes, &mut notes)?.ok_or(too_small)?;
    let mut loose: Vec<(Part, Outline, bool)> = Vec::new();
    for &(piece, is_kept) in &chosen.loose {
        // What bounds nothing, or touches itself by rounding, stays with what the notes say is left out.
        if let Ok(Some(outline)) = outline_of(&parts, parts.parts[piece], dirt, options.holes, &mut Vec::new()) {
            loose.push((parts.parts[piece], outline, is_kept));
        }
    }
    // The outlines are all that is needed of them: with large drawings this is memory that the pixels then have.
    drop(parts);
    drop(coverage);
    let filled: Vec<&Outline> = match options.holes {
        HoleRule::Keep => Vec::new(),
        HoleRule::Fill => std::iter::once(&outline)
            .chain(loose.iter().map(|(_, outline, _)| outline))
            .collect(),
    };
    let picture = without_background(image, &found, &filled);
    let mut in_order: Vec<LoosePart> = loose
        .into_iter()
        .map(|(part, outline, is_kept)| LoosePart {
            picture: Some(picture.cropped(part.bounds, CROP_MARGIN)),
            outline,
            area: part.area,
            art: None,
            is_kept,
        })
        .collect();
    if !in_order.is_empty() {
        // Nothing overlaps in a bitmap: what is small is drawn over what is large.
        in_order.sort_by(|a, b| b.area.total_cmp(&a.area));
        in_order.insert(
            0,
            LoosePart {
                outline: outline.clone(),
                area: largest.area,
                picture: None,
                art: None,
                is_kept: false,
            },
        );
    }
    Ok(Drawing {
        outline,
        picture,
        art: None,
        notes,
        unit_px: 1.0,
        canvas: Canvas::of_pixels(image.width() as usize, image.height() as usize),
        parts: in_order,
    })
}

/// The outline of one part; `None` if it bounds nothing. Its pin-holes are closed and told of.
fn outline_of(
    parts: &Parts<'_>,
    part: Part,
    dirt: f64,
    hole_rule: HoleRule,
    notes: &mut Vec<InputNote>,
) -> Result<Option<Outline>, InputError> {
    let mut outer = None;
    let mut holes = Vec::new();
    let (mut closed, mut closed_area) = (0, 0.0);
    for points in parts.loops(part) {
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
    let Some(outer) = outer else { return Ok(None) };
    Ok(Some(Outline::new(outer, holes)?))
}

/// The pixels, premultiplied, with the background taken out. Inside outlines that are `filled` the background stays, unless the paper
/// of a line drawing is to be clear.
fn without_background(image: &RgbaImage, found: &Found, filled: &[&Outline]) -> Picture {
    let (width, height) = (image.width() as usize, image.height() as usize);
    let mut pixels = vec![[0; 4]; width * height];
    let is_filled = found.kind == FigureKind::Painted && !filled.is_empty();
    let covered_by_fill = is_filled.then(|| rows_inside(filled, width, height));
    pixels
        .par_chunks_mut(width.max(1))
        .zip(image.as_raw().par_chunks(4 * width.max(1)))
        .enumerate()
        .for_each(|(y, (row, source))| {
            let Some((paper, kept)) = &found.kept else {
                for (pixel, source) in row.iter_mut().zip(source.chunks_exact(4)) {
                    *pixel = premultiplied([source[0], source[1], source[2], source[3]]);
                }
                return;
            };
            for (x, (pixel, source)) in row.iter_mut().zip(source.chunks_exact(4)).enumerate() {
                let index = y * width + x;
                let is_filled = covered_by_fill.as_ref().is_some_and(|inside| inside[index]);
                *pixel = match if is_filled { u8::MAX } else { kept[index] } {
                    0 => continue,
                    u8::MAX => [source[0], source[1], source[2], u8::MAX],
                    // An edge pixel is a mixture of drawing and paper: take the paper's part out.
                    alpha => {
                        let share = f32::from(alpha) / 255.0;
                        let behind = paper.at(x, y);
                        let [red, green, blue] = std::array::from_fn(|k| {
                            (f32::from(source[k]) - (1.0 - share) * 255.0 * behind[k])
                                .clamp(0.0, 255.0 * share)
                                .round() as u8
                        });
                        [red, green, blue, alpha]
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

/// Whether each pixel's centre lies inside one of the outlines, which lie apart.
pub(super) fn rows_inside(outlines: &[&Outline], width: usize, height: usize) -> Vec<bool> {
    let mut crossings = vec![Vec::new(); height];
    for ring in outlines.iter().flat_map(|outline| outline.rings()) {
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
