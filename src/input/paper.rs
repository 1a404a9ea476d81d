//! The background of a drawing as a smooth field, and its noise.
//!
//! Pixels and the region that the background is looked for in -> [`Paper`].
//!
//! 1. The picture is averaged down to at most [`WORKING_SIDE`] pixels a side.
//! 2. A polynomial of degree 2 in each channel is fitted to a band along the border of the region, robustly: iteratively
//!    reweighted least squares with Tukey's biweight, at the scale of the median absolute residual, by degrees. Whatever touches the
//!    border in less than about half of the band is left out by that.
//! 3. What the polynomial leaves is followed where the background is seen, inside line drawings too: residuals of all pixels within
//!    [`REACH`] deviations are averaged locally (normalised convolution with a box applied three times), and again with the better
//!    field. Light, shadow and stains follow; a drawing does not, because its edges are steep.
//! 4. The noise is measured on full-size pixels, again by the median absolute residual: grain, JPEG blocks, weave.
//!
//! A border whose residuals are not small is no plain background: refused. Cost O(#pixels).

use std::collections::BTreeMap;

use image::RgbaImage;
use nalgebra::{SMatrix, SVector};
use rayon::prelude::*;

use super::averaged::{Colour, STEP, Small};
use super::box_filter::box_filter;
use super::enclosure::{Region, border, depths};

/// The longer side of the picture in which the background is looked for, in pixels at most.
const WORKING_SIDE: usize = 1024;
/// Width of the band along the border that the background is first fitted to, as a fraction of the shorter side.
const BAND: f64 = 0.03;
/// The most pixels that are fitted to, evenly chosen.
const MOST_SAMPLES: usize = 20_000;
/// Deviations of the noise within which a pixel counts as background: of a million Gaussian ones hardly any is beyond.
const REACH: f32 = 5.0;
/// The largest deviation, of the range from black to white, at which the background still counts as plain: above the coarsest
/// watercolour paper, below painted checkerboards and pictures.
const LARGEST_NOISE: f32 = 0.05;
/// The least share of the band that the fit has to explain.
const LEAST_EXPLAINED: f64 = 0.5;
/// The most stretches of the border that something else covers, where that is more than [`PATTERN_SHARE`] of it: beyond, it is a
/// pattern, such as transparency painted as squares.
const MOST_STRETCHES: usize = 16;
/// Share of the border that a pattern covers at least.
const PATTERN_SHARE: f64 = 0.2;
/// Radius within which residuals are averaged, as a fraction of the longer side: light and shadow change over larger distances.
const FOLLOWED: f64 = 0.03;
/// Share of the neighbourhood that has to be background for what the polynomial leaves there to count in full.
const LEAST_SEEN: f32 = 0.05;
/// Side of the places whose means are compared, in pixels of the field.
const PLACE_SIDE: usize = 32;
/// Deviations of such means within which a region shows the background.
const UNEVEN: f32 = 3.0;
/// How often the field is made better.
const ROUNDS: usize = 3;
/// From a median absolute residual to the standard deviation of Gaussian noise.
const DEVIATION_OF_MEDIAN: f32 = 1.4826;

/// The coefficients of 1, x, y, x x, x y, y y in each channel.
type Polynomial = [[f64; 6]; 3];

/// A background.
#[derive(Debug, Clone)]
pub(super) struct Paper {
    /// Full-size pixels to one of the field, along each side.
    scale: usize,
    /// Columns of the field.
    width: usize,
    /// Rows of the field.
    height: usize,
    field: Vec<Colour>,
    /// For each full-size column the pixel of the field at or left of it, and how far it is towards the next.
    columns: Vec<(usize, f32)>,
    /// The field as it is along the border, continued: it knows nothing of what is seen farther inside.
    polynomial: Polynomial,
    /// How far the background of whole places is from that.
    unevenness: f32,
    /// The standard deviation of full-size pixels from the field, in the noisiest channel; at least that of rounding.
    pub(super) noise: f32,
}

impl Small {
    /// The pixels of the region that are near its border, at most [`MOST_SAMPLES`].
    fn band(&self) -> Vec<usize> {
        // Of at most 1,024 pixels.
        let reach = ((BAND * self.width.min(self.height) as f64).round() as u16).max(1);
        let depths = depths(&self.region, self.width, reach);
        let near: Vec<usize> = (0..depths.len())
            .filter(|&k| (1..=reach).contains(&depths[k]))
            .collect();
        let stride = near.len().div_ceil(MOST_SAMPLES).max(1);
        near.into_iter().step_by(stride).collect()
    }

    fn monomials(&self, pixel: usize) -> [f64; 6] {
        monomials(self.width, self.height, pixel)
    }
}

/// The monomials of a pixel's place, in units in which the picture is two long.
fn monomials(width: usize, height: usize, pixel: usize) -> [f64; 6] {
    let longer = width.max(height) as f64;
    let x = 2.0 * (pixel % width) as f64 / longer - 1.0;
    let y = 2.0 * (pixel / width) as f64 / longer - 1.0;
    [1.0, x, y, x * x, x * y, y * y]
}

/// The pixel of a field, of `count` along this side, at or before a full-size pixel, and how far that is towards the next.
fn between(full: usize, scale: usize, count: usize) -> (usize, f32) {
    if scale == 1 {
        return (full, 0.0);
    }
    let place = ((full as f32 + 0.5) / scale as f32 - 0.5).clamp(0.0, (count - 1) as f32);
    let low = (place as usize).min(count.saturating_sub(2));
    (low, place - low as f32)
}

fn mixed(a: Colour, b: Colour, share: f32) -> Colour {
    std::array::from_fn(|k| (1.0 - share) * a[k] + share * b[k])
}

fn polynomial_at(polynomial: &Polynomial, monomials: [f64; 6]) -> Colour {
    polynomial.map(|terms| terms.iter().zip(monomials).map(|(a, b)| a * b).sum::<f64>() as f32)
}

/// The deviation of the means of small places in the band from the polynomial.
fn unevenness(small: &Small, polynomial: &Polynomial, band: &[usize], reach: f32) -> f32 {
    let mut places: BTreeMap<(usize, usize), ([f32; 3], f32)> = BTreeMap::new();
    for &pixel in band {
        let own = residual(small, polynomial, pixel);
        if largest(own) <= reach {
            let place = (pixel % small.width / PLACE_SIDE, pixel / small.width / PLACE_SIDE);
            let (sum, count) = places.entry(place).or_default();
            for (total, value) in sum.iter_mut().zip(own) {
                *total += value;
            }
            *count += 1.0;
        }
    }
    let mut means: Vec<f32> = places
        .values()
        .map(|(sum, count)| largest(sum.map(|total| total / count)))
        .collect();
    (DEVIATION_OF_MEDIAN * median(&mut means)).max(0.5 * STEP)
}

impl Paper {
    /// The background of the picture, or of a region of it (one entry a pixel). `None` if it is not plain.
    pub(super) fn estimate(image: &RgbaImage, region: Option<&[bool]>) -> Option<Self> {
        let small = Small::new(image, region, WORKING_SIDE);
        let band = small.band();
        if band.is_empty() {
            return None;
        }
        let (polynomial, deviation) = fit(&small, &band);
        let is_explained = |pixel: usize| largest(residual(&small, &polynomial, pixel)) <= REACH * deviation;
        let explained = band.iter().filter(|&&pixel| is_explained(pixel)).count() as f64 / band.len() as f64;
        if deviation > LARGEST_NOISE || explained < LEAST_EXPLAINED {
            return None;
        }
        // A figure cut by the frame leaves the border in a few stretches, a pattern in many.
        let rim: Vec<bool> = border(small.width, small.height)
            .into_iter()
            .map(is_explained)
            .collect();
        let stretches = rim.windows(2).filter(|pair| pair[0] && !pair[1]).count();
        if region.is_none() && stretches > MOST_STRETCHES && explained < 1.0 - PATTERN_SHARE {
            return None;
        }
        let mut paper = Self {
            scale: small.scale,
            width: small.width,
            height: small.height,
            field: follow(&small, &polynomial, deviation),
            columns: (0..image.width() as usize)
                .map(|x| between(x, small.scale, small.width))
                .collect(),
            polynomial,
            unevenness: unevenness(&small, &polynomial, &band, REACH * deviation),
            noise: deviation,
        };
        paper.noise = paper.measure_noise(image, region);
        Some(paper)
    }

    /// The background's colour at a full-size pixel.
    pub(super) fn at(&self, x: usize, y: usize) -> Colour {
        let (left, u) = self.columns[x];
        let (top, v) = between(y, self.scale, self.height);
        let field = |x: usize| {
            let x = x.min(self.width - 1);
            let below = (top + 1).min(self.height - 1);
            mixed(self.field[top * self.width + x], self.field[below * self.width + x], v)
        };
        mixed(field(left), field(left + 1), u)
    }

    /// The background's colours along a full-size row, in `row`; `field_row` is memory for them.
    fn read_row(&self, y: usize, field_row: &mut Vec<Colour>, row: &mut Vec<Colour>) {
        let (top, v) = between(y, self.scale, self.height);
        let below = (top + 1).min(self.height - 1);
        let of_field = |row: usize| &self.field[row * self.width..(row + 1) * self.width];
        field_row.clear();
        field_row.extend(of_field(top).iter().zip(of_field(below)).map(|(a, b)| mixed(*a, *b, v)));
        field_row.extend(field_row.last().copied());
        row.clear();
        row.extend(
            self.columns
                .iter()
                .map(|&(left, u)| mixed(field_row[left], field_row[left + 1], u)),
        );
    }

    /// Whether the median colour of a region of full-size pixels is that of the background along the border. Grain cancels out in large
    /// regions, so that whites are told apart that single pixels do not tell; the soft rim of the region does not count.
    pub(super) fn is_seen_in(&self, image: &RgbaImage, region: &Region) -> bool {
        let width = image.width() as usize;
        let mut residuals: [Vec<f32>; 3] = Default::default();
        let stride = region.area.div_ceil(MOST_SAMPLES).max(1);
        for at in region.pixels(width).step_by(stride) {
            let place = (at / width / self.scale) * self.width + at % width / self.scale;
            let expected = polynomial_at(&self.polynomial, monomials(self.width, self.height, place));
            let pixel = &image.as_raw()[4 * at..];
            for ((residuals, channel), expected) in residuals.iter_mut().zip(pixel).zip(expected) {
                residuals.push(f32::from(*channel) * STEP - expected);
            }
        }
        let middle = residuals.each_mut().map(|values| median(values));
        largest(middle) <= UNEVEN * self.unevenness
    }

    /// How light it is on average, from 0 to 1.
    pub(super) fn lightness(&self) -> f32 {
        let sum: f64 = self.field.iter().flatten().map(|channel| f64::from(*channel)).sum();
        (sum / (3 * self.field.len()).max(1) as f64) as f32
    }

    /// How far each full-size pixel is from the background, in the channel where it is farthest, from 0 to 255.
    pub(super) fn contrast(&self, image: &RgbaImage) -> Vec<u8> {
        let width = image.width() as usize;
        let mut contrast = vec![0; width * image.height() as usize];
        contrast
            .par_chunks_mut(width.max(1))
            .zip(image.as_raw().par_chunks(4 * width.max(1)))
            .enumerate()
            .for_each_init(Default::default, |(field_row, paper), (y, (row, pixels))| {
                self.read_row(y, field_row, paper);
                for ((contrast, pixel), paper) in row.iter_mut().zip(pixels.chunks_exact(4)).zip(paper.iter()) {
                    let far = |k: usize| (f32::from(pixel[k]) - 255.0 * paper[k]).abs();
                    // Rounded, since casts cut off.
                    *contrast = (far(0).max(far(1)).max(far(2)) + 0.5) as u8;
                }
            });
        contrast
    }

    /// The deviation of full-size pixels that are background.
    fn measure_noise(&self, image: &RgbaImage, region: Option<&[bool]>) -> f32 {
        let (width, count) = (image.width() as usize, image.width() as usize * image.height() as usize);
        // A stride without small divisors meets all columns.
        let stride = (count / (5 * MOST_SAMPLES)).max(1) | 1;
        let mut residuals: [Vec<f32>; 3] = Default::default();
        for at in (0..count)
            .step_by(stride)
            .filter(|&at| region.is_none_or(|region| region[at]))
        {
            let paper = self.at(at % width, at / width);
            let pixel = &image.as_raw()[4 * at..4 * at + 3];
            let own: Colour = std::array::from_fn(|k| f32::from(pixel[k]) * STEP - paper[k]);
            if largest(own) <= 3.0 * REACH * self.noise.max(STEP) {
                for (channel, value) in residuals.iter_mut().zip(own) {
                    channel.push(value.abs());
                }
            }
        }
        let deviation = residuals.iter_mut().map(|values| DEVIATION_OF_MEDIAN * median(values));
        deviation.fold(0.5 * STEP, f32::max)
    }
}

/// The polynomial of the band, and the deviation of what follows it.
fn fit(small: &Small, band: &[usize]) -> (Polynomial, f32) {
    let mut polynomial: Polynomial = [[0.0; 6]; 3];
    for (channel, coefficients) in polynomial.iter_mut().enumerate() {
        let mut values: Vec<f32> = band.iter().map(|&pixel| small.pixels[pixel][channel]).collect();
        coefficients[0] = f64::from(median(&mut values));
    }
    let mut deviation = deviation_of(small, &polynomial, band);
    for terms in [1, 3, 3, 6, 6, 6] {
        if band.len() < 4 * terms {
            break;
        }
        let reach = f64::from(REACH * deviation);
        let mut normal = SMatrix::<f64, 6, 6>::zeros();
        let mut right = [SVector::<f64, 6>::zeros(); 3];
        for &pixel in band {
            let share = f64::from(largest(residual(small, &polynomial, pixel))) / reach;
            if share >= 1.0 {
                continue;
            }
            let weight = (1.0 - share * share).powi(2);
            let monomials = SVector::from(small.monomials(pixel));
            normal += weight * monomials * monomials.transpose();
            for (right, value) in right.iter_mut().zip(small.pixels[pixel]) {
                *right += weight * f64::from(value) * monomials;
            }
        }
        // Terms that are not yet fitted are held at zero; a ridge far below rounding of colours keeps thin layouts solvable.
        let ridge = 1e-9 * normal[(0, 0)].max(1.0);
        for k in 0..6 {
            normal[(k, k)] += if k < terms {
                ridge
            } else {
                1e12 * normal[(0, 0)].max(1.0)
            };
        }
        let Some(cholesky) = normal.cholesky() else { break };
        let better = right.map(|right| cholesky.solve(&right).into());
        let deviation_then = deviation_of(small, &better, band);
        if !deviation_then.is_finite() {
            break;
        }
        (polynomial, deviation) = (better, deviation_then);
    }
    (polynomial, deviation)
}

fn deviation_of(small: &Small, polynomial: &Polynomial, band: &[usize]) -> f32 {
    let mut values: Vec<f32> = band
        .iter()
        .map(|&pixel| largest(residual(small, polynomial, pixel)))
        .collect();
    (DEVIATION_OF_MEDIAN * median(&mut values)).max(0.5 * STEP)
}

/// The field: the polynomial with what it leaves.
fn follow(small: &Small, polynomial: &Polynomial, deviation: f32) -> Vec<Colour> {
    let count = small.pixels.len();
    let base: Vec<Colour> = (0..count)
        .into_par_iter()
        .map(|pixel| evaluate(small, polynomial, pixel))
        .collect();
    let radius = (FOLLOWED * small.width.max(small.height) as f64).round() as usize;
    let (mut field, mut reach) = (base.clone(), REACH * deviation);
    if radius == 0 {
        return field;
    }
    for _ in 0..ROUNDS {
        let mut seen: Vec<[f32; 4]> = (0..count)
            .into_par_iter()
            .map(|at| {
                let pixel = small.pixels[at];
                let own: Colour = std::array::from_fn(|k| pixel[k] - field[at][k]);
                if !small.region[at] || largest(own) > reach {
                    return [0.0; 4];
                }
                let [r, g, b] = std::array::from_fn(|k| pixel[k] - base[at][k]);
                [r, g, b, 1.0]
            })
            .collect();
        for _ in 0..3 {
            box_filter(&mut seen, small.width, radius);
        }
        field.par_iter_mut().enumerate().for_each(|(at, field)| {
            // Where hardly any background is seen nearby, the polynomial says what it is.
            let weight = seen[at][3].max(LEAST_SEEN);
            *field = std::array::from_fn(|k| base[at][k] + seen[at][k] / weight);
        });
        let mut left: Vec<f32> = (0..count)
            .filter(|&at| small.region[at])
            .map(|at| largest(std::array::from_fn(|k| small.pixels[at][k] - field[at][k])))
            .filter(|own| *own <= reach)
            .collect();
        reach = REACH * (DEVIATION_OF_MEDIAN * median(&mut left)).max(0.5 * STEP);
    }
    field
}

fn evaluate(small: &Small, polynomial: &Polynomial, pixel: usize) -> Colour {
    polynomial_at(polynomial, small.monomials(pixel))
}

fn residual(small: &Small, polynomial: &Polynomial, pixel: usize) -> Colour {
    let expected = evaluate(small, polynomial, pixel);
    std::array::from_fn(|k| small.pixels[pixel][k] - expected[k])
}

fn largest(colour: Colour) -> f32 {
    colour.into_iter().fold(0.0, |most, value| most.max(value.abs()))
}

/// The median, 0 of nothing.
fn median(values: &mut [f32]) -> f32 {
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f32::total_cmp).1
}
