//! Words beside points, placed so that they cover neither one another nor the drawing.
//!
//! Every label tries places around its point, near ones in the wanted direction first, and takes the one that overlaps
//! least. Cost O(#labels x #places x #things in the way).

use std::f64::consts::TAU;

use crate::math::{Matrix, Point, matrix};

/// Directions that are tried.
const DIRECTIONS: usize = 16;
/// Distances from the point that are tried, in pixels.
const DISTANCES_PX: [f64; 8] = [6.0, 11.0, 18.0, 27.0, 38.0, 52.0, 70.0, 92.0];
/// A label that need not be there is left out beyond this distance, in pixels.
const NEAR_PX: f64 = 27.0;
/// A label further away than this gets a line to its point.
pub(super) const LEADER_PX: f64 = 12.0;
/// What overlaps cost, per square pixel: another label; a line; the space outside.
const OVERLAP_COSTS: [f64; 3] = [2.0, 0.5, 20.0];
/// What a pixel of distance costs, and the opposite of the wanted direction.
const DISTANCE_COST: f64 = 0.8;
const DIRECTION_COST: f64 = 8.0;

/// A box along the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Area {
    pub(super) low: Point,
    pub(super) high: Point,
}

impl Area {
    pub(super) fn around(centre: Point, half: Point) -> Self {
        Self {
            low: centre - half,
            high: centre + half,
        }
    }

    pub(super) fn middle(&self) -> Point {
        (self.low + self.high) * 0.5
    }

    fn overlap(&self, other: &Self) -> f64 {
        let shared = self.high.inf(&other.high) - self.low.sup(&other.low);
        shared.x.max(0.0) * shared.y.max(0.0)
    }

    fn size(&self) -> f64 {
        (self.high - self.low).product()
    }
}

/// Where a label came to stand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Placed {
    pub(super) area: Area,
    /// From the point to the label.
    pub(super) distance: f64,
    /// How much of other labels it covers, in square pixels.
    pub(super) covers: f64,
}

/// Whether a label has to be there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Need {
    /// Even if it covers something.
    Must,
    /// Only where there is room near its point.
    IfFree,
}

/// The labels of one part of a picture.
#[derive(Debug)]
pub(super) struct Labels {
    bounds: Area,
    taken: Vec<Area>,
    lines: Vec<Area>,
}

impl Labels {
    /// No labels yet, within `bounds`.
    pub(super) fn within(bounds: Area) -> Self {
        Self {
            bounds,
            taken: Vec::new(),
            lines: Vec::new(),
        }
    }

    /// Something that must stay visible.
    pub(super) fn keep_free(&mut self, area: Area) {
        self.taken.push(area);
    }

    /// A line that labels should not cover, given by places a few pixels apart.
    pub(super) fn avoid(&mut self, places: &[Point]) {
        self.lines
            .extend(places.iter().map(|p| Area::around(*p, Point::repeat(2.0))));
    }

    /// Finds the place of a label of some size beside `point`, if possible in the direction of `wanted`.
    pub(super) fn place(&mut self, point: Point, size: Point, wanted: Point, need: Need) -> Option<Placed> {
        let wanted = wanted.try_normalize(0.0).unwrap_or(Point::new(1.0, 0.0));
        let half = size * 0.5;
        let mut best: Option<(f64, Placed)> = None;
        for distance in DISTANCES_PX {
            for k in 0..DIRECTIONS {
                let turn: Matrix = matrix::rotation(TAU * k as f64 / DIRECTIONS as f64);
                let direction = turn * wanted;
                let area = Area::around(point + direction * distance + direction.component_mul(&half), half);
                let over = |areas: &[Area]| areas.iter().map(|other| area.overlap(other)).sum::<f64>();
                let covers = over(&self.taken);
                let outside = area.size() - area.overlap(&self.bounds);
                let cost = OVERLAP_COSTS[0] * covers
                    + OVERLAP_COSTS[1] * over(&self.lines)
                    + OVERLAP_COSTS[2] * outside
                    + DISTANCE_COST * distance
                    + DIRECTION_COST * 0.5 * (1.0 - direction.dot(&wanted));
                if best.is_none_or(|(least, _)| cost < least) {
                    let placed = Placed { area, distance, covers };
                    best = Some((cost, placed));
                }
            }
        }
        let (_, placed) = best?;
        if need == Need::IfFree && (placed.covers > 0.0 || placed.distance > NEAR_PX) {
            return None;
        }
        self.taken.push(placed.area);
        Some(placed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_of_one_point_do_not_overlap_and_stay_inside() {
        let bounds = Area {
            low: Point::zeros(),
            high: Point::repeat(200.0),
        };
        let mut labels = Labels::within(bounds);
        let places: Vec<Area> = (0..8)
            .map(|_| {
                let (point, left) = (Point::new(5.0, 100.0), Point::new(-1.0, 0.0));
                let placed = labels.place(point, Point::new(30.0, 8.0), left, Need::Must);
                placed.expect("a place").area
            })
            .collect();
        for (k, area) in places.iter().enumerate() {
            assert!(
                (area.overlap(&bounds) - 240.0).abs() < 1e-9,
                "label {k} leaves the sheet"
            );
            assert!(
                places[..k].iter().all(|other| area.overlap(other) < 1e-9),
                "label {k} covers another"
            );
        }
    }

    #[test]
    fn a_free_label_stands_where_it_is_wanted() {
        let mut labels = Labels::within(Area::around(Point::zeros(), Point::repeat(100.0)));
        let placed = labels
            .place(
                Point::zeros(),
                Point::new(20.0, 10.0),
                Point::new(0.0, 2.0),
                Need::IfFree,
            )
            .expect("a place");
        assert!((placed.area.low - Point::new(-10.0, 6.0)).norm() < 1e-12);
        assert_eq!((placed.distance, placed.covers), (6.0, 0.0));
    }

    #[test]
    fn a_label_without_room_is_left_out_unless_it_must_be_there() {
        let bounds = Area::around(Point::zeros(), Point::repeat(100.0));
        let mut labels = Labels::within(bounds);
        labels.keep_free(bounds);
        let mut place = |need| labels.place(Point::zeros(), Point::new(20.0, 10.0), Point::new(1.0, 0.0), need);
        assert_eq!(place(Need::IfFree), None);
        assert!(place(Need::Must).is_some_and(|placed| placed.covers > 0.0));
    }
}
