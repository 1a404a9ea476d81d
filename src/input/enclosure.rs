//! Inside and outside of what is drawn: floods, borders and depths on a grid of pixels.

/// How deep each pixel lies inside a mask, in steps from side to side from what is outside of it, the frame of the picture counted
/// as outside; up to `most + 1`. Cost O(#pixels).
pub(super) fn depths(mask: &[bool], width: usize, most: usize) -> Vec<usize> {
    let mut depths: Vec<usize> = mask.iter().map(|&inside| if inside { most + 1 } else { 0 }).collect();
    let height = mask.len() / width.max(1);
    let mut sweep = |start: usize, stride: usize, count: usize| {
        for backwards in [false, true] {
            let mut depth = 0;
            for k in 0..count {
                let k = if backwards { count - 1 - k } else { k };
                let at = &mut depths[start + k * stride];
                depth = (depth + 1).min(*at);
                *at = depth;
            }
        }
    };
    for row in 0..height {
        sweep(row * width, 1, width);
    }
    for column in 0..width {
        sweep(column, width, height);
    }
    depths
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
    let mut reached = vec![false; is_drawn.len()];
    let mut open: Vec<usize> = Vec::new();
    for &seed in seeds {
        if !is_drawn[seed] && !reached[seed] {
            reached[seed] = true;
            open.push(seed);
        }
    }
    while let Some(at) = open.pop() {
        let column = at % width;
        let mut visit = |other: usize| {
            if !is_drawn[other] && !reached[other] {
                reached[other] = true;
                open.push(other);
            }
        };
        if column > 0 {
            visit(at - 1);
        }
        if column + 1 < width {
            visit(at + 1);
        }
        if at >= width {
            visit(at - width);
        }
        if at + width < is_drawn.len() {
            visit(at + width);
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
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Region {
    /// Its pixels. At most 2^26 are read.
    pub(super) pixels: Vec<u32>,
}

impl Region {
    /// Whether something drawn lies in it: seen from its own box, what is not it falls into pieces, of which one does not reach the
    /// box's frame.
    pub(super) fn has_island(&self, drawn: &[bool], width: usize) -> bool {
        let places = || self.pixels.iter().map(|&at| (at as usize % width, at as usize / width));
        let (mut low, mut high) = ((usize::MAX, usize::MAX), (0, 0));
        for (x, y) in places() {
            low = (low.0.min(x), low.1.min(y));
            high = (high.0.max(x), high.1.max(y));
        }
        // One pixel around it, so that the surroundings hang together.
        let (box_width, box_height) = (high.0 - low.0 + 3, high.1 - low.1 + 3);
        let mut own = vec![false; box_width * box_height];
        for (x, y) in places() {
            own[(y - low.1 + 1) * box_width + x - low.0 + 1] = true;
        }
        let around = flood(&own, box_width, &border(box_width, box_height));
        (0..own.len()).any(|k| {
            let (x, y) = (k % box_width, k / box_width);
            let is_within = (1..box_width - 1).contains(&x) && (1..box_height - 1).contains(&y);
            !own[k] && !around[k] && is_within && drawn[(y + low.1 - 1) * width + x + low.0 - 1]
        })
    }
}

/// The regions of a mask, joined from side to side, in the order of their first pixels. Cost O(#pixels).
pub(super) fn regions(mask: &[bool], width: usize) -> Vec<Region> {
    let mut seen = vec![false; mask.len()];
    let mut regions = Vec::new();
    for seed in 0..mask.len() {
        if !mask[seed] || seen[seed] {
            continue;
        }
        let mut pixels = vec![seed as u32];
        seen[seed] = true;
        let mut next = 0;
        while next < pixels.len() {
            let at = pixels[next] as usize;
            next += 1;
            let column = at % width;
            let beside = [
                (column > 0).then(|| at - 1),
                (column + 1 < width).then_some(at + 1),
                at.checked_sub(width),
                (at + width < mask.len()).then_some(at + width),
            ];
            for other in beside.into_iter().flatten() {
                if mask[other] && !seen[other] {
                    seen[other] = true;
                    pixels.push(other as u32);
                }
            }
        }
        regions.push(Region { pixels });
    }
    regions
}
