//! Beginnings of a registration, and which of them explains the drawing best.
//!
//! They are compared point by point: patches are rigid, and would count what is squashed as different. And away from the edge, which outlines
//! in correspondence meet whatever they are.

use std::f64::consts::FRAC_PI_2;

use super::levels::LEVELS;
use super::outline::{RingPair, spread};
use super::pair::Pair;
use super::register::{RegistrationError, RingPairs};
use super::rigid::Rigid;
use super::template::{Fit, Template, Window};
use crate::appearance::ByteImage;
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
impl Pair<'_> {
    /// The vertices as the best beginning has them, and its number; `points` are those of [`POINT_PX`].
    pub(super) fn best_beginning(
        &self,
        rigid: &Rigid,
        points: &Template,
        beginnings: &[RingPairs],
    ) -> Result<(Vec<Point>, usize), RegistrationError> {
        if let [only] = beginnings {
            return Ok((self.begun(rigid, only)?, 0));
        }
        let here = Window::here();
        let image = ByteImage::new(&self.pose.blurred(LEVELS[0].deviation_px), here.reach);
        let differs = |places: &[Point]| {
            let rotations = rigid.rotations(places, 1);
            let fits = points.fits(&image, places, &rotations, &here, 1.0);
            let inside = fits.into_iter().zip(self.inside);
            let inside: Vec<Fit> = inside.filter_map(|(fit, inside)| inside.then_some(fit)).collect();
            mean_residual(&inside)
        };
        let mut best: Option<(f64, Vec<Point>, usize)> = None;
        for (number, beginning) in beginnings.iter().enumerate() {
            // Compared as the outlines have them, before they are stiffened: what is squashed is no worse than what is turned.
            let places = self.begun(rigid, beginning)?;
            let difference = self.affinely(beginning).map_or(0.0, |affine| {
                let least = differs(&places).min(differs(&affine));
                least * (1.0 + TURNED * self.turn_rad(&places).min(FRAC_PI_2))
            });
            let is_better = |least: f64| difference < CLEARLY.0 * least - CLEARLY.1;
            if best.as_ref().is_none_or(|(least, ..)| is_better(*least)) {
                best = Some((difference, places, number));
            }
        }
        let (_, places, number) = best.ok_or(RegistrationError::NoFigure)?;
        Ok((places, number))
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
        Ok(spread(self.lattice, rigid, &rings, &pins)?)
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
}

/// The mean over the vertices of how much their patches differ.
pub(super) fn mean_residual(fits: &[Fit]) -> f64 {
    fits.iter().map(|fit| f64::from(fit.residual)).sum::<f64>() / fits.len().max(1) as f64
}
