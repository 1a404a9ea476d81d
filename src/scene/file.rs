//! The scene file as it is written, before anything is checked but names and types of keys.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::{Spanned, Value};

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneFile {
    pub(super) version: Spanned<i64>,
    pub(super) reference: Option<Spanned<String>>,
    #[serde(default)]
    pub(super) input: InputTable,
    #[serde(default)]
    pub(super) mesh: MeshTable,
    #[serde(default)]
    pub(super) pose_space: PoseSpaceTable,
    #[serde(default)]
    pub(super) blend: BlendTable,
    #[serde(default)]
    pub(super) texture: TextureTable,
    #[serde(default)]
    pub(super) pose: Vec<Spanned<PoseTable>>,
    #[serde(default)]
    pub(super) pseudo_pose: Vec<Spanned<PseudoPoseTable>>,
    #[serde(default)]
    pub(super) landmark: Vec<Spanned<LandmarkTable>>,
    #[serde(default)]
    pub(super) part: Vec<Spanned<PartTable>>,
    #[serde(default)]
    pub(super) region: Vec<Spanned<RegionTable>>,
    #[serde(default)]
    pub(super) layer: Vec<Spanned<LayerTable>>,
    #[serde(default)]
    pub(super) animation: AnimationTable,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct InputTable {
    pub(super) figure: Option<Spanned<String>>,
    pub(super) gap: Option<Spanned<f64>>,
    pub(super) paper: Option<Spanned<String>>,
    pub(super) holes: Option<Spanned<String>>,
    pub(super) threshold: Option<Spanned<f64>>,
    pub(super) parts: Option<Spanned<String>>,
    pub(super) overlaps: Option<Spanned<String>>,
    pub(super) cells: Option<Spanned<Vec<i64>>>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MeshTable {
    pub(super) simplify: Option<Spanned<f64>>,
    pub(super) edge_length: Option<Spanned<f64>>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PoseSpaceTable {
    pub(super) provider: Option<Spanned<String>>,
    pub(super) radial: Option<Spanned<String>>,
    pub(super) epsilon: Option<Spanned<f64>>,
    pub(super) bounded: Option<Spanned<bool>>,
    pub(super) walls: Option<Spanned<Vec<Vec<Vec<f64>>>>>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BlendTable {
    pub(super) reference: Option<Spanned<String>>,
    pub(super) stretch: Option<Spanned<String>>,
    pub(super) guard: Option<Spanned<String>>,
    /// A name, or a list of names and tables.
    pub(super) anchor: Option<Spanned<Value>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RegionTable {
    pub(super) landmark: String,
    pub(super) radius: f64,
    pub(super) stiffness: Option<f64>,
    pub(super) stretch_limit: Option<f64>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TextureTable {
    pub(super) sharpness: Option<Spanned<f64>>,
    pub(super) blending: Option<Spanned<String>>,
    pub(super) drawing: Option<Spanned<String>>,
    pub(super) sampling: Option<Spanned<String>>,
    pub(super) register: Option<Spanned<String>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PoseTable {
    pub(super) name: Spanned<String>,
    /// A path, or with layers a table of paths.
    pub(super) source: Option<Spanned<Value>>,
    pub(super) element: Option<Spanned<Value>>,
    pub(super) figure: Option<Spanned<String>>,
    pub(super) gap: Option<Spanned<f64>>,
    pub(super) paper: Option<Spanned<String>>,
    pub(super) threshold: Option<Spanned<f64>>,
    pub(super) keep: Option<Spanned<Vec<Value>>>,
    pub(super) drop: Option<Spanned<Vec<Value>>>,
    pub(super) frame: Option<Spanned<i64>>,
    pub(super) cell: Option<Spanned<Vec<i64>>>,
    pub(super) at: Option<Spanned<Vec<f64>>>,
    /// A flag, or `auto`.
    pub(super) mirror: Option<Spanned<Value>>,
    pub(super) turns: Option<Spanned<i64>>,
    pub(super) deform_of: Option<Spanned<String>>,
    pub(super) handles: Option<Spanned<Vec<HandleTable>>>,
    /// Layers from back to front, or limbs in a scene without.
    pub(super) order: Option<Spanned<Vec<Spanned<String>>>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct HandleTable {
    pub(super) from: Vec<f64>,
    pub(super) to: Vec<f64>,
    pub(super) layer: Option<Spanned<String>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PseudoPoseTable {
    pub(super) from: Spanned<Vec<f64>>,
    pub(super) at: Spanned<Vec<f64>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LandmarkTable {
    pub(super) name: Spanned<String>,
    /// A point a pose, or with `path` a polyline a pose.
    pub(super) at: BTreeMap<String, Spanned<Value>>,
    pub(super) path: Option<Spanned<bool>>,
    pub(super) layer: Option<Spanned<String>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PartTable {
    pub(super) name: Spanned<String>,
    /// A point a pose.
    pub(super) at: BTreeMap<String, Spanned<Value>>,
    /// A polyline a pose.
    #[serde(default)]
    pub(super) cut: BTreeMap<String, Spanned<Value>>,
    pub(super) layer: Option<Spanned<String>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LayerTable {
    pub(super) name: Spanned<String>,
    pub(super) anchor: Option<Spanned<LayerAnchorTable>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LayerAnchorTable {
    pub(super) layer: Spanned<String>,
    /// A landmark.
    pub(super) at: Spanned<String>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AnimationTable {
    pub(super) fps: Option<Spanned<f64>>,
    #[serde(rename = "loop")]
    pub(super) looped: Option<bool>,
    pub(super) size: Option<Spanned<Vec<i64>>>,
    pub(super) background: Option<Spanned<String>>,
    pub(super) camera: Option<Spanned<String>>,
    pub(super) hold: Option<Spanned<i64>>,
    pub(super) keys: Option<Spanned<Vec<Spanned<KeyTable>>>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct KeyTable {
    pub(super) time: f64,
    pub(super) at: Vec<f64>,
    pub(super) hold: Option<Spanned<i64>>,
    pub(super) spacing: Option<Spanned<Vec<Spanned<f64>>>>,
}
