//! Ink: how much darker a place is than what surrounds it.
//!
//! The closing of the lightness (dilation, then erosion, by an octagon) fills whatever is dark and narrower than the octagon; what it adds
//! is ink. Source: Meyer 1979, the black top-hat transform. An octagon is a square dilated by a diamond, and both are made of steps to
//! the neighbouring pixels, so that a closing is a few passes over the image.

/// Steps of the square and of the diamond whose sum is the octagon: as far along the axes (3 + 4 pixels) as along the diagonals.
const SQUARE_STEPS: usize = 3;
const DIAMOND_STEPS: usize = 4;

/// A difference in lightness that counts as full ink, of 100.
const FULL_INK: f32 = 50.0;

/// Ink in 0..1 of an image of lightness, row by row.
pub(super) fn ink(lightness: &[f32], width: usize) -> Vec<f32> {
    let closed = eroded(dilated(lightness.to_vec(), width), width);
    closed
        .iter()
        .zip(lightness)
        .map(|(closed, own)| ((closed - own) / FULL_INK).clamp(0.0, 1.0))
        .collect()
}

fn eroded(mut image: Vec<f32>, width: usize) -> Vec<f32> {
    image.iter_mut().for_each(|value| *value = -*value);
    let mut image = dilated(image, width);
    image.iter_mut().for_each(|value| *value = -*value);
    image
}

/// The largest value within the octagon around every pixel; beyond the border there is nothing.
fn dilated(mut image: Vec<f32>, width: usize) -> Vec<f32> {
    if width == 0 {
        return image;
    }
    for _ in 0..SQUARE_STEPS {
        image = widened_down(&widened_across(&image, width), width);
    }
    for _ in 0..DIAMOND_STEPS {
        let mut wider = widened_across(&image, width);
        for (wider, own) in wider.iter_mut().zip(widened_down(&image, width)) {
            *wider = wider.max(own);
        }
        image = wider;
    }
    image
}

/// The largest of each pixel and its neighbours to the left and right.
fn widened_across(image: &[f32], width: usize) -> Vec<f32> {
    let mut wider = image.to_vec();
    for (wider, row) in wider.chunks_exact_mut(width).zip(image.chunks_exact(width)) {
        raise(&mut wider[1..], row);
        raise(wider, &row[1..]);
    }
    wider
}

/// The largest of each pixel and its neighbours above and below.
fn widened_down(image: &[f32], width: usize) -> Vec<f32> {
    let mut wider = image.to_vec();
    raise(&mut wider[width..], image);
    raise(&mut wider, &image[width..]);
    wider
}

fn raise(values: &mut [f32], others: &[f32]) {
    for (value, other) in values.iter_mut().zip(others) {
        *value = value.max(*other);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_ink_and_a_wide_area_is_not() {
        let (width, height) = (60, 40);
        let dark = |x: usize, y: usize| (x == 10 && y > 5) || (30..58).contains(&x) && (5..38).contains(&y);
        let lightness: Vec<f32> = (0..width * height)
            .map(|k| if dark(k % width, k / width) { 20.0 } else { 90.0 })
            .collect();
        let ink = ink(&lightness, width);
        assert_eq!(ink[20 * width + 10], 1.0);
        assert_eq!(ink[20 * width + 44], 0.0);
        assert_eq!(ink[20 * width + 20], 0.0);
    }
}
