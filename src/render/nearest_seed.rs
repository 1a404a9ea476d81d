//! For each pixel, the nearest of some pixels.
//!
//! Two sweeps over the picture pass on the nearest seed known so far to the eight neighbours (Danielsson 1980). The
//! distance is exact but for rare ties at a fraction of a pixel. Cost O(#pixels).

/// The squared distance between two pixels of a grid, given by their indices, row by row.
pub(super) fn distance_squared(pixel: usize, seed: u32, width: usize) -> f64 {
    let seed = seed as usize;
    let (dx, dy) = (
        (pixel % width).abs_diff(seed % width),
        (pixel / width).abs_diff(seed / width),
    );
    (dx * dx + dy * dy) as f64
}

/// For each pixel of a grid, row by row, the index of the nearest pixel with `is_seed`; `None` if there is no seed.
pub(super) fn nearest_seeds(width: usize, height: usize, is_seed: impl Fn(usize) -> bool) -> Option<Vec<u32>> {
    const NONE: u32 = u32::MAX;
    let mut nearest: Vec<u32> = (0..width * height)
        .map(|i| if is_seed(i) { i as u32 } else { NONE })
        .collect();
    if nearest.iter().all(|s| *s == NONE) {
        return None;
    }
    let distance = |x: usize, y: usize, seed: u32| -> i64 {
        let (sx, sy) = (seed as usize % width, seed as usize / width);
        let (dx, dy) = (sx as i64 - x as i64, sy as i64 - y as i64);
        dx * dx + dy * dy
    };
    let mut relax = |x: usize, y: usize, dx: isize, dy: isize| {
        let (Some(nx), Some(ny)) = (x.checked_add_signed(dx), y.checked_add_signed(dy)) else {
            return;
        };
        if nx >= width || ny >= height {
            return;
        }
        let candidate = nearest[ny * width + nx];
        if candidate == NONE {
            return;
        }
        let here = &mut nearest[y * width + x];
        if *here == NONE || distance(x, y, candidate) < distance(x, y, *here) {
            *here = candidate;
        }
    };
    for y in 0..height {
        for x in 0..width {
            for (dx, dy) in [(-1, 0), (-1, -1), (0, -1), (1, -1)] {
                relax(x, y, dx, dy);
            }
        }
        for x in (0..width).rev() {
            relax(x, y, 1, 0);
        }
    }
    for y in (0..height).rev() {
        for x in (0..width).rev() {
            for (dx, dy) in [(1, 0), (1, 1), (0, 1), (-1, 1)] {
                relax(x, y, dx, dy);
            }
        }
        for x in 0..width {
            relax(x, y, -1, 0);
        }
    }
    Some(nearest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_a_search_over_all_seeds() {
        let (width, height) = (23, 17);
        let seeds = [30usize, 77, 200, 201, 388];
        let found = nearest_seeds(width, height, |i| seeds.contains(&i)).expect("there are seeds");
        let distance = |i: usize, s: usize| {
            let (dx, dy) = ((i % width).abs_diff(s % width), (i / width).abs_diff(s / width));
            dx * dx + dy * dy
        };
        for (i, seed) in found.iter().enumerate() {
            let best = seeds.iter().map(|s| distance(i, *s)).min().expect("there are seeds");
            assert_eq!(distance(i, *seed as usize), best, "pixel {i}");
        }
        assert!(nearest_seeds(3, 3, |_| false).is_none());
    }
}
