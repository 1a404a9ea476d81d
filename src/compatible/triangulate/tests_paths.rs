//! Paths become chains of edges, before and after refinement.

use proptest::prelude::*;

use super::super::{RefineOptions, refine};
use super::*;
use crate::mesh::validity::check_embedding;
use crate::outline::Ring;

fn outline(outer: &[[f64; 2]]) -> Outline {
    Outline::new(
        Ring::new(outer.iter().copied().map(Point::from)).expect("a ring"),
        vec![],
    )
    .expect("an outline")
}

fn square() -> Outline {
    outline(&[[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0]])
}

/// A path from its points in every pose: #poses x #points.
fn path(ends: [PathEnd; 2], poses: &[Vec<[f64; 2]>]) -> FeaturePath {
    let points = (0..poses[0].len())
        .map(|k| poses.iter().map(|pose| Point::from(pose[k])).collect())
        .collect();
    FeaturePath { ends, points }
}

const FREE: [PathEnd; 2] = [PathEnd::Inside; 2];

/// Proves mesh and chains, bare and refined; each chain keeps the given points.
fn prove(polygons: &[Outline], features: &Features) -> TriangulateReport {
    let (mesh, report) = triangulate_features(polygons, features, Effort::Full).expect("triangulated");
    let (refined, _) = refine(
        &mesh,
        &RefineOptions {
            edge_length: 0.1,
            ..RefineOptions::default()
        },
    )
    .expect("refined");
    for mesh in [&mesh, &refined] {
        for positions in &mesh.positions {
            check_embedding(&mesh.topology, positions, &mesh.rings).expect("an embedding");
        }
        let edges: std::collections::BTreeSet<(usize, usize)> = mesh.topology.edges().into_iter().collect();
        assert_eq!(mesh.paths.len(), features.paths.len());
        for (vertices, given) in mesh.paths.iter().zip(&features.paths) {
            for link in vertices.windows(2) {
                assert!(
                    edges.contains(&(link[0].min(link[1]), link[0].max(link[1]))),
                    "{link:?} is an edge"
                );
            }
            for (pose, positions) in mesh.positions.iter().enumerate() {
                let along: Vec<Point> = vertices.iter().map(|&v| positions[v]).collect();
                let mut rest = along.iter();
                assert!(given.points.iter().all(|places| rest.any(|p| *p == places[pose])));
            }
        }
    }
    report
}

#[test]
fn a_free_path_is_a_chain_of_edges_however_it_is_turned() {
    let poses = [
        vec![[2.0, 2.0], [4.0, 3.0], [6.0, 2.0]],
        vec![[7.0, 7.0], [5.0, 5.0], [4.0, 7.0]],
        vec![[2.0, 6.0], [2.0, 4.0], [2.0, 2.0]],
    ];
    let features = Features {
        points: vec![[[4.0, 2.0], [2.0, 2.0], [7.0, 4.0]].map(Point::from).to_vec()],
        paths: vec![path(FREE, &poses)],
    };
    prove(&[square(), square(), square()], &features);
}

#[test]
fn a_path_of_one_edge_is_an_edge() {
    let features = Features {
        points: vec![],
        paths: vec![path(
            FREE,
            &[vec![[2.0, 2.0], [6.0, 2.0]], vec![[3.0, 7.0], [3.0, 1.0]]],
        )],
    };
    prove(&[square(), square()], &features);
}

#[test]
fn paths_from_the_outline_and_from_side_to_side_are_chains() {
    let at = |vertex| PathEnd::Boundary { ring: 0, vertex };
    let features = Features {
        points: vec![[[6.0, 2.0], [7.0, 3.0]].map(Point::from).to_vec()],
        paths: vec![
            path([at(0), at(2)], &[vec![[4.0, 5.0]], vec![[5.0, 4.0]]]),
            path(
                [at(0), PathEnd::Inside],
                &[vec![[2.0, 5.0], [1.0, 7.0]], vec![[1.0, 3.0], [4.0, 6.0]]],
            ),
        ],
    };
    prove(&[square(), square()], &features);
    // The same order about vertex 0 in every pose, or it is refused.
    let mut crossed = features.clone();
    crossed.paths[1] = path([at(0), PathEnd::Inside], &[vec![[2.0, 5.0]], vec![[6.0, 1.0]]]);
    let error = triangulate_features(&[square(), square()], &crossed, Effort::Full).expect_err("on the other side");
    assert!(matches!(error, TriangulateError::PathSides { pose: 1, .. }), "{error}");
}

#[test]
fn paths_that_leave_or_cross_are_refused_by_number() {
    let polygons = [outline(&[[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [4.0, 4.0], [0.0, 9.0]])];
    let refused = |paths: Vec<Vec<[f64; 2]>>| {
        let features = Features {
            points: vec![],
            paths: paths.into_iter().map(|points| path(FREE, &[points])).collect(),
        };
        triangulate_features(&polygons, &features, Effort::Full).expect_err("refused")
    };
    let feature = Feature::Path(0);
    let outside = TriangulateError::FeatureOutside { feature, pose: 0 };
    assert_eq!(refused(vec![vec![[1.0, 7.0], [8.0, 7.0]]]), outside);
    assert_eq!(refused(vec![vec![[1.0, 1.0], [8.0, 12.0]]]), outside);
    let meet = |first, second| TriangulateError::FeaturesMeet {
        first: Feature::Path(first),
        second: Feature::Path(second),
        pose: 0,
    };
    let knot = vec![[1.0, 1.0], [4.0, 1.0], [4.0, 2.0], [2.0, 0.5]];
    assert_eq!(refused(vec![knot]), meet(0, 0));
    let cross = vec![vec![[1.0, 1.0], [3.0, 3.0]], vec![[1.0, 3.0], [3.0, 1.0]]];
    assert_eq!(refused(cross), meet(1, 0));
    assert_eq!(refused(vec![vec![[1.0, 1.0]]]), TriangulateError::PathShort { path: 0 });
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]
    #[test]
    fn zigzags_anywhere_are_chains(
        zigzags in (2_usize..5, 2_usize..7).prop_flat_map(|(poses, count)| {
            let zigzag = (0.0..6.2f64, prop::collection::vec(-1.0..1.0f64, count));
            prop::collection::vec(zigzag, poses)
        }),
    ) {
        let poses: Vec<Vec<[f64; 2]>> = zigzags
            .iter()
            .map(|(angle, offsets)| {
                offsets
                    .iter()
                    .enumerate()
                    .map(|(k, offset)| {
                        let along = k as f64 / offsets.len() as f64 * 6.0 - 3.0;
                        let (sin, cos) = angle.sin_cos();
                        [4.5 + along * cos - offset * sin, 4.5 + along * sin + offset * cos]
                    })
                    .collect()
            })
            .collect();
        let polygons: Vec<Outline> = poses.iter().map(|_| square()).collect();
        prove(&polygons, &Features { points: vec![], paths: vec![path(FREE, &poses)] });
    }
}
