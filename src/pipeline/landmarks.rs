//! A layer's landmarks, sorted: on the outlines, points inside, lines inside; and where they go in the poses that
//! lack them.
//!
//! An end of a line that lies at the outline in every pose is an outline landmark, too: it guides the matching, and the
//! line is joined to the outline's vertex there.

use std::sync::Arc;

use rayon::prelude::*;

use super::PipelineError;
use super::inside::Obstacles;
use super::landmark_path;
use super::note::{Note, NoteKind};
use super::sides::Sides;
use super::spec::LayerSpec;
use crate::compatible::{CompatibleMesh, FeaturePath, Features, PathEnd};
use crate::input::Drawing;
use crate::matching::Landmark;
use crate::math::{Point, point};
use crate::outline::{ArcLength, Outline, parameter_gap};
use crate::pose::{LandmarkKind, PlacedLandmark};

/// How far a landmark may lie from the outline it is snapped to, as a fraction of the pose's diagonal: a few times the
/// width of an ink line.
const LANDMARK_REACH: f64 = 0.03;

/// A landmark that in every pose lies inside the shape by more than this, as a fraction of the diagonal, is an interior
/// one: about the width of an ink line.
pub const INTERIOR_DEPTH: f64 = 0.01;

/// Ends of lines nearer than this to an outline landmark in every pose, in perimeters, are that landmark.
const SAME_PLACE: f64 = 2e-3;

/// A landmark this near to a vertex of the outline, in perimeters, is at that vertex: half a pixel of an outline of two
/// thousand. The mesh has vertices at both, and the edge between would be as short as what the artist's decimals leave.
const CORNER_REACH: f64 = 2.5e-4;

/// All landmarks of a layer. Places are those of the drawings as they are used: reflected where the pose is.
pub(super) struct Landmarks {
    /// On the outer rings, ends of lines included.
    pub(super) on_outline: Vec<Landmark>,
    pub(super) points: Vec<InteriorPoint>,
    pub(super) paths: Vec<InteriorPath>,
}

/// A point inside.
pub(super) struct InteriorPoint {
    pub(super) name: String,
    pub(super) at: Vec<Option<Point>>,
}

/// A line inside.
pub(super) struct InteriorPath {
    pub(super) name: String,
    pub(super) at: Vec<Option<Vec<Point>>>,
    /// Which outline landmark its start and its end are.
    pub(super) ends: [Option<usize>; 2],
}

/// Sorts the layer's landmarks.
///
/// # Errors
/// [`PipelineError`] if a landmark has no place, or is neither inside nor at the outline.
pub(super) fn sorted(layer: &LayerSpec, drawings: &[Arc<Drawing>]) -> Result<Landmarks, PipelineError> {
    let measured: Vec<(ArcLength, f64)> = (drawings.iter())
        .map(|drawing| {
            let outer = drawing.outline.outer();
            (ArcLength::new(outer), point::diagonal(outer.points()))
        })
        .collect();
    let look = |pose: usize, place: Point| Found::new(layer, drawings, &measured, pose, place);
    let nowhere = |landmark: &String| PipelineError::LandmarkNowhere {
        landmark: landmark.clone(),
    };
    let mut sorted = Landmarks {
        on_outline: Vec::new(),
        points: Vec::new(),
        paths: Vec::new(),
    };
    let everywhere: Vec<Vec<Option<Found>>> = (layer.landmarks.par_iter())
        .map(|landmark| {
            let places = landmark.at.iter().enumerate();
            places
                .map(|(pose, place)| place.map(|place| look(pose, place)))
                .collect()
        })
        .collect();
    for (landmark, found) in layer.landmarks.iter().zip(everywhere) {
        let name = landmark.name.clone();
        if found.iter().all(Option::is_none) {
            return Err(nowhere(&name));
        }
        if found.iter().flatten().all(Found::is_deep) {
            let at = found.iter().map(|found| found.as_ref().map(|f| f.place)).collect();
            sorted.points.push(InteriorPoint { name, at });
        } else {
            let at = snapped(layer, &name, &found)?;
            sorted.on_outline.push(Landmark { name, at });
        }
    }
    for path in &layer.paths {
        let name = path.name.clone();
        if path.at.iter().all(Option::is_none) {
            return Err(nowhere(&name));
        }
        let mut ends = [None; 2];
        for (end, word) in ["start", "end"].into_iter().enumerate() {
            let found: Vec<Option<Found>> = (path.at.iter().enumerate())
                .map(|(pose, points)| {
                    let points = points.as_ref()?;
                    let place = if end == 0 { points.first() } else { points.last() };
                    Some(look(pose, *place?))
                })
                .collect();
            let within_reach = found.iter().flatten().all(|f| f.distance <= LANDMARK_REACH * f.size);
            let is_inside = found.iter().flatten().all(|f| f.inside);
            if found.iter().flatten().all(Found::is_deep) || (is_inside && !within_reach) {
                continue;
            }
            let name = format!("{name} ({word})");
            let at = snapped(layer, &name, &found)?;
            ends[end] = Some(sorted.on_outline_at(Landmark { name, at }));
        }
        let place = |pose: usize, points: &Vec<Point>| -> Vec<Point> {
            points.iter().map(|&p| as_used(layer, pose, p)).collect()
        };
        let at = path
            .at
            .iter()
            .enumerate()
            .map(|(pose, points)| points.as_ref().map(|points| place(pose, points)));
        let at = at.collect();
        sorted.paths.push(InteriorPath { name, at, ends });
    }
    Ok(sorted)
}

impl Landmarks {
    /// The number of an outline landmark, which may be there already.
    fn on_outline_at(&mut self, landmark: Landmark) -> usize {
        let is_same = |other: &Landmark| {
            let mut shared = other
                .at
                .iter()
                .zip(&landmark.at)
                .filter_map(|(a, b)| Some(parameter_gap((*a)?, (*b)?)))
                .peekable();
            shared.peek().is_some() && shared.all(|gap| gap < SAME_PLACE)
        };
        let Some(number) = self.on_outline.iter().position(is_same) else {
            self.on_outline.push(landmark);
            return self.on_outline.len() - 1;
        };
        for (kept, also) in self.on_outline[number].at.iter_mut().zip(landmark.at) {
            *kept = kept.or(also);
        }
        number
    }

    /// All landmarks on every pose of the finished mesh: those on the outline, points inside, lines. `anchors` are the places
    /// of the first (#landmarks x #poses).
    pub(super) fn placed(&self, anchors: &[Vec<Point>], mesh: &CompatibleMesh) -> Vec<PlacedLandmark> {
        let on_outline = self.on_outline.iter().zip(anchors).map(|(landmark, places)| {
            let at = places.iter().map(|place| vec![*place]).collect();
            placed(&landmark.name, LandmarkKind::OnOutline, at, &landmark.at)
        });
        let along = |vertices: &[usize]| -> Vec<Vec<Point>> {
            let places = |positions: &Vec<Point>| vertices.iter().map(|&v| positions[v]).collect();
            mesh.positions.iter().map(places).collect()
        };
        let inside = self
            .points
            .iter()
            .zip(&mesh.landmarks)
            .map(|(point, vertex)| placed(&point.name, LandmarkKind::Inside, along(&[*vertex]), &point.at));
        let lines = self
            .paths
            .iter()
            .zip(&mesh.paths)
            .map(|(path, vertices)| placed(&path.name, LandmarkKind::Line, along(vertices), &path.at));
        on_outline.chain(inside).chain(lines).collect()
    }

    /// What the triangulation has to meet inside `polygons`: lines simplified to `tolerance` (of the diagonals), and
    /// everything placed in the poses that lack it. `anchors` are the places of the outline landmarks (#landmarks x
    /// #poses). Notes say what was placed.
    pub(super) fn features(
        &self,
        layer: &LayerSpec,
        polygons: &[Outline],
        anchors: &[Vec<Point>],
        tolerance: f64,
    ) -> Result<(Features, Vec<Note>), PipelineError> {
        let mut features = Features::default();
        let mut notes = Vec::new();
        let mut obstacles: Vec<Obstacles> = polygons.iter().map(Obstacles::new).collect();
        let deviations: Vec<f64> = polygons.iter().map(|polygon| tolerance * polygon.diagonal()).collect();
        let lacking = |pose: usize, landmark: &str| PipelineError::LandmarkMissing {
            landmark: landmark.to_owned(),
            pose: layer.poses[pose].name.clone(),
        };
        let mut sides = Sides::default();
        // Those from outline to outline first: whatever else is placed has to be on the right side of them.
        let mut order: Vec<usize> = (0..self.paths.len()).collect();
        order.sort_by_key(|&k| self.paths[k].ends.iter().any(Option::is_none));
        let mut paths: Vec<Option<FeaturePath>> = vec![None; self.paths.len()];
        for number in order {
            let path = &self.paths[number];
            let mut rows = landmark_path::corresponding(&path.at, &deviations);
            let mut ends = [PathEnd::Inside; 2];
            for (end, anchor) in path.ends.iter().enumerate() {
                if let Some(places) = anchor.and_then(|anchor| anchors.get(anchor)) {
                    let row = if end == 0 { 0 } else { rows.len() - 1 };
                    rows.remove(row);
                    ends[end] = PathEnd::Boundary {
                        ring: 0,
                        vertex: nearest_vertex(polygons, places),
                    };
                }
            }
            let mut points = Vec::with_capacity(rows.len());
            for row in &rows {
                let all: Result<Vec<Point>, PipelineError> = (0..polygons.len())
                    .map(|pose| {
                        let place = row[pose].or_else(|| sides.predicted(polygons, row, pose));
                        place.ok_or_else(|| lacking(pose, &path.name))
                    })
                    .collect();
                points.push(all?);
            }
            let on_outline = ends.map(|end| match end {
                PathEnd::Inside => None,
                PathEnd::Boundary { vertex, .. } => Some(vertex),
            });
            for (pose, obstacles) in obstacles.iter_mut().enumerate() {
                let end = |end: Option<usize>| end.map(|vertex| polygons[pose].outer().point(vertex));
                let between = points.iter().map(|places| places[pose]);
                obstacles.add_line(end(on_outline[0]).into_iter().chain(between).chain(end(on_outline[1])));
            }
            if let [Some(from), Some(to)] = on_outline {
                sides.add_line(polygons, [from, to], &points);
            }
            for (pose, _) in path.at.iter().enumerate().filter(|(_, points)| points.is_none()) {
                let landmark = path.name.clone();
                notes.push(Note::on_pose(
                    &layer.poses[pose].name,
                    NoteKind::LineMissing { landmark },
                ));
            }
            paths[number] = Some(FeaturePath { ends, points });
        }
        features.paths = paths.into_iter().flatten().collect();
        for landmark in &self.points {
            for (pose, place) in landmark.at.iter().enumerate() {
                if let Some(place) = place {
                    obstacles[pose].add_point(*place);
                }
            }
        }
        for landmark in &self.points {
            let mut places = Vec::with_capacity(polygons.len());
            for (pose, place) in landmark.at.iter().enumerate() {
                if let Some(place) = place {
                    places.push(*place);
                    continue;
                }
                let wanted = sides.wanted(&landmark.at);
                let is_allowed = |p: Point| wanted.as_ref().is_none_or(|wanted| sides.of(pose, p) == *wanted);
                let place = sides
                    .predicted(polygons, &landmark.at, pose)
                    .and_then(|place| obstacles[pose].nearest_free(&polygons[pose], place, is_allowed))
                    .ok_or_else(|| lacking(pose, &landmark.name))?;
                obstacles[pose].add_point(place);
                let kind = NoteKind::LandmarkPlaced {
                    landmark: landmark.name.clone(),
                    at: as_drawn(layer, pose, place),
                };
                notes.push(Note::on_pose(&layer.poses[pose].name, kind));
                places.push(place);
            }
            features.points.push(places);
        }
        Ok((features, notes))
    }
}

/// A landmark at `at` in every pose; `drawn` says which poses have it of their own.
fn placed<T>(name: &str, kind: LandmarkKind, at: Vec<Vec<Point>>, drawn: &[Option<T>]) -> PlacedLandmark {
    PlacedLandmark {
        name: name.to_owned(),
        kind,
        at,
        given: drawn.iter().map(Option::is_some).collect(),
    }
}

/// The vertex of the outer rings that is nearest to the given places, in the pose where it is farthest.
fn nearest_vertex(polygons: &[Outline], places: &[Point]) -> usize {
    let distance = |vertex: usize| {
        polygons
            .iter()
            .zip(places)
            .map(|(polygon, place)| (polygon.outer().point(vertex) - place).norm() / polygon.diagonal())
            .fold(0.0, f64::max)
    };
    let count = polygons.first().map_or(0, |polygon| polygon.outer().len());
    (0..count)
        .min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
        .unwrap_or(0)
}

/// A place of the source in the drawing as it is used. `pose` counts the drawn poses.
pub(super) fn as_used(layer: &LayerSpec, pose: usize, place: Point) -> Point {
    layer.drawn().nth(pose).map_or(place, |source| source.used_place(place))
}

/// The place of the source that [`as_used`] takes to `place`.
pub(super) fn as_drawn(layer: &LayerSpec, pose: usize, place: Point) -> Point {
    layer
        .drawn()
        .nth(pose)
        .map_or(place, |source| source.drawn_place(place))
}

/// The parameters of an outline landmark.
fn snapped(layer: &LayerSpec, landmark: &str, found: &[Option<Found>]) -> Result<Vec<Option<f64>>, PipelineError> {
    for (pose, found) in found.iter().enumerate() {
        if let Some(found) = found.as_ref().filter(|f| f.distance > LANDMARK_REACH * f.size) {
            return Err(PipelineError::LandmarkOffOutline {
                landmark: landmark.to_owned(),
                pose: layer.poses[pose].name.clone(),
                distance: found.distance,
                largest: LANDMARK_REACH * found.size,
                x: found.place.x,
                y: found.place.y,
            });
        }
    }
    Ok(found.iter().map(|found| found.as_ref().map(|f| f.parameter)).collect())
}

/// A landmark's place on one pose.
struct Found {
    place: Point,
    /// Of the nearest point of the outline, or a vertex beside it.
    parameter: f64,
    /// To that point, in source units.
    distance: f64,
    inside: bool,
    /// The pose's diagonal.
    size: f64,
}

impl Found {
    fn new(
        layer: &LayerSpec,
        drawings: &[Arc<Drawing>],
        measured: &[(ArcLength, f64)],
        pose: usize,
        place: Point,
    ) -> Self {
        let place = as_used(layer, pose, place);
        let (curve, size) = &measured[pose];
        let (nearest, distance) = curve.nearest(place);
        // Of the vertices, the nearer end of the edge that it lies on.
        let corners = curve.vertex_parameters();
        let (edge, _) = curve.locate(nearest);
        let ends = [edge, (edge + 1) % corners.len()].map(|vertex| corners[vertex]);
        let corner = ends
            .into_iter()
            .min_by(|a, b| parameter_gap(*a, nearest).total_cmp(&parameter_gap(*b, nearest)));
        let parameter = corner
            .filter(|t| parameter_gap(*t, nearest) <= CORNER_REACH)
            .unwrap_or(nearest);
        Self {
            place,
            parameter,
            distance,
            inside: drawings[pose].outline.contains(place),
            size: *size,
        }
    }

    fn is_deep(&self) -> bool {
        self.inside && self.distance > INTERIOR_DEPTH * self.size
    }
}
