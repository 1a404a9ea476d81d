//! Frames of pixel art: every pixel is one texel of each drawing, and is inside the figure or is not.
//!
//! Mesh, placed in the frame, and textures with their weights -> the frame.
//!
//! 1. Each pixel whose centre lies in a triangle is taken by that triangle's affine map to a texel of each texture. A pixel that lies in
//!    none, but less than [`REACH_TEXELS`] from one that does, is taken by the map of that one: texels are squares, and their corners
//!    stand out of a mesh that encloses a smooth outline.
//! 2. A pixel is inside if the textures whose texel lies inside their outline have at least half of the weight. So at a pose the
//!    figure is its drawing, texel for texel, and with the weight on one texture there is no colour that it has not.
//! 3. Inside, the colour is the mean of the textures' texels, by their weights. Outside of their outlines textures have the nearest
//!    texel within.
//!
//! Differs from [`super::painter`]: there the edge is the blended outline, with the exact area that it covers.
//!
//! Cost: O(#pixels in the mesh's box x #textures). Limits: a frame that shows a drawing smaller than it is leaves out texels.

use rayon::prelude::*;

use super::affine_map::{AffineMap, TriangleFrame};
use super::band::Window;
use super::colour_blend::{ColourBlend, Light, Linear, Plain};
use super::nearest_seed::{distance_squared, nearest_seeds};
use super::raster::PlacedVertices;
use super::sampler::{LANES, WHOLE_WEIGHT};
use super::{Frame, Texture};
use crate::math::Point;
use crate::mesh::geometry;

/// How far from the mesh a texel may reach: half its diagonal lies outside of the smooth outline at most, and as much of the pixel.
const REACH_TEXELS: f64 = 1.5;

/// A texture that counts in a frame.
pub(super) struct NearestTexture<'a> {
    pub(super) texture: &'a Texture,
    /// #vertices, in texels.
    pub(super) texels: &'a [Point],
    /// Of [`WHOLE_WEIGHT`].
    pub(super) weight: u32,
}

/// The columns of row `row` of a grid of `width` columns whose centres lie inside rings, in order. Points must be finite.
pub(super) fn centres_inside(rings: &[Vec<Point>], row: usize, width: usize) -> Vec<std::ops::Range<usize>> {
    let y = row as f64 + 0.5;
    let mut crossings: Vec<f64> = Vec::new();
    for ring in rings {
        for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            // Half open, so that a vertex on the line counts once.
            if (a.y <= y) != (b.y <= y) {
                crossings.push(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x));
            }
        }
    }
    crossings.sort_unstable_by(f64::total_cmp);
    // Casts saturate.
    let column = |x: f64| ((x - 0.5).ceil().max(0.0) as usize).min(width);
    let runs = crossings.chunks_exact(2).map(|pair| column(pair[0])..column(pair[1]));
    runs.filter(|run| run.start < run.end).collect()
}

/// The frame of `size` (columns, rows) of a mesh at `placed`, in pixels; its background is clear.
pub(super) fn paint_nearest(
    triangles: &[[usize; 3]],
    placed: &[Point],
    shown: &[NearestTexture<'_>],
    size: [usize; 2],
    blending: ColourBlend,
) -> Frame {
    let [columns, rows] = size;
    let mut frame = Frame::filled(columns, rows, [0; 4]);
    let vertices = PlacedVertices::new(placed);
    let Some(reach) = reach_px(&vertices, triangles, shown) else {
        return frame;
    };
    let around = [-reach, reach].map(|by| Point::new(by, by));
    let corners: Vec<Point> = placed.iter().flat_map(|p| around.map(|by| *p + by)).collect();
    let Some(window) = Window::around(corners.iter(), columns, rows) else {
        return frame;
    };
    let shift = Point::new(window.left as f64, window.top as f64);
    let placed: Vec<Point> = placed.iter().map(|p| *p - shift).collect();
    let vertices = PlacedVertices::new(&placed);
    let triangle_of = triangles_at(&vertices, triangles, &window, reach);
    let maps: Vec<Vec<AffineMap>> = triangles
        .par_iter()
        .map(|triangle| {
            let from = TriangleFrame::new(vertices.corners(*triangle));
            let to = |of: &NearestTexture<'_>| from.map_to(geometry::corners(of.texels, *triangle));
            shown.iter().map(to).collect()
        })
        .collect();
    let pixels = &mut frame.pixels[window.top * columns..(window.top + window.height) * columns];
    pixels.par_chunks_mut(columns).enumerate().for_each(|(row, pixels)| {
        let of_row = &triangle_of[row * window.width..(row + 1) * window.width];
        let pixels = &mut pixels[window.left..window.left + window.width];
        for (column, (pixel, triangle)) in pixels.iter_mut().zip(of_row).enumerate() {
            let Some(maps) = maps.get(*triangle as usize) else {
                continue;
            };
            let centre = Point::new(column as f64 + 0.5, row as f64 + 0.5);
            let texels = shown.iter().zip(maps).map(|(of, map)| {
                let (texel, is_inside) = of.texture.nearest(map.apply(centre));
                (texel, is_inside, of.weight)
            });
            *pixel = match blending {
                // One texture alone is the same in either light.
                ColourBlend::Linear if shown.len() > 1 => mean(texels, Linear::new()),
                _ => mean(texels, Plain),
            };
        }
    });
    frame
}

/// How far beyond the mesh texels may be seen, in pixels; `None` if nothing is seen.
fn reach_px(vertices: &PlacedVertices, triangles: &[[usize; 3]], shown: &[NearestTexture<'_>]) -> Option<f64> {
    let area_px = vertices.covered_area(triangles);
    let texel_px = shown.iter().map(|of| {
        let area = |t: &[usize; 3]| geometry::signed_area(geometry::corners(of.texels, *t));
        let texels: f64 = triangles.iter().map(area).sum();
        (area_px / texels).sqrt()
    });
    let largest = texel_px.fold(0.0, f64::max);
    (largest > 0.0 && largest.is_finite()).then_some(REACH_TEXELS * largest + 1.0)
}

/// For each pixel of the window the triangle whose map it is taken by; the largest number where there is none.
fn triangles_at(vertices: &PlacedVertices, triangles: &[[usize; 3]], window: &Window, reach: f64) -> Vec<u32> {
    const NONE: u32 = u32::MAX;
    let (width, height) = (window.width, window.height);
    let mut covered = vec![NONE; width * height];
    vertices.for_each_span(triangles, width, 0..height, |span| {
        covered[span.row * width + span.start..span.row * width + span.end].fill(span.triangle as u32);
    });
    let Some(nearest) = nearest_seeds(width, height, |at| covered[at] != NONE) else {
        return covered;
    };
    let is_near = |at: usize| distance_squared(at, nearest[at], width) <= reach * reach;
    (0..width * height)
        .map(|at| {
            if is_near(at) {
                covered[nearest[at] as usize]
            } else {
                NONE
            }
        })
        .collect()
}

/// The mean of texels, with whether each lies inside and its weight; clear where most of the weight is outside.
fn mean(texels: impl Iterator<Item = ([u8; 4], bool, u32)>, light: impl Light) -> [u8; 4] {
    let mut sums = [[0; LANES]; 4];
    let mut inside = 0;
    for (texel, is_inside, weight) in texels {
        inside += if is_inside { weight } else { 0 };
        let mut channels = [[0; LANES]; 4];
        for (channel, value) in channels.iter_mut().zip(texel) {
            channel[0] = u32::from(value) << 8;
        }
        let channels = light.decode(channels);
        for (sum, channel) in sums.iter_mut().zip(&channels) {
            sum[0] += channel[0] * weight;
        }
    }
    if 2 * inside < WHOLE_WEIGHT {
        return [0; 4];
    }
    light.encode(&sums)[0]
}
