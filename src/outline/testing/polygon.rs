//! Random simple polygons, every decision exact.

use super::Sequence;
use crate::math::{Point, point, predicate};

/// A simple polygon through the points in some order: crossing edges are uncrossed until none are left. `None` for
/// points that allow no positive simple polygon by that, as several at one place.
pub(crate) fn untangled(mut points: Vec<Point>) -> Option<Vec<Point>> {
    let count = points.len();
    let mut clean = 0;
    let mut i = 0;
    for _ in 0..200 * count * count {
        // Edge i crosses none of all others: then on to the next one, until that holds for all.
        let (a, b) = (points[i], points[(i + 1) % count]);
        let tangled = (0..count).find(|&j| {
            let is_apart = j != i && (j + 1) % count != i && (i + 1) % count != j;
            is_apart
                && boxes_meet(a, b, points[j], points[(j + 1) % count])
                && predicate::touch(a, b, points[j], points[(j + 1) % count])
        });
        match tangled {
            Some(j) => {
                points[i.min(j) + 1..=i.max(j)].reverse();
                clean = 0;
            }
            None => {
                clean += 1;
                i = (i + 1) % count;
            }
        }
        if clean >= count {
            return positive(points);
        }
    }
    None
}

/// The points in positive order; `None` if two neighbouring edges fold back or there is no area.
fn positive(mut points: Vec<Point>) -> Option<Vec<Point>> {
    if doubled_area(&points) < 0.0 {
        points.reverse();
    }
    let free = (0..points.len()).all(|edge| is_free(&points, edge));
    (free && doubled_area(&points) > 0.0).then_some(points)
}

fn doubled_area(points: &[Point]) -> f64 {
    let count = points.len();
    (0..count)
        .map(|k| point::cross(points[k] - points[0], points[(k + 1) % count] - points[0]))
        .sum()
}

/// Whether an edge meets no other one but for its neighbours in their common vertices.
fn is_free(points: &[Point], edge: usize) -> bool {
    let count = points.len();
    let ends = |edge: usize| (points[edge % count], points[(edge + 1) % count]);
    let (a, b) = ends(edge);
    (0..count).filter(|&other| other != edge).all(|other| {
        let (c, d) = ends(other);
        if other == (edge + 1) % count {
            !predicate::folds_back(a, b, d)
        } else if edge == (other + 1) % count {
            !predicate::folds_back(c, a, b)
        } else {
            !(boxes_meet(a, b, c, d) && predicate::touch(a, b, c, d))
        }
    })
}

/// A polygon that grows from a triangle: one random edge after another is bent to a random point beside it, so far as
/// nothing is touched. Of all lengths, thin and winding. On a lattice of so many places a side, if one is given:
/// then many vertices are exactly in line.
pub(crate) fn grown(count: usize, lattice: Option<usize>, random: &mut Sequence) -> Vec<Point> {
    let snapped = |p: Point| match lattice {
        None => p,
        Some(side) => (p * side as f64).map(|x| x.round()),
    };
    let scale = lattice.map_or(1.0, |side| side as f64);
    let mut points = Vec::new();
    while points.len() < 3 {
        let corners: Vec<Point> = (0..3)
            .map(|_| snapped(Point::new(random.next(), random.next())))
            .collect();
        if predicate::is_positive(corners[0], corners[1], corners[2]) {
            points = corners;
        }
    }
    while points.len() < count {
        let at = random.below(points.len());
        let (a, b) = (points[at], points[(at + 1) % points.len()]);
        // Mostly about as far off as the edge is long, sometimes much nearer or farther.
        let reach = (b - a).norm() / scale * (4.0 * (random.next() - 0.6)).exp();
        let along = random.next();
        let new = (a + (b - a) * along) / scale + random.direction() * reach;
        let new = snapped(new);
        let within = new.iter().all(|&x| (-0.5 * scale..=1.5 * scale).contains(&x));
        if within && new != a && new != b {
            points.insert(at + 1, new);
            if !(is_free(&points, at) && is_free(&points, at + 1) && doubled_area(&points) > 0.0) {
                points.remove(at + 1);
            }
        }
    }
    points
}

/// Moves vertices one by one, `steps` times, each by a random length in a random direction, unless the polygon would
/// touch itself.
pub(crate) fn walked(points: &mut [Point], steps: usize, random: &mut Sequence) {
    let count = points.len();
    for _ in 0..steps {
        let at = random.below(count);
        let (before, here) = ((at + count - 1) % count, points[at]);
        let reach = (points[before] - here)
            .norm()
            .min((points[(at + 1) % count] - here).norm());
        points[at] = here + random.direction() * (reach * random.next());
        if !(is_free(points, before) && is_free(points, at) && doubled_area(points) > 0.0) {
            points[at] = here;
        }
    }
}

fn boxes_meet(a: Point, b: Point, c: Point, d: Point) -> bool {
    let (low, high) = (a.inf(&b), a.sup(&b));
    let (other_low, other_high) = (c.inf(&d), c.sup(&d));
    low.x <= other_high.x && other_low.x <= high.x && low.y <= other_high.y && other_low.y <= high.y
}
