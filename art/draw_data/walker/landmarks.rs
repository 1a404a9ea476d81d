//! Points of the figure that its drawings have in common.

use kurbo::{Affine, Point};

use super::head::{lips, pompom_axis};
use super::posture::Posture;
use crate::canvas::Canvas;
use crate::curves::at;
use crate::figure::{Landmarks, Ray, Side, Skeleton, arm_rays, leg_rays};

/// Rays of a mitten, from the thumb's side of the wrist to the other one: a point inside, and one it passes through.
const HAND: [Ray; 7] = [
    ("cuff_thumb_side", Point::new(-1.5, 0.0), Point::new(-1.5, 23.0)),
    ("thumb_root", Point::new(24.0, 30.0), Point::new(12.0, 41.0)),
    ("thumb_tip", Point::new(31.0, 40.0), Point::new(34.0, 58.0)),
    ("thumb_notch", Point::new(28.0, 20.0), Point::new(41.0, 31.0)),
    ("fingertip", Point::new(40.0, 2.0), Point::new(72.0, 2.0)),
    ("knuckles", Point::new(35.0, 0.0), Point::new(35.0, -27.0)),
    ("cuff_little_side", Point::new(-1.5, 0.0), Point::new(-1.5, -23.0)),
];

/// Rays of a shoe, from the instep over the toe to the heel.
const SHOE: [Ray; 6] = [
    ("instep", Point::new(52.0, 24.0), Point::new(58.0, 7.0)),
    ("toe", Point::new(60.0, 32.0), Point::new(84.0, 32.0)),
    ("sole_front", Point::new(74.0, 30.0), Point::new(74.0, 40.0)),
    ("sole_middle", Point::new(26.0, 30.0), Point::new(26.0, 40.0)),
    ("sole_back", Point::new(-22.0, 30.0), Point::new(-22.0, 40.0)),
    ("heel", Point::new(0.0, 32.0), Point::new(-32.0, 32.0)),
];

/// Just outside the ink line of a sleeve, in half widths of it.
const UNDER_ARM: f64 = 1.45;

/// The middle of a sleeve's stripe, along the arm.
const SLEEVE: f64 = 0.62;

impl Landmarks for Posture {
    /// The pompom: from its end to its right side, and its left side.
    fn top_rays(&self, skeleton: &Skeleton) -> [Vec<Ray>; 2] {
        let [pompom, above] = pompom_axis(skeleton.head, self.flop_deg);
        let beside = |angle_deg: f64| Affine::rotate_about(f64::to_radians(angle_deg), pompom) * above;
        [
            vec![("pompom", pompom, above), ("right_pompom", pompom, beside(80.0))],
            vec![("left_pompom", pompom, beside(-80.0))],
        ]
    }

    /// The rays of one side, from the cap down to the inner side of the leg.
    fn side_rays(&self, canvas: &Canvas, skeleton: &Skeleton, side: Side) -> Vec<Ray> {
        let (head, torso, leg) = (skeleton.head, skeleton.torso, skeleton.leg(side));
        let turn_up = |name, across: f64| (name, leg.limb.place(0.93, 0.0), leg.limb.place(0.93, across));
        let turn_ups = [
            turn_up("turn_up_outside", -side.sign()),
            turn_up("turn_up_inside", side.sign()),
        ];
        let mut rays = vec![
            ("cap_brim", head * side.at(60.0, -116.0), head * side.at(93.0, -116.0)),
            ("ear", head * side.at(88.0, -58.0), head * side.at(105.0, -58.0)),
            ("jaw", head * side.at(40.0, -50.0), head * side.at(74.0, -22.0)),
        ];
        rays.extend(arm_rays(canvas, skeleton.arm(side), SLEEVE, &HAND, UNDER_ARM));
        rays.extend([
            ("waist", torso * side.at(0.0, -36.0), torso * side.at(66.0, -36.0)),
            ("hem", torso * side.at(40.0, -32.0), torso * side.at(64.0, -10.0)),
        ]);
        rays.extend(leg_rays(leg, 0.5, turn_ups, &SHOE));
        rays
    }

    fn middle_points(&self, skeleton: &Skeleton) -> Vec<(&'static str, Point)> {
        let (head, torso) = (skeleton.head, skeleton.torso);
        let [upper_lip, lower_lip] = lips(self.body.mouth);
        vec![
            ("pompom_middle", pompom_axis(head, self.flop_deg)[0]),
            ("brim_top", head * at(0.0, -142.0)),
            ("brim_bottom", head * at(0.0, -107.0)),
            ("nose", head * at(0.0, -44.0)),
            ("mouth_top", head * at(0.0, upper_lip)),
            ("mouth_bottom", head * at(0.0, lower_lip)),
            ("scarf_knot", torso * at(0.0, -124.0)),
            ("scarf_end", torso * at(26.0, -76.0)),
            ("stripe_middle", torso * at(0.0, -55.0)),
            ("hem_middle", torso * at(0.0, -5.0)),
        ]
    }

    fn side_points(&self, skeleton: &Skeleton, side: Side) -> Vec<(&'static str, Point)> {
        let (head, torso, sign) = (skeleton.head, skeleton.torso, side.sign());
        let (arm, leg) = (skeleton.arm(side), skeleton.leg(side));
        vec![
            ("brim_end", head * side.at(68.0, -114.0)),
            ("fringe", head * side.at(36.0, -96.0)),
            ("eye", head * (side.at(35.0, -68.0) + self.look)),
            ("cheek", head * side.at(54.0, -36.0)),
            ("mouth_corner", head * side.at(28.0, -30.5)),
            ("scarf_side", torso * side.at(40.0, -138.0)),
            ("stripe_end", torso * side.at(48.0, -61.0)),
            ("hem_end", torso * side.at(48.0, -8.0)),
            ("sleeve_middle", arm.limb.place(SLEEVE, 0.0)),
            ("cuff_start", arm.hand * at(-13.0, 0.0)),
            ("cuff_end", arm.hand * at(10.0, 0.0)),
            ("crease", arm.hand * at(33.0, 22.0)),
            ("knee_middle", leg.limb.place(0.5, 0.0)),
            // The corners of the turned-up hem, a little inside.
            ("turn_up_start_inside", leg.limb.place(0.865, 0.6 * sign)),
            ("turn_up_start_outside", leg.limb.place(0.865, -0.6 * sign)),
            ("turn_up_end_inside", leg.limb.place(1.0, 0.6 * sign)),
            ("turn_up_end_outside", leg.limb.place(1.0, -0.6 * sign)),
            ("tongue", leg.foot * at(18.0, 8.0)),
            ("cap", leg.foot * at(57.0, 22.0)),
        ]
    }
}
