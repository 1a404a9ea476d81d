//! Forms in space as pictures: a small renderer for contact sheets and single views, not for realism.
//!
//! Triangles, positions and normals -> a [`Frame`] with a clear background; many forms of a space -> one [`Sheet`].
//!
//! 1. [`View`] turns the form and looks at it from afar: an orthographic view, so that equal sizes look equal anywhere.
//! 2. `raster` finds the nearest triangle for K x K samples of every pixel (a depth buffer; both sides of a triangle count).
//! 3. `light` shades each sample with the normal interpolated over the triangle, in linear light: a key light from the upper left, a
//!    fill light from the right, sky and ground, a soft highlight, and a rim that sets the form off from its background.
//! 4. The samples of a pixel are averaged in linear light, and encoded by the sRGB curve.
//!
//! Cost: linear in triangles and in samples covered. Nothing depends on the number of threads.
//!
//! Limits: no shadows, no transparency, no perspective. A texture is looked up in one of its halved copies, chosen for the whole
//! form.

mod light;
mod mip;
mod raster;
mod sheet;
mod sheet_layout;
#[cfg(test)]
mod tests;
mod view;

pub(crate) use light::Look;
pub(crate) use sheet::{CellKind, Sheet, SheetAxis, SheetCell};
pub(crate) use view::{View, Window};

use super::Frame;
use crate::math::Point3;
use mip::Mip;
use rayon::prelude::*;

/// What all forms of a picture share: triangles, and where their corners lie in a texture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ShadedMesh<'a> {
    /// Vertices, counter-clockwise seen from outside.
    pub triangles: &'a [[usize; 3]],
    /// Places in the texture, from its lower left corner: (1, 1) is the upper right one.
    pub texture_places: &'a [[f64; 2]],
    /// Indices of texture places, as many as triangles, or none.
    pub texture_triangles: &'a [[usize; 3]],
}

/// One form.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ShadedForm<'a> {
    /// Positions, #vertices.
    pub positions: &'a [Point3],
    /// Unit normals, #vertices.
    pub normals: &'a [Point3],
    /// What is on it, where the mesh has places in a texture.
    pub texture: Option<&'a Frame>,
}

/// Samples along each side of a pixel.
pub(crate) const SAMPLES: usize = 4;
/// About how many pixels are drawn at a time, and at most how many rows: a few megabytes of samples.
const BAND: usize = 1 << 16;
const MOST_ROWS: usize = 64;

/// Draws a form through a window of the view, `size` columns and rows large, on a clear background.
///
/// Vertices that are not finite, and triangles that name others than there are, are left out.
#[must_use]
pub(crate) fn shade(mesh: &ShadedMesh<'_>, form: &ShadedForm<'_>, view: &View, window: &Window, look: &Look) -> Frame {
    let [width, height] = window.size;
    let samples = SAMPLES as f64;
    let place = |p: &Point3| {
        let seen = view.turned(*p);
        let [x, y] = window.place(&seen);
        Point3::new(x * samples, y * samples, seen.z)
    };
    let places: Vec<Point3> = form.positions.iter().map(place).collect();
    let normals: Vec<Point3> = form.normals.iter().map(|n| view.turned(*n)).collect();
    let texture = form
        .texture
        .filter(|_| mesh.texture_triangles.len() == mesh.triangles.len())
        .and_then(|texture| Mip::new(texture, mesh, &places));
    // What one sample shows, as light.
    let light_of = |hit: raster::Hit, x: usize, y: usize| {
        let corners = mesh.triangles[hit.triangle];
        let normal = mixed(corners.map(|v| normals.get(v).copied().unwrap_or_default()), hit.shares);
        let albedo = match &texture {
            Some(texture) => texture.light_at(mesh, hit.triangle, hit.shares),
            None => look.albedo(),
        };
        look.light(albedo, normal, [x, y])
    };
    let rows_a_band = (BAND / width.max(1)).clamp(1, MOST_ROWS);
    let bands = (0..height.div_ceil(rows_a_band)).into_par_iter();
    let band = |band: usize| {
        let rows = band * rows_a_band..((band + 1) * rows_a_band).min(height);
        let sample_rows = rows.start * SAMPLES..rows.end * SAMPLES;
        let buffer = raster::nearest(mesh.triangles, &places, width * SAMPLES, sample_rows);
        let mut pixels = Vec::with_capacity(width * rows.len());
        for (row, column) in rows.flat_map(|row| (0..width).map(move |column| (row, column))) {
            let mut sum = [0.0; 3];
            let mut covered = 0;
            for k in 0..SAMPLES * SAMPLES {
                let (x, y) = (column * SAMPLES + k % SAMPLES, row * SAMPLES + k / SAMPLES);
                let Some(hit) = buffer.at(x, y) else { continue };
                for (sum, light) in sum.iter_mut().zip(light_of(hit, x, y)) {
                    *sum += light;
                }
                covered += 1;
            }
            pixels.push(light::encoded(sum, covered, SAMPLES * SAMPLES));
        }
        pixels
    };
    let pixels: Vec<Vec<[u8; 4]>> = bands.map(band).collect();
    let pixels = pixels.concat();
    Frame { width, height, pixels }
}

fn mixed(corners: [Point3; 3], shares: [f64; 3]) -> Point3 {
    corners[0] * shares[0] + corners[1] * shares[1] + corners[2] * shares[2]
}
