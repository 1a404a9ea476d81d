//! The regions of a layer that lies over itself, as drawings of their own.
//!
//! A built layer -> its regions, from back to front ([`OverlapRegions`]): what each shows in every drawing, whole where another one hides it; which lies in front in which pose;
//! and where each hangs on another.
//!
//! - A region hangs on the neighbour with which it has the longest joint, beginning at the largest region, so that a limb's parts hang on one another as a chain and the first
//!   of them on the trunk. Where a region has several neighbours the others are told ([`NoteKind::JointsLeft`]).
//! - The joint is the middle of the edges of the mesh that two regions share in a pose that does not lie over itself; the mesh carries it to the others.
//! - Limits: what lies in front of itself by way of others has no order; it is painted as frames are, and that is told ([`NoteKind::DepthCycle`]).

use std::sync::Arc;

use super::PipelineError;
use super::build::Build;
use super::drawings::sharpen;
use super::note::{Note, NoteKind};
use super::spec::{DrawnPose, LayerSpec};
use crate::input::{Canvas, Drawing, Picture};
use crate::math::Point;
use crate::mesh::{PointLocator, geometry};
use crate::pose::Mapping;
use crate::render::{RegionPictures, Regions, cut_out};

/// Points around the edge of a region that hold its drawings together where it is matched by itself: the edge of a cut says little.
const EDGE_POINTS: usize = 8;

/// The regions of one layer of a build that lies over itself.
#[derive(Debug)]
pub struct OverlapRegions<'a> {
    layer: &'a LayerSpec,
    mapping: &'a Mapping,
    /// As they are used.
    drawings: Vec<Arc<Drawing>>,
    regions: Regions,
    /// The regions from back to front, where a pose does not say otherwise.
    order: Vec<usize>,
    /// By region, what it hangs on.
    joints: Vec<Option<Joint>>,
    notes: Vec<Note>,
}

/// Where a region hangs on another one.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Joint {
    /// The other region.
    pub to: usize,
    /// The place of the joint on each of the layer's drawings, as they are in their files.
    pub at: Vec<Point>,
}

/// The pixels that a drawing is written in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PixelGrid {
    /// The place of the drawing where the corner of the first pixel lies.
    pub low: Point,
    /// Pixels a unit of the drawing.
    pub pixels_per_unit: f64,
    /// Columns and rows.
    pub size: [usize; 2],
}

impl PixelGrid {
    /// The whole canvas of a drawing.
    #[must_use]
    pub fn of(canvas: &Canvas, pixels_per_unit: f64) -> Self {
        // Casts saturate.
        let size = (canvas.size() * pixels_per_unit).map(|side| side.round().max(1.0) as usize);
        Self {
            low: canvas.low,
            pixels_per_unit,
            size: [size.x, size.y],
        }
    }

    /// A place of the drawing in pixels.
    #[must_use]
    pub fn to_pixels(&self, place: Point) -> Point {
        (place - self.low) * self.pixels_per_unit
    }

    /// A picture of `pose` as it is used, on this grid of the drawing as it is.
    fn filled(&self, picture: &Picture, pose: &DrawnPose) -> Picture {
        let [width, height] = self.size;
        let pixel = |index: usize| {
            let centre = Point::new((index % width) as f64 + 0.5, (index / width) as f64 + 0.5);
            let place = pose.used_place(self.low + centre / self.pixels_per_unit);
            interpolated(picture, picture.to_pixels(place) - Point::repeat(0.5))
        };
        Picture {
            width,
            height,
            pixels: (0..width * height).map(pixel).collect(),
            origin: self.low,
            pixels_per_unit: self.pixels_per_unit,
        }
    }
}

impl Build {
    /// The regions of a layer, if it lies over itself. Vector drawings are drawn with at least `pixels_per_unit` pixels a unit.
    ///
    /// # Errors
    /// [`PipelineError`] if a vector drawing cannot be drawn so.
    pub fn overlap_regions(
        &self,
        layer: usize,
        pixels_per_unit: f64,
    ) -> Result<Option<OverlapRegions<'_>>, PipelineError> {
        let shape = &self.layers()[layer];
        let (spec, mapping) = (&self.spec().layers[layer], shape.mapping());
        if mapping.overlaps.is_empty() {
            return Ok(None);
        }
        let mut drawings = self.drawings(layer).to_vec();
        sharpen(spec, &mut drawings, pixels_per_unit)?;
        let regions = Regions::new(mapping, &shape.silhouette);
        let even = vec![1.0; mapping.poses.len()];
        let order = regions.order().from_back_to_front(&even, &even);
        let mut notes = Vec::new();
        let joints = joints(spec, mapping, &regions, &mut notes);
        let found = OverlapRegions {
            layer: spec,
            mapping,
            drawings,
            regions,
            order,
            joints,
            notes: Vec::new(),
        };
        notes.extend(found.cycles());
        Ok(Some(OverlapRegions { notes, ..found }))
    }

    /// The picture of one drawing of a layer, counted like [`Self::drawings`], cut out by its outline, on a grid of the drawing as it is in its file.
    ///
    /// # Errors
    /// As [`Self::overlap_regions`].
    pub fn cut_out(&self, layer: usize, drawing: usize, grid: &PixelGrid) -> Result<Picture, PipelineError> {
        let spec = &self.spec().layers[layer];
        let mut drawings = self.drawings(layer).to_vec();
        sharpen(spec, &mut drawings, grid.pixels_per_unit)?;
        let pose = spec.drawn().nth(drawing);
        let (Some(pose), Some(drawing)) = (pose, drawings.get(drawing)) else {
            return Err(PipelineError::stage(&[], None, "there is no such drawing".to_owned()));
        };
        Ok(grid.filled(&cut_out(&drawing.picture, &drawing.outline), pose))
    }
}

impl OverlapRegions<'_> {
    /// What the regions are called: each as the limb that most of it belongs to.
    #[must_use]
    pub fn names(&self) -> &[String] {
        self.regions.names()
    }

    /// The regions from back to front, where a pose does not say otherwise.
    #[must_use]
    pub fn order(&self) -> &[usize] {
        &self.order
    }

    /// What there is to know of how they are told apart.
    #[must_use]
    pub fn notes(&self) -> &[Note] {
        &self.notes
    }

    /// The regions from back to front in a pose of the layer: [`Self::order`] unless it contradicts the pose.
    #[must_use]
    pub fn order_in(&self, pose: usize) -> Vec<usize> {
        if self.contradicted(pose, &self.order).is_none() {
            return self.order.clone();
        }
        let count = self.mapping.poses.len();
        let unit: Vec<f64> = (0..count).map(|k| f64::from(u8::from(k == pose))).collect();
        // What the pose does not tell is as in the others.
        self.regions.order().from_back_to_front(&vec![1.0; count], &unit)
    }

    /// Where a region hangs on another one; `None` of the one that all others hang on.
    #[must_use]
    pub fn joint(&self, region: usize) -> Option<&Joint> {
        self.joints[region].as_ref()
    }

    /// Points around a region's edge, eight or a few less: by point, its place on each of the layer's drawings, as they are in their files.
    #[must_use]
    pub fn edge_points(&self, region: usize) -> Vec<Vec<Point>> {
        let drawn = self.layer.drawn_poses();
        let of_drawings = |places: Vec<Point>| -> Vec<Point> {
            let poses = drawn.iter().zip(self.layer.drawn());
            poses.map(|(pose, drawn)| drawn.drawn_place(places[*pose])).collect()
        };
        let points = self.regions.edge_points(region, self.mapping, EDGE_POINTS);
        points.into_iter().map(of_drawings).collect()
    }

    /// By drawing of the layer, counted like its drawn poses, the pictures of all regions, each drawing's on its own of `grids`, which are of drawings as they are in their files.
    #[must_use]
    pub fn pictures(&self, grids: &[PixelGrid]) -> Vec<Vec<Picture>> {
        let drawn: Vec<(&Drawing, usize)> = (self.drawings.iter().map(Arc::as_ref))
            .zip(self.layer.drawn_poses())
            .collect();
        let pictures = RegionPictures::new(self.mapping, &self.regions, &drawn);
        let of_drawing = |(drawing, (pose, grid)): (usize, (&DrawnPose, &PixelGrid))| {
            (0..self.regions.count())
                .map(|region| grid.filled(&pictures.cut(region, drawing), pose))
                .collect()
        };
        self.layer.drawn().zip(grids).enumerate().map(of_drawing).collect()
    }

    /// Whether a pose of the layer lies over itself.
    #[must_use]
    pub fn lies_over_itself(&self, pose: usize) -> bool {
        self.mapping.overlaps.depth(pose).is_some()
    }

    /// The region that is seen at a place of a pose of the layer, in the coordinates of the drawing that it shows; the nearest one beside the figure.
    #[must_use]
    pub fn region_at(&self, pose: usize, place: Point) -> usize {
        let Some((_, drawn)) = self.layer.drawing_of(pose) else {
            return 0;
        };
        let place = drawn.used_place(place);
        let positions = &self.mapping.poses.positions()[pose];
        let triangles = self.mapping.poses.topology().triangles();
        let holds = |t: &usize| {
            let shares = geometry::barycentric(geometry::corners(positions, triangles[*t]), place);
            shares.is_some_and(|shares| shares.iter().all(|share| *share >= 0.0))
        };
        let depth = |t: &usize| self.mapping.overlaps.depth(pose).map_or(0.0, |depth| depth[*t]);
        let seen = (0..triangles.len())
            .filter(holds)
            .max_by(|a, b| depth(a).total_cmp(&depth(b)));
        let nearest = || {
            PointLocator::new(triangles, positions)
                .nearest(place)
                .map(|located| located.triangle)
        };
        seen.or_else(nearest).map_or(0, |t| self.regions.region_of(t))
    }

    /// Two regions whose order contradicts a pose.
    fn contradicted(&self, pose: usize, order: &[usize]) -> Option<[usize; 2]> {
        let count = self.regions.count();
        let in_front = &self.regions.order().in_front()[pose];
        order.iter().enumerate().find_map(|(place, &behind)| {
            let mut later = order[place + 1..].iter();
            later
                .find(|&&front| in_front[behind * count + front] > 0)
                .map(|&front| [behind, front])
        })
    }

    /// The poses in which something lies in front of itself by way of others.
    fn cycles(&self) -> Vec<Note> {
        let of_pose = |pose: usize| {
            let [front, behind] = self.contradicted(pose, &self.order_in(pose))?;
            let [front, behind] = [front, behind].map(|region| self.names()[region].clone());
            let name = &self.mapping.poses.names()[pose];
            Some(Note::on_pose(name, NoteKind::DepthCycle { front, behind }))
        };
        (0..self.mapping.poses.len()).filter_map(of_pose).collect()
    }
}

/// By region, where it hangs on another.
fn joints(layer: &LayerSpec, mapping: &Mapping, regions: &Regions, notes: &mut Vec<Note>) -> Vec<Option<Joint>> {
    let count = regions.count();
    let triangles = mapping.poses.topology().triangles();
    let positions = mapping.poses.positions();
    let open = regions.open_pose();
    let mut areas = vec![0.0; count];
    for (t, triangle) in triangles.iter().enumerate() {
        areas[regions.region_of(t)] += geometry::signed_area(geometry::corners(&positions[open], *triangle));
    }
    // By pair of regions, the length of their joint, and its middle times that.
    let mut borders = vec![(0.0, Point::zeros()); count * count];
    for (t, other) in mapping.poses.topology().adjacent_triangles() {
        let (a, b) = (regions.region_of(t), regions.region_of(other));
        let shared: Vec<Point> = (triangles[t].iter())
            .filter(|v| triangles[other].contains(v))
            .map(|v| positions[open][*v])
            .collect();
        if let (true, [from, to]) = (a != b, &shared[..]) {
            let length = (to - from).norm();
            for border in [a * count + b, b * count + a] {
                borders[border].0 += length;
                borders[border].1 += (from + to) * (0.5 * length);
            }
        }
    }
    // Of equals the first.
    let root = (0..count).rev().max_by(|a, b| areas[*a].total_cmp(&areas[*b]));
    let mut joints: Vec<Option<Joint>> = vec![None; count];
    let mut hung: Vec<usize> = root.into_iter().collect();
    let locator = PointLocator::new(triangles, &positions[open]);
    loop {
        let left = (0..count).filter(|region| !hung.contains(region));
        let pairs = left.flat_map(|region| hung.iter().map(move |to| (region, *to)));
        let longest = pairs
            .filter(|(region, to)| borders[region * count + to].0 > 0.0)
            .reduce(|best, next| {
                let length = |(region, to): (usize, usize)| borders[region * count + to].0;
                if length(next) > length(best) { next } else { best }
            });
        let Some((region, to)) = longest else { break };
        hung.push(region);
        let (length, sum) = borders[region * count + to];
        let middle = locator.bind(sum / length);
        joints[region] = middle.map(|middle| Joint {
            to,
            at: (layer.drawn_poses().iter().zip(layer.drawn()))
                .map(|(pose, drawn)| drawn.drawn_place(middle.at(&positions[*pose])))
                .collect(),
        });
    }
    for region in 0..count {
        let name = |region: usize| regions.names()[region].clone();
        if let Some(joint) = &joints[region] {
            let is_other = |other: &usize| {
                *other != joint.to
                    && borders[region * count + other].0 > 0.0
                    && joints[*other].as_ref().is_none_or(|joint| joint.to != region)
            };
            let left: Vec<String> = (0..count).filter(is_other).map(name).collect();
            if !left.is_empty() {
                notes.push(Note::on_all(NoteKind::JointsLeft {
                    region: name(region),
                    to: name(joint.to),
                    left,
                }));
            }
        } else if Some(region) != root {
            notes.push(Note::on_all(NoteKind::NoJoint { region: name(region) }));
        }
    }
    joints
}

/// The premultiplied colour at a place between the centres of pixels, clear beyond the picture.
fn interpolated(picture: &Picture, place: Point) -> [u8; 4] {
    /// Places nearer to a pixel's centre are there: grids that coincide do so but for rounding.
    const EXACT_PX: f64 = 1e-6;
    let low = place.map(|c| (c + EXACT_PX).floor());
    let part = (place - low).map(|c| if c < EXACT_PX { 0.0 } else { c });
    let pixel = |x: f64, y: f64| {
        let is_there = x >= 0.0 && y >= 0.0 && x < picture.width as f64 && y < picture.height as f64;
        let index = is_there.then(|| y as usize * picture.width + x as usize);
        index
            .and_then(|index| picture.pixels.get(index))
            .copied()
            .unwrap_or_default()
    };
    let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(x, y)| {
        let share = |along: f64, part: f64| if along > 0.0 { part } else { 1.0 - part };
        (pixel(low.x + x, low.y + y), share(x, part.x) * share(y, part.y))
    });
    std::array::from_fn(|channel| {
        let sum: f64 = corners
            .iter()
            .map(|(pixel, share)| f64::from(pixel[channel]) * share)
            .sum();
        sum.round() as u8
    })
}
