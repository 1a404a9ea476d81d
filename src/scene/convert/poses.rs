//! Poses: names, sources, places.

use std::f64::consts::TAU;
use std::path::PathBuf;

use toml::{Spanned, Value};

use super::{Checked, Reader, WrittenReading};
use crate::input::{Extent, PartOptions, PartRule, PictureChoice, PlaceRule};
use crate::math::Point;
use crate::pipeline::Facing;
use crate::scene::error::SceneProblem;
use crate::scene::file::PoseTable;
use crate::scene::settings::{DrawnSource, InputSettings, PoseSource, ReadingSettings, ScenePose};
use crate::scene::source;

/// The most whole turns that can be added to a pose.
const MOST_TURNS: i64 = 1000;

impl Reader<'_> {
    pub(super) fn poses(
        &self,
        tables: &[Spanned<PoseTable>],
        layers: &[String],
        input: &InputSettings,
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
            let pose = self.pose(table, index, &names, layers, poses.first().map(|p| p.at.len()), input)?;
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
        input: &InputSettings,
    ) -> Checked<ScenePose> {
        let written = table.get_ref();
        let name = written.name.get_ref().clone();
        let source = match &written.deform_of {
            _ if !layers.is_empty() => PoseSource::Layered,
            Some(of) => PoseSource::Deformed(self.deformed(written, of, names)?),
            None => PoseSource::Drawn(self.drawn(written, input)?),
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
            limb_order: self.limb_order(written, layers)?,
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

    /// Which loose parts belong to the drawing of a pose, or to its drawings of several layers.
    pub(super) fn parts_of(&self, written: &PoseTable, rule: PartRule, of: PlaceRule) -> Checked<PartOptions> {
        let name = written.name.get_ref();
        let places = |list: &Option<Spanned<Vec<Value>>>, key: &str| -> Checked<Vec<Point>> {
            let Some(list) = list else { return Ok(Vec::new()) };
            let (start, what) = (list.span().start, format!("each place of `{key}` of pose '{name}'"));
            let places = list.get_ref().iter();
            places.map(|place| self.point(place, start, &what)).collect()
        };
        Ok(PartOptions {
            rule,
            keep: places(&written.keep, "keep")?,
            drop: places(&written.drop, "drop")?,
            places: of,
        })
    }

    /// Which picture of its file the drawing of a pose is.
    pub(super) fn picture_of(&self, written: &PoseTable, input: &InputSettings) -> Checked<PictureChoice> {
        let name = written.name.get_ref();
        match (&written.frame, &written.cell) {
            (None, None) => Ok(PictureChoice::Only),
            (Some(_), Some(cell)) => Err(self.fail(
                cell.span().start,
                SceneProblem::Format(format!(
                    "pose '{name}' has `frame` and `cell`; a drawing is a frame of an animated file or a cell of a sheet, so remove one"
                )),
            )),
            (Some(frame), None) => match usize::try_from(*frame.get_ref()) {
                Ok(frame) => Ok(PictureChoice::Frame(frame)),
                Err(_) => Err(self.fail(
                    frame.span().start,
                    SceneProblem::BadNumber {
                        key: format!("`frame` of pose '{name}'"),
                        value: *frame.get_ref() as f64,
                        allowed: "a whole number, counted from 0",
                    },
                )),
            },
            (None, Some(cell)) => match input.cells {
                Some(of) => Ok(PictureChoice::Cell {
                    at: self.whole_pair(cell, &format!("`cell` of pose '{name}'"), 0)?,
                    of,
                }),
                None => Err(self.fail(
                    cell.span().start,
                    SceneProblem::Format(format!(
                        "pose '{name}' has `cell`, but nothing says how the sheet is divided; add `cells = [COLUMNS, ROWS]` under [input]"
                    )),
                )),
            },
        }
    }

    fn drawn(&self, written: &PoseTable, input: &InputSettings) -> Checked<DrawnSource> {
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
            reading: self.reading_of(written, &input.reading)?,
            parts: self.parts_of(written, input.parts, PlaceRule::OwnDrawing)?,
            picture: self.picture_of(written, input)?,
            facing: self.facing_of(written)?,
        })
    }

    /// Whether a pose's drawing is reflected.
    pub(super) fn facing_of(&self, written: &PoseTable) -> Checked<Facing> {
        let Some(mirror) = &written.mirror else {
            return Ok(Facing::AsDrawn);
        };
        match mirror.get_ref() {
            Value::Boolean(false) => Ok(Facing::AsDrawn),
            Value::Boolean(true) => Ok(Facing::Mirrored),
            Value::String(word) if word == "auto" => Ok(Facing::Auto),
            other => Err(self.fail(
                mirror.span().start,
                SceneProblem::BadChoice {
                    key: format!("pose '{}': mirror", written.name.get_ref()),
                    value: other.as_str().map_or_else(|| other.to_string(), str::to_owned),
                    allowed: "true, false or 'auto'",
                },
            )),
        }
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
