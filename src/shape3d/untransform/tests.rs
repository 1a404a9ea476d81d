use super::*;
use crate::shape3d::{Joint, Rig, RigScratch, Skeleton, Turn};
use proptest::prelude::*;
use std::f64::consts::TAU;

const RADIUS: f64 = 1.0;
const RING: usize = 16;
/// Where the elbow is, and how far the skin is shared on either side of it.
const ELBOW: f64 = 4.0;
const SHARED: f64 = 2.0;

/// An upper arm, a forearm that turns by `degrees` for a unit of adjective 0, and both by 120 for a unit of adjective 1.
fn skeleton(degrees: f64) -> Skeleton {
    let mut upper = Joint::new("upper", None, Point3::zeros());
    upper.turns.push(Turn {
        adjective: 1,
        axis: Point3::new(1.0, 1.0, 1.0),
        degrees: 120.0,
        degrees_at_zero: 0.0,
    });
    let mut forearm = Joint::new("forearm", Some(0), Point3::new(ELBOW, 0.0, 0.0));
    forearm.turns.push(Turn {
        adjective: 0,
        axis: Point3::z(),
        degrees,
        degrees_at_zero: 0.0,
    });
    Skeleton::new(vec![upper, forearm], 2).expect("a skeleton")
}

/// A tube along x from 0 to 8.
fn tube() -> Vec<Point3> {
    (0..=32)
        .flat_map(|station| {
            (0..RING).map(move |corner| {
                let (sin, cos) = libm::sincos(TAU * corner as f64 / RING as f64);
                Point3::new(station as f64 * 0.25, RADIUS * cos, RADIUS * sin)
            })
        })
        .collect()
}

fn share(x: f64) -> f64 {
    crate::math::smooth_step(x, ELBOW - SHARED, ELBOW + SHARED)
}

fn skin() -> Skin {
    let weights: Vec<_> = tube()
        .iter()
        .map(|at| vec![(0, 1.0 - share(at.x)), (1, share(at.x))])
        .collect();
    Skin::new(&weights, 2).expect("a skin")
}

/// The tube as an artist would bend it: its middle line goes round an arc, its cross-sections stay circles.
fn bent_by_an_artist(angle_rad: f64) -> Vec<Point3> {
    const STEPS: usize = 400;
    tube()
        .iter()
        .map(|at| {
            let (mut middle, step) = (Point3::zeros(), at.x / STEPS as f64);
            for index in 0..STEPS {
                let (sin, cos) = libm::sincos(angle_rad * share((index as f64 + 0.5) * step));
                middle += Point3::new(cos, sin, 0.0) * step;
            }
            let (sin, cos) = libm::sincos(angle_rad * share(at.x));
            middle + Point3::new(-sin, cos, 0.0) * at.y + Point3::z() * at.z
        })
        .collect()
}

/// The area of the cross-section at the elbow, by the shoelace formula in its best plane, as a fraction of the straight one's.
fn elbow_section(positions: &[Point3]) -> f64 {
    let ring = &positions[16 * RING..17 * RING];
    let centre: Point3 = ring.iter().sum::<Point3>() / RING as f64;
    let area: Point3 = (0..RING)
        .map(|corner| (ring[corner] - centre).cross(&(ring[(corner + 1) % RING] - centre)))
        .sum();
    let straight = 0.5 * RING as f64 * RADIUS * RADIUS * libm::sin(TAU / RING as f64);
    0.5 * area.norm() / straight
}

/// The tube blended from the straight and the bent example and taken to its pose.
fn by_example(degrees: f64, examples: &[(f64, Vec<Point3>)], weights: &[f64], place: [f64; 2]) -> Vec<Point3> {
    let rig = Rig::new(skeleton(degrees), skin()).expect("a rig");
    let rest: Vec<RestForm> = examples
        .iter()
        .map(|(elbow, form)| rig.untransform(&[*elbow, 0.0], form).expect("a rest form"))
        .collect();
    let poser = rig.poser(&rest);
    let mut blended: Vec<Point3> = (0..rest[0].positions.len())
        .map(|vertex| {
            rest.iter()
                .zip(weights)
                .map(|(form, &weight)| form.positions[vertex] * weight)
                .sum()
        })
        .collect();
    let mut planes: [Vec<f32>; 3] = [0, 1, 2].map(|axis| blended.iter().map(|at| at[axis] as f32).collect());
    let mut scratch = RigScratch::default();
    poser.pose(&place, weights, &mut blended, &mut scratch).expect("a pose");
    let [xs, ys, zs] = &mut planes;
    let measured = allocation_counter::measure(|| {
        poser
            .pose_planes(&place, weights, [&mut *xs, &mut *ys, &mut *zs], &mut scratch)
            .expect("a pose");
    });
    // The rows are allocated once.
    assert!(measured.count_total <= 1, "{measured:?}");
    for (vertex, exact) in blended.iter().enumerate() {
        let single = Point3::new(f64::from(xs[vertex]), f64::from(ys[vertex]), f64::from(zs[vertex]));
        assert!((exact - single).norm() < 2e-5, "vertex {vertex}: {exact} and {single}");
    }
    blended
}

#[test]
fn naive_blending_shrinks_the_elbow_and_blending_by_example_does_not() {
    // Figures 6 and 8 of the paper.
    let quarter = TAU / 4.0;
    let mut naive = tube();
    skin()
        .apply(&skeleton(90.0).transforms(&[1.0, 0.0]).expect("a place"), &mut naive)
        .expect("positions");
    let shrunk = elbow_section(&naive);
    // Half of each of two matrices with a right angle between them: cos 45 degrees in one direction of the section.
    assert!((shrunk - 0.5_f64.sqrt()).abs() < 1e-9, "{shrunk}");

    let examples = [(0.0, tube()), (1.0, bent_by_an_artist(quarter))];
    let bent = by_example(90.0, &examples, &[0.0, 1.0], [1.0, 0.0]);
    for (found, wanted) in bent.iter().zip(&examples[1].1) {
        assert!((found - wanted).norm() < 1e-12);
    }
    assert!((elbow_section(&bent) - 1.0).abs() < 1e-9);
    // Half way there is no example; the naive blend has cos 22.5 degrees = 0.924.
    let half = elbow_section(&by_example(90.0, &examples, &[0.5, 0.5], [0.5, 0.0]));
    assert!((1.0..1.12).contains(&half), "{half}");
}

#[test]
fn vertices_without_an_inverse_are_reported_and_still_met() {
    // Half a turn: the middle of the elbow is squashed to a line.
    let folded = bent_by_an_artist(TAU / 2.0);
    let rig = Rig::new(skeleton(180.0), skin()).expect("a rig");
    let rest = rig.untransform(&[1.0, 0.0], &folded).expect("a rest form");
    let reported: Vec<usize> = rest.near_singular.iter().map(|near| near.vertex).collect();
    assert_eq!(reported, (16 * RING..17 * RING).collect::<Vec<_>>());
    assert!(
        rest.near_singular
            .iter()
            .all(|near| near.joints == [0, 1] && near.condition > 1e9)
    );
    // Nothing is blown up beyond the limit, which the rings beside the middle nearly reach.
    assert!(rest.positions.iter().all(|at| at.norm() < 30.0));

    let examples = [(0.0, tube()), (1.0, folded)];
    let met = by_example(180.0, &examples, &[0.0, 1.0], [1.0, 0.0]);
    for (found, wanted) in met.iter().zip(&examples[1].1) {
        assert!((found - wanted).norm() < 1e-11, "{found} {wanted}");
    }
    // The residuals go along when the whole arm is turned: x becomes y, y becomes z.
    let turned = by_example(180.0, &examples, &[0.0, 1.0], [1.0, 1.0]);
    for (found, wanted) in turned.iter().zip(&examples[1].1) {
        assert!((found - Point3::new(wanted.z, wanted.x, wanted.y)).norm() < 1e-11);
    }
}

#[test]
fn a_blend_of_nothing_leaves_the_vertex_to_its_joint() {
    // Three half turns about three axes and nothing turned at all sum to the zero matrix.
    let turn = |x: f64, y: f64, z: f64| Transform {
        linear: Matrix3::from_diagonal(&Point3::new(x, y, z)),
        translation: Point3::x(),
    };
    let transforms = [
        turn(1.0, 1.0, 1.0),
        turn(1.0, -1.0, -1.0),
        turn(-1.0, 1.0, -1.0),
        turn(-1.0, -1.0, 1.0),
    ];
    let skin = Skin::new(&[(0..4).map(|joint| (joint, 0.25)).collect()], 4).expect("a skin");
    let posed = Point3::new(3.0, 4.0, 5.0);
    let rest = untransform(&skin, &transforms, &[posed]).expect("a rest form");
    assert_eq!(rest.positions, [Point3::new(2.0, 4.0, 5.0)]);
    assert_eq!(rest.near_singular[0].condition, f64::INFINITY);
    assert_eq!(rest.near_singular[0].residual, posed - Point3::x());
    let offsets: Vec<_> = Residuals::new(&skin, &[rest]).offsets(&[1.0], &transforms).collect();
    assert_eq!(offsets, [(0, posed - Point3::x())]);
}

#[test]
fn what_does_not_fit_is_refused() {
    let rig = Rig::new(skeleton(90.0), skin()).expect("a rig");
    assert!(rig.untransform(&[0.0], &tube()).is_err());
    assert!(rig.untransform(&[0.0, 0.0], &tube()[1..]).is_err());
    let mut broken = tube();
    broken[7].z = f64::NAN;
    assert_eq!(
        rig.untransform(&[0.0, 0.0], &broken),
        Err(RigError::PositionNotFinite { vertex: 7 })
    );
    let other = Skin::new(&[vec![(0, 1.0)]], 3).expect("a skin");
    assert!(Rig::new(skeleton(90.0), other).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]
    #[test]
    fn untransform_and_transform_are_the_identity(
        elbow in -1.4..1.4f64,
        shoulder in -2.0..2.0f64,
        seed in 0..1000usize,
    ) {
        let rig = Rig::new(skeleton(90.0), skin()).expect("a rig");
        let posed: Vec<Point3> = tube()
            .iter()
            .enumerate()
            .map(|(vertex, at)| at + Point3::new(1.0, -0.5, 0.25) * libm::sin((vertex * seed) as f64))
            .collect();
        let place = [elbow, shoulder];
        let rest = rig.untransform(&place, &posed).expect("a rest form");
        prop_assert!(rest.near_singular.is_empty());
        let mut again = rest.positions.clone();
        rig.skin().apply(&rig.skeleton().transforms(&place).expect("a place"), &mut again).expect("positions");
        for (found, wanted) in again.iter().zip(&posed) {
            prop_assert!((found - wanted).norm() < 1e-12);
        }
    }
}
