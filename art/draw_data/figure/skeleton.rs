//! The skeleton: its measures, how it is posed, and its parts placed in the picture.

use kurbo::{Affine, BezPath, Circle, Point, Shape, Vec2};

use crate::curves::{Limb, at, hanging, right_of};

/// Shares of the shorter bone that the bends of knee and elbow take.
const KNEE_ROUNDNESS: f64 = 0.7;
const ELBOW_ROUNDNESS: f64 = 0.75;

/// The side of the picture that a limb is on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Side {
    Left,
    Right,
}

impl Side {
    pub(crate) const BOTH: [Self; 2] = [Self::Left, Self::Right];

    pub(crate) fn sign(self) -> f64 {
        match self {
            Self::Left => -1.0,
            Self::Right => 1.0,
        }
    }

    /// A point on this side from its place on the right side.
    pub(crate) fn at(self, x: f64, y: f64) -> Point {
        at(x * self.sign(), y)
    }

    /// The name of a part on this side.
    pub(crate) fn named(self, part: &str) -> String {
        match self {
            Self::Left => format!("left_{part}"),
            Self::Right => format!("right_{part}"),
        }
    }
}

/// Two bones and what hangs on them. Angles in degrees from straight down, outwards positive.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LimbAngles {
    pub(crate) upper: f64,
    pub(crate) lower: f64,
    /// Hand: relative to the forearm, thumb side positive. Foot: toe lifted, from level.
    pub(crate) tip: f64,
}

pub(crate) const fn limb(upper: f64, lower: f64, tip: f64) -> LimbAngles {
    LimbAngles { upper, lower, tip }
}

/// How a leg is posed.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Stance {
    /// The ankle is there and the shoe stands level; the knee gives way outwards.
    Planted(Point),
    /// The bones have these angles.
    Free(LimbAngles),
}

#[derive(Debug, Clone, Copy)]
pub(crate) enum Mouth {
    Smile,
    Open,
}

/// How the skeleton is posed in one drawing.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Attitude {
    pub(crate) name: &'static str,
    /// Place in pose space.
    pub(crate) at: [f64; 2],
    /// Where the middle of the hips is.
    pub(crate) hips: Point,
    /// Torso and head, clockwise from upright, degrees. The head's is measured from the picture, not from the torso.
    pub(crate) lean_deg: f64,
    pub(crate) tilt_deg: f64,
    pub(crate) mouth: Mouth,
    /// Left, right.
    pub(crate) arms: [LimbAngles; 2],
    /// Left, right.
    pub(crate) legs: [Stance; 2],
}

/// The two bones of a limb and what is around them, pixels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bones {
    pub(crate) upper: f64,
    pub(crate) lower: f64,
    /// At the root, the bend and the end.
    pub(crate) half_widths: [f64; 3],
}

/// The measures of a skeleton, pixels; of limbs, those on the right.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Build {
    /// From the middle of the hips, in the torso's coordinates.
    pub(crate) neck: Point,
    pub(crate) shoulder: Point,
    /// From the middle of the hips, in the picture's directions.
    pub(crate) hip: Vec2,
    pub(crate) arm: Bones,
    pub(crate) leg: Bones,
    /// The point of a leg, along it, whose direction from the hip says where the legs part.
    pub(crate) mid_thigh: f64,
}

/// A leg, placed.
#[derive(Debug)]
pub(crate) struct Leg {
    pub(crate) side: Side,
    pub(crate) limb: Limb,
    /// The round of the hip.
    pub(crate) hip: Circle,
    pub(crate) ankle: Point,
    /// Direction from the knee to the ankle.
    pub(crate) shin: Vec2,
    /// Drawn for the right side; on the left it is mirrored.
    pub(crate) foot: Affine,
}

impl Leg {
    fn new(build: &Build, hips: Point, side: Side, stance: Stance) -> Self {
        let (sign, bones) = (side.sign(), &build.leg);
        let hip = hips + Vec2::new(build.hip.x * sign, build.hip.y);
        let (knee, ankle, shin, toe_lift_deg) = match stance {
            Stance::Planted(ankle) => {
                let knee = bones.bend_between(hip, ankle, sign);
                (knee, ankle, (ankle - knee).normalize(), 0.0)
            }
            Stance::Free(angles) => {
                let ([knee, ankle], shin) = bones.hang(hip, sign, angles);
                (knee, ankle, shin, angles.tip)
            }
        };
        Self {
            side,
            limb: Limb::new([hip, knee, ankle], bones.half_widths, KNEE_ROUNDNESS),
            hip: Circle::new(hip, bones.half_widths[0]),
            ankle,
            shin,
            foot: Affine::translate(ankle.to_vec2())
                * Affine::scale_non_uniform(sign, 1.0)
                * Affine::rotate(-toe_lift_deg.to_radians()),
        }
    }

    /// What is drawn for it without the shoe: the limb, and the round of the hip.
    pub(crate) fn parts(&self) -> [BezPath; 2] {
        [self.limb.body(), self.hip.to_path(0.05)]
    }
}

/// An arm, placed.
#[derive(Debug)]
pub(crate) struct Arm {
    pub(crate) side: Side,
    pub(crate) limb: Limb,
    /// The round of the shoulder.
    pub(crate) shoulder: Circle,
    /// The x axis continues the forearm, the y axis points to the thumb.
    pub(crate) hand: Affine,
}

impl Arm {
    fn new(build: &Build, torso: Affine, side: Side, angles: LimbAngles) -> Self {
        let (sign, bones) = (side.sign(), &build.arm);
        let shoulder = torso * side.at(build.shoulder.x, build.shoulder.y);
        let ([elbow, wrist], forearm) = bones.hang(shoulder, sign, angles);
        Self {
            side,
            limb: Limb::new([shoulder, elbow, wrist], bones.half_widths, ELBOW_ROUNDNESS),
            shoulder: Circle::new(shoulder, bones.half_widths[0]),
            hand: Affine::translate(wrist.to_vec2())
                * Affine::rotate(forearm.atan2())
                * Affine::scale_non_uniform(1.0, -sign)
                * Affine::rotate(angles.tip.to_radians()),
        }
    }

    /// What is drawn for it without the hand: the limb, and the round of the shoulder.
    pub(crate) fn parts(&self) -> [BezPath; 2] {
        [self.limb.body(), self.shoulder.to_path(0.05)]
    }
}

impl Bones {
    /// Where bend and end are with these angles, and the direction of the lower bone.
    fn hang(&self, root: Point, sign: f64, angles: LimbAngles) -> ([Point; 2], Vec2) {
        let bend = root + hanging(sign * angles.upper) * self.upper;
        let lower = hanging(sign * angles.lower);
        ([bend, bend + lower * self.lower], lower)
    }

    /// The bend of a limb from `root` to `end`, towards `sign`.
    fn bend_between(&self, root: Point, end: Point, sign: f64) -> Point {
        let reach = end - root;
        let distance = reach.hypot().min(self.upper + self.lower);
        let along = (distance * distance + self.upper * self.upper - self.lower * self.lower) / (2.0 * distance);
        let across = (self.upper * self.upper - along * along).max(0.0).sqrt();
        let direction = reach.normalize();
        root + direction * along - right_of(direction) * (across * sign)
    }
}

/// The parts of a figure, placed.
#[derive(Debug)]
pub(crate) struct Skeleton {
    pub(crate) torso: Affine,
    pub(crate) head: Affine,
    /// Left, right.
    pub(crate) legs: [Leg; 2],
    /// Left, right.
    pub(crate) arms: [Arm; 2],
}

impl Skeleton {
    pub(crate) fn new(build: &Build, attitude: &Attitude) -> Self {
        let torso = Affine::translate(attitude.hips.to_vec2()) * Affine::rotate(attitude.lean_deg.to_radians());
        let neck = torso * build.neck;
        let ([left_arm, right_arm], [left_leg, right_leg]) = (attitude.arms, attitude.legs);
        Self {
            torso,
            head: Affine::translate(neck.to_vec2()) * Affine::rotate(attitude.tilt_deg.to_radians()),
            legs: [
                Leg::new(build, attitude.hips, Side::Left, left_leg),
                Leg::new(build, attitude.hips, Side::Right, right_leg),
            ],
            arms: [
                Arm::new(build, torso, Side::Left, left_arm),
                Arm::new(build, torso, Side::Right, right_arm),
            ],
        }
    }

    pub(crate) fn arm(&self, side: Side) -> &Arm {
        &self.arms[side as usize]
    }

    pub(crate) fn leg(&self, side: Side) -> &Leg {
        &self.legs[side as usize]
    }
}
