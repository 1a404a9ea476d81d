//! All poses registered to the reference.

use std::sync::Arc;

use rayon::prelude::*;

use super::beginning::{INSIDE, POINT_PX};
use super::explained::Found;
use super::lattice::Lattice;
use super::levels::LEVELS;
use super::pair::{Pair, Registered};
use super::template::Template;
use crate::appearance::{Appearance, ChannelImage, PIXELS_PER_UNIT};
use crate::math::{Matrix, Point};
use crate::solve::SolveError;

/// The lattice's spacing, in figure units.
const SPACING: f64 = 0.022;

/// The trust in a pair of points that is certain and in one that is likely, beside some 100 of a vertex whose place is clear.
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

/// Outlines in correspondence, as a beginning: for every ring, points of the reference and of the pose in source units.
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
    lattice: Lattice,
    reference: Arc<Appearance>,
    poses: Vec<Option<RegisteredPose>>,
}

#[derive(Debug, Clone)]
struct RegisteredPose {
    appearance: Arc<Appearance>,
    places: Vec<Point>,
    frames: Vec<Matrix>,
    explained: Explained,
    residual: f64,
}

impl Registration {
    /// Where a place of the reference is in `pose`, in source units; `None` for the reference itself and poses that were not registered.
    #[must_use]
    pub fn carried(&self, pose: usize, place: Point) -> Option<Point> {
        let registered = self.poses.get(pose)?.as_ref()?;
        let p = self.reference.to_pixels(place);
        let carried = self.lattice.carried(&registered.places, &registered.frames, p)?;
        Some(registered.appearance.to_source(carried))
    }

    /// How much the drawing of `pose` differs from what the reference shows at the same places: 0 for equal drawings, at most 1.2.
    #[must_use]
    pub fn residual(&self, pose: usize) -> Option<f64> {
        Some(self.poses.get(pose)?.as_ref()?.residual)
    }

    /// How much of what the reference shows is found in the drawing of `pose`, and where least; `None` as for [`carried`](Self::carried).
    #[must_use]
    pub fn explained(&self, pose: usize) -> Option<Explained> {
        Some(self.poses.get(pose)?.as_ref()?.explained)
    }
}

/// Registers every pose of `appearances` but the reference, and says for each which beginning explained the drawing best. `beginnings` has for
/// each at least one beginning, the one that turns the drawing least first; `pins` are pairs of points that are known to correspond.
///
/// # Errors
/// [`RegistrationError`] if the reference has no figure.
pub fn register(
    appearances: &[Arc<Appearance>],
    reference: usize,
    beginnings: &[Vec<RingPairs>],
    pins: &[Vec<Pin>],
) -> Result<(Registration, Vec<usize>), RegistrationError> {
    let own = &appearances[reference];
    let lattice = Lattice::new(&own.mask(), own.size()[0], SPACING * PIXELS_PER_UNIT);
    if lattice.points.is_empty() {
        return Err(RegistrationError::NoFigure);
    }
    let images: Vec<ChannelImage> = LEVELS.par_iter().map(|level| own.blurred(level.deviation_px)).collect();
    let templates: Vec<Template> = (LEVELS.par_iter().zip(&images))
        .map(|(level, image)| Template::new(&lattice, image, level.patch_radius * PIXELS_PER_UNIT))
        .collect();
    let points = Template::new(&lattice, &images[0], POINT_PX);
    let inside: Vec<bool> = (lattice.points.iter())
        .map(|p| images[0].at(p.x as f32, p.y as f32)[4] >= INSIDE)
        .collect();
    let registered: Vec<Option<Registered>> = (0..appearances.len())
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
        .map(|registered| registered.as_ref().map_or(0, |registered| registered.beginning))
        .collect();
    let poses = (registered.into_iter().zip(appearances))
        .map(|(registered, appearance)| {
            registered.map(|registered| {
                let found = Found::new(&lattice, &registered);
                let residual = registered.residuals.iter().map(|left| f64::from(*left)).sum::<f64>();
                RegisteredPose {
                    explained: Explained {
                        share: found.share,
                        least: [
                            own.to_source(lattice.points[found.least]),
                            appearance.to_source(registered.places[found.least]),
                        ],
                    },
                    residual: residual / registered.residuals.len().max(1) as f64,
                    appearance: Arc::clone(appearance),
                    places: registered.places,
                    frames: registered.frames,
                }
            })
        })
        .collect();
    let registration = Registration {
        reference: Arc::clone(own),
        lattice,
        poses,
    };
    Ok((registration, chosen))
}
