//! Drawings in lines: how thick the lines are, and what they enclose, seen from outside, with their gaps bridged.
//!
//! Which pixels are drawn -> [`Ink`], [`Enclosed`]. Gaps (module `gaps`) are looked for on at most [`GAP_SIDE`] pixels a side. A gap too
//! wide to be bridged, but not much wider, is named with the setting that would bridge it.

use rayon::prelude::*;

use super::enclosure::{flood, outer_border};
use super::figure::is_line_drawing;
use super::gaps::{Bare, Bridge};
use super::runs::Runs;
use super::{BitmapOptions, InputNote};
use crate::math::Point;

/// How many times wider than `gap` gaps are looked for, to be named.
const NAMED_GAP: f64 = 5.0;
/// Growth of the figure by which a wider gap is named.
const NAMED_GROWTH: f64 = 1.05;
/// Work on gaps is done on at most so many pixels a side.
const GAP_SIDE: usize = 1024;

/// What is drawn, measured.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ink {
    /// Its mean width, in pixels.
    pub(super) line_width: f64,
    /// The diagonal of the box around all but the farthest specks, in pixels.
    pub(super) diagonal: f64,
}

impl Ink {
    /// Share of the drawn pixels beyond each side of the box.
    const SPECKS: f64 = 0.002;

    pub(super) fn measure(drawn: &[bool], width: usize) -> Option<Self> {
        let height = drawn.len() / width.max(1);
        let runs = Runs::of(drawn, width, |drawn| *drawn);
        let (mut in_columns, mut in_rows) = (vec![0_usize; width], vec![0_usize; height]);
        // Along a row every run has two sides, along a column every change of what is drawn is one.
        let mut sides = 2 * runs.all().len();
        for run in runs.all() {
            in_rows[run.row()] += run.len();
            for count in &mut in_columns[run.columns()] {
                *count += 1;
            }
        }
        let row = |y: Option<usize>| y.and_then(|y| drawn.get(y * width..(y + 1) * width));
        sides += (0..=height)
            .into_par_iter()
            .map(|y| match (row(y.checked_sub(1)), row(Some(y))) {
                (Some(above), Some(below)) => above.iter().zip(below).filter(|(a, b)| a != b).count(),
                (one, other) => one
                    .or(other)
                    .map_or(0, |row| row.iter().filter(|drawn| **drawn).count()),
            })
            .sum::<usize>();
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
#[derive(Debug)]
pub(super) struct Enclosed {
    /// Whether each pixel lies outside.
    pub(super) outside: Vec<bool>,
    /// Share of what is not outside, or would not be if all gaps were bridged, that is not drawn.
    bare_share: f64,
    bridged: Vec<Bridge>,
    /// The mean width of the lines, in pixels.
    line_width: f32,
    /// A gap too wide to be bridged, in pixels, and as a fraction of the diagonal.
    open: Option<(Bridge, f64)>,
}

impl Enclosed {
    /// Whether it is the figure of a line drawing.
    pub(super) fn is_line_drawing(&self, ink: &Ink) -> bool {
        is_line_drawing(ink.line_width, ink.diagonal, self.bare_share)
    }

    /// Draws the bridges into a field of coverages.
    pub(super) fn draw_bridges(&self, coverage: &mut [f32], width: usize) {
        for bridge in &self.bridged {
            for_each_pixel(bridge, self.line_width, width, coverage.len(), |at, share| {
                coverage[at] = coverage[at].max(share);
            });
        }
    }

    /// What the artist should know.
    pub(super) fn notes(&self) -> Vec<InputNote> {
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
pub(super) fn enclose(drawn: &[bool], width: usize, ink: &Ink, options: &BitmapOptions) -> Enclosed {
    let small = Reduced::of(drawn, width);
    let bare = Bare::measure(&small.drawn, small.width);
    let with = |gap: f64| {
        let found = small.bridges(&bare, ink, gap);
        let mut bridged = drawn.to_vec();
        for bridge in &found {
            for_each_pixel(bridge, ink.line_width as f32, width, drawn.len(), |at, share| {
                bridged[at] |= share >= options.threshold as f32;
            });
        }
        let outside = flood(&bridged, width, &outer_border(&bridged, width));
        (found, outside)
    };
    let is_thin = is_line_drawing(ink.line_width, ink.diagonal, 1.0);
    let ((bridged, outside), wide) =
        rayon::join(|| with(options.gap), || is_thin.then(|| with(NAMED_GAP * options.gap)));
    let (inside, bare) = counted(&outside, drawn);
    let (mut open, mut bare_share) = (None, bare as f64 / inside.max(1) as f64);
    if let Some((wide, outside)) = wide {
        let (more, bare) = counted(&outside, drawn);
        if more as f64 > NAMED_GROWTH * inside as f64 {
            let widest = wide.into_iter().max_by(|a, b| a.length().total_cmp(&b.length()));
            // A line drawing whose outline is open is one nevertheless.
            bare_share = bare_share.max(bare as f64 / more.max(1) as f64);
            open = widest.map(|bridge| (bridge, f64::from(bridge.length()) / ink.diagonal));
        }
    }
    Enclosed {
        line_width: ink.line_width as f32,
        outside,
        bare_share,
        bridged,
        open,
    }
}

/// How many pixels are not outside, and how many of these are not drawn.
fn counted(outside: &[bool], drawn: &[bool]) -> (usize, usize) {
    let chunks = outside.par_chunks(1 << 16).zip(drawn.par_chunks(1 << 16));
    let counts = chunks.map(|(outside, drawn)| {
        let inside = outside.iter().filter(|outside| !**outside).count();
        let bare = outside
            .iter()
            .zip(drawn)
            .filter(|(outside, drawn)| !**outside && !**drawn);
        (inside, bare.count())
    });
    counts.reduce(|| (0, 0), |a, b| (a.0 + b.0, a.1 + b.1))
}

/// A mask made smaller by a whole number: what is drawn anywhere in a pixel's square is drawn.
struct Reduced {
    drawn: Vec<bool>,
    width: usize,
    /// Full-size pixels to one of it, along each side.
    scale: usize,
}

impl Reduced {
    fn of(drawn: &[bool], width: usize) -> Self {
        let height = drawn.len() / width.max(1);
        let scale = width.max(height).div_ceil(GAP_SIDE).max(1);
        let (small_width, small_height) = (width.div_ceil(scale), height.div_ceil(scale));
        let mut small = vec![false; small_width * small_height];
        for (y, row) in drawn.chunks_exact(width.max(1)).enumerate() {
            let small_row = &mut small[y / scale * small_width..][..small_width];
            for (small, pixels) in small_row.iter_mut().zip(row.chunks(scale)) {
                *small |= pixels.contains(&true);
            }
        }
        Self {
            drawn: small,
            width: small_width,
            scale,
        }
    }

    /// The bridges over gaps of at most the fraction `gap` of the diagonal, in full-size pixels.
    fn bridges(&self, bare: &Bare<'_>, ink: &Ink, gap: f64) -> Vec<Bridge> {
        let factor = self.scale as f32;
        let found = bare.bridges(
            (gap * ink.diagonal) as f32 / factor,
            ink.line_width as f32 / factor,
            &outer_border(&self.drawn, self.width),
        );
        let full = |place: [f32; 2]| place.map(|c| (c + 0.5) * factor - 0.5);
        let widened = |bridge: Bridge| Bridge {
            from: full(bridge.from),
            to: full(bridge.to),
        };
        found.into_iter().map(widened).collect()
    }
}

/// Calls `found` for the pixels of a bridge that is drawn as a line, with how much of each it covers.
fn for_each_pixel(bridge: &Bridge, line_width: f32, width: usize, count: usize, mut found: impl FnMut(usize, f32)) {
    let height = count / width.max(1);
    let half = 0.5 * line_width.max(1.5);
    let range = |a: f32, b: f32, most: usize| {
        let low = (a.min(b) - half - 1.0).floor().max(0.0) as usize;
        low..((a.max(b) + half + 2.0).ceil().max(0.0) as usize).min(most)
    };
    for y in range(bridge.from[1], bridge.to[1], height) {
        for x in range(bridge.from[0], bridge.to[0], width) {
            let share = (half + 0.5 - bridge.distance(x as f32, y as f32)).clamp(0.0, 1.0);
            if share > 0.0 {
                found(y * width + x, share);
            }
        }
    }
}
