//! What an artist says corresponds, in the search of limbs.
//!
//! A pin is a place of the reference and where that is in the pose. Hypotheses that miss it cost, and so does a figure: a landmark on a hand takes the arm
//! there, whatever else looks like it.

use super::articulation::Articulation;
use super::named::Seen;
use crate::math::Point;
use crate::registration::pair::Pair;

/// A pin is met within one spacing, one on a limb that is only seen about there within several, and missed altogether this many further away.
const MET: f64 = 1.0;
const ABOUT: f64 = 4.0;
const MISSED: f64 = 3.0;
/// What a missed pin costs a vertex of its band, of [`MOST_DIFFERENCE`](crate::registration::template::MOST_DIFFERENCE) that a wrong picture costs.
const BAND_COST: f64 = 0.6;
/// What it costs the whole figure: more than any limb explains.
const FIGURE_COST: f64 = 0.1;

/// The pins of a pose.
#[derive(Debug)]
pub(super) struct Pinned {
    pins: Vec<Fastened>,
    /// By band, the pins in it.
    of_node: Vec<Vec<usize>>,
    spacing: f64,
}

#[derive(Debug)]
struct Fastened {
    /// The vertex that it is nearest to, and how far it is from there.
    vertex: usize,
    aside: Point,
    to: Point,
    /// Within how many spacings it is met.
    met: f64,
}

impl Fastened {
    /// Where it is if the vertices are at `places`.
    fn put(&self, places: &[Point], scale: f64) -> Point {
        places[self.vertex] + self.aside * scale
    }
}

impl Pinned {
    /// Those of the pair, and where limbs are seen, in working pixels.
    pub(super) fn new(pair: &Pair<'_>, limbs: &Articulation, seen: &[Seen]) -> Self {
        let mut pinned = Self {
            pins: Vec::new(),
            of_node: vec![Vec::new(); limbs.nodes.len()],
            spacing: pair.lattice.spacing,
        };
        let pins = pair.pins.iter().map(|pin| (pin.from, pin.to, MET));
        for (from, to, met) in pins.chain(seen.iter().map(|seen| (seen.from, seen.to, ABOUT))) {
            if let Some((vertex, _)) = pair.lattice.cell_at(from) {
                pinned.of_node[limbs.node_of[vertex]].push(pinned.pins.len());
                pinned.pins.push(Fastened {
                    vertex,
                    aside: from - pair.lattice.points[vertex],
                    to,
                    met,
                });
            }
        }
        pinned
    }

    /// Whether there is a pin in some bands.
    pub(super) fn is_on(&self, nodes: &[usize]) -> bool {
        nodes.iter().any(|node| !self.of_node[*node].is_empty())
    }

    /// What a band costs a vertex whose pins are put by `place`, which has where a place of the reference goes; `points` are the reference's vertices.
    pub(super) fn of_band(&self, node: usize, points: &[Point], place: impl Fn(Point) -> Point) -> f64 {
        let pins = self.of_node[node].iter().map(|pin| &self.pins[*pin]);
        pins.map(|pin| BAND_COST * self.missed(pin, place(points[pin.vertex] + pin.aside)))
            .sum()
    }

    /// What a figure costs whose vertices are at `places`, `scale` times as large as the reference.
    pub(super) fn of_figure(&self, places: &[Point], scale: f64) -> f64 {
        let missed = |pin: &Fastened| self.missed(pin, pin.put(places, scale));
        FIGURE_COST * self.pins.iter().map(missed).sum::<f64>()
    }

    /// Whether all pins of some bands are met.
    pub(super) fn are_met(&self, nodes: &[usize], places: &[Point], scale: f64) -> bool {
        let mut pins = nodes
            .iter()
            .flat_map(|node| &self.of_node[*node])
            .map(|pin| &self.pins[*pin]);
        pins.all(|pin| self.missed(pin, pin.put(places, scale)) <= 0.0)
    }

    /// How badly a pin that is put at a place is missed, from 0 to 1.
    fn missed(&self, pin: &Fastened, place: Point) -> f64 {
        (((place - pin.to).norm() / self.spacing - pin.met) / MISSED).clamp(0.0, 1.0)
    }
}
