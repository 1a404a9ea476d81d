//! All poses registered to the reference.

use std::sync::{Arc, OnceLock};

use rayon::prelude::*;

use super::beginning::{INSIDE, POINT_PX};
use super::explained::Found;
use super::lattice::Lattice;
use super::levels::{LEVELS, Level};
use super::limbs::{LimbProblem, Limbs, NamedLimb, Said, Sought};
use super::pair::Pair;
use super::rigid::Rigid;
use super::template::Template;
use crate::appearance::{Appearance, ChannelImage, PIXELS_PER_UNIT};
use crate::math::{Matrix, Point};
use crate::solve::SolveError;

/// The lattice's spacing, in figure units.
const SPACING: f64 = 0.022;

/// The trust in a vertex whose place is clear.
const CLEAR: f64 = 100.0;

/// The trust in a pair of points that is certain and in one that is likely.
const CERTAIN: f64 = 1e5;
const LIKELY: f64 = 1000.0;

/// Why drawings could not be registered.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RegistrationError {
    /// The figure is thinner than a working pixel everywhere.
    #[error("the figure of the reference is too thin to be compared")]
    NoFigure,
    /// The rigid system could not be solved.
    #[error("the registration's system could not be solved: {0}")]
    Solve(#[from] SolveError),
}

/// Outlines in correspondence, as a beginning: points of the reference and of the pose in source units, first those of the outer ring; then those of
/// rims that are known to correspond: with them all rings stay where nothing that is drawn speaks against it.
pub type RingPairs = Vec<(Vec<Point>, Vec<Point>)>;

/// A place of the reference and the place of a pose that corresponds to it, in source units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pin {
    pub(crate) from: Point,
    pub(crate) to: Point,
    pub(super) trust: f64,
}

impl Pin {
    /// A pair that corresponds for certain: an artist says so.
    #[must_use]
    pub fn certain(from: Point, to: Point) -> Self {
        Self {
            from,
            to,
            trust: CERTAIN,
        }
    }

    /// A pair that is likely to correspond: what is drawn may contradict it.
    #[must_use]
    pub fn likely(from: Point, to: Point) -> Self {
        Self {
            from,
            to,
            trust: LIKELY,
        }
    }
}

/// How far the drawing of a pose is that of the reference, moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Explained {
    /// The share of the reference's figure that is found in the pose, up to 1.
    pub share: f64,
    /// Where it is found least: on the reference and on the pose, in source units.
    pub least: [Point; 2],
}

/// Where the reference's places are in every pose.
#[derive(Debug, Clone)]
pub struct Registration {
    searched: Arc<Searched>,
    poses: Vec<Option<Arc<RegisteredPose>>>,
}

/// What of the reference is looked for in every pose.
#[derive(Debug)]
struct Searched {
    reference: Arc<Appearance>,
    lattice: Lattice,
    /// By level.
    templates: Vec<Template>,
    /// What beginnings are compared by.
    points: Template,
    /// Which vertices are inside the figure, away from its edge.
    inside: Vec<bool>,
    /// Made when a pose is first sought that may lie over itself.
    limbs: OnceLock<Option<Limbs>>,
}

/// A pose in which the limbs were sought.
#[derive(Debug, Clone)]
pub(crate) struct FoundLimbs {
    placed: Arc<RegisteredPose>,
    pub(crate) overlap: Overlap,
}

/// How a figure lies over itself in a pose.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Overlap {
    /// By part of the figure, its rank from back to front.
    pub(crate) ranks: Vec<usize>,
    /// The share of the figure on which parts lie that do not hang together.
    pub(crate) share: f64,
    /// How badly the pose is explained where nothing may lie over anything, and where it may: 0 for a drawing like the reference, about 1 for another one.
    pub(crate) unexplained: [f64; 2],
}

#[derive(Debug, Clone)]
struct RegisteredPose {
    beginnings: Vec<RingPairs>,
    pins: Vec<Pin>,
    chosen: usize,
    appearance: Arc<Appearance>,
    places: Vec<Point>,
    frames: Vec<Matrix>,
    trusts: Vec<f64>,
    /// By vertex, how much the drawings still differ around it.
    residuals: Vec<f32>,
    explained: Explained,
    residual: f64,
}

impl Registration {
    /// Where a place of the reference is in `pose`, in source units; `None` for the reference itself and poses that were not registered.
    #[must_use]
    pub fn carried(&self, pose: usize, place: Point) -> Option<Point> {
        let registered = self.poses.get(pose)?.as_ref()?;
        let p = self.searched.reference.to_pixels(place);
        let carried = self
            .searched
            .lattice
            .carried(&registered.places, &registered.frames, p)?;
        Some(registered.appearance.to_source(carried))
    }

    /// How surely a place of the reference is where [`carried`](Self::carried) has it: about 1 where what is drawn there is found, more where it is known
    /// besides, by landmarks or by names, and near 0 where nothing is drawn that could tell, or something else.
    #[must_use]
    pub fn trust(&self, pose: usize, place: Point) -> f64 {
        let of_cell = || {
            let registered = self.poses.get(pose)?.as_ref()?;
            let (cell, _) = self
                .searched
                .lattice
                .cell_at(self.searched.reference.to_pixels(place))?;
            registered.trusts.get(cell)
        };
        of_cell().map_or(0.0, |trust| trust / CLEAR)
    }

    /// How much the drawing of `pose` differs from what the reference shows at the same places, both blurred as for the first level: 0 for equal
    /// drawings, at most 1.2.
    #[must_use]
    pub fn residual(&self, pose: usize) -> Option<f64> {
        Some(self.poses.get(pose)?.as_ref()?.residual)
    }

    /// `pose` as pose `number` of `other` has it, which is a registration of the same figures seen otherwise; how far the drawing is explained stays.
    pub(crate) fn placed_as_in(&mut self, pose: usize, other: &Self, number: usize) {
        let theirs = other.poses.get(number).and_then(Option::as_ref);
        if let (Some(Some(own)), Some(theirs)) = (self.poses.get_mut(pose), theirs) {
            *own = Arc::new(RegisteredPose {
                places: theirs.places.clone(),
                frames: theirs.frames.clone(),
                trusts: theirs.trusts.clone(),
                residuals: theirs.residuals.clone(),
                ..own.as_ref().clone()
            });
        }
    }

    /// Finds the limbs of the reference, before they are sought in several poses at once: what is made once for all must not be made by a task among them. For each
    /// of `named`, which are places of the reference, the number of the limb there.
    pub(crate) fn find_limbs(&self, named: &[NamedLimb]) -> Vec<Result<usize, LimbProblem>> {
        let in_pixels: Vec<NamedLimb> = (named.iter())
            .map(|limb| limb.mapped(|p| self.searched.reference.to_pixels(p)))
            .collect();
        match self.searched.limbs(&in_pixels) {
            Some(limbs) => limbs.named().to_vec(),
            None => vec![Err(LimbProblem::Outside); named.len()],
        }
    }

    /// The place of the reference that is nearest to `place` in `pose`; `None` as for [`carried`](Self::carried).
    pub(crate) fn traced(&self, pose: usize, place: Point) -> Option<Point> {
        let registered = self.poses.get(pose)?.as_ref()?;
        let p = registered.appearance.to_pixels(place);
        let away = |v: &usize| (registered.places[*v] - p).norm_squared();
        let nearest = (0..registered.places.len()).min_by(|a, b| away(a).total_cmp(&away(b)))?;
        Some(self.searched.reference.to_source(self.searched.lattice.points[nearest]))
    }

    /// The limbs of the reference, which [`Self::find_limbs`] has found, sought one by one in `pose`, where the figure may lie over itself and where an artist has `said`
    /// of them what is in source units.
    ///
    /// # Errors
    /// [`RegistrationError`] as of [`register`].
    pub(crate) fn seek_limbs(&self, pose: usize, said: &Said) -> Result<Option<FoundLimbs>, RegistrationError> {
        let searched = &self.searched;
        let limbs = searched.limbs.get().and_then(Option::as_ref);
        let Some((limbs, registered)) = limbs.zip(self.poses.get(pose).and_then(Option::as_ref)) else {
            return Ok(None);
        };
        let pair = Pair::new(
            &searched.lattice,
            &searched.reference,
            &registered.appearance,
            &registered.pins,
            &searched.inside,
        );
        let Sought {
            places,
            form,
            ranks,
            is_hidden,
            overlap,
            energies,
        } = limbs.sought(
            &pair,
            &searched.templates,
            (&registered.places, &registered.residuals),
            &said.mapped(
                |p| searched.reference.to_pixels(p),
                |p| registered.appearance.to_pixels(p),
            ),
        )?;
        let frames = Rigid::new(&searched.lattice, form).frames(&places, 0);
        let trusts = (registered.trusts.iter().zip(is_hidden))
            .map(|(trust, is_hidden)| if is_hidden { 0.0 } else { *trust })
            .collect();
        Ok(Some(FoundLimbs {
            placed: Arc::new(RegisteredPose {
                places,
                frames,
                trusts,
                ..registered.as_ref().clone()
            }),
            overlap: Overlap {
                ranks,
                share: overlap,
                unexplained: energies,
            },
        }))
    }

    /// From now on places of `pose` are carried to where the limbs were found.
    pub(crate) fn place(&mut self, pose: usize, found: &FoundLimbs) {
        if let Some(own) = self.poses.get_mut(pose) {
            *own = Some(Arc::clone(&found.placed));
        }
    }

    /// By part of the figure, the limb that it belongs to; `None` of the trunk. Empty if no limbs were sought.
    #[must_use]
    pub(crate) fn limb_of_parts(&self) -> Vec<Option<usize>> {
        let limbs = self.searched.limbs.get().and_then(Option::as_ref);
        limbs.map(Limbs::limb_of_parts).unwrap_or_default()
    }

    /// The part of the figure that a place of the reference is in, of those that [`Overlap::ranks`] counts; `None` if no limbs were sought.
    #[must_use]
    pub(crate) fn part_at(&self, place: Point) -> Option<usize> {
        let limbs = self.searched.limbs.get()?.as_ref()?;
        let (cell, _) = self
            .searched
            .lattice
            .cell_at(self.searched.reference.to_pixels(place))?;
        Some(limbs.part_of(cell))
    }

    /// How much of what the reference shows is found in the drawing of `pose`, and where least; `None` as for [`carried`](Self::carried).
    #[must_use]
    pub fn explained(&self, pose: usize) -> Option<Explained> {
        Some(self.poses.get(pose)?.as_ref()?.explained)
    }
}

impl Searched {
    /// For the first of the levels only, or for all of them.
    fn new(reference: &Arc<Appearance>, levels: &[Level]) -> Result<Self, RegistrationError> {
        let lattice = Lattice::new(&reference.mask(), reference.size()[0], SPACING * PIXELS_PER_UNIT);
        if lattice.points.is_empty() {
            return Err(RegistrationError::NoFigure);
        }
        let images: Vec<ChannelImage> = (levels.par_iter())
            .map(|level| reference.blurred(level.deviation_px))
            .collect();
        let templates = (levels.par_iter().zip(&images))
            .map(|(level, image)| Template::new(&lattice, image, level.patch_radius * PIXELS_PER_UNIT))
            .collect();
        let coarsest = &images[0];
        Ok(Self {
            templates,
            points: Template::new(&lattice, coarsest, POINT_PX),
            inside: (lattice.points.iter())
                .map(|p| coarsest.at(p.x as f32, p.y as f32)[4] >= INSIDE)
                .collect(),
            reference: Arc::clone(reference),
            limbs: OnceLock::new(),
            lattice,
        })
    }

    /// The limbs of the reference, those that are `named` there, in working pixels, among them.
    fn limbs(&self, named: &[NamedLimb]) -> Option<&Limbs> {
        self.limbs
            .get_or_init(|| Limbs::new(&self.lattice, &self.reference, named))
            .as_ref()
    }

    fn registered(
        &self,
        appearance: &Arc<Appearance>,
        beginnings: &[RingPairs],
        pins: &[Pin],
    ) -> Result<RegisteredPose, RegistrationError> {
        let pair = Pair::new(&self.lattice, &self.reference, appearance, pins, &self.inside);
        let registered = pair.registered(&self.points, &self.templates, beginnings)?;
        let found = Found::new(&self.lattice, &registered);
        Ok(RegisteredPose {
            beginnings: beginnings.to_vec(),
            pins: pins.to_vec(),
            chosen: registered.beginning,
            explained: Explained {
                share: found.share,
                least: [
                    self.reference.to_source(self.lattice.points[found.least]),
                    appearance.to_source(registered.places[found.least]),
                ],
            },
            residual: registered.coarse_residual,
            appearance: Arc::clone(appearance),
            places: registered.places,
            frames: registered.frames,
            trusts: registered.trusts,
            residuals: registered.residuals,
        })
    }
}

/// Registers every pose of `appearances` but the reference, and says for each which beginning explained the drawing best. `beginnings` has for
/// each at least one beginning, the one that turns the drawing least first; `pins` are pairs of points that are known to correspond. What
/// `before` has made of the same is taken from there.
///
/// # Errors
/// [`RegistrationError`] if the reference has no figure.
pub fn register(
    appearances: &[Arc<Appearance>],
    reference: usize,
    beginnings: &[Vec<RingPairs>],
    pins: &[Vec<Pin>],
    before: Option<&Registration>,
) -> Result<(Registration, Vec<usize>), RegistrationError> {
    let own = &appearances[reference];
    let before = before.filter(|before| Arc::ptr_eq(&before.searched.reference, own));
    let searched = match before {
        Some(before) => Arc::clone(&before.searched),
        None => Arc::new(Searched::new(own, &LEVELS)?),
    };
    let registered = |pose: usize| {
        let appearance = &appearances[pose];
        let beginnings = beginnings.get(pose).map_or(&[][..], Vec::as_slice);
        let pins = pins.get(pose).map_or(&[][..], Vec::as_slice);
        if pose == reference || beginnings.is_empty() {
            return Ok(None);
        }
        let same = before
            .and_then(|before| before.poses.get(pose)?.as_ref())
            .filter(|before| {
                Arc::ptr_eq(&before.appearance, appearance) && before.pins == pins && before.beginnings == beginnings
            });
        let made = match same {
            Some(same) => Arc::clone(same),
            None => Arc::new(searched.registered(appearance, beginnings, pins)?),
        };
        Ok(Some(made))
    };
    let poses: Vec<Option<Arc<RegisteredPose>>> = (0..appearances.len())
        .into_par_iter()
        .map(registered)
        .collect::<Result<_, RegistrationError>>()?;
    let chosen = (poses.iter())
        .map(|pose| pose.as_ref().map_or(0, |pose| pose.chosen))
        .collect();
    Ok((Registration { searched, poses }, chosen))
}

/// How much the second of two drawings differs from the first, as of [`Registration::residual`], registered from the best of some beginnings: what
/// only a whole registration places is not needed to say which of two drawings is nearer.
///
/// # Errors
/// [`RegistrationError`] if the first has no figure.
pub(crate) fn difference(
    [reference, other]: [&Arc<Appearance>; 2],
    beginnings: &[RingPairs],
) -> Result<f64, RegistrationError> {
    Ok(Searched::new(reference, &LEVELS[..1])?
        .registered(other, beginnings, &[])?
        .residual)
}
