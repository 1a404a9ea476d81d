//! Where a point inside the shape goes in a pose that lacks it.
//!
//! 1. Mean value coordinates (Hormann and Floater 2006) with respect to the corresponding polygons, holes included,
//!    carry it from every pose that has it; the mean of these is the prediction.
//! 2. If that is not inside with some room about it, the nearest place of a grid that is takes its place.

use crate::math::{Point, point};
use crate::outline::Outline;

/// The room about a placed point, as a fraction of the pose's diagonal: half an ink line. Halved where there is less.
const ROOM: f64 = 0.005;

/// How often the room is halved and the grid made finer.
const HALVINGS: u32 = 3;

/// Cells along each side of the first grid.
const CELLS: u32 = 48;

/// A point's place in `pose`, predicted from its places in the others; `None` if no pose has it.
pub(super) fn predicted(polygons: &[Outline], places: &[Option<Point>], pose: usize) -> Option<Point> {
    let shapes: Vec<Vec<&[Point]>> = polygons
        .iter()
        .map(|polygon| polygon.rings().iter().map(|ring| ring.points()).collect())
        .collect();
    predicted_in(&shapes, places, pose)
}

/// As [`predicted`], within any shapes that correspond point by point, each a list of rings.
pub(super) fn predicted_in(shapes: &[Vec<&[Point]>], places: &[Option<Point>], pose: usize) -> Option<Point> {
    let target: Vec<Point> = shapes[pose].concat();
    let mut sum = Point::zeros();
    let mut count = 0.0;
    for (shape, place) in shapes.iter().zip(places) {
        if let Some(place) = place {
            let weights = mean_value_weights(shape, *place);
            sum += weights
                .iter()
                .zip(&target)
                .map(|(weight, p)| p * *weight)
                .sum::<Point>();
            count += 1.0;
        }
    }
    (count > 0.0 && point::is_finite(sum)).then(|| sum / count)
}

/// Mean value coordinates of a point inside, one a vertex; they sum to 1 and reproduce the point.
fn mean_value_weights(shape: &[&[Point]], p: Point) -> Vec<f64> {
    let mut weights = Vec::new();
    for ring in shape {
        let start = weights.len();
        weights.resize(start + ring.len(), 0.0);
        for (k, a) in ring.iter().enumerate() {
            let (u, v) = (a - p, ring[(k + 1) % ring.len()] - p);
            // tan(angle / 2) between the directions to the two ends.
            let half_tangent = point::cross(u, v) / (u.norm() * v.norm() + u.dot(&v));
            if half_tangent.is_finite() {
                weights[start + k] += half_tangent / u.norm();
                weights[start + (k + 1) % ring.len()] += half_tangent / v.norm();
            }
        }
    }
    let sum: f64 = weights.iter().sum();
    weights.iter().map(|weight| weight / sum).collect()
}

/// What a placed point keeps away from, in one pose.
pub(super) struct Obstacles {
    segments: Vec<(Point, Point)>,
}

impl Obstacles {
    pub(super) fn new(polygon: &Outline) -> Self {
        Self {
            segments: polygon.rings().iter().flat_map(|ring| ring.edges()).collect(),
        }
    }

    pub(super) fn add_point(&mut self, place: Point) {
        self.segments.push((place, place));
    }

    pub(super) fn add_line(&mut self, places: impl IntoIterator<Item = Point>) {
        let places: Vec<Point> = places.into_iter().collect();
        self.segments.extend(places.windows(2).map(|link| (link[0], link[1])));
    }

    /// The place itself if there is room about it and it is allowed, else the nearest such place of a grid; `None` if there
    /// is none.
    pub(super) fn nearest_free(
        &self,
        polygon: &Outline,
        place: Point,
        is_allowed: impl Fn(Point) -> bool,
    ) -> Option<Point> {
        let (low, high) = point::bounding_box(polygon.outer().points())?;
        (0..=HALVINGS).find_map(|halving| {
            let share = 0.5_f64.powi(halving as i32);
            let room = ROOM * share * (high - low).norm();
            let is_free = |p: Point| {
                let away = |&(a, b): &(Point, Point)| point::nearest_on_segment(p, a, b).1 >= room;
                polygon.contains(p) && self.segments.iter().all(away) && is_allowed(p)
            };
            if is_free(place) {
                return Some(place);
            }
            let cells = CELLS << halving;
            let at = |i: u32, j: u32| {
                let share = Point::new(f64::from(i), f64::from(j)) / f64::from(cells);
                low + (high - low).component_mul(&share)
            };
            let mut grid: Vec<Point> = (1..cells).flat_map(|j| (1..cells).map(move |i| at(i, j))).collect();
            grid.sort_by(|a, b| (a - place).norm_squared().total_cmp(&(b - place).norm_squared()));
            grid.into_iter().find(|&p| is_free(p))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outline::Ring;

    fn outline(points: &[[f64; 2]]) -> Outline {
        Outline::new(
            Ring::new(points.iter().copied().map(Point::from)).expect("a ring"),
            vec![],
        )
        .expect("an outline")
    }

    #[test]
    fn an_affine_image_carries_the_point_exactly() {
        let from = outline(&[[0.0, 0.0], [4.0, 0.0], [5.0, 3.0], [2.0, 2.0], [0.0, 4.0]]);
        let image = |p: Point| Point::new(2.0 * p.x - p.y + 7.0, 0.5 * p.x + p.y - 3.0);
        let to = outline(
            &from
                .outer()
                .points()
                .iter()
                .map(|&p| image(p).into())
                .collect::<Vec<[f64; 2]>>(),
        );
        let p = Point::new(1.5, 1.0);
        let found = predicted(&[from, to], &[Some(p), None], 1).expect("carried");
        assert!((found - image(p)).norm() < 1e-12, "{found}");
    }

    #[test]
    fn a_place_outside_goes_to_the_nearest_one_with_room() {
        let corner = outline(&[[0.0, 0.0], [9.0, 0.0], [9.0, 1.0], [1.0, 1.0], [1.0, 9.0], [0.0, 9.0]]);
        let mut obstacles = Obstacles::new(&corner);
        let outside = Point::new(1.2, 5.0);
        let first = obstacles.nearest_free(&corner, outside, |_| true).expect("a place");
        assert!(corner.contains(first) && (first - outside).norm() < 0.6, "{first}");
        obstacles.add_point(first);
        let second = obstacles.nearest_free(&corner, first, |_| true).expect("another");
        assert!(corner.contains(second) && second != first);
        let beyond = obstacles.nearest_free(&corner, first, |p| p.x > 6.0).expect("a third");
        assert!(corner.contains(beyond) && beyond.x > 6.0);
        assert_eq!(obstacles.nearest_free(&corner, first, |_| false), None);
    }
}
