//! From the written scene to the validated one.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use toml::{Spanned, Value};

use super::animation::{Animation, Key};
use super::error::{SceneError, SceneProblem};
use super::file::{AnimationTable, LandmarkTable, PoseTable, SceneFile};
use super::settings::{
    Anchor, Background, BlendReference, BlendSettings, Facing, Holes, InputSettings, MeshSettings, PoseSpaceSettings,
    Provider, PseudoPose, Radial, Scene, SceneLandmark, ScenePose, Stretch,
};
use super::source;
use crate::math::Point;
use crate::outline::Ring;

/// The version of the format.
const VERSION: i64 = 1;
/// The largest absolute coordinate of the pose space: beyond it the products of the weights' systems lose all digits.
const LARGEST_PLACE: f64 = 1e6;
/// The largest side of a frame, in pixels.
const LARGEST_FRAME: i64 = 16_384;
/// The highest frame rate.
const HIGHEST_RATE: f64 = 1000.0;
/// The longest animation, in seconds: with the highest rate its frames can still be counted exactly.
const LATEST_TIME: f64 = 1e6;
/// The most whole turns that can be added to a pose.
const MOST_TURNS: i64 = 1000;

impl Scene {
    /// Reads a scene file.
    ///
    /// # Errors
    /// [`SceneError`] with the file and the line.
    pub fn open(file: &Path) -> Result<Self, SceneError> {
        let text = std::fs::read_to_string(file).map_err(|error| SceneError {
            file: file.to_owned(),
            line: None,
            problem: SceneProblem::Unreadable {
                reason: error.to_string(),
            },
        })?;
        Self::parse(&text, file)
    }

    /// Reads the text of a scene file; `file` is its path, which sources are relative to and errors name. No file is
    /// opened.
    ///
    /// # Errors
    /// [`SceneError`] with the file and the line.
    pub fn parse(text: &str, file: &Path) -> Result<Self, SceneError> {
        let reader = Reader {
            text,
            file: file.to_owned(),
        };
        let written: SceneFile = toml::from_str(text).map_err(|error| {
            let at = error.span().map_or(0, |span| span.start);
            reader.fail(at, SceneProblem::Format(error.message().trim_end().replace('\n', "; ")))
        })?;
        reader.scene(written)
    }
}

struct Reader<'a> {
    text: &'a str,
    file: PathBuf,
}

type Checked<T> = Result<T, SceneError>;

impl Reader<'_> {
    fn line(&self, at: usize) -> usize {
        let upto = at.min(self.text.len());
        1 + self.text.as_bytes()[..upto].iter().filter(|b| **b == b'\n').count()
    }

    fn fail(&self, at: usize, problem: SceneProblem) -> SceneError {
        SceneError {
            file: self.file.clone(),
            line: Some(self.line(at)),
            problem,
        }
    }

    fn unsupported<T>(&self, at: usize, what: &str, remedy: &str) -> Checked<T> {
        Err(self.fail(
            at,
            SceneProblem::NotSupported {
                what: what.to_owned(),
                remedy: remedy.to_owned(),
            },
        ))
    }

    fn scene(&self, written: SceneFile) -> Checked<Scene> {
        let version = *written.version.get_ref();
        if version != VERSION {
            return Err(self.fail(written.version.span().start, SceneProblem::Version { found: version }));
        }
        if let Some(layer) = written.layer.first() {
            self.unsupported::<()>(
                layer.span().start,
                "[[layer]]",
                "remove it and give each pose one source",
            )?;
        }
        let poses = self.poses(&written.pose)?;
        let names: Vec<&str> = poses.iter().map(|p| p.name.as_str()).collect();
        let landmarks = self.landmarks(&written.landmark, &names)?;
        let reference = match &written.reference {
            Some(name) => Some(self.pose_index(name, "`reference`", &names)?),
            None => None,
        };
        let input = self.input(&written)?;
        let pose_space = self.pose_space(&written)?;
        let dimension = poses.first().map_or(0, |p| p.at.len());
        let mut pseudo_poses = Vec::new();
        for pseudo in &written.pseudo_pose {
            if pose_space.provider != Provider::Rbf {
                self.unsupported::<()>(
                    pseudo.span().start,
                    "[[pseudo_pose]] with biharmonic weights",
                    "set `provider = \"rbf\"` under [pose_space]",
                )?;
            }
            let table = pseudo.get_ref();
            pseudo_poses.push(PseudoPose {
                from: self.place(&table.from, "`from` of a [[pseudo_pose]]", Some(dimension))?,
                at: self.place(&table.at, "`at` of a [[pseudo_pose]]", Some(dimension))?,
            });
        }
        Ok(Scene {
            file: self.file.clone(),
            reference,
            input,
            mesh: MeshSettings {
                simplify: self.number(
                    &written.mesh.simplify,
                    "[mesh] simplify",
                    MeshSettings::default().simplify,
                    |v| v > 0.0 && v <= 0.5,
                    "above 0 and at most 0.5, a fraction of the diagonal",
                )?,
                edge_length: self.number(
                    &written.mesh.edge_length,
                    "[mesh] edge_length",
                    MeshSettings::default().edge_length,
                    |v| (0.002..=1.0).contains(&v),
                    "between 0.002 and 1, a fraction of the diagonal",
                )?,
            },
            pose_space,
            blend: self.blend(&written, &names, &landmarks)?,
            texture_sharpness: self.number(
                &written.texture.sharpness,
                "[texture] sharpness",
                0.5,
                |v| (0.0..=1.0).contains(&v),
                "between 0 and 1",
            )?,
            animation: self.animation(&written.animation, &poses)?,
            poses,
            pseudo_poses,
            landmarks,
        })
    }

    fn number(
        &self,
        value: &Option<Spanned<f64>>,
        key: &str,
        default: f64,
        allowed: impl Fn(f64) -> bool,
        range: &'static str,
    ) -> Checked<f64> {
        match value {
            None => Ok(default),
            Some(value) if value.get_ref().is_finite() && allowed(*value.get_ref()) => Ok(*value.get_ref()),
            Some(value) => Err(self.fail(
                value.span().start,
                SceneProblem::BadNumber {
                    key: key.to_owned(),
                    value: *value.get_ref(),
                    allowed: range,
                },
            )),
        }
    }

    fn choice<T: Copy + Default>(
        &self,
        value: &Option<Spanned<String>>,
        key: &str,
        choices: &[(&str, T)],
        allowed: &'static str,
    ) -> Checked<T> {
        let Some(value) = value else { return Ok(T::default()) };
        choices
            .iter()
            .find(|(word, _)| word == value.get_ref())
            .map(|(_, choice)| *choice)
            .ok_or_else(|| {
                self.fail(
                    value.span().start,
                    SceneProblem::BadChoice {
                        key: key.to_owned(),
                        value: value.get_ref().clone(),
                        allowed,
                    },
                )
            })
    }

    fn pose_index(&self, name: &Spanned<String>, used_by: &str, names: &[&str]) -> Checked<usize> {
        names
            .iter()
            .position(|n| n == name.get_ref())
            .ok_or_else(|| self.fail(name.span().start, unknown_pose(name.get_ref(), used_by, names)))
    }

    fn place(&self, value: &Spanned<Vec<f64>>, key: &str, dimension: Option<usize>) -> Checked<Vec<f64>> {
        let at = value.span().start;
        let place = value.get_ref();
        if let Some(bad) = place.iter().find(|v| !v.is_finite() || v.abs() > LARGEST_PLACE) {
            return Err(self.fail(
                at,
                SceneProblem::BadNumber {
                    key: key.to_owned(),
                    value: *bad,
                    allowed: "finite and at most a million in size",
                },
            ));
        }
        let expected = dimension.unwrap_or(place.len().max(1));
        if place.len() != expected {
            return Err(self.fail(
                at,
                SceneProblem::Dimension {
                    key: key.to_owned(),
                    found: place.len(),
                    expected,
                },
            ));
        }
        Ok(place.clone())
    }

    fn input(&self, written: &SceneFile) -> Checked<InputSettings> {
        Ok(InputSettings {
            holes: self.choice(
                &written.input.holes,
                "[input] holes",
                &[("keep", Holes::Keep), ("fill", Holes::Fill)],
                "'keep' or 'fill'",
            )?,
            threshold: self.number(
                &written.input.threshold,
                "[input] threshold",
                InputSettings::default().threshold,
                |v| v > 0.0 && v < 1.0,
                "between 0 and 1, ends excluded",
            )?,
        })
    }

    fn pose_space(&self, written: &SceneFile) -> Checked<PoseSpaceSettings> {
        let table = &written.pose_space;
        if let Some(bounded) = table.bounded.as_ref().filter(|b| *b.get_ref()) {
            self.unsupported::<()>(bounded.span().start, "`bounded = true`", "remove it")?;
        }
        if let Some(walls) = table.walls.as_ref().filter(|w| !w.get_ref().is_empty()) {
            self.unsupported::<()>(walls.span().start, "`walls`", "remove them")?;
        }
        Ok(PoseSpaceSettings {
            provider: self.choice(
                &table.provider,
                "[pose_space] provider",
                &[("biharmonic", Provider::Biharmonic), ("rbf", Provider::Rbf)],
                "'biharmonic' or 'rbf'",
            )?,
            radial: self.choice(
                &table.radial,
                "[pose_space] radial",
                &[("b-spline", Radial::BSpline), ("thin-plate", Radial::ThinPlate)],
                "'b-spline' or 'thin-plate'",
            )?,
            epsilon: self.number(
                &table.epsilon,
                "[pose_space] epsilon",
                PoseSpaceSettings::default().epsilon,
                |v| (0.0..=1e6).contains(&v),
                "between 0 and a million",
            )?,
        })
    }

    fn blend(&self, written: &SceneFile, names: &[&str], landmarks: &[SceneLandmark]) -> Checked<BlendSettings> {
        let table = &written.blend;
        if let Some(guard) = &table.guard {
            match guard.get_ref().as_str() {
                "off" => {}
                "repair" => self.unsupported(guard.span().start, "`guard = \"repair\"`", "set it to \"off\"")?,
                other => {
                    return Err(self.fail(
                        guard.span().start,
                        SceneProblem::BadChoice {
                            key: "[blend] guard".to_owned(),
                            value: other.to_owned(),
                            allowed: "'off' or 'repair'",
                        },
                    ));
                }
            }
        }
        let reference = match &table.reference {
            Some(name) if name.get_ref() != "canonical" => {
                BlendReference::Pose(self.pose_index(name, "[blend] reference", names)?)
            }
            _ => BlendReference::Canonical,
        };
        let anchor = match &table.anchor {
            Some(name) if name.get_ref() != "centroid" => {
                let found = landmarks.iter().position(|l| &l.name == name.get_ref());
                Anchor::Landmark(found.ok_or_else(|| {
                    self.fail(
                        name.span().start,
                        SceneProblem::UnknownLandmark {
                            name: name.get_ref().clone(),
                            used_by: "[blend] anchor".to_owned(),
                        },
                    )
                })?)
            }
            _ => Anchor::Centroid,
        };
        Ok(BlendSettings {
            reference,
            stretch: self.choice(
                &table.stretch,
                "[blend] stretch",
                &[
                    ("linear", Stretch::Linear),
                    ("limited", Stretch::Limited),
                    ("log", Stretch::Log),
                ],
                "'linear', 'limited' or 'log'",
            )?,
            anchor,
        })
    }

    fn poses(&self, tables: &[Spanned<PoseTable>]) -> Checked<Vec<ScenePose>> {
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
        let mut poses: Vec<ScenePose> = Vec::new();
        for (index, table) in tables.iter().enumerate() {
            let pose = self.pose(table, index, tables.len(), poses.first().map(|p| p.at.len()))?;
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
        Ok(poses)
    }

    fn pose(
        &self,
        table: &Spanned<PoseTable>,
        index: usize,
        count: usize,
        dimension: Option<usize>,
    ) -> Checked<ScenePose> {
        let written = table.get_ref();
        let name = written.name.get_ref().clone();
        if let Some(of) = &written.deform_of {
            self.unsupported::<()>(of.span().start, "`deform_of`", "give the pose a source")?;
        }
        if let Some(handles) = &written.handles {
            self.unsupported::<()>(handles.span().start, "`handles`", "give the pose a source")?;
        }
        let Some(source) = &written.source else {
            return Err(self.fail(
                written.name.span().start,
                SceneProblem::Format(format!(
                    "pose '{name}' has no source; add `source = \"FILE\"`, an image or SVG beside the scene file"
                )),
            ));
        };
        let path = self.word(source, &format!("pose '{name}': source"))?;
        if let Some(reason) = source::leaves_folder(&path) {
            return Err(self.fail(
                source.span().start,
                SceneProblem::SourceOutside {
                    pose: name,
                    path,
                    reason,
                },
            ));
        }
        let element = match &written.element {
            Some(element) => Some(self.word(element, &format!("pose '{name}': element"))?),
            None => None,
        };
        let at = match &written.at {
            Some(at) => self.place(at, &format!("`at` of pose '{name}'"), dimension)?,
            None => automatic_place(index, count),
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
            source: PathBuf::from(path),
            source_line: self.line(source.span().start),
            element,
            at,
            facing: if written.mirror == Some(true) {
                Facing::Mirrored
            } else {
                Facing::AsDrawn
            },
            turns: turns as i32,
        })
    }

    /// A string, where with layers a table could stand.
    fn word(&self, value: &Spanned<Value>, key: &str) -> Checked<String> {
        match value.get_ref() {
            Value::String(word) => Ok(word.clone()),
            Value::Table(_) => self.unsupported(value.span().start, &format!("{key} per layer"), "give one string"),
            other => Err(self.fail(
                value.span().start,
                SceneProblem::Format(format!("{key} is {other}, but must be a string in quotes")),
            )),
        }
    }

    fn landmarks(&self, tables: &[Spanned<LandmarkTable>], names: &[&str]) -> Checked<Vec<SceneLandmark>> {
        let mut landmarks: Vec<SceneLandmark> = Vec::new();
        for table in tables {
            let written = table.get_ref();
            let start = written.name.span().start;
            let name = written.name.get_ref().clone();
            if name.is_empty() || landmarks.iter().any(|l| l.name == name) {
                return Err(self.fail(start, SceneProblem::BadName { kind: "landmark", name }));
            }
            if let Some(path) = written.path.as_ref().filter(|p| *p.get_ref()) {
                self.unsupported::<()>(path.span().start, "`path = true`", "name single points as landmarks")?;
            }
            let mut at = vec![None; names.len()];
            for (pose, value) in &written.at {
                let place = value.span().start;
                let index = names
                    .iter()
                    .position(|n| n == pose)
                    .ok_or_else(|| self.fail(place, unknown_pose(pose, &format!("landmark '{name}'"), names)))?;
                at[index] = Some(self.point(value, &format!("landmark '{name}' on pose '{pose}'"))?);
            }
            landmarks.push(SceneLandmark {
                name,
                line: self.line(start),
                at,
            });
        }
        Ok(landmarks)
    }

    fn point(&self, value: &Spanned<Value>, key: &str) -> Checked<Point> {
        let start = value.span().start;
        let number = |v: &Value| match v {
            Value::Float(f) => Some(*f),
            Value::Integer(i) => Some(*i as f64),
            _ => None,
        };
        let numbers: Option<Vec<f64>> = value
            .get_ref()
            .as_array()
            .map(Vec::as_slice)
            .unwrap_or_default()
            .iter()
            .map(number)
            .collect();
        let Some([x, y]) = numbers.as_deref() else {
            return Err(self.fail(start, SceneProblem::Format(format!("{key} must be a point [x, y]"))));
        };
        if let Some(bad) = [*x, *y]
            .into_iter()
            .find(|v| !v.is_finite() || v.abs() > Ring::LARGEST_COORDINATE)
        {
            return Err(self.fail(
                start,
                SceneProblem::BadNumber {
                    key: key.to_owned(),
                    value: bad,
                    allowed: "a place on the drawing",
                },
            ));
        }
        Ok(Point::new(*x, *y))
    }

    fn animation(&self, table: &AnimationTable, poses: &[ScenePose]) -> Checked<Animation> {
        let mut animation = match &table.keys {
            Some(keys) if !keys.get_ref().is_empty() => {
                let dimension = poses.first().map_or(0, |p| p.at.len());
                let mut checked: Vec<Key> = Vec::new();
                for (index, key) in keys.get_ref().iter().enumerate() {
                    let start = key.span().start;
                    let written = key.get_ref();
                    if !written.time.is_finite() || written.time.abs() > LATEST_TIME {
                        return Err(self.fail(
                            start,
                            SceneProblem::BadNumber {
                                key: format!("time of animation key {index}"),
                                value: written.time,
                                allowed: "finite and at most a million seconds",
                            },
                        ));
                    }
                    if let Some(before) = checked.last().map(|k| k.time).filter(|before| *before >= written.time) {
                        return Err(self.fail(
                            start,
                            SceneProblem::KeyOrder {
                                index,
                                time: written.time,
                                before,
                            },
                        ));
                    }
                    let at = Spanned::new(key.span(), written.at.clone());
                    checked.push(Key {
                        time: written.time,
                        at: self.place(&at, &format!("`at` of animation key {index}"), Some(dimension))?,
                    });
                }
                Animation::new(checked, table.looped.unwrap_or(false))
            }
            _ => Animation::visiting(poses.iter().map(|p| p.at.as_slice()), table.looped.unwrap_or(true)),
        };
        animation.fps = self.number(
            &table.fps,
            "[animation] fps",
            Animation::DEFAULT_FPS,
            |v| v > 0.0 && v <= HIGHEST_RATE,
            "above 0 and at most 1000",
        )?;
        if let Some(size) = &table.size {
            let (start, sides) = (size.span().start, size.get_ref());
            let bad = |value: i64| {
                self.fail(
                    start,
                    SceneProblem::BadNumber {
                        key: "[animation] size".to_owned(),
                        value: value as f64,
                        allowed: "two whole numbers [columns, rows] between 1 and 16384",
                    },
                )
            };
            let [columns, rows] = sides[..] else {
                return Err(bad(sides.len() as i64));
            };
            for side in [columns, rows] {
                if !(1..=LARGEST_FRAME).contains(&side) {
                    return Err(bad(side));
                }
            }
            animation.size = [columns as u32, rows as u32];
        }
        if let Some(background) = &table.background {
            animation.background = background_colour(background.get_ref()).ok_or_else(|| {
                self.fail(
                    background.span().start,
                    SceneProblem::BadChoice {
                        key: "[animation] background".to_owned(),
                        value: background.get_ref().clone(),
                        allowed: "'transparent', 'white', 'black', '#rrggbb' or '#rrggbbaa'",
                    },
                )
            })?;
        }
        Ok(animation)
    }
}

fn unknown_pose(name: &str, used_by: &str, names: &[&str]) -> SceneProblem {
    SceneProblem::UnknownPose {
        name: name.to_owned(),
        used_by: used_by.to_owned(),
        known: names.iter().map(|n| format!("'{n}'")).collect::<Vec<_>>().join(", "),
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

fn background_colour(word: &str) -> Option<Background> {
    let hex = match word {
        "transparent" => return Some(Background::Transparent),
        "white" => "#ffffff",
        "black" => "#000000",
        other => other,
    }
    .strip_prefix('#')?;
    if !hex.is_ascii() || !matches!(hex.len(), 6 | 8) {
        return None;
    }
    let mut colour = [255; 4];
    for (k, channel) in colour.iter_mut().enumerate().take(hex.len() / 2) {
        *channel = u8::from_str_radix(&hex[2 * k..2 * k + 2], 16).ok()?;
    }
    Some(Background::Colour(colour))
}

#[cfg(test)]
mod tests;
