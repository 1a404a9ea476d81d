//! Figures that lie over themselves, painted region after region.
//!
//! The textures and the mesh are those of any figure; what differs is that a place of the frame may be in several triangles.
//!
//! 1. The mesh is divided into regions that can be painted at once (`division`); in a frame they are painted from back to front.
//! 2. Each is cut out by its own edge (`rim`): the blended outline where it ends, and a little way into its neighbours where it does not.
//! 3. What another region hides in a drawing is shown from the drawings that show it (`pictures`).
//! 4. Where one drawing alone is seen, nothing is hidden that it does not hide itself: the frame is that drawing, whole, and near there it becomes it.

mod division;
mod pictures;
mod rim;
mod stretch;

use rayon::prelude::*;

use self::division::Division;
use self::rim::{Boundary, Rim};
use self::stretch::{AtRest, in_order};
use super::{Camera, Frame, PaintOptions, Painter, PoseTexture, Silhouette, Texture};
use crate::input::Drawing;
use crate::math::{Point, smooth_step};
use crate::pose::Mapping;

/// Rings of triangles by which a region is painted beyond its rim, and by which its rim lies beyond it.
const PAINTED_RINGS: usize = 2;
const RIM_RINGS: usize = 1;

/// From this weight of a drawing on a frame becomes that drawing.
const NEARLY_ALONE: f64 = 0.92;
/// From this one on it is.
const ALONE: f64 = 1.0 - 1e-9;
/// What the weight of a shape counts beside that of its drawing for the order of regions.
const FAINT: f64 = 1e-6;

/// Paints frames of a figure that lies over itself.
#[derive(Debug, Clone)]
pub(crate) struct OverlapPainter {
    division: Division,
    regions: Vec<Region>,
    triangles: Vec<[usize; 3]>,
    rest: AtRest,
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

#[derive(Debug, Clone)]
struct Region {
    painter: Painter,
    /// The triangles that it is painted with.
    painted: Vec<usize>,
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
        let rest = AtRest::new(mapping.poses.topology(), &positions[open]);
        let stretched: Vec<Vec<f64>> = positions.iter().map(|pose| rest.stretches(pose)).collect();
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
                        let (picture, rims) = pictures.of(region, drawing, &in_order(&painted, &stretched[*drawn_on]));
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
                    painter,
                    painted,
                    rims: rims[region].clone(),
                }
            })
            .collect();
        let textures = (drawings.iter())
            .map(|(drawing, drawn_on)| PoseTexture {
                texture: Texture::new(&drawing.picture, &drawing.outline, samples),
                drawn_on: *drawn_on,
            })
            .collect();
        let shown = drawing_of.to_vec();
        let whole = Painter::new(mapping, textures, shown, silhouette.clone(), camera, options);
        Self {
            division,
            regions,
            triangles: triangles.to_vec(),
            rest,
            whole,
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
            silhouette,
            camera,
        }
    }

    /// The frame of the figure whose #vertices positions are `positions`, as of [`Painter::paint`].
    #[must_use]
    pub(crate) fn paint(&self, positions: &[Point], weights: &[f64], texture_weights: &[f64]) -> Frame {
        let seen = (positions, weights, texture_weights);
        let rings = self.silhouette.at(positions, weights);
        let (drawing, weight) = self.most_seen(weights, texture_weights);
        if weight >= ALONE {
            let drawn = &self.drawn[drawing];
            let shift = positions.first().copied().unwrap_or_default() - drawn.first;
            let rings = drawn.rings.iter().map(|ring| ring.iter().map(|p| p + shift).collect());
            return self.whole.paint_patch(seen, &self.triangles, rings.collect());
        }
        let stretches = self.rest.stretches(positions);
        let mut frame: Option<Frame> = None;
        // Where no drawing of a pose that lies over itself is seen, its shape may count all the same.
        let counts = texture_weights
            .iter()
            .zip(weights)
            .map(|(seen, own)| seen + FAINT * own.max(0.0));
        for region in self.division.order(&counts.collect::<Vec<_>>()) {
            let Region { painter, painted, rims } = &self.regions[region];
            let shown = corners(&self.triangles, &in_order(painted, &stretches));
            let within: Vec<Vec<Point>> = rims.iter().map(|rim| rim.at(&rings, positions)).collect();
            let own = painter.paint_patch(seen, &shown, within);
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
            let all: Vec<usize> = (0..self.triangles.len()).collect();
            let shown = corners(&self.triangles, &in_order(&all, &stretches));
            let whole = self.whole.paint_patch(seen, &shown, rings);
            frame.mix(&whole, smooth_step(weight, NEARLY_ALONE, 1.0));
        }
        frame
    }

    /// The drawing that is seen most, and how far nothing else is and the shape is that which it was made on.
    fn most_seen(&self, weights: &[f64], texture_weights: &[f64]) -> (usize, f64) {
        let mut seen = vec![0.0; self.drawn.len()];
        for (drawing, weight) in self.drawing_of.iter().zip(texture_weights) {
            if let Some(sum) = seen.get_mut(*drawing) {
                *sum += weight;
            }
        }
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
