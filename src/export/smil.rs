//! Animated SVG (SMIL): a document that plays in a browser without a script.
//!
//! Attributes that change have an `<animate>` child with keys of their own, linear between them or held; every key of a path has the
//! same absolute `M`, `C` and `Z` commands. What does not change has none. A loop repeats for ever and its last key is its
//! first; anything else stops at its last frame.
//!
//! - Siblings whose order changes are defined once, used once an order, and the orders shown in turn by a discrete
//!   `display`.
//! - Pictures have one `<image>` a frame, equal ones shared, shown in turn: as large as a PNG sequence and a third more for
//!   its encoding as text.
//! - The map of a radial gradient is animated as shift, turn, shear and scale, since SVG has no animated matrix.

use super::svg::{Element, document, number};
use super::{KeyInterpolation, KeyOptions, KeyReport, KeyedError, KeyedVector, Repetition, SampleTiming};

/// Decimals of lengths: a hundredth of a pixel is far below the error of the keys, and the file is mostly lengths.
const DECIMALS: usize = 2;
/// Decimals of times, as fractions of the whole: a tenth of a millisecond in a film of a minute.
const TIME_DECIMALS: usize = 6;

impl KeyedVector {
    /// The drawing as an animated SVG document. The same samples give the same text.
    ///
    /// # Errors
    /// [`KeyedError`] if samples are missing.
    pub fn to_smil(&self, options: &KeyOptions) -> Result<(String, KeyReport), KeyedError> {
        self.complete()?;
        Ok(document(self, options, DECIMALS))
    }
}

/// Turns samples into times.
#[derive(Debug, Clone, Copy)]
pub(super) struct Clock {
    last: usize,
    duration_s: f64,
    repetition: Repetition,
    interpolation: KeyInterpolation,
}

impl Clock {
    pub(super) fn new(timing: &SampleTiming, interpolation: KeyInterpolation) -> Self {
        let last = timing.sample_count() - 1;
        Self {
            last,
            duration_s: timing.frame_of(last) / timing.fps,
            repetition: timing.repetition,
            interpolation,
        }
    }

    /// An attribute with keys at the samples `keys`; a single one stands for all time.
    pub(super) fn animate(
        &self,
        element: &mut Element,
        name: &'static str,
        keys: &[usize],
        value: impl Fn(usize) -> String,
    ) {
        let values: Vec<String> = keys.iter().map(|key| value(*key)).collect();
        let Some(first) = values.first() else { return };
        element.set(name, first.clone());
        // Where only a part of what has the same keys changes.
        if values.iter().all(|value| value == first) {
            return;
        }
        let animation = Element::new("animate").with("attributeName", name);
        element.push(self.keyed(animation, &values, keys));
    }

    /// A part of a gradient's map with keys at the samples `keys`, after the parts before it.
    pub(super) fn transform(
        &self,
        element: &mut Element,
        kind: &'static str,
        keys: &[usize],
        value: impl Fn(usize) -> String,
    ) {
        let values: Vec<String> = keys.iter().map(|key| value(*key)).collect();
        let animation = Element::new("animateTransform")
            .with("attributeName", "gradientTransform")
            .with("type", kind)
            .with("additive", "sum");
        element.push(self.keyed(animation, &values, keys));
    }

    /// An attribute that jumps: the samples from which it has a value, and the values.
    pub(super) fn switch(&self, element: &mut Element, name: &'static str, changes: &[(usize, String)]) {
        let Some((_, first)) = changes.first() else { return };
        element.set(name, first.clone());
        if changes.len() < 2 || self.last == 0 {
            return;
        }
        let times: Vec<f64> = changes.iter().map(|(sample, _)| self.jump(*sample)).collect();
        let values: Vec<String> = changes.iter().map(|(_, value)| value.clone()).collect();
        let animation = Element::new("animate")
            .with("attributeName", name)
            .with("calcMode", "discrete");
        element.push(self.timed(animation, &values, &times));
    }

    /// An animation between keys as they are interpolated.
    fn keyed(&self, animation: Element, values: &[String], keys: &[usize]) -> Element {
        match self.interpolation {
            KeyInterpolation::Linear => {
                let times: Vec<f64> = keys.iter().map(|key| self.share(*key)).collect();
                self.timed(animation, values, &times)
            }
            KeyInterpolation::Held => {
                let times: Vec<f64> = keys.iter().map(|key| self.jump(*key)).collect();
                self.timed(animation.with("calcMode", "discrete"), values, &times)
            }
        }
    }

    /// When a value jumps to that of a sample: the sample's time rounded down, and one decimal less, so not a moment late. Players
    /// round the duration to microseconds and these times to single precision, and a time that meets a frame's own exactly
    /// may come out on either side of it.
    fn jump(&self, sample: usize) -> f64 {
        let whole = 10_f64.powi(TIME_DECIMALS as i32);
        ((self.share(sample) * whole).floor() - 1.0).max(0.0) / whole
    }

    fn share(&self, sample: usize) -> f64 {
        sample as f64 / self.last.max(1) as f64
    }

    fn timed(&self, mut animation: Element, values: &[String], times: &[f64]) -> Element {
        let times: Vec<String> = times.iter().map(|time| number(*time, TIME_DECIMALS)).collect();
        animation.set("dur", format!("{}s", number(self.duration_s, TIME_DECIMALS)));
        match self.repetition {
            Repetition::Forever => animation.set("repeatCount", "indefinite"),
            Repetition::Once => animation.set("fill", "freeze"),
        }
        animation.set("keyTimes", times.join(";"));
        animation.set("values", values.join(";"));
        animation
    }
}
