//! What the examples that draw share: a white sheet to draw and paste on.

use inbetween::math::Point;
use inbetween::render::Frame;
use tiny_skia::{Color, FillRule, Paint, Path as Curve, PathBuilder, Pixmap, PixmapPaint, Stroke, Transform};

/// A white sheet.
pub(crate) struct Sheet {
    pub(crate) pixels: Pixmap,
}

impl Sheet {
    /// A sheet of this many columns and rows of pixels.
    pub(crate) fn new([columns, rows]: [u32; 2]) -> Result<Self, String> {
        let mut pixels = Pixmap::new(columns, rows).ok_or("an empty sheet")?;
        pixels.fill(Color::WHITE);
        Ok(Self { pixels })
    }

    pub(crate) fn line(&mut self, curve: &Option<Curve>, width: f32, colour: Color) {
        let stroke = Stroke {
            line_cap: tiny_skia::LineCap::Round,
            width,
            ..Stroke::default()
        };
        if let Some(curve) = curve {
            self.pixels
                .stroke_path(curve, &paint(colour), &stroke, Transform::identity(), None);
        }
    }

    pub(crate) fn fill(&mut self, curve: &Option<Curve>, colour: Color) {
        if let Some(curve) = curve {
            self.pixels
                .fill_path(curve, &paint(colour), FillRule::Winding, Transform::identity(), None);
        }
    }

    pub(crate) fn dot(&mut self, centre: Point, radius: f32, colour: Color) {
        let circle = |r: f32| PathBuilder::from_circle(centre.x as f32, centre.y as f32, r);
        self.fill(&circle(radius + 0.8), Color::WHITE);
        self.fill(&circle(radius), colour);
    }

    /// Puts a frame with its upper left corner at `corner`.
    pub(crate) fn paste(&mut self, corner: [u32; 2], frame: &Frame) -> Result<(), String> {
        let mut pixels = Pixmap::new(frame.width as u32, frame.height as u32).ok_or("an empty frame")?;
        for (to, from) in pixels.data_mut().chunks_exact_mut(4).zip(&frame.pixels) {
            to.copy_from_slice(from);
        }
        let [left, top] = corner.map(|pixels| pixels as i32);
        let paint = PixmapPaint::default();
        self.pixels
            .draw_pixmap(left, top, pixels.as_ref(), &paint, Transform::identity(), None);
        Ok(())
    }

    /// What is on the sheet.
    pub(crate) fn into_frame(self) -> Frame {
        Frame {
            width: self.pixels.width() as usize,
            height: self.pixels.height() as usize,
            pixels: self
                .pixels
                .data()
                .chunks_exact(4)
                .map(|p| [p[0], p[1], p[2], p[3]])
                .collect(),
        }
    }
}

/// The curve through `points`, in pixels of the sheet.
pub(crate) fn outline_of(points: &[Point], closed: bool) -> Option<Curve> {
    let mut builder = PathBuilder::new();
    let (first, rest) = points.split_first()?;
    builder.move_to(first.x as f32, first.y as f32);
    for p in rest {
        builder.line_to(p.x as f32, p.y as f32);
    }
    if closed {
        builder.close();
    }
    builder.finish()
}

fn paint(colour: Color) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color(colour);
    paint
}
