use proptest::prelude::*;

use super::*;
use crate::weights::Radial;

fn topology() -> FormTopology {
    FormTopology::from_triangles(4, vec![[0, 1, 2], [0, 2, 3]]).expect("two triangles")
}

fn form(seed: f64) -> Form {
    let position = |v: usize| Point3::from_fn(|d, _| (seed + 1.3 * v as f64 + 0.4 * d as f64).sin());
    Form::new(&topology(), (0..4).map(position).collect()).expect("a form")
}

fn shape(places: &[Vec<f64>], options: &RbfOptions) -> Result<Shape, ShapeError> {
    let examples = places.iter().enumerate();
    let examples = examples.map(|(k, at)| Example {
        form: form(2.3 * (k * k) as f64),
        at: at.clone(),
    });
    Shape::new(topology(), examples.collect(), options)
}

fn distance(a: &Form, b: &Form) -> f64 {
    let pairs = a.positions().iter().zip(b.positions());
    pairs.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

/// Five examples and two pseudo-examples, as in Figure 5.
fn bendable() -> Shape {
    let places = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [0.5, 0.5]].map(Vec::from);
    let options = RbfOptions {
        pseudo_poses: vec![
            PseudoPose {
                from: vec![0.8, 0.6],
                at: vec![1.0, 0.8],
            },
            PseudoPose {
                from: vec![0.2, 0.6],
                at: vec![0.0, 0.8],
            },
        ],
        ..RbfOptions::default()
    };
    shape(&places, &options).expect("a shape")
}

#[test]
fn the_example_of_figures_2_and_3_by_hand() {
    // The line for the first example falls by 0.25 / 0.195 a unit about (0.4, 1/3). It misses the examples by 9/26, -12/26 and 3/26,
    // which splines of radius 0.15, 0.15 and 0.45 make good with these coefficients.
    let line = |x: f64| 1.0 / 3.0 - 0.25 / 0.195 * (x - 0.4);
    let coefficients = [1723.0 / 2340.0, -2152.0 / 2340.0, 9.0 / 52.0];
    let by_hand = [
        (0.15, 1.0),
        (0.30, 0.0),
        (0.75, 0.0),
        // Splines at 0.5, 0.5 and 7/6 of their radius.
        (
            0.225,
            line(0.225) + 23.0 / 48.0 * (coefficients[0] + coefficients[1]) + 125.0 / 1296.0 * coefficients[2],
        ),
        // At 1, 2 (where it ends) and 5/3 of their radius.
        (0.0, line(0.0) + coefficients[0] / 6.0 + coefficients[2] / 162.0),
        // Far away, the line alone.
        (3.0, line(3.0)),
    ];
    let places = [0.15, 0.30, 0.75].map(|x| vec![x]);
    let shape = shape(&places, &RbfOptions::default()).expect("a shape");
    let mut weights = Vec::new();
    for (x, expected) in by_hand {
        shape.weights().weights(&[x], &mut weights).expect("a place");
        assert!(
            (weights[0] - expected).abs() < 1e-13,
            "at {x}: {weights:?}, not {expected}"
        );
        // The upper line of Figure 3: the bases scaled by the examples' value, and summed.
        let sum: f64 = (weights.iter().zip(shape.forms()))
            .map(|(weight, form)| weight * form.positions()[2].y)
            .sum();
        let found = shape.form_at(&[x]).expect("a place");
        assert!((found.positions()[2].y - sum).abs() < 1e-14);
    }
}

#[test]
fn examples_are_exact_and_pseudo_examples_take_what_was_found_elsewhere() {
    let shape = bendable();
    for (example, at) in shape.weights().places().iter().enumerate() {
        let found = shape.form_at(at).expect("a place");
        assert!(distance(&found, &shape.forms()[example]) < 1e-13);
    }
    let mut plain = shape.clone();
    plain.set_pseudo_examples(Vec::new()).expect("fewer");
    for pseudo in shape.weights().pseudo_poses() {
        let (wanted, found) = (plain.form_at(&pseudo.from), shape.form_at(&pseudo.at));
        assert!(distance(&wanted.expect("a place"), &found.expect("a place")) < 1e-13);
    }
    plain
        .set_pseudo_examples(shape.weights().pseudo_poses().to_vec())
        .expect("the same again");
    assert_eq!(plain.form_at(&[0.9, 0.7]), shape.form_at(&[0.9, 0.7]));
}

#[test]
fn a_blend_that_was_fixed_up_becomes_an_example() {
    let mut shape = bendable();
    let at = [0.75, 0.1];
    let mut positions = shape.form_at(&at).expect("a place").into_positions();
    positions[3].z += 0.25;
    let fixed = Form::new(shape.topology(), positions).expect("a form");
    let kept: Vec<*const Point3> = shape.forms().iter().map(|form| form.positions().as_ptr()).collect();
    shape.insert_example(fixed.clone(), &at).expect("a new place");
    assert!(distance(&shape.form_at(&at).expect("a place"), &fixed) < 1e-13);
    let first = shape.forms()[0].clone();
    assert!(distance(&shape.form_at(&[0.0, 0.0]).expect("a place"), &first) < 1e-13);
    // Neither this nor moving an example copies a form.
    shape.move_example(1, &[1.1, -0.1]).expect("a place");
    let now: Vec<*const Point3> = shape.forms().iter().map(|form| form.positions().as_ptr()).collect();
    assert_eq!(now[..5], kept[..]);
    assert_eq!(shape.remove_example(5), Ok(fixed));
}

#[test]
fn editing_gives_what_a_new_shape_would_be() {
    let mut edited = bendable();
    edited.move_example(4, &[0.4, 0.55]).expect("a place");
    edited.insert_example(form(9.0), &[0.5, -0.4]).expect("a place");
    edited.remove_example(0).expect("an example");
    edited.replace_form(2, form(77.0)).expect("a form");
    let examples = edited.forms().iter().zip(edited.weights().places());
    let examples = examples.map(|(form, at)| Example {
        form: form.clone(),
        at: at.clone(),
    });
    let options = RbfOptions {
        pseudo_poses: edited.weights().pseudo_poses().to_vec(),
        ..RbfOptions::default()
    };
    let fresh = Shape::new(topology(), examples.collect(), &options).expect("a shape");
    for at in [[0.3, 0.2], [0.9, 0.75], [-0.5, 1.5]] {
        assert_eq!(edited.form_at(&at), fresh.form_at(&at));
    }
}

#[test]
fn mistakes_are_refused_and_change_nothing() {
    let mut shape = bendable();
    let before = shape.form_at(&[0.3, 0.9]);
    let small = FormTopology::from_triangles(3, vec![[0, 1, 2]]).expect("a triangle");
    let other = Form::new(&small, vec![Point3::zeros(); 3]).expect("a form");
    let refused = shape
        .insert_example(other.clone(), &[3.0, 3.0])
        .expect_err("another form");
    let problem = FormError::OtherVertexCount { expected: 4, found: 3 };
    assert_eq!(refused, ShapeError::Form { example: 5, problem });
    assert!(shape.replace_form(0, other).is_err());
    assert!(shape.insert_example(form(1.0), &[0.5, 0.5]).is_err());
    assert!(shape.insert_example(form(1.0), &[0.5]).is_err());
    assert!(shape.move_example(0, &[f64::NAN, 0.0]).is_err());
    assert!(shape.move_example(2, &[1.0, 1.0]).is_err());
    let none = ShapeError::NoSuchExample { example: 5, count: 5 };
    assert_eq!(shape.move_example(5, &[2.0, 2.0]), Err(none.clone()));
    assert_eq!(shape.remove_example(5), Err(none.clone()));
    assert_eq!(shape.replace_form(5, form(0.0)), Err(none));
    let bad = vec![PseudoPose {
        from: vec![0.5],
        at: vec![0.1, 0.2],
    }];
    assert!(shape.set_pseudo_examples(bad).is_err());
    assert!(shape.form_at(&[1e300, 0.0]).is_err());
    assert_eq!((shape.forms().len(), shape.form_at(&[0.3, 0.9])), (5, before));
    let far = Form::new(&topology(), vec![Point3::new(1e13, 0.0, 0.0); 4]);
    assert_eq!(far, Err(FormError::NotFinite { vertex: 0 }));
    assert!(Shape::new(topology(), Vec::new(), &RbfOptions::default()).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn forms_that_are_linear_in_their_place_stay_so_everywhere(
        places in prop::collection::vec(prop::collection::vec(0.0..1.0f64, 3), 4..9),
        at in prop::collection::vec(-0.5..1.5f64, 3),
    ) {
        let linear = |at: &[f64]| {
            let position = |v: usize| Point3::new(at[0] + v as f64, at[1] - at[2], 0.5 * at[v % 3]);
            Form::new(&topology(), (0..4).map(position).collect()).expect("a form")
        };
        for radial in [Radial::BSpline, Radial::ThinPlate] {
            let examples = places.iter().map(|at| Example { form: linear(at), at: at.clone() }).collect();
            let options = RbfOptions { radial, ..RbfOptions::default() };
            let Ok(shape) = Shape::new(topology(), examples, &options) else { continue };
            let found = shape.form_at(&at).expect("a place");
            prop_assert!(distance(&found, &linear(&at)) < 1e-6);
        }
    }
}
