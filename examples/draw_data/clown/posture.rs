//! The skeleton's angles in the two drawings.

use kurbo::{Affine, Point};

use crate::curves::at;

/// The side of the picture that a limb is on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Side {
    Left,
    Right,
}

impl Side {
    pub(super) fn sign(self) -> f64 {
        match self {
            Self::Left => -1.0,
            Self::Right => 1.0,
        }
    }
}

/// Two bones and what hangs on them. Angles in degrees from straight down, outwards positive.
#[derive(Debug, Clone, Copy)]
pub(super) struct LimbAngles {
    pub(super) upper: f64,
    pub(super) lower: f64,
    /// Hand: relative to the forearm, thumb side positive. Foot: toe lifted, from level.
    pub(super) tip: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Mouth {
    Smile,
    Open,
}

/// One drawing of the figure.
#[derive(Debug, Clone, Copy)]
pub(super) struct Posture {
    pub(super) name: &'static str,
    /// Place in pose space.
    pub(super) at: [f64; 2],
    /// Where the middle of the hips is.
    pub(super) hips: Point,
    /// Torso and head, clockwise from upright, degrees. The head's is measured from the picture, not from the torso.
    pub(super) lean_deg: f64,
    pub(super) tilt_deg: f64,
    pub(super) mouth: Mouth,
    pub(super) left_arm: LimbAngles,
    pub(super) right_arm: LimbAngles,
    pub(super) left_leg: LimbAngles,
    pub(super) right_leg: LimbAngles,
}

impl Posture {
    pub(super) fn torso(&self) -> Affine {
        Affine::translate(self.hips.to_vec2()) * Affine::rotate(self.lean_deg.to_radians())
    }

    pub(super) fn head(&self) -> Affine {
        let neck = self.torso() * at(0.0, -146.0);
        Affine::translate(neck.to_vec2()) * Affine::rotate(self.tilt_deg.to_radians())
    }
}

const fn limb(upper: f64, lower: f64, tip: f64) -> LimbAngles {
    LimbAngles { upper, lower, tip }
}

pub(super) fn postures() -> [Posture; 2] {
    let stand = Posture {
        name: "stand",
        at: [0.0, 0.0],
        hips: at(320.0, 500.0),
        lean_deg: 0.0,
        tilt_deg: 0.0,
        mouth: Mouth::Smile,
        left_arm: limb(66.0, 40.0, 0.0),
        right_arm: limb(66.0, 40.0, 0.0),
        left_leg: limb(20.0, 10.0, 0.0),
        right_leg: limb(20.0, 10.0, 0.0),
    };
    let cheer = Posture {
        name: "cheer",
        at: [0.0, 1.0],
        hips: at(300.0, 490.0),
        lean_deg: -6.0,
        tilt_deg: -10.0,
        mouth: Mouth::Open,
        left_arm: limb(88.0, 118.0, 0.0),
        right_arm: limb(96.0, 126.0, 0.0),
        left_leg: limb(6.0, 4.0, 0.0),
        right_leg: limb(66.0, 50.0, 24.0),
    };
    [stand, cheer]
}
