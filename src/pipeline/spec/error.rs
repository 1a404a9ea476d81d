//! What can be wrong with a specification.

/// Why a specification is no character. Layers, poses and landmarks are named.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SpecError {
    /// There is no layer.
    #[error("the character has no layer; give it at least one")]
    NoLayer,
    /// The space has no pose.
    #[error("the pose space has no pose; give it at least one")]
    NoPose,
    /// A drawing's facing is left open.
    #[error("layer '{layer}', pose '{pose}': which way it faces is not settled; call `CharacterSpec::with_facings`")]
    OpenFacing {
        /// The layer.
        layer: String,
        /// The pose.
        pose: String,
    },
    /// A name is empty or taken.
    #[error("{kind} name '{name}' is {}; give every {kind} a name of its own", if name.is_empty() { "empty" } else { "used twice" })]
    BadName {
        /// `pose`, `layer` or `landmark`.
        kind: &'static str,
        /// The name.
        name: String,
    },
    /// A layer has a pose that the space lacks.
    #[error("layer '{layer}' has a pose '{pose}', which the pose space lacks; add it there")]
    UnknownPose {
        /// The layer.
        layer: String,
        /// The pose.
        pose: String,
    },
    /// A pose that no layer has.
    #[error("no layer has pose '{pose}'; draw it, or leave it out of the pose space")]
    EmptyPose {
        /// The pose.
        pose: String,
    },
    /// A layer without a drawing.
    #[error("layer '{layer}' has no drawn pose; give it at least one")]
    NoDrawing {
        /// The layer.
        layer: String,
    },
    /// A copy of a pose that does not exist, or of itself.
    #[error("layer '{layer}': pose '{pose}' is a deformed copy of {}; let it be one of a drawn pose", if *.is_circle { "itself, by way of others" } else { "a pose that does not exist" })]
    BadCopy {
        /// The layer.
        layer: String,
        /// The copy.
        pose: String,
        /// Whether it is a copy of itself.
        is_circle: bool,
    },
    /// Something has not as many entries as it must.
    #[error("{what}: {found} entries, but {expected} are needed")]
    Count {
        /// What.
        what: String,
        /// How many there are.
        found: usize,
        /// How many there must be.
        expected: usize,
    },
    /// A place of the pose space of another dimension than the first one's.
    #[error(
        "the place of pose '{pose}' has {found} coordinates, the others have {expected}; give every place the same number, at least one"
    )]
    Dimension {
        /// The pose.
        pose: String,
        /// Its coordinates.
        found: usize,
        /// Those of the first pose.
        expected: usize,
    },
    /// Two poses at one place.
    #[error("poses '{first}' and '{second}' lie at the same place; move one of them")]
    SamePlace {
        /// A pose.
        first: String,
        /// The other.
        second: String,
    },
    /// A number is not finite or out of its range.
    #[error("{what} is {value}, but must be {allowed}")]
    BadNumber {
        /// Which.
        what: String,
        /// The number.
        value: f64,
        /// The range in words.
        allowed: &'static str,
    },
    /// A landmark or limb has a place on a deformed copy.
    #[error(
        "layer '{layer}': '{landmark}' has a place on pose '{pose}', a deformed copy, whose landmarks and limbs its mesh carries; remove it, or move a handle there"
    )]
    LandmarkOnCopy {
        /// The layer.
        layer: String,
        /// The landmark.
        landmark: String,
        /// The copy.
        pose: String,
    },
    /// A line that is a point.
    #[error(
        "layer '{layer}': line '{landmark}' needs at least two different points on pose '{pose}', successive ones different"
    )]
    ShortLine {
        /// The layer.
        layer: String,
        /// The line.
        landmark: String,
        /// The pose.
        pose: String,
    },
    /// What is said of a limb cannot be.
    #[error("layer '{layer}': limb '{limb}': {reason}")]
    BadLimb {
        /// The layer.
        layer: String,
        /// The limb.
        limb: String,
        /// What is wrong, and what to do.
        reason: String,
    },
    /// An order of limbs that is none.
    #[error(
        "layer '{layer}': the order of limbs in pose '{pose}' must name two or more, each once, from back to front; what belongs to no limb is 'trunk'"
    )]
    BadLimbOrder {
        /// The layer.
        layer: String,
        /// The pose.
        pose: String,
    },
    /// Limbs are named, but nothing may lie over anything.
    #[error(
        "layer '{layer}': limbs that lie over one another are named, but `overlaps = \"refuse\"` says that there are none; remove one or the other"
    )]
    LimbsRefused {
        /// The layer.
        layer: String,
    },
    /// The reference is no drawn pose.
    #[error(
        "layer '{layer}': pose {reference} cannot be the reference of the matching; name a drawn pose of the layer"
    )]
    BadReference {
        /// The layer.
        layer: String,
        /// The index given.
        reference: usize,
    },
    /// The blend names a landmark that the layer lacks.
    #[error(
        "layer '{layer}': the blend names landmark {point}, but there are {count}; correct the number or add the landmark"
    )]
    UnknownLandmark {
        /// The layer.
        layer: String,
        /// The index given.
        point: usize,
        /// How many landmarks there are.
        count: usize,
    },
    /// A layer cannot hang where it is to hang.
    #[error("layer '{layer}' cannot be attached: {reason}")]
    BadAttachment {
        /// The layer.
        layer: String,
        /// Why, and what to do.
        reason: String,
    },
    /// A drawing order that is none.
    #[error("the drawing order of pose '{pose}' must name each layer once, from back to front")]
    BadDrawOrder {
        /// The pose.
        pose: String,
    },
}
