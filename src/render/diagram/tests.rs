//! What is drawn where, on two equal squares of two triangles.

use proptest::prelude::*;

use super::*;
use crate::matching::{Correspondence, PoseMatch, SalientPoint};
use crate::math::Point;
use crate::mesh::Topology;
use crate::outline::{Outline, Ring};
use crate::pose::{LandmarkKind, Matching, PoseSet};

const ROWS: usize = 64;

fn square() -> Mapping {
    let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]
        .map(Point::from)
        .to_vec();
    let outline = Outline::new(Ring::new(corners.clone()).expect("a ring"), vec![]).expect("simple");
    let mut vertices = corners;
    // The triangle 1 2 4 is thin.
    vertices.push(Point::new(1.9, 1.0));
    let triangles = vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
    Mapping {
        poses: PoseSet::new(
            Topology::new(5, triangles).expect("a mesh"),
            vec![("a".to_owned(), vertices.clone()), ("b".to_owned(), vertices)],
        )
        .expect("poses"),
        outlines: vec![outline.clone(), outline],
        rings: vec![vec![0, 1, 2, 3]],
        steiner: 1,
        matching: Matching {
            reference: 0,
            outer: Correspondence::identity(2, ROWS),
        },
        overlaps: crate::pose::Overlaps::default(),
    }
}

/// The corners are salient, the second pose has this mismatch.
fn report(mismatch: Vec<f64>) -> MatchReport {
    let of_pose = |mismatch: Vec<f64>| PoseMatch {
        cost: 0.0,
        mismatch,
        looks_mirrored: false,
        reflection_ratio: 1.0,
        salient: (0..4)
            .map(|k| SalientPoint {
                parameter: f64::from(k) / 4.0,
                scale: 0.04,
                curvature: 9.0,
            })
            .collect(),
        landmarks: Vec::new(),
    };
    MatchReport {
        poses: vec![of_pose(vec![0.0; ROWS]), of_pose(mismatch)],
    }
}

/// Unlike along the second side only.
fn unlike() -> Vec<f64> {
    (0..ROWS)
        .map(|k| {
            if (ROWS / 4..ROWS / 2).contains(&k) {
                2.0 * Sections::DOUBTFUL_COST
            } else {
                0.0
            }
        })
        .collect()
}

fn mark(kind: LandmarkKind, at: Vec<Point>) -> PlacedLandmark {
    PlacedLandmark {
        name: "nose".to_owned(),
        kind,
        at: vec![at.clone(), at],
        given: vec![true, false],
    }
}

fn drawn(mapping: &Mapping, matching: &MatchReport, landmarks: &[PlacedLandmark]) -> Frame {
    let poses = [("a", 0.0), ("b", 1.0)].map(|(name, x)| DiagramPose {
        name: name.to_owned(),
        at: vec![x, 0.0],
    });
    let diagram = Diagram {
        mapping,
        matching,
        landmarks,
        poses: &poses,
        path: &[vec![0.0, 0.0], vec![1.0, 0.0]],
    };
    let sections = Sections::new(mapping, matching, landmarks);
    draw(&diagram, &sections, |at| Some(vec![1.0 - at[0], at[0]])).expect("a picture")
}

fn pixel(picture: &Frame, place: Point) -> [u8; 4] {
    picture.pixels[place.y as usize * picture.width + place.x as usize]
}

fn bytes(colour: Color) -> [u8; 4] {
    let colour = colour.premultiply().to_color_u8();
    [colour.red(), colour.green(), colour.blue(), colour.alpha()]
}

#[test]
fn sections_run_between_corners_and_show_where_the_outlines_differ() {
    let mapping = square();
    let sections = Sections::new(&mapping, &report(unlike()), &[]);
    // Four corners, and each side in three.
    assert_eq!(sections.links().len(), 12);
    assert!((sections.links()[3].at[1] - 0.25).abs() < 1e-12);
    for (k, cost) in sections.costs(1).iter().enumerate() {
        let expected = if (3..6).contains(&k) {
            2.0 * Sections::DOUBTFUL_COST
        } else {
            0.0
        };
        assert!((cost - expected).abs() < 1e-9, "section {k} costs {cost}");
    }
    assert_eq!(sections.costs(0), sections.costs(1));
    assert!(sections.worst(1).is_some_and(|k| (3..6).contains(&k)));
    let mut doubtful = sections.doubtful(1);
    doubtful.sort_unstable();
    assert_eq!(doubtful, [3, 4, 5]);
    assert_eq!((sections.numbers(3), sections.numbers(11)), ((4, 5), (12, 1)));
    // Unlike all over, the worst is.
    let mut worse = vec![Sections::DOUBTFUL_COST; ROWS];
    worse[2] *= 1.1;
    assert_eq!(Sections::new(&mapping, &report(worse), &[]).doubtful(1), [0]);
    // Alike all over, nothing is doubtful.
    assert!(
        Sections::new(&mapping, &report(vec![0.0; ROWS]), &[])
            .doubtful(1)
            .is_empty()
    );
}

#[test]
fn a_landmark_on_the_outline_is_a_link_and_takes_the_place_of_a_salient_point() {
    let landmarks = [
        mark(LandmarkKind::Inside, vec![Point::new(1.0, 1.0)]),
        mark(LandmarkKind::OnOutline, vec![Point::new(2.0, 0.02)]),
    ];
    let sections = Sections::new(&square(), &report(unlike()), &landmarks);
    let of_landmark: Vec<&Link> = sections.links().iter().filter(|l| l.landmark.is_some()).collect();
    assert_eq!(of_landmark.len(), 1);
    assert_eq!(of_landmark[0].landmark, Some(1));
    assert!((of_landmark[0].at[0] - 0.2525).abs() < 1e-12);
    assert_eq!(sections.links().len(), 12);
}

#[test]
fn the_picture_marks_links_landmarks_doubtful_sections_and_thin_triangles() {
    let (mapping, landmarks) = (square(), [mark(LandmarkKind::Inside, vec![Point::new(0.5, 1.0)])]);
    let picture = drawn(&mapping, &report(unlike()), &landmarks);
    let layout = Layout::new(&mapping, legend::height(2));
    for pose in 0..2 {
        let (outline, mesh) = (layout.outlines[pose].fit, layout.meshes[pose].fit);
        assert_eq!(pixel(&picture, outline.place(Point::new(0.5, 1.0))), bytes(INK));
        assert_eq!(pixel(&picture, outline.place(Point::zeros())), bytes(hue(0.0, 0.5)));
        let thin = Point::new(1.97, 1.0);
        assert_eq!(pixel(&picture, mesh.place(thin)), bytes(worst_colour()));
        // Beside the first side it is calm, beside the second, unlike in pose b, there is a band.
        let beside = outline.place(Point::new(2.0, 0.5)) + Point::new(4.0, 0.0);
        assert_eq!(pixel(&picture, beside) != [255; 4], pose == 1);
        let on_side = outline.place(Point::new(2.0, 0.5));
        assert_eq!(
            pixel(&picture, on_side),
            bytes(cost_colour(2.0 * Sections::DOUBTFUL_COST))
        );
        let calm = outline.place(Point::new(0.5, 0.0));
        assert_eq!(pixel(&picture, calm), bytes(cost_colour(0.0)));
    }
    // The left side of the map belongs to pose a, the right side to pose b.
    let [x, y] = layout.space.map(|corner| corner + 60.0);
    let (left, right) = (Point::new(x, y), Point::new(x + 400.0, y));
    assert_ne!(pixel(&picture, left), pixel(&picture, right));
}

#[test]
fn what_does_not_belong_together_is_refused() {
    let (mapping, matching) = (square(), report(unlike()));
    let sections = Sections::new(&mapping, &matching, &[]);
    let diagram = Diagram {
        mapping: &mapping,
        matching: &matching,
        landmarks: &[],
        poses: &[],
        path: &[],
    };
    assert!(draw(&diagram, &sections, |_| None).is_err());
}

#[test]
fn many_poses_stand_in_several_rows_on_one_sheet() {
    let one = square();
    let many = |count: usize| {
        let vertices = &one.poses.positions()[0];
        let named = (0..count).map(|k| (k.to_string(), vertices.clone())).collect();
        Mapping {
            poses: PoseSet::new(one.poses.topology().clone(), named).expect("poses"),
            ..one.clone()
        }
    };
    for (count, columns) in [(1, 1), (5, 5), (6, 3), (8, 4), (16, 4)] {
        let layout = Layout::new(&many(count), legend::height(count));
        assert_eq!(layout.columns, columns, "{count} poses");
        let [width, height] = layout.size.map(f64::from);
        for cell in layout.outlines.iter().chain(&layout.meshes) {
            assert!(cell.area.high.x <= width && cell.area.high.y <= height);
        }
    }
    let [width, height] = Layout::new(&many(400), legend::height(400)).size;
    assert!(width < 8000 && height < 14_000, "{width} x {height}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]
    #[test]
    fn sections_together_cost_what_the_rows_cost(mismatch in proptest::collection::vec(0.0..9.0f64, ROWS)) {
        let mapping = square();
        let sections = Sections::new(&mapping, &report(mismatch.clone()), &[]);
        let links = sections.links();
        let total: f64 = (0..links.len())
            .map(|k| (links[(k + 1) % links.len()].at[1] - links[k].at[1]).rem_euclid(1.0) * sections.costs(1)[k])
            .sum();
        let mean = mismatch.iter().sum::<f64>() / ROWS as f64;
        prop_assert!((total - mean).abs() < 1e-9);
    }
}
