//! Figures that lie over themselves, painted region after region.
//!
//! The textures and the mesh are those of any figure; what differs is that a place of the frame may be in several triangles.
//!
//! 1. The mesh is divided into regions that can be painted at once (`division`); in a frame they are painted from back to front.
//! 2. Each is cut out by its own edge (`rim`): the blended outline where it ends, and a little way into its neighbours where it does not.
//! 3. What another region hides in a drawing is shown from the drawings that show it (`pictures`).
//! 4. Within a region what is stretched least is in front, and what is torn is not shown (`stretch`).
//! 5. Where one drawing alone is seen, nothing is hidden that it does not hide itself: the frame is that drawing, whole, and near there it becomes it.

mod depth_order;
mod division;
mod pictures;
mod regions;
mod rim;
mod stretch;

use rayon::prelude::*;

pub use self::depth_order::DepthOrder;
pub(crate) use self::pictures::{RegionPictures, cut_out};
pub(crate) use self::regions::{RegionMesh, Regions};
use self::stretch::in_order;
use super::painter::weights_of_drawings;
use super::{Camera, Frame, PaintOptions, Painter, PoseTexture, Silhouette, Texture};
use crate::input::Drawing;
use crate::math::{Point, smooth_step};
use crate::pose::Mapping;

/// From this weight of a drawing on a frame becomes that drawing.
const NEARLY_ALONE: f64 = 0.92;
/// From this one on it is.
const ALONE: f64 = 1.0 - 1e-9;

/// Paints frames of a figure that lies over itself.
#[derive(Debug, Clone)]
pub(crate) struct OverlapPainter {
    regions: Regions,
    /// One a region.
    painters: Vec<Painter>,
    /// With the drawings as they are.
    whole: Painter,
    drawn: Vec<Drawn>,
    /// By pose, its drawing.
    drawing_of: Vec<usize>,
    silhouette: Silhouette,
    camera: Camera,
}

/// A drawing that may be seen alone.
#[derive(Debug, Clone)]
struct Drawn {
    /// The pose that it is drawn on.
    pose: usize,
    /// Of its outline and openings, in source units.
    rings: Vec<Vec<Point>>,
    /// Where the mesh's first vertex is there.
    first: Point,
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
                Painter::new(
                    mapping,
                    textures,
                    drawing_of.to_vec(),
                    silhouette.clone(),
                    camera,
                    options,
                )
            })
            .collect();
        let textures = (drawings.iter())
            .map(|(drawing, drawn_on)| PoseTexture {
                texture: Texture::new(&drawing.picture, &drawing.outline, samples),
                drawn_on: *drawn_on,
            })
            .collect();
        let shown = drawing_of.to_vec();
        let positions = mapping.poses.positions();
        Self {
            painters,
            whole: Painter::new(mapping, textures, shown, silhouette.clone(), camera, options),
            drawn: (drawings.iter())
                .map(|(drawing, pose)| Drawn {
                    pose: *pose,
                    rings: (drawing.outline.rings().iter().chain(drawing.outline.openings()))
                        .map(|ring| ring.points().to_vec())
                        .collect(),
                    first: positions[*pose].first().copied().unwrap_or_default(),
                })
                .collect(),
            drawing_of: drawing_of.to_vec(),
            regions,
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
        let seen = (positions, weights, texture_weights);
        let rings = self.silhouette.at(positions, weights);
        let rest = self.regions.rest();
        let (drawing, weight) = self.most_seen(weights, texture_weights);
        if weight >= ALONE {
            let drawn = &self.drawn[drawing];
            let shift = positions.first().copied().unwrap_or_default() - drawn.first;
            let rings = drawn.rings.iter().map(|ring| ring.iter().map(|p| p + shift).collect());
            return self.whole.paint_patch(seen, rest.triangles(), rings.collect());
        }
        let stretches = rest.stretches(positions);
        let shown = |painted: &[usize]| -> Vec<[usize; 3]> {
            let order = in_order(painted, &stretches);
            order.iter().map(|t| rest.triangles()[*t]).collect()
        };
        let mut frame: Option<Frame> = None;
        for region in self.regions.order().from_back_to_front(weights, texture_weights) {
            let within = self.regions.rims_in(region, &rings, positions);
            let own = self.painters[region].paint_patch(seen, &shown(self.regions.painted(region)), within);
            match &mut frame {
                None => frame = Some(own),
                Some(frame) => frame.put_over(&own, 1.0),
            }
        }
        let mut frame = frame.unwrap_or_else(|| {
            let [columns, rows] = self.camera.size();
            Frame::filled(columns, rows, [0; 4])
        });
        if weight > NEARLY_ALONE {
            let all: Vec<usize> = (0..rest.triangles().len()).collect();
            let whole = self.whole.paint_patch(seen, &shown(&all), rings);
            frame.mix(&whole, smooth_step(weight, NEARLY_ALONE, 1.0));
        }
        frame
    }

    /// The drawing that is seen most, and how far nothing else is and the shape is that which it was made on.
    fn most_seen(&self, weights: &[f64], texture_weights: &[f64]) -> (usize, f64) {
        let seen = weights_of_drawings(self.drawn.len(), self.drawing_of.iter().copied(), texture_weights);
        let most = (0..seen.len())
            .max_by(|a, b| seen[*a].total_cmp(&seen[*b]))
            .unwrap_or(0);
        let Some(drawn) = self.drawn.get(most) else {
            return (0, 0.0);
        };
        // A copy of the pose that is deformed may show what the drawing hides.
        let shape = weights.get(drawn.pose).copied().unwrap_or(0.0);
        (most, seen[most].min(shape))
    }
}
