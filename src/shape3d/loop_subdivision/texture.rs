//! Texture coordinates of a subdivided mesh.

use super::{SubdivisionError, check_triangles, divided};

/// Texture coordinates and their triangles.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SubdividedTexture {
    /// Places in the texture.
    pub coordinates: Vec<[f64; 2]>,
    /// Indices of them, in the order of the mesh's own triangles.
    pub triangles: Vec<[usize; 3]>,
}

/// Texture coordinates and their triangles, subdivided linearly `steps` times: new ones are half-way between two old ones.
///
/// Triangles of texture coordinates are a mesh of their own that is cut open along seams, so every seam is kept, and the
/// triangles come out in the order of [`LoopSubdivision`](super::LoopSubdivision)'s.
///
/// # Errors
/// [`SubdivisionError`] if a triangle names coordinates that do not exist, or there would be too many triangles.
pub fn subdivide_texture(
    coordinates: &[[f64; 2]],
    triangles: &[[usize; 3]],
    steps: usize,
) -> Result<SubdividedTexture, SubdivisionError> {
    check_triangles(coordinates.len(), triangles, steps)?;
    let (mut coordinates, mut triangles) = (coordinates.to_vec(), triangles.to_vec());
    for _ in 0..steps {
        let mut edges: Vec<[usize; 2]> = triangles.iter().flat_map(sides_of).collect();
        edges.sort_unstable();
        edges.dedup();
        let count = coordinates.len();
        let sides: Vec<[usize; 3]> = triangles
            .iter()
            // Every side is among the edges.
            .map(|triangle| sides_of(triangle).map(|side| edges.partition_point(|edge| *edge < side)))
            .collect();
        for [a, b] in edges {
            let ([ax, ay], [bx, by]) = (coordinates[a], coordinates[b]);
            coordinates.push([0.5 * (ax + bx), 0.5 * (ay + by)]);
        }
        triangles = divided(&triangles, &sides, count);
    }
    Ok(SubdividedTexture { coordinates, triangles })
}

fn sides_of(&[a, b, c]: &[usize; 3]) -> [[usize; 2]; 3] {
    [[a, b], [b, c], [c, a]].map(|[from, to]| [from.min(to), from.max(to)])
}
