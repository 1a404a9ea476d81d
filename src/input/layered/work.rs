//! How much is done for one picture: a few bytes of a file can name the same pixels a thousand times.

use super::LayeredError;
use crate::input::decode::LARGEST_COUNT;

/// How many times the pixels of the largest picture are decoded or composed at most.
const MOST_LAYERS_OF_LARGEST: u64 = 128;

/// Pixels that may still be decoded or composed.
#[derive(Debug)]
pub(super) struct Work {
    left: u64,
}

impl Default for Work {
    fn default() -> Self {
        Self {
            left: MOST_LAYERS_OF_LARGEST * LARGEST_COUNT,
        }
    }
}

impl Work {
    /// Some pixels are about to be decoded or composed.
    ///
    /// # Errors
    /// If that is more than is left.
    pub(super) fn spend(&mut self, pixels: u64) -> Result<(), LayeredError> {
        self.left = self.left.checked_sub(pixels).ok_or(LayeredError::TooMuchWork)?;
        Ok(())
    }
}
