//! Textures registered to one another, through the public interface: crosses that lie elsewhere on meshes that are the same.

use std::sync::Arc;

use inbetween::appearance::Appearance;
use inbetween::input::Picture;
use inbetween::math::Point;
use inbetween::mesh::{Topology, geometry, subdivided};
use inbetween::outline::{Outline, Ring};
use inbetween::registration::{Embedded, register_textures};

const SIDE: usize = 240;

/// A square with a dark cross whose middle is at `middle`, on paper that gets darker to the right.
fn drawing(middle: [f64; 2]) -> Arc<Appearance> {
    let outline = [[20.0, 20.0], [220.0, 20.0], [220.0, 220.0], [20.0, 220.0]].map(Point::from);
    let outline = Outline::new(Ring::new(outline.to_vec()).expect("a ring"), vec![]).expect("simple");
    let colour = |k: usize| {
        let [x, y] = [(k % SIDE) as f64 + 0.5 - middle[0], (k / SIDE) as f64 + 0.5 - middle[1]];
        let in_cross = (x.abs() < 4.0 || y.abs() < 4.0) && x.abs().max(y.abs()) < 40.0;
        if in_cross {
            [30, 30, 40, 255]
        } else {
            [230 - (k % SIDE / 4) as u8, 200, 180, 255]
        }
    };
    let picture = Picture {
        width: SIDE,
        height: SIDE,
        pixels: (0..SIDE * SIDE).map(colour).collect(),
        origin: Point::zeros(),
        pixels_per_unit: 1.0,
    };
    Arc::new(Appearance::of(&outline, &picture))
}

/// A grid of squares of side 40, each two triangles.
fn mesh() -> (Vec<[usize; 3]>, Vec<Point>) {
    let places = (0..36).map(|k| Point::new(20.0 + 40.0 * (k % 6) as f64, 20.0 + 40.0 * (k / 6) as f64));
    let squares = (0..25).map(|k| k / 5 * 6 + k % 5);
    let triangles = squares.flat_map(|k| [[k, k + 1, k + 7], [k, k + 7, k + 6]]);
    (triangles.collect(), places.collect())
}

/// Where the vertices of the fine mesh are in the reference and, registered, in the other drawing.
fn registered(drawings: &[Arc<Appearance>], wanted: bool) -> Option<[Vec<Point>; 2]> {
    let (triangles, positions) = mesh();
    let (fine, places) = subdivided(&triangles, positions.len(), 4);
    let fine = Topology::new(places.len(), fine).expect("a mesh");
    let drawn = Embedded {
        triangles: &triangles,
        fine: (&fine, &places),
        appearances: drawings,
        positions: &[&positions, &positions],
    };
    let mut found = register_textures(&drawn, 0, &[wanted, wanted]);
    assert!(found[0].is_none(), "the reference is not moved");
    let of_other = found.remove(1)?;
    Some([places, of_other].map(|anchors| anchors.iter().map(|anchor| anchor.at(&positions)).collect()))
}

#[test]
fn lines_a_few_pixels_apart_come_to_lie_on_one_another() {
    for shift in [[3.0, 2.0], [-2.5, 0.0], [0.6, -4.0]] {
        let drawings = [drawing([120.0, 120.0]), drawing([120.0 + shift[0], 120.0 + shift[1]])];
        let [from, to] = registered(&drawings, true).expect("they differ");
        let [from_middle, missed]: [Vec<Point>; 2] = [
            from.iter().map(|p| p - Point::new(120.0, 120.0)).collect(),
            from.iter().zip(&to).map(|(a, b)| b - a - Point::from(shift)).collect(),
        ];
        // A line says where it is across itself, and only where two cross also along.
        let mut seen = 0;
        for (place, missed) in from_middle
            .iter()
            .zip(&missed)
            .filter(|(place, _)| place.abs().sum() < 10.5)
        {
            let across: &[usize] = match (place.x.abs() < 1.0, place.y.abs() < 1.0) {
                (true, true) => &[0, 1],
                (true, false) => &[0],
                (false, _) => &[1],
            };
            assert!(
                across.iter().all(|k| missed[*k].abs() < 0.5),
                "{place} misses {missed} for {shift:?}"
            );
            seen += 1;
        }
        assert_eq!(seen, 5);
    }
}

#[test]
fn what_is_alike_or_not_wanted_or_another_thing_stays_on_the_mesh() {
    let own = drawing([120.0, 120.0]);
    assert!(registered(&[Arc::clone(&own), Arc::clone(&own)], true).is_none());
    assert!(registered(&[Arc::clone(&own), drawing([123.0, 120.0])], false).is_none());
    // A cross elsewhere is another cross: nothing is pulled half across the drawing.
    if let Some([from, to]) = registered(&[own, drawing([70.0, 70.0])], true) {
        let farthest = from.iter().zip(&to).map(|(a, b)| (b - a).norm()).fold(0.0, f64::max);
        assert!(farthest < 20.0, "{farthest}");
    }
}

#[test]
fn no_triangle_turns_over_at_any_weights_between() {
    let drawings = [drawing([120.0, 120.0]), drawing([126.0, 116.0])];
    let [from, to] = registered(&drawings, true).expect("they differ");
    let (triangles, positions) = mesh();
    let (fine, _) = subdivided(&triangles, positions.len(), 4);
    for share in [0.25, 0.5, 1.0] {
        let between: Vec<Point> = from.iter().zip(&to).map(|(a, b)| a + (b - a) * share).collect();
        for triangle in &fine {
            let area = |at: &[Point]| geometry::signed_area(geometry::corners(at, *triangle));
            assert!(area(&between) > 0.2 * area(&from));
        }
    }
}
