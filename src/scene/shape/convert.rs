//! From the written scene of a shape to the validated one.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use toml::Spanned;

use super::error::ShapeProblem;
use super::file::{ExampleTable, PlaceTable, PseudoExampleTable, ShapeSceneFile, SubdivisionTable};
use super::settings::{
    PseudoExample, ShapeExample, ShapeFile, ShapeScene, SubdivisionSettings, Subject, SurfacePoints,
};
use crate::scene::convert::{Checked, LARGEST_PLACE, Reader, text_of};
use crate::scene::source::leaves_folder;
use crate::scene::{SceneError, SceneProblem};
use crate::weights::Radial;

/// The most steps of subdivision: each has four times the triangles of the one before.
const MOST_STEPS: i64 = 5;

impl ShapeScene {
    /// Reads the scene file of a shape.
    ///
    /// # Errors
    /// [`SceneError`] with the file and the line.
    pub fn open(file: &Path) -> Result<Self, SceneError> {
        Self::parse(&text_of(file)?, file)
    }

    /// Reads the text of a scene file; `file` is its path, which other files are relative to and errors name. No file is
    /// opened.
    ///
    /// # Errors
    /// [`SceneError`] with the file and the line.
    pub fn parse(text: &str, file: &Path) -> Result<Self, SceneError> {
        let reader = Reader {
            text,
            file: file.to_owned(),
        };
        reader.shape_scene(&reader.written()?)
    }
}

impl Reader<'_> {
    fn shape_scene(&self, written: &ShapeSceneFile) -> Checked<ShapeScene> {
        self.check_version(&written.version)?;
        let adjectives = self.adjectives(&written.adjectives)?;
        let examples = self.examples(&written.example, &adjectives)?;
        let is_textured = examples.iter().any(|example| example.texture.is_some());
        let mut pseudo_examples = Vec::new();
        for pseudo in &written.pseudo_example {
            pseudo_examples.push(self.pseudo_example(pseudo, &adjectives, is_textured)?);
        }
        let skeleton = match &written.skeleton {
            Some(table) => Some(self.skeleton(table, &adjectives)?),
            None => None,
        };
        let (animation, texture_animation) = self.shape_animation(&written.animation, &adjectives, &examples)?;
        Ok(ShapeScene {
            file: self.file.clone(),
            radial: self.choice(
                &written.radial,
                "radial",
                &[("b-spline", Radial::BSpline), ("thin-plate", Radial::ThinPlate)],
                "'b-spline' or 'thin-plate'",
            )?,
            pseudo_examples,
            skeleton,
            subdivision: self.subdivision(&written.subdivision)?,
            sheet: self.sheet(&written.sheet, &adjectives, &examples)?,
            animation,
            texture_animation,
            adjectives,
            examples,
        })
    }

    fn adjectives(&self, written: &Spanned<Vec<Spanned<String>>>) -> Checked<Vec<String>> {
        let mut adjectives: Vec<String> = Vec::new();
        for name in written.get_ref() {
            self.add_name("adjective", name, &mut adjectives)?;
        }
        if adjectives.is_empty() {
            return Err(self.fail(written.span().start, ShapeProblem::NoAdjective.into()));
        }
        Ok(adjectives)
    }

    /// Adds a name to those there are.
    pub(super) fn add_name(&self, kind: &'static str, name: &Spanned<String>, names: &mut Vec<String>) -> Checked<()> {
        if name.get_ref().is_empty() || names.contains(name.get_ref()) {
            let name_problem = SceneProblem::BadName {
                kind,
                name: name.get_ref().clone(),
            };
            return Err(self.fail(name.span().start, name_problem));
        }
        names.push(name.get_ref().clone());
        Ok(())
    }

    fn examples(&self, tables: &[ExampleTable], adjectives: &[String]) -> Checked<Vec<ShapeExample>> {
        if tables.is_empty() {
            return Err(self.fail(self.text.len(), ShapeProblem::NoExample.into()));
        }
        let mut names = Vec::new();
        let mut examples: Vec<ShapeExample> = Vec::new();
        for table in tables {
            self.add_name("example", &table.name, &mut names)?;
            let example = self.example(table, adjectives)?;
            let same = |first: &ShapeExample, what: &'static str| {
                let problem = ShapeProblem::SamePlace {
                    first: first.name.clone(),
                    second: example.name.clone(),
                    what,
                };
                self.fail(table.name.span().start, problem.into())
            };
            if let Some(other) = examples.iter().find(|other| other.at == example.at) {
                return Err(same(other, "their forms"));
            }
            let both_textured = |other: &&ShapeExample| other.texture.is_some() && example.texture.is_some();
            if let Some(other) = (examples.iter().filter(both_textured)).find(|o| o.texture_at == example.texture_at) {
                return Err(same(other, "their textures"));
            }
            examples.push(example);
        }
        Ok(examples)
    }

    fn example(&self, table: &ExampleTable, adjectives: &[String]) -> Checked<ShapeExample> {
        let name = table.name.get_ref().clone();
        let at = self.named_place(&table.at, &format!("`at` of example '{name}'"), adjectives)?;
        let texture = match &table.texture {
            Some(file) => Some(self.file_inside(file, format!("texture of example '{name}'"))?),
            None => None,
        };
        let texture_at = match &table.texture_at {
            Some(place) => {
                let key = format!("`texture_at` of example '{name}'");
                if texture.is_none() {
                    return Err(self.fail(place.span().start, ShapeProblem::NoTexture { key }.into()));
                }
                self.named_place(place, &key, adjectives)?
            }
            None => at.clone(),
        };
        Ok(ShapeExample {
            form: self.file_inside(&table.form, format!("form of example '{name}'"))?,
            name,
            at,
            texture,
            texture_at,
        })
    }

    fn pseudo_example(
        &self,
        table: &PseudoExampleTable,
        adjectives: &[String],
        is_textured: bool,
    ) -> Checked<PseudoExample> {
        let of = self.choice(
            &table.of,
            "`of` of a [[pseudo_example]]",
            &[
                ("geometry", Subject::Geometry),
                ("texture", Subject::Texture),
                ("both", Subject::Both),
            ],
            "'geometry', 'texture' or 'both'",
        )?;
        if let Some(word) = table.of.as_ref().filter(|_| of.is_texture() && !is_textured) {
            let key = format!("`of = \"{}\"` of a [[pseudo_example]]", word.get_ref());
            return Err(self.fail(word.span().start, ShapeProblem::NoTexture { key }.into()));
        }
        Ok(PseudoExample {
            from: self.named_place(&table.from, "`from` of a [[pseudo_example]]", adjectives)?,
            at: self.named_place(&table.at, "`at` of a [[pseudo_example]]", adjectives)?,
            of,
        })
    }

    fn subdivision(&self, table: &SubdivisionTable) -> Checked<SubdivisionSettings> {
        let steps = self.whole_number(
            &table.steps,
            "[subdivision] steps",
            0,
            0..=MOST_STEPS,
            "a whole number from 0 to 5",
        )?;
        Ok(SubdivisionSettings {
            steps,
            points: match table.limit {
                Some(false) => SurfacePoints::Refined,
                Some(true) | None => SurfacePoints::Limit,
            },
        })
    }

    /// A place by name as coordinates.
    pub(super) fn named_place(&self, table: &PlaceTable, key: &str, adjectives: &[String]) -> Checked<Vec<f64>> {
        self.known_adjectives(table.get_ref(), key, adjectives)?;
        let coordinate = |name: &String| match table.get_ref().get(name) {
            Some(value) => self.coordinate(value, &format!("'{name}' in {key}")),
            None => {
                let problem = ShapeProblem::MissingAdjective {
                    key: key.to_owned(),
                    name: name.clone(),
                };
                Err(self.fail(table.span().start, problem.into()))
            }
        };
        adjectives.iter().map(coordinate).collect()
    }

    /// Refuses names that no adjective has.
    pub(super) fn known_adjectives(
        &self,
        place: &BTreeMap<String, Spanned<f64>>,
        key: &str,
        adjectives: &[String],
    ) -> Checked<()> {
        match place.iter().find(|(name, _)| !adjectives.contains(name)) {
            Some((name, value)) => Err(self.unknown_adjective(name, value.span().start, key, adjectives)),
            None => Ok(()),
        }
    }

    fn unknown_adjective(&self, name: &str, at: usize, key: &str, adjectives: &[String]) -> SceneError {
        let known: Vec<String> = adjectives.iter().map(|name| format!("'{name}'")).collect();
        let problem = ShapeProblem::UnknownAdjective {
            key: key.to_owned(),
            name: name.to_owned(),
            known: known.join(", "),
        };
        self.fail(at, problem.into())
    }

    /// The index of an adjective.
    pub(super) fn adjective(&self, name: &Spanned<String>, key: &str, adjectives: &[String]) -> Checked<usize> {
        let found = adjectives.iter().position(|known| known == name.get_ref());
        found.ok_or_else(|| self.unknown_adjective(name.get_ref(), name.span().start, key, adjectives))
    }

    /// A coordinate of the space.
    pub(super) fn coordinate(&self, value: &Spanned<f64>, key: &str) -> Checked<f64> {
        let number = *value.get_ref();
        if number.is_finite() && number.abs() <= LARGEST_PLACE {
            return Ok(number);
        }
        let problem = SceneProblem::BadNumber {
            key: key.to_owned(),
            value: number,
            allowed: "finite and at most a million in size",
        };
        Err(self.fail(value.span().start, problem))
    }

    /// A whole number in a range.
    pub(super) fn whole_number(
        &self,
        value: &Option<Spanned<i64>>,
        key: &str,
        default: usize,
        range: std::ops::RangeInclusive<i64>,
        allowed: &'static str,
    ) -> Checked<usize> {
        let Some(value) = value else { return Ok(default) };
        let number = *value.get_ref();
        if range.contains(&number) {
            return Ok(number as usize);
        }
        let problem = SceneProblem::BadNumber {
            key: key.to_owned(),
            value: number as f64,
            allowed,
        };
        Err(self.fail(value.span().start, problem))
    }

    /// A file that stays in the scene's folder.
    pub(super) fn file_inside(&self, written: &Spanned<String>, key: String) -> Checked<ShapeFile> {
        let at = written.span().start;
        match leaves_folder(written.get_ref()) {
            None => Ok(ShapeFile {
                path: PathBuf::from(written.get_ref()),
                key,
                line: self.line(at),
            }),
            Some(reason) => {
                let problem = ShapeProblem::FileOutside {
                    key,
                    path: written.get_ref().clone(),
                    reason,
                };
                Err(self.fail(at, problem.into()))
            }
        }
    }
}
