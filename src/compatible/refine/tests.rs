//! Whole refinements: valid in every pose, boundary kept, edges short.

use proptest::prelude::*;

use super::super::triangulate;
use super::*;
use crate::math::Point;
use crate::mesh::validity::check_embedding;
use crate::outline::testing::{Kinship, poses};
use crate::outline::{Outline, Ring};

/// A star-shaped polygon from its radii.
fn star(radii: &[f64]) -> Outline {
    let points = radii.iter().enumerate().map(|(k, radius)| {
        let angle = std::f64::consts::TAU * k as f64 / radii.len() as f64;
        Point::new(radius * angle.cos(), radius * angle.sin())
    });
    Outline::new(Ring::new(points).expect("a ring"), Vec::new()).expect("simple")
}

#[test]
fn a_landmark_keeps_its_place_and_the_worst_angle_is_reported() {
    let polygons = vec![star(&[1.0; 8]), star(&[1.0, 0.7, 1.0, 0.7, 1.0, 0.7, 1.0, 0.7])];
    let landmark = vec![Point::new(0.1, 0.1), Point::new(-0.2, 0.1)];
    let (mesh, _) = triangulate(&polygons, std::slice::from_ref(&landmark)).expect("triangulated");
    let (refined, report) = refine(
        &mesh,
        &RefineOptions {
            edge_length: 0.1,
            ..RefineOptions::default()
        },
    )
    .expect("refined");
    let vertex = refined.landmarks[0];
    assert_eq!(
        [refined.positions[0][vertex], refined.positions[1][vertex]],
        [landmark[0], landmark[1]]
    );
    let smallest = geometry::worst_angles_deg(&refined.positions, refined.topology.triangles())
        .into_iter()
        .fold(f64::INFINITY, f64::min);
    assert_eq!(report.smallest_angle_deg, smallest);
    assert!(report.low_angle_deg > 12.0, "{report:?}");
}

#[test]
fn an_edge_length_out_of_range_is_refused() {
    let (mesh, _) = triangulate(&[star(&[1.0; 5])], &[]).expect("triangulated");
    for given in [0.0, -1.0, 1e-9] {
        let refused = refine(
            &mesh,
            &RefineOptions {
                edge_length: given,
                ..RefineOptions::default()
            },
        );
        assert_eq!(refused, Err(RefineError::BadEdgeLength { given }));
    }
    let refused = refine(
        &mesh,
        &RefineOptions {
            edge_length: f64::NAN,
            ..RefineOptions::default()
        },
    );
    assert!(matches!(refused, Err(RefineError::BadEdgeLength { .. })));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]
    #[test]
    fn refined_meshes_of_any_polygons_stay_embedded(
        polygons in poses(3..20, 1..4, 0..3, Kinship::Strangers),
        edge_length in 0.1..0.4f64,
    ) {
        let (mesh, _) = triangulate(&polygons, &[]).expect("triangulated");
        let (refined, _) = refine(&mesh, &RefineOptions { edge_length, ..RefineOptions::default() }).expect("refined");
        let holes = polygons[0].holes().len() as i64;
        prop_assert_eq!(refined.topology.euler_characteristic() as i64, 1 - holes);
        for (pose, positions) in refined.positions.iter().enumerate() {
            check_embedding(&refined.topology, positions, &refined.rings).expect("an embedding");
            for (ring, given) in refined.rings.iter().zip(polygons[pose].rings()) {
                let mut along = ring.iter().map(|&v| positions[v]);
                prop_assert!(given.points().iter().all(|p| along.any(|q| q == *p)), "the ring is kept in order");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]
    #[test]
    fn refined_meshes_stay_embedded_on_the_same_boundary(
        radii in (4_usize..16).prop_flat_map(|n| {
            prop::collection::vec(prop::collection::vec(0.2..1.0f64, n), 1..4)
        }),
        edge_length in 0.05..0.4f64,
    ) {
        let polygons: Vec<Outline> = radii.iter().map(|radii| star(radii)).collect();
        let (mesh, _) = triangulate(&polygons, &[]).expect("triangulated");
        let (refined, report) = refine(&mesh, &RefineOptions { edge_length, ..RefineOptions::default() }).expect("refined");
        prop_assert_eq!(refined.topology.euler_characteristic(), 1);
        prop_assert_eq!(refined.topology.vertex_count(), mesh.topology.vertex_count() + report.splits);
        for (pose, positions) in refined.positions.iter().enumerate() {
            check_embedding(&refined.topology, positions, &refined.rings).expect("an embedding");
            // New boundary vertices are middles of edges: on them up to rounding.
            let given = &mesh.positions[pose];
            for &v in &mesh.rings[0] {
                prop_assert!(refined.rings[0].iter().any(|&w| positions[w] == given[v]));
            }
            let area = |mesh: &CompatibleMesh, positions: &[Point]| -> f64 {
                mesh.topology.triangles().iter().map(|&t| geometry::signed_area(geometry::corners(positions, t))).sum()
            };
            let (before, after) = (area(&mesh, given), area(&refined, positions));
            prop_assert!((before - after).abs() < 1e-12 * before);
        }
        // The length asked for holds in the power mean over the poses.
        for (a, b) in refined.topology.edges() {
            let powers = refined.positions.iter().zip(&mesh.positions)
                .map(|(p, given)| ((p[b] - p[a]).norm() / point::diagonal(given)).powi(16)).sum::<f64>() / radii.len() as f64;
            let mean = powers.powf(1.0 / 16.0);
            // Smoothing moves vertices after the last split.
            prop_assert!(mean <= 2.0 * edge_length, "{} > {}", mean, edge_length);
        }
    }
}
