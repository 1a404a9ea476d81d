//! Properties that every provider has, and numbers from an independent implementation (numpy, SciPy).

use proptest::prelude::*;

use super::*;

mod plane;

fn places(points: &[[f64; 2]]) -> Vec<Vec<f64>> {
    points.iter().map(|p| p.to_vec()).collect()
}

fn biharmonic(points: &[[f64; 2]]) -> BiharmonicWeights {
    BiharmonicWeights::new(&places(points), &BiharmonicOptions::default()).expect("a layout")
}

fn at(provider: &dyn WeightProvider, place: [f64; 2]) -> Vec<f64> {
    let mut weights = Vec::new();
    provider.weights(&place, &mut weights).expect("a place");
    weights
}

const LAYOUTS: [&[[f64; 2]]; 5] = [
    &[[0.3, 0.2]],
    &[[0.0, 0.0], [1.0, 0.5]],
    &[[0.0, 0.0], [0.3, 0.3], [0.4, 0.4], [1.0, 1.0]],
    &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
    &[[2e5, 3e5], [2.1e5, 3.4e5], [2.5e5, 3e5], [2.2e5, 3.1e5]],
];

fn providers(layout: &[[f64; 2]]) -> Vec<Box<dyn WeightProvider>> {
    let mut all: Vec<Box<dyn WeightProvider>> = Vec::new();
    for energy in [Energy::Hessian, Energy::JacobianDifferences] {
        let options = BiharmonicOptions {
            energy,
            ..BiharmonicOptions::default()
        };
        all.push(Box::new(
            BiharmonicWeights::new(&places(layout), &options).expect("a layout"),
        ));
    }
    for radial in [Radial::BSpline, Radial::ThinPlate] {
        let options = RbfOptions {
            radial,
            ..RbfOptions::default()
        };
        all.push(Box::new(RbfWeights::new(&places(layout), &options).expect("a layout")));
    }
    all
}

#[test]
fn weights_are_cardinal_and_sum_to_one() {
    for layout in LAYOUTS {
        let size = (layout[0][0] - layout[layout.len() - 1][0]).abs().max(1.0);
        for provider in providers(layout) {
            for (k, &place) in layout.iter().enumerate() {
                for (pose, weight) in at(&*provider, place).into_iter().enumerate() {
                    let expected = if pose == k { 1.0 } else { 0.0 };
                    assert!((weight - expected).abs() < 1e-9, "{provider:?}");
                }
            }
            for step in 0..40 {
                let (sin, cos) = (0.7 * f64::from(step)).sin_cos();
                let away = 0.2 * f64::from(step) * size;
                let sum: f64 = at(&*provider, [layout[0][0] + away * cos, layout[0][1] + away * sin])
                    .iter()
                    .sum();
                assert!((sum - 1.0).abs() < 1e-9, "{sum}");
            }
        }
    }
}

#[test]
fn a_square_of_poses_has_symmetric_weights() {
    let provider = biharmonic(LAYOUTS[3]);
    for weight in at(&provider, [0.5, 0.5]) {
        assert!((weight - 0.25).abs() < 2e-3, "{weight}");
    }
    for (x, y) in [(0.3, 0.1), (-0.4, 0.8), (1.4, 1.2)] {
        let (here, mirrored) = (at(&provider, [x, y]), at(&provider, [1.0 - x, y]));
        for (pose, other) in [(0, 1), (1, 0), (2, 3), (3, 2)] {
            assert!((here[pose] - mirrored[other]).abs() < 5e-3);
        }
    }
}

#[test]
fn weights_level_out_far_away() {
    for layout in LAYOUTS {
        let provider = biharmonic(layout);
        let (low, high) = provider.domain();
        let centre = [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])];
        let diagonal = (high[0] - low[0]) / 8.0;
        for step in 0..8 {
            let (sin, cos) = (std::f64::consts::FRAC_PI_4 * f64::from(step)).sin_cos();
            let out = |r: f64| {
                at(
                    &provider,
                    [centre[0] + r * diagonal * cos, centre[1] + r * diagonal * sin],
                )
            };
            for (near, far) in out(6.0).into_iter().zip(out(12.0)) {
                assert!((near - far).abs() < 0.02);
            }
            // No wild extrapolation on the way.
            assert!(out(2.0).iter().all(|weight| weight.abs() < 2.0), "{:?}", out(2.0));
        }
    }
}

#[test]
fn weights_do_not_kink_between_vertices() {
    for layout in &LAYOUTS[1..] {
        let provider = biharmonic(layout);
        let (low, high) = provider.domain();
        let point = |t: f64| {
            let t = 0.4 + 0.2 * t;
            [
                low[0] + t * (high[0] - low[0]),
                low[1] + (0.42 + 0.8 * (t - 0.4)) * (high[1] - low[1]),
            ]
        };
        let largest_second_difference = |steps: u32| {
            let samples: Vec<Vec<f64>> = (0..=steps)
                .map(|k| at(&provider, point(f64::from(k) / f64::from(steps))))
                .collect();
            let bends = samples
                .windows(3)
                .flat_map(|w| (0..w[0].len()).map(|pose| (w[0][pose] - 2.0 * w[1][pose] + w[2][pose]).abs()));
            bends.fold(0.0, f64::max)
        };
        let ratio = largest_second_difference(200) / largest_second_difference(800);
        assert!(ratio > 8.0, "{ratio}");
    }
}

/// The weights of `poses`, in a frame of their own, on a given mesh.
fn solved(mesh: tessellation::Tessellation, poses: &[crate::math::Point], energy: Energy) -> surface::Surface {
    let (epsilon, gradient_unit) = match energy {
        Energy::Hessian => (1e-3, 1024.0),
        Energy::JacobianDifferences => (1e-3, 1.0),
    };
    let plan = space::Plan {
        poses,
        walls: &walls::Walls::default(),
        energy,
        epsilon,
        range: Range::Free,
        flat: Vec::new(),
        pulled: Vec::new(),
        frame: space::Frame {
            centre: crate::math::Point::zeros(),
            diagonal: 1.0,
        },
        held: Vec::new(),
    };
    let space = space::Space::on_mesh(mesh, gradient_unit, &plan, &space::Wishes::default()).expect("a layout");
    space.surface().clone()
}

#[test]
fn the_default_energy_converges() {
    // The same weights from a mesh with four times the vertices.
    let poses = [[-0.4, -0.3], [0.4, -0.3], [0.4, 0.3], [-0.1, 0.1], [0.0, 0.15]].map(crate::math::Point::from);
    let surface = |refinement: u32| {
        let mesh = tessellation::graded(&poses, &walls::Walls::default(), refinement).expect("no walls");
        solved(mesh, &poses, Energy::Hessian)
    };
    let (coarse, fine) = (surface(0), surface(1));
    let (mut a, mut b) = (Vec::new(), Vec::new());
    let mut worst = 0.0_f64;
    for k in 0..200 {
        let p = crate::math::Point::new((f64::from(k) * 0.37).sin(), (f64::from(k) * 0.71).cos());
        coarse.values(p, &mut a);
        fine.values(p, &mut b);
        for (x, y) in a.iter().zip(&b) {
            worst = worst.max((x - y).abs());
        }
    }
    assert!(worst < 8e-3, "{worst}");
}

#[test]
fn the_layout_may_be_moved_and_scaled() {
    let layout = [[0.0, 0.0], [1.0, 0.2], [0.3, 0.9]];
    let moved = layout.map(|[x, y]| [1000.0 * x - 7.0, 1000.0 * y + 3.0]);
    let (plain, far) = (biharmonic(&layout), biharmonic(&moved));
    for place in [[0.5, 0.5], [2.0, -1.0], [-9.0, 3.0]] {
        let same = [1000.0 * place[0] - 7.0, 1000.0 * place[1] + 3.0];
        for (a, b) in at(&plain, place).into_iter().zip(at(&far, same)) {
            assert!((a - b).abs() < 1e-9);
        }
    }
}

#[test]
fn bad_layouts_are_refused() {
    let refused = |points: &[[f64; 2]]| {
        let error = BiharmonicWeights::new(&places(points), &BiharmonicOptions::default()).expect_err("bad");
        assert_eq!(
            RbfWeights::new(&places(points), &RbfOptions::default())
                .expect_err("bad")
                .to_string(),
            error.to_string()
        );
        error
    };
    assert_eq!(refused(&[]), WeightError::NoPose);
    let same = refused(&[[0.0, 1.0], [2.0, 1.0], [0.0, 1.0]]);
    assert_eq!(same, WeightError::Coincident { first: 0, second: 2 });
    assert!(matches!(
        refused(&[[0.0, f64::NAN], [2.0, 1.0]]),
        WeightError::NotFinite { .. }
    ));
    let space = BiharmonicWeights::new(&[vec![0.0; 3]], &BiharmonicOptions::default());
    assert!(matches!(
        space,
        Err(WeightError::WrongDimension { expected: 2, found: 3 })
    ));
    let options = BiharmonicOptions {
        epsilon: 0.0,
        ..BiharmonicOptions::default()
    };
    assert!(BiharmonicWeights::new(&places(LAYOUTS[1]), &options).is_err());
    let provider = biharmonic(LAYOUTS[1]);
    let mut weights = Vec::new();
    assert!(provider.weights(&[0.0, f64::NAN], &mut weights).is_err());
    assert!(provider.weights(&[0.0], &mut weights).is_err());
}

#[test]
fn radial_weights_agree_with_the_independent_implementation() {
    let paper = RbfWeights::new(&[vec![0.15], vec![0.30], vec![0.75]], &RbfOptions::default()).expect("a layout");
    let mut weights = Vec::new();
    for (x, expected) in RBF_ONE_DIMENSION {
        paper.weights(&[x], &mut weights).expect("a place");
        assert_close(&weights, &expected);
    }
    let quad = places(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [0.5, 0.5]]);
    let pseudo = |from: [f64; 2], at: [f64; 2]| PseudoPose {
        from: from.to_vec(),
        at: at.to_vec(),
    };
    let options = RbfOptions {
        radial: Radial::BSpline,
        pseudo_poses: vec![pseudo([0.8, 0.6], [1.0, 0.9]), pseudo([0.2, 0.6], [0.0, 0.8])],
    };
    let moved = RbfWeights::new(&quad, &options).expect("a layout");
    assert_close(&at(&moved, [0.7, 0.4]), &RBF_PSEUDO);
    let thin = RbfOptions {
        radial: Radial::ThinPlate,
        ..RbfOptions::default()
    };
    let scattered = places(&[[0.1, 0.2], [0.9, 0.1], [0.4, 0.7], [0.8, 0.8], [0.2, 0.5]]);
    let provider = RbfWeights::new(&scattered, &thin).expect("a layout");
    assert_close(&at(&provider, [0.5, 0.4]), &THIN_PLATE[0]);
    assert_close(&at(&provider, [1.5, -0.2]), &THIN_PLATE[1]);
}

#[test]
fn radial_weights_are_edited_like_a_new_fit_and_batches_equal_single_places() {
    let scattered: Vec<Vec<f64>> = (0..14)
        .map(|k| (0..4).map(|d| (f64::from(k) * 1.7 * f64::from(d + 3)).sin()).collect())
        .collect();
    let queries: Vec<f64> = (0..4 * 37).map(|k| 1.2 * (f64::from(k) * 0.37).sin()).collect();
    for radial in [Radial::BSpline, Radial::ThinPlate] {
        let options = RbfOptions {
            radial,
            pseudo_poses: vec![PseudoPose {
                from: vec![0.1; 4],
                at: vec![0.3; 4],
            }],
        };
        let mut edited = RbfWeights::new(&scattered, &options).expect("a layout");
        let mut layout = scattered.clone();
        layout[3] = vec![0.2, 0.1, -0.4, 0.9];
        edited.move_pose(3, &layout[3]).expect("a place");
        layout.push(vec![-0.6, 0.5, 0.4, 0.2]);
        edited.insert_pose(&layout[14]).expect("a place");
        layout.remove(0);
        edited.remove_pose(0).expect("a pose");
        let fresh = RbfWeights::new(&layout, &options).expect("a layout");
        let (mut many, mut one, mut other) = (Vec::new(), Vec::new(), Vec::new());
        edited.weights_of_many(&queries, &mut many).expect("places");
        for (query, row) in queries.chunks_exact(4).zip(many.chunks_exact(14)) {
            edited.weights(query, &mut one).expect("a place");
            fresh.weights(query, &mut other).expect("a place");
            assert_eq!((row, &one), (one.as_slice(), &other));
        }
        assert!(edited.move_pose(14, &layout[0]).is_err() && edited.insert_pose(&layout[2]).is_err());
        assert!(edited.weights_of_many(&queries[..5], &mut many).is_err());
        edited.weights(&queries[..4], &mut other).expect("a place");
        fresh.weights(&queries[..4], &mut one).expect("a place");
        assert_eq!(one, other);
    }
}

#[test]
fn nearly_singular_layouts_are_refused_with_the_poses_to_blame() {
    let mut layout = places(&[[0.1, 0.2], [0.9, 0.1], [0.4, 0.7], [0.8, 0.8], [0.2, 0.5]]);
    layout.push(vec![0.4 + 2e-6, 0.7]);
    let options = RbfOptions {
        radial: Radial::ThinPlate,
        ..RbfOptions::default()
    };
    let error = RbfWeights::new(&layout, &options).expect_err("nearly singular");
    let WeightError::NearlySingular { poses, condition } = &error else {
        panic!("{error}");
    };
    assert_eq!((poses.as_slice(), *condition > 1e10), (&[2, 5][..], true));
    let message = error.naming(|pose| format!("'{}'", ["a", "b", "run", "c", "d", "jump"][pose]));
    assert!(
        message.contains("'run', 'jump'") && message.contains("move one"),
        "{message}"
    );
    layout.pop();
    let fine = RbfWeights::new(&layout, &options).expect("a layout");
    assert!(fine.condition() < 1e4, "{}", fine.condition());
}

fn assert_close(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() < 1e-10, "{found:?} instead of {expected:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn radial_weights_reproduce_linear_functions(
        points in proptest::collection::vec(proptest::collection::vec(0.0..1.0f64, 3), 4..10),
        place in proptest::collection::vec(-0.5..1.5f64, 3),
    ) {
        for radial in [Radial::BSpline, Radial::ThinPlate] {
            let options = RbfOptions { radial, ..RbfOptions::default() };
            let Ok(provider) = RbfWeights::new(&points, &options) else { continue };
            let mut weights = Vec::new();
            provider.weights(&place, &mut weights).expect("a place");
            for k in 0..3 {
                let blended: f64 = points.iter().zip(&weights).map(|(p, w)| p[k] * w).sum();
                prop_assert!((blended - place[k]).abs() < 1e-6, "{blended} instead of {}", place[k]);
            }
        }
    }
}

const RBF_ONE_DIMENSION: [(f64, [f64; 3]); 4] = [
    (0.0, [0.96994301994302, 0.37340930674264006, -0.3433523266856601]),
    (0.2, [0.6854067742956628, 0.30834652316133826, 0.006246702542998812]),
    (0.5, [0.23651735781365416, 0.2401990784706834, 0.5232835637156625]),
    (1.0, [-0.3590930674264009, -0.07676479898702122, 1.4358578664134223]),
];

const RBF_PSEUDO: [f64; 5] = [
    -0.086414770029907,
    0.29785595563214806,
    -0.0006712211855351702,
    0.010874128044810444,
    0.7783559075384836,
];

const THIN_PLATE: [[f64; 5]; 2] = [
    [
        0.12275989415239347,
        0.33026635721490527,
        0.2838974144927734,
        0.04051676077708505,
        0.22255957336284282,
    ],
    [
        -0.2289661668083065,
        1.8016380682787716,
        -0.5601299049299779,
        0.21330452751670784,
        -0.22584652405719402,
    ],
];
