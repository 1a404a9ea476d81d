//! Why forms make no shape.

use crate::weights::WeightError;

/// Why something is no form, or not one of these.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FormError {
    /// There is no face.
    #[error("there is no face: a form needs at least one")]
    NoFace,
    /// A face has fewer than three corners.
    #[error("face {face} has {corners} corners; it needs at least three")]
    TooFewCorners {
        /// Which, from 0.
        face: usize,
        /// How many it has.
        corners: usize,
    },
    /// A face has more corners than are triangulated.
    #[error("face {face} has {corners} corners; at most {most} are taken, so divide it")]
    TooManyCorners {
        /// Which, from 0.
        face: usize,
        /// How many it has.
        corners: usize,
        /// How many it may have.
        most: usize,
    },
    /// A face means a vertex that does not exist.
    #[error("face {face} uses vertex {vertex}, but there are {count}, counted from 0")]
    NoSuchVertex {
        /// Which, from 0.
        face: usize,
        /// The vertex it names.
        vertex: usize,
        /// How many there are.
        count: usize,
    },
    /// A face uses a vertex twice.
    #[error("face {face} uses vertex {vertex} more than once")]
    RepeatedVertex {
        /// Which, from 0.
        face: usize,
        /// The vertex.
        vertex: usize,
    },
    /// A face has texture coordinates for some of its corners only, or means one that does not exist.
    #[error("the texture coordinates of face {face} cannot be used: {problem}")]
    BadTextureCorner {
        /// Which, from 0.
        face: usize,
        /// What is wrong.
        problem: &'static str,
    },
    /// A coordinate is not finite, or larger than is taken.
    #[error(
        "vertex {vertex} does not lie at a finite place; coordinates are at most {:e}",
        super::Form::LARGEST_COORDINATE
    )]
    NotFinite {
        /// Which, from 0.
        vertex: usize,
    },
    /// The number of vertices is another one.
    #[error("{found} vertices where the other forms have {expected}; export all of them from one model")]
    OtherVertexCount {
        /// In the topology.
        expected: usize,
        /// In the form.
        found: usize,
    },
    /// The number of faces is another one.
    #[error(
        "{found} faces where the other forms have {expected}{}; export all of them from one model",
        first_difference(*first)
    )]
    OtherFaceCount {
        /// In the topology.
        expected: usize,
        /// In the form.
        found: usize,
        /// The first face that differs, from 0; `None` if there are only more or fewer.
        first: Option<usize>,
    },
    /// A face has other corners.
    #[error(
        "face {face} has the vertices {found:?} where the other forms have {expected:?} (faces and vertices are counted from 0); \
         export all of them from one model"
    )]
    OtherFace {
        /// The first face that differs, from 0.
        face: usize,
        /// Its vertices in the topology.
        expected: Vec<usize>,
        /// Its vertices in the form.
        found: Vec<usize>,
    },
}

fn first_difference(first: Option<usize>) -> String {
    first.map_or(String::new(), |face| {
        format!(" (the first that differs is face {face}, counted from 0)")
    })
}

/// Why examples make no shape, or a shape cannot be blended.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ShapeError {
    /// An example's form does not belong to the others.
    #[error("example {example}: {problem}")]
    Form {
        /// Which, from 0.
        example: usize,
        /// What is wrong with it.
        problem: FormError,
    },
    /// There are no weights for these places.
    #[error(transparent)]
    Weights(#[from] WeightError),
    /// A buffer or list has the wrong length.
    #[error("{found} {what} where {expected} are needed")]
    WrongLength {
        /// What is counted.
        what: &'static str,
        /// How many there must be.
        expected: usize,
        /// How many there are.
        found: usize,
    },
    /// The images are of different sizes.
    #[error(
        "image {image} is {} x {} pixels where the others are {} x {}; scale it to their size",
        found[0], found[1], expected[0], expected[1]
    )]
    OtherImageSize {
        /// Which, from 0.
        image: usize,
        /// Width and height of the first.
        expected: [usize; 2],
        /// Its own.
        found: [usize; 2],
    },
    /// An example is meant that does not exist.
    #[error("example {example} does not exist: there are {count}, counted from 0")]
    NoSuchExample {
        /// The index given.
        example: usize,
        /// How many there are.
        count: usize,
    },
}
