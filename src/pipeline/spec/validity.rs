//! Whether a specification is a character. It is asked once, before anything is built; the stages rely on the answer.

use super::{CharacterSpec, Facing, LayerSpec, LimbSpec, OverlapSearch, Places, PoseShape, SpaceSpec, SpecError};
use crate::math::Point;
use crate::outline::Ring;

/// The largest absolute coordinate of the pose space: beyond it the products of the weights' systems lose all digits.
pub(crate) const LARGEST_PLACE: f64 = 1e6;
/// What the tolerance of the simplification may be, as a fraction of the diagonal.
const TOLERANCE: std::ops::RangeInclusive<f64> = f64::MIN_POSITIVE..=0.5;
/// What the length of edges may be, as a fraction of the diagonal: shorter ones take hours.
const EDGE_LENGTH: std::ops::RangeInclusive<f64> = 0.002..=1.0;

impl CharacterSpec {
    /// Whether a character can be built of it: names, numbers and indices are what they must be.
    ///
    /// # Errors
    /// [`SpecError`] for the first thing that is not.
    pub fn check(&self) -> Result<(), SpecError> {
        if self.layers.is_empty() {
            return Err(SpecError::NoLayer);
        }
        self.space.check()?;
        check_names("layer", self.layers.iter().map(|layer| &layer.name))?;
        for layer in &self.layers {
            layer.check()?;
            let unknown = layer.poses.iter().find(|pose| !self.space.poses.contains(&pose.name));
            if let Some(pose) = unknown {
                return Err(SpecError::UnknownPose {
                    layer: layer.name.clone(),
                    pose: pose.name.clone(),
                });
            }
        }
        let has = |layer: &LayerSpec, name: &String| layer.poses.iter().any(|pose| &pose.name == name);
        let is_empty = |name: &&String| !self.layers.iter().any(|layer| has(layer, name));
        if let Some(pose) = self.space.poses.iter().find(is_empty) {
            return Err(SpecError::EmptyPose { pose: pose.clone() });
        }
        for k in 0..self.layers.len() {
            self.check_attachment(k)?;
        }
        self.check_draw_orders()?;
        check_number(
            "the sharpness of textures",
            self.texture.sharpness,
            &(0.0..=1.0),
            "between 0 and 1",
        )
    }

    fn check_attachment(&self, layer: usize) -> Result<(), SpecError> {
        let own = &self.layers[layer];
        let Some(attachment) = own.attachment else {
            return Ok(());
        };
        let refused = |reason: String| SpecError::BadAttachment {
            layer: own.name.clone(),
            reason,
        };
        let Some(other) = self.layers.get(attachment.to) else {
            return Err(refused(format!("there is no layer {}", attachment.to)));
        };
        let Some(landmark) = own.landmarks.get(attachment.landmark) else {
            return Err(refused(format!("it has no landmark {}", attachment.landmark)));
        };
        for (pose, at) in own.poses.iter().zip(&landmark.at) {
            if !other.poses.iter().any(|theirs| theirs.name == pose.name) {
                let (to, name) = (&other.name, &pose.name);
                return Err(refused(format!(
                    "layer '{to}' lacks pose '{name}'; draw it there, or attach to another layer"
                )));
            }
            if at.is_none() && matches!(pose.shape, PoseShape::Drawn(_)) {
                let (landmark, name) = (&landmark.name, &pose.name);
                return Err(refused(format!(
                    "it needs landmark '{landmark}' on pose '{name}'; add its place there"
                )));
            }
        }
        let mut at = layer;
        for _ in 0..self.layers.len() {
            match self.layers.get(at).and_then(|layer| layer.attachment) {
                Some(next) => at = next.to,
                None => return Ok(()),
            }
        }
        Err(refused(
            "it hangs on itself, by way of others; leave one of them without attachment".to_owned(),
        ))
    }

    fn check_draw_orders(&self) -> Result<(), SpecError> {
        if self.draw_orders.is_empty() {
            return Ok(());
        }
        check_count("the drawing orders", self.draw_orders.len(), self.space.poses.len())?;
        for (order, pose) in self.draw_orders.iter().zip(&self.space.poses) {
            let mut sorted = order.clone();
            sorted.sort_unstable();
            if !sorted.into_iter().eq(0..self.layers.len()) {
                return Err(SpecError::BadDrawOrder { pose: pose.clone() });
            }
        }
        Ok(())
    }
}

impl SpaceSpec {
    /// Whether poses can lie in it as it says.
    ///
    /// # Errors
    /// [`SpecError`] for the first thing that is wrong.
    pub fn check(&self) -> Result<(), SpecError> {
        if self.poses.is_empty() {
            return Err(SpecError::NoPose);
        }
        check_names("pose", self.poses.iter())?;
        let Places::Given(places) = &self.places else {
            return Ok(());
        };
        check_count("the places of the poses", places.len(), self.poses.len())?;
        let expected = places[0].len().max(1);
        for (k, (place, pose)) in places.iter().zip(&self.poses).enumerate() {
            if place.len() != expected {
                return Err(SpecError::Dimension {
                    pose: pose.clone(),
                    found: place.len(),
                    expected,
                });
            }
            for &value in place {
                let what = || format!("the place of pose '{pose}'");
                let range = -LARGEST_PLACE..=LARGEST_PLACE;
                check_number_of(what, value, &range, "finite and at most a million in size")?;
            }
            if let Some(other) = places[..k].iter().position(|other| other == place) {
                return Err(SpecError::SamePlace {
                    first: self.poses[other].clone(),
                    second: pose.clone(),
                });
            }
        }
        Ok(())
    }
}

impl LayerSpec {
    /// Whether it can be mapped and blended.
    ///
    /// # Errors
    /// [`SpecError`] for the first thing that is wrong.
    pub fn check(&self) -> Result<(), SpecError> {
        let name = || self.name.clone();
        check_names("pose", self.poses.iter().map(|pose| &pose.name))?;
        let drawn = self.drawn_poses();
        if drawn.is_empty() {
            return Err(SpecError::NoDrawing { layer: name() });
        }
        if let Some(reference) = self.reference.filter(|pose| !drawn.contains(pose)) {
            return Err(SpecError::BadReference {
                layer: name(),
                reference,
            });
        }
        for (index, pose) in self.poses.iter().enumerate() {
            let (of, handles) = match &pose.shape {
                PoseShape::Drawn(drawn) if drawn.facing == Facing::Auto => {
                    return Err(SpecError::OpenFacing {
                        layer: name(),
                        pose: pose.name.clone(),
                    });
                }
                PoseShape::Drawn(_) => continue,
                PoseShape::Deformed(copy) => (copy.of, copy.handles.as_slice()),
                PoseShape::Shrunk(copy) => (copy.of, [].as_slice()),
            };
            if self.drawing_of(index).is_none() {
                return Err(SpecError::BadCopy {
                    layer: name(),
                    pose: pose.name.clone(),
                    is_circle: self.poses.len() > of,
                });
            }
            let what = || format!("layer '{}': a handle of pose '{}'", self.name, pose.name);
            check_points(what, handles.iter().flat_map(|handle| [handle.from, handle.to]))?;
        }
        let names = self.landmarks.iter().map(|landmark| &landmark.name);
        check_names("landmark", names.chain(self.paths.iter().map(|path| &path.name)))?;
        for landmark in &self.landmarks {
            let one = |at: &Option<Point>| at.map(|at| vec![at]);
            self.check_landmark(&landmark.name, &landmark.at.iter().map(one).collect::<Vec<_>>())?;
        }
        for path in &self.paths {
            self.check_landmark(&path.name, &path.at)?;
            for (at, pose) in path.at.iter().zip(&self.poses) {
                let is_short = |line: &Vec<Point>| line.len() < 2 || line.windows(2).any(|pair| pair[0] == pair[1]);
                if at.as_ref().is_some_and(is_short) {
                    return Err(SpecError::ShortLine {
                        layer: name(),
                        landmark: path.name.clone(),
                        pose: pose.name.clone(),
                    });
                }
            }
        }
        self.check_limbs()?;
        let count = self.landmarks.len();
        if let Some(point) = self.blend.points().find(|point| *point >= count) {
            return Err(SpecError::UnknownLandmark {
                layer: name(),
                point,
                count,
            });
        }
        let what = |of: &str| format!("layer '{}': {of}", self.name);
        let tolerance = self.mesh.simplify.tolerance;
        check_number_of(
            || what("the tolerance of the boundary"),
            tolerance,
            &TOLERANCE,
            "above 0 and at most 0.5",
        )?;
        let length = self.mesh.refine.edge_length;
        check_number_of(
            || what("the length of edges"),
            length,
            &EDGE_LENGTH,
            "between 0.002 and 1",
        )?;
        let angle = self.mesh.refine.smallest_angle_deg;
        check_number_of(
            || what("the smallest angle"),
            angle,
            &(0.0..=60.0),
            "between 0 and 60 degrees",
        )
    }

    fn check_limbs(&self) -> Result<(), SpecError> {
        check_names("limb", self.limbs.iter().map(|limb| &limb.name))?;
        let refused = |limb: &LimbSpec, reason: &str| SpecError::BadLimb {
            layer: self.name.clone(),
            limb: limb.name.clone(),
            reason: reason.to_owned(),
        };
        for limb in &self.limbs {
            if limb.name == LimbSpec::TRUNK {
                return Err(refused(limb, "that is what belongs to no limb; give it another name"));
            }
            let one = |at: &Option<Point>| at.map(|at| vec![at]);
            let places: Vec<_> = limb.at.iter().map(one).collect();
            self.check_places("limb", &limb.name, &places)?;
            self.check_places("limb", &limb.name, &limb.cut)?;
            if limb.at.iter().all(Option::is_none) {
                return Err(refused(
                    limb,
                    "it has no place; give it one in a drawing that shows it apart",
                ));
            }
            let is_short = |line: &Vec<Point>| line.len() < 2 || line.windows(2).any(|pair| pair[0] == pair[1]);
            if limb.cut.iter().flatten().any(is_short) {
                return Err(refused(
                    limb,
                    "a cut needs at least two points, successive ones different",
                ));
            }
            if (limb.cut.iter().zip(&limb.at)).any(|(cut, at)| cut.is_some() && at.is_none()) {
                return Err(refused(
                    limb,
                    "it has a cut in a pose that it has no place in; add its place there",
                ));
            }
        }
        if !self.limb_orders.is_empty() {
            check_count("the orders of limbs", self.limb_orders.len(), self.poses.len())?;
        }
        for (order, pose) in self.limb_orders.iter().zip(&self.poses) {
            let is_repeated = |(k, name): (usize, &String)| order[..k].contains(name);
            if order.iter().enumerate().any(is_repeated) || order.len() == 1 {
                return Err(SpecError::BadLimbOrder {
                    layer: self.name.clone(),
                    pose: pose.name.clone(),
                });
            }
        }
        if self.overlaps == OverlapSearch::Refuse && self.has_limbs() {
            return Err(SpecError::LimbsRefused {
                layer: self.name.clone(),
            });
        }
        Ok(())
    }

    fn check_landmark(&self, landmark: &str, at: &[Option<Vec<Point>>]) -> Result<(), SpecError> {
        self.check_places("landmark", landmark, at)
    }

    /// Whether a mark, whose kind is named, has places on drawn poses alone.
    fn check_places(&self, kind: &str, name: &str, at: &[Option<Vec<Point>>]) -> Result<(), SpecError> {
        let what = || format!("layer '{}': {kind} '{name}'", self.name);
        check_count(&what(), at.len(), self.poses.len())?;
        for (at, pose) in at.iter().zip(&self.poses) {
            let Some(points) = at else { continue };
            if !matches!(pose.shape, PoseShape::Drawn(_)) {
                return Err(SpecError::LandmarkOnCopy {
                    layer: self.name.clone(),
                    landmark: name.to_owned(),
                    pose: pose.name.clone(),
                });
            }
            check_points(|| format!("{} on pose '{}'", what(), pose.name), points.iter().copied())?;
        }
        Ok(())
    }
}

fn check_names<'a>(kind: &'static str, names: impl Iterator<Item = &'a String>) -> Result<(), SpecError> {
    let mut seen = std::collections::BTreeSet::new();
    for name in names {
        if name.is_empty() || !seen.insert(name) {
            return Err(SpecError::BadName {
                kind,
                name: name.clone(),
            });
        }
    }
    Ok(())
}

fn check_count(what: &str, found: usize, expected: usize) -> Result<(), SpecError> {
    if found == expected {
        return Ok(());
    }
    Err(SpecError::Count {
        what: what.to_owned(),
        found,
        expected,
    })
}

fn check_points(what: impl Fn() -> String, points: impl IntoIterator<Item = Point>) -> Result<(), SpecError> {
    let range = -Ring::LARGEST_COORDINATE..=Ring::LARGEST_COORDINATE;
    for value in points.into_iter().flat_map(|p| [p.x, p.y]) {
        check_number_of(&what, value, &range, "a place on the drawing")?;
    }
    Ok(())
}

fn check_number(
    what: &str,
    value: f64,
    range: &std::ops::RangeInclusive<f64>,
    allowed: &'static str,
) -> Result<(), SpecError> {
    check_number_of(|| what.to_owned(), value, range, allowed)
}

fn check_number_of(
    what: impl Fn() -> String,
    value: f64,
    range: &std::ops::RangeInclusive<f64>,
    allowed: &'static str,
) -> Result<(), SpecError> {
    // A NaN is in no range.
    if range.contains(&value) {
        return Ok(());
    }
    Err(SpecError::BadNumber {
        what: what(),
        value,
        allowed,
    })
}
