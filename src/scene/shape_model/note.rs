//! What the designer should know, as values: a caller can count, group and translate them; shown, each is a sentence.

use crate::shape3d::{NearSingular, Rig};

/// A remark on an example of a shape, which is made all the same.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ShapeNote {
    /// The name of the example.
    pub example: String,
    /// What there is to know.
    pub kind: ShapeNoteKind,
}

/// What there is to know of an example.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum ShapeNoteKind {
    /// The joints of some vertices turn against one another so far that their blended transform has no usable inverse.
    NearSingular {
        /// The number of such vertices.
        vertices: usize,
        /// The vertex whose transform is worst.
        worst: usize,
        /// The names of the joints that move that vertex.
        joints: Vec<String>,
        /// The condition number of its transform.
        condition: f64,
    },
}

impl ShapeNote {
    /// What to say of vertices without a usable inverse, if there are any.
    pub(super) fn near_singular(example: &str, found: &[NearSingular], rig: &Rig) -> Option<Self> {
        let worst = found.iter().max_by(|a, b| a.condition.total_cmp(&b.condition))?;
        let joints = rig.skeleton().joints();
        Some(Self {
            example: example.to_owned(),
            kind: ShapeNoteKind::NearSingular {
                vertices: found.len(),
                worst: worst.vertex,
                joints: worst.joints.iter().map(|&joint| joints[joint].name.clone()).collect(),
                condition: worst.condition,
            },
        })
    }
}

impl std::fmt::Display for ShapeNote {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { example, kind } = self;
        match kind {
            ShapeNoteKind::NearSingular {
                vertices,
                worst,
                joints,
                condition,
            } => {
                let joints: Vec<String> = joints.iter().map(|joint| format!("'{joint}'")).collect();
                write!(
                    f,
                    "example '{example}': the joints of {vertices} vertices turn against one another so far that their blend has no \
                     usable inverse, worst vertex {worst} between {} (condition {condition:.1e}); what is missing there is blended after \
                     the joints",
                    joints.join(" and ")
                )
            }
        }
    }
}
