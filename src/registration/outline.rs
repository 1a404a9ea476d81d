//! Beginnings of a registration: the interior that follows from outlines in correspondence.

use super::lattice::Lattice;
use super::rigid::{Rigid, Targets, turning};
use crate::math::{Matrix, Point, point};
use crate::solve::SolveError;

/// Vertices nearer than this to an outline point of their cell or a neighbouring one, in spacings, are put by it.
const NEAR: f64 = 0.9;
/// The trust of vertices that are not, beside 1 of those that are.
const FREE_TRUST: f64 = 1e-4;
/// Samples to each side that give the direction of a ring.
const TANGENT_REACH: usize = 3;
/// Stiffness beside a trust of 1, and alternations, of every round.
const ROUNDS: [(f64, usize); 3] = [(3.0, 12), (1.0, 12), (1.0, 12)];

/// A ring of the reference with a ring of another pose, point by point, both in working pixels.
pub(super) struct RingPair {
    pub(super) reference: Vec<Point>,
    pub(super) pose: Vec<Point>,
}

/// The point of a closed polygon nearest to `p` and its distance: it is next to the nearest of the vertices. `None` if it has none.
pub(super) fn nearest_on_ring(ring: &[Point], p: Point) -> Option<(f64, Point)> {
    let count = ring.len();
    let squared = |k: &usize| (ring[*k] - p).norm_squared();
    let nearest = (0..count).min_by(|a, b| squared(a).total_cmp(&squared(b)))?;
    let on_segment = |from: usize| {
        let (a, b) = (ring[from], ring[(from + 1) % count]);
        let (along, distance) = point::nearest_on_segment(p, a, b);
        (distance, a + (b - a) * along)
    };
    let (before, after) = (on_segment((nearest + count - 1) % count), on_segment(nearest));
    Some(if before.0 < after.0 { before } else { after })
}

/// Where the vertices go when the outlines do: those near an outline as it moves and turns there, those near a pin as it moves, the others as
/// rigidly as possible.
pub(super) fn spread(lattice: &Lattice, rings: &[RingPair], pins: &[[Point; 2]]) -> Result<Vec<Point>, SolveError> {
    let mut samples: Vec<(Point, Point, Point)> = Vec::new();
    let mut of_cell: Vec<Vec<usize>> = vec![Vec::new(); lattice.points.len()];
    for ring in rings {
        let count = ring.reference.len();
        let direction = |points: &[Point], k: usize| {
            points[(k + TANGENT_REACH) % count] - points[(k + count - TANGENT_REACH % count) % count]
        };
        for k in 0..count {
            let (a, b) = (direction(&ring.reference, k), direction(&ring.pose, k));
            let turn = Point::new(a.dot(&b), point::cross(a, b));
            let turn = match turn.norm() {
                length if length > 0.0 => turn / length,
                _ => Point::new(1.0, 0.0),
            };
            if let Some((cell, _)) = lattice.cell_at(ring.reference[k]) {
                of_cell[cell].push(samples.len());
            }
            samples.push((ring.reference[k], ring.pose[k], turn));
        }
    }
    if samples.is_empty() {
        return Ok(lattice.points.clone());
    }
    let nearest_of = |p: Point, of: &mut dyn Iterator<Item = usize>| {
        of.min_by(|a, b| {
            let squared = |k: usize| (samples[k].0 - p).norm_squared();
            squared(*a).total_cmp(&squared(*b))
        })
    };
    let (mut places, mut trust) = (Vec::new(), Vec::new());
    for (v, &p) in lattice.points.iter().enumerate() {
        let around = std::iter::once(v).chain(lattice.neighbours[v].iter().copied());
        let own = nearest_of(p, &mut around.flat_map(|cell| of_cell[cell].iter().copied()));
        let is_near = own.is_some_and(|k| (samples[k].0 - p).norm() < NEAR * lattice.spacing);
        let nearest = own.or_else(|| nearest_of(p, &mut (0..samples.len())));
        let (from, to, turn) = nearest.map_or((p, p, Point::new(1.0, 0.0)), |k| samples[k]);
        places.push(to + turning(turn) * (p - from));
        trust.push(Matrix::identity() * if is_near { 1.0 } else { FREE_TRUST });
    }
    for [from, to] in pins {
        if let Some((cell, _)) = lattice.cell_at(*from) {
            places[cell] = to + (lattice.points[cell] - from);
            trust[cell] = Matrix::identity();
        }
    }
    let targets = Targets {
        places: &places,
        trust: &trust,
    };
    let rigid = Rigid::new(lattice, Matrix::identity());
    let mut spread = places.clone();
    for (stiffness, iterations) in ROUNDS {
        spread = rigid.solve(&spread, &targets, stiffness, iterations)?;
    }
    Ok(spread)
}
