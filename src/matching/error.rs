//! Why outlines cannot be matched.

use super::CorrespondenceError;
use crate::outline::RingError;

/// Why outlines cannot be matched. Poses and landmarks are numbered as given.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MatchError {
    /// There is no outline.
    #[error("there is no outline to match")]
    NoPose,
    /// The reference is not one of the poses.
    #[error("pose {reference} is asked to be the reference, but there are only {count} poses")]
    NoSuchReference {
        /// The number asked for.
        reference: usize,
        /// How many poses there are.
        count: usize,
    },
    /// A landmark has more or fewer entries than there are poses.
    #[error("landmark '{landmark}' has {found} entries for {expected} poses; give one for each pose, absent or not")]
    LandmarkEntries {
        /// Its name.
        landmark: String,
        /// How many entries it has.
        found: usize,
        /// How many poses there are.
        expected: usize,
    },
    /// A landmark's parameter is not finite.
    #[error("landmark '{landmark}' has no finite place on pose {pose}")]
    LandmarkPlace {
        /// Its name.
        landmark: String,
        /// Which pose.
        pose: usize,
    },
    /// Two landmarks are at the same place of an outline.
    #[error("landmarks '{first}' and '{second}' are at the same place of pose {pose}'s outline; move one or remove it")]
    LandmarksCoincide {
        /// A name.
        first: String,
        /// The other name.
        second: String,
        /// Which pose.
        pose: usize,
    },
    /// Along two outlines the landmarks do not come in the same order.
    #[error(
        "landmark '{landmark}' makes the order impossible: going around pose {pose} the landmarks come in another order than around pose {other}; check where it is on both, or whether one of the drawings faces the other way"
    )]
    LandmarkOrder {
        /// The landmark without which the order would be possible, or the first one out of order.
        landmark: String,
        /// Which pose.
        pose: usize,
        /// The pose it is compared with.
        other: usize,
    },
    /// An outline is so thin or small that nothing can be measured on it.
    #[error("pose {pose} cannot be matched: {source}")]
    Degenerate {
        /// Which pose.
        pose: usize,
        /// What is wrong with it.
        source: RingError,
    },
    /// The outlines differ so much in their proportions between landmarks that no match with bounded stretch exists.
    #[error("no match of pose {pose} passes through its landmarks; check their places, or add more of them")]
    NoMatch {
        /// Which pose.
        pose: usize,
    },
    /// The matched parameters are no correspondence.
    #[error(transparent)]
    Correspondence(#[from] CorrespondenceError),
}
