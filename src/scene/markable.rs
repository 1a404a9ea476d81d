//! Which places can be landmarks of parts that were written as pictures: they are read again with outlines of their own.

use crate::input::{BitmapOptions, FigureRule, Picture, read_pixels};
use crate::math::{Point, point};
use crate::outline::ArcLength;

/// On the outline is what is no farther from it than this, as a fraction of the figure's diagonal: less than what a landmark may be off.
const ON: f64 = 0.025;

/// A picture's figure, as it is read again.
pub(super) struct Figure<'a> {
    picture: &'a Picture,
    outer: ArcLength,
    /// Of holes and openings.
    others: Vec<ArcLength>,
    diagonal: f64,
}

impl<'a> Figure<'a> {
    /// `None` if nothing is on the picture.
    pub(super) fn of(picture: &'a Picture) -> Option<Self> {
        let alphas: Vec<u8> = picture.pixels.iter().flat_map(|pixel| [0, 0, 0, pixel[3]]).collect();
        let options = BitmapOptions {
            figure: FigureRule::Alpha,
            ..BitmapOptions::default()
        };
        let outline = read_pixels([picture.width, picture.height], &alphas, &options)
            .ok()?
            .outline;
        let others = outline.holes().iter().chain(outline.openings()).map(ArcLength::new);
        Some(Self {
            picture,
            outer: ArcLength::new(outline.outer()),
            others: others.collect(),
            diagonal: point::diagonal(outline.outer().points()),
        })
    }

    /// Whether a place of the drawing, in source units, is on the outer outline, and not at a hole.
    fn is_on_outline(&self, place: Point) -> bool {
        let p = self.picture.to_pixels(place);
        let is_near = |ring: &ArcLength| (ring.at(ring.nearest(p).0) - p).norm() < ON * self.diagonal;
        is_near(&self.outer) && !self.others.iter().any(is_near)
    }
}

/// Whether a landmark that has these places on these figures is on the outline of all of them; there is at least one.
pub(super) fn are_on_outlines<'a>(places: impl IntoIterator<Item = (&'a Figure<'a>, Point)>) -> bool {
    let mut places = places.into_iter().peekable();
    places.peek().is_some() && places.all(|(figure, place)| figure.is_on_outline(place))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_inside_at_a_hole_or_outside_of_one_figure_is_not_on_all_outlines() {
        // A square of 80 with a hole of 20, two pixels a unit, from (10, 10).
        let pixels = (0..100 * 100).map(|k| {
            let [x, y] = [k % 100, k / 100];
            let is_in = |low: usize, high: usize| (low..high).contains(&x) && (low..high).contains(&y);
            [0, 0, 0, if is_in(10, 90) && !is_in(60, 80) { 255 } else { 0 }]
        });
        let picture = Picture {
            width: 100,
            height: 100,
            pixels: pixels.collect(),
            origin: Point::new(10.0, 10.0),
            pixels_per_unit: 2.0,
        };
        let figure = Figure::of(&picture).expect("a figure");
        let at = |x: f64, y: f64| (&figure, Point::new(10.0 + x / 2.0, 10.0 + y / 2.0));
        let is_on = |x: f64, y: f64| are_on_outlines([at(x, y)]);
        assert!(is_on(10.5, 50.0));
        assert!(!is_on(30.0, 30.0));
        assert!(!is_on(60.5, 70.0));
        assert!(!is_on(2.0, 2.0));
        assert!(are_on_outlines([at(10.5, 50.0), at(50.0, 89.0)]));
        assert!(!are_on_outlines([at(10.5, 50.0), at(30.0, 30.0)]));
        assert!(!are_on_outlines([at(12.0, 50.0), at(30.0, 30.0)]));
    }
}
