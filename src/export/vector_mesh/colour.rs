//! The colour of a paint at a place.

use crate::math::{Point, point};
use crate::render::{Gradient, GradientKind, Paint, Spread, Stop};

/// A gradient's placement with a smaller area than this, in square pixels, is squeezed to a line.
const LEAST_AREA: f64 = 1e-12;

/// A paint with an opacity.
#[derive(Debug)]
pub(super) enum Painted<'a> {
    Solid([f32; 4]),
    Gradient(&'a Gradient, f64),
}

impl<'a> Painted<'a> {
    pub(super) const WHITE: Painted<'static> = Painted::Solid([1.0; 4]);

    pub(super) fn new(paint: &'a Paint, opacity: f64) -> Self {
        match paint {
            Paint::Solid(colour) => Self::Solid(faded(*colour, opacity)),
            Paint::Gradient(gradient) => Self::Gradient(gradient, opacity),
        }
    }

    pub(super) fn white(opacity: f64) -> Self {
        Self::Solid(faded([1.0; 4], opacity))
    }

    /// Whether something shows through.
    pub(super) fn is_translucent(&self) -> bool {
        match self {
            Self::Solid(colour) => colour[3] < 1.0,
            Self::Gradient(gradient, opacity) => {
                *opacity < 1.0 || gradient.stops.iter().any(|stop| stop.colour[3] < 1.0)
            }
        }
    }

    pub(super) fn at(&self, p: Point) -> [f32; 4] {
        match self {
            Self::Solid(colour) => *colour,
            Self::Gradient(gradient, opacity) => faded(colour_at(gradient, p), *opacity),
        }
    }
}

fn faded([red, green, blue, alpha]: [f64; 4], opacity: f64) -> [f32; 4] {
    // What is no number becomes 0.
    let channel = |c: f64| if c > 0.0 { c.min(1.0) as f32 } else { 0.0 };
    [red, green, blue, alpha * opacity].map(channel)
}

fn colour_at(gradient: &Gradient, p: Point) -> [f64; 4] {
    let placement = &gradient.placement;
    let area = point::cross(placement.along_x, placement.along_y);
    // A gradient squeezed to a line has its last colour everywhere.
    if area.abs() <= LEAST_AREA || !area.is_finite() {
        return gradient.stops.last().map_or([0.0; 4], |stop| stop.colour);
    }
    let away = p - placement.origin;
    let own = Point::new(
        point::cross(away, placement.along_y) / area,
        point::cross(placement.along_x, away) / area,
    );
    let t = match gradient.kind {
        GradientKind::Linear => own.x,
        GradientKind::Radial { focus } => radial(own, focus),
    };
    of_stops(
        &gradient.stops,
        match gradient.spread {
            Spread::Pad => t.clamp(0.0, 1.0),
            Spread::Repeat => t.rem_euclid(1.0),
            Spread::Reflect => 1.0 - (t.rem_euclid(2.0) - 1.0).abs(),
        },
    )
}

/// How far `p` is on the way from `focus` to the unit circle: the `t` for which it lies on the circle of radius `t` around
/// `(1 - t) focus`.
fn radial(p: Point, focus: Point) -> f64 {
    let away = p - focus;
    // |away + t focus|² = t²
    let (a, b, c) = (1.0 - focus.norm_squared(), away.dot(&focus), away.norm_squared());
    if a <= 0.0 {
        return 1.0;
    }
    (b + (b * b + a * c).max(0.0).sqrt()) / a
}

fn of_stops(stops: &[Stop], t: f64) -> [f64; 4] {
    let after = stops.partition_point(|stop| stop.offset <= t);
    match (after.checked_sub(1).and_then(|k| stops.get(k)), stops.get(after)) {
        (Some(from), Some(to)) => {
            let share = (t - from.offset) / (to.offset - from.offset);
            std::array::from_fn(|c| from.colour[c] + share * (to.colour[c] - from.colour[c]))
        }
        (Some(only), None) | (None, Some(only)) => only.colour,
        (None, None) => [0.0; 4],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::Placement;

    fn gradient(kind: GradientKind, spread: Spread) -> Gradient {
        let stop = |offset: f64, red: f64| Stop {
            offset,
            colour: [red, 0.0, 0.0, 1.0],
        };
        Gradient {
            kind,
            placement: Placement {
                along_x: Point::new(10.0, 0.0),
                along_y: Point::new(0.0, 10.0),
                origin: Point::new(5.0, 5.0),
            },
            spread,
            stops: vec![stop(0.0, 0.0), stop(0.5, 0.2), stop(1.0, 1.0)],
        }
    }

    #[test]
    fn colours_follow_the_gradient_and_its_spread() {
        let red = |gradient: &Gradient, x: f64| colour_at(gradient, Point::new(x, 5.0))[0];
        let linear = |spread| gradient(GradientKind::Linear, spread);
        for (x, expected) in [(0.0, 0.0), (7.5, 0.1), (10.0, 0.2), (12.5, 0.6), (99.0, 1.0)] {
            assert!((red(&linear(Spread::Pad), x) - expected).abs() < 1e-12);
        }
        assert!((red(&linear(Spread::Repeat), 17.5) - 0.1).abs() < 1e-12);
        assert!((red(&linear(Spread::Reflect), 17.5) - 0.6).abs() < 1e-12);
        let focus = Point::new(0.5, 0.0);
        let radial = gradient(GradientKind::Radial { focus }, Spread::Pad);
        assert!(red(&radial, 10.0).abs() < 1e-12, "the focus");
        for x in [15.0, -5.0] {
            assert!((red(&radial, x) - 1.0).abs() < 1e-12, "the circle");
        }
        // Half of the way to either side of the circle.
        for x in [12.5, 2.5] {
            assert!((red(&radial, x) - 0.2).abs() < 1e-12);
        }
        let mut squeezed = linear(Spread::Pad);
        squeezed.placement.along_y = Point::new(3.0, 0.0);
        assert_eq!(red(&squeezed, 5.0), 1.0);
    }
}
