//! What Shape by Example costs at run time and while it is edited: `cargo bench --bench shape`, half a minute.
//!
//! First a table, in microseconds, the least of many runs, of
//! - NumPy's `w @ X` in single precision, which adds as many forms of as many values, run in between in one go with ours;
//! - the blend, and the blend with its weights, of the two shapes that the paper measures: 8 examples (and 6 pseudo-examples,
//!   4 adjectives) of 4,005 values, 5 examples (and 2, 2) of 7,686;
//! - fitting the weights again after one of 14 examples in 4 dimensions has moved, and one of 8 with 6 pseudo-examples.
//!
//! It needs `python3` with NumPy, and says so if there is none. Then criterion measures ours again.

use std::hint::black_box;
use std::process::Command;
use std::time::Instant;

use brief::brief;
use criterion::{Criterion, criterion_group, criterion_main};
use inbetween::math::Point3;
use inbetween::shape3d::{Example, Form, FormBlender, FormLayout, FormTopology, Shape};
use inbetween::weights::{PseudoPose, Radial, RbfOptions, RbfWeights, WeightProvider};

#[path = "common/brief.rs"]
mod brief;

/// The shapes of sections 6.1 and 6.2: examples, pseudo-examples, adjectives, vertices.
const SHAPES: [(&str, [usize; 4]); 2] = [
    ("8 x 4,005 values", [8, 6, 4, 1335]),
    ("5 x 7,686 values", [5, 2, 2, 2562]),
];

/// How often each of both is measured, in turns.
const TURNS: usize = 5;

/// Prints the least time of `w @ X`, in microseconds.
const NUMPY: &str = "
import sys, time
import numpy as np
forms, values = int(sys.argv[1]), int(sys.argv[2])
x = np.random.default_rng(1).random((forms, values), dtype=np.float32)
w = np.random.default_rng(2).random(forms, dtype=np.float32)
least = 1.0
for _ in range(2000):
    begin = time.perf_counter()
    for _ in range(20): w @ x
    least = min(least, (time.perf_counter() - begin) / 20)
print(least * 1e6)
";

fn coordinate(k: usize, d: usize) -> f64 {
    (1.7 * (k * (d + 3)) as f64).sin()
}

fn places(count: usize, dimension: usize) -> Vec<Vec<f64>> {
    (0..count)
        .map(|k| (0..dimension).map(|d| coordinate(k, d)).collect())
        .collect()
}

fn options(radial: Radial, pseudo: &[Vec<f64>]) -> RbfOptions {
    let pseudo_pose = |at: &Vec<f64>| PseudoPose {
        from: at.iter().map(|x| 0.9 * x).collect(),
        at: at.clone(),
    };
    let mut options = RbfOptions::default();
    options.radial = radial;
    options.pseudo_poses = pseudo.iter().map(pseudo_pose).collect();
    options
}

fn shape([count, pseudo, dimension, vertices]: [usize; 4]) -> Shape {
    let places = places(count + pseudo, dimension);
    let topology = FormTopology::from_triangles(vertices, vec![[0, 1, 2]]).expect("a triangle");
    let example = |k: usize| {
        let position = |v: usize| Point3::from_fn(|d, _| (0.01 * (v * 3 + d) as f64 + k as f64).sin());
        Example {
            form: Form::new(&topology, (0..vertices).map(position).collect()).expect("a form"),
            at: places[k].clone(),
        }
    };
    let options = options(Radial::BSpline, &places[count..]);
    Shape::new(topology.clone(), (0..count).map(example).collect(), &options).expect("a shape")
}

/// The weights of 14 examples in 4 dimensions, the last `pseudo` of which are pseudo-examples.
fn weights_of_14(radial: Radial, pseudo: usize) -> RbfWeights {
    let places = places(14, 4);
    let (own, pseudo) = places.split_at(14 - pseudo);
    RbfWeights::new(own, &options(radial, pseudo)).expect("a layout")
}

fn place(angle: f64) -> [f64; 4] {
    [0.3 * angle.cos(), 0.3 * angle.sin(), 0.3, 0.4]
}

/// The least time of `work`, in microseconds.
fn least(mut work: impl FnMut()) -> f64 {
    const AT_ONCE: u32 = 20;
    let mut least = f64::INFINITY;
    for _ in 0..2000 {
        let begin = Instant::now();
        (0..AT_ONCE).for_each(|_| work());
        least = least.min(begin.elapsed().as_secs_f64() / f64::from(AT_ONCE));
    }
    1e6 * least
}

fn numpy(forms: usize, values: usize) -> Option<f64> {
    let mut command = Command::new("python3");
    command.args(["-c", NUMPY, &forms.to_string(), &values.to_string()]);
    // One thread, as ours.
    let output = command.env("OPENBLAS_NUM_THREADS", "1").output().ok()?;
    String::from_utf8(output.stdout).ok()?.trim().parse().ok()
}

#[expect(clippy::print_stdout, reason = "a table is what it is for")]
fn table(_: &mut Criterion) {
    println!("microseconds           | NumPy blend | blend | with weights | of NumPy's");
    for (name, sizes) in SHAPES {
        let shape = shape(sizes);
        let blender = FormBlender::new(&shape, FormLayout::Planar);
        let mut weights = Vec::new();
        let mut values = vec![0.0_f32; blender.value_count()];
        let at: Vec<f64> = (0..shape.dimension()).map(|d| 0.1 + 0.2 * d as f64).collect();
        shape.weights().weights(&at, &mut weights).expect("a place");
        let (mut theirs, mut blend, mut both) = (Some(f64::INFINITY), f64::INFINITY, f64::INFINITY);
        for _ in 0..TURNS {
            theirs = theirs.and_then(|so_far| Some(so_far.min(numpy(sizes[0], 3 * sizes[3])?)));
            blend = blend.min(least(|| {
                blender
                    .blend(black_box(&weights), black_box(&mut values))
                    .expect("buffers");
            }));
            both = both.min(least(|| {
                shape.weights().weights(black_box(&at), &mut weights).expect("a place");
                blender.blend(&weights, black_box(&mut values)).expect("buffers");
            }));
        }
        match theirs {
            Some(theirs) => println!(
                "{name:22} | {theirs:11.2} | {blend:5.2} | {both:12.2} | {:.2}",
                both / theirs
            ),
            None => {
                println!("{name:22} | {:>11} | {blend:5.2} | {both:12.2} |", "-");
                println!("NOT COMPARED: there is no python3 with NumPy on this machine (pip install numpy)");
            }
        }
    }
    for radial in [Radial::BSpline, Radial::ThinPlate] {
        for pseudo in [0, 6] {
            let mut provider = weights_of_14(radial, pseudo);
            let mut angle = 0.0;
            let time = least(|| {
                angle += 0.1;
                provider.move_pose(3, &place(angle)).expect("a place");
            });
            println!(
                "{radial:?}, {} + {pseudo} examples in 4 dimensions, fitted again: {time:.2}",
                14 - pseudo
            );
        }
    }
}

fn at_run_time(criterion: &mut Criterion) {
    let mut group = brief(criterion, "run time");
    for (name, sizes) in SHAPES {
        let shape = shape(sizes);
        let blender = FormBlender::new(&shape, FormLayout::Planar);
        let (mut weights, mut values) = (Vec::new(), vec![0.0_f32; blender.value_count()]);
        let mut angle = 0.0;
        group.bench_function(format!("weights and blend/{name}"), |b| {
            b.iter(|| {
                angle += 0.1;
                let at = &place(angle)[..shape.dimension()];
                shape.weights().weights(at, &mut weights)?;
                blender.blend(&weights, black_box(&mut values))
            });
        });
    }
}

fn while_editing(criterion: &mut Criterion) {
    let mut group = brief(criterion, "editing");
    for radial in [Radial::BSpline, Radial::ThinPlate] {
        for pseudo in [0, 6] {
            let mut provider = weights_of_14(radial, pseudo);
            let mut angle = 0.0;
            let name = format!("{radial:?}, {} + {pseudo} examples in 4 dimensions", 14 - pseudo);
            group.bench_function(format!("move an example/{name}"), |b| {
                b.iter(|| {
                    angle += 0.1;
                    provider.move_pose(3, &place(angle))
                });
            });
        }
    }
}

criterion_group!(benches, table, at_run_time, while_editing);
criterion_main!(benches);
