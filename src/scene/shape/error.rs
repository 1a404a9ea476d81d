//! What can be wrong with a scene of a shape in space, besides what can be wrong with any scene.

/// What is wrong with a shape's scene, and the remedy.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ShapeProblem {
    /// There is no example.
    #[error("the scene has no example; add at least one [[example]] with a name, a form and its place")]
    NoExample,
    /// There is no adjective.
    #[error("the scene has no adjective; name at least one, such as `adjectives = [\"bend\"]`")]
    NoAdjective,
    /// A place names what is no adjective.
    #[error("{key} names '{name}', but the adjectives are {known}; correct the name or add the adjective")]
    UnknownAdjective {
        /// Which key.
        key: String,
        /// The name.
        name: String,
        /// The names there are.
        known: String,
    },
    /// A place leaves an adjective out.
    #[error("{key} says nothing of '{name}'; give every adjective a value")]
    MissingAdjective {
        /// Which key.
        key: String,
        /// The adjective.
        name: String,
    },
    /// Two examples at one place.
    #[error(
        "examples '{first}' and '{second}' have {what} at the same place; move one of them, since the blend there could \
         only be one of the two"
    )]
    SamePlace {
        /// An example.
        first: String,
        /// The other.
        second: String,
        /// Their forms or their textures.
        what: &'static str,
    },
    /// A file that leaves the scene's folder.
    #[error("{key} '{path}' {reason}; copy the file beside the scene file and name it relative to that")]
    FileOutside {
        /// Which key, with its example where it has one.
        key: String,
        /// The path as written.
        path: String,
        /// In which way it leaves.
        reason: &'static str,
    },
    /// A file that cannot be read.
    #[error("{key}: cannot read '{path}': {reason}; correct the name or put the file there")]
    FileMissing {
        /// Which key, with its example where it has one.
        key: String,
        /// The path as written.
        path: String,
        /// The system's reason.
        reason: String,
    },
    /// A file whose content is of no use.
    #[error("{key}: '{path}': {reason}")]
    FileUnusable {
        /// Which key, with its example where it has one.
        key: String,
        /// The path as written.
        path: String,
        /// What is wrong with it, and what to do.
        reason: String,
    },
    /// A joint is named that does not exist, or comes later.
    #[error(
        "joint '{joint}' has the parent '{parent}', which is no joint above it; name one of those, from the root outwards"
    )]
    UnknownParent {
        /// The joint.
        joint: String,
        /// Its parent as written.
        parent: String,
    },
    /// A place or direction that is none.
    #[error("{key} must be three finite numbers{extra}, such as [0.0, 0.0, 1.0]")]
    BadVector {
        /// Which key.
        key: String,
        /// What else it must be.
        extra: &'static str,
    },
    /// Textures are asked for where there are none.
    #[error("{key} is about textures, but no example has one; add `texture = \"FILE\"` to the examples, or remove it")]
    NoTexture {
        /// Which key.
        key: String,
    },
    /// Two axes of the contact sheet are the same adjective, or one of them is fixed, too.
    #[error("[sheet] uses the adjective '{name}' twice; each is across, up or fixed")]
    SheetAxis {
        /// The adjective.
        name: String,
    },
}
