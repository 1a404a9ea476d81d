//! Poses: names, sources, places.

use std::f64::consts::TAU;
use std::path::PathBuf;

use toml::{Spanned, Value};

use super::{Checked, Reader, WrittenReading};
use crate::input::Extent;
use crate::pipeline::Facing;
use crate::scene::error::SceneProblem;
use crate::scene::file::PoseTable;
use crate::scene::settings::{DrawnSource, PoseSource, ReadingSettings, ScenePose};
use crate::scene::source;

/// The most whole turns that can be added to a pose.
const MOST_TURNS: i64 = 1000;

impl Reader<'_> {
    pub(super) fn poses(
        &self,
        tables: &[Spanned<PoseTable>],
        layers: &[String],
        reading: &ReadingSettings,
    ) -> Checked<Vec<ScenePose>> {
        if tables.is_empty() {
            return Err(self.fail(self.text.len(), SceneProblem::NoPose));
        }
        let placed = tables.iter().position(|t| t.get_ref().at.is_some());
        let unplaced = tables.iter().position(|t| t.get_ref().at.is_none());
        if let (Some(with), Some(without)) = (placed, unplaced) {
            return Err(self.fail(
                tables[without].get_ref().name.span().start,
                SceneProblem::HalfPlaced {
                    with: tables[with].get_ref().name.get_ref().clone(),
                    without: tables[without].get_ref().name.get_ref().clone(),
                },
            ));
        }
        let names: Vec<String> = tables.iter().map(|t| t.get_ref().name.get_ref().clone()).collect();
        let mut poses: Vec<ScenePose> = Vec::new();
        for (index, table) in tables.iter().enumerate() {
            let pose = self.pose(table, index, &names, layers, poses.first().map(|p| p.at.len()), reading)?;
            let at = table.get_ref().name.span().start;
            if pose.name.is_empty() || poses.iter().any(|p| p.name == pose.name) {
                return Err(self.fail(
                    at,
                    SceneProblem::BadName {
                        kind: "pose",
                        name: pose.name,
                    },
                ));
            }
            if let Some(other) = poses.iter().find(|p| p.at == pose.at) {
                return Err(self.fail(
                    at,
                    SceneProblem::SamePlace {
                        first: other.name.clone(),
                        second: pose.name,
                        place: format!("{:?}", pose.at),
                    },
                ));
            }
            poses.push(pose);
        }
        self.check_copies(tables, &poses)?;
        Ok(poses)
    }

    fn pose(
        &self,
        table: &Spanned<PoseTable>,
        index: usize,
        names: &[String],
        layers: &[String],
        dimension: Option<usize>,
        reading: &ReadingSettings,
    ) -> Checked<ScenePose> {
        let written = table.get_ref();
        let name = written.name.get_ref().clone();
        let source = match &written.deform_of {
            _ if !layers.is_empty() => PoseSource::Layered,
            Some(of) => PoseSource::Deformed(self.deformed(written, of, names)?),
            None => PoseSource::Drawn(self.drawn(written, reading)?),
        };
        let at = match &written.at {
            Some(at) => self.place(at, &format!("`at` of pose '{name}'"), dimension)?,
            None => automatic_place(index, names.len()),
        };
        let turns = written.turns.as_ref().map_or(0, |t| *t.get_ref());
        if turns.abs() > MOST_TURNS {
            return Err(self.fail(
                written.turns.as_ref().map_or(0, |t| t.span().start),
                SceneProblem::BadNumber {
                    key: format!("`turns` of pose '{name}'"),
                    value: turns as f64,
                    allowed: "a whole number between -1000 and 1000",
                },
            ));
        }
        Ok(ScenePose {
            name,
            source,
            at,
            turns: turns as i32,
            draw_order: Vec::new(),
        })
    }

    /// How the drawing of a pose is read, if it is not as `usual`.
    pub(super) fn reading_of(&self, written: &PoseTable, usual: &ReadingSettings) -> Checked<ReadingSettings> {
        let keys = WrittenReading {
            figure: &written.figure,
            gap: &written.gap,
            paper: &written.paper,
            threshold: &written.threshold,
        };
        self.reading(&keys, &format!("pose '{}':", written.name.get_ref()), usual)
    }

    fn drawn(&self, written: &PoseTable, reading: &ReadingSettings) -> Checked<DrawnSource> {
        let name = written.name.get_ref();
        if let Some(handles) = &written.handles {
            return Err(self.fail(
                handles.span().start,
                SceneProblem::Format(format!(
                    "pose '{name}' has handles but no `deform_of`; name the pose that they deform, or remove them"
                )),
            ));
        }
        let Some(source) = &written.source else {
            return Err(self.fail(
                written.name.span().start,
                SceneProblem::Format(format!(
                    "pose '{name}' has no source; add `source = \"FILE\"`, an image or SVG beside the scene file, or `deform_of` and handles"
                )),
            ));
        };
        let path = self.word(source, &format!("pose '{name}': source"))?;
        let element = match &written.element {
            Some(element) => Some(self.word(element, &format!("pose '{name}': element"))?),
            None => None,
        };
        Ok(DrawnSource {
            file: self.inside_folder(path, name, source.span().start)?,
            line: self.line(source.span().start),
            element,
            extent: Extent::Everything,
            reading: self.reading_of(written, reading)?,
            facing: if written.mirror == Some(true) {
                Facing::Mirrored
            } else {
                Facing::AsDrawn
            },
        })
    }

    /// A source as a path that stays in the scene's folder.
    pub(super) fn inside_folder(&self, path: String, pose: &str, at: usize) -> Checked<PathBuf> {
        match source::leaves_folder(&path) {
            None => Ok(PathBuf::from(path)),
            Some(reason) => Err(self.fail(
                at,
                SceneProblem::SourceOutside {
                    pose: pose.to_owned(),
                    path,
                    reason,
                },
            )),
        }
    }

    /// A string, where with layers a table could stand.
    fn word(&self, value: &Spanned<Value>, key: &str) -> Checked<String> {
        match value.get_ref() {
            Value::String(word) => Ok(word.clone()),
            Value::Table(_) => Err(self.fail(
                value.span().start,
                SceneProblem::Format(format!(
                    "{key} is a table with one a layer, but the scene has no [[layer]]; give one string, or list the layers"
                )),
            )),
            other => Err(self.fail(
                value.span().start,
                SceneProblem::Format(format!("{key} is {other}, but must be a string in quotes")),
            )),
        }
    }
}

/// Evenly on the unit circle, from (1, 0); a single pose at the origin.
fn automatic_place(index: usize, count: usize) -> Vec<f64> {
    if count == 1 {
        return vec![0.0, 0.0];
    }
    let angle_rad = TAU * index as f64 / count as f64;
    // Rounded, so that the four corners of a square lie exactly on the axes.
    let tidy = |v: f64| (v * 1e12).round() / 1e12;
    vec![tidy(angle_rad.cos()), tidy(angle_rad.sin())]
}
