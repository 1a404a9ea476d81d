//! How the bear is posed in each drawing.

use kurbo::Vec2;

/// Two bones of an arm, degrees from straight down, outwards positive.
#[derive(Debug, Clone, Copy)]
pub(super) struct ArmAngles {
    pub(super) upper: f64,
    pub(super) lower: f64,
}

pub(super) const fn arm(upper: f64, lower: f64) -> ArmAngles {
    ArmAngles { upper, lower }
}

/// How the bear is posed in one drawing.
#[derive(Debug, Clone, Copy)]
pub(super) struct Attitude {
    pub(super) name: &'static str,
    /// Place in pose space.
    pub(super) at: [f64; 2],
    /// How far the hips are moved from where they are when it stands.
    pub(super) hips: Vec2,
    /// Of the back, and of the head against the picture, clockwise from upright, degrees.
    pub(super) lean_deg: f64,
    pub(super) tilt_deg: f64,
    /// How far the head sinks towards the chest.
    pub(super) nod: f64,
    /// Where on the head the face is.
    pub(super) look: Vec2,
    /// 0 closed, 1 open.
    pub(super) eyes: f64,
    /// 0 closed, 1 laughing.
    pub(super) mouth: f64,
    /// The arm that moves, on the picture's left.
    pub(super) near: ArmAngles,
    pub(super) far: ArmAngles,
    /// The flower's direction, clockwise from upright, and how far its stem bends on the way, degrees.
    pub(super) flower: Option<(f64, f64)>,
    pub(super) order: &'static [&'static str],
}

pub(super) const REST: Attitude = Attitude {
    name: "rest",
    at: [0.0, 0.0],
    hips: Vec2::ZERO,
    lean_deg: 0.0,
    tilt_deg: 0.0,
    nod: 0.0,
    look: Vec2::ZERO,
    eyes: 1.0,
    mouth: 0.1,
    near: arm(24.0, 10.0),
    far: arm(24.0, 10.0),
    flower: None,
    order: &[],
};

pub(super) const ATTITUDES: [Attitude; 6] = [
    REST,
    Attitude {
        name: "heart",
        at: [1.0, 0.0],
        hips: Vec2::new(3.0, 0.0),
        lean_deg: -3.0,
        tilt_deg: 9.0,
        nod: 6.0,
        look: Vec2::new(8.0, 4.0),
        eyes: 0.0,
        mouth: 0.1,
        near: arm(7.0, -101.0),
        far: arm(28.0, 18.0),
        ..REST
    },
    Attitude {
        name: "bow",
        at: [0.6, -1.0],
        hips: Vec2::new(-46.0, 8.0),
        lean_deg: 17.0,
        tilt_deg: 27.0,
        nod: 34.0,
        look: Vec2::new(10.0, 24.0),
        eyes: 0.0,
        mouth: 0.1,
        near: arm(-8.0, -86.0),
        far: arm(46.0, 64.0),
        ..REST
    },
    Attitude {
        name: "behind",
        at: [-1.0, 0.0],
        hips: Vec2::new(-2.0, 0.0),
        lean_deg: 3.0,
        tilt_deg: -7.0,
        nod: 4.0,
        look: Vec2::new(14.0, -4.0),
        mouth: 0.0,
        near: arm(34.0, -50.0),
        far: arm(20.0, 6.0),
        flower: Some((22.0, 0.0)),
        order: &["far_arm", "flower", "arm", "body"],
        ..REST
    },
    Attitude {
        name: "wave",
        at: [-0.6, 1.0],
        hips: Vec2::new(5.0, 0.0),
        lean_deg: -4.0,
        tilt_deg: -10.0,
        look: Vec2::new(-12.0, -6.0),
        mouth: 1.0,
        near: arm(120.0, 166.0),
        far: arm(34.0, 26.0),
        flower: Some((6.0, -12.0)),
        order: &["far_arm", "body", "flower", "arm"],
        ..REST
    },
    Attitude {
        name: "offer",
        at: [0.6, 1.0],
        hips: Vec2::new(-4.0, 0.0),
        lean_deg: 5.0,
        tilt_deg: 6.0,
        nod: 3.0,
        look: Vec2::new(16.0, 4.0),
        mouth: 0.5,
        near: arm(-34.0, -100.0),
        far: arm(22.0, 4.0),
        flower: Some((34.0, 18.0)),
        order: &["far_arm", "body", "flower", "arm"],
        ..REST
    },
];
