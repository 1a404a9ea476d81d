//! Boots and trousers, mittens, the wand, the coat and the scarf.

use kurbo::{Affine, BezPath, Circle, Point, Rect, Shape};

use super::{FINE, INK, LINE, PAPER, outlined};
use crate::canvas::{Canvas, moved};
use crate::curves::{at, brush, polygon, smooth_closed};
use crate::figure::{Arm, Leg, Side, Skeleton};

/// The wand in the hand's coordinates: from its lower end to its tip.
const WAND: [Point; 2] = [Point::new(33.0, -46.0), Point::new(39.0, 92.0)];

/// The tip of the wand.
pub(super) fn wand_tip(arm: &Arm) -> Point {
    arm.hand * WAND[1]
}

pub(super) fn draw_legs(canvas: &mut Canvas, skeleton: &Skeleton) {
    for leg in &skeleton.legs {
        draw_boot(canvas, leg);
    }
    for leg in &skeleton.legs {
        let parts = leg.parts();
        for part in &parts {
            canvas.nib(part, LINE, INK);
        }
        for part in &parts {
            canvas.fill(part, PAPER);
        }
        // Striped trousers.
        for along in [0.42, 0.58, 0.74, 0.90] {
            let stripe = leg.limb.patch(along, along + 0.07, -1.0, 1.0);
            canvas.fill(&stripe, INK);
        }
    }
}

fn draw_boot(canvas: &mut Canvas, leg: &Leg) {
    let boot = moved(
        leg.foot,
        &smooth_closed(&[
            at(-27.0, 32.0),
            at(-27.0, 8.0),
            at(-24.0, -12.0),
            at(0.0, -16.0),
            at(22.0, -10.0),
            at(32.0, 4.0),
            at(56.0, 6.0),
            at(78.0, -6.0),
            at(86.0, 4.0),
            at(78.0, 30.0),
            at(40.0, 35.0),
            at(0.0, 34.0),
        ]),
    );
    canvas.fill(&boot, INK);
    canvas.nib(&boot, LINE, INK);
    let shine = [at(34.0, 13.0), at(48.0, 14.0), at(62.0, 9.0)];
    canvas.fill(&moved(leg.foot, &brush(&shine, 5.0, 2.5)), PAPER);
}

pub(super) fn draw_hand(canvas: &mut Canvas, arm: &Arm) {
    let hand = moved(
        arm.hand,
        &smooth_closed(&[
            at(-4.0, -15.0),
            at(18.0, -25.0),
            at(44.0, -26.0),
            at(62.0, -14.0),
            at(66.0, 4.0),
            at(56.0, 19.0),
            at(44.0, 22.0),
            at(40.0, 28.0),
            at(36.0, 44.0),
            at(24.0, 45.0),
            at(14.0, 32.0),
            at(-4.0, 15.0),
        ]),
    );
    outlined(canvas, &hand, LINE);
    for (from, to) in [(at(62.0, -8.0), at(46.0, -7.0)), (at(62.0, 7.0), at(47.0, 6.0))] {
        let line = brush(&[from, from.midpoint(to), to], FINE * 0.8, FINE * 0.5);
        canvas.fill(&moved(arm.hand, &line), INK);
    }
}

/// The wand lies over the palm, and the thumb over the wand.
pub(super) fn draw_wand(canvas: &mut Canvas, skeleton: &Skeleton) {
    let arm = skeleton.arm(Side::Right);
    let [end, tip] = WAND;
    let along = (tip - end).normalize();
    let across = kurbo::Vec2::new(along.y, -along.x) * 5.5;
    let white = tip - along * 24.0;
    let rod = moved(
        arm.hand,
        &polygon(&[end + across, tip + across, tip - across, end - across]),
    );
    canvas.fill(&rod, INK);
    canvas.nib(&rod, FINE, INK);
    let light = moved(
        arm.hand,
        &polygon(&[white + across, tip + across, tip - across, white - across]),
    );
    canvas.fill(&light, PAPER);
    canvas.nib(&light, FINE * 0.8, INK);
    let thumb = smooth_closed(&[
        at(12.0, 22.0),
        at(28.0, 14.0),
        at(46.0, 16.0),
        at(51.0, 25.0),
        at(42.0, 32.0),
        at(24.0, 36.0),
    ]);
    outlined(canvas, &moved(arm.hand, &thumb), FINE);
}

pub(super) fn draw_coat(canvas: &mut Canvas, skeleton: &Skeleton) {
    let torso = skeleton.torso;
    let place = |path: &BezPath| moved(torso, path);
    let coat = place(&smooth_closed(&[
        at(0.0, 34.0),
        at(48.0, 30.0),
        at(78.0, 18.0),
        at(70.0, -24.0),
        at(60.0, -66.0),
        at(60.0, -104.0),
        at(40.0, -134.0),
        at(0.0, -142.0),
        at(-40.0, -134.0),
        at(-60.0, -104.0),
        at(-60.0, -66.0),
        at(-70.0, -24.0),
        at(-78.0, 18.0),
        at(-48.0, 30.0),
    ]));
    let sleeves = skeleton.arms.each_ref().map(Arm::parts);
    for part in sleeves.iter().flatten().chain([&coat]) {
        canvas.nib(part, LINE, INK);
    }
    for part in sleeves.iter().flatten().chain([&coat]) {
        canvas.fill(part, PAPER);
    }
    let middle = brush(
        &[at(0.0, -124.0), at(2.0, -60.0), at(3.0, 0.0), at(4.0, 32.0)],
        FINE * 0.8,
        FINE * 0.5,
    );
    canvas.fill(&place(&middle), INK);
    let belt = Rect::new(-90.0, -40.0, 90.0, -18.0).to_path(0.05);
    canvas.fill_inside(&place(&belt), &coat, INK);
    let buckle = Rect::new(-13.0, -38.0, 15.0, -20.0).to_path(0.05);
    canvas.fill(&place(&buckle), PAPER);
    canvas.fill(&place(&Rect::new(-4.0, -32.0, 7.0, -26.0).to_path(0.05)), INK);
    for y in [-92.0, -64.0] {
        let button = place(&Circle::new((16.0, y), 6.5).to_path(0.05));
        canvas.fill(&button, INK);
    }
    let pocket = [at(30.0, 0.0), at(56.0, 0.0), at(58.0, 18.0), at(32.0, 21.0)];
    canvas.nib(&place(&polygon(&pocket)), FINE * 0.7, INK);
    let patch = [at(-56.0, -6.0), at(-40.0, -8.0), at(-36.0, 8.0), at(-54.0, 11.0)];
    canvas.nib(&place(&polygon(&patch)), FINE * 0.7, INK);
    for k in 0..4 {
        let x = -62.0 + 4.0 * f64::from(k);
        let hatch = [
            at(x, -88.0 + 7.0 * f64::from(k)),
            at(x + 8.0, -94.0 + 7.0 * f64::from(k)),
            at(x + 16.0, -102.0 + 7.0 * f64::from(k)),
        ];
        canvas.fill_inside(&place(&brush(&hatch, 3.2, 1.6)), &coat, INK);
    }
    for arm in &skeleton.arms {
        let cuff = arm.limb.patch(0.80, 0.90, -1.0, 1.0);
        canvas.fill(&cuff, INK);
        let sign = arm.side.sign();
        let fold = |along: f64, across: f64| arm.limb.place(along, across * sign);
        let crease = brush(&[fold(0.38, 0.95), fold(0.44, 0.55), fold(0.46, 0.1)], FINE * 0.8, 1.8);
        canvas.fill(&crease, INK);
    }
}

/// A striped scarf around the neck, with one end that hangs.
pub(super) fn draw_scarf(canvas: &mut Canvas, torso: Affine) {
    let place = |points: &[Point]| moved(torso, &smooth_closed(points));
    let end = place(&[
        at(-36.0, -132.0),
        at(-14.0, -130.0),
        at(-12.0, -96.0),
        at(-14.0, -66.0),
        at(-38.0, -66.0),
        at(-37.0, -98.0),
    ]);
    let around = place(&[
        at(-52.0, -146.0),
        at(0.0, -136.0),
        at(52.0, -146.0),
        at(58.0, -132.0),
        at(46.0, -120.0),
        at(0.0, -110.0),
        at(-46.0, -120.0),
        at(-58.0, -132.0),
    ]);
    outlined(canvas, &end, LINE);
    for y in [-104.0, -84.0] {
        let stripe = Rect::new(-60.0, y, 0.0, y + 9.0).to_path(0.05);
        canvas.fill_inside(&moved(torso, &stripe), &end, INK);
    }
    outlined(canvas, &around, LINE);
    for x in [-40.0, -12.0, 16.0, 44.0] {
        let stripe = polygon(&[
            at(x - 5.0, -160.0),
            at(x + 5.0, -160.0),
            at(x + 3.0, -100.0),
            at(x - 7.0, -100.0),
        ]);
        canvas.fill_inside(&moved(torso, &stripe), &around, INK);
    }
}
