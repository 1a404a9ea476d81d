//! The text of a new scene file.

use std::fmt::Write as _;

use crate::input::PictureChoice;

/// A pose of a new scene.
#[derive(Debug, Clone, PartialEq)]
pub struct NewPose {
    /// Its name.
    pub name: String,
    /// Its source, relative to the scene file.
    pub source: String,
    /// Which picture of its source it is.
    pub picture: PictureChoice,
    /// What of its source it is.
    pub element: NewElement,
    /// Its place in the pose space; all poses of a scene have one, or none.
    pub at: Option<[f64; 2]>,
}

/// What of its source a pose of a new scene is.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum NewElement {
    /// All that is seen.
    #[default]
    Whole,
    /// A layer or group of a layered file, by its path.
    One(String),
    /// An element for each of the scene's layers that the pose has.
    Layers {
        /// The names of the layers and the paths of their elements.
        elements: Vec<(String, String)>,
        /// The layers from back to front, where that is not the scene's own order.
        order: Option<Vec<String>>,
    },
}

/// A scene file for `poses` with `layers`, from back to front, or without any, and with the keys an artist is likely to want next as comments.
#[must_use]
pub fn scene_text(layers: &[String], poses: &[NewPose]) -> String {
    let mut text = String::from(
        "version = 1\n\
         # `at` is a pose's place: poses that are alike lie near one another. Move them as you like, x and y meaning whatever\n\
         # suits the character. Without any `at` the poses are laid out anew, from the drawings, whenever they are used.\n",
    );
    let grid = poses.iter().find_map(|pose| match pose.picture {
        PictureChoice::Cell { of, .. } => Some(of),
        PictureChoice::Only | PictureChoice::Frame(_) => None,
    });
    if let Some([columns, rows]) = grid {
        let _ = write!(text, "\n[input]\ncells = [{columns}, {rows}]\n");
    }
    // A TOML value knows its own quoting.
    let quoted = |s: &str| toml::Value::String(s.to_owned()).to_string();
    for (place, layer) in layers.iter().enumerate() {
        text.push_str(if place == 0 { "\n# From back to front.\n" } else { "\n" });
        let _ = writeln!(text, "[[layer]]\nname = {}", quoted(layer));
    }
    for pose in poses {
        let _ = write!(
            text,
            "\n[[pose]]\nname = {}\nsource = {}\n",
            quoted(&pose.name),
            quoted(&pose.source)
        );
        match pose.picture {
            PictureChoice::Only => {}
            PictureChoice::Frame(frame) => {
                let _ = writeln!(text, "frame = {frame}");
            }
            PictureChoice::Cell { at: [column, row], .. } => {
                let _ = writeln!(text, "cell = [{column}, {row}]");
            }
        }
        match &pose.element {
            NewElement::Whole => {}
            NewElement::One(element) => {
                let _ = writeln!(text, "element = {}", quoted(element));
            }
            NewElement::Layers { elements, order } => {
                let listed = elements.iter();
                let listed = listed.map(|(layer, path)| format!("{} = {}", toml_key(layer), quoted(path)));
                let _ = writeln!(text, "element = {{ {} }}", listed.collect::<Vec<_>>().join(", "));
                if let Some(order) = order {
                    let listed: Vec<String> = order.iter().map(|layer| quoted(layer)).collect();
                    let _ = writeln!(text, "order = [{}]", listed.join(", "));
                }
            }
        }
        text.push_str(&match pose.at {
            Some([x, y]) => format!("at = [{x:?}, {y:?}]\n"),
            None => "# at = [0.0, 0.0]\n".to_owned(),
        });
    }
    text.push_str(
        "\n# A point that corresponds, where the automatic match errs: source pixels or SVG units, a pose may lack it.\n\
         # [[landmark]]\n# name = \"nose\"\n",
    );
    if let Some(layer) = layers.last() {
        let _ = writeln!(text, "# layer = {}", quoted(layer));
    }
    let _ = writeln!(
        text,
        "# at = {{ {} }}",
        poses
            .iter()
            .map(|p| format!("{} = [0.0, 0.0]", toml_key(&p.name)))
            .collect::<Vec<_>>()
            .join(", ")
    );
    text.push_str("\n[animation]\nfps = 24\nsize = [1280, 720]\nbackground = \"transparent\"\n# On the drawings' own canvas: camera = \"drawing\"\n# Without keys the animation is a loop through all poses.\n# loop = true\n# keys = [ { time = 0.0, at = [0.0, 0.0] }, { time = 1.0, at = [1.0, 0.0] } ]\n");
    text
}

fn toml_key(name: &str) -> String {
    let bare = !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    if bare {
        name.to_owned()
    } else {
        toml::Value::String(name.to_owned()).to_string()
    }
}
