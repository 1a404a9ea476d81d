//! A bitmap to draw on: flat colours over an ink line, drawn large and averaged down.
//!
//! The ink line of a group of parts is every part drawn a little fatter in ink first and in its colour afterwards, so
//! that parts which belong together get one line around them all. Averaging down keeps each pixel's alpha very close
//! to the area that the drawing covers in it.

use std::error::Error;
use std::path::Path;

use kurbo::{Affine, BezPath, PathEl, Point};
use tiny_skia::{
    BlendMode, Color, FillRule, LineJoin, Mask, Paint, PathBuilder, Pixmap, PremultipliedColorU8, Stroke, Transform,
};

/// Large pixels to one pixel of the finished picture, in each direction.
const OVERSAMPLING: u32 = 4;

/// How thin the thinnest line of a broad nib is, of its thickest.
const NIB: f64 = 0.55;

/// What a shadow leaves of the colour under it.
const SHADOW: Rgb = [0xe4, 0xc0, 0xb6];

/// An sRGB colour.
pub(crate) type Rgb = [u8; 3];

/// The picture being drawn.
#[derive(Debug)]
pub(crate) struct Canvas {
    large: Pixmap,
    width_px: u32,
    height_px: u32,
}

impl Canvas {
    /// An empty picture.
    pub(crate) fn new(width_px: u32, height_px: u32) -> Result<Self, Box<dyn Error>> {
        let large = Pixmap::new(width_px * OVERSAMPLING, height_px * OVERSAMPLING).ok_or("the picture is empty")?;
        Ok(Self {
            large,
            width_px,
            height_px,
        })
    }

    /// Fills a path.
    pub(crate) fn fill(&mut self, path: &BezPath, colour: Rgb) {
        if let Some(path) = skia(path) {
            self.large
                .fill_path(&path, &paint(colour), FillRule::Winding, enlarge(), None);
        }
    }

    /// Fills the part of a path that lies inside `window`.
    pub(crate) fn fill_inside(&mut self, path: &BezPath, window: &BezPath, colour: Rgb) {
        self.paint_inside(path, window, &paint(colour));
    }

    /// Darkens the part of a path that lies inside `window`, whatever colours are there.
    pub(crate) fn shade(&mut self, path: &BezPath, window: &BezPath) {
        let mut shadow = paint(SHADOW);
        shadow.blend_mode = BlendMode::Multiply;
        self.paint_inside(path, window, &shadow);
    }

    fn paint_inside(&mut self, path: &BezPath, window: &BezPath, paint: &Paint<'_>) {
        let (Some(path), Some(window)) = (skia(path), skia(window)) else {
            return;
        };
        let Some(mut mask) = Mask::new(self.large.width(), self.large.height()) else {
            return;
        };
        mask.fill_path(&window, FillRule::Winding, true, enlarge());
        self.large
            .fill_path(&path, paint, FillRule::Winding, enlarge(), Some(&mask));
    }

    /// Fills a path and `margin` around it: the ink under a part.
    pub(crate) fn ink(&mut self, path: &BezPath, margin: f64, colour: Rgb) {
        self.fill(path, colour);
        self.line(path, 2.0 * margin, colour);
    }

    /// Draws along a path with a round pen.
    pub(crate) fn line(&mut self, path: &BezPath, width: f64, colour: Rgb) {
        self.stroke(path, width, colour, enlarge());
    }

    /// Draws along a path with a broad nib, which is held at 45 degrees: lines that run along it are thin, lines across it are `width` wide.
    pub(crate) fn nib(&mut self, path: &BezPath, width: f64, colour: Rgb) {
        let held = Affine::rotate(-std::f64::consts::FRAC_PI_4) * Affine::scale_non_uniform(1.0, NIB);
        let round = held.inverse() * path.clone();
        let [a, b, c, d, e, f] = held.as_coeffs().map(|value| value as f32);
        let placed = enlarge().pre_concat(Transform::from_row(a, b, c, d, e, f));
        self.stroke(&round, width, colour, placed);
    }

    /// Draws along a path with a pen that is round before it is placed on the picture.
    fn stroke(&mut self, path: &BezPath, width: f64, colour: Rgb, placed: Transform) {
        let stroke = Stroke {
            width: width as f32,
            line_join: LineJoin::Round,
            line_cap: tiny_skia::LineCap::Round,
            ..Stroke::default()
        };
        if let Some(path) = skia(path) {
            self.large.stroke_path(&path, &paint(colour), &stroke, placed, None);
        }
    }

    /// How dark the drawing makes white paper there, from 0 to 1.
    pub(crate) fn darkness(&self, point: Point) -> f64 {
        let [x, y] = [point.x, point.y].map(|value| value * f64::from(OVERSAMPLING) - 0.5);
        let [left, top] = [x, y].map(f64::floor);
        let at = |column: f64, row: f64| {
            // What is left of the picture or above it becomes a pixel beyond its other side, which there is none of.
            let [column, row] = [column, row].map(|value| if value < 0.0 { u32::MAX } else { value as u32 });
            let pixel = (column < self.large.width())
                .then(|| self.large.pixel(column, row))
                .flatten();
            pixel.map_or(0.0, |pixel| f64::from(pixel.alpha() - pixel.green()) / 255.0)
        };
        let between = |a: f64, b: f64, part: f64| a + (b - a) * part;
        let upper = between(at(left, top), at(left + 1.0, top), x - left);
        let lower = between(at(left, top + 1.0), at(left + 1.0, top + 1.0), x - left);
        between(upper, lower, y - top)
    }

    /// Where the ray from `inside` through `towards` first leaves what has been drawn.
    pub(crate) fn edge(&self, inside: Point, towards: Point) -> Result<Point, Box<dyn Error>> {
        let step = (towards - inside).normalize() / f64::from(OVERSAMPLING);
        let bounds = kurbo::Rect::new(0.0, 0.0, f64::from(self.width_px), f64::from(self.height_px));
        let mut here = inside;
        while bounds.contains(here) {
            if !self.is_drawn(here) {
                return Ok(here - 0.5 * step);
            }
            here += step;
        }
        Err(format!("nothing ends between {inside} and {towards}").into())
    }

    /// Whether anything is drawn there.
    pub(crate) fn is_drawn(&self, point: Point) -> bool {
        let [column, row] = [point.x, point.y].map(|value| (value * f64::from(OVERSAMPLING)).max(0.0) as u32);
        let pixel = self.large.pixel(column, row);
        pixel.is_some_and(|pixel| pixel.alpha() >= 128)
    }

    /// Averages down and writes a PNG file.
    pub(crate) fn save(&self, file: &Path) -> Result<(), Box<dyn Error>> {
        let mut picture = Pixmap::new(self.width_px, self.height_px).ok_or("the picture is empty")?;
        let (large, large_width) = (self.large.pixels(), self.large.width());
        let samples = OVERSAMPLING * OVERSAMPLING;
        for y in 0..self.height_px {
            for x in 0..self.width_px {
                let mut sums = [0_u32; 4];
                for sample in 0..samples {
                    let (u, v) = (
                        x * OVERSAMPLING + sample % OVERSAMPLING,
                        y * OVERSAMPLING + sample / OVERSAMPLING,
                    );
                    let pixel = large[(v * large_width + u) as usize];
                    for (sum, part) in sums
                        .iter_mut()
                        .zip([pixel.red(), pixel.green(), pixel.blue(), pixel.alpha()])
                    {
                        *sum += u32::from(part);
                    }
                }
                let [red, green, blue, alpha] = sums.map(|sum| ((sum + samples / 2) / samples) as u8);
                picture.pixels_mut()[(y * self.width_px + x) as usize] =
                    PremultipliedColorU8::from_rgba(red.min(alpha), green.min(alpha), blue.min(alpha), alpha)
                        .ok_or("a colour brighter than its alpha")?;
            }
        }
        picture.save_png(file)?;
        Ok(())
    }
}

/// The same path at another place.
pub(crate) fn moved(frame: Affine, path: &BezPath) -> BezPath {
    frame * path.clone()
}

fn enlarge() -> Transform {
    Transform::from_scale(OVERSAMPLING as f32, OVERSAMPLING as f32)
}

fn paint([red, green, blue]: Rgb) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color(Color::from_rgba8(red, green, blue, 255));
    paint.anti_alias = true;
    paint
}

fn skia(path: &BezPath) -> Option<tiny_skia::Path> {
    let mut builder = PathBuilder::new();
    let f = |point: kurbo::Point| (point.x as f32, point.y as f32);
    for element in path.elements() {
        match *element {
            PathEl::MoveTo(p) => builder.move_to(f(p).0, f(p).1),
            PathEl::LineTo(p) => builder.line_to(f(p).0, f(p).1),
            PathEl::QuadTo(a, p) => builder.quad_to(f(a).0, f(a).1, f(p).0, f(p).1),
            PathEl::CurveTo(a, b, p) => builder.cubic_to(f(a).0, f(a).1, f(b).0, f(b).1, f(p).0, f(p).1),
            PathEl::ClosePath => builder.close(),
        }
    }
    builder.finish()
}
