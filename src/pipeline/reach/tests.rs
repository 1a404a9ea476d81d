use super::*;
use crate::blend::BlendOptions;
use crate::mesh::Topology;
use crate::weights::{BiharmonicOptions, BiharmonicWeights, RbfOptions, RbfWeights};

/// A clock hand of two triangles from the origin to (4, 0), turned by some angles.
fn hands(angles_deg: &[f64]) -> PoseSet {
    let rest = [[0.0, -0.5], [4.0, 0.0], [0.0, 0.5], [-1.0, 0.0]].map(Point::from);
    let topology = Topology::new(4, vec![[0, 1, 2], [0, 2, 3]]).expect("a mesh");
    let poses = angles_deg.iter().enumerate().map(|(k, angle)| {
        let turn = crate::math::rotation(angle.to_radians());
        (format!("p{k}"), rest.iter().map(|p| turn * p).collect())
    });
    PoseSet::new(topology, poses.collect()).expect("poses")
}

fn tip(poses: &PoseSet) -> ShapePoint {
    let tips: Vec<Point> = poses.positions().iter().map(|positions| positions[1]).collect();
    ShapePoint::new(poses, &tips).expect("a point")
}

fn reach_with_defaults(
    weights: &dyn WeightProvider,
    blend: &RigidBlend,
    places: &[Vec<f64>],
    points: &[ShapePoint],
    targets: &[Point],
) -> Result<Reach, PipelineError> {
    reach(weights, blend, places, points, targets, &ReachOptions::default())
}

#[test]
fn what_a_known_place_shows_is_reached_in_a_plane() {
    let poses = hands(&[0.0, 80.0, 160.0]);
    let places = vec![vec![0.0, 0.0], vec![1.0, 0.0], vec![0.4, 1.0]];
    let weights = BiharmonicWeights::new(&places, &BiharmonicOptions::default()).expect("weights");
    let blend = RigidBlend::new(&poses, &BlendOptions::default()).expect("a blend");
    let (mut at_place, mut positions) = (Vec::new(), Vec::new());
    for known in [[0.5, 0.0], [0.2, 0.3], [0.9, 0.4], [0.5, 0.6]] {
        weights.weights(&known, &mut at_place).expect("weights");
        blend
            .blend(&at_place, &mut blend.scratch(), &mut positions)
            .expect("a blend");
        let target = tip(&poses).at(&positions, &at_place);
        let found = reach_with_defaults(&weights, &blend, &places, &[tip(&poses)], &[target]);
        let found = found.expect("a place");
        assert!(found.error < 1e-6, "{known:?}: {found:?}");
        assert!((found.reached[0] - target).norm() < 1e-6);
        let again = reach_with_defaults(&weights, &blend, &places, &[tip(&poses)], &[target]);
        assert_eq!(again.expect("a place"), found);
        assert!(found.evaluations < 5000, "{}", found.evaluations);
    }
}

#[test]
fn out_of_reach_the_nearest_is_found_in_a_line_and_in_space() {
    // A hand that turns from 0 to 90 degrees comes nearest to (10, 10) when it points there.
    let poses = hands(&[0.0, 90.0]);
    let blend = RigidBlend::new(&poses, &BlendOptions::default()).expect("a blend");
    for places in [
        vec![vec![0.0], vec![1.0]],
        vec![vec![0.0, 2.0, 1.0], vec![3.0, 2.0, 1.0]],
    ] {
        let weights = RbfWeights::new(&places, &RbfOptions::default()).expect("weights");
        let target = Point::new(10.0, 10.0);
        let found = reach_with_defaults(&weights, &blend, &places, &[tip(&poses)], &[target]);
        let found = found.expect("a place");
        // It turns about its middle, which stays on the diagonal: so does the tip.
        assert!((found.reached[0].x - found.reached[0].y).abs() < 1e-2, "{found:?}");
        assert!((found.error - (target - found.reached[0]).norm()).abs() < 1e-9);
        assert!((found.weights[0] - 0.5).abs() < 1e-3);
    }
}

#[test]
fn several_points_share_the_error_and_one_pose_stays_where_it_is() {
    let poses = hands(&[0.0, 90.0]);
    let blend = RigidBlend::new(&poses, &BlendOptions::default()).expect("a blend");
    let places = vec![vec![0.0], vec![1.0]];
    let weights = RbfWeights::new(&places, &RbfOptions::default()).expect("weights");
    // The tip is wanted as in the first pose, and as much as in the second.
    let targets = [Point::new(4.0, 0.0), Point::new(0.0, 4.0)];
    let points = [tip(&poses), tip(&poses)];
    let found = reach_with_defaults(&weights, &blend, &places, &points, &targets).expect("a place");
    assert!((found.weights[0] - 0.5).abs() < 1e-3, "{found:?}");
    assert!(reach_with_defaults(&weights, &blend, &places, &points, &targets[..1]).is_err());

    let one = hands(&[0.0]);
    let blend = RigidBlend::new(&one, &BlendOptions::default()).expect("a blend");
    let places = vec![vec![2.0, 3.0]];
    let weights = BiharmonicWeights::new(&places, &BiharmonicOptions::default()).expect("weights");
    let found = reach_with_defaults(&weights, &blend, &places, &[tip(&one)], &[Point::new(4.0, 1.0)]);
    let found = found.expect("a place");
    assert_eq!((found.at, found.evaluations), (vec![2.0, 3.0], 3));
    assert!((found.error - 1.0).abs() < 1e-12);
}

#[test]
fn the_sequence_is_haltons() {
    let second: Vec<f64> = (1..5).map(|k| radical_inverse(k, 2)).collect();
    assert_eq!(second, [0.5, 0.25, 0.75, 0.125]);
    assert_eq!([0, 1, 2, 3, 4].map(prime), [2, 3, 5, 7, 11]);
}
