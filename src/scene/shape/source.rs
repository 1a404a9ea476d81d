//! The files of a shape's scene: inside its folder, whatever the scene says.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::error::ShapeProblem;
use super::settings::{ShapeFile, ShapeScene};
use crate::scene::{SceneError, SceneProblem};

/// The vertices' weights as they are written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WeightsFile {
    joints: Vec<String>,
    weights: Vec<Vec<(usize, f64)>>,
}

impl ShapeScene {
    /// Every file that the scene is read from besides its own, each once, in the order of the scene file.
    ///
    /// # Errors
    /// As [`Self::path_of`].
    pub fn source_files(&self) -> Result<Vec<PathBuf>, SceneError> {
        let examples = self.examples.iter();
        let named = examples.flat_map(|example| std::iter::once(&example.form).chain(&example.texture));
        let mut files: Vec<PathBuf> = Vec::new();
        for file in named.chain(self.skeleton.as_ref().map(|skeleton| &skeleton.weights)) {
            let path = self.path_of(file)?;
            if !files.contains(&path) {
                files.push(path);
            }
        }
        Ok(files)
    }

    /// The path of a file, with every symbolic link resolved.
    ///
    /// # Errors
    /// [`SceneError`] if it does not exist or lies outside the scene's folder.
    pub fn path_of(&self, file: &ShapeFile) -> Result<PathBuf, SceneError> {
        let missing = |reason: std::io::Error| self.missing(file, &reason);
        let folder = match self.file.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        let folder = folder.canonicalize().map_err(missing)?;
        let path = folder.join(&file.path).canonicalize().map_err(missing)?;
        if !path.starts_with(&folder) {
            let problem = ShapeProblem::FileOutside {
                key: file.key.clone(),
                path: file.path.display().to_string(),
                reason: "is a link that leaves the scene's folder",
            };
            return Err(self.failed(file, problem));
        }
        if !path.is_file() {
            return Err(missing(std::io::Error::other("it is not a file")));
        }
        Ok(path)
    }

    /// The bytes of a file.
    ///
    /// # Errors
    /// [`SceneError`] if it cannot be read or lies outside the scene's folder.
    pub fn read(&self, file: &ShapeFile) -> Result<Vec<u8>, SceneError> {
        std::fs::read(self.path_of(file)?).map_err(|reason| self.missing(file, &reason))
    }

    /// What is wrong with the content of a file, as an error that names it and the line that names it.
    #[must_use]
    pub fn unusable(&self, file: &ShapeFile, reason: &str) -> SceneError {
        let problem = ShapeProblem::FileUnusable {
            key: file.key.clone(),
            path: file.path.display().to_string(),
            reason: reason.to_owned(),
        };
        self.failed(file, problem)
    }

    /// The joints that each vertex follows and how much, #vertices lists of joints of the scene with their weights; `None` without a
    /// skeleton. What the weights sum to is not looked at here.
    ///
    /// # Errors
    /// [`SceneError`] if the file cannot be read, is no such file, or names joints that the scene does not have.
    pub fn skin_weights(&self) -> Result<Option<Vec<Vec<(usize, f64)>>>, SceneError> {
        let Some(skeleton) = &self.skeleton else {
            return Ok(None);
        };
        let file = &skeleton.weights;
        let unusable = |reason: String| self.unusable(file, &reason);
        let written: WeightsFile = serde_json::from_slice(&self.read(file)?).map_err(|error| {
            unusable(format!(
                "{error}; write {{\"joints\": [names], \"weights\": [[[joint, weight], ...] for each vertex]}}"
            ))
        })?;
        let joint_of = |name: &String| {
            let joint = skeleton.joints.iter().position(|joint| joint.name == *name);
            joint.ok_or_else(|| {
                unusable(format!(
                    "joint '{name}' is no [[skeleton.joint]] of the scene; add it there"
                ))
            })
        };
        let joints: Vec<usize> = written.joints.iter().map(joint_of).collect::<Result<_, _>>()?;
        let mut weights = Vec::with_capacity(written.weights.len());
        for (vertex, list) in written.weights.iter().enumerate() {
            let follow = |&(index, weight): &(usize, f64)| match joints.get(index) {
                Some(joint) => Ok((*joint, weight)),
                None => Err(unusable(format!(
                    "vertex {vertex} follows joint {index}, but there are {}, counted from 0",
                    joints.len()
                ))),
            };
            weights.push(list.iter().map(follow).collect::<Result<Vec<_>, _>>()?);
        }
        Ok(Some(weights))
    }

    fn missing(&self, file: &ShapeFile, reason: &std::io::Error) -> SceneError {
        let problem = ShapeProblem::FileMissing {
            key: file.key.clone(),
            path: file.path.display().to_string(),
            reason: reason.to_string(),
        };
        self.failed(file, problem)
    }

    fn failed(&self, file: &ShapeFile, problem: ShapeProblem) -> SceneError {
        SceneError {
            file: self.file.clone(),
            line: Some(file.line),
            problem: SceneProblem::Shape(problem),
        }
    }
}
