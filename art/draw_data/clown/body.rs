//! Shoes, gloves, the two-coloured suit and the ruff.

use kurbo::{Affine, BezPath, Circle, Ellipse, Point, Rect, RoundedRect, Shape};

use super::{FINE, INK, LINE, RED, TEAL, WHITE, YELLOW};
use crate::canvas::{Canvas, moved};
use crate::curves::{at, brush, polygon, smooth_closed};
use crate::figure::{Arm, Leg, Side, Skeleton};

/// Where the trouser leg ends, its x axis across.
pub(super) fn hem(leg: &Leg) -> Affine {
    Affine::translate((leg.ankle - leg.shin * 6.0).to_vec2())
        * Affine::rotate(leg.shin.atan2() - std::f64::consts::FRAC_PI_2)
}

pub(super) fn draw_shoe(canvas: &mut Canvas, leg: &Leg) {
    let upper = moved(
        leg.foot,
        &smooth_closed(&[
            at(-34.0, 30.0),
            at(-35.0, 6.0),
            at(-26.0, -14.0),
            at(4.0, -18.0),
            at(32.0, -6.0),
            at(56.0, -8.0),
            at(84.0, -20.0),
            at(110.0, -8.0),
            at(117.0, 14.0),
            at(108.0, 31.0),
            at(60.0, 33.0),
            at(0.0, 33.0),
        ]),
    );
    let sole = moved(
        leg.foot,
        &RoundedRect::from_rect(Rect::new(-38.0, 26.0, 118.0, 41.0), 7.0).to_path(0.05),
    );
    canvas.ink(&upper, LINE, INK);
    canvas.ink(&sole, LINE, INK);
    canvas.fill(&upper, RED);
    let toe = moved(leg.foot, &Circle::new((104.0, 8.0), 36.0).to_path(0.05));
    canvas.fill_inside(&toe, &upper, YELLOW);
    let under = moved(leg.foot, &Ellipse::new((30.0, 40.0), (110.0, 17.0), 0.0).to_path(0.05));
    canvas.shade(&under, &upper);
    canvas.ink(&sole, FINE * 0.5, INK);
    canvas.fill(&sole, WHITE);
    for x in [26.0, 42.0, 58.0] {
        let lace = [at(x + 4.0, -8.0), at(x, 2.0), at(x - 1.0, 12.0)];
        canvas.fill(&moved(leg.foot, &brush(&lace, 5.0, 3.2)), WHITE);
    }
}

/// A four-fingered glove with its fingers together.
pub(super) fn draw_glove(canvas: &mut Canvas, arm: &Arm) {
    let glove = moved(
        arm.hand,
        &smooth_closed(&[
            at(0.0, -17.0),
            at(18.0, -26.0),
            at(44.0, -31.0),
            at(62.0, -26.0),
            at(70.0, -14.0),
            at(75.0, 0.0),
            at(71.0, 14.0),
            at(58.0, 22.0),
            at(44.0, 23.0),
            at(40.0, 29.0),
            at(44.0, 44.0),
            at(38.0, 55.0),
            at(25.0, 55.0),
            at(14.0, 42.0),
            at(5.0, 22.0),
            at(-4.0, 8.0),
        ]),
    );
    canvas.ink(&glove, LINE, INK);
    canvas.fill(&glove, WHITE);
    let shade = [
        at(0.0, -50.0),
        at(90.0, -50.0),
        at(72.0, -20.0),
        at(44.0, -22.0),
        at(16.0, -16.0),
    ];
    canvas.shade(&moved(arm.hand, &smooth_closed(&shade)), &glove);
    for (from, to) in [(at(72.0, -11.0), at(50.0, -9.0)), (at(73.0, 9.0), at(52.0, 7.0))] {
        let line = brush(&[from, from.midpoint(to), to], FINE, FINE * 0.7);
        canvas.fill(&moved(arm.hand, &line), INK);
    }
}

/// A frill: a closed curve around `[0, 0]` with `lobes` lobes.
fn frill(half_width: f64, half_height: f64, lobes: usize) -> BezPath {
    let points: Vec<Point> = (0..2 * lobes)
        .map(|k| {
            let angle_rad = std::f64::consts::PI * k as f64 / lobes as f64;
            let reach = if k % 2 == 0 { 1.0 } else { 0.86 };
            at(
                half_width * reach * angle_rad.cos(),
                half_height * reach * angle_rad.sin(),
            )
        })
        .collect();
    smooth_closed(&points)
}

pub(super) fn draw_suit(canvas: &mut Canvas, skeleton: &Skeleton) {
    let (torso, legs, arms) = (skeleton.torso, &skeleton.legs, &skeleton.arms);
    let trunk = moved(
        torso,
        &smooth_closed(&[
            at(0.0, 36.0),
            at(48.0, 30.0),
            at(78.0, 2.0),
            at(84.0, -42.0),
            at(74.0, -92.0),
            at(58.0, -130.0),
            at(0.0, -148.0),
            at(-58.0, -130.0),
            at(-74.0, -92.0),
            at(-84.0, -42.0),
            at(-78.0, 2.0),
            at(-48.0, 30.0),
        ]),
    );
    let leg_parts = legs.each_ref().map(Leg::parts);
    let arm_parts = arms.each_ref().map(Arm::parts);
    for part in leg_parts.iter().chain(&arm_parts).flatten().chain([&trunk]) {
        canvas.ink(part, LINE, INK);
    }
    for (leg, parts) in legs.iter().zip(&leg_parts) {
        for part in parts {
            canvas.fill(part, if leg.side == Side::Left { TEAL } else { YELLOW });
        }
        for (along, across) in [(0.5, -0.35), (0.74, 0.4)] {
            let dot = Circle::new(leg.limb.place(along, across), 8.5).to_path(0.05);
            canvas.fill_inside(&dot, &parts[0], WHITE);
        }
        canvas.shade(&leg.limb.shadow(0.3, -1.0), &parts[0]);
    }
    // The trunk covers where the legs begin, and the arms lie on the trunk's sides.
    canvas.fill(&trunk, TEAL);
    let half = |x: f64| {
        moved(
            torso,
            &polygon(&[at(0.0, -200.0), at(x, -200.0), at(x, 80.0), at(0.0, 80.0)]),
        )
    };
    canvas.fill_inside(&half(-200.0), &trunk, YELLOW);
    for (x, y) in [
        (-44.0, -6.0),
        (-58.0, -62.0),
        (-30.0, -98.0),
        (40.0, 2.0),
        (56.0, -50.0),
        (34.0, -92.0),
    ] {
        let dot = moved(torso, &Circle::new((x, y), 9.5).to_path(0.05));
        canvas.fill_inside(&dot, &trunk, if x < 0.0 { RED } else { WHITE });
    }
    let side = [
        at(100.0, 40.0),
        at(40.0, 40.0),
        at(66.0, -10.0),
        at(66.0, -80.0),
        at(50.0, -130.0),
        at(110.0, -90.0),
    ];
    canvas.shade(&moved(torso, &smooth_closed(&side)), &trunk);
    let half_width = 0.5 * FINE;
    let seam = polygon(&[
        at(-half_width, -160.0),
        at(half_width, -160.0),
        at(half_width, 40.0),
        at(-half_width, 40.0),
    ]);
    canvas.fill_inside(&moved(torso, &seam), &trunk, INK);
    for (arm, parts) in arms.iter().zip(&arm_parts) {
        for part in parts {
            canvas.fill(part, if arm.side == Side::Left { YELLOW } else { TEAL });
        }
        let dot = Circle::new(arm.limb.place(0.62, 0.1), 8.5).to_path(0.05);
        canvas.fill_inside(&dot, &parts[0], if arm.side == Side::Left { RED } else { WHITE });
        canvas.shade(&arm.limb.shadow(0.25, arm.side.sign()), &parts[0]);
        let fold = |across: f64| arm.limb.place(0.16, across * arm.side.sign());
        let crease = brush(&[fold(0.95), fold(0.5), fold(0.15)], FINE, 1.6);
        canvas.fill(&crease, INK);
    }
    for y in [-104.0, -64.0, -24.0] {
        let button = moved(torso, &Circle::new((0.0, y), 14.0).to_path(0.05));
        canvas.ink(&button, FINE * 0.7, INK);
        canvas.fill(&button, RED);
        let light = moved(torso, &Circle::new((-4.0, y - 5.0), 4.0).to_path(0.05));
        canvas.fill(&light, WHITE);
    }
    for leg in legs {
        let (frame, shade) = (hem(leg), Ellipse::new((0.0, 14.0), (44.0, 11.0), 0.0).to_path(0.05));
        let hem = moved(frame, &frill(41.0, 15.0, 9));
        canvas.ink(&hem, LINE * 0.8, INK);
        canvas.fill(&hem, WHITE);
        canvas.shade(&moved(frame, &shade), &hem);
    }
    for arm in arms {
        let cuff = moved(arm.hand * Affine::translate((-4.0, 0.0)), &frill(14.0, 34.0, 8));
        canvas.ink(&cuff, LINE * 0.8, INK);
        canvas.fill(&cuff, WHITE);
        let shade = Ellipse::new((-4.0, -30.0), (20.0, 14.0), 0.0).to_path(0.05);
        canvas.shade(&moved(arm.hand, &shade), &cuff);
    }
}

pub(super) fn draw_ruff(canvas: &mut Canvas, torso: Affine) {
    let frame = torso * Affine::translate((0.0, -142.0));
    let ruff = moved(frame, &frill(82.0, 30.0, 11));
    canvas.ink(&ruff, LINE, INK);
    canvas.fill(&ruff, WHITE);
    canvas.shade(
        &moved(frame, &Ellipse::new((0.0, -10.0), (64.0, 24.0), 0.0).to_path(0.05)),
        &ruff,
    );
    for k in 0..9 {
        let angle_rad = std::f64::consts::PI * (f64::from(k) + 1.0) / 10.0;
        let on = |reach: f64| at(82.0 * reach * angle_rad.cos(), 30.0 * reach * angle_rad.sin());
        let pleat = brush(&[on(0.6), on(0.7), on(0.84)], FINE * 0.8, 1.4);
        canvas.fill(&moved(frame, &pleat), INK);
    }
}
