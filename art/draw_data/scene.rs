//! The scene file beside the drawings.

use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;

use kurbo::Point;

use crate::svg::rounded;

/// One drawing and its place.
#[derive(Debug)]
pub(crate) struct Pose {
    pub(crate) name: &'static str,
    pub(crate) file: String,
    /// Place in pose space.
    pub(crate) at: [f64; 2],
    /// Points of the drawing that are known, on its outline or inside it; the same names in every pose.
    pub(crate) landmarks: Vec<(String, Point)>,
}

/// A pose that is another one deformed.
#[derive(Debug)]
pub(crate) struct Copy {
    pub(crate) name: &'static str,
    /// The pose that is deformed.
    pub(crate) of: &'static str,
    /// Place in pose space.
    pub(crate) at: [f64; 2],
    /// From where to where its handles are moved.
    pub(crate) handles: Vec<(Point, Point)>,
}

/// What a scene file says.
#[derive(Debug)]
pub(crate) struct Scene {
    /// The SVG element whose outline is meant.
    pub(crate) element: Option<&'static str>,
    /// The poses; the first is the reference.
    pub(crate) poses: Vec<Pose>,
    /// Those of the known points that the scene has as landmarks.
    pub(crate) landmarks: &'static [&'static str],
    /// The `[mesh]` section as it stands in the file; empty for the default settings.
    pub(crate) mesh: &'static str,
    /// How sharply the texture follows the nearest pose.
    pub(crate) sharpness: f64,
    /// Size of the animation, pixels.
    pub(crate) size_px: [u32; 2],
    /// The animation's keys as they stand in the file.
    pub(crate) keys: &'static str,
}

/// Writes `scene.toml` into `folder`, and beside it `truth.toml` with all points that are known.
pub(crate) fn save(folder: &Path, scene: &Scene) -> Result<(), Box<dyn Error>> {
    save_with_copies(folder, scene, &[])
}

/// As [`save`], with poses that are deformed copies.
pub(crate) fn save_with_copies(folder: &Path, scene: &Scene, copies: &[Copy]) -> Result<(), Box<dyn Error>> {
    let mut text = String::from("version = 1\n");
    let reference = scene.poses.first().ok_or("a scene needs a pose")?;
    writeln!(text, "reference = \"{}\"", reference.name)?;
    if !scene.mesh.is_empty() {
        write!(text, "\n[mesh]\n{}", scene.mesh)?;
    }
    write!(text, "\n[texture]\nsharpness = {:.1}\n", scene.sharpness)?;
    for pose in &scene.poses {
        write!(
            text,
            "\n[[pose]]\nname = \"{}\"\nsource = \"{}\"\n",
            pose.name, pose.file
        )?;
        if let Some(element) = scene.element {
            writeln!(text, "element = \"{element}\"")?;
        }
        writeln!(text, "at = [{:.1}, {:.1}]", pose.at[0], pose.at[1])?;
    }
    for copy in copies {
        write!(
            text,
            "\n[[pose]]\nname = \"{}\"\ndeform_of = \"{}\"\nat = [{:.1}, {:.1}]\nhandles = [\n",
            copy.name, copy.of, copy.at[0], copy.at[1]
        )?;
        for (from, to) in &copy.handles {
            let [a, b, c, d] = [from.x, from.y, to.x, to.y].map(decimal);
            writeln!(text, "  {{ from = [{a}, {b}], to = [{c}, {d}] }},")?;
        }
        writeln!(text, "]")?;
    }
    let mut truth = String::from(TRUTH);
    for (k, (name, _)) in reference.landmarks.iter().enumerate() {
        let places: Vec<String> = scene
            .poses
            .iter()
            .map(|pose| {
                let point = pose.landmarks[k].1;
                format!("{} = [{}, {}]", pose.name, decimal(point.x), decimal(point.y))
            })
            .collect();
        let known = format!("\n[[landmark]]\nname = \"{name}\"\nat = {{ {} }}\n", places.join(", "));
        truth.push_str(&known);
        if scene.landmarks.contains(&name.as_str()) {
            text.push_str(&known);
        }
    }
    std::fs::write(folder.join("truth.toml"), truth)?;
    text.push_str(&animation(scene.size_px, scene.keys));
    std::fs::write(folder.join("scene.toml"), text)?;
    Ok(())
}

/// The head of a file of known points.
pub(crate) const TRUTH: &str = "\
# Where the same points are on every drawing, as known from the skeleton that it was drawn from. The scene does not read this: it is the
# truth that the matching is measured by.
";

/// The `[animation]` section.
pub(crate) fn animation([width, height]: [u32; 2], keys: &str) -> String {
    format!("\n[animation]\nfps = 24\nloop = true\nsize = [{width}, {height}]\nbackground = \"white\"\n{keys}")
}

/// Hundredths, with a decimal point even where there is nothing behind it.
pub(crate) fn decimal(value: f64) -> String {
    format!("{:?}", rounded(value))
}
