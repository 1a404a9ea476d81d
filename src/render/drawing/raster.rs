//! Pixels of a [`VectorFrame`].
//!
//! 1. The frame is drawn in tiles of at most [`TILE`] pixels a side, so that neither a large frame nor supersampling asks for one
//!    huge picture (tiny-skia cannot refuse what it cannot allocate).
//! 2. In each tile, back to front: paths by tiny-skia, anti-aliased; what is translucent as a whole, or clipped, first on a layer
//!    as large as what can be seen of it.
//! 3. With more than one sample along a pixel's side, tiles are drawn that many times larger, and pixels are means.
//!
//! Left out: paths with a coordinate that is not finite or beyond [`FURTHEST`], which no pixel would show right, and subpaths
//! shrunk to a point, which a round cap would turn into a dot.

use tiny_skia::{
    BlendMode, Color, FillRule as Rule, FilterQuality, GradientStop, LinearGradient, Mask, Paint as SkiaPaint, Path,
    PathBuilder, Pixmap, PixmapPaint, Point as SkiaPoint, PremultipliedColorU8, RadialGradient, Shader, SpreadMode,
    Stroke as SkiaStroke, StrokeDash, Transform,
};

use super::super::Frame;
use super::{
    Fill, FillRule, Gradient, GradientKind, LineCap, LineJoin, Paint, Spread, Stroke, Subpath, VectorFrame,
    VectorGroup, VectorNode, VectorPicture, VectorShape,
};
use crate::math::{Point, point};

/// The longest side of a tile, in samples.
const TILE: usize = 2048;

/// The furthest coordinate that is drawn, in pixels: single precision still tells a hundredth of a pixel at a tenth of it.
const FURTHEST: f64 = 1e6;

/// A subpath smaller than this, in pixels, is a point.
const LEAST_EXTENT: f64 = 1e-6;

/// The faintest opacity that changes a pixel.
const FAINTEST: f64 = 1.0 / 512.0;

/// Dashes of a line beyond which it is drawn whole: they could not be told apart.
const MOST_DASHES: f64 = 100_000.0;

impl VectorFrame {
    /// The pixels of the frame. `samples` along a pixel's side are drawn and averaged, at least 1: paths are anti-aliased
    /// already, more shows thin lines and edges that meet more evenly.
    ///
    /// A picture smaller than the frame covers its upper left part.
    #[must_use]
    pub fn rasterise(&self, samples: usize) -> Frame {
        rasterised(self, samples)
    }
}

fn rasterised(frame: &VectorFrame, samples: usize) -> Frame {
    let samples = samples.clamp(1, TILE / 8);
    let [columns, rows] = frame.size;
    let mut drawn = Frame::filled(columns, rows, [0; 4]);
    let side = TILE / samples;
    for top in (0..rows).step_by(side) {
        for left in (0..columns).step_by(side) {
            let (width, height) = (side.min(columns - left), side.min(rows - top));
            let area = Area {
                left: (left * samples) as i64,
                top: (top * samples) as i64,
                width: width * samples,
                height: height * samples,
            };
            let Some(mut canvas) = Canvas::new(area, samples as f64) else {
                continue;
            };
            canvas.draw_all(&frame.nodes);
            canvas.average_into(&mut drawn, [left, top], [width, height], samples);
        }
    }
    if let Some(colour) = frame.background {
        drawn.put_before(colour);
    }
    drawn
}

/// A rectangle of samples.
#[derive(Debug, Clone, Copy)]
struct Area {
    left: i64,
    top: i64,
    width: usize,
    height: usize,
}

impl Area {
    /// What of it lies within a box of samples, and a border for anti-aliasing. `None` if nothing does.
    fn within(&self, low: Point, high: Point) -> Option<Self> {
        let border = 2.0;
        let left = (low.x - border).floor().max(self.left as f64);
        let top = (low.y - border).floor().max(self.top as f64);
        let right = (high.x + border).ceil().min((self.left + self.width as i64) as f64);
        let bottom = (high.y + border).ceil().min((self.top + self.height as i64) as f64);
        // Written so that NaN fails too.
        (right > left && bottom > top).then_some(Self {
            left: left as i64,
            top: top as i64,
            width: (right - left) as usize,
            height: (bottom - top) as usize,
        })
    }
}

/// A piece of the frame under construction.
struct Canvas {
    pixmap: Pixmap,
    area: Area,
    /// Samples along a pixel's side.
    scale: f64,
}

impl Canvas {
    fn new(area: Area, scale: f64) -> Option<Self> {
        Some(Self {
            pixmap: Pixmap::new(area.width as u32, area.height as u32)?,
            area,
            scale,
        })
    }

    fn draw_all(&mut self, nodes: &[VectorNode]) {
        for node in nodes {
            match node {
                VectorNode::Group(group) => self.draw_group(group),
                VectorNode::Shape(shape) => self.draw_shape(shape),
                VectorNode::Picture(picture) => self.draw_picture(picture),
            }
        }
    }

    fn draw_group(&mut self, group: &VectorGroup) {
        if !is_seen(group.opacity) {
            return;
        }
        if group.opacity >= 1.0 && group.clip.is_none() {
            return self.draw_all(&group.nodes);
        }
        let area = match &group.clip {
            Some(rings) => point::bounding_box(rings.iter().flatten())
                .and_then(|(low, high)| self.area.within(low * self.scale, high * self.scale)),
            None => Some(self.area),
        };
        let Some(mut layer) = area.and_then(|area| Self::new(area, self.scale)) else {
            return;
        };
        layer.draw_all(&group.nodes);
        if let Some(rings) = &group.clip {
            layer.cut(rings);
        }
        self.put(&layer, group.opacity);
    }

    fn draw_shape(&mut self, shape: &VectorShape) {
        if !is_seen(shape.opacity) {
            return;
        }
        let Some((low, high)) = point::bounding_box(shape.subpaths.iter().flat_map(Subpath::points)) else {
            return;
        };
        let reach = shape.stroke.as_ref().map_or(0.0, |stroke| {
            let corners = match stroke.join {
                LineJoin::Miter => stroke.miter_limit.max(1.0),
                LineJoin::Round | LineJoin::Bevel => 1.0,
            };
            0.5 * stroke.width * corners.max(std::f64::consts::SQRT_2)
        });
        let reach = Point::repeat(reach);
        let Some(area) = self
            .area
            .within((low - reach) * self.scale, (high + reach) * self.scale)
        else {
            return;
        };
        match (&shape.fill, &shape.stroke) {
            (Some(fill), Some(stroke)) if shape.opacity < 1.0 => {
                let Some(mut layer) = Self::new(area, self.scale) else {
                    return;
                };
                layer.fill(shape, fill, 1.0);
                layer.stroke(shape, stroke, 1.0);
                self.put(&layer, shape.opacity);
            }
            (fill, stroke) => {
                if let Some(fill) = fill {
                    self.fill(shape, fill, shape.opacity);
                }
                if let Some(stroke) = stroke {
                    self.stroke(shape, stroke, shape.opacity);
                }
            }
        }
    }

    fn fill(&mut self, shape: &VectorShape, fill: &Fill, opacity: f64) {
        let (Some(path), Some(paint)) = (self.path(&shape.subpaths), self.paint(&fill.paint, opacity)) else {
            return;
        };
        let rule = match fill.rule {
            FillRule::NonZero => Rule::Winding,
            FillRule::EvenOdd => Rule::EvenOdd,
        };
        self.pixmap.fill_path(&path, &paint, rule, Transform::identity(), None);
    }

    fn stroke(&mut self, shape: &VectorShape, stroke: &Stroke, opacity: f64) {
        let width = (stroke.width * self.scale) as f32;
        if !(width > 0.0 && width.is_finite()) {
            return;
        }
        let (Some(path), Some(paint)) = (self.path(&shape.subpaths), self.paint(&stroke.paint, opacity)) else {
            return;
        };
        let style = SkiaStroke {
            width,
            miter_limit: stroke.miter_limit.max(1.0) as f32,
            line_cap: match stroke.cap {
                LineCap::Butt => tiny_skia::LineCap::Butt,
                LineCap::Round => tiny_skia::LineCap::Round,
                LineCap::Square => tiny_skia::LineCap::Square,
            },
            line_join: match stroke.join {
                LineJoin::Miter => tiny_skia::LineJoin::Miter,
                LineJoin::Round => tiny_skia::LineJoin::Round,
                LineJoin::Bevel => tiny_skia::LineJoin::Bevel,
            },
            dash: self.dash(shape, stroke),
        };
        self.pixmap
            .stroke_path(&path, &paint, &style, Transform::identity(), None);
    }

    /// The dashes of a line; `None` for a whole one.
    fn dash(&self, shape: &VectorShape, stroke: &Stroke) -> Option<StrokeDash> {
        let period: f64 = stroke.dashes.iter().sum();
        let length: f64 = shape.subpaths.iter().map(hull_length).sum();
        let can_be_told_apart = length * stroke.dashes.len() as f64 <= MOST_DASHES * period;
        if !can_be_told_apart {
            return None;
        }
        let dashes = stroke.dashes.iter().map(|dash| (dash * self.scale) as f32).collect();
        StrokeDash::new(dashes, (stroke.dash_offset * self.scale) as f32)
    }

    /// In samples of this canvas.
    fn place(&self, p: Point) -> Point {
        p * self.scale - Point::new(self.area.left as f64, self.area.top as f64)
    }

    fn path(&self, subpaths: &[Subpath]) -> Option<Path> {
        let mut builder = PathBuilder::new();
        for subpath in subpaths {
            let is_drawable = subpath.points().all(|p| p.iter().all(|c| c.abs() <= FURTHEST));
            let extent = point::diagonal(subpath.points());
            if !is_drawable || extent < LEAST_EXTENT {
                continue;
            }
            let to = |p: Point| {
                let p = self.place(p);
                (p.x as f32, p.y as f32)
            };
            let (x, y) = to(subpath.start);
            builder.move_to(x, y);
            for [a, b, c] in &subpath.cubics {
                let ((ax, ay), (bx, by), (cx, cy)) = (to(*a), to(*b), to(*c));
                builder.cubic_to(ax, ay, bx, by, cx, cy);
            }
            if subpath.is_closed {
                builder.close();
            }
        }
        builder.finish()
    }

    fn paint(&self, paint: &Paint, opacity: f64) -> Option<SkiaPaint<'static>> {
        let shader = match paint {
            Paint::Solid(colour) => Shader::SolidColor(to_colour(*colour, opacity)),
            Paint::Gradient(gradient) => self.shader(gradient, opacity)?,
        };
        Some(SkiaPaint {
            shader,
            anti_alias: true,
            ..SkiaPaint::default()
        })
    }

    fn shader(&self, gradient: &Gradient, opacity: f64) -> Option<Shader<'static>> {
        let placement = &gradient.placement;
        let (x, y) = (placement.along_x * self.scale, placement.along_y * self.scale);
        let origin = self.place(placement.origin);
        let [a, b, c, d, e, f] = [x.x, x.y, y.x, y.y, origin.x, origin.y].map(|c| c as f32);
        let transform = Transform::from_row(a, b, c, d, e, f);
        let stops: Vec<GradientStop> = gradient
            .stops
            .iter()
            .map(|stop| GradientStop::new(stop.offset as f32, to_colour(stop.colour, opacity)))
            .collect();
        // A gradient squeezed to a line has its last colour everywhere.
        let last = gradient.stops.last().map(|stop| to_colour(stop.colour, opacity))?;
        let mode = match gradient.spread {
            Spread::Pad => SpreadMode::Pad,
            Spread::Reflect => SpreadMode::Reflect,
            Spread::Repeat => SpreadMode::Repeat,
        };
        let shader = match gradient.kind {
            GradientKind::Linear => {
                LinearGradient::new(SkiaPoint::zero(), SkiaPoint::from_xy(1.0, 0.0), stops, mode, transform)
            }
            GradientKind::Radial { focus } => {
                let focus = SkiaPoint::from_xy(focus.x as f32, focus.y as f32);
                RadialGradient::new(focus, 0.0, SkiaPoint::zero(), 1.0, stops, mode, transform)
            }
        };
        Some(shader.unwrap_or(Shader::SolidColor(last)))
    }

    /// Leaves only what is inside of `rings`.
    fn cut(&mut self, rings: &[Vec<Point>]) {
        let mut builder = PathBuilder::new();
        for ring in rings {
            if !ring.iter().all(|p| p.iter().all(|c| c.abs() <= FURTHEST)) {
                continue;
            }
            for (k, p) in ring.iter().enumerate() {
                let p = self.place(*p);
                if k == 0 {
                    builder.move_to(p.x as f32, p.y as f32);
                } else {
                    builder.line_to(p.x as f32, p.y as f32);
                }
            }
            builder.close();
        }
        let Some(mut mask) = Mask::new(self.pixmap.width(), self.pixmap.height()) else {
            return;
        };
        if let Some(path) = builder.finish() {
            mask.fill_path(&path, Rule::Winding, true, Transform::identity());
        }
        self.pixmap.apply_mask(&mask);
    }

    /// Puts a layer on top.
    fn put(&mut self, layer: &Self, opacity: f64) {
        let paint = PixmapPaint {
            opacity: opacity.clamp(0.0, 1.0) as f32,
            blend_mode: BlendMode::SourceOver,
            quality: FilterQuality::Nearest,
        };
        let (x, y) = (layer.area.left - self.area.left, layer.area.top - self.area.top);
        self.pixmap.draw_pixmap(
            x as i32,
            y as i32,
            layer.pixmap.as_ref(),
            &paint,
            Transform::identity(),
            None,
        );
    }

    fn draw_picture(&mut self, picture: &VectorPicture) {
        if !is_seen(picture.opacity) {
            return;
        }
        let samples = self.scale as usize;
        let opacity = (picture.opacity.min(1.0) * 255.0).round() as u32;
        let width = self.area.width;
        let frame = &picture.frame;
        for (i, pixel) in self.pixmap.pixels_mut().iter_mut().enumerate() {
            let x = (self.area.left as usize + i % width) / samples;
            let y = (self.area.top as usize + i / width) / samples;
            if x >= frame.width || y >= frame.height {
                continue;
            }
            let front = frame.pixels[y * frame.width + x].map(|c| divided_by_255(u32::from(c) * opacity));
            let back = [pixel.red(), pixel.green(), pixel.blue(), pixel.alpha()];
            let [red, green, blue, alpha] = std::array::from_fn(|c| {
                let behind = divided_by_255(u32::from(back[c]) * (255 - front[3]));
                (front[c] + behind).min(255) as u8
            });
            if let Some(colour) =
                PremultipliedColorU8::from_rgba(red.min(alpha), green.min(alpha), blue.min(alpha), alpha)
            {
                *pixel = colour;
            }
        }
    }

    fn average_into(&self, frame: &mut Frame, [left, top]: [usize; 2], [width, height]: [usize; 2], samples: usize) {
        let data = self.pixmap.data();
        let count = (samples * samples) as u32;
        for row in 0..height {
            for column in 0..width {
                let mut sum = [0_u32; 4];
                for y in row * samples..(row + 1) * samples {
                    let from = 4 * (y * self.area.width + column * samples);
                    for sample in data[from..from + 4 * samples].chunks_exact(4) {
                        for (sum, c) in sum.iter_mut().zip(sample) {
                            *sum += u32::from(*c);
                        }
                    }
                }
                frame.pixels[(top + row) * frame.width + left + column] = sum.map(|c| ((c + count / 2) / count) as u8);
            }
        }
    }
}

fn is_seen(opacity: f64) -> bool {
    opacity >= FAINTEST
}

fn divided_by_255(value: u32) -> u32 {
    (value + 127) / 255
}

fn to_colour([red, green, blue, alpha]: [f64; 4], opacity: f64) -> Color {
    // NaN stays NaN, and is then no colour.
    let channel = |c: f64| c.clamp(0.0, 1.0) as f32;
    Color::from_rgba(channel(red), channel(green), channel(blue), channel(alpha * opacity))
        .unwrap_or(Color::TRANSPARENT)
}

/// The length of a path's control polygon: no curve is longer.
fn hull_length(subpath: &Subpath) -> f64 {
    let points: Vec<&Point> = subpath.points().collect();
    points.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum()
}
