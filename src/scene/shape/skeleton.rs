//! Joints and what turns them.

use toml::Spanned;

use super::error::ShapeProblem;
use super::file::{JointTable, SkeletonTable, TurnTable};
use super::settings::{JointSettings, JointTurn, SkeletonSettings};
use crate::math::Point3;
use crate::scene::SceneProblem;
use crate::scene::convert::{Checked, Reader};

impl Reader<'_> {
    pub(super) fn skeleton(&self, table: &SkeletonTable, adjectives: &[String]) -> Checked<SkeletonSettings> {
        if table.joint.is_empty() {
            return Err(self.fail(
                table.weights.span().start,
                SceneProblem::Format(
                    "the skeleton has no joint; add at least one [[skeleton.joint]] with a name and an origin"
                        .to_owned(),
                ),
            ));
        }
        let mut names: Vec<String> = Vec::new();
        let mut joints = Vec::new();
        for table in &table.joint {
            joints.push(self.joint(table, &names, adjectives)?);
            self.add_name("joint", &table.name, &mut names)?;
        }
        Ok(SkeletonSettings {
            weights: self.file_inside(&table.weights, "weights of the skeleton".to_owned())?,
            joints,
        })
    }

    fn joint(&self, table: &JointTable, before: &[String], adjectives: &[String]) -> Checked<JointSettings> {
        let name = table.name.get_ref().clone();
        let parent = match &table.parent {
            None => None,
            Some(parent) => match before.iter().position(|joint| joint == parent.get_ref()) {
                Some(index) => Some(index),
                None => {
                    let problem = ShapeProblem::UnknownParent {
                        joint: name,
                        parent: parent.get_ref().clone(),
                    };
                    return Err(self.fail(parent.span().start, problem.into()));
                }
            },
        };
        let origin = self.vector(&table.origin, &format!("`origin` of joint '{name}'"), "")?;
        let turns = (table.turns.iter())
            .map(|turn| self.turn(turn, &name, adjectives))
            .collect::<Checked<_>>()?;
        Ok(JointSettings {
            name,
            parent,
            origin,
            turns,
        })
    }

    fn turn(&self, table: &TurnTable, joint: &str, adjectives: &[String]) -> Checked<JointTurn> {
        let key = |what: &str| format!("`{what}` of a turn of joint '{joint}'");
        let axis = self.vector(&table.axis, &key("axis"), " that are not all 0")?;
        // The longest component first: squares of small ones would vanish.
        let scaled = axis / axis.amax();
        if !scaled.norm().is_normal() {
            let problem = ShapeProblem::BadVector {
                key: key("axis"),
                extra: " that are not all 0",
            };
            return Err(self.fail(table.axis.span().start, problem.into()));
        }
        Ok(JointTurn {
            adjective: self.adjective(&table.adjective, &key("adjective"), adjectives)?,
            axis: scaled.normalize(),
            degrees: self.coordinate(&table.degrees, &key("degrees"))?,
            offset_degrees: match &table.offset {
                Some(offset) => self.coordinate(offset, &key("offset"))?,
                None => 0.0,
            },
        })
    }

    fn vector(&self, value: &Spanned<Vec<f64>>, key: &str, extra: &'static str) -> Checked<Point3> {
        match value.get_ref()[..] {
            [x, y, z] if [x, y, z].iter().all(|v| v.is_finite()) => Ok(Point3::new(x, y, z)),
            _ => {
                let key = key.to_owned();
                Err(self.fail(value.span().start, ShapeProblem::BadVector { key, extra }.into()))
            }
        }
    }
}
