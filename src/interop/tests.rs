//! There and back, through every crate.

use super::*;
use crate::outline::{Outline, Ring};

fn ring(points: &[[f64; 2]]) -> Ring {
    Ring::new(points.iter().copied().map(Point::from)).expect("a ring")
}

/// A square with a hole, far from the origin.
fn outline() -> Outline {
    let far = |[x, y]: [f64; 2]| [x + 8e6, y - 3e6];
    let outer = [[0.0, 0.0], [30.0, 0.1], [31.0, 29.3], [0.7, 30.0]].map(far);
    let hole = [[10.0, 10.0], [10.5, 20.0], [20.0, 15.0]].map(far);
    Outline::new(ring(&outer), vec![ring(&hole)]).expect("an outline")
}

fn curved() -> Vec<Subpath> {
    let mut open = Subpath::starting_at(Point::new(1.0, 2.0));
    open.line_to(Point::new(5.0, 2.5));
    open.quadratic_to(Point::new(7.0, 2.5), Point::new(7.0, 6.0));
    let mut closed = Subpath::starting_at(Point::new(0.0, 9.0));
    closed
        .cubics
        .push([[3.0, 9.0], [4.0, 12.0], [1.0, 14.0]].map(Point::from));
    closed.is_closed = true;
    vec![open, closed]
}

#[cfg(any(feature = "lyon", feature = "tiny_skia"))]
fn assert_near(a: &[Subpath], b: &[Subpath], tolerance: f64) {
    assert_eq!(a.len(), b.len());
    for (a, b) in a.iter().zip(b) {
        assert_eq!((a.cubics.len(), a.is_closed), (b.cubics.len(), b.is_closed));
        for (p, q) in a.points().zip(b.points()) {
            assert!((p - q).amax() <= tolerance, "{p} {q}");
        }
    }
}

#[test]
fn lines_stay_lines_and_outlines_come_back() {
    let subpaths = outline().to_subpaths();
    assert!(
        subpaths
            .iter()
            .flat_map(Subpath::segments)
            .all(|s| matches!(s, Segment::Line(_)))
    );
    assert_eq!(Outline::from_subpaths(&subpaths, 0.1), Ok(outline()));
    // The outer ring need not be the first.
    let turned: Vec<Subpath> = subpaths.into_iter().rev().collect();
    assert_eq!(Outline::from_subpaths(&turned, 0.1), Ok(outline()));
    assert_eq!(Outline::from_subpaths(&[], 0.1), Err(PathOutlineError::Empty));
    for bad in [0.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            Outline::from_subpaths(&turned, bad),
            Err(PathOutlineError::BadTolerance(_))
        ));
    }
    let mut wild = turned;
    wild[0].cubics[0][2].x = f64::NAN;
    let refused = Outline::from_subpaths(&wild, 0.1);
    assert!(matches!(refused, Err(PathOutlineError::Ring { piece: 0, .. })));
}

#[test]
fn chords_keep_within_the_tolerance() {
    let arc = &curved()[1];
    let from = arc.start;
    let [a, b, to] = arc.cubics[0];
    let on_curve = |t: f64| {
        let s = 1.0 - t;
        from * (s * s * s) + a * (3.0 * s * s * t) + b * (3.0 * s * t * t) + to * (t * t * t)
    };
    for tolerance in [1.0, 0.1, 0.001] {
        let chords = arc.polyline(&arc.steps(tolerance));
        for k in 0..=1000 {
            let p = on_curve(f64::from(k) / 1000.0);
            let away = |pair: &[Point]| crate::math::point::nearest_on_segment(p, pair[0], pair[1]).1;
            let distance = chords.windows(2).map(away).fold(f64::INFINITY, f64::min);
            assert!(distance <= tolerance, "{distance} with {tolerance}");
        }
    }
}

#[test]
fn frames_give_their_shapes_from_back_to_front() {
    use crate::render::VectorGroup;
    let shape = |id: &str| VectorShape::of_subpaths(id, curved());
    let mut frame = VectorFrame::of_shapes([8, 8], [shape("a"), shape("d")]);
    let group = VectorGroup {
        id: "g".to_owned(),
        opacity: 0.5,
        clip: None,
        nodes: VectorFrame::of_shapes([8, 8], [shape("b"), shape("c")]).nodes,
    };
    frame.nodes.insert(1, VectorNode::Group(group));
    let ids: Vec<&str> = frame.shapes().iter().map(|shape| shape.id.as_str()).collect();
    assert_eq!(ids, ["a", "b", "c", "d"]);
}

#[cfg(feature = "lyon")]
#[test]
fn through_lyon() {
    use crate::math::SinglePrecision;
    let (path, single) = outline().to_lyon().expect("finite");
    // A box of 32 units, 8 million from the origin: a millionth of a unit, where single precision alone keeps half a unit.
    assert!(single.precision() < 1.1e-6, "{}", single.precision());
    let back = Outline::from_lyon(&path, &single, 0.1).expect("an outline");
    for (a, b) in outline().rings().iter().zip(back.rings()) {
        for (p, q) in a.points().iter().zip(b.points()) {
            assert!((p - q).amax() <= single.precision());
        }
    }
    let near = SinglePrecision::UNCHANGED;
    let path = Subpath::to_lyon(&curved(), &near).expect("finite");
    assert_near(&Subpath::from_lyon(&path, &near).expect("finite"), &curved(), 1e-6);
    let mut wild = curved();
    wild[0].cubics[0][1].y = f64::INFINITY;
    Subpath::to_lyon(&wild, &near).expect_err("not finite");
    let frame = VectorFrame::of_shapes([8, 8], [VectorShape::of_subpaths("a", curved())]);
    let paths = frame.to_lyon().expect("finite");
    let again = VectorFrame::from_lyon([8, 8], paths.iter().map(|(id, path)| (id.clone(), path))).expect("finite");
    assert_near(&again.shapes()[0].subpaths, &curved(), 1e-6);
}

#[cfg(feature = "kurbo")]
#[test]
fn through_kurbo() {
    let back = Outline::from_kurbo(&outline().to_kurbo(), 0.1);
    assert_eq!(back, Ok(outline()));
    assert_eq!(Subpath::from_kurbo(&Subpath::to_kurbo(&curved())), curved());
    let shape = VectorShape::of_subpaths("a", curved());
    assert_eq!(VectorShape::from_kurbo("a", &shape.to_kurbo()), shape);
}

#[cfg(feature = "tiny_skia")]
#[test]
fn through_tiny_skia() {
    use crate::math::SinglePrecision;
    let near = SinglePrecision::UNCHANGED;
    let path = Subpath::to_tiny_skia(&curved(), &near)
        .expect("finite")
        .expect("a path");
    assert_near(&Subpath::from_tiny_skia(&path, &near), &curved(), 1e-6);
    let (path, single) = outline().to_tiny_skia().expect("finite").expect("a path");
    let back = Outline::from_tiny_skia(&path, &single, 0.1).expect("an outline");
    assert!((back.area() - outline().area()).abs() < 1e-3);
    assert_eq!(Subpath::to_tiny_skia(&[], &near), Ok(None));
}
