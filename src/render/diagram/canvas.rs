//! Lines, dots and words on a white sheet.

use tiny_skia::{Color, FillRule, LineCap, LineJoin, Paint, PathBuilder, Pixmap, Stroke, Transform};

#[cfg(feature = "scene")]
mod words;

use super::stroke_font;
use crate::math::{Point, point};
use crate::render::Frame;

/// How high letters are, as a share of their line.
const LETTER_SHARE: f64 = 0.75;

/// A white sheet to draw on.
pub(in crate::render) struct Canvas {
    pixmap: Pixmap,
}

impl Canvas {
    pub(in crate::render) fn new(width: u32, height: u32) -> Option<Self> {
        let mut pixmap = Pixmap::new(width, height)?;
        pixmap.fill(Color::WHITE);
        Some(Self { pixmap })
    }

    /// A line through points, closed if asked to be by repeating the first.
    pub(in crate::render) fn line(&mut self, points: &[Point], width: f64, colour: Color) {
        let mut builder = PathBuilder::new();
        for (k, p) in points.iter().filter(|p| point::is_finite(**p)).enumerate() {
            if k == 0 {
                builder.move_to(p.x as f32, p.y as f32);
            } else {
                builder.line_to(p.x as f32, p.y as f32);
            }
        }
        let Some(path) = builder.finish() else { return };
        let stroke = Stroke {
            width: width as f32,
            line_cap: LineCap::Round,
            line_join: LineJoin::Round,
            ..Stroke::default()
        };
        self.pixmap
            .stroke_path(&path, &paint(colour), &stroke, Transform::identity(), None);
    }

    /// A filled polygon.
    pub(in crate::render) fn fill(&mut self, points: &[Point], colour: Color) {
        let mut builder = PathBuilder::new();
        for (k, p) in points.iter().enumerate() {
            if k == 0 {
                builder.move_to(p.x as f32, p.y as f32);
            } else {
                builder.line_to(p.x as f32, p.y as f32);
            }
        }
        builder.close();
        if let Some(path) = builder.finish() {
            self.pixmap
                .fill_path(&path, &paint(colour), FillRule::Winding, Transform::identity(), None);
        }
    }

    /// A dot with a thin white rim.
    pub(in crate::render) fn dot(&mut self, centre: Point, radius: f64, colour: Color) {
        for (r, c) in [(radius + 1.0, Color::WHITE), (radius, colour)] {
            if let Some(path) = PathBuilder::from_circle(centre.x as f32, centre.y as f32, r as f32) {
                self.pixmap
                    .fill_path(&path, &paint(c), FillRule::Winding, Transform::identity(), None);
            }
        }
    }

    /// A circle.
    pub(super) fn circle(&mut self, centre: Point, radius: f64, width: f64, colour: Color) {
        const CORNERS: usize = 32;
        let on_circle = |k: usize| {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / CORNERS as f64).sin_cos();
            centre + Point::new(cos, sin) * radius
        };
        let points: Vec<Point> = (0..=CORNERS).map(on_circle).collect();
        self.line(&points, width, colour);
    }

    /// A square with a thin white rim.
    pub(super) fn square(&mut self, centre: Point, half: f64, colour: Color) {
        for (h, c) in [(half + 1.0, Color::WHITE), (half, colour)] {
            let corners = [[-h, -h], [h, -h], [h, h], [-h, h]].map(|d| centre + Point::from(d));
            self.fill(&corners, c);
        }
    }

    /// One pixel, which must be on the sheet.
    pub(super) fn pixel(&mut self, x: u32, y: u32, colour: Color) {
        let index = (y * self.pixmap.width() + x) as usize;
        if let Some(pixel) = self.pixmap.pixels_mut().get_mut(index) {
            *pixel = colour.premultiply().to_color_u8();
        }
    }

    /// Words, from their upper left corner, on a white band.
    pub(super) fn text(&mut self, words: &str, [left, top]: [f64; 2], height: f64, colour: Color) {
        for (band, line_width) in [(true, 0.35), (false, 0.13)] {
            for stroke in stroke_font::strokes(words) {
                let points: Vec<Point> = stroke
                    .iter()
                    .map(|p| Point::new(left, top) + p * (LETTER_SHARE * height))
                    .collect();
                let ink = if band { Color::WHITE } else { colour };
                self.line(&points, line_width * height, ink);
            }
        }
    }

    /// How wide and high [`Self::text`] of some height is, in pixels.
    pub(in crate::render) fn text_size(words: &str, height: f64) -> Point {
        stroke_font::size(words) * (LETTER_SHARE * height)
    }

    /// Words whose middle is at a place.
    pub(super) fn text_around(&mut self, words: &str, middle: Point, height: f64, colour: Color) {
        let corner = middle - Self::text_size(words, height) * 0.5;
        self.text(words, [corner.x, corner.y], height, colour);
    }

    pub(in crate::render) fn into_frame(self) -> Frame {
        Frame {
            width: self.pixmap.width() as usize,
            height: self.pixmap.height() as usize,
            pixels: self
                .pixmap
                .pixels()
                .iter()
                .map(|p| [p.red(), p.green(), p.blue(), p.alpha()])
                .collect(),
        }
    }
}

fn paint(colour: Color) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color(colour);
    paint.anti_alias = true;
    paint
}

/// Where points go so that a shape fills a square cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fit {
    scale: f64,
    shift: Point,
}

impl Fit {
    /// Fits `points` into the cell at `corner`, with a tenth of it left free.
    pub(super) fn new(points: &[Point], corner: [f64; 2], cell: f64) -> Self {
        let (low, high) = point::bounding_box(points).unwrap_or_default();
        let extent = (high - low).max().max(f64::MIN_POSITIVE);
        let scale = 0.9 * cell / extent;
        Self {
            scale,
            shift: Point::from(corner) + Point::repeat(0.5 * cell) - (low + high) * (0.5 * scale),
        }
    }

    pub(super) fn place(&self, p: Point) -> Point {
        p * self.scale + self.shift
    }
}
