//! Boundary matching (NWM 3.1): which point of every outline corresponds to which.
//!
//! [`match_rings`] takes N closed curves and landmarks and returns a [`Correspondence`].
//!
//! - `curve`: a ring with place and size taken out; turning over several windows.
//! - `feature`: salient points in curvature scale space, which explain a match.
//! - `elastic`, `start`: dynamic programming over turning and stretch, over all cyclic starts.
//! - `coarse`, `pair`, `thin_plate`, `monotone`: from coarse candidates to the match of a pose to the reference.
//! - `n_way`, `landmark`: all poses, guided by landmarks.
//! - `openings`: which holes all outlines have; `ties`: which of them landmarks on their rims say are one.

mod candidates;
mod coarse;
mod correspondence;
mod curve;
mod drawn;
mod elastic;
mod error;
mod feature;
mod frame;
mod landmark;
mod monotone;
mod n_way;
mod openings;
mod pair;
mod reflection;
mod start;
mod thin_plate;
mod ties;

pub use candidates::RingCandidates;
pub use correspondence::{Correspondence, CorrespondenceError};
pub use error::MatchError;
pub use feature::SalientPoint;
pub use landmark::Landmark;
pub(crate) use n_way::match_rings_beside;
pub use n_way::{MatchOptions, MatchReport, MirrorHints, PoseMatch, RingMatch, match_rings};
pub use openings::shared_holes;
pub use ties::{HoleTieError, HoleTies};
