//! Triangles against the path that they are to cover, and indices from frame to frame.

use super::*;
use crate::render::{Fill, Frame, LineCap, LineJoin, Paint, Stroke, VectorGroup, VectorPicture};

fn polygon(points: &[[f64; 2]]) -> Subpath {
    closed(&points.iter().copied().map(Point::from).collect::<Vec<_>>()).expect("points")
}

fn disc(x: f64, y: f64, radius: f64) -> Subpath {
    // The usual four curves.
    let k = 0.552_284_75 * radius;
    let at = |dx: f64, dy: f64| Point::new(x + dx, y + dy);
    Subpath {
        start: at(radius, 0.0),
        cubics: vec![
            [at(radius, k), at(k, radius), at(0.0, radius)],
            [at(-k, radius), at(-radius, k), at(-radius, 0.0)],
            [at(-radius, -k), at(-k, -radius), at(0.0, -radius)],
            [at(k, -radius), at(radius, -k), at(radius, 0.0)],
        ],
        is_closed: true,
    }
}

const RED: Paint = Paint::Solid([1.0, 0.0, 0.0, 1.0]);

fn filled(id: &str, subpaths: Vec<Subpath>, rule: FillRule) -> VectorShape {
    let mut shape = VectorShape::of_subpaths(id, subpaths);
    shape.fill = Some(Fill { paint: RED, rule });
    shape
}

fn line(width: f64) -> Stroke {
    Stroke {
        paint: RED,
        width,
        cap: LineCap::Butt,
        join: LineJoin::Miter,
        miter_limit: 4.0,
        dashes: Vec::new(),
        dash_offset: 0.0,
    }
}

fn frame(shapes: Vec<VectorShape>) -> VectorFrame {
    VectorFrame::of_shapes([100, 100], shapes)
}

fn tessellator() -> VectorTessellator {
    VectorTessellator::new(0.05).expect("a tolerance")
}

fn mesh_of(tessellator: &mut VectorTessellator, frame: &VectorFrame) -> VectorMesh<Point> {
    let position = |vertex: MeshVertex| Point::new(f64::from(vertex.position[0]), f64::from(vertex.position[1]));
    tessellator.tessellate(frame, position).expect("a mesh")
}

/// In how many triangles a place is.
fn covered(mesh: &VectorMesh<Point>, p: Point) -> usize {
    let is_in = |triangle: &&[u32]| {
        let [a, b, c] = [triangle[0], triangle[1], triangle[2]].map(|index| mesh.vertices[index as usize]);
        let side = |a: Point, b: Point| crate::math::point::cross(b - a, p - a);
        let sides = [side(a, b), side(b, c), side(c, a)];
        sides.iter().all(|s| *s > 0.0) || sides.iter().all(|s| *s < 0.0)
    };
    mesh.indices.chunks_exact(3).filter(is_in).count()
}

fn area(mesh: &VectorMesh<Point>) -> f64 {
    let of = |triangle: &[u32]| {
        let [a, b, c] = [triangle[0], triangle[1], triangle[2]].map(|index| mesh.vertices[index as usize]);
        0.5 * crate::math::point::cross(b - a, c - a).abs()
    };
    mesh.indices.chunks_exact(3).map(of).sum()
}

/// Holds a mesh to the pixels of the frame, where these are surely inside or outside.
fn assert_covers(frame: &VectorFrame, mesh: &VectorMesh<Point>) {
    let pixels = frame.rasterise(1);
    let at = |x: usize, y: usize| pixels.pixels[y * pixels.width + x][3];
    for y in 1..pixels.height - 1 {
        for x in 1..pixels.width - 1 {
            let around = [(0, 0), (0, 2), (2, 0), (2, 2), (1, 1), (0, 1), (1, 0), (2, 1), (1, 2)];
            let around = around.map(|(dx, dy)| at(x + dx - 1, y + dy - 1));
            // Off the lines of the grid, on which edges of triangles lie.
            let count = covered(mesh, Point::new(x as f64 + 0.4871, y as f64 + 0.5133));
            if around.iter().all(|alpha| *alpha == 255) {
                assert!(count >= 1, "({x}, {y}) is inside");
            }
            if around.iter().all(|alpha| *alpha == 0) {
                assert_eq!(count, 0, "({x}, {y}) is outside");
            }
        }
    }
}

#[test]
fn triangles_cover_what_the_path_does() {
    let star = [[50.0, 5.0], [75.0, 90.0], [8.0, 35.0], [92.0, 35.0], [25.0, 90.0]];
    for rule in [FillRule::NonZero, FillRule::EvenOdd] {
        for subpaths in [
            vec![disc(50.0, 50.0, 40.0)],
            vec![disc(50.0, 50.0, 40.0), disc(45.0, 55.0, 20.0)],
            vec![polygon(&star)],
        ] {
            let frame = frame(vec![filled("a", subpaths, rule)]);
            let mesh = mesh_of(&mut tessellator(), &frame);
            assert_covers(&frame, &mesh);
        }
    }
    let mesh = mesh_of(
        &mut tessellator(),
        &frame(vec![filled("a", vec![disc(50.0, 50.0, 40.0)], FillRule::NonZero)]),
    );
    let exact = std::f64::consts::PI * 1600.0;
    assert!(
        (area(&mesh) - exact).abs() < 0.05 * 2.0 * std::f64::consts::PI * 40.0,
        "{}",
        area(&mesh)
    );
}

#[test]
fn lines_and_their_dashes_are_as_wide_and_long_as_they_say() {
    let mut path = Subpath::starting_at(Point::new(10.0, 50.0));
    path.line_to(Point::new(90.0, 50.0));
    let mut shape = VectorShape::of_subpaths("a", vec![path]);
    shape.stroke = Some(line(4.0));
    let whole = mesh_of(&mut tessellator(), &frame(vec![shape.clone()]));
    assert!((area(&whole) - 320.0).abs() < 1e-3, "{}", area(&whole));
    assert_covers(&frame(vec![shape.clone()]), &whole);
    // Half a dash, then gaps of 5 and dashes of 10: 5 + 10 · 5 of 80.
    shape.stroke = Some(Stroke {
        dashes: vec![10.0, 5.0],
        dash_offset: 5.0,
        ..line(4.0)
    });
    let dashed = mesh_of(&mut tessellator(), &frame(vec![shape.clone()]));
    assert!((area(&dashed) - 4.0 * 55.0).abs() < 1e-3, "{}", area(&dashed));
    assert_covers(&frame(vec![shape.clone()]), &dashed);
    shape.stroke = Some(line(f64::NAN));
    let refused = tessellator().tessellate(&frame(vec![shape]), |vertex| vertex);
    assert!(matches!(refused, Err(VectorMeshError::TooFar { .. })));
}

#[test]
fn indices_stay_while_no_triangle_turns_over() {
    let mut tessellator = tessellator();
    let bent = |by: f64| {
        let mut shape = filled(
            "a",
            vec![disc(50.0, 50.0, 30.0), disc(50.0, 50.0, 10.0)],
            FillRule::EvenOdd,
        );
        for subpath in &mut shape.subpaths {
            for p in std::iter::once(&mut subpath.start).chain(subpath.cubics.iter_mut().flatten()) {
                p.x += by * (p.y / 50.0).powi(2);
            }
        }
        shape.stroke = Some(line(1.0));
        frame(vec![shape])
    };
    let first = mesh_of(&mut tessellator, &bent(0.0));
    assert!(!first.indices_are_kept());
    for step in 1..6 {
        let frame = bent(f64::from(step));
        let mesh = mesh_of(&mut tessellator, &frame);
        assert!(mesh.indices_are_kept(), "step {step}: {:?}", mesh.parts);
        assert_eq!(mesh.indices, first.indices);
        assert_covers(&frame, &mesh);
    }
    // The hole leaves the disc: even-odd now paints it.
    let mut apart = bent(0.0);
    if let VectorNode::Shape(shape) = &mut apart.nodes[0] {
        shape.subpaths[1] = disc(85.0, 50.0, 10.0);
        shape.stroke = None;
    }
    let mesh = mesh_of(&mut tessellator, &apart);
    assert!(!mesh.indices_are_kept());
    assert_covers(&apart, &mesh);
}

#[test]
fn kept_triangles_of_paths_that_overlap_themselves_cover_them() {
    let mut tessellator = tessellator();
    // A bow whose ends come to lie over one another.
    let bow = |shift: f64| {
        let outer = [
            [20.0, 20.0],
            [80.0, 20.0],
            [80.0, 80.0],
            [50.0 + shift, 80.0],
            [50.0 + shift, 60.0],
            [60.0, 60.0],
        ];
        let inner = [
            [60.0, 40.0],
            [40.0, 40.0],
            [40.0, 60.0],
            [48.0 - shift, 60.0],
            [48.0 - shift, 80.0],
            [20.0, 80.0],
        ];
        frame(vec![filled(
            "a",
            vec![polygon(&[outer, inner].concat())],
            FillRule::NonZero,
        )])
    };
    for shift in [4.0, 2.0, 0.0, -2.0, -4.0] {
        let frame = bow(shift);
        assert_covers(&frame, &mesh_of(&mut tessellator, &frame));
    }
}

#[test]
fn parts_say_what_they_are_and_colours_are_the_callers() {
    let clip: Vec<Point> = [[10.0, 10.0], [60.0, 10.0], [10.0, 60.0]].map(Point::from).to_vec();
    let group = VectorGroup {
        id: "g".to_owned(),
        opacity: 0.5,
        clip: Some(vec![clip]),
        nodes: vec![
            VectorNode::Shape(Box::new(filled("s", vec![disc(50.0, 50.0, 20.0)], FillRule::NonZero))),
            VectorNode::Picture(VectorPicture {
                id: "p".to_owned(),
                frame: Frame::filled(8, 6, [0; 4]),
                opacity: 0.5,
            }),
        ],
    };
    let mut frame = frame(vec![]);
    frame.nodes.push(VectorNode::Group(group));
    let mesh = tessellator()
        .tessellate(&frame, |vertex| (vertex.part, vertex.colour[3]))
        .expect("a mesh");
    let parts: Vec<_> = mesh
        .parts
        .iter()
        .map(|part| (part.id.as_str(), part.kind, part.clip))
        .collect();
    assert_eq!(
        parts,
        [
            ("g", PartKind::Clip, None),
            ("s", PartKind::Fill, Some(0)),
            ("p", PartKind::Picture, Some(0))
        ]
    );
    for (number, alpha) in [(0, 1.0), (1, 0.5), (2, 0.25)] {
        let vertices = &mesh.vertices[mesh.parts[number].vertices.clone()];
        assert!(!vertices.is_empty() && vertices.iter().all(|vertex| *vertex == (number, alpha)));
    }
    let used: std::collections::BTreeSet<u32> = mesh.indices.iter().copied().collect();
    assert!(used.iter().all(|index| (*index as usize) < mesh.vertices.len()));
}

#[test]
fn coordinates_that_are_no_pixels_are_refused_before_lyon_sees_them() {
    for bad in [f64::NAN, f64::INFINITY, 1e7, -1e300] {
        let mut subpath = disc(50.0, 50.0, 10.0);
        subpath.cubics[1][0].y = bad;
        let refused = tessellator().tessellate(&frame(vec![filled("far", vec![subpath], FillRule::NonZero)]), |v| v);
        assert!(
            matches!(refused, Err(VectorMeshError::TooFar { ref id, .. }) if id == "far"),
            "{bad}"
        );
    }
    for bad in [0.0, -1.0, f64::NAN] {
        VectorTessellator::new(bad).expect_err("no tolerance");
    }
    // Points and nothing at all are parts without triangles.
    let nothing = [
        vec![],
        vec![Subpath::starting_at(Point::new(3.0, 4.0))],
        vec![polygon(&[[1.0, 1.0]; 3])],
    ];
    for subpaths in nothing {
        let mut shape = filled("a", subpaths, FillRule::NonZero);
        shape.stroke = Some(line(2.0));
        let mesh = mesh_of(&mut tessellator(), &frame(vec![shape]));
        assert_eq!((mesh.parts.len(), mesh.indices.len()), (2, 0));
    }
    // Far from the corner, still to a sixteenth of a pixel.
    let far = frame(vec![filled("a", vec![disc(9e5, 9e5, 3.0)], FillRule::NonZero)]);
    let mesh = mesh_of(&mut tessellator(), &far);
    assert!(
        (area(&mesh) - std::f64::consts::PI * 9.0).abs() < 1.5,
        "{}",
        area(&mesh)
    );
}
