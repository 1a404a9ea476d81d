//! The smoothest weights on a plane: mesh-based biharmonic interpolation.
//!
//! Source: NWM 4.1, equations 1 and 2.
//!
//! 1. The layout is moved to the origin and scaled to diagonal 1, so that nothing depends on its units.
//! 2. A square that reaches 4 layout diagonals from the centre to each side is triangulated with the poses as
//!    vertices (spade).
//! 3. The weights minimise an energy under the constraint to be 1 at their own pose and 0 at the others (eliminated);
//!    one sparse factorisation serves all poses.
//! 4. Between vertices they are evaluated by Clough-Tocher patches, with continuous gradients: motion does not kink at
//!    mesh edges.
//! 5. Beyond the square, the value at its nearest point holds.
//!
//! Differences from the paper: equation 1 takes triangles to be even, and on uneven ones its result depends on the mesh.
//! The default energy is the one that it stands for, `|second derivatives|^2 + w |gradient|^2` integrated over the
//! plane, on elements that converge to it ([`Energy::Hessian`]), and the mesh is graded. The paper's form is
//! [`Energy::JacobianDifferences`], on an even mesh.
//!
//! What `epsilon` means: in the paper it weighs gradients against gradient jumps between neighbouring triangles, so it
//! is a number per squared edge. Here the edge is fixed as 1/32 of the layout's diagonal: `w = 32^2 epsilon` in units
//! where the diagonal is 1. Weights level out over the distance `1 / sqrt(w)`: one diagonal for the default 1e-3.
//!
//! Cost: some 2,000 vertices for a handful of poses, under 100 ms to build and microseconds to ask.

use super::layout::Layout;
use super::surface::Surface;
use super::{WeightError, WeightProvider, check_place, hessian, jacobian_differences, tessellation};
use crate::math::Point;

/// Edges to the diagonal in the meaning of `epsilon`; see the module's page.
const NOMINAL_EDGES: f64 = 32.0;

/// What is minimised.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Energy {
    /// Squared second derivatives (thin-plate energy) and squared gradients, integrated over the plane. The result is a
    /// property of the layout, not of the mesh.
    #[default]
    Hessian,
    /// The paper's equation 1 as printed, on an even mesh.
    JacobianDifferences,
}

/// What [`BiharmonicWeights`] can be told.
#[derive(Debug, Clone, PartialEq)]
pub struct BiharmonicOptions {
    /// How strongly flat is preferred to straight. Default: 1e-3; the weights then level out about one diagonal away from
    /// the poses. Smaller values extrapolate further.
    pub epsilon: f64,
    /// Default: [`Energy::Hessian`].
    pub energy: Energy,
}

impl Default for BiharmonicOptions {
    fn default() -> Self {
        Self {
            epsilon: 1e-3,
            energy: Energy::default(),
        }
    }
}

/// Biharmonic weights over a plane of poses.
///
/// ```
/// use inbetween::weights::{BiharmonicOptions, BiharmonicWeights, WeightProvider};
///
/// # fn main() -> Result<(), inbetween::weights::WeightError> {
/// let places = [vec![0.0, 0.0], vec![1.0, 0.0], vec![2.0, 0.0]];
/// let provider = BiharmonicWeights::new(&places, &BiharmonicOptions::default())?;
/// let mut weights = Vec::new();
/// provider.weights(&[1.0, 0.0], &mut weights)?;
/// assert!((weights[1] - 1.0).abs() < 1e-9);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct BiharmonicWeights {
    pose_count: usize,
    centre: Point,
    diagonal: f64,
    /// `None` for a single pose: its weight is 1 everywhere.
    surface: Option<Surface>,
}

impl BiharmonicWeights {
    /// Solves for weights of poses at `places` (#poses x 2).
    ///
    /// # Errors
    /// [`WeightError`] if there is no pose, places are not of two finite coordinates, two coincide, or `epsilon` is not
    /// a positive number.
    pub fn new(places: &[Vec<f64>], options: &BiharmonicOptions) -> Result<Self, WeightError> {
        let layout = Layout::new(places)?;
        if layout.dimension() != 2 {
            return Err(WeightError::WrongDimension {
                expected: 2,
                found: layout.dimension(),
            });
        }
        if !(options.epsilon > 0.0 && options.epsilon.is_finite()) {
            return Err(WeightError::BadOption {
                option: "epsilon",
                value: options.epsilon,
                must_be: "a positive number",
            });
        }
        let (low, high) = layout.bounds();
        let centre = Point::new(low[0] + 0.5 * (high[0] - low[0]), low[1] + 0.5 * (high[1] - low[1]));
        let pose_count = layout.len();
        if pose_count == 1 {
            return Ok(Self {
                pose_count,
                centre,
                diagonal: 1.0,
                surface: None,
            });
        }
        let diagonal = layout.diagonal();
        let poses: Vec<Point> = layout
            .places()
            .iter()
            .map(|place| (Point::new(place[0], place[1]) - centre) / diagonal)
            .collect();
        let (mesh, jets) = match options.energy {
            Energy::Hessian => {
                let mesh = tessellation::graded(&poses, 0);
                let weight = NOMINAL_EDGES * NOMINAL_EDGES * options.epsilon;
                let jets = hessian::minimise(&mesh, pose_count, weight)?;
                (mesh, jets)
            }
            Energy::JacobianDifferences => {
                let mesh = tessellation::even(&poses);
                let jets = jacobian_differences::minimise(&mesh, pose_count, options.epsilon)?;
                (mesh, jets)
            }
        };
        Ok(Self {
            pose_count,
            centre,
            diagonal,
            surface: Some(Surface::new(mesh, jets, pose_count)),
        })
    }

    /// The square that was solved on: lowest and highest corner. Beyond it weights are constant outwards.
    #[must_use]
    pub fn domain(&self) -> ([f64; 2], [f64; 2]) {
        let reach = Point::repeat(tessellation::REACH * self.diagonal);
        ((self.centre - reach).into(), (self.centre + reach).into())
    }

    /// Vertices of the mesh; 0 for a single pose.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.surface.as_ref().map_or(0, Surface::vertex_count)
    }
}

impl WeightProvider for BiharmonicWeights {
    fn pose_count(&self) -> usize {
        self.pose_count
    }

    fn dimension(&self) -> usize {
        2
    }

    fn weights(&self, at: &[f64], weights: &mut Vec<f64>) -> Result<(), WeightError> {
        check_place(at, 2)?;
        match &self.surface {
            Some(surface) => {
                let place = Point::new(at[0], at[1]) - self.centre;
                surface.values(place / self.diagonal, weights);
            }
            None => {
                weights.clear();
                weights.push(1.0);
            }
        }
        Ok(())
    }
}
