//! 255 colours for a whole animation, and every pixel as one of them.
//!
//! One palette for all frames, and for each pixel an index that depends on its colour and its place alone: what rests
//! does not flicker, and a frame has the same pixels whichever other frames are written with it.
//!
//! 1. [`ColourCount`] counts the colours of any number of frames. Up to 255 are kept exactly.
//! 2. Otherwise colours are put into bins of 4 x 4 x 4, and the bins into boxes: the box with the largest error is cut in two
//!    where that helps most, until there are 255 (after Wu 1991). A bin weighs the root of its pixels, so that an eye
//!    has its colours, too.
//! 3. Bins go to the nearest entry and entries to the mean of their bins, a few times (k-means); an entry whose pixels
//!    mostly have one colour becomes that colour, so that flat areas are exact.
//! 4. A pixel whose colour is between entries becomes one of several entries whose mean is its colour, chosen by its
//!    place in an 8 x 8 matrix (Knoll's pattern dithering).

use rayon::prelude::*;

use crate::render::Frame;

/// The most colours; one more index is kept for transparency.
const MOST_COLOURS: usize = 255;
/// Pixels with less alpha than this are clear: the format knows no half-clear ones.
const CLEAR_BELOW: u8 = 128;
/// What a difference in red, green and blue counts: roughly as the eye sees it.
const CHANNEL_WEIGHTS: [i32; 3] = [2, 4, 3];
/// Bits a channel of the bins.
const BIN_BITS: u32 = 6;
/// Bits a channel of the cells that the nearest entry is looked up in.
const CELL_BITS: u32 = 4;
/// How often entries move to the mean of their bins.
const ROUNDS: usize = 6;
/// The part of its pixels that must have one colour for an entry to become it.
const FLAT_SHARE: f64 = 0.4;
/// Differences of a channel up to this are not dithered: nobody sees them, but noise on flat areas.
const NOT_SEEN: i32 = 3;
/// How many entries a pixel between colours chooses from.
const CANDIDATES: usize = 16;
/// The part of the error so far, in sixteenths, that the next candidate makes up for: less is less grainy.
const STRENGTH: i32 = 12;

type Colour = [u8; 3];

/// How many pixels of some frames have which colour.
pub struct ColourCount {
    /// One count for each of the 2^24 colours.
    counts: Vec<u32>,
}

impl std::fmt::Debug for ColourCount {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ColourCount").finish_non_exhaustive()
    }
}

impl Default for ColourCount {
    /// No frames.
    fn default() -> Self {
        Self {
            counts: vec![0; 1 << 24],
        }
    }
}

impl ColourCount {
    /// Counts the pixels of a frame. The order of frames does not matter.
    pub fn add(&mut self, frame: &Frame) {
        for pixel in frame.straight().chunks_exact(4).filter(|p| p[3] >= CLEAR_BELOW) {
            let count =
                &mut self.counts[usize::from(pixel[0]) << 16 | usize::from(pixel[1]) << 8 | usize::from(pixel[2])];
            *count = count.saturating_add(1);
        }
    }

    /// The colours that there are, in order, with their counts.
    fn colours(&self) -> Vec<(Colour, u32)> {
        let there = self.counts.iter().enumerate().filter(|(_, count)| **count > 0);
        there
            .map(|(code, count)| ([(code >> 16) as u8, (code >> 8) as u8, code as u8], *count))
            .collect()
    }
}

/// A palette and a fast way to the nearest of its colours. Index 0 is transparent.
#[derive(Debug, Clone)]
pub struct Palette {
    /// From dark to light.
    colours: Vec<Colour>,
    /// For each cell of colours the entries that can be nearest to a colour in it.
    near: Vec<Vec<u8>>,
}

impl Palette {
    /// The transparent index.
    pub const TRANSPARENT: u8 = 0;

    /// A palette for frames whose colours were counted.
    #[must_use]
    pub fn new(count: &ColourCount) -> Self {
        let colours = count.colours();
        if colours.len() <= MOST_COLOURS {
            return Self::of(colours.into_iter().map(|(colour, _)| colour).collect());
        }
        let bins = bins(&colours);
        let mut entries = cut_into_boxes(bins.clone());
        for _ in 0..ROUNDS {
            entries = means_of_nearest(&bins, &entries);
        }
        let rounded = entries
            .iter()
            .map(|entry| entry.map(|c| c.round().clamp(0.0, 255.0) as u8));
        let palette = Self::of(rounded.collect());
        Self::of(palette.with_flat_colours(&colours))
    }

    /// A palette for `frames`.
    #[must_use]
    pub fn for_frames(frames: &[Frame]) -> Self {
        let mut count = ColourCount::default();
        for frame in frames {
            count.add(frame);
        }
        Self::new(&count)
    }

    /// Red, green, blue of each index, the transparent one included: at most 256 x 3 bytes.
    #[must_use]
    pub fn bytes(&self) -> Vec<u8> {
        [[0, 0, 0]].iter().chain(&self.colours).flatten().copied().collect()
    }

    /// The index of each pixel of `frame`, dithered.
    #[must_use]
    pub fn indices(&self, frame: &Frame) -> Vec<u8> {
        let straight = frame.straight();
        let mut indices = vec![Self::TRANSPARENT; frame.pixels.len()];
        if frame.width == 0 {
            return indices;
        }
        let rows = indices
            .par_chunks_mut(frame.width)
            .zip(straight.par_chunks(frame.width * 4));
        rows.enumerate().for_each(|(y, (indices, row))| {
            // Neighbours often have one colour.
            let mut last: Option<(Colour, Candidates)> = None;
            for (x, (index, pixel)) in indices.iter_mut().zip(row.chunks_exact(4)).enumerate() {
                if pixel[3] < CLEAR_BELOW {
                    continue;
                }
                let colour = [pixel[0], pixel[1], pixel[2]];
                let candidates = match last {
                    Some((same, candidates)) if same == colour => candidates,
                    _ => self.candidates(colour),
                };
                last = Some((colour, candidates));
                *index = 1 + match candidates {
                    Candidates::One(entry) => entry,
                    Candidates::Many(entries) => entries[threshold(x, y)],
                };
            }
        });
        indices
    }

    fn of(mut colours: Vec<Colour>) -> Self {
        colours.sort_unstable();
        colours.dedup();
        colours.sort_by_key(|[r, g, b]| 299 * u32::from(*r) + 587 * u32::from(*g) + 114 * u32::from(*b));
        let near = near(&colours);
        Self { colours, near }
    }

    /// The entry nearest to a colour.
    fn nearest(&self, colour: [i32; 3]) -> u8 {
        let cell = |c: i32| (c as usize) >> (8 - CELL_BITS);
        let [r, g, b] = colour.map(cell);
        let entries = &self.near[(r << (2 * CELL_BITS)) | (g << CELL_BITS) | b];
        let distance = |entry: &u8| {
            let own = self.colours[usize::from(*entry)];
            (0..3)
                .map(|k| CHANNEL_WEIGHTS[k] * (colour[k] - i32::from(own[k])).pow(2))
                .sum::<i32>()
        };
        entries.iter().copied().min_by_key(distance).unwrap_or(0)
    }

    /// The entries that a colour is made of.
    fn candidates(&self, colour: Colour) -> Candidates {
        if self.colours.is_empty() {
            return Candidates::One(0);
        }
        let wanted = colour.map(i32::from);
        let first = self.nearest(wanted);
        let own = self.colours[usize::from(first)];
        if (0..3).all(|k| (wanted[k] - i32::from(own[k])).abs() <= NOT_SEEN) {
            return Candidates::One(first);
        }
        let mut entries = [first; CANDIDATES];
        let mut error = [0; 3];
        for entry in &mut entries {
            let mut corrected = wanted;
            for (channel, error) in corrected.iter_mut().zip(error) {
                *channel = (*channel + error * STRENGTH / 16).clamp(0, 255);
            }
            *entry = self.nearest(corrected);
            for (k, error) in error.iter_mut().enumerate() {
                *error += wanted[k] - i32::from(self.colours[usize::from(*entry)][k]);
            }
        }
        // From dark to light.
        entries.sort_unstable();
        Candidates::Many(entries)
    }

    /// The colours, each replaced by the one that most of its pixels have, if there is one.
    fn with_flat_colours(&self, colours: &[(Colour, u32)]) -> Vec<Colour> {
        let mut of_entry = vec![(0u64, 0u32, [0; 3]); self.colours.len()];
        for (colour, count) in colours {
            let (all, most, commonest) = &mut of_entry[usize::from(self.nearest(colour.map(i32::from)))];
            *all += u64::from(*count);
            if *count > *most {
                (*most, *commonest) = (*count, *colour);
            }
        }
        let flat = of_entry.into_iter().zip(&self.colours);
        flat.map(|((all, most, commonest), colour)| {
            if all > 0 && f64::from(most) >= FLAT_SHARE * all as f64 {
                commonest
            } else {
                *colour
            }
        })
        .collect()
    }
}

#[derive(Clone, Copy)]
enum Candidates {
    One(u8),
    Many([u8; CANDIDATES]),
}

/// Which of the candidates a pixel takes: Bayer's 8 x 8 matrix, in [`CANDIDATES`] steps.
fn threshold(x: usize, y: usize) -> usize {
    let mut value = 0;
    for bit in 0..3 {
        let (column, row) = ((x >> bit) & 1, (y >> bit) & 1);
        value |= (column ^ row) << (5 - 2 * bit) | row << (4 - 2 * bit);
    }
    value * CANDIDATES / 64
}

/// Colours that are nearly one: their mean, and what they weigh.
#[derive(Debug, Clone, Copy)]
struct Bin {
    mean: [f64; 3],
    weight: f64,
}

fn bins(colours: &[(Colour, u32)]) -> Vec<Bin> {
    let mut sums = vec![([0u64; 3], 0u64); 1 << (3 * BIN_BITS)];
    for (colour, count) in colours {
        let [r, g, b] = colour.map(|c| usize::from(c >> (8 - BIN_BITS)));
        let (sum, pixels) = &mut sums[(r << (2 * BIN_BITS)) | (g << BIN_BITS) | b];
        for (sum, channel) in sum.iter_mut().zip(colour) {
            *sum += u64::from(*channel) * u64::from(*count);
        }
        *pixels += u64::from(*count);
    }
    let there = sums.into_iter().filter(|(_, pixels)| *pixels > 0);
    there
        .map(|(sum, pixels)| Bin {
            mean: sum.map(|s| s as f64 / pixels as f64),
            weight: (pixels as f64).sqrt(),
        })
        .collect()
}

/// Weighted sums over bins, from which mean and squared error follow.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    weight: f64,
    first: [f64; 3],
    second: [f64; 3],
}

impl Sums {
    fn add(&mut self, bin: &Bin) {
        self.weight += bin.weight;
        for k in 0..3 {
            self.first[k] += bin.weight * bin.mean[k];
            self.second[k] += bin.weight * bin.mean[k] * bin.mean[k];
        }
    }

    fn without(&self, other: &Self) -> Self {
        let minus = |a: [f64; 3], b: [f64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        Self {
            weight: self.weight - other.weight,
            first: minus(self.first, other.first),
            second: minus(self.second, other.second),
        }
    }

    /// Squared differences from the mean, a channel each.
    fn errors(&self) -> [f64; 3] {
        [0, 1, 2].map(|k| {
            let about_mean = self.second[k] - self.first[k] * self.first[k] / self.weight.max(f64::MIN_POSITIVE);
            f64::from(CHANNEL_WEIGHTS[k]) * about_mean.max(0.0)
        })
    }

    fn error(&self) -> f64 {
        self.errors().iter().sum()
    }
}

/// The means of at most [`MOST_COLOURS`] boxes of bins.
fn cut_into_boxes(bins: Vec<Bin>) -> Vec<[f64; 3]> {
    let sums_of = |bins: &[Bin]| {
        let mut sums = Sums::default();
        bins.iter().for_each(|bin| sums.add(bin));
        sums
    };
    let mut boxes = vec![(sums_of(&bins), bins)];
    while boxes.len() < MOST_COLOURS {
        let splittable = boxes.iter().enumerate().filter(|(_, (_, bins))| bins.len() > 1);
        let Some(worst) = splittable.max_by(|(_, (a, _)), (_, (b, _))| a.error().total_cmp(&b.error())) else {
            break;
        };
        let (sums, mut bins) = boxes.swap_remove(worst.0);
        let errors = sums.errors();
        let axis = (0..3).max_by(|a, b| errors[*a].total_cmp(&errors[*b])).unwrap_or(0);
        bins.sort_by(|a, b| a.mean[axis].total_cmp(&b.mean[axis]));
        let mut lower = Sums::default();
        let (mut best, mut least) = (1, f64::INFINITY);
        for (k, bin) in bins[..bins.len() - 1].iter().enumerate() {
            lower.add(bin);
            let error = lower.error() + sums.without(&lower).error();
            if error < least {
                (best, least) = (k + 1, error);
            }
        }
        let upper = bins.split_off(best);
        boxes.push((sums_of(&bins), bins));
        boxes.push((sums_of(&upper), upper));
    }
    boxes
        .iter()
        .map(|(sums, _)| sums.first.map(|s| s / sums.weight))
        .collect()
}

/// The mean of the bins nearest to each entry; an entry without any stays.
fn means_of_nearest(bins: &[Bin], entries: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let nearest: Vec<usize> = bins
        .par_iter()
        .map(|bin| {
            let distance = |entry: &[f64; 3]| -> f64 {
                let along = |k: usize| f64::from(CHANNEL_WEIGHTS[k]) * (entry[k] - bin.mean[k]).powi(2);
                along(0) + along(1) + along(2)
            };
            let (mut best, mut least) = (0, f64::INFINITY);
            for (k, entry) in entries.iter().enumerate() {
                let away = distance(entry);
                if away < least {
                    (best, least) = (k, away);
                }
            }
            best
        })
        .collect();
    let mut sums = vec![Sums::default(); entries.len()];
    for (bin, entry) in bins.iter().zip(nearest) {
        sums[entry].add(bin);
    }
    let moved = sums.iter().zip(entries);
    moved
        .map(|(sums, entry)| {
            if sums.weight > 0.0 {
                sums.first.map(|s| s / sums.weight)
            } else {
                *entry
            }
        })
        .collect()
}

/// For each cell the entries that are at most as far from its nearest corner as some entry is from its farthest one.
fn near(colours: &[Colour]) -> Vec<Vec<u8>> {
    let side = 1 << CELL_BITS;
    let width = 256 / side;
    (0..side * side * side)
        .map(|cell| {
            let low = [cell / (side * side), cell / side % side, cell % side].map(|c| c * width);
            let reach = |colour: &Colour| {
                let (mut least, mut most) = (0, 0);
                for k in 0..3 {
                    let (low, high, own) = (low[k], low[k] + width - 1, i32::from(colour[k]));
                    let outside = (low - own).max(own - high).max(0);
                    let across = (own - low).abs().max((own - high).abs());
                    least += CHANNEL_WEIGHTS[k] * outside * outside;
                    most += CHANNEL_WEIGHTS[k] * across * across;
                }
                (least, most)
            };
            let bar = colours.iter().map(|colour| reach(colour).1).min().unwrap_or(0);
            let close = colours.iter().enumerate().filter(|(_, colour)| reach(colour).0 <= bar);
            close.map(|(entry, _)| entry as u8).collect()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gradient() -> Frame {
        let mut frame = Frame::filled(64, 64, [0, 0, 0, 255]);
        for (i, pixel) in frame.pixels.iter_mut().enumerate() {
            let (x, y) = (i % 64, i / 64);
            *pixel = [(x * 4) as u8, (y * 4) as u8, (x ^ y) as u8 * 4, 255];
        }
        frame
    }

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
                let shown = &bytes[usize::from(index) * 3..][..3];
                assert!((0..3).all(|k| shown[k].abs_diff(pixel[k]) <= NOT_SEEN as u8));
            }
        }
    }

    #[test]
    fn the_nearest_entry_is_the_nearest_of_all() {
        let palette = Palette::for_frames(&[gradient()]);
        for code in (0..1 << 24).step_by(10_007) {
            let colour = [code >> 16, (code >> 8) & 255, code & 255];
            let away = |own: &Colour| -> i32 {
                (0..3)
                    .map(|k| CHANNEL_WEIGHTS[k] * (colour[k] - i32::from(own[k])).pow(2))
                    .sum()
            };
            let found = away(&palette.colours[usize::from(palette.nearest(colour))]);
            assert_eq!(Some(found), palette.colours.iter().map(away).min());
        }
    }

    /// Dithered, the mean of a neighbourhood is nearer to the picture than any single entry is.
    #[test]
    fn many_colours_are_right_in_the_mean() {
        let frame = gradient();
        let palette = Palette::for_frames(std::slice::from_ref(&frame));
        let (bytes, indices) = (palette.bytes(), palette.indices(&frame));
        assert!(bytes.len() <= 768);
        let (mut pixel_error, mut block_error) = (0.0, 0.0);
        for block in 0..64 {
            let mut sum = [0.0; 3];
            for i in 0..64 {
                let at = (block / 8 * 8 + i / 8) * 64 + block % 8 * 8 + i % 8;
                for (k, sum) in sum.iter_mut().enumerate() {
                    let difference =
                        f64::from(frame.pixels[at][k]) - f64::from(bytes[usize::from(indices[at]) * 3 + k]);
                    *sum += difference / 64.0;
                    pixel_error += difference.abs() / f64::from(64 * 64 * 3);
                }
            }
            block_error += sum.iter().map(|s: &f64| s.abs()).sum::<f64>() / f64::from(64 * 3);
        }
        assert!(pixel_error < 14.0 && block_error < 2.0, "{pixel_error} {block_error}");
    }

    #[test]
    fn flat_areas_among_many_colours_are_exact() {
        let mut frame = gradient();
        for pixel in &mut frame.pixels[..64 * 20] {
            *pixel = [37, 91, 143, 255];
        }
        let palette = Palette::for_frames(std::slice::from_ref(&frame));
        let bytes = palette.bytes();
        let index = usize::from(palette.indices(&frame)[70]);
        assert_eq!(bytes[index * 3..][..3], [37, 91, 143]);
    }

    #[test]
    fn what_rests_does_not_flicker() {
        let first = gradient();
        let mut second = first.clone();
        second.pixels[100..200].fill([255, 0, 0, 255]);
        let palette = Palette::for_frames(&[first.clone(), second.clone()]);
        let (before, after) = (palette.indices(&first), palette.indices(&second));
        assert!((0..64 * 64).all(|i| before[i] == after[i] || (100..200).contains(&i)));
    }
}
