//! A pose's picture made ready to be warped.
//!
//! Picture and outline -> a picture of colours without edges:
//! 1. Halved until a texel is not much finer than a frame's sample, so that bilinear sampling does not alias.
//! 2. In a thin band inside the outline, where alpha is the anti-aliased edge of the drawing, colours are divided by
//!    it: the edge becomes as opaque as the drawing behind it.
//! 3. Every pixel outside takes the nearest colour inside.
//!
//! So wherever a frame's outline lies near the pose's own, the texture gives the drawing's colour at full strength,
//! and no fringe of paper or transparency shows. Transparency further inside (glass, holes that are filled) is kept.
//!
//! Limits: what is translucent within the band is taken to be as opaque as the most opaque pixel near it.

use super::coverage::Coverage;
use super::nearest_seed::nearest_seeds;
use crate::input::Picture;
use crate::math::Point;
use crate::outline::Outline;

/// The width of the band in which alpha is taken to be the drawing's edge, in pixels of the picture: anti-aliasing is
/// one to two pixels wide, a scaled or compressed drawing's edge a little more.
const BAND_PX: f64 = 2.5;
/// A pixel at the edge gives its colour if its alpha is at least this fraction of the alpha behind it; colours of
/// fainter pixels are too coarsely rounded.
const FAINTEST: f32 = 0.4;
/// How far behind the edge the drawing's own alpha is looked for, in pixels.
const BEHIND_PX: usize = 4;
/// Texels that a frame's pixel may span before the picture is halved: samples are half a pixel apart, and bilinear
/// sampling is good down to about 1.5 texels a sample.
const TEXELS_A_PIXEL: f64 = 3.0;

/// A premultiplied picture whose colours reach beyond its outline, sampled in source units.
#[derive(Clone)]
pub struct Texture {
    width: usize,
    height: usize,
    pixels: Vec<[u8; 4]>,
    origin: Point,
    pixels_per_unit: f64,
}

impl std::fmt::Debug for Texture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Texture")
            .field("width", &self.width)
            .field("height", &self.height)
            .finish_non_exhaustive()
    }
}

impl Texture {
    /// The texture of `picture`, whose shape is `outline`, for frames at `frame_scale` pixels a source unit.
    #[must_use]
    pub fn new(picture: &Picture, outline: &Outline, frame_scale: f64) -> Self {
        let mut texture = Self {
            width: picture.width.max(1),
            height: picture.height.max(1),
            pixels: picture.pixels.clone(),
            origin: picture.origin,
            pixels_per_unit: picture.pixels_per_unit,
        };
        texture.pixels.resize(texture.width * texture.height, [0; 4]);
        while texture.pixels_per_unit > TEXELS_A_PIXEL * frame_scale && texture.width.min(texture.height) > 1 {
            texture.halve();
        }
        texture.bleed(outline);
        texture
    }

    /// The place in texels, from the corner of texel (0, 0), of a place in source units.
    #[must_use]
    pub fn to_texels(&self, p: Point) -> Point {
        (p - self.origin) * self.pixels_per_unit
    }

    /// The premultiplied colour at a place in texels, each channel in 0..255, interpolated between the centres of the
    /// four texels around it. Beyond the border the border's colour holds.
    #[must_use]
    #[inline]
    pub fn sample(&self, u: f32, v: f32) -> [f32; 4] {
        // Written so that NaN becomes 0.
        let clamp = |t: f32, count: usize| (t - 0.5).max(0.0).min((count - 1) as f32);
        let (u, v) = (clamp(u, self.width), clamp(v, self.height));
        let (x, y) = (u as usize, v as usize);
        let (right, below) = ((x + 1).min(self.width - 1), (y + 1).min(self.height - 1));
        let (across, down) = (u - x as f32, v - y as f32);
        let upper = &self.pixels[y * self.width..(y + 1) * self.width];
        let lower = &self.pixels[below * self.width..(below + 1) * self.width];
        let (a, b, c, d) = (upper[x], upper[right], lower[x], lower[right]);
        std::array::from_fn(|k| {
            let top = f32::from(a[k]) + across * (f32::from(b[k]) - f32::from(a[k]));
            let bottom = f32::from(c[k]) + across * (f32::from(d[k]) - f32::from(c[k]));
            top + down * (bottom - top)
        })
    }

    fn halve(&mut self) {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let mut pixels = Vec::with_capacity(width * height);
        for y in 0..height {
            for x in 0..width {
                let mut sum = [0u32; 4];
                for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                    // Beyond the border nothing is drawn.
                    if 2 * x + dx < self.width && 2 * y + dy < self.height {
                        let pixel = self.pixels[(2 * y + dy) * self.width + 2 * x + dx];
                        for k in 0..4 {
                            sum[k] += u32::from(pixel[k]);
                        }
                    }
                }
                pixels.push(sum.map(|s| ((s + 2) / 4) as u8));
            }
        }
        (self.width, self.height, self.pixels) = (width, height, pixels);
        self.pixels_per_unit *= 0.5;
    }

    fn bleed(&mut self, outline: &Outline) {
        let (width, height) = (self.width, self.height);
        let rings: Vec<Vec<Point>> = outline
            .rings()
            .iter()
            .map(|ring| ring.points().iter().map(|p| self.to_texels(*p)).collect())
            .collect();
        let coverage = Coverage::of(rings.iter().map(Vec::as_slice), width, height);
        /// Below this a pixel is not wholly inside; above it only rounding is missing.
        const WHOLLY: f32 = 0.999;
        let inside = |i: usize| coverage.areas()[i] >= WHOLLY;
        let Some(border) = nearest_seeds(width, height, |i| !inside(i)) else {
            return;
        };
        let depth_squared = |i: usize| {
            let seed = border[i] as usize;
            let (dx, dy) = ((i % width).abs_diff(seed % width), (i / width).abs_diff(seed / width));
            (dx * dx + dy * dy) as f64
        };
        let original = self.pixels.clone();
        let mut coloured = vec![false; original.len()];
        for i in 0..original.len() {
            if inside(i) && depth_squared(i) > BAND_PX * BAND_PX {
                coloured[i] = true;
                continue;
            }
            // Half covered pixels are kept as seeds, too: thin lines have no others.
            if coverage.areas()[i] < 0.5 || original[i][3] == 0 {
                continue;
            }
            let behind = opacity_near(&original, width, height, i);
            let alpha = f32::from(original[i][3]);
            if alpha >= FAINTEST * behind {
                coloured[i] = true;
                let gain = behind / alpha;
                self.pixels[i] = original[i].map(|c| (f32::from(c) * gain).round().min(255.0) as u8);
            }
        }
        if let Some(nearest) = nearest_seeds(width, height, |i| coloured[i]) {
            for (i, seed) in nearest.iter().enumerate() {
                self.pixels[i] = self.pixels[*seed as usize];
            }
        }
    }
}

/// The largest alpha within [`BEHIND_PX`] of pixel `i`.
fn opacity_near(pixels: &[[u8; 4]], width: usize, height: usize, i: usize) -> f32 {
    let (x, y) = (i % width, i / width);
    let rows = y.saturating_sub(BEHIND_PX)..(y + BEHIND_PX + 1).min(height);
    let most = rows
        .flat_map(|row| {
            let columns = x.saturating_sub(BEHIND_PX)..(x + BEHIND_PX + 1).min(width);
            pixels[row * width..(row + 1) * width][columns].iter().map(|p| p[3])
        })
        .max();
    f32::from(most.unwrap_or(0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outline::Ring;

    /// A red disc of radius 8 in a picture of 24 x 24, anti-aliased, with a clear window of 2 x 2 in its middle.
    fn disc() -> (Picture, Outline) {
        let centre = Point::new(12.0, 12.0);
        let points = (0..64).map(|k| {
            let angle = f64::from(k) * std::f64::consts::TAU / 64.0;
            centre + 8.0 * Point::new(angle.cos(), angle.sin())
        });
        let outline = Outline::new(Ring::new(points).expect("a ring"), vec![]).expect("simple");
        let coverage = Coverage::of([outline.outer().points()], 24, 24);
        let mut pixels: Vec<[u8; 4]> = coverage
            .areas()
            .iter()
            .map(|a| {
                let alpha = (a * 255.0).round() as u8;
                [alpha, 0, 0, alpha]
            })
            .collect();
        for (x, y) in [(11, 11), (12, 11), (11, 12), (12, 12)] {
            pixels[y * 24 + x] = [0; 4];
        }
        let picture = Picture {
            width: 24,
            height: 24,
            pixels,
            origin: Point::zeros(),
            pixels_per_unit: 1.0,
        };
        (picture, outline)
    }

    #[test]
    fn colours_reach_beyond_the_edge_and_windows_stay_clear() {
        let (picture, outline) = disc();
        let texture = Texture::new(&picture, &outline, 1.0);
        for (u, v) in [(4.0, 12.0), (0.0, 0.0), (12.0, 20.3), (500.0, -3.0), (18.0, 12.0)] {
            assert_eq!(texture.sample(u, v), [255.0, 0.0, 0.0, 255.0], "at {u}, {v}");
        }
        assert_eq!(texture.sample(12.0, 12.0), [0.0; 4]);
    }

    #[test]
    fn samples_are_exact_at_centres_and_even_between() {
        let (mut picture, outline) = disc();
        picture.pixels[10 * 24 + 9] = [10, 20, 30, 255];
        picture.pixels[10 * 24 + 10] = [20, 40, 60, 255];
        let texture = Texture::new(&picture, &outline, 1.0);
        assert_eq!(texture.sample(9.5, 10.5), [10.0, 20.0, 30.0, 255.0]);
        assert_eq!(texture.sample(10.0, 10.5), [15.0, 30.0, 45.0, 255.0]);
    }

    #[test]
    fn a_small_frame_gets_a_small_texture() {
        let (picture, outline) = disc();
        let texture = Texture::new(&picture, &outline, 0.1);
        assert_eq!((texture.width, texture.pixels_per_unit), (6, 0.25));
        assert_eq!(texture.to_texels(Point::new(12.0, 12.0)), Point::new(3.0, 3.0));
    }
}
