//! The weights that a pose space asks for.

use super::PipelineError;
use super::spec::WeightOptions;
use crate::weights::{BiharmonicWeights, RbfWeights, WeightError, WeightProvider};

/// How far the sum of given weights may be from 1.
const SUM_TOLERANCE: f64 = 1e-6;

/// Weights whose poses can be moved, which takes a small part of the time that new ones would.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum EditableWeights {
    /// Biharmonic weights.
    Biharmonic(Box<BiharmonicWeights>),
    /// Radial weights.
    Rbf(Box<RbfWeights>),
}

impl EditableWeights {
    /// Moves a pose. On an error nothing has changed.
    ///
    /// # Errors
    /// [`WeightError`] as for new weights.
    pub fn move_pose(&mut self, pose: usize, at: &[f64]) -> Result<(), WeightError> {
        match self {
            Self::Biharmonic(weights) => weights.move_pose(pose, at).map(drop),
            Self::Rbf(weights) => weights.move_pose(pose, at),
        }
    }

    fn provider(&self) -> &dyn WeightProvider {
        match self {
            Self::Biharmonic(weights) => weights.as_ref(),
            Self::Rbf(weights) => weights.as_ref(),
        }
    }
}

impl WeightProvider for EditableWeights {
    fn pose_count(&self) -> usize {
        self.provider().pose_count()
    }

    fn dimension(&self) -> usize {
        self.provider().dimension()
    }

    fn weights(&self, at: &[f64], weights: &mut Vec<f64>) -> Result<(), WeightError> {
        self.provider().weights(at, weights)
    }

    fn weights_of_many(&self, places: &[f64], weights: &mut Vec<f64>) -> Result<(), WeightError> {
        self.provider().weights_of_many(places, weights)
    }
}

/// The weights of poses at `places`, which are called `names` in messages.
///
/// # Errors
/// [`PipelineError::Space`], naming poses, if the places allow no weights.
pub fn editable_weights(
    names: &[String],
    places: &[Vec<f64>],
    options: &WeightOptions,
) -> Result<EditableWeights, PipelineError> {
    let built: Result<EditableWeights, WeightError> = match options {
        WeightOptions::Biharmonic(options) => {
            BiharmonicWeights::new(places, options).map(|w| EditableWeights::Biharmonic(Box::new(w)))
        }
        WeightOptions::Rbf(options) => RbfWeights::new(places, options).map(|w| EditableWeights::Rbf(Box::new(w))),
    };
    let name = |pose: usize| match names.get(pose) {
        Some(pose) => format!("'{pose}'"),
        None => format!("pseudo-pose {}", pose - names.len()),
    };
    built.map_err(|source| PipelineError::Space {
        message: source.naming(name),
        source,
    })
}

/// Weights given by hand, made to sum to exactly 1.
///
/// # Errors
/// [`PipelineError::BadWeights`] if there is not one a pose, one is not finite, or the sum is off by more than 1e-6.
pub fn checked_weights(given: &[f64], names: &[String]) -> Result<Vec<f64>, PipelineError> {
    if given.len() != names.len() {
        let poses = names.iter().map(|n| format!("'{n}'")).collect::<Vec<_>>().join(", ");
        return Err(PipelineError::BadWeights(format!(
            "{} weights for {} poses; give one for each of {poses}, in this order",
            given.len(),
            names.len()
        )));
    }
    if let Some(bad) = given.iter().position(|w| !w.is_finite()) {
        return Err(PipelineError::BadWeights(format!(
            "the weight of pose '{}' is {}; weights must be finite numbers",
            names[bad], given[bad]
        )));
    }
    let sum: f64 = given.iter().sum();
    // The sum of finite weights may still overflow.
    if !sum.is_finite() || (sum - 1.0).abs() > SUM_TOLERANCE {
        return Err(PipelineError::BadWeights(format!(
            "the weights sum to {sum}, but must sum to 1 (within {SUM_TOLERANCE:e}); divide each by {sum}"
        )));
    }
    Ok(given.iter().map(|w| w / sum).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_must_fit_and_sum_to_one() {
        let names = ["a".to_owned(), "b".to_owned()];
        assert_eq!(checked_weights(&[1.5, -0.5], &names).expect("they do"), vec![1.5, -0.5]);
        let nearly = checked_weights(&[0.5, 0.5000005], &names).expect("nearly");
        assert!((nearly.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        for bad in [&[0.5, 0.6][..], &[1.0], &[f64::NAN, 1.0], &[f64::MAX, f64::MAX]] {
            assert!(checked_weights(bad, &names).is_err(), "{bad:?}");
        }
    }
}
