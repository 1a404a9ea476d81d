//! Beginnings of a registration, and which of them explains the drawing best.
//!
//! They are compared point by point: patches are rigid, and would count what is squashed as different. And away from the edge, which outlines
//! in correspondence meet whatever they are.

use std::f64::consts::FRAC_PI_2;

use super::outline::{RingPair, nearest_on_ring, spread};
use super::pair::Pair;
use super::register::{RegistrationError, RingPairs};
use super::rigid::Rigid;
use super::template::{Fit, Template, Window};
use crate::appearance::{ByteImage, ChannelImage, PIXELS_PER_UNIT};
use crate::math::{Matrix, Point, angle, point, rotation};

/// A beginning is taken instead of one that turns the drawing less if its drawings differ by less than this share, less this difference.
const CLEARLY: (f64, f64) = (0.95, 0.003);
/// The blurred coverage of a place that is away from the edge.
pub(super) const INSIDE: f32 = 0.97;
/// The radius, in working pixels, of what is compared of a beginning at each vertex.
pub(super) const POINT_PX: f64 = 1.0;
/// The share by which a difference counts more for each radian that the figure is turned, up to a quarter turn: drawings stand upright, and one
/// that was really turned differs several times as much if it is taken to stand.
const TURNED: f64 = 0.1;

/// How far the outline under a linear map may be from the other in the mean, in figure units, to be that outline squashed: less than a line is wide.
const SQUASHED: f64 = 0.004;
/// Alternations of nearest points and the best affine map, and how far the outlines may be apart to go on with them.
const ALTERNATIONS: usize = 12;
const HOPELESS: f64 = 0.03;
/// Of so many points of an outline one is looked at.
const SQUASH_STRIDE: usize = 4;
/// Steps in which a round outline is turned, in radians, and the finer ones between two.
const TURN_STEP_RAD: f64 = std::f64::consts::PI / 60.0;
const FINE_TURNS: u8 = 6;

/// What a registration begins with.
pub(super) struct Beginning {
    pub(super) places: Vec<Point>,
    /// The linear map under which the lattice is at rest: that of the outlines if one is the other squashed, else the identity.
    pub(super) form: Matrix,
    pub(super) number: usize,
}

/// What beginnings are compared by.
struct Shown<'a> {
    /// The reference around every vertex.
    points: &'a Template,
    /// The pose.
    image: ByteImage,
    rigid: Rigid<'a>,
}

impl Pair<'_> {
    /// The best of some beginnings; `points` are those of [`POINT_PX`], `coarsest` is the pose blurred as for the first level.
    pub(super) fn best_beginning(
        &self,
        points: &Template,
        coarsest: &ChannelImage,
        beginnings: &[RingPairs],
    ) -> Result<Beginning, RegistrationError> {
        let shown = Shown {
            points,
            image: ByteImage::new(coarsest, Window::here().reach),
            rigid: Rigid::new(self.lattice, Matrix::identity()),
        };
        let (number, rings, places) = self.least_different(&shown, beginnings)?;
        let (outer, rims) = rings.split_at(rings.len().min(1));
        Ok(match Affine::squashing(outer) {
            Some(affine) => {
                let turned = self.turned_as_drawn(&shown, outer, affine);
                // Rims that are known to be elsewhere are left there.
                let carries_rims = turned.off(rims) < SQUASHED;
                Beginning {
                    places: if carries_rims { self.moved(&turned) } else { places },
                    form: turned.linear,
                    number,
                }
            }
            None => Beginning {
                places,
                form: Matrix::identity(),
                number,
            },
        })
    }

    /// A map of the outlines turned as what is drawn says where they do not: a disc may be turned at will, and stays upright if nothing on it is
    /// clearly better turned.
    fn turned_as_drawn(&self, shown: &Shown, rings: &[RingPair], affine: Affine) -> Affine {
        let Some(turning) = Turning::new(&affine, rings) else {
            return affine;
        };
        let fits = |affine: &Affine| affine.distance(rings) < SQUASHED;
        let difference = |affine: &Affine| {
            let places = self.moved(affine);
            let turned = TURNED * self.turn_rad(&places).min(FRAC_PI_2);
            self.difference(shown, &places) * (1.0 + turned)
        };
        let (mut best, mut coarse_rad) = ((difference(&affine), affine), 0.0);
        // The smallest turns first, as long as the outline goes with them: of equal ones the least is taken.
        let steps = (std::f64::consts::PI / TURN_STEP_RAD) as usize;
        let mut is_open = [true; 2];
        for k in 1..=steps {
            for (sense, is_open) in [1.0, -1.0].into_iter().zip(&mut is_open) {
                let turn_rad = sense * k as f64 * TURN_STEP_RAD;
                let turned = turning.by(turn_rad);
                *is_open = *is_open && fits(&turned);
                if !*is_open {
                    continue;
                }
                let value = difference(&turned);
                if value < CLEARLY.0 * best.0 - CLEARLY.1 {
                    (best, coarse_rad) = ((value, turned), turn_rad);
                }
            }
        }
        // Between the steps.
        let shares = (1..FINE_TURNS).map(|k| f64::from(k) / f64::from(FINE_TURNS));
        let shares = shares.flat_map(|share| [share, -share]);
        let turned = shares.map(|share| turning.by(coarse_rad + share * TURN_STEP_RAD));
        for turned in turned.filter(fits) {
            let value = difference(&turned);
            if value < best.0 {
                best = (value, turned);
            }
        }
        best.1
    }

    /// How much the drawings differ, away from the edge, where the vertices are at `places`.
    fn difference(&self, shown: &Shown, places: &[Point]) -> f64 {
        let frames = shown.rigid.frames(places, 1);
        let fits = (shown.points).fits(&shown.image, places, &frames, &Window::here(), 1.0);
        let inside = fits.into_iter().zip(self.inside);
        let inside: Vec<Fit> = inside.filter_map(|(fit, inside)| inside.then_some(fit)).collect();
        mean_residual(&inside)
    }

    /// The beginning whose drawings differ least where it has them: its number, its rings and where they put the vertices.
    fn least_different(
        &self,
        shown: &Shown,
        beginnings: &[RingPairs],
    ) -> Result<(usize, Vec<RingPair>, Vec<Point>), RegistrationError> {
        if let [only] = beginnings {
            let rings = self.in_pixels(only);
            let places = self.spread(&rings)?;
            return Ok((0, rings, places));
        }
        let mut best: Option<(f64, usize, Vec<RingPair>, Vec<Point>)> = None;
        for (number, beginning) in beginnings.iter().enumerate() {
            // Compared as the outlines have them, before they are stiffened: what is squashed is no worse than what is turned.
            let rings = self.in_pixels(beginning);
            let places = self.spread(&rings)?;
            let spread = self.difference(shown, &places);
            let least = Affine::of(&rings[..rings.len().min(1)]).map_or(spread, |affine| {
                spread.min(self.difference(shown, &self.moved(&affine)))
            });
            let difference = least * (1.0 + TURNED * self.turn_rad(&places).min(FRAC_PI_2));
            let is_better = |least: f64| difference < CLEARLY.0 * least - CLEARLY.1;
            if best.as_ref().is_none_or(|(least, ..)| is_better(*least)) {
                best = Some((difference, number, rings, places));
            }
        }
        let (_, number, rings, places) = best.ok_or(RegistrationError::NoFigure)?;
        Ok((number, rings, places))
    }

    fn in_pixels(&self, beginning: &RingPairs) -> Vec<RingPair> {
        (beginning.iter())
            .map(|(reference, pose)| RingPair {
                reference: reference.iter().map(|p| self.reference.to_pixels(*p)).collect(),
                pose: pose.iter().map(|p| self.pose.to_pixels(*p)).collect(),
            })
            .collect()
    }

    /// The vertices where outlines in correspondence have them.
    fn spread(&self, rings: &[RingPair]) -> Result<Vec<Point>, RegistrationError> {
        let pins: Vec<[Point; 2]> = self.pins.iter().map(|pin| [pin.from, pin.to]).collect();
        Ok(spread(self.lattice, rings, &pins)?)
    }

    /// The vertices under an affine map.
    fn moved(&self, affine: &Affine) -> Vec<Point> {
        self.lattice.points.iter().map(|p| affine.at(*p)).collect()
    }

    /// The absolute angle by which the figure is turned as a whole, in radians.
    fn turn_rad(&self, places: &[Point]) -> f64 {
        let count = places.len().max(1) as f64;
        let middle = |points: &[Point]| points.iter().sum::<Point>() / count;
        let (from, to) = (middle(&self.lattice.points), middle(places));
        let pairs = self.lattice.points.iter().zip(places);
        angle::best_turn(pairs.map(|(a, b)| (a - from, b - to))).abs()
    }
}

/// An affine map: `linear * (p - from) + to`.
#[derive(Clone, Copy)]
struct Affine {
    linear: Matrix,
    from: Point,
    to: Point,
}

impl Affine {
    fn at(&self, p: Point) -> Point {
        self.linear * (p - self.from) + self.to
    }

    /// The one that comes nearest to outlines in correspondence: what is squashed as a whole is squashed inside, too, which a rigid form does
    /// not say. `None` if the outlines have no area.
    fn of(rings: &[RingPair]) -> Option<Self> {
        let pairs = rings.iter().flat_map(|ring| ring.reference.iter().zip(&ring.pose));
        Self::nearest(pairs.map(|(a, b)| (*a, *b)))
    }

    /// How far the reference's outlines are from the pose's in the mean, in figure units.
    fn distance(&self, rings: &[RingPair]) -> f64 {
        let points = rings.iter().flat_map(|ring| {
            let points = ring.reference.iter().step_by(SQUASH_STRIDE);
            points.filter_map(|p| nearest_on_ring(&ring.pose, self.at(*p)))
        });
        let (sum, count) = points.fold((0.0, 0usize), |(sum, count), (distance, _)| (sum + distance, count + 1));
        sum / (count.max(1) as f64 * PIXELS_PER_UNIT)
    }

    /// How far it takes the reference's points from those that correspond to them in the mean, in figure units; 0 of none.
    fn off(&self, rings: &[RingPair]) -> f64 {
        let pairs = rings.iter().flat_map(|ring| ring.reference.iter().zip(&ring.pose));
        let (sum, count) = pairs.fold((0.0, 0usize), |(sum, count), (a, b)| {
            (sum + (self.at(*a) - b).norm(), count + 1)
        });
        sum / (count.max(1) as f64 * PIXELS_PER_UNIT)
    }

    fn nearest(pairs: impl Iterator<Item = (Point, Point)> + Clone) -> Option<Self> {
        let count = pairs.clone().count() as f64;
        let from = pairs.clone().map(|(a, _)| a).sum::<Point>() / count;
        let to = pairs.clone().map(|(_, b)| b).sum::<Point>() / count;
        let (mut second, mut mixed) = (Matrix::zeros(), Matrix::zeros());
        for (a, b) in pairs {
            second += (a - from) * (a - from).transpose();
            mixed += (b - to) * (a - from).transpose();
        }
        let linear = mixed * second.try_inverse()?;
        (linear.determinant() > 0.0).then_some(Self { linear, from, to })
    }

    /// The map under which the reference's outlines *are* the pose's wherever their points go, if there is one: points in correspondence by arc
    /// length are not yet where an affine map has them. Nearest points and the best map for them alternate (Besl and McKay 1992).
    fn squashing(rings: &[RingPair]) -> Option<Self> {
        let mut affine = Self::of(rings)?;
        let mut distance = f64::INFINITY;
        for _ in 0..ALTERNATIONS {
            let pairs: Vec<(Point, Point)> = (rings.iter())
                .flat_map(|ring| {
                    let points = ring.reference.iter().step_by(SQUASH_STRIDE);
                    points.filter_map(|p| Some((*p, nearest_on_ring(&ring.pose, affine.at(*p))?.1)))
                })
                .collect();
            let apart: f64 = pairs.iter().map(|(a, b)| (affine.at(*a) - b).norm()).sum();
            distance = apart / (pairs.len().max(1) as f64 * PIXELS_PER_UNIT);
            if distance > HOPELESS {
                return None;
            }
            affine = Self::nearest(pairs.iter().copied())?;
        }
        (distance < SQUASHED).then_some(affine)
    }
}

/// The maps that are an affine one but for a turn of the reference's outline in the frame in which its area is as wide as high.
struct Turning {
    affine: Affine,
    /// From that frame, and to it.
    root: Matrix,
    inverse: Matrix,
}

impl Turning {
    /// `None` if the outline has no area.
    fn new(affine: &Affine, rings: &[RingPair]) -> Option<Self> {
        let ring = &rings.first()?.reference;
        // Moments of the area, by triangles: those of the rim are not those of an ellipse.
        let edges = |origin: Point| {
            let next = ring.iter().skip(1).chain(ring.first());
            (ring.iter().zip(next)).map(move |(a, b)| (a - origin, b - origin))
        };
        let start = *ring.first()?;
        let double_area: f64 = edges(start).map(|(a, b)| point::cross(a, b)).sum();
        let third: Point = edges(start).map(|(a, b)| (a + b) * point::cross(a, b)).sum();
        let middle = start + third / (3.0 * double_area);
        let moments: Matrix = edges(middle)
            .map(|(a, b)| {
                let sum = a + b;
                (sum * sum.transpose() + a * a.transpose() + b * b.transpose()) * point::cross(a, b)
            })
            .sum();
        let axes = moments.symmetric_eigen();
        if axes.eigenvalues.iter().any(|moment| moment.is_nan() || *moment <= 0.0) {
            return None;
        }
        let lengths = Matrix::from_diagonal(&axes.eigenvalues.map(f64::sqrt));
        let root = axes.eigenvectors * lengths * axes.eigenvectors.transpose();
        Some(Self {
            affine: Affine {
                from: middle,
                to: affine.at(middle),
                ..*affine
            },
            inverse: root.try_inverse()?,
            root,
        })
    }

    fn by(&self, turn_rad: f64) -> Affine {
        Affine {
            linear: self.affine.linear * self.root * rotation(turn_rad) * self.inverse,
            ..self.affine
        }
    }
}

/// The mean over the vertices of how much their patches differ.
pub(super) fn mean_residual(fits: &[Fit]) -> f64 {
    fits.iter().map(|fit| f64::from(fit.residual)).sum::<f64>() / fits.len().max(1) as f64
}
