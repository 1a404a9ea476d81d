//! Beginnings of a registration, and which of them explains the drawing best.
//!
//! They are compared point by point: patches are rigid, and would count what is squashed as different. And away from the edge, which outlines
//! in correspondence meet whatever they are.

use std::f64::consts::FRAC_PI_2;

use super::levels::LEVELS;
use super::outline::{RingPair, nearest_on_ring, spread};
use super::pair::Pair;
use super::register::{RegistrationError, RingPairs};
use super::rigid::Rigid;
use super::template::{Fit, Template, Window};
use crate::appearance::{ByteImage, PIXELS_PER_UNIT};
use crate::math::{Matrix, Point, angle, point};

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
/// And of a hole at most so many.
const POINTS_OF_A_HOLE: usize = 32;

/// What a registration begins with.
pub(super) struct Beginning {
    pub(super) places: Vec<Point>,
    /// The linear map under which the lattice is at rest: that of the outlines if one is the other squashed, else the identity.
    pub(super) form: Matrix,
    pub(super) number: usize,
}

impl Pair<'_> {
    /// The best of some beginnings; `points` are those of [`POINT_PX`].
    pub(super) fn best_beginning(
        &self,
        points: &Template,
        beginnings: &[RingPairs],
    ) -> Result<Beginning, RegistrationError> {
        let (number, rings, places) = self.least_different(points, beginnings)?;
        Ok(
            match Affine::squashing(&rings, [self.reference.holes(), self.pose.holes()]) {
                Some(affine) => Beginning {
                    places: self.moved(&affine),
                    form: affine.linear,
                    number,
                },
                None => Beginning {
                    places,
                    form: Matrix::identity(),
                    number,
                },
            },
        )
    }

    /// The beginning whose drawings differ least where it has them: its number, its rings and where they put the vertices.
    fn least_different(
        &self,
        points: &Template,
        beginnings: &[RingPairs],
    ) -> Result<(usize, Vec<RingPair>, Vec<Point>), RegistrationError> {
        if let [only] = beginnings {
            let rings = self.in_pixels(only);
            let places = self.spread(&rings)?;
            return Ok((0, rings, places));
        }
        let rigid = Rigid::new(self.lattice, Matrix::identity());
        let here = Window::here();
        let image = ByteImage::new(&self.pose.blurred(LEVELS[0].deviation_px), here.reach);
        let differs = |places: &[Point]| {
            let fits = points.fits(&image, places, &rigid.frames(places, 1), &here, 1.0);
            let inside = fits.into_iter().zip(self.inside);
            let inside: Vec<Fit> = inside.filter_map(|(fit, inside)| inside.then_some(fit)).collect();
            mean_residual(&inside)
        };
        let mut best: Option<(f64, usize, Vec<RingPair>, Vec<Point>)> = None;
        for (number, beginning) in beginnings.iter().enumerate() {
            // Compared as the outlines have them, before they are stiffened: what is squashed is no worse than what is turned.
            let rings = self.in_pixels(beginning);
            let places = self.spread(&rings)?;
            let spread = differs(&places);
            let least = Affine::of(&rings).map_or(spread, |affine| spread.min(differs(&self.moved(&affine))));
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
        let turn: Point = pairs
            .map(|(a, b)| Point::new((a - from).dot(&(b - to)), point::cross(a - from, b - to)))
            .sum();
        angle::between(Point::new(1.0, 0.0), turn).abs()
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
    /// length are not yet where an affine map has them. Nearest points and the best map for them alternate (Besl and McKay 1992). The holes
    /// have to follow if there are as many: of a disc they alone say how far it is turned.
    fn squashing(rings: &[RingPair], [holes, holes_of_pose]: [&[Vec<Point>]; 2]) -> Option<Self> {
        let holes = if holes.len() == holes_of_pose.len() { holes } else { &[] };
        let mut affine = Self::of(rings)?;
        let mut distance = f64::INFINITY;
        for _ in 0..ALTERNATIONS {
            let on_outlines = rings.iter().flat_map(|ring| {
                let points = ring.reference.iter().step_by(SQUASH_STRIDE);
                points.filter_map(|p| Some((*p, nearest_on_ring(&ring.pose, affine.at(*p))?.1)))
            });
            let nearest_hole = |p: Point| {
                let on_holes = holes_of_pose.iter().filter_map(|hole| nearest_on_ring(hole, p));
                on_holes.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, nearest)| nearest)
            };
            let on_holes = holes.iter().flat_map(|hole| {
                let points = hole.iter().step_by(hole.len().div_ceil(POINTS_OF_A_HOLE));
                points.filter_map(|p| Some((*p, nearest_hole(affine.at(*p))?)))
            });
            let pairs: Vec<(Point, Point)> = on_outlines.chain(on_holes).collect();
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

/// The mean over the vertices of how much their patches differ.
fn mean_residual(fits: &[Fit]) -> f64 {
    fits.iter().map(|fit| f64::from(fit.residual)).sum::<f64>() / fits.len().max(1) as f64
}
