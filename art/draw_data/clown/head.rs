//! Face, hair and the little hat.

use kurbo::{Affine, BezPath, Circle, Ellipse, Shape, Vec2};

use super::{CHEEK, DARK, FINE, GREEN, INK, LINE, ORANGE, RED, SKIN, WHITE, YELLOW};
use crate::canvas::{Canvas, moved};
use crate::curves::{at, brush, smooth_closed};
use crate::figure::Mouth;

/// The balls of hair on the right side: middle and radius. The left side mirrors them.
const HAIR: [(f64, f64, f64); 4] = [
    (78.0, -112.0, 25.0),
    (98.0, -84.0, 27.0),
    (88.0, -54.0, 23.0),
    (62.0, -130.0, 20.0),
];

pub(super) fn draw(canvas: &mut Canvas, head: Affine, mouth: Mouth) {
    let place = |path: BezPath| moved(head, &path);
    let ball = |x: f64, y: f64, radius: f64| place(Circle::new((x, y), radius).to_path(0.05));
    let hair: Vec<BezPath> = HAIR
        .iter()
        .flat_map(|&(x, y, radius)| [ball(x, y, radius), ball(-x, y, radius)])
        .collect();
    let face = place(smooth_closed(&[
        at(0.0, 2.0),
        at(46.0, -6.0),
        at(76.0, -38.0),
        at(82.0, -80.0),
        at(66.0, -126.0),
        at(0.0, -152.0),
        at(-66.0, -126.0),
        at(-82.0, -80.0),
        at(-76.0, -38.0),
        at(-46.0, -6.0),
    ]));
    for part in hair.iter().chain([&face]) {
        canvas.ink(part, LINE, INK);
    }
    for part in &hair {
        canvas.fill(part, ORANGE);
    }
    for &(x, y, radius) in &HAIR {
        for sign in [-1.0, 1.0] {
            let curl = brush(
                &[
                    at((x + 0.5 * radius) * sign, y - 0.3 * radius),
                    at((x + 0.6 * radius) * sign, y + 0.2 * radius),
                    at((x + 0.2 * radius) * sign, y + 0.55 * radius),
                ],
                FINE,
                1.4,
            );
            canvas.fill(&place(curl), [0xc4, 0x5a, 0x16]);
        }
    }
    canvas.ink(&face, FINE * 0.7, INK);
    canvas.fill(&face, SKIN);
    let shade = [
        at(-60.0, 14.0),
        at(-38.0, -6.0),
        at(4.0, -3.0),
        at(44.0, -14.0),
        at(66.0, -42.0),
        at(71.0, -84.0),
        at(100.0, -84.0),
        at(90.0, -6.0),
        at(20.0, 24.0),
    ];
    canvas.shade(&place(smooth_closed(&shade)), &face);
    draw_features(canvas, head, mouth);
    draw_hat(canvas, head);
}

fn draw_features(canvas: &mut Canvas, head: Affine, mouth: Mouth) {
    let place = |path: BezPath| moved(head, &path);
    for sign in [-1.0, 1.0] {
        let white = Ellipse::new((32.0 * sign, -84.0), (19.0, 27.0), 0.0).to_path(0.05);
        canvas.fill(&place(white), WHITE);
        let star = brush(
            &[
                at(32.0 * sign, -116.0),
                at(32.0 * sign, -108.0),
                at(32.0 * sign, -101.0),
            ],
            6.0,
            2.0,
        );
        canvas.fill(&place(star), [0x3a, 0x86, 0xc8]);
        let tear = brush(
            &[at(32.0 * sign, -66.0), at(32.0 * sign, -60.0), at(32.0 * sign, -52.0)],
            6.0,
            2.0,
        );
        canvas.fill(&place(tear), [0x3a, 0x86, 0xc8]);
        let middle = at(32.0 * sign, -82.0);
        canvas.fill(&place(Ellipse::new(middle, (9.5, 14.0), 0.0).to_path(0.05)), INK);
        canvas.fill(
            &place(Circle::new(middle + Vec2::new(3.0, -5.5), 3.9).to_path(0.05)),
            WHITE,
        );
        canvas.fill(
            &place(Circle::new(middle + Vec2::new(-3.0, 5.5), 2.0).to_path(0.05)),
            WHITE,
        );
        canvas.fill(
            &place(Ellipse::new((58.0 * sign, -46.0), (13.0, 10.0), 0.0).to_path(0.05)),
            CHEEK,
        );
        let brow = brush(
            &[
                at(18.0 * sign, -122.0),
                at(33.0 * sign, -130.0),
                at(48.0 * sign, -122.0),
            ],
            FINE * 1.5,
            FINE * 0.8,
        );
        canvas.fill(&place(brow), INK);
    }
    // The painted mouth is the same in both drawings, the lips are not.
    let painted = place(smooth_closed(&[
        at(0.0, -44.0),
        at(30.0, -42.0),
        at(50.0, -34.0),
        at(40.0, -14.0),
        at(0.0, -3.0),
        at(-40.0, -14.0),
        at(-50.0, -34.0),
        at(-30.0, -42.0),
    ]));
    canvas.fill(&painted, WHITE);
    match mouth {
        Mouth::Smile => {
            let line = [
                at(-34.0, -30.0),
                at(-18.0, -19.0),
                at(0.0, -15.5),
                at(18.0, -19.0),
                at(34.0, -30.0),
            ];
            canvas.fill(&place(brush(&line, FINE * 1.9, FINE * 1.1)), RED);
        }
        Mouth::Open => {
            let open = place(smooth_closed(&[
                at(-34.0, -32.0),
                at(0.0, -29.0),
                at(34.0, -32.0),
                at(26.0, -15.0),
                at(0.0, -8.0),
                at(-26.0, -15.0),
            ]));
            canvas.ink(&open, FINE, RED);
            canvas.fill(&open, DARK);
            canvas.fill_inside(
                &place(Ellipse::new((0.0, -9.0), (17.0, 8.0), 0.0).to_path(0.05)),
                &open,
                CHEEK,
            );
        }
    }
    let nose = place(Circle::new((0.0, -56.0), 19.0).to_path(0.05));
    canvas.ink(&nose, FINE * 0.7, INK);
    canvas.fill(&nose, RED);
    canvas.shade(&place(Circle::new((7.0, -48.0), 19.0).to_path(0.05)), &nose);
    canvas.fill_inside(&place(Circle::new((-3.0, -60.0), 17.0).to_path(0.05)), &nose, RED);
    canvas.fill(
        &place(Ellipse::new((-6.0, -63.0), (5.0, 4.0), -0.5).to_path(0.05)),
        WHITE,
    );
}

/// The hat's coordinates: small, and on one side of the head.
pub(super) fn hat(head: Affine) -> Affine {
    head * Affine::translate((8.0, -149.0)) * Affine::rotate(f64::to_radians(8.0))
}

fn draw_hat(canvas: &mut Canvas, head: Affine) {
    let frame = hat(head);
    let crown = moved(
        frame,
        &smooth_closed(&[
            at(-34.0, 2.0),
            at(-38.0, -28.0),
            at(-37.0, -52.0),
            at(-20.0, -58.0),
            at(0.0, -60.0),
            at(20.0, -58.0),
            at(37.0, -52.0),
            at(38.0, -28.0),
            at(34.0, 2.0),
            at(0.0, 6.0),
        ]),
    );
    let brim = moved(frame, &Ellipse::new((0.0, 2.0), (58.0, 12.0), 0.0).to_path(0.05));
    canvas.ink(&crown, LINE, INK);
    canvas.ink(&brim, LINE, INK);
    canvas.fill(&crown, GREEN);
    let band = moved(frame, &Ellipse::new((0.0, -4.0), (60.0, 16.0), 0.0).to_path(0.05));
    canvas.fill_inside(&band, &crown, YELLOW);
    let side = [
        at(60.0, 20.0),
        at(14.0, 20.0),
        at(20.0, -30.0),
        at(16.0, -70.0),
        at(60.0, -70.0),
    ];
    canvas.shade(&moved(frame, &smooth_closed(&side)), &crown);
    canvas.ink(&brim, FINE * 0.5, INK);
    canvas.fill(&brim, GREEN);
    // A daisy on the band.
    for k in 0..6 {
        let angle_rad = std::f64::consts::TAU * f64::from(k) / 6.0;
        let petal = Circle::new((-22.0 + 10.0 * angle_rad.cos(), -18.0 + 10.0 * angle_rad.sin()), 6.5);
        let petal = moved(frame, &petal.to_path(0.05));
        canvas.ink(&petal, FINE * 0.4, INK);
        canvas.fill(&petal, WHITE);
    }
    let middle = moved(frame, &Circle::new((-22.0, -18.0), 6.5).to_path(0.05));
    canvas.ink(&middle, FINE * 0.3, INK);
    canvas.fill(&middle, ORANGE);
}
