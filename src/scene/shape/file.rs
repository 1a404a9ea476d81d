//! The scene file of a shape as it is written, before anything is checked but names and types of keys.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::Spanned;

/// A place: one value an adjective.
pub(super) type PlaceTable = Spanned<BTreeMap<String, Spanned<f64>>>;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ShapeSceneFile {
    pub(super) version: Spanned<i64>,
    pub(super) adjectives: Spanned<Vec<Spanned<String>>>,
    pub(super) radial: Option<Spanned<String>>,
    #[serde(default)]
    pub(super) example: Vec<ExampleTable>,
    #[serde(default)]
    pub(super) pseudo_example: Vec<PseudoExampleTable>,
    pub(super) skeleton: Option<SkeletonTable>,
    #[serde(default)]
    pub(super) subdivision: SubdivisionTable,
    #[serde(default)]
    pub(super) sheet: SheetTable,
    #[serde(default)]
    pub(super) animation: AnimationTable,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ExampleTable {
    pub(super) name: Spanned<String>,
    pub(super) form: Spanned<String>,
    pub(super) at: PlaceTable,
    pub(super) texture: Option<Spanned<String>>,
    pub(super) texture_at: Option<PlaceTable>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PseudoExampleTable {
    pub(super) from: PlaceTable,
    pub(super) at: PlaceTable,
    pub(super) of: Option<Spanned<String>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SkeletonTable {
    pub(super) weights: Spanned<String>,
    #[serde(default)]
    pub(super) joint: Vec<JointTable>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct JointTable {
    pub(super) name: Spanned<String>,
    pub(super) parent: Option<Spanned<String>>,
    pub(super) origin: Spanned<Vec<f64>>,
    #[serde(default)]
    pub(super) turns: Vec<TurnTable>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TurnTable {
    pub(super) adjective: Spanned<String>,
    pub(super) axis: Spanned<Vec<f64>>,
    pub(super) degrees: Spanned<f64>,
    pub(super) offset: Option<Spanned<f64>>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SubdivisionTable {
    pub(super) steps: Option<Spanned<i64>>,
    pub(super) limit: Option<bool>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SheetTable {
    pub(super) across: Option<AcrossTable>,
    pub(super) up: Option<UpTable>,
    pub(super) fixed: Option<PlaceTable>,
    #[serde(default)]
    pub(super) view: ViewTable,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AcrossTable {
    pub(super) adjective: Spanned<String>,
    pub(super) from: Option<Spanned<f64>>,
    pub(super) to: Option<Spanned<f64>>,
    pub(super) columns: Option<Spanned<i64>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct UpTable {
    pub(super) adjective: Spanned<String>,
    pub(super) from: Option<Spanned<f64>>,
    pub(super) to: Option<Spanned<f64>>,
    pub(super) rows: Option<Spanned<i64>>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ViewTable {
    pub(super) yaw: Option<Spanned<f64>>,
    pub(super) pitch: Option<Spanned<f64>>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AnimationTable {
    pub(super) fps: Option<Spanned<f64>>,
    #[serde(rename = "loop")]
    pub(super) looped: Option<bool>,
    pub(super) keys: Option<Vec<Spanned<KeyTable>>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct KeyTable {
    pub(super) time: f64,
    pub(super) at: PlaceTable,
    pub(super) texture_at: Option<PlaceTable>,
}
