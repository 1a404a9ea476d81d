//! `--layer`: one layer of a scene.

use anyhow::anyhow;
use inbetween::outline::Outline;
use inbetween::pipeline::{LayerParts, LayerSpec};
use inbetween::scene::{Scene, SceneBuildError};

/// A layer that was chosen.
pub(crate) struct Chosen {
    /// The layer, as a scene of its own.
    pub(crate) scene: Scene,
    /// What is mapped: the layer, or one of the loose parts that it falls into.
    pub(crate) layer: LayerSpec,
    /// For each of its poses the outlines of all that the drawing has, where it has several.
    pub(crate) outlines: Vec<Vec<Outline>>,
    /// What the artist should know.
    pub(crate) notes: Vec<String>,
}

/// The layer that is named, as a scene of its own; a scene without layers is whole, and one with layers needs a name. Of a layer that
/// falls into loose parts, which are layers of their own, it is the largest that is meant where none is named.
pub(crate) fn chosen(scene: Scene, name: Option<&str>) -> anyhow::Result<Chosen> {
    let file = scene.file.display().to_string();
    let known: Vec<String> = scene.layers.iter().map(|layer| format!("'{}'", layer.name)).collect();
    if let Some(own) = name.and_then(|name| scene.layer(name)) {
        return Ok(largest(own.scene.clone())?);
    }
    if scene.layers.is_empty() {
        let spec = scene.layer_spec(0)?;
        let parts = LayerParts::of(&spec, &[]);
        let Some(name) = name else {
            return Ok(largest_of(scene, parts));
        };
        let Some(place) = parts.layers.iter().position(|layer| layer.name == name) else {
            let known: Vec<String> = parts.layers.iter().map(|layer| format!("'{}'", layer.name)).collect();
            return Err(match known.len() {
                1 => anyhow!("{file}: there is no layer '{name}'; leave out --layer"),
                _ => anyhow!("{file}: there is no layer '{name}'; choose one of {}", known.join(", ")),
            });
        };
        return Ok(Chosen {
            scene,
            layer: parts.layers[place].clone(),
            outlines: parts.outlines,
            notes: Vec::new(),
        });
    }
    // The layers that the drawings fall into can be named, too.
    let spec = scene.spec()?;
    match name {
        None => Err(anyhow!(
            "{file}: the scene has layers; choose one with --layer: {}",
            known.join(", ")
        )),
        Some(name) => match spec.layers.into_iter().find(|layer| layer.name == name) {
            Some(layer) => Ok(Chosen {
                outlines: vec![Vec::new(); layer.poses.len()],
                scene,
                layer,
                notes: Vec::new(),
            }),
            None => Err(anyhow!(
                "{file}: there is no layer '{name}'; choose one of {}",
                known.join(", ")
            )),
        },
    }
}

fn largest(scene: Scene) -> Result<Chosen, SceneBuildError> {
    let spec = scene.layer_spec(0)?;
    Ok(largest_of(scene, LayerParts::of(&spec, &[])))
}

fn largest_of(scene: Scene, mut parts: LayerParts) -> Chosen {
    let layer = parts.layers.swap_remove(parts.largest);
    let said = parts.note.map(|note| {
        format!(
            "{note}; this is '{}', the largest: --layer NAME takes another",
            layer.name
        )
    });
    Chosen {
        scene,
        layer,
        outlines: parts.outlines,
        notes: said.into_iter().collect(),
    }
}
