//! Points of the figure that its drawings have in common, but those on what is loose.

use kurbo::Point;

use super::posture::Posture;
use crate::canvas::Canvas;
use crate::curves::at;
use crate::figure::{Landmarks, Ray, Side, Skeleton, arm_rays, leg_rays};

/// Rays of a hand, from the wrist on the thumb's side to the other one; where the wand is there is none.
const HAND: [Ray; 4] = [
    ("thumb_root", Point::new(16.0, 20.0), Point::new(12.0, 40.0)),
    ("fingertips", Point::new(44.0, 0.0), Point::new(80.0, 1.0)),
    ("little_finger", Point::new(50.0, -6.0), Point::new(60.0, -30.0)),
    ("wrist", Point::new(14.0, -6.0), Point::new(12.0, -34.0)),
];

/// Rays of a boot, from the instep over the toe to the heel.
const BOOT: [Ray; 6] = [
    ("instep", Point::new(44.0, 20.0), Point::new(48.0, 0.0)),
    ("toe", Point::new(60.0, 16.0), Point::new(100.0, 6.0)),
    ("sole_front", Point::new(70.0, 20.0), Point::new(72.0, 44.0)),
    ("sole_middle", Point::new(28.0, 20.0), Point::new(28.0, 44.0)),
    ("sole_back", Point::new(-16.0, 20.0), Point::new(-18.0, 44.0)),
    ("heel", Point::new(0.0, 14.0), Point::new(-40.0, 16.0)),
];

/// Just outside the ink line of a sleeve, in half widths of it.
const UNDER_ARM: f64 = 1.45;

impl Landmarks for Posture {
    /// The tuft: its middle tip and the one on the left.
    fn top_rays(&self, skeleton: &Skeleton) -> [Vec<Ray>; 2] {
        let head = skeleton.head;
        let tip = |name, x: f64, y: f64| (name, head * at(0.0, -140.0), head * at(x, y));
        [
            vec![tip("tuft_middle", 12.0, -178.0), tip("tuft_right", 40.0, -162.0)],
            vec![tip("tuft_left", -22.0, -172.0)],
        ]
    }

    /// The rays of one side, from the hair down to the inner side of the leg.
    fn side_rays(&self, canvas: &Canvas, skeleton: &Skeleton, side: Side) -> Vec<Ray> {
        let (head, torso, leg) = (skeleton.head, skeleton.torso, skeleton.leg(side));
        let shaft = |name, across: f64| (name, leg.limb.place(0.95, 0.0), leg.limb.place(0.95, across));
        let shafts = [shaft("shaft_outside", -side.sign()), shaft("shaft_inside", side.sign())];
        let mut rays = vec![
            ("temple", head * side.at(50.0, -110.0), head * side.at(90.0, -118.0)),
            ("ear", head * side.at(80.0, -62.0), head * side.at(110.0, -62.0)),
            ("jaw", head * side.at(40.0, -40.0), head * side.at(80.0, -18.0)),
        ];
        rays.extend(arm_rays(canvas, skeleton.arm(side), 0.6, &HAND, UNDER_ARM));
        rays.extend([
            ("waist", torso * side.at(0.0, -52.0), torso * side.at(66.0, -52.0)),
            ("hem", torso * side.at(50.0, 8.0), torso * side.at(86.0, 16.0)),
        ]);
        rays.extend(leg_rays(leg, 0.5, shafts, &BOOT));
        rays
    }

    fn middle_points(&self, skeleton: &Skeleton) -> Vec<(&'static str, Point)> {
        let (head, torso) = (skeleton.head, skeleton.torso);
        vec![
            ("fringe_middle", head * at(-4.0, -94.0)),
            ("nose", head * at(8.0, -46.0)),
            ("mouth_middle", head * at(2.0, -15.0)),
            ("buckle", torso * at(1.0, -29.0)),
            ("button_top", torso * at(16.0, -92.0)),
            ("button_bottom", torso * at(16.0, -64.0)),
            ("scarf_end", torso * at(-26.0, -72.0)),
            ("pocket", torso * at(44.0, 10.0)),
            ("patch", torso * at(-46.0, 2.0)),
        ]
    }

    fn side_points(&self, skeleton: &Skeleton, side: Side) -> Vec<(&'static str, Point)> {
        let (head, torso) = (skeleton.head, skeleton.torso);
        let (arm, leg) = (skeleton.arm(side), skeleton.leg(side));
        vec![
            ("eye", head * side.at(33.0, -64.0)),
            ("cheek", head * side.at(56.0, -31.0)),
            ("mouth_corner", head * side.at(25.0, -24.0)),
            ("scarf_side", torso * side.at(44.0, -133.0)),
            ("belt_end", torso * side.at(56.0, -29.0)),
            ("hem_corner", torso * side.at(62.0, 16.0)),
            ("elbow", arm.limb.place(0.5, 0.0)),
            ("cuff_start", arm.limb.place(0.80, 0.0)),
            ("cuff_end", arm.limb.place(0.90, 0.0)),
            ("palm", arm.hand * at(50.0, 0.0)),
            ("knee", leg.limb.place(0.5, 0.0)),
            ("stripe", leg.limb.place(0.775, 0.0)),
            ("boot", leg.foot * at(6.0, 10.0)),
            ("shine", leg.foot * at(48.0, 13.0)),
        ]
    }
}
