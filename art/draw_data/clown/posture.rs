//! The skeleton's measures, and its angles in the two drawings.

use kurbo::{Point, Vec2};

use crate::curves::at;
use crate::figure::{Attitude, Bones, Build, Mouth, Stance, limb};

pub(super) const BUILD: Build = Build {
    neck: Point::new(0.0, -146.0),
    shoulder: Point::new(48.0, -116.0),
    hip: Vec2::new(36.0, 6.0),
    arm: Bones {
        upper: 72.0,
        lower: 66.0,
        half_widths: [25.0, 24.0, 26.0],
    },
    leg: Bones {
        upper: 70.0,
        lower: 74.0,
        half_widths: [36.0, 33.0, 31.0],
    },
    mid_thigh: 0.5,
};

/// Standing and cheering.
pub(super) fn attitudes() -> [Attitude; 2] {
    let stand = Attitude {
        name: "stand",
        at: [0.0, 0.0],
        hips: at(320.0, 500.0),
        lean_deg: 0.0,
        tilt_deg: 0.0,
        mouth: Mouth::Smile,
        arms: [limb(66.0, 40.0, 0.0); 2],
        legs: [Stance::Free(limb(20.0, 10.0, 0.0)); 2],
    };
    let cheer = Attitude {
        name: "cheer",
        at: [0.0, 1.0],
        hips: at(300.0, 490.0),
        lean_deg: -6.0,
        tilt_deg: -10.0,
        mouth: Mouth::Open,
        arms: [limb(88.0, 118.0, 0.0), limb(96.0, 126.0, 0.0)],
        legs: [Stance::Free(limb(6.0, 4.0, 0.0)), Stance::Free(limb(66.0, 50.0, 24.0))],
    };
    [stand, cheer]
}
