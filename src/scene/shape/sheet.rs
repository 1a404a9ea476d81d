//! The contact sheet: its axes, what is fixed, from where it is looked at.

use toml::Spanned;

use super::error::ShapeProblem;
use super::file::SheetTable;
use super::settings::{AxisSettings, ShapeExample, SheetSettings};
use crate::scene::SceneProblem;
use crate::scene::convert::{Checked, Reader};

/// How many forms stand along a side unless the scene says.
const FORMS_A_SIDE: usize = 5;
/// The most forms along a side.
const MOST_FORMS: i64 = 50;
const FORMS_ALLOWED: &str = "a whole number from 1 to 50";
/// The view unless the scene says, in degrees.
const YAW: f64 = 20.0;
const PITCH: f64 = 15.0;

impl Reader<'_> {
    pub(super) fn sheet(
        &self,
        table: &SheetTable,
        adjectives: &[String],
        examples: &[ShapeExample],
    ) -> Checked<SheetSettings> {
        let given_up = match &table.up {
            Some(up) => Some(self.adjective(&up.adjective, "[sheet] up", adjectives)?),
            None => None,
        };
        let across_adjective = match &table.across {
            Some(across) => self.adjective(&across.adjective, "[sheet] across", adjectives)?,
            // The first that the other side leaves.
            None => usize::from(given_up == Some(0) && adjectives.len() > 1),
        };
        let up_adjective = given_up.or_else(|| (0..adjectives.len()).find(|&k| k != across_adjective));
        if up_adjective == Some(across_adjective) {
            let at = (table.up.as_ref()).map_or(0, |up| up.adjective.span().start);
            return Err(self.twice(&adjectives[across_adjective], at));
        }
        let across = match &table.across {
            Some(written) => {
                let count = self.forms(&written.columns, "[sheet] across: columns")?;
                let ends = [&written.from, &written.to];
                self.axis(across_adjective, ends, count, "[sheet] across", examples)?
            }
            None => self.axis(across_adjective, [&None, &None], FORMS_A_SIDE, "", examples)?,
        };
        let up = match (&table.up, up_adjective) {
            (_, None) => None,
            (Some(written), Some(adjective)) => {
                let count = self.forms(&written.rows, "[sheet] up: rows")?;
                Some(self.axis(adjective, [&written.from, &written.to], count, "[sheet] up", examples)?)
            }
            (None, Some(adjective)) => Some(self.axis(adjective, [&None, &None], FORMS_A_SIDE, "", examples)?),
        };
        let mut fixed = mean_place(examples, adjectives.len());
        if let Some(written) = &table.fixed {
            self.known_adjectives(written.get_ref(), "[sheet] fixed", adjectives)?;
            for (k, name) in adjectives.iter().enumerate() {
                let Some(value) = written.get_ref().get(name) else {
                    continue;
                };
                if k == across.adjective || up.is_some_and(|up| k == up.adjective) {
                    return Err(self.twice(name, value.span().start));
                }
                fixed[k] = self.coordinate(value, &format!("'{name}' in [sheet] fixed"))?;
            }
        }
        let angle = |value: &Option<Spanned<f64>>, key: &str, default: f64| {
            self.number(
                value,
                key,
                default,
                |v| v.abs() <= 360.0,
                "between -360 and 360 degrees",
            )
        };
        Ok(SheetSettings {
            across,
            up,
            fixed,
            yaw_degrees: angle(&table.view.yaw, "[sheet] view: yaw", YAW)?,
            pitch_degrees: angle(&table.view.pitch, "[sheet] view: pitch", PITCH)?,
        })
    }

    fn forms(&self, count: &Option<Spanned<i64>>, key: &str) -> Checked<usize> {
        self.whole_number(count, key, FORMS_A_SIDE, 1..=MOST_FORMS, FORMS_ALLOWED)
    }

    /// An axis from the least to the greatest value of the examples, unless it says otherwise.
    fn axis(
        &self,
        adjective: usize,
        [from, to]: [&Option<Spanned<f64>>; 2],
        count: usize,
        key: &str,
        examples: &[ShapeExample],
    ) -> Checked<AxisSettings> {
        let values = || examples.iter().map(|example| example.at[adjective]);
        let end = |value: &Option<Spanned<f64>>, which: &str, default: f64| match value {
            Some(value) => self.coordinate(value, &format!("{key}: {which}")),
            None => Ok(default),
        };
        let axis = AxisSettings {
            adjective,
            from: end(from, "from", values().fold(f64::INFINITY, f64::min))?,
            to: end(to, "to", values().fold(f64::NEG_INFINITY, f64::max))?,
            count,
        };
        if axis.from != axis.to || count < 2 {
            return Ok(axis);
        }
        // One value needs no more than one form.
        match from.as_ref().or(to.as_ref()) {
            None => Ok(AxisSettings { count: 1, ..axis }),
            Some(value) => Err(self.fail(
                value.span().start,
                SceneProblem::Format(format!(
                    "{key} begins and ends at {}; give it two different values",
                    axis.from
                )),
            )),
        }
    }

    fn twice(&self, name: &str, at: usize) -> crate::scene::SceneError {
        let problem = ShapeProblem::SheetAxis { name: name.to_owned() };
        self.fail(at, problem.into())
    }
}

fn mean_place(examples: &[ShapeExample], dimension: usize) -> Vec<f64> {
    let sum = |k: usize| examples.iter().map(|example| example.at[k]).sum::<f64>();
    (0..dimension).map(|k| sum(k) / examples.len() as f64).collect()
}
