use super::*;
use proptest::prelude::*;

const LIMIT: SubdividedPositions = SubdividedPositions::Limit;
const REFINED: SubdividedPositions = SubdividedPositions::Refined;

fn subdivision(
    count: usize,
    triangles: &[[usize; 3]],
    steps: usize,
    positions: SubdividedPositions,
) -> LoopSubdivision {
    LoopSubdivision::new(count, triangles, &SubdivisionOptions { steps, positions }).expect("a subdivision")
}

fn octahedron() -> (Vec<Point3>, Vec<[usize; 3]>) {
    let corners = vec![
        Point3::x(),
        Point3::y(),
        Point3::z(),
        -Point3::x(),
        -Point3::y(),
        -Point3::z(),
    ];
    let triangles = vec![
        [0, 1, 2],
        [1, 3, 2],
        [3, 4, 2],
        [4, 0, 2],
        [1, 0, 5],
        [3, 1, 5],
        [4, 3, 5],
        [0, 4, 5],
    ];
    (corners, triangles)
}

/// A vertex with `valence` triangles around it, all or half of the way, and a bump.
fn fan(valence: usize, is_closed: bool) -> (Vec<Point3>, Vec<[usize; 3]>) {
    let neighbours = if is_closed { valence } else { valence + 1 };
    let turn = if is_closed { 1.0 } else { 0.5 } * std::f64::consts::TAU / valence as f64;
    let mut at = vec![Point3::new(0.0, 0.0, 0.4)];
    for index in 0..neighbours {
        let (sin, cos) = libm::sincos(turn * index as f64);
        at.push(Point3::new(cos, sin, 0.1 * libm::sin(7.0 * index as f64)));
    }
    let triangles = (0..valence)
        .map(|index| [0, 1 + index, 1 + (index + 1) % neighbours])
        .collect();
    (at, triangles)
}

#[test]
fn the_octahedron_and_the_tetrahedron_by_hand() {
    // Valence 4: a neighbour counts (5/8 - 9/64) / 4 = 31/256 in a step and 31/220 in the limit; the neighbours sum to zero.
    let (corners, triangles) = octahedron();
    for steps in [0, 1, 3] {
        let smooth = subdivision(6, &triangles, steps, LIMIT);
        let mut positions = vec![Point3::zeros(); smooth.vertex_count()];
        let mut normals = positions.clone();
        smooth.apply(&corners, &mut positions, &mut normals).expect("counts");
        for (vertex, corner) in corners.iter().enumerate() {
            assert!((positions[vertex] - corner * (24.0 / 55.0)).norm() < 1e-14, "{steps}");
            assert!((normals[vertex] - corner).norm() < 1e-14, "{steps}");
        }
    }
    let once = subdivision(6, &triangles, 1, REFINED);
    let refined = once.positions(&corners).expect("counts");
    assert!((refined[0] - Point3::x() * (33.0 / 64.0)).norm() < 1e-15);
    // The vertex of the edge from x to y, with z and -z across.
    let edge = once.triangles()[0][1];
    assert!((refined[edge] - Point3::new(0.375, 0.375, 0.0)).norm() < 1e-15);

    // Valence 3: a neighbour counts 3/16 in a step and 1/5 in the limit; the others sum to the opposite of a corner.
    let corners = [
        Point3::new(1.0, 1.0, 1.0),
        Point3::new(1.0, -1.0, -1.0),
        Point3::new(-1.0, 1.0, -1.0),
        Point3::new(-1.0, -1.0, 1.0),
    ];
    let smooth = subdivision(4, &[[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]], 2, LIMIT);
    let positions = smooth.positions(&corners).expect("counts");
    for (found, corner) in positions.iter().zip(corners) {
        assert!((found - corner * 0.2).norm() < 1e-14);
    }
}

#[test]
fn regular_vertices_have_the_box_splines_mask() {
    let (_, triangles) = fan(6, true);
    let limit = subdivision(7, &triangles, 0, LIMIT);
    let expected: Vec<(usize, f64)> = (0..7).map(|v| (v, if v == 0 { 0.5 } else { 1.0 / 12.0 })).collect();
    for (found, expected) in limit.stencil(0).iter().zip(&expected) {
        assert!(found.0 == expected.0 && (found.1 - expected.1).abs() < 1e-15);
    }
    assert!(limit.stencil(7).is_empty());
}

#[test]
fn the_boundary_is_a_cubic_b_spline_of_itself() {
    let (at, triangles) = fan(5, true);
    let steps = 5;
    let smooth = subdivision(6, &triangles, steps, LIMIT);
    let mut lifted = at.clone();
    lifted[0].z = 9.0;
    let (flat, high) = (
        smooth.positions(&at).expect("counts"),
        smooth.positions(&lifted).expect("counts"),
    );
    // One side of the spline from neighbour 2 to neighbour 3, at all its finest parameters.
    let spline = |t: f64| {
        let s = 1.0 - t;
        at[1] * (s * s * s / 6.0)
            + at[2] * (2.0 / 3.0 - t * t + t * t * t / 2.0)
            + at[3] * (2.0 / 3.0 - s * s + s * s * s / 2.0)
            + at[4] * (t * t * t / 6.0)
    };
    let pieces = 1 << steps;
    for piece in 0..=pieces {
        let wanted = spline(f64::from(piece) / f64::from(pieces));
        let vertex = (0..flat.len())
            .find(|&vertex| (flat[vertex] - wanted).norm() < 1e-12)
            .expect("a vertex on the spline");
        assert_eq!(flat[vertex], high[vertex]);
    }
}

#[test]
fn a_plane_stays_a_plane_and_a_grid_a_grid() {
    let side = 5;
    let triangles: Vec<[usize; 3]> = (0..side - 1)
        .flat_map(|row| (0..side - 1).map(move |column| row * side + column))
        .flat_map(|a| [[a, a + 1, a + side + 1], [a, a + side + 1, a + side]])
        .collect();
    let plane = |x: f64, y: f64| Point3::new(x, y, 1.0 + 0.5 * x - 0.25 * y);
    let control: Vec<Point3> = (0..side * side)
        .map(|vertex| plane((vertex % side) as f64, (vertex / side) as f64))
        .collect();
    let smooth = subdivision(side * side, &triangles, 2, LIMIT);
    let mut positions = vec![Point3::zeros(); smooth.vertex_count()];
    let mut normals = positions.clone();
    smooth.apply(&control, &mut positions, &mut normals).expect("counts");
    let normal = Point3::new(-0.5, 0.25, 1.0).normalize();
    for (at, found) in positions.iter().zip(&normals) {
        assert!((at - plane(at.x, at.y)).norm() < 1e-13);
        assert!((found - normal).norm() < 1e-13);
    }
    // In the middle everything is regular and even, and linear functions are reproduced.
    assert!((positions[12] - control[12]).norm() < 1e-14);
}

#[test]
fn vertices_that_hold_two_fans_together_stay() {
    let at = [
        [0.0, 0.0],
        [1.0, 0.0],
        [1.0, 1.0],
        [-1.0, 0.0],
        [-1.0, -1.0],
        [7.0, 7.0],
    ];
    let control: Vec<Point3> = at.iter().map(|[x, y]| Point3::new(*x, *y, 0.0)).collect();
    let smooth = subdivision(6, &[[0, 1, 2], [0, 3, 4]], 2, LIMIT);
    let mut positions = vec![Point3::zeros(); smooth.vertex_count()];
    let mut normals = positions.clone();
    smooth.apply(&control, &mut positions, &mut normals).expect("counts");
    assert_eq!((positions[0], normals[0]), (control[0], Point3::z()));
    assert_eq!((positions[5], normals[5]), (control[5], Point3::zeros()));
}

#[test]
fn single_precision_is_the_same_and_allocates_nothing() {
    let (corners, triangles) = octahedron();
    let smooth = subdivision(6, &triangles, 3, LIMIT);
    let count = smooth.vertex_count();
    let (mut positions, mut normals) = (vec![Point3::zeros(); count], vec![Point3::zeros(); count]);
    let planes =
        |points: &[Point3]| [0, 1, 2].map(|axis| points.iter().map(|at| at[axis] as f32).collect::<Vec<f32>>());
    let control = planes(&corners);
    let (mut at, mut to) = (planes(&positions), planes(&normals));
    let mut scratch = SubdivisionScratch::default();
    for expected in [1, 0] {
        let measured = allocation_counter::measure(|| {
            smooth.apply(&corners, &mut positions, &mut normals).expect("counts");
            let [px, py, pz] = &mut at;
            let [nx, ny, nz] = &mut to;
            let control = [&control[0][..], &control[1], &control[2]];
            smooth
                .apply_planes(control, [px, py, pz], [nx, ny, nz], &mut scratch)
                .expect("counts");
        });
        assert_eq!(measured.count_total, expected);
    }
    for vertex in 0..count {
        for axis in 0..3 {
            assert!((f64::from(at[axis][vertex]) - positions[vertex][axis]).abs() < 1e-6);
            assert!((f64::from(to[axis][vertex]) - normals[vertex][axis]).abs() < 1e-5);
        }
    }
}

#[test]
fn seams_of_the_texture_stay_apart() {
    // Two triangles of a square whose common edge is a seam.
    let coordinates = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 1.0], [1.0, 0.5], [1.0, 1.0]];
    let SubdividedTexture {
        coordinates: finer,
        triangles,
    } = subdivide_texture(&coordinates, &[[0, 1, 2], [4, 5, 3]], 1).expect("triangles");
    assert_eq!(finer.len(), 12);
    assert_eq!(finer[triangles[0][1]], [0.5, 0.0]);
    let corners = |range: std::ops::Range<usize>| -> std::collections::BTreeSet<usize> {
        triangles[range].iter().flatten().copied().collect()
    };
    assert!(corners(0..4).is_disjoint(&corners(4..8)));
    // The order of the triangles is that of the geometry.
    let smooth = subdivision(4, &[[0, 1, 2], [1, 3, 2]], 1, REFINED);
    let geometry = [Point3::zeros(), Point3::x(), Point3::y(), Point3::new(1.0, 1.0, 0.0)];
    let fine = subdivide_texture(&geometry.map(|at| [at.x, at.y]), &[[0, 1, 2], [1, 3, 2]], 1).expect("triangles");
    for (triangle, texture) in smooth.triangles().iter().zip(&fine.triangles) {
        for (&vertex, &corner) in triangle.iter().zip(texture) {
            if vertex < 4 {
                assert_eq!(fine.coordinates[corner], [geometry[vertex].x, geometry[vertex].y]);
            }
        }
    }
}

#[test]
fn what_cannot_be_subdivided_is_refused() {
    let options = SubdivisionOptions::default();
    let wrong = |triangles: &[[usize; 3]], options| LoopSubdivision::new(4, triangles, options).expect_err("an error");
    assert!(matches!(
        wrong(&[[0, 1, 4]], &options),
        SubdivisionError::NoSuchVertex { vertex: 4, .. }
    ));
    assert!(matches!(
        wrong(&[[0, 1, 0]], &options),
        SubdivisionError::RepeatedVertex { vertex: 0, .. }
    ));
    let many = SubdivisionOptions { steps: 40, ..options };
    assert!(matches!(
        wrong(&[[0, 1, 2]], &many),
        SubdivisionError::TooMany { steps: 40, .. }
    ));
    let smooth = LoopSubdivision::new(4, &[[0, 1, 2]], &options).expect("a subdivision");
    assert!(smooth.positions(&[Point3::zeros(); 3]).is_err());
    assert!(smooth.apply(&[Point3::zeros(); 4], &mut [], &mut []).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]
    /// The limit does not depend on how often one subdivides first: the masks are left eigenvectors of the steps.
    #[test]
    fn limits_are_limits(valence in 3..10usize, open in 1..7usize, is_closed in any::<bool>(), steps in 1..4usize) {
        let (at, triangles) = fan(if is_closed { valence } else { open }, is_closed);
        let smooth = [0, steps].map(|steps| subdivision(at.len(), &triangles, steps, LIMIT));
        let [(coarse, coarse_normals), (fine, fine_normals)] = smooth.each_ref().map(|smooth| {
            let (mut positions, mut normals) =
                (vec![Point3::zeros(); smooth.vertex_count()], vec![Point3::zeros(); smooth.vertex_count()]);
            smooth.apply(&at, &mut positions, &mut normals).expect("counts");
            (positions, normals)
        });
        for vertex in 0..at.len() {
            prop_assert!((coarse[vertex] - fine[vertex]).norm() < 1e-12);
            prop_assert!((coarse_normals[vertex] - fine_normals[vertex]).norm() < 1e-9, "vertex {vertex}: {} {}",
                coarse_normals[vertex], fine_normals[vertex]);
        }
        for stencil in smooth[1].stencils() {
            prop_assert!((stencil.iter().map(|entry| entry.1).sum::<f64>() - 1.0).abs() < 1e-13);
            prop_assert!(stencil.iter().all(|entry| entry.1 >= 0.0));
        }
    }

    /// Normals are those of triangles so small that they lie in the surface.
    #[test]
    fn normals_are_those_of_tiny_triangles(valence in 3..9usize, is_closed in any::<bool>()) {
        let (at, triangles) = fan(valence, is_closed);
        let smooth = subdivision(at.len(), &triangles, 5, LIMIT);
        let (mut positions, mut normals) =
            (vec![Point3::zeros(); smooth.vertex_count()], vec![Point3::zeros(); smooth.vertex_count()]);
        smooth.apply(&at, &mut positions, &mut normals).expect("counts");
        for triangle in smooth.triangles() {
            let [a, b, c] = triangle.map(|vertex| positions[vertex]);
            let flat = (b - a).cross(&(c - a)).normalize();
            for &vertex in triangle {
                prop_assert!(flat.dot(&normals[vertex]) > 0.97, "vertex {vertex}: {flat} {}", normals[vertex]);
            }
        }
    }
}
