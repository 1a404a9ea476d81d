//! What triangles of a vector frame cost: `cargo bench --features lyon --bench vector_mesh`, half a minute.
//!
//! Blobs of 24 curves each, filled and with a line, that wobble from frame to frame; at a tolerance of a tenth of a pixel:
//! - `first frame`: everything is tessellated by lyon;
//! - `next frame`: fills keep their triangles, lines are tessellated again;
//! - `next frame, fills alone`: only vertices are computed;
//! - `lyon alone, fills`: lyon's own tessellation of the same curves, path building left out.

use std::hint::black_box;
use std::time::Duration;

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use inbetween::export::VectorTessellator;
use inbetween::math::Point;
use inbetween::render::drawing::{Fill, FillRule, LineCap, LineJoin, Paint, Stroke, Subpath, VectorFrame, VectorShape};
use lyon_tessellation::{BuffersBuilder, FillOptions, FillTessellator, FillVertex, VertexBuffers};

/// How many blobs.
const BLOBS: usize = 64;
/// The curves of each.
const CURVES: usize = 24;

/// A blob whose radius varies by `wobble`.
fn blob(number: usize, wobble: f64, is_stroked: bool) -> VectorShape {
    let centre = Point::new(60.0 + 110.0 * (number % 8) as f64, 60.0 + 110.0 * (number / 8) as f64);
    let at = |k: f64| {
        let angle = std::f64::consts::TAU * k / CURVES as f64;
        let radius = 40.0 + 6.0 * (3.0 * angle + wobble + number as f64).sin();
        centre + Point::new(angle.cos(), angle.sin()) * radius
    };
    let mut subpath = Subpath::starting_at(at(0.0));
    for k in 0..CURVES {
        let k = k as f64;
        subpath.cubics.push([at(k + 1.0 / 3.0), at(k + 2.0 / 3.0), at(k + 1.0)]);
    }
    subpath.is_closed = true;
    let mut shape = VectorShape::of_subpaths(format!("blob {number}"), vec![subpath]);
    let paint = Paint::Solid([0.2, 0.5, 0.7, 1.0]);
    shape.fill = Some(Fill {
        paint: paint.clone(),
        rule: FillRule::NonZero,
    });
    shape.stroke = is_stroked.then(|| Stroke {
        paint,
        width: 3.0,
        cap: LineCap::Round,
        join: LineJoin::Round,
        miter_limit: 4.0,
        dashes: Vec::new(),
        dash_offset: 0.0,
    });
    shape
}

fn frame(wobble: f64, is_stroked: bool) -> VectorFrame {
    VectorFrame::of_shapes([960, 960], (0..BLOBS).map(|number| blob(number, wobble, is_stroked)))
}

fn frames(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("64 blobs of 24 curves");
    let new = || VectorTessellator::new(0.1).expect("a tolerance");
    let whole = [frame(0.0, true), frame(0.2, true)];
    group.bench_function("first frame", |bencher| {
        let first =
            |mut tessellator: VectorTessellator| tessellator.tessellate(&whole[0], |vertex| vertex).expect("a mesh");
        bencher.iter_batched(new, first, BatchSize::SmallInput);
    });
    for (name, frames) in [
        ("next frame", whole),
        ("next frame, fills alone", [frame(0.0, false), frame(0.2, false)]),
    ] {
        let mut tessellator = new();
        tessellator.tessellate(&frames[0], |vertex| vertex).expect("a mesh");
        let mut turn = 0;
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                turn += 1;
                tessellator
                    .tessellate(black_box(&frames[turn % 2]), |vertex| vertex)
                    .expect("a mesh")
            });
        });
    }
    let paths = frame(0.0, false).to_lyon().expect("finite");
    group.bench_function("lyon alone, fills", |bencher| {
        bencher.iter(|| {
            let mut buffers: VertexBuffers<[f32; 2], u32> = VertexBuffers::new();
            for (_, path) in &paths {
                let mut builder =
                    BuffersBuilder::new(&mut buffers, |vertex: FillVertex<'_>| vertex.position().to_array());
                let options = FillOptions::tolerance(0.1).with_fill_rule(lyon_tessellation::FillRule::NonZero);
                FillTessellator::new()
                    .tessellate_path(path, &options, &mut builder)
                    .expect("a tessellation");
            }
            buffers.indices.len()
        });
    });
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().measurement_time(Duration::from_secs(3));
    targets = frames
}
criterion_main!(benches);
