//! What can be wrong with a skeleton and the skin on it.

/// Why there is no skeleton or skin, or why one cannot be used so.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RigError {
    /// A skeleton without joints.
    #[error("a skeleton needs a joint")]
    NoJoint,
    /// Two joints have one name.
    #[error("two joints are called '{joint}'")]
    SameName {
        /// The name.
        joint: String,
    },
    /// A parent does not exist.
    #[error("joint '{joint}': there is no joint {parent} that could carry it, only {count} joints")]
    NoSuchParent {
        /// The joint's name.
        joint: String,
        /// The parent's number.
        parent: usize,
        /// How many joints there are.
        count: usize,
    },
    /// Joints carry one another.
    #[error("joint '{joint}' is carried, through its parents, by joints that go in a circle")]
    Circle {
        /// The name of a joint on the circle or beyond it.
        joint: String,
    },
    /// An adjective does not exist.
    #[error("joint '{joint}' moves with adjective {adjective}, but there are only {dimension}")]
    NoSuchAdjective {
        /// The joint's name.
        joint: String,
        /// The adjective's number.
        adjective: usize,
        /// How many there are.
        dimension: usize,
    },
    /// A number of a joint is not finite.
    #[error("joint '{joint}': a number is not finite")]
    JointNotFinite {
        /// The joint's name.
        joint: String,
    },
    /// An axis has no length.
    #[error("joint '{joint}': the axis of a turn has no length")]
    NoAxis {
        /// The joint's name.
        joint: String,
    },
    /// A factor is zero or negative.
    #[error("joint '{joint}': the factors of a scaling must be positive")]
    ScaleNotPositive {
        /// The joint's name.
        joint: String,
    },
    /// A place has another number of adjectives.
    #[error("a place has {expected} values, {found} were given")]
    WrongDimension {
        /// What the skeleton has.
        expected: usize,
        /// What was given.
        found: usize,
    },
    /// A place is not finite.
    #[error("the value of adjective {adjective} is not finite")]
    PlaceNotFinite {
        /// Which.
        adjective: usize,
    },
    /// Another number of joints.
    #[error("there are {expected} joints, {found} were given")]
    WrongJointCount {
        /// What there is.
        expected: usize,
        /// What was given.
        found: usize,
    },
    /// Another number of vertices.
    #[error("the skin has {expected} vertices, {found} were given")]
    WrongVertexCount {
        /// What the skin has.
        expected: usize,
        /// What was given.
        found: usize,
    },
    /// A vertex names a joint that does not exist.
    #[error("vertex {vertex} follows joint {joint}, but there are only {count}")]
    NoSuchJoint {
        /// The vertex.
        vertex: usize,
        /// The joint's number.
        joint: usize,
        /// How many there are.
        count: usize,
    },
    /// A vertex names a joint twice.
    #[error("vertex {vertex} names joint {joint} twice")]
    JointTwice {
        /// The vertex.
        vertex: usize,
        /// The joint's number.
        joint: usize,
    },
    /// A weight is negative or not finite.
    #[error("vertex {vertex}: the weight {weight} of joint {joint} is not a number from 0 up")]
    BadWeight {
        /// The vertex.
        vertex: usize,
        /// The joint's number.
        joint: usize,
        /// The weight.
        weight: f64,
    },
    /// The weights of a vertex do not sum to 1.
    #[error("vertex {vertex}: its weights sum to {sum} instead of 1")]
    WeightSum {
        /// The vertex.
        vertex: usize,
        /// What they sum to.
        sum: f64,
    },
    /// A position is not finite.
    #[error("vertex {vertex} is not at a finite position")]
    PositionNotFinite {
        /// The vertex.
        vertex: usize,
    },
}
