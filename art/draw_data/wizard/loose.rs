//! What hangs on nothing: the hat, the sparks, the drop.

use kurbo::{Affine, BezPath, Point, Vec2};

use super::body::wand_tip;
use super::posture::Posture;
use super::{FINE, INK, LINE, outlined};
use crate::canvas::{Canvas, moved};
use crate::curves::{at, brush, smooth_through};
use crate::figure::{Side, Skeleton};

pub(super) fn draw_hat(canvas: &mut Canvas, head: Affine, posture: &Posture) {
    let (lift, turn_deg) = posture.hat;
    let frame = head * Affine::translate((0.0, -158.0 - lift)) * Affine::rotate(turn_deg.to_radians());
    let mut hat = BezPath::new();
    smooth_through(
        &mut hat,
        &[
            at(-70.0, 8.0),
            at(-52.0, -4.0),
            at(-38.0, -12.0),
            at(-24.0, -52.0),
            at(-2.0, -88.0),
        ],
    );
    smooth_through(&mut hat, &[at(-2.0, -88.0), at(22.0, -98.0), at(40.0, -84.0)]);
    smooth_through(
        &mut hat,
        &[
            at(40.0, -84.0),
            at(26.0, -76.0),
            at(24.0, -54.0),
            at(38.0, -12.0),
            at(54.0, -4.0),
            at(70.0, 8.0),
        ],
    );
    smooth_through(
        &mut hat,
        &[
            at(70.0, 8.0),
            at(40.0, 17.0),
            at(0.0, 21.0),
            at(-40.0, 17.0),
            at(-70.0, 8.0),
        ],
    );
    hat.close_path();
    let hat = moved(frame, &hat);
    outlined(canvas, &hat, LINE);
    let band = [
        at(-40.0, -12.0),
        at(0.0, -4.0),
        at(40.0, -12.0),
        at(34.0, -30.0),
        at(0.0, -22.0),
        at(-34.0, -30.0),
    ];
    canvas.fill_inside(&moved(frame, &crate::curves::polygon(&band)), &hat, INK);
    let place = frame * at(-2.0, -54.0);
    canvas.fill(&star(place, 14.0), INK);
}

/// Sparks of four rays, and of no other filling than paper.
pub(super) fn draw_sparks(canvas: &mut Canvas, skeleton: &Skeleton, posture: &Posture) {
    let tip = wand_tip(skeleton.arm(Side::Right));
    for (place, size) in posture.sparks {
        outlined(canvas, &star(tip + place, size), FINE);
    }
}

pub(super) fn draw_drop(canvas: &mut Canvas, head: Affine, posture: &Posture) {
    if posture.sweats {
        let mut drop = BezPath::new();
        smooth_through(
            &mut drop,
            &[
                at(-100.0, -176.0),
                at(-93.0, -154.0),
                at(-97.0, -139.0),
                at(-110.0, -135.0),
                at(-120.0, -144.0),
                at(-116.0, -158.0),
                at(-100.0, -176.0),
            ],
        );
        drop.close_path();
        outlined(canvas, &moved(head, &drop), FINE);
        let light = [at(-112.0, -152.0), at(-112.0, -146.0), at(-108.0, -142.0)];
        canvas.fill(&moved(head, &brush(&light, 3.0, 2.0)), INK);
    }
}

/// A star of four rays.
fn star(middle: Point, size: f64) -> BezPath {
    let ray = |k: i32| {
        let angle_rad = std::f64::consts::FRAC_PI_4 * f64::from(k);
        let reach = if k % 2 == 0 { size } else { 0.36 * size };
        middle + Vec2::new(angle_rad.sin(), -angle_rad.cos()) * reach
    };
    let mut path = BezPath::new();
    path.move_to(ray(0));
    for k in 0..4 {
        path.quad_to(ray(2 * k + 1), ray(2 * k + 2));
    }
    path.close_path();
    path
}
