//! Points of the figure that its drawings have in common.

use std::error::Error;

use kurbo::{Affine, Point};

use super::Figure;
use super::posture::Side;
use crate::canvas::Canvas;
use crate::curves::at;

/// Rays of a hand, from the thumb over the fingertips to the little finger's side, in the hand's coordinates.
const HAND: [(&str, Point, Point); 7] = [
    ("cuff_thumb", Point::new(-4.0, 20.0), Point::new(-4.0, 36.0)),
    ("thumb_root", Point::new(28.0, 0.0), Point::new(40.0, 29.0)),
    ("thumb", Point::new(26.0, 30.0), Point::new(33.0, 57.0)),
    ("hand_side", Point::new(40.0, 0.0), Point::new(60.0, 22.0)),
    ("fingers", Point::new(40.0, -4.0), Point::new(75.0, -2.0)),
    ("palm_side", Point::new(40.0, -4.0), Point::new(44.0, -32.0)),
    ("cuff_palm", Point::new(-4.0, -20.0), Point::new(-4.0, -36.0)),
];

/// Rays of a shoe, from the instep over the toe to the heel.
const SHOE: [(&str, Point, Point); 8] = [
    ("instep", Point::new(64.0, 20.0), Point::new(64.0, -14.0)),
    ("toe_top", Point::new(88.0, 10.0), Point::new(88.0, -22.0)),
    ("sole_front", Point::new(100.0, 30.0), Point::new(122.0, 45.0)),
    ("sole_ball", Point::new(84.0, 30.0), Point::new(84.0, 44.0)),
    ("sole", Point::new(48.0, 30.0), Point::new(48.0, 44.0)),
    ("sole_heel", Point::new(10.0, 30.0), Point::new(10.0, 44.0)),
    ("sole_back", Point::new(-20.0, 30.0), Point::new(-42.0, 45.0)),
    ("heel", Point::new(0.0, 28.0), Point::new(-40.0, 27.0)),
];

/// All landmarks, in order around the figure.
pub(super) fn landmarks(canvas: &Canvas, figure: &Figure) -> Result<Vec<(String, Point)>, Box<dyn Error>> {
    let hat = figure.head * Affine::translate((8.0, -149.0)) * Affine::rotate(f64::to_radians(8.0));
    let mut rays: Vec<(String, Point, Point)> = vec![
        ("hat_top".to_owned(), hat * at(0.0, -40.0), hat * at(0.0, -70.0)),
        ("hat_right".to_owned(), hat * at(20.0, -48.0), hat * at(44.0, -58.0)),
        ("brim_right".to_owned(), hat * at(20.0, 2.0), hat * at(64.0, 2.0)),
    ];
    rays.extend(side_rays(canvas, figure, Side::Right));
    let thighs = figure
        .legs
        .each_ref()
        .map(|leg| (leg.limb.place(0.5, 0.0) - leg.hip).normalize());
    let seat = figure.torso * at(0.0, 0.0);
    rays.push(("crotch".to_owned(), seat, seat + thighs[0] + thighs[1]));
    rays.extend(side_rays(canvas, figure, Side::Left).into_iter().rev());
    rays.push(("brim_left".to_owned(), hat * at(-20.0, 2.0), hat * at(-64.0, 2.0)));
    rays.push(("hat_left".to_owned(), hat * at(-20.0, -48.0), hat * at(-44.0, -58.0)));
    let mut points: Vec<(String, Point)> = Vec::new();
    for (name, inside, towards) in rays {
        points.push((name, canvas.edge(inside, towards)?));
    }
    points.extend(inner_points(figure));
    Ok(points)
}

/// Landmarks inside the figure, where something is drawn that should not fade from one place to another.
fn inner_points(figure: &Figure) -> Vec<(String, Point)> {
    let mut points = Vec::new();
    let mut add = |name: String, point: Point| points.push((name, point));
    let (head, torso) = (figure.head, figure.torso);
    add("nose".to_owned(), head * at(0.0, -56.0));
    add("chin".to_owned(), head * at(0.0, -8.0));
    add("forehead".to_owned(), head * at(0.0, -124.0));
    add("seat".to_owned(), torso * at(0.0, 8.0));
    add("collar".to_owned(), torso * at(0.0, -126.0));
    for (name, y) in [
        ("button_top", -104.0),
        ("button_middle", -64.0),
        ("button_bottom", -24.0),
    ] {
        add(name.to_owned(), torso * at(0.0, y));
    }
    for (name, index, sign) in [("left", 0, -1.0), ("right", 1, 1.0)] {
        let mut add = |part: &str, point: Point| add(format!("{name}_{part}"), point);
        let (arm, leg) = (&figure.arms[index], &figure.legs[index]);
        add("eye", head * at(32.0 * sign, -82.0));
        add("cheek", head * at(60.0 * sign, -44.0));
        add("mouth_corner", head * at(36.0 * sign, -29.0));
        add("collar_end", torso * at(58.0 * sign, -134.0));
        add("belly", torso * at(52.0 * sign, -46.0));
        add("sleeve_middle", arm.limb.place(0.55, 0.0));
        add("cuff_start", arm.hand * at(-14.0, 0.0));
        add("cuff_end", arm.hand * at(8.0, 0.0));
        add("hand", arm.hand * at(36.0, 0.0));
        add("knee", leg.limb.place(0.55, 0.0));
        add("hem_start", leg.hem * at(0.0, -13.0));
        add("hem_end", leg.hem * at(0.0, 13.0));
        add("foot", leg.foot * at(10.0, 16.0));
        add("toe_cap", leg.foot * at(84.0, 10.0));
        add("seat", torso * at(46.0 * sign, 14.0));
    }
    points
}

/// The rays of one side, from the hair down to the inner side of the leg.
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
        "hair_top",
        placed(figure.head, 70.0, -112.0),
        placed(figure.head, 96.0, -138.0),
    );
    add(
        "hair",
        placed(figure.head, 90.0, -84.0),
        placed(figure.head, 126.0, -84.0),
    );
    add(
        "hair_bottom",
        placed(figure.head, 80.0, -54.0),
        placed(figure.head, 96.0, -30.0),
    );
    add(
        "ruff",
        placed(figure.torso, 50.0, -146.0),
        placed(figure.torso, 86.0, -164.0),
    );
    // `across` runs to the right of the direction from the shoulder to the wrist.
    add("sleeve_outside", arm.limb.place(0.6, 0.0), arm.limb.place(0.6, -sign));
    for (part, inside, towards) in HAND {
        add(part, arm.hand * inside, arm.hand * towards);
    }
    add("sleeve_inside", arm.limb.place(0.6, 0.0), arm.limb.place(0.6, sign));
    // Under the sleeve, up to where the trunk's line begins.
    let under = |step: i32| arm.limb.place(0.9 - 0.005 * f64::from(step), 1.4 * sign);
    let armpit = (0..160)
        .map(under)
        .find(|&point| canvas.is_drawn(point))
        .unwrap_or(arm.shoulder);
    add("armpit", arm.limb.place(0.25, 0.0), armpit);
    add(
        "waist",
        placed(figure.torso, 0.0, -36.0),
        placed(figure.torso, 88.0, -36.0),
    );
    add("knee_outside", leg.limb.place(0.6, 0.0), leg.limb.place(0.6, -sign));
    add(
        "hem_outside",
        leg.hem * at(20.0 * sign, -4.0),
        leg.hem * at(40.0 * sign, -18.0),
    );
    for (part, inside, towards) in SHOE {
        add(part, leg.foot * inside, leg.foot * towards);
    }
    add(
        "hem_inside",
        leg.hem * at(-20.0 * sign, -4.0),
        leg.hem * at(-40.0 * sign, -18.0),
    );
    add("knee_inside", leg.limb.place(0.6, 0.0), leg.limb.place(0.6, sign));
    rays
}
