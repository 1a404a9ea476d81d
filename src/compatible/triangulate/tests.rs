//! Whole triangulations, proven by the mesh checker.

mod random;

use proptest::prelude::*;

use super::super::CompatibleMesh;
use super::visibility::tests::star;
use super::*;
use crate::mesh::validity::check_embedding;
use crate::outline::Ring;

fn polygon(points: Vec<Point>) -> Outline {
    Outline::new(Ring::new(points).expect("a ring"), Vec::new()).expect("simple")
}

pub(super) fn prove(mesh: &CompatibleMesh, polygons: &[Outline]) {
    for (positions, polygon) in mesh.positions.iter().zip(polygons) {
        check_embedding(&mesh.topology, positions, &mesh.rings).expect("an embedding");
        assert_eq!(mesh.rings.len(), polygon.rings().len());
        for (ring, given) in mesh.rings.iter().zip(polygon.rings()) {
            let places: Vec<Point> = ring.iter().map(|&v| positions[v]).collect();
            assert_eq!(places, given.points(), "the boundary is the polygon, vertex by vertex");
        }
    }
    let characteristic = i64::try_from(mesh.topology.euler_characteristic()).expect("small");
    assert_eq!(characteristic, 2 - i64::try_from(mesh.rings.len()).expect("few"));
    let boundary: usize = mesh.rings.iter().map(Vec::len).sum();
    assert_eq!(
        mesh.steiner,
        mesh.topology.vertex_count() - boundary - mesh.landmarks.len()
    );
}

/// A band along a spiral: m points on each side.
fn spiral(m: usize, turns: f64) -> Vec<Point> {
    let side = |width: f64| {
        (0..m).map(move |k| {
            let s = k as f64 / (m - 1) as f64;
            let angle = std::f64::consts::TAU * turns * s;
            let radius = 1.0 + 3.0 * s + width;
            Point::new(radius * angle.cos(), radius * angle.sin())
        })
    };
    let mut points: Vec<Point> = side(0.4 / turns).collect();
    let back: Vec<Point> = side(-0.4 / turns).collect();
    points.extend(back.into_iter().rev());
    points
}

#[test]
fn equal_polygons_need_no_steiner_point() {
    let polygons = vec![polygon(spiral(12, 1.5)), polygon(spiral(12, 1.5))];
    let (mesh, report) = triangulate(&polygons, &[]).expect("triangulated");
    prove(&mesh, &polygons);
    assert_eq!(report, TriangulateReport::default());
}

#[test]
fn a_spiral_against_a_disc_against_a_mirrored_spiral() {
    let count = 24;
    let disc = star(&vec![1.0; count]);
    let bent = spiral(count / 2, 1.2);
    let other: Vec<Point> = spiral(count / 2, 1.2)
        .into_iter()
        .map(|p| Point::new(p.x, -p.y))
        .rev()
        .collect();
    let polygons = vec![polygon(disc), polygon(bent), polygon(other)];
    let (mesh, _) = triangulate(&polygons, &[]).expect("triangulated");
    prove(&mesh, &polygons);
}

#[test]
fn landmarks_become_vertices_even_where_they_turn_around_one_another() {
    let square = || {
        polygon(
            [[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0]]
                .map(Point::from)
                .to_vec(),
        )
    };
    let polygons = vec![square(), square()];
    let places = |turn: f64| (0..3).map(move |k| turn + std::f64::consts::TAU * f64::from(k) / 3.0);
    let at = |angle: f64| Point::new(4.5 + 2.0 * angle.cos(), 4.5 + 2.0 * angle.sin());
    let landmarks: Vec<Vec<Point>> = places(0.0).zip(places(1.5)).map(|(a, b)| vec![at(a), at(b)]).collect();
    let (mesh, _) = triangulate(&polygons, &landmarks).expect("triangulated");
    prove(&mesh, &polygons);
    for (&vertex, landmark) in mesh.landmarks.iter().zip(&landmarks) {
        assert_eq!(
            [mesh.positions[0][vertex], mesh.positions[1][vertex]],
            [landmark[0], landmark[1]]
        );
    }
    let outside = triangulate(&polygons, &[vec![Point::new(1.0, 1.0), Point::new(-1.0, 1.0)]]).expect_err("outside");
    let feature = Feature::Point(0);
    assert_eq!(outside, TriangulateError::FeatureOutside { feature, pose: 1 });
}

#[test]
fn counts_that_differ_are_refused() {
    let error = triangulate(&[polygon(star(&[1.0; 5])), polygon(star(&[1.0; 6]))], &[]).expect_err("5 is not 6");
    assert_eq!(
        error,
        TriangulateError::CountsDiffer {
            pose: 1,
            ring: 0,
            found: 6,
            expected: 5
        }
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn stars_of_any_radii_are_triangulated(
        radii in (3_usize..24).prop_flat_map(|n| {
            prop::collection::vec(prop::collection::vec(0.05..1.0f64, n), 2..5)
        }),
        shift in 0_usize..24,
    ) {
        let polygons: Vec<Outline> = radii
            .iter()
            .enumerate()
            .map(|(pose, radii)| {
                let mut points = star(radii);
                let by = pose * shift % points.len();
                points.rotate_left(by);
                polygon(points)
            })
            .collect();
        let (mesh, _) = triangulate(&polygons, &[]).expect("triangulated");
        prove(&mesh, &polygons);
    }
}
