//! What lies along a whole border of a scan or photograph: the shadow where the sheet leaves the glass, the lid, the table beside it.
//!
//! Parts of a picture with a background -> those that are narrow and run along (nearly) all of a side. A character is not drawn
//! like that; a floor or a frame is, and counts as background, too. Cost O(#columns + #rows).

use super::iso_line::Parts;

/// The least share of a side that a strip along it covers: its ends may crumble.
const COVERED: f64 = 0.9;
/// How far a strip reaches into the picture at most, as a share of the picture's extent.
const DEPTH: f64 = 0.15;
/// What is left must be a drawing: the largest other part has at least this share of a strip's area.
const LEAST_LEFT: f64 = 0.05;

/// The parts, by index, that lie along a border; none where nothing but crumbs would be left.
pub(super) fn border_strips(parts: &Parts<'_>) -> Vec<usize> {
    let size = parts.size();
    let mut strips: Vec<usize> = Vec::new();
    for (along, across) in [(0, 1), (1, 0)] {
        for border in [0, size[across] - 1] {
            let mut covered = vec![0_usize; parts.parts.len()];
            for k in 0..size[along] {
                let mut pixel = [k, k];
                pixel[across] = border;
                if let Some(part) = parts.covering(pixel[0], pixel[1]) {
                    covered[part] += 1;
                }
            }
            let is_strip = |part: &usize| {
                let [low, high] = parts.parts[*part].bounds;
                let depth = (high[across] + 1 - low[across]) as f64;
                covered[*part] as f64 >= COVERED * size[along] as f64 && depth <= DEPTH * size[across] as f64
            };
            strips.extend((0..covered.len()).filter(is_strip));
        }
    }
    strips.sort_unstable();
    strips.dedup();
    let largest = |is_wanted: &dyn Fn(&usize) -> bool| {
        let areas = (0..parts.parts.len())
            .filter(is_wanted)
            .map(|part| parts.parts[part].area);
        areas.fold(0.0, f64::max)
    };
    let is_strip = |part: &usize| strips.contains(part);
    if largest(&|part| !is_strip(part)) < LEAST_LEFT * largest(&is_strip) {
        strips.clear();
    }
    strips
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::coverage::Coverage;

    /// The strips of a picture of 40 x 30 pixels that is covered where `is_ink` says so.
    fn strips(is_ink: impl Fn(usize, usize) -> bool) -> usize {
        let measured: Vec<f32> = (0..40 * 30)
            .map(|k| f32::from(u8::from(is_ink(k % 40, k / 40))))
            .collect();
        let coverage = Coverage::framed(measured, 40, 0.5);
        border_strips(&Parts::of(&coverage, 0.5)).len()
    }

    fn figure(x: usize, y: usize) -> bool {
        (15..25).contains(&x) && (8..22).contains(&y)
    }

    #[test]
    fn a_strip_along_a_side_is_none_of_the_figure() {
        assert_eq!(strips(|x, y| figure(x, y) || x < 4), 1);
        assert_eq!(strips(|x, y| figure(x, y) || y >= 28 && x > 1), 1);
        assert_eq!(strips(|x, y| figure(x, y) || !(3..38).contains(&x)), 2);
    }

    #[test]
    fn what_is_wide_or_short_or_all_there_is_is_none() {
        assert_eq!(strips(figure), 0);
        assert_eq!(strips(|x, y| figure(x, y) || x < 4 && y < 20), 0);
        assert_eq!(strips(|x, y| figure(x, y) || x < 9), 0);
        assert_eq!(strips(|x, _| x < 4), 0);
        // An arm that leaves the picture is no strip, either.
        assert_eq!(strips(|x, y| figure(x, y) || (12..15).contains(&y)), 0);
    }
}
