//! Words without a band, and pictures, as the contact sheet of a space needs them.

use tiny_skia::{Color, Pixmap, Transform};

use super::{Canvas, LETTER_SHARE};
use crate::math::Point;
use crate::render::Frame;
use crate::render::diagram::stroke_font;

impl Canvas {
    /// Words from their upper left corner, as they are.
    pub(in crate::render) fn words(&mut self, words: &str, [left, top]: [f64; 2], height: f64, colour: Color) {
        let middle = Point::new(left, top) + Self::text_size(words, height) * 0.5;
        self.words_along(words, middle, Point::x(), height, colour);
    }

    /// Words whose middle is at a place, as they are.
    pub(in crate::render) fn words_around(&mut self, words: &str, middle: Point, height: f64, colour: Color) {
        self.words_along(words, middle, Point::x(), height, colour);
    }

    /// Words whose middle is at a place and that run along a unit direction, as they are.
    pub(in crate::render) fn words_along(
        &mut self,
        words: &str,
        middle: Point,
        along: Point,
        height: f64,
        colour: Color,
    ) {
        let half = Self::text_size(words, height) * 0.5;
        let down = Point::new(-along.y, along.x);
        for stroke in stroke_font::strokes(words) {
            let place = |p: &Point| {
                let from_middle = p * (LETTER_SHARE * height) - half;
                middle + along * from_middle.x + down * from_middle.y
            };
            let points: Vec<Point> = stroke.iter().map(place).collect();
            self.line(&points, 0.12 * height, colour);
        }
    }

    /// Puts a picture with its upper left corner at a pixel.
    pub(in crate::render) fn paste(&mut self, picture: &Frame, [left, top]: [usize; 2]) {
        let Some(size) = tiny_skia::IntSize::from_wh(picture.width as u32, picture.height as u32) else {
            return;
        };
        let bytes = picture.pixels.as_flattened().to_vec();
        if let Some(pixmap) = Pixmap::from_vec(bytes, size) {
            let paint = tiny_skia::PixmapPaint::default();
            let (left, top) = (left as i32, top as i32);
            self.pixmap
                .draw_pixmap(left, top, pixmap.as_ref(), &paint, Transform::identity(), None);
        }
    }
}
