//! Figures that lie over themselves, painted region after region.
//!
//! The textures and the mesh are those of any figure; what differs is that a place of the frame may be in several triangles.
//!
//! 1. The mesh is divided into regions that can be painted at once (`division`); in a frame they are painted from back to front.
//! 2. Each is cut out by its own edge (`rim`): the blended outline where it ends, and a little way into its neighbours where it does not.
//! 3. What another region hides in a drawing is shown from the drawings that show it (`pictures`).

mod division;
mod pictures;
mod rim;

use rayon::prelude::*;

use self::division::Division;
use self::rim::{Boundary, Rim};
use super::{Camera, Frame, PaintOptions, Painter, PoseTexture, Silhouette, Texture};
use crate::input::Drawing;
use crate::math::Point;
use crate::pose::Mapping;

/// Rings of triangles by which a region is painted beyond its rim, and by which its rim lies beyond it.
const PAINTED_RINGS: usize = 2;
const RIM_RINGS: usize = 1;

/// What the weight of a shape counts beside that of its drawing for the order of regions.
const FAINT: f64 = 1e-6;

/// Paints frames of a figure that lies over itself.
#[derive(Debug, Clone)]
pub(crate) struct OverlapPainter {
    division: Division,
    regions: Vec<Region>,
    silhouette: Silhouette,
    camera: Camera,
}

#[derive(Debug, Clone)]
struct Region {
    painter: Painter,
    rims: Vec<Rim>,
}

impl OverlapPainter {
    /// A painter of `mapping`, seen by `camera`. Every drawing was made on one pose; `drawing_of` says which one each pose shows.
    #[must_use]
    pub(crate) fn new(
        mapping: &Mapping,
        drawings: &[(&Drawing, usize)],
        drawing_of: &[usize],
        silhouette: Silhouette,
        camera: Camera,
        options: PaintOptions,
    ) -> Self {
        let division = Division::new(mapping);
        let triangles = mapping.poses.topology().triangles();
        let positions = mapping.poses.positions();
        let unit = |pose: usize| -> Vec<f64> { (0..positions.len()).map(|k| f64::from(u8::from(k == pose))).collect() };
        let shown: Vec<Vec<Vec<Point>>> = (0..positions.len())
            .map(|pose| silhouette.at(&positions[pose], &unit(pose)))
            .collect();
        let open = (0..positions.len())
            .find(|pose| mapping.overlaps.depth(*pose).is_none())
            .unwrap_or(0);
        let boundary = Boundary::new(&mapping.rings, &shown[open], &positions[open]);
        let grown: Vec<Vec<usize>> = (0..division.count)
            .map(|region| {
                (0..triangles.len())
                    .filter(|t| division.region_of[*t] == region)
                    .collect()
            })
            .collect();
        let rims: Vec<Vec<Rim>> = (grown.iter())
            .map(|own| boundary.rims(&corners(triangles, &with_rings(triangles, own, RIM_RINGS))))
            .collect();
        let samples = camera.scale() * options.supersample.clamp(1, PaintOptions::MOST_SAMPLES) as f64;
        let pictures = pictures::Pictures {
            mapping,
            division: &division,
            drawings,
            rims: &rims,
            shown: &shown,
            hidden: Vec::new(),
        }
        .with_hidden();
        let regions = (0..division.count)
            .into_par_iter()
            .map(|region| {
                let painted = with_rings(triangles, &grown[region], PAINTED_RINGS);
                let textures = (drawings.iter().enumerate())
                    .map(|(drawing, (_, drawn_on))| {
                        let (picture, rims) = pictures.of(region, drawing, &painted);
                        PoseTexture {
                            texture: Texture::within(&picture, &rims, samples),
                            drawn_on: *drawn_on,
                        }
                    })
                    .collect();
                let painter = Painter::new(
                    mapping,
                    textures,
                    drawing_of.to_vec(),
                    silhouette.clone(),
                    camera,
                    options,
                );
                Region {
                    painter: painter.of_triangles(corners(triangles, &painted)),
                    rims: rims[region].clone(),
                }
            })
            .collect();
        Self {
            division,
            regions,
            silhouette,
            camera,
        }
    }

    /// The frame of the figure whose #vertices positions are `positions`, as of [`Painter::paint`].
    #[must_use]
    pub(crate) fn paint(&self, positions: &[Point], weights: &[f64], texture_weights: &[f64]) -> Frame {
        let rings = self.silhouette.at(positions, weights);
        let mut frame: Option<Frame> = None;
        // Where no drawing of a pose that lies over itself is seen, its shape may count all the same.
        let counts = texture_weights
            .iter()
            .zip(weights)
            .map(|(seen, own)| seen + FAINT * own.max(0.0));
        for region in self.division.order(&counts.collect::<Vec<_>>()) {
            let Region { painter, rims } = &self.regions[region];
            let within: Vec<Vec<Point>> = rims.iter().map(|rim| rim.at(&rings, positions)).collect();
            let own = painter.paint_within(positions, weights, texture_weights, within);
            match &mut frame {
                None => frame = Some(own),
                Some(frame) => frame.put_over(&own, 1.0),
            }
        }
        frame.unwrap_or_else(|| {
            let [columns, rows] = self.camera.size();
            Frame::filled(columns, rows, [0; 4])
        })
    }
}

/// Some triangles and those around them, in order.
fn with_rings(triangles: &[[usize; 3]], own: &[usize], rings: usize) -> Vec<usize> {
    let mut is_in = vec![false; triangles.len()];
    own.iter().for_each(|t| is_in[*t] = true);
    let most = triangles.iter().flatten().max().map_or(0, |v| v + 1);
    for _ in 0..rings {
        let mut touched = vec![false; most];
        let inside = (0..triangles.len()).filter(|t| is_in[*t]);
        inside.flat_map(|t| triangles[t]).for_each(|v| touched[v] = true);
        for (t, triangle) in triangles.iter().enumerate() {
            is_in[t] |= triangle.iter().any(|v| touched[*v]);
        }
    }
    (0..triangles.len()).filter(|t| is_in[*t]).collect()
}

fn corners(triangles: &[[usize; 3]], numbers: &[usize]) -> Vec<[usize; 3]> {
    numbers.iter().map(|t| triangles[*t]).collect()
}
