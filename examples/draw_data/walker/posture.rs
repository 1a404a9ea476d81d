//! The skeleton's angles in the five poses.

use kurbo::{Affine, Point, Vec2};

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

/// How a leg is posed.
#[derive(Debug, Clone, Copy)]
pub(super) enum Stance {
    /// The shoe stands where it stands in the upright pose; the knee gives way outwards.
    Planted,
    /// The leg is in the air.
    Free(LimbAngles),
}

/// Two bones and what hangs on them. Angles in degrees from straight down, outwards positive.
#[derive(Debug, Clone, Copy)]
pub(super) struct LimbAngles {
    pub(super) upper: f64,
    pub(super) lower: f64,
    /// Hand: relative to the forearm, thumb side positive. Foot: toe lifted, from level.
    pub(super) tip: f64,
}

#[derive(Debug, Clone, Copy)]
pub(super) enum Mouth {
    Smile,
    Open,
}

impl Mouth {
    /// How high the middles of its upper and lower line lie, in the head's coordinates.
    pub(super) fn lips(self) -> [f64; 2] {
        match self {
            Self::Smile => [-21.0, -14.0],
            Self::Open => [-29.0, -6.0],
        }
    }
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
    /// How far the cap's tip flops to the right, degrees from upright.
    pub(super) flop_deg: f64,
    /// Where the eyes look, pixels.
    pub(super) look: Vec2,
    pub(super) mouth: Mouth,
    pub(super) left_arm: LimbAngles,
    pub(super) right_arm: LimbAngles,
    pub(super) left_leg: Stance,
    pub(super) right_leg: Stance,
}

impl Posture {
    pub(super) fn torso(&self) -> Affine {
        Affine::translate(self.hips.to_vec2()) * Affine::rotate(self.lean_deg.to_radians())
    }

    pub(super) fn head(&self) -> Affine {
        let neck = self.torso() * at(0.0, -150.0);
        Affine::translate(neck.to_vec2()) * Affine::rotate(self.tilt_deg.to_radians())
    }
}

const fn limb(upper: f64, lower: f64, tip: f64) -> LimbAngles {
    LimbAngles { upper, lower, tip }
}

pub(super) fn postures() -> [Posture; 5] {
    let stand = Posture {
        name: "stand",
        at: [0.0, 0.0],
        hips: at(320.0, 486.0),
        lean_deg: 0.0,
        tilt_deg: -2.0,
        flop_deg: 58.0,
        look: Vec2::new(0.0, 0.0),
        mouth: Mouth::Smile,
        left_arm: limb(58.0, 26.0, 0.0),
        right_arm: limb(58.0, 26.0, 0.0),
        left_leg: Stance::Planted,
        right_leg: Stance::Planted,
    };
    let stride_left = Posture {
        name: "stride_left",
        at: [-1.0, 0.0],
        hips: at(346.0, 484.0),
        lean_deg: 5.0,
        tilt_deg: -4.0,
        flop_deg: 74.0,
        look: Vec2::new(-3.0, 0.0),
        left_arm: limb(72.0, 52.0, 6.0),
        right_arm: limb(58.0, 108.0, 4.0),
        left_leg: Stance::Free(limb(56.0, 8.0, 14.0)),
        ..stand
    };
    let stride_right = Posture {
        name: "stride_right",
        at: [1.0, 0.0],
        hips: at(294.0, 484.0),
        lean_deg: -5.0,
        tilt_deg: 4.0,
        flop_deg: 36.0,
        look: Vec2::new(3.0, 0.0),
        left_arm: stride_left.right_arm,
        right_arm: stride_left.left_arm,
        right_leg: stride_left.left_leg,
        ..stand
    };
    let jump = Posture {
        name: "jump",
        at: [0.0, 1.0],
        hips: at(320.0, 420.0),
        tilt_deg: 2.0,
        flop_deg: 22.0,
        look: Vec2::new(0.0, -3.0),
        mouth: Mouth::Open,
        left_arm: limb(96.0, 138.0, 0.0),
        right_arm: limb(96.0, 138.0, 0.0),
        left_leg: Stance::Free(limb(58.0, 6.0, -16.0)),
        right_leg: Stance::Free(limb(58.0, 6.0, -16.0)),
        ..stand
    };
    let wave = Posture {
        name: "wave",
        at: [0.0, -1.0],
        hips: at(306.0, 488.0),
        lean_deg: -4.0,
        tilt_deg: -7.0,
        flop_deg: 62.0,
        look: Vec2::new(2.0, -1.0),
        mouth: Mouth::Open,
        left_arm: limb(60.0, 30.0, 0.0),
        right_arm: limb(92.0, 140.0, 8.0),
        ..stand
    };
    [stand, stride_left, stride_right, jump, wave]
}
