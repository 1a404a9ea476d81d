//! Lines inside the drawings with as many points in every pose: they correspond by arc length, and are simplified
//! together.

use crate::math::{Point, point};

/// Points of different poses this close, in lengths of the line, become one.
const MERGE_DISTANCE: f64 = 1e-3;

/// The points of a line: #points x #poses, `None` in the poses that lack it. Corresponding points have the same share
/// of the length before them. No pose's line deviates from its own by more than `deviations` (in source units).
pub(super) fn corresponding(lines: &[Option<Vec<Point>>], deviations: &[f64]) -> Vec<Vec<Option<Point>>> {
    let measured: Vec<Option<Measured>> = lines
        .iter()
        .map(|line| line.as_ref().map(|l| Measured::new(l)))
        .collect();
    // Every vertex of any pose, but for the ends.
    let mut stations: Vec<f64> = measured
        .iter()
        .flatten()
        .flat_map(|line| line.parameters.clone())
        .collect();
    stations.retain(|&t| t > MERGE_DISTANCE && t < 1.0 - MERGE_DISTANCE);
    stations.sort_by(f64::total_cmp);
    stations.dedup_by(|next, kept| *next - *kept < MERGE_DISTANCE);
    stations.insert(0, 0.0);
    stations.push(1.0);
    let places: Vec<Option<Vec<Point>>> = measured
        .iter()
        .map(|line| line.as_ref().map(|line| stations.iter().map(|&t| line.at(t)).collect()))
        .collect();
    // Douglas and Peucker's algorithm on all poses at once: the worst pose decides.
    let mut kept = vec![0, stations.len() - 1];
    let mut spans = vec![(0, stations.len() - 1)];
    while let Some((from, to)) = spans.pop() {
        let deviation = |k: usize| {
            places
                .iter()
                .zip(deviations)
                .filter_map(|(places, allowed)| {
                    let places = places.as_ref()?;
                    let (_, distance) = point::nearest_on_segment(places[k], places[from], places[to]);
                    Some(distance / allowed.max(f64::MIN_POSITIVE))
                })
                .fold(0.0, f64::max)
        };
        let worst = (from + 1..to)
            .map(|k| (deviation(k), k))
            .max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
        if let Some((_, k)) = worst.filter(|worst| worst.0 > 1.0) {
            kept.push(k);
            spans.extend([(from, k), (k, to)]);
        }
    }
    kept.sort_unstable();
    kept.iter()
        .map(|&k| {
            places
                .iter()
                .map(|places| places.as_ref().map(|places| places[k]))
                .collect()
        })
        .collect()
}

/// A line measured by its length.
struct Measured<'a> {
    points: &'a [Point],
    /// The share of the length before each point.
    parameters: Vec<f64>,
}

impl<'a> Measured<'a> {
    fn new(points: &'a [Point]) -> Self {
        let mut parameters = vec![0.0];
        let mut travelled = 0.0;
        for link in points.windows(2) {
            travelled += (link[1] - link[0]).norm();
            parameters.push(travelled);
        }
        let last = parameters.len() - 1;
        for (k, parameter) in parameters.iter_mut().enumerate() {
            // Without any length, evenly.
            *parameter = if travelled > 0.0 {
                *parameter / travelled
            } else {
                k as f64 / last.max(1) as f64
            };
        }
        Self { points, parameters }
    }

    fn at(&self, t: f64) -> Point {
        let link = self
            .parameters
            .partition_point(|&p| p <= t)
            .clamp(1, self.points.len() - 1)
            - 1;
        let (start, end) = (self.parameters[link], self.parameters[link + 1]);
        // A link without length ends where it begins.
        let along = if end > start {
            ((t - start) / (end - start)).clamp(0.0, 1.0)
        } else {
            1.0
        };
        let (a, b) = (self.points[link], self.points[link + 1]);
        if along == 1.0 { b } else { a + (b - a) * along }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(points: &[[f64; 2]]) -> Option<Vec<Point>> {
        Some(points.iter().copied().map(Point::from).collect())
    }

    #[test]
    fn a_corner_of_one_pose_is_a_point_of_all() {
        let lines = [
            line(&[[0.0, 0.0], [4.0, 0.0]]),
            None,
            line(&[[0.0, 0.0], [3.0, 0.0], [3.0, 1.0]]),
        ];
        let rows = corresponding(&lines, &[0.1; 3]);
        let place = |x: f64, y: f64| Some(Point::new(x, y));
        assert_eq!(
            rows,
            vec![
                vec![place(0.0, 0.0), None, place(0.0, 0.0)],
                vec![place(3.0, 0.0), None, place(3.0, 0.0)],
                vec![place(4.0, 0.0), None, place(3.0, 1.0)],
            ]
        );
    }

    #[test]
    fn points_drawn_twice_change_nothing() {
        let plain = line(&[[0.0, 0.0], [3.0, 0.0], [3.0, 1.0]]);
        let doubled = line(&[[0.0, 0.0], [0.0, 0.0], [3.0, 0.0], [3.0, 0.0], [3.0, 1.0], [3.0, 1.0]]);
        assert_eq!(corresponding(&[doubled], &[0.1]), corresponding(&[plain], &[0.1]));
        let dot = line(&[[2.0, 5.0], [2.0, 5.0], [2.0, 5.0]]);
        let place = vec![Some(Point::new(2.0, 5.0))];
        assert_eq!(corresponding(&[dot], &[0.1]), vec![place.clone(), place]);
    }

    #[test]
    fn what_deviates_less_than_allowed_goes() {
        let lines = [line(&[[0.0, 0.0], [2.0, 0.05], [4.0, 0.0], [4.0, 3.0]])];
        assert_eq!(corresponding(&lines, &[0.1]).len(), 3);
        assert_eq!(corresponding(&lines, &[0.01]).len(), 4);
    }
}
