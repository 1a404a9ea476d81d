//! Edits of the scene's text: what the artist left alone, comments and all, stays as it is.

mod landmarks;
mod parts;
mod poses;
mod settings;
mod written;

use std::collections::BTreeMap;

use inbetween::math::Point;
use inbetween::scene::{Scene, Workbench};
use serde::Deserialize;
use serde_json::Value;
use toml_edit::DocumentMut;

use super::pictures::as_drawn;
use super::problem::{Problem, Refusal, Where};

/// One edit. The fields are those that the page of the [explorer](super) lists.
#[derive(Debug, Clone, Deserialize)]
#[serde(tag = "op", rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum Op {
    MovePose {
        pose: String,
        at: Vec<f64>,
    },
    AddLandmark {
        name: Option<String>,
        layer: Option<String>,
        at: BTreeMap<String, Value>,
        #[serde(default)]
        path: bool,
    },
    MoveLandmark {
        landmark: String,
        at: BTreeMap<String, Value>,
    },
    UnsetLandmark {
        landmark: String,
        pose: String,
    },
    RenameLandmark {
        landmark: String,
        name: String,
    },
    RemoveLandmark {
        landmark: String,
    },
    AddPseudoPose {
        from: Vec<f64>,
        at: Vec<f64>,
    },
    MovePseudoPose {
        index: usize,
        from: Option<Vec<f64>>,
        at: Option<Vec<f64>>,
    },
    RemovePseudoPose {
        index: usize,
    },
    Set {
        table: String,
        key: String,
        value: Value,
    },
    SetKeys {
        keys: Vec<KeyText>,
        #[serde(rename = "loop")]
        looped: Option<bool>,
        fps: Option<f64>,
    },
    AddDeformedPose {
        name: Option<String>,
        of: String,
        at: Vec<f64>,
        handles: Vec<HandleText>,
    },
    SetHandles {
        pose: String,
        handles: Vec<HandleText>,
    },
    RemovePose {
        pose: String,
    },
    SetPose {
        pose: String,
        key: String,
        value: Value,
    },
    MarkPart {
        pose: String,
        list: PartList,
        at: [f64; 2],
    },
    UnmarkPart {
        pose: String,
        list: PartList,
        index: usize,
    },
}

/// A list of places on loose parts of a pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum PartList {
    /// Those that belong to the figure.
    Keep,
    /// Those that do not.
    Drop,
}

/// A key of the animation.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct KeyText {
    pub(super) time: f64,
    pub(super) at: Vec<f64>,
    pub(super) hold: Option<i64>,
    #[serde(default)]
    pub(super) spacing: Vec<f64>,
}

/// A handle of a deformed copy.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct HandleText {
    pub(super) from: [f64; 2],
    pub(super) to: [f64; 2],
    pub(super) layer: Option<String>,
}

/// What edits have to know besides the text.
pub(super) struct Context<'a> {
    /// The scene of the text that is edited, with the places that are shown.
    pub(super) scene: Option<&'a Scene>,
    pub(super) bench: Option<&'a Workbench>,
}

/// An edited text, and the names that were given to what has none.
pub(super) struct Edited {
    pub(super) text: String,
    pub(super) names: Vec<String>,
}

/// Applies edits one after the other.
pub(super) fn apply(text: &str, ops: &[Op], context: &Context<'_>) -> Result<Edited, Refusal> {
    let mut document: DocumentMut = text.parse().map_err(|error: toml_edit::TomlError| {
        Refusal::conflict(Problem::at(
            format!(
                "the scene file cannot be edited until it can be read: {}",
                error.message()
            ),
            Where::File,
        ))
    })?;
    let mut names = Vec::new();
    for op in ops {
        names.extend(op.apply(&mut document, context)?);
    }
    Ok(Edited {
        text: document.to_string(),
        names,
    })
}

impl Op {
    fn apply(&self, document: &mut DocumentMut, context: &Context<'_>) -> Result<Option<String>, Refusal> {
        match self {
            Self::MovePose { pose, at } => poses::move_pose(document, context, pose, at)?,
            Self::AddLandmark { name, layer, at, path } => {
                return landmarks::add(document, context, (name.as_deref(), layer.as_deref()), at, *path).map(Some);
            }
            Self::MoveLandmark { landmark, at } => landmarks::move_to(document, context, landmark, at)?,
            Self::UnsetLandmark { landmark, pose } => landmarks::unset(document, landmark, pose)?,
            Self::RenameLandmark { landmark, name } => landmarks::rename(document, landmark, name)?,
            Self::RemoveLandmark { landmark } => landmarks::remove(document, landmark)?,
            Self::AddPseudoPose { from, at } => settings::add_pseudo_pose(document, from, at)?,
            Self::MovePseudoPose { index, from, at } => {
                settings::move_pseudo_pose(document, *index, from.as_deref(), at.as_deref())?;
            }
            Self::RemovePseudoPose { index } => settings::remove_pseudo_pose(document, *index)?,
            Self::Set { table, key, value } => settings::set(document, table, key, value)?,
            Self::SetKeys { keys, looped, fps } => settings::set_keys(document, keys, *looped, *fps)?,
            Self::AddDeformedPose { name, of, at, handles } => {
                return poses::add_copy(document, context, (name.as_deref(), of), at, handles).map(Some);
            }
            Self::SetHandles { pose, handles } => poses::set_handles(document, context, pose, handles)?,
            Self::RemovePose { pose } => poses::remove(document, context, pose)?,
            Self::SetPose { pose, key, value } => poses::set(document, pose, key, value)?,
            Self::MarkPart { pose, list, at } => parts::mark(document, pose, *list, *at)?,
            Self::UnmarkPart { pose, list, index } => parts::unmark(document, pose, *list, *index)?,
        }
        Ok(None)
    }

    /// What it does, for the list of steps.
    pub(super) fn label(&self) -> String {
        match self {
            Self::MovePose { pose, .. } => format!("move pose '{pose}'"),
            Self::AddLandmark { .. } => "add landmark".to_owned(),
            Self::MoveLandmark { landmark, .. } => format!("move landmark '{landmark}'"),
            Self::UnsetLandmark { landmark, pose } => format!("take landmark '{landmark}' off pose '{pose}'"),
            Self::RenameLandmark { landmark, .. } => format!("rename landmark '{landmark}'"),
            Self::RemoveLandmark { landmark } => format!("remove landmark '{landmark}'"),
            Self::AddPseudoPose { .. } => "add pseudo-pose".to_owned(),
            Self::MovePseudoPose { .. } => "move pseudo-pose".to_owned(),
            Self::RemovePseudoPose { .. } => "remove pseudo-pose".to_owned(),
            Self::Set { table, key, .. } => format!("set {key} of {table}"),
            Self::SetKeys { .. } => "set the animation's keys".to_owned(),
            Self::AddDeformedPose { of, .. } => format!("add a pose from '{of}'"),
            Self::SetHandles { pose, .. } => format!("move handles of '{pose}'"),
            Self::RemovePose { pose } => format!("remove pose '{pose}'"),
            Self::SetPose { pose, key, .. } => format!("set {key} of pose '{pose}'"),
            Self::MarkPart { pose, list, .. } | Self::UnmarkPart { pose, list, .. } => {
                format!("change what is {} of pose '{pose}'", list.participle())
            }
        }
    }
}

impl Context<'_> {
    /// A place in drawing units as the file has it: reflected where the pose is.
    fn as_written(&self, layer: Option<&str>, pose: &str, place: Point) -> Point {
        let Some(bench) = self.bench else { return place };
        let shape = |layer: &str| bench.layers().iter().position(|shape| shape.name() == layer);
        as_drawn(bench, layer.and_then(shape).unwrap_or(0), pose, place)
    }
}

/// A point as JSON.
fn point(value: &Value) -> Result<Point, Refusal> {
    let number = |value: &Value| value.as_f64().filter(|v| v.is_finite());
    match value.as_array().map(Vec::as_slice) {
        Some([x, y]) => match (number(x), number(y)) {
            (Some(x), Some(y)) => Ok(Point::new(x, y)),
            _ => Err(Refusal::bad(format!("{value} is not a point [x, y]"))),
        },
        _ => Err(Refusal::bad(format!("{value} is not a point [x, y]"))),
    }
}

#[cfg(test)]
mod tests;
