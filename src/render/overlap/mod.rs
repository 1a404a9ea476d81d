//! Figures that lie over themselves, painted region after region.
//!
//! The textures and the mesh are those of any figure; what differs is that a place of the frame may be in several triangles.
//!
//! 1. The mesh is divided into regions that can be painted at once (`division`); in a frame they are painted from back to front.
//! 2. Each is cut out by its own edge (`rim`): the blended outline where it ends, and a little way into its neighbours where it does not.
//! 3. What another region hides in a drawing is shown from the drawings that show it (`pictures`).

mod depth_order;
mod division;
mod pictures;
mod regions;
mod rim;

use rayon::prelude::*;

pub use self::depth_order::DepthOrder;
pub(crate) use self::pictures::{RegionPictures, cut_out};
pub(crate) use self::regions::{RegionMesh, Regions};
use super::{Camera, Frame, PaintOptions, Painter, PoseTexture, Silhouette, Texture};
use crate::input::Drawing;
use crate::math::Point;
use crate::pose::Mapping;

/// Paints frames of a figure that lies over itself.
#[derive(Debug, Clone)]
pub(crate) struct OverlapPainter {
    regions: Regions,
    /// One a region.
    painters: Vec<Painter>,
    silhouette: Silhouette,
    camera: Camera,
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
        let regions = Regions::new(mapping, &silhouette);
        let samples = camera.scale() * options.supersample.clamp(1, PaintOptions::MOST_SAMPLES) as f64;
        let pictures = RegionPictures::new(mapping, &regions, drawings);
        let painters = (0..regions.count())
            .into_par_iter()
            .map(|region| {
                let textures = (drawings.iter().enumerate())
                    .map(|(drawing, (_, drawn_on))| PoseTexture {
                        texture: Texture::within(
                            &pictures.of(region, drawing),
                            &regions.rims_at(region, *drawn_on, mapping),
                            samples,
                        ),
                        drawn_on: *drawn_on,
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
                painter.of_triangles(regions.painted(region, mapping))
            })
            .collect();
        Self {
            regions,
            painters,
            silhouette,
            camera,
        }
    }

    /// The regions that it paints.
    #[must_use]
    pub(crate) fn regions(&self) -> &Regions {
        &self.regions
    }

    /// The frame of the figure whose #vertices positions are `positions`, as of [`Painter::paint`].
    #[must_use]
    pub(crate) fn paint(&self, positions: &[Point], weights: &[f64], texture_weights: &[f64]) -> Frame {
        let rings = self.silhouette.at(positions, weights);
        let mut frame: Option<Frame> = None;
        for region in self.regions.order().from_back_to_front(weights, texture_weights) {
            let within = self.regions.rims_in(region, &rings, positions);
            let own = self.painters[region].paint_within(positions, weights, texture_weights, within);
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
