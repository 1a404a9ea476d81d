//! The limbs of a figure: a tree of bands across its lattice, and the chains of bands that may bend.
//!
//! Lattice of the reference -> [`Articulation`].
//!
//! 1. The root is the middle of the thickest place of the figure: a head, a chest, the body of a fish.
//! 2. A *tip* is a vertex from which no other nearby is further from the root, along the lattice. From every tip, bands of equal distance to it are laid
//!    across the figure for as long as it stays about as thick as it is there: they are a limb, and where it widens the limb begins.
//! 3. What is left is the trunk, in bands of equal distance to the root.
//! 4. Bands that follow one another without branching are a *chain*: a limb is one, a trunk is several.
//!
//! Departure: parts are found by where a silhouette becomes thin (the short-cut rule of Singh, Seyranian and Hoffman 1999, "Parsing silhouettes"),
//! measured along the lattice instead of straight across, so that a bent arm is one limb.
//!
//! Limit: a limb that lies within the silhouette of the trunk is part of the trunk.

use std::collections::BTreeMap;

use super::chain::{Chain, chains, joints};
use super::named::Region;
use crate::math::Point;
use crate::registration::lattice::Lattice;

/// The width of a band, in spacings: about as wide as two rows of vertices.
const BAND: f64 = 1.9;
/// The bands that a limb has at least.
const LEAST_BANDS: usize = 3;
/// The limbs that are looked for at most.
const MOST_LIMBS: usize = 14;
/// The core is what is this near to the root, in radii of the largest disc inside.
const CORE: f64 = 0.9;
/// A limb ends where a band has this many times the vertices of the earlier ones, and two more, or is this many times as thick, and a pixel more.
const WIDER: f64 = 1.6;
const THICKER: f64 = 1.35;
/// The share of a band whose thickest vertices say how thick it is.
const THICKEST_SHARE: usize = 6;
/// Rings of neighbours that no vertex may be further in for a tip to be one.
const TIP_RINGS: usize = 3;
/// Bands with fewer vertices belong to the band before them.
const LEAST_VERTICES: usize = 4;
/// No node.
const NONE: usize = usize::MAX;

/// The bands of a lattice.
#[derive(Debug)]
pub(super) struct Articulation {
    /// The vertices of every band.
    pub(super) nodes: Vec<Vec<usize>>,
    /// The band that a band hangs on; that of the root is [`usize::MAX`].
    pub(super) parents: Vec<usize>,
    /// Where a band meets the one that it hangs on, in working pixels of the reference.
    pub(super) joints: Vec<Point>,
    /// Parents before their children.
    pub(super) chains: Vec<Chain>,
    /// By vertex.
    pub(super) node_of: Vec<usize>,
    /// By vertex.
    pub(super) chain_of: Vec<usize>,
    /// By vertex, how far the edge of the figure is, in working pixels.
    pub(super) depth: Vec<f64>,
}

impl Articulation {
    /// `None` of an empty lattice. Each of `parted` is a limb, where the lattice may be cut from the root there.
    pub(super) fn new(lattice: &Lattice, parted: &[&Region]) -> Option<Self> {
        let depth = lattice.depths();
        let root = (0..depth.len()).max_by(|a, b| depth[*a].total_cmp(&depth[*b]))?;
        let mut making = Making {
            lattice,
            depth: &depth,
            root,
            band: BAND * lattice.spacing,
            nodes: Vec::new(),
            parents: Vec::new(),
            node_of: vec![NONE; depth.len()],
        };
        let limbs = making.limbs(parted);
        making.lay_trunk(&limbs);
        let firsts = making.hang(limbs);
        let Making {
            nodes,
            parents,
            node_of,
            ..
        } = making;
        let joints = joints(lattice, &nodes, &parents, &node_of);
        let chains = chains(&parents, &firsts);
        let mut chain_of = vec![0; depth.len()];
        for (number, chain) in chains.iter().enumerate() {
            for &v in chain.nodes.iter().flat_map(|node| &nodes[*node]) {
                chain_of[v] = number;
            }
        }
        Some(Self {
            nodes,
            parents,
            joints,
            chains,
            node_of,
            chain_of,
            depth,
        })
    }

    /// The number of the limb that a region lies on, among [`Self::ends`]; `None` if it lies on the trunk.
    pub(super) fn limb_of(&self, region: &Region) -> Option<usize> {
        let own = self.chain_of[region.vertex];
        self.ends().iter().position(|line| line.contains(&own))
    }

    /// The vertices of a chain.
    pub(super) fn vertices(&self, chain: usize) -> impl Iterator<Item = usize> + '_ {
        self.chains[chain]
            .nodes
            .iter()
            .flat_map(|node| self.nodes[*node].iter().copied())
    }

    /// A chain and those that continue it, in order.
    pub(super) fn line(&self, chain: usize) -> Vec<usize> {
        let mut line = vec![chain];
        while let Some(&last) = line.last() {
            let next = (last + 1..self.chains.len())
                .find(|other| self.chains[*other].continues && self.chains[*other].parent == Some(last));
            match next {
                Some(next) => line.push(next),
                None => break,
            }
        }
        line
    }

    /// The bands of chains, in order.
    pub(super) fn bands(&self, chains: &[usize]) -> Vec<usize> {
        let bands = chains.iter().flat_map(|chain| &self.chains[*chain].nodes);
        bands.copied().collect()
    }

    /// How many vertices some bands have.
    pub(super) fn count(&self, bands: &[usize]) -> usize {
        bands.iter().map(|band| self.nodes[*band].len()).sum()
    }

    /// The lines of chains that nothing else hangs on.
    pub(super) fn ends(&self) -> Vec<Vec<usize>> {
        (1..self.chains.len())
            .filter(|chain| !self.chains[*chain].continues)
            .map(|chain| (self.below(chain).len(), self.line(chain)))
            .filter(|(below, line)| below + 1 == line.len())
            .map(|(_, line)| line)
            .collect()
    }

    /// The chains that hang on one, directly or not, parents first.
    pub(super) fn below(&self, chain: usize) -> Vec<usize> {
        let hangs = |&other: &usize| {
            let mut at = self.chains[other].parent;
            while let Some(parent) = at {
                if parent == chain {
                    return true;
                }
                at = self.chains[parent].parent;
            }
            false
        };
        (0..self.chains.len()).filter(hangs).collect()
    }
}

/// The bands while they are laid.
struct Making<'a> {
    lattice: &'a Lattice,
    depth: &'a [f64],
    root: usize,
    /// Width, in pixels.
    band: f64,
    nodes: Vec<Vec<usize>>,
    parents: Vec<usize>,
    node_of: Vec<usize>,
}

impl Making<'_> {
    /// The bands of every limb, from its tip on; `parted` ones before all others.
    fn limbs(&self, parted: &[&Region]) -> Vec<Vec<Vec<usize>>> {
        let count = self.depth.len();
        let from_root = self.lattice.distances_from(&[self.root]);
        let is_core: Vec<bool> = (from_root.iter())
            .map(|distance| *distance <= CORE * self.depth[self.root])
            .collect();
        let mut is_tip = self.tips(&from_root);
        let mut is_taken = vec![false; count];
        let mut distance = from_root;
        let mut limbs = Vec::new();
        for region in parted {
            let bands = region.bands(self.lattice, self.band, &is_taken);
            if bands.is_empty() {
                continue;
            }
            for &v in bands.iter().flatten() {
                is_taken[v] = true;
            }
            limbs.push(bands);
        }
        while limbs.len() < MOST_LIMBS {
            let free = (0..count).filter(|v| is_tip[*v] && !is_taken[*v] && !is_core[*v] && distance[*v].is_finite());
            let Some(tip) = free.max_by(|a, b| distance[*a].total_cmp(&distance[*b])) else {
                break;
            };
            if distance[tip] < (LEAST_BANDS as f64 - 0.5) * self.band {
                break;
            }
            let from_tip = self.lattice.distances_from(&[tip]);
            let bands = self.limb(tip, &from_tip, &is_core, &is_taken);
            if bands.len() >= LEAST_BANDS {
                for &v in bands.iter().flatten() {
                    is_taken[v] = true;
                }
                limbs.push(bands);
            } else {
                is_tip[tip] = false;
            }
            for (least, other) in distance.iter_mut().zip(from_tip) {
                *least = least.min(other);
            }
        }
        limbs
    }

    /// Which vertices no other nearby is further from the root than.
    fn tips(&self, from_root: &[f64]) -> Vec<bool> {
        let mut furthest = from_root.to_vec();
        for _ in 0..TIP_RINGS {
            furthest = (0..furthest.len())
                .map(|v| {
                    let around = self.lattice.neighbours[v].iter().map(|w| furthest[*w]);
                    around.fold(furthest[v], f64::max)
                })
                .collect();
        }
        (from_root.iter().zip(furthest))
            .map(|(own, furthest)| *own >= furthest - 1e-9)
            .collect()
    }

    /// The bands from a tip to where the figure widens.
    fn limb(&self, tip: usize, from_tip: &[f64], is_core: &[bool], is_taken: &[bool]) -> Vec<Vec<usize>> {
        let mut by_band: Vec<Vec<usize>> = Vec::new();
        for v in (0..from_tip.len()).filter(|v| !is_taken[*v] && from_tip[*v].is_finite()) {
            let band = (from_tip[v] / self.band) as usize;
            if by_band.len() <= band {
                by_band.resize(band + 1, Vec::new());
            }
            by_band[band].push(v);
        }
        let mut bands: Vec<Vec<usize>> = Vec::new();
        let (mut counts, mut depths) = (Vec::new(), Vec::new());
        for (k, band) in by_band.into_iter().enumerate() {
            let in_core = band.iter().filter(|v| is_core[**v]).count();
            let reaches_core = in_core * 10 > band.len() * 3 || (in_core > 0 && band.len() <= 2);
            if band.is_empty() || reaches_core || from_tip[self.root] < (k + 1) as f64 * self.band {
                break;
            }
            let thickness = self.thickness(&band);
            let widens = k >= 2
                && (band.len() as f64 > WIDER * median(&counts[1..]) + 2.0
                    || thickness > THICKER * median(&depths[1..]) + 1.0);
            if widens {
                break;
            }
            counts.push(band.len() as f64);
            depths.push(thickness);
            bands.push(band);
        }
        // What hangs together with the tip.
        let all: Vec<usize> = bands.iter().flatten().copied().collect();
        let pieces = self.pieces(&all);
        let own = pieces.iter().find(|piece| piece.contains(&tip));
        for band in &mut bands {
            band.retain(|v| own.is_some_and(|own| own.binary_search(v).is_ok()));
        }
        bands.retain(|band| !band.is_empty());
        bands
    }

    /// How thick the figure is across a band.
    fn thickness(&self, band: &[usize]) -> f64 {
        let mut depths: Vec<f64> = band.iter().map(|v| self.depth[*v]).collect();
        depths.sort_by(|a, b| b.total_cmp(a));
        let count = (depths.len() / THICKEST_SHARE).max(1);
        depths[..count].iter().sum::<f64>() / count as f64
    }

    /// The vertices of `among` that hang together, each piece sorted.
    fn pieces(&self, among: &[usize]) -> Vec<Vec<usize>> {
        let mut is_free = vec![false; self.depth.len()];
        for &v in among {
            is_free[v] = true;
        }
        let mut pieces = Vec::new();
        for &start in among {
            if !is_free[start] {
                continue;
            }
            is_free[start] = false;
            let (mut piece, mut next) = (vec![start], 0);
            while let Some(&v) = piece.get(next) {
                next += 1;
                for &w in &self.lattice.neighbours[v] {
                    if is_free[w] {
                        is_free[w] = false;
                        piece.push(w);
                    }
                }
            }
            piece.sort_unstable();
            pieces.push(piece);
        }
        pieces
    }

    /// The bands of what is no limb, from the root on.
    fn lay_trunk(&mut self, limbs: &[Vec<Vec<usize>>]) {
        let mut is_limb = vec![false; self.depth.len()];
        for &v in limbs.iter().flatten().flatten() {
            is_limb[v] = true;
        }
        let rest: Vec<usize> = (0..is_limb.len()).filter(|v| !is_limb[*v]).collect();
        let pieces = self.pieces(&rest);
        let Some(main) = pieces.into_iter().find(|piece| piece.binary_search(&self.root).is_ok()) else {
            return;
        };
        let mut within = vec![false; is_limb.len()];
        for &v in &main {
            within[v] = true;
        }
        let distance = self.lattice.distances_within(&[self.root], &within);
        let core = CORE * self.depth[self.root];
        let width = self.band;
        let band_of = |v: usize| match distance[v] - core {
            beyond if beyond > 0.0 => 1 + (beyond / width) as usize,
            _ => 0,
        };
        let last = main.iter().map(|v| band_of(*v)).max().unwrap_or(0);
        for band in 0..=last {
            let members: Vec<usize> = main.iter().copied().filter(|v| band_of(*v) == band).collect();
            let pieces = self.pieces(&members);
            for piece in pieces {
                let parent = if band == 0 {
                    None
                } else {
                    Some(self.touched(&piece).unwrap_or(0))
                };
                match parent {
                    Some(parent) if piece.len() < LEAST_VERTICES => self.join(&piece, parent),
                    _ => self.add(piece, parent.unwrap_or(NONE)),
                }
            }
        }
        self.prune();
    }

    fn add(&mut self, vertices: Vec<usize>, parent: usize) {
        for &v in &vertices {
            self.node_of[v] = self.nodes.len();
        }
        self.nodes.push(vertices);
        self.parents.push(parent);
    }

    fn join(&mut self, vertices: &[usize], node: usize) {
        for &v in vertices {
            self.node_of[v] = node;
        }
        self.nodes[node].extend(vertices);
    }

    /// The node that most vertices next to these are in.
    fn touched(&self, vertices: &[usize]) -> Option<usize> {
        let mut counts = BTreeMap::new();
        for &w in vertices.iter().flat_map(|v| &self.lattice.neighbours[*v]) {
            if self.node_of[w] != NONE && !vertices.contains(&w) {
                *counts.entry(self.node_of[w]).or_insert(0usize) += 1;
            }
        }
        counts
            .into_iter()
            .max_by(|a, b| a.1.cmp(&b.1).then(b.0.cmp(&a.0)))
            .map(|(node, _)| node)
    }

    /// Joins single bands beside others to what they hang on: an ear, a bump.
    fn prune(&mut self) {
        for node in (1..self.nodes.len()).rev() {
            let parent = self.parents[node];
            let has_siblings =
                (0..self.nodes.len()).any(|k| k != node && !self.nodes[k].is_empty() && self.parents[k] == parent);
            let is_leaf = !(0..self.nodes.len()).any(|k| !self.nodes[k].is_empty() && self.parents[k] == node);
            if has_siblings && is_leaf && parent != NONE {
                let vertices = std::mem::take(&mut self.nodes[node]);
                self.join(&vertices, parent);
            }
        }
        // Numbered again without those that are gone.
        let mut number = vec![NONE; self.nodes.len()];
        let (mut nodes, mut parents) = (Vec::new(), Vec::new());
        for (node, vertices) in std::mem::take(&mut self.nodes).into_iter().enumerate() {
            if !vertices.is_empty() {
                number[node] = nodes.len();
                nodes.push(vertices);
                parents.push(self.parents[node]);
            }
        }
        for parent in parents.iter_mut().filter(|parent| **parent != NONE) {
            *parent = number[*parent];
        }
        for node in self.node_of.iter_mut().filter(|node| **node != NONE) {
            *node = number[*node];
        }
        (self.nodes, self.parents) = (nodes, parents);
    }

    /// Hangs the limbs on what is there, and gives what is left over to its neighbours; the first bands of the limbs.
    fn hang(&mut self, limbs: Vec<Vec<Vec<usize>>>) -> Vec<usize> {
        let mut firsts = Vec::new();
        let mut waiting: Vec<Vec<Vec<usize>>> = limbs;
        while !waiting.is_empty() {
            let ready = waiting
                .iter()
                .position(|bands| bands.last().is_some_and(|base| self.touched(base).is_some()));
            // A limb that hangs on nothing is cut off from the root by others: its tip hangs on one of them.
            let limb = waiting.remove(ready.unwrap_or(0));
            let mut parent = limb.last().and_then(|base| self.touched(base)).unwrap_or(0);
            firsts.push(self.nodes.len());
            for band in limb.into_iter().rev() {
                self.add(band, parent);
                parent = self.nodes.len() - 1;
            }
        }
        // Pieces of the trunk that limbs cut off.
        let free: Vec<usize> = (0..self.node_of.len()).filter(|v| self.node_of[*v] == NONE).collect();
        let pieces = self.pieces(&free);
        for piece in pieces {
            let node = self.touched(&piece).unwrap_or(0);
            self.join(&piece, node);
        }
        firsts
    }
}

/// The median, the upper one of two; 0 of nothing.
pub(super) fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A disc with bars, one pixel a unit, in a square of 400.
    fn figure(radius: f64, bars: &[[[f64; 2]; 2]], width: f64) -> Lattice {
        let mask: Vec<bool> = (0..400 * 400)
            .map(|k| {
                let p = Point::new((k % 400) as f64 + 0.5, (k / 400) as f64 + 0.5);
                let is_in = |bar: &[[f64; 2]; 2]| {
                    let [a, b] = bar.map(Point::from);
                    crate::math::point::nearest_on_segment(p, a, b).1 < 0.5 * width
                };
                (p - Point::new(200.0, 200.0)).norm() < radius || bars.iter().any(is_in)
            })
            .collect();
        Lattice::new(&mask, 400, 10.0)
    }

    const BARS: [[[f64; 2]; 2]; 4] = [
        [[200.0, 200.0], [360.0, 120.0]],
        [[200.0, 200.0], [40.0, 120.0]],
        [[180.0, 200.0], [150.0, 380.0]],
        [[220.0, 200.0], [250.0, 380.0]],
    ];

    #[test]
    fn bars_on_a_disc_are_limbs_that_begin_at_it() {
        let lattice = figure(60.0, &BARS, 30.0);
        let limbs = Articulation::new(&lattice, &[]).expect("a figure");
        let ends: Vec<usize> = (1..limbs.chains.len())
            .filter(|chain| limbs.below(*chain).is_empty())
            .collect();
        assert_eq!(ends.len(), 4, "{:?}", limbs.chains);
        for chain in ends {
            let first = limbs.joints[limbs.chains[chain].nodes[0]];
            let away = (first - Point::new(200.0, 200.0)).norm();
            assert!((40.0..90.0).contains(&away), "a limb begins {away} from the middle");
            // No vertex of one bar is in the limb of another.
            let sides: Vec<bool> = limbs.vertices(chain).map(|v| lattice.points[v].x > 200.0).collect();
            assert!(sides.iter().all(|side| *side == sides[0]));
        }
        // Every vertex is in one chain.
        let count: usize = (0..limbs.chains.len()).map(|chain| limbs.vertices(chain).count()).sum();
        assert_eq!(count, lattice.points.len());
    }

    #[test]
    fn a_worm_is_one_chain_from_its_head() {
        let lattice = figure(28.0, &[[[200.0, 200.0], [380.0, 300.0]]], 36.0);
        let limbs = Articulation::new(&lattice, &[]).expect("a figure");
        let longest = limbs.chains.iter().map(|chain| chain.nodes.len()).max().unwrap_or(0);
        assert!(longest >= 6, "{:?}", limbs.chains);
        assert!(limbs.chains.len() <= 3, "{:?}", limbs.chains);
    }
}
