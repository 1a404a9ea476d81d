//! What the artist says of limbs, as the search for them takes it.
//!
//! Limbs of a layer by name -> their numbers in the open drawing, and for every pose what is said of them there.

use super::PipelineError;
use super::drawn::RegistrationGuide;
use super::landmarks::as_used;
use super::spec::{LayerSpec, LimbSpec};
use crate::math::Point;
use crate::registration::{NamedLimb, Said, Seen};

/// Limbs that are not named by the artist are called so, with their number, from 1.
const LIMB: &str = "limb";

/// What is said of the limbs of a layer.
#[derive(Debug, Clone, Default)]
pub(super) struct LimbsSaid {
    /// By limb, its name.
    names: Vec<String>,
    /// By pose.
    said: Vec<Said>,
}

/// The poses other than `template` that the artist says something of limbs of.
pub(super) fn poses_said(layer: &LayerSpec, template: usize) -> Vec<usize> {
    let is_ordered = |pose: usize| layer.limb_orders.get(pose).is_some_and(|order| !order.is_empty());
    let is_said = |pose: &usize| is_ordered(*pose) || layer.limbs.iter().any(|limb| limb.at[*pose].is_some());
    (0..layer.poses.len())
        .filter(|pose| *pose != template)
        .filter(is_said)
        .collect()
}

impl LimbsSaid {
    /// Finds the limbs of the reference, and those that are named among them. `open` are the poses that are known to show all parts apart.
    pub(super) fn new(layer: &LayerSpec, guide: &RegistrationGuide, open: &[usize]) -> Result<Self, PipelineError> {
        let template = guide.reference;
        let named: Vec<NamedLimb> = (layer.limbs.iter())
            .map(|limb| in_template(layer, guide, open, limb))
            .collect::<Result<_, PipelineError>>()?;
        let found = guide.registration.find_limbs(&named);
        let count = (guide.registration.limb_of_parts().into_iter().flatten())
            .max()
            .map_or(0, |last| last + 1);
        let mut said = Self {
            names: (1..=count).map(|number| format!("{LIMB} {number}")).collect(),
            said: vec![Said::default(); layer.poses.len()],
        };
        let mut numbers: Vec<usize> = Vec::new();
        for (limb, found) in layer.limbs.iter().zip(found) {
            let refusal = |problem: String| PipelineError::Limb {
                limb: limb.name.clone(),
                pose: layer.poses[template].name.clone(),
                problem,
            };
            let number = found.map_err(|problem| refusal(problem.to_string()))?;
            if let Some(other) = numbers.iter().position(|other| *other == number) {
                let other = &layer.limbs[other].name;
                return Err(refusal(format!(
                    "it is on the limb that '{other}' is on; remove one, or draw a `cut` between them"
                )));
            }
            said.names[number].clone_from(&limb.name);
            numbers.push(number);
        }
        for (pose, said_of_pose) in said.said.iter_mut().enumerate() {
            let seen = (layer.limbs.iter().zip(&named).zip(&numbers)).filter_map(|((limb, named), number)| {
                Some(Seen {
                    limb: *number,
                    from: named.at,
                    to: as_used(layer, pose, limb.at[pose]?),
                })
            });
            said_of_pose.seen = seen.collect();
            for name in layer.limb_orders.get(pose).into_iter().flatten() {
                let number = said.names.iter().position(|own| own == name);
                if number.is_none() && name != LimbSpec::TRUNK {
                    return Err(PipelineError::UnknownLimb {
                        limb: name.clone(),
                        pose: layer.poses[pose].name.clone(),
                        known: said
                            .names
                            .iter()
                            .map(|name| format!("'{name}'"))
                            .collect::<Vec<_>>()
                            .join(", "),
                    });
                }
                said_of_pose.order.push(number);
            }
        }
        Ok(said)
    }

    /// What is said of a pose.
    pub(super) fn of(&self, pose: usize) -> &Said {
        &self.said[pose]
    }

    /// The name of a limb.
    pub(super) fn name(&self, limb: usize) -> &str {
        self.names.get(limb).map_or(LIMB, String::as_str)
    }
}

/// A limb's place and cut on the template: its own, or those of a pose that shows all parts apart, too.
fn in_template(
    layer: &LayerSpec,
    guide: &RegistrationGuide,
    open: &[usize],
    limb: &LimbSpec,
) -> Result<NamedLimb, PipelineError> {
    let template = guide.reference;
    let traced = |pose: usize, place: Point| {
        let used = as_used(layer, pose, place);
        if pose == template {
            return used;
        }
        guide.registration.traced(pose, used).unwrap_or(used)
    };
    let mut poses = std::iter::once(template).chain(open.iter().copied().filter(|pose| *pose != template));
    let shown = poses.find_map(|pose| Some((pose, limb.at[pose]?)));
    let Some((pose, at)) = shown else {
        return Err(PipelineError::Limb {
            limb: limb.name.clone(),
            pose: layer.poses[template].name.clone(),
            problem: "it has no place in this drawing, which shows the parts apart; give it one".to_owned(),
        });
    };
    Ok(NamedLimb {
        at: traced(pose, at),
        cut: limb.cut[pose].iter().flatten().map(|p| traced(pose, *p)).collect(),
    })
}
