//! A finished picture.

use crate::math::vectorised;

/// A premultiplied RGBA picture.
#[derive(Clone, PartialEq, Eq)]
pub struct Frame {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Row by row, red, green, blue, alpha, colours multiplied by alpha; #rows x #columns entries.
    pub pixels: Vec<[u8; 4]>,
}

impl Frame {
    /// A picture of one colour: red, green, blue, alpha, not premultiplied.
    #[must_use]
    pub fn filled(width: usize, height: usize, colour: [u8; 4]) -> Self {
        Self {
            width,
            height,
            pixels: vec![premultiplied(colour); width * height],
        }
    }

    /// The pixels with colours not multiplied by alpha, as most file formats store them.
    #[must_use]
    pub fn straight(&self) -> Vec<u8> {
        self.pixels.iter().flat_map(|pixel| straight(*pixel)).collect()
    }

    /// Puts the picture in front of a colour: red, green, blue, alpha, not premultiplied.
    pub fn put_before(&mut self, colour: [u8; 4]) {
        let back = premultiplied(colour);
        for pixel in &mut self.pixels {
            let through = 255 - u32::from(pixel[3]);
            for (front, behind) in pixel.iter_mut().zip(back) {
                *front = (u32::from(*front) + (u32::from(behind) * through + 127) / 255).min(255) as u8;
            }
        }
    }

    /// Puts another picture of the same size in front, as strong as `opacity` says: 0 changes nothing, at 1 opaque pixels of
    /// `front` replace what was there. Where `front` is larger or smaller, the common part counts: both begin at the
    /// upper left corner.
    pub fn put_over(&mut self, front: &Frame, opacity: f64) {
        // Rounded once; NaN shows nothing.
        let strength = (opacity.clamp(0.0, 1.0) * f64::from(WHOLE)).round() as u32;
        if strength == 0 || self.width == 0 || front.width == 0 {
            return;
        }
        let rows = self.pixels.chunks_exact_mut(self.width);
        for (row, over) in rows.zip(front.pixels.chunks_exact(front.width)) {
            vectorised(
                #[inline(always)]
                || {
                    for (pixel, over) in row.iter_mut().zip(over) {
                        // Each of at most WHOLE * 255; rounded together, so that colours stay below alpha.
                        let through = WHOLE * 255 - u32::from(over[3]) * strength;
                        for (behind, front) in pixel.iter_mut().zip(over) {
                            let sum = u32::from(*front) * strength * 255 + u32::from(*behind) * through;
                            *behind = ((sum + WHOLE * 255 / 2) / (WHOLE * 255)).min(255) as u8;
                        }
                    }
                },
            );
        }
    }

    /// Mixes in another picture of the same size, which is all that is left at a `share` of 1. Where `other` is larger or smaller, the common part counts.
    pub(super) fn mix(&mut self, other: &Frame, share: f64) {
        let share = (share.clamp(0.0, 1.0) * f64::from(WHOLE)).round() as u32;
        if self.width == 0 || other.width == 0 {
            return;
        }
        let rows = self.pixels.chunks_exact_mut(self.width);
        for (row, other) in rows.zip(other.pixels.chunks_exact(other.width)) {
            for (own, other) in row.iter_mut().flatten().zip(other.iter().flatten()) {
                let sum = u32::from(*own) * (WHOLE - share) + u32::from(*other) * share;
                *own = ((sum + WHOLE / 2) / WHOLE) as u8;
            }
        }
    }
}

/// A whole opacity: with it, sums of two channels times 255 fit 32 bits.
const WHOLE: u32 = 1 << 14;

impl std::fmt::Debug for Frame {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Frame")
            .field("width", &self.width)
            .field("height", &self.height)
            .finish_non_exhaustive()
    }
}

/// A pixel whose colours are no longer multiplied by its alpha; black where it is clear.
pub(super) fn straight([r, g, b, a]: [u8; 4]) -> [u8; 4] {
    let divided = |c: u8| match a {
        0 => 0,
        255 => c,
        a => ((u32::from(c) * 255 + u32::from(a) / 2) / u32::from(a)).min(255) as u8,
    };
    [divided(r), divided(g), divided(b), a]
}

fn premultiplied([r, g, b, a]: [u8; 4]) -> [u8; 4] {
    let times = |c: u8| ((u32::from(c) * u32::from(a) + 127) / 255) as u8;
    [times(r), times(g), times(b), a]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn straight_undoes_premultiplied() {
        let frame = Frame::filled(1, 1, [200, 100, 0, 128]);
        assert_eq!(frame.pixels[0], [100, 50, 0, 128]);
        assert_eq!(frame.straight(), [199, 100, 0, 128]);
        assert_eq!(Frame::filled(1, 1, [9, 9, 9, 0]).straight(), [0, 0, 0, 0]);
    }

    #[test]
    fn a_half_clear_pixel_lets_half_through() {
        let mut frame = Frame::filled(1, 1, [255, 0, 0, 128]);
        frame.put_before([255, 255, 255, 255]);
        assert_eq!(frame.pixels[0], [255, 127, 127, 255]);
    }

    #[test]
    fn opacity_0_changes_nothing_and_1_shows_all_of_the_front() {
        let colours: Vec<[u8; 4]> = (0..=255).map(|a| [a, a / 2, 0, a]).collect();
        let picture = |pixels: &[[u8; 4]]| Frame {
            width: 16,
            height: 16,
            pixels: pixels.to_vec(),
        };
        let back = picture(&colours);
        for opacity in [0.0, -1.0, f64::NAN] {
            let mut frame = back.clone();
            frame.put_over(&Frame::filled(16, 16, [1, 2, 3, 255]), opacity);
            assert_eq!(frame, back);
        }
        let opaque: Vec<[u8; 4]> = (0..=255).map(|c| [c, 255 - c, 7, 255]).collect();
        for opacity in [1.0, 3.0] {
            let mut frame = back.clone();
            frame.put_over(&picture(&opaque), opacity);
            assert_eq!(frame.pixels, opaque);
            // Nothing in front, and nothing behind.
            frame.put_over(&Frame::filled(16, 16, [0; 4]), opacity);
            assert_eq!(frame.pixels, opaque);
            let mut clear = Frame::filled(16, 16, [0; 4]);
            clear.put_over(&back, opacity);
            assert_eq!(clear, back);
        }
    }

    #[test]
    fn half_a_front_is_half_there_and_pictures_need_not_be_equally_large() {
        let mut frame = Frame::filled(3, 2, [0, 0, 255, 255]);
        frame.put_over(&Frame::filled(1, 5, [255, 0, 0, 255]), 0.5);
        let (mixed, blue) = ([128, 0, 128, 255], [0, 0, 255, 255]);
        assert_eq!(frame.pixels, [mixed, blue, blue, mixed, blue, blue]);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn over_agrees_with_the_formula_and_stays_premultiplied(
            behind in prop::array::uniform4(0u8..),
            front in prop::array::uniform4(0u8..),
            opacity in 0.0..1.0f64,
        ) {
            let legal = |[r, g, b, a]: [u8; 4]| [r.min(a), g.min(a), b.min(a), a];
            let one = |pixel| Frame { width: 1, height: 1, pixels: vec![legal(pixel)] };
            let mut frame = one(behind);
            frame.put_over(&one(front), opacity);
            let found = frame.pixels[0];
            let through = 1.0 - f64::from(legal(front)[3]) / 255.0 * opacity;
            for k in 0..4 {
                let expected = f64::from(legal(front)[k]) * opacity + f64::from(legal(behind)[k]) * through;
                prop_assert!((f64::from(found[k]) - expected).abs() < 0.55, "{found:?}: {expected}");
                prop_assert!(found[k] <= found[3]);
            }
        }
    }
}
