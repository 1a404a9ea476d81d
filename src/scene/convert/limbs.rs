//! Limbs that lie over other parts of the figure: what `[[part]]` and `order` say of them.

use toml::Spanned;

use super::{Checked, Reader};
use crate::pipeline::LimbSpec;
use crate::scene::error::SceneProblem;
use crate::scene::file::{PartTable, PoseTable};
use crate::scene::settings::SceneLimb;

impl Reader<'_> {
    pub(super) fn limbs(
        &self,
        tables: &[Spanned<PartTable>],
        names: &[&str],
        layers: &[String],
    ) -> Checked<Vec<SceneLimb>> {
        let mut limbs: Vec<SceneLimb> = Vec::new();
        for table in tables {
            let written = table.get_ref();
            let start = written.name.span().start;
            let name = written.name.get_ref().clone();
            if name.is_empty() || limbs.iter().any(|limb| limb.name == name) {
                return Err(self.fail(start, SceneProblem::BadName { kind: "part", name }));
            }
            if name == LimbSpec::TRUNK {
                let problem = format!("part '{name}': that is what belongs to no part; give it another name");
                return Err(self.fail(start, SceneProblem::Format(problem)));
            }
            let owner = format!("part '{name}'");
            let layer = self.layer_of(start, written.layer.as_ref(), &owner, layers)?;
            let at = self.on_poses(&written.at, &owner, names, |value, key| {
                self.point(value.get_ref(), value.span().start, key)
            })?;
            let cut = self.on_poses(&written.cut, &format!("the cut of {owner}"), names, |value, key| {
                self.polyline(value, key)
            })?;
            limbs.push(SceneLimb {
                name,
                line: self.line(start),
                layer,
                at,
                cut,
            });
        }
        Ok(limbs)
    }

    /// The limbs of a pose from back to front, in a scene without layers; empty where nothing is said.
    pub(super) fn limb_order(&self, written: &PoseTable, layers: &[String]) -> Checked<Vec<String>> {
        let Some(order) = written.order.as_ref().filter(|_| layers.is_empty()) else {
            return Ok(Vec::new());
        };
        let names: Vec<String> = order.get_ref().iter().map(|name| name.get_ref().clone()).collect();
        let is_repeated = |k: &usize| names[..*k].contains(&names[*k]);
        if names.len() < 2 || (0..names.len()).any(|k| is_repeated(&k)) {
            return Err(self.fail(
                order.span().start,
                SceneProblem::Format(format!(
                    "`order` of pose '{}' names limbs, since the scene has no [[layer]]; it must name two or more, each once, from back to front: those of [[part]], and 'trunk' \
                     for what belongs to none",
                    written.name.get_ref()
                )),
            ));
        }
        Ok(names)
    }
}
