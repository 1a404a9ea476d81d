//! The text of a new scene file.

use std::fmt::Write as _;

use crate::input::PictureChoice;

/// A drawing for a new scene.
#[derive(Debug, Clone, PartialEq)]
pub struct NewPose {
    /// Its name.
    pub name: String,
    /// Its source, relative to the scene file.
    pub source: String,
    /// Which picture of its source it is.
    pub picture: PictureChoice,
    /// Its place in the pose space; all poses of a scene have one, or none.
    pub at: Option<[f64; 2]>,
}

/// A scene file for `poses`, with the keys an artist is likely to want next as comments.
#[must_use]
pub fn scene_text(poses: &[NewPose]) -> String {
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
    for pose in poses {
        // A TOML value knows its own quoting.
        let quoted = |s: &str| toml::Value::String(s.to_owned()).to_string();
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
        text.push_str(&match pose.at {
            Some([x, y]) => format!("at = [{x:?}, {y:?}]\n"),
            None => "# at = [0.0, 0.0]\n".to_owned(),
        });
    }
    text.push_str(
        "\n# A point that corresponds, where the automatic match errs: source pixels or SVG units, a pose may lack it.\n\
         # [[landmark]]\n# name = \"nose\"\n",
    );
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
