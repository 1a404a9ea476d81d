//! One form: where the vertices of a topology lie.

use super::{FormError, FormTopology};
use crate::math::Point3;

/// Positions of all vertices of a [`FormTopology`], all finite and at most [`Form::LARGEST_COORDINATE`].
#[derive(Debug, Clone, PartialEq)]
pub struct Form {
    positions: Vec<Point3>,
}

impl Form {
    /// The largest coordinate, in the form's own unit: sums of squares of such are finite in single precision, too.
    pub const LARGEST_COORDINATE: f64 = 1e12;

    /// The form of `topology` with these positions (#vertices).
    ///
    /// # Errors
    /// [`FormError::OtherVertexCount`] or [`FormError::NotFinite`].
    pub fn new(topology: &FormTopology, positions: Vec<Point3>) -> Result<Self, FormError> {
        let form = Self { positions };
        form.check(topology)?;
        Ok(form)
    }

    /// The positions, #vertices.
    #[must_use]
    pub fn positions(&self) -> &[Point3] {
        &self.positions
    }

    /// The positions, to be changed and made a form again.
    #[must_use]
    pub fn into_positions(self) -> Vec<Point3> {
        self.positions
    }

    pub(super) fn check(&self, topology: &FormTopology) -> Result<(), FormError> {
        if self.positions.len() != topology.vertex_count() {
            return Err(FormError::OtherVertexCount {
                expected: topology.vertex_count(),
                found: self.positions.len(),
            });
        }
        match self
            .positions
            .iter()
            .position(|p| p.iter().any(|x| x.is_nan() || x.abs() > Self::LARGEST_COORDINATE))
        {
            Some(vertex) => Err(FormError::NotFinite { vertex }),
            None => Ok(()),
        }
    }
}
