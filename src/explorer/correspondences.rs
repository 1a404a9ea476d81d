//! Which point of every outline corresponds to which, and the drawings beneath.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

use inbetween::input::{Drawing, Picture};
use inbetween::math::{Point, point};
use inbetween::mesh::PointLocator;
use inbetween::outline::{ArcLength, Outline};
use inbetween::pipeline::INTERIOR_DEPTH;
use inbetween::pose::LandmarkKind;
use inbetween::render::Frame;
use inbetween::render::diagram::Sections;
use inbetween::scene::{Scene, Workbench};
use serde::Deserialize;
use serde_json::{Value, json};

use super::http::{Request, Response};
use super::pictures::{asked_layer, index, pose_of, shape_of, texture_of};
use super::problem::Refusal;
use super::session::Session;

/// Samples along the outlines that a request may ask for.
const MOST_SAMPLES: usize = 4096;
/// The longest side of a picture that is sent.
pub(super) const LONGEST_SIDE: usize = 4096;

fn flat(points: &[Point]) -> Vec<f64> {
    points.iter().flat_map(|p| [p.x, p.y]).collect()
}

fn pair(p: Point) -> [f64; 2] {
    [p.x, p.y]
}

/// `GET api/correspondences`.
pub(super) fn correspondences(request: &Request, session: &Session) -> Result<Response, Refusal> {
    let shown = session.shown();
    let samples = index(request, "samples", MOST_SAMPLES + 1)?;
    if let Some(bench) = &shown.bench {
        let layer = asked_layer(request, bench)?;
        let known: Vec<&str> = request.value("known").unwrap_or_default().split(',').collect();
        let mut answer = matched(bench, layer, samples, &known);
        answer["shape"] = shown.revisions.shape.into();
        return Ok(Response::json(&answer));
    }
    let scene = shown.framed_scene()?;
    let layer = index(request, "layer", scene.layers.len().max(1))?;
    Ok(Response::json(&unmatched(scene, layer)))
}

pub(super) fn outline_json(outline: &Outline) -> (Value, Value) {
    let holes: Vec<Vec<f64>> = outline.holes().iter().map(|hole| flat(hole.points())).collect();
    (flat(outline.outer().points()).into(), json!(holes))
}

/// What tells this outline, and all that follows from it alone, from others.
fn mark_of(outline: &Outline) -> String {
    let mut hasher = DefaultHasher::new();
    for ring in outline.rings() {
        ring.points().len().hash(&mut hasher);
        let numbers = ring.points().iter().flat_map(|p| [p.x, p.y]);
        numbers.for_each(|number| number.to_bits().hash(&mut hasher));
    }
    format!("{:016x}", hasher.finish())
}

pub(super) fn picture_json(picture: &Picture) -> Value {
    json!({
        "origin": pair(picture.origin), "scale": picture.pixels_per_unit,
        "width": picture.width, "height": picture.height,
    })
}

/// `known`: the marks of the outlines that whoever asks has.
fn matched(bench: &Workbench, layer: usize, samples: usize, known: &[&str]) -> Value {
    let (shape, report) = (&bench.layers()[layer], bench.report(layer));
    let mapping = shape.mapping();
    let drawn = bench.spec().layers[layer].drawn_poses();
    let texture_of = texture_of(bench, layer);
    let curves: Vec<ArcLength> = mapping
        .outlines
        .iter()
        .map(|outline| ArcLength::new(outline.outer()))
        .collect();
    let at = |pose: usize, t: f64| pair(curves[pose].at(t));
    let pose_json = |pose: usize| {
        let matched = &report.matching.poses[pose];
        let mark = mark_of(&mapping.outlines[pose]);
        let is_known = known.contains(&mark.as_str());
        let mut answer = json!({
            "mark": mark,
            "pose": shape.poses()[pose], "name": mapping.poses.names()[pose], "drawn": drawn.contains(&pose),
            "picture": picture_json(&bench.drawings(layer)[texture_of[pose]].picture),
            "cost": matched.cost, "looks_mirrored": matched.looks_mirrored,
        });
        if !is_known {
            let salient = matched.salient.iter().map(|s| {
                json!({
                    "at": at(pose, s.parameter), "scale": s.scale, "curvature": s.curvature,
                })
            });
            (answer["outline"], answer["holes"]) = outline_json(&mapping.outlines[pose]);
            answer["salient"] = salient.collect();
        }
        answer
    };
    let poses = 0..mapping.poses.len();
    let sections = Sections::new(mapping, &report.matching, &report.landmarks);
    let links = sections.links().iter().map(|link| {
        json!({
            "at": poses.clone().map(|pose| at(pose, link.at[pose])).collect::<Vec<_>>(),
            "landmark": link.landmark.map(|k| &report.landmarks[k].name),
        })
    });
    let suggestions = poses
        .clone()
        .filter(|pose| *pose != sections.reference())
        .flat_map(|pose| {
            let doubtful = sections.doubtful(pose);
            let of_section = |&k: &usize| {
                let (from, to) = sections.numbers(k);
                json!({"pose": shape.poses()[pose], "from": from - 1, "to": to - 1, "cost": sections.costs(pose)[k]})
            };
            doubtful.iter().map(of_section).collect::<Vec<_>>()
        });
    let landmarks = report.landmarks.iter().map(|landmark| {
        let points = |points: &Vec<Point>| points.iter().map(|p| pair(*p)).collect::<Vec<_>>();
        json!({
            "name": landmark.name,
            "kind": match landmark.kind {
                LandmarkKind::OnOutline => "outline",
                LandmarkKind::OnRim => "rim",
                LandmarkKind::Inside => "inside",
                LandmarkKind::Line => "line",
            },
            "given": landmark.given,
            "at": landmark.at.iter().map(points).collect::<Vec<_>>(),
        })
    });
    let (reference, outer) = (mapping.matching.reference, &mapping.matching.outer);
    let along = |pose: usize| -> Vec<f64> {
        let parameter = |k: usize| outer.carry(reference, pose, k as f64 / samples as f64);
        (0..samples).flat_map(|k| at(pose, parameter(k))).collect()
    };
    json!({
        "reference": shape.poses()[reference],
        "poses": poses.clone().map(pose_json).collect::<Vec<_>>(),
        "links": links.collect::<Vec<_>>(),
        "costs": poses.clone().map(|pose| sections.costs(pose)).collect::<Vec<_>>(),
        "suggestions": suggestions.collect::<Vec<_>>(),
        "landmarks": landmarks.collect::<Vec<_>>(),
        "samples": poses.map(along).collect::<Vec<_>>(),
    })
}

/// Of drawings that could not be mapped.
fn unmatched(scene: &Scene, layer: usize) -> Value {
    let own = scene.of_layer(layer);
    let all: Vec<usize> = (0..scene.poses.len()).collect();
    let poses_of = scene.layers.get(layer).map_or(&all, |layer| &layer.poses);
    let pose_json = |(pose, index): (usize, &usize)| {
        let is_drawn = own.drawn_poses().contains(&pose);
        let drawing = scene.read_drawing(layer, pose).ok();
        let drawing = drawing.and_then(|drawn| drawn.as_used().ok());
        let (outline, holes) = drawing
            .as_ref()
            .map_or((Value::Null, json!([])), |d| outline_json(&d.outline));
        json!({
            "pose": index, "name": own.poses[pose].name, "drawn": is_drawn,
            "outline": outline, "holes": holes,
            "picture": drawing.as_ref().map(|drawing| picture_json(&drawing.picture)),
            "salient": [], "cost": 0.0, "looks_mirrored": false,
        })
    };
    json!({
        "shape": 0, "reference": own.reference.map(|pose| poses_of[pose]),
        "poses": poses_of.iter().enumerate().map(pose_json).collect::<Vec<_>>(),
        "links": [], "costs": [], "suggestions": [], "landmarks": [], "samples": [],
    })
}

/// `GET api/drawing`.
pub(super) fn drawing(request: &Request, session: &Session) -> Result<Response, Refusal> {
    let shown = session.shown();
    let scene = shown.scene.as_deref().or(shown.bench.as_deref().map(Workbench::scene));
    let scene = match scene {
        Some(scene) => scene,
        None => shown.framed_scene()?,
    };
    // Loose parts are layers that the scene does not know.
    let of_bench = shown.bench.as_deref().map_or(0, |bench| bench.layers().len());
    let layer = index(request, "layer", scene.layers.len().max(of_bench).max(1))?;
    let pose = index(request, "pose", scene.poses.len())?;
    let longest = match request.value("max") {
        None => LONGEST_SIDE,
        Some(text) => text.parse().map_err(|_| Refusal::bad("`max` is no number"))?,
    };
    let own = scene.of_layer(layer);
    let own_pose = match scene.layers.get(layer) {
        Some(layer) => layer.poses.iter().position(|p| *p == pose),
        None => Some(pose),
    };
    let root = own_pose.and_then(|pose| Some(own.drawing_of(pose)?.0));
    let root = root.ok_or_else(|| Refusal::bad(format!("pose {pose} has no drawing in layer {layer}")))?;
    let kept = shown.bench.as_deref().and_then(|bench| {
        let theirs = bench.spec().layers.get(layer)?;
        let name = &own.poses[root].name;
        let pose = theirs.poses.iter().position(|pose| pose.name == *name)?;
        let (root, _) = theirs.drawing_of(pose)?;
        let k = theirs.drawn_poses().iter().position(|&pose| pose == root)?;
        bench.drawings(layer).get(k)
    });
    let drawing: Arc<Drawing> = match kept {
        Some(drawing) => Arc::clone(drawing),
        None => scene.read_drawing(layer, root)?.as_used().map_err(Refusal::bad)?,
    };
    let frame = smaller(&drawing.picture, longest.clamp(1, LONGEST_SIDE));
    let png = inbetween::export::png_bytes(&frame).map_err(Refusal::failed)?;
    Ok(Response {
        may_be_kept: request.value("v").is_some(),
        ..Response::new("image/png", png)
    })
}

/// A picture none of whose sides is longer: each pixel the mean of a square of them.
pub(super) fn smaller(picture: &Picture, longest: usize) -> Frame {
    let times = picture.width.max(picture.height).div_ceil(longest).max(1);
    let (width, height) = (picture.width.div_ceil(times), picture.height.div_ceil(times));
    let mut frame = Frame::filled(width, height, [0; 4]);
    for (i, pixel) in frame.pixels.iter_mut().enumerate() {
        let (x0, y0) = (i % width * times, i / width * times);
        let mut sum = [0usize; 4];
        for y in y0..(y0 + times).min(picture.height) {
            for source in &picture.pixels[y * picture.width..][x0..(x0 + times).min(picture.width)] {
                for (sum, channel) in sum.iter_mut().zip(source) {
                    *sum += usize::from(*channel);
                }
            }
        }
        *pixel = sum.map(|sum| (sum / (times * times)) as u8);
    }
    frame
}

/// The body of `POST api/carry`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Carried {
    #[serde(default)]
    layer: usize,
    pose: String,
    at: [f64; 2],
}

/// `POST api/carry`.
pub(super) fn carry(body: &[u8], session: &Session) -> Result<Response, Refusal> {
    let asked: Carried = serde_json::from_slice(body).map_err(Refusal::bad)?;
    let shown = session.shown();
    let bench = shown.bench()?;
    let shape = shape_of(bench, asked.layer)?;
    let mapping = shape.mapping();
    let names = mapping.poses.names();
    let own = pose_of(shape, asked.layer, &asked.pose)?;
    let place = Point::from(asked.at);
    if !point::is_finite(place) {
        return Err(Refusal::bad("`at` is not finite"));
    }
    let Place { ring, at: t, is_inside } = Place::of(&mapping.outlines[own], place);
    let triangles = mapping.poses.topology().triangles();
    let everywhere = mapping.poses.positions();
    let locator = || PointLocator::new(triangles, &everywhere[own]);
    let at: Option<Vec<[f64; 2]>> = match ring {
        _ if is_inside => locator()
            .bind(place)
            .map(|bound| everywhere.iter().map(|at| pair(bound.at(at))).collect()),
        0 => {
            let outer = |pose: usize| ArcLength::new(mapping.outlines[pose].outer());
            let carried = |pose: usize| pair(outer(pose).at(mapping.matching.outer.carry(own, pose, t)));
            Some((0..names.len()).map(carried).collect())
        }
        // Rims are within the mesh, which carries them; the other rim is nearby.
        rim => {
            let curve = |pose: usize| Some(ArcLength::new(mapping.outlines[pose].rings().get(rim)?));
            let place = curve(own).map(|own| own.at(t));
            // By the nearest point of the mesh, if rounding puts it beside.
            let bound = place.and_then(|place| Some((place, *locator().bind_along([place])?.first()?)));
            bound.and_then(|(place, bound)| {
                let carried = |pose: usize| {
                    let curve = curve(pose)?;
                    let near = bound.at(&everywhere[pose]);
                    Some(pair(if pose == own {
                        place
                    } else {
                        curve.at(curve.nearest(near).0)
                    }))
                };
                (0..names.len()).map(carried).collect()
            })
        }
    };
    let kind = match ring {
        _ if is_inside => "inside",
        0 => "outline",
        _ => "rim",
    };
    Ok(Response::json(&json!({"kind": kind, "poses": names, "at": at})))
}

/// What a place of a pose is taken for: the nearest place of its rings, unless it lies deep inside.
struct Place {
    /// The nearest ring; 0 is the outer one.
    ring: usize,
    /// The parameter there.
    at: f64,
    is_inside: bool,
}

impl Place {
    fn of(outline: &Outline, place: Point) -> Self {
        let (mut ring, (mut at, mut distance)) = (0, ArcLength::new(outline.outer()).nearest(place));
        for (hole, rim) in outline.holes().iter().enumerate() {
            let (t, away) = ArcLength::new(rim).nearest(place);
            if away < distance {
                (ring, at, distance) = (hole + 1, t, away);
            }
        }
        Self {
            ring,
            at,
            is_inside: outline.contains(place) && distance > INTERIOR_DEPTH * outline.diagonal(),
        }
    }
}
