//! Carried drawings as a whole.

use proptest::prelude::*;

use inbetween::input::{Art, ArtElement, Drawing, SvgOptions, read_svg};
use inbetween::matching::Correspondence;
use inbetween::math::{Point, point, rotation};
use inbetween::mesh::Topology;
use inbetween::outline::{Outline, Ring};
use inbetween::pose::{Mapping, Matching, PoseSet};
use inbetween::render::drawing::*;
use inbetween::render::{Camera, Silhouette};

/// The square from (0, 0) to (100, 100), its diagonal an edge of the mesh, in poses given by maps of its corners.
fn mapping(poses: &[[[f64; 2]; 4]]) -> Mapping {
    let topology = Topology::new(4, vec![[0, 1, 2], [0, 2, 3]]).expect("a mesh");
    let named = poses
        .iter()
        .enumerate()
        .map(|(k, corners)| (format!("pose{k}"), corners.map(Point::from).to_vec()));
    let outlines = poses.iter().map(|corners| {
        let ring = Ring::new(corners.map(Point::from)).expect("a ring");
        Outline::new(ring, vec![]).expect("simple")
    });
    Mapping {
        poses: PoseSet::new(topology, named.collect()).expect("poses"),
        outlines: outlines.collect(),
        rings: vec![vec![0, 1, 2, 3]],
        steiner: 0,
        matching: Matching {
            reference: 0,
            outer: Correspondence::identity(poses.len(), 8),
        },
        overlaps: inbetween::pose::Overlaps::default(),
    }
}

const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [100.0, 0.0], [100.0, 100.0], [0.0, 100.0]];
const SHEARED: [[f64; 2]; 4] = [[0.0, 0.0], [100.0, 0.0], [150.0, 100.0], [50.0, 100.0]];
/// Bent along the diagonal.
const BENT: [[f64; 2]; 4] = [[0.0, 0.0], [100.0, 0.0], [100.0, 100.0], [40.0, 70.0]];

/// One pixel a unit.
fn camera() -> Camera {
    let reach = 200.0 * (0.5 - Camera::MARGIN) / 2.0;
    let corners = [Point::repeat(50.0 - 2.0 * reach), Point::repeat(50.0 + 2.0 * reach)];
    Camera::fitting(&corners, [200, 200])
}

fn art(body: &str) -> Art {
    let text = format!(r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">{body}</svg>"#);
    let drawing = read_svg(text.as_bytes(), &SvgOptions::default()).expect("a drawing");
    drawing.art.expect("curves")
}

fn carried(mapping: &Mapping, bodies: &[&str]) -> (CarriedDrawing, Vec<CrossFade>) {
    let art = bodies.iter().enumerate().map(|(drawn_on, body)| PoseArt {
        art: art(body),
        drawn_on,
    });
    let drawing_of = (0..bodies.len()).collect();
    CarriedDrawing::new(mapping, art.collect(), drawing_of, Silhouette::new(mapping), camera())
}

fn shapes(nodes: &[VectorNode]) -> Vec<&VectorShape> {
    nodes
        .iter()
        .flat_map(|node| match node {
            VectorNode::Shape(shape) => vec![&**shape],
            VectorNode::Group(group) => shapes(&group.nodes),
            VectorNode::Picture(_) => vec![],
        })
        .collect()
}

fn ids(nodes: &[VectorNode]) -> Vec<&str> {
    nodes.iter().map(VectorNode::id).collect()
}

/// What a subpath of the first element is made of, in source units.
fn in_units(shape: &VectorShape) -> Vec<Point> {
    let origin = camera().to_pixels(Point::zeros());
    shape
        .subpaths
        .iter()
        .flat_map(Subpath::points)
        .map(|p| (p - origin) / camera().scale())
        .collect()
}

const LINE: &str = r#"<path id="l" d="M10 60C30 10 60 90 90 30" fill="none" stroke="black"/><path d="M1 1H99V99Z"/>"#;

#[test]
fn a_curve_over_an_edge_is_sheared_exactly_and_needs_no_division() {
    let mapping = mapping(&[SQUARE, SHEARED]);
    let (carried, notes) = carried(&mapping, &[LINE]);
    assert!(notes.is_empty());
    let nodes = carried.frame(&mapping.poses.positions()[1], &[1.0], &[1.0]);
    let found = in_units(shapes(&nodes)[0]);
    let expected = [[10.0, 60.0], [30.0, 10.0], [60.0, 90.0], [90.0, 30.0]].map(|[x, y]| Point::new(x + 0.5 * y, y));
    assert_eq!(found.len(), 4);
    for (p, q) in found.iter().zip(&expected) {
        assert!((p - q).norm() < 1e-9, "{p} for {q}");
    }
}

#[test]
fn a_curve_over_a_bend_is_divided_there() {
    let mapping = mapping(&[SQUARE, BENT]);
    let (carried, _) = carried(&mapping, &[LINE]);
    let nodes = carried.frame(&mapping.poses.positions()[0], &[1.0, 0.0], &[1.0, 0.0]);
    let own = in_units(shapes(&nodes)[0]);
    assert!(own.len() > 4);
    // In its own pose it is itself.
    let curve = kurbo::CubicBez::new((10.0, 60.0), (30.0, 10.0), (60.0, 90.0), (90.0, 30.0));
    for end in own.iter().step_by(3) {
        let nearest = kurbo::ParamCurveNearest::nearest(&curve, kurbo::Point::new(end.x, end.y), 1e-9);
        assert!(nearest.distance_sq < 1e-12);
    }
}

#[test]
fn matched_elements_morph_and_others_fade() {
    let mapping = mapping(&[SQUARE, SQUARE]);
    let (carried, notes) = carried(
        &mapping,
        &[
            r##"<rect id="a" x="10" y="10" width="20" height="20" fill="#f00" stroke="#000" stroke-width="2"/>
            <rect id="hat" x="40" y="10" width="9" height="9" opacity="0.5"/>"##,
            r##"<rect id="a" x="50" y="10" width="20" height="40" fill="#00f" stroke="#000" stroke-width="6" opacity="0.5"/>
            <rect width="5" height="5"/>"##,
        ],
    );
    assert!(notes.is_empty());
    let positions = &mapping.poses.positions()[0];
    let nodes = carried.frame(positions, &[0.75, 0.25], &[0.9, 0.1]);
    assert_eq!(ids(&nodes), ["a", "hat", "pose1-1"]);
    let shapes = shapes(&nodes);
    let (low, high) = point::bounding_box(&in_units(shapes[0])).expect("points");
    assert!((low - Point::new(20.0, 10.0)).norm() < 1e-9 && (high - Point::new(40.0, 35.0)).norm() < 1e-9);
    let Some(Paint::Solid(colour)) = shapes[0].fill.as_ref().map(|fill| fill.paint.clone()) else {
        panic!("a colour");
    };
    for (found, expected) in colour.iter().zip([0.75, 0.0, 0.25, 1.0]) {
        assert!((found - expected).abs() < 1e-12);
    }
    let width = shapes[0].stroke.as_ref().expect("a stroke").width;
    assert!((width - 3.0 * camera().scale()).abs() < 1e-9);
    assert!((shapes[0].opacity - 0.875).abs() < 1e-7);
    assert!((shapes[1].opacity - 0.45).abs() < 1e-7 && (shapes[2].opacity - 0.1).abs() < 1e-7);
}

#[test]
fn drawings_without_a_common_name_fade_as_a_whole_within_one_edge() {
    let mapping = mapping(&[SQUARE, SQUARE]);
    let whole = r#"<rect width="100" height="100" fill="white"/>"#;
    let black = r#"<rect id="b" width="100" height="100"/>"#;
    let (carried, _) = carried(&mapping, &[whole, black]);
    let positions = &mapping.poses.positions()[0];
    let nodes = carried.frame(positions, &[0.25, 0.75], &[0.25, 0.75]);
    let frame = VectorFrame {
        size: [200, 200],
        background: None,
        nodes,
    };
    let pixels = frame.rasterise(1);
    let middle = pixels.pixels[100 * 200 + 100];
    assert!(middle[0].abs_diff(64) <= 1 && middle[3] == 255, "{middle:?}");
    assert_eq!(pixels.pixels[100 * 200 + 5], [0; 4]);
    assert_eq!(ids(&frame.nodes), ["drawings"]);
    let VectorNode::Group(all) = &frame.nodes[0] else {
        panic!("a group");
    };
    assert!(all.clip.is_some());
    assert_eq!(ids(&all.nodes), ["drawing pose0", "drawing pose1"]);
}

#[test]
fn drawings_that_fade_are_of_one_colour_up_to_the_edge_and_keep_their_openings() {
    // Inside the mesh, the outlines are 10 and 20 away from it: half-way the silhouette is 15 away.
    let mut mapping = mapping(&[SQUARE, SQUARE]);
    let inset = |by: f64| {
        let ring = Ring::new(SQUARE.map(|[x, y]| Point::new(x + by * (1.0 - x / 50.0), y + by * (1.0 - y / 50.0))));
        Outline::new(ring.expect("a ring"), vec![]).expect("simple")
    };
    mapping.outlines = vec![inset(10.0), inset(20.0)];
    let large = r##"<path fill="#f00" fill-rule="evenodd" d="M10 10H90V90H10ZM40 40V60H60V40Z"/>"##;
    let small =
        r##"<rect x="20" y="20" width="60" height="60" fill="#00f"/><circle cx="30" cy="50" r="4" fill="#0f0"/>"##;
    let (carried, _) = carried(&mapping, &[large, small]);
    let frame = |weights: [f64; 2]| {
        let frame = VectorFrame {
            size: [200, 200],
            background: None,
            nodes: carried.frame(&mapping.poses.positions()[0], &weights, &weights),
        };
        frame.rasterise(1)
    };
    let between = frame([0.5, 0.5]);
    let at = |pixels: &[[u8; 4]], x: usize, y: usize| pixels[(y + 50) * 200 + x + 50];
    // Two to the left of the small square, inside the silhouette, and in its middle.
    let (edge, middle) = (at(&between.pixels, 17, 50), at(&between.pixels, 70, 30));
    assert_eq!(edge, middle);
    assert!(
        middle[0].abs_diff(128) <= 1 && middle[2].abs_diff(128) <= 1,
        "{middle:?}"
    );
    assert_eq!(at(&between.pixels, 13, 50), [0; 4]);
    // At a pose there is its drawing: no more than that on the outside, and nothing in its opening.
    let alone = frame([1.0, 0.0]);
    assert_eq!(at(&alone.pixels, 8, 50), [0; 4]);
    assert_eq!(at(&alone.pixels, 50, 50), [0; 4]);
    assert_eq!(at(&alone.pixels, 12, 50), [255, 0, 0, 255]);
}

#[test]
fn where_drawings_contradict_one_another_the_one_seen_most_decides() {
    let mapping = mapping(&[SQUARE, SQUARE]);
    let arm = r#"<rect id="arm" width="40" height="40"/>"#;
    let chest = r#"<rect id="chest" x="20" width="40" height="40"/>"#;
    let (carried, _) = carried(&mapping, &[&format!("{arm}{chest}"), &format!("{chest}{arm}")]);
    let positions = &mapping.poses.positions()[0];
    let order = |first: f64| {
        let weights = [first, 1.0 - first];
        ids(&carried.frame(positions, &weights, &weights))
            .iter()
            .map(|id| id.to_string())
            .collect::<Vec<_>>()
    };
    assert_eq!(order(1.0), ["arm", "chest"]);
    assert_eq!(order(0.5), ["arm", "chest"]);
    assert_eq!(order(0.4), ["chest", "arm"]);
}

#[test]
fn what_cannot_change_gradually_fades_and_is_noted() {
    let mapping = mapping(&[SQUARE, SQUARE]);
    let gradients = r#"<linearGradient id="g"><stop stop-color="red"/><stop offset="1"/></linearGradient>
        <radialGradient id="h"><stop stop-color="red"/><stop offset="1"/></radialGradient>"#;
    let with = |paint| {
        format!(r#"{gradients}<rect id="a" width="40" height="40" fill="{paint}"/><rect id="b" width="9" height="9"/>"#)
    };
    let (carried, notes) = carried(&mapping, &[&with("url(#g)"), &with("url(#h)")]);
    assert_eq!(notes.len(), 1);
    assert!(
        notes[0].element == "a" && notes[0].reason.contains("radial"),
        "{notes:?}"
    );
    let nodes = carried.frame(&mapping.poses.positions()[0], &[0.5, 0.5], &[0.5, 0.5]);
    assert_eq!(ids(&nodes), ["a@pose0", "a@pose1", "b"]);
}

#[test]
fn a_gradient_follows_its_element() {
    let turned = SQUARE.map(|p| (rotation(1.0) * Point::from(p)).into());
    let mapping = mapping(&[SQUARE, turned]);
    let body = r#"<linearGradient id="g"><stop stop-color="red"/><stop offset="1"/></linearGradient>
        <rect id="a" x="20" y="20" width="40" height="60" fill="url(#g)"/>"#;
    let (carried, _) = carried(&mapping, &[body]);
    let nodes = carried.frame(&mapping.poses.positions()[1], &[1.0, 0.0], &[1.0, 0.0]);
    let Some(Paint::Gradient(gradient)) = shapes(&nodes)[0].fill.as_ref().map(|fill| fill.paint.clone()) else {
        panic!("a gradient");
    };
    let expected = rotation(1.0) * Point::new(40.0, 0.0) * camera().scale();
    assert!(
        (gradient.placement.along_x - expected).norm() < 1e-3,
        "{:?}",
        gradient.placement
    );
}

#[test]
fn copies_of_a_pose_show_its_drawing() {
    let mapping = mapping(&[SQUARE, SHEARED]);
    let art = vec![PoseArt {
        art: art(LINE),
        drawn_on: 0,
    }];
    let (carried, _) = CarriedDrawing::new(&mapping, art, vec![0, 0], Silhouette::new(&mapping), camera());
    let nodes = carried.frame(&mapping.poses.positions()[1], &[0.0, 1.0], &[0.0, 1.0]);
    let shapes = shapes(&nodes);
    assert_eq!(shapes[0].opacity, 1.0);
    assert!((in_units(shapes[0])[0] - Point::new(40.0, 60.0)).norm() < 1e-9);
}

/// A curve that begins a hair before an edge and crosses it at once.
#[test]
fn an_end_just_before_an_edge_stays_on_its_side() {
    let bent = [SQUARE[0], SQUARE[1], SQUARE[2], [10.0, 60.0]];
    let mapping = mapping(&[SQUARE, bent]);
    let body = r#"<path d="M98.92 98.9191C1 22 1 1 1 1" fill="none" stroke="red"/><rect width="100" height="100"/>"#;
    let (carried, _) = carried(&mapping, &[body]);
    let start_at = |pose: usize| {
        in_units(shapes(&carried.frame(&mapping.poses.positions()[pose], &[1.0, 0.0], &[1.0, 0.0]))[0])[0]
    };
    // Above the diagonal nothing moves.
    assert!(
        (start_at(1) - start_at(0)).norm() < 1e-9,
        "{} {}",
        start_at(0),
        start_at(1)
    );
}

#[test]
fn a_part_that_only_one_drawing_has_shrinks_to_a_point() {
    let mapping = mapping(&[SQUARE, SQUARE]);
    let (carried, _) = carried(
        &mapping,
        &[
            r#"<path id="a" d="M10 10H50V50H10Z M70 70H90V90H70Z"/>"#,
            r#"<path id="a" d="M72 12H90V30Z M10 10H50V52H10Z M70 72H90V90H70Z"/>"#,
        ],
    );
    let positions = &mapping.poses.positions()[0];
    let nodes = carried.frame(positions, &[1.0, 0.0], &[1.0, 0.0]);
    let subpaths = &shapes(&nodes)[0].subpaths;
    let extents: Vec<f64> = subpaths
        .iter()
        .map(|subpath| point::diagonal(subpath.points()))
        .collect();
    assert_eq!(extents.len(), 3);
    assert!(extents[2] < 1e-9 && extents[0] > 1.0 && extents[1] > 1.0, "{extents:?}");
    // The squares are paired with the squares, although the triangle comes first.
    let half = carried.frame(positions, &[0.5, 0.5], &[0.5, 0.5]);
    let (_, high) = point::bounding_box(&in_units(shapes(&half)[0])[..13]).expect("points");
    assert!((high - Point::new(50.0, 51.0)).norm() < 1e-9);
}

#[test]
fn an_unknown_pose_or_drawing_is_left_out() {
    let mapping = mapping(&[SQUARE]);
    let art = vec![PoseArt {
        art: art(LINE),
        drawn_on: 9,
    }];
    let (carried, _) = CarriedDrawing::new(&mapping, art, vec![4], Silhouette::new(&mapping), camera());
    assert!(carried.frame(&mapping.poses.positions()[0], &[1.0], &[1.0]).is_empty());
    let (nothing, _) = CarriedDrawing::new(&mapping, vec![], vec![], Silhouette::new(&mapping), camera());
    assert!(nothing.frame(&mapping.poses.positions()[0], &[1.0], &[1.0]).is_empty());
}

/// The number of curves of each node, by id.
fn structure(nodes: &[VectorNode]) -> Vec<(String, Vec<usize>)> {
    let mut found: Vec<(String, Vec<usize>)> = shapes(nodes)
        .iter()
        .map(|shape| {
            (
                shape.id.clone(),
                shape.subpaths.iter().map(|s| s.cubics.len()).collect(),
            )
        })
        .collect();
    found.sort();
    found
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn every_end_of_a_curve_lies_where_the_mesh_carries_it(
        numbers in proptest::collection::vec(1.0..99.0f64, 8),
        corner in (10.0..60.0f64, 60.0..140.0f64),
    ) {
        let bent = [SQUARE[0], SQUARE[1], SQUARE[2], [corner.0, corner.1]];
        let mapping = mapping(&[SQUARE, bent]);
        let body = format!(
            r#"<path d="M{} {}C{} {} {} {} {} {}" fill="none" stroke="red"/><rect width="100" height="100"/>"#,
            numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5], numbers[6], numbers[7],
        );
        let (carried, _) = carried(&mapping, &[&body]);
        let own = in_units(shapes(&carried.frame(&mapping.poses.positions()[0], &[1.0, 0.0], &[1.0, 0.0]))[0]);
        let there = in_units(shapes(&carried.frame(&mapping.poses.positions()[1], &[1.0, 0.0], &[1.0, 0.0]))[0]);
        for (from, to) in own.iter().zip(&there).step_by(3) {
            // The diagonal stays; the half beyond it follows the corner.
            let beyond = (from.y - from.x).max(0.0) / 100.0;
            let expected = from + (Point::new(corner.0, corner.1) - Point::new(0.0, 100.0)) * beyond;
            prop_assert!((to - expected).norm() < 1e-6, "{from} to {to}, not {expected}");
        }
    }

    #[test]
    fn all_frames_have_the_same_nodes(first in -0.5..1.5f64, seen in 0.0..1.0f64, height in 40.0..160.0f64) {
        let bent = [SQUARE[0], SQUARE[1], SQUARE[2], [20.0, height]];
        let mapping = mapping(&[SQUARE, bent]);
        let (carried, _) = carried(&mapping, &[LINE, r#"<circle id="l" cx="50" cy="50" r="30"/><path id="m" d="M1 1H99V99Z"/>"#]);
        let positions = mapping.poses.positions();
        let at = |weights: [f64; 2], seen: [f64; 2], k: usize| structure(&carried.frame(&positions[k], &weights, &seen));
        prop_assert_eq!(at([first, 1.0 - first], [seen, 1.0 - seen], 0), at([1.0, 0.0], [1.0, 0.0], 1));
    }
}

/// Lines of all kinds, dashes, gradients, even-odd holes and translucent groups of elements that do not overlap.
const STYLES: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 400 300"><defs>
    <linearGradient id="l" gradientTransform="rotate(30)"><stop offset="0.1" stop-color="#f80"/><stop offset="0.5" stop-color="#08f"
    stop-opacity="0.5"/><stop offset="0.5" stop-color="#fff"/><stop offset="0.9" stop-color="#222"/></linearGradient>
    <radialGradient id="r" fx="0.3" fy="0.3" spreadMethod="reflect" r="0.3"><stop stop-color="#ff0"/><stop offset="1" stop-color="#a00"/>
    </radialGradient></defs>
    <rect x="10" y="10" width="380" height="280" rx="20" fill="url(#l)" stroke="#123" stroke-width="7"/>
    <g transform="rotate(10 200 150) scale(1.5)"><ellipse cx="80" cy="80" rx="50" ry="40" fill="url(#r)" stroke="url(#l)"
    stroke-width="6" stroke-dasharray="12 5 3" stroke-linecap="round"/></g>
    <path d="M220 60h120v120h-120z M250 90h60v60h-60z" fill="#0a5" fill-rule="evenodd" opacity="0.6" stroke="#000" stroke-width="5"
    stroke-linejoin="bevel"/>
    <path d="M40 260 L80 200 L120 260 Q160 180 200 260 T 280 260" fill="none" stroke="#c0f" stroke-width="9" stroke-linejoin="round"
    stroke-linecap="square"/>
    <g opacity="0.5"><rect x="300" y="200" width="30" height="50"/><rect x="340" y="200" width="30" height="50" fill="#fff"/></g></svg>"##;

#[test]
fn a_drawing_in_its_own_pose_looks_as_its_file() {
    looks_as_its_file("styles", STYLES.as_bytes());
    for name in ["face/calm_left", "face/laugh_right", "snake/coil"] {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("data/{name}.svg"));
        looks_as_its_file(name, &std::fs::read(path).expect("a file"));
    }
}

/// Compares with what resvg makes of the file. The mesh is a box around the drawing.
fn looks_as_its_file(name: &str, bytes: &[u8]) {
    let mut options = SvgOptions::default();
    options.pixels_per_unit = Some(0.5);
    let Drawing { art, picture, .. } = read_svg(bytes, &options).expect("a drawing");
    let corners = [[-1.0, -1.0], [1200.0, -1.0], [1200.0, 700.0], [-1.0, 700.0]];
    let mapping = mapping(&[corners, SQUARE]);
    let art = vec![PoseArt {
        art: art.expect("curves"),
        drawn_on: 0,
    }];
    let size = [picture.width, picture.height];
    // A camera that shows the picture as it is: half a pixel a unit.
    let (low, high) = (
        picture.origin,
        picture.origin + Point::new(size[0] as f64, size[1] as f64) * 2.0,
    );
    let margin = Point::repeat(Camera::MARGIN * size[0].min(size[1]) as f64 * 2.0);
    let camera = Camera::fitting(&[low + margin, high - margin], size);
    assert!((camera.scale() - 0.5).abs() < 1e-9);
    let (carried, _) = CarriedDrawing::new(&mapping, art, vec![0], Silhouette::new(&mapping), camera);
    let frame = VectorFrame {
        size,
        background: None,
        nodes: carried.frame(&mapping.poses.positions()[0], &[1.0], &[1.0]),
    };
    let drawn = frame.rasterise(1);
    let differences: Vec<u8> = drawn
        .pixels
        .iter()
        .zip(&picture.pixels)
        .map(|(a, b)| a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0))
        .collect();
    let worst = differences.iter().copied().max().unwrap_or(0);
    let far = differences.iter().filter(|difference| **difference > 8).count();
    assert!(
        worst <= 40 && far * 1000 < differences.len(),
        "{name}: worst {worst}, {far} of {}",
        differences.len()
    );
}

fn element(points: &[[f64; 2]]) -> ArtElement {
    let [start, rest @ ..] = points else {
        panic!("points");
    };
    ArtElement {
        id: None,
        subpaths: vec![Subpath {
            start: Point::from(*start),
            cubics: rest
                .chunks_exact(3)
                .map(|c| [c[0], c[1], c[2]].map(Point::from))
                .collect(),
            is_closed: true,
        }],
        fill: None,
        stroke: None,
        opacity: 1.0,
    }
}

#[test]
fn odd_shapes_do_not_stop_the_rasteriser() {
    let paint = Paint::Solid([1.0, 0.5, 0.0, 1.0]);
    let odd: [&[[f64; 2]]; 5] = [
        &[[f64::NAN, 1.0], [2.0, 2.0], [3.0, 3.0], [4.0, 4.0]],
        &[[1e300, 1.0], [2.0, 2.0], [3.0, 3.0], [4.0, 4.0]],
        &[[5.0, 5.0], [5.0, 5.0], [5.0, 5.0], [5.0, 5.0]],
        &[[0.0, 5.0], [5.0, 5.0], [7.0, 5.0], [90.0, 5.0]],
        &[[-9e5, -9e5], [9e5, -9e5], [9e5, 9e5], [-9e5, 9e5]],
    ];
    let shapes = odd.iter().enumerate().map(|(k, points)| {
        VectorNode::Shape(Box::new(VectorShape {
            id: k.to_string(),
            subpaths: element(points).subpaths,
            fill: Some(Fill {
                paint: paint.clone(),
                rule: FillRule::EvenOdd,
            }),
            stroke: Some(Stroke {
                paint: paint.clone(),
                width: 1.5,
                cap: LineCap::Round,
                join: LineJoin::Round,
                miter_limit: 4.0,
                dashes: vec![1e-9, 1e-9],
                dash_offset: 0.0,
            }),
            opacity: 0.5,
        }))
    });
    let frame = VectorFrame {
        size: [50, 50],
        background: None,
        nodes: shapes.collect(),
    };
    let pixels = frame.rasterise(2).pixels;
    assert!(pixels.iter().all(|[r, g, b, a]| r <= a && g <= a && b <= a));
    // The dot is none.
    let only_dot = VectorFrame {
        nodes: vec![frame.nodes[2].clone()],
        ..frame.clone()
    };
    assert!(only_dot.rasterise(1).pixels.iter().all(|pixel| *pixel == [0; 4]));
}

#[test]
fn tiles_meet_without_a_seam_in_a_frame_wider_than_one() {
    let size = [5000, 3];
    let paint = Paint::Solid([0.0, 0.0, 1.0, 1.0]);
    let frame = VectorFrame {
        size,
        background: Some([255; 4]),
        nodes: vec![VectorNode::Group(VectorGroup {
            id: "g".to_owned(),
            opacity: 0.5,
            clip: Some(vec![
                [[0.0, 0.0], [5000.0, 0.0], [5000.0, 3.0], [0.0, 3.0]]
                    .map(Point::from)
                    .to_vec(),
            ]),
            nodes: vec![VectorNode::Shape(Box::new(VectorShape {
                id: "s".to_owned(),
                subpaths: element(&[
                    [-10.0, -10.0],
                    [0.0, -10.0],
                    [0.0, -10.0],
                    [6000.0, -10.0],
                    [6000.0, -10.0],
                    [6000.0, -10.0],
                    [6000.0, 10.0],
                    [6000.0, 10.0],
                    [-10.0, 10.0],
                    [-10.0, 10.0],
                ])
                .subpaths,
                fill: Some(Fill {
                    paint,
                    rule: FillRule::NonZero,
                }),
                stroke: None,
                opacity: 1.0,
            }))],
        })],
    };
    let drawn = frame.rasterise(2);
    assert!(drawn.pixels.iter().all(|pixel| *pixel == drawn.pixels[0]), "one colour");
    assert!(drawn.pixels[0][0].abs_diff(128) <= 1 && drawn.pixels[0][2] == 255);
}
