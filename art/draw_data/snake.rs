//! The snake: five vector drawings of one body, bent along five centre lines.
//!
//! Everything is drawn once on the straight snake, in body coordinates (distance from the tail along the back, distance
//! across), and carried onto a centre line that is given by its tangent angle. Length and width are therefore the same
//! in every pose, and the pattern follows the body. Each centre line's mean tangent points to the right, so that no
//! pose as a whole is turned against another: the coil's head and tail turn by equal amounts in opposite directions.

use std::error::Error;
use std::f64::consts::PI;
use std::path::Path;

use kurbo::{BezPath, Circle, Ellipse, PathEl, Point, Shape, Vec2};

use crate::curves::{at, brush, grown, right_of, smooth_closed, smooth_through};
use crate::scene::{self, Pose, Scene};
use crate::svg::Drawing;

const WIDTH: f64 = 1080.0;
const HEIGHT: f64 = 560.0;
/// From the tail's tip to the snout.
const LENGTH: f64 = 960.0;
/// Half the body's width where it is thickest.
const HALF_WIDTH: f64 = 24.0;
/// Thickness of the ink line.
const LINE: f64 = 5.0;
/// Thickness of the ink line around the tongue.
const TONGUE_LINE: f64 = 4.5;
/// How far the tongue reaches beyond the snout.
const TONGUE: f64 = 46.0;

const INK: &str = "#1f2f3a";
const SKIN: &str = "#7ccb4f";
const SIDE: &str = "#5aae45";
const BACK: &str = "#2f8a55";
const BACK_LIGHT: &str = "#ffd95a";
const TONGUE_RED: &str = "#f0525a";
const CHEEK: &str = "#f59a8b";
const WHITE: &str = "#fffdf4";

/// Samples of a centre line.
const SAMPLES: usize = 1200;

const MESH: &str = "\
simplify = 0.005
edge_length = 0.035
";

const KEYS: &str = "\
# Slither twice (the wave runs from the head to the tail), coil up, rest, uncoil.
keys = [
  { time = 0.0, at = [0.0, 0.0] },
  { time = 0.5, at = [-1.0, -0.6] },
  { time = 1.0, at = [1.0, -0.6] },
  { time = 1.5, at = [-1.0, -0.6] },
  { time = 2.0, at = [1.0, -0.6] },
  { time = 2.5, at = [0.0, 0.0] },
  { time = 3.0, at = [0.0, 1.0] },
  { time = 3.5, at = [0.0, 2.0] },
  { time = 4.1, at = [0.0, 2.0] },
  { time = 4.6, at = [0.0, 1.0] },
  { time = 5.1, at = [0.0, 0.0] },
]
";

/// One drawing: its name, its place in pose space, and the curvature of its centre line at a distance from the tail.
type Bend = (&'static str, [f64; 2], fn(f64) -> f64);

const BENDS: [Bend; 5] = [
    ("straight", [0.0, 0.0], |_| 0.0),
    ("s_bend_left", [-1.0, -0.6], |s| swing(s, -50.0)),
    ("s_bend_right", [1.0, -0.6], |s| swing(s, 50.0)),
    ("half_coil", [0.0, 1.0], |s| 0.5 * coil(s)),
    ("coil", [0.0, 2.0], coil),
];

/// Curvature of a body whose tangent angle swings like a sine, with the given phase.
fn swing(s: f64, phase_deg: f64) -> f64 {
    let wave_number = 2.0 * PI * 1.5 / LENGTH;
    let amplitude_rad = 70.0_f64.to_radians();
    // The head does not bend.
    let stiff = 1.0 - smooth_step((s - 0.86 * LENGTH) / (0.09 * LENGTH));
    stiff * amplitude_rad * wave_number * (wave_number * (s - 0.5 * LENGTH) + phase_deg.to_radians()).cos()
}

/// Curvature of a spiral with even gaps, the tail in its middle; the neck opens and the head looks out.
fn coil(s: f64) -> f64 {
    const INNER_RADIUS: f64 = 30.0;
    const PITCH: f64 = 84.0;
    const NECK: f64 = 740.0;
    let radius = |s: f64| {
        // From s = r0 a + PITCH a^2 / (4 pi), a the angle turned so far.
        let quadratic = PITCH / (4.0 * PI);
        let angle_rad = ((INNER_RADIUS * INNER_RADIUS + 4.0 * quadratic * s).sqrt() - INNER_RADIUS) / (2.0 * quadratic);
        INNER_RADIUS + PITCH * angle_rad / (2.0 * PI)
    };
    let opening = smooth_step((s - NECK) / (LENGTH - NECK));
    (1.0 - 1.6 * opening) / radius(s.min(LENGTH))
}

fn smooth_step(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// Draws the five poses into `folder`.
pub(crate) fn draw(folder: &Path) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(folder)?;
    let mut poses = Vec::new();
    for (name, at_place, curvature) in BENDS {
        let centre_line = CentreLine::new(curvature);
        let mut drawing = Drawing::new(WIDTH, HEIGHT, &format!("snake, {name}"));
        for (id, colour, path) in straight_snake() {
            drawing.fill(id, colour, centre_line.carry(&path));
        }
        let file = format!("{name}.svg");
        drawing.save(&folder.join(&file))?;
        let landmarks: Vec<(String, Point)> = landmarks()
            .into_iter()
            .map(|(name, body)| (name, centre_line.place(body).0))
            .collect();
        poses.push(Pose {
            name,
            file,
            at: at_place,
            landmarks,
        });
    }
    scene::save(
        folder,
        &Scene {
            element: Some("body"),
            poses,
            landmarks: &[],
            mesh: MESH,
            sharpness: 0.8,
            size_px: [960, 480],
            keys: KEYS,
        },
    )
}

/// The points of the outline that are known, in body coordinates: going round the body from the tail.
fn landmarks() -> Vec<(String, Point)> {
    let side = |name: &str, sign: f64| -> Vec<(String, Point)> {
        let station = |k: u32| {
            let s = FIRST_STATION + STATION_STEP * f64::from(k);
            (format!("{name}_{:02}", k + 1), at(s, sign * (half_width(s) + LINE)))
        };
        let mut points: Vec<(String, Point)> = (0..STATIONS).map(station).collect();
        let tip = tongue_side(TONGUE_LINE)[TONGUE_TIP];
        points.push((format!("{name}_tongue_tip"), at(tip.x, sign * tip.y)));
        points
    };
    let mut points = vec![("tail".to_owned(), at(-LINE, 0.0))];
    points.extend(side("left", 1.0));
    points.push(("tongue".to_owned(), tongue_side(TONGUE_LINE)[FORK]));
    points.extend(side("right", -1.0).into_iter().rev());
    // The spine, but for the tail, which is too thin for a point inside.
    points.extend((SPINE..STATIONS).map(|k| {
        let s = FIRST_STATION + STATION_STEP * f64::from(k);
        (format!("spine_{:02}", k + 1), at(s, 0.0))
    }));
    points
}

/// Where along the body the sides carry landmarks: evenly, up to the widest part of the head.
const FIRST_STATION: f64 = 60.0;
const STATION_STEP: f64 = 50.0;
const STATIONS: u32 = 18;
/// The first of them that has a point of the spine beside it.
const SPINE: u32 = 3;

/// A centre line, sampled evenly; before the tail and beyond the snout it goes straight on.
struct CentreLine {
    points: Vec<Point>,
    angles_rad: Vec<f64>,
}

impl CentreLine {
    fn new(curvature: fn(f64) -> f64) -> Self {
        let step = LENGTH / SAMPLES as f64;
        let mut angles_rad = vec![0.0];
        for k in 0..SAMPLES {
            angles_rad.push(angles_rad[k] + step * curvature((k as f64 + 0.5) * step));
        }
        let mean_rad = angles_rad.iter().sum::<f64>() / angles_rad.len() as f64;
        for angle_rad in &mut angles_rad {
            *angle_rad -= mean_rad;
        }
        let mut points = vec![Point::ZERO];
        for k in 0..SAMPLES {
            let middle_rad = 0.5 * (angles_rad[k] + angles_rad[k + 1]);
            points.push(points[k] + Vec2::from_angle(middle_rad) * step);
        }
        let mut this = Self { points, angles_rad };
        let shift = at(0.5 * WIDTH, 0.5 * HEIGHT) - this.extent_middle();
        for point in &mut this.points {
            *point += shift;
        }
        this
    }

    /// The middle of the bounding box of the centre line and the tongue.
    fn extent_middle(&self) -> Point {
        let mut bounds = kurbo::Rect::from_points(self.points[0], self.points[SAMPLES]);
        for &point in &self.points {
            bounds = bounds.union_pt(point);
        }
        bounds.union_pt(self.place(at(LENGTH + TONGUE, 0.0)).0).center()
    }

    /// Where a point in body coordinates lies, with the tangent and the curvature there.
    fn place(&self, body: Point) -> (Point, Vec2, f64) {
        let scaled = (body.x / LENGTH).clamp(0.0, 1.0) * SAMPLES as f64;
        let k = (scaled as usize).min(SAMPLES - 1);
        let part = scaled - k as f64;
        let angle_rad = self.angles_rad[k] * (1.0 - part) + self.angles_rad[k + 1] * part;
        let tangent = Vec2::from_angle(angle_rad);
        let beyond = body.x - body.x.clamp(0.0, LENGTH);
        let inside = (0.0..=LENGTH).contains(&body.x);
        let curvature = (self.angles_rad[k + 1] - self.angles_rad[k]) * SAMPLES as f64 / LENGTH;
        let centre = self.points[k].lerp(self.points[k + 1], part) + tangent * beyond;
        (
            centre + right_of(tangent) * body.y,
            tangent,
            if inside { curvature } else { 0.0 },
        )
    }

    /// A direction in body coordinates, carried along.
    fn turn(&self, body: Point, direction: Vec2) -> Vec2 {
        let (_, tangent, curvature) = self.place(body);
        tangent * (direction.x * (1.0 - curvature * body.y)) + right_of(tangent) * direction.y
    }

    /// A curve in body coordinates, carried along: short pieces keep their ends and their end tangents.
    fn carry(&self, path: &BezPath) -> BezPath {
        let mut carried = BezPath::new();
        for segment in path.segments() {
            let cubic = segment.to_cubic();
            if carried.elements().is_empty() {
                carried.move_to(self.place(cubic.p0).0);
            }
            let pieces = ((cubic.p3 - cubic.p0).hypot() / LONGEST_PIECE).ceil().max(1.0) as usize;
            for piece in 0..pieces {
                let range = piece as f64 / pieces as f64..(piece + 1) as f64 / pieces as f64;
                let short = kurbo::ParamCurve::subsegment(&cubic, range);
                let from = self.place(short.p0).0 + self.turn(short.p0, short.p1 - short.p0);
                let to = self.place(short.p3).0 + self.turn(short.p3, short.p2 - short.p3);
                carried.curve_to(from, to, self.place(short.p3).0);
            }
        }
        carried.push(PathEl::ClosePath);
        carried
    }
}

/// Pieces of this length, bent by the tightest winding, still look like the true curve.
const LONGEST_PIECE: f64 = 20.0;

/// The snake before it is bent: element names, colours and closed curves in body coordinates.
fn straight_snake() -> Vec<(String, &'static str, BezPath)> {
    let mut parts: Vec<(String, &'static str, BezPath)> = Vec::new();
    let mut add = |id: &str, colour, path| parts.push((id.to_owned(), colour, path));
    let skin = skin_ring();
    add("body", INK, body_with_tongue());
    add("tongue", TONGUE_RED, tongue());
    add("skin", SKIN, smooth_closed(&skin));
    add("side", SIDE, lower_side());
    for (k, s) in (0..11).map(|k| (k, 96.0 + 72.0 * f64::from(k))) {
        let half = half_width(s);
        let long = 14.0 + 0.55 * half;
        let saddle = [
            at(s - long, 0.0),
            at(s - 0.55 * long, -0.62 * half),
            at(s, -0.82 * half),
            at(s + 0.55 * long, -0.62 * half),
            at(s + long, 0.0),
            at(s + 0.55 * long, 0.62 * half),
            at(s, 0.82 * half),
            at(s - 0.55 * long, 0.62 * half),
        ];
        add(&format!("band-{:02}", k + 1), BACK, smooth_closed(&saddle));
        let dot = Ellipse::new((s, 0.0), (0.42 * long, 0.30 * half), 0.0).to_path(0.05);
        add(&format!("dot-{:02}", k + 1), BACK_LIGHT, dot);
    }
    for (side, sign) in [("left", -1.0), ("right", 1.0)] {
        let eye = at(LENGTH - 41.0, 22.0 * sign);
        let cheek = Ellipse::new((LENGTH - 71.0, 22.5 * sign), (11.0, 7.0), 0.0);
        add(&format!("cheek-{side}"), CHEEK, cheek.to_path(0.05));
        add(&format!("eye-line-{side}"), INK, Circle::new(eye, 17.5).to_path(0.05));
        add(&format!("eye-{side}"), WHITE, Circle::new(eye, 13.5).to_path(0.05));
        let pupil = eye + Vec2::new(3.4, -1.4 * sign);
        add(&format!("pupil-{side}"), INK, Circle::new(pupil, 8.6).to_path(0.05));
        add(
            &format!("glint-{side}"),
            WHITE,
            Circle::new(pupil + Vec2::new(2.4, -2.6), 2.5).to_path(0.05),
        );
        let nostril = brush(
            &[
                at(LENGTH - 10.0, 5.0 * sign),
                at(LENGTH - 8.0, 7.0 * sign),
                at(LENGTH - 8.0, 9.5 * sign),
            ],
            3.0,
            2.0,
        );
        add(&format!("nostril-{side}"), INK, nostril);
    }
    parts
}

/// Half widths of the skin, from the tail to the snout.
const PROFILE: [(f64, f64); 18] = [
    (1.5, 2.2),
    (6.0, 3.6),
    (22.0, 5.4),
    (55.0, 8.6),
    (110.0, 13.2),
    (180.0, 18.2),
    (270.0, 22.6),
    (360.0, HALF_WIDTH),
    (480.0, HALF_WIDTH),
    (600.0, HALF_WIDTH),
    (720.0, HALF_WIDTH),
    (810.0, 23.5),
    (860.0, 24.0),
    (888.0, 30.5),
    (912.0, 35.5),
    (935.0, 32.5),
    (950.0, 22.5),
    (958.0, 10.0),
];

fn half_width(s: f64) -> f64 {
    let k = PROFILE
        .windows(2)
        .position(|pair| s < pair[1].0)
        .unwrap_or(PROFILE.len() - 2);
    let ((s0, h0), (s1, h1)) = (PROFILE[k], PROFILE[k + 1]);
    h0 + (h1 - h0) * (s - s0) / (s1 - s0)
}

/// The outline of the skin: tail, left side, snout, right side.
fn skin_ring() -> Vec<Point> {
    let mut ring = vec![at(0.0, 0.0)];
    ring.extend(PROFILE.iter().map(|&(s, half)| at(s, -half)));
    ring.push(at(LENGTH, 0.0));
    ring.extend(PROFILE.iter().rev().map(|&(s, half)| at(s, half)));
    ring
}

/// The silhouette: the skin and the tongue, with the ink line around them.
fn body_with_tongue() -> BezPath {
    let outer = grown(&skin_ring(), LINE);
    let snout = 1 + PROFILE.len();
    let mut path = BezPath::new();
    let tongue_edge = tongue_side(TONGUE_LINE);
    let mirrored = |points: &[Point]| -> Vec<Point> { points.iter().rev().map(|p| at(p.x, -p.y)).collect() };
    let mut left: Vec<Point> = outer[..snout].to_vec();
    left.push(tongue_edge[0]);
    smooth_through(&mut path, &left);
    smooth_through(&mut path, &tongue_edge);
    smooth_through(&mut path, &mirrored(&tongue_edge));
    smooth_through(&mut path, &mirrored(&left));
    path.close_path();
    path
}

fn tongue() -> BezPath {
    let edge = tongue_side(0.0);
    let mut path = BezPath::new();
    smooth_through(&mut path, &edge);
    let back: Vec<Point> = edge.iter().rev().map(|p| at(p.x, -p.y)).collect();
    smooth_through(&mut path, &back);
    path.line_to(at(LENGTH - 14.0, 4.0));
    path.line_to(at(LENGTH - 14.0, -4.0));
    path.close_path();
    path
}

/// Where in a side of the tongue its tip is.
const TONGUE_TIP: usize = 4;
/// Where in a side of the tongue the bottom of the fork is.
const FORK: usize = 6;

/// One side of the tongue, from the snout round its tip to the fork, `margin` fatter than the red of it.
fn tongue_side(margin: f64) -> Vec<Point> {
    let m = margin;
    vec![
        at(LENGTH + 0.6 * m, -4.0 - m),
        at(LENGTH + 16.0, -4.0 - m),
        at(LENGTH + 28.0, -7.0 - m),
        at(LENGTH + 40.0 - 0.3 * m, -14.5 - m),
        at(LENGTH + TONGUE - m * 0.2 + m * 0.9, -14.0 - 0.2 * m),
        at(LENGTH + TONGUE - 6.0 + m, -7.0 + 0.4 * m),
        at(LENGTH + 30.0 + m, 0.0),
    ]
}

/// The side of the skin that lies in shadow.
fn lower_side() -> BezPath {
    let ends = [70.0, 900.0].map(|s| at(s, 0.97 * half_width(s)));
    let edge = |share: f64| -> Vec<Point> {
        let between = PROFILE[4..13].iter().map(|&(s, _)| at(s, share * half_width(s)));
        std::iter::once(ends[0]).chain(between).chain([ends[1]]).collect()
    };
    let mut path = BezPath::new();
    smooth_through(&mut path, &edge(0.62));
    smooth_through(&mut path, &edge(0.97).into_iter().rev().collect::<Vec<_>>());
    path.close_path();
    path
}
