//! One pose registered to the reference, level after level.

use super::beginning::mean_residual;
use super::lattice::Lattice;
use super::levels::{LEVELS, Level};
use super::register::{Pin, RegistrationError, RingPairs};
use super::rigid::{Rigid, Targets};
use super::template::{Fit, Template, Window};
use crate::appearance::{Appearance, ByteImage, ChannelImage, PIXELS_PER_UNIT};
use crate::math::{Matrix, Point};

/// A beginning is first made this stiff, beside a trust of 1 in where it is: folds that the outlines left come out.
const FIRST_STIFFNESS: f64 = 30.0;
const FIRST_ITERATIONS: usize = 10;
/// The trust in outer rings that stay, less than in what is clear, and in rims between the landmarks that are on them, more than that: far more than in empty
/// paint, which would give way.
const HELD_OUTER: f64 = 30.0;
const HELD_RIM: f64 = 300.0;
/// A level ends when vertices move by less than this share of its step in the mean.
const STILL: f64 = 0.1;

/// The reference and one other pose.
pub(super) struct Pair<'a> {
    pub(super) lattice: &'a Lattice,
    pub(super) reference: &'a Appearance,
    pub(super) pose: &'a Appearance,
    /// In working pixels.
    pub(super) pins: Vec<Pin>,
    /// Points of rings that stay, in working pixels.
    held: Vec<Pin>,
    /// Which vertices are inside the figure, away from its edge.
    pub(super) inside: &'a [bool],
}

/// A pose in registration.
pub(super) struct Registered {
    /// By vertex, in working pixels.
    pub(super) places: Vec<Point>,
    /// By vertex, the linear map of what is around it.
    pub(super) frames: Vec<Matrix>,
    /// By vertex, how much the drawings still differ around it.
    pub(super) residuals: Vec<f32>,
    /// The mean of the same after the first level.
    pub(super) coarse_residual: f64,
    /// By vertex, what its place was worth in the last solve: the mean of its trust over directions.
    pub(super) trusts: Vec<f64>,
    /// The number of the beginning.
    pub(super) beginning: usize,
}

/// A level's end.
struct Settled {
    places: Vec<Point>,
    fits: Vec<Fit>,
    /// As of [`Registered`].
    trusts: Vec<f64>,
}

impl<'a> Pair<'a> {
    pub(super) fn new(
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
            held: Vec::new(),
            inside,
        }
    }

    /// The pose registered from the best of some beginnings, at as many levels as there are templates.
    pub(super) fn registered(
        mut self,
        points: &Template,
        templates: &[Template],
        beginnings: &[RingPairs],
    ) -> Result<Registered, RegistrationError> {
        let coarsest = self.pose.blurred(LEVELS[0].deviation_px);
        let beginning = self.best_beginning(points, &coarsest, beginnings)?;
        // Empty paint slides along its outlines: where rims are turned against the outer one, they would turn each other.
        if let Some(rings) = beginnings.get(beginning.number).filter(|rings| rings.len() > 1) {
            self.held = self.on_rings(rings);
        }
        let rigid = Rigid::new(self.lattice, beginning.form);
        let mut places = self.stiffened(&rigid, &beginning.places)?;
        let (mut residuals, mut trusts) = (Vec::new(), Vec::new());
        let mut coarse_residual = None;
        let mut coarsest = Some(coarsest);
        for (level, template) in LEVELS.iter().zip(templates) {
            let image = coarsest.take().unwrap_or_else(|| self.pose.blurred(level.deviation_px));
            let settled = self.level(level, template, &image, &rigid, places, &[])?;
            residuals = settled.fits.iter().map(|fit| fit.residual).collect();
            coarse_residual.get_or_insert_with(|| mean_residual(&settled.fits));
            (places, trusts) = (settled.places, settled.trusts);
        }
        Ok(Registered {
            frames: rigid.frames(&places, 0),
            places,
            residuals,
            coarse_residual: coarse_residual.unwrap_or_default(),
            trusts,
            beginning: beginning.number,
        })
    }

    /// The vertices registered further from where they are, at the levels from `first` on, of which the pose is given. Those that are hidden are not compared.
    pub(super) fn settled_from(
        &self,
        rigid: &Rigid,
        places: &[Point],
        (first, images): (usize, &[ChannelImage]),
        templates: &[Template],
        is_hidden: &[bool],
    ) -> Result<Vec<Point>, RegistrationError> {
        let mut places = places.to_vec();
        for ((level, template), image) in LEVELS.iter().zip(templates).skip(first).zip(images) {
            places = self.level(level, template, image, rigid, places, is_hidden)?.places;
        }
        Ok(places)
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

    /// One pair of points of rings in correspondence a vertex at most: the one that is nearest to it.
    fn on_rings(&self, rings: &RingPairs) -> Vec<Pin> {
        let mut nearest: Vec<Option<(f64, Pin)>> = vec![None; self.lattice.points.len()];
        for (ring, (reference, pose)) in rings.iter().enumerate() {
            let trust = if ring == 0 { HELD_OUTER } else { HELD_RIM };
            for (from, to) in reference.iter().zip(pose) {
                let (from, to) = (self.reference.to_pixels(*from), self.pose.to_pixels(*to));
                let Some((cell, _)) = self.lattice.cell_at(from) else {
                    continue;
                };
                let distance = (from - self.lattice.points[cell]).norm_squared();
                if nearest[cell].is_none_or(|(least, _)| distance < least) {
                    nearest[cell] = Some((distance, Pin { from, to, trust }));
                }
            }
        }
        nearest.into_iter().flatten().map(|(_, pin)| pin).collect()
    }

    /// Joins the targets with those that pins give the vertices next to them, each by its trust.
    pub(super) fn pin(&self, rigid: &Rigid, places: &[Point], targets: &mut [Point], trust: &mut [Matrix]) {
        if self.pins.is_empty() && self.held.is_empty() {
            return;
        }
        let frames = rigid.frames(places, 1);
        let mut sums = vec![(0.0, Point::zeros()); targets.len()];
        for pin in self.pins.iter().chain(&self.held) {
            if let Some((cell, _)) = self.lattice.cell_at(pin.from) {
                let aside = frames[cell] * (self.lattice.points[cell] - pin.from);
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
        image: &ChannelImage,
        rigid: &Rigid,
        mut places: Vec<Point>,
        is_hidden: &[bool],
    ) -> Result<Settled, RegistrationError> {
        let window = Window::new(level.reach * PIXELS_PER_UNIT, level.step * PIXELS_PER_UNIT);
        let image = ByteImage::new(image, window.reach);
        let floor = window.floor();
        let (mut fits, mut trusts) = (Vec::new(), Vec::new());
        for _ in 0..level.iterations {
            let frames = rigid.frames(&places, 1);
            fits = template.fits(&image, &places, &frames, &window, level.temperature);
            let (mut targets, mut trust) = (Vec::new(), Vec::new());
            for (v, (fit, place)) in fits.iter().zip(&places).enumerate() {
                if is_hidden.get(v) == Some(&true) {
                    targets.push(*place);
                    trust.push(Matrix::zeros());
                    continue;
                }
                let (target, certainty) = fit.target(*place, floor, self.lattice.spacing);
                targets.push(target);
                trust.push(certainty);
            }
            self.pin(rigid, &places, &mut targets, &mut trust);
            trusts = trust.iter().map(|trust| 0.5 * trust.trace()).collect();
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
        Ok(Settled { places, fits, trusts })
    }
}
