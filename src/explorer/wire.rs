//! Binary answers.

use inbetween::math::Point;

/// Little-endian numbers of four bytes.
pub(super) struct Words<'a>(pub(super) &'a mut Vec<u8>);

impl Words<'_> {
    pub(super) fn u32(&mut self, number: usize) {
        self.0
            .extend_from_slice(&u32::try_from(number).unwrap_or(u32::MAX).to_le_bytes());
    }

    pub(super) fn f32(&mut self, number: f64) {
        self.0.extend_from_slice(&(number as f32).to_le_bytes());
    }

    pub(super) fn f32s(&mut self, numbers: &[f64]) {
        for number in numbers {
            self.f32(*number);
        }
    }

    pub(super) fn points(&mut self, points: &[Point]) {
        self.0.reserve(8 * points.len());
        for point in points {
            self.f32(point.x);
            self.f32(point.y);
        }
    }

    pub(super) fn bits(&mut self, bits: impl ExactSizeIterator<Item = bool>) {
        let mut words = vec![0u32; bits.len().div_ceil(32)];
        for (k, bit) in bits.enumerate() {
            words[k / 32] |= u32::from(bit) << (k % 32);
        }
        for word in words {
            self.0.extend_from_slice(&word.to_le_bytes());
        }
    }
}
