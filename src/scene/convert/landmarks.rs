//! Landmarks: names and places on poses.

use toml::{Spanned, Value};

use super::{Checked, Reader, unknown_pose};
use crate::math::Point;
use crate::outline::Ring;
use crate::scene::error::SceneProblem;
use crate::scene::file::LandmarkTable;
use crate::scene::settings::SceneLandmark;

impl Reader<'_> {
    pub(super) fn landmarks(&self, tables: &[Spanned<LandmarkTable>], names: &[&str]) -> Checked<Vec<SceneLandmark>> {
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
}
