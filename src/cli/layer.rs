//! `--layer`: one layer of a scene.

use anyhow::anyhow;
use inbetween::scene::Scene;

/// The layer that is named, as a scene of its own; a scene without layers is whole, and one with layers needs a name.
pub(crate) fn chosen(scene: Scene, name: Option<&str>) -> anyhow::Result<Scene> {
    let file = scene.file.display();
    let known: Vec<String> = scene.layers.iter().map(|layer| format!("'{}'", layer.name)).collect();
    match name {
        None if scene.layers.is_empty() => Ok(scene),
        None => Err(anyhow!(
            "{file}: the scene has layers; choose one with --layer: {}",
            known.join(", ")
        )),
        Some(name) => match scene.layer(name) {
            Some(layer) => Ok(layer.scene.clone()),
            None if scene.layers.is_empty() => Err(anyhow!("{file}: there is no layer '{name}'; leave out --layer")),
            None => Err(anyhow!(
                "{file}: there is no layer '{name}'; choose one of {}",
                known.join(", ")
            )),
        },
    }
}
