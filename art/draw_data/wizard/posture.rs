//! The skeleton's measures, its angles in the three poses, where the loose things are, and how each sheet lies on the glass.

use kurbo::{Point, Vec2};

use crate::curves::at;
use crate::figure::{Attitude, Bones, Build, Mouth, Stance, limb};
use crate::scan::Sheet;

pub(super) const BUILD: Build = Build {
    neck: Point::new(0.0, -140.0),
    shoulder: Point::new(44.0, -110.0),
    hip: Vec2::new(30.0, 6.0),
    arm: Bones {
        upper: 68.0,
        lower: 64.0,
        half_widths: [22.0, 20.0, 27.0],
    },
    leg: Bones {
        upper: 60.0,
        lower: 60.0,
        half_widths: [26.0, 23.0, 21.0],
    },
    mid_thigh: 0.4,
};

/// One drawing of the figure.
#[derive(Debug, Clone, Copy)]
pub(super) struct Posture {
    pub(super) body: Attitude,
    /// Where the eyes look, pixels.
    pub(super) look: Vec2,
    /// How far the brows are raised, pixels.
    pub(super) brows: f64,
    /// How high the hat floats over the hair, pixels, and how far it is turned to the right, degrees.
    pub(super) hat: (f64, f64),
    /// Places of the sparks around the tip of the wand, and their sizes, pixels.
    pub(super) sparks: [(Vec2, f64); 3],
    /// Whether there is a drop of sweat.
    pub(super) sweats: bool,
    /// The paper that it is drawn on.
    pub(super) sheet: Sheet,
}

pub(super) fn postures() -> [Posture; 3] {
    let wait = Posture {
        body: Attitude {
            name: "wait",
            at: [0.0, 0.0],
            hips: at(310.0, 528.0),
            lean_deg: 0.0,
            tilt_deg: 3.0,
            mouth: Mouth::Smile,
            arms: [limb(54.0, 26.0, 0.0), limb(60.0, 74.0, 0.0)],
            legs: [Stance::Free(limb(14.0, 4.0, 0.0)); 2],
        },
        look: Vec2::new(3.0, 0.0),
        brows: 0.0,
        hat: (52.0, 6.0),
        sparks: [
            (Vec2::new(2.0, -57.0), 22.0),
            (Vec2::new(46.0, -27.0), 16.0),
            (Vec2::new(-38.0, -39.0), 12.0),
        ],
        sweats: false,
        sheet: Sheet {
            tilt_deg: -1.1,
            shift: Vec2::new(2.0, -3.0),
            seed: 0x1001,
        },
    };
    let conjure = Posture {
        body: Attitude {
            name: "conjure",
            at: [1.0, 0.0],
            hips: at(300.0, 528.0),
            lean_deg: 5.0,
            tilt_deg: 9.0,
            mouth: Mouth::Open,
            arms: [limb(74.0, 100.0, 6.0), limb(84.0, 112.0, 0.0)],
            legs: [Stance::Free(limb(36.0, 14.0, 0.0)), Stance::Free(limb(20.0, 2.0, 0.0))],
        },
        look: Vec2::new(5.0, -4.0),
        brows: 2.0,
        hat: (62.0, 12.0),
        sparks: [
            (Vec2::new(6.0, -63.0), 26.0),
            (Vec2::new(54.0, -29.0), 20.0),
            (Vec2::new(-42.0, -43.0), 15.0),
        ],
        sheet: Sheet {
            tilt_deg: 1.6,
            shift: Vec2::new(-4.0, 2.0),
            seed: 0x2002,
        },
        ..wait
    };
    let startle = Posture {
        body: Attitude {
            name: "startle",
            at: [0.5, 0.9],
            hips: at(316.0, 498.0),
            lean_deg: -4.0,
            tilt_deg: -8.0,
            mouth: Mouth::Open,
            arms: [limb(100.0, 132.0, 0.0), limb(80.0, 96.0, -8.0)],
            legs: [
                Stance::Free(limb(46.0, 10.0, -8.0)),
                Stance::Free(limb(52.0, 20.0, -4.0)),
            ],
        },
        look: Vec2::new(4.0, 2.0),
        brows: 4.0,
        hat: (76.0, -10.0),
        sparks: [
            (Vec2::new(10.0, -61.0), 22.0),
            (Vec2::new(54.0, -19.0), 17.0),
            (Vec2::new(-36.0, -47.0), 13.0),
        ],
        sweats: true,
        sheet: Sheet {
            tilt_deg: -0.5,
            shift: Vec2::new(1.0, 4.0),
            seed: 0x3003,
        },
    };
    [wait, conjure, startle]
}
