//! Why there is no picture.

/// Why a diagram or a sheet of forms cannot be drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PictureError {
    /// A diagram has no poses, or not one outline and one place of each landmark for each of them.
    #[error("there is nothing to show: poses, outlines and landmarks do not belong together")]
    Mismatched {
        /// The poses of the mapping.
        poses: usize,
    },
    /// No picture holds so many poses.
    #[error("there are too many poses for one picture")]
    TooManyPoses {
        /// How many there are.
        poses: usize,
    },
    /// A sheet does not have one form for each pair of values.
    #[error("{forms} forms do not fill {columns} columns and {rows} rows")]
    FormCount {
        /// The forms there are.
        forms: usize,
        /// The values to the right.
        columns: usize,
        /// The values upwards.
        rows: usize,
    },
    /// No form of a sheet has a vertex that is finite.
    #[error("no form has a finite vertex")]
    NotFinite,
    /// No picture holds so many forms.
    #[error("there are too many forms for one picture")]
    TooManyForms {
        /// How many there are.
        forms: usize,
    },
}
