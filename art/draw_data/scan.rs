//! A drawing on paper, scanned: the sheet lies a little turned on the glass, its surface is uneven, light falls off to one side, and
//! where the sheet leaves the glass there is a shadow.
//!
//! The hand that drew it was not quite steady, either: lines waver by a pixel, differently in every drawing.

use std::error::Error;
use std::path::Path;

use image::codecs::jpeg::JpegEncoder;
use kurbo::{Affine, Point, Vec2};

use crate::canvas::Canvas;
use crate::figure::{HEIGHT_PX, WIDTH_PX};

/// Samples of a pixel in each direction.
const SAMPLES: u32 = 3;

/// Of the JPEG file.
const QUALITY: u8 = 82;

/// How white the paper is, how much darker it is at the far side, and in the shadow at the edge.
const PAPER: f64 = 0.95;
const FALLOFF: f64 = 0.09;
const SHADOW: f64 = 0.30;

/// How far the shadow reaches, and how far lines waver and how slowly, pixels.
const SHADOW_PX: f64 = 34.0;
const WAVER_PX: f64 = 1.1;
const WAVER_LENGTH_PX: f64 = 38.0;

/// How one sheet lies on the glass.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sheet {
    /// Clockwise, degrees.
    pub(crate) tilt_deg: f64,
    /// By how much it is off the middle, pixels.
    pub(crate) shift: Vec2,
    /// Which of all sheets and hands it is.
    pub(crate) seed: u32,
}

impl Sheet {
    /// Where a point of the scan is on the drawing.
    fn drawn(&self, scanned: Point) -> Point {
        let middle = Point::new(0.5 * f64::from(WIDTH_PX), 0.5 * f64::from(HEIGHT_PX));
        let lies = Affine::translate(self.shift) * Affine::rotate_about(self.tilt_deg.to_radians(), middle);
        let point = lies.inverse() * scanned;
        let waver = |channel: u32| {
            let slow = noise(point, WAVER_LENGTH_PX, self.seed ^ channel);
            let quick = noise(point, 0.3 * WAVER_LENGTH_PX, self.seed ^ channel ^ 0x55);
            WAVER_PX * (2.0 * slow + 0.5 * quick - 1.25)
        };
        point + Vec2::new(waver(1), waver(2))
    }

    /// Where a point of the drawing is on the scan.
    pub(crate) fn scanned(&self, drawn: Point) -> Point {
        // Lines waver by little and slowly: each step leaves a tenth of the distance.
        (0..8).fold(drawn, |point, _| point + (drawn - self.drawn(point)))
    }

    /// Scans a drawing and writes a grey JPEG file.
    pub(crate) fn save(&self, canvas: &Canvas, file: &Path) -> Result<(), Box<dyn Error>> {
        let mut grey = Vec::new();
        for y in 0..HEIGHT_PX {
            for x in 0..WIDTH_PX {
                let middle = Point::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                let samples = (0..SAMPLES * SAMPLES).map(|k| {
                    let part = |k: u32| (f64::from(k) + 0.5) / f64::from(SAMPLES);
                    let corner = Vec2::new(part(k % SAMPLES) - 0.5, part(k / SAMPLES) - 0.5);
                    canvas.darkness(self.drawn(middle + corner * 1.3))
                });
                let ink = samples.sum::<f64>() / f64::from(SAMPLES * SAMPLES);
                // Ink is blacker where the pen rested, and lets a little of the paper's grain through.
                let black =
                    0.93 - 0.12 * noise(middle, 9.0, self.seed ^ 0x77) - 0.05 * noise(middle, 1.5, self.seed ^ 0x99);
                let light = self.light(middle);
                grey.push((255.0 * light * (1.0 - ink * black)).round().clamp(0.0, 255.0) as u8);
            }
        }
        let mut bytes = Vec::new();
        JpegEncoder::new_with_quality(&mut bytes, QUALITY).encode(
            &grey,
            WIDTH_PX,
            HEIGHT_PX,
            image::ExtendedColorType::L8,
        )?;
        std::fs::write(file, bytes)?;
        Ok(())
    }

    /// How bright the bare paper is.
    fn light(&self, point: Point) -> f64 {
        let across = point.x / f64::from(WIDTH_PX);
        let down = point.y / f64::from(HEIGHT_PX);
        let shadow = SHADOW * (-point.x.max(0.0) / SHADOW_PX * (1.0 + 0.3 * down)).exp();
        let grain =
            0.020 * (noise(point, 1.6, self.seed ^ 0xb1) - 0.5) + 0.016 * (noise(point, 5.0, self.seed ^ 0xc3) - 0.5);
        let stain = 0.030 * (noise(point, 170.0, self.seed ^ 0xd5) - 0.5);
        PAPER - FALLOFF * (0.7 * (1.0 - across) + 0.3 * down) - shadow + grain + stain
    }
}

/// Smooth noise between 0 and 1, whose bumps are `length` apart.
fn noise(point: Point, length: f64, seed: u32) -> f64 {
    let [x, y] = [point.x / length, point.y / length];
    let [left, top] = [x.floor(), y.floor()];
    let smooth = |part: f64| part * part * (3.0 - 2.0 * part);
    let (across, down) = (smooth(x - left), smooth(y - top));
    let value = |column: f64, row: f64| f64::from(scattered(column as i32, row as i32, seed)) / f64::from(u32::MAX);
    let between = |a: f64, b: f64, part: f64| a + (b - a) * part;
    between(
        between(value(left, top), value(left + 1.0, top), across),
        between(value(left, top + 1.0), value(left + 1.0, top + 1.0), across),
        down,
    )
}

/// A number that has nothing to do with that of the next cell (a finaliser of MurmurHash3).
fn scattered(column: i32, row: i32, seed: u32) -> u32 {
    let mut bits = (column as u32).wrapping_mul(0x9e37_79b1)
        ^ (row as u32).wrapping_mul(0x85eb_ca77)
        ^ seed.wrapping_mul(0xc2b2_ae3d);
    for factor in [0x85eb_ca6b, 0xc2b2_ae35] {
        bits = (bits ^ (bits >> 15)).wrapping_mul(factor);
    }
    bits ^ (bits >> 16)
}
