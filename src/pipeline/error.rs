//! Why a specification gives no character.

use super::spec::SpecError;
use crate::animation::AnimationError;
use crate::blend::BlendError;
use crate::input::InputError;
use crate::math::Point;
use crate::texture::TextureError;
use crate::weights::WeightError;

/// Why the pipeline stopped. Every message names what it is about: layer, pose, landmark. Where that is written, and in which file,
/// the front end knows that made the specification.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PipelineError {
    /// The specification is no character.
    #[error(transparent)]
    Spec(#[from] SpecError),
    /// The animation is none in this pose space.
    #[error(transparent)]
    Animation(#[from] AnimationError),
    /// A layer cannot be used.
    #[error("layer '{layer}': {source}")]
    Layer {
        /// Its name.
        layer: String,
        /// What is wrong.
        source: Box<PipelineError>,
    },
    /// A character with layers was given where one layer is meant.
    #[error("the character has layers; this works on one of them, {}", layers.join(" or "))]
    Layered {
        /// Their names.
        layers: Vec<String>,
    },
    /// A drawing cannot be used.
    #[error("pose '{pose}': {source}")]
    Drawing {
        /// The pose's name.
        pose: String,
        /// What is wrong.
        source: Box<InputError>,
    },
    /// The poses have different numbers of holes.
    #[error(
        "pose '{pose}' has {found} holes, but pose '{other}' has {expected}; draw the same holes in every pose, or set \
         `holes = \"match\"` or `holes = \"fill\"` under [input]"
    )]
    HoleCount {
        /// The pose that differs.
        pose: String,
        /// Its holes.
        found: usize,
        /// The pose it differs from.
        other: String,
        /// That pose's holes.
        expected: usize,
    },
    /// A landmark lies off the outline.
    #[error(
        "landmark '{landmark}': on pose '{pose}' it lies {distance:.1} units from the outline, at most \
         {largest:.1} are allowed; move ({x:.1}, {y:.1}) onto the outline, or inside the shape in every pose"
    )]
    LandmarkOffOutline {
        /// Its name.
        landmark: String,
        /// The pose's name.
        pose: String,
        /// How far it is off, in source units.
        distance: f64,
        /// How far it may be off.
        largest: f64,
        /// Its place.
        x: f64,
        /// Its place.
        y: f64,
    },
    /// A landmark is on the rim of a hole in one pose, and somewhere else in another.
    #[error(
        "landmark '{landmark}': on pose '{pose}' it lies {place}, at ({x:.1}, {y:.1}), but on pose '{other}' {other_place}; put it on the same \
         thing in every pose, or take it out of one of them"
    )]
    LandmarkPlaces {
        /// Its name.
        landmark: String,
        /// A pose's name.
        pose: String,
        /// Where it is on that pose.
        place: LandmarkPlace,
        /// Its place there.
        x: f64,
        /// Its place there.
        y: f64,
        /// The other pose's name.
        other: String,
        /// Where it is on that one.
        other_place: LandmarkPlace,
    },
    /// Landmarks on rims contradict one another about which hole is which.
    #[error(
        "landmarks '{first}' and '{second}' are on the rims of two holes of pose '{pose}', but {}; move one of them there to the hole of the other, or \
         take it out of one of the poses",
        match other {
            Some(other) => format!("on the rim of one hole of pose '{other}'"),
            None => "by further landmarks and poses these are one hole".to_owned(),
        }
    )]
    LandmarkHoles {
        /// A landmark.
        first: String,
        /// The other.
        second: String,
        /// The name of the pose where they are on two holes.
        pose: String,
        /// The name of the pose where they are on one; `None` if that follows from several poses.
        other: Option<String>,
    },
    /// A landmark on a rim is not given in the reference, all of whose holes are others.
    #[error(
        "landmark '{landmark}' is on the rim of a hole, but no hole of pose '{pose}', which has no place for it, is left to be that hole; give it a \
         place there, too"
    )]
    LandmarkWithoutHole {
        /// Its name.
        landmark: String,
        /// The name of the reference.
        pose: String,
    },
    /// A landmark inside the shape is not given in every pose, and there is no room where it should be.
    #[error(
        "landmark '{landmark}' lies inside the shape, but pose '{pose}' has neither a place for it nor room where it should be; give it one"
    )]
    LandmarkMissing {
        /// Its name.
        landmark: String,
        /// The pose's name.
        pose: String,
    },
    /// A landmark inside the drawing is not inside its polygon.
    #[error("landmark '{landmark}' is not inside the shape of pose '{pose}', or leaves it; correct its place")]
    LandmarkOutside {
        /// Which.
        landmark: String,
        /// The pose's name.
        pose: String,
    },
    /// Two landmarks inside the shape touch or cross.
    #[error("landmarks '{first}' and '{second}' meet inside pose '{pose}'; draw them apart")]
    LandmarksMeet {
        /// A landmark.
        first: String,
        /// The other.
        second: String,
        /// The pose's name.
        pose: String,
    },
    /// A line crosses itself.
    #[error("landmark '{landmark}' crosses itself in pose '{pose}'; draw it without a loop")]
    LandmarkCrossesItself {
        /// Which.
        landmark: String,
        /// The pose's name.
        pose: String,
    },
    /// A line leads from a place of the outline back to the same place.
    #[error(
        "landmark '{landmark}' begins and ends at the same place of the outline of pose '{pose}'; let its ends lie apart, or one of them inside"
    )]
    LandmarkClosed {
        /// Which.
        landmark: String,
        /// The name of a pose in which it is drawn.
        pose: String,
    },
    /// Something lies on different sides of a line.
    #[error(
        "pose '{pose}' has a hole or landmark on the other side of landmark '{landmark}' than pose '{other}'; let the same things lie on each side, or end the line inside"
    )]
    LandmarkSides {
        /// The line.
        landmark: String,
        /// A pose's name.
        pose: String,
        /// The other pose's name.
        other: String,
    },
    /// Landmarks contradict one another.
    #[error(
        "landmark '{landmark}' makes the order impossible: going around pose '{pose}' the landmarks come in another order \
         than around pose '{other}'; correct its place on one of them, or set `mirror = true` if one faces the other way"
    )]
    LandmarkOrder {
        /// The landmark's name.
        landmark: String,
        /// A pose's name.
        pose: String,
        /// The other pose's name.
        other: String,
    },
    /// Two landmarks lie at one place.
    #[error("landmarks '{first}' and '{second}' lie at the same place of pose '{pose}'; move one or remove it")]
    LandmarksCoincide {
        /// A landmark's name.
        first: String,
        /// The other's.
        second: String,
        /// The pose's name.
        pose: String,
    },
    /// A landmark is asked for that does not exist, or is a line.
    #[error("there is no landmark point '{name}'; the character has {known}")]
    UnknownLandmark {
        /// The name asked for.
        name: String,
        /// Those there are.
        known: String,
    },
    /// A limb is named where there is none that can be told from the rest.
    #[error("part '{limb}': on pose '{pose}', {problem}")]
    Limb {
        /// Its name.
        limb: String,
        /// The pose that shows the parts apart.
        pose: String,
        /// What is wrong and what to do.
        problem: String,
    },
    /// An order names a limb that there is not.
    #[error(
        "the order of pose '{pose}' names '{limb}', but the limbs that were found are {known}, and 'trunk' is the rest; correct the name, or add a [[part]] with it"
    )]
    UnknownLimb {
        /// The name.
        limb: String,
        /// The pose.
        pose: String,
        /// Those there are.
        known: String,
    },
    /// Something is said of limbs in a pose where nothing is drawn that could show them.
    #[error(
        "pose '{pose}' is a silhouette without anything drawn inside, which does not show how limbs lie over one another; draw them as layers, or remove what [[part]] and `order` \
         say of it"
    )]
    LimbsUnseen {
        /// The pose.
        pose: String,
    },
    /// Parts of a pose lie over one another, and the mesh cannot follow them there.
    #[error(
        "pose '{pose}': its parts seem to lie over one another, but {misfit}; a landmark or a [[part]] with a place there may help, or draw that part as a layer"
    )]
    Overlap {
        /// The pose.
        pose: String,
        /// What does not fit.
        misfit: OverlapMisfit,
    },
    /// A landmark without a place.
    #[error("landmark '{landmark}' lies on no pose; give it a place on at least one")]
    LandmarkNowhere {
        /// Its name.
        landmark: String,
    },
    /// A copy cannot be deformed.
    #[error("pose '{pose}', a deformed copy of '{of}': {message}")]
    Deformation {
        /// The copy's name.
        pose: String,
        /// The name of the pose that is deformed.
        of: String,
        /// What is wrong and what to do.
        message: String,
    },
    /// A stage refused; its own error says why.
    #[error("{}{source}", pose.as_ref().map(|p| format!("pose '{p}': ")).unwrap_or_default())]
    Stage {
        /// The pose's name, where one is to blame.
        pose: Option<String>,
        /// What is wrong.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The places of the poses allow no weights.
    #[error("pose space: {message}")]
    Space {
        /// What is wrong, with the names of the poses.
        message: String,
        /// The same with their numbers.
        source: WeightError,
    },
    /// Poses without places have no layer in common.
    #[error("pose space: no layer is in all poses, so the poses cannot be compared; give every pose its place")]
    NoCommonLayer,
    /// The weights cannot be computed.
    #[error("pose space: {0}")]
    Weights(WeightError),
    /// The weights given do not sum to 1, or are too many or too few.
    #[error("{0}")]
    BadWeights(String),
    /// The shapes cannot be blended.
    #[error("blend: {0}")]
    Blend(#[from] BlendError),
    /// The textures cannot be weighted.
    #[error("texture: {0}")]
    Texture(#[from] TextureError),
}

/// What kind of place of a pose a landmark is at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum LandmarkPlace {
    /// The outer outline.
    Outline,
    /// The rim of a hole.
    Rim,
    /// The rim of a hole that not every pose has: the mesh covers it.
    CoveredRim,
    /// Inside the shape.
    Inside,
    /// Outside of the shape, or in the middle of a hole.
    Nowhere,
}

/// Why the mesh cannot follow limbs to where they were found.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum OverlapMisfit {
    /// It covers too little of the figure, or too much beside it.
    Cover {
        /// What mesh and figure have in common, of what either has.
        share: f64,
        /// What they must have.
        least: f64,
        /// Where most is missing, in the drawing's coordinates as it is used.
        at: Point,
    },
    /// It stays away from a place that is marked.
    Mark {
        /// The place, in the drawing's coordinates as it is used.
        at: Point,
    },
    /// It folds.
    Fold,
}

impl std::fmt::Display for OverlapMisfit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Cover { share, least, at } => write!(
                f,
                "where its limbs were found they explain {:.1} % of its figure ({:.1} % are needed), least near ({:.0}, {:.0})",
                100.0 * share,
                100.0 * least,
                at.x,
                at.y
            ),
            Self::Mark { at } => write!(
                f,
                "the mesh cannot be brought onto the mark near ({:.0}, {:.0}) without being turned over",
                at.x, at.y
            ),
            Self::Fold => f.write_str("the mesh would be folded where its limbs were found"),
        }
    }
}

impl std::fmt::Display for LandmarkPlace {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Outline => "on the outer outline",
            Self::Rim => "on the rim of a hole",
            Self::CoveredRim => "on the rim of a hole that not every pose has",
            Self::Inside => "inside the shape",
            Self::Nowhere => "outside of the shape",
        })
    }
}

impl PipelineError {
    /// The layer that it is about, where one is named.
    #[must_use]
    pub fn layer(&self) -> Option<&str> {
        match self {
            Self::Layer { layer, .. } => Some(layer),
            _ => None,
        }
    }

    /// The refusal itself, without the layer that it is about.
    #[must_use]
    pub fn within_layer(&self) -> &Self {
        match self {
            Self::Layer { source, .. } => source.within_layer(),
            own => own,
        }
    }

    /// The landmark that it is about, where one is named; the end of a line as the line's name with `(start)` or `(end)`.
    #[must_use]
    pub fn landmark(&self) -> Option<&str> {
        match self.within_layer() {
            Self::LandmarkOffOutline { landmark, .. }
            | Self::LandmarkPlaces { landmark, .. }
            | Self::LandmarkWithoutHole { landmark, .. }
            | Self::LandmarkMissing { landmark, .. }
            | Self::LandmarkOutside { landmark, .. }
            | Self::LandmarkCrossesItself { landmark, .. }
            | Self::LandmarkClosed { landmark, .. }
            | Self::LandmarkSides { landmark, .. }
            | Self::LandmarkOrder { landmark, .. }
            | Self::LandmarkNowhere { landmark } => Some(landmark),
            Self::LandmarksMeet { second, .. }
            | Self::LandmarksCoincide { second, .. }
            | Self::LandmarkHoles { second, .. } => Some(second),
            _ => None,
        }
    }

    /// The limb that it is about, where one is named.
    #[must_use]
    pub fn limb(&self) -> Option<&str> {
        match self.within_layer() {
            Self::Limb { limb, .. } => Some(limb),
            _ => None,
        }
    }

    /// The place that it is about, on its pose's drawing, where one is known.
    #[must_use]
    pub fn place(&self) -> Option<Point> {
        match self.within_layer() {
            Self::LandmarkOffOutline { x, y, .. } | Self::LandmarkPlaces { x, y, .. } => Some(Point::new(*x, *y)),
            Self::Overlap { misfit, .. } => match misfit {
                OverlapMisfit::Cover { at, .. } | OverlapMisfit::Mark { at } => Some(*at),
                OverlapMisfit::Fold => None,
            },
            _ => None,
        }
    }

    /// The pose that it is about, where one is named.
    #[must_use]
    pub fn pose(&self) -> Option<&str> {
        match self.within_layer() {
            Self::Drawing { pose, .. }
            | Self::HoleCount { pose, .. }
            | Self::LandmarkOffOutline { pose, .. }
            | Self::LandmarkPlaces { pose, .. }
            | Self::LandmarkHoles { pose, .. }
            | Self::LandmarkWithoutHole { pose, .. }
            | Self::LandmarkMissing { pose, .. }
            | Self::LandmarkOutside { pose, .. }
            | Self::LandmarksMeet { pose, .. }
            | Self::LandmarkCrossesItself { pose, .. }
            | Self::LandmarkClosed { pose, .. }
            | Self::LandmarkSides { pose, .. }
            | Self::LandmarkOrder { pose, .. }
            | Self::LandmarksCoincide { pose, .. }
            | Self::Deformation { pose, .. } => Some(pose),
            Self::Limb { pose, .. }
            | Self::UnknownLimb { pose, .. }
            | Self::LimbsUnseen { pose }
            | Self::Overlap { pose, .. } => Some(pose),
            Self::Stage { pose, .. } => pose.as_deref(),
            _ => None,
        }
    }

    /// A stage's refusal about the pose of an index.
    pub(super) fn stage(
        names: &[String],
        pose: Option<usize>,
        source: impl Into<Box<dyn std::error::Error + Send + Sync>>,
    ) -> Self {
        Self::Stage {
            pose: pose.and_then(|k| names.get(k)).cloned(),
            source: source.into(),
        }
    }
}
