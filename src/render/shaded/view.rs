//! From where a form is looked at, and which part of the view a picture shows.

use crate::math::Point3;

/// The part of a window that is left free on each side.
const MARGIN: f64 = 0.06;

/// A direction to look from. Forms have y up; seen are x to the right, y up, z towards the eye.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct View {
    yaw: [f64; 2],
    pitch: [f64; 2],
}

impl View {
    /// The form turned to the right by `yaw_degrees` about y, and looked at from `pitch_degrees` above.
    #[must_use]
    pub(crate) fn new(yaw_degrees: f64, pitch_degrees: f64) -> Self {
        let turn = |degrees: f64| {
            let (sin, cos) = libm::sincos(degrees.to_radians());
            [sin, cos]
        };
        Self {
            yaw: turn(yaw_degrees),
            pitch: turn(pitch_degrees),
        }
    }

    /// A point or direction as it is seen.
    #[must_use]
    pub(crate) fn turned(&self, p: Point3) -> Point3 {
        let ([sin, cos], [sin_pitch, cos_pitch]) = (self.yaw, self.pitch);
        let (x, z) = (cos * p.x + sin * p.z, cos * p.z - sin * p.x);
        Point3::new(x, cos_pitch * p.y - sin_pitch * z, sin_pitch * p.y + cos_pitch * z)
    }

    /// The box of points as they are seen, its least and greatest corner; `None` without a finite one.
    #[must_use]
    pub(crate) fn bounds<'a>(&self, points: impl IntoIterator<Item = &'a Point3>) -> Option<[Point3; 2]> {
        let seen = points.into_iter().map(|p| self.turned(*p));
        let finite = seen.filter(|p| p.iter().all(|x| x.is_finite()));
        finite.fold(None, |bounds, p| match bounds {
            None => Some([p, p]),
            Some([low, high]) => Some([low.inf(&p), high.sup(&p)]),
        })
    }
}

/// The part of a view that a picture shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Window {
    /// Columns and rows.
    pub size: [usize; 2],
    middle: [f64; 2],
    pixels_per_unit: f64,
}

impl Window {
    /// A picture of `size` columns and rows with all of a box in it, as large as it can be, with a margin.
    #[must_use]
    pub(crate) fn around([low, high]: [Point3; 2], size: [usize; 2]) -> Self {
        let extent = high - low;
        let room = |side: usize| side as f64 * (1.0 - 2.0 * MARGIN);
        let scale = (room(size[0]) / extent.x).min(room(size[1]) / extent.y);
        Self {
            size,
            middle: [0.5 * (low.x + high.x), 0.5 * (low.y + high.y)],
            // A box without extent.
            pixels_per_unit: if scale.is_finite() { scale } else { 1.0 },
        }
    }

    /// Where a point of the view lies in the picture, in pixels from its upper left corner.
    #[must_use]
    pub(crate) fn place(&self, seen: &Point3) -> [f64; 2] {
        [
            0.5 * self.size[0] as f64 + (seen.x - self.middle[0]) * self.pixels_per_unit,
            0.5 * self.size[1] as f64 - (seen.y - self.middle[1]) * self.pixels_per_unit,
        ]
    }
}
