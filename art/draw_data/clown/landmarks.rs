//! Points of the figure that its drawings have in common.

use kurbo::Point;

use super::Clown;
use super::body::hem;
use super::head::hat;
use crate::canvas::Canvas;
use crate::curves::at;
use crate::figure::{Landmarks, Ray, Side, Skeleton, arm_rays, leg_rays};

/// Rays of a hand, from the thumb over the fingertips to the little finger's side, in the hand's coordinates.
const HAND: [Ray; 7] = [
    ("cuff_thumb", Point::new(-4.0, 20.0), Point::new(-4.0, 36.0)),
    ("thumb_root", Point::new(28.0, 0.0), Point::new(40.0, 29.0)),
    ("thumb", Point::new(26.0, 30.0), Point::new(33.0, 57.0)),
    ("hand_side", Point::new(40.0, 0.0), Point::new(60.0, 22.0)),
    ("fingers", Point::new(40.0, -4.0), Point::new(75.0, -2.0)),
    ("palm_side", Point::new(40.0, -4.0), Point::new(44.0, -32.0)),
    ("cuff_palm", Point::new(-4.0, -20.0), Point::new(-4.0, -36.0)),
];

/// Rays of a shoe, from the instep over the toe to the heel.
const SHOE: [Ray; 8] = [
    ("instep", Point::new(64.0, 20.0), Point::new(64.0, -14.0)),
    ("toe_top", Point::new(88.0, 10.0), Point::new(88.0, -22.0)),
    ("sole_front", Point::new(100.0, 30.0), Point::new(122.0, 45.0)),
    ("sole_ball", Point::new(84.0, 30.0), Point::new(84.0, 44.0)),
    ("sole", Point::new(48.0, 30.0), Point::new(48.0, 44.0)),
    ("sole_heel", Point::new(10.0, 30.0), Point::new(10.0, 44.0)),
    ("sole_back", Point::new(-20.0, 30.0), Point::new(-42.0, 45.0)),
    ("heel", Point::new(0.0, 28.0), Point::new(-40.0, 27.0)),
];

/// Just outside the ink line of a sleeve, in half widths of it.
const UNDER_ARM: f64 = 1.4;

impl Landmarks for Clown {
    /// The hat: from its top to the right end of its brim, and back from the left one.
    fn top_rays(&self, skeleton: &Skeleton) -> [Vec<Ray>; 2] {
        let hat = hat(skeleton.head);
        let crown = |name, sign: f64| (name, hat * at(20.0 * sign, -48.0), hat * at(44.0 * sign, -58.0));
        let brim = |name, sign: f64| (name, hat * at(20.0 * sign, 2.0), hat * at(64.0 * sign, 2.0));
        let top = ("hat_top", hat * at(0.0, -40.0), hat * at(0.0, -70.0));
        [
            vec![top, crown("hat_right", 1.0), brim("brim_right", 1.0)],
            vec![brim("brim_left", -1.0), crown("hat_left", -1.0)],
        ]
    }

    /// The rays of one side, from the hair down to the inner side of the leg.
    fn side_rays(&self, canvas: &Canvas, skeleton: &Skeleton, side: Side) -> Vec<Ray> {
        let (head, torso, leg) = (skeleton.head, skeleton.torso, skeleton.leg(side));
        let hem_ray = |name, sign: f64| {
            let [inside, towards] = [at(20.0 * sign, -4.0), at(40.0 * sign, -18.0)];
            (name, hem(leg) * inside, hem(leg) * towards)
        };
        let hems = [hem_ray("hem_outside", side.sign()), hem_ray("hem_inside", -side.sign())];
        let mut rays = vec![
            ("hair_top", head * side.at(70.0, -112.0), head * side.at(96.0, -138.0)),
            ("hair", head * side.at(90.0, -84.0), head * side.at(126.0, -84.0)),
            ("hair_bottom", head * side.at(80.0, -54.0), head * side.at(96.0, -30.0)),
            ("ruff", torso * side.at(50.0, -146.0), torso * side.at(86.0, -164.0)),
        ];
        rays.extend(arm_rays(canvas, skeleton.arm(side), 0.6, &HAND, UNDER_ARM));
        rays.push(("waist", torso * side.at(0.0, -36.0), torso * side.at(88.0, -36.0)));
        rays.extend(leg_rays(leg, 0.6, hems, &SHOE));
        rays
    }

    fn middle_points(&self, skeleton: &Skeleton) -> Vec<(&'static str, Point)> {
        let (head, torso) = (skeleton.head, skeleton.torso);
        vec![
            ("nose", head * at(0.0, -56.0)),
            ("chin", head * at(0.0, -8.0)),
            ("forehead", head * at(0.0, -124.0)),
            ("seat", torso * at(0.0, 8.0)),
            ("collar", torso * at(0.0, -126.0)),
            ("button_top", torso * at(0.0, -104.0)),
            ("button_middle", torso * at(0.0, -64.0)),
            ("button_bottom", torso * at(0.0, -24.0)),
        ]
    }

    fn side_points(&self, skeleton: &Skeleton, side: Side) -> Vec<(&'static str, Point)> {
        let (head, torso) = (skeleton.head, skeleton.torso);
        let (arm, leg) = (skeleton.arm(side), skeleton.leg(side));
        vec![
            ("eye", head * side.at(32.0, -82.0)),
            ("cheek", head * side.at(60.0, -44.0)),
            ("mouth_corner", head * side.at(36.0, -29.0)),
            ("collar_end", torso * side.at(58.0, -134.0)),
            ("belly", torso * side.at(52.0, -46.0)),
            ("sleeve_middle", arm.limb.place(0.55, 0.0)),
            ("cuff_start", arm.hand * at(-14.0, 0.0)),
            ("cuff_end", arm.hand * at(8.0, 0.0)),
            ("hand", arm.hand * at(36.0, 0.0)),
            ("knee", leg.limb.place(0.55, 0.0)),
            ("hem_start", hem(leg) * at(0.0, -13.0)),
            ("hem_end", hem(leg) * at(0.0, 13.0)),
            ("foot", leg.foot * at(10.0, 16.0)),
            ("toe_cap", leg.foot * at(84.0, 10.0)),
            ("seat", torso * side.at(46.0, 14.0)),
        ]
    }
}
