//! A layer's landmarks, sorted: on the outlines, on rims of holes, points inside, lines inside; and where they go in the poses that
//! lack them.
//!
//! Landmarks on rims say which hole is which, too. An end of a line that lies at the outline in every pose is an outline landmark, too: it guides the matching, and the
//! line is joined to the outline's vertex there.

use std::sync::Arc;

use rayon::prelude::*;

use super::PipelineError;
use super::inside::Obstacles;
use super::landmark_path;
use super::landmark_ring::{Found, MarkedRing, MeasuredOutline, Nearest, marked_ring, tie_refusal};
use super::note::{Note, NoteKind};
use super::sides::Sides;
use super::spec::LayerSpec;
use crate::compatible::{CompatibleMesh, FeaturePath, Features, PathEnd};
use crate::input::Drawing;
use crate::matching::{HoleTies, Landmark};
use crate::math::Point;
use crate::outline::{Outline, parameter_gap};
use crate::pose::{LandmarkKind, PlacedLandmark};

/// Ends of lines nearer than this to an outline landmark in every pose, in perimeters, are that landmark.
const SAME_PLACE: f64 = 2e-3;

/// All landmarks of a layer. Places are those of the drawings as they are used: reflected where the pose is.
pub(super) struct Landmarks {
    /// On the outer rings, ends of lines included.
    pub(super) on_outline: Vec<Landmark>,
    /// On rims of holes.
    pub(super) on_rims: Vec<RimLandmark>,
    /// What these say of the holes.
    pub(super) ties: HoleTies,
    pub(super) points: Vec<InteriorPoint>,
    pub(super) paths: Vec<InteriorPath>,
}

/// A landmark on the rim of a hole.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RimLandmark {
    /// Its name, and its parameter on the hole's ring in every pose that has it.
    pub(super) landmark: Landmark,
    /// Which of the pose's holes that is, in the drawing's order.
    pub(super) holes: Vec<Option<usize>>,
}

/// The names of landmarks on rims.
pub(super) fn rim_names(on_rims: &[RimLandmark]) -> Vec<&str> {
    on_rims.iter().map(|rim| rim.landmark.name.as_str()).collect()
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
    let measured: Vec<MeasuredOutline> = (drawings.iter())
        .map(|drawing| MeasuredOutline::new(&drawing.outline))
        .collect();
    let look = |pose: usize, place: Point| Found::new(layer, &measured[pose], pose, place);
    let nowhere = |landmark: &String| PipelineError::LandmarkNowhere {
        landmark: landmark.clone(),
    };
    let mut sorted = Landmarks {
        on_outline: Vec::new(),
        on_rims: Vec::new(),
        ties: HoleTies::default(),
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
        match marked_ring(layer, &name, &found, &measured)? {
            None => {
                let at = found.iter().map(|found| found.as_ref().map(|f| f.place)).collect();
                sorted.points.push(InteriorPoint { name, at });
            }
            Some(MarkedRing::Outer) => {
                let at = found
                    .iter()
                    .map(|found| Some(found.as_ref()?.outer.parameter))
                    .collect();
                sorted.on_outline.push(Landmark { name, at });
            }
            Some(MarkedRing::Rim) => {
                let rims: Vec<Option<Nearest>> = found.iter().map(|found| found.as_ref()?.rim).collect();
                let at = rims.iter().map(|rim| Some((*rim)?.parameter)).collect();
                sorted.on_rims.push(RimLandmark {
                    landmark: Landmark { name, at },
                    holes: rims.iter().map(|rim| Some((*rim)?.ring - 1)).collect(),
                });
            }
        }
    }
    let marks: Vec<Vec<Option<usize>>> = sorted.on_rims.iter().map(|rim| rim.holes.clone()).collect();
    sorted.ties =
        HoleTies::new(&marks).map_err(|error| tie_refusal(&layer.names(), &rim_names(&sorted.on_rims), error))?;
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
            let within_reach = found.iter().flatten().all(Found::is_at_outer);
            let is_inside = found.iter().flatten().all(|f| f.inside);
            if found.iter().flatten().all(Found::is_inward) || (is_inside && !within_reach) {
                continue;
            }
            let name = format!("{name} ({word})");
            let stray = found.iter().enumerate().find_map(|(pose, found)| {
                let found = found.as_ref().filter(|found| !found.is_at_outer())?;
                Some(found.off_outline(layer, &name, pose))
            });
            if let Some(refusal) = stray {
                return Err(refusal);
            }
            let at = found
                .iter()
                .map(|found| Some(found.as_ref()?.outer.parameter))
                .collect();
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

    /// All landmarks on every pose of the finished mesh: those on the outline, on rims, points inside, lines. `anchors` are the places
    /// of the first two (#landmarks x #poses).
    pub(super) fn placed(&self, anchors: &[Vec<Point>], mesh: &CompatibleMesh) -> Vec<PlacedLandmark> {
        let on_outline = self.on_outline.iter().map(|own| (own, LandmarkKind::OnOutline));
        let on_rims = self.on_rims.iter().map(|own| (&own.landmark, LandmarkKind::OnRim));
        let on_rings = on_outline
            .chain(on_rims)
            .zip(anchors)
            .map(|((landmark, kind), places)| {
                let at = places.iter().map(|place| vec![*place]).collect();
                placed(&landmark.name, kind, at, &landmark.at)
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
        on_rings.chain(inside).chain(lines).collect()
    }

    /// What the triangulation has to meet inside `polygons`: lines simplified to `tolerance` (of the diagonals), and
    /// everything placed in the poses that lack it. `anchors` are the places of the outline landmarks (#landmarks x
    /// #poses), and of those on rims. Notes say what was placed.
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
