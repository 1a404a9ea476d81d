//! All poses registered to the reference.

use std::f64::consts::FRAC_PI_2;

use rayon::prelude::*;

use super::lattice::Lattice;
use super::outline::{RingPair, spread};
use super::rigid::{Rigid, Targets};
use super::template::{Fit, MOST_DIFFERENCE, Template, Window};
use crate::appearance::{Appearance, ByteImage, PIXELS_PER_UNIT};
use crate::math::{Matrix, Point, angle, point};
use crate::solve::SolveError;

/// The lattice's spacing, in figure units.
const SPACING: f64 = 0.022;

/// One level of the search. Lengths are in figure units but for the blur, which is in working pixels.
struct Level {
    deviation_px: f32,
    patch_radius: f64,
    reach: f64,
    step: f64,
    stiffness: f64,
    temperature: f32,
    iterations: usize,
}

/// From coarse to fine.
const LEVELS: [Level; 5] = [
    level(5.0, 0.060, 0.060, 0.0100, 300.0, 0.030, 4),
    level(3.5, 0.045, 0.036, 0.0060, 150.0, 0.027, 4),
    level(2.2, 0.034, 0.020, 0.0034, 75.0, 0.0225, 3),
    level(1.3, 0.026, 0.010, 0.0018, 37.5, 0.018, 3),
    level(0.9, 0.020, 0.005, 0.0011, 22.5, 0.015, 2),
];

const fn level(
    deviation_px: f32,
    patch_radius: f64,
    reach: f64,
    step: f64,
    stiffness: f64,
    temperature: f32,
    iterations: usize,
) -> Level {
    Level {
        deviation_px,
        patch_radius,
        reach,
        step,
        stiffness,
        temperature,
        iterations,
    }
}

/// A beginning is first made this stiff, beside a trust of 1 in where it is: folds that the outlines left come out.
const FIRST_STIFFNESS: f64 = 30.0;
const FIRST_ITERATIONS: usize = 10;
/// A beginning is taken instead of one that turns the drawing less if its drawings differ by less than this share, less this difference.
const CLEARLY: (f64, f64) = (0.95, 0.003);
/// The blurred coverage of a place that is away from the edge.
const INSIDE: f32 = 0.97;
/// The radius, in working pixels, of what is compared of a beginning at each vertex.
const POINT_PX: f64 = 1.0;
/// The share by which a difference counts more for each radian that the figure is turned, up to a quarter turn: drawings stand upright, and one
/// that was really turned differs several times as much if it is taken to stand.
const TURNED: f64 = 0.1;
/// Trust falls by a factor e when the best place in the window differs by this share of [`MOST_DIFFERENCE`].
const DOUBT: f32 = 0.25;
/// The trust in a pair of points that is certain and in one that is likely, beside some 100 of a vertex whose place is clear.
const CERTAIN: f64 = 1e5;
const LIKELY: f64 = 300.0;

/// A level ends when vertices move by less than this share of its step in the mean.
const STILL: f64 = 0.1;

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

/// Outlines in correspondence, as a beginning: for every ring, points of the reference and of the pose in source units.
pub type RingPairs = Vec<(Vec<Point>, Vec<Point>)>;

/// A place of the reference and the place of a pose that corresponds to it, in source units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pin {
    from: Point,
    to: Point,
    trust: f64,
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

/// Where the reference's places are in every pose.
#[derive(Debug, Clone)]
pub struct Registration {
    lattice: Lattice,
    reference: Appearance,
    poses: Vec<Option<RegisteredPose>>,
}

#[derive(Debug, Clone)]
struct RegisteredPose {
    appearance: Appearance,
    places: Vec<Point>,
    rotations: Vec<Point>,
    residual: f64,
}

impl Registration {
    /// Where a place of the reference is in `pose`, in source units; `None` for the reference itself and poses that were not registered.
    #[must_use]
    pub fn carried(&self, pose: usize, place: Point) -> Option<Point> {
        let registered = self.poses.get(pose)?.as_ref()?;
        let p = self.reference.to_pixels(place);
        let carried = self.lattice.carried(&registered.places, &registered.rotations, p)?;
        Some(registered.appearance.to_source(carried))
    }

    /// How much the drawing of `pose` differs from what the reference shows at the same places: 0 for equal drawings, at most 1.2.
    #[must_use]
    pub fn residual(&self, pose: usize) -> Option<f64> {
        Some(self.poses.get(pose)?.as_ref()?.residual)
    }
}

/// Registers every pose of `appearances` but the reference, and says for each which beginning explained the drawing best. `beginnings` has for each at least one beginning, the
/// one that turns the drawing least first; `pins` are pairs of points that are known to correspond.
///
/// # Errors
/// [`RegistrationError`] if the reference has no figure.
pub fn register(
    appearances: Vec<Appearance>,
    reference: usize,
    beginnings: &[Vec<RingPairs>],
    pins: &[Vec<Pin>],
) -> Result<(Registration, Vec<usize>), RegistrationError> {
    let own = &appearances[reference];
    let lattice = Lattice::new(&own.mask(), own.size()[0], SPACING * PIXELS_PER_UNIT);
    if lattice.points.is_empty() {
        return Err(RegistrationError::NoFigure);
    }
    let templates: Vec<Template> = (LEVELS.par_iter())
        .map(|level| {
            Template::new(
                &lattice,
                &own.blurred(level.deviation_px),
                level.patch_radius * PIXELS_PER_UNIT,
            )
        })
        .collect();
    // Beginnings are compared point by point: patches are rigid, and would count what is squashed as different. And away from the edge, which
    // outlines in correspondence meet whatever they are.
    let blurred = own.blurred(LEVELS[0].deviation_px);
    let points = Template::new(&lattice, &blurred, POINT_PX);
    let inside: Vec<bool> = (lattice.points.iter())
        .map(|p| blurred.at(p.x as f32, p.y as f32)[4] >= INSIDE)
        .collect();
    let registered: Vec<Option<(Vec<Point>, f64, usize)>> = (0..appearances.len())
        .into_par_iter()
        .map(|pose| {
            let beginnings = beginnings.get(pose).map_or(&[][..], Vec::as_slice);
            if pose == reference || beginnings.is_empty() {
                return Ok(None);
            }
            let pair = Pair::new(
                &lattice,
                own,
                &appearances[pose],
                pins.get(pose).map_or(&[], Vec::as_slice),
                &inside,
            );
            pair.registered(&points, &templates, beginnings).map(Some)
        })
        .collect::<Result<_, RegistrationError>>()?;
    let chosen = (registered.iter())
        .map(|registered| registered.as_ref().map_or(0, |(.., chosen)| *chosen))
        .collect();
    let poses = (registered.into_iter().zip(&appearances))
        .map(|(registered, appearance)| {
            registered.map(|(places, residual, _)| RegisteredPose {
                rotations: Rigid::new(&lattice, 1.0).rotations(&places, 0),
                appearance: appearance.clone(),
                places,
                residual,
            })
        })
        .collect();
    let registration = Registration {
        reference: own.clone(),
        lattice,
        poses,
    };
    Ok((registration, chosen))
}

/// The reference and one other pose.
struct Pair<'a> {
    lattice: &'a Lattice,
    reference: &'a Appearance,
    pose: &'a Appearance,
    /// In working pixels.
    pins: Vec<Pin>,
    /// Which vertices are inside the figure, away from its edge.
    inside: &'a [bool],
}

impl<'a> Pair<'a> {
    fn new(
        lattice: &'a Lattice,
        reference: &'a Appearance,
        pose: &'a Appearance,
        pins: &[Pin],
        inside: &'a [bool],
    ) -> Self {
        Self {
            lattice,
            reference,
            pose,
            pins: (pins.iter())
                .map(|pin| Pin {
                    from: reference.to_pixels(pin.from),
                    to: pose.to_pixels(pin.to),
                    trust: pin.trust,
                })
                .collect(),
            inside,
        }
    }

    /// The places of the vertices, how much the drawings still differ there, and from which beginning.
    fn registered(
        &self,
        points: &Template,
        templates: &[Template],
        beginnings: &[RingPairs],
    ) -> Result<(Vec<Point>, f64, usize), RegistrationError> {
        let rigid = Rigid::new(self.lattice, 1.0);
        let here = Window::here();
        let image = ByteImage::new(&self.pose.blurred(LEVELS[0].deviation_px), here.reach);
        let mut best: Option<(f64, Vec<Point>, usize)> = None;
        for (number, beginning) in beginnings.iter().enumerate() {
            // Compared as the outlines have them, before they are stiffened: what is squashed is no worse than what is turned.
            let places = self.begun(&rigid, beginning)?;
            let differs = |places: &[Point]| {
                let rotations = rigid.rotations(places, 1);
                let fits = points.fits(&image, places, &rotations, &here, 1.0);
                let inside = fits.into_iter().zip(self.inside);
                mean_residual(
                    &inside
                        .filter_map(|(fit, inside)| inside.then_some(fit))
                        .collect::<Vec<_>>(),
                )
            };
            let is_choice = beginnings.len() > 1;
            let difference = match is_choice.then(|| self.affinely(beginning)).flatten() {
                Some(affine) => {
                    let least = differs(&places).min(differs(&affine));
                    least * (1.0 + TURNED * self.turn_rad(&places).min(FRAC_PI_2))
                }
                None => 0.0,
            };
            let is_better = |least: f64| difference < CLEARLY.0 * least - CLEARLY.1;
            if best.as_ref().is_none_or(|(least, ..)| is_better(*least)) {
                best = Some((difference, places, number));
            }
        }
        let Some((_, places, number)) = best else {
            return Err(RegistrationError::NoFigure);
        };
        let mut places = self.stiffened(&rigid, &places)?;
        let mut residual = 0.0;
        for (level, template) in LEVELS.iter().zip(templates) {
            let fits;
            (places, fits) = self.level(level, template, &rigid, places)?;
            residual = mean_residual(&fits);
        }
        Ok((places, residual, number))
    }

    /// The vertices where outlines in correspondence have them.
    fn begun(&self, rigid: &Rigid, beginning: &RingPairs) -> Result<Vec<Point>, RegistrationError> {
        let rings: Vec<RingPair> = (beginning.iter())
            .map(|(reference, pose)| RingPair {
                reference: reference.iter().map(|p| self.reference.to_pixels(*p)).collect(),
                pose: pose.iter().map(|p| self.pose.to_pixels(*p)).collect(),
            })
            .collect();
        let pins: Vec<[Point; 2]> = self.pins.iter().map(|pin| [pin.from, pin.to]).collect();
        Ok(spread(self.lattice, rigid, 1.0, &rings, &pins)?)
    }

    /// The vertices moved by the affine map that comes nearest to outlines in correspondence: what is squashed as a whole is squashed inside, too,
    /// which a rigid form does not say. `None` if the outlines have no area.
    fn affinely(&self, beginning: &RingPairs) -> Option<Vec<Point>> {
        let pairs: Vec<(Point, Point)> = (beginning.iter())
            .flat_map(|(reference, pose)| reference.iter().zip(pose))
            .map(|(a, b)| (self.reference.to_pixels(*a), self.pose.to_pixels(*b)))
            .collect();
        let count = pairs.len() as f64;
        let from = pairs.iter().map(|(a, _)| a).sum::<Point>() / count;
        let to = pairs.iter().map(|(_, b)| b).sum::<Point>() / count;
        let (mut second, mut mixed) = (Matrix::zeros(), Matrix::zeros());
        for (a, b) in &pairs {
            second += (a - from) * (a - from).transpose();
            mixed += (b - to) * (a - from).transpose();
        }
        let map = mixed * second.try_inverse()?;
        Some(self.lattice.points.iter().map(|p| map * (p - from) + to).collect())
    }

    /// The absolute angle by which the figure is turned as a whole, in radians.
    fn turn_rad(&self, places: &[Point]) -> f64 {
        let count = places.len().max(1) as f64;
        let middle = |points: &[Point]| points.iter().sum::<Point>() / count;
        let (from, to) = (middle(&self.lattice.points), middle(places));
        let pairs = self.lattice.points.iter().zip(places);
        let turn: Point = pairs
            .map(|(a, b)| Point::new((a - from).dot(&(b - to)), point::cross(a - from, b - to)))
            .sum();
        angle::between(Point::new(1.0, 0.0), turn).abs()
    }

    /// The vertices moved a little towards a rigid form, so that folds come out.
    fn stiffened(&self, rigid: &Rigid, places: &[Point]) -> Result<Vec<Point>, RegistrationError> {
        let (mut wanted, mut trust) = (places.to_vec(), vec![Matrix::identity(); places.len()]);
        self.pin(rigid, places, &mut wanted, &mut trust);
        let targets = Targets {
            places: &wanted,
            trust: &trust,
        };
        Ok(rigid.solve(places, &targets, FIRST_STIFFNESS, FIRST_ITERATIONS)?)
    }

    /// Joins the targets with those that pins give the vertices next to them, each by its trust.
    fn pin(&self, rigid: &Rigid, places: &[Point], targets: &mut [Point], trust: &mut [Matrix]) {
        if self.pins.is_empty() {
            return;
        }
        let rotations = rigid.rotations(places, 1);
        let mut sums = vec![(0.0, Point::zeros()); targets.len()];
        for pin in &self.pins {
            if let Some((cell, _)) = self.lattice.cell_at(pin.from) {
                let turn = rotations[cell];
                let aside = Matrix::new(turn.x, -turn.y, turn.y, turn.x) * (self.lattice.points[cell] - pin.from);
                sums[cell].0 += pin.trust;
                sums[cell].1 += (pin.to + aside) * pin.trust;
            }
        }
        for (cell, (sum, weighted)) in sums.into_iter().enumerate().filter(|(_, sum)| sum.0 > 0.0) {
            let joint = trust[cell] + Matrix::identity() * sum;
            if let Some(inverse) = joint.try_inverse() {
                targets[cell] = inverse * (trust[cell] * targets[cell] + weighted);
                trust[cell] = joint;
            }
        }
    }

    fn level(
        &self,
        level: &Level,
        template: &Template,
        rigid: &Rigid,
        mut places: Vec<Point>,
    ) -> Result<(Vec<Point>, Vec<Fit>), RegistrationError> {
        let window = Window::new(level.reach * PIXELS_PER_UNIT, level.step * PIXELS_PER_UNIT);
        let image = ByteImage::new(&self.pose.blurred(level.deviation_px), window.reach);
        let floor = Matrix::identity() * (0.25 * window.step * window.step);
        let mut fits = Vec::new();
        for _ in 0..level.iterations {
            let rotations = rigid.rotations(&places, 1);
            fits = template.fits(&image, &places, &rotations, &window, level.temperature);
            let (mut targets, mut trust) = (Vec::new(), Vec::new());
            for (fit, place) in fits.iter().zip(&places) {
                let confidence = f64::from(libm::expf(-fit.residual / (DOUBT * MOST_DIFFERENCE)));
                let inverse = (fit.covariance + floor).try_inverse().unwrap_or_else(Matrix::zeros);
                targets.push(place + fit.displacement);
                trust.push(inverse * confidence * self.lattice.spacing.powi(2));
            }
            self.pin(rigid, &places, &mut targets, &mut trust);
            let targets = Targets {
                places: &targets,
                trust: &trust,
            };
            let solved = rigid.solve(&places, &targets, level.stiffness, 6)?;
            let moved = solved.iter().zip(&places).map(|(a, b)| (a - b).norm()).sum::<f64>();
            places = solved;
            if moved < STILL * window.step * places.len() as f64 {
                break;
            }
        }
        Ok((places, fits))
    }
}

/// The mean over the vertices of how much their patches differ.
fn mean_residual(fits: &[Fit]) -> f64 {
    fits.iter().map(|fit| f64::from(fit.residual)).sum::<f64>() / fits.len().max(1) as f64
}
