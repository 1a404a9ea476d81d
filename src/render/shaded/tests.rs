use proptest::prelude::*;

use super::light::Surface;
use super::*;

const PLAIN: Look = Look {
    colour: [200, 120, 80],
    surface: Surface::Even,
};

/// A square facing the eye, from -1 to 1, at a height, with its own texture places.
fn square(z: f64) -> Vec<Point3> {
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        .map(|[x, y]| Point3::new(x, y, z))
        .to_vec()
}

const SQUARE: [[usize; 3]; 2] = [[0, 1, 2], [0, 2, 3]];
const PLACES: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

fn mesh<'a>(triangles: &'a [[usize; 3]]) -> ShadedMesh<'a> {
    ShadedMesh {
        triangles,
        texture_places: &PLACES,
        texture_triangles: triangles,
    }
}

fn drawn(mesh: &ShadedMesh<'_>, positions: &[Point3], texture: Option<&Frame>, size: [usize; 2]) -> Frame {
    let view = View::new(0.0, 0.0);
    let window = Window::around(view.bounds(positions).expect("points"), size);
    let normals = vec![Point3::z(); positions.len()];
    let form = ShadedForm {
        positions,
        normals: &normals,
        texture,
    };
    shade(mesh, &form, &view, &window, &PLAIN)
}

#[test]
fn a_square_covers_its_pixels_wholly_and_leaves_a_margin() {
    let frame = drawn(&mesh(&SQUARE), &square(0.0), None, [100, 60]);
    let alpha = |x: usize, y: usize| frame.pixels[y * 100 + x][3];
    // 60 pixels less 6 in a hundred on each side.
    assert_eq!(
        (alpha(50, 30), alpha(50, 4), alpha(50, 55), alpha(25, 30), alpha(75, 30)),
        (255, 255, 255, 255, 255)
    );
    assert_eq!(
        (alpha(50, 2), alpha(50, 57), alpha(22, 30), alpha(77, 30)),
        (0, 0, 0, 0)
    );
    let opaque = frame.pixels.iter().filter(|p| p[3] == 255).count();
    assert!((51 * 51..=53 * 53).contains(&opaque), "{opaque}");
    // An even normal is lit evenly.
    assert!(
        frame
            .pixels
            .iter()
            .filter(|p| p[3] == 255)
            .all(|p| *p == frame.pixels[30 * 100 + 50])
    );
}

#[test]
fn what_is_nearer_hides_what_is_farther_in_any_order() {
    let mut positions = square(0.0);
    positions.extend(square(1.0).iter().map(|p| Point3::new(0.5 * p.x, 0.5 * p.y, p.z)));
    let (near, far) = ([[4, 5, 6], [4, 6, 7]], SQUARE);
    let places = raster_places(&positions);
    for triangles in [[near, far].concat(), [far, near].concat()] {
        let buffer = raster::nearest(&triangles, &places, 40, 0..40);
        let seen = |x: usize, y: usize| triangles[buffer.at(x, y).expect("covered").triangle][0];
        assert_eq!((seen(20, 20), seen(3, 3)), (4, 0));
    }
}

/// From -1..1 to 0..40, y down.
fn raster_places(positions: &[Point3]) -> Vec<Point3> {
    positions
        .iter()
        .map(|p| Point3::new(20.0 + 20.0 * p.x, 20.0 - 20.0 * p.y, p.z))
        .collect()
}

#[test]
fn a_texture_stands_upright() {
    // Red above, blue below.
    let texture = Frame {
        width: 2,
        height: 2,
        pixels: vec![[255, 0, 0, 255], [255, 0, 0, 255], [0, 0, 255, 255], [0, 0, 255, 255]],
    };
    let frame = drawn(&mesh(&SQUARE), &square(0.0), Some(&texture), [60, 60]);
    let [top, bottom] = [10, 49].map(|y| frame.pixels[y * 60 + 30]);
    assert!(top[0] > top[2] + 50 && bottom[2] > bottom[0] + 50, "{top:?} {bottom:?}");
}

#[test]
fn light_comes_from_the_upper_left_and_both_sides_are_lit() {
    let light = |normal: Point3| PLAIN.light([0.5; 3], normal, [0, 0])[1];
    assert!(light(Point3::new(-0.5, 0.5, 0.7)) > 1.5 * light(Point3::new(0.5, -0.5, 0.7)));
    let normal = Point3::new(-0.3, 0.2, 0.9);
    assert_eq!(light(normal), light(-normal));
    assert!(light(Point3::zeros()).is_finite());
    // Nothing is whiter than white.
    for k in 0..1000 {
        let (a, b) = (f64::from(k), f64::from(k * k % 997));
        let n = Point3::new(a.sin(), b.cos(), (a * b).sin());
        let found = PLAIN.light([1.0; 3], n, [0, 0]);
        assert!(found.iter().all(|c| (0.0..=1.0).contains(c)), "{found:?}");
    }
}

#[test]
fn a_view_turns_the_front_to_the_right_and_looks_from_above() {
    let seen = View::new(90.0, 0.0).turned(Point3::z());
    assert!((seen - Point3::x()).norm() < 1e-15);
    let seen = View::new(0.0, 90.0).turned(Point3::y());
    assert!((seen - Point3::z()).norm() < 1e-15);
}

#[test]
fn nonsense_is_survived() {
    let wild = [
        Point3::new(f64::NAN, 0.0, 0.0),
        Point3::new(1e300, -1e300, 0.0),
        Point3::new(0.0, f64::INFINITY, 0.0),
        Point3::new(1.0, 1.0, 0.0),
    ];
    for triangles in [vec![[0, 1, 2]], vec![[1, 3, 9]], vec![[3, 3, 3]], vec![[1, 3, 2]]] {
        let frame = drawn(&mesh(&triangles), &wild, None, [10, 10]);
        assert_eq!(frame.pixels.len(), 100);
    }
    let empty = Frame::filled(0, 0, [0; 4]);
    drawn(&mesh(&SQUARE), &square(0.0), Some(&empty), [8, 8]);
}

#[test]
fn a_sheet_needs_a_form_for_each_cell_and_shows_its_kinds() {
    let positions = square(0.0);
    let normals = vec![Point3::z(); 4];
    let cell = |kind: CellKind| SheetCell {
        form: ShadedForm {
            positions: &positions,
            normals: &normals,
            texture: None,
        },
        kind,
        caption: "a very long name that no card has the room for, whatever it is",
    };
    let axis = |name: &str, values: &[f64]| SheetAxis {
        name: name.to_owned(),
        values: values.to_vec(),
    };
    let mut sheet = Sheet {
        title: "a form",
        subtitle: "",
        across: axis("bend", &[0.0, 0.5]),
        up: Some(axis("thickness", &[0.0, 1.0])),
        mesh: mesh(&SQUARE),
        cells: vec![
            cell(CellKind::Example),
            cell(CellKind::PseudoExample),
            cell(CellKind::Between),
            cell(CellKind::Beyond),
        ],
        view: View::new(0.0, 0.0),
        size: Some([700, 640]),
    };
    let frame = sheet.draw().expect("a sheet");
    assert_eq!((frame.width, frame.height), (700, 640));
    // Opaque, and the first form is darker than the last.
    assert!(frame.pixels.iter().all(|p| p[3] == 255));
    let brightness = |x: usize, y: usize| {
        frame.pixels[y * 700 + x][..3]
            .iter()
            .map(|c| u32::from(*c))
            .sum::<u32>()
    };
    let (low, high) = ((240, 430), (540, 200));
    assert!(brightness(low.0, low.1) + 60 < brightness(high.0, high.1));
    sheet.cells.pop();
    assert!(sheet.draw().is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn shares_are_those_of_the_point(corners in prop::array::uniform3(prop::array::uniform3(0.0..12.0f64))) {
        let places = corners.map(Point3::from);
        let buffer = raster::nearest(&[[0, 1, 2]], &places, 12, 0..12);
        let lower = raster::nearest(&[[0, 1, 2]], &places, 12, 5..12);
        let mut covered: f64 = 0.0;
        for y in 0..12 {
            for x in 0..12 {
                prop_assert!(y < 5 || buffer.at(x, y) == lower.at(x, y));
                let Some(hit) = buffer.at(x, y) else { continue };
                covered += 1.0;
                let point = mixed(places, hit.shares);
                prop_assert!((point.x - x as f64 - 0.5).abs() < 1e-6 && (point.y - y as f64 - 0.5).abs() < 1e-6);
            }
        }
        let (a, b) = (places[1] - places[0], places[2] - places[0]);
        let area = 0.5 * (a.x * b.y - a.y * b.x).abs();
        // As many samples as its area, but for those that its edges cut.
        prop_assert!((covered - area).abs() <= 30.0, "{covered} {area}");
    }
}
