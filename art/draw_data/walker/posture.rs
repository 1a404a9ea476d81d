//! The skeleton's measures, and its angles in the five poses.

use kurbo::{Point, Vec2};

use crate::curves::at;
use crate::figure::{Attitude, Bones, Build, Mouth, Side, Stance, WIDTH_PX, limb};

/// Where the soles stand.
const GROUND_PX: f64 = 684.0;

pub(super) const BUILD: Build = Build {
    neck: Point::new(0.0, -150.0),
    shoulder: Point::new(44.0, -122.0),
    hip: Vec2::new(31.0, 4.0),
    arm: Bones {
        upper: 74.0,
        lower: 70.0,
        half_widths: [24.0, 20.0, 19.0],
    },
    leg: Bones {
        upper: 82.0,
        lower: 78.0,
        half_widths: [28.0, 23.0, 22.0],
    },
    mid_thigh: 0.4,
};

/// One drawing of the figure.
#[derive(Debug, Clone, Copy)]
pub(super) struct Posture {
    pub(super) body: Attitude,
    /// How far the cap's tip flops to the right, degrees from upright.
    pub(super) flop_deg: f64,
    /// Where the eyes look, pixels.
    pub(super) look: Vec2,
}

/// Both shoes where they stand in the upright pose.
fn planted() -> [Stance; 2] {
    let middle = at(0.5 * f64::from(WIDTH_PX), GROUND_PX - 40.0);
    Side::BOTH.map(|side| Stance::Planted(middle + side.at(62.0, 0.0).to_vec2()))
}

pub(super) fn postures() -> [Posture; 5] {
    let stand = Posture {
        body: Attitude {
            name: "stand",
            at: [0.0, 0.0],
            hips: at(320.0, 486.0),
            lean_deg: 0.0,
            tilt_deg: -2.0,
            mouth: Mouth::Smile,
            arms: [limb(58.0, 26.0, 0.0); 2],
            legs: planted(),
        },
        flop_deg: 58.0,
        look: Vec2::new(0.0, 0.0),
    };
    let stride_left = Posture {
        body: Attitude {
            name: "stride_left",
            at: [-1.0, 0.0],
            hips: at(346.0, 484.0),
            lean_deg: 5.0,
            tilt_deg: -4.0,
            arms: [limb(72.0, 52.0, 6.0), limb(58.0, 108.0, 4.0)],
            legs: [Stance::Free(limb(56.0, 8.0, 14.0)), stand.body.legs[1]],
            ..stand.body
        },
        flop_deg: 74.0,
        look: Vec2::new(-3.0, 0.0),
    };
    let stride_right = Posture {
        body: Attitude {
            name: "stride_right",
            at: [1.0, 0.0],
            hips: at(294.0, 484.0),
            lean_deg: -5.0,
            tilt_deg: 4.0,
            arms: [stride_left.body.arms[1], stride_left.body.arms[0]],
            legs: [stand.body.legs[0], stride_left.body.legs[0]],
            ..stand.body
        },
        flop_deg: 36.0,
        look: Vec2::new(3.0, 0.0),
    };
    let jump = Posture {
        body: Attitude {
            name: "jump",
            at: [0.0, 1.0],
            hips: at(320.0, 420.0),
            tilt_deg: 2.0,
            mouth: Mouth::Open,
            arms: [limb(96.0, 138.0, 0.0); 2],
            legs: [Stance::Free(limb(58.0, 6.0, -16.0)); 2],
            ..stand.body
        },
        flop_deg: 22.0,
        look: Vec2::new(0.0, -3.0),
    };
    let wave = Posture {
        body: Attitude {
            name: "wave",
            at: [0.0, -1.0],
            hips: at(306.0, 488.0),
            lean_deg: -4.0,
            tilt_deg: -7.0,
            mouth: Mouth::Open,
            arms: [limb(60.0, 30.0, 0.0), limb(92.0, 140.0, 8.0)],
            ..stand.body
        },
        flop_deg: 62.0,
        look: Vec2::new(2.0, -1.0),
    };
    [stand, stride_left, stride_right, jump, wave]
}
