//! A pose's picture made ready to be warped.
//!
//! Picture and outline -> a picture of colours without edges:
//! 1. Shrunk, each texel the mean of what it covers, if it is much finer than a frame's samples: one bilinear look-up a
//!    sample then misses nothing and does not alias.
//! 2. In a thin band inside the outline, where alpha is the anti-aliased edge of the drawing, colours are divided by
//!    it: the edge becomes as opaque as the drawing behind it.
//! 3. Every pixel outside takes the nearest colour inside.
//! 4. Halved a few times more, for frames that show the drawing smaller than it was made for.
//!
//! So wherever a frame's outline lies near the pose's own, the texture gives the drawing's colour at full strength,
//! and no fringe of paper or transparency shows. Transparency further inside (glass, holes that are filled) is kept.
//!
//! Limits: what is translucent within the band is taken to be as opaque as the most opaque pixel near it. A frame takes
//! one of the halvings for all of a texture: a part alone that shrinks to less than half its size may alias.

use super::coverage::Coverage;
use super::level::{Level, MOST_TEXELS};
use super::nearest_seed::{distance_squared, nearest_seeds};
use super::nearest_texel::centres_inside;
use crate::input::Picture;
use crate::math::Point;
use crate::outline::{Outline, Ring};

/// The width of the band in which alpha is taken to be the drawing's edge, in pixels of the picture: anti-aliasing is
/// one to two pixels wide, a scaled or compressed drawing's edge a little more.
const BAND_PX: f64 = 2.5;
/// A pixel at the edge gives its colour if its alpha is at least this fraction of the alpha behind it; colours of
/// fainter pixels are too coarsely rounded.
const FAINTEST: f32 = 0.4;
/// How far behind the edge the drawing's own alpha is looked for, in pixels.
const BEHIND_PX: usize = 4;
/// Texels a sample may span: beyond, single bilinear look-ups begin to skip texels.
const MOST_TEXELS_A_SAMPLE: f64 = 1.9;
/// Texels a sample spans after shrinking: fine enough that a shift or turn against the frame's grid blurs little.
const TEXELS_A_SAMPLE: f64 = 1.4;
/// How much smaller than meant a drawing may be shown before a halved texture is taken: shapes that breathe a little
/// should not change sharpness with it.
const SLACK: f64 = 1.2;
/// How often a texture is halved for frames that show it small.
const HALVINGS: usize = 4;

/// A premultiplied picture whose colours reach beyond its outline, sampled in source units.
#[derive(Clone)]
pub struct Texture {
    /// Each half as wide and high as the one before.
    levels: Vec<Level>,
    origin: Point,
    pixels_per_unit: f64,
    /// Of a texture for nearest texels, which of them lie inside the outline, row by row; otherwise empty.
    inside: Vec<bool>,
}

impl std::fmt::Debug for Texture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Texture")
            .field("width", &self.levels[0].width())
            .field("height", &self.levels[0].height())
            .finish_non_exhaustive()
    }
}

impl Texture {
    /// The texture of `picture`, whose shape is `outline`, for frames with `samples_per_unit` samples a source unit:
    /// the camera's scale, times [`PaintOptions::supersample`](super::PaintOptions::supersample).
    #[must_use]
    pub fn new(picture: &Picture, outline: &Outline, samples_per_unit: f64) -> Self {
        let rings: Vec<&[Point]> = outline.rings().iter().map(Ring::points).collect();
        Self::within(picture, &rings, samples_per_unit)
    }

    /// The texture of `picture`, as of [`Self::new`], whose shape is given by closed polygons that may cross one another.
    #[must_use]
    pub(super) fn within<R: AsRef<[Point]>>(picture: &Picture, rings: &[R], samples_per_unit: f64) -> Self {
        let mut finest = Level::new(picture.width, picture.height, picture.pixels.clone());
        let mut ratio = MOST_TEXELS as f64 / finest.width().max(finest.height()) as f64;
        let fineness = picture.pixels_per_unit / samples_per_unit;
        if fineness > MOST_TEXELS_A_SAMPLE {
            ratio = ratio.min(TEXELS_A_SAMPLE / fineness);
        }
        let mut pixels_per_unit = picture.pixels_per_unit;
        if ratio < 1.0 {
            finest = finest.shrunk(ratio);
            pixels_per_unit *= ratio;
        }
        let mut texture = Self {
            levels: vec![finest],
            origin: picture.origin,
            pixels_per_unit,
            inside: Vec::new(),
        };
        texture.bleed(rings);
        for _ in 0..HALVINGS {
            let last = &texture.levels[texture.levels.len() - 1];
            if last.width().min(last.height()) <= 2 {
                break;
            }
            let half = last.shrunk(0.5);
            texture.levels.push(half);
        }
        texture
    }

    /// The texture of `picture`, whose shape is `outline`, for frames that show nearest texels: the picture's own pixels inside the
    /// outline, outside the nearest of them.
    #[must_use]
    pub fn for_nearest(picture: &Picture, outline: &Outline) -> Self {
        let mut texture = Self {
            levels: vec![Level::new(picture.width, picture.height, picture.pixels.clone())],
            origin: picture.origin,
            pixels_per_unit: picture.pixels_per_unit,
            inside: Vec::new(),
        };
        let [width, height] = texture.size();
        let place = |ring: &Ring| -> Vec<Point> { ring.points().iter().map(|p| texture.to_texels(*p)).collect() };
        let rings: Vec<Vec<Point>> = outline.rings().iter().map(place).collect();
        let mut inside = vec![false; width * height];
        for (row, inside) in inside.chunks_exact_mut(width).enumerate() {
            for columns in centres_inside(&rings, row, width) {
                inside[columns].fill(true);
            }
        }
        if let Some(nearest) = nearest_seeds(width, height, |i| inside[i]) {
            let texels = texture.levels[0].texels_mut();
            for (i, seed) in nearest.iter().enumerate() {
                texels[i] = texels[*seed as usize];
            }
        }
        texture.inside = inside;
        texture
    }

    /// Of a texture for nearest texels, which of them lie inside the outline, row by row; otherwise empty.
    #[must_use]
    pub fn texels_inside(&self) -> &[bool] {
        &self.inside
    }

    /// The texel nearest to a place in texels, and whether it lies inside the outline; beyond the border it does not.
    pub(super) fn nearest(&self, place: Point) -> ([u8; 4], bool) {
        let [width, height] = self.size();
        // Casts saturate, and what is not a number becomes 0.
        let (x, y) = (place.x.floor(), place.y.floor());
        let column = (x.max(0.0) as usize).min(width - 1);
        let row = (y.max(0.0) as usize).min(height - 1);
        let is_there = x >= 0.0 && y >= 0.0 && x < width as f64 && y < height as f64;
        let texel = row * width + column;
        let is_inside = self.inside.get(texel).copied().unwrap_or(false);
        (self.levels[0].texels()[texel], is_there && is_inside)
    }

    /// Columns and rows of the finest picture.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        [self.levels[0].width(), self.levels[0].height()]
    }

    /// The place in texels, from the corner of texel (0, 0), of a place in source units.
    #[must_use]
    pub fn to_texels(&self, p: Point) -> Point {
        (p - self.origin) * self.pixels_per_unit
    }

    /// The premultiplied colour at a place in texels, each channel in 0..=255, interpolated between the centres of the
    /// four texels around it. Beyond the border the border's colour holds.
    #[must_use]
    pub fn sample(&self, u: f32, v: f32) -> [f32; 4] {
        self.levels[0].sample(u, v)
    }

    /// The picture for samples that span `texels` of its texels, and how many times smaller it is than the finest.
    pub(super) fn level_for(&self, texels: f64) -> (&Level, f64) {
        let mut smaller = 1.0;
        for level in &self.levels[..self.levels.len() - 1] {
            // Not a number is no reason to look at a coarse picture.
            if texels / smaller <= MOST_TEXELS_A_SAMPLE * SLACK || texels.is_nan() {
                return (level, smaller);
            }
            smaller *= 2.0;
        }
        (&self.levels[self.levels.len() - 1], smaller)
    }

    fn bleed<R: AsRef<[Point]>>(&mut self, rings: &[R]) {
        let place = |ring: &R| -> Vec<Point> { ring.as_ref().iter().map(|p| self.to_texels(*p)).collect() };
        let polygons: Vec<Vec<Point>> = rings.iter().map(place).collect();
        let (width, height) = (self.levels[0].width(), self.levels[0].height());
        let coverage = Coverage::of(polygons.iter().map(Vec::as_slice), width, height);
        bleed(self.levels[0].texels_mut(), width, &coverage);
    }
}

/// Lets the colours of premultiplied pixels, so many in a row, reach beyond the edge of the shape that covers them as `coverage` says, at full strength (steps 2 and 3 of the
/// [module](self)).
pub(super) fn bleed(pixels: &mut [[u8; 4]], width: usize, coverage: &Coverage) {
    let height = pixels.len().checked_div(width).unwrap_or(0);
    /// Below this a pixel is not wholly inside; above it only rounding is missing.
    const WHOLLY: f32 = 0.999;
    let inside = |i: usize| coverage.areas()[i] >= WHOLLY;
    let Some(border) = nearest_seeds(width, height, |i| !inside(i)) else {
        return;
    };
    let depth_squared = |i: usize| distance_squared(i, border[i], width);
    let original = pixels.to_vec();
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
            pixels[i] = original[i].map(|c| (f32::from(c) * gain).round().min(255.0) as u8);
        }
    }
    if let Some(nearest) = nearest_seeds(width, height, |i| coloured[i]) {
        for (i, seed) in nearest.iter().enumerate() {
            pixels[i] = pixels[*seed as usize];
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
        assert!((texture.pixels_per_unit - 0.14).abs() < 1e-12);
        assert_eq!(texture.levels[0].width(), 4);
        assert!((texture.to_texels(Point::new(12.0, 12.0)) - Point::new(1.68, 1.68)).norm() < 1e-12);
    }

    #[test]
    fn a_drawing_shown_small_is_looked_up_in_a_halved_texture() {
        let (picture, outline) = disc();
        let texture = Texture::new(&picture, &outline, 1.0);
        let expected = [
            (0.1, 24, 1.0),
            (2.0, 24, 1.0),
            (2.5, 12, 2.0),
            (5.0, 6, 4.0),
            (1e9, 2, 16.0),
            (f64::NAN, 24, 1.0),
        ];
        for (texels, width, smaller) in expected {
            let (level, found) = texture.level_for(texels);
            assert_eq!((level.width(), found), (width, smaller), "for {texels}");
        }
    }
}
