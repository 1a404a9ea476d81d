//! What a loose part is known by.

use crate::input::Picture;
use crate::math::{Point, point};
use crate::outline::{ArcLength, Outline};

/// Samples along the longer side of a part's box that its colour is taken from.
const COLOUR_SAMPLES: usize = 24;

/// A part of one pose, measured.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PartShape {
    /// Its area, in source units squared, holes subtracted.
    pub area: f64,
    /// The centroid of its outer ring, in source units.
    pub centroid: Point,
    /// Its box: lower and upper corner, in source units.
    pub bounds: [Point; 2],
    /// Mean colour: red, green, blue, not multiplied by alpha, and alpha; each from 0 to 1.
    pub colour: [f64; 4],
    /// How much longer than wide it is, as the logarithm of the ratio of the axes of its ellipse of inertia; 0 or more.
    pub elongation: f64,
    /// The landmarks that lie on it, by number.
    pub landmarks: Vec<usize>,
}

impl PartShape {
    /// The part of `outline`, painted as in `picture`; no landmark lies on it.
    #[must_use]
    pub(crate) fn of(outline: &Outline, picture: &Picture) -> Self {
        let points = outline.outer().points();
        let (low, high) = point::bounding_box(points).unwrap_or_default();
        let moments = Moments::of(points);
        Self {
            area: outline.area(),
            centroid: moments.centroid,
            bounds: [low, high],
            colour: colour(outline, picture, [low, high]),
            elongation: moments.elongation,
            landmarks: Vec::new(),
        }
    }

    /// The part reflected left to right: x becomes `axis - x`.
    #[must_use]
    pub(crate) fn mirrored(mut self, axis: f64) -> Self {
        let [low, high] = self.bounds;
        self.centroid.x = axis - self.centroid.x;
        self.bounds = [Point::new(axis - high.x, low.y), Point::new(axis - low.x, high.y)];
        self
    }

    /// Its width and height.
    #[must_use]
    pub(crate) fn extent(&self) -> Point {
        self.bounds[1] - self.bounds[0]
    }

    /// Whether it lies behind what stands over it: it is translucent, or grey, flat and at the foot of `body`, as a shadow on the ground is.
    #[must_use]
    pub(crate) fn is_shadow_of(&self, body: &Self) -> bool {
        /// Paint that is meant to be opaque is, but for its edge.
        const OPAQUE: f64 = 0.9;
        /// The most that channels of a grey differ.
        const GREY: f64 = 0.15;
        /// How much wider than high it is at least.
        const FLAT: f64 = 2.5;
        let [red, green, blue, alpha] = self.colour;
        let spread = red.max(green).max(blue) - red.min(green).min(blue);
        let is_at_foot = self.centroid.y > body.centroid.y + 0.25 * body.extent().y;
        let is_flat = self.extent().x > FLAT * self.extent().y;
        is_at_foot && (alpha < OPAQUE || spread < GREY) && is_flat
    }
}

/// The part that a place belongs to: the one that it lies in, or else the nearest. `None` where there are no parts.
#[must_use]
pub(crate) fn nearest_part<'a>(parts: impl IntoIterator<Item = &'a Outline>, place: Point) -> Option<usize> {
    let distance = |outline: &Outline| {
        if outline.contains(place) {
            0.0
        } else {
            let rings = outline.rings().iter();
            rings
                .map(|ring| ArcLength::new(ring).nearest(place).1)
                .fold(f64::INFINITY, f64::min)
        }
    };
    let distances = parts.into_iter().map(distance).enumerate();
    distances.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(part, _)| part)
}

struct Moments {
    centroid: Point,
    elongation: f64,
}

impl Moments {
    /// Of the inside of a polygon, by Green's theorem.
    fn of(points: &[Point]) -> Self {
        let origin = points.first().copied().unwrap_or_default();
        let (mut area, mut first) = (0.0, Point::zeros());
        let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
        for (a, b) in points.iter().zip(points.iter().cycle().skip(1)) {
            let (a, b) = (*a - origin, *b - origin);
            let doubled = point::cross(a, b);
            area += doubled / 2.0;
            first += (a + b) * (doubled / 6.0);
            xx += doubled * (a.x * a.x + a.x * b.x + b.x * b.x) / 12.0;
            yy += doubled * (a.y * a.y + a.y * b.y + b.y * b.y) / 12.0;
            xy += doubled * (2.0 * a.x * a.y + a.x * b.y + b.x * a.y + 2.0 * b.x * b.y) / 24.0;
        }
        if area <= 0.0 {
            return Self {
                centroid: origin,
                elongation: 0.0,
            };
        }
        let mean = first / area;
        let (xx, yy, xy) = (
            xx / area - mean.x * mean.x,
            yy / area - mean.y * mean.y,
            xy / area - mean.x * mean.y,
        );
        let (half, spread) = ((xx + yy) / 2.0, ((xx - yy) / 2.0).hypot(xy));
        let ratio = (half + spread) / (half - spread);
        Self {
            centroid: origin + mean,
            // Axes go by the roots of the moments.
            elongation: if ratio.is_finite() && ratio > 1.0 {
                0.5 * ratio.ln()
            } else {
                0.0
            },
        }
    }
}

/// The mean colour of the picture inside the outline, on an even grid.
fn colour(outline: &Outline, picture: &Picture, [low, high]: [Point; 2]) -> [f64; 4] {
    let step = (high - low).max() / COLOUR_SAMPLES as f64;
    let (mut sums, mut count) = ([0.0; 4], 0.0);
    for row in 0..COLOUR_SAMPLES {
        for column in 0..COLOUR_SAMPLES {
            let place = low + Point::new(column as f64 + 0.5, row as f64 + 0.5) * step;
            if place.x > high.x || place.y > high.y || !outline.contains(place) {
                continue;
            }
            let pixel = picture.to_pixels(place);
            // Casts saturate.
            let at = (pixel.y as usize)
                .saturating_mul(picture.width)
                .saturating_add(pixel.x as usize);
            let Some(colour) = picture.pixels.get(at).filter(|_| (pixel.x as usize) < picture.width) else {
                continue;
            };
            for (sum, channel) in sums.iter_mut().zip(colour) {
                *sum += f64::from(*channel) / 255.0;
            }
            count += 1.0;
        }
    }
    let [red, green, blue, alpha] = sums;
    if alpha == 0.0 {
        return [0.0, 0.0, 0.0, 0.0];
    }
    [red / alpha, green / alpha, blue / alpha, alpha / count]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outline::Ring;

    fn bar(left: f64, top: f64, right: f64, bottom: f64) -> Outline {
        let corners = [[left, top], [right, top], [right, bottom], [left, bottom]].map(Point::from);
        Outline::new(Ring::new(corners).expect("a ring"), vec![]).expect("simple")
    }

    #[test]
    fn a_part_is_measured() {
        let picture = Picture {
            width: 10,
            height: 10,
            pixels: (0..100)
                .map(|k| if k % 10 < 5 { [128, 0, 0, 128] } else { [0; 4] })
                .collect(),
            origin: Point::zeros(),
            pixels_per_unit: 1.0,
        };
        let part = PartShape::of(&bar(1.0, 2.0, 5.0, 3.0), &picture);
        assert_eq!((part.area, part.centroid), (4.0, Point::new(3.0, 2.5)));
        // Four times as long as wide.
        assert!((part.elongation - 4.0_f64.ln()).abs() < 1e-9);
        assert!((part.colour[0] - 1.0).abs() < 1e-9 && (part.colour[3] - 128.0 / 255.0).abs() < 1e-9);
        let reflected = part.mirrored(10.0);
        assert_eq!((reflected.centroid.x, reflected.bounds[0].x), (7.0, 5.0));
    }

    #[test]
    fn a_place_belongs_to_the_part_around_it_or_the_nearest() {
        let parts = [bar(0.0, 0.0, 4.0, 4.0), bar(10.0, 0.0, 11.0, 1.0)];
        assert_eq!(nearest_part(&parts, Point::new(1.0, 1.0)), Some(0));
        assert_eq!(nearest_part(&parts, Point::new(8.0, 0.5)), Some(1));
        assert_eq!(nearest_part(&[], Point::zeros()), None);
    }
}
