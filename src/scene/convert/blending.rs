//! How shapes are blended: reference, stretches, anchors, regions, guard.

use toml::{Spanned, Value};

use super::{Checked, Reader};
use crate::blend::{Anchor, BlendOptions, FrameGuard, Reference, Region, SoftAnchor, Stretch};
use crate::scene::error::SceneProblem;
use crate::scene::file::{RegionTable, SceneFile};
use crate::scene::settings::SceneLandmark;

/// The stiffness of an anchor that is one of several and does not say its own: the shape gives way a little.
const SOFT: f64 = 10.0;
/// Stiffnesses lie between one over this and this: beyond it the system loses half of its digits.
const STIFFEST: f64 = 1e6;
/// The largest radius of a region, in diagonals: a drawing may wind a lot, but its mesh is no longer than this.
const WIDEST: f64 = 1e3;

impl Reader<'_> {
    pub(super) fn blend(
        &self,
        written: &SceneFile,
        names: &[&str],
        landmarks: &[SceneLandmark],
    ) -> Checked<BlendOptions> {
        let table = &written.blend;
        let reference = match &table.reference {
            Some(name) if name.get_ref() != "canonical" => {
                Reference::Pose(self.pose_index(name, "[blend] reference", names)?)
            }
            _ => Reference::Canonical,
        };
        let regions = written.region.iter().map(|region| self.region(region, landmarks));
        Ok(BlendOptions {
            reference,
            stretch: self.choice(
                &table.stretch,
                "[blend] stretch",
                &Stretch::NAMED,
                "'linear', 'limited' or 'log'",
            )?,
            guard: self.choice(
                &table.guard,
                "[blend] guard",
                &[("off", FrameGuard::Off), ("repair", FrameGuard::Repair)],
                "'off' or 'repair'",
            )?,
            anchor: match &table.anchor {
                Some(anchor) => self.anchor(anchor, landmarks)?,
                None => Anchor::Centroid,
            },
            turns: Vec::new(),
            regions: regions.collect::<Checked<_>>()?,
        })
    }

    /// `"centroid"`, a landmark, or a list of landmarks, each a name or `{ landmark, stiffness }`.
    fn anchor(&self, written: &Spanned<Value>, landmarks: &[SceneLandmark]) -> Checked<Anchor> {
        let at = written.span().start;
        let misread = || {
            self.fail(
                at,
                SceneProblem::Format(
                    "[blend] anchor must be 'centroid', the name of a landmark, or a list of landmarks, each a name or \
                     { landmark = \"...\", stiffness = 10.0 }"
                        .to_owned(),
                ),
            )
        };
        match written.get_ref() {
            Value::String(name) if name == "centroid" => Ok(Anchor::Centroid),
            Value::String(name) => Ok(Anchor::Point(self.landmark_index(
                at,
                name,
                "[blend] anchor",
                landmarks,
            )?)),
            Value::Array(list) if !list.is_empty() => {
                let soft = list.iter().map(|entry| {
                    let (name, stiffness) = match entry {
                        Value::String(name) => (name, SOFT),
                        Value::Table(table) => {
                            if table.keys().any(|key| key != "landmark" && key != "stiffness") {
                                return Err(misread());
                            }
                            let name = table.get("landmark").and_then(Value::as_str).ok_or_else(misread)?;
                            let stiffness = match table.get("stiffness") {
                                None => SOFT,
                                Some(Value::Float(number)) => *number,
                                Some(Value::Integer(number)) => *number as f64,
                                Some(_) => return Err(misread()),
                            };
                            return self.soft_anchor(at, name, stiffness, landmarks);
                        }
                        _ => return Err(misread()),
                    };
                    self.soft_anchor(at, name, stiffness, landmarks)
                });
                Ok(Anchor::Soft(soft.collect::<Checked<_>>()?))
            }
            _ => Err(misread()),
        }
    }

    fn soft_anchor(&self, at: usize, name: &str, stiffness: f64, landmarks: &[SceneLandmark]) -> Checked<SoftAnchor> {
        Ok(SoftAnchor {
            point: self.landmark_index(at, name, "[blend] anchor", landmarks)?,
            stiffness: self.in_range(
                at,
                "stiffness of an anchor",
                stiffness,
                STIFFEST.recip(),
                STIFFEST,
                "between 1e-6 and 1e6",
            )?,
        })
    }

    fn region(&self, written: &Spanned<RegionTable>, landmarks: &[SceneLandmark]) -> Checked<Region> {
        let (at, table) = (written.span().start, written.get_ref());
        let stiffness = table.stiffness.unwrap_or(1.0);
        let limit = table.stretch_limit.unwrap_or(f64::INFINITY);
        Ok(Region {
            point: self.landmark_index(at, &table.landmark, "a [[region]]", landmarks)?,
            radius: self.in_range(
                at,
                "radius of a [[region]]",
                table.radius,
                f64::MIN_POSITIVE,
                WIDEST,
                "above 0 and at most 1000",
            )?,
            stiffness: self.in_range(
                at,
                "stiffness of a [[region]]",
                stiffness,
                STIFFEST.recip(),
                STIFFEST,
                "between 1e-6 and 1e6",
            )?,
            stretch_limit: self.in_range(
                at,
                "stretch_limit of a [[region]]",
                limit,
                1.0,
                f64::INFINITY,
                "at least 1",
            )?,
        })
    }

    fn landmark_index(&self, at: usize, name: &str, used_by: &str, landmarks: &[SceneLandmark]) -> Checked<usize> {
        landmarks
            .iter()
            .position(|landmark| landmark.name == name)
            .ok_or_else(|| {
                self.fail(
                    at,
                    SceneProblem::UnknownLandmark {
                        name: name.to_owned(),
                        used_by: used_by.to_owned(),
                    },
                )
            })
    }

    fn in_range(&self, at: usize, key: &str, value: f64, least: f64, most: f64, allowed: &'static str) -> Checked<f64> {
        if (least..=most).contains(&value) {
            return Ok(value);
        }
        Err(self.fail(
            at,
            SceneProblem::BadNumber {
                key: key.to_owned(),
                value,
                allowed,
            },
        ))
    }
}
