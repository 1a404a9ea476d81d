//! The parts that were found in a scene's drawings, as the layers of a scene of its own.
//!
//! A scene without layers -> one drawing a part and pose, and what of the scene belongs to which part ([`Separated`]). The drawings are on
//! the canvas of the ones that they were found in.
//!
//! - Loose parts are cut apart, and every coordinate of the scene stays as it is. A part that a pose lacks grows from a point while the scene is whole, and appears when it is
//!   in layers.
//! - A part whose drawings lie over themselves becomes its regions (module `overlap_regions` of the pipeline): each with what others hide of it filled, hung on the one that it
//!   joins, in the order in which frames paint them. What hides and what is hidden cannot be told apart in curves, so drawings in curves are then written as pixels, all of one
//!   fineness, and places on them are counted in these pixels ([`Separated::grids`]).

use super::SceneBuildError;
use super::drawings::read_drawing;
use super::markable::{Figure, are_on_outlines};
use super::settings::Scene;
use crate::input::{Art, Canvas, Picture};
use crate::math::Point;
use crate::outline::Outline;
use crate::pipeline::{
    Build, CharacterSpec, DrawnPose, HandleMove, LayerRole, LayerSpec, Note, NoteKind, OverlapRegions, OverlapSearch,
    PixelGrid, PoseShape,
};

/// A scene's parts.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Separated {
    /// From back to front; one if the drawings are of one piece.
    pub layers: Vec<SeparatedLayer>,
    /// For each pose the layers from back to front.
    pub draw_orders: Vec<Vec<usize>>,
    /// For each pose that is drawn in curves and written as pixels, these: places of its drawing are [counted in them](PixelGrid::to_pixels).
    pub grids: Vec<Option<PixelGrid>>,
    /// Whether any of the layers are parts that lie over one another.
    pub has_overlaps: bool,
    /// The names of lines that lie on several layers, and so on none.
    pub divided_lines: Vec<String>,
    /// What the artist should know.
    pub notes: Vec<Note>,
}

/// One part of a scene's drawings.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct SeparatedLayer {
    /// What it is called.
    pub name: String,
    /// Its drawing in each pose of the scene; `None` where the pose lacks it or is a deformed copy.
    pub drawings: Vec<Option<SeparatedDrawing>>,
    /// The names of the landmarks and lines that lie on it.
    pub landmarks: Vec<String>,
    /// For each pose of the scene the handles that take hold of it.
    pub handles: Vec<Vec<HandleMove>>,
    /// Landmarks that it has besides: where it hangs, and around the edge that it was cut along.
    pub added: Vec<SeparatedLandmark>,
    /// What it hangs on.
    pub anchor: Option<SeparatedAnchor>,
}

/// A landmark that a part has from how it was found.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SeparatedLandmark {
    /// Its name; no landmark of the scene is called so.
    pub name: String,
    /// Its place on each pose's drawing, in source units of the scene; `None` on poses that are not drawn.
    pub at: Vec<Option<Point>>,
}

/// Where a part hangs on another one.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SeparatedAnchor {
    /// The other layer.
    pub to: usize,
    /// The name of the landmark that holds them together, one of those that were added.
    pub landmark: String,
}

/// A part of one drawing.
#[derive(Debug, Clone)]
pub enum SeparatedDrawing {
    /// Its pixels on the whole canvas.
    Pixels(Picture),
    /// Of a vector drawing: its curves, and the page that they are on.
    Curves(Art, Canvas),
    /// Of a vector drawing with something that curves cannot say, such as a picture or a mask.
    Unwritable,
}

impl Scene {
    /// The parts of a scene without layers. Parts that lie over one another are sought by mapping the drawings, which takes as long as
    /// [`map_layer`](crate::pipeline::map_layer).
    ///
    /// # Errors
    /// [`SceneBuildError`] if a drawing cannot be read, or if drawings of one piece cannot be mapped. Where there are loose parts, a note says why none were sought that lie
    /// over one another.
    pub fn separated(&self) -> Result<Separated, SceneBuildError> {
        let spec = self.spec_with(&read_drawing)?.with_loose_parts();
        let mut notes = spec.notes.clone();
        let is_sought = |layer: &LayerSpec| layer.overlaps == OverlapSearch::Auto && layer.drawn().count() > 1;
        let build = match spec.layers.iter().any(is_sought).then(|| Build::new(&spec)) {
            Some(Err(error)) if spec.layers.len() > 1 => {
                notes.push(Note::of_separation(NoteKind::OverlapsNotSought {
                    why: error.to_string(),
                }));
                None
            }
            built => built.transpose().map_err(|error| self.refusal(error))?,
        };
        let parts = Parts::new(&spec, build.as_ref()).map_err(|error| self.refusal(error))?;
        for regions in parts.regions.iter().flatten() {
            notes.extend(regions.notes().iter().cloned());
        }
        let taken: Vec<&str> = (self.landmarks.iter().map(|landmark| landmark.name.as_str()))
            .chain(self.paths.iter().map(|path| path.name.as_str()))
            .collect();
        let layers = parts.layers(&taken).map_err(|error| self.refusal(error))?;
        let divided_lines = parts.divided_lines();
        for line in &divided_lines {
            notes.push(Note::of_separation(NoteKind::LineDivided { landmark: line.clone() }));
        }
        let poses: Vec<String> = (self.poses.iter().zip(&parts.grids))
            .filter(|(_, grid)| grid.is_some())
            .map(|(pose, _)| pose.name.clone())
            .collect();
        if !poses.is_empty() {
            let pixels_per_unit = parts.pixels_per_unit;
            notes.push(Note::of_separation(NoteKind::CurvesAsPixels { poses, pixels_per_unit }));
        }
        Ok(Separated {
            layers,
            draw_orders: parts.draw_orders(),
            has_overlaps: parts.has_overlaps(),
            divided_lines,
            notes,
            grids: parts.grids,
        })
    }
}

/// The layers of a specification, and the regions of those that lie over themselves. All layers have all poses of the space.
struct Parts<'a> {
    spec: &'a CharacterSpec,
    build: Option<&'a Build>,
    /// By layer.
    regions: Vec<Option<OverlapRegions<'a>>>,
    /// The new layers from back to front: a layer, and a region of it.
    order: Vec<(usize, Option<usize>)>,
    names: Vec<String>,
    /// Of vector drawings where they are written as pixels; 1 where bitmaps are among the drawings, whose units are their pixels.
    pixels_per_unit: f64,
    grids: Vec<Option<PixelGrid>>,
}

impl<'a> Parts<'a> {
    fn new(spec: &'a CharacterSpec, build: Option<&'a Build>) -> Result<Self, crate::pipeline::PipelineError> {
        let drawn = || spec.layers.iter().flat_map(LayerSpec::drawn);
        let pixels_per_unit = if drawn().all(|pose| pose.svg.is_some()) {
            drawn()
                .map(|pose| pose.drawing.picture.pixels_per_unit)
                .fold(1.0, f64::max)
        } else {
            1.0
        };
        let regions_of = |layer: usize| match build {
            Some(build) => build.overlap_regions(layer, pixels_per_unit),
            None => Ok(None),
        };
        let regions: Vec<Option<OverlapRegions<'_>>> =
            (0..spec.layers.len()).map(regions_of).collect::<Result<_, _>>()?;
        let mut order = Vec::new();
        let mut names: Vec<String> = Vec::new();
        for (layer, regions) in regions.iter().enumerate() {
            let Some(regions) = regions else {
                order.push((layer, None));
                names.push(free_name(&spec.layers[layer].name, &names));
                continue;
            };
            for &region in regions.order() {
                order.push((layer, Some(region)));
                let name = &regions.names()[region];
                names.push(match spec.layers[layer].role {
                    LayerRole::Body => free_name(name, &names),
                    LayerRole::LoosePart => free_name(&format!("{} {name}", spec.layers[layer].name), &names),
                });
            }
        }
        let grid = |pose: usize| {
            let mut in_layers = spec.layers.iter().filter_map(|layer| drawn_pose(layer, pose));
            let first = in_layers.next().filter(|drawn| drawn.svg.is_some())?;
            Some(PixelGrid::of(&first.drawing.canvas, pixels_per_unit))
        };
        let has_overlaps = regions.iter().any(Option::is_some);
        let grids = (0..spec.space.poses.len()).map(|pose| grid(pose).filter(|_| has_overlaps));
        Ok(Self {
            spec,
            build,
            grids: grids.collect(),
            regions,
            order,
            names,
            pixels_per_unit,
        })
    }

    fn has_overlaps(&self) -> bool {
        self.regions.iter().any(Option::is_some)
    }

    /// The new layer that is a region of a layer, or the whole of it.
    fn new_layer(&self, layer: usize, region: Option<usize>) -> usize {
        self.order.iter().position(|own| *own == (layer, region)).unwrap_or(0)
    }

    /// For each pose the new layers from back to front.
    fn draw_orders(&self) -> Vec<Vec<usize>> {
        let of_layer = |pose: usize, layer: usize| -> Vec<usize> {
            match &self.regions[layer] {
                None => vec![self.new_layer(layer, None)],
                Some(regions) => (regions.order_in(pose).into_iter())
                    .map(|region| self.new_layer(layer, Some(region)))
                    .collect(),
            }
        };
        let of_pose = |(pose, layers): (usize, Vec<usize>)| {
            let layers = layers.into_iter();
            layers.flat_map(|layer| of_layer(pose, layer)).collect()
        };
        let orders = self.spec.draw_order_of_poses();
        orders.into_iter().enumerate().map(of_pose).collect()
    }

    /// The new layers; `taken` are the names that landmarks have already.
    fn layers(&self, taken: &[&str]) -> Result<Vec<SeparatedLayer>, crate::pipeline::PipelineError> {
        let mut drawings = self.drawings()?;
        let mut landmarks: Vec<String> = taken.iter().map(|name| (*name).to_owned()).collect();
        let mut layers = Vec::new();
        for (k, &(layer, region)) in self.order.iter().enumerate() {
            let own_drawings = std::mem::take(&mut drawings[k]);
            let figures: Vec<Option<Figure<'_>>> = if region.is_some() {
                own_drawings.iter().map(figure_of).collect()
            } else {
                Vec::new()
            };
            let drawn = self.spec.layers[layer].drawn_poses();
            let on_outline = |at: &&Vec<Point>| {
                let on = drawn.iter().zip(*at);
                are_on_outlines(on.filter_map(|(pose, place)| Some((figures.get(*pose)?.as_ref()?, *place))))
            };
            let mut added = Vec::new();
            let mut add = |name: String, at: &[Point]| {
                let name = free_name(&name, &landmarks);
                landmarks.push(name.clone());
                let mut of_poses = vec![None; self.spec.space.poses.len()];
                for (pose, place) in drawn.iter().zip(at) {
                    of_poses[*pose] = Some(*place);
                }
                added.push(SeparatedLandmark {
                    name: name.clone(),
                    at: of_poses,
                });
                name
            };
            let regions = self.regions[layer].as_ref().zip(region);
            let anchor = regions.and_then(|(regions, region)| {
                let joint = regions.joint(region)?;
                Some(SeparatedAnchor {
                    to: self.new_layer(layer, Some(joint.to)),
                    landmark: add(format!("{} joint", self.names[k]), &joint.at),
                })
            });
            let edge = regions.map(|(regions, region)| regions.edge_points(region));
            for (number, at) in edge.unwrap_or_default().iter().filter(on_outline).enumerate() {
                add(format!("{} edge {}", self.names[k], number + 1), at);
            }
            layers.push(SeparatedLayer {
                name: self.names[k].clone(),
                drawings: own_drawings,
                landmarks: self.landmarks(layer, region),
                handles: (0..self.spec.space.poses.len())
                    .map(|pose| self.handles(layer, region, pose))
                    .collect(),
                added,
                anchor,
            });
        }
        Ok(layers)
    }

    /// By new layer and pose.
    fn drawings(&self) -> Result<Vec<Vec<Option<SeparatedDrawing>>>, crate::pipeline::PipelineError> {
        let mut drawings: Vec<Vec<Option<SeparatedDrawing>>> =
            vec![vec![None; self.spec.space.poses.len()]; self.order.len()];
        for (layer, regions) in self.regions.iter().enumerate() {
            let drawn = self.spec.layers[layer].drawn_poses();
            let poses = drawn.iter().zip(self.spec.layers[layer].drawn());
            let Some(regions) = regions else {
                for (drawing, (&pose, drawn)) in poses.enumerate() {
                    drawings[self.new_layer(layer, None)][pose] = Some(match (self.build, self.grids[pose]) {
                        (Some(build), Some(grid)) => SeparatedDrawing::Pixels(build.cut_out(layer, drawing, &grid)?),
                        _ => self.loose(layer, pose, drawn),
                    });
                }
                continue;
            };
            let grids: Vec<PixelGrid> = poses
                .map(|(pose, drawn)| self.grids[*pose].unwrap_or_else(|| PixelGrid::of(&drawn.drawing.canvas, 1.0)))
                .collect();
            for (&pose, pictures) in drawn.iter().zip(regions.pictures(&grids)) {
                for (region, picture) in pictures.into_iter().enumerate() {
                    let new = self.new_layer(layer, Some(region));
                    drawings[new][pose] = Some(SeparatedDrawing::Pixels(picture));
                }
            }
        }
        Ok(drawings)
    }

    /// A loose part's own drawing.
    fn loose(&self, layer: usize, pose: usize, drawn: &DrawnPose) -> SeparatedDrawing {
        match (&drawn.drawing.art, &drawn.svg) {
            (Some(art), _) => SeparatedDrawing::Curves(art.clone(), drawn.drawing.canvas),
            (None, Some(_)) => SeparatedDrawing::Unwritable,
            (None, None) => {
                let others = (self.spec.layers.iter().enumerate()).filter(|(other, _)| *other != layer);
                let outlines: Vec<&Outline> = others
                    .filter_map(|(_, other)| Some(&drawn_pose(other, pose)?.drawing.outline))
                    .collect();
                SeparatedDrawing::Pixels(drawn.drawing.picture_alone(&outlines))
            }
        }
    }

    /// The landmarks and lines on a layer, or on a region of it.
    fn landmarks(&self, layer: usize, region: Option<usize>) -> Vec<String> {
        let spec = &self.spec.layers[layer];
        let (points, lines) = (spec.landmarks.iter(), spec.paths.iter());
        let (Some(regions), Some(region)) = (&self.regions[layer], region) else {
            return (points.map(|landmark| landmark.name.clone()))
                .chain(lines.map(|path| path.name.clone()))
                .collect();
        };
        let is_here =
            |place: Option<(usize, Point)>| place.is_some_and(|(pose, place)| regions.region_at(pose, place) == region);
        points
            .filter(|landmark| is_here(given(regions, &landmark.at)))
            .map(|landmark| landmark.name.clone())
            .chain(
                lines
                    .filter(|path| regions_of_line(regions, &path.at) == [region])
                    .map(|path| path.name.clone()),
            )
            .collect()
    }

    /// The lines that lie on several regions.
    fn divided_lines(&self) -> Vec<String> {
        let of_layer = |(layer, regions): (&LayerSpec, &Option<OverlapRegions<'_>>)| -> Vec<String> {
            let Some(regions) = regions else { return Vec::new() };
            let divided = layer
                .paths
                .iter()
                .filter(|path| regions_of_line(regions, &path.at).len() != 1);
            divided.map(|path| path.name.clone()).collect()
        };
        self.spec.layers.iter().zip(&self.regions).flat_map(of_layer).collect()
    }

    /// The handles of a pose that take hold of a layer, or of a region of it.
    fn handles(&self, layer: usize, region: Option<usize>, pose: usize) -> Vec<HandleMove> {
        let Some(PoseShape::Deformed(copy)) = self.spec.layers[layer].poses.get(pose).map(|pose| &pose.shape) else {
            return Vec::new();
        };
        let (Some(regions), Some(region)) = (&self.regions[layer], region) else {
            return copy.handles.clone();
        };
        let is_here = |handle: &&HandleMove| regions.region_at(copy.of, handle.from) == region;
        copy.handles.iter().filter(is_here).copied().collect()
    }
}

/// What is on a part's picture, as it is read again.
fn figure_of(drawing: &Option<SeparatedDrawing>) -> Option<Figure<'_>> {
    match drawing {
        Some(SeparatedDrawing::Pixels(picture)) => Figure::of(picture),
        _ => None,
    }
}

/// The drawing of a pose that is drawn.
fn drawn_pose(layer: &LayerSpec, pose: usize) -> Option<&DrawnPose> {
    match &layer.poses.get(pose)?.shape {
        PoseShape::Drawn(drawn) => Some(drawn),
        PoseShape::Deformed(_) | PoseShape::Shrunk(_) => None,
    }
}

/// A pose in which something has a place, and the place: one that does not lie over itself, if there is any.
fn given<T: Clone>(regions: &OverlapRegions<'_>, at: &[Option<T>]) -> Option<(usize, T)> {
    let mut poses: Vec<usize> = (0..at.len()).filter(|pose| at[*pose].is_some()).collect();
    poses.sort_by_key(|pose| regions.lies_over_itself(*pose));
    let pose = *poses.first()?;
    Some((pose, at[pose].clone()?))
}

/// The regions that a line lies on.
fn regions_of_line(regions: &OverlapRegions<'_>, at: &[Option<Vec<Point>>]) -> Vec<usize> {
    let Some((pose, line)) = given(regions, at) else {
        return Vec::new();
    };
    let mut found: Vec<usize> = line.iter().map(|place| regions.region_at(pose, *place)).collect();
    found.sort_unstable();
    found.dedup();
    found
}

/// The name, or the first numbered one that is not taken.
fn free_name(name: &str, taken: &[String]) -> String {
    let numbered = (2..).map(|number| format!("{name} {number}"));
    let mut names = std::iter::once(name.to_owned()).chain(numbered);
    names.find(|name| !taken.contains(name)).unwrap_or_default()
}
