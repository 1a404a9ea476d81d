//! Shoes, trousers, mittens, sweater and scarf.

use kurbo::{Affine, BezPath, Ellipse, Rect, RoundedRect, Shape};

use super::style::{CREAM, FINE, HAT, INK, LINE, SCARF, SHOE, SWEATER, TROUSERS, TURN_UP};
use crate::canvas::{Canvas, moved};
use crate::curves::{at, brush, polygon, smooth_closed, smooth_through};
use crate::figure::{Arm, Leg};

pub(super) fn draw_shoes(canvas: &mut Canvas, legs: &[Leg; 2]) {
    let upper = smooth_closed(&[
        at(-27.0, 30.0),
        at(-26.0, 6.0),
        at(-20.0, -10.0),
        at(4.0, -13.0),
        at(24.0, -6.0),
        at(44.0, 4.0),
        at(64.0, 8.0),
        at(78.0, 20.0),
        at(76.0, 31.0),
        at(40.0, 33.0),
        at(0.0, 33.0),
    ]);
    let sole = RoundedRect::from_rect(Rect::new(-32.0, 26.0, 84.0, 40.0), 7.0).to_path(0.05);
    for leg in legs {
        let (upper, sole) = (moved(leg.foot, &upper), moved(leg.foot, &sole));
        canvas.ink(&upper, LINE, INK);
        canvas.ink(&sole, LINE, INK);
        canvas.fill(&upper, SHOE);
        let heel = moved(leg.foot, &Ellipse::new((-30.0, 22.0), (26.0, 40.0), 0.0).to_path(0.05));
        canvas.shade(&heel, &upper);
        let cap = moved(leg.foot, &Ellipse::new((82.0, 34.0), (28.0, 30.0), 0.0).to_path(0.05));
        canvas.fill_inside(&cap, &upper, CREAM);
        canvas.ink(&sole, FINE * 0.5, INK);
        canvas.fill(&sole, CREAM);
        for x in [22.0, 34.0, 46.0] {
            let lace = [
                at(x, 2.0 + 0.25 * (x - 22.0)),
                at(x - 4.0, 10.0 + 0.2 * (x - 22.0)),
                at(x - 5.0, 19.0),
            ];
            canvas.fill(&moved(leg.foot, &brush(&lace, 4.2, 2.6)), CREAM);
        }
    }
}

pub(super) fn draw_trousers(canvas: &mut Canvas, torso: Affine, legs: &[Leg; 2]) {
    let seat = moved(
        torso,
        &smooth_closed(&[
            at(-60.0, -30.0),
            at(0.0, -40.0),
            at(60.0, -30.0),
            at(59.0, 6.0),
            at(36.0, 20.0),
            at(0.0, 25.0),
            at(-36.0, 20.0),
            at(-59.0, 6.0),
        ]),
    );
    let mut parts = vec![seat];
    for leg in legs {
        parts.extend(leg.parts());
    }
    for part in &parts {
        canvas.ink(part, LINE, INK);
    }
    for part in &parts {
        canvas.fill(part, TROUSERS);
    }
    for leg in legs {
        // Turned-up hem.
        let hem = leg.limb.patch(0.87, 1.0, -1.14, 1.14);
        canvas.ink(&hem, LINE * 0.75, INK);
        canvas.fill(&hem, TURN_UP);
        canvas.shade(&leg.limb.shadow(0.05, -1.0), &leg.limb.patch(0.0, 1.0, -1.14, 1.14));
    }
}

pub(super) fn draw_hand(canvas: &mut Canvas, arm: &Arm) {
    let mitten = moved(
        arm.hand,
        &smooth_closed(&[
            at(0.0, -19.0),
            at(22.0, -27.0),
            at(48.0, -27.0),
            at(68.0, -14.0),
            at(72.0, 4.0),
            at(64.0, 20.0),
            at(46.0, 25.0),
            at(41.0, 31.0),
            at(46.0, 44.0),
            at(40.0, 56.0),
            at(26.0, 57.0),
            at(14.0, 44.0),
            at(6.0, 24.0),
            at(-4.0, 10.0),
        ]),
    );
    canvas.ink(&mitten, LINE, INK);
    canvas.fill(&mitten, HAT);
    let shade = moved(
        arm.hand,
        &smooth_closed(&[
            at(0.0, -40.0),
            at(80.0, -40.0),
            at(90.0, 0.0),
            at(66.0, -8.0),
            at(48.0, -17.0),
            at(20.0, -18.0),
            at(0.0, -10.0),
        ]),
    );
    canvas.shade(&shade, &mitten);
    let crease = moved(
        arm.hand,
        &brush(&[at(39.0, 30.0), at(33.0, 23.0), at(30.0, 14.0)], FINE, FINE * 0.7),
    );
    canvas.fill(&crease, INK);
}

fn draw_cuff(canvas: &mut Canvas, arm: &Arm) {
    let cuff = moved(arm.hand, &RoundedRect::new(-12.0, -23.0, 9.0, 23.0, 8.0).to_path(0.05));
    canvas.ink(&cuff, LINE * 0.8, INK);
    canvas.fill(&cuff, CREAM);
    let shade = moved(arm.hand, &RoundedRect::new(-12.0, -23.0, 9.0, -8.0, 4.0).to_path(0.05));
    canvas.shade(&shade, &cuff);
}

pub(super) fn draw_sweater(canvas: &mut Canvas, torso: Affine, arms: &[Arm; 2]) {
    let trunk = moved(
        torso,
        &smooth_closed(&[
            at(-64.0, -10.0),
            at(-66.0, -40.0),
            at(-62.0, -90.0),
            at(-54.0, -128.0),
            at(-34.0, -146.0),
            at(0.0, -150.0),
            at(34.0, -146.0),
            at(54.0, -128.0),
            at(62.0, -90.0),
            at(66.0, -40.0),
            at(64.0, -10.0),
            at(0.0, -3.0),
        ]),
    );
    let mut parts = vec![trunk.clone()];
    for arm in arms {
        parts.extend(arm.parts());
    }
    for part in &parts {
        canvas.ink(part, LINE, INK);
    }
    for part in &parts {
        canvas.fill(part, SWEATER);
    }
    for arm in arms {
        canvas.fill(&arm.limb.patch(0.55, 0.69, -1.0, 1.0), CREAM);
        // The side away from the thumb lies in shadow.
        canvas.shade(&arm.limb.shadow(0.22, arm.side.sign()), &arm.limb.body());
    }
    for (top, bottom) in [(-72.0, -50.0), (-22.0, 10.0)] {
        let mut stripe = BezPath::new();
        smooth_through(&mut stripe, &[at(-80.0, top), at(0.0, top + 6.0), at(80.0, top)]);
        stripe.line_to(at(80.0, bottom));
        smooth_through(
            &mut stripe,
            &[at(80.0, bottom), at(0.0, bottom + 6.0), at(-80.0, bottom)],
        );
        stripe.close_path();
        canvas.fill_inside(&moved(torso, &stripe), &trunk, CREAM);
    }
    let side = [
        at(80.0, 10.0),
        at(38.0, 10.0),
        at(50.0, -50.0),
        at(46.0, -96.0),
        at(58.0, -130.0),
        at(90.0, -60.0),
    ];
    canvas.shade(&moved(torso, &smooth_closed(&side)), &trunk);
    for arm in arms {
        draw_cuff(canvas, arm);
    }
    // Where the sleeves meet the body: a short crease.
    for sign in [-1.0, 1.0] {
        let crease = brush(
            &[at(60.0 * sign, -92.0), at(54.0 * sign, -102.0), at(50.0 * sign, -114.0)],
            FINE,
            1.6,
        );
        canvas.fill(&moved(torso, &crease), INK);
    }
}

pub(super) fn draw_scarf(canvas: &mut Canvas, torso: Affine) {
    let tail = moved(
        torso,
        &smooth_closed(&[
            at(8.0, -140.0),
            at(30.0, -140.0),
            at(36.0, -110.0),
            at(42.0, -80.0),
            at(26.0, -74.0),
            at(10.0, -80.0),
            at(10.0, -110.0),
        ]),
    );
    canvas.ink(&tail, FINE, INK);
    canvas.fill(&tail, SCARF);
    let fringe = moved(
        torso,
        &polygon(&[at(0.0, -92.0), at(50.0, -96.0), at(50.0, -88.0), at(0.0, -84.0)]),
    );
    canvas.fill_inside(&fringe, &tail, CREAM);
    let wrap = moved(
        torso,
        &smooth_closed(&[
            at(-54.0, -150.0),
            at(-50.0, -162.0),
            at(0.0, -160.0),
            at(50.0, -162.0),
            at(54.0, -150.0),
            at(44.0, -134.0),
            at(0.0, -122.0),
            at(-44.0, -134.0),
        ]),
    );
    canvas.ink(&wrap, LINE * 0.8, INK);
    canvas.fill(&wrap, SCARF);
    let shade = moved(
        torso,
        &smooth_closed(&[
            at(-46.0, -160.0),
            at(0.0, -146.0),
            at(46.0, -160.0),
            at(40.0, -170.0),
            at(-40.0, -170.0),
        ]),
    );
    canvas.shade(&shade, &wrap);
}
