//! The limbs put where they explain the pose.
//!
//! A beginning -> places of all vertices under which the figure may lie over itself.
//!
//! Again and again, every chain that is not explained is sought anew with what hangs on it, alone and in pairs (legs that are swapped); the best
//! hypotheses are registered where they lie, and one is kept if it explains the pose clearly better.
//!
//! What explains a pose is the whole picture ([`Comparison::energy`]): a hypothesis gains nothing where another limb explains the same.

use std::collections::BTreeSet;

use rayon::prelude::*;

use super::articulation::Articulation;
use super::comparison::{BARE, CELL_PX, Comparison, Layer};
use super::hypotheses::Search;
use crate::appearance::{ByteImage, PIXELS_PER_UNIT, STEPS_PER_UNIT};
use crate::math::{Matrix, Point};
use crate::registration::levels::Level;
use crate::registration::pair::Pair;
use crate::registration::register::RegistrationError;
use crate::registration::rigid::{Rigid, Targets};
use crate::registration::template::{Template, Window};

/// By how much the energy has to fall for a hypothesis to be kept: less is noise.
const CLEARLY: f64 = 0.003;
/// Rounds of all chains at most.
const ROUNDS: usize = 3;
/// Hypotheses of a chain that are made, and those that are registered.
const MADE: usize = 6;
const TRIED: usize = 3;
/// Of a pair: hypotheses of the first, and of the second for each of these.
const MADE_OF_PAIR: [usize; 2] = [2, 2];
/// A hypothesis is the present one if its vertices are this near to it, in spacings.
const SAME: f64 = 0.6;
/// Vertices this near to what moves are registered with it, along the lattice, in spacings.
const AROUND: f64 = 2.5;
/// Beside the stiffness, the trust in vertices that stay.
const HELD: f64 = 1000.0;
/// Stiffness and alternations that take folds out of what was put by bands.
const SETTLING: (f64, usize) = (6.0, 6);
/// A chain is explained where at least this share of it is seen and differs by less than this in the mean.
const SEEN_SHARE: f64 = 0.5;
const EXPLAINED: f64 = 0.2;
/// Chains are tried in pairs where they come this near to one another, in spacings, and neither has more than so many times the other's vertices.
const PAIR_REACH: f64 = 3.0;
const PAIR_SIZES: f64 = 2.5;

/// A level with what is compared at it.
pub(super) struct Fine<'a> {
    pub(super) level: &'a Level,
    pub(super) template: &'a Template,
    pub(super) image: ByteImage,
    pub(super) window: Window,
}

impl<'a> Fine<'a> {
    pub(super) fn new(level: &'a Level, template: &'a Template, pair: &Pair<'_>) -> Self {
        let window = Window::new(level.reach * PIXELS_PER_UNIT, level.step * PIXELS_PER_UNIT);
        Self {
            level,
            template,
            image: ByteImage::new(&pair.pose.blurred(level.deviation_px), window.reach),
            window,
        }
    }
}

/// A figure put somewhere, and what it shows there.
#[derive(Clone)]
pub(super) struct Put {
    pub(super) places: Vec<Point>,
    pub(super) layers: Vec<Layer>,
    pub(super) energy: f64,
}

/// What the search works with.
pub(super) struct Finder<'a> {
    pub(super) pair: &'a Pair<'a>,
    pub(super) limbs: &'a Articulation,
    pub(super) comparison: &'a Comparison<'a>,
    pub(super) search: Search<'a>,
    pub(super) rigid: Rigid<'a>,
    /// What hypotheses are registered at, coarse to fine.
    pub(super) levels: &'a [Fine<'a>],
}

impl Finder<'_> {
    pub(super) fn put(&self, places: Vec<Point>) -> Put {
        let layers = self.comparison.layers(&places);
        self.put_in(places, layers)
    }

    /// The figure at places where it shows `layers`.
    pub(super) fn put_in(&self, places: Vec<Point>, layers: Vec<Layer>) -> Put {
        let missed = self.search.pinned.of_figure(&places, self.search.scale);
        Put {
            energy: self.comparison.energy(&layers) + missed,
            places,
            layers,
        }
    }

    /// Puts chains by their best hypotheses, one after another; those that continue another are put with that.
    pub(super) fn grow(&self, chains: &[usize], places: &mut [Point], layers: &mut [Layer]) {
        for chain in chains {
            layers[*chain].fill(BARE);
        }
        for &chain in chains.iter().filter(|chain| !self.limbs.chains[**chain].continues) {
            let others = self.comparison.least(layers, |_| true);
            let line = self.limbs.line(chain);
            let (bands, rest) = (self.limbs.bands(&line), self.search.rest(&others));
            let best = self.search.put_from_joint(&bands, places, &rest, 1).into_iter().next();
            for (v, place) in best.into_iter().flat_map(|best| best.places) {
                places[v] = place;
            }
            for chain in line {
                layers[chain] = self.comparison.layer(chain, places);
            }
        }
    }

    /// The vertices `free` a little more rigid than bands leave them, the others held where they are.
    pub(super) fn settled(&self, places: &[Point], free: &[usize]) -> Result<Vec<Point>, RegistrationError> {
        let mut trust = vec![Matrix::identity() * (HELD * SETTLING.0); places.len()];
        for &v in free {
            trust[v] = Matrix::identity();
        }
        let targets = Targets { places, trust: &trust };
        Ok(self.rigid.solve(places, &targets, SETTLING.0, SETTLING.1)?)
    }

    /// The vertices `free` registered, the others held where they are.
    pub(super) fn registered(&self, mut places: Vec<Point>, free: &[usize]) -> Result<Vec<Point>, RegistrationError> {
        let spacing = self.pair.lattice.spacing;
        for fine in self.levels {
            let level = fine.level;
            let floor = fine.window.floor();
            for _ in 0..level.iterations.min(3) {
                let frames = self.rigid.frames(&places, 1);
                let fits =
                    (fine.template).fits_of(free, &fine.image, &places, &frames, &fine.window, level.temperature);
                let mut targets = places.clone();
                let mut trust = vec![Matrix::identity() * (HELD * level.stiffness); places.len()];
                for (fit, &v) in fits.iter().zip(free) {
                    (targets[v], trust[v]) = fit.target(places[v], floor, spacing);
                }
                self.pair.pin(&self.rigid, &places, &mut targets, &mut trust);
                let targets = Targets {
                    places: &targets,
                    trust: &trust,
                };
                places = self.rigid.solve(&places, &targets, level.stiffness, 5)?;
            }
        }
        Ok(places)
    }

    /// The vertices of some chains and those around them.
    fn around(&self, chains: &[usize]) -> Vec<usize> {
        let own: Vec<usize> = chains.iter().flat_map(|chain| self.limbs.vertices(*chain)).collect();
        let distance = self.pair.lattice.distances_from(&own);
        let reach = AROUND * self.pair.lattice.spacing;
        (0..distance.len()).filter(|v| distance[*v] < reach).collect()
    }

    /// Whether some chains are where they are now.
    fn is_same(&self, now: &Put, places: &[Point], chains: &[usize]) -> bool {
        let own = chains.iter().flat_map(|chain| self.limbs.vertices(*chain));
        let (sum, count) = own.fold((0.0, 0usize), |(sum, count), v| {
            (sum + (places[v] - now.places[v]).norm_squared(), count + 1)
        });
        (sum / count.max(1) as f64).sqrt() < SAME * self.pair.lattice.spacing
    }

    /// A chain put by its hypotheses, with what hangs on it.
    fn with_chain(&self, chain: usize, now: &Put, gone: &[usize], most: usize) -> Vec<Put> {
        let line = self.limbs.line(chain);
        let mut below = self.limbs.below(chain);
        below.retain(|other| !line.contains(other));
        let leaves = |other: usize| !line.contains(&other) && !below.contains(&other) && !gone.contains(&other);
        let others = self.comparison.least(&now.layers, leaves);
        let (bands, rest) = (self.limbs.bands(&line), self.search.rest(&others));
        let mut hypotheses = self.search.put_from_joint(&bands, &now.places, &rest, most);
        if self.search.pinned.is_on(&bands) {
            hypotheses.extend(self.search.put_from_tip(&bands, &now.places, &rest, most));
        }
        (hypotheses.into_par_iter())
            .map(|hypothesis| {
                let (mut places, mut layers) = (now.places.clone(), now.layers.clone());
                for (v, place) in hypothesis.places {
                    places[v] = place;
                }
                for &other in gone.iter().chain(&below) {
                    layers[other].fill(BARE);
                }
                for &chain in &line {
                    layers[chain] = self.comparison.layer(chain, &places);
                }
                self.grow(&below, &mut places, &mut layers);
                self.put_in(places, layers)
            })
            .collect()
    }

    /// The best of the first few placements of chains once they are registered, if it explains the pose clearly better than now.
    fn better(&self, now: &Put, mut made: Vec<Put>, chains: &[usize]) -> Result<Option<Put>, RegistrationError> {
        made.sort_by(|a, b| a.energy.total_cmp(&b.energy));
        made.truncate(TRIED);
        made.retain(|put| !self.is_same(now, &put.places, chains));
        let free = self.around(chains);
        let registered: Vec<Result<Put, RegistrationError>> = (made.par_iter())
            .map(|put| Ok(self.put(self.registered(self.settled(&put.places, &free)?, &free)?)))
            .collect();
        let mut best: Option<Put> = None;
        for put in registered {
            let put = put?;
            if put.energy < best.as_ref().map_or(now.energy - CLEARLY, |best| best.energy) {
                best = Some(put);
            }
        }
        Ok(best)
    }

    fn with_all_below(&self, chain: usize) -> Vec<usize> {
        std::iter::once(chain).chain(self.limbs.below(chain)).collect()
    }

    /// Whether most of a chain is seen, and what is seen of it is what the pose shows there.
    fn is_explained(&self, now: &Put, chain: usize) -> bool {
        let own = &now.layers[chain];
        let others = self.comparison.least(&now.layers, |other| other != chain);
        let (mut sum, mut seen) = (0.0, 0usize);
        for (own, other) in own.iter().zip(&others).filter(|(own, _)| **own != BARE) {
            if own <= other {
                sum += f64::from(*own);
                seen += 1;
            }
        }
        // The cells that it has at rest.
        let side = self.pair.lattice.spacing / CELL_PX as f64;
        let whole = 0.87 * self.limbs.vertices(chain).count() as f64 * side * side;
        let (nodes, scale) = (&self.limbs.chains[chain].nodes, self.search.scale);
        (self.search.pinned.are_met(nodes, &now.places, scale))
            && seen as f64 > SEEN_SHARE * whole
            && sum / (f64::from(STEPS_PER_UNIT) * seen as f64) < EXPLAINED
    }

    /// The figure with every chain where it explains the pose best.
    pub(super) fn improved(&self, mut now: Put) -> Result<Put, RegistrationError> {
        // What was tried since something last changed need not be tried again.
        let mut tried_now: BTreeSet<[usize; 2]> = BTreeSet::new();
        for _ in 0..ROUNDS {
            let before = now.energy;
            for chain in (1..self.limbs.chains.len()).rev() {
                let moved = self.with_all_below(chain);
                if !tried_now.insert([chain, chain]) || self.is_explained(&now, chain) {
                    continue;
                }
                let made = self.with_chain(chain, &now, &[], MADE);
                if let Some(better) = self.better(&now, made, &moved)? {
                    now = better;
                    tried_now.clear();
                }
            }
            for (first, second) in self.pairs(&now) {
                let is_new = tried_now.insert([first, second]);
                if !is_new || self.is_explained(&now, first) && self.is_explained(&now, second) {
                    continue;
                }
                let moved = [first, second];
                let made = self.with_chain(first, &now, &[second], MADE_OF_PAIR[0]);
                let made = made
                    .iter()
                    .flat_map(|put| self.with_chain(second, put, &[], MADE_OF_PAIR[1]));
                if let Some(better) = self.better(&now, made.collect(), &moved)? {
                    now = better;
                    tried_now.clear();
                }
            }
            if now.energy > before - CLEARLY {
                break;
            }
        }
        Ok(now)
    }

    /// Chains at ends that are near one another and about as large, both ways round.
    fn pairs(&self, now: &Put) -> Vec<(usize, usize)> {
        let ends: Vec<usize> = self.limbs.ends().iter().map(|line| line[0]).collect();
        let reach = PAIR_REACH * self.pair.lattice.spacing;
        let is_pair = |a: usize, b: usize| {
            let size = |chain: usize| self.limbs.vertices(chain).count() as f64;
            let alike = size(a) < PAIR_SIZES * size(b) && size(b) < PAIR_SIZES * size(a);
            let near = || {
                self.limbs.vertices(a).any(|v| {
                    let mut others = self.limbs.vertices(b);
                    others.any(|w| (now.places[v] - now.places[w]).norm() < reach)
                })
            };
            alike && near()
        };
        let mut pairs = Vec::new();
        for &a in &ends {
            pairs.extend(ends.iter().filter(|b| **b != a && is_pair(a, **b)).map(|b| (a, *b)));
        }
        pairs
    }
}
