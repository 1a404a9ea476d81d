//! Where a chain may be, from its tip.
//!
//! A chain, what it hangs on where that is, and what the rest of the figure shows -> places of its vertices, the likeliest first.
//!
//! An arm behind the trunk shows its hand alone. Hypotheses from the joint on ([`super::hypotheses`]) lose it, since one hidden band is as good as
//! another; so the last band goes wherever the rest explains nothing and it fits, the bands before it follow, and what is left to the joint costs by its
//! length: the joint may be hidden, too. That is tried where an artist has marked something of the chain. Elsewhere it found as many wrong hands as right
//! ones.

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use super::comparison::middle;
use super::hypotheses::{
    BENDS_DEG, Hypothesis, MOST_WIDTH, Rest, Search, State, TURN_COST, TURNS, bands_of, bend_cost,
};
use crate::math::{Point, angle, rotation};

/// How little explained a place has to be for a tip, from 0 to 1.
const UNEXPLAINED: f32 = 0.5;
/// What a spacing between the joint and where it hangs costs a vertex, and the spacings beyond which it costs no more: it is torn off then.
const GAP_COST: f64 = 0.015;
const MOST_GAP: f64 = 12.0;

impl Search<'_> {
    /// At most `most` hypotheses of bands that continue one another and hang on others at `places`; `rest` is what these show. None where these explain everything.
    pub(super) fn put_from_tip(&self, nodes: &[usize], places: &[Point], rest: &Rest, most: usize) -> Vec<Hypothesis> {
        let limbs = self.limbs;
        let nodes: Vec<usize> = nodes.iter().rev().copied().collect();
        let (Some(&tip), Some(&first)) = (nodes.first(), nodes.last()) else {
            return Vec::new();
        };
        let bands = bands_of(limbs, &nodes);
        let length = limbs.count(&nodes) as f64;
        let mut trail = vec![self.tips(tip, &bands[0], rest)];
        for (k, &node) in nodes.iter().enumerate().skip(1) {
            let states = self.preceding(&trail[k - 1], nodes[k - 1], (node, &bands[k]), rest);
            trail.push(states);
        }
        let (root, root_turn_rad) = self.hold(first, places);
        let spacing = self.comparison.lattice.spacing;
        let weight = limbs.nodes[first].len() as f64;
        let mut ends = trail.last().cloned().unwrap_or_default();
        for state in &mut ends {
            let gap = ((state.joint - root).norm() / spacing).min(MOST_GAP);
            let turned_rad = angle::wrap(state.turn_rad - root_turn_rad).abs();
            state.cost += GAP_COST * length * gap + TURN_COST * weight * turned_rad;
        }
        ends.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        let put_before = trail.split_last().map(|(_, before)| before).unwrap_or_default();
        let tip_of = |end: &State| put_before.iter().rev().fold(*end, |state, states| states[state.before]);
        self.distinct(&nodes, &trail, &ends, tip_of, most)
    }

    /// The last band wherever the rest of the figure explains nothing.
    fn tips(&self, node: usize, band: &[usize], rest: &Rest) -> Vec<State> {
        let (comparison, limbs) = (self.comparison, self.limbs);
        let vertices = &limbs.nodes[node];
        let from = vertices.iter().map(|v| comparison.lattice.points[*v]).sum::<Point>() / vertices.len().max(1) as f64
            - limbs.joints[node];
        let (columns, side) = (comparison.size[0], comparison.lattice.spacing);
        let mut taken = BTreeSet::new();
        let mut states = Vec::new();
        for cell in 0..rest.unexplained.len() {
            let place = middle(cell, columns);
            // One a spacing; casts saturate.
            let square = ((place.x / side) as usize, (place.y / side) as usize);
            if !comparison.figure[cell] || rest.unexplained[cell] <= UNEXPLAINED || !taken.insert(square) {
                continue;
            }
            for turn in 0..TURNS {
                let turn_rad = TAU * turn as f64 / TURNS as f64;
                states.push(State {
                    joint: place - rotation(turn_rad) * from * self.scale,
                    turn_rad,
                    cost: 0.0,
                    before: 0,
                    is_under: false,
                });
            }
        }
        self.price(node, band, &mut states, rest);
        self.fittest(states, MOST_WIDTH)
    }

    /// The states of a band that those of the band after it, `after`, continue.
    fn preceding(&self, last: &[State], after: usize, (node, band): (usize, &[usize]), rest: &Rest) -> Vec<State> {
        let limbs = self.limbs;
        let step = (limbs.joints[after] - limbs.joints[node]) * self.scale;
        let weight = limbs.nodes[after].len() as f64;
        let mut states = Vec::with_capacity(last.len() * BENDS_DEG.len());
        for (number, state) in last.iter().enumerate() {
            for bend_deg in BENDS_DEG {
                let bend_rad: f64 = bend_deg.to_radians();
                let turn_rad = state.turn_rad - bend_rad;
                states.push(State {
                    joint: state.joint - rotation(turn_rad) * step,
                    turn_rad,
                    cost: state.cost + bend_cost(bend_rad, weight),
                    before: number,
                    is_under: false,
                });
            }
        }
        self.price(node, band, &mut states, rest);
        self.fittest(states, MOST_WIDTH)
    }
}
