//! Landmarks: names and places, or lines, on poses.

use std::collections::BTreeMap;

use toml::{Spanned, Value};

use super::{Checked, Reader, unknown_pose};
use crate::math::Point;
use crate::outline::Ring;
use crate::scene::error::SceneProblem;
use crate::scene::file::LandmarkTable;
use crate::scene::settings::{SceneLandmark, ScenePath};

impl Reader<'_> {
    pub(super) fn landmarks(
        &self,
        tables: &[Spanned<LandmarkTable>],
        names: &[&str],
        layers: &[String],
    ) -> Checked<(Vec<SceneLandmark>, Vec<ScenePath>)> {
        let mut landmarks: Vec<SceneLandmark> = Vec::new();
        let mut paths: Vec<ScenePath> = Vec::new();
        for table in tables {
            let written = table.get_ref();
            let start = written.name.span().start;
            let name = written.name.get_ref().clone();
            let is_taken = landmarks.iter().any(|l| l.name == name) || paths.iter().any(|path| path.name == name);
            if name.is_empty() || is_taken {
                return Err(self.fail(start, SceneProblem::BadName { kind: "landmark", name }));
            }
            let line = self.line(start);
            let owner = format!("landmark '{name}'");
            let layer = self.layer_of(start, written.layer.as_ref(), &owner, layers)?;
            if written.path.as_ref().is_some_and(|path| *path.get_ref()) {
                let at = self.on_poses(&written.at, &owner, names, |value, key| self.polyline(value, key))?;
                paths.push(ScenePath { name, line, layer, at });
            } else {
                let point = |value: &Spanned<Value>, key: &str| self.point(value.get_ref(), value.span().start, key);
                let at = self.on_poses(&written.at, &owner, names, point)?;
                landmarks.push(SceneLandmark { name, line, layer, at });
            }
        }
        Ok((landmarks, paths))
    }

    /// The layer that something is on which starts at `start`; `None` in a scene without layers.
    pub(super) fn layer_of(
        &self,
        start: usize,
        written: Option<&Spanned<String>>,
        owner: &str,
        layers: &[String],
    ) -> Checked<Option<usize>> {
        match written {
            Some(layer) => Ok(Some(self.layer_index(layer, owner, layers)?)),
            None if layers.is_empty() => Ok(None),
            None => Err(self.fail(
                start,
                SceneProblem::Format(format!(
                    "{owner} does not say which layer it is on; add `layer = \"{}\"`",
                    layers.join("\"` or `layer = \"")
                )),
            )),
        }
    }

    /// What a landmark or a part says of each pose.
    pub(super) fn on_poses<T: Clone>(
        &self,
        written: &BTreeMap<String, Spanned<Value>>,
        owner: &str,
        names: &[&str],
        read: impl Fn(&Spanned<Value>, &str) -> Checked<T>,
    ) -> Checked<Vec<Option<T>>> {
        let mut at = vec![None; names.len()];
        for (pose, value) in written {
            let place = value.span().start;
            let index = names
                .iter()
                .position(|n| n == pose)
                .ok_or_else(|| self.fail(place, unknown_pose(pose, owner, names)))?;
            at[index] = Some(read(value, &format!("{owner} on pose '{pose}'"))?);
        }
        Ok(at)
    }

    /// A line of two points or more; repeated points are merged.
    pub(super) fn polyline(&self, value: &Spanned<Value>, key: &str) -> Checked<Vec<Point>> {
        let start = value.span().start;
        let mut points: Vec<Point> = Vec::new();
        for (k, point) in value
            .get_ref()
            .as_array()
            .map(Vec::as_slice)
            .unwrap_or_default()
            .iter()
            .enumerate()
        {
            let point = self.point(point, start, &format!("point {k} of {key}"))?;
            if points.last() != Some(&point) {
                points.push(point);
            }
        }
        if points.len() < 2 {
            let problem = format!("{key} must be a line of at least two different points, [[x, y], [x, y], ...]");
            return Err(self.fail(start, SceneProblem::Format(problem)));
        }
        Ok(points)
    }

    pub(super) fn point(&self, value: &Value, start: usize, key: &str) -> Checked<Point> {
        let number = |v: &Value| match v {
            Value::Float(f) => Some(*f),
            Value::Integer(i) => Some(*i as f64),
            _ => None,
        };
        let numbers: Option<Vec<f64>> = value
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
