//! Places of double precision for libraries and devices that have single precision.

use super::Point;
use super::point::bounding_box;

/// The bits of a double's exponent, and what is added to it.
const EXPONENT: (u64, i32) = (0x7ff, 1022);

/// How places of double precision become places of single precision: the middle of a box goes to the origin, and a power of two
/// scales the box into the square from -1 to 1.
///
/// There, neighbouring numbers of single precision are at most 2⁻²⁴ apart, so that a place that goes there and back is off by at most
/// [`Self::precision`] in each coordinate, however far from the origin the box lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SinglePrecision {
    centre: Point,
    scale: f64,
}

/// Why a place has no single precision.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NotSingle {
    /// A coordinate is not finite, in double precision or in single.
    #[error("({x}, {y}) cannot be said in single precision; give finite coordinates that are not as large")]
    NotFinite {
        /// Its x.
        x: f64,
        /// Its y.
        y: f64,
    },
}

impl SinglePrecision {
    /// Coordinates as they are: with single precision's 24 bits, a place 1,000 units from the origin is off by up to 3e-5 units.
    pub const UNCHANGED: Self = Self {
        centre: Point::new(0.0, 0.0),
        scale: 1.0,
    };

    /// For places in the box of `points`; as they are for no points.
    ///
    /// # Errors
    /// [`NotSingle`] if a coordinate is not finite.
    pub fn fitting<'a>(points: impl IntoIterator<Item = &'a Point> + Clone) -> Result<Self, NotSingle> {
        // A box hides what is not a number.
        if let Some(p) = points.clone().into_iter().find(|p| !super::point::is_finite(**p)) {
            return Err(NotSingle::NotFinite { x: p.x, y: p.y });
        }
        let Some((low, high)) = bounding_box(points) else {
            return Ok(Self::UNCHANGED);
        };
        let half = (high * 0.5 - low * 0.5).max();
        Ok(Self {
            centre: low * 0.5 + high * 0.5,
            scale: power_above(half).recip(),
        })
    }

    /// A place in single precision.
    ///
    /// # Errors
    /// [`NotSingle`] if a coordinate is not finite there.
    pub fn to_single(&self, p: Point) -> Result<[f32; 2], NotSingle> {
        let q = (p - self.centre) * self.scale;
        let single = [q.x as f32, q.y as f32];
        if single.iter().all(|c| c.is_finite()) {
            Ok(single)
        } else {
            Err(NotSingle::NotFinite { x: p.x, y: p.y })
        }
    }

    /// The place in double precision.
    #[must_use]
    pub fn to_double(&self, [x, y]: [f32; 2]) -> Point {
        Point::new(f64::from(x), f64::from(y)) / self.scale + self.centre
    }

    /// What lengths are multiplied by on the way to single precision: a power of two.
    #[must_use]
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// By how much a coordinate in the box may be off when it comes back: half of the distance of neighbouring numbers at 1, and a
    /// rounding of double precision.
    #[must_use]
    pub fn precision(&self) -> f64 {
        0.5_f64.powi(25) / self.scale + self.centre.amax() * f64::EPSILON
    }
}

/// The least power of two above a positive number, 1 for 0; in the range in which its reciprocal is a normal number, too.
fn power_above(number: f64) -> f64 {
    if number == 0.0 {
        return 1.0;
    }
    let exponent = (number.to_bits() >> 52 & EXPONENT.0) as i32 - EXPONENT.1;
    2.0_f64.powi(exponent.clamp(-1000, 1000))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn what_is_not_finite_is_refused() {
        for bad in [f64::NAN, f64::INFINITY] {
            let points = [Point::new(0.0, 1.0), Point::new(2.0, bad)];
            SinglePrecision::fitting(&points).expect_err("not finite");
            SinglePrecision::UNCHANGED.to_single(points[1]).expect_err("not finite");
        }
        SinglePrecision::UNCHANGED
            .to_single(Point::new(1e39, 0.0))
            .expect_err("too large");
    }

    #[test]
    fn powers_are_those_above() {
        for (number, power) in [(0.75, 1.0), (1.0, 2.0), (3.0, 4.0), (1e-3, 2.0_f64.powi(-9))] {
            assert_eq!(power_above(number), power);
        }
    }

    proptest! {
        #[test]
        fn there_and_back_is_as_precise_as_it_says(
            far in -1e7..1e7f64,
            points in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64), 1..8),
            size in 1e-3..1e6f64,
        ) {
            let points: Vec<Point> = points.iter().map(|(x, y)| Point::new(far + x * size, y * size)).collect();
            let single = SinglePrecision::fitting(&points).expect("finite");
            for p in points {
                let q = single.to_single(p).expect("finite");
                prop_assert!(q.iter().all(|c| c.abs() <= 1.0));
                prop_assert!((single.to_double(q) - p).amax() <= single.precision());
            }
        }
    }
}
