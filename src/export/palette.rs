//! 255 colours for a whole animation.
//!
//! One palette for all frames, so that flat areas do not flicker from frame to frame. Few colours are kept exactly;
//! more are learnt by a self-organising map (NeuQuant, Dekker 1994; the crate `color_quant`), then each entry is moved
//! to the mean of the colours that it stands for.

use crate::render::Frame;

/// The most colours; one more index is kept for transparency.
const MOST_COLOURS: usize = 255;
/// Pixels with less alpha than this are clear: the format knows no half-clear ones.
const CLEAR_BELOW: u8 = 128;
/// Bits a channel of the lookup table.
const TABLE_BITS: u32 = 6;
/// How densely pixels are shown to the map: every third.
const LEARNING_STEP: i32 = 3;

/// A palette and a fast way to the nearest of its colours. Index 0 is transparent.
#[derive(Debug, Clone)]
pub struct Palette {
    colours: Vec<[u8; 3]>,
    /// Exact colours, sorted, with their index; empty if there are too many.
    exact: Vec<([u8; 3], u8)>,
    /// The index for each colour reduced to [`TABLE_BITS`] a channel.
    table: Vec<u8>,
}

impl Palette {
    /// The transparent index.
    pub const TRANSPARENT: u8 = 0;

    /// A palette for pictures like `frames`.
    #[must_use]
    pub fn for_frames(frames: &[Frame]) -> Self {
        let mut pixels: Vec<[u8; 3]> = Vec::new();
        for frame in frames {
            for pixel in frame.straight().chunks_exact(4).filter(|p| p[3] >= CLEAR_BELOW) {
                pixels.push([pixel[0], pixel[1], pixel[2]]);
            }
        }
        let mut distinct = pixels.clone();
        distinct.sort_unstable();
        distinct.dedup();
        if distinct.len() <= MOST_COLOURS {
            let exact = (1u8..).zip(&distinct).map(|(index, colour)| (*colour, index)).collect();
            let mut palette = Self {
                colours: distinct,
                exact,
                table: Vec::new(),
            };
            palette.fill_table();
            return palette;
        }
        let bytes: Vec<u8> = pixels.iter().flat_map(|[r, g, b]| [*r, *g, *b, 255]).collect();
        let learnt = color_quant::NeuQuant::new(LEARNING_STEP, MOST_COLOURS, &bytes);
        let mut palette = Self {
            colours: learnt
                .color_map_rgb()
                .chunks_exact(3)
                .map(|c| [c[0], c[1], c[2]])
                .collect(),
            exact: Vec::new(),
            table: Vec::new(),
        };
        palette.fill_table();
        palette.settle(&pixels);
        palette.fill_table();
        palette
    }

    /// Red, green, blue of each index, the transparent one included: at most 256 x 3 bytes.
    #[must_use]
    pub fn bytes(&self) -> Vec<u8> {
        [[0, 0, 0]].iter().chain(&self.colours).flatten().copied().collect()
    }

    /// The index of each pixel of `frame`.
    #[must_use]
    pub fn indices(&self, frame: &Frame) -> Vec<u8> {
        frame
            .straight()
            .chunks_exact(4)
            .map(|p| {
                if p[3] < CLEAR_BELOW {
                    Self::TRANSPARENT
                } else {
                    self.index_of([p[0], p[1], p[2]])
                }
            })
            .collect()
    }

    fn index_of(&self, colour: [u8; 3]) -> u8 {
        match self.exact.binary_search_by_key(&colour, |(c, _)| *c) {
            Ok(found) => self.exact[found].1,
            Err(_) => self.table[cell(colour)],
        }
    }

    fn fill_table(&mut self) {
        let mut table = vec![Self::TRANSPARENT; 1 << (3 * TABLE_BITS)];
        if self.colours.is_empty() {
            self.table = table;
            return;
        }
        for (entry, index) in table.iter_mut().enumerate() {
            // The middle of the cell.
            let channel = |k: u32| {
                let bits = (entry >> (TABLE_BITS * k)) & ((1 << TABLE_BITS) - 1);
                ((bits << (8 - TABLE_BITS)) + (1 << (7 - TABLE_BITS))) as i32
            };
            let [r, g, b] = [channel(2), channel(1), channel(0)];
            let distance = |c: &[u8; 3]| {
                let [dr, dg, db] = [r - i32::from(c[0]), g - i32::from(c[1]), b - i32::from(c[2])];
                dr * dr + dg * dg + db * db
            };
            let nearest = self.colours.iter().enumerate().min_by_key(|(_, c)| distance(c));
            *index = nearest.map_or(0, |(k, _)| k as u8 + 1);
        }
        self.table = table;
    }

    /// Moves each colour to the mean of the pixels nearest to it.
    fn settle(&mut self, pixels: &[[u8; 3]]) {
        let mut sums = vec![([0u64; 3], 0u64); self.colours.len()];
        for pixel in pixels {
            let (sum, count) = &mut sums[usize::from(self.table[cell(*pixel)]) - 1];
            for (s, c) in sum.iter_mut().zip(pixel) {
                *s += u64::from(*c);
            }
            *count += 1;
        }
        for (colour, (sum, count)) in self.colours.iter_mut().zip(sums) {
            if count > 0 {
                *colour = sum.map(|s| ((s + count / 2) / count) as u8);
            }
        }
    }
}

fn cell([r, g, b]: [u8; 3]) -> usize {
    let reduced = |c: u8| usize::from(c >> (8 - TABLE_BITS));
    (reduced(r) << (2 * TABLE_BITS)) | (reduced(g) << TABLE_BITS) | reduced(b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_colours_are_exact() {
        let mut frame = Frame::filled(4, 4, [250, 251, 252, 255]);
        frame.pixels[3] = [251, 251, 252, 255];
        frame.pixels[4] = [0; 4];
        let palette = Palette::for_frames(std::slice::from_ref(&frame));
        let bytes = palette.bytes();
        for (pixel, index) in frame.pixels.iter().zip(palette.indices(&frame)) {
            if pixel[3] == 0 {
                assert_eq!(index, Palette::TRANSPARENT);
            } else {
                assert_eq!(&bytes[usize::from(index) * 3..][..3], &pixel[..3]);
            }
        }
    }

    #[test]
    fn many_colours_are_near() {
        let mut frame = Frame::filled(64, 64, [0, 0, 0, 255]);
        for (i, pixel) in frame.pixels.iter_mut().enumerate() {
            *pixel = [(i % 64 * 4) as u8, (i / 64 * 4) as u8, 128, 255];
        }
        let palette = Palette::for_frames(std::slice::from_ref(&frame));
        let bytes = palette.bytes();
        assert!(bytes.len() <= 768);
        let error: u32 = frame
            .pixels
            .iter()
            .zip(palette.indices(&frame))
            .map(|(p, i)| {
                (0..3)
                    .map(|k| u32::from(p[k].abs_diff(bytes[usize::from(i) * 3 + k])))
                    .sum::<u32>()
            })
            .sum();
        assert!(error / 4096 < 14, "mean error {}", error / 4096);
    }
}
