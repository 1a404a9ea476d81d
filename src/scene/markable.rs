//! Which places can be landmarks of parts that were written as pictures: they are read again with outlines of their own.

use crate::input::{BitmapOptions, FigureRule, Picture, read_pixels};
use crate::math::{Point, point};
use crate::outline::ArcLength;

/// On the outline is what is no farther from it than this, as a fraction of the figure's diagonal: less than what a landmark may be off.
const ON: f64 = 0.025;
/// Inside is what is this deep inside at least: more than what makes a landmark an inner one.
const INSIDE: f64 = 0.012;

/// Where a place is on figures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    OnOutline,
    Inside,
    /// On the outline of one and not of another, at a hole, or outside.
    Unclear,
}

/// A picture's figure, as it is read again.
pub(super) struct Figure<'a> {
    picture: &'a Picture,
    outer: ArcLength,
    /// Of holes and openings.
    others: Vec<ArcLength>,
    contains: Box<dyn Fn(Point) -> bool>,
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
            contains: Box::new(move |p| outline.outer().contains(p)),
        })
    }

    /// Whether a place of the drawing, in source units, is on the outline, and whether it is inside; both may be.
    fn is_on_and_inside(&self, place: Point) -> [bool; 2] {
        let p = self.picture.to_pixels(place);
        let away = |ring: &ArcLength| (ring.at(ring.nearest(p).0) - p).norm() / self.diagonal;
        if self.others.iter().any(|ring| away(ring) < ON) {
            return [false; 2];
        }
        let outer = away(&self.outer);
        [outer < ON, outer > INSIDE && (self.contains)(p)]
    }
}

/// Where a landmark is that has these places on these figures, if that is the same on all of them.
pub(super) fn same_place<'a>(places: impl IntoIterator<Item = (&'a Figure<'a>, Point)>) -> Place {
    let mut all = None;
    for (figure, place) in places {
        let [on, inside] = figure.is_on_and_inside(place);
        let [so_far_on, so_far_inside] = all.unwrap_or([true; 2]);
        all = Some([so_far_on && on, so_far_inside && inside]);
    }
    match all {
        Some([true, _]) => Place::OnOutline,
        Some([false, true]) => Place::Inside,
        _ => Place::Unclear,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_on_the_outline_inside_or_unclear() {
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
        let place = |x: f64, y: f64| same_place([at(x, y)]);
        assert_eq!(place(10.5, 50.0), Place::OnOutline);
        assert_eq!(place(30.0, 30.0), Place::Inside);
        assert_eq!(place(60.5, 70.0), Place::Unclear);
        assert_eq!(place(2.0, 2.0), Place::Unclear);
        assert_eq!(same_place([at(10.5, 50.0), at(50.0, 89.0)]), Place::OnOutline);
        assert_eq!(same_place([at(10.5, 50.0), at(30.0, 30.0)]), Place::Unclear);
        // A little inside of one outline and deep inside another is inside of both.
        assert_eq!(same_place([at(12.0, 50.0), at(30.0, 30.0)]), Place::Inside);
    }
}
