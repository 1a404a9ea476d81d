//! Curves and colours that the bear's parts share.

use kurbo::{BezPath, Point, Vec2};

use super::{BRASS, BRASS_LIGHT, INK};
use crate::curves::{at, right_of, smooth_closed};
use crate::svg::{Gradient, GradientShape, Group, Look};

/// A line that bends evenly, from which other points are measured: a back, a stem.
pub(super) struct Spine {
    base: Point,
    /// Clockwise from upright.
    heading_rad: f64,
    bend_rad: f64,
    /// Where it stops bending.
    length: f64,
}

impl Spine {
    pub(super) fn new(base: Point, heading_deg: f64, bend_deg: f64, length: f64) -> Self {
        Self {
            base,
            heading_rad: heading_deg.to_radians(),
            bend_rad: bend_deg.to_radians(),
            length,
        }
    }

    /// The point `up` along the line and `x` to its right.
    pub(super) fn place(&self, x: f64, up: f64) -> Point {
        let bent = up.clamp(0.0, self.length);
        let turned_rad = self.bend_rad * bent / self.length;
        let ahead = |angle_rad: f64| Vec2::new(angle_rad.sin(), -angle_rad.cos());
        // The chord of an arc has half its turn.
        let chord = bent * sinc(0.5 * turned_rad);
        let along = ahead(self.heading_rad + turned_rad);
        self.base + ahead(self.heading_rad + 0.5 * turned_rad) * chord + along * (up - bent) + right_of(along) * x
    }

    pub(super) fn places(&self, points: &[(f64, f64)]) -> Vec<Point> {
        points.iter().map(|&(x, up)| self.place(x, up)).collect()
    }
}

pub(super) fn sinc(x: f64) -> f64 {
    if x.abs() < 1e-9 { 1.0 } else { x.sin() / x }
}

/// An ellipse whose half axes are these vectors, of eight curves.
pub(super) fn ellipse(middle: Point, across: Vec2, down: Vec2) -> BezPath {
    let points: Vec<Point> = (0..8)
        .map(|k| {
            let (sin, cos) = (f64::from(k) * std::f64::consts::FRAC_PI_4).sin_cos();
            middle + across * cos + down * sin
        })
        .collect();
    smooth_closed(&points)
}

pub(super) fn circle(middle: Point, radius: f64) -> BezPath {
    ellipse(middle, Vec2::new(radius, 0.0), Vec2::new(0.0, radius))
}

/// One cubic curve through four points' hull.
pub(super) fn curve(points: [Point; 4]) -> BezPath {
    let mut path = BezPath::new();
    path.move_to(points[0]);
    path.curve_to(points[1], points[2], points[3]);
    path
}

pub(super) fn linear(id: &str, from: Point, to: Point, colours: &[&'static str]) -> Gradient {
    Gradient {
        id: id.to_owned(),
        shape: GradientShape::Linear(from, to),
        stops: stops(colours),
    }
}

pub(super) fn radial(id: &str, middle: Point, radius: f64, colours: &[&'static str]) -> Gradient {
    Gradient {
        id: id.to_owned(),
        shape: GradientShape::Radial(middle, radius),
        stops: stops(colours),
    }
}

pub(super) fn stops(colours: &[&'static str]) -> Vec<(f64, &'static str, f64)> {
    let last = (colours.len() - 1) as f64;
    (colours.iter().enumerate())
        .map(|(k, colour)| (k as f64 / last, *colour, 1.0))
        .collect()
}

/// A button with a light on it, and the gradient of that.
pub(super) fn button(group: &mut Group, id: &str, middle: Point, radius: f64) {
    let shine = format!("{id}-brass");
    let light = at(middle.x - 0.3 * radius, middle.y - 0.4 * radius);
    group.gradient(radial(&shine, light, 1.3 * radius, &[BRASS_LIGHT, BRASS]));
    group.path(id, Look::shaded(&shine).lined(INK, 2.5), circle(middle, radius));
}
