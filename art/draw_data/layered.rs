//! The file of a scene with layers: one drawing a pose, in which every layer is a group.

use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;

use kurbo::Point;

use crate::scene::{TRUTH, animation, decimal};

/// A layer, from the back to the front.
#[derive(Debug)]
pub(crate) struct Layer {
    /// Its name, and the id of its group in every drawing.
    pub(crate) name: &'static str,
    /// The layer that it hangs on, and its own landmark where it does.
    pub(crate) anchor: Option<(&'static str, &'static str)>,
}

/// One drawing and its place.
#[derive(Debug)]
pub(crate) struct Pose {
    pub(crate) name: &'static str,
    pub(crate) file: String,
    /// Place in pose space.
    pub(crate) at: [f64; 2],
    /// Its layers from back to front, where that is not the scene's order.
    pub(crate) order: &'static [&'static str],
    /// The layers that it has, each with its known points.
    pub(crate) layers: Vec<(&'static str, Vec<(String, Point)>)>,
}

/// What a scene file says.
#[derive(Debug)]
pub(crate) struct Scene {
    pub(crate) layers: &'static [Layer],
    /// The poses; the first is the reference, and has the most layers' known points first.
    pub(crate) poses: Vec<Pose>,
    /// Those of the known points that the scene has as landmarks.
    pub(crate) landmarks: &'static [&'static str],
    /// Sections before the layers as they stand in the file.
    pub(crate) settings: &'static str,
    /// Size of the animation, pixels.
    pub(crate) size_px: [u32; 2],
    /// The animation's keys as they stand in the file.
    pub(crate) keys: &'static str,
}

/// Writes `scene.toml` into `folder`, and beside it `truth.toml` with all points that are known.
pub(crate) fn save(folder: &Path, scene: &Scene) -> Result<(), Box<dyn Error>> {
    let reference = scene.poses.first().ok_or("a scene needs a pose")?;
    let mut text = format!("version = 1\nreference = \"{}\"\n\n{}", reference.name, scene.settings);
    for layer in scene.layers {
        write!(text, "\n[[layer]]\nname = \"{}\"\n", layer.name)?;
        if let Some((to, at)) = layer.anchor {
            writeln!(text, "anchor = {{ layer = \"{to}\", at = \"{at}\" }}")?;
        }
    }
    for pose in &scene.poses {
        let elements: Vec<String> = (pose.layers.iter())
            .map(|(name, _)| format!("{name} = \"{name}\""))
            .collect();
        write!(
            text,
            "\n[[pose]]\nname = \"{}\"\nsource = \"{}\"\nelement = {{ {} }}\nat = [{:.1}, {:.1}]\n",
            pose.name,
            pose.file,
            elements.join(", "),
            pose.at[0],
            pose.at[1]
        )?;
        if !pose.order.is_empty() {
            writeln!(text, "order = {:?}", pose.order)?;
        }
    }
    let mut truth = String::from(TRUTH);
    for layer in scene.layers {
        write_landmarks(&mut text, layer.name, scene, &|name| scene.landmarks.contains(&name))?;
        write_landmarks(&mut truth, layer.name, scene, &|_| true)?;
    }
    std::fs::write(folder.join("truth.toml"), truth)?;
    text.push_str(&animation(scene.size_px, scene.keys));
    std::fs::write(folder.join("scene.toml"), text)?;
    Ok(())
}

fn write_landmarks(text: &mut String, layer: &str, scene: &Scene, is_kept: &dyn Fn(&str) -> bool) -> std::fmt::Result {
    let having: Vec<(&str, &[(String, Point)])> = (scene.poses.iter())
        .flat_map(|pose| {
            let own = pose.layers.iter().filter(|(name, _)| *name == layer);
            own.map(|(_, landmarks)| (pose.name, landmarks.as_slice()))
        })
        .collect();
    let Some((_, first)) = having.first() else {
        return Ok(());
    };
    for (k, (name, _)) in first.iter().enumerate().filter(|(_, (name, _))| is_kept(name)) {
        let places: Vec<String> = (having.iter())
            .map(|(pose, landmarks)| {
                let point = landmarks[k].1;
                format!("{pose} = [{}, {}]", decimal(point.x), decimal(point.y))
            })
            .collect();
        write!(
            text,
            "\n[[landmark]]\nname = \"{name}\"\nlayer = \"{layer}\"\nat = {{ {} }}\n",
            places.join(", ")
        )?;
    }
    Ok(())
}
