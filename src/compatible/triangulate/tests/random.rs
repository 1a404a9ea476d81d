//! Whole triangulations of arbitrary, of large and of known difficult polygons.

use proptest::prelude::*;

use super::super::visibility::tests::star;
use super::super::*;
use super::{polygon, prove, spiral};
use crate::mesh::geometry;
use crate::outline::Ring;
use crate::outline::testing::{Kinship, Sequence, poses, untangled};

fn random_polygons(count: usize, poses: usize, seed: u64) -> Vec<Outline> {
    let mut random = Sequence::new(seed);
    (0..poses)
        .map(|_| {
            let points = (0..count).map(|_| Point::new(random.next(), random.next())).collect();
            polygon(untangled(points).expect("points in general position"))
        })
        .collect()
}

/// A comb with `teeth` teeth: four points each.
fn comb(teeth: usize) -> Vec<Point> {
    let mut points: Vec<Point> = (0..teeth)
        .flat_map(|k| [(0.0, 3.0), (0.5, 3.0), (0.55, 0.3), (0.95, 0.3)].map(|(x, y)| Point::new(k as f64 + x, y)))
        .collect();
    points.truncate(4 * teeth - 2);
    points.push(Point::new(points[points.len() - 1].x, 0.0));
    points.push(Point::new(0.0, 0.0));
    points.reverse();
    points
}

/// A nearly round polygon with `waves` waves.
fn wavy(count: usize, waves: f64) -> Vec<Point> {
    (0..count)
        .map(|k| std::f64::consts::TAU * k as f64 / count as f64)
        .map(|angle| Point::new(angle.cos(), angle.sin()) * (1.0 + 0.02 * (waves * angle).cos()))
        .collect()
}

#[test]
fn a_comb_a_spiral_and_a_disc_take_few_points() {
    // The overlay of these three has 907 Steiner points.
    let polygons = vec![
        polygon(spiral(20, 1.0)),
        polygon(comb(10)),
        polygon(star(&vec![1.0; 40])),
    ];
    let (mesh, _) = triangulate(&polygons, &[]).expect("triangulated");
    prove(&mesh, &polygons);
    assert!(mesh.steiner <= 12, "{}", mesh.steiner);
}

#[test]
fn a_part_that_is_too_narrow_does_not_overlay_everything() {
    // Four random polygons: hubs leave ever narrower parts. To overlay the whole where one of them was too narrow once
    // cost hundreds of points; half that many vertices as there are in all poses is a generous bound.
    for seed in 1..4 {
        let polygons = random_polygons(24, 4, seed);
        let (mesh, _) = triangulate(&polygons, &[]).expect("triangulated");
        prove(&mesh, &polygons);
        assert!(mesh.steiner <= 30, "seed {seed}: {}", mesh.steiner);
    }
}

#[test]
fn large_convex_pieces_are_divided_and_lose_nothing() {
    let polygons: Vec<Outline> = [2.0, 3.0, 5.0].map(|waves| polygon(wavy(400, waves))).into();
    let (mesh, report) = triangulate(&polygons, &[]).expect("triangulated");
    prove(&mesh, &polygons);
    assert_eq!(report, TriangulateReport::default());
}

#[test]
fn a_large_spiral_against_a_slightly_different_one_needs_no_point() {
    let polygons = vec![polygon(spiral(160, 1.5)), polygon(spiral(160, 1.4))];
    let (mesh, _) = triangulate(&polygons, &[]).expect("triangulated");
    prove(&mesh, &polygons);
    assert_eq!(mesh.steiner, 0);
}

#[test]
fn the_same_polygons_give_the_same_mesh() {
    let polygons = random_polygons(16, 3, 9);
    let first = triangulate(&polygons, &[]).expect("triangulated");
    assert_eq!(first, triangulate(&polygons, &[]).expect("triangulated"));
}

#[test]
fn two_holes_in_a_plate_that_bends() {
    let hole = |x: f64, size: f64| -> Vec<Point> {
        (0..7)
            .map(|k| -std::f64::consts::TAU * f64::from(k) / 7.0)
            .map(|angle| Point::new(x + size * angle.cos(), size * angle.sin()))
            .collect()
    };
    let bent = |by: f64| {
        let bend = |points: Vec<Point>| -> Ring {
            let points = points
                .into_iter()
                .map(|p| Point::new(p.x + by * p.y, p.y + by * p.x * p.x));
            Ring::new(points).expect("a ring")
        };
        let outer: Vec<Point> = star(&[1.0; 16]).into_iter().map(|p| p * 3.0).collect();
        Outline::new(bend(outer), vec![bend(hole(-1.2, 0.6)), bend(hole(1.2, 0.4))]).expect("simple")
    };
    let polygons = vec![bent(0.0), bent(0.15), bent(-0.1)];
    let (mesh, _) = triangulate(&polygons, &[]).expect("triangulated");
    prove(&mesh, &polygons);
}

/// How much of the search is worth its time here: the meshes are as valid without.
const LITTLE_WORK: usize = 100_000;

/// Triangulates and proves everything that is promised of the mesh.
fn prove_all(polygons: &[Outline], work: usize) {
    let (mesh, _) = searched(polygons, &Features::default(), work).expect("triangulated");
    prove(&mesh, polygons);
    for (positions, polygon) in mesh.positions.iter().zip(polygons) {
        let triangles = mesh.topology.triangles().iter();
        let covered: f64 = triangles
            .map(|&t| geometry::signed_area(geometry::corners(positions, t)))
            .sum();
        let area = polygon.area();
        assert!((covered - area).abs() <= 1e-9 * area, "{covered} of {area} is covered");
    }
}

/// Pieces this large have no table of all their diagonals, nor an overlay of their own.
#[test]
fn large_polygons_without_common_diagonals_are_divided_over_paths() {
    let mut turned = spiral(160, 1.3);
    turned.rotate_left(80);
    let mirrored = spiral(160, 1.3).into_iter().map(|p| Point::new(p.x, -p.y)).rev();
    let polygons = vec![polygon(spiral(160, 1.3)), polygon(turned), polygon(mirrored.collect())];
    let (mesh, report) = searched(&polygons, &Features::default(), 0).expect("triangulated");
    prove(&mesh, &polygons);
    assert!(report.link > 0, "{report:?}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]
    #[test]
    fn any_simple_polygons_are_triangulated(polygons in poses(3..16, 2..9, 0..1, Kinship::Strangers)) {
        prove_all(&polygons, patch::WORK);
    }

    #[test]
    fn any_simple_polygons_with_holes_are_triangulated(polygons in poses(3..12, 1..6, 1..4, Kinship::Strangers)) {
        prove_all(&polygons, LITTLE_WORK);
    }

    #[test]
    fn related_polygons_of_up_to_two_hundred_vertices_are_triangulated(
        polygons in poses(16..201, 1..9, 0..4, Kinship::Relatives),
    ) {
        prove_all(&polygons, LITTLE_WORK);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2))]
    #[test]
    fn unrelated_polygons_of_up_to_two_hundred_vertices_are_triangulated(
        polygons in poses(16..201, 2..4, 0..2, Kinship::Strangers),
    ) {
        prove_all(&polygons, LITTLE_WORK);
    }
}
