//! Wishes beyond the energy, which vary over the plane: weights pulled towards values, or kept flat, in a region.
//!
//! Source: NWM 4.1 names further least-squares objectives as an extension; these are its natural ones.

use std::fmt;
use std::sync::Arc;

use super::{WeightError, check_place};
use crate::math::Point;

/// How strongly something counts at each place, from 0 to 1 as a rule.
pub(super) type Field<'a> = &'a dyn Fn(Point) -> f64;

/// A part of the pose space with soft borders: how much each place belongs to it.
///
/// ```
/// use inbetween::weights::Region;
/// let disc = Region::disc([1.0, 0.0], 0.5);
/// assert_eq!((disc.at([1.0, 0.0]), disc.at([2.0, 0.0])), (1.0, 0.0));
/// let left = Region::new(|[x, _]| if x < 0.0 { 1.0 } else { 0.0 });
/// assert_eq!(left.at([-3.0, 1.0]), 1.0);
/// ```
#[derive(Clone)]
pub struct Region {
    share: Arc<dyn Fn([f64; 2]) -> f64 + Send + Sync>,
}

impl Region {
    /// The region with `share` at each place, in the pose space's own coordinates. It must give the same for the same place;
    /// what is negative or NaN counts as 0.
    pub fn new(share: impl Fn([f64; 2]) -> f64 + Send + Sync + 'static) -> Self {
        Self { share: Arc::new(share) }
    }

    /// A disc: 1 at its centre, smoothly down to 0 at its rim.
    #[must_use]
    pub fn disc(centre: [f64; 2], radius: f64) -> Self {
        Self::new(move |place| {
            let away = (Point::from(place) - Point::from(centre)).norm() / radius;
            if away < 1.0 { (1.0 - away * away).powi(2) } else { 0.0 }
        })
    }

    /// The region's share at a place, not negative.
    #[must_use]
    pub fn at(&self, place: [f64; 2]) -> f64 {
        // NaN is not larger than 0 either.
        (self.share)(place).max(0.0)
    }
}

impl fmt::Debug for Region {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Region").finish_non_exhaustive()
    }
}

impl PartialEq for Region {
    /// Whether both are copies of one region.
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.share, &other.share)
    }
}

/// The weights that are wanted.
#[derive(Debug, Clone, PartialEq)]
pub enum Target {
    /// These, one a pose, with sum 1.
    Weights(Vec<f64>),
    /// Those found at this place without any [`Objective::Pull`], [`Objective::PullAt`] or pseudo-pose.
    FoundAt([f64; 2]),
}

/// A least-squares objective beside the smoothness of the weights. Lengths in a strength's unit are layout diagonals.
#[derive(Debug, Clone, PartialEq)]
pub enum Objective {
    /// Weights in a region are pulled towards a target: half the integral of `strength share |w - target|^2` is added to
    /// the energy. They come close to it where the region is wider than `strength^(-1/4)` diagonals: a tenth for 1e4.
    Pull {
        /// Where.
        region: Region,
        /// Towards what.
        target: Target,
        /// How strongly.
        strength: f64,
    },
    /// The weights at a place are pulled towards a target: `strength |w - target|^2 / 2` is added to the energy. A soft
    /// pseudo-pose; it tells from about 10, and is nearly exact from 1e4.
    PullAt {
        /// Where.
        at: [f64; 2],
        /// Towards what.
        target: Target,
        /// How strongly.
        strength: f64,
    },
    /// Weights change little within a region: `strength share` is added to `epsilon` there. They level out over
    /// `1 / (32 sqrt(strength))` diagonals: 1/32 for 1.
    Flatten {
        /// Where.
        region: Region,
        /// How strongly.
        strength: f64,
    },
}

impl Objective {
    /// Whether it asks for certain weights.
    pub(super) fn pulls(&self) -> bool {
        !matches!(self, Self::Flatten { .. })
    }

    pub(super) fn target_mut(&mut self) -> Option<&mut Target> {
        match self {
            Self::Pull { target, .. } | Self::PullAt { target, .. } => Some(target),
            Self::Flatten { .. } => None,
        }
    }

    pub(super) fn check(&self, pose_count: usize) -> Result<(), WeightError> {
        let (Self::Pull { strength, .. } | Self::PullAt { strength, .. } | Self::Flatten { strength, .. }) = self;
        if !(*strength > 0.0 && strength.is_finite()) {
            return Err(WeightError::BadOption {
                option: "the strength of an objective",
                value: *strength,
                must_be: "a positive number",
            });
        }
        if let Self::PullAt { at, .. } = self {
            check_place(at, 2)?;
        }
        match self {
            Self::Pull { target, .. } | Self::PullAt { target, .. } => target.check(pose_count),
            Self::Flatten { .. } => Ok(()),
        }
    }
}

/// How far the sum of wanted weights may be from 1.
const SUM_TOLERANCE: f64 = 1e-6;

impl Target {
    fn check(&self, pose_count: usize) -> Result<(), WeightError> {
        match self {
            Self::FoundAt(place) => check_place(place, 2),
            Self::Weights(weights) => {
                check_place(weights, pose_count)?;
                let sum: f64 = weights.iter().sum();
                if (sum - 1.0).abs() <= SUM_TOLERANCE {
                    Ok(())
                } else {
                    Err(WeightError::BadOption {
                        option: "the sum of an objective's weights",
                        value: sum,
                        must_be: "1",
                    })
                }
            }
        }
    }
}
