//! The figure of a drawing in channels that can be compared.

use tiny_skia::{FillRule, Mask, PathBuilder, Transform};

use super::blur::{ChannelImage, LANES, Pixel};
use super::colour::Lab;
use super::ink::ink;
use crate::input::{Drawing, Picture};
use crate::math::Point;
use crate::math::point::bounding_box;
use crate::outline::Outline;

/// The side of the square with the figure's area, in figure units: that of a person or an animal whose diagonal is one.
pub(crate) const SIDE_PER_UNIT: f64 = 0.41;
/// Working pixels that span a figure unit: an eye of a hundredth is six pixels wide, and a figure costs about 60,000 pixels.
pub(crate) const PIXELS_PER_UNIT: f64 = 600.0;
/// Working pixels around the figure: what a comparison sees of the outside.
const MARGIN: f64 = 24.0;
/// Working pixels that a drawing has at most. Lines of a width that is nothing beside their length have fewer a unit.
const MOST_PIXELS: f64 = 4e6;

/// What differences in lightness (of 100) and along the colour axes (of about 60) weigh beside those of ink and coverage.
const LIGHTNESS_WEIGHT: f32 = 1.0 / 100.0;
const COLOUR_WEIGHT: f32 = 1.5 / 60.0;
/// Coverage, blurred, from which colours count fully: nearer to nothing they are a quotient of little by little.
const FULL_COVERAGE: f32 = 1.0 / 3.0;

/// A difference from the mean colour that is seen, in weighted channels, and the share of the figure that has to have it: less is dirt.
const SEEN_DIFFERENCE: f32 = 0.05;
const DRAWN_SHARE: f32 = 0.002;

/// Alpha below which a pixel has no colour.
const LEAST_ALPHA: f32 = 0.02;
/// Blur, in working pixels, and the coverage under it that is only found some three of them away from the edge.
const EDGE_BLUR_PX: f32 = 1.5;
const INSIDE_COVERAGE: f32 = 0.985;

/// A drawing's figure in working pixels.
#[derive(Debug, Clone)]
pub struct Appearance {
    /// Channels times coverage, not blurred.
    base: ChannelImage,
    /// The place of the corner of the first pixel, in source units.
    origin: Point,
    /// Working pixels a source unit.
    scale: f64,
}

impl Appearance {
    /// What `drawing` shows within its outline; holes of the outline are outside.
    #[must_use]
    pub fn new(drawing: &Drawing) -> Self {
        Self::of(&drawing.outline, &drawing.picture)
    }

    /// As [`Appearance::new`], with the openings of the outline outside, too: a ring that an arm closes has paper in it.
    #[must_use]
    pub fn opened(drawing: &Drawing) -> Self {
        Self::of(&drawing.outline.opened(), &drawing.picture)
    }

    /// What `picture` shows within `outline`.
    #[must_use]
    pub fn of(outline: &Outline, picture: &Picture) -> Self {
        let (low, high) = bounding_box(outline.outer().points()).unwrap_or_default();
        let extent = high - low;
        let side = outline.area().sqrt().max(f64::MIN_POSITIVE);
        let wanted = SIDE_PER_UNIT * PIXELS_PER_UNIT / side;
        let most = (MOST_PIXELS / (extent.x * extent.y).max(f64::MIN_POSITIVE)).sqrt();
        let scale = wanted.min(most);
        let origin = low - Point::repeat(MARGIN / scale);
        let size = |length: f64| (length * scale + 2.0 * MARGIN).ceil().max(1.0) as usize;
        let (width, height) = (size(extent.x), size(extent.y));
        let mut figure = Self {
            base: ChannelImage {
                width,
                height,
                pixels: Vec::new(),
            },
            origin,
            scale,
        };
        let coverage = figure.coverage(outline);
        figure.base.pixels = figure.channels(picture, &coverage);
        figure
    }

    /// The same figure without its colours: lines and form are left, which other colours do not change.
    #[must_use]
    pub fn without_colours(&self) -> Self {
        let mut plain = self.clone();
        for pixel in &mut plain.base.pixels {
            pixel[..3].fill(0.0);
        }
        plain
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        [self.base.width, self.base.height]
    }

    /// Working pixels a source unit.
    #[must_use]
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// A place of the source in working pixels.
    #[must_use]
    pub fn to_pixels(&self, place: Point) -> Point {
        (place - self.origin) * self.scale
    }

    /// A place in working pixels in source units.
    #[must_use]
    pub fn to_source(&self, place: Point) -> Point {
        place / self.scale + self.origin
    }

    /// Whether the middle of a pixel is in the figure; rows of columns.
    #[must_use]
    pub fn mask(&self) -> Vec<bool> {
        self.base.pixels.iter().map(|pixel| pixel[4] > 0.5).collect()
    }

    /// The level of the scale space with this standard deviation, in working pixels: colours are means over the figure alone, ink and
    /// coverage fade at its edge.
    #[must_use]
    pub fn blurred(&self, deviation_px: f32) -> ChannelImage {
        let mut image = self.base.gaussian(deviation_px);
        for pixel in &mut image.pixels {
            let coverage = pixel[4];
            let factor = (coverage / FULL_COVERAGE).min(1.0) / (coverage + 1e-4);
            for channel in &mut pixel[..3] {
                *channel *= factor;
            }
        }
        image
    }

    /// Whether anything is drawn inside the figure: whether colours differ from their mean by more than an eye would pass over.
    #[must_use]
    pub fn is_drawn(&self) -> bool {
        // Far enough from the edge that what is behind the figure does not shine through.
        let blurred = self.base.gaussian(EDGE_BLUR_PX);
        let inside = || blurred.pixels.iter().filter(|pixel| pixel[4] >= INSIDE_COVERAGE);
        let count = inside().count().max(1) as f32;
        let mut mean = [0.0; 3];
        for pixel in inside() {
            for (mean, channel) in mean.iter_mut().zip(pixel) {
                *mean += channel / count;
            }
        }
        let differs = |pixel: &&Pixel| {
            let difference: f32 = pixel
                .iter()
                .zip(mean)
                .map(|(channel, mean)| (channel - mean).abs())
                .sum();
            difference > SEEN_DIFFERENCE
        };
        inside().filter(differs).count() as f32 > DRAWN_SHARE * count
    }

    /// How much of every pixel the outline covers.
    fn coverage(&self, outline: &Outline) -> Vec<f32> {
        let count = self.base.width * self.base.height;
        let mut path = PathBuilder::new();
        for ring in std::iter::once(outline.outer()).chain(outline.holes()) {
            for (k, p) in ring.points().iter().enumerate() {
                let p = self.to_pixels(*p);
                if k == 0 {
                    path.move_to(p.x as f32, p.y as f32);
                } else {
                    path.line_to(p.x as f32, p.y as f32);
                }
            }
            path.close();
        }
        let mask = Mask::new(self.base.width as u32, self.base.height as u32);
        let (Some(path), Some(mut mask)) = (path.finish(), mask) else {
            return vec![0.0; count];
        };
        mask.fill_path(&path, FillRule::EvenOdd, true, Transform::identity());
        mask.data().iter().map(|c| f32::from(*c) / 255.0).collect()
    }

    /// The channels, weighted, times the coverage.
    fn channels(&self, picture: &Picture, coverage: &[f32]) -> Vec<Pixel> {
        let (sampler, lab) = (PictureSampler::new(picture, self.scale), Lab::new());
        let mut lightness = vec![100.0; coverage.len()];
        let mut pixels = vec![[0.0; LANES]; coverage.len()];
        for (k, (pixel, lightness)) in pixels.iter_mut().zip(&mut lightness).enumerate() {
            if coverage[k] > 0.0 {
                let (column, row) = (k % self.base.width, k / self.base.width);
                let middle = self.to_source(Point::new(column as f64 + 0.5, row as f64 + 0.5));
                let [l, a, b] = lab.of(sampler.colour(middle));
                *lightness = l;
                pixel[0] = l * LIGHTNESS_WEIGHT * coverage[k];
                pixel[1] = a * COLOUR_WEIGHT * coverage[k];
                pixel[2] = b * COLOUR_WEIGHT * coverage[k];
                pixel[4] = coverage[k];
            }
        }
        for ((pixel, ink), coverage) in pixels.iter_mut().zip(ink(&lightness, self.base.width)).zip(coverage) {
            pixel[3] = ink * coverage;
        }
        pixels
    }
}

/// Means of a picture over the area of a working pixel.
struct PictureSampler<'a> {
    picture: &'a Picture,
    /// Samples along each side of a working pixel.
    count: usize,
    /// Picture pixels a working pixel.
    step: f64,
}

impl<'a> PictureSampler<'a> {
    fn new(picture: &'a Picture, scale: f64) -> Self {
        let step = picture.pixels_per_unit / scale;
        Self {
            picture,
            count: (step.ceil().max(1.0) as usize).min(16),
            step,
        }
    }

    /// The colour of the working pixel around a place of the source, in 0..1, without what shines through; white where there is none.
    fn colour(&self, middle: Point) -> [f32; 3] {
        let centre = self.picture.to_pixels(middle);
        let mut sum = [0.0; 4];
        for j in 0..self.count {
            for i in 0..self.count {
                let aside = |k: usize| ((k as f64 + 0.5) / self.count as f64 - 0.5) * self.step;
                let sample = self.bilinear(centre + Point::new(aside(i), aside(j)));
                for (sum, sample) in sum.iter_mut().zip(sample) {
                    *sum += sample;
                }
            }
        }
        let scale = 1.0 / (255.0 * (self.count * self.count) as f32);
        let [r, g, b, alpha] = sum.map(|c| c * scale);
        if alpha < LEAST_ALPHA {
            return [1.0; 3];
        }
        [r, g, b].map(|c| (c / alpha).clamp(0.0, 1.0))
    }

    /// The picture at a place in its own pixels; clear beyond its border.
    fn bilinear(&self, p: Point) -> [f32; 4] {
        let (x, y) = (p.x - 0.5, p.y - 0.5);
        let (column, row) = (floored(x), floored(y));
        let (u, v) = ((x - column as f64) as f32, (y - row as f64) as f32);
        let mut value = [0.0; 4];
        for (i, j, weight) in [
            (0, 0, (1.0 - u) * (1.0 - v)),
            (1, 0, u * (1.0 - v)),
            (0, 1, (1.0 - u) * v),
            (1, 1, u * v),
        ] {
            // What is negative becomes larger than any picture.
            let (x, y) = (column.saturating_add(i) as usize, row.saturating_add(j) as usize);
            if x < self.picture.width && y < self.picture.height {
                let pixel = self.picture.pixels[y * self.picture.width + x];
                for (value, channel) in value.iter_mut().zip(pixel) {
                    *value += weight * f32::from(channel);
                }
            }
        }
        value
    }
}

/// The largest whole number that is not larger; `f64::floor` is a call of a function where the processor may lack the instruction.
fn floored(x: f64) -> i64 {
    let truncated = x as i64;
    truncated - i64::from(truncated as f64 > x)
}
