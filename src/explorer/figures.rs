//! The sheets of the drawings, whole, and what of each was taken for the figure.
//!
//! All places are those of the drawing's file: nothing here is reflected, whatever the pose says. Readings that the present mesh was made
//! of are not repeated; those of a scene that cannot be mapped are, since what was taken is then most likely the cause.

use std::path::Path;
use std::sync::Arc;
use std::time::UNIX_EPOCH;

use inbetween::input::{Drawing, FigureRule, InputNote, PaperRule, PartOptions};
use inbetween::math::Point;
use inbetween::outline::Outline;
use inbetween::scene::{DrawnSource, PoseSource, ReadingSettings, Scene, SceneBuildError};
use serde_json::{Value, json};
use toml_edit::DocumentMut;

use super::correspondences::{LONGEST_SIDE, outline_json, picture_json, smaller};
use super::http::{Request, Response};
use super::model::Shown;
use super::pictures::index;
use super::problem::{Problem, Refusal};
use super::session::Session;
use super::stamp::stamp;
use crate::tables::{name_of, tables};

/// The keys of a pose that say how its drawing is read.
const KEYS: [&str; 4] = ["figure", "gap", "paper", "threshold"];

/// A drawing that a request is about.
struct Asked<'a> {
    shown: &'a Shown,
    scene: &'a Scene,
    layer: usize,
    /// Among the poses of the layer.
    pose: usize,
    source: &'a DrawnSource,
}

impl<'a> Asked<'a> {
    fn of(request: &Request, shown: &'a Shown) -> Result<Self, Refusal> {
        let scene = match &shown.scene {
            Some(scene) => scene,
            None => shown.framed_scene()?,
        };
        let layer = index(request, "layer", scene.layers.len().max(1))?;
        let pose = index(request, "pose", scene.poses.len())?;
        let within = match scene.layers.get(layer) {
            Some(layer) => layer.poses.iter().position(|own| *own == pose),
            None => Some(pose),
        };
        let own = scene.of_layer(layer);
        let source = within.and_then(|pose| match &own.poses.get(pose)?.source {
            PoseSource::Drawn(source) => Some((pose, source)),
            PoseSource::Deformed(_) | PoseSource::Layered => None,
        });
        let (pose, source) =
            source.ok_or_else(|| Refusal::bad(format!("pose {pose} has no drawing of its own in layer {layer}")))?;
        Ok(Self {
            shown,
            scene,
            layer,
            pose,
            source,
        })
    }

    /// The drawing as the scene reads it.
    fn read(&self, session: &Session) -> Result<Arc<Drawing>, SceneBuildError> {
        let read = match &self.shown.bench {
            Some(bench) if !session.is_stale() => bench.read_drawing(self.scene, self.layer, self.pose),
            _ => self.scene.read_drawing(self.layer, self.pose),
        };
        read.map(|drawn| drawn.drawing)
    }

    /// The drawing with other places of pieces that belong to it, and with none of pieces that do not: all of them have to be on it.
    fn read_with(&self, keep: Vec<Point>) -> Result<Arc<Drawing>, SceneBuildError> {
        let mut scene = self.scene.clone();
        let own = match scene.layers.get_mut(self.layer) {
            Some(layer) => &mut layer.scene,
            None => &mut scene,
        };
        if let Some(PoseSource::Drawn(source)) = own.poses.get_mut(self.pose).map(|pose| &mut pose.source) {
            let mut parts = PartOptions::default();
            parts.rule = source.parts.rule;
            parts.keep = keep;
            source.parts = parts;
        }
        scene.read_drawing(self.layer, self.pose).map(|drawn| drawn.drawing)
    }

    /// Where the sheet's picture lies, given the drawing on it, as far as that can be read; null if it cannot.
    fn place_of_sheet(&self, drawing: Option<&Arc<Drawing>>) -> Value {
        match drawing {
            // Without decoding it again.
            Some(drawing) if self.is_bitmap() => {
                let size = drawing.canvas.size();
                json!({"origin": [0, 0], "scale": 1, "width": size.x, "height": size.y})
            }
            _ => match self.scene.read_sheet(self.layer, self.pose) {
                Ok(picture) => picture_json(&picture),
                Err(_) => Value::Null,
            },
        }
    }

    fn is_bitmap(&self) -> bool {
        let suffix = self.source.file.extension();
        !suffix.is_some_and(|suffix| suffix.eq_ignore_ascii_case("svg"))
    }
}

/// `GET api/figure`.
pub(super) fn figure(request: &Request, session: &Session) -> Result<Response, Refusal> {
    let shown = session.shown();
    let asked = Asked::of(request, &shown)?;
    let parts = &asked.source.parts;
    if let Some(place) = request.value("keep") {
        // Whether there is a piece.
        asked.read_with(vec![place_of(place)?])?;
    }
    let read = asked.read(session);
    let is_marked = !(parts.keep.is_empty() && parts.drop.is_empty());
    // With all that was dropped, and whatever places do not fit.
    let bare = if is_marked && (read.is_err() || !parts.drop.is_empty()) {
        asked.read_with(Vec::new()).ok()
    } else {
        None
    };
    let pair = |p: &Point| [p.x, p.y];
    let (problem, drawing) = match &read {
        Ok(drawing) => (None, Some(drawing)),
        Err(error) => (Some(Problem::from(error)), bare.as_ref()),
    };
    let mut pieces = drawing.map(|drawing| pieces_of(drawing)).unwrap_or_default();
    if let (Ok(read), Some(bare)) = (&read, &bare) {
        // Of a drawing of several layers, a place may be one of another's.
        let is_there = |outline: &Outline| outlines_of(read).any(|(own, _)| own == outline);
        let is_dropped =
            |outline: &Outline| parts.drop.iter().any(|place| outline.contains(*place)) && !is_there(outline);
        let dropped = outlines_of(bare).filter(|(outline, _)| is_dropped(outline));
        pieces.extend(dropped.map(|(outline, _)| piece_json(outline, "dropped")));
    }
    let reading = &asked.source.reading;
    Ok(Response::json(&json!({
        "name": asked.scene.of_layer(asked.layer).poses[asked.pose].name,
        "bitmap": asked.is_bitmap(),
        "taken": drawing.filter(|_| asked.is_bitmap()).map(|drawing| taken(drawing)),
        "mark": file_mark(asked.scene, &asked.source.file),
        "sheet": asked.place_of_sheet(drawing),
        "pieces": pieces,
        "notes": drawing.map(|drawing| notes_of(drawing)),
        "reading": reading_json(reading),
        "usual": reading_json(&asked.scene.input.reading),
        "own": own_keys(&session.text(), &asked.scene.of_layer(asked.layer).poses[asked.pose].name),
        "keep": parts.keep.iter().map(pair).collect::<Vec<_>>(),
        "drop": parts.drop.iter().map(pair).collect::<Vec<_>>(),
        "problem": problem,
    })))
}

/// `GET api/sheet`.
pub(super) fn sheet(request: &Request, session: &Session) -> Result<Response, Refusal> {
    let shown = session.shown();
    let asked = Asked::of(request, &shown)?;
    let longest = match request.value("max") {
        None => LONGEST_SIDE,
        Some(text) => text.parse().map_err(|_| Refusal::bad("`max` is no number"))?,
    };
    let picture = asked.scene.read_sheet(asked.layer, asked.pose)?;
    let frame = smaller(&picture, longest.clamp(1, LONGEST_SIDE));
    let png = inbetween::export::png_bytes(&frame).map_err(Refusal::failed)?;
    Ok(Response {
        may_be_kept: request.value("v").is_some(),
        ..Response::new("image/png", png)
    })
}

/// "X,Y".
fn place_of(text: &str) -> Result<Point, Refusal> {
    let numbers: Vec<f64> = text.split(',').filter_map(|part| part.parse().ok()).collect();
    match numbers[..] {
        [x, y] if x.is_finite() && y.is_finite() => Ok(Point::new(x, y)),
        _ => Err(Refusal::bad("`keep` must be a place X,Y")),
    }
}

/// All pieces of a drawing that are handed on, the largest first, with whether they were asked for.
fn outlines_of(drawing: &Drawing) -> impl Iterator<Item = (&Outline, bool)> {
    let others = drawing.parts.iter().filter(|part| part.outline != drawing.outline);
    std::iter::once((&drawing.outline, false)).chain(others.map(|part| (&part.outline, part.is_kept)))
}

fn pieces_of(drawing: &Drawing) -> Vec<Value> {
    let roles = std::iter::once("body").chain(std::iter::repeat("part"));
    outlines_of(drawing)
        .zip(roles)
        .map(|((outline, is_kept), role)| piece_json(outline, if is_kept { "kept" } else { role }))
        .collect()
}

/// What is to be said of a drawing. Parts that its outline goes without are seen on the sheet.
fn notes_of(drawing: &Drawing) -> Vec<String> {
    let is_seen = |note: &&InputNote| matches!(note, InputNote::PartsLeftOut { .. }) && !drawing.parts.is_empty();
    let told = drawing.notes.iter().filter(|note| note.is_told() && !is_seen(note));
    told.map(ToString::to_string).collect()
}

/// As what the figure of a bitmap was taken, as `figure` would ask for it.
fn taken(drawing: &Drawing) -> &'static str {
    let told = drawing.notes.iter().find_map(|note| match note {
        InputNote::FigurePainted { .. } => Some("background"),
        InputNote::FigureOfLines { .. } => Some("lines"),
        _ => None,
    });
    told.unwrap_or("alpha")
}

fn piece_json(outline: &Outline, role: &str) -> Value {
    let (outer, holes) = outline_json(outline);
    json!({"role": role, "outline": outer, "holes": holes})
}

fn reading_json(reading: &ReadingSettings) -> Value {
    let figure = FigureRule::NAMED.iter().find(|(_, rule)| *rule == reading.figure);
    let paper = PaperRule::NAMED.iter().find(|(_, rule)| *rule == reading.paper);
    json!({
        "figure": figure.map(|(name, _)| name), "gap": reading.gap,
        "paper": paper.map(|(name, _)| name), "threshold": reading.threshold,
    })
}

/// Which of the keys that say how a drawing is read the scene's text has for a pose.
fn own_keys(text: &str, pose: &str) -> Vec<&'static str> {
    let Ok(mut document) = text.parse::<DocumentMut>() else {
        return Vec::new();
    };
    let own = tables(&mut document, "pose")
        .into_iter()
        .find(|table| name_of(&**table) == Some(pose));
    let has = |key: &&str| own.as_ref().is_some_and(|table| table.contains_key(key));
    KEYS.into_iter().filter(has).collect()
}

/// What tells a drawing's file from an older one of the same name.
fn file_mark(scene: &Scene, source: &Path) -> String {
    let file = scene.file.parent().unwrap_or(Path::new(".")).join(source);
    let Some((length, Some(written))) = stamp(&file) else {
        return String::new();
    };
    let since = written.duration_since(UNIX_EPOCH).unwrap_or_default();
    format!("{length:x}-{:x}", since.as_nanos())
}
