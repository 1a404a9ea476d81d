//! On which sides of the lines that divide the shape a point lies, in every pose.
//!
//! A line with both ends on the outline cuts the polygon in two, in the same way in every pose: what lies on one side in one
//! pose has to lie on that side in all. A point that a pose lacks is carried there by the corresponding polygons
//! ([`inside::predicted`]); where that takes it across a line, by the parts of the polygons beside the line instead.

use super::inside;
use crate::math::Point;
use crate::outline::{Outline, Ring};

/// The lines so far.
#[derive(Default)]
pub(super) struct Sides {
    lines: Vec<Line>,
}

/// The two parts into which a line cuts the outer polygon: #poses each, corresponding point by point.
struct Line {
    parts: [Vec<Vec<Point>>; 2],
    /// The first parts, to ask whether a point is in them.
    first: Vec<Option<Ring>>,
}

impl Sides {
    /// Adds a line from one vertex of the outer rings to another over `points` (#points x #poses).
    pub(super) fn add_line(&mut self, polygons: &[Outline], [from, to]: [usize; 2], points: &[Vec<Point>]) {
        if from == to {
            return;
        }
        let along = |polygon: &Outline, from: usize, to: usize| -> Vec<Point> {
            let (ring, count) = (polygon.outer(), polygon.outer().len());
            (0..=(to + count - from) % count)
                .map(|k| ring.point(from + k))
                .collect()
        };
        let part = |pose: usize, polygon: &Outline, is_first: bool| {
            let between = points.iter().map(|places| places[pose]);
            if is_first {
                along(polygon, to, from).into_iter().chain(between).collect()
            } else {
                along(polygon, from, to).into_iter().chain(between.rev()).collect()
            }
        };
        let parts = [true, false].map(|is_first| -> Vec<Vec<Point>> {
            let numbered = polygons.iter().enumerate();
            numbered.map(|(pose, polygon)| part(pose, polygon, is_first)).collect()
        });
        let first = parts[0]
            .iter()
            .map(|part| Ring::new(part.iter().copied()).ok())
            .collect();
        self.lines.push(Line { parts, first });
    }

    /// The side of every line, as the part that holds the place.
    pub(super) fn of(&self, pose: usize, place: Point) -> Vec<usize> {
        let is_first = |line: &Line| line.first[pose].as_ref().is_some_and(|part| part.contains(place));
        self.lines.iter().map(|line| usize::from(!is_first(line))).collect()
    }

    /// The sides of the first pose that has the point; `None` if none has.
    pub(super) fn wanted(&self, places: &[Option<Point>]) -> Option<Vec<usize>> {
        let given = places
            .iter()
            .enumerate()
            .find_map(|(pose, place)| Some((pose, (*place)?)));
        given.map(|(pose, place)| self.of(pose, place))
    }

    /// A point's place in a pose that lacks it, on the sides where it should be if it can be carried there.
    pub(super) fn predicted(&self, polygons: &[Outline], places: &[Option<Point>], pose: usize) -> Option<Point> {
        let wanted = self.wanted(places)?;
        let plain = inside::predicted(polygons, places, pose)?;
        let found = self.of(pose, plain);
        let Some(crossed) = (0..wanted.len()).find(|&line| found[line] != wanted[line]) else {
            return Some(plain);
        };
        let parts: Vec<Vec<&[Point]>> = self.lines[crossed].parts[wanted[crossed]]
            .iter()
            .map(|part| vec![part.as_slice()])
            .collect();
        inside::predicted_in(&parts, places, pose).or(Some(plain))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Outline {
        let corners = [[0.0, 0.0], [8.0, 0.0], [8.0, 8.0], [0.0, 8.0]].map(Point::from);
        Outline::new(Ring::new(corners).expect("a ring"), vec![]).expect("an outline")
    }

    #[test]
    fn a_point_stays_on_its_side_of_a_line_that_bends() {
        let polygons = [square(), square()];
        let mut sides = Sides::default();
        // From corner to corner, straight in one pose and bent in the other.
        sides.add_line(&polygons, [0, 2], &[vec![Point::new(4.0, 4.0), Point::new(2.5, 5.5)]]);
        let place = Point::new(3.0, 5.0);
        let places = [Some(place), None];
        let plain = inside::predicted(&polygons, &places, 1).expect("carried");
        assert_ne!(sides.of(1, plain), sides.of(0, place), "the line has passed it");
        let carried = sides.predicted(&polygons, &places, 1).expect("carried");
        assert_eq!(sides.of(1, carried), sides.of(0, place));
        assert!(polygons[1].contains(carried));
        // On the other side nothing changes.
        let other = [Some(Point::new(5.0, 3.0)), None];
        assert_eq!(
            sides.predicted(&polygons, &other, 1),
            inside::predicted(&polygons, &other, 1)
        );
    }
}
