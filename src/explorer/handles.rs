//! Dragging the drawing itself: as-rigid-as-possible deformation, and inverse posing.

use std::sync::PoisonError;

use inbetween::math::Point;
use inbetween::mesh::PointLocator;
use inbetween::pipeline::{LayerShape, ReachOptions, ShapePoint, reach, reach_near};
use inbetween::pose::{DragOptions, HandleDeformation, HandleScratch};
use inbetween::weights::{WeightError, WeightProvider};
use serde::Deserialize;
use serde_json::json;

use super::draggers::Dragger;
use super::frames::{is_inverted, provider_named};
use super::http::Response;
use super::pictures::{pose_of, shape_of};
use super::problem::{Problem, Refusal};
use super::session::Session;
use super::wire::Words;

/// Steps of a drag if the page does not say.
const STEPS: usize = 40;
/// The most that it can ask for.
const MOST_STEPS: usize = 600;
/// Steps of a search near the present place: a hand waits for it.
const REACH_STEPS: usize = 12;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Handle {
    from: [f64; 2],
    to: [f64; 2],
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct DeformRequest {
    #[serde(default)]
    layer: usize,
    pose: String,
    handles: Vec<Handle>,
    steps: Option<usize>,
}

/// `POST api/deform`.
pub(super) fn deform(body: &[u8], session: &Session) -> Result<Response, Refusal> {
    let asked: DeformRequest = serde_json::from_slice(body).map_err(Refusal::bad)?;
    let shown = session.shown();
    let bench = shown.bench()?;
    let shape = shape_of(bench, asked.layer)?;
    let poses = &shape.mapping().poses;
    let pose = pose_of(shape, asked.layer, &asked.pose)?;
    let from: Vec<[f64; 2]> = asked.handles.iter().map(|handle| handle.from).collect();
    let places: Vec<Point> = from.iter().copied().map(Point::from).collect();
    let targets: Vec<Point> = asked.handles.iter().map(|handle| Point::from(handle.to)).collect();
    let key = (shown.revisions.shape, asked.layer, pose);
    let refused = |error: inbetween::pose::HandleError| Refusal::conflict(Problem::new(error));
    // Held while it is dragged: drags come one after the other anyway.
    let mut kept = session.draggers.0.lock().unwrap_or_else(PoisonError::into_inner);
    let mut dragger = match kept.take() {
        Some(dragger) if dragger.key == key && dragger.from == from => dragger,
        other => {
            let deformation = match other {
                Some(same_pose) if same_pose.key == key => same_pose.deformation.with_handles(&places),
                _ => HandleDeformation::new(poses.topology(), &poses.positions()[pose], &places),
            };
            Dragger {
                key,
                from,
                deformation: deformation.map_err(refused)?,
                scratch: HandleScratch::default(),
            }
        }
    };
    let mut options = DragOptions::default();
    options.most_iterations = asked.steps.unwrap_or(STEPS).clamp(1, MOST_STEPS);
    dragger.deformation = dragger.deformation.with_options(options);
    let mut positions = Vec::new();
    let dragged = dragger.deformation.drag(&targets, &mut dragger.scratch, &mut positions);
    *kept = Some(dragger);
    drop(kept);
    dragged.map_err(refused)?;
    let triangles = poses.topology().triangles();
    let inverted = triangles
        .iter()
        .filter(|corners| is_inverted(&positions, **corners))
        .count();
    let mut bytes = Vec::new();
    let mut words = Words(&mut bytes);
    words.u32(positions.len());
    words.u32(inverted);
    words.points(&positions);
    Ok(Response::binary(bytes))
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Search {
    #[default]
    Near,
    Everywhere,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ReachRequest {
    #[serde(default)]
    layer: usize,
    /// Where the points were taken hold of.
    at: Vec<f64>,
    /// Where the search begins.
    start: Option<Vec<f64>>,
    points: Vec<Handle>,
    provider: Option<String>,
    #[serde(default)]
    search: Search,
}

/// `POST api/reach`.
pub(super) fn reach_place(body: &[u8], session: &Session) -> Result<Response, Refusal> {
    let asked: ReachRequest = serde_json::from_slice(body).map_err(Refusal::bad)?;
    let shown = session.shown();
    let bench = shown.bench()?;
    let shape = shape_of(bench, asked.layer)?;
    let provider = shown.provider(asked.provider.as_deref().map(provider_named).transpose()?)?;
    let weights = provider.weights_at(&asked.at).map_err(Refusal::bad)?;
    let posed = bench.posed(&weights, None)?;
    let positions = &posed.layers[asked.layer].positions;
    let of_layer = LayerWeights {
        whole: provider.as_ref(),
        shape,
    };
    // A layer that hangs on another is moved as a whole afterwards; where it was taken hold of, that is known.
    let own = shape.own_weights(&weights);
    let mut unmoved = Vec::new();
    let blend = shape.blend();
    let blended = blend.blend(&own, &mut blend.scratch(), &mut unmoved);
    blended.map_err(|error| Refusal::conflict(Problem::new(error)))?;
    let hung = match (positions.first(), unmoved.first()) {
        (Some(a), Some(b)) => a - b,
        _ => Point::zeros(),
    };
    let locator = PointLocator::new(shape.mapping().poses.topology().triangles(), positions);
    let mut points = Vec::new();
    for handle in &asked.points {
        let bound = locator.bind(Point::from(handle.from));
        let bound = bound.ok_or_else(|| Refusal::bad("there is no mesh to take hold of"))?;
        points.push(ShapePoint::on_mesh(bound, shape.poses().len()));
    }
    let targets: Vec<Point> = asked
        .points
        .iter()
        .map(|handle| Point::from(handle.to) - hung)
        .collect();
    let places: Vec<Vec<f64>> = bench.scene().poses.iter().map(|pose| pose.at.clone()).collect();
    let start = asked.start.as_ref().unwrap_or(&asked.at);
    let found = match asked.search {
        Search::Everywhere => reach(&of_layer, blend, &places, &points, &targets, &ReachOptions::default()),
        Search::Near => {
            let mut options = ReachOptions::default();
            options.steps = REACH_STEPS;
            reach_near(&of_layer, blend, &places, &points, &targets, &options, start)
        }
    }?;
    let weights = provider.weights_at(&found.at).map_err(Refusal::bad)?;
    let reached: Vec<[f64; 2]> = found.reached.iter().map(|p| (p + hung).into()).collect();
    Ok(Response::json(&json!({
        "at": found.at, "weights": weights, "reached": reached, "error": found.error, "evaluations": found.evaluations,
    })))
}

/// The weights of the poses that have a layer.
#[derive(Debug)]
struct LayerWeights<'a> {
    whole: &'a dyn WeightProvider,
    shape: &'a LayerShape,
}

impl WeightProvider for LayerWeights<'_> {
    fn pose_count(&self) -> usize {
        self.shape.poses().len()
    }

    fn dimension(&self) -> usize {
        self.whole.dimension()
    }

    fn weights(&self, at: &[f64], weights: &mut Vec<f64>) -> Result<(), WeightError> {
        *weights = self.shape.own_weights(&self.whole.weights_at(at)?);
        Ok(())
    }
}
