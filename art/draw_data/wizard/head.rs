//! Face, ears and hair.

use kurbo::{Affine, BezPath, Ellipse, Shape, Vec2};

use super::posture::Posture;
use super::{FINE, INK, LINE, PAPER, outlined};
use crate::canvas::{Canvas, moved};
use crate::curves::{at, brush, polygon, smooth_closed};
use crate::figure::{Mouth, Side};

/// The fringe, along its lower edge from left to right: tips and notches.
const FRINGE: [(f64, f64); 9] = [
    (-84.0, -78.0),
    (-62.0, -104.0),
    (-44.0, -92.0),
    (-30.0, -112.0),
    (-4.0, -94.0),
    (14.0, -114.0),
    (40.0, -94.0),
    (56.0, -108.0),
    (84.0, -78.0),
];

pub(super) fn draw(canvas: &mut Canvas, head: Affine, posture: &Posture) {
    let place = |path: BezPath| moved(head, &path);
    for side in Side::BOTH {
        let ear = Ellipse::new(side.at(86.0, -62.0), (15.0, 19.0), 0.0).to_path(0.05);
        outlined(canvas, &place(ear), LINE);
    }
    let face = place(smooth_closed(&[
        at(0.0, 4.0),
        at(44.0, -4.0),
        at(76.0, -34.0),
        at(86.0, -76.0),
        at(66.0, -126.0),
        at(0.0, -148.0),
        at(-66.0, -126.0),
        at(-86.0, -76.0),
        at(-76.0, -34.0),
        at(-44.0, -4.0),
    ]));
    outlined(canvas, &face, LINE);
    let mut hair: Vec<_> = FRINGE.iter().map(|&(x, y)| at(x, y)).collect();
    hair.extend([at(100.0, -160.0), at(-100.0, -160.0)]);
    canvas.fill_inside(&place(polygon(&hair)), &face, INK);
    let tuft = [
        at(-34.0, -136.0),
        at(-22.0, -172.0),
        at(-6.0, -150.0),
        at(12.0, -178.0),
        at(18.0, -150.0),
        at(40.0, -162.0),
        at(40.0, -132.0),
    ];
    canvas.fill(&place(polygon(&tuft)), INK);
    canvas.nib(&place(polygon(&tuft)), FINE, INK);
    let shine = [at(-50.0, -122.0), at(-34.0, -131.0), at(-14.0, -136.0)];
    canvas.fill(&place(brush(&shine, 5.0, 2.0)), PAPER);
    draw_features(canvas, head, posture);
}

fn draw_features(canvas: &mut Canvas, head: Affine, posture: &Posture) {
    let place = |path: BezPath| moved(head, &path);
    for side in Side::BOTH {
        let sign = side.sign();
        let eye = side.at(33.0, -64.0);
        outlined(canvas, &place(Ellipse::new(eye, (17.0, 22.0), 0.0).to_path(0.05)), FINE);
        let pupil = eye + posture.look;
        canvas.fill(&place(Ellipse::new(pupil, (8.5, 11.0), 0.0).to_path(0.05)), INK);
        let light = pupil + Vec2::new(-2.5, -4.5);
        canvas.fill(&place(Ellipse::new(light, (3.0, 3.6), 0.0).to_path(0.05)), PAPER);
        let brow = [
            side.at(16.0, -92.0 - posture.brows),
            side.at(34.0, -97.0 - posture.brows),
            side.at(50.0, -90.0 - posture.brows),
        ];
        canvas.nib(&place(brush(&brow, 7.0, 3.0)), 3.0, PAPER);
        canvas.fill(&place(brush(&brow, 7.0, 3.0)), INK);
        for k in 0..3 {
            let x = 50.0 + 8.0 * f64::from(k);
            let cheek = [
                at(x * sign, -36.0),
                at((x - 2.0) * sign, -31.0),
                at((x - 4.0) * sign, -26.0),
            ];
            canvas.fill(&place(brush(&cheek, 3.4, 2.0)), INK);
        }
    }
    let nose = [at(-3.0, -52.0), at(8.0, -46.0), at(4.0, -38.0), at(-6.0, -38.0)];
    let mut line = BezPath::new();
    crate::curves::smooth_through(&mut line, &nose);
    canvas.nib(&place(line), FINE, INK);
    match posture.body.mouth {
        Mouth::Smile => {
            let line = [
                at(-26.0, -24.0),
                at(-12.0, -16.0),
                at(4.0, -14.0),
                at(18.0, -18.0),
                at(28.0, -27.0),
            ];
            canvas.fill(&place(brush(&line, 6.5, 3.0)), INK);
        }
        Mouth::Open => {
            let open = place(smooth_closed(&[
                at(-22.0, -24.0),
                at(0.0, -27.0),
                at(23.0, -25.0),
                at(17.0, -10.0),
                at(0.0, -5.0),
                at(-16.0, -10.0),
            ]));
            canvas.fill(&open, INK);
            canvas.nib(&open, FINE * 0.6, INK);
            let tongue = place(Ellipse::new((1.0, -7.0), (10.0, 5.0), 0.0).to_path(0.05));
            canvas.fill_inside(&tongue, &open, PAPER);
        }
    }
}
