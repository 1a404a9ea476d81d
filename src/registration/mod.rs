//! Registration: where every place of the reference's figure is in every other pose, by what is drawn.
//!
//! [`Appearance`](crate::appearance::Appearance)s and outlines in correspondence -> [`Registration`].
//!
//! Source: Sykora, Dingliana and Collins 2009, "As-rigid-as-possible image registration for hand-drawn cartoon animations", which pushes the
//! vertices of a lattice to where their patch fits best and pulls the lattice back to a rigid form, coarse to fine.
//!
//! 1. A triangular lattice over the reference's figure (`lattice`), which keeps limbs apart that lie side by side.
//! 2. A beginning from outlines in correspondence (`outline`); of several, the one whose drawing is explained best.
//! 3. At each of five levels, coarse to fine: the patch of every vertex is compared with a window of the other drawing (`template`); the soft
//!    minimum of the costs is a displacement *and its covariance*, so that an edge holds across itself and lets slide along itself, and a
//!    uniform area lets go altogether. The lattice follows as rigidly as possible (`rigid`).
//!
//! 4. What is left at every vertex says how far the drawing is explained, and where least (`explained`).
//!
//! *Differences from the source*: patches are masked along the lattice, turn with it, and compare colour, ink and coverage with truncated
//! differences; displacements have covariances; the beginning comes from the outlines.
//!
//! Cost: O(#vertices x #candidates x #samples of a patch) a level, about 40 ms a pose. Limit: what moved by more than the widest window from
//! the beginning is not found.

mod beginning;
mod explained;
mod geodesic;
mod lattice;
mod levels;
mod limbs;
mod outline;
mod pair;
mod register;
mod rigid;
mod template;
mod textures;

pub use limbs::LimbProblem;
pub(crate) use limbs::{NamedLimb, Said, Seen};
pub(crate) use register::difference;
pub use register::{Explained, Pin, Registration, RegistrationError, RingPairs, register};
pub(crate) use register::{FoundLimbs, Overlap};
pub use textures::{Embedded, register_textures};
