//! From the written scene to the validated one.

mod blending;
mod deformed;
mod landmarks;
mod layered;
mod limbs;
mod playing;
mod poses;

use std::path::{Path, PathBuf};

use toml::Spanned;

use super::error::{SceneError, SceneProblem};
use super::file::SceneFile;
use super::settings::{FrameSize, Holes, InputSettings, Layout, PoseSpaceSettings, Provider, ReadingSettings, Scene};
use crate::input::{FigureRule, PaperRule, PartRule};
use crate::pipeline::OverlapSearch;
use crate::pipeline::{ArtChoice, CameraRule, MeshOptions, Register};
use crate::render::{ColourBlend, Sampling};
use crate::weights::{PseudoPose, Radial, Range};

/// The version of the format.
const VERSION: i64 = 1;
/// The largest absolute coordinate of the pose space: beyond it the products of the weights' systems lose all digits.
pub(super) const LARGEST_PLACE: f64 = 1e6;

impl Scene {
    /// Reads a scene file.
    ///
    /// # Errors
    /// [`SceneError`] with the file and the line.
    pub fn open(file: &Path) -> Result<Self, SceneError> {
        Self::parse(&text_of(file)?, file)
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
        reader.scene(reader.written()?)
    }
}

/// The text of a scene file.
pub(super) fn text_of(file: &Path) -> Checked<String> {
    std::fs::read_to_string(file).map_err(|error| SceneError {
        file: file.to_owned(),
        line: None,
        problem: SceneProblem::Unreadable {
            reason: error.to_string(),
        },
    })
}

/// The keys that say how a drawing is read, under `[input]` or of one pose.
pub(super) struct WrittenReading<'a> {
    pub(super) figure: &'a Option<Spanned<String>>,
    pub(super) gap: &'a Option<Spanned<f64>>,
    pub(super) paper: &'a Option<Spanned<String>>,
    pub(super) threshold: &'a Option<Spanned<f64>>,
}

/// A scene file's text, and what to say when something in it is wrong.
pub(super) struct Reader<'a> {
    pub(super) text: &'a str,
    pub(super) file: PathBuf,
}

pub(super) type Checked<T> = Result<T, SceneError>;

impl Reader<'_> {
    /// What stands in the file, names and types of keys checked.
    pub(super) fn written<T: serde::de::DeserializeOwned>(&self) -> Checked<T> {
        toml::from_str(self.text).map_err(|error| {
            let at = error.span().map_or(0, |span| span.start);
            self.fail(at, SceneProblem::Format(error.message().trim_end().replace('\n', "; ")))
        })
    }

    /// Refuses another version of the format.
    pub(super) fn check_version(&self, version: &Spanned<i64>) -> Checked<()> {
        match *version.get_ref() {
            VERSION => Ok(()),
            found => Err(self.fail(version.span().start, SceneProblem::Version { found })),
        }
    }

    pub(super) fn line(&self, at: usize) -> usize {
        let upto = at.min(self.text.len());
        1 + self.text.as_bytes()[..upto].iter().filter(|b| **b == b'\n').count()
    }

    pub(super) fn fail(&self, at: usize, problem: SceneProblem) -> SceneError {
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
        self.check_version(&written.version)?;
        let layer_names = self.layer_names(&written.layer)?;
        let input = self.input(&written)?;
        let poses = self.poses(&written.pose, &layer_names, &input)?;
        let names: Vec<&str> = poses.iter().map(|p| p.name.as_str()).collect();
        self.check_drawn(written.reference.as_ref(), &written.landmark, &written.pose)?;
        let (landmarks, paths) = self.landmarks(&written.landmark, &names, &layer_names)?;
        let limbs = self.limbs(&written.part, &names, &layer_names)?;
        let reference = match &written.reference {
            Some(name) => Some(self.pose_index(name, "`reference`", &names)?),
            None => None,
        };
        let pose_space = self.pose_space(&written)?;
        let dimension = poses.first().map_or(0, |p| p.at.len());
        // All poses have a place or none.
        let is_placed = written.pose.iter().all(|pose| pose.get_ref().at.is_some());
        let mut pseudo_poses = Vec::new();
        for pseudo in &written.pseudo_pose {
            let table = pseudo.get_ref();
            pseudo_poses.push(PseudoPose {
                from: self.place(&table.from, "`from` of a [[pseudo_pose]]", Some(dimension))?,
                at: self.place(&table.at, "`at` of a [[pseudo_pose]]", Some(dimension))?,
            });
        }
        let mut scene = Scene {
            file: self.file.clone(),
            reference,
            input,
            mesh: self.mesh(&written)?,
            layout: if is_placed { Layout::Given } else { Layout::Automatic },
            pose_space,
            blend: self.blend(&written, &names, &landmarks)?,
            texture_sharpness: self.number(
                &written.texture.sharpness,
                "[texture] sharpness",
                0.5,
                |v| (0.0..=1.0).contains(&v),
                "between 0 and 1",
            )?,
            colour_blend: self.choice(
                &written.texture.blending,
                "[texture] blending",
                &[("plain", ColourBlend::Plain), ("linear", ColourBlend::Linear)],
                "'plain' or 'linear'",
            )?,
            art: self.choice(
                &written.texture.drawing,
                "[texture] drawing",
                &[("curves", ArtChoice::Curves), ("pixels", ArtChoice::Pixels)],
                "'curves' or 'pixels'",
            )?,
            sampling: self.choice(
                &written.texture.sampling,
                "[texture] sampling",
                &Sampling::NAMED,
                "'smooth' or 'nearest'",
            )?,
            register: self.choice(
                &written.texture.register,
                "[texture] register",
                &Register::NAMED,
                "'auto' or 'off'",
            )?,
            camera: self.choice(
                &written.animation.camera,
                "[animation] camera",
                &CameraRule::NAMED,
                "'fit' or 'drawing'",
            )?,
            frame_size: match &written.animation.size {
                Some(_) => FrameSize::Given,
                None => FrameSize::Open,
            },
            animation: self.animation(&written.animation, &poses)?,
            poses,
            pseudo_poses,
            landmarks,
            paths,
            limbs,
            layers: Vec::new(),
        };
        self.check_layer_words(&written, &layer_names)?;
        if !layer_names.is_empty() {
            scene.layers = self.layers(&written, &scene, &layer_names)?;
            let orders = self.draw_orders(&written, &scene.layers, &layer_names)?;
            for (pose, order) in scene.poses.iter_mut().zip(orders) {
                pose.draw_order = order;
            }
        }
        Ok(scene)
    }

    pub(super) fn number(
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

    pub(super) fn choice<T: Copy + Default>(
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

    /// Two whole numbers, columns and rows, from `least` on.
    pub(super) fn whole_pair(&self, value: &Spanned<Vec<i64>>, key: &str, least: i64) -> Checked<[usize; 2]> {
        /// More cells than pixels are of no use.
        const MOST: i64 = 16_384;
        let bad = |found: i64| {
            self.fail(
                value.span().start,
                SceneProblem::BadNumber {
                    key: key.to_owned(),
                    value: found as f64,
                    allowed: "two whole numbers [columns, rows]",
                },
            )
        };
        let [columns, rows] = value.get_ref()[..] else {
            return Err(bad(value.get_ref().len() as i64));
        };
        match [columns, rows].into_iter().find(|side| !(least..=MOST).contains(side)) {
            Some(side) => Err(bad(side)),
            None => Ok([columns as usize, rows as usize]),
        }
    }

    fn mesh(&self, written: &SceneFile) -> Checked<MeshOptions> {
        let mut mesh = MeshOptions::default();
        mesh.simplify.tolerance = self.number(
            &written.mesh.simplify,
            "[mesh] simplify",
            mesh.simplify.tolerance,
            |v| v > 0.0 && v <= 0.5,
            "above 0 and at most 0.5, a fraction of the diagonal",
        )?;
        mesh.refine.edge_length = self.number(
            &written.mesh.edge_length,
            "[mesh] edge_length",
            mesh.refine.edge_length,
            |v| (0.002..=1.0).contains(&v),
            "between 0.002 and 1, a fraction of the diagonal",
        )?;
        Ok(mesh)
    }

    fn input(&self, written: &SceneFile) -> Checked<InputSettings> {
        Ok(InputSettings {
            holes: self.choice(
                &written.input.holes,
                "[input] holes",
                &[("match", Holes::Match), ("keep", Holes::Keep), ("fill", Holes::Fill)],
                "'match', 'keep' or 'fill'",
            )?,
            reading: self.reading(
                &WrittenReading {
                    figure: &written.input.figure,
                    gap: &written.input.gap,
                    paper: &written.input.paper,
                    threshold: &written.input.threshold,
                },
                "[input]",
                &ReadingSettings::default(),
            )?,
            parts: self.choice(
                &written.input.parts,
                "[input] parts",
                &PartRule::NAMED,
                "'layers' or 'largest'",
            )?,
            overlaps: self.choice(
                &written.input.overlaps,
                "[input] overlaps",
                &OverlapSearch::NAMED,
                "'auto' or 'refuse'",
            )?,
            cells: match &written.input.cells {
                Some(cells) => Some(self.whole_pair(cells, "[input] cells", 1)?),
                None => None,
            },
        })
    }

    /// How drawings are read, where it is written, else as in `usual`; `owner` is what the keys stand under.
    pub(super) fn reading(
        &self,
        written: &WrittenReading<'_>,
        owner: &str,
        usual: &ReadingSettings,
    ) -> Checked<ReadingSettings> {
        let key = |name: &str| format!("{owner} {name}");
        Ok(ReadingSettings {
            figure: match written.figure {
                Some(_) => self.choice(
                    written.figure,
                    &key("figure"),
                    &FigureRule::NAMED,
                    "'auto', 'alpha', 'background' or 'lines'",
                )?,
                None => usual.figure,
            },
            gap: self.number(
                written.gap,
                &key("gap"),
                usual.gap,
                |v| (0.0..=0.2).contains(&v),
                "between 0 and 0.2, a fraction of the drawing's diagonal",
            )?,
            paper: match written.paper {
                Some(_) => self.choice(written.paper, &key("paper"), &PaperRule::NAMED, "'keep' or 'clear'")?,
                None => usual.paper,
            },
            threshold: self.number(
                written.threshold,
                &key("threshold"),
                usual.threshold,
                |v| v > 0.0 && v < 1.0,
                "between 0 and 1, ends excluded",
            )?,
        })
    }

    fn pose_space(&self, written: &SceneFile) -> Checked<PoseSpaceSettings> {
        let table = &written.pose_space;
        let provider = self.choice(
            &table.provider,
            "[pose_space] provider",
            &Provider::NAMED,
            "'biharmonic' or 'rbf'",
        )?;
        let bounded = table.bounded.as_ref().filter(|bounded| *bounded.get_ref());
        let walls = table.walls.as_ref().filter(|walls| !walls.get_ref().is_empty());
        if provider == Provider::Rbf {
            let remedy = "remove it, or set `provider = \"biharmonic\"`";
            if let Some(bounded) = bounded {
                self.unsupported::<()>(
                    bounded.span().start,
                    "`bounded = true` with `provider = \"rbf\"`",
                    remedy,
                )?;
            }
            if let Some(walls) = walls {
                self.unsupported::<()>(walls.span().start, "`walls` with `provider = \"rbf\"`", remedy)?;
            }
        }
        Ok(PoseSpaceSettings {
            provider,
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
            range: match bounded {
                Some(_) => Range::Unit,
                None => Range::Free,
            },
            walls: match walls {
                Some(walls) => self.walls(walls)?,
                None => Vec::new(),
            },
        })
    }

    fn walls(&self, walls: &Spanned<Vec<Vec<Vec<f64>>>>) -> Checked<Vec<Vec<[f64; 2]>>> {
        let at = walls.span();
        let point = |wall: usize, index: usize, point: &Vec<f64>| {
            let key = format!("point {index} of wall {wall}");
            let place = self.place(&Spanned::new(at.clone(), point.clone()), &key, Some(2))?;
            Ok([place[0], place[1]])
        };
        let wall = |(wall, points): (usize, &Vec<Vec<f64>>)| {
            if points.len() < 2 {
                return Err(self.fail(
                    at.start,
                    SceneProblem::Format(format!(
                        "wall {wall} has {} points, but must have two or more: [ [x, y], [x, y], ... ]",
                        points.len()
                    )),
                ));
            }
            points
                .iter()
                .enumerate()
                .map(|(index, p)| point(wall, index, p))
                .collect()
        };
        walls.get_ref().iter().enumerate().map(wall).collect()
    }
}

fn unknown_pose(name: &str, used_by: &str, names: &[&str]) -> SceneProblem {
    SceneProblem::UnknownPose {
        name: name.to_owned(),
        used_by: used_by.to_owned(),
        known: names.iter().map(|n| format!("'{n}'")).collect::<Vec<_>>().join(", "),
    }
}

#[cfg(test)]
mod tests;
