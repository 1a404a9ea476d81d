//! What weights over the pose space cost: `cargo bench --bench weights`, a minute.
//!
//! - `biharmonic`: building a plane, editing a pose on it, asking for the weights of one place; with the number of
//!   mesh vertices in the name. A frame at 60 Hz is 16.6 ms.
//! - `bounded`: the same plane with weights within [0, 1].
//! - `radial`: 14 examples in 4 dimensions: 10,000 places in one call (divide by 10,000 for one place), one place, and solving
//!   again after a pose has moved.

use std::hint::black_box;

use brief::brief;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use inbetween::weights::{
    BiharmonicOptions, BiharmonicWeights, Edit, Energy, Radial, Range, RbfOptions, RbfWeights, WeightProvider,
};

#[path = "common/brief.rs"]
mod brief;

/// Poses in rows, off the grid by a fifth of its step.
fn plane(count: usize) -> Vec<Vec<f64>> {
    let side = (count as f64).sqrt().ceil() as usize;
    let place = |k: usize| {
        let wobble = |factor: f64| 0.2 * (factor * k as f64).sin();
        vec![(k % side) as f64 + wobble(7.0), (k / side) as f64 + wobble(5.0)]
    };
    (0..count).map(place).collect()
}

fn biharmonic(criterion: &mut Criterion) {
    let mut group = brief(criterion, "biharmonic");
    for (count, energy) in [
        (4, Energy::Hessian),
        (8, Energy::Hessian),
        (16, Energy::Hessian),
        (16, Energy::JacobianDifferences),
    ] {
        let places = plane(count);
        let mut options = BiharmonicOptions::default();
        options.energy = energy;
        let built = BiharmonicWeights::new(&places, &options).expect("a layout");
        let name = format!("{energy:?}, {count} poses, {} vertices", built.vertex_count());
        group.bench_function(format!("build/{name}"), |b| {
            b.iter(|| BiharmonicWeights::new(&places, &options));
        });
        // Every pose has been moved: the dearest state.
        let mut edited = built.clone();
        for (pose, place) in places.iter().enumerate() {
            let moved = [place[0] + 0.04, place[1] + 0.06];
            assert_eq!(edited.move_pose(pose, &moved), Ok(Edit::Solved));
        }
        let mut angle = 0.0_f64;
        group.bench_function(format!("move a pose/{name}"), |b| {
            b.iter(|| {
                angle += 0.1;
                let place = [places[1][0] + 0.1 * angle.cos(), places[1][1] + 0.1 * angle.sin()];
                assert_eq!(edited.move_pose(1, &place), Ok(Edit::Solved));
            });
        });
        let last = [places[count - 1][0] + 0.04, places[count - 1][1] + 0.06];
        group.bench_function(format!("remove and insert a pose/{name}"), |b| {
            b.iter(|| {
                assert_eq!(edited.remove_pose(count - 1), Ok(Edit::Solved));
                assert_eq!(edited.insert_pose(&last), Ok(Edit::Solved));
            });
        });
        let mut weights = Vec::new();
        group.bench_function(format!("ask for a place/{name}"), |b| {
            b.iter(|| {
                angle += 0.1;
                built.weights(&[0.5 + angle.cos(), 0.5 + angle.sin()], &mut weights)
            });
        });
    }
}

fn bounded(criterion: &mut Criterion) {
    let mut group = brief(criterion, "bounded");
    let mut options = BiharmonicOptions::default();
    options.range = Range::Unit;
    let places = plane(4);
    let built = BiharmonicWeights::new(&places, &options).expect("a layout");
    let name = format!("4 poses, {} vertices", built.vertex_count());
    group.bench_function(format!("build/{name}"), |b| {
        b.iter(|| BiharmonicWeights::new(&places, &options));
    });
    let mut edited = built;
    let mut angle = 0.0_f64;
    group.bench_function(format!("move a pose/{name}"), |b| {
        b.iter(|| {
            angle += 0.1;
            edited.move_pose(1, &[places[1][0] + 0.1 * angle.cos(), places[1][1] + 0.1 * angle.sin()])
        });
    });
}

fn radial(criterion: &mut Criterion) {
    const DIMENSION: usize = 4;
    const PLACES: usize = 10_000;
    let mut group = brief(criterion, "radial");
    let coordinate = |k: usize, d: usize| (1.7 * (k * (d + 3)) as f64).sin();
    let places: Vec<Vec<f64>> = (0..14)
        .map(|k| (0..DIMENSION).map(|d| coordinate(k, d)).collect())
        .collect();
    let queries: Vec<f64> = (0..PLACES * DIMENSION).map(|k| (0.37 * k as f64).sin()).collect();
    for radial in [Radial::BSpline, Radial::ThinPlate] {
        let mut options = RbfOptions::default();
        options.radial = radial;
        let mut provider = RbfWeights::new(&places, &options).expect("a layout");
        let mut weights = Vec::new();
        group.throughput(Throughput::Elements(PLACES as u64));
        group.bench_function(format!("10,000 places/{radial:?}, 14 examples in 4 dimensions"), |b| {
            b.iter(|| provider.weights_of_many(black_box(&queries), &mut weights));
        });
        group.throughput(Throughput::Elements(1));
        group.bench_function(format!("one place/{radial:?}, 14 examples in 4 dimensions"), |b| {
            b.iter(|| provider.weights(black_box(&queries[..DIMENSION]), &mut weights));
        });
        let mut angle = 0.0_f64;
        group.bench_function(format!("solve again/{radial:?}, 14 examples in 4 dimensions"), |b| {
            b.iter(|| {
                angle += 0.1;
                provider.move_pose(3, &[0.3 * angle.cos(), 0.3 * angle.sin(), 0.3, 0.4])
            });
        });
    }
}

criterion_group!(benches, biharmonic, bounded, radial);
criterion_main!(benches);
