//! Fingers and thumb of a hand at rest.

use std::f64::consts::TAU;

use inbetween::math::{Point3, smooth_step};

use super::body::Build;
use super::topology::{FINGER_CORNERS, FINGER_RINGS, KNUCKLES, THUMB_RINGS};

/// From the index to the little finger: its length for a man, and how far it is spread towards the thumb.
const FINGERS: [(f64, f64); 4] = [(0.78, 7.0), (0.87, 1.5), (0.8, -4.0), (0.62, -10.0)];
/// Where their roots are on the hand's edge, as fractions of half its breadth.
const ROOTS: [f64; 4] = [0.73, 0.25, -0.25, -0.73];
/// How far a finger is bent towards the palm: at its root, and at each of its joints.
const CURL_DEGREES: [f64; 2] = [9.0, 16.0];
/// Where its joints are, as fractions of its length.
const FINGER_JOINTS: [f64; 2] = [0.4, 0.7];
/// Radii of a finger's rings, as fractions of its radius.
const FINGER_RADII: [f64; 8] = [1.04, 1.0, 1.02, 1.05, 0.95, 0.98, 0.92, 0.7];
const THUMB_RADII: [f64; 5] = [1.15, 1.0, 1.02, 0.95, 0.68];

/// A point on the middle line of a finger, and the directions there.
struct Stalk {
    at: Point3,
    /// Towards the tip.
    along: Point3,
    /// Towards the thumb.
    across: Point3,
    /// Towards the back of the hand.
    above: Point3,
}

impl Build {
    pub(crate) fn web(&self, web: usize) -> Point3 {
        let [up, ..] = self.section(KNUCKLES);
        Point3::new(KNUCKLES + 0.05, up * (0.5 - 0.5 * web as f64), -0.02)
    }

    pub(crate) fn on_finger(&self, finger: usize, ring: usize, corner: usize) -> Point3 {
        let stalk = self.stalk(finger, FINGER_RINGS[ring]);
        let (sin, cos) = libm::sincos(TAU * corner as f64 / FINGER_CORNERS as f64);
        let slim = if finger == 3 { 0.88 } else { 1.0 };
        let radius = self.between(0.08, 0.107) * FINGER_RADII[ring] * slim;
        stalk.at + (stalk.across * cos + stalk.above * sin) * radius
    }

    pub(crate) fn finger_tip(&self, finger: usize) -> Point3 {
        let stalk = self.stalk(finger, 1.0);
        stalk.at + stalk.along * 0.015
    }

    fn stalk(&self, finger: usize, share: f64) -> Stalk {
        let (length, spread) = FINGERS[finger];
        let [up, ..] = self.section(KNUCKLES);
        let (sin, cos) = libm::sincos(f64::to_radians(spread));
        let (straight, across) = (Point3::new(cos, sin, 0.0), Point3::new(-sin, cos, 0.0));
        let directions = |share: f64| {
            let joints: f64 = FINGER_JOINTS
                .iter()
                .map(|joint| smooth_step(share, joint - 0.1, joint + 0.1))
                .sum();
            let (sin, cos) = libm::sincos((CURL_DEGREES[0] + CURL_DEGREES[1] * joints).to_radians());
            (straight * cos - Point3::z() * sin, straight * sin + Point3::z() * cos)
        };
        const STEPS: usize = 50;
        let step = share / STEPS as f64;
        let length = length * self.between(0.9, 1.0);
        let root = Point3::new(KNUCKLES, ROOTS[finger] * up, 0.0);
        let at = (0..STEPS).fold(root, |at, index| {
            at + directions((index as f64 + 0.5) * step).0 * (length * step)
        });
        let (along, above) = directions(share);
        Stalk {
            at,
            along,
            across,
            above,
        }
    }

    pub(crate) fn on_thumb(&self, ring: usize, corner: usize) -> Point3 {
        let stalk = self.thumb(THUMB_RINGS[ring]);
        // The first corner of the root is at the wrist, towards the palm.
        let (sin, cos) = libm::sincos(TAU * (corner as f64 / FINGER_CORNERS as f64 - 0.125));
        let radius = self.between(0.085, 0.115) * THUMB_RADII[ring];
        stalk.at + (stalk.across * cos + stalk.above * sin) * radius
    }

    pub(crate) fn thumb_tip(&self) -> Point3 {
        let stalk = self.thumb(1.0);
        stalk.at + stalk.along * 0.015
    }

    /// The middle line of the thumb; across is towards the wrist, away from the fingers.
    fn thumb(&self, share: f64) -> Stalk {
        let [up, ..] = self.section(5.78);
        let root = Point3::new(5.75, up * 0.8, -0.02);
        // Straight away from the hand, then more and more along it.
        let length = self.between(0.7, 0.8);
        let start = Point3::new(0.5, 0.85, -0.14).normalize();
        let end = Point3::new(0.86, 0.5, -0.14).normalize();
        let bend = smooth_step(share, 0.2, 0.9);
        let at = root + (start * (1.0 - 0.5 * bend * share) + end * (0.5 * bend * share)) * (length * share);
        let along = (start * (1.0 - bend) + end * bend).normalize();
        let above = (Point3::z() - along * along.z).normalize();
        Stalk {
            at,
            along,
            across: above.cross(&along),
            above,
        }
    }
}
