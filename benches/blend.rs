//! What a blended frame costs, beside what it cannot do without: `cargo bench --bench blend`, two minutes.
//!
//! In one run and on one thread, so that the ratios mean something on any machine:
//! - `faer solve`: faer's own two triangular solves for x and y on the same matrix, factored by faer as it likes best;
//! - `frame`: everything from weights to vertices, the check for inverted triangles included;
//! - `certificate`: what is certified of such a frame when it is asked for, and `motion`: the proof between two such frames;
//! - `triad`: `a = b + s c` over arrays that together hold as many bytes as a frame reads at least once (the factor
//!   twice, and what the poses say about the triangles): what the memory alone would take.
//!
//! Then the set-up, and a crowd on all cores.

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::cholesky::{CholeskySymbolicParams, LltRef, SymmetricOrdering, factorize_symbolic_cholesky};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Conj, Mat, Par, Side};
use inbetween::blend::{BlendOptions, Certifier, RigidBlend, Stretch};
use inbetween::math::Point;
use inbetween::pose::{Overlaps, PoseSet};
use strip::poses;

#[path = "common/strip.rs"]
mod strip;

/// Columns and rows of the two meshes: 2,000 and 10,000 vertices.
const SIZES: [(usize, usize); 2] = [(50, 40), (125, 80)];

/// The entries of a matrix with the mesh's structure: one over edge lengths, the first vertex held.
fn entries(poses: &PoseSet) -> Vec<(usize, usize, f64)> {
    let positions = &poses.positions()[0];
    let mut entries = vec![];
    for triangle in poses.topology().triangles() {
        for (&from, &to) in triangle.iter().zip(triangle.iter().cycle().skip(1)) {
            let stiffness = 1.0 / (positions[from] - positions[to]).norm();
            for (row, column, value) in [(from, from, 1.0), (to, to, 1.0), (from, to, -1.0), (to, from, -1.0)] {
                if row > 0 && column > 0 {
                    entries.push((row - 1, column - 1, value * stiffness));
                }
            }
        }
    }
    entries
}

/// Measures faer's solve.
fn solves(group: &mut criterion::BenchmarkGroup<'_, criterion::measurement::WallTime>, poses: &PoseSet) {
    let size = poses.topology().vertex_count() - 1;
    let entries = entries(poses);
    let triplets: Vec<_> = entries.iter().map(|&(r, c, value)| Triplet::new(r, c, value)).collect();
    let matrix = SparseColMat::<usize, f64>::try_new_from_triplets(size, size, &triplets).expect("a matrix");
    let symbolic = factorize_symbolic_cholesky(
        matrix.symbolic(),
        Side::Lower,
        SymmetricOrdering::Amd,
        CholeskySymbolicParams::default(),
    )
    .expect("memory");
    let mut factor = vec![0.0; symbolic.len_val()];
    let mut buffer = MemBuffer::new(symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default()));
    symbolic
        .factorize_numeric_llt(
            &mut factor,
            matrix.as_ref(),
            Side::Lower,
            LltRegularization::default(),
            Par::Seq,
            MemStack::new(&mut buffer),
            Default::default(),
        )
        .expect("positive definite");
    let factored = LltRef::new(&symbolic, &factor);
    let mut buffer = MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(2, Par::Seq));
    let right = Mat::from_fn(size, 2, |row, column| (row as f64 * 0.7 + column as f64).sin());
    let mut solution = right.clone();
    group.bench_function("faer solve", |b| {
        b.iter(|| {
            solution.copy_from(&right);
            factored.solve_in_place_with_conj(Conj::No, solution.as_mut(), Par::Seq, MemStack::new(&mut buffer));
        });
    });
}

fn frames(criterion: &mut Criterion) {
    for (columns, rows) in SIZES {
        let vertices = columns * rows;
        let mut group = criterion.benchmark_group(format!("{vertices} vertices"));
        group
            .measurement_time(Duration::from_secs(2))
            .warm_up_time(Duration::from_millis(500));
        let mut factor_entries = 0;
        for count in [4, 16] {
            let poses = poses(columns, rows, count);
            if count == 4 {
                solves(&mut group, &poses);
            }
            let weights: Vec<f64> = (0..count)
                .map(|k| 2.0 * (k + 1) as f64 / (count * (count + 1)) as f64)
                .collect();
            for stretch in [Stretch::Linear, Stretch::Limited, Stretch::Log] {
                let mut options = BlendOptions::default();
                options.stretch = stretch;
                let blend = RigidBlend::new(&poses, &options).expect("a blend");
                factor_entries = blend.factor_entry_count();
                let (mut scratch, mut positions) = (blend.scratch(), Vec::new());
                group.bench_function(format!("frame, {count} poses, {stretch:?}"), |b| {
                    b.iter(|| blend.blend(black_box(&weights), &mut scratch, &mut positions));
                });
            }
            let options = BlendOptions::default();
            let blend = RigidBlend::new(&poses, &options).expect("a blend");
            let certifier = Certifier::new(&poses, &Overlaps::default(), &options).expect("a certifier");
            let (mut scratch, mut positions, mut later) = (blend.scratch(), Vec::new(), Vec::new());
            blend.blend(&weights, &mut scratch, &mut positions).expect("a frame");
            let mut moved = weights.clone();
            (moved[0], moved[1]) = (weights[0] + 0.05, weights[1] - 0.05);
            blend.blend(&moved, &mut scratch, &mut later).expect("a frame");
            group.bench_function(format!("certificate, {count} poses"), |b| {
                b.iter(|| certifier.certify(black_box(&weights), &positions));
            });
            group.bench_function(format!("motion, {count} poses"), |b| {
                b.iter(|| certifier.unproven_between(black_box(&positions), &later));
            });
            let bytes = 2 * 12 * factor_entries + 32 * count * poses.topology().triangles().len();
            let (b, c) = (vec![1.0; bytes / 24], vec![2.0; bytes / 24]);
            let mut a = b.clone();
            group.bench_function(format!("triad, {count} poses, {} kB", bytes / 1000), |bencher| {
                bencher.iter(|| {
                    for ((a, b), c) in a.iter_mut().zip(&b).zip(&c) {
                        *a = b + black_box(3.0) * c;
                    }
                    black_box(&mut a);
                });
            });
        }
        group.finish();
    }
}

fn set_up(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("set-up");
    group.sample_size(10);
    let poses = poses(125, 80, 8);
    group.bench_function("10000 vertices, 8 poses", |b| {
        b.iter(|| RigidBlend::new(&poses, &BlendOptions::default()));
    });
    group.finish();
}

/// A thousand characters of 500 vertices, each with its own weights: one frame of a crowd, on one thread and on all.
fn crowd(criterion: &mut Criterion) {
    const CHARACTERS: usize = 1000;
    let mut group = criterion.benchmark_group("crowd of 1000");
    group.sample_size(20);
    let poses = poses(25, 20, 4);
    let blend = RigidBlend::new(&poses, &BlendOptions::default()).expect("a blend");
    let weights: Vec<f64> = (0..CHARACTERS)
        .flat_map(|k| {
            let t = k as f64 / CHARACTERS as f64;
            [0.4 - 0.3 * t, 0.3 * t, 0.5, 0.1]
        })
        .collect();
    let mut positions = vec![Point::zeros(); CHARACTERS * blend.vertex_count()];
    for threads in [1, rayon::current_num_threads()] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads");
        let mut scratch = blend.crowd_scratch();
        group.bench_function(format!("{threads} threads"), |b| {
            b.iter(|| pool.install(|| blend.blend_crowd(&weights, &mut scratch, &mut positions)));
        });
    }
    let mut scratch = blend.scratch();
    let mut one = Vec::new();
    group.bench_function("one after the other", |b| {
        b.iter(|| {
            for weights in weights.chunks(4) {
                blend.blend(weights, &mut scratch, &mut one).expect("a frame");
            }
        });
    });
    group.finish();
}

criterion_group!(benches, frames, set_up, crowd);
criterion_main!(benches);
