//! Holes and landmarks that see nothing in common, proven by the mesh checker.

use proptest::prelude::*;

use super::super::CompatibleMesh;
use super::ear_clipping::triangulate_polygon;
use super::visibility::tests::star;
use super::*;
use crate::mesh::validity::check_embedding;
use crate::outline::Ring;

fn ring(points: impl IntoIterator<Item = Point>) -> Ring {
    Ring::new(points).expect("a ring")
}

fn outline(outer: Vec<Point>, holes: Vec<Vec<Point>>) -> Outline {
    Outline::new(ring(outer), holes.into_iter().map(ring).collect()).expect("an outline")
}

fn points(list: &[[f64; 2]]) -> Vec<Point> {
    list.iter().copied().map(Point::from).collect()
}

fn prove(mesh: &CompatibleMesh, polygons: &[Outline]) {
    let holes = polygons[0].holes().len() as i64;
    for (positions, polygon) in mesh.positions.iter().zip(polygons) {
        check_embedding(&mesh.topology, positions, &mesh.rings).expect("an embedding");
        for (vertices, ring) in mesh.rings.iter().zip(polygon.rings()) {
            let found: Vec<Point> = vertices.iter().map(|&v| positions[v]).collect();
            assert_eq!(found, ring.points(), "the boundary is the polygon, vertex by vertex");
        }
    }
    assert_eq!(mesh.topology.euler_characteristic() as i64, 1 - holes);
}

/// A small square hole with its middle at a place, negative.
fn hole(at: [f64; 2]) -> Vec<Point> {
    let s = 0.2;
    let corners = [[-s, -s], [-s, s], [s, s], [s, -s]];
    corners.iter().map(|c| Point::new(at[0] + c[0], at[1] + c[1])).collect()
}

/// A U of corridors one unit wide.
fn u_shape() -> Vec<Point> {
    points(&[
        [0.0, 0.0],
        [9.0, 0.0],
        [9.0, 9.0],
        [8.0, 9.0],
        [8.0, 1.0],
        [1.0, 1.0],
        [1.0, 9.0],
        [0.0, 9.0],
    ])
}

#[test]
fn a_hole_at_the_two_ends_of_a_u_is_reached_over_bends() {
    let polygons = [[0.5, 8.0], [8.5, 8.0], [4.5, 0.5]].map(|at| outline(u_shape(), vec![hole(at)]));
    let (mesh, report) = triangulate(&polygons, &[]).expect("triangulated");
    prove(&mesh, &polygons);
    assert!(report.bridge > 0, "{report:?}");
}

#[test]
fn a_landmark_at_the_two_ends_of_a_u_is_reached_over_bends() {
    let polygons = [outline(u_shape(), vec![]), outline(u_shape(), vec![])];
    let landmark = points(&[[0.5, 8.9], [8.5, 8.9]]);
    let (mesh, report) = triangulate(&polygons, std::slice::from_ref(&landmark)).expect("triangulated");
    prove(&mesh, &polygons);
    assert!(report.bridge > 0, "{report:?}");
    for (positions, place) in mesh.positions.iter().zip(&landmark) {
        assert_eq!(positions[mesh.landmarks[0]], *place);
    }
}

#[test]
fn holes_that_change_places_are_all_reached() {
    let places = [[0.5, 8.0], [0.5, 5.0], [4.5, 0.5], [8.5, 5.0], [8.5, 8.0]];
    let polygons: Vec<Outline> = [[0, 1, 2, 3, 4], [4, 3, 2, 1, 0], [2, 4, 1, 0, 3]]
        .iter()
        .map(|order| outline(u_shape(), order.iter().map(|&k| hole(places[k])).collect()))
        .collect();
    let (mesh, report) = triangulate(&polygons, &[]).expect("triangulated");
    prove(&mesh, &polygons);
    assert!(report.bridge > 0, "{report:?}");
}

/// The walk around everything, and the places of its vertices.
fn joined(polygons: &[Outline], landmarks: &[Vec<Point>]) -> (Vec<usize>, Vec<Vec<Point>>) {
    let mut islands: Vec<Vec<usize>> = Vec::new();
    let mut count = 0;
    for ring in polygons[0].rings() {
        islands.push((count..count + ring.len()).collect());
        count += ring.len();
    }
    islands.extend((count..count + landmarks.len()).map(|v| vec![v]));
    let mut positions: Vec<Vec<Point>> = polygons
        .iter()
        .enumerate()
        .map(|(pose, polygon)| {
            let rings = polygon.rings().iter().flat_map(|ring| ring.points()).copied();
            rings.chain(landmarks.iter().map(|places| places[pose])).collect()
        })
        .collect();
    let outer = islands.remove(0);
    let joined = bridge::join_islands(&mut positions, outer, islands).expect("joined");
    (joined.walk, positions)
}

/// Bends at the middles of links and edges were in line with vertices but for rounding, and the overlay needed the flat
/// triangles between.
#[test]
fn bends_are_in_line_with_nothing() {
    let places = [[0.5, 8.0], [4.5, 0.5], [8.5, 8.0]];
    let polygons: Vec<Outline> = [[0, 1, 2], [2, 0, 1], [1, 2, 0]]
        .iter()
        .map(|order| outline(u_shape(), order.iter().map(|&k| hole(places[k])).collect()))
        .collect();
    let (walk, positions) = joined(&polygons, &[]);
    let given: usize = polygons[0].rings().iter().map(Ring::len).sum();
    for positions in &positions {
        let bends: Vec<usize> = walk.iter().copied().filter(|&v| v >= given).collect();
        assert!(!bends.is_empty());
        for &bend in &bends {
            for (k, &a) in walk.iter().enumerate() {
                for &b in walk[..k].iter().filter(|&&b| b != a && a != bend && b != bend) {
                    let (u, v) = (positions[a] - positions[bend], positions[b] - positions[bend]);
                    let sine = crate::math::point::cross(u, v) / (u.norm() * v.norm());
                    assert!(sine.abs() > 1e-6, "{bend} is in line with {a} and {b}");
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]
    #[test]
    fn holes_and_landmarks_at_unrelated_places_are_joined(
        poses in (4_usize..20, 0_usize..3, 0_usize..4, 2_usize..6).prop_flat_map(|(n, holes, landmarks, poses)| {
            let radii = prop::collection::vec(0.15..1.0f64, n);
            let places = prop::collection::vec(0.0..1.0f64, holes + landmarks);
            prop::collection::vec((radii, places, 0_usize..n), poses).prop_map(move |poses| (holes, poses))
        }),
    ) {
        let (hole_count, poses) = poses;
        let mut polygons = Vec::new();
        let mut landmarks: Vec<Vec<Point>> = vec![Vec::new(); poses[0].1.len() - hole_count];
        for (radii, places, shift) in &poses {
            // Inside the wedge between two spokes and the centre, the features in the order of their random numbers.
            let mut outer = star(radii);
            let mut order: Vec<usize> = (0..places.len()).collect();
            order.sort_by(|&a, &b| places[a].total_cmp(&places[b]));
            let mut holes = vec![Vec::new(); hole_count];
            for (slot, &which) in order.iter().enumerate() {
                let wedge = slot * (outer.len() / places.len().max(1)).max(1);
                let (a, b) = (outer[wedge % outer.len()], outer[(wedge + 1) % outer.len()]);
                // Slots that share a wedge lie at different depths.
                let depth = 0.2 + 0.6 * (slot as f64 + 0.5) / places.len() as f64;
                let at = |u: f64, v: f64| a * ((depth + u) * (0.5 - v)) + b * ((depth + u) * (0.5 + v));
                if which < hole_count {
                    holes[which] = vec![at(0.0, 0.2), at(0.0, -0.2), at(0.03, 0.0)];
                } else {
                    landmarks[which - hole_count].push(at(0.01, 0.03));
                }
            }
            outer.rotate_left(*shift);
            polygons.push(outline(outer, holes));
        }
        let (walk, positions) = joined(&polygons, &landmarks);
        for positions in &positions {
            let walk: Vec<Point> = walk.iter().map(|&v| positions[v]).collect();
            prop_assert!(triangulate_polygon(&walk).is_some(), "the walk is not weakly simple");
        }
        let (mesh, _) = triangulate(&polygons, &landmarks).expect("triangulated");
        prove(&mesh, &polygons);
        for (&vertex, landmark) in mesh.landmarks.iter().zip(&landmarks) {
            let found: Vec<Point> = mesh.positions.iter().map(|positions| positions[vertex]).collect();
            prop_assert_eq!(&found, landmark);
        }
    }
}
