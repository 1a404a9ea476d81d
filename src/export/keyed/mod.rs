//! A drawing over time, sampled: what the writers of animated vector formats take.
//!
//! Frames of one drawing at even times -> one tree in which every number is the list of its values. Where values are linear
//! between keys, the samples lie closer than the frames: what is between two frames is then held to the same error as the
//! frames are. Where keys are held ([`KeyInterpolation::Held`]), frames are all there is to sample.
//!
//! - All frames have the same nodes with equally many curves; a frame that has not is refused.
//! - Pictures are kept for whole frames only, cut to what is drawn and each but once, as PNG.
//! - A node that cannot be seen at some samples may be anywhere there: it is put on the straight line between where it
//!   is seen last and where it is seen next, or stays where it is seen last if keys are held, so that no keys are spent on it.
//!
//! Memory: two numbers a control point and sample, and the files of the pictures.

mod planner;
mod tree;

pub(super) use planner::Planner;
pub(super) use tree::{GradientTrack, Group, Node, PaintTrack, Picture, Piece, Shape, Siblings, StrokeTrack, runs};

use super::Repetition;
use crate::render::VectorFrame;
use tree::Pictures;

/// When the samples of an animation are taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SampleTiming {
    /// Frames a second.
    pub fps: f64,
    /// How many frames there are.
    pub frame_count: usize,
    /// How many samples are taken from one frame to the next, at least 1.
    pub samples_a_frame: usize,
    /// Whether the first frame follows the last one.
    pub repetition: Repetition,
}

impl SampleTiming {
    /// How many samples there are: of a loop up to where it starts over, else up to the last frame.
    #[must_use]
    pub fn sample_count(&self) -> usize {
        let steps = match self.repetition {
            Repetition::Once => self.frame_count.saturating_sub(1),
            Repetition::Forever => self.frame_count,
        };
        steps * self.samples_a_frame.max(1) + 1
    }

    /// The time of a sample, in frames from the first one.
    #[must_use]
    pub fn frame_of(&self, sample: usize) -> f64 {
        sample as f64 / self.samples_a_frame.max(1) as f64
    }
}

/// How closely keys follow the samples.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct KeyOptions {
    /// How far a control point may be from where it belongs, at any sample, in pixels. Default: 0.25, which no eye sees.
    pub max_error_px: f64,
    /// How far a colour or an opacity may be from what it should be, of 255. Default: 1.
    pub max_error_steps: f64,
    /// What is shown between keys. Default: linear.
    pub interpolation: KeyInterpolation,
}

/// What is shown between two keys.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum KeyInterpolation {
    /// Values are linear in time.
    #[default]
    Linear,
    /// Every key is held until the next one, as in animation on twos: a sample that shows what the one before it shows costs nothing.
    Held,
}

impl Default for KeyOptions {
    fn default() -> Self {
        Self {
            max_error_px: 0.25,
            max_error_steps: 1.0,
            interpolation: KeyInterpolation::default(),
        }
    }
}

/// What keys were written, and what they cost.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct KeyReport {
    /// How many keys all animated attributes have together.
    pub keys: usize,
    /// The largest distance of a control point from where it belongs, over all samples, in pixels.
    pub worst_px: f64,
    /// The largest difference of a colour or opacity, of 255.
    pub worst_step: f64,
    /// What the format cannot hold, each once.
    pub approximations: Vec<Approximation>,
}

/// What a format cannot hold and how it is drawn instead; shown, it is a sentence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Approximation {
    /// A gradient that repeats or is reflected ends in its last colour.
    RepeatedGradient,
    /// An elliptic gradient is round, with the same area.
    EllipticGradient,
}

impl std::fmt::Display for Approximation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::RepeatedGradient => "Lottie has no repeated gradients; they end in their last colour",
            Self::EllipticGradient => "Lottie has no elliptic gradients; they are drawn round, with the same area",
        })
    }
}

/// Why frames are not an animation.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum KeyedError {
    /// A frame is built differently from the first one.
    #[error(
        "sample {sample}: {what} of '{id}' differs from the first sample's; all frames of an animation are built alike"
    )]
    Unlike {
        /// Which sample, counted from 0.
        sample: usize,
        /// The node.
        id: String,
        /// What differs.
        what: &'static str,
    },
    /// Not as many frames as the timing wants.
    #[error("{given} samples are given, but the timing has {wanted}")]
    Count {
        /// How many there are.
        given: usize,
        /// How many are wanted.
        wanted: usize,
    },
    /// A picture cannot be encoded.
    #[error("the picture '{id}' cannot be written: {reason}")]
    Picture {
        /// The node.
        id: String,
        /// The encoder's reason.
        reason: String,
    },
}

/// A sampled drawing.
///
/// ```
/// use inbetween::export::{KeyOptions, KeyedVector, Repetition, SampleTiming};
/// use inbetween::math::Point;
/// use inbetween::render::drawing::{Fill, FillRule, Paint, Subpath, VectorFrame, VectorNode, VectorShape};
///
/// let timing = SampleTiming { fps: 12.0, frame_count: 4, samples_a_frame: 2, repetition: Repetition::Once };
/// let frames = (0..timing.sample_count()).map(|sample| {
///     let x = 10.0 * timing.frame_of(sample);
///     let line = |a: Point, b: Point| [a + (b - a) / 3.0, b - (b - a) / 3.0, b];
///     let corners = [[0.0, 0.0], [8.0, 0.0], [0.0, 8.0]].map(|[dx, dy]| Point::new(x + dx, 4.0 + dy));
///     let triangle = VectorShape {
///         id: "triangle".to_owned(),
///         subpaths: vec![Subpath {
///             start: corners[0],
///             cubics: (0..3).map(|k| line(corners[k], corners[(k + 1) % 3])).collect(),
///             is_closed: true,
///         }],
///         fill: Some(Fill { paint: Paint::Solid([0.8, 0.1, 0.1, 1.0]), rule: FillRule::NonZero }),
///         stroke: None,
///         opacity: 1.0,
///     };
///     VectorFrame { size: [48, 16], background: None, nodes: vec![VectorNode::Shape(Box::new(triangle))] }
/// });
/// let keyed = KeyedVector::new(timing, frames)?;
/// let (text, report) = keyed.to_smil(&KeyOptions::default())?;
/// assert!(text.contains("<animate attributeName=\"d\""));
/// assert_eq!(report.keys, 2);
/// # Ok::<(), inbetween::export::KeyedError>(())
/// ```
#[derive(Debug)]
pub struct KeyedVector {
    pub(super) timing: SampleTiming,
    pub(super) size: [usize; 2],
    pub(super) background: Option<[u8; 4]>,
    pub(super) siblings: Siblings,
    pub(super) pictures: Pictures,
    samples: usize,
}

impl KeyedVector {
    /// A drawing from all samples of its timing, in order.
    ///
    /// # Errors
    /// [`KeyedError`] if a frame is not like the first one, or there are too few or too many.
    pub fn new(timing: SampleTiming, frames: impl IntoIterator<Item = VectorFrame>) -> Result<Self, KeyedError> {
        let mut keyed = Self::empty(timing);
        for frame in frames {
            keyed.add(&frame)?;
        }
        Ok(keyed)
    }

    /// A drawing without samples, for [`KeyedVector::add`].
    #[must_use]
    pub fn empty(timing: SampleTiming) -> Self {
        Self {
            timing,
            size: [0, 0],
            background: None,
            siblings: Siblings::default(),
            pictures: Pictures::default(),
            samples: 0,
        }
    }

    /// Takes the next sample.
    ///
    /// # Errors
    /// [`KeyedError`] if it is not like the first one.
    pub fn add(&mut self, frame: &VectorFrame) -> Result<(), KeyedError> {
        let sample = self.samples;
        if sample == 0 {
            self.size = frame.size;
            self.background = frame.background;
            self.siblings = Siblings::like(&frame.nodes);
        }
        if self.size != frame.size {
            return Err(KeyedError::Unlike {
                sample,
                id: "the frame".to_owned(),
                what: "the size",
            });
        }
        let step = self.timing.samples_a_frame.max(1);
        let is_frame = sample.is_multiple_of(step) && sample / step < self.timing.frame_count;
        self.siblings
            .add(&frame.nodes, is_frame, &mut self.pictures)
            .map_err(|fault| fault.at(sample))?;
        self.samples += 1;
        Ok(())
    }

    /// The number of samples, if it is the timing's.
    pub(super) fn complete(&self) -> Result<usize, KeyedError> {
        let wanted = self.timing.sample_count();
        if self.samples == wanted {
            Ok(wanted)
        } else {
            Err(KeyedError::Count {
                given: self.samples,
                wanted,
            })
        }
    }
}

#[cfg(test)]
pub(super) mod tests;
