//! Curves that the three drawings share: smooth lines through points, limbs of varying width, brush strokes.
//!
//! Everything is a `kurbo` path in picture coordinates (x right, y down), made of few cubic segments, so that it can be
//! filled by the rasteriser or written as an SVG path unchanged.

use kurbo::{BezPath, Point, Vec2};

/// A point from its coordinates.
pub(crate) fn at(x: f64, y: f64) -> Point {
    Point::new(x, y)
}

/// The unit vector `angle_deg` away from straight down, towards the picture's right.
pub(crate) fn hanging(angle_deg: f64) -> Vec2 {
    let angle_rad = angle_deg.to_radians();
    Vec2::new(angle_rad.sin(), angle_rad.cos())
}

/// The vector turned by a quarter: to the right of its direction as seen on the picture.
pub(crate) fn right_of(direction: Vec2) -> Vec2 {
    Vec2::new(-direction.y, direction.x)
}

/// The closed curve through the points, with continuous tangents (Catmull-Rom with chord-length knots).
pub(crate) fn smooth_closed(points: &[Point]) -> BezPath {
    let count = points.len();
    let tangents: Vec<Vec2> = (0..count)
        .map(|k| tangent(points[(k + count - 1) % count], points[k], points[(k + 1) % count]))
        .collect();
    let mut path = BezPath::new();
    path.move_to(points[0]);
    for k in 0..count {
        let next = (k + 1) % count;
        segment(&mut path, points[k], tangents[k], points[next], tangents[next]);
    }
    path.close_path();
    path
}

/// Continues `path` smoothly through the points (the path stands at the first of them, or is empty).
pub(crate) fn smooth_through(path: &mut BezPath, points: &[Point]) {
    let last = points.len() - 1;
    if path.elements().is_empty() {
        path.move_to(points[0]);
    }
    let tangents: Vec<Vec2> = (0..=last)
        .map(|k| match k {
            0 => (points[1] - points[0]).normalize(),
            k if k == last => (points[last] - points[last - 1]).normalize(),
            k => tangent(points[k - 1], points[k], points[k + 1]),
        })
        .collect();
    for k in 0..last {
        segment(path, points[k], tangents[k], points[k + 1], tangents[k + 1]);
    }
}

/// Unit tangent at `here`: the nearer neighbour counts more, so that uneven spacing makes no bulges.
fn tangent(before: Point, here: Point, after: Point) -> Vec2 {
    let (back, ahead) = (here - before, after - here);
    (back.normalize() * ahead.hypot() + ahead.normalize() * back.hypot()).normalize()
}

fn segment(path: &mut BezPath, from: Point, leaving: Vec2, to: Point, arriving: Vec2) {
    let chord = to - from;
    // A handle of 1/3 of the chord for straight runs, growing towards that of a circular arc for turning ones.
    let turn_rad = leaving.cross(arriving).atan2(leaving.dot(arriving)).abs();
    let handle = chord.hypot() / 3.0 / (turn_rad / 4.0).cos().powi(2).max(0.5);
    path.curve_to(from + leaving * handle, to - arriving * handle, to);
}

/// The closed polygon through the points.
pub(crate) fn polygon(points: &[Point]) -> BezPath {
    let mut path = BezPath::new();
    path.move_to(points[0]);
    for &point in &points[1..] {
        path.line_to(point);
    }
    path.close_path();
    path
}

/// The closed curve moved outwards by `distance` (the points run so that the inside lies on their right).
pub(crate) fn grown(points: &[Point], distance: f64) -> Vec<Point> {
    let count = points.len();
    (0..count)
        .map(|k| {
            let along = tangent(points[(k + count - 1) % count], points[k], points[(k + 1) % count]);
            points[k] - right_of(along) * distance
        })
        .collect()
}

/// A stroke along a line through the points, thick in the middle and thin at its ends, as one closed curve.
pub(crate) fn brush(points: &[Point], middle_width: f64, end_width: f64) -> BezPath {
    let last = points.len() - 1;
    let side = |sign: f64| -> Vec<Point> {
        (0..=last)
            .map(|k| {
                let along = points[(k + 1).min(last)] - points[k.saturating_sub(1)];
                let swell = (std::f64::consts::PI * k as f64 / last as f64).sin();
                let width = end_width + (middle_width - end_width) * swell;
                points[k] + right_of(along.normalize()) * (0.5 * width * sign)
            })
            .collect()
    };
    let mut ring = side(-1.0);
    let first = points[0] - (points[1] - points[0]).normalize() * (0.4 * end_width);
    ring.push(points[last] + (points[last] - points[last - 1]).normalize() * (0.4 * end_width));
    ring.extend(side(1.0).into_iter().rev());
    ring.push(first);
    smooth_closed(&ring)
}

/// A limb: a centre line over one rounded joint, with a half width that varies along it.
#[derive(Debug, Clone)]
pub(crate) struct Limb {
    centre: Vec<Point>,
    across: Vec<Vec2>,
}

/// Samples of a limb's centre line.
const LIMB_SAMPLES: usize = 49;

impl Limb {
    /// A limb over `joints` (root, bend, end); `roundness` is the share of the shorter bone that the bend takes.
    pub(crate) fn new(joints: [Point; 3], half_widths: [f64; 3], roundness: f64) -> Self {
        let [root, bend, end] = joints;
        let cut = roundness * (bend - root).hypot().min((end - bend).hypot());
        let before = bend - (bend - root).normalize() * cut;
        let after = bend + (end - bend).normalize() * cut;
        let mut line = BezPath::new();
        line.move_to(root);
        line.line_to(before);
        line.quad_to(bend, after);
        line.line_to(end);
        let dense = flatten(&line);
        let centre = resample(&dense, LIMB_SAMPLES);
        let across = (0..LIMB_SAMPLES)
            .map(|k| {
                let along = centre[(k + 1).min(LIMB_SAMPLES - 1)] - centre[k.saturating_sub(1)];
                let t = k as f64 / (LIMB_SAMPLES - 1) as f64;
                let [a, b, c] = half_widths;
                let width = if t < 0.5 {
                    a + (b - a) * 2.0 * t
                } else {
                    b + (c - b) * (2.0 * t - 1.0)
                };
                right_of(along.normalize()) * width
            })
            .collect();
        Self { centre, across }
    }

    /// The part of the limb from `from` to `to` along it (0 at the root, 1 at the end), and from `left` to `right`
    /// across it (-1 and 1 at its edges).
    pub(crate) fn patch(&self, from: f64, to: f64, left: f64, right: f64) -> BezPath {
        let steps = 2 + ((to - from) * 40.0) as usize;
        let edge = |across: f64| -> Vec<Point> {
            (0..=steps)
                .map(|k| self.place(from + (to - from) * k as f64 / steps as f64, across))
                .collect()
        };
        let mut ring = edge(left);
        ring.extend(edge(right).into_iter().rev());
        polygon(&ring)
    }

    /// The shadow along one side (`1.0` or `-1.0`), from `from` to the end; it begins as a point and widens.
    pub(crate) fn shadow(&self, from: f64, side: f64) -> BezPath {
        let steps = 40;
        let along = |k: i32| from + (1.0 - from) * f64::from(k) / f64::from(steps);
        let inner = |k: i32| 1.0 - 0.6 * (f64::from(k) / f64::from(steps) * 4.0).min(1.0).powf(0.6);
        let mut ring: Vec<Point> = (0..=steps).map(|k| self.place(along(k), side * inner(k))).collect();
        ring.extend((0..=steps).rev().map(|k| self.place(along(k), side * 1.2)));
        polygon(&ring)
    }

    /// The whole limb.
    pub(crate) fn body(&self) -> BezPath {
        self.patch(0.0, 1.0, -1.0, 1.0)
    }

    /// The point at `along` (0 at the root, 1 at the end) and `across` (-1 and 1 at the edges).
    pub(crate) fn place(&self, along: f64, across: f64) -> Point {
        let scaled = along.clamp(0.0, 1.0) * (LIMB_SAMPLES - 1) as f64;
        let k = (scaled as usize).min(LIMB_SAMPLES - 2);
        let part = scaled - k as f64;
        self.centre[k].lerp(self.centre[k + 1], part) + self.across[k].lerp(self.across[k + 1], part) * across
    }
}

fn flatten(path: &BezPath) -> Vec<Point> {
    let mut points = Vec::new();
    kurbo::flatten(path, 0.02, |element| {
        if let kurbo::PathEl::MoveTo(point) | kurbo::PathEl::LineTo(point) = element {
            points.push(point);
        }
    });
    points
}

/// `count` points evenly spaced along an open line.
fn resample(line: &[Point], count: usize) -> Vec<Point> {
    let mut reached = vec![0.0];
    for pair in line.windows(2) {
        reached.push(reached[reached.len() - 1] + (pair[1] - pair[0]).hypot());
    }
    let total = reached[reached.len() - 1];
    let mut edge = 0;
    (0..count)
        .map(|k| {
            let target = total * k as f64 / (count - 1) as f64;
            while edge + 2 < line.len() && reached[edge + 1] < target {
                edge += 1;
            }
            let part = ((target - reached[edge]) / (reached[edge + 1] - reached[edge]).max(1e-12)).clamp(0.0, 1.0);
            line[edge].lerp(line[edge + 1], part)
        })
        .collect()
}
