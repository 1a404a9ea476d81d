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
use super::enclosure::{border, depths, flood, outer_border, regions};
use super::figure::{FigureKind, FigureRule, PaperRule, borders_covered, is_line_drawing, is_sheet};
use super::gaps::{Bridge, bridges};
use super::paper::Paper;
use super::{BitmapOptions, InputError, InputNote};
use crate::math::Point;

/// Alpha, 0 to 255, below which the most opaque pixel counts as nothing.
const FAINTEST_ALPHA: u8 = 8;
/// Coverage from which on something is seen.
const FAINT: f32 = 0.03;
/// A soft edge is this many pixels wide outside of the outline at least: edges of drawing programs are one, of scans two or three.
const SOFT_EDGE: usize = 4;
/// Share of the figure's area that a soft edge has at least.
const LEAST_SOFT: f64 = 0.02;
/// Deviations of the noise beyond which a pixel is drawn on.
const DRAWN: f32 = 6.0;
/// The least contrast, 0 to 255, that is drawn: below are the steps of 8-bit values in smooth gradients.
const LEAST_CONTRAST: f32 = 3.0;
/// A part that is nowhere stronger than this share of the stronger tenth of what is drawn is grain.
const GRAIN_SHARE: f64 = 0.2;
/// The least share of a painted figure's area of an opening in it.
const LEAST_OPENING: f64 = 0.04;
/// How much stronger a line around an opening is than what lies beyond it.
const LINE_CONTRAST: f64 = 1.5;
/// The widest such line, as a fraction of the diagonal.
const WIDEST_FRAME: f64 = 0.02;
/// Share of an opening's rim that is the figure's outer line, from which on it is no opening.
const LEAST_SHARED_RIM: f64 = 0.05;
/// Least share of the picture that a photographed page covers.
const LEAST_PAGE: f64 = 0.3;
/// Least share of the smallest rectangle around it that a page fills.
const PAGE_RECTANGLE: f64 = 0.9;
/// How much of a page's edge is left out, as a fraction of the picture's shorter side: its shadow, a curled corner.
const PAGE_MARGIN: f64 = 0.012;
/// Shares of a page that what is drawn on it covers.
const ON_PAGE: std::ops::Range<f64> = 0.002..0.85;
/// How many times wider than `gap` gaps are looked for, to be named.
const NAMED_GAP: f64 = 5.0;
/// Growth of the figure by which a wider gap is named.
const NAMED_GROWTH: f64 = 1.05;
/// Work on gaps is done on at most so many pixels a side.
const GAP_SIDE: usize = 1024;

/// A figure before it is an outline.
#[derive(Debug)]
pub(super) struct Found {
    pub(super) kind: FigureKind,
    /// Row by row, 0 to 1.
    pub(super) coverage: Vec<f32>,
    /// The background that is taken out of the pixels, and how much of each pixel is kept; `None` where alpha says it.
    pub(super) kept: Option<(Paper, Vec<f32>)>,
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

/// The pixels around one.
fn neighbours(at: usize, width: usize, count: usize) -> impl Iterator<Item = usize> {
    let (x, y, height) = (at % width, at / width, count / width);
    let rows = y.saturating_sub(1)..(y + 2).min(height);
    rows.flat_map(move |row| (x.saturating_sub(1)..(x + 2).min(width)).map(move |column| row * width + column))
        .filter(move |&other| other != at)
}

/// The figure of lines without paper, if it is one.
fn lines_on_nothing(coverage: &[f32], width: usize, options: &BitmapOptions) -> Option<Found> {
    let drawn = drawn(coverage, options.threshold as f32);
    let ink = Ink::measure(&drawn, width)?;
    let is_asked = options.figure == FigureRule::Lines;
    if !is_asked && !is_line_drawing(ink.line_width, ink.diagonal, 1.0) {
        return None;
    }
    let lines = enclose(coverage, &drawn, width, &ink, options);
    (is_asked || lines.is_line_drawing(&ink)).then(|| Found {
        kind: FigureKind::Lines,
        coverage: filled(&lines.coverage, &lines.outside, width, options.threshold as f32),
        kept: None,
        notes: lines.notes(),
    })
}

/// The figure on paper, or on a page that was photographed with what it lies on.
fn on_paper(
    image: &RgbaImage,
    region: Option<&[bool]>,
    fidelity: Fidelity,
    options: &BitmapOptions,
) -> Result<Found, InputError> {
    let (found, inside) = on_background(image, region, fidelity, options)?;
    if region.is_some() {
        return Ok(found);
    }
    let width = image.width() as usize;
    let surroundings = found.kept.as_ref().map_or(1.0, |(paper, _)| paper.lightness());
    if let Some(page) = page(&inside, width)
        && let Ok((on_page, drawn)) = on_background(image, Some(&page), fidelity, options)
        && on_page
            .kept
            .as_ref()
            .is_some_and(|(paper, _)| paper.lightness() > surroundings)
        && ON_PAGE.contains(&(count(&drawn) / count(&page)))
    {
        let mut on_page = on_page;
        on_page.notes.insert(0, InputNote::PageTaken);
        return Ok(on_page);
    }
    Ok(found)
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
    let largest = regions(inside, width)
        .into_iter()
        .max_by_key(|region| region.pixels.len())?;
    let area = largest.pixels.len() as f64;
    let mut mask = vec![false; inside.len()];
    for &at in &largest.pixels {
        mask[at as usize] = true;
    }
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
    let margin = (PAGE_MARGIN * width.min(inside.len() / width) as f64).ceil() as usize + 1;
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
        FigureRule::Lines => Some(enclose(&edges.coverage, &drawn, width, &ink, options)),
        _ => is_line_drawing(ink.line_width, ink.diagonal, 1.0)
            .then(|| enclose(&edges.coverage, &drawn, width, &ink, options))
            .filter(|lines| lines.is_line_drawing(&ink)),
    };
    let (kind, coverage, outside, mut notes) = match lines {
        Some(lines) => {
            let notes = lines.notes();
            (FigureKind::Lines, lines.coverage, lines.outside, notes)
        }
        None => {
            let mut outside = flood(&drawn, width, &border(width, image.height() as usize));
            let enclosed = open(&mut outside, &drawn, &contrast, width, &ink, edges.radius);
            let note = InputNote::FigurePainted { enclosed };
            (FigureKind::Painted, edges.coverage.clone(), outside, vec![note])
        }
    };
    let inside: Vec<bool> = outside.iter().map(|outside| !outside).collect();
    if borders_covered(&inside, width, 0.0) == 4 {
        notes.push(InputNote::FillsCanvas);
    }
    let kept = if kind == FigureKind::Lines && options.paper == PaperRule::Clear {
        edges.coverage
    } else {
        kept(&coverage, &outside, width, edges.radius)
    };
    let found = Found {
        kind,
        coverage: filled(&coverage, &outside, width, threshold),
        kept: Some((paper, kept)),
        notes,
    };
    Ok((found, inside))
}

/// Takes away what is drawn only faintly, all by itself: grain of the paper, ringing, smudges.
fn leave_out_grain(coverage: &mut [f32], drawn: &mut [bool], contrast: &[u8], width: usize, faintest: u8) {
    let mut strengths: Vec<u8> = (0..drawn.len())
        .filter(|&at| drawn[at])
        .map(|at| contrast[at])
        .collect();
    if strengths.is_empty() {
        return;
    }
    let high = strengths.len() * 9 / 10;
    let strong = f64::from(*strengths.select_nth_unstable(high).1);
    let least = (GRAIN_SHARE * strong).max(2.0 * f64::from(faintest)).min(strong);
    for region in regions(drawn, width) {
        if region.pixels.iter().all(|&at| f64::from(contrast[at as usize]) < least) {
            for &at in &region.pixels {
                (drawn[at as usize], coverage[at as usize]) = (false, 0.0);
            }
        }
    }
}

fn drawn(coverage: &[f32], threshold: f32) -> Vec<bool> {
    coverage.iter().map(|share| *share >= threshold).collect()
}

/// What is drawn, measured.
#[derive(Debug, Clone, Copy)]
struct Ink {
    /// Its mean width, in pixels.
    line_width: f64,
    /// The diagonal of the box around all but the farthest specks, in pixels.
    diagonal: f64,
}

impl Ink {
    /// Share of the drawn pixels beyond each side of the box.
    const SPECKS: f64 = 0.002;

    fn measure(drawn: &[bool], width: usize) -> Option<Self> {
        let height = drawn.len() / width.max(1);
        let (mut in_columns, mut in_rows) = (vec![0_usize; width], vec![0_usize; height]);
        let mut sides = 0_usize;
        for (at, _) in drawn.iter().enumerate().filter(|(_, drawn)| **drawn) {
            let (x, y) = (at % width, at / width);
            in_columns[x] += 1;
            in_rows[y] += 1;
            sides += usize::from(x == 0 || !drawn[at - 1]) + usize::from(x + 1 == width || !drawn[at + 1]);
            sides += usize::from(y == 0 || !drawn[at - width]) + usize::from(y + 1 == height || !drawn[at + width]);
        }
        let area: usize = in_rows.iter().sum();
        if area == 0 {
            return None;
        }
        let extent = |counts: &[usize]| {
            let least = Self::SPECKS * area as f64;
            let reaches = |counts: &mut dyn Iterator<Item = &usize>| {
                let mut sum = 0;
                counts
                    .take_while(|count| {
                        sum += **count;
                        sum as f64 <= least
                    })
                    .count()
            };
            let (low, high) = (reaches(&mut counts.iter()), reaches(&mut counts.iter().rev()));
            (counts.len() - low - high) as f64
        };
        // Sides of pixels along a line in any direction are 4 / pi times as long as the line, on average.
        let perimeter = std::f64::consts::FRAC_PI_4 * sides as f64;
        Some(Self {
            line_width: 2.0 * area as f64 / perimeter,
            diagonal: extent(&in_columns).hypot(extent(&in_rows)),
        })
    }
}

/// What lines enclose.
struct Enclosed {
    /// With bridges drawn.
    coverage: Vec<f32>,
    outside: Vec<bool>,
    /// Share of what is not outside, or would not be if all gaps were bridged, that is not drawn.
    bare_share: f64,
    bridged: Vec<Bridge>,
    /// A gap too wide to be bridged, in pixels, and as a fraction of the diagonal.
    open: Option<(Bridge, f64)>,
}

impl Enclosed {
    fn is_line_drawing(&self, ink: &Ink) -> bool {
        is_line_drawing(ink.line_width, ink.diagonal, self.bare_share)
    }

    fn notes(&self) -> Vec<InputNote> {
        let place = |bridge: &Bridge| {
            let middle = |k: usize| 0.5 * f64::from(bridge.from[k] + bridge.to[k]) + 0.5;
            Point::new(middle(0), middle(1))
        };
        let mut notes = vec![InputNote::FigureOfLines {
            bridged: self.bridged.len(),
        }];
        notes.extend(self.open.iter().map(|(bridge, gap)| InputNote::LineOpen {
            place: place(bridge),
            width: f64::from(bridge.length()),
            gap: *gap,
        }));
        notes
    }
}

/// The inside of lines, gaps bridged.
fn enclose(coverage: &[f32], drawn: &[bool], width: usize, ink: &Ink, options: &BitmapOptions) -> Enclosed {
    let with = |gap: f64| {
        let found = find_bridges(drawn, width, ink, gap);
        let mut coverage = coverage.to_vec();
        for bridge in &found {
            draw(bridge, ink.line_width as f32, &mut coverage, width);
        }
        let bridged = self::drawn(&coverage, options.threshold as f32);
        let outside = flood(&bridged, width, &outer_border(&bridged, width));
        (found, coverage, outside)
    };
    let (bridged, drawn_over, outside) = with(options.gap);
    let inside = outside.iter().filter(|outside| !**outside).count();
    let bare = (0..outside.len()).filter(|&at| !outside[at] && !drawn[at]).count();
    let (mut open, mut bare_share) = (None, bare as f64 / inside.max(1) as f64);
    let is_thin = is_line_drawing(ink.line_width, ink.diagonal, 1.0);
    if is_thin {
        let (wide, _, outside) = with(NAMED_GAP * options.gap);
        let more = outside.iter().filter(|outside| !**outside).count();
        if more as f64 > NAMED_GROWTH * inside as f64 {
            let widest = wide.into_iter().max_by(|a, b| a.length().total_cmp(&b.length()));
            let bare = (0..outside.len()).filter(|&at| !outside[at] && !drawn[at]).count();
            // A line drawing whose outline is open is one nevertheless.
            bare_share = bare_share.max(bare as f64 / more.max(1) as f64);
            open = widest.map(|bridge| (bridge, f64::from(bridge.length()) / ink.diagonal));
        }
    }
    Enclosed {
        coverage: drawn_over,
        outside,
        bare_share,
        bridged,
        open,
    }
}

/// The bridges over gaps of at most the fraction `gap` of the diagonal, in full-size pixels.
fn find_bridges(drawn: &[bool], width: usize, ink: &Ink, gap: f64) -> Vec<Bridge> {
    let height = drawn.len() / width.max(1);
    let scale = width.max(height).div_ceil(GAP_SIDE).max(1);
    let (small_width, small_height) = (width.div_ceil(scale), height.div_ceil(scale));
    let mut small = vec![false; small_width * small_height];
    for (at, _) in drawn.iter().enumerate().filter(|(_, drawn)| **drawn) {
        small[at / width / scale * small_width + at % width / scale] = true;
    }
    let factor = scale as f32;
    let found = bridges(
        &small,
        small_width,
        (gap * ink.diagonal) as f32 / factor,
        ink.line_width as f32 / factor,
        &outer_border(&small, small_width),
    );
    let full = |place: [f32; 2]| place.map(|c| (c + 0.5) * factor - 0.5);
    let widened = |bridge: Bridge| Bridge {
        from: full(bridge.from),
        to: full(bridge.to),
    };
    found.into_iter().map(widened).collect()
}

/// Draws a bridge as a line.
fn draw(bridge: &Bridge, line_width: f32, coverage: &mut [f32], width: usize) {
    let height = coverage.len() / width.max(1);
    let half = 0.5 * line_width.max(1.5);
    let range = |a: f32, b: f32, most: usize| {
        let low = (a.min(b) - half - 1.0).floor().max(0.0) as usize;
        low..((a.max(b) + half + 2.0).ceil().max(0.0) as usize).min(most)
    };
    for y in range(bridge.from[1], bridge.to[1], height) {
        for x in range(bridge.from[0], bridge.to[0], width) {
            let share = (half + 0.5 - bridge.distance(x as f32, y as f32)).clamp(0.0, 1.0);
            let at = &mut coverage[y * width + x];
            *at = at.max(share);
        }
    }
}

/// Opens a painted figure where its background shows through, by marking that as outside. Returns how many places that look like the
/// background stay part of the figure.
fn open(outside: &mut [bool], drawn: &[bool], contrast: &[u8], width: usize, ink: &Ink, radius: usize) -> usize {
    let enclosed: Vec<bool> = outside
        .iter()
        .zip(drawn)
        .map(|(outside, drawn)| !outside && !drawn)
        .collect();
    let area = outside.iter().filter(|outside| !**outside).count() as f64;
    let mut kept = 0;
    for region in regions(&enclosed, width) {
        // What shows is not a picture in itself: eyes have pupils.
        let is_large = region.pixels.len() as f64 >= LEAST_OPENING * area;
        if is_large
            && !region.has_island(drawn, width)
            && !is_framed(&region.pixels, &enclosed, outside, contrast, width, ink, radius)
        {
            for &at in &region.pixels {
                outside[at as usize] = true;
            }
        } else if region.pixels.len() > (2 * radius + 1).pow(2) {
            kept += 1;
        }
    }
    kept
}

/// Whether a line runs around a region: what is drawn close to it differs from what is drawn a little farther; or whether it reaches
/// the outer line, as white stripes and shirts do: the outside is close to a part of its rim.
fn is_framed(
    region: &[u32],
    enclosed: &[bool],
    outside: &[bool],
    contrast: &[u8],
    width: usize,
    ink: &Ink,
    radius: usize,
) -> bool {
    let height = contrast.len() / width;
    let near = (radius + 1) as isize;
    let far = near + (WIDEST_FRAME * ink.diagonal).ceil() as isize;
    let (mut strong, mut beyond, mut sampled, mut by_outside) = (0.0, 0.0, 0_usize, 0_usize);
    for &at in region {
        let (x, y) = ((at as usize % width) as isize, (at as usize / width) as isize);
        for (dx, dy) in [(1, 0), (-1, 0), (0, 1), (0, -1)] {
            let pixel = |steps: isize| {
                let (x, y) = (x + dx * steps, y + dy * steps);
                (x >= 0 && y >= 0 && (x as usize) < width && (y as usize) < height)
                    .then(|| y as usize * width + x as usize)
            };
            // Only from the rim, outwards.
            let (Some(beside), Some(end)) = (pixel(1), pixel(far)) else {
                continue;
            };
            if enclosed[beside] {
                continue;
            }
            let peak = (1..=near).filter_map(pixel).map(|at| contrast[at]).max().unwrap_or(0);
            strong += f64::from(peak);
            beyond += f64::from(contrast[end]);
            by_outside += usize::from((1..=far).filter_map(pixel).any(|at| outside[at]));
            sampled += 1;
        }
    }
    strong > LINE_CONTRAST * beyond || by_outside as f64 > LEAST_SHARED_RIM * sampled as f64
}

/// The field whose iso-line is the outline: inside everything counts, and only its rim keeps the coverage of its edge.
fn filled(coverage: &[f32], outside: &[bool], width: usize, threshold: f32) -> Vec<f32> {
    (0..coverage.len())
        .into_par_iter()
        .with_min_len(1 << 14)
        .map(|at| {
            if outside[at] {
                coverage[at].min(threshold)
            } else if neighbours(at, width, coverage.len()).any(|other| outside[other]) {
                coverage[at].max(threshold)
            } else {
                1.0
            }
        })
        .collect()
}

/// How much of each pixel's colour belongs to the figure: outside its coverage; inside all of it, but for the flank of the edge, where
/// the paper shines through, followed inwards as long as coverage rises.
fn kept(coverage: &[f32], outside: &[bool], width: usize, radius: usize) -> Vec<f32> {
    let mut kept: Vec<f32> = coverage
        .iter()
        .zip(outside)
        .map(|(share, outside)| if *outside { *share } else { 1.0 })
        .collect();
    let is_rim = |at: usize| !outside[at] && neighbours(at, width, outside.len()).any(|other| outside[other]);
    let mut rim: Vec<usize> = (0..outside.len()).into_par_iter().filter(|&at| is_rim(at)).collect();
    let mut done: Vec<bool> = outside.to_vec();
    for _ in 0..=radius {
        for &at in &rim {
            kept[at] = coverage[at];
            done[at] = true;
        }
        let mut next = Vec::new();
        for &at in &rim {
            for other in neighbours(at, width, outside.len()) {
                if !done[other] && coverage[other] < 1.0 && coverage[other] >= coverage[at] {
                    done[other] = true;
                    next.push(other);
                }
            }
        }
        rim = next;
    }
    kept
}

#[cfg(test)]
mod tests;
