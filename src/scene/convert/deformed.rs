//! Poses that are deformed copies of others: `deform_of` and `handles`.

use toml::Spanned;

use super::{Checked, Reader};
use crate::math::Point;
use crate::outline::Ring;
use crate::pipeline::{DeformedCopy, Facing, HandleMove};
use crate::scene::error::SceneProblem;
use crate::scene::file::{HandleTable, LandmarkTable, PoseTable};
use crate::scene::settings::{DeformedSource, ScenePose};

impl Reader<'_> {
    /// The copy that a pose with `deform_of` is; `names` are those of all poses.
    pub(super) fn deformed(
        &self,
        written: &PoseTable,
        of: &Spanned<String>,
        names: &[String],
    ) -> Checked<DeformedSource> {
        let (name, start) = (written.name.get_ref(), of.span().start);
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let base = self.pose_index(of, &format!("`deform_of` of pose '{name}'"), &names)?;
        let surplus = [
            written.source.as_ref().map(|v| (v.span().start, "source")),
            written.element.as_ref().map(|v| (v.span().start, "element")),
            (self.facing_of(written)? != Facing::AsDrawn).then_some((start, "mirror")),
        ];
        if let Some((at, key)) = surplus.into_iter().flatten().next() {
            return Err(self.fail(
                at,
                SceneProblem::Format(format!(
                    "pose '{name}' is a deformed copy of '{}' and has its drawing, so it cannot have `{key}`; remove `{key}` or `deform_of`",
                    of.get_ref()
                )),
            ));
        }
        let handles = written.handles.as_ref().filter(|handles| !handles.get_ref().is_empty());
        let Some(handles) = handles else {
            return Err(self.fail(
                start,
                SceneProblem::Format(format!(
                    "pose '{name}' has `deform_of` but no handles; add `handles = [ {{ from = [x, y], to = [x, y] }} ]`"
                )),
            ));
        };
        let at = handles.span().start;
        let moves = handles
            .get_ref()
            .iter()
            .enumerate()
            .map(|(k, handle)| self.handle(handle, at, k, name));
        Ok(DeformedSource {
            line: self.line(at),
            copy: DeformedCopy {
                of: base,
                handles: moves.collect::<Checked<_>>()?,
            },
        })
    }

    fn handle(&self, handle: &HandleTable, start: usize, index: usize, pose: &str) -> Checked<HandleMove> {
        let place = |value: &[f64], key: &str| {
            let [x, y] = value else {
                return Err(self.fail(
                    start,
                    SceneProblem::Format(format!(
                        "`{key}` of handle {index} of pose '{pose}' must be a point [x, y]"
                    )),
                ));
            };
            let is_bad = |v: &&f64| !v.is_finite() || v.abs() > Ring::LARGEST_COORDINATE;
            match [*x, *y].iter().find(is_bad) {
                None => Ok(Point::new(*x, *y)),
                Some(bad) => Err(self.fail(
                    start,
                    SceneProblem::BadNumber {
                        key: format!("`{key}` of handle {index} of pose '{pose}'"),
                        value: *bad,
                        allowed: "a place on the drawing",
                    },
                )),
            }
        };
        Ok(HandleMove {
            from: place(&handle.from, "from")?,
            to: place(&handle.to, "to")?,
        })
    }

    /// Refuses copies of one another, and scenes in which nothing is drawn.
    pub(super) fn check_copies(&self, tables: &[Spanned<PoseTable>], poses: &[ScenePose]) -> Checked<()> {
        for (pose, table) in poses.iter().zip(tables) {
            let mut at = table.get_ref();
            let mut passed = 0;
            while let Some(of) = &at.deform_of {
                let Some(next) = poses.iter().position(|pose| &pose.name == of.get_ref()) else {
                    break;
                };
                at = tables[next].get_ref();
                passed += 1;
                if passed > poses.len() {
                    let of = table.get_ref().deform_of.as_ref();
                    return Err(self.fail(
                        of.map_or(0, |of| of.span().start),
                        SceneProblem::Format(format!(
                            "pose '{}' is a deformed copy of itself, by way of `deform_of`; give one of the poses a source",
                            pose.name
                        )),
                    ));
                }
            }
        }
        Ok(())
    }

    /// Refuses what only a drawn pose can be.
    pub(super) fn check_drawn(
        &self,
        reference: Option<&Spanned<String>>,
        landmarks: &[Spanned<LandmarkTable>],
        tables: &[Spanned<PoseTable>],
    ) -> Checked<()> {
        let is_copy = |name: &str| {
            let mut poses = tables.iter().map(Spanned::get_ref);
            poses.any(|pose| pose.name.get_ref() == name && pose.deform_of.is_some())
        };
        if let Some(name) = reference.filter(|name| is_copy(name.get_ref())) {
            return Err(self.fail(
                name.span().start,
                SceneProblem::Format(format!(
                    "`reference` names pose '{}', a deformed copy, which is not matched; name the pose it is a copy of",
                    name.get_ref()
                )),
            ));
        }
        for landmark in landmarks.iter().map(Spanned::get_ref) {
            if let Some((pose, place)) = landmark.at.iter().find(|(pose, _)| is_copy(pose)) {
                return Err(self.fail(
                    place.span().start,
                    SceneProblem::Format(format!(
                        "landmark '{}' names pose '{pose}', a deformed copy, whose landmarks its mesh carries; remove that place, or move a handle there",
                        landmark.name.get_ref()
                    )),
                ));
            }
        }
        Ok(())
    }
}
