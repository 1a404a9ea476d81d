//! Where a chain may be: the best of what its joints allow.
//!
//! A chain, what it hangs on where that is, and what the rest of the figure shows -> places of its vertices, the likeliest first.
//!
//! 1. The first band turns about its joint by any angle, and the joint may lie a little elsewhere.
//! 2. Every further band continues the one before it with a bend. The states that cost least go on, no two of which are nearly the same.
//! 3. A state costs what its patches differ from the pose. Where others cover it, it may be hidden, at a price; where it explains what nothing else
//!    does, it earns something; bends cost; and so does lying where an earlier band of the same chain lies already.
//!
//! Source: the beam search over articulated chains that follows from the pictorial structures of Felzenszwalb and Huttenlocher 2005 when the chain is
//! long and its states are continuous: what is kept of each link is a fixed number of states instead of a table of all.

use std::collections::BTreeSet;
use std::f64::consts::{FRAC_PI_4, TAU};

use rayon::prelude::*;

use super::articulation::{Articulation, median};
use super::comparison::{BARE, CELL_PX, Comparison, Layer, MOST};
use super::pinned::Pinned;
use crate::appearance::STEPS_PER_UNIT;
use crate::math::{Point, angle, rotation};
use crate::registration::template::{MOST_DIFFERENCE, Template};

/// States that go on: so many, and more for every band of the chain, since a long one can go wrong more often; at most.
const WIDTH: usize = 80;
const WIDTH_A_BAND: usize = 8;
pub(super) const MOST_WIDTH: usize = 300;
/// Directions of a first band.
pub(super) const TURNS: usize = 24;
/// Bends between bands, in degrees.
pub(super) const BENDS_DEG: [f64; 9] = [0.0, -12.0, 12.0, -25.0, 25.0, -45.0, 45.0, -70.0, 70.0];
/// Shifts of a first joint: distance in spacings, how many around, and what they cost a vertex.
const SHIFTS: [(f64, usize, f64); 4] = [(0.0, 1, 0.0), (1.0, 6, 0.01), (2.2, 8, 0.03), (4.0, 12, 0.06)];
/// What a vertex costs where others may hide it.
const HIDDEN: f64 = 0.3;
/// Differences of the rest from which on the pose is not quite explained, and not at all.
const BARELY: f32 = 0.25;
const BADLY: f32 = 0.75;
/// What is not explained is averaged this far around, in spacings: a single line is no limb.
const LIMB_SPACINGS: f64 = 0.4;
/// What a vertex earns where nothing else explains the pose, if it fits.
const EXPLAINS: f64 = 0.35;
/// What a radian of turn costs a vertex of the first band, and a bend of 45 degrees one of a later band; bends cost as their 3/2th power.
pub(super) const TURN_COST: f64 = 0.02;
const BEND_COST: f64 = 0.05;
/// How broad a chain is, in median depths of a band's vertices, beside a spacing.
const BREADTH: f64 = 1.6;
/// What a vertex costs where its chain is already, within how many breadths, and how many bands further back that is looked for.
const AGAIN: f64 = 0.08;
const AGAIN_REACH: f64 = 1.5;
const AGAIN_BANDS: usize = 3;
/// Nearer than this to one of these, in breadths, it is hidden by it.
const UNDER: f64 = 0.9;
/// Vertices of a band that are compared at most.
const SAMPLES: usize = 6;
/// Vertices of the parent, the nearest to the joint, that say how it is turned there.
const HOLD: usize = 14;
/// States are nearly the same in one cell of this side, in spacings, and within this angle.
const CELL_SPACINGS: f64 = 0.7;
const CELL_RAD: f64 = 0.25;
/// Hypotheses differ where their last bands are this far apart, in spacings, or turned by this much against one another.
const APART_SPACINGS: f64 = 2.2;
const APART_RAD: f64 = 0.6;

/// A chain put somewhere.
pub(super) struct Hypothesis {
    /// The chain's vertices and their places.
    pub(super) places: Vec<(usize, Point)>,
}

/// A band's placement: where its joint is and how it is turned.
#[derive(Clone, Copy)]
pub(super) struct State {
    pub(super) joint: Point,
    pub(super) turn_rad: f64,
    pub(super) cost: f64,
    /// The state of the band that was put before it.
    pub(super) before: usize,
    /// Whether an earlier band of the chain lies there, which may hide it.
    pub(super) is_under: bool,
}

/// What hypotheses are made from.
pub(super) struct Search<'a> {
    pub(super) limbs: &'a Articulation,
    pub(super) comparison: &'a Comparison<'a>,
    pub(super) patches: &'a Template,
    pub(super) pinned: &'a Pinned,
    /// How much larger the figure is in the pose.
    pub(super) scale: f64,
}

/// What the rest of the figure shows.
pub(super) struct Rest {
    pub(super) is_covered: Vec<bool>,
    /// By cell, from 0 to 1, how little it is explained.
    pub(super) unexplained: Vec<f32>,
}

impl Search<'_> {
    /// At most `most` hypotheses of bands that continue one another and hang on others at `places`; `rest` is what these show.
    pub(super) fn put_from_joint(
        &self,
        nodes: &[usize],
        places: &[Point],
        rest: &Rest,
        most: usize,
    ) -> Vec<Hypothesis> {
        let limbs = self.limbs;
        let Some((&first, rest_of_nodes)) = nodes.split_first() else {
            return Vec::new();
        };
        let bands = bands_of(limbs, nodes);
        let length = limbs.count(nodes) as f64;
        let (root, root_turn_rad) = self.hold(first, places);
        let width = (WIDTH + WIDTH_A_BAND * nodes.len()).min(MOST_WIDTH);
        let mut trail: Vec<Vec<State>> =
            vec![self.first_states(first, &bands[0], (root, root_turn_rad), length, rest, width)];
        for (k, &node) in rest_of_nodes.iter().enumerate() {
            let before = nodes[k];
            let states = self.continued(&trail, before, (node, &bands[k + 1]), rest, width);
            trail.push(states);
        }
        let ends = trail.last().map(Vec::as_slice).unwrap_or_default();
        self.distinct(nodes, &trail, ends, |end| *end, most)
    }

    /// What is left to be explained.
    pub(super) fn rest(&self, others: &Layer) -> Rest {
        let [columns, rows] = self.comparison.size;
        let bare: Vec<f32> = (others.iter().zip(&self.comparison.figure))
            .map(|(differs, in_figure)| {
                let differs = f32::from((*differs).min(MOST)) / STEPS_PER_UNIT;
                if *in_figure {
                    ((differs - BARELY) / (BADLY - BARELY)).clamp(0.0, 1.0)
                } else {
                    0.0
                }
            })
            .collect();
        let reach = ((LIMB_SPACINGS * self.comparison.lattice.spacing / CELL_PX as f64).round() as usize).max(1);
        Rest {
            is_covered: others.iter().map(|differs| *differs != BARE).collect(),
            unexplained: averaged(&bare, columns, rows, reach),
        }
    }

    /// Where the joint of a first band is, and how what it hangs on is turned there.
    pub(super) fn hold(&self, first: usize, places: &[Point]) -> (Point, f64) {
        let (limbs, points) = (self.limbs, &self.comparison.lattice.points);
        let joint = limbs.joints[first];
        let mut near = limbs.nodes[limbs.parents[first]].clone();
        near.sort_by(|a, b| {
            let distance = |v: &usize| (points[*v] - joint).norm_squared();
            distance(a).total_cmp(&distance(b)).then(a.cmp(b))
        });
        near.truncate(HOLD);
        let count = near.len().max(1) as f64;
        let from = near.iter().map(|v| points[*v]).sum::<Point>() / count;
        let to = near.iter().map(|v| places[*v]).sum::<Point>() / count;
        let turn_rad = angle::best_turn(near.iter().map(|v| (points[*v] - from, places[*v] - to)));
        (to + rotation(turn_rad) * (joint - from) * self.scale, turn_rad)
    }

    fn first_states(
        &self,
        node: usize,
        band: &[usize],
        (root, root_turn_rad): (Point, f64),
        length: f64,
        rest: &Rest,
        width: usize,
    ) -> Vec<State> {
        let spacing = self.comparison.lattice.spacing;
        let weight = self.limbs.nodes[node].len() as f64;
        let mut states = Vec::new();
        for (distance, around, cost) in SHIFTS {
            for k in 0..around {
                let direction = TAU * k as f64 / around as f64;
                let joint = root + rotation(direction) * Point::new(distance * spacing, 0.0);
                for turn in 0..TURNS {
                    let turned_rad = angle::wrap(TAU * turn as f64 / TURNS as f64);
                    states.push(State {
                        joint,
                        turn_rad: root_turn_rad + turned_rad,
                        cost: cost * length + TURN_COST * weight * turned_rad.abs(),
                        before: 0,
                        is_under: false,
                    });
                }
            }
        }
        self.price(node, band, &mut states, rest);
        self.fittest(states, width)
    }

    /// The states of a band that follow from those of the band before it.
    fn continued(
        &self,
        trail: &[Vec<State>],
        before: usize,
        (node, band): (usize, &[usize]),
        rest: &Rest,
        width: usize,
    ) -> Vec<State> {
        let limbs = self.limbs;
        let step = (limbs.joints[node] - limbs.joints[before]) * self.scale;
        let weight = limbs.nodes[node].len() as f64;
        let Some(last) = trail.last() else { return Vec::new() };
        let depths: Vec<f64> = limbs.nodes[node].iter().map(|v| limbs.depth[*v]).collect();
        let breadth = BREADTH * median(&depths) * self.scale + self.comparison.lattice.spacing;
        let mut states = Vec::with_capacity(last.len() * BENDS_DEG.len());
        for (number, state) in last.iter().enumerate() {
            let joint = state.joint + rotation(state.turn_rad) * step;
            let nearest = nearest_before(trail, number, joint);
            let again = AGAIN * weight * (AGAIN_REACH - nearest / breadth).clamp(0.0, 1.0);
            for bend_deg in BENDS_DEG {
                let bend_rad = bend_deg.to_radians();
                states.push(State {
                    joint,
                    turn_rad: state.turn_rad + bend_rad,
                    cost: state.cost + bend_cost(bend_rad, weight) + again,
                    before: number,
                    is_under: nearest < UNDER * breadth,
                });
            }
        }
        self.price(node, band, &mut states, rest);
        self.fittest(states, width)
    }

    /// Adds what the vertices of a band cost where the states put them.
    pub(super) fn price(&self, node: usize, band: &[usize], states: &mut [State], rest: &Rest) {
        let comparison = self.comparison;
        let joint = self.limbs.joints[node];
        let weight = self.limbs.nodes[node].len() as f64 / band.len().max(1) as f64;
        states.par_iter_mut().with_min_len(64).for_each(|state| {
            let frame = rotation(state.turn_rad) * self.scale;
            let cost = |v: &usize| {
                let place = state.joint + frame * (comparison.lattice.points[*v] - joint);
                let differs = f64::from(self.patches.difference_at(comparison.pose, *v, place, &frame));
                let cell = comparison.cell_at(place);
                let seen = if state.is_under || rest.is_covered[cell] {
                    differs.min(HIDDEN)
                } else {
                    differs
                };
                let fits = (1.0 - 2.0 * differs / f64::from(MOST_DIFFERENCE)).clamp(0.0, 1.0);
                seen - EXPLAINS * f64::from(rest.unexplained[cell]) * fits
            };
            state.cost += weight * band.iter().map(cost).sum::<f64>();
            let place = |p: Point| state.joint + frame * (p - joint);
            state.cost +=
                self.limbs.nodes[node].len() as f64 * self.pinned.of_band(node, &comparison.lattice.points, place);
        });
    }

    /// The states that cost least, one of those that are nearly the same.
    pub(super) fn fittest(&self, mut states: Vec<State>, width: usize) -> Vec<State> {
        states.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        let side = CELL_SPACINGS * self.comparison.lattice.spacing;
        let mut taken = BTreeSet::new();
        let mut fittest = Vec::with_capacity(width);
        for state in states {
            // Casts saturate.
            let cell = |value: f64| value.round() as i64;
            let turn = angle::wrap(state.turn_rad);
            if taken.insert((
                cell(state.joint.x / side),
                cell(state.joint.y / side),
                cell(turn / CELL_RAD),
            )) {
                fittest.push(state);
                if fittest.len() == width {
                    break;
                }
            }
        }
        fittest
    }

    /// The first of `ends`, states of the band that was put last, whose tips differ from one another, with all bands; `tip_of` has the tip that belongs to an end.
    pub(super) fn distinct(
        &self,
        nodes: &[usize],
        trail: &[Vec<State>],
        ends: &[State],
        tip_of: impl Fn(&State) -> State,
        most: usize,
    ) -> Vec<Hypothesis> {
        let apart = APART_SPACINGS * self.comparison.lattice.spacing;
        let mut tips: Vec<State> = Vec::new();
        let mut found = Vec::new();
        for end in ends {
            let tip = tip_of(end);
            let is_known = tips.iter().any(|other| {
                (other.joint - tip.joint).norm() < apart && angle::wrap(other.turn_rad - tip.turn_rad).abs() < APART_RAD
            });
            if is_known {
                continue;
            }
            tips.push(tip);
            found.push(self.hypothesis(nodes, trail, end));
            if found.len() == most {
                break;
            }
        }
        found
    }

    /// The bands `nodes`, in the order that they were put in, of which the last one's state is `end`.
    fn hypothesis(&self, nodes: &[usize], trail: &[Vec<State>], end: &State) -> Hypothesis {
        let (limbs, points) = (self.limbs, &self.comparison.lattice.points);
        let mut places = Vec::new();
        let mut state = *end;
        for (k, &node) in nodes.iter().enumerate().rev() {
            let frame = rotation(state.turn_rad) * self.scale;
            let place = |v: &usize| (*v, state.joint + frame * (points[*v] - limbs.joints[node]));
            places.extend(limbs.nodes[node].iter().map(place));
            if k > 0 {
                state = trail[k - 1][state.before];
            }
        }
        Hypothesis { places }
    }
}

/// What a bend costs a band of so many vertices.
pub(super) fn bend_cost(bend_rad: f64, vertices: f64) -> f64 {
    let bent = bend_rad.abs() / FRAC_PI_4;
    BEND_COST * vertices * (bent * bent.sqrt())
}

/// How near the joints of earlier bands come to a place, but for those of the last few.
fn nearest_before(trail: &[Vec<State>], number: usize, place: Point) -> f64 {
    let (mut at, mut nearest) = (number, f64::INFINITY);
    for (back, states) in trail.iter().rev().enumerate() {
        let state = &states[at];
        if back >= AGAIN_BANDS {
            nearest = nearest.min((state.joint - place).norm());
        }
        at = state.before;
    }
    nearest
}

/// The vertices of bands that are compared.
pub(super) fn bands_of(limbs: &Articulation, nodes: &[usize]) -> Vec<Vec<usize>> {
    let samples = |node: &usize| spread_out(&limbs.nodes[*node], SAMPLES);
    nodes.iter().map(samples).collect()
}

/// At most `most` of some vertices, evenly among them.
pub(super) fn spread_out(vertices: &[usize], most: usize) -> Vec<usize> {
    let count = vertices.len().min(most);
    (0..count).map(|k| vertices[k * vertices.len() / count]).collect()
}

/// The mean over squares of `2 reach + 1` cells.
fn averaged(values: &[f32], columns: usize, rows: usize, reach: usize) -> Vec<f32> {
    let line = |get: &dyn Fn(usize) -> f32, count: usize| -> Vec<f32> {
        let mut sums = Vec::with_capacity(count + 1);
        sums.push(0.0);
        for k in 0..count {
            sums.push(sums[k] + get(k));
        }
        let span = (2 * reach + 1) as f32;
        (0..count)
            .map(|k| (sums[(k + reach + 1).min(count)] - sums[k.saturating_sub(reach)]) / span)
            .collect()
    };
    let mut across = vec![0.0; values.len()];
    for (row, out) in across.chunks_exact_mut(columns.max(1)).enumerate() {
        out.copy_from_slice(&line(&|k| values[row * columns + k], columns));
    }
    let mut both = vec![0.0; values.len()];
    for column in 0..columns {
        for (row, value) in line(&|k| across[k * columns + column], rows).into_iter().enumerate() {
            both[row * columns + column] = value;
        }
    }
    both
}
