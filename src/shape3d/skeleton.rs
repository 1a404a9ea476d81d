//! Joints that move with the adjectives: a place of the space in, what each joint does to the rest position out.
//!
//! Source: SBE section 5, where one elbow turns; here any number of joints in a tree.
//!
//! A joint has an origin in the rest position and moves relative to its parent: it is scaled about its origin, turned about
//! it, and shifted, each by an amount that an adjective says. All of it is in the parent's frame, whose axes are those of
//! the rest position carried along, so that `local pose = T R S` as animation formats have it. With every amount 0 the
//! skeleton is in its rest position and every transform is the identity.
//!
//! Cost: O(joints + turns) a place, no allocation after [`Skeleton::new`].

use super::rig_error::RigError;
use super::transform::{Transform, quaternion_about, quaternion_product, rotation_of};
use crate::math::Point3;

/// A turn about an axis through a joint's origin, by the right-hand rule: `degrees_at_zero + degrees * value` of the adjective.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turn {
    /// Which adjective, by its number in the place.
    pub adjective: usize,
    /// The axis in the rest position; any length but 0.
    pub axis: Point3,
    /// For one unit of the adjective.
    pub degrees: f64,
    /// Where the adjective is 0.
    pub degrees_at_zero: f64,
}

/// A shift of a joint: `by * value` of the adjective.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shift {
    /// Which adjective, by its number in the place.
    pub adjective: usize,
    /// For one unit of the adjective, along the rest position's axes.
    pub by: Point3,
}

/// A scaling about a joint's origin along the rest position's axes: by the factors to the power of the adjective's value, so
/// that it is 1 at 0 and never reaches 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scaling {
    /// Which adjective, by its number in the place.
    pub adjective: usize,
    /// The factors for one unit of the adjective; all positive.
    pub factors: Point3,
}

/// A joint of a skeleton.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// Its name; no two joints share one.
    pub name: String,
    /// The joint that carries it; none for a root.
    pub parent: Option<usize>,
    /// Where it is in the rest position.
    pub origin: Point3,
    /// Turns, in the order in which they are applied.
    pub turns: Vec<Turn>,
    /// Shifts; they add up.
    pub shifts: Vec<Shift>,
    /// Scalings, before the turns; they multiply.
    pub scalings: Vec<Scaling>,
}

impl Joint {
    /// A joint that does not move relative to its parent.
    #[must_use]
    pub fn new(name: &str, parent: Option<usize>, origin: Point3) -> Self {
        Self {
            name: name.to_owned(),
            parent,
            origin,
            turns: Vec::new(),
            shifts: Vec::new(),
            scalings: Vec::new(),
        }
    }
}

/// A joint's pose relative to its parent, as the nodes of animation formats have it: first scaled, then turned, then moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalPose {
    /// Where the joint's origin is, in the parent's frame; for a root, in space.
    pub translation: Point3,
    /// A unit quaternion, `(x, y, z, w)`.
    pub rotation: [f64; 4],
    /// The factors along the axes.
    pub scale: Point3,
}

/// Joints in a tree that move with the adjectives.
///
/// ```
/// use inbetween::{math::Point3, shape3d::{Joint, Skeleton, Turn}};
///
/// # fn main() -> Result<(), inbetween::shape3d::RigError> {
/// let mut elbow = Joint::new("forearm", Some(0), Point3::new(3.0, 0.0, 0.0));
/// elbow.turns.push(Turn { adjective: 0, axis: Point3::z(), degrees: 90.0, degrees_at_zero: 0.0 });
/// let skeleton = Skeleton::new(vec![Joint::new("upper", None, Point3::zeros()), elbow], 1)?;
/// let transforms = skeleton.transforms(&[1.0])?;
/// let fingertip = transforms[1].apply(Point3::new(5.0, 0.0, 0.0));
/// assert!((fingertip - Point3::new(3.0, 2.0, 0.0)).norm() < 1e-12);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Skeleton {
    joints: Vec<Joint>,
    /// Every joint after its parent.
    order: Vec<usize>,
    dimension: usize,
}

impl Skeleton {
    /// Checks joints that move with `dimension` adjectives. A parent may stand before or after its children; the axes of turns
    /// are made to have length 1.
    ///
    /// # Errors
    /// [`RigError`] if there is no joint, two have the same name, a parent or adjective does not exist, joints carry one
    /// another in a circle, an axis has no length, a factor is not positive, or a number is not finite.
    pub fn new(joints: Vec<Joint>, dimension: usize) -> Result<Self, RigError> {
        if joints.is_empty() {
            return Err(RigError::NoJoint);
        }
        let mut joints = joints;
        for index in 0..joints.len() {
            let (before, rest) = joints.split_at_mut(index);
            if let [joint, ..] = rest {
                if before.iter().any(|other| other.name == joint.name) {
                    return Err(RigError::SameName {
                        joint: joint.name.clone(),
                    });
                }
                check(joint, dimension)?;
                for turn in &mut joint.turns {
                    turn.axis /= turn.axis.norm();
                }
            }
        }
        let order = order_of(&joints)?;
        Ok(Self {
            joints,
            order,
            dimension,
        })
    }

    /// The joints, in the order in which they were given.
    #[must_use]
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// How many adjectives a place has.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// What each joint does to the rest position at a place.
    ///
    /// # Errors
    /// As [`Self::transforms_into`].
    pub fn transforms(&self, place: &[f64]) -> Result<Vec<Transform>, RigError> {
        let mut transforms = vec![Transform::IDENTITY; self.joints.len()];
        self.transforms_into(place, &mut transforms)?;
        Ok(transforms)
    }

    /// What each joint does to the rest position at a place, into `transforms` (#joints). Nothing is allocated.
    ///
    /// # Errors
    /// [`RigError`] if a length is wrong or the place is not finite.
    pub fn transforms_into(&self, place: &[f64], transforms: &mut [Transform]) -> Result<(), RigError> {
        self.check_place(place)?;
        self.check_length(transforms.len())?;
        for &index in &self.order {
            let joint = &self.joints[index];
            let local = self.local_pose(joint, place);
            let linear = rotation_of(local.rotation) * nalgebra::Matrix3::from_diagonal(&local.scale);
            // In the parent's frame the rest position is as in space, but for where its origin is.
            let start = joint.origin - self.start_of(joint);
            let own = Transform {
                linear,
                translation: joint.origin + (local.translation - start) - linear * joint.origin,
            };
            transforms[index] = match joint.parent {
                Some(parent) => transforms[parent].after(&own),
                None => own,
            };
        }
        Ok(())
    }

    /// Each joint's pose relative to its parent at a place, into `poses` (#joints). Nothing is allocated.
    ///
    /// The product of a joint's poses from its root to itself takes the joint's own coordinates to space; the rest position
    /// minus the joint's origin is in these coordinates.
    ///
    /// # Errors
    /// [`RigError`] if a length is wrong or the place is not finite.
    pub fn local_poses_into(&self, place: &[f64], poses: &mut [LocalPose]) -> Result<(), RigError> {
        self.check_place(place)?;
        self.check_length(poses.len())?;
        for (pose, joint) in poses.iter_mut().zip(&self.joints) {
            *pose = self.local_pose(joint, place);
        }
        Ok(())
    }

    /// Each joint's pose relative to its parent at a place.
    ///
    /// # Errors
    /// As [`Self::local_poses_into`].
    pub fn local_poses(&self, place: &[f64]) -> Result<Vec<LocalPose>, RigError> {
        self.check_place(place)?;
        Ok(self.joints.iter().map(|joint| self.local_pose(joint, place)).collect())
    }

    /// Where the joint's parent is in the rest position; the origin of space for a root.
    fn start_of(&self, joint: &Joint) -> Point3 {
        joint
            .parent
            .map_or(Point3::zeros(), |parent| self.joints[parent].origin)
    }

    fn local_pose(&self, joint: &Joint, place: &[f64]) -> LocalPose {
        let mut translation = joint.origin - self.start_of(joint);
        for shift in &joint.shifts {
            translation += shift.by * place[shift.adjective];
        }
        let mut rotation = [0.0, 0.0, 0.0, 1.0];
        for turn in &joint.turns {
            let degrees = turn.degrees_at_zero + turn.degrees * place[turn.adjective];
            rotation = quaternion_product(quaternion_about(turn.axis, degrees.to_radians()), rotation);
        }
        let mut scale = Point3::repeat(1.0);
        for scaling in &joint.scalings {
            let value = place[scaling.adjective];
            scale.component_mul_assign(&scaling.factors.map(|factor| libm::pow(factor, value)));
        }
        LocalPose {
            translation,
            rotation,
            scale,
        }
    }

    fn check_place(&self, place: &[f64]) -> Result<(), RigError> {
        if place.len() != self.dimension {
            return Err(RigError::WrongDimension {
                expected: self.dimension,
                found: place.len(),
            });
        }
        match place.iter().position(|value| !value.is_finite()) {
            Some(adjective) => Err(RigError::PlaceNotFinite { adjective }),
            None => Ok(()),
        }
    }

    fn check_length(&self, found: usize) -> Result<(), RigError> {
        let expected = self.joints.len();
        if found == expected {
            Ok(())
        } else {
            Err(RigError::WrongJointCount { expected, found })
        }
    }
}

fn check(joint: &Joint, dimension: usize) -> Result<(), RigError> {
    let name = || joint.name.clone();
    let finite = |point: &Point3| point.iter().all(|x| x.is_finite());
    let adjectives = (joint.turns.iter().map(|t| t.adjective))
        .chain(joint.shifts.iter().map(|s| s.adjective))
        .chain(joint.scalings.iter().map(|s| s.adjective));
    for adjective in adjectives {
        if adjective >= dimension {
            return Err(RigError::NoSuchAdjective {
                joint: name(),
                adjective,
                dimension,
            });
        }
    }
    let is_finite = finite(&joint.origin)
        && joint
            .turns
            .iter()
            .all(|t| finite(&t.axis) && t.degrees.is_finite() && t.degrees_at_zero.is_finite())
        && joint.shifts.iter().all(|s| finite(&s.by))
        && joint.scalings.iter().all(|s| finite(&s.factors));
    if !is_finite {
        return Err(RigError::JointNotFinite { joint: name() });
    }
    // The square of a tiny length is 0 already.
    if joint.turns.iter().any(|t| !t.axis.norm().is_normal()) {
        return Err(RigError::NoAxis { joint: name() });
    }
    if joint.scalings.iter().any(|s| s.factors.iter().any(|f| *f <= 0.0)) {
        return Err(RigError::ScaleNotPositive { joint: name() });
    }
    Ok(())
}

/// The joints, every one after its parent.
fn order_of(joints: &[Joint]) -> Result<Vec<usize>, RigError> {
    let mut order = Vec::with_capacity(joints.len());
    let mut is_placed = vec![false; joints.len()];
    for joint in joints {
        if let Some(parent) = joint.parent.filter(|&parent| parent >= joints.len()) {
            return Err(RigError::NoSuchParent {
                joint: joint.name.clone(),
                parent,
                count: joints.len(),
            });
        }
    }
    while order.len() < joints.len() {
        let placed = order.len();
        for (index, joint) in joints.iter().enumerate() {
            if !is_placed[index] && joint.parent.is_none_or(|parent| is_placed[parent]) {
                is_placed[index] = true;
                order.push(index);
            }
        }
        if order.len() == placed {
            let stuck = is_placed.iter().position(|placed| !placed).unwrap_or(0);
            return Err(RigError::Circle {
                joint: joints[stuck].name.clone(),
            });
        }
    }
    Ok(order)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn turn(axis: Point3, degrees: f64) -> Turn {
        Turn {
            adjective: 0,
            axis,
            degrees,
            degrees_at_zero: 0.0,
        }
    }

    fn arm() -> Vec<Joint> {
        // The child stands before its parent.
        let mut hand = Joint::new("hand", Some(2), Point3::new(5.0, 0.0, 0.0));
        hand.turns.push(Turn {
            adjective: 1,
            axis: Point3::new(0.0, 3.0, 0.0),
            degrees: 45.0,
            degrees_at_zero: 45.0,
        });
        let upper = Joint::new("upper", None, Point3::zeros());
        let mut forearm = Joint::new("forearm", Some(1), Point3::new(3.0, 0.0, 0.0));
        forearm.turns.push(turn(Point3::z(), 90.0));
        vec![hand, upper, forearm]
    }

    #[test]
    fn a_hand_by_hand() {
        let skeleton = Skeleton::new(arm(), 2).expect("a skeleton");
        let transforms = skeleton.transforms(&[1.0, 1.0]).expect("a place");
        // The elbow turns by 90 degrees about z, the wrist by 90 degrees about its y, which is now minus x.
        let wrist = transforms[0].apply(Point3::new(5.0, 0.0, 0.0));
        assert!((wrist - Point3::new(3.0, 2.0, 0.0)).norm() < 1e-12, "{wrist}");
        let finger = transforms[0].apply(Point3::new(6.0, 0.0, 0.0));
        assert!((finger - Point3::new(3.0, 2.0, -1.0)).norm() < 1e-12, "{finger}");
        assert_eq!(transforms[1], Transform::IDENTITY);
    }

    #[test]
    fn turns_come_in_their_order_after_the_scaling_and_before_the_shift() {
        let mut joint = Joint::new("ball", None, Point3::new(1.0, 0.0, 0.0));
        joint.turns = vec![turn(Point3::z(), 90.0), turn(Point3::x(), 90.0)];
        joint.shifts = vec![Shift {
            adjective: 0,
            by: Point3::new(0.0, 0.0, 10.0),
        }];
        joint.scalings = vec![Scaling {
            adjective: 0,
            factors: Point3::new(2.0, 1.0, 1.0),
        }];
        let skeleton = Skeleton::new(vec![joint], 1).expect("a skeleton");
        let moved = skeleton.transforms(&[1.0]).expect("a place")[0].apply(Point3::new(2.0, 0.0, 0.0));
        assert!((moved - Point3::new(1.0, 0.0, 12.0)).norm() < 1e-12, "{moved}");
        assert_eq!(skeleton.transforms(&[0.0]).expect("a place")[0], Transform::IDENTITY);
    }

    #[test]
    fn what_is_wrong_is_named() {
        let wrong = |change: &dyn Fn(&mut Vec<Joint>)| {
            let mut joints = arm();
            change(&mut joints);
            Skeleton::new(joints, 2).expect_err("an error").to_string()
        };
        assert!(wrong(&|joints| joints.clear()).contains("joint"));
        assert!(wrong(&|joints| joints[1].name = "hand".into()).contains("'hand'"));
        assert!(wrong(&|joints| joints[1].parent = Some(0)).contains("circle"));
        assert!(wrong(&|joints| joints[0].parent = Some(7)).contains('7'));
        assert!(wrong(&|joints| joints[0].turns[0].axis = Point3::zeros()).contains("axis"));
        assert!(wrong(&|joints| joints[0].turns[0].adjective = 2).contains('2'));
        assert!(wrong(&|joints| joints[2].origin.y = f64::NAN).contains("'forearm'"));
        let skeleton = Skeleton::new(arm(), 2).expect("a skeleton");
        assert!(skeleton.transforms(&[0.0]).is_err());
        assert!(skeleton.transforms(&[0.0, f64::NAN]).is_err());
        assert!(skeleton.transforms_into(&[0.0, 0.0], &mut []).is_err());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]
        #[test]
        fn local_poses_multiply_to_the_transforms(elbow in -3.0..3.0f64, wrist in -3.0..3.0f64, point in -4.0..4.0f64) {
            let mut joints = arm();
            joints[2].shifts.push(Shift { adjective: 1, by: Point3::new(0.2, -0.1, 0.3) });
            joints[2].scalings.push(Scaling { adjective: 0, factors: Point3::new(1.2, 0.9, 1.0) });
            let skeleton = Skeleton::new(joints, 2).expect("a skeleton");
            let place = [elbow, wrist];
            let transforms = skeleton.transforms(&place).expect("a place");
            let poses = skeleton.local_poses(&place).expect("a place");
            for (index, joint) in skeleton.joints().iter().enumerate() {
                let at = Point3::new(point, 1.0, -2.0);
                let mut carried = at - joint.origin;
                let mut current = Some(index);
                while let Some(of) = current {
                    let LocalPose { translation, rotation, scale } = poses[of];
                    carried = rotation_of(rotation) * carried.component_mul(&scale) + translation;
                    current = skeleton.joints()[of].parent;
                }
                prop_assert!((carried - transforms[index].apply(at)).norm() < 1e-11);
            }
        }
    }
}
