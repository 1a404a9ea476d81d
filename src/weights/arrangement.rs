//! Automatic layout: places in the plane from how far the poses are from one another.
//!
//! 1. Distances get a floor, so that poses that do not differ do not coincide.
//! 2. Classical multidimensional scaling (Torgerson 1952): the two leading eigenvectors of the centred squared distances.
//! 3. Stress majorisation (SMACOF, de Leeuw 1977) from there, until it changes nothing more.
//! 4. Places that are still too near are pushed apart, all at once.
//! 5. The result is turned, reflected and scaled to one form, see [`arrange`].
//!
//! The shape of the layout does not depend on the order of the poses, but for rounding, and where the distances themselves
//! leave a choice (four poses that all differ equally do not fit into a plane; which two become neighbours is open).
//!
//! Cost: O(n^3) for the eigenvectors by Jacobi rotations, O(n^2) a step after that.

use crate::math::Point;

/// No distance counts as smaller than this share of the largest.
const FLOOR: f64 = 0.1;

/// Places are at least this far apart, where the furthest is 1 from the centre; with many poses a circle's even share.
const APART: f64 = 0.1;

/// Places are multiples of this: short to read, and far finer than [`APART`].
const STEP: f64 = 1e-3;

/// Steps of majorisation at most, and the change (as a share of the layout's size) that is none.
const STEPS: usize = 1000;
const SETTLED: f64 = 1e-9;

/// Rounds of pushing apart at most.
const PUSHES: usize = 1000;

/// Sweeps of Jacobi rotations at most; they converge quadratically, in less than ten.
const SWEEPS: usize = 60;

/// Places in the plane, one a pose, whose distances are about in the proportion of `distances` (#poses x #poses,
/// symmetric; of two different numbers for one pair the mean counts, what is not a positive number counts as 0).
///
/// Their mean is at the origin and the furthest is 1 from it. The first pose that is at least half as far out as the furthest
/// lies straight to the left, and the first one that is not on its line lies below, at positive y. A single pose
/// is at the origin. No two are nearer than a tenth (less, for more than 30 poses). Coordinates are multiples of 0.001.
///
/// ```
/// use inbetween::weights::arrange;
/// // Three poses in a row.
/// let places = arrange(&[vec![0.0, 1.0, 2.0], vec![1.0, 0.0, 1.0], vec![2.0, 1.0, 0.0]]);
/// assert_eq!(places, [[-1.0, 0.0], [0.0, 0.0], [1.0, 0.0]]);
/// ```
#[must_use]
pub fn arrange(distances: &[Vec<f64>]) -> Vec<[f64; 2]> {
    let count = distances.len();
    if count < 2 {
        return vec![[0.0, 0.0]; count];
    }
    let wanted = floored(distances);
    let mut places = classical(&wanted);
    majorise(&mut places, &wanted);
    normalise(&mut places);
    push_apart(&mut places);
    normalise(&mut places);
    let rounded = |v: f64| (v / STEP).round() * STEP;
    // Rounded once more: a multiple of a step that is no binary fraction has digits to lose. Negative zero is zero.
    let tidy = |v: f64| (rounded(v) * 1e6).round() / 1e6 + 0.0;
    places.iter().map(|p| [tidy(p.x), tidy(p.y)]).collect()
}

/// A place for one more among given places, all of one dimension: its distances to them are as nearly as can be in proportion to `own`, by
/// the proportion of `places` to `among`, which has a distance for each pair of them. A thousandth of what they span, rounded to.
///
/// It lies no nearer to another than a twentieth of what they span. One more than one lies at distance 1 along the first axis, the
/// first of all at the origin of the plane.
#[must_use]
pub fn place_among(places: &[Vec<f64>], among: &[Vec<f64>], own: &[f64]) -> Vec<f64> {
    /// Steps of the majorisation, which converges linearly.
    const STEPS: usize = 300;
    /// Share of the span that poses stay apart.
    const APART: f64 = 0.05;
    let Some(first) = places.first() else {
        return vec![0.0; 2];
    };
    let gap = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
    let span = places
        .iter()
        .flat_map(|a| places.iter().map(|b| gap(a, b)))
        .fold(0.0, f64::max);
    if span == 0.0 {
        let mut beside = first.clone();
        if let Some(x) = beside.first_mut() {
            *x += 1.0;
        }
        return beside;
    }
    // The proportion of all distances between the places to those that they stand for.
    let known: f64 = among.iter().flatten().filter(|d| d.is_finite()).sum();
    let spread: f64 = places.iter().flat_map(|a| places.iter().map(|b| gap(a, b))).sum();
    let scale = if known > 0.0 { spread / known } else { 1.0 };
    let wanted: Vec<f64> = own
        .iter()
        .map(|d| {
            if d.is_finite() {
                (d * scale).max(APART * span)
            } else {
                span
            }
        })
        .collect();
    let stress = |place: &[f64]| -> f64 {
        let errors = places
            .iter()
            .zip(&wanted)
            .map(|(other, wanted)| gap(place, other) - wanted);
        errors.map(|error| error * error).sum()
    };
    // Places on a line have no way out of it, so the search begins beside each of them, in every direction.
    let begun = places.iter().zip(&wanted).flat_map(|(place, wanted)| {
        (0..2 * place.len()).map(move |k| {
            let mut start = place.clone();
            start[k / 2] += if k % 2 == 0 { *wanted } else { -*wanted };
            start
        })
    });
    let settled = begun.map(|mut place| {
        for _ in 0..STEPS {
            let mut next = vec![0.0; place.len()];
            for (other, wanted) in places.iter().zip(&wanted) {
                let distance = gap(&place, other).max(f64::MIN_POSITIVE);
                for ((next, at), other) in next.iter_mut().zip(&place).zip(other) {
                    *next += (other + (at - other) * wanted / distance) / places.len() as f64;
                }
            }
            place = next;
        }
        place
    });
    // Nearly equal ones go to the first, whatever the rounding.
    let mut best: Option<(f64, Vec<f64>)> = None;
    for place in settled {
        let own = stress(&place);
        if best.as_ref().is_none_or(|(least, _)| own < least - 1e-9 * span * span) {
            best = Some((own, place));
        }
    }
    let mut place = best.map_or_else(|| first.clone(), |(_, place)| place);
    if let Some(near) = places.iter().find(|other| gap(&place, other) < APART * span) {
        let away = gap(&place, near);
        for (k, (at, other)) in place.iter_mut().zip(near).enumerate() {
            let direction = if away > 0.0 {
                (*at - other) / away
            } else {
                f64::from(u8::from(k == 0))
            };
            *at = other + direction * APART * span;
        }
    }
    let step = span / 1000.0;
    let decimals = 10f64.powf((-step.log10()).ceil().clamp(0.0, 12.0));
    place
        .into_iter()
        .map(|v| (v * decimals).round() / decimals + 0.0)
        .collect()
}

/// Symmetric distances of at least [`FLOOR`]; all 1 if none is positive.
fn floored(distances: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let count = distances.len();
    let at = |a: usize, b: usize| {
        let given = distances[a].get(b).copied().unwrap_or(0.0);
        if given > 0.0 && given.is_finite() { given } else { 0.0 }
    };
    let mut wanted: Vec<Vec<f64>> = (0..count)
        .map(|a| (0..count).map(|b| 0.5 * at(a, b) + 0.5 * at(b, a)).collect())
        .collect();
    let largest = wanted.iter().flatten().copied().fold(0.0, f64::max);
    for (a, row) in wanted.iter_mut().enumerate() {
        for (b, distance) in row.iter_mut().enumerate() {
            *distance = match (a == b, largest > 0.0) {
                (true, _) => 0.0,
                (false, true) => (*distance / largest).max(FLOOR),
                (false, false) => 1.0,
            };
        }
    }
    wanted
}

/// The best places if the distances were those of points in space.
fn classical(wanted: &[Vec<f64>]) -> Vec<Point> {
    let count = wanted.len();
    let squared = |a: usize, b: usize| wanted[a][b] * wanted[a][b];
    let means: Vec<f64> = (0..count)
        .map(|a| (0..count).map(|b| squared(a, b)).sum::<f64>() / count as f64)
        .collect();
    let mean = means.iter().sum::<f64>() / count as f64;
    let mut products: Vec<Vec<f64>> = (0..count)
        .map(|a| {
            (0..count)
                .map(|b| -0.5 * (squared(a, b) - means[a] - means[b] + mean))
                .collect()
        })
        .collect();
    let vectors = eigenvectors(&mut products);
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&a, &b| products[b][b].total_cmp(&products[a][a]));
    let coordinate = |rank: usize, pose: usize| {
        let k = order[rank];
        products[k][k].max(0.0).sqrt() * vectors[pose][k]
    };
    (0..count)
        .map(|pose| Point::new(coordinate(0, pose), coordinate(1, pose)))
        .collect()
}

/// Makes a symmetric matrix diagonal by Jacobi rotations; returns the eigenvectors as columns.
fn eigenvectors(matrix: &mut [Vec<f64>]) -> Vec<Vec<f64>> {
    let count = matrix.len();
    let mut vectors: Vec<Vec<f64>> = (0..count)
        .map(|a| (0..count).map(|b| f64::from(u8::from(a == b))).collect())
        .collect();
    for _ in 0..SWEEPS {
        let mut turned = false;
        for p in 0..count {
            for q in p + 1..count {
                let off = matrix[p][q];
                if off.abs() <= f64::EPSILON * f64::EPSILON.sqrt() {
                    continue;
                }
                turned = true;
                let theta = (matrix[q][q] - matrix[p][p]) / (2.0 * off);
                let tangent = theta.signum() / (theta.abs() + theta.hypot(1.0));
                let cosine = tangent.hypot(1.0).recip();
                let sine = tangent * cosine;
                let rotate = |x: f64, y: f64| (cosine * x - sine * y, sine * x + cosine * y);
                for row in matrix.iter_mut().chain(vectors.iter_mut()) {
                    (row[p], row[q]) = rotate(row[p], row[q]);
                }
                let (upper, lower) = matrix.split_at_mut(q);
                for (x, y) in upper[p].iter_mut().zip(&mut lower[0]) {
                    (*x, *y) = rotate(*x, *y);
                }
            }
        }
        if !turned {
            break;
        }
    }
    vectors
}

/// Lowers the sum of squared errors of the distances, which every step does.
fn majorise(places: &mut Vec<Point>, wanted: &[Vec<f64>]) {
    let count = places.len();
    for _ in 0..STEPS {
        let next: Vec<Point> = (0..count)
            .map(|a| {
                let pull = |b: usize| {
                    let apart = places[a] - places[b];
                    let distance = apart.norm();
                    // Of two poses at one place neither direction is better.
                    if distance > 0.0 {
                        apart * (wanted[a][b] / distance)
                    } else {
                        Point::zeros()
                    }
                };
                (0..count).map(pull).sum::<Point>() / count as f64
            })
            .collect();
        let changed = places
            .iter()
            .zip(&next)
            .map(|(p, q)| (p - q).norm())
            .fold(0.0, f64::max);
        *places = next;
        if changed < SETTLED {
            break;
        }
    }
}

/// Moves places that are nearer than they may be, away from one another; equal ones across the line from the centre.
fn push_apart(places: &mut [Point]) {
    let count = places.len();
    // A little more, for the rounding to the step.
    let apart = APART.min(3.0 / count as f64) + 2.0 * STEP;
    for _ in 0..PUSHES {
        let mut moves = vec![Point::zeros(); count];
        let mut any = false;
        for a in 0..count {
            for b in a + 1..count {
                let between = places[a] - places[b];
                let distance = between.norm();
                if distance >= apart {
                    continue;
                }
                any = true;
                let direction = if distance > 1e-9 {
                    between / distance
                } else {
                    let out = places[a] + places[b];
                    let out = if out.norm() > 1e-9 {
                        out.normalize()
                    } else {
                        Point::new(1.0, 0.0)
                    };
                    Point::new(-out.y, out.x)
                };
                let step = direction * (0.5 * (apart - distance) + STEP);
                moves[a] += step;
                moves[b] -= step;
            }
        }
        for (place, step) in places.iter_mut().zip(moves) {
            *place += step;
        }
        if !any {
            break;
        }
    }
}

/// Centre, size and turn as promised by [`arrange`].
fn normalise(places: &mut [Point]) {
    let centre = places.iter().sum::<Point>() / places.len() as f64;
    places.iter_mut().for_each(|p| *p -= centre);
    let furthest = places.iter().map(Point::norm).fold(0.0, f64::max);
    if furthest == 0.0 {
        return;
    }
    places.iter_mut().for_each(|p| *p /= furthest);
    let Some(first) = places.iter().find(|p| p.norm() >= 0.5).copied() else {
        return;
    };
    // The turn that takes it to the left.
    let left = -first.normalize();
    for p in places.iter_mut() {
        *p = Point::new(p.dot(&left), left.x * p.y - left.y * p.x);
    }
    let off_line = places.iter().find(|p| p.y.abs() > 0.5 * APART);
    if off_line.is_some_and(|p| p.y < 0.0) {
        places.iter_mut().for_each(|p| p.y = -p.y);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_more_lies_where_its_distances_say() {
        let places = [[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]].map(Vec::from);
        let among = [[0.0, 40.0, 30.0], [40.0, 0.0, 50.0], [30.0, 50.0, 0.0]].map(Vec::from);
        let found = place_among(&places, &among, &[50.0, 30.0, 40.0]);
        assert!(
            (found[0] - 4.0).abs() < 0.02 && (found[1] - 3.0).abs() < 0.02,
            "{found:?}"
        );
        // A copy of one of them keeps a little away from it, and one beside one alone is a step aside.
        let copy = place_among(&places, &among, &[0.0, 40.0, 30.0]);
        assert!(copy.iter().map(|v| v * v).sum::<f64>().sqrt() > 0.2, "{copy:?}");
        assert_eq!(place_among(&[vec![2.0, 5.0]], &[vec![0.0]], &[9.0]), [3.0, 5.0]);
    }

    use proptest::prelude::*;
    use std::f64::consts::TAU;

    fn table(count: usize, distance: impl Fn(usize, usize) -> f64) -> Vec<Vec<f64>> {
        (0..count)
            .map(|a| (0..count).map(|b| distance(a, b)).collect())
            .collect()
    }

    fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
        (Point::from(a) - Point::from(b)).norm()
    }

    fn closest(places: &[[f64; 2]]) -> f64 {
        let pairs = (0..places.len()).flat_map(|a| (0..a).map(move |b| (a, b)));
        pairs
            .map(|(a, b)| apart(places[a], places[b]))
            .fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn a_motion_that_closes_comes_out_as_a_circle() {
        // Differences of angles, the shorter way round.
        let steps = |a: usize, b: usize| {
            let between = a.abs_diff(b);
            between.min(12 - between) as f64
        };
        let places = arrange(&table(12, steps));
        assert_eq!(places[0], [-1.0, 0.0]);
        for (k, place) in places.iter().enumerate() {
            let angle = TAU * (0.5 - k as f64 / 12.0);
            assert!(apart(*place, [angle.cos(), angle.sin()]) < 2e-3, "{places:?}");
        }
    }

    #[test]
    fn points_of_a_plane_are_found_again() {
        let known = [[-1.0, 0.0], [0.3, 0.7], [0.5, -0.6], [0.2, -0.1]];
        let places = arrange(&table(4, |a, b| apart(known[a], known[b])));
        for (a, b) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
            assert!((apart(places[a], places[b]) - apart(known[a], known[b])).abs() < 2e-3);
        }
        assert!(places[1][1] > 0.0);
    }

    #[test]
    fn equal_drawings_do_not_coincide() {
        for count in 2..9 {
            let all_equal = arrange(&table(count, |_, _| 0.0));
            assert!(closest(&all_equal) >= 0.1, "{all_equal:?}");
            let two_kinds = arrange(&table(count, |a, b| if a % 2 == b % 2 { 0.0 } else { 1.0 }));
            assert!(closest(&two_kinds) >= 0.1, "{two_kinds:?}");
        }
        assert_eq!(arrange(&[vec![0.0]]), [[0.0, 0.0]]);
        assert_eq!(arrange(&[]), Vec::<[f64; 2]>::new());
        let wild = arrange(&[vec![0.0, f64::NAN], vec![f64::INFINITY, 0.0]]);
        assert_eq!(wild, [[-1.0, 0.0], [1.0, 0.0]]);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        #[test]
        fn the_shape_does_not_depend_on_the_order(
            points in proptest::collection::vec(proptest::array::uniform3(0.0..1.0f64), 3..9),
            seed in 0_usize..100,
        ) {
            let count = points.len();
            let distance = |a: usize, b: usize| {
                points[a].iter().zip(&points[b]).map(|(x, y)| (x - y) * (x - y)).sum::<f64>().sqrt()
            };
            let mut order: Vec<usize> = (0..count).collect();
            order.rotate_left(seed % count);
            order.swap(0, seed % 2);
            let plain = arrange(&table(count, distance));
            let other = arrange(&table(count, |a, b| distance(order[a], order[b])));
            prop_assert!(closest(&plain) > 0.09);
            for a in 0..count {
                for b in 0..a {
                    let (here, there) = (apart(plain[order[a]], plain[order[b]]), apart(other[a], other[b]));
                    prop_assert!((here - there).abs() < 5e-3, "{here} {there}");
                }
            }
        }
    }
}
