//! The points of a figure that the artist names: the same physical point in all of its pictures.
//!
//! Every outline point is found on the finished picture: a ray that is fixed to a part of the figure leaves the drawing
//! there. Going round the figure the names come in the same order in every pose.

use std::error::Error;

use kurbo::Point;

use super::{Arm, Figure, Leg, Side, Skeleton};
use crate::canvas::Canvas;
use crate::curves::at;

/// An outline point's name, a point inside the figure, and one that the ray from there passes through.
pub(crate) type Ray = (&'static str, Point, Point);

/// Where the landmarks of a figure lie on one drawing of it.
pub(crate) trait Landmarks {
    /// Outline points at the top: from the first one to the right side, and back from the left side.
    fn top_rays(&self, skeleton: &Skeleton) -> [Vec<Ray>; 2];

    /// Outline points of one side, from the head down to the inner side of the leg.
    fn side_rays(&self, canvas: &Canvas, skeleton: &Skeleton, side: Side) -> Vec<Ray>;

    /// Points inside, on the middle, where something is drawn that should not fade from one place to another.
    fn middle_points(&self, skeleton: &Skeleton) -> Vec<(&'static str, Point)>;

    /// Such points of one side.
    fn side_points(&self, skeleton: &Skeleton, side: Side) -> Vec<(&'static str, Point)>;
}

/// All landmarks: in order around the figure, then those inside.
pub(super) fn landmarks<F: Figure>(
    figure: &F,
    canvas: &Canvas,
    skeleton: &Skeleton,
) -> Result<Vec<(String, Point)>, Box<dyn Error>> {
    let side = |side: Side| -> Vec<(String, Point, Point)> {
        let rays = figure.side_rays(canvas, skeleton, side).into_iter();
        rays.map(|(part, inside, towards)| (side.named(part), inside, towards))
            .collect()
    };
    let owned = |(name, inside, towards): Ray| (name.to_owned(), inside, towards);
    let [to_the_right, from_the_left] = figure.top_rays(skeleton);
    let mut rays: Vec<(String, Point, Point)> = to_the_right.into_iter().map(owned).collect();
    rays.extend(side(Side::Right));
    let thighs = skeleton
        .legs
        .each_ref()
        .map(|leg| (leg.limb.place(F::BUILD.mid_thigh, 0.0) - leg.hip.center).normalize());
    let seat = skeleton.torso * at(0.0, 0.0);
    rays.push(("crotch".to_owned(), seat, seat + thighs[0] + thighs[1]));
    rays.extend(side(Side::Left).into_iter().rev());
    rays.extend(from_the_left.into_iter().map(owned));
    let mut points = Vec::new();
    for (name, inside, towards) in rays {
        points.push((name, canvas.edge(inside, towards)?));
    }
    for (name, point) in figure.middle_points(skeleton) {
        points.push((name.to_owned(), point));
    }
    for side in Side::BOTH {
        for (part, point) in figure.side_points(skeleton, side) {
            points.push((side.named(part), point));
        }
    }
    Ok(points)
}

/// The rays of an arm, from the outside of the sleeve (`sleeve` along the arm) round the hand to the armpit.
///
/// The armpit is where the trunk's line begins just outside the ink of the sleeve, `under_arm` half widths from its middle.
pub(crate) fn arm_rays(canvas: &Canvas, arm: &Arm, sleeve: f64, hand: &[Ray], under_arm: f64) -> Vec<Ray> {
    let sign = arm.side.sign();
    // `across` runs to the right of the direction from the shoulder to the wrist.
    let across = |name, across: f64| (name, arm.limb.place(sleeve, 0.0), arm.limb.place(sleeve, across));
    let mut rays = vec![across("sleeve_outside", -sign)];
    rays.extend(
        hand.iter()
            .map(|&(name, from, to)| (name, arm.hand * from, arm.hand * to)),
    );
    rays.push(across("sleeve_inside", sign));
    let under = |step: i32| arm.limb.place(0.9 - 0.005 * f64::from(step), under_arm * sign);
    let armpit = (0..160)
        .map(under)
        .find(|&point| canvas.is_drawn(point))
        .unwrap_or(arm.shoulder.center);
    rays.push(("armpit", arm.limb.place(0.25, 0.0), armpit));
    rays
}

/// The rays of a leg, from the outside of the knee (`knee` along the leg) round the shoe to the inside of it; the
/// trouser leg ends with `hem`, outside and inside.
pub(crate) fn leg_rays(leg: &Leg, knee: f64, hem: [Ray; 2], shoe: &[Ray]) -> Vec<Ray> {
    let sign = leg.side.sign();
    let across = |name, across: f64| (name, leg.limb.place(knee, 0.0), leg.limb.place(knee, across));
    let [outside, inside] = hem;
    let mut rays = vec![across("knee_outside", -sign), outside];
    rays.extend(
        shoe.iter()
            .map(|&(name, from, to)| (name, leg.foot * from, leg.foot * to)),
    );
    rays.extend([inside, across("knee_inside", sign)]);
    rays
}
