//! The face, the hair under the cap, and the cap with its pompom.

use kurbo::{Affine, BezPath, Circle, Ellipse, Point, Shape, Vec2};

use super::posture::Posture;
use super::style::{CHEEK, CREAM, FINE, HAIR, HAT, INK, LINE, MOUTH, RIB, SKIN, TONGUE};
use crate::canvas::{Canvas, moved};
use crate::curves::{Limb, at, brush, hanging, smooth_closed};
use crate::figure::Mouth;

pub(super) fn draw_head(canvas: &mut Canvas, head: Affine, posture: &Posture) {
    let place = |path: BezPath| moved(head, &path);
    let ears: Vec<BezPath> = [-1.0, 1.0]
        .map(|sign| place(Ellipse::new((88.0 * sign, -58.0), (17.0, 20.0), 0.0).to_path(0.05)))
        .into();
    let face = place(smooth_closed(&[
        at(0.0, 4.0),
        at(48.0, -6.0),
        at(80.0, -36.0),
        at(88.0, -74.0),
        at(84.0, -116.0),
        at(0.0, -150.0),
        at(-84.0, -116.0),
        at(-88.0, -74.0),
        at(-80.0, -36.0),
        at(-48.0, -6.0),
    ]));
    for part in ears.iter().chain([&face]) {
        canvas.ink(part, LINE, INK);
    }
    for part in ears.iter().chain([&face]) {
        canvas.fill(part, SKIN);
    }
    let shade = place(smooth_closed(&[
        at(-60.0, 14.0),
        at(-40.0, -8.0),
        at(0.0, -6.0),
        at(46.0, -18.0),
        at(70.0, -44.0),
        at(76.0, -90.0),
        at(110.0, -90.0),
        at(100.0, -10.0),
        at(20.0, 30.0),
    ]));
    canvas.shade(&shade, &face);
    for sign in [-1.0, 1.0] {
        let inner = brush(
            &[at(90.0 * sign, -68.0), at(97.0 * sign, -60.0), at(91.0 * sign, -50.0)],
            FINE * 1.2,
            2.0,
        );
        canvas.fill(&place(inner), [0xd9, 0x83, 0x6c]);
        canvas.fill(
            &place(Ellipse::new((54.0 * sign, -36.0), (15.0, 10.0), 0.0).to_path(0.05)),
            CHEEK,
        );
    }
    draw_features(canvas, head, posture);
    // Hair under the cap.
    let fringe = place(smooth_closed(&[
        at(-86.0, -120.0),
        at(-84.0, -84.0),
        at(-76.0, -70.0),
        at(-66.0, -88.0),
        at(-48.0, -98.0),
        at(-30.0, -90.0),
        at(-6.0, -101.0),
        at(22.0, -93.0),
        at(48.0, -101.0),
        at(68.0, -88.0),
        at(77.0, -70.0),
        at(84.0, -84.0),
        at(86.0, -120.0),
        at(0.0, -146.0),
    ]));
    canvas.ink(&fringe, FINE * 0.5, INK);
    canvas.fill(&fringe, HAIR);
}

fn draw_features(canvas: &mut Canvas, head: Affine, posture: &Posture) {
    let place = |path: BezPath| moved(head, &path);
    let look = posture.look;
    for sign in [-1.0, 1.0] {
        let middle = at(35.0 * sign, -68.0) + look;
        canvas.fill(&place(Ellipse::new(middle, (10.5, 15.0), 0.0).to_path(0.05)), INK);
        canvas.fill(
            &place(Circle::new(middle + Vec2::new(3.5, -6.0), 4.2).to_path(0.05)),
            CREAM,
        );
        canvas.fill(
            &place(Circle::new(middle + Vec2::new(-3.5, 6.0), 2.1).to_path(0.05)),
            CREAM,
        );
    }
    let nose = brush(
        &[at(-9.0, -47.0), at(-3.0, -42.0), at(4.0, -42.0), at(10.0, -47.0)],
        FINE * 1.3,
        FINE * 0.7,
    );
    canvas.fill(&place(nose), [0xc9, 0x6b, 0x55]);
    match posture.body.mouth {
        Mouth::Smile => {
            let line = [
                at(-28.0, -30.0),
                at(-16.0, -21.0),
                at(0.0, -17.5),
                at(16.0, -21.0),
                at(28.0, -30.0),
            ];
            canvas.fill(&place(brush(&line, FINE * 1.5, FINE * 0.9)), INK);
        }
        Mouth::Open => {
            let mouth = place(smooth_closed(&[
                at(-28.0, -31.0),
                at(0.0, -27.0),
                at(28.0, -31.0),
                at(22.0, -16.0),
                at(0.0, -8.0),
                at(-22.0, -16.0),
            ]));
            canvas.ink(&mouth, FINE * 0.6, INK);
            canvas.fill(&mouth, MOUTH);
            let tongue = place(Ellipse::new((0.0, -8.0), (15.0, 9.0), 0.0).to_path(0.05));
            canvas.fill_inside(&tongue, &mouth, TONGUE);
        }
    }
}

/// How high the middles of the mouth's upper and lower line lie, in the head's coordinates.
pub(super) fn lips(mouth: Mouth) -> [f64; 2] {
    match mouth {
        Mouth::Smile => [-21.0, -14.0],
        Mouth::Open => [-29.0, -6.0],
    }
}

/// The pompom's middle and the point above it in the direction of the cap's tip.
pub(super) fn pompom_axis(head: Affine, flop_deg: f64) -> [Point; 2] {
    let (pompom, direction) = cap_end(flop_deg);
    [head * pompom, head * (pompom + direction * POMPOM_RADIUS)]
}

/// The cap's soft tip with its pompom; it lies behind the cap's dome.
pub(super) fn draw_cap_tip(canvas: &mut Canvas, head: Affine, flop_deg: f64) {
    let (tip, pompom) = cap_tip(flop_deg);
    let (tip, pompom) = (
        moved(head, &tip.body()),
        Circle::new(head * pompom, POMPOM_RADIUS).to_path(0.05),
    );
    canvas.ink(&tip, LINE, INK);
    canvas.ink(&pompom, LINE, INK);
    canvas.fill(&tip, HAT);
}

const POMPOM_RADIUS: f64 = 22.0;
/// Where the cap's tip begins to flop over.
const CAP_BEND: Point = Point::new(2.0, -188.0);

fn cap_tip(flop_deg: f64) -> (Limb, Point) {
    let root = at(0.0, -140.0);
    let (pompom, direction) = cap_end(flop_deg);
    let end = pompom - direction * (POMPOM_RADIUS - 6.0);
    (Limb::new([root, CAP_BEND, end], [60.0, 30.0, 13.0], 0.9), pompom)
}

/// The middle of the pompom, and the direction in which the cap's tip points there.
fn cap_end(flop_deg: f64) -> (Point, Vec2) {
    let direction = -hanging(-flop_deg);
    (CAP_BEND + direction * (32.0 + POMPOM_RADIUS), direction)
}

pub(super) fn draw_cap(canvas: &mut Canvas, head: Affine, flop_deg: f64) {
    let place = |path: BezPath| moved(head, &path);
    let dome = place(smooth_closed(&[
        at(-86.0, -112.0),
        at(-74.0, -144.0),
        at(-40.0, -166.0),
        at(0.0, -173.0),
        at(40.0, -166.0),
        at(74.0, -144.0),
        at(86.0, -112.0),
        at(0.0, -126.0),
    ]));
    canvas.ink(&dome, LINE, INK);
    let (tip, pompom) = cap_tip(flop_deg);
    canvas.fill(&place(tip.body()), HAT);
    canvas.fill(&dome, HAT);
    let shade = place(smooth_closed(&[
        at(96.0, -100.0),
        at(56.0, -124.0),
        at(50.0, -150.0),
        at(28.0, -170.0),
        at(60.0, -180.0),
        at(110.0, -140.0),
    ]));
    canvas.shade(&shade, &dome);
    let ball = Circle::new(head * pompom, POMPOM_RADIUS).to_path(0.05);
    canvas.ink(&ball, LINE * 0.7, INK);
    canvas.fill(&ball, CREAM);
    let under = Circle::new(head * (pompom + Vec2::new(9.0, 10.0)), POMPOM_RADIUS).to_path(0.05);
    canvas.shade(&under, &ball);
    let light = Circle::new(head * (pompom - Vec2::new(4.0, 4.0)), POMPOM_RADIUS).to_path(0.05);
    canvas.fill_inside(&light, &ball, CREAM);
    let brim = place(smooth_closed(&[
        at(-92.0, -100.0),
        at(-93.0, -118.0),
        at(-82.0, -130.0),
        at(-40.0, -139.0),
        at(0.0, -142.0),
        at(40.0, -139.0),
        at(82.0, -130.0),
        at(93.0, -118.0),
        at(92.0, -100.0),
        at(80.0, -94.0),
        at(40.0, -104.0),
        at(0.0, -107.0),
        at(-40.0, -104.0),
        at(-80.0, -94.0),
    ]));
    canvas.ink(&brim, LINE * 0.8, INK);
    canvas.fill(&brim, CREAM);
    let under = place(smooth_closed(&[
        at(100.0, -90.0),
        at(60.0, -92.0),
        at(58.0, -120.0),
        at(66.0, -140.0),
        at(110.0, -130.0),
    ]));
    canvas.shade(&under, &brim);
    for x in [-66.0_f64, -40.0, -14.0, 14.0, 40.0, 66.0] {
        let drop = 0.0017 * x * x;
        let rib = brush(
            &[at(x * 0.98, -131.0 + drop), at(x, -123.0 + drop), at(x, -115.0 + drop)],
            FINE * 0.8,
            1.4,
        );
        canvas.fill(&place(rib), RIB);
    }
}
