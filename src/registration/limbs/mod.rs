//! Figures that lie over themselves: a drawing whose parts are apart, found in one where an arm lies in front of the chest or legs cross.
//!
//! Outlines say nothing there, since part of them is hidden. So the limbs of the open drawing are sought one by one.
//!
//! 1. The limbs of the open figure (`articulation`).
//! 2. What the figure explains of the pose wherever it is put (`comparison`).
//! 3. Hypotheses for every limb (`hypotheses`, `from_tip`), a beginning that is grown from them where outlines say nothing (`growth`), and the search among them
//!    (`search`).
//! 4. Which part lies in front (`order`); what is hidden is then no longer compared, and the whole is registered once more.
//!
//! Source: Sykora, Dingliana and Collins 2009 for the registration; Felzenszwalb and Huttenlocher 2005, "Pictorial structures for object recognition", for
//! limbs that are sought as wholes.
//!
//! Cost: a second or two a pose. Limits: a limb that is hidden altogether is where it is least bent; limbs that look alike may be swapped.

mod articulation;
mod chain;
mod comparison;
mod from_tip;
mod growth;
mod hypotheses;
mod named;
mod order;
mod pinned;
mod search;

use rayon::prelude::*;

use self::articulation::{Articulation, median};
use self::comparison::{BARE, Comparison, Layer};
use self::hypotheses::Search;
pub use self::named::LimbProblem;
use self::named::Region;
pub(crate) use self::named::{NamedLimb, Said, Seen};
use self::pinned::Pinned;
use self::search::{Finder, Fine, Put};
use super::lattice::Lattice;
use super::levels::LEVELS;
use super::pair::Pair;
use super::register::RegistrationError;
use super::rigid::Rigid;
use super::template::Template;
use crate::appearance::{Appearance, ByteImage, ChannelImage, PIXELS_PER_UNIT};
use crate::math::{Matrix, Point};

/// The level whose blur figures are compared at.
const COMPARED: usize = 2;
/// The one at which it is decided what lies in front.
const ORDERED: usize = 3;
/// The patches of hypotheses: their radius, in figure units, and steps from middle to edge.
const PATCH_RADIUS: f64 = 0.028;
const PATCH_STEPS: f64 = 2.2;
/// What places outside the figure weigh in them: a limb that lies over another part has that around it, and not what is around it in the reference.
const PATCH_OUTSIDE: f32 = 0.0;
/// The levels that hypotheses are registered at.
const REGISTERED: std::ops::Range<usize> = 1..3;
/// The first of those that what was found is registered at, whole.
const SETTLED: usize = 2;
/// Chains longer than this are divided into parts of about as many bands: an arm bends, and may lie in front of one thing and behind another.
const BANDS_A_PART: usize = 4;
/// Vertices that differ less than this say how much larger the figure is in the pose.
const ALIKE: f32 = 0.2;
/// By how much that may be, and the share of edges that has to say so.
const MOST_SCALE: f64 = 1.4;
const TELLING_SHARE: f64 = 0.2;
/// Where a drawing does not say how large its figure is, it is grown at so many times the size that an open figure of its area has.
const GROWN_SCALES: [f64; 4] = [1.0, 1.06, 1.13, 1.2];
/// Beginnings that leave less energy than this need no other.
const GOOD: f64 = 0.2;
/// Of two beginnings, one that leaves this many times what the other leaves is not followed.
const FAR_WORSE: f64 = 1.5;
/// One that leaves more than this explains nothing.
const HOPELESS: f64 = 0.45;

/// The limbs of a reference, and what they are sought by.
#[derive(Debug)]
pub(super) struct Limbs {
    articulation: Articulation,
    /// By vertex, the part; numbered from the root on.
    part_of: Vec<usize>,
    parts: usize,
    /// For each limb that an artist names its number.
    named: Vec<Result<usize, LimbProblem>>,
    /// The reference at the level [`COMPARED`] and at the one [`ORDERED`].
    compared: ByteImage,
    ordered: ByteImage,
    patches: Template,
}

/// Where a figure was found that may lie over itself.
#[derive(Debug, Clone)]
pub(super) struct Sought {
    pub(super) places: Vec<Point>,
    /// The map under which the lattice is at rest.
    pub(super) form: Matrix,
    /// By part, its rank from back to front.
    pub(super) ranks: Vec<usize>,
    /// By vertex, whether something lies in front of it.
    pub(super) is_hidden: Vec<bool>,
    /// The share of the figure that lies over itself.
    pub(super) overlap: f64,
    /// How badly the pose is explained, by the registration that began with the outlines and now.
    pub(super) energies: [f64; 2],
}

impl Limbs {
    /// `None` of an empty lattice. Limbs that are `named` in the reference, in working pixels, begin where their names say.
    pub(super) fn new(lattice: &Lattice, reference: &Appearance, named: &[NamedLimb]) -> Option<Self> {
        let regions: Vec<Result<Region, LimbProblem>> = named.iter().map(|limb| Region::new(lattice, limb)).collect();
        let parted: Vec<&Region> = (regions.iter().flatten()).filter(|region| region.is_parted()).collect();
        let articulation = Articulation::new(lattice, &parted)?;
        let named = (regions.into_iter())
            .map(|region| articulation.limb_of(&region?).ok_or(LimbProblem::Trunk))
            .collect();
        let mut part_of = vec![0; lattice.points.len()];
        let mut parts = 0;
        for chain in &articulation.chains {
            let count = (chain.nodes.len() as f64 / BANDS_A_PART as f64).round().max(1.0) as usize;
            for (k, node) in chain.nodes.iter().enumerate() {
                for &v in &articulation.nodes[*node] {
                    part_of[v] = parts + k * count / chain.nodes.len();
                }
            }
            parts += count;
        }
        let blurred = |level: usize| reference.blurred(LEVELS[level].deviation_px);
        let (compared, ordered) = rayon::join(|| blurred(COMPARED), || blurred(ORDERED));
        Some(Self {
            patches: Template::sampled(
                lattice,
                &compared,
                PATCH_RADIUS * PIXELS_PER_UNIT,
                (PATCH_STEPS, PATCH_OUTSIDE),
            ),
            compared: ByteImage::new(&compared, 0),
            ordered: ByteImage::new(&ordered, 0),
            articulation,
            part_of,
            parts,
            named,
        })
    }

    /// The part of a vertex.
    pub(super) fn part_of(&self, vertex: usize) -> usize {
        self.part_of[vertex]
    }

    /// By part, the chain that it belongs to if nothing hangs on that; `None` of the trunk. Numbered from 0.
    pub(super) fn limb_of_parts(&self) -> Vec<Option<usize>> {
        let mut limbs = vec![None; self.parts];
        for (limb, line) in self.articulation.ends().iter().enumerate() {
            for v in line.iter().flat_map(|chain| self.articulation.vertices(*chain)) {
                limbs[self.part_of[v]] = Some(limb);
            }
        }
        limbs
    }

    /// For each limb that was named its number, as of [`Self::limb_of_parts`].
    pub(super) fn named(&self) -> &[Result<usize, LimbProblem>] {
        &self.named
    }

    /// The reference sought in a pose where a registration that began with the outlines has it at `places`, with `residuals` left at every vertex;
    /// `templates` are those of all levels, and what is `said` is in working pixels.
    pub(super) fn sought(
        &self,
        pair: &Pair<'_>,
        templates: &[Template],
        (places, residuals): (&[Point], &[f32]),
        said: &Said,
    ) -> Result<Sought, RegistrationError> {
        let lattice = pair.lattice;
        let image = ByteImage::new(&pair.pose.blurred(LEVELS[COMPARED].deviation_px), 0);
        let chains = (&self.articulation.chain_of[..], self.articulation.chains.len());
        let comparison = Comparison::new(lattice, chains, &self.compared, &image);
        let layers = comparison.layers(places);
        let pinned = Pinned::new(pair, &self.articulation, &said.seen);
        let looks = comparison.energy(&layers);
        // A beginning that explains nothing says nothing of the size, either: drawings of a character are as large as one another in their own units.
        let scale = if looks > HOPELESS {
            (pair.pose.scale() / pair.reference.scale()).clamp(1.0 / MOST_SCALE, MOST_SCALE)
        } else {
            scale(lattice, places, residuals)
        };
        let levels: Vec<Fine<'_>> = (REGISTERED.zip(&templates[REGISTERED]))
            .map(|(level, template)| Fine::new(&LEVELS[level], template, pair))
            .collect();
        let finder_at = |scale: f64| Finder {
            pair,
            limbs: &self.articulation,
            comparison: &comparison,
            search: Search {
                limbs: &self.articulation,
                comparison: &comparison,
                patches: &self.patches,
                pinned: &pinned,
                scale,
            },
            rigid: Rigid::new(lattice, Matrix::identity() * scale),
            levels: &levels,
        };
        let mut finders = vec![finder_at(scale)];
        let given = finders[0].put_in(places.to_vec(), layers);
        let before = given.energy;
        if before > HOPELESS {
            finders.extend(GROWN_SCALES.map(|factor| finder_at(factor * comparison.least_scale())));
        }
        let grown = if before > GOOD { growth::grown(&finders)? } else { None };
        // By finder. One may lead where the other does not; what explains far less leads nowhere.
        let beginnings = match grown {
            Some((_, grown)) if grown.energy >= FAR_WORSE * before => vec![(0, given)],
            Some(grown) if before > FAR_WORSE * grown.1.energy => vec![grown],
            Some(grown) => vec![(0, given), grown],
            None => vec![(0, given)],
        };
        let improved: Vec<(usize, Put)> = (beginnings.into_par_iter())
            .map(|(finder, beginning)| Ok((finder, finders[finder].improved(beginning)?)))
            .collect::<Result<_, RegistrationError>>()?;
        let by_energy = |a: &(usize, Put), b: &(usize, Put)| a.1.energy.total_cmp(&b.1.energy);
        let Some((finder, found)) = improved.into_iter().min_by(by_energy) else {
            return Err(RegistrationError::NoFigure);
        };
        let finder = &finders[finder];
        let mut sought = Sought {
            places: found.places,
            form: Matrix::identity() * finder.search.scale,
            ranks: Vec::new(),
            is_hidden: vec![false; lattice.points.len()],
            overlap: 0.0,
            energies: [before, found.energy],
        };
        let finest: Vec<ChannelImage> = (LEVELS[SETTLED..].par_iter())
            .map(|level| pair.pose.blurred(level.deviation_px))
            .collect();
        let ordered = ByteImage::new(&finest[ORDERED - SETTLED], 0);
        let parts = (&self.part_of[..], self.parts);
        let in_order = Comparison::new(lattice, parts, &self.ordered, &ordered);
        // What lies in front is known better once everything is where it is seen, and the reverse.
        for _ in 0..2 {
            sought.places = pair.settled_from(
                &finder.rigid,
                &sought.places,
                (SETTLED, &finest),
                templates,
                &sought.is_hidden,
            )?;
            self.put_in_order(lattice, &in_order, said, &mut sought);
        }
        sought.energies[1] = finder.put(sought.places.clone()).energy;
        Ok(sought)
    }

    /// Finds what lies in front, and what is hidden by it.
    fn put_in_order(&self, lattice: &Lattice, comparison: &Comparison<'_>, said: &Said, sought: &mut Sought) {
        let layers = comparison.layers(&sought.places);
        let in_front = said.in_front(&self.limb_of_parts(), &layers, comparison);
        sought.ranks = order::ranks(&layers, &in_front);
        let front = front(&layers, &sought.ranks);
        sought.is_hidden = (sought.places.iter().enumerate())
            .map(|(v, place)| {
                let own = self.part_of[v];
                front[comparison.cell_at(*place)]
                    .is_some_and(|front| sought.ranks[front] > sought.ranks[own] && !self.touches(lattice, v, front))
            })
            .collect();
        let mut hang_together = vec![false; self.parts * self.parts];
        for &[v, w] in &lattice.edges {
            let (a, b) = (self.part_of[v], self.part_of[w]);
            hang_together[a * self.parts + b] = true;
            hang_together[b * self.parts + a] = true;
        }
        let lies_over = (0..front.len()).filter(|cell| comparison.figure[*cell]).filter(|cell| {
            let there: Vec<usize> = (0..layers.len()).filter(|part| layers[*part][*cell] != BARE).collect();
            let mut pairs = (there.iter().enumerate()).flat_map(|(k, a)| there[..k].iter().map(move |b| (*a, *b)));
            pairs.any(|(a, b)| !hang_together[a * self.parts + b])
        });
        sought.overlap = lies_over.count() as f64 / comparison.figure_cells as f64;
    }

    /// Whether a vertex is next to a part.
    fn touches(&self, lattice: &Lattice, v: usize, part: usize) -> bool {
        lattice.neighbours[v].iter().any(|w| self.part_of[*w] == part)
    }
}

/// By cell, the part in front.
fn front(layers: &[Layer], ranks: &[usize]) -> Vec<Option<usize>> {
    let cells = layers.first().map_or(0, Vec::len);
    (0..cells)
        .map(|cell| {
            let there = (0..layers.len()).filter(|part| layers[*part][cell] != BARE);
            there.max_by_key(|part| ranks[*part])
        })
        .collect()
}

/// How much larger the reference is in the pose, by the edges around which both look alike.
fn scale(lattice: &Lattice, places: &[Point], residuals: &[f32]) -> f64 {
    let is_alike = |v: usize| residuals.get(v).is_some_and(|left| *left < ALIKE);
    let ratio = |&[a, b]: &[usize; 2]| {
        let rest = (lattice.points[a] - lattice.points[b]).norm();
        (rest > 0.0 && is_alike(a) && is_alike(b)).then(|| (places[a] - places[b]).norm() / rest)
    };
    let ratios: Vec<f64> = lattice.edges.iter().filter_map(ratio).collect();
    if (ratios.len() as f64) < TELLING_SHARE * lattice.edges.len() as f64 || ratios.is_empty() {
        return 1.0;
    }
    median(&ratios).clamp(1.0 / MOST_SCALE, MOST_SCALE)
}
