//! Where a scene's drawings lie: inside its folder, whatever the scene says.

use std::path::{Component, Path, PathBuf};

use super::error::{SceneError, SceneProblem};
use super::settings::Scene;

/// Why a source as written leaves the scene's folder; `None` if it does not.
pub(super) fn leaves_folder(source: &str) -> Option<&'static str> {
    if source.is_empty() {
        return Some("is empty");
    }
    // A backslash or a drive letter is a separator on one system and a letter on another: refused on both.
    if source.contains('\\') || source.as_bytes().get(1) == Some(&b':') {
        return Some("is written with a drive or backslashes");
    }
    for component in Path::new(source).components() {
        match component {
            Component::Normal(_) | Component::CurDir => {}
            Component::ParentDir => return Some("goes up with '..'"),
            Component::RootDir | Component::Prefix(_) => return Some("is an absolute path"),
        }
    }
    None
}

impl Scene {
    /// Every file that the scene is read from besides its own, each once, in an order that depends on the scene file alone.
    ///
    /// # Errors
    /// As [`Self::source_path`].
    pub fn source_files(&self) -> Result<Vec<PathBuf>, SceneError> {
        let mut files: Vec<PathBuf> = Vec::new();
        for scene in std::iter::once(self).chain(self.layers.iter().map(|layer| &layer.scene)) {
            for pose in scene.drawn_poses() {
                let file = scene.source_path(pose)?;
                if !files.contains(&file) {
                    files.push(file);
                }
            }
        }
        Ok(files)
    }

    /// The refusal of a pose without a drawing, which no validated scene has.
    pub(super) fn without_drawing(&self, pose: usize) -> SceneError {
        SceneError {
            file: self.file.clone(),
            line: None,
            problem: SceneProblem::Format(format!("pose '{}' has no drawing", self.poses[pose].name)),
        }
    }

    /// The path of the drawing that pose `index` shows, with every symbolic link resolved.
    ///
    /// # Errors
    /// [`SceneError`] if it does not exist or lies outside the scene's folder.
    pub fn source_path(&self, index: usize) -> Result<PathBuf, SceneError> {
        let pose = &self.poses[index];
        let Some((_, drawing)) = self.drawing_of(index) else {
            return Err(self.without_drawing(index));
        };
        let written = drawing.file.display().to_string();
        let failed = |problem| SceneError {
            file: self.file.clone(),
            line: Some(drawing.line),
            problem,
        };
        let missing = |reason: std::io::Error| {
            failed(SceneProblem::SourceMissing {
                pose: pose.name.clone(),
                path: written.clone(),
                reason: reason.to_string(),
            })
        };
        let folder = match self.file.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        let folder = folder.canonicalize().map_err(missing)?;
        let path = folder.join(&drawing.file).canonicalize().map_err(missing)?;
        if !path.starts_with(&folder) {
            return Err(failed(SceneProblem::SourceOutside {
                pose: pose.name.clone(),
                path: written,
                reason: "is a link that leaves the scene's folder",
            }));
        }
        if !path.is_file() {
            return Err(missing(std::io::Error::other("it is not a file")));
        }
        Ok(path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_paths_below_the_folder_stay() {
        for inside in ["a.png", "poses/a.png", "./a.png"] {
            assert_eq!(leaves_folder(inside), None, "{inside}");
        }
        for outside in [
            "",
            "../a.png",
            "poses/../../a.png",
            "/etc/passwd",
            "C:/a.png",
            "..\\a.png",
        ] {
            assert!(leaves_folder(outside).is_some(), "{outside}");
        }
    }
}
