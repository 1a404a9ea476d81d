//! Strokes: dashes cut from the path, triangles by lyon.

use lyon_tessellation::math::point;
use lyon_tessellation::path::{EndpointId, Path};
use lyon_tessellation::{
    BuffersBuilder, StrokeOptions, StrokeTessellator, StrokeVertex, StrokeVertexConstructor, TessellationError,
    UnsupportedParamater, VertexBuffers,
};

use super::Triangles;
use super::known::Sampled;
use crate::math::{Point, SinglePrecision};
use crate::render::{LineCap, LineJoin, Stroke};

/// Dashes of a line beyond which it is drawn whole: they could not be told apart.
const MOST_DASHES: f64 = 100_000.0;

/// The triangles of the line.
pub(super) fn triangles(sampled: &Sampled, stroke: &Stroke, tolerance_px: f64) -> Result<Triangles, TessellationError> {
    if stroke.width <= 0.0 {
        return Ok(Triangles::default());
    }
    let single = sampled.single;
    let mut options = StrokeOptions::default()
        .with_line_width((stroke.width * single.scale()) as f32)
        .with_tolerance((tolerance_px * single.scale()).max(f64::from(f32::EPSILON)) as f32)
        .with_miter_limit((stroke.miter_limit as f32).max(StrokeOptions::MINIMUM_MITER_LIMIT));
    let cap = match stroke.cap {
        LineCap::Butt => lyon_tessellation::LineCap::Butt,
        LineCap::Round => lyon_tessellation::LineCap::Round,
        LineCap::Square => lyon_tessellation::LineCap::Square,
    };
    (options.start_cap, options.end_cap) = (cap, cap);
    options.line_join = match stroke.join {
        LineJoin::Miter => lyon_tessellation::LineJoin::Miter,
        LineJoin::Round => lyon_tessellation::LineJoin::Round,
        LineJoin::Bevel => lyon_tessellation::LineJoin::Bevel,
    };
    let path = match dashed(sampled, stroke) {
        Some(dashes) => path_of(&single, dashes.iter().map(|dash| (0, dash.as_slice(), false)), false)?.0,
        None => lyon_path(sampled, false)?.0,
    };
    let mut buffers: VertexBuffers<Point, u32> = VertexBuffers::new();
    let mut output = BuffersBuilder::new(&mut buffers, Placed(single));
    StrokeTessellator::new().tessellate_path(&path, &options, &mut output)?;
    Ok(Triangles {
        positions: buffers.vertices,
        indices: buffers.indices,
        sources: Vec::new(),
    })
}

/// Positions in pixels.
struct Placed(SinglePrecision);

impl StrokeVertexConstructor<Point> for Placed {
    fn new_vertex(&mut self, vertex: StrokeVertex<'_, '_>) -> Point {
        let position = vertex.position();
        self.0.to_double([position.x, position.y])
    }
}

/// A path of its points, joined by lines, and which point each endpoint is. As fills have it, every piece is closed.
pub(super) fn lyon_path(
    sampled: &Sampled,
    all_closed: bool,
) -> Result<(Path, Vec<(EndpointId, usize)>), TessellationError> {
    path_of(&sampled.single, sampled.drawn(), all_closed)
}

fn path_of<'a>(
    single: &SinglePrecision,
    pieces: impl Iterator<Item = (usize, &'a [Point], bool)>,
    all_closed: bool,
) -> Result<(Path, Vec<(EndpointId, usize)>), TessellationError> {
    let mut builder = Path::builder();
    let mut endpoints = Vec::new();
    for (first, points, is_closed) in pieces {
        for (k, p) in points.iter().enumerate() {
            // Admitted by the caller: no point is further than single precision can say.
            let [x, y] = (single.to_single(*p))
                .map_err(|_| TessellationError::UnsupportedParamater(UnsupportedParamater::PositionIsNaN))?;
            let endpoint = if k == 0 {
                builder.begin(point(x, y))
            } else {
                builder.line_to(point(x, y))
            };
            endpoints.push((endpoint, first + k));
        }
        if !points.is_empty() {
            builder.end(is_closed || all_closed);
        }
    }
    Ok((builder.build(), endpoints))
}

/// The dashes of a line as lines of their own; `None` for a whole one.
fn dashed(sampled: &Sampled, stroke: &Stroke) -> Option<Vec<Vec<Point>>> {
    let period: f64 = stroke.dashes.iter().sum();
    let length = |points: &[Point]| -> f64 { points.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum() };
    let whole: f64 = sampled.drawn().map(|(_, points, _)| length(points)).sum();
    let can_be_told_apart = period > 0.0 && whole * stroke.dashes.len() as f64 <= MOST_DASHES * period;
    if !can_be_told_apart
        || stroke.dashes.iter().any(|dash| !dash.is_finite() || *dash < 0.0)
        || !stroke.dash_offset.is_finite()
    {
        return None;
    }
    let mut dashes = Vec::new();
    for (_, points, is_closed) in sampled.drawn() {
        let closing = is_closed.then(|| points[0]);
        let mut cut = Cut::new(stroke, period, points[0]);
        for p in points[1..].iter().copied().chain(closing) {
            cut.line_to(p);
        }
        dashes.extend(cut.finished());
    }
    Some(dashes)
}

/// A line that is cut into dashes on the way.
struct Cut<'a> {
    lengths: &'a [f64],
    /// Which dash or gap, and what is left of it.
    index: usize,
    left: f64,
    at: Point,
    dashes: Vec<Vec<Point>>,
    dash: Vec<Point>,
}

impl<'a> Cut<'a> {
    fn new(stroke: &'a Stroke, period: f64, start: Point) -> Self {
        let lengths = &stroke.dashes;
        let (mut index, mut left) = (0, stroke.dash_offset.rem_euclid(period));
        while index + 1 < lengths.len() && left >= lengths[index] {
            left -= lengths[index];
            index += 1;
        }
        let mut cut = Self {
            lengths,
            index,
            left: (lengths[index] - left).max(0.0),
            at: start,
            dashes: Vec::new(),
            dash: Vec::new(),
        };
        if cut.is_dash() {
            cut.dash.push(start);
        }
        cut
    }

    fn is_dash(&self) -> bool {
        self.index.is_multiple_of(2)
    }

    fn line_to(&mut self, to: Point) {
        let mut length = (to - self.at).norm();
        while length > self.left {
            self.at += (to - self.at) * (self.left / length);
            length -= self.left;
            if self.is_dash() {
                self.dash.push(self.at);
                self.dashes.push(std::mem::take(&mut self.dash));
            }
            self.index = (self.index + 1) % self.lengths.len();
            self.left = self.lengths[self.index];
            if self.is_dash() {
                self.dash.push(self.at);
            }
        }
        self.left -= length;
        self.at = to;
        if self.is_dash() {
            self.dash.push(to);
        }
    }

    fn finished(mut self) -> Vec<Vec<Point>> {
        if self.dash.len() > 1 {
            self.dashes.push(self.dash);
        }
        self.dashes
    }
}
