//! Copies of one drawing, moved, turned and scaled, are that drawing at every place of the pose space.

use inbetween::input::{Drawing, SvgOptions, read_svg};
use inbetween::math::Point;
use inbetween::pipeline::{LayerSpec, PoseSpec, map_layer};
use inbetween::pose::Mapping;
use proptest::prelude::*;

/// How far corresponding vertices may be apart when one copy is laid upon the other, as a fraction of the diagonal: where nothing tells one place of a
/// rim from the next, vertices of both may drift a hundredth of it, and those inside go with them.
const APART: f64 = 0.03;

/// What is drawn: `kind` with `count` teeth, holes or points and the random number `r` in `[0, 1)`, about the origin, some 200 units wide.
fn art(kind: usize, count: usize, r: f64) -> String {
    let turn = |k: usize, of: usize| std::f64::consts::TAU * k as f64 / of as f64;
    let around = |corners: usize, radius: &dyn Fn(usize) -> f64| -> String {
        let places = (0..corners).map(|k| {
            let (sine, cosine) = turn(k, corners).sin_cos();
            format!("{:.3},{:.3}", radius(k) * cosine, radius(k) * sine)
        });
        places.collect::<Vec<_>>().join(" ")
    };
    let disc = |x: f64, y: f64, radius: f64| {
        format!(
            "M{:.3} {y:.3}a{radius} {radius} 0 1 0 {:.3} 0a{radius} {radius} 0 1 0 {:.3} 0z",
            x - radius,
            2.0 * radius,
            -2.0 * radius
        )
    };
    match kind {
        // A ring.
        0 => format!(
            r##"<path fill="#457" fill-rule="evenodd" d="{}{}"/>"##,
            disc(0.0, 0.0, 100.0),
            disc(0.0, 0.0, 40.0 + 50.0 * r)
        ),
        // A gear.
        1 => {
            let teeth = around(4 * count, &|k| if k % 4 < 2 { 100.0 } else { 70.0 + 15.0 * r });
            format!(
                r##"<path fill="#666" fill-rule="evenodd" d="M{teeth}z{}"/>"##,
                disc(0.0, 0.0, 30.0)
            )
        }
        // A star.
        2 => format!(
            r##"<polygon fill="#fa2" points="{}"/>"##,
            around(2 * count, &|k| if k % 2 == 0 { 100.0 } else { 35.0 + 30.0 * r })
        ),
        // Letters.
        3 => r##"<path d="M-60 -90h120v36h-80v36h60v36h-60v36h80v36h-120z"/>"##.to_owned(),
        4 => r##"<path fill-rule="evenodd" d="M-25 -90h50l65 180h-38l-14 -40h-76l-14 40h-38zM0 -50l-26 68h52z"/>"##
            .to_owned(),
        // A disc with holes.
        5 => {
            let holes = (0..count).map(|k| {
                let (sine, cosine) = (turn(k, count) + r).sin_cos();
                disc(60.0 * cosine, 60.0 * sine, 14.0)
            });
            format!(
                r##"<path fill="#283" fill-rule="evenodd" d="{}{}"/>"##,
                disc(0.0, 0.0, 100.0),
                holes.collect::<String>()
            )
        }
        // A figure of lines.
        6 => format!(
            r##"<g fill="none" stroke="#000" stroke-width="9" stroke-linecap="round"><circle cx="0" cy="-70" r="26" fill="#fff"/><path d="M0 -44V20L-40 95M0 20L45 90M0 -25L-60 {:.2}M0 -25L62 -60"/></g>"##,
            40.0 * r
        ),
        // A face: an outline that says nothing, and what is drawn inside.
        _ => format!(
            r##"<circle r="100" fill="#fc8"/><circle cx="-35" cy="-20" r="14" fill="#124"/><circle cx="35" cy="-20" r="14" fill="#124"/><path d="M-40 {0:.2}q40 30 80 0v10q-40 30 -80 0z" fill="#a22"/>"##,
            25.0 + 20.0 * r
        ),
    }
}

fn copy(art: &str, (x, y): (f64, f64), turn_deg: f64, scale: f64) -> Drawing {
    let text = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="800" height="800"><g transform="translate({x} {y}) rotate({turn_deg}) scale({scale})">{art}</g></svg>"#
    );
    read_svg(text.as_bytes(), &SvgOptions::default()).expect("a drawing")
}

/// The largest distance of corresponding vertices when the second pose is moved, turned and scaled onto the first, over its diagonal.
fn apart(mapping: &Mapping) -> f64 {
    let [first, second] = [0, 1].map(|pose| mapping.poses.positions()[pose].clone());
    let middle = |points: &[Point]| points.iter().sum::<Point>() / points.len() as f64;
    let (to, from) = (middle(&first), middle(&second));
    let (mut along, mut across, mut squares) = (0.0, 0.0, 0.0);
    for (a, b) in first.iter().zip(&second) {
        let (a, b) = (a - to, b - from);
        along += a.dot(&b);
        across += b.x * a.y - b.y * a.x;
        squares += b.norm_squared();
    }
    let (c, s) = (along / squares, across / squares);
    let laid = |p: &Point| {
        let p = p - from;
        Point::new(c * p.x - s * p.y, s * p.x + c * p.y) + to
    };
    let distances = first.iter().zip(&second).map(|(a, b)| (a - laid(b)).norm());
    distances.fold(0.0, f64::max) / mapping.outlines[0].diagonal()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 16, max_shrink_iters: 0, ..ProptestConfig::default() })]

    #[test]
    fn a_copy_corresponds_to_its_drawing_point_by_point(
        kind in 0..8usize, count in 3..9usize, r in 0.0..1.0, turn_deg in -40.0..40.0, scale in 0.6..1.6, x in 300.0..500.0, y in 300.0..500.0
    ) {
        let art = art(kind, count, r);
        let drawings = [copy(&art, (400.0, 400.0), 0.0, 1.0), copy(&art, (x, y), turn_deg, scale)];
        let poses = drawings.into_iter().zip(["drawing", "copy"]);
        let poses = poses.map(|(drawing, name)| PoseSpec::drawn(name, drawing)).collect();
        let (mapping, _) = map_layer(&LayerSpec::new("figure", poses)).expect("a mapping");
        mapping.check().expect("valid");
        prop_assert!(apart(&mapping) < APART, "{} % of the diagonal apart", 100.0 * apart(&mapping));
    }
}
