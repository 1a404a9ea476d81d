//! What an artist says corresponds, in the search of limbs.
//!
//! A pin is a place of the reference and where that is in the pose. Hypotheses that miss it cost, and so does a figure: a landmark on a hand takes the arm
//! there, whatever else looks like it.

use super::articulation::Articulation;
use crate::math::Point;
use crate::registration::pair::Pair;

/// A pin is met within one spacing, and missed altogether this many further away.
const MET: f64 = 1.0;
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
}

impl Fastened {
    /// Where it is if the vertices are at `places`.
    fn put(&self, places: &[Point], scale: f64) -> Point {
        places[self.vertex] + self.aside * scale
    }
}

impl Pinned {
    pub(super) fn new(pair: &Pair<'_>, limbs: &Articulation) -> Self {
        let mut pinned = Self {
            pins: Vec::new(),
            of_node: vec![Vec::new(); limbs.nodes.len()],
            spacing: pair.lattice.spacing,
        };
        for pin in &pair.pins {
            if let Some((vertex, _)) = pair.lattice.cell_at(pin.from) {
                pinned.of_node[limbs.node_of[vertex]].push(pinned.pins.len());
                pinned.pins.push(Fastened {
                    vertex,
                    aside: pin.from - pair.lattice.points[vertex],
                    to: pin.to,
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
        pins.map(|pin| BAND_COST * self.missed(place(points[pin.vertex] + pin.aside), pin.to))
            .sum()
    }

    /// What a figure costs whose vertices are at `places`, `scale` times as large as the reference.
    pub(super) fn of_figure(&self, places: &[Point], scale: f64) -> f64 {
        let missed = |pin: &Fastened| self.missed(pin.put(places, scale), pin.to);
        FIGURE_COST * self.pins.iter().map(missed).sum::<f64>()
    }

    /// Whether all pins of some bands are met.
    pub(super) fn are_met(&self, nodes: &[usize], places: &[Point], scale: f64) -> bool {
        let mut pins = nodes
            .iter()
            .flat_map(|node| &self.of_node[*node])
            .map(|pin| &self.pins[*pin]);
        pins.all(|pin| self.missed(pin.put(places, scale), pin.to) <= 0.0)
    }

    /// How badly a place misses `to`, from 0 to 1.
    fn missed(&self, place: Point, to: Point) -> f64 {
        (((place - to).norm() / self.spacing - MET) / MISSED).clamp(0.0, 1.0)
    }
}
