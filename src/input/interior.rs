//! The inside of a painted figure, and the rim of any.
//!
//! Which pixels are drawn, and which are outside -> what else is outside, because the background shows through the figure; the field
//! whose iso-line is the outline; and how much of each pixel is the figure's. Cost O(#pixels).

use rayon::prelude::*;

use super::enclosure::{Region, neighbours, regions, touches};
use super::lines::Ink;

/// The least share of a painted figure's area of an opening in it.
const LEAST_OPENING: f64 = 0.04;
/// How much stronger a line around an opening is than what lies beyond it.
const LINE_CONTRAST: f64 = 1.5;
/// The widest such line, as a fraction of the diagonal.
const WIDEST_FRAME: f64 = 0.02;
/// Share of an opening's rim that is the figure's outer line, from which on it is no opening.
const LEAST_SHARED_RIM: f64 = 0.05;

/// Opens a painted figure where its background shows through, by marking that as outside; `shows_background` looks closer at a region.
/// Returns how many places that look like the background stay part of the figure.
pub(super) fn open(
    outside: &mut [bool],
    drawn: &[bool],
    contrast: &[u8],
    width: usize,
    ink: &Ink,
    radius: usize,
    shows_background: &dyn Fn(&Region) -> bool,
) -> usize {
    let enclosed: Vec<bool> = outside
        .iter()
        .zip(drawn)
        .map(|(outside, drawn)| !outside && !drawn)
        .collect();
    let area = outside.iter().filter(|outside| !**outside).count() as f64;
    let mut kept = 0;
    for region in regions(&enclosed, width) {
        // What shows is not a picture in itself: eyes have pupils.
        let is_large = region.area as f64 >= LEAST_OPENING * area;
        if is_large
            && !region.has_island(drawn, width)
            && shows_background(&region)
            && !is_framed(&region, &enclosed, outside, contrast, width, ink, radius)
        {
            region.mark(outside, width);
        } else if region.area > (2 * radius + 1).pow(2) {
            kept += 1;
        }
    }
    kept
}

/// Whether a line runs around a region: what is drawn close to it differs from what is drawn a little farther; or whether it reaches
/// the outer line, as white stripes and shirts do: the outside is close to a part of its rim.
fn is_framed(
    region: &Region,
    enclosed: &[bool],
    outside: &[bool],
    contrast: &[u8],
    width: usize,
    ink: &Ink,
    radius: usize,
) -> bool {
    let height = contrast.len() / width;
    let near = (radius + 1) as isize;
    let far = near + (WIDEST_FRAME * ink.diagonal).ceil() as isize;
    let (mut strong, mut beyond, mut sampled, mut by_outside) = (0.0, 0.0, 0_usize, 0_usize);
    for at in region.pixels(width) {
        let (x, y) = ((at % width) as isize, (at / width) as isize);
        for (dx, dy) in [(1, 0), (-1, 0), (0, 1), (0, -1)] {
            let pixel = |steps: isize| {
                let (x, y) = (x + dx * steps, y + dy * steps);
                (x >= 0 && y >= 0 && (x as usize) < width && (y as usize) < height)
                    .then(|| y as usize * width + x as usize)
            };
            // Only from the rim, outwards.
            let (Some(beside), Some(end)) = (pixel(1), pixel(far)) else {
                continue;
            };
            if enclosed[beside] {
                continue;
            }
            let peak = (1..=near).filter_map(pixel).map(|at| contrast[at]).max().unwrap_or(0);
            strong += f64::from(peak);
            beyond += f64::from(contrast[end]);
            by_outside += usize::from((1..=far).filter_map(pixel).any(|at| outside[at]));
            sampled += 1;
        }
    }
    strong > LINE_CONTRAST * beyond || by_outside as f64 > LEAST_SHARED_RIM * sampled as f64
}

/// The field whose iso-line is the outline: inside everything counts, and only its rim keeps the coverage of its edge.
pub(super) fn fill(coverage: &mut [f32], outside: &[bool], width: usize, threshold: f32) {
    coverage
        .par_iter_mut()
        .with_min_len(1 << 14)
        .enumerate()
        .for_each(|(at, share)| {
            *share = if outside[at] {
                share.min(threshold)
            } else if touches(outside, at, width) {
                share.max(threshold)
            } else {
                1.0
            };
        });
}

/// How much of each pixel's colour belongs to the figure, from 0 to 255: outside its coverage; inside all of it, but for the flank of the
/// edge, where the paper shines through, followed inwards as long as coverage rises.
pub(super) fn kept(coverage: &[f32], outside: &[bool], width: usize, radius: usize) -> Vec<u8> {
    let mut kept: Vec<u8> = coverage
        .par_iter()
        .zip(outside)
        .with_min_len(1 << 14)
        .map(|(share, outside)| if *outside { in_bytes(*share) } else { u8::MAX })
        .collect();
    let is_rim = |at: &usize| !outside[*at] && touches(outside, *at, width);
    let mut rim: Vec<usize> = (0..outside.len())
        .into_par_iter()
        .with_min_len(1 << 14)
        .filter(is_rim)
        .collect();
    let mut done: Vec<bool> = outside.to_vec();
    for _ in 0..=radius {
        for &at in &rim {
            kept[at] = in_bytes(coverage[at]);
            done[at] = true;
        }
        let mut next = Vec::new();
        for &at in &rim {
            for other in neighbours(at, width, outside.len()) {
                if !done[other] && coverage[other] < 1.0 && coverage[other] >= coverage[at] {
                    done[other] = true;
                    next.push(other);
                }
            }
        }
        rim = next;
    }
    kept
}

/// A share as a byte.
pub(super) fn in_bytes(share: f32) -> u8 {
    (255.0 * share).round() as u8
}
