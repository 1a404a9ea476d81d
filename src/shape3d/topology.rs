//! What all forms of a shape share: vertices, faces, texture coordinates; no positions.
//!
//! Source: SBE 3: "all forms in a shape must have the same number of vertices with the same connectivity".
//!
//! Faces are kept as they were modelled, with any number of corners, beside their triangles. Two forms belong together if
//! their faces are the same, corner by corner; triangles and texture coordinates are those of the form that the topology was
//! made from, since every form would divide a warped quadrangle differently.

use super::FormError;
use super::face::triangulate;
use crate::math::Point3;

/// More corners than this a face is not triangulated with: ear clipping is quadratic in them.
const MOST_CORNERS: usize = 4096;

/// A face: its corners in order.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct FormFace {
    /// Vertices.
    pub vertices: Vec<usize>,
    /// Texture coordinates, one a corner; empty if it has none.
    pub texture: Vec<usize>,
}

/// The topology of a form.
#[derive(Debug, Clone, PartialEq)]
pub struct FormTopology {
    vertex_count: usize,
    faces: Vec<FormFace>,
    triangles: Vec<[usize; 3]>,
    texture_coordinates: Vec<[f64; 2]>,
    texture_triangles: Vec<[usize; 3]>,
}

impl FormTopology {
    /// The topology of a form with `positions` (#vertices) and `faces`. Positions are looked at only to triangulate faces with
    /// more than three corners: by ear clipping in the face's mean plane, the shortest diagonal first, so that a
    /// quadrangle is divided by its shorter diagonal, and by the one inside if it is not convex.
    ///
    /// If some faces have texture coordinates and others none, the others get the place (0, 0).
    ///
    /// # Errors
    /// [`FormError`] if there is no face, or one has fewer than three corners, more than 4096, a vertex twice, or an index
    /// out of range.
    pub fn new(
        positions: &[Point3],
        faces: Vec<FormFace>,
        texture_coordinates: Vec<[f64; 2]>,
    ) -> Result<Self, FormError> {
        let mut topology = Self {
            vertex_count: positions.len(),
            faces,
            triangles: Vec::new(),
            texture_coordinates,
            texture_triangles: Vec::new(),
        };
        topology.check()?;
        topology.fill_in_texture();
        let textured = topology.has_texture();
        let mut corners = Vec::new();
        for face in &topology.faces {
            let at = |k: usize| positions[face.vertices[k]];
            triangulate(face.vertices.len(), at, &mut corners);
            for triangle in &corners {
                topology.triangles.push(triangle.map(|k: usize| face.vertices[k]));
                if textured {
                    topology.texture_triangles.push(triangle.map(|k| face.texture[k]));
                }
            }
        }
        Ok(topology)
    }

    /// The topology of a form whose faces are triangles.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn from_triangles(vertex_count: usize, triangles: Vec<[usize; 3]>) -> Result<Self, FormError> {
        Self::from_textured_triangles(vertex_count, triangles, Vec::new(), Vec::new())
    }

    /// The topology of a form whose faces are triangles, with texture coordinates: `texture_triangles` has as many entries as
    /// `triangles`, or none.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn from_textured_triangles(
        vertex_count: usize,
        triangles: Vec<[usize; 3]>,
        texture_coordinates: Vec<[f64; 2]>,
        texture_triangles: Vec<[usize; 3]>,
    ) -> Result<Self, FormError> {
        if !texture_triangles.is_empty() && texture_triangles.len() != triangles.len() {
            return Err(FormError::BadTextureCorner {
                face: texture_triangles.len().min(triangles.len()),
                problem: "there is not one triangle of them for each triangle",
            });
        }
        let face = |(k, triangle): (usize, &[usize; 3])| FormFace {
            vertices: triangle.to_vec(),
            texture: texture_triangles.get(k).map_or(Vec::new(), |corners| corners.to_vec()),
        };
        let topology = Self {
            vertex_count,
            faces: triangles.iter().enumerate().map(face).collect(),
            triangles,
            texture_coordinates,
            texture_triangles,
        };
        topology.check()?;
        Ok(topology)
    }

    /// How many vertices there are.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.vertex_count
    }

    /// The faces as they were modelled. Either all of them have texture coordinates or none has.
    #[must_use]
    pub fn faces(&self) -> &[FormFace] {
        &self.faces
    }

    /// The triangles of all faces, in the faces' order.
    #[must_use]
    pub fn triangles(&self) -> &[[usize; 3]] {
        &self.triangles
    }

    /// Places in the texture, from its lower left corner: (1, 1) is the upper right one.
    #[must_use]
    pub fn texture_coordinates(&self) -> &[[f64; 2]] {
        &self.texture_coordinates
    }

    /// The triangles as indices of texture coordinates: as many as [`Self::triangles`], or none.
    #[must_use]
    pub fn texture_triangles(&self) -> &[[usize; 3]] {
        &self.texture_triangles
    }

    /// Whether there are texture coordinates.
    #[must_use]
    pub fn has_texture(&self) -> bool {
        self.faces.iter().any(|face| !face.texture.is_empty())
    }

    /// Whether a form of the topology `other` is one of this topology too: as many vertices, and the same faces. Texture
    /// coordinates may differ; those of `self` count.
    ///
    /// # Errors
    /// [`FormError::OtherVertexCount`], [`FormError::OtherFaceCount`], [`FormError::OtherFace`].
    pub fn same_as(&self, other: &Self) -> Result<(), FormError> {
        if self.vertex_count != other.vertex_count {
            return Err(FormError::OtherVertexCount {
                expected: self.vertex_count,
                found: other.vertex_count,
            });
        }
        let mut pairs = self.faces.iter().zip(&other.faces);
        let first = pairs.position(|(own, others)| own.vertices != others.vertices);
        if self.faces.len() != other.faces.len() {
            return Err(FormError::OtherFaceCount {
                expected: self.faces.len(),
                found: other.faces.len(),
                first,
            });
        }
        match first {
            None => Ok(()),
            Some(face) => Err(FormError::OtherFace {
                face,
                expected: self.faces[face].vertices.clone(),
                found: other.faces[face].vertices.clone(),
            }),
        }
    }

    fn check(&self) -> Result<(), FormError> {
        if self.faces.is_empty() {
            return Err(FormError::NoFace);
        }
        // Which face was the last to use a vertex.
        let mut used_by = vec![usize::MAX; self.vertex_count];
        for (face, FormFace { vertices, texture }) in self.faces.iter().enumerate() {
            let corners = vertices.len();
            if corners < 3 {
                return Err(FormError::TooFewCorners { face, corners });
            }
            if corners > MOST_CORNERS {
                return Err(FormError::TooManyCorners {
                    face,
                    corners,
                    most: MOST_CORNERS,
                });
            }
            for &vertex in vertices {
                let count = self.vertex_count;
                let last = used_by
                    .get_mut(vertex)
                    .ok_or(FormError::NoSuchVertex { face, vertex, count })?;
                if std::mem::replace(last, face) == face {
                    return Err(FormError::RepeatedVertex { face, vertex });
                }
            }
            if !texture.is_empty() && texture.len() != corners {
                let problem = "some corners have none";
                return Err(FormError::BadTextureCorner { face, problem });
            }
            if texture.iter().any(|&k| k >= self.texture_coordinates.len()) {
                let problem = "one does not exist";
                return Err(FormError::BadTextureCorner { face, problem });
            }
        }
        match self.texture_coordinates.iter().flatten().all(|x| x.is_finite()) {
            true => Ok(()),
            false => Err(FormError::BadTextureCorner {
                face: 0,
                problem: "one is not finite",
            }),
        }
    }

    fn fill_in_texture(&mut self) {
        if !self.has_texture() || self.faces.iter().all(|face| !face.texture.is_empty()) {
            return;
        }
        let missing = self.texture_coordinates.len();
        self.texture_coordinates.push([0.0; 2]);
        for face in self.faces.iter_mut().filter(|face| face.texture.is_empty()) {
            face.texture = vec![missing; face.vertices.len()];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(corners: [[f64; 2]; 4]) -> Vec<Point3> {
        corners.iter().map(|[x, y]| Point3::new(*x, *y, 0.0)).collect()
    }

    fn face(vertices: &[usize], texture: &[usize]) -> FormFace {
        FormFace {
            vertices: vertices.to_vec(),
            texture: texture.to_vec(),
        }
    }

    #[test]
    fn faces_stay_beside_their_triangles_and_lacking_texture_is_filled_in() {
        let positions = square([[0.0, 0.0], [2.0, 0.0], [3.0, 2.0], [0.0, 1.0]]);
        let faces = vec![face(&[0, 1, 2, 3], &[0, 1, 2, 3]), face(&[0, 3, 1], &[])];
        let coordinates = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let topology = FormTopology::new(&positions, faces, coordinates).expect("two faces");
        assert_eq!(topology.faces().len(), 2);
        assert_eq!(topology.triangles().len(), 3);
        // The shorter diagonal joins 1 and 3.
        assert!(
            topology.triangles()[..2]
                .iter()
                .all(|t| t.contains(&1) && t.contains(&3))
        );
        assert_eq!(topology.texture_triangles()[..2], topology.triangles()[..2]);
        assert_eq!(topology.texture_triangles()[2], [4, 4, 4]);
        assert_eq!(topology.texture_coordinates()[4], [0.0, 0.0]);
    }

    #[test]
    fn other_topologies_are_refused_with_counts_and_the_first_difference() {
        let of = |count: usize, triangles: &[[usize; 3]]| {
            FormTopology::from_triangles(count, triangles.to_vec()).expect("triangles")
        };
        let own = of(4, &[[0, 1, 2], [0, 2, 3]]);
        assert_eq!(own.same_as(&own), Ok(()));
        assert_eq!(
            own.same_as(&of(5, &[[0, 1, 2], [0, 2, 3]])),
            Err(FormError::OtherVertexCount { expected: 4, found: 5 })
        );
        assert_eq!(
            own.same_as(&of(4, &[[0, 1, 2]])),
            Err(FormError::OtherFaceCount {
                expected: 2,
                found: 1,
                first: None
            })
        );
        let turned = own.same_as(&of(4, &[[0, 1, 2], [0, 3, 2]])).expect_err("another face");
        assert!(matches!(&turned, FormError::OtherFace { face: 1, .. }), "{turned}");
        assert!(turned.to_string().contains("[0, 3, 2]"), "{turned}");
    }

    #[test]
    fn what_is_no_topology_is_refused() {
        let refused = |count: usize, triangles: &[[usize; 3]]| {
            FormTopology::from_triangles(count, triangles.to_vec()).expect_err("none")
        };
        assert_eq!(refused(3, &[]), FormError::NoFace);
        assert_eq!(
            refused(3, &[[0, 1, 3]]),
            FormError::NoSuchVertex {
                face: 0,
                vertex: 3,
                count: 3
            }
        );
        assert_eq!(
            refused(3, &[[0, 1, 0]]),
            FormError::RepeatedVertex { face: 0, vertex: 0 }
        );
        let positions = square([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        let built = |face: FormFace| FormTopology::new(&positions, vec![face], vec![[0.0; 2]; 2]).expect_err("none");
        assert_eq!(
            built(face(&[0, 1], &[])),
            FormError::TooFewCorners { face: 0, corners: 2 }
        );
        for texture in [[0, 1].as_slice(), &[0, 1, 2]] {
            let error = built(face(&[0, 1, 2], texture));
            assert!(matches!(error, FormError::BadTextureCorner { face: 0, .. }), "{error}");
        }
    }
}
