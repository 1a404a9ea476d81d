//! Soft coverage of pixels by what is drawn on paper.
//!
//! Contrasts with the paper, 0 to 255 -> coverages, 0 to 1.
//!
//! A pixel with no paper nearby is covered, and an edge pixel is covered by its contrast relative to the largest one nearby: half
//! of it is reached where the edge is, however blurred. Relative, because a pale body on white paper is as much a body as its
//! black ink line. How near "nearby" is, is measured: one pixel for art from a drawing program, a few for a scan.

use rayon::prelude::*;

/// The widest blur of an edge that is followed, in pixels.
const WIDEST_EDGE: usize = 6;
/// The rise of an edge ends at this share of its height.
const RISEN: f32 = 0.9;
/// The longest way, in pixels, within which a rise is looked for.
const LONGEST_RISE: usize = 14;
/// Distance in pixels that a lossy format carries ringing from an edge: blocks of colour are 16 pixels wide.
const RINGING_REACH: usize = 16;
/// Largest ringing as a share of the edge that it comes from.
const RINGING_SHARE: f32 = 0.12;

/// Whether the file's format keeps pixels as they were.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Fidelity {
    /// As they were.
    Exact,
    /// In transformed blocks: edges ring.
    Lossy,
}

/// What is drawn.
#[derive(Debug)]
pub(super) struct Edges {
    /// Row by row, 0 to 1.
    pub(super) coverage: Vec<f32>,
    /// From the foot of an edge to its height, in pixels.
    pub(super) radius: usize,
}

impl Edges {
    /// The coverages of pixels of the given contrasts, of which those up to `faintest` are paper.
    pub(super) fn of(contrast: &[u8], width: usize, faintest: u8, fidelity: Fidelity) -> Self {
        let radius = edge_radius(contrast, width, faintest);
        let strongest = widened(contrast, width, radius, u8::max);
        let weakest = widened(contrast, width, radius, u8::min);
        let ringing = match fidelity {
            Fidelity::Exact => None,
            Fidelity::Lossy => Some(widened(contrast, width, RINGING_REACH, u8::max)),
        };
        let mut coverage = vec![0.0; contrast.len()];
        coverage
            .par_iter_mut()
            .with_min_len(1 << 14)
            .enumerate()
            .for_each(|(at, share)| {
                let (own, strong) = (contrast[at], strongest[at]);
                if strong <= faintest {
                    return;
                }
                let of_strongest = f32::from(own) / f32::from(strong);
                // A faint edge pixel counts by a fraction: noise in the open has nothing strong beside it.
                let faint = || of_strongest.min(0.5 * f32::from(own) / f32::from(faintest));
                let is_ringing = ringing.as_ref().is_some_and(|around| {
                    let own = f32::from(own);
                    own <= RINGING_SHARE * f32::from(around[at]) && own < RISEN * f32::from(strong)
                });
                *share = if is_ringing || own <= faintest {
                    faint()
                } else if weakest[at] > faintest {
                    1.0
                } else {
                    of_strongest
                };
            });
        Self { coverage, radius }
    }
}

/// How far edges rise: the median over all rows of the number of pixels between the last one that is paper and the first one that
/// is nearly as strong as the strongest after it.
fn edge_radius(contrast: &[u8], width: usize, faintest: u8) -> usize {
    let rises: Vec<[usize; LONGEST_RISE + 1]> = contrast
        .par_chunks(width.max(1))
        .map(|row| {
            let mut counts = [0; LONGEST_RISE + 1];
            for foot in 0..row.len().saturating_sub(1) {
                if row[foot] > faintest || row[foot + 1] <= faintest {
                    continue;
                }
                let rise = &row[foot + 1..(foot + 1 + LONGEST_RISE).min(row.len())];
                let mut peak = 0;
                for &value in rise.iter().take_while(|value| **value > faintest) {
                    // A rise ends where it falls again: behind a line is paper, or paint.
                    if f32::from(value) < RISEN * f32::from(peak) {
                        break;
                    }
                    peak = value.max(peak);
                }
                // What is hardly above paper has no shape.
                if peak >= faintest.saturating_mul(4).max(24) {
                    let risen = rise
                        .iter()
                        .position(|&value| f32::from(value) >= RISEN * f32::from(peak));
                    counts[risen.unwrap_or(0)] += 1;
                }
            }
            counts
        })
        .collect();
    let mut counts = [0; LONGEST_RISE + 1];
    for row in &rises {
        for (total, count) in counts.iter_mut().zip(row) {
            *total += count;
        }
    }
    let half = counts.iter().sum::<usize>() / 2;
    let mut below = 0;
    for (rise, count) in counts.iter().enumerate() {
        below += count;
        if below > half {
            return rise.clamp(1, WIDEST_EDGE);
        }
    }
    1
}

/// Every value with those of the square of `2 radius + 1` pixels around it, by `pick`.
fn widened(values: &[u8], width: usize, radius: usize, pick: impl Fn(u8, u8) -> u8 + Copy + Sync) -> Vec<u8> {
    let width = width.max(1);
    let mut along = values.to_vec();
    along
        .par_chunks_mut(width)
        .zip(values.par_chunks(width))
        .for_each(|(out, row)| {
            for shift in 1..=radius.min(width.saturating_sub(1)) {
                for (out, other) in out.iter_mut().zip(&row[shift..]) {
                    *out = pick(*out, *other);
                }
                for (out, other) in out[shift..].iter_mut().zip(row) {
                    *out = pick(*out, *other);
                }
            }
        });
    let height = values.len() / width;
    let mut both = along.clone();
    both.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
        for row in y.saturating_sub(radius)..(y + radius + 1).min(height) {
            for (out, other) in out.iter_mut().zip(&along[row * width..(row + 1) * width]) {
                *out = pick(*out, *other);
            }
        }
    });
    both
}
