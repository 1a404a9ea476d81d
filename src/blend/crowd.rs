//! Many characters of one kind in one call, each with its own weights.
//!
//! Reading the factor is most of what a frame costs, and it is the same for all: [`TOGETHER`] characters are solved side by
//! side, and groups of them on all threads. Every character gets the same bytes as from [`RigidBlend::blend`].

use rayon::prelude::*;

use super::BlendError;
use super::rigid::{BlendReport, BlendScratch, RigidBlend};
use crate::math::Point;

/// Characters that are solved side by side: their eight right-hand sides fill a cache line.
const TOGETHER: usize = 4;

/// Working space for a crowd: one for each thread. See [`RigidBlend::crowd_scratch`].
#[derive(Debug, Clone, Default)]
pub struct CrowdScratch {
    threads: Vec<ThreadScratch>,
}

#[derive(Debug, Clone, Default)]
struct ThreadScratch {
    frame: BlendScratch,
    together: Vec<[f64; 2 * TOGETHER]>,
}

impl RigidBlend {
    /// Working space for [`Self::blend_crowd`].
    #[must_use]
    pub fn crowd_scratch(&self) -> CrowdScratch {
        CrowdScratch::default()
    }

    /// Blends many characters: `weights` are #characters x #poses, `positions` #characters x #vertices, both one character
    /// after the other. Runs on all threads of rayon's pool.
    ///
    /// The report is that of all frames together: inverted triangles are added up.
    ///
    /// # Errors
    /// As [`Self::blend`], for the first character with an error; and if the lengths of the lists do not fit.
    pub fn blend_crowd(
        &self,
        weights: &[f64],
        scratch: &mut CrowdScratch,
        positions: &mut [Point],
    ) -> Result<BlendReport, BlendError> {
        let characters = weights.len() / self.pose_count();
        let expected = characters * self.vertex_count();
        if characters * self.pose_count() != weights.len() || positions.len() != expected {
            return Err(BlendError::WrongCount {
                what: "weights or positions",
                found: positions.len(),
                poses: self.pose_count(),
            });
        }
        if characters == 0 {
            return Ok(BlendReport::default());
        }
        let threads = rayon::current_num_threads();
        scratch.threads.resize_with(threads, || ThreadScratch {
            frame: self.scratch(),
            together: Vec::new(),
        });
        // Whole groups for each thread, so that the grouping does not depend on how many threads there are.
        let share = characters.div_ceil(TOGETHER).div_ceil(threads) * TOGETHER;
        positions
            .par_chunks_mut(share * self.vertex_count())
            .zip(weights.par_chunks(share * self.pose_count()))
            .zip(&mut scratch.threads)
            .map(|((positions, weights), scratch)| {
                let groups = positions
                    .chunks_mut(TOGETHER * self.vertex_count())
                    .zip(weights.chunks(TOGETHER * self.pose_count()));
                let mut total = BlendReport::default();
                for (positions, weights) in groups {
                    total = total.and(self.blend_group(weights, scratch, positions)?);
                }
                Ok(total)
            })
            // Rayon joins neighbours in order, so the first error stays the first.
            .reduce(|| Ok(BlendReport::default()), |a, b| Ok(a?.and(b?)))
    }

    fn blend_group(
        &self,
        weights: &[f64],
        scratch: &mut ThreadScratch,
        positions: &mut [Point],
    ) -> Result<BlendReport, BlendError> {
        let characters = || weights.chunks(self.pose_count()).enumerate();
        let ThreadScratch { frame, together } = scratch;
        together.clear();
        together.resize(self.system().right_len(), [0.0; 2 * TOGETHER]);
        for (k, weights) in characters() {
            self.normalise(weights, frame)?;
            self.assemble(&[], frame, together, k);
        }
        self.system().solve(together)?;
        let mut total = BlendReport::default();
        for ((k, weights), positions) in characters().zip(positions.chunks_mut(self.vertex_count())) {
            for (position, solved) in positions.iter_mut().zip(self.system().solved(together)) {
                *position = Point::new(solved[2 * k], solved[2 * k + 1]);
            }
            self.normalise(weights, frame)?;
            total = total.and(self.finish(&[], frame, positions)?);
        }
        Ok(total)
    }
}
