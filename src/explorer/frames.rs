//! Frames on the wire, and weights.

use std::sync::Arc;

use inbetween::blend::Stretch;
use inbetween::export::svg_text;
use inbetween::math::{Point, predicate};
use inbetween::pipeline::{Posed, checked_weights};
use inbetween::scene::{Provider, Workbench};
use inbetween::weights::WeightProvider;
use serde_json::json;

use super::http::{Request, Response};
use super::model::Shown;
use super::problem::Refusal;
use super::session::Session;
use super::thinning::thinned;
use super::wire::Words;

/// Frames that one request may ask for.
const MOST_FRAMES: usize = 256;

/// Numbers separated by commas.
pub(super) fn numbers(text: &str) -> Result<Vec<f64>, Refusal> {
    let number = |word: &str| word.trim().parse::<f64>().ok().filter(|v| v.is_finite());
    text.split(',')
        .map(number)
        .collect::<Option<_>>()
        .ok_or_else(|| Refusal::bad(format!("'{text}' is not a list of finite numbers, such as 0.5,0.5")))
}

/// The provider that a request names.
pub(super) fn asked_provider(request: &Request) -> Result<Option<Provider>, Refusal> {
    match request.value("provider") {
        None | Some("") => Ok(None),
        Some(name) => provider_named(name).map(Some),
    }
}

pub(super) fn provider_named(name: &str) -> Result<Provider, Refusal> {
    Provider::named(name).ok_or_else(|| Refusal::bad(format!("provider '{name}' is neither biharmonic nor rbf")))
}

fn sharpness(request: &Request) -> Result<Option<f64>, Refusal> {
    let Some(text) = request.value("sharpness") else {
        return Ok(None);
    };
    match numbers(text)?.as_slice() {
        [sharpness] if (0.0..=1.0).contains(sharpness) => Ok(Some(*sharpness)),
        _ => Err(Refusal::bad("sharpness must be between 0 and 1")),
    }
}

/// How far outlines may be off, in drawing units.
fn tolerance(request: &Request) -> Result<f64, Refusal> {
    let Some(text) = request.value("tolerance") else {
        return Ok(0.0);
    };
    match numbers(text)?.as_slice() {
        [tolerance] if *tolerance >= 0.0 => Ok(*tolerance),
        _ => Err(Refusal::bad("tolerance must be a number that is not negative")),
    }
}

fn stretch(request: &Request) -> Result<Option<Stretch>, Refusal> {
    let Some(name) = request.value("stretch").filter(|name| !name.is_empty()) else {
        return Ok(None);
    };
    let refusal = || Refusal::bad(format!("stretch '{name}' is none of linear, limited, log"));
    Stretch::named(name).map(Some).ok_or_else(refusal)
}

/// The weights of every place or list of weights of a request, in its order.
fn asked_weights(request: &Request, shown: &Shown) -> Result<Vec<Vec<f64>>, Refusal> {
    let provider = asked_provider(request)?;
    let names = shown.framed_scene()?.names();
    let mut all = Vec::new();
    let mut known: Option<Arc<dyn WeightProvider>> = None;
    for (name, value) in &request.query {
        match name.as_str() {
            "at" => {
                let provider = match &known {
                    Some(known) => known,
                    None => known.insert(shown.provider(provider)?),
                };
                all.push(provider.weights_at(&numbers(value)?).map_err(Refusal::bad)?);
            }
            "weights" => all.push(checked_weights(&numbers(value)?, &names).map_err(Refusal::bad)?),
            "poses" => {
                let alone = |pose: usize| (0..names.len()).map(|k| f64::from(u8::from(k == pose))).collect();
                all.extend((0..names.len()).map(alone));
            }
            _ => {}
        }
    }
    match all.len() {
        0 => Err(Refusal::bad("say where: at=X,Y or weights=W0,W1,... or poses=all")),
        1..=MOST_FRAMES => Ok(all),
        _ => Err(Refusal::bad(format!("at most {MOST_FRAMES} frames at a time"))),
    }
}

/// `GET api/weights`.
pub(super) fn weights(request: &Request, session: &Session) -> Result<Response, Refusal> {
    let shown = session.shown();
    let sharpness = sharpness(request)?;
    let mut answers = Vec::new();
    for weights in asked_weights(request, &shown)? {
        let seen = shown.texture_weights(&weights, sharpness)?;
        answers.push(json!({"weights": weights, "texture_weights": seen}));
    }
    Ok(Response::json(&answers.into()))
}

/// `GET api/frame`.
pub(super) fn frame(request: &Request, session: &Session) -> Result<Response, Refusal> {
    let shown = session.shown();
    let bench = &shown.stretched(stretch(request)?)?;
    let sharpness = sharpness(request)?;
    let outlines = match request.value("silhouette") {
        Some("1") => Some(tolerance(request)?),
        _ => None,
    };
    let mut bytes = Vec::new();
    for weights in asked_weights(request, &shown)? {
        let posed = bench.posed(&weights, sharpness)?;
        let seen = shown.texture_weights(&weights, sharpness)?;
        let start = bytes.len();
        let mut block = Words(&mut bytes);
        block.u32(0);
        block.u32(shown.revisions.shape as usize);
        block.u32(shown.revisions.weights as usize);
        block.u32(weights.len());
        block.u32(posed.layers.len());
        block.u32(posed.flipped());
        block.f32s(&weights);
        block.f32s(&seen);
        for layer in &posed.order {
            block.u32(*layer);
        }
        write_layers(&mut block, bench, &posed, outlines);
        let length = (bytes.len() - start) as u32;
        bytes[start..start + 4].copy_from_slice(&length.to_le_bytes());
    }
    Ok(Response::binary(bytes))
}

/// `GET api/curves`: one frame as the command renders it, without what is behind it.
pub(super) fn curves(request: &Request, session: &Session) -> Result<Response, Refusal> {
    let shown = session.shown();
    let bench = shown.stretched(stretch(request)?)?;
    let all = asked_weights(request, &shown)?;
    let [weights] = all.as_slice() else {
        return Err(Refusal::bad("curves are of one frame"));
    };
    let posed = bench.posed(weights, sharpness(request)?)?;
    let mut frame = shown.character()?.draw(&posed);
    frame.background = None;
    let text = svg_text(&frame).map_err(Refusal::failed)?;
    Ok(Response::new("image/svg+xml", text))
}

/// With outlines to a tolerance, or without any.
fn write_layers(block: &mut Words<'_>, bench: &Workbench, posed: &Posed, outlines: Option<f64>) {
    for (k, (layer, shape)) in posed.layers.iter().zip(bench.layers()).enumerate() {
        let triangles = shape.mapping().poses.topology().triangles();
        let texture_of = super::pictures::texture_of(bench, k);
        let texture_count = bench.drawings(k).len();
        let rings: Vec<Vec<Point>> = match outlines {
            Some(tolerance) => (bench.silhouette(k, layer).iter())
                .map(|ring| thinned(ring, tolerance))
                .collect(),
            None => Vec::new(),
        };
        block.u32(layer.positions.len());
        block.u32(layer.weights.len());
        block.u32(texture_count);
        block.u32(triangles.len());
        block.u32(rings.len());
        block.f32(layer.opacity);
        block.points(&layer.positions);
        block.f32s(&layer.weights);
        let mut seen = vec![0.0; texture_count];
        for (texture, weight) in texture_of.iter().zip(&layer.texture_weights) {
            seen[*texture] += weight;
        }
        block.f32s(&seen);
        block.bits(triangles.iter().map(|corners| is_inverted(&layer.positions, *corners)));
        for ring in &rings {
            block.u32(ring.len());
            block.points(ring);
        }
    }
}

/// Whether a triangle is turned over or has no area.
pub(super) fn is_inverted(positions: &[Point], [a, b, c]: [usize; 3]) -> bool {
    !predicate::is_positive(positions[a], positions[b], positions[c])
}
