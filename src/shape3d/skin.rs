//! Skin: which joints every vertex follows, and how much.
//!
//! Source: SBE section 5: a vertex goes where the blend `sum alpha_k T_k` of its joints' transforms takes it. The paper's
//! elbow has two joints a vertex; here a vertex may follow any number.
//!
//! Weights that come from a file are rounded, so they may miss 1 by [`WEIGHT_SUM_TOLERANCE`]; they are then divided by
//! their sum, because weights that sum to 0.999 pull the vertex towards the origin.

use super::rig_error::RigError;
use super::transform::Transform;
use crate::math::Point3;

/// By how much the weights of a vertex may miss 1: a dozen of them rounded to four digits.
pub const WEIGHT_SUM_TOLERANCE: f64 = 1e-3;

/// The joints that every vertex follows, with weights that sum to 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Skin {
    joint_count: usize,
    /// Where the entries of each vertex start, and the end of the last.
    starts: Vec<usize>,
    /// `(joint, weight)`, the joints of a vertex in increasing order, without weights of 0.
    entries: Vec<(usize, f64)>,
}

impl Skin {
    /// Checks the weights of every vertex, `(joint, weight)`, for a skeleton of `joint_count` joints.
    ///
    /// # Errors
    /// [`RigError`] if a joint does not exist or stands twice at one vertex, a weight is negative or not finite, or weights do
    /// not sum to 1.
    pub fn new(vertices: &[Vec<(usize, f64)>], joint_count: usize) -> Result<Self, RigError> {
        let mut starts = Vec::with_capacity(vertices.len() + 1);
        let mut entries = Vec::new();
        starts.push(0);
        for (vertex, given) in vertices.iter().enumerate() {
            let mut sorted = given.clone();
            sorted.sort_by_key(|entry| entry.0);
            for (index, &(joint, weight)) in sorted.iter().enumerate() {
                if joint >= joint_count {
                    return Err(RigError::NoSuchJoint {
                        vertex,
                        joint,
                        count: joint_count,
                    });
                }
                if sorted.get(index + 1).is_some_and(|next| next.0 == joint) {
                    return Err(RigError::JointTwice { vertex, joint });
                }
                if !(weight.is_finite() && weight >= 0.0) {
                    return Err(RigError::BadWeight { vertex, joint, weight });
                }
            }
            let sum: f64 = sorted.iter().map(|entry| entry.1).sum();
            if (sum - 1.0).abs() > WEIGHT_SUM_TOLERANCE {
                return Err(RigError::WeightSum { vertex, sum });
            }
            entries.extend(
                sorted
                    .iter()
                    .filter(|entry| entry.1 > 0.0)
                    .map(|&(joint, weight)| (joint, weight / sum)),
            );
            starts.push(entries.len());
        }
        Ok(Self {
            joint_count,
            starts,
            entries,
        })
    }

    /// How many vertices it has.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.starts.len() - 1
    }

    /// How many joints its skeleton has.
    #[must_use]
    pub fn joint_count(&self) -> usize {
        self.joint_count
    }

    /// The joints that a vertex follows, and how much; empty for a vertex that does not exist.
    #[must_use]
    pub fn of(&self, vertex: usize) -> &[(usize, f64)] {
        match (self.starts.get(vertex), self.starts.get(vertex + 1)) {
            (Some(&from), Some(&to)) => &self.entries[from..to],
            _ => &[],
        }
    }

    /// The joint that a vertex follows most; of equals the first.
    #[must_use]
    pub fn heaviest(&self, vertex: usize) -> Option<usize> {
        let mut best: Option<(usize, f64)> = None;
        for &(joint, weight) in self.of(vertex) {
            if best.is_none_or(|(_, heaviest)| weight > heaviest) {
                best = Some((joint, weight));
            }
        }
        best.map(|(joint, _)| joint)
    }

    /// The blend of the transforms of a vertex's joints: the first factor of equation 8.
    #[must_use]
    pub fn blended(&self, vertex: usize, transforms: &[Transform]) -> Transform {
        let mut blended = Transform::ZERO;
        for &(joint, weight) in self.of(vertex) {
            blended.add_scaled(weight, &transforms[joint]);
        }
        blended
    }

    /// Moves every vertex from the rest position to where its joints take it.
    ///
    /// # Errors
    /// [`RigError`] if there are not as many transforms as joints or not as many positions as vertices.
    pub fn apply(&self, transforms: &[Transform], positions: &mut [Point3]) -> Result<(), RigError> {
        self.check(transforms.len(), positions.len())?;
        for (vertex, position) in positions.iter_mut().enumerate() {
            *position = match self.of(vertex) {
                &[(joint, _)] => transforms[joint].apply(*position),
                _ => self.blended(vertex, transforms).apply(*position),
            };
        }
        Ok(())
    }

    /// The skin of a mesh whose vertices are blends of this one's: row `i` of `combinations` has the vertices that vertex `i` is
    /// made of, with weights that sum to 1. Loop subdivision's masks are such rows.
    ///
    /// # Errors
    /// [`RigError`] if a combination's weights come out negative or do not sum to 1.
    pub fn combined<'a>(&self, combinations: impl Iterator<Item = &'a [(usize, f64)]>) -> Result<Self, RigError> {
        let mut sums = vec![0.0; self.joint_count];
        let vertices: Vec<Vec<(usize, f64)>> = combinations
            .map(|combination| {
                sums.fill(0.0);
                for &(vertex, share) in combination {
                    for &(joint, weight) in self.of(vertex) {
                        sums[joint] += share * weight;
                    }
                }
                let present = sums.iter().enumerate().filter(|(_, sum)| **sum != 0.0);
                present.map(|(joint, &sum)| (joint, sum)).collect()
            })
            .collect();
        Self::new(&vertices, self.joint_count)
    }

    pub(super) fn check(&self, joints: usize, vertices: usize) -> Result<(), RigError> {
        if joints != self.joint_count {
            return Err(RigError::WrongJointCount {
                expected: self.joint_count,
                found: joints,
            });
        }
        if vertices != self.vertex_count() {
            return Err(RigError::WrongVertexCount {
                expected: self.vertex_count(),
                found: vertices,
            });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vertex_half_way_between_two_joints() {
        let skin = Skin::new(&[vec![(1, 0.5), (0, 0.5)], vec![(1, 1.0)]], 2).expect("a skin");
        let shift = |x| Transform {
            translation: Point3::new(x, 0.0, 0.0),
            ..Transform::IDENTITY
        };
        let mut positions = [Point3::zeros(), Point3::y()];
        skin.apply(&[shift(1.0), shift(4.0)], &mut positions)
            .expect("positions");
        assert_eq!(positions, [Point3::new(2.5, 0.0, 0.0), Point3::new(4.0, 1.0, 0.0)]);
        assert_eq!((skin.heaviest(0), skin.heaviest(1)), (Some(0), Some(1)));
        assert!(skin.apply(&[shift(1.0)], &mut positions).is_err());
        assert!(skin.apply(&[shift(1.0), shift(4.0)], &mut positions[..1]).is_err());
    }

    #[test]
    fn rounded_weights_are_made_to_sum_to_one_and_wrong_ones_refused() {
        let third = 0.3333;
        let skin = Skin::new(&[vec![(0, third), (1, third), (2, third)]], 3).expect("a skin");
        let sum: f64 = skin.of(0).iter().map(|entry| entry.1).sum();
        assert!((sum - 1.0).abs() < 1e-15);
        for (entries, needle) in [
            (vec![(0, 0.5)], "0.5"),
            (vec![(3, 1.0)], "joint 3"),
            (vec![(0, 0.5), (0, 0.5)], "twice"),
            (vec![(0, -0.5), (1, 1.5)], "-0.5"),
            (vec![(0, f64::NAN), (1, 1.0)], "NaN"),
            (vec![], "sum"),
        ] {
            let message = Skin::new(&[entries], 3).expect_err("an error").to_string();
            assert!(message.contains(needle), "{message}");
        }
    }

    #[test]
    fn a_blend_of_vertices_follows_their_joints() {
        let skin = Skin::new(&[vec![(0, 1.0)], vec![(0, 0.5), (2, 0.5)]], 3).expect("a skin");
        let rows: [&[(usize, f64)]; 2] = [&[(0, 0.5), (1, 0.5)], &[(0, 1.0)]];
        let finer = skin.combined(rows.into_iter()).expect("a skin");
        assert_eq!(finer.of(0), [(0, 0.75), (2, 0.25)]);
        assert_eq!(finer.of(1), [(0, 1.0)]);
    }
}
