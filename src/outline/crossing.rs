//! Where closed polygons cross themselves or one another, decided exactly.
//!
//! Closed polygons whose edges are known, and points for them -> the pairs of edges that cross, with their places.
//!
//! 1. Candidate pairs of edges are found by a sweep along the axis on which the edges overlap least, then by their boxes.
//! 2. Two edges whose insides meet in one point cross (`predicate::cross_properly`).
//! 3. Where an end of one edge lies on the other, the polygons meet without any two edges crossing. They cross there if they come from different sides of
//!    one another; where they run along one another, the ends of that common stretch decide.
//!
//! What touches and turns back does not cross: that is the difference from `simplicity`, which forbids touching too. Edges without length are passed over.
//!
//! Cost O(n log n) for edges of similar length, O(n^2) if all edges overlap on both axes.

use std::cmp::Ordering;

use super::simplicity::common_point;
use crate::math::{Point, predicate};

/// The edges of some closed polygons, numbered through all of them: edge `k` runs from point `k` to point `next[k]`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ClosedCurves {
    next: Vec<usize>,
    previous: Vec<usize>,
}

/// Which side of a directed curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    /// Where triangles on the curve are positive.
    Positive,
    Negative,
}

/// The points of a curve on both sides of a place on it: the last one before it that lies elsewhere, and the first one after it.
#[derive(Debug, Clone, Copy)]
struct Passage {
    before: usize,
    after: usize,
}

impl ClosedCurves {
    /// For curves with so many points each, which stand one after the other.
    pub(crate) fn of_lengths(lengths: impl IntoIterator<Item = usize>) -> Self {
        let (mut next, mut previous) = (Vec::new(), Vec::new());
        for length in lengths {
            let start = next.len();
            next.extend((0..length).map(|k| start + (k + 1) % length));
            previous.extend((0..length).map(|k| start + (k + length - 1) % length));
        }
        Self { next, previous }
    }

    /// How many points and edges there are.
    pub(crate) fn len(&self) -> usize {
        self.next.len()
    }

    /// Calls `visit` with the edges of each crossing, the smaller number first, and its place up to rounding. The order of the calls depends on the points alone.
    /// All of `points` are finite. A crossing at a common point of four edges is that of the two that begin there.
    pub(crate) fn for_each_crossing(&self, points: &[Point], mut visit: impl FnMut([usize; 2], Point)) {
        let mut active: Vec<SweptEdge> = Vec::new();
        for edge in self.swept(points) {
            active.retain(|other| other.high[0] >= edge.low[0]);
            for other in &active {
                if other.low[1] <= edge.high[1] && edge.low[1] <= other.high[1] {
                    let (first, second) = (edge.number.min(other.number), edge.number.max(other.number));
                    self.decide(points, [first, second], &mut visit);
                }
            }
            active.push(edge);
        }
    }

    /// The edges with length in the order of the sweep.
    fn swept(&self, points: &[Point]) -> Vec<SweptEdge> {
        let mut edges: Vec<SweptEdge> = Vec::with_capacity(self.len());
        for (number, (a, &next)) in points.iter().zip(&self.next).enumerate() {
            let b = points[next];
            if *a != b {
                let (low, high) = (a.inf(&b), a.sup(&b));
                edges.push(SweptEdge {
                    number,
                    low: [low.x, low.y],
                    high: [high.x, high.y],
                });
            }
        }
        // How many edges a line across the axis meets on average: their lengths along it, over that of all together.
        let crowd = |axis: usize| {
            let lengths: f64 = edges.iter().map(|edge| edge.high[axis] - edge.low[axis]).sum();
            let low = edges.iter().map(|edge| edge.low[axis]).fold(f64::INFINITY, f64::min);
            let high = edges
                .iter()
                .map(|edge| edge.high[axis])
                .fold(f64::NEG_INFINITY, f64::max);
            lengths / (high - low)
        };
        // A comparison with what is not a number is false.
        if crowd(1) < crowd(0) {
            for edge in &mut edges {
                edge.low.swap(0, 1);
                edge.high.swap(0, 1);
            }
        }
        edges.sort_unstable_by(|a, b| a.low[0].total_cmp(&b.low[0]).then(a.number.cmp(&b.number)));
        edges
    }

    /// Calls `visit` if two edges with length cross.
    fn decide(&self, points: &[Point], [first, second]: [usize; 2], visit: &mut impl FnMut([usize; 2], Point)) {
        let [[a, b], [c, d]] = [first, second].map(|edge| [points[edge], points[self.next[edge]]]);
        let (abc, abd) = (predicate::orientation(a, b, c), predicate::orientation(a, b, d));
        if abc == abd && abc != Ordering::Equal {
            return;
        }
        if predicate::cross_properly(a, b, c, d) {
            visit([first, second], common_point(a, b, c, d));
            return;
        }
        // Beginnings of edges on the other edge, of which the end is not part: every meeting of two curves is found once.
        let begins_inside = |p: Point, from: Point, to: Point| p != to && predicate::on_segment(p, from, to);
        let meetings = [
            begins_inside(a, c, d).then_some(a),
            (a != c && begins_inside(c, a, b)).then_some(c),
        ];
        for place in meetings.into_iter().flatten() {
            if self.pass(points, first, second, place) {
                visit([first, second], place);
            }
        }
    }

    /// Whether the curve of edge `second` passes from one side of the curve of edge `first` to the other at `place`, or along the stretch that they have in
    /// common there.
    fn pass(&self, points: &[Point], first: usize, second: usize, place: Point) -> bool {
        let along = self.passage(points, first, place);
        let Passage { before, after } = self.passage(points, second, place);
        let from = self.side_of_arm(points, along, place, before, &self.previous);
        let to = self.side_of_arm(points, along, place, after, &self.next);
        matches!((from, to), (Some(from), Some(to)) if from != to)
    }

    /// How the curve of `edge` passes `place`, which is its beginning or inside it.
    fn passage(&self, points: &[Point], edge: usize, place: Point) -> Passage {
        let before = if points[edge] == place {
            self.distinct(points, edge, &self.previous)
        } else {
            edge
        };
        Passage {
            before,
            after: self.next[edge],
        }
    }

    /// The first point from `from` on, by the links of `step`, that lies elsewhere; `from` itself if all lie there.
    fn distinct(&self, points: &[Point], from: usize, step: &[usize]) -> usize {
        let mut at = step[from];
        while at != from && points[at] == points[from] {
            at = step[at];
        }
        at
    }

    /// On which side of the curve of `along` a second curve leaves it that goes from `place` to point `to` and on by the links of `step`; nothing if it never
    /// does.
    fn side_of_arm(
        &self,
        points: &[Point],
        mut along: Passage,
        mut place: Point,
        mut to: usize,
        step: &[usize],
    ) -> Option<Side> {
        // Every step reaches a further point of one of the two.
        for _ in 0..2 * self.len() {
            let (before, after, target) = (points[along.before], points[along.after], points[to]);
            let is_forward = is_same_direction(place, after, target);
            if !is_forward && !is_same_direction(place, before, target) {
                return Some(side(before, place, after, target));
            }
            // The nearer one of the curve's point and the arm's is reached.
            let (ahead, end) = if is_forward {
                (along.after, after)
            } else {
                (along.before, before)
            };
            let is_end = predicate::on_segment(end, place, target);
            place = if is_end { end } else { target };
            if place == target {
                to = self.distinct(points, to, step);
            }
            let (behind, beyond) = if is_forward {
                (&self.previous, &self.next)
            } else {
                (&self.next, &self.previous)
            };
            let left = self.distinct(points, ahead, behind);
            let next = if is_end {
                self.distinct(points, ahead, beyond)
            } else {
                ahead
            };
            along = if is_forward {
                Passage {
                    before: left,
                    after: next,
                }
            } else {
                Passage {
                    before: next,
                    after: left,
                }
            };
        }
        None
    }
}

/// An edge and its box, the axis of the sweep first.
#[derive(Debug, Clone, Copy)]
struct SweptEdge {
    number: usize,
    low: [f64; 2],
    high: [f64; 2],
}

/// Whether `p` and `q` lie in exactly the same direction from `place`.
fn is_same_direction(place: Point, p: Point, q: Point) -> bool {
    let signs = |p: Point| [p.x.partial_cmp(&place.x), p.y.partial_cmp(&place.y)];
    predicate::orientation(place, p, q) == Ordering::Equal && p != place && signs(p) == signs(q)
}

/// On which side of the path `before`, `place`, `after` the direction to `target` lies, which is that of neither end. Of a path that turns back on itself all
/// directions are on one side.
fn side(before: Point, place: Point, after: Point, target: Point) -> Side {
    let positive = |a: Point, b: Point| predicate::orientation(a, b, target) == Ordering::Greater;
    let negative = |a: Point, b: Point| predicate::orientation(a, b, target) == Ordering::Less;
    let is_positive = match predicate::orientation(before, place, after) {
        Ordering::Greater => positive(before, place) && positive(place, after),
        Ordering::Less => !(negative(before, place) && negative(place, after)),
        Ordering::Equal if is_same_direction(place, before, after) => true,
        Ordering::Equal => positive(before, place),
    };
    if is_positive { Side::Positive } else { Side::Negative }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The pairs of edges that cross, in order.
    fn crossings(rings: &[&[[f64; 2]]]) -> Vec<[usize; 2]> {
        let curves = ClosedCurves::of_lengths(rings.iter().map(|ring| ring.len()));
        let points: Vec<Point> = rings.iter().copied().flatten().copied().map(Point::from).collect();
        let mut found = Vec::new();
        curves.for_each_crossing(&points, |edges, _| found.push(edges));
        found.sort_unstable();
        found
    }

    const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];

    #[test]
    fn a_bow_tie_crosses_in_its_middle() {
        let bow_tie = [[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]];
        assert_eq!(crossings(&[&bow_tie]), [[0, 2]]);
        let curves = ClosedCurves::of_lengths([4]);
        let points = bow_tie.map(Point::from);
        curves.for_each_crossing(&points, |_, place| assert_eq!(place, Point::new(1.0, 1.0)));
        assert!(crossings(&[&SQUARE]).is_empty());
    }

    #[test]
    fn rings_that_cross_one_another_do_so_an_even_number_of_times() {
        let moved = SQUARE.map(|[x, y]| [x + 1.0, y + 2.0]);
        assert_eq!(crossings(&[&SQUARE, &moved]), [[1, 4], [2, 7]]);
        let inside = [[1.0, 1.0], [1.0, 2.0], [2.0, 2.0]];
        assert!(crossings(&[&SQUARE, &inside]).is_empty());
    }

    #[test]
    fn a_vertex_that_touches_an_edge_does_not_cross_it() {
        let pinched = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 0.0], [0.0, 4.0]];
        assert!(crossings(&[&pinched]).is_empty());
        // The same vertex one unit of the last place further down.
        let mut crossed = pinched;
        crossed[3][1] = -f64::MIN_POSITIVE;
        assert_eq!(crossings(&[&crossed]).len(), 2);
        // Two squares that share a corner, or part of a side.
        let corner = SQUARE.map(|[x, y]| [x + 4.0, y + 4.0]);
        let beside = SQUARE.map(|[x, y]| [x + 4.0, y + 1.0]);
        assert!(crossings(&[&SQUARE, &corner]).is_empty());
        assert!(crossings(&[&SQUARE, &beside]).is_empty());
        assert!(crossings(&[&SQUARE, &SQUARE]).is_empty());
    }

    #[test]
    fn curves_that_pass_through_a_vertex_cross_there_once() {
        // An eight whose middle is a vertex of one branch, and of both.
        let one = [[0.0, 0.0], [2.0, 2.0], [4.0, 4.0], [4.0, 0.0], [0.0, 4.0]];
        assert_eq!(crossings(&[&one]), [[1, 3]]);
        let both = [[0.0, 0.0], [2.0, 2.0], [4.0, 4.0], [4.0, 0.0], [2.0, 2.0], [0.0, 4.0]];
        assert_eq!(crossings(&[&both]), [[1, 4]]);
        // With a repeated point, which makes an edge without length.
        let repeated = [
            [0.0, 0.0],
            [2.0, 2.0],
            [2.0, 2.0],
            [4.0, 4.0],
            [4.0, 0.0],
            [2.0, 2.0],
            [0.0, 4.0],
        ];
        assert_eq!(crossings(&[&repeated]), [[2, 5]]);
    }

    #[test]
    fn curves_that_run_along_one_another_cross_if_they_change_sides() {
        let along = |y: f64| {
            [
                [-1.0, 1.0],
                [1.0, 0.0],
                [2.0, 0.0],
                [5.0, 0.0],
                [6.0, y],
                [6.0, 9.0],
                [-1.0, 9.0],
            ]
        };
        let half_plane = [[0.0, 0.0], [0.0, -5.0], [9.0, -5.0], [9.0, 0.0], [3.0, 0.0]];
        // It leaves the common stretch on the side it came from, or on the other one; then it crosses once more elsewhere.
        assert!(crossings(&[&half_plane, &along(1.0)]).is_empty());
        let other = along(-1.0);
        let found = crossings(&[&half_plane, &other]);
        assert!(found.contains(&[3, 9]), "{found:?}");
        assert!(found.iter().any(|edges| *edges != [3, 9]), "{found:?}");
    }

    proptest! {
        /// The sweep finds what looking at all pairs finds, and closed curves in general position cross one another an even number of times.
        #[test]
        fn the_sweep_finds_what_all_pairs_show(
            first in proptest::collection::vec([-9.0..9.0f64, -9.0..9.0f64], 3..24),
            second in proptest::collection::vec([-9.0..9.0f64, -9.0..9.0f64], 3..24),
        ) {
            let found = crossings(&[&first, &second]);
            let curves = ClosedCurves::of_lengths([first.len(), second.len()]);
            let points: Vec<Point> = first.iter().chain(&second).copied().map(Point::from).collect();
            let ends = |edge: usize| (points[edge], points[curves.next[edge]]);
            let mut expected = Vec::new();
            for i in 0..points.len() {
                for j in i + 1..points.len() {
                    let ((a, b), (c, d)) = (ends(i), ends(j));
                    if predicate::cross_properly(a, b, c, d) {
                        expected.push([i, j]);
                    }
                }
            }
            prop_assert_eq!(&found, &expected);
            let between = found.iter().filter(|[i, j]| *i < first.len() && *j >= first.len());
            prop_assert_eq!(between.count() % 2, 0);
        }
    }

    proptest! {
        // Most curves on so coarse a grid share a stretch or turn back, and are passed over.
        #![proptest_config(ProptestConfig::with_cases(4000))]

        /// On a coarse grid, where vertices lie on edges and edges on one another, two closed curves still cross an even number of times.
        #[test]
        fn closed_curves_on_a_grid_cross_evenly(
            first in proptest::collection::vec([0..4i32, 0..4i32], 3..7),
            second in proptest::collection::vec([0..4i32, 0..4i32], 3..7),
        ) {
            let place = |p: &[i32; 2]| p.map(f64::from);
            let (first, second): (Vec<_>, Vec<_>) = (first.iter().map(place).collect(), second.iter().map(place).collect());
            let curves = ClosedCurves::of_lengths([first.len(), second.len()]);
            let points: Vec<Point> = first.iter().chain(&second).copied().map(Point::from).collect();
            let shares_a_stretch = |i: usize, j: usize| {
                let ((a, b), (c, d)) = ((points[i], points[curves.next[i]]), (points[j], points[curves.next[j]]));
                let inner = [a, b, c, d].iter().filter(|p| predicate::on_segment(**p, a, b) && predicate::on_segment(**p, c, d)).count();
                predicate::orientation(a, b, c).is_eq() && predicate::orientation(a, b, d).is_eq() && inner > 1
            };
            let turns_back = |k: usize| {
                let after = curves.next[k];
                predicate::folds_back(points[k], points[after], points[curves.next[after]]) || points[k] == points[after]
            };
            let have_a_stretch = (0..first.len()).any(|i| (first.len()..points.len()).any(|j| shares_a_stretch(i, j)));
            if have_a_stretch || (0..points.len()).any(turns_back) {
                return Ok(());
            }
            let mut count = 0;
            curves.for_each_crossing(&points, |[i, j], _| count += usize::from(i < first.len() && j >= first.len()));
            prop_assert_eq!(count % 2, 0);
        }
    }
}
