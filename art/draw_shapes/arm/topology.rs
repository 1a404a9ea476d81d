//! Vertices and faces of the arm, the same in every example.
//!
//! The corners of a ring are counted from +y (the thumb's side) by +z (the back of the hand) to -y and back. The last ring is at
//! the knuckles; two corners and a web between fingers on either side, and three between, are the root of a finger. The thumb
//! grows out of four quadrangles on the hand's upper edge, whose middle vertex becomes its tip.

use std::f64::consts::TAU;

use crate::object::Polygons;

pub(crate) const CORNERS: usize = 20;
pub(crate) const FINGER_CORNERS: usize = 8;
/// Where the rings of a finger are, as fractions of its length.
pub(crate) const FINGER_RINGS: [f64; 8] = [0.1, 0.22, 0.35, 0.46, 0.6, 0.7, 0.84, 0.95];
pub(crate) const THUMB_RINGS: [f64; 5] = [0.34, 0.47, 0.61, 0.79, 0.94];
/// Rings that close the shoulder, beside the point in the middle.
pub(crate) const CAP_RINGS: usize = 5;
/// Where the first ring of the arm proper is.
pub(crate) const FIRST_STATION: f64 = -0.25;
/// How far the shoulder goes on before it.
pub(crate) const CAP_LENGTH: f64 = 0.7;
const ARM_RINGS: usize = 39;
const RING_SPACING: f64 = 0.15;
const HAND_STATIONS: [f64; 6] = [5.6, 5.78, 5.96, 6.14, 6.32, 6.5];
pub(crate) const KNUCKLES: f64 = 6.5;
/// The first of the rings that the thumb grows out of, by its number in the hand.
const THUMB_ROOT: usize = 0;

/// Where a ring that closes the shoulder is on a quarter of a circle.
pub(crate) fn cap_angle_rad(ring: usize) -> f64 {
    0.25 * TAU * ring as f64 / (CAP_RINGS + 1) as f64
}

/// What a vertex is.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Site {
    /// The middle of the shoulder's cut.
    ShoulderPoint,
    /// A corner of a ring that closes the shoulder.
    Cap { ring: usize, corner: usize },
    /// A corner of a ring around the arm or the hand.
    Ring { station: f64, corner: usize },
    /// Between two fingers; 0 is beside the index finger.
    Web(usize),
    /// A corner of a ring around a finger.
    Finger { finger: usize, ring: usize, corner: usize },
    /// The end of a finger.
    FingerTip(usize),
    /// A corner of a ring around the thumb.
    Thumb { ring: usize, corner: usize },
    /// The end of the thumb.
    ThumbTip,
}

impl Site {
    /// Where along the arm its cross-section is, for the skin; anything beyond the wrist is the hand.
    pub(crate) fn station(&self) -> f64 {
        match *self {
            Self::ShoulderPoint => FIRST_STATION - CAP_LENGTH,
            Self::Cap { ring, .. } => FIRST_STATION - CAP_LENGTH * libm::cos(cap_angle_rad(ring)),
            Self::Ring { station, .. } => station,
            Self::Thumb { .. } | Self::ThumbTip => HAND_STATIONS[THUMB_ROOT + 1],
            Self::Web(_) | Self::Finger { .. } | Self::FingerTip(_) => KNUCKLES,
        }
    }
}

pub(crate) struct Topology {
    pub(crate) sites: Vec<Site>,
    pub(crate) faces: Vec<Vec<usize>>,
}

pub(crate) fn arm() -> Topology {
    let mut polygons = Polygons::default();
    let mut sites = Vec::new();

    let point = polygons.add(1)[0];
    sites.push(Site::ShoulderPoint);
    let mut rings = Vec::new();
    for ring in 1..=CAP_RINGS {
        rings.push(polygons.add(CORNERS));
        sites.extend((0..CORNERS).map(|corner| Site::Cap { ring, corner }));
    }
    let stations = (0..ARM_RINGS)
        .map(|ring| FIRST_STATION + RING_SPACING * ring as f64)
        .chain(HAND_STATIONS);
    for station in stations {
        rings.push(polygons.add(CORNERS));
        sites.extend((0..CORNERS).map(|corner| Site::Ring { station, corner }));
    }
    let backwards: Vec<usize> = rings[0].iter().rev().copied().collect();
    polygons.cap(&backwards, point);

    let root = CAP_RINGS + ARM_RINGS + THUMB_ROOT;
    for (index, pair) in rings.windows(2).enumerate() {
        let before = polygons.faces.len();
        polygons.tube(&pair[0], &pair[1]);
        if (root..root + 2).contains(&index) {
            // The quadrangles on either side of corner 0: the first and the last of the tube.
            polygons.faces.remove(before + CORNERS - 1);
            polygons.faces.remove(before);
        }
    }

    let webs = polygons.add(3);
    sites.extend((0..3).map(Site::Web));
    let knuckles = &rings[rings.len() - 1];
    for finger in 0..4 {
        let side = |web: usize, corner: usize| {
            if (1..4).contains(&web) {
                webs[web - 1]
            } else {
                knuckles[corner]
            }
        };
        let (near, far) = (1 + 2 * finger, 19 - 2 * finger);
        let mut loop_of = vec![
            side(finger, 0),
            knuckles[near],
            knuckles[near + 1],
            knuckles[near + 2],
            side(finger + 1, 10),
            knuckles[far - 2],
            knuckles[far - 1],
            knuckles[far],
        ];
        for ring in 0..FINGER_RINGS.len() {
            let next = polygons.add(FINGER_CORNERS);
            sites.extend((0..FINGER_CORNERS).map(|corner| Site::Finger { finger, ring, corner }));
            polygons.tube(&loop_of, &next);
            loop_of = next;
        }
        let tip = polygons.add(1)[0];
        sites.push(Site::FingerTip(finger));
        polygons.cap(&loop_of, tip);
    }

    let last = CORNERS - 1;
    let [first, middle, end] = [0, 1, 2].map(|ring| &rings[root + ring]);
    let mut loop_of = vec![
        first[last],
        first[0],
        first[1],
        middle[1],
        end[1],
        end[0],
        end[last],
        middle[last],
    ];
    for ring in 0..THUMB_RINGS.len() {
        let next = polygons.add(FINGER_CORNERS);
        sites.extend((0..FINGER_CORNERS).map(|corner| Site::Thumb { ring, corner }));
        polygons.tube(&loop_of, &next);
        loop_of = next;
    }
    let tip = middle[0];
    sites[tip] = Site::ThumbTip;
    polygons.cap(&loop_of, tip);

    Topology {
        sites,
        faces: polygons.faces,
    }
}
