//! Loop subdivision as one sparse matrix from the vertices of a form to those of a smooth surface, with normals.
//!
//! Source: Loop, "Smooth subdivision surfaces based on triangles" (1987); SBE 6.1 takes one step and then the places and
//! normals on the limit surface. Everything depends on the topology alone, so that it is computed once:
//!
//! 1. Each step puts a vertex on every edge and moves the old ones (`masks`); a triangle becomes four, in its place and order:
//!    those at its three corners, then the one in the middle.
//! 2. The steps' matrices are multiplied, then the limit's mask for positions and those for two tangents.
//! 3. The three products have nearly the same entries, and are kept as one list of rows ([`LoopSubdivision::stencil`]).
//!
//! A frame multiplies and takes the cross products of the tangents.
//!
//! On the boundary the surface is a cubic B-spline of the boundary vertices (Hoppe et al. 1994) and depends on nothing inside.
//! A vertex where several fans of triangles meet stays where it is, and has the normal of its first fan.
//! Positions are a partition of unity with weights from 0 to 1; normals are those of the limit surface even where positions
//! are not taken there.
//!
//! Limits: an edge with more than two triangles, or with two that disagree about what is outside, is refused. Creases and
//! corners are not marked by anything, so there are none.
//!
//! Cost: O(triangles * 4^steps) once; a frame about ten multiplications with each coordinate a vertex and mask.

mod masks;
mod neighbourhood;
mod texture;

#[cfg(test)]
mod tests;

pub use texture::{SubdividedTexture, subdivide_texture};

use sprs::CsMat;

use crate::math::{Point3, vectorised};
use neighbourhood::Neighbourhood;

/// More triangles than this are not made: some hundred megabytes of matrix.
pub const MOST_TRIANGLES: usize = 1 << 21;

/// Where the vertices of the finest mesh are put.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SubdividedPositions {
    /// On the limit surface, as if subdivision had gone on for ever.
    #[default]
    Limit,
    /// Where the last step puts them.
    Refined,
}

/// What [`LoopSubdivision`] can be told.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct SubdivisionOptions {
    /// How many times every triangle is divided into four. Default: 1.
    pub steps: usize,
    /// Default: [`SubdividedPositions::Limit`].
    pub positions: SubdividedPositions,
}

impl Default for SubdivisionOptions {
    fn default() -> Self {
        Self {
            steps: 1,
            positions: SubdividedPositions::Limit,
        }
    }
}

/// Why a mesh is not subdivided.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SubdivisionError {
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} has vertex {vertex}, but there are only {count}")]
    NoSuchVertex {
        /// The triangle.
        triangle: usize,
        /// The vertex.
        vertex: usize,
        /// How many there are.
        count: usize,
    },
    /// A triangle has a vertex twice.
    #[error("triangle {triangle} has vertex {vertex} twice")]
    RepeatedVertex {
        /// The triangle.
        triangle: usize,
        /// The vertex.
        vertex: usize,
    },
    /// An edge has more than two triangles.
    #[error("the edge of vertices {} and {} has {} triangles ({})", edge[0], edge[1], triangles.len(), listed(triangles))]
    Branching {
        /// Its ends.
        edge: [usize; 2],
        /// The triangles.
        triangles: Vec<usize>,
    },
    /// Two triangles at an edge are turned against each other.
    #[error(
        "triangles {} and {} run along the edge of vertices {} and {} in the same direction: one of them is turned over",
        triangles[0], triangles[1], edge[0], edge[1]
    )]
    Turned {
        /// Its ends.
        edge: [usize; 2],
        /// The triangles.
        triangles: [usize; 2],
    },
    /// There would be too many triangles.
    #[error("{steps} steps would make more than {MOST_TRIANGLES} of {triangles} triangles")]
    TooMany {
        /// Triangles before.
        triangles: usize,
        /// Steps.
        steps: usize,
    },
    /// Another number of vertices.
    #[error("{expected} vertices expected, {found} found")]
    WrongCount {
        /// What there should be.
        expected: usize,
        /// What was given.
        found: usize,
    },
}

fn listed(numbers: &[usize]) -> String {
    let numbers: Vec<String> = numbers.iter().map(ToString::to_string).collect();
    numbers.join(", ")
}

/// Loop subdivision of one topology.
///
/// ```
/// use inbetween::{math::Point3, shape3d::{LoopSubdivision, SubdivisionOptions}};
///
/// # fn main() -> Result<(), inbetween::shape3d::SubdivisionError> {
/// let tetrahedron = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
/// let smooth = LoopSubdivision::new(4, &tetrahedron, &SubdivisionOptions::default())?;
/// assert_eq!((smooth.vertex_count(), smooth.triangles().len()), (10, 16));
/// let corners = [Point3::zeros(), Point3::x(), Point3::y(), Point3::z()];
/// let positions = smooth.positions(&corners)?;
/// assert!(positions.iter().all(|at| at.norm() < 1.0));
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct LoopSubdivision {
    control_count: usize,
    triangles: Vec<[usize; 3]>,
    /// Where each vertex's entries start, and the end of the last.
    starts: Vec<usize>,
    /// Control vertices and what they count for the position, increasing by row.
    combinations: Vec<(usize, f64)>,
    /// What they count for the two tangents.
    tangents: Vec<[f64; 2]>,
    /// All three in single precision, beside the control vertex.
    single: Vec<(u32, [f32; 3])>,
}

/// What [`LoopSubdivision::apply_planes`] works with; one a thread, used again for every frame.
#[derive(Debug, Clone, Default)]
pub struct SubdivisionScratch {
    /// The control vertices, a register each.
    control: Vec<[f32; 4]>,
}

impl LoopSubdivision {
    /// Prepares the subdivision of a mesh of `vertex_count` vertices.
    ///
    /// # Errors
    /// [`SubdivisionError`] if a triangle is broken, the mesh is not an oriented surface, or there would be too many triangles.
    pub fn new(
        vertex_count: usize,
        triangles: &[[usize; 3]],
        options: &SubdivisionOptions,
    ) -> Result<Self, SubdivisionError> {
        check_triangles(vertex_count, triangles, options.steps)?;
        let mut triangles = triangles.to_vec();
        let mut mesh = Neighbourhood::new(vertex_count, &triangles)?;
        let mut refined: CsMat<f64> = CsMat::eye(vertex_count);
        for _ in 0..options.steps {
            refined = &masks::refinement(&mesh) * &refined;
            triangles = divided(&triangles, &mesh.sides, mesh.rings.len());
            mesh = Neighbourhood::new(refined.rows(), &triangles)?;
        }
        let [along, inwards] = masks::limit_tangents(&mesh).map(|tangent| &tangent * &refined);
        let positions = match options.positions {
            SubdividedPositions::Limit => &masks::limit_positions(&mesh) * &refined,
            SubdividedPositions::Refined => refined,
        };
        let mut subdivision = Self {
            control_count: vertex_count,
            triangles,
            starts: vec![0],
            combinations: Vec::new(),
            tangents: Vec::new(),
            single: Vec::new(),
        };
        for row in 0..positions.rows() {
            subdivision.push_row([&positions, &along, &inwards].map(|matrix| entries_of(matrix, row)));
        }
        Ok(subdivision)
    }

    /// How many vertices the finest mesh has. The first of them belong to the vertices of the mesh that was given.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.starts.len() - 1
    }

    /// How many vertices the mesh has that was given.
    #[must_use]
    pub fn control_count(&self) -> usize {
        self.control_count
    }

    /// The finest triangles. Those of a triangle that was given stand together, in the order of the given ones.
    #[must_use]
    pub fn triangles(&self) -> &[[usize; 3]] {
        &self.triangles
    }

    /// What the position of a vertex of the finest mesh is made of: vertices of the given mesh, increasing, with weights
    /// that sum to 1 and are not negative. Empty for a vertex that does not exist.
    #[must_use]
    pub fn stencil(&self, vertex: usize) -> &[(usize, f64)] {
        match (self.starts.get(vertex), self.starts.get(vertex + 1)) {
            (Some(&from), Some(&to)) => &self.combinations[from..to],
            _ => &[],
        }
    }

    /// The stencils of all vertices.
    pub fn stencils(&self) -> impl Iterator<Item = &[(usize, f64)]> {
        (0..self.vertex_count()).map(|vertex| self.stencil(vertex))
    }

    /// Positions of the finest mesh for `control` positions (#given vertices).
    ///
    /// # Errors
    /// [`SubdivisionError::WrongCount`].
    pub fn positions(&self, control: &[Point3]) -> Result<Vec<Point3>, SubdivisionError> {
        check_count(self.control_count, control.len())?;
        Ok(self
            .stencils()
            .map(|stencil| stencil.iter().map(|&(vertex, share)| control[vertex] * share).sum())
            .collect())
    }

    /// Positions and unit normals of the finest mesh, into buffers (#vertices); nothing is allocated. The normal is zero where
    /// the surface has no tangent plane: at isolated vertices and in degenerate forms.
    ///
    /// # Errors
    /// [`SubdivisionError::WrongCount`].
    pub fn apply(
        &self,
        control: &[Point3],
        positions: &mut [Point3],
        normals: &mut [Point3],
    ) -> Result<(), SubdivisionError> {
        check_count(self.control_count, control.len())?;
        check_count(self.vertex_count(), positions.len())?;
        check_count(self.vertex_count(), normals.len())?;
        for ((range, position), normal) in self.starts.windows(2).zip(positions).zip(normals) {
            let (mut at, mut along, mut inwards) = (Point3::zeros(), Point3::zeros(), Point3::zeros());
            let entries = range[0]..range[1];
            for (&(vertex, share), &[first, second]) in
                self.combinations[entries.clone()].iter().zip(&self.tangents[entries])
            {
                at += control[vertex] * share;
                along += control[vertex] * first;
                inwards += control[vertex] * second;
            }
            *position = at;
            *normal = along.cross(&inwards).try_normalize(0.0).unwrap_or_else(Point3::zeros);
        }
        Ok(())
    }

    /// The same in single precision: planes are the x, the y and the z of all vertices. Nothing is allocated once `scratch` has
    /// been used.
    ///
    /// # Errors
    /// [`SubdivisionError::WrongCount`].
    pub fn apply_planes(
        &self,
        control: [&[f32]; 3],
        positions: [&mut [f32]; 3],
        normals: [&mut [f32]; 3],
        scratch: &mut SubdivisionScratch,
    ) -> Result<(), SubdivisionError> {
        for plane in control {
            check_count(self.control_count, plane.len())?;
        }
        for plane in positions.iter().chain(&normals) {
            check_count(self.vertex_count(), plane.len())?;
        }
        let [xs, ys, zs] = control;
        scratch.control.clear();
        scratch
            .control
            .extend(xs.iter().zip(ys).zip(zs).map(|((&x, &y), &z)| [x, y, z, 0.0]));
        vectorised(
            #[inline(always)]
            || self.multiply_planes(&scratch.control, positions, normals),
        );
        Ok(())
    }

    #[inline(always)]
    fn multiply_planes(&self, control: &[[f32; 4]], positions: [&mut [f32]; 3], normals: [&mut [f32]; 3]) {
        let [px, py, pz] = positions;
        let [nx, ny, nz] = normals;
        for (vertex, range) in self.starts.windows(2).enumerate() {
            let mut sums = [wide::f32x4::ZERO; 3];
            for &(from, shares) in &self.single[range[0]..range[1]] {
                let at = wide::f32x4::new(control[from as usize]);
                for (sum, share) in sums.iter_mut().zip(shares) {
                    *sum += at * share;
                }
            }
            let [[x, y, z, _], [ax, ay, az, _], [bx, by, bz, _]] = sums.map(wide::f32x4::to_array);
            (px[vertex], py[vertex], pz[vertex]) = (x, y, z);
            (nx[vertex], ny[vertex], nz[vertex]) = (ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx);
        }
        normalise_planes(nx, ny, nz);
    }

    /// Adds a row: the union of what three matrices have there.
    fn push_row(&mut self, parts: [Vec<(usize, f64)>; 3]) {
        let mut columns: Vec<usize> = parts.iter().flatten().map(|entry| entry.0).collect();
        columns.sort_unstable();
        columns.dedup();
        for column in columns {
            let [position, along, inwards] = parts.each_ref().map(|part| {
                part.binary_search_by_key(&column, |entry| entry.0)
                    .map_or(0.0, |index| part[index].1)
            });
            self.combinations.push((column, position));
            self.tangents.push([along, inwards]);
            let column = u32::try_from(column).unwrap_or(u32::MAX);
            self.single.push((column, [position, along, inwards].map(|x| x as f32)));
        }
        self.starts.push(self.combinations.len());
    }
}

/// Makes vectors of three planes one long; those of no length stay.
#[inline(always)]
pub(super) fn normalise_planes(xs: &mut [f32], ys: &mut [f32], zs: &mut [f32]) {
    for ((x, y), z) in xs.iter_mut().zip(ys).zip(zs) {
        let squared = *x * *x + *y * *y + *z * *z;
        let factor = if squared > 0.0 { 1.0 / squared.sqrt() } else { 0.0 };
        *x *= factor;
        *y *= factor;
        *z *= factor;
    }
}

/// Four triangles for each, given the numbers of its edges; the vertex of edge `k` is `count + k`.
fn divided(triangles: &[[usize; 3]], sides: &[[usize; 3]], count: usize) -> Vec<[usize; 3]> {
    triangles
        .iter()
        .zip(sides)
        .flat_map(|(&[a, b, c], side)| {
            let [ab, bc, ca] = side.map(|edge| count + edge);
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        })
        .collect()
}

fn check_triangles(count: usize, triangles: &[[usize; 3]], steps: usize) -> Result<(), SubdivisionError> {
    for (triangle, corners) in triangles.iter().enumerate() {
        if let Some(&vertex) = corners.iter().find(|&&vertex| vertex >= count) {
            return Err(SubdivisionError::NoSuchVertex {
                triangle,
                vertex,
                count,
            });
        }
        let [a, b, c] = *corners;
        if a == b || b == c || c == a {
            let vertex = if a == b { a } else { c };
            return Err(SubdivisionError::RepeatedVertex { triangle, vertex });
        }
    }
    let factor = u32::try_from(steps).ok().and_then(|steps| 4_usize.checked_pow(steps));
    match factor.and_then(|factor| factor.checked_mul(triangles.len())) {
        Some(finest) if finest <= MOST_TRIANGLES => Ok(()),
        _ => Err(SubdivisionError::TooMany {
            triangles: triangles.len(),
            steps,
        }),
    }
}

fn check_count(expected: usize, found: usize) -> Result<(), SubdivisionError> {
    if expected == found {
        Ok(())
    } else {
        Err(SubdivisionError::WrongCount { expected, found })
    }
}

fn entries_of(matrix: &CsMat<f64>, row: usize) -> Vec<(usize, f64)> {
    let mut entries: Vec<(usize, f64)> = matrix
        .outer_view(row)
        .map(|row| row.iter().map(|(column, &value)| (column, value)).collect())
        .unwrap_or_default();
    entries.sort_unstable_by_key(|entry| entry.0);
    entries
}
