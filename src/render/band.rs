//! Rows of a frame, painted together.
//!
//! The spans of all triangles in these rows, ordered so that textures are read in long runs -> colours; then the edge's
//! areas -> what is left to be done where the colours and the outline disagree. [`super::painter`] has the whole.

use std::cmp::Reverse;
use std::ops::Range;

use super::affine_map::{AffineMap, TriangleFrame};
use super::colour_blend::Light;
use super::coverage::CoverageRows;
use super::level::Level;
use super::raster::{PlacedVertices, Span};
use super::reached::{Reached, nearest_reached};
use super::sampler::{Channels, LANES, NOTHING, Walk, add_colours, look_up, paint, read_ahead, rounded};
use crate::math::{Point, vectorised};
use crate::mesh::geometry;

/// Rows of pixels painted at a time. Enough that few triangles are begun twice, few enough to share them out evenly.
pub(super) const BAND_ROWS: usize = 32;
/// Columns painted at a time, of a band. The texels that a row of a few textures needs, and the row below, stay near.
const STRIP_SAMPLES: usize = 512;
/// A pixel whose covered area differs by less than this from all or nothing is wholly inside or outside: the difference
/// is rounding, or less than half a step.
const LEAST_AREA: f32 = 1.0 / 512.0;

/// A texture that counts in a frame.
pub(super) struct Shown<'a> {
    pub(super) level: &'a Level,
    /// #vertices, in texels of the finest level.
    pub(super) texels: &'a [Point],
    /// From those to texels of `level`.
    pub(super) scale: f64,
    /// Of [`WHOLE_WEIGHT`](super::sampler::WHOLE_WEIGHT).
    pub(super) weight: u32,
}

/// What all bands of a frame share.
pub(super) struct BandPainter<'a> {
    pub(super) triangles: &'a [[usize; 3]],
    /// Whether triangles may lie over one another, the later ones in front.
    pub(super) in_order: bool,
    /// In samples, from the window's corner.
    pub(super) vertices: &'a PlacedVertices,
    pub(super) shown: &'a [Shown<'a>],
    pub(super) window: &'a Window,
    /// Of the frame.
    pub(super) columns: usize,
    pub(super) samples: usize,
}

/// What is left to do in a band whose colours are painted. Places are indices of its pixels.
pub(super) struct Band {
    reached: Reached,
    /// Runs of painted pixels outside the outline.
    outside: Vec<Range<usize>>,
    /// Pixels at the edge, and how much of each is inside.
    partly: Vec<(usize, f32)>,
    /// Pixels inside that no sample reached: columns and rows of the window.
    unreached: Vec<[usize; 2]>,
}

impl BandPainter<'_> {
    /// Paints the colours of the band that begins at row `top` of the window.
    pub(super) fn band(&self, top: usize, pixels: &mut [[u8; 4]], edges: &[[Point; 2]], light: impl Light) -> Band {
        let height = pixels.len() / self.columns;
        let reached = if self.samples == 1 {
            self.paint_centres(top, pixels, light)
        } else {
            self.paint_means(top, pixels, light)
        };
        let mut coverage = CoverageRows::new(self.window.width, top..top + height);
        for [a, b] in edges {
            coverage.add_edge(*a, *b);
        }
        let mut band = Band {
            reached,
            outside: Vec::new(),
            partly: Vec::new(),
            unreached: Vec::new(),
        };
        for row in 0..height {
            let first = row * self.columns + self.window.left;
            coverage.for_each_run(row, |columns, area| {
                if area < LEAST_AREA {
                    if let Some(painted) = band.reached.extent(row, columns) {
                        band.outside.push(first + painted.start..first + painted.end);
                    }
                    return;
                }
                band.reached
                    .for_each_unreached(row, columns.clone(), |column| band.unreached.push([column, top + row]));
                if area < 1.0 - LEAST_AREA {
                    band.partly.extend(columns.map(|column| (first + column, area)));
                }
            });
        }
        band
    }

    /// One sample a pixel.
    fn paint_centres(&self, top: usize, pixels: &mut [[u8; 4]], light: impl Light) -> Reached {
        let height = pixels.len() / self.columns;
        let mut reached = Reached::new(self.window.width, height);
        self.for_each_span(top..top + height, |span, walks| {
            let row = span.row - top;
            reached.add(row, span.start..span.end);
            let start = row * self.columns + self.window.left;
            let pixels = &mut pixels[start + span.start..start + span.end];
            vectorised(
                #[inline(always)]
                || {
                    for (shown, walk) in self.shown.iter().zip(walks) {
                        read_ahead(shown.level, walk, pixels.len());
                    }
                    self.paint_span(walks, pixels, light);
                },
            );
        });
        reached
    }

    /// The mean of the samples of each pixel.
    fn paint_means(&self, top: usize, pixels: &mut [[u8; 4]], light: impl Light) -> Reached {
        let (height, width) = (pixels.len() / self.columns, self.window.width);
        let mut reached = Reached::new(width, height);
        /// The sums of a pixel's channels lose these bits, to fit 32 for the most samples.
        const LOST_BITS: u32 = 4;
        let mut means = vec![([0u32; 4], 0u32); width * height];
        let rows = top * self.samples..(top + height) * self.samples;
        self.for_each_span(rows, |span, walks| {
            let row = span.row / self.samples - top;
            let (first, last) = (span.start / self.samples, (span.end - 1) / self.samples);
            reached.add(row, first..last + 1);
            let means = &mut means[row * width..(row + 1) * width];
            for start in (span.start..span.end).step_by(LANES) {
                let sums = vectorised(
                    #[inline(always)]
                    || self.colours(walks, start - span.start, light),
                );
                for (lane, column) in (start..span.end.min(start + LANES)).enumerate() {
                    let (sum, count) = &mut means[column / self.samples];
                    for (sum, channel) in sum.iter_mut().zip(&sums) {
                        *sum += channel[lane] >> LOST_BITS;
                    }
                    *count += 1;
                }
            }
        });
        for (row, means) in means.chunks_exact(width).enumerate() {
            let start = row * self.columns + self.window.left;
            let pixels = pixels[start..start + width].chunks_mut(LANES);
            for (pixels, means) in pixels.zip(means.chunks(LANES)) {
                let mut sums: Channels = [[0; LANES]; 4];
                for (lane, (sum, count)) in means.iter().enumerate() {
                    for (channel, sum) in sums.iter_mut().zip(sum) {
                        channel[lane] = sum.checked_div(*count).unwrap_or(0) << LOST_BITS;
                    }
                }
                pixels.copy_from_slice(&light.encode(&sums)[..pixels.len()]);
            }
        }
        reached
    }

    /// Calls `paint` for each span of some rows of samples, with the walks through the textures that begin at its start:
    /// row by row and from left to right, as textures lie in memory where they are not turned.
    #[inline(always)]
    fn for_each_span(&self, rows: Range<usize>, mut paint: impl FnMut(Span, &[Walk])) {
        let mut maps: Vec<AffineMap> = Vec::new();
        // The spans, and where the maps of each one's triangle begin.
        let mut spans: Vec<(Span, usize)> = Vec::new();
        let mut mapped_triangle = usize::MAX;
        let width = self.window.width * self.samples;
        self.vertices.for_each_span(self.triangles, width, rows, |span| {
            if span.triangle != mapped_triangle {
                mapped_triangle = span.triangle;
                let triangle = self.triangles[span.triangle];
                let from = TriangleFrame::new(self.vertices.corners(triangle));
                maps.extend(
                    self.shown
                        .iter()
                        .map(|of| from.map_to(geometry::corners(of.texels, triangle).map(|p| p * of.scale))),
                );
            }
            spans.push((span, maps.len() - self.shown.len()));
        });
        if self.in_order {
            spans = foremost(spans, width);
        }
        // Spans come triangle by triangle: those at one place stay in that order.
        let order = |span: &Span| [span.start / STRIP_SAMPLES, span.row, span.start];
        spans.sort_by_key(|(span, _)| order(span).iter().fold(0, |key, part| key << 20 | *part as u64));
        let mut walks: Vec<Walk> = Vec::with_capacity(self.shown.len());
        for (span, map) in spans {
            let start = Point::new(span.start as f64 + 0.5, span.row as f64 + 0.5);
            let maps = &maps[map..map + self.shown.len()];
            walks.clear();
            walks.extend(maps.iter().map(|map| Walk::new(map.apply(start), map.along_x)));
            paint(span, &walks);
        }
    }

    /// Paints the samples of a span, one a pixel.
    #[inline(always)]
    fn paint_span<L: Light>(&self, walks: &[Walk], pixels: &mut [[u8; 4]], light: L) {
        let look = |k: usize| (self.shown[k].level, &walks[k], self.shown[k].weight);
        // A few textures side by side, which is faster; more, and other light, one after the other.
        match self.shown.len() {
            1 if L::AS_THEY_ARE => paint([look(0)], pixels),
            2 if L::AS_THEY_ARE => paint([look(0), look(1)], pixels),
            3 if L::AS_THEY_ARE => paint([look(0), look(1), look(2)], pixels),
            4 if L::AS_THEY_ARE => paint([look(0), look(1), look(2), look(3)], pixels),
            _ => {
                for (run, pixels) in pixels.chunks_mut(LANES).enumerate() {
                    let colours = self.pixels(walks, run * LANES, pixels.len(), light);
                    pixels.copy_from_slice(&colours[..pixels.len()]);
                }
            }
        }
    }

    /// The colours of `count` samples of a span, at most `LANES`, from its sample `first` on.
    #[inline(always)]
    fn pixels<L: Light>(&self, walks: &[Walk], first: usize, count: usize, light: L) -> [[u8; 4]; LANES] {
        if !L::AS_THEY_ARE {
            return light.encode(&self.colours(walks, first, light));
        }
        let mut sums = NOTHING;
        for (shown, walk) in self.shown.iter().zip(walks) {
            add_colours(shown.level, walk, first, shown.weight, &mut sums[..count]);
        }
        rounded(&sums)
    }

    /// The weighted sums of the textures at `LANES` samples of a span, from its sample `first` on.
    #[inline(always)]
    fn colours(&self, walks: &[Walk], first: usize, light: impl Light) -> Channels {
        let mut sums: Channels = [[0; LANES]; 4];
        for (shown, walk) in self.shown.iter().zip(walks) {
            let channels = light.decode(look_up(shown.level, walk, first));
            for (sum, channel) in sums.iter_mut().zip(&channels) {
                for (sum, value) in sum.iter_mut().zip(channel) {
                    *sum += value * shown.weight;
                }
            }
        }
        sums
    }
}

/// The pieces of spans that no later span lies over; what belongs to a span stays with its pieces.
fn foremost(mut spans: Vec<(Span, usize)>, width: usize) -> Vec<(Span, usize)> {
    spans.sort_by_key(|(span, _)| (span.row, Reverse(span.triangle)));
    let mut pieces = Vec::with_capacity(spans.len());
    let mut is_covered = vec![false; width];
    let mut row = usize::MAX;
    for (span, of) in spans {
        if span.row != row {
            is_covered.fill(false);
            row = span.row;
        }
        let mut start = span.start;
        while start < span.end {
            let free = is_covered[start..span.end]
                .iter()
                .take_while(|covered| !**covered)
                .count();
            if free > 0 {
                is_covered[start..start + free].fill(true);
                let end = start + free;
                pieces.push((Span { start, end, ..span }, of));
            }
            start += free;
            start += is_covered[start..span.end]
                .iter()
                .take_while(|covered| **covered)
                .count();
        }
    }
    pieces
}

impl Band {
    /// Clears what is outside and lets pixels at the edge through by what is inside.
    pub(super) fn cut_out(&self, pixels: &mut [[u8; 4]]) {
        for run in &self.outside {
            pixels[run.clone()].fill([0; 4]);
        }
        for (pixel, area) in &self.partly {
            let pixel = &mut pixels[*pixel];
            *pixel = pixel.map(|c| (f32::from(c) * area + 0.5) as u8);
        }
    }
}

/// Gives pixels inside the outline that no sample reached the nearest colour.
pub(super) fn fill_unreached(pixels: &mut [[u8; 4]], window: &Window, columns: usize, bands: &[Band]) {
    let unreached: Vec<[usize; 2]> = bands.iter().flat_map(|band| band.unreached.iter().copied()).collect();
    let is_reached = |[x, y]: [usize; 2]| bands[y / BAND_ROWS].reached.is_reached(y % BAND_ROWS, x);
    let nearest = nearest_reached(&unreached, [window.width, window.height], is_reached);
    for ([x, y], from) in unreached.iter().zip(nearest) {
        if let Some([near_x, near_y]) = from {
            pixels[y * columns + window.left + x] = pixels[near_y * columns + window.left + near_x];
        }
    }
}

/// The part of the frame that a shape touches.
pub(super) struct Window {
    pub(super) left: usize,
    pub(super) top: usize,
    pub(super) width: usize,
    pub(super) height: usize,
}

impl Window {
    pub(super) fn around<'a>(points: impl Iterator<Item = &'a Point>, columns: usize, rows: usize) -> Option<Self> {
        let (low, high) = crate::math::point::bounding_box(points.filter(|p| crate::math::point::is_finite(**p)))?;
        // Casts saturate, so a shape far outside gives an empty window.
        let left = low.x.floor().max(0.0) as usize;
        let top = low.y.floor().max(0.0) as usize;
        let width = (high.x.ceil().max(0.0) as usize).min(columns).saturating_sub(left);
        let height = (high.y.ceil().max(0.0) as usize).min(rows).saturating_sub(top);
        (width > 0 && height > 0).then_some(Self {
            left,
            top,
            width,
            height,
        })
    }
}
