//! The points of the figure that the artist names: the same physical point in all five pictures.
//!
//! Every outline point is found on the finished picture: a ray that is fixed to a part of the figure leaves the drawing
//! there. Going round the figure the names come in the same order in every pose.

use std::error::Error;

use kurbo::{Affine, Point};

use super::Figure;
use super::head::pompom_axis;
use super::posture::{Posture, Side};
use crate::canvas::Canvas;
use crate::curves::at;

/// Rays of a mitten, from the thumb's side of the wrist to the other one: a point inside, and one it passes through.
const HAND: [(&str, Point, Point); 7] = [
    ("cuff_thumb_side", Point::new(-1.5, 0.0), Point::new(-1.5, 23.0)),
    ("thumb_root", Point::new(24.0, 30.0), Point::new(12.0, 41.0)),
    ("thumb_tip", Point::new(31.0, 40.0), Point::new(34.0, 58.0)),
    ("thumb_notch", Point::new(28.0, 20.0), Point::new(41.0, 31.0)),
    ("fingertip", Point::new(40.0, 2.0), Point::new(72.0, 2.0)),
    ("knuckles", Point::new(35.0, 0.0), Point::new(35.0, -27.0)),
    ("cuff_little_side", Point::new(-1.5, 0.0), Point::new(-1.5, -23.0)),
];

/// Rays of a shoe, from the instep over the toe to the heel.
const SHOE: [(&str, Point, Point); 6] = [
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

/// All landmarks, in order around the figure.
pub(super) fn landmarks(
    canvas: &Canvas,
    figure: &Figure,
    posture: &Posture,
) -> Result<Vec<(String, Point)>, Box<dyn Error>> {
    let mut rays: Vec<(String, Point, Point)> = Vec::new();
    let [pompom, above] = pompom_axis(figure.head, posture.flop_deg);
    let beside = |angle_deg: f64| Affine::rotate_about(f64::to_radians(angle_deg), pompom) * above;
    rays.push(("pompom".to_owned(), pompom, above));
    rays.push(("right_pompom".to_owned(), pompom, beside(80.0)));
    rays.extend(side_rays(canvas, figure, Side::Right));
    let thighs = figure
        .legs
        .each_ref()
        .map(|leg| (leg.limb.place(0.4, 0.0) - leg.hip).normalize());
    let seat = figure.torso * at(0.0, 0.0);
    rays.push(("crotch".to_owned(), seat, seat + thighs[0] + thighs[1]));
    rays.extend(side_rays(canvas, figure, Side::Left).into_iter().rev());
    rays.push(("left_pompom".to_owned(), pompom, beside(-80.0)));
    let mut points: Vec<(String, Point)> = Vec::new();
    for (name, inside, towards) in rays {
        points.push((name, canvas.edge(inside, towards)?));
    }
    points.extend(inner_points(figure, posture));
    Ok(points)
}

/// Landmarks inside the figure, where something is drawn that should not fade from one place to another.
fn inner_points(figure: &Figure, posture: &Posture) -> Vec<(String, Point)> {
    let mut points = Vec::new();
    let mut add = |name: String, point: Point| points.push((name, point));
    let (head, torso) = (figure.head, figure.torso);
    add("pompom_middle".to_owned(), pompom_axis(head, posture.flop_deg)[0]);
    add("brim_top".to_owned(), head * at(0.0, -142.0));
    add("brim_bottom".to_owned(), head * at(0.0, -107.0));
    add("nose".to_owned(), head * at(0.0, -44.0));
    add("mouth_top".to_owned(), head * at(0.0, posture.mouth.lips()[0]));
    add("mouth_bottom".to_owned(), head * at(0.0, posture.mouth.lips()[1]));
    add("scarf_knot".to_owned(), torso * at(0.0, -124.0));
    add("scarf_end".to_owned(), torso * at(26.0, -76.0));
    add("stripe_middle".to_owned(), torso * at(0.0, -55.0));
    add("hem_middle".to_owned(), torso * at(0.0, -5.0));
    for (name, index, sign) in [("left", 0, -1.0), ("right", 1, 1.0)] {
        let mut add = |part: &str, point: Point| add(format!("{name}_{part}"), point);
        let (arm, leg) = (&figure.arms[index], &figure.legs[index]);
        add("brim_end", head * at(68.0 * sign, -114.0));
        add("fringe", head * at(36.0 * sign, -96.0));
        add("eye", head * (at(35.0 * sign, -68.0) + posture.look));
        add("cheek", head * at(54.0 * sign, -36.0));
        add("mouth_corner", head * at(28.0 * sign, -30.5));
        add("scarf_side", torso * at(40.0 * sign, -138.0));
        add("stripe_end", torso * at(48.0 * sign, -61.0));
        add("hem_end", torso * at(48.0 * sign, -8.0));
        add("sleeve_middle", arm.limb.place(SLEEVE, 0.0));
        add("cuff_start", arm.hand * at(-13.0, 0.0));
        add("cuff_end", arm.hand * at(10.0, 0.0));
        add("crease", arm.hand * at(33.0, 22.0));
        add("knee_middle", leg.limb.place(0.5, 0.0));
        // The corners of the turned-up hem, a little inside.
        add("turn_up_start_inside", leg.limb.place(0.865, 0.6 * sign));
        add("turn_up_start_outside", leg.limb.place(0.865, -0.6 * sign));
        add("turn_up_end_inside", leg.limb.place(1.0, 0.6 * sign));
        add("turn_up_end_outside", leg.limb.place(1.0, -0.6 * sign));
        add("tongue", leg.foot * at(18.0, 8.0));
        add("cap", leg.foot * at(57.0, 22.0));
    }
    points
}

/// The rays of one side, from the cap down to the inner side of the leg.
fn side_rays(canvas: &Canvas, figure: &Figure, side: Side) -> Vec<(String, Point, Point)> {
    let (name, index, sign) = match side {
        Side::Left => ("left", 0, side.sign()),
        Side::Right => ("right", 1, side.sign()),
    };
    let (arm, leg) = (&figure.arms[index], &figure.legs[index]);
    let mut rays = Vec::new();
    let mut add = |part: &str, inside: Point, towards: Point| rays.push((format!("{name}_{part}"), inside, towards));
    let placed = |frame: Affine, x: f64, y: f64| frame * at(x * sign, y);

    add(
        "cap_brim",
        placed(figure.head, 60.0, -116.0),
        placed(figure.head, 93.0, -116.0),
    );
    add(
        "ear",
        placed(figure.head, 88.0, -58.0),
        placed(figure.head, 105.0, -58.0),
    );
    add(
        "jaw",
        placed(figure.head, 40.0, -50.0),
        placed(figure.head, 74.0, -22.0),
    );
    // `across` runs to the right of the direction from the shoulder to the wrist.
    add(
        "sleeve_outside",
        arm.limb.place(SLEEVE, 0.0),
        arm.limb.place(SLEEVE, -sign),
    );
    for (part, inside, towards) in HAND {
        add(part, arm.hand * inside, arm.hand * towards);
    }
    add(
        "sleeve_inside",
        arm.limb.place(SLEEVE, 0.0),
        arm.limb.place(SLEEVE, sign),
    );
    // Under the sleeve, up to where the trunk's line begins.
    let under = |step: i32| arm.limb.place(0.9 - 0.005 * f64::from(step), UNDER_ARM * sign);
    let armpit = (0..160)
        .map(under)
        .find(|&point| canvas.is_drawn(point))
        .unwrap_or(arm.shoulder);
    add("armpit", arm.limb.place(0.25, 0.0), armpit);
    add(
        "waist",
        placed(figure.torso, 0.0, -36.0),
        placed(figure.torso, 66.0, -36.0),
    );
    add(
        "hem",
        placed(figure.torso, 40.0, -32.0),
        placed(figure.torso, 64.0, -10.0),
    );
    add("knee_outside", leg.limb.place(0.5, 0.0), leg.limb.place(0.5, -sign));
    add(
        "turn_up_outside",
        leg.limb.place(0.93, 0.0),
        leg.limb.place(0.93, -sign),
    );
    for (part, inside, towards) in SHOE {
        add(part, leg.foot * inside, leg.foot * towards);
    }
    add("turn_up_inside", leg.limb.place(0.93, 0.0), leg.limb.place(0.93, sign));
    add("knee_inside", leg.limb.place(0.5, 0.0), leg.limb.place(0.5, sign));
    rays
}
