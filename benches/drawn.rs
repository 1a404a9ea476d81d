//! What it costs that drawings are looked at: `cargo bench --bench drawn`, a minute.
//!
//! A figure of 600 x 700 pixels with arms, a face and stripes, its arms raised more from pose to pose. On all processors, since that is how it is
//! waited for.
//!
//! - `appearance`: one drawing resampled, its colours, ink and coverage.
//! - `register`: one pose found from a beginning that leaves its arms where they were; `register again` after a pin has moved on one pose of three.
//! - `textures`: the pictures of four poses registered to one another on their mesh, divided as it is for painting.
//! - `map`: four and sixteen drawings to a mesh, and four silhouettes of the same outlines, which are not looked at inside.

use std::sync::Arc;

use brief::brief;
use criterion::{Criterion, criterion_group, criterion_main};
use inbetween::appearance::Appearance;
use inbetween::input::{Drawing, SvgOptions, read_svg};
use inbetween::math::Point;
use inbetween::mesh::{Topology, subdivided};
use inbetween::pipeline::{LayerSpec, PoseSpec, map_layer};
use inbetween::registration::{Embedded, Pin, RingPairs, register, register_textures};

#[path = "common/brief.rs"]
mod brief;

/// A figure whose arms are raised by some degrees; `is_drawn` with a face and colours, or all in black.
fn figure(raised_deg: f64, is_drawn: bool) -> Drawing {
    let [skin, shirt, stripe, line] = if is_drawn {
        ["#fc9", "#c33", "#fff", "#311"]
    } else {
        ["#000"; 4]
    };
    let text = format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" width="600" height="700"><g stroke="{line}" stroke-width="6" stroke-linejoin="round">
        <rect x="380" y="275" width="190" height="52" rx="26" fill="{skin}" transform="rotate({0} 400 301)"/>
        <rect x="30" y="275" width="190" height="52" rx="26" fill="{skin}" transform="rotate({1} 200 301)"/>
        <rect x="215" y="500" width="66" height="180" rx="30" fill="{line}"/><rect x="319" y="500" width="66" height="180" rx="30" fill="{line}"/>
        <rect x="190" y="250" width="220" height="290" rx="50" fill="{shirt}"/><circle cx="300" cy="150" r="118" fill="{skin}"/></g>
        <path d="M190 340h220v36h-220zM190 430h220v36h-220z" fill="{stripe}"/>
        <g fill="{line}"><circle cx="258" cy="130" r="17"/><circle cx="342" cy="130" r="17"/><path d="M250 195q50 40 100 0v12q-50 40 -100 0z"/></g></svg>"##,
        -raised_deg,
        0.7 * raised_deg
    );
    read_svg(text.as_bytes(), &SvgOptions::default()).expect("a drawing")
}

fn layer(poses: usize, is_drawn: bool) -> LayerSpec {
    let pose = |k: usize| PoseSpec::drawn(format!("p{k}"), figure(40.0 * k as f64 / poses as f64, is_drawn));
    LayerSpec::new("figure", (0..poses).map(pose).collect())
}

fn drawn(criterion: &mut Criterion) {
    let mut group = brief(criterion, "drawn");
    let drawings: Vec<Drawing> = (0..4).map(|k| figure(4.0 * f64::from(k), true)).collect();
    group.bench_function("appearance", |b| b.iter(|| Appearance::new(&drawings[0])));
    let appearances: Vec<Arc<Appearance>> = drawings
        .iter()
        .map(|drawing| Arc::new(Appearance::new(drawing)))
        .collect();
    let points = drawings[0].outline.outer().points().to_vec();
    let stays: RingPairs = vec![(points.clone(), points)];
    let beginnings = |poses: usize| -> Vec<Vec<RingPairs>> {
        (0..poses)
            .map(|k| if k == 0 { Vec::new() } else { vec![stays.clone()] })
            .collect()
    };
    group.bench_function("register", |b| {
        b.iter(|| register(&appearances[..2], 0, &beginnings(2), &[], None).expect("a registration"));
    });
    let before = register(&appearances, 0, &beginnings(4), &[], None)
        .expect("a registration")
        .0;
    let pin = Pin::certain(Point::new(258.0, 130.0), Point::new(262.0, 131.0));
    let pins = vec![Vec::new(), Vec::new(), vec![pin], Vec::new()];
    group.bench_function("register again", |b| {
        b.iter(|| register(&appearances, 0, &beginnings(4), &pins, Some(&before)).expect("a registration"));
    });
    let (mapping, _) = map_layer(&layer(4, true)).expect("a mapping");
    let shown: Vec<Arc<Appearance>> = (0..4)
        .map(|k| Arc::new(Appearance::new(&figure(10.0 * f64::from(k), true))))
        .collect();
    let triangles = mapping.poses.topology().triangles();
    let (fine, places) = subdivided(triangles, mapping.poses.topology().vertex_count(), 3);
    let fine = Topology::new(places.len(), fine).expect("a mesh");
    let positions: Vec<&[Point]> = mapping.poses.positions().iter().map(Vec::as_slice).collect();
    let embedded = Embedded {
        triangles,
        fine: (&fine, &places),
        appearances: &shown,
        positions: &positions,
    };
    group.bench_function("textures", |b| b.iter(|| register_textures(&embedded, 0, &[true; 4])));
    for (poses, is_drawn) in [(4, true), (16, true), (4, false)] {
        let layer = layer(poses, is_drawn);
        let what = if is_drawn { "drawings" } else { "silhouettes" };
        group.bench_function(format!("map/{poses} {what}"), |b| {
            b.iter(|| map_layer(&layer).expect("a mapping"))
        });
    }
}

criterion_group!(benches, drawn);
criterion_main!(benches);
