//! Which point of one subpath becomes which of its counterparts.
//!
//! Equally many curves: curve by curve, as files of one drawing program have them; a closed path that plainly starts elsewhere or runs
//! the other way round is turned first.
//!
//! Otherwise by place, since the mesh carries every pose onto every other:
//!
//! 1. Every path is sampled evenly by its length; samples are carried to the pose of the first and freed of position and size,
//!    so that what moves on the mesh is compared by its form.
//! 2. A path that runs the other way is reversed; a closed one starts where it fits best.
//! 3. A monotone match by dynamic programming: the cost of a pair is the squared distance and [`TURNING`] times 1 - cos of the
//!    difference of directions; steps advance both paths, one at most [`STEEPEST`] times as far as the other.
//! 4. Ends of curves that are matched nearly become pairs, so that corners stay corners.
//! 5. All are divided where any has the end of a curve, so that they have equally many.
//!
//! Cost: O(samples^2) a pair.

use kurbo::{CubicBez, ParamCurve, ParamCurveArclen};

use super::binding::PoseMesh;
use super::strand::to_point;
use crate::math::{Point, point};

/// Samples along a path.
const SAMPLES: usize = 96;

/// The weight of directions against distances, which are in units of the path's size.
const TURNING: f64 = 0.3;

/// How many times as far one path may advance as the other.
const STEEPEST: usize = 3;

/// Ends of curves nearer than this along the path become pairs, as a fraction of its length.
const PAIRED: f64 = 0.025;

/// A path with equally many curves is turned only if that makes the sum of squared distances this many times smaller.
const PLAINLY: f64 = 4.0;

/// Parameters nearer than this are the same, in fractions of the length.
const SAME: f64 = 1e-9;

/// How exactly lengths are measured, as a fraction of a curve's size.
const LENGTH_ACCURACY: f64 = 1e-6;

/// The curves of several subpaths, divided so that they correspond: row by row one curve of each. `paths[d]` lies on `meshes[d]`.
pub(super) fn aligned(mut paths: Vec<Vec<CubicBez>>, meshes: &[&PoseMesh], is_closed: bool) -> Vec<Vec<CubicBez>> {
    let Some(first) = paths.first() else {
        return Vec::new();
    };
    let count = first.len();
    if count == 0 || paths.iter().any(Vec::is_empty) {
        return Vec::new();
    }
    if paths.iter().all(|path| path.len() == count) {
        if is_closed && paths.len() > 1 {
            turn_alike(&mut paths, meshes);
        }
        return (0..count).map(|k| paths.iter().map(|path| path[k]).collect()).collect();
    }
    let reference = Measured::new(std::mem::take(&mut paths[0]), meshes[0], meshes, is_closed);
    let others: Vec<Aligned> = paths
        .drain(..)
        .zip(meshes)
        .skip(1)
        .map(|(path, mesh)| Aligned::new(&reference, Measured::new(path, mesh, meshes, is_closed), mesh, meshes))
        .collect();
    let mut rows: Vec<f64> = reference.ends.clone();
    rows.extend(others.iter().flat_map(Aligned::ends_on_reference));
    rows.sort_by(f64::total_cmp);
    rows.dedup_by(|a, b| *a - *b < SAME);
    let of_reference: Vec<f64> = rows.iter().map(|&row| reference.parameter(row)).collect();
    let of_others: Vec<Vec<f64>> = others
        .iter()
        .map(|other| {
            rows.iter()
                .map(|&row| other.path.parameter(other.map.at(row)))
                .collect()
        })
        .collect();
    let mut curves: Vec<Vec<CubicBez>> = (0..rows.len() - 1)
        .map(|k| {
            let own =
                std::iter::once((&reference, &of_reference)).chain(others.iter().map(|o| &o.path).zip(&of_others));
            own.map(|(path, at)| path.between(at[k], at[k + 1])).collect()
        })
        .collect();
    meet(&mut curves, is_closed);
    curves
}

/// Lets every curve start exactly where the one before it ends.
fn meet(curves: &mut [Vec<CubicBez>], is_closed: bool) {
    for k in 1..curves.len() {
        let (before, after) = curves.split_at_mut(k);
        for (a, b) in before[k - 1].iter().zip(&mut after[0]) {
            b.p0 = a.p3;
        }
    }
    if let (true, Some(first)) = (is_closed, curves.first().cloned()) {
        for (a, b) in first.iter().zip(curves.last_mut().into_iter().flatten()) {
            b.p3 = a.p0;
        }
    }
}

/// Turns and reverses closed paths with equally many curves where that makes them plainly more like the first.
fn turn_alike(paths: &mut [Vec<CubicBez>], meshes: &[&PoseMesh]) {
    let common = meshes[0].positions();
    let nodes = |path: &[CubicBez], mesh: &PoseMesh| {
        freed(path.iter().map(|c| mesh.bind_here(to_point(c.p0)).at(common)).collect())
    };
    let wanted = nodes(&paths[0], meshes[0]);
    let count = wanted.len();
    for (path, mesh) in paths.iter_mut().zip(meshes).skip(1) {
        let mut best = (Vec::new(), sum_of_squares(&wanted, &nodes(path, mesh), 0) / PLAINLY);
        for candidate in [path.clone(), reversed(path)] {
            let own = nodes(&candidate, mesh);
            for shift in 0..count {
                let cost = sum_of_squares(&wanted, &own, shift);
                if cost < best.1 {
                    let mut turned = candidate.clone();
                    turned.rotate_left(shift);
                    best = (turned, cost);
                }
            }
        }
        if !best.0.is_empty() {
            *path = best.0;
        }
    }
}

fn sum_of_squares(a: &[Point], b: &[Point], shift: usize) -> f64 {
    let count = b.len();
    a.iter()
        .enumerate()
        .map(|(k, p)| (p - b[(k + shift) % count]).norm_squared())
        .sum()
}

fn reversed(path: &[CubicBez]) -> Vec<CubicBez> {
    path.iter()
        .rev()
        .map(|c| CubicBez::new(c.p3, c.p2, c.p1, c.p0))
        .collect()
}

/// Points about their mean, with a mean square distance of 1 from it.
fn freed(points: Vec<Point>) -> Vec<Point> {
    let count = points.len().max(1) as f64;
    let mean = points.iter().sum::<Point>() / count;
    let size = (points.iter().map(|p| (p - mean).norm_squared()).sum::<f64>() / count).sqrt();
    let scale = if size > 0.0 { 1.0 / size } else { 1.0 };
    points.into_iter().map(|p| (p - mean) * scale).collect()
}

/// A path measured along its length. Parameters run from `0` to the number of curves, beyond for a closed path that starts
/// elsewhere; fractions of the length from 0 to 1.
struct Measured {
    path: Vec<CubicBez>,
    /// Where each curve ends, as a fraction of the length; 0 first, 1 last.
    ends: Vec<f64>,
    is_closed: bool,
    /// Carried to the common pose and freed: [`SAMPLES`], and the end of an open path.
    samples: Vec<Point>,
}

impl Measured {
    fn new(path: Vec<CubicBez>, mesh: &PoseMesh, meshes: &[&PoseMesh], is_closed: bool) -> Self {
        let mut sums = vec![0.0];
        let mut sum = 0.0;
        for curve in &path {
            let size = (curve.p1 - curve.p0).hypot() + (curve.p2 - curve.p1).hypot() + (curve.p3 - curve.p2).hypot();
            // Every curve has a length, so that fractions are distinct.
            sum += curve
                .arclen(LENGTH_ACCURACY * size.max(f64::MIN_POSITIVE))
                .max(f64::MIN_POSITIVE.sqrt());
            sums.push(sum);
        }
        let mut ends: Vec<f64> = sums.into_iter().map(|end| end / sum).collect();
        if let Some(last) = ends.last_mut() {
            *last = 1.0;
        }
        let mut this = Self {
            path,
            ends,
            is_closed,
            samples: Vec::new(),
        };
        let common = meshes[0].positions();
        let count = if is_closed { SAMPLES } else { SAMPLES + 1 };
        let sample = |k: usize| {
            let at = this.parameter(k as f64 / SAMPLES as f64);
            let index = (at as usize).min(this.path.len() - 1);
            mesh.bind_here(to_point(this.path[index].eval(at - index as f64)))
                .at(common)
        };
        this.samples = freed((0..count).map(sample).collect());
        this
    }

    /// The parameter at a fraction of the length, which may lie in [0, 2]. Ends of curves are whole numbers.
    fn parameter(&self, fraction: f64) -> f64 {
        let count = self.path.len();
        let (turns, fraction) = if fraction > 1.0 + SAME {
            (count, fraction - 1.0)
        } else {
            (0, fraction)
        };
        let k = self.ends.partition_point(|end| *end <= fraction - SAME).clamp(1, count) - 1;
        let (from, to) = (self.ends[k], self.ends[k + 1]);
        let along = if fraction - from <= SAME {
            0.0
        } else if to - fraction <= SAME {
            1.0
        } else {
            // By length within the curve, not by its own parameter.
            let curve = &self.path[k];
            let size = (curve.p1 - curve.p0).hypot() + (curve.p2 - curve.p1).hypot() + (curve.p3 - curve.p2).hypot();
            let accuracy = LENGTH_ACCURACY * size.max(f64::MIN_POSITIVE);
            let length = curve.arclen(accuracy);
            if length > 0.0 {
                curve
                    .inv_arclen(length * (fraction - from) / (to - from), accuracy)
                    .clamp(0.0, 1.0)
            } else {
                (fraction - from) / (to - from)
            }
        };
        (turns + k) as f64 + along
    }

    /// The piece between two parameters, which lies on one curve.
    fn between(&self, from: f64, to: f64) -> CubicBez {
        let whole = (0.5 * (from + to)).floor();
        let curve = self.path[whole as usize % self.path.len()];
        let (from, to) = ((from - whole).clamp(0.0, 1.0), (to - whole).clamp(0.0, 1.0));
        if from == 0.0 && to == 1.0 {
            curve
        } else {
            curve.subsegment(from..to)
        }
    }

    fn direction(&self, k: usize) -> Point {
        let count = self.samples.len();
        let (before, after) = if self.is_closed {
            ((k + count - 1) % count, (k + 1) % count)
        } else {
            (k.saturating_sub(1), (k + 1).min(count - 1))
        };
        let along = self.samples[after] - self.samples[before];
        let length = along.norm();
        if length > 0.0 { along / length } else { Point::zeros() }
    }
}

/// A path matched to the reference.
struct Aligned {
    path: Measured,
    /// From fractions of the reference to fractions of the path.
    map: Monotone,
}

impl Aligned {
    fn new(reference: &Measured, path: Measured, mesh: &PoseMesh, meshes: &[&PoseMesh]) -> Self {
        let path = if runs_backwards(reference, &path) {
            Measured::new(reversed(&path.path), mesh, meshes, path.is_closed)
        } else {
            path
        };
        let shift = match path.is_closed {
            false => 0,
            true => (0..SAMPLES)
                .min_by(|&a, &b| {
                    let cost = |shift| sum_of_squares(&reference.samples, &path.samples, shift);
                    cost(a).total_cmp(&cost(b))
                })
                .unwrap_or(0),
        };
        let matched = Monotone {
            knots: matched_samples(reference, &path, shift)
                .into_iter()
                .map(|(a, b)| [a as f64 / SAMPLES as f64, (b + shift) as f64 / SAMPLES as f64])
                .collect(),
        };
        let map = with_pairs(reference, &path, matched);
        Self { path, map }
    }

    /// Where on the reference the path's curves end.
    fn ends_on_reference(&self) -> Vec<f64> {
        let (low, high) = self.map.range();
        let of_turns = self.path.ends.iter().flat_map(|end| [*end, *end + 1.0]);
        of_turns
            .filter(|end| (low + SAME..=high - SAME).contains(end))
            .map(|end| self.map.inverse(end))
            .collect()
    }
}

fn runs_backwards(reference: &Measured, path: &Measured) -> bool {
    if path.is_closed {
        let area = |samples: &[Point]| -> f64 {
            (0..samples.len())
                .map(|k| point::cross(samples[k], samples[(k + 1) % samples.len()]))
                .sum()
        };
        return (area(&reference.samples) < 0.0) != (area(&path.samples) < 0.0);
    }
    let backwards: Vec<Point> = path.samples.iter().rev().copied().collect();
    sum_of_squares(&reference.samples, &backwards, 0) < sum_of_squares(&reference.samples, &path.samples, 0)
}

/// The best monotone match of samples, as pairs of their numbers (those of `path` counted from `shift`), both from 0 to [`SAMPLES`].
fn matched_samples(reference: &Measured, path: &Measured, shift: usize) -> Vec<(usize, usize)> {
    let side = SAMPLES + 1;
    let index = |of: &Measured, k: usize| k % of.samples.len();
    let directions: Vec<Point> = (0..side).map(|k| path.direction(index(path, k + shift))).collect();
    let cost = |a: usize, b: usize| {
        let distance = reference.samples[index(reference, a)] - path.samples[index(path, b + shift)];
        let turned = reference.direction(index(reference, a)).dot(&directions[b]);
        distance.norm_squared() + TURNING * (1.0 - turned)
    };
    let steps: Vec<(usize, usize)> = std::iter::once((1, 1))
        .chain((2..=STEEPEST).flat_map(|far| [(1, far), (far, 1)]))
        .collect();
    let mut best = vec![(f64::INFINITY, (0, 0)); side * side];
    best[0].0 = 0.0;
    for a in 1..side {
        for b in 1..side {
            let own = cost(a, b);
            for &(da, db) in &steps {
                if da > a || db > b {
                    continue;
                }
                let before = best[(a - da) * side + b - db].0;
                let total = before + own * (da + db) as f64;
                if total < best[a * side + b].0 {
                    best[a * side + b] = (total, (da, db));
                }
            }
        }
    }
    let mut pairs = vec![(SAMPLES, SAMPLES)];
    let (mut a, mut b) = (SAMPLES, SAMPLES);
    while a > 0 && b > 0 {
        let (da, db) = best[a * side + b].1;
        if da == 0 {
            break;
        }
        (a, b) = (a - da, b - db);
        pairs.push((a, b));
    }
    pairs.reverse();
    pairs
}

/// The match, bent so that ends of curves that it nearly pairs are paired.
fn with_pairs(reference: &Measured, path: &Measured, matched: Monotone) -> Monotone {
    let (low, high) = matched.range();
    let ends: Vec<f64> = path
        .ends
        .iter()
        .flat_map(|end| [*end, *end + 1.0])
        .filter(|end| (low - PAIRED..=high + PAIRED).contains(end))
        .collect();
    let nearest = |of: &[f64], to: f64| {
        of.iter()
            .copied()
            .min_by(|a, b| (a - to).abs().total_cmp(&(b - to).abs()))
    };
    // From where the match puts it to where its partner is.
    let mut bends: Vec<[f64; 2]> = Vec::new();
    let interior = &reference.ends[1..reference.ends.len() - 1];
    let images: Vec<f64> = interior.iter().map(|end| matched.at(*end)).collect();
    for &image in &images {
        let Some(partner) = nearest(&ends, image).filter(|end| (end - image).abs() < PAIRED) else {
            continue;
        };
        let is_mutual = nearest(&images, partner) == Some(image);
        let is_ahead = bends
            .last()
            .is_none_or(|[from, to]| image > from + SAME && partner > to + SAME);
        if is_mutual && is_ahead && partner > low + SAME && partner < high - SAME {
            bends.push([image, partner]);
        }
    }
    let mut knots = vec![[low, low]];
    knots.extend(bends);
    knots.push([high, high]);
    let bent = Monotone { knots };
    // A bend lies between two knots of the match as a rule: both are needed.
    let mut at: Vec<f64> = matched.knots.iter().map(|knot| knot[0]).collect();
    at.extend(interior);
    at.sort_by(f64::total_cmp);
    at.dedup_by(|a, b| *a - *b < SAME);
    Monotone {
        knots: at.into_iter().map(|a| [a, bent.at(matched.at(a))]).collect(),
    }
}

/// A piecewise linear map that increases strictly.
struct Monotone {
    knots: Vec<[f64; 2]>,
}

impl Monotone {
    fn range(&self) -> (f64, f64) {
        let value = |knot: Option<&[f64; 2]>| knot.map_or(0.0, |knot| knot[1]);
        (value(self.knots.first()), value(self.knots.last()))
    }

    fn at(&self, x: f64) -> f64 {
        self.between(x, 0, 1)
    }

    fn inverse(&self, y: f64) -> f64 {
        self.between(y, 1, 0)
    }

    fn between(&self, value: f64, from: usize, to: usize) -> f64 {
        let last = self.knots.len().saturating_sub(1).max(1);
        let k = self.knots.partition_point(|knot| knot[from] <= value).clamp(1, last);
        let (Some(low), Some(high)) = (self.knots.get(k - 1), self.knots.get(k)) else {
            return value;
        };
        let part = (value - low[from]) / (high[from] - low[from]);
        if part <= 0.0 {
            low[to]
        } else if part >= 1.0 {
            high[to]
        } else {
            low[to] + (high[to] - low[to]) * part
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of side 2 as a mesh, at the place itself.
    fn with_mesh(mut test: impl FnMut(&PoseMesh)) {
        let positions = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]].map(Point::from);
        let triangles = [[0, 1, 2], [0, 2, 3]];
        test(&PoseMesh::new(&triangles, &positions));
    }

    fn at([x, y]: [f64; 2]) -> kurbo::Point {
        kurbo::Point::new(x, y)
    }

    fn polygon(corners: &[[f64; 2]]) -> Vec<CubicBez> {
        (0..corners.len())
            .map(|k| {
                let [a, b] = [corners[k], corners[(k + 1) % corners.len()]].map(at);
                CubicBez::new(a, a.lerp(b, 1.0 / 3.0), a.lerp(b, 2.0 / 3.0), b)
            })
            .collect()
    }

    const SQUARE: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

    #[test]
    fn corners_of_a_square_are_found_among_more_points() {
        // The same square from its third corner, with a point in the middle of two sides, either way round.
        let mut more = vec![
            [1.0, 1.0],
            [0.0, 1.0],
            [-1.0, 1.0],
            [-1.0, -1.0],
            [0.1, -1.0],
            [1.0, -1.0],
        ];
        with_mesh(|mesh| {
            for _ in 0..2 {
                let curves = aligned(vec![polygon(&SQUARE), polygon(&more)], &[mesh, mesh], true);
                assert_eq!(curves.len(), 6, "four corners and two points");
                for row in &curves {
                    assert!((row[0].p0 - row[1].p0).hypot() < 0.05, "{row:?}");
                }
                for k in 0..curves.len() {
                    for (a, b) in curves[k].iter().zip(&curves[(k + 1) % curves.len()]) {
                        assert_eq!(a.p3, b.p0);
                    }
                }
                more.reverse();
            }
        });
    }

    #[test]
    fn equal_counts_correspond_as_given_unless_plainly_turned() {
        with_mesh(|mesh| {
            // A quadrilateral that is a little different keeps its order.
            let other = [[-1.0, -0.8], [0.9, -1.0], [1.0, 1.1], [-1.2, 1.0]];
            let curves = aligned(vec![polygon(&SQUARE), polygon(&other)], &[mesh, mesh], true);
            assert_eq!(curves[0][1].p0, at(other[0]));
            let turned = [other[2], other[1], other[0], other[3]];
            let curves = aligned(vec![polygon(&SQUARE), polygon(&turned)], &[mesh, mesh], true);
            assert_eq!(curves[0][1].p0, at(other[0]));
            assert_eq!(curves[1][1].p0, at(other[1]));
        });
    }

    #[test]
    fn an_open_line_keeps_its_ends() {
        let line = |points: &[[f64; 2]]| polygon(points)[..points.len() - 1].to_vec();
        with_mesh(|mesh| {
            let a = line(&[[-1.0, 0.0], [0.0, 1.0], [1.0, 0.0]]);
            let b = line(&[[1.0, 0.1], [0.5, 0.6], [0.0, 1.0], [-1.0, 0.0]]);
            let curves = aligned(vec![a, b], &[mesh, mesh], false);
            assert_eq!(curves.len(), 3);
            assert_eq!(curves[0][1].p0, kurbo::Point::new(-1.0, 0.0));
            assert_eq!(curves[2][1].p3, kurbo::Point::new(1.0, 0.1));
            // The corner at the top is in both.
            assert!(curves.iter().any(|row| row[0].p3.y == 1.0 && row[1].p3.y == 1.0));
        });
    }
}
