//! Loose parts of a figure, and which of them are one thing in all poses: the dot of an i, a head that floats, three drops.
//!
//! Parts of every pose, measured -> [`PartGroups`]: for each thing, the part that it is in each pose, if any.
//!
//! 1. [`PartShape`]: each part's place, size, colour, elongation and what landmarks lie on it, relative to the whole figure, so that the
//!    figure's own place and size do not count.
//! 2. Poses are taken in turn, the one with the most parts first; the parts of each are assigned to the things known so far at the least
//!    sum of costs (`assign`: the Hungarian method). A pair that costs more than leaving both alone stays apart, and what is left over is
//!    a new thing.
//! 3. Small bits that are in one pose only, and crowds of them, are dust ([`PartGroups::dust`]).
//! 4. [`origin`]: where a thing that a pose lacks grows from there.
//!
//! Cost: O(p^3) a pose for p parts, which are a dozen as a rule and at most [`MOST_PARTS`].
//!
//! Limits: parts are compared with the mean of those that were assigned before, so the order of poses with equally many parts may
//! count where several things are alike; a landmark on a part in two poses settles it.

mod assignment;
mod groups;
mod origin;
mod shape;

pub(crate) use groups::{PartGroups, group};
pub(crate) use origin::origin;
pub(crate) use shape::{PartShape, nearest_part};

/// The most loose parts of one drawing that are told apart: of more, the smallest are dust.
pub(crate) const MOST_PARTS: usize = 48;
