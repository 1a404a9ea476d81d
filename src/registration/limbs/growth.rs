//! A beginning for outlines that say nothing: the figure grown from its root.
//!
//! Finders at several sizes -> the whole figure put, and which of them has its size.
//!
//! 1. The root's band goes wherever its patches fit best, at any turn and at any of the sizes: how large a figure is that lies over itself, neither its
//!    area nor its outline says.
//! 2. From the likeliest of these, at every size, chain after chain is put by its best hypothesis. The root says where it is, and hardly how large: what
//!    the whole then explains decides.
//! 3. The best of these are registered, whole.

use rayon::prelude::*;

use super::comparison::BARE;
use super::hypotheses::spread_out;
use super::search::{Finder, Put};
use crate::math::{Point, angle, rotation};
use crate::registration::register::RegistrationError;

/// Places that go on, directions that are tried, vertices that are compared, and what a radian of turn costs each.
const ROOTS: usize = 3;
const TURNS: usize = 20;
const SAMPLES: usize = 24;
const TURN_COST: f64 = 0.02;
/// Of everything that is grown, how much is registered.
const REGISTERED: usize = 3;
/// Roots are apart by this many spacings, or this angle.
const APART: (f64, f64) = (2.5, 0.7);

/// A place of the root.
#[derive(Clone, Copy)]
struct Root {
    cost: f64,
    place: Point,
    turn_rad: f64,
}

/// The figure grown from its root, the best of some, and the number of the one of `finders` that it was grown by: they differ in the size of the figure.
pub(super) fn grown(finders: &[Finder<'_>]) -> Result<Option<(usize, Put)>, RegistrationError> {
    let spacing = finders.first().map_or(0.0, |finder| finder.pair.lattice.spacing);
    let tried: Vec<Vec<Root>> = finders.iter().map(Finder::roots).collect();
    let places = likeliest(tried.iter().flatten(), spacing);
    let is_likely = |root: &&Root| places.iter().any(|place| is_near(place, root, spacing));
    let roots: Vec<(usize, Root)> = (tried.iter().enumerate())
        .flat_map(|(finder, tried)| {
            let near = likeliest(tried.iter().filter(is_likely), spacing);
            near.into_iter().map(move |root| (finder, root))
        })
        .collect();
    let mut grown: Vec<(usize, Put)> = (roots.into_par_iter())
        .map(|(finder, root)| (finder, finders[finder].grown_from(root)))
        .collect();
    grown.sort_by(|a, b| a.1.energy.total_cmp(&b.1.energy));
    grown.truncate(REGISTERED);
    let registered: Vec<Result<(usize, Put), RegistrationError>> = (grown.into_par_iter())
        .map(|(finder, put)| Ok((finder, finders[finder].registered_whole(&put)?)))
        .collect();
    let registered: Vec<(usize, Put)> = registered.into_iter().collect::<Result<_, _>>()?;
    Ok((registered.into_iter()).min_by(|a, b| a.1.energy.total_cmp(&b.1.energy)))
}

/// Whether two roots are nearly the same.
fn is_near(a: &Root, b: &Root, spacing: f64) -> bool {
    (a.place - b.place).norm() < APART.0 * spacing && angle::wrap(a.turn_rad - b.turn_rad).abs() < APART.1
}

/// The roots that cost least, one of those that are nearly the same.
fn likeliest<'a>(tried: impl Iterator<Item = &'a Root>, spacing: f64) -> Vec<Root> {
    let mut tried: Vec<&Root> = tried.collect();
    tried.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let mut roots: Vec<Root> = Vec::new();
    for root in tried {
        if !roots.iter().any(|other| is_near(other, root, spacing)) {
            roots.push(*root);
            if roots.len() == ROOTS {
                break;
            }
        }
    }
    roots
}

impl Finder<'_> {
    /// The middle of the root's band in the reference.
    fn middle(&self) -> Point {
        let band = &self.limbs.nodes[0];
        band.iter().map(|v| self.pair.lattice.points[*v]).sum::<Point>() / band.len().max(1) as f64
    }

    /// All places of the root's band.
    fn roots(&self) -> Vec<Root> {
        let points = &self.pair.lattice.points;
        let middle = self.middle();
        let samples = spread_out(&self.limbs.nodes[0], SAMPLES);
        let spacing = self.pair.lattice.spacing;
        let [width, height] = self.comparison.pose.size();
        let along = |length: usize| (0..(length as f64 / spacing) as usize).map(move |k| (k as f64 + 0.5) * spacing);
        let middles: Vec<Point> = (along(height).flat_map(|y| along(width).map(move |x| Point::new(x, y))))
            .filter(|p| self.comparison.figure[self.comparison.cell_at(*p)])
            .collect();
        (middles.par_iter())
            .flat_map_iter(|&place| {
                let samples = &samples;
                (0..TURNS).map(move |turn| {
                    let turn_rad = angle::wrap(std::f64::consts::TAU * turn as f64 / TURNS as f64);
                    let frame = rotation(turn_rad) * self.search.scale;
                    let differs = samples.iter().map(|v| {
                        let at = place + frame * (points[*v] - middle);
                        f64::from((self.search.patches).difference_at(self.comparison.pose, *v, at, &frame))
                    });
                    let pinned = (self.search.pinned).of_band(0, points, |p| place + frame * (p - middle));
                    let differs = differs.sum::<f64>() / samples.len().max(1) as f64;
                    Root {
                        cost: differs + TURN_COST * turn_rad.abs() + pinned,
                        place,
                        turn_rad,
                    }
                })
            })
            .collect()
    }

    /// Puts the root's band, and everything that hangs on it.
    fn grown_from(&self, root: Root) -> Put {
        let (points, middle) = (&self.pair.lattice.points, self.middle());
        let frame = rotation(root.turn_rad) * self.search.scale;
        let mut places = vec![Point::zeros(); points.len()];
        for &v in &self.limbs.nodes[0] {
            places[v] = root.place + frame * (points[v] - middle);
        }
        let mut layers = vec![vec![BARE; self.comparison.figure.len()]; self.limbs.chains.len()];
        layers[0] = self.comparison.layer(0, &places);
        let chains: Vec<usize> = (1..self.limbs.chains.len()).collect();
        self.grow(&chains, &mut places, &mut layers);
        self.put_in(places, layers)
    }

    /// The whole figure registered.
    fn registered_whole(&self, put: &Put) -> Result<Put, RegistrationError> {
        let all: Vec<usize> = (0..put.places.len()).collect();
        Ok(self.put(self.registered(self.settled(&put.places, &all)?, &all)?))
    }
}
