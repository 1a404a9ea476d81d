//! Inside and outside of what is drawn: floods, regions, borders and depths on a grid of pixels.

use rayon::prelude::*;

use super::runs::{Run, Runs};

/// How deep each pixel lies inside a mask, in steps from side to side from what is outside of it, the frame of the picture counted
/// as outside; up to `most + 1`. Cost O(#pixels).
pub(super) fn depths(mask: &[bool], width: usize, most: u16) -> Vec<u16> {
    let width = width.max(1);
    let deepest = most.saturating_add(1);
    let mut depths: Vec<u16> = mask.iter().map(|&inside| if inside { deepest } else { 0 }).collect();
    depths.par_chunks_mut(width).for_each(|row| {
        deepen(row.iter_mut().map(std::slice::from_mut), 1);
        deepen(row.iter_mut().rev().map(std::slice::from_mut), 1);
    });
    deepen(depths.chunks_exact_mut(width), width);
    deepen(depths.chunks_exact_mut(width).rev(), width);
    depths
}

/// Lets no depth be more than one step beyond that before it; before the first line, of `width` depths, is the outside.
fn deepen<'a>(lines: impl Iterator<Item = &'a mut [u16]>, width: usize) {
    let mut before = vec![0_u16; width];
    for line in lines {
        for (own, before) in line.iter_mut().zip(&mut before) {
            *before = (*before + 1).min(*own);
            *own = *before;
        }
    }
}

/// The pixels around one.
pub(super) fn neighbours(at: usize, width: usize, count: usize) -> impl Iterator<Item = usize> {
    let (x, y, height) = (at % width, at / width, count / width);
    let rows = y.saturating_sub(1)..(y + 2).min(height);
    rows.flat_map(move |row| (x.saturating_sub(1)..(x + 2).min(width)).map(move |column| row * width + column))
        .filter(move |&other| other != at)
}

/// Whether one of the pixels around one is in a mask.
pub(super) fn touches(mask: &[bool], at: usize, width: usize) -> bool {
    let column = at % width;
    if column == 0 || column + 1 == width || at < width || at + width >= mask.len() {
        return neighbours(at, width, mask.len()).any(|other| mask[other]);
    }
    let row = |middle: usize| mask[middle - 1] | mask[middle] | mask[middle + 1];
    row(at - width) | row(at + width) | mask[at - 1] | mask[at + 1]
}

/// What is reached from `seeds` over pixels that are not drawn, from side to side. Cost O(#pixels).
pub(super) fn flood(is_drawn: &[bool], width: usize, seeds: &[usize]) -> Vec<bool> {
    let bare = Runs::of(is_drawn, width, |is_drawn| !is_drawn);
    let components = bare.components(|_, _| false);
    let mut is_reached = vec![false; components.count];
    for &seed in seeds {
        if let Some(run) = bare.at(seed % width, seed / width) {
            is_reached[components.label_of[run] as usize] = true;
        }
    }
    let mut reached = vec![false; is_drawn.len()];
    for (run, label) in bare.all().iter().zip(&components.label_of) {
        if is_reached[*label as usize] {
            reached[run.pixels(width)].fill(true);
        }
    }
    reached
}

/// The pixels along the border, once around.
pub(super) fn border(width: usize, height: usize) -> Vec<usize> {
    if width == 0 || height == 0 {
        return Vec::new();
    }
    let mut border: Vec<usize> = (0..width).collect();
    border.extend((1..height).map(|row| row * width + width - 1));
    if height > 1 {
        border.extend(
            (0..width.saturating_sub(1))
                .rev()
                .map(|column| (height - 1) * width + column),
        );
    }
    if width > 1 {
        border.extend((1..height.saturating_sub(1)).rev().map(|row| row * width));
    }
    border
}

/// Where the outside of a line drawing meets the border. Lines that run out of the picture divide the border into stretches, which
/// lie outside and inside in turn, beginning with the longest: a wrist that the frame cuts is closed along the frame.
pub(super) fn outer_border(is_drawn: &[bool], width: usize) -> Vec<usize> {
    let border = border(width, is_drawn.len() / width.max(1));
    let Some(first) = border.iter().position(|&at| is_drawn[at]) else {
        return border;
    };
    let cyclic: Vec<usize> = border[first..].iter().chain(&border[..first]).copied().collect();
    let stretches: Vec<&[usize]> = cyclic
        .split(|&at| is_drawn[at])
        .filter(|stretch| !stretch.is_empty())
        .collect();
    let longest = (0..stretches.len()).max_by_key(|&k| (stretches[k].len(), usize::MAX - k));
    match longest {
        Some(longest) if stretches.len().is_multiple_of(2) => {
            let same_side = |(k, _): &(usize, &&[usize])| k.abs_diff(longest) % 2 == 0;
            stretches
                .iter()
                .enumerate()
                .filter(same_side)
                .flat_map(|(_, stretch)| stretch.iter().copied())
                .collect()
        }
        _ => border,
    }
}

/// A connected region of a mask.
#[derive(Debug, Clone)]
pub(super) struct Region {
    runs: Vec<Run>,
    /// How many pixels it has.
    pub(super) area: usize,
}

impl Region {
    /// The indices of its pixels in a picture of the given width, row by row.
    pub(super) fn pixels(&self, width: usize) -> impl Iterator<Item = usize> + '_ {
        self.runs.iter().flat_map(move |run| run.pixels(width))
    }

    /// Sets its pixels in a mask of the given width.
    pub(super) fn mark(&self, mask: &mut [bool], width: usize) {
        for run in &self.runs {
            mask[run.pixels(width)].fill(true);
        }
    }

    /// Whether something drawn lies in it: seen from its own box, what is not it falls into pieces, of which one does not reach the
    /// box's frame.
    pub(super) fn has_island(&self, drawn: &[bool], width: usize) -> bool {
        let columns = || self.runs.iter().map(|run| run.columns());
        let (Some(first), Some(last)) = (self.runs.first(), self.runs.last()) else {
            return false;
        };
        let left = columns().map(|columns| columns.start).min().unwrap_or(0);
        let right = columns().map(|columns| columns.end).max().unwrap_or(0);
        // One pixel around it, so that the surroundings hang together.
        let (box_width, box_height) = (right - left + 2, last.row() - first.row() + 3);
        let mut own = vec![false; box_width * box_height];
        for run in &self.runs {
            let start = (run.row() - first.row() + 1) * box_width + run.columns().start - left + 1;
            own[start..start + run.len()].fill(true);
        }
        let around = flood(&own, box_width, &border(box_width, box_height));
        (1..box_height - 1).any(|y| {
            let row = y * box_width;
            (1..box_width - 1)
                .any(|x| !own[row + x] && !around[row + x] && drawn[(y + first.row() - 1) * width + x + left - 1])
        })
    }
}

/// The regions of a mask, joined from side to side, in the order of their first pixels. Cost O(#pixels).
pub(super) fn regions(mask: &[bool], width: usize) -> Vec<Region> {
    let runs = Runs::of(mask, width, |inside| *inside);
    let components = runs.components(|_, _| false);
    let mut regions = vec![
        Region {
            runs: Vec::new(),
            area: 0
        };
        components.count
    ];
    for (run, label) in runs.all().iter().zip(&components.label_of) {
        let region = &mut regions[*label as usize];
        region.runs.push(*run);
        region.area += run.len();
    }
    regions
}
