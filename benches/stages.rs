//! What each stage costs, on outlines of 100 to 2000 points in 2 to 8 poses: `cargo bench`.
//!
//! The shapes are wavy discs, each pose with its own phase and depth of waves, so that matching and triangulation have
//! real work to do. Times of one run can be compared with one another; times of different machines cannot.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use inbetween::blend::{BlendOptions, RigidBlend};
use inbetween::compatible::{RefineOptions, SimplifyOptions, refine, simplify, triangulate};
use inbetween::matching::{MatchOptions, match_rings};
use inbetween::math::Point;
use inbetween::outline::{Outline, Ring};
use inbetween::pose::PoseSet;

/// A disc whose rim has seven waves; poses differ in the depth and the place of the waves.
fn wavy(points: usize, pose: usize) -> Outline {
    let (depth, phase) = (0.25 + 0.03 * pose as f64, 0.4 * pose as f64);
    let rim = (0..points).map(|k| {
        let angle = std::f64::consts::TAU * k as f64 / points as f64;
        let radius = 100.0 * (1.0 + depth * (7.0 * angle + phase).sin() * (0.6 + 0.4 * (angle + 0.3).cos()));
        Point::new(radius * angle.cos(), radius * angle.sin())
    });
    let ring = Ring::new(rim).expect("distinct finite points");
    Outline::new(ring, Vec::new()).expect("a star-shaped ring is simple")
}

fn stages(criterion: &mut Criterion) {
    for (points, poses) in [(100, 4), (500, 4), (1000, 2), (1000, 4), (1000, 8), (2000, 4)] {
        let outlines: Vec<Outline> = (0..poses).map(|pose| wavy(points, pose)).collect();
        let rings: Vec<Ring> = outlines.iter().map(|outline| outline.outer().clone()).collect();
        let name = format!("{points} points x {poses} poses");
        let mut group = criterion.benchmark_group("stages");
        group.sample_size(10);

        let options = MatchOptions::default();
        group.bench_function(BenchmarkId::new("match", &name), |b| {
            b.iter(|| match_rings(&rings, &[], &options))
        });
        let matched = match_rings(&rings, &[], &options).expect("a match");
        let correspondences = [matched.correspondence];

        let options = SimplifyOptions::default();
        group.bench_function(BenchmarkId::new("simplify", &name), |b| {
            b.iter(|| simplify(&outlines, &correspondences, &[], &options));
        });
        let polygons = simplify(&outlines, &correspondences, &[], &options)
            .expect("simplified")
            .polygons;

        group.bench_function(BenchmarkId::new("triangulate", &name), |b| {
            b.iter(|| triangulate(&polygons, &[]))
        });
        let (mesh, _) = triangulate(&polygons, &[]).expect("triangulated");

        let options = RefineOptions::default();
        group.bench_function(BenchmarkId::new("refine", &name), |b| {
            b.iter(|| refine(&mesh, &options))
        });
        let (mesh, _) = refine(&mesh, &options).expect("refined");

        let named = mesh
            .positions
            .into_iter()
            .enumerate()
            .map(|(pose, positions)| (format!("p{pose}"), positions));
        let set = PoseSet::new(mesh.topology, named.collect()).expect("a pose set");
        let blend = RigidBlend::new(&set, &BlendOptions::default()).expect("a blend");
        let weights = vec![1.0 / poses as f64; poses];
        let (mut scratch, mut out) = (blend.scratch(), Vec::new());
        group.bench_function(BenchmarkId::new("blend a frame", &name), |b| {
            b.iter(|| blend.blend(&weights, &mut scratch, &mut out));
        });
        group.finish();
    }
}

criterion_group!(benches, stages);
criterion_main!(benches);
