//! How thick the arm is, and its muscles.

use std::f64::consts::{PI, TAU};

use inbetween::math::{Point3, smooth_step};

use super::topology::{CAP_LENGTH, CORNERS, FIRST_STATION, Site, cap_angle_rad};

/// What a form shows.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Build {
    /// 0: female, slim; 1: male, muscular.
    pub(crate) gender: f64,
    pub(crate) shoulder: f64,
    pub(crate) elbow: f64,
}

/// The arm at a station: how far it reaches from the bone towards +y, -y and to both sides, first female, then male.
struct Section {
    station: f64,
    female: [f64; 3],
    male: [f64; 3],
}

const fn section(station: f64, female: [f64; 3], male: [f64; 3]) -> Section {
    Section { station, female, male }
}

const SECTIONS: [Section; 15] = [
    section(-0.25, [0.42, 0.46, 0.44], [0.60, 0.64, 0.60]),
    section(0.2, [0.43, 0.42, 0.43], [0.64, 0.58, 0.62]),
    section(0.7, [0.38, 0.38, 0.38], [0.56, 0.52, 0.54]),
    section(1.2, [0.34, 0.36, 0.34], [0.45, 0.49, 0.44]),
    section(1.8, [0.33, 0.34, 0.32], [0.44, 0.46, 0.42]),
    section(2.4, [0.29, 0.30, 0.29], [0.38, 0.38, 0.38]),
    section(2.8, [0.27, 0.27, 0.28], [0.35, 0.34, 0.37]),
    section(3.1, [0.27, 0.27, 0.29], [0.35, 0.34, 0.39]),
    section(3.5, [0.30, 0.29, 0.31], [0.40, 0.37, 0.43]),
    section(3.9, [0.30, 0.28, 0.30], [0.40, 0.37, 0.42]),
    section(4.5, [0.25, 0.24, 0.24], [0.33, 0.31, 0.33]),
    section(5.1, [0.20, 0.20, 0.175], [0.26, 0.26, 0.24]),
    section(5.45, [0.20, 0.20, 0.155], [0.265, 0.265, 0.21]),
    section(6.0, [0.33, 0.33, 0.15], [0.43, 0.43, 0.20]),
    section(6.5, [0.35, 0.35, 0.12], [0.45, 0.45, 0.155]),
];

/// A swelling on the skin.
struct Muscle {
    /// Its middle along the arm, straight and with the elbow or shoulder bent.
    station: [f64; 2],
    /// Half of its length, straight and bent.
    length: [f64; 2],
    /// Its middle around the arm, in parts of a turn from +y by +z.
    turn: f64,
    /// Half of its width, in parts of a turn.
    width: f64,
    /// Female straight and bent, male straight and bent.
    height: [f64; 4],
    moved_by: Mover,
}

/// What makes a muscle swell.
#[derive(Clone, Copy)]
enum Mover {
    Elbow,
    ShoulderUp,
    ShoulderDown,
}

const MUSCLES: [Muscle; 11] = [
    // Biceps.
    Muscle {
        station: [1.65, 1.68],
        length: [1.15, 0.78],
        turn: 0.0,
        width: 0.21,
        height: [0.02, 0.12, 0.1, 0.38],
        moved_by: Mover::Elbow,
    },
    // Triceps: its long head, and the side one seen from the front.
    Muscle {
        station: [1.25, 1.2],
        length: [0.95, 1.05],
        turn: 0.53,
        width: 0.2,
        height: [0.02, 0.0, 0.13, 0.09],
        moved_by: Mover::Elbow,
    },
    Muscle {
        station: [1.1, 1.1],
        length: [0.75, 0.75],
        turn: 0.36,
        width: 0.12,
        height: [0.0, 0.0, 0.06, 0.04],
        moved_by: Mover::Elbow,
    },
    // Deltoid, above and in front; it bulges where the arm is raised.
    Muscle {
        station: [0.3, 0.5],
        length: [0.75, 0.65],
        turn: 0.08,
        width: 0.26,
        height: [0.02, 0.05, 0.1, 0.13],
        moved_by: Mover::ShoulderUp,
    },
    // What is drawn out above where the arm hangs down, and pressed together below.
    Muscle {
        station: [-0.1, -0.1],
        length: [0.6, 0.7],
        turn: 0.0,
        width: 0.3,
        height: [0.0, 0.03, 0.0, 0.05],
        moved_by: Mover::ShoulderDown,
    },
    Muscle {
        station: [0.5, 0.5],
        length: [0.7, 0.6],
        turn: 0.5,
        width: 0.22,
        height: [0.0, -0.04, 0.02, -0.06],
        moved_by: Mover::ShoulderDown,
    },
    // Brachioradialis.
    Muscle {
        station: [3.35, 3.45],
        length: [1.0, 0.8],
        turn: 0.1,
        width: 0.2,
        height: [0.015, 0.03, 0.06, 0.1],
        moved_by: Mover::Elbow,
    },
    // Flexors below the forearm.
    Muscle {
        station: [3.65, 3.6],
        length: [1.0, 0.85],
        turn: 0.45,
        width: 0.2,
        height: [0.01, 0.02, 0.05, 0.07],
        moved_by: Mover::Elbow,
    },
    // The point of the elbow.
    Muscle {
        station: [3.02, 2.98],
        length: [0.25, 0.42],
        turn: 0.5,
        width: 0.17,
        height: [0.01, 0.13, 0.02, 0.18],
        moved_by: Mover::Elbow,
    },
    // The fold inside the elbow.
    Muscle {
        station: [3.0, 3.0],
        length: [0.5, 0.5],
        turn: 0.0,
        width: 0.25,
        height: [0.0, -0.04, -0.01, -0.05],
        moved_by: Mover::Elbow,
    },
    // The bone beside the wrist.
    Muscle {
        station: [5.3, 5.3],
        length: [0.2, 0.2],
        turn: 0.38,
        width: 0.12,
        height: [0.025, 0.025, 0.03, 0.03],
        moved_by: Mover::Elbow,
    },
];

/// Where the fingers' edges are on the hand's broad side, corner by corner from +y to -y, as fractions of half its breadth.
const HAND_ACROSS: [f64; 11] = [1.0, 0.93, 0.74, 0.5, 0.25, 0.0, -0.25, -0.5, -0.74, -0.93, -1.0];
/// How far the corners reach to the sides, as fractions of half the hand's thickness.
const HAND_ASIDE: [f64; 11] = [0.0, 0.7, 1.0, 0.93, 1.0, 0.93, 1.0, 0.93, 1.0, 0.7, 0.0];

impl Build {
    /// Where a vertex of the straight arm is.
    pub(crate) fn place(&self, site: &Site) -> Point3 {
        match *site {
            Site::ShoulderPoint => Point3::new(FIRST_STATION - CAP_LENGTH, -0.02, 0.0),
            Site::Cap { ring, corner } => {
                let (sin, cos) = libm::sincos(cap_angle_rad(ring));
                let edge = self.on_ring(FIRST_STATION, corner);
                Point3::new(FIRST_STATION - CAP_LENGTH * cos, edge.y * sin, edge.z * sin)
            }
            Site::Ring { station, corner } => self.on_ring(station, corner),
            Site::Web(web) => self.web(web),
            Site::Finger { finger, ring, corner } => self.on_finger(finger, ring, corner),
            Site::FingerTip(finger) => self.finger_tip(finger),
            Site::Thumb { ring, corner } => self.on_thumb(ring, corner),
            Site::ThumbTip => self.thumb_tip(),
        }
    }

    /// A number between the female and the male one.
    pub(crate) fn between(&self, female: f64, male: f64) -> f64 {
        female + self.gender * (male - female)
    }

    pub(crate) fn on_ring(&self, station: f64, corner: usize) -> Point3 {
        let turn = corner as f64 / CORNERS as f64;
        let (sin, cos) = libm::sincos(TAU * turn);
        let [up, down, aside] = self.section(station);
        let height = if cos >= 0.0 { up } else { down };
        let swelling: f64 = MUSCLES.iter().map(|muscle| self.swelling(muscle, station, turn)).sum();
        let round = Point3::new(0.0, cos * (height + swelling), sin * (aside + swelling));

        let half = corner.min(CORNERS - corner);
        let side = if corner > CORNERS / 2 { -1.0 } else { 1.0 };
        let flat = Point3::new(0.0, HAND_ACROSS[half] * up, HAND_ASIDE[half] * aside * side);
        let share = smooth_step(station, 5.35, 6.1);
        round * (1.0 - share) + flat * share + Point3::x() * station
    }

    /// The three radii at a station, on a smooth curve through [`SECTIONS`].
    pub(crate) fn section(&self, station: f64) -> [f64; 3] {
        let after = SECTIONS
            .iter()
            .position(|section| section.station > station)
            .unwrap_or(SECTIONS.len() - 1)
            .max(1);
        let at = |index: usize| &SECTIONS[index.min(SECTIONS.len() - 1)];
        let [before, from, to, next] = [after.saturating_sub(2), after - 1, after, after + 1].map(at);
        let length = to.station - from.station;
        let t = ((station - from.station) / length).clamp(0.0, 1.0);
        [0, 1, 2].map(|which| {
            let value = |section: &Section| self.between(section.female[which], section.male[which]);
            let slope = |a: &Section, b: &Section| (value(b) - value(a)) / (b.station - a.station).max(1e-9);
            // A cubic through both ends with the slopes of their neighbours.
            let (start, end) = (slope(before, to) * length, slope(from, next) * length);
            let (s, squared, cubed) = (1.0 - t, t * t, t * t * t);
            value(from) * (1.0 + 2.0 * t) * s * s
                + value(to) * (3.0 * squared - 2.0 * cubed)
                + start * t * s * s
                + end * (cubed - squared)
        })
    }

    /// How much a muscle adds to the radius.
    fn swelling(&self, muscle: &Muscle, station: f64, turn: f64) -> f64 {
        let bent = match muscle.moved_by {
            Mover::Elbow => self.elbow,
            Mover::ShoulderUp => self.shoulder.max(0.0),
            Mover::ShoulderDown => (-self.shoulder).max(0.0),
        };
        let mix = |pair: [f64; 2]| pair[0] + bent * (pair[1] - pair[0]);
        let [female, female_bent, male, male_bent] = muscle.height;
        let height = self.between(mix([female, female_bent]), mix([male, male_bent]));
        let along = (station - mix(muscle.station)) / mix(muscle.length);
        let around = (turn - muscle.turn - (turn - muscle.turn).round()) / muscle.width;
        height * hill(along) * hill(around)
    }
}

/// 1 in the middle, 0 from -1 down and from 1 up, smooth.
fn hill(at: f64) -> f64 {
    if at.abs() < 1.0 {
        0.5 + 0.5 * libm::cos(PI * at)
    } else {
        0.0
    }
}
