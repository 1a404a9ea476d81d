//! The figure of a bitmap: which pixels, by what evidence, and its pixels without their background.
//!
//! Straight pixels -> [`Found`]: a field of coverages whose iso-line is the outline, and how much of each pixel's colour is kept.
//!
//! 1. Where alpha says it, coverage is alpha relative to the most opaque pixel.
//! 2. Otherwise the background is estimated as a smooth field with noise (module `paper`), and coverage is the contrast with it,
//!    relative to the edges nearby (module `edges`).
//! 3. The outside is flooded from the border. In a line drawing gaps are bridged first (module `gaps`), and all that is not outside
//!    is the figure. In a painted one, so is what is enclosed and looks like the background, if it is small, framed by a line, or
//!    has something drawn in it: eyes, teeth, collars. Large openings with nothing around them but paint stay open.
//! 4. A figure that is itself a light sheet with something on it is a photographed page: the figure is looked for on the page.

use image::RgbaImage;
use rayon::prelude::*;

use super::edges::{Edges, Fidelity};
use super::enclosure::{Region, border, depths, flood, neighbours, regions};
use super::figure::{FigureKind, FigureRule, PaperRule, borders_covered, is_line_drawing, is_sheet};
use super::interior::{fill, in_bytes, kept, open};
use super::lines::{Ink, enclose};
use super::paper::Paper;
use super::{BitmapOptions, InputError, InputNote};

/// Alpha, 0 to 255, below which the most opaque pixel counts as nothing.
const FAINTEST_ALPHA: u8 = 8;
/// Coverage from which on something is seen.
pub(super) const FAINT: f32 = 0.03;
/// A soft edge is this many pixels wide outside of the outline at least: edges of drawing programs are one, of scans two or three.
const SOFT_EDGE: usize = 4;
/// Share of the figure's area that a soft edge has at least.
pub(super) const LEAST_SOFT: f64 = 0.02;
/// Deviations of the noise beyond which a pixel is drawn on.
const DRAWN: f32 = 6.0;
/// The least contrast, 0 to 255, that is drawn: below are the steps of 8-bit values in smooth gradients.
const LEAST_CONTRAST: f32 = 3.0;
/// A part that is nowhere stronger than this share of the stronger tenth of what is drawn is grain.
const GRAIN_SHARE: f64 = 0.2;
/// Least share of the picture that a photographed page covers.
const LEAST_PAGE: f64 = 0.3;
/// Least share of the smallest rectangle around it that a page fills.
const PAGE_RECTANGLE: f64 = 0.9;
/// Lightness of paper, from black to white, at least, where nothing is known of what it lies on.
const LEAST_PAPER: f32 = 0.4;
/// Shares of the picture's width and height around its middle that a page is looked for in.
const MIDDLES: [f64; 3] = [0.7, 0.55, 0.4];
/// How much of a page's edge is left out, as a fraction of the picture's shorter side: its shadow, a curled corner.
const PAGE_MARGIN: f64 = 0.012;
/// Shares of a page that what is drawn on it covers.
const ON_PAGE: std::ops::Range<f64> = 0.002..0.85;

/// A figure before it is an outline.
#[derive(Debug)]
pub(super) struct Found {
    pub(super) kind: FigureKind,
    /// Row by row, 0 to 1.
    pub(super) coverage: Vec<f32>,
    /// The background that is taken out of the pixels, and how much of each pixel is kept, from 0 to 255; `None` where alpha says it.
    pub(super) kept: Option<(Paper, Vec<u8>)>,
    /// What was taken, unless there was nothing to decide.
    pub(super) notes: Vec<InputNote>,
}

/// The figure by the rule of the options.
pub(super) fn find(image: &RgbaImage, fidelity: Fidelity, options: &BitmapOptions) -> Result<Found, InputError> {
    let width = image.width() as usize;
    let alphas = || image.pixels().map(|pixel| pixel.0[3]);
    let (low, high) = alphas().fold((u8::MAX, 0), |(low, high), a| (low.min(a), high.max(a)));
    let has_alpha = low < high || high < FAINTEST_ALPHA;
    if !has_alpha {
        return match options.figure {
            FigureRule::Alpha => Err(InputError::NoAlpha),
            _ => on_paper(image, None, fidelity, options),
        };
    }
    let most = if high < FAINTEST_ALPHA { 255.0 } else { f32::from(high) };
    let by_alpha: Vec<f32> = alphas().map(|a| f32::from(a) / most).collect();
    let opaque: Vec<bool> = by_alpha.iter().map(|share| *share >= 0.5).collect();
    let sheet = is_sheet(&opaque, width);
    match options.figure {
        FigureRule::Alpha => Ok(cut_out(by_alpha, width, sheet)),
        FigureRule::Auto | FigureRule::Lines if !sheet => match lines_on_nothing(&by_alpha, width, options) {
            Some(found) => Ok(found),
            None => Ok(cut_out(by_alpha, width, false)),
        },
        _ => match on_paper(image, Some(&without_rim(&opaque, width)), fidelity, options) {
            // Nothing that can be told apart is drawn on it: it is a figure that fills its canvas.
            Err(InputError::NothingDrawn { .. } | InputError::BackgroundNotPlain)
                if options.figure == FigureRule::Auto =>
            {
                Ok(cut_out(by_alpha, width, true))
            }
            found => found,
        },
    }
}

fn cut_out(coverage: Vec<f32>, width: usize, fills_canvas: bool) -> Found {
    let fills_canvas = fills_canvas.then_some(InputNote::FillsCanvas);
    let soft = has_soft_edge(&coverage, width).then_some(InputNote::SoftEdgeCut);
    Found {
        kind: FigureKind::CutOut,
        coverage,
        kept: None,
        notes: fills_canvas.into_iter().chain(soft).collect(),
    }
}

/// Whether much of what is seen lies outside of the outline: more than the edge pixels of any drawing.
fn has_soft_edge(coverage: &[f32], width: usize) -> bool {
    let faint = coverage.iter().filter(|share| (FAINT..0.5).contains(*share)).count();
    if faint == 0 {
        return false;
    }
    let inside: Vec<bool> = coverage.iter().map(|share| *share >= 0.5).collect();
    let rim = (0..inside.len())
        .into_par_iter()
        .filter(|&at| !inside[at] && neighbours(at, width, inside.len()).any(|other| inside[other]))
        .count();
    faint > SOFT_EDGE * rim && faint as f64 > LEAST_SOFT * count(&inside)
}

/// A mask without the pixels that have one beside them that is not in it.
fn without_rim(mask: &[bool], width: usize) -> Vec<bool> {
    let inside = |at: usize| neighbours(at, width, mask.len()).all(|other| mask[other]);
    (0..mask.len())
        .into_par_iter()
        .map(|at| mask[at] && inside(at))
        .collect()
}

/// The figure of lines without paper, if it is one.
fn lines_on_nothing(coverage: &[f32], width: usize, options: &BitmapOptions) -> Option<Found> {
    let threshold = options.threshold as f32;
    let drawn = drawn(coverage, threshold);
    let ink = Ink::measure(&drawn, width)?;
    let is_asked = options.figure == FigureRule::Lines;
    if !is_asked && !is_line_drawing(ink.line_width, ink.diagonal, 1.0) {
        return None;
    }
    let lines = enclose(&drawn, width, &ink, options);
    (is_asked || lines.is_line_drawing(&ink)).then(|| {
        let mut coverage = coverage.to_vec();
        lines.draw_bridges(&mut coverage, width);
        fill(&mut coverage, &lines.outside, width, threshold);
        Found {
            kind: FigureKind::Lines,
            coverage,
            kept: None,
            notes: lines.notes(),
        }
    })
}

/// The figure on paper, or on a page that was photographed with what it lies on.
fn on_paper(
    image: &RgbaImage,
    region: Option<&[bool]>,
    fidelity: Fidelity,
    options: &BitmapOptions,
) -> Result<Found, InputError> {
    let width = image.width() as usize;
    let on_page = |page: &[bool], surroundings: f32| {
        let (mut found, drawn) = on_background(image, Some(page), fidelity, options).ok()?;
        let is_lighter = found
            .kept
            .as_ref()
            .is_some_and(|(paper, _)| paper.lightness() > surroundings);
        found.notes.insert(0, InputNote::PageTaken);
        (is_lighter && ON_PAGE.contains(&(count(&drawn) / count(page)))).then_some(found)
    };
    match on_background(image, region, fidelity, options) {
        Ok((found, _)) if region.is_some() => Ok(found),
        Ok((found, inside)) => {
            let surroundings = found.kept.as_ref().map_or(1.0, |(paper, _)| paper.lightness());
            let page = page(&inside, width).and_then(|page| on_page(&page, surroundings));
            Ok(page.unwrap_or(found))
        }
        // What the page lies on is not plain: the page itself is, around the middle of the picture.
        Err(InputError::BackgroundNotPlain) if region.is_none() => page_around_middle(image)
            .and_then(|page| on_page(&page, LEAST_PAPER))
            .ok_or(InputError::BackgroundNotPlain),
        Err(refusal) => Err(refusal),
    }
}

/// The page that is seen around the middle of a picture.
fn page_around_middle(image: &RgbaImage) -> Option<Vec<bool>> {
    let (width, height) = (image.width() as usize, image.height() as usize);
    MIDDLES.iter().find_map(|share| {
        let is_in = |at: usize, whole: usize| {
            let from_middle = (at as f64 + 0.5) / whole as f64 - 0.5;
            from_middle.abs() < 0.5 * share
        };
        let middle: Vec<bool> = (0..width * height)
            .map(|at| is_in(at % width, width) && is_in(at / width, height))
            .collect();
        let paper = Paper::estimate(image, Some(&middle))?;
        let most = (2.0 * DRAWN * 255.0 * paper.noise).max(LEAST_CONTRAST).round() as u8;
        let is_paper: Vec<bool> = paper
            .contrast(image)
            .into_iter()
            .map(|contrast| contrast <= most)
            .collect();
        let largest = regions(&is_paper, width).into_iter().max_by_key(|region| region.area)?;
        let mut sheet = vec![false; is_paper.len()];
        largest.mark(&mut sheet, width);
        let around = flood(&sheet, width, &border(width, height));
        let filled: Vec<bool> = around.into_iter().map(|around| !around).collect();
        page(&filled, width)
    })
}

fn count(mask: &[bool]) -> f64 {
    mask.iter().filter(|inside| **inside).count() as f64
}

/// The inner part of a mask that is a large rectangle.
fn page(inside: &[bool], width: usize) -> Option<Vec<bool>> {
    let least = LEAST_PAGE * inside.len() as f64;
    if count(inside) < least {
        return None;
    }
    let largest = regions(inside, width).into_iter().max_by_key(|region| region.area)?;
    let area = largest.area as f64;
    let mut mask = vec![false; inside.len()];
    largest.mark(&mut mask, width);
    // The ends of each row have the same convex hull as the whole.
    let mut ends = Vec::new();
    for (y, row) in mask.chunks_exact(width).enumerate() {
        if let (Some(first), Some(last)) = (row.iter().position(|v| *v), row.iter().rposition(|v| *v)) {
            ends.extend([first as i32, last as i32].map(|x| imageproc::point::Point::new(x, y as i32)));
        }
    }
    if area < least || ends.len() < 4 {
        return None;
    }
    let corners = imageproc::geometry::min_area_rect(&ends);
    let side = |a: usize, b: usize| {
        let (a, b) = (corners[a], corners[b]);
        f64::from(a.x - b.x).hypot(f64::from(a.y - b.y)) + 1.0
    };
    if area < PAGE_RECTANGLE * side(0, 1) * side(1, 2) {
        return None;
    }
    // Sides are at most 16,384 pixels: it is a few hundred at most.
    let margin = (PAGE_MARGIN * width.min(inside.len() / width) as f64).ceil() as u16 + 1;
    Some(
        depths(&mask, width, margin)
            .into_iter()
            .map(|depth| depth > margin)
            .collect(),
    )
}

/// The figure by its contrast with the background, and which pixels are not outside.
fn on_background(
    image: &RgbaImage,
    region: Option<&[bool]>,
    fidelity: Fidelity,
    options: &BitmapOptions,
) -> Result<(Found, Vec<bool>), InputError> {
    let width = image.width() as usize;
    let threshold = options.threshold as f32;
    let paper = Paper::estimate(image, region).ok_or(InputError::BackgroundNotPlain)?;
    let mut contrast = paper.contrast(image);
    if let Some(region) = region {
        for (contrast, inside) in contrast.iter_mut().zip(region) {
            *contrast = if *inside { *contrast } else { 0 };
        }
    }
    let faintest = (255.0 * DRAWN * paper.noise).max(LEAST_CONTRAST).round() as u8;
    let mut edges = Edges::of(&contrast, width, faintest, fidelity);
    let mut drawn = drawn(&edges.coverage, threshold);
    leave_out_grain(&mut edges.coverage, &mut drawn, &contrast, width, faintest);
    let ink = Ink::measure(&drawn, width).ok_or(InputError::NothingDrawn {
        width,
        height: image.height() as usize,
        by_alpha: false,
    })?;
    let lines = match options.figure {
        FigureRule::Background => None,
        FigureRule::Lines => Some(enclose(&drawn, width, &ink, options)),
        _ => is_line_drawing(ink.line_width, ink.diagonal, 1.0)
            .then(|| enclose(&drawn, width, &ink, options))
            .filter(|lines| lines.is_line_drawing(&ink)),
    };
    let Edges { mut coverage, radius } = edges;
    let clear = (lines.is_some() && options.paper == PaperRule::Clear)
        .then(|| coverage.iter().map(|share| in_bytes(*share)).collect());
    let (kind, outside, mut notes) = match lines {
        Some(lines) => {
            lines.draw_bridges(&mut coverage, width);
            let notes = lines.notes();
            (FigureKind::Lines, lines.outside, notes)
        }
        None => {
            let mut outside = flood(&drawn, width, &border(width, image.height() as usize));
            let shows_paper = |region: &Region| paper.is_seen_in(image, region);
            let enclosed = open(&mut outside, &drawn, &contrast, width, &ink, radius, &shows_paper);
            (
                FigureKind::Painted,
                outside,
                vec![InputNote::FigurePainted { enclosed }],
            )
        }
    };
    drop((drawn, contrast));
    let inside: Vec<bool> = outside
        .par_iter()
        .with_min_len(1 << 14)
        .map(|outside| !outside)
        .collect();
    if borders_covered(&inside, width, 0.0) == 4 {
        notes.push(InputNote::FillsCanvas);
    }
    let kept = clear.unwrap_or_else(|| kept(&coverage, &outside, width, radius));
    fill(&mut coverage, &outside, width, threshold);
    let found = Found {
        kind,
        coverage,
        kept: Some((paper, kept)),
        notes,
    };
    Ok((found, inside))
}

/// Takes away what is drawn only faintly, all by itself: grain of the paper, ringing, smudges.
fn leave_out_grain(coverage: &mut [f32], drawn: &mut [bool], contrast: &[u8], width: usize, faintest: u8) {
    let mut strengths = [0_usize; 256];
    for (contrast, _) in contrast.iter().zip(drawn.iter()).filter(|(_, drawn)| **drawn) {
        strengths[usize::from(*contrast)] += 1;
    }
    let count: usize = strengths.iter().sum();
    if count == 0 {
        return;
    }
    let mut up_to = 0;
    let strong = strengths.iter().position(|count_of| {
        up_to += count_of;
        up_to > count * 9 / 10
    });
    let strong = strong.unwrap_or(255) as f64;
    let least = (GRAIN_SHARE * strong).max(2.0 * f64::from(faintest)).min(strong);
    for region in regions(drawn, width) {
        if region.pixels(width).all(|at| f64::from(contrast[at]) < least) {
            for at in region.pixels(width) {
                (drawn[at], coverage[at]) = (false, 0.0);
            }
        }
    }
}

fn drawn(coverage: &[f32], threshold: f32) -> Vec<bool> {
    let drawn = coverage.par_iter().with_min_len(1 << 14);
    drawn.map(|share| *share >= threshold).collect()
}

#[cfg(test)]
mod tests;
