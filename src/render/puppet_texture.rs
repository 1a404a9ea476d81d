//! A drawing's picture made ready for an engine that draws textured meshes.
//!
//! Picture, outline and mesh -> colours that reach beyond the edge, and the drawing's own alpha:
//! 1. Halved while it is much finer than a frame needs.
//! 2. Cut or widened to the mesh, so that every vertex lies on it.
//! 3. What is drawn apart from the outline (another part of the same file) is cleared.
//! 4. Colours divided by alpha; where there is next to none, the colour of the nearest pixel that has some. So a reader that
//!    interpolates colours and alphas apart shows no fringe.
//!
//! Differences from [`Texture`](super::Texture), which the frames of this crate are painted with: its edge is opaque, and the
//! frame's one outline cuts it. An engine has no such outline, so here the alpha is the drawing's, and in-between frames have the
//! edges of all the drawings that they show.

use super::coverage::Coverage;
use super::frame::straight;
use super::nearest_seed::{distance_squared, nearest_seeds};
use super::puppet::PuppetTexture;
use crate::input::Picture;
use crate::math::{Point, point};
use crate::outline::Outline;

/// Texels that a frame's pixel may span before the picture is halved: engines show characters larger, too.
const TEXELS_A_PIXEL: f64 = 2.5;
/// The largest side of a texture that engines are sure to take.
const MOST_TEXELS: usize = 4096;
/// Clear pixels around the mesh.
const MARGIN: i64 = 2;
/// Colours of pixels with a fainter alpha are too coarsely rounded to be divided by it.
const FAINTEST: u8 = 48;
/// How far from the outline's inside a pixel may be drawn, in pixels: the edge's anti-aliasing.
const EDGE_PX: f64 = 2.0;

impl PuppetTexture {
    /// The texture of `picture`, whose shape is `outline`, under a mesh whose vertices lie at `positions` (#vertices, in source
    /// units), for frames at `frame_scale` pixels a source unit.
    #[must_use]
    pub fn new(name: &str, picture: &Picture, outline: &Outline, positions: &[Point], frame_scale: f64) -> Self {
        let mut canvas = Canvas::under(picture, positions, frame_scale);
        canvas.clear_beyond(outline);
        canvas.texture(name, positions)
    }

    /// The texture of a picture that is cut out already, as [`Self::new`] makes it of one that is not.
    #[must_use]
    pub(crate) fn of_cut(name: &str, picture: &Picture, positions: &[Point], frame_scale: f64) -> Self {
        Canvas::under(picture, positions, frame_scale).texture(name, positions)
    }
}

/// A premultiplied picture.
struct Canvas {
    width: usize,
    height: usize,
    pixels: Vec<[u8; 4]>,
    origin: Point,
    pixels_per_unit: f64,
}

impl Canvas {
    /// A picture under a mesh (steps 1 and 2).
    fn under(picture: &Picture, positions: &[Point], frame_scale: f64) -> Self {
        let mut canvas = Self::of(picture);
        while canvas.pixels_per_unit > TEXELS_A_PIXEL * frame_scale || canvas.span(positions) > MOST_TEXELS as f64 {
            if canvas.width.max(canvas.height) == 1 {
                break;
            }
            canvas = canvas.halved();
        }
        canvas.fitted(positions)
    }

    fn texture(&self, name: &str, positions: &[Point]) -> PuppetTexture {
        PuppetTexture {
            name: name.to_owned(),
            width: self.width,
            height: self.height,
            pixels: self.straight(),
            places: positions.iter().map(|p| self.place(*p)).collect(),
        }
    }

    fn of(picture: &Picture) -> Self {
        let (width, height) = (picture.width.max(1), picture.height.max(1));
        let mut pixels = picture.pixels.clone();
        pixels.resize(width * height, [0; 4]);
        Self {
            width,
            height,
            pixels,
            origin: picture.origin,
            pixels_per_unit: picture.pixels_per_unit,
        }
    }

    fn place(&self, p: Point) -> Point {
        (p - self.origin) * self.pixels_per_unit
    }

    /// The longer side of the mesh, in pixels.
    fn span(&self, positions: &[Point]) -> f64 {
        let (low, high) = point::bounding_box(positions).unwrap_or_default();
        (high - low).max() * self.pixels_per_unit + 2.0 * MARGIN as f64 + 2.0
    }

    /// The pixel, clear outside the picture.
    fn pixel(&self, x: i64, y: i64) -> [u8; 4] {
        match (usize::try_from(x), usize::try_from(y)) {
            (Ok(x), Ok(y)) if x < self.width && y < self.height => self.pixels[y * self.width + x],
            _ => [0; 4],
        }
    }

    fn halved(&self) -> Self {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let quarter = |x: usize, y: usize| {
            let (x, y) = (2 * x as i64, 2 * y as i64);
            let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| self.pixel(x + dx, y + dy));
            std::array::from_fn(|c| ((four.iter().map(|p| u32::from(p[c])).sum::<u32>() + 2) / 4) as u8)
        };
        Self {
            width,
            height,
            pixels: (0..width * height).map(|i| quarter(i % width, i / width)).collect(),
            origin: self.origin,
            pixels_per_unit: self.pixels_per_unit * 0.5,
        }
    }

    fn fitted(&self, positions: &[Point]) -> Self {
        let Some((low, high)) = point::bounding_box(positions) else {
            return Self {
                pixels: self.pixels.clone(),
                ..*self
            };
        };
        let corner = |p: Point, round: fn(f64) -> f64| self.place(p).map(|c| round(c) as i64);
        let (low, high) = (corner(low, f64::floor), corner(high, f64::ceil));
        let (left, top) = (low.x - MARGIN, low.y - MARGIN);
        let side = |from: i64, to: i64| (to - from + 2 * MARGIN).clamp(1, MOST_TEXELS as i64) as usize;
        let (width, height) = (side(low.x, high.x), side(low.y, high.y));
        let pixel = |i: usize| self.pixel(left + (i % width) as i64, top + (i / width) as i64);
        Self {
            width,
            height,
            pixels: (0..width * height).map(pixel).collect(),
            origin: self.origin + Point::new(left as f64, top as f64) / self.pixels_per_unit,
            pixels_per_unit: self.pixels_per_unit,
        }
    }

    fn clear_beyond(&mut self, outline: &Outline) {
        let coverage = Coverage::of_outline(outline, |p| self.place(p), self.width, self.height);
        let Some(nearest) = nearest_seeds(self.width, self.height, |i| coverage.areas()[i] > 0.0) else {
            return;
        };
        for (i, seed) in nearest.iter().enumerate() {
            if distance_squared(i, *seed, self.width) > EDGE_PX * EDGE_PX {
                self.pixels[i] = [0; 4];
            }
        }
    }

    fn straight(&self) -> Vec<[u8; 4]> {
        let faintest = self.pixels.iter().map(|p| p[3]).max().unwrap_or(0).min(FAINTEST);
        let nearest = nearest_seeds(self.width, self.height, |i| {
            faintest > 0 && self.pixels[i][3] >= faintest
        });
        let Some(nearest) = nearest else {
            return self.pixels.iter().map(|p| straight(*p)).collect();
        };
        let coloured = |(pixel, seed): (&[u8; 4], &u32)| {
            let [r, g, b, _] = straight(self.pixels[*seed as usize]);
            [r, g, b, pixel[3]]
        };
        self.pixels.iter().zip(&nearest).map(coloured).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outline::Ring;

    /// A red square from (8, 8) to (24, 24) with a half-covered edge at the left, and a loose green pixel.
    fn square(pixels_per_unit: f64) -> (Picture, Outline, Vec<Point>) {
        let mut pixels = vec![[0; 4]; 40 * 32];
        for y in 8..24 {
            for x in 8..24 {
                pixels[y * 40 + x] = if x == 8 { [100, 0, 0, 128] } else { [200, 0, 0, 255] };
            }
        }
        pixels[3 * 40 + 36] = [0, 255, 0, 255];
        let picture = Picture {
            width: 40,
            height: 32,
            pixels,
            origin: Point::new(-1.0, 2.0),
            pixels_per_unit,
        };
        let place = |x: f64, y: f64| picture.origin + Point::new(x, y) / pixels_per_unit;
        let corners = [place(8.5, 8.0), place(24.0, 8.0), place(24.0, 24.0), place(8.5, 24.0)];
        let outline = Outline::new(Ring::new(corners).expect("a ring"), vec![]).expect("simple");
        let mesh = vec![place(7.3, 7.0), place(38.0, -6.0), place(25.0, 26.0)];
        (picture, outline, mesh)
    }

    #[test]
    fn alpha_is_the_drawings_and_colours_reach_beyond_it() {
        let (picture, outline, mesh) = square(1.0);
        let texture = PuppetTexture::new("a", &picture, &outline, &mesh, 1.0);
        assert_eq!(texture.pixels.len(), texture.width * texture.height);
        let at = |x: f64, y: f64| {
            let place = (Point::new(x, y) - Point::new(7.3, 7.0)) + texture.places[0];
            texture.pixels[place.y as usize * texture.width + place.x as usize]
        };
        assert_eq!(at(12.5, 12.5), [200, 0, 0, 255]);
        assert_eq!(at(8.5, 12.5), [199, 0, 0, 128], "the edge");
        assert_eq!(at(6.5, 12.5), [199, 0, 0, 0], "beyond the edge");
        assert_eq!(at(36.5, 3.5), [200, 0, 0, 0], "what is apart");
        for place in &texture.places {
            assert!(place.x >= 1.0 && place.x <= texture.width as f64 - 1.0, "{place:?}");
            assert!(place.y >= 1.0 && place.y <= texture.height as f64 - 1.0, "{place:?}");
        }
    }

    #[test]
    fn fine_pictures_are_halved() {
        let (picture, outline, mesh) = square(8.0);
        let fine = PuppetTexture::new("a", &picture, &outline, &mesh, 4.0);
        let coarse = PuppetTexture::new("a", &picture, &outline, &mesh, 1.0);
        assert!(
            coarse.width < fine.width / 2 && coarse.width > fine.width / 6,
            "{} {}",
            coarse.width,
            fine.width
        );
        let size = |t: &PuppetTexture| (t.places[1] - t.places[0]).norm();
        assert!((size(&fine) / size(&coarse) - 4.0).abs() < 1e-9);
    }
}
