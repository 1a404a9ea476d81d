//! A figure with an arm in front of its chest, beside the same figure with the arm stretched out.

use inbetween::animation::Animation;
use inbetween::input::BitmapOptions;
use inbetween::math::Point;
use inbetween::mesh::PointLocator;
use inbetween::pipeline::LandmarkSpec;
use inbetween::pipeline::{OverlapSearch, map_layer};
use inbetween::pose::Mapping;
use inbetween::{Character, CharacterSpec, Drawing, LayerSpec, PoseSpec, read_pixels};

pub(crate) const SIZE: [usize; 2] = [360, 360];
/// Half the width of the lines, in pixels.
const LINE: f64 = 2.0;

const INK: [u8; 3] = [30, 25, 40];
const SKIN: [u8; 3] = [240, 200, 170];
pub(crate) const SHIRT: [u8; 3] = [60, 110, 200];
pub(crate) const SLEEVE: [u8; 3] = [200, 60, 50];
const HAND: [u8; 3] = [250, 210, 60];
const TROUSERS: [u8; 3] = [70, 120, 70];
const WHITE: [u8; 3] = [250, 250, 250];

/// A capsule: how far a point is outside.
fn capsule(p: Point, a: Point, b: Point, radius: f64) -> f64 {
    let along = ((p - a).dot(&(b - a)) / (b - a).norm_squared().max(1e-9)).clamp(0.0, 1.0);
    (p - a - (b - a) * along).norm() - radius
}

/// Half the width of an arm, in pixels.
const ARM: f64 = 11.0;

/// The joints of an arm: shoulder, elbow, hand.
pub(crate) type Arm = [Point; 3];

const SHOULDER: [f64; 2] = [200.0, 144.0];

pub(crate) fn stretched() -> Arm {
    [SHOULDER, [258.0, 122.0], [316.0, 96.0]].map(Point::from)
}

pub(crate) fn across() -> Arm {
    [SHOULDER, [156.0, 186.0], [112.0, 228.0]].map(Point::from)
}

/// The figure with its right arm as said.
fn figure(arm: Arm) -> Drawing {
    read_pixels(SIZE, &pixels(arm), &BitmapOptions::default()).expect("a figure")
}

/// Its pixels: red, green, blue, alpha.
pub(crate) fn pixels(arm: Arm) -> Vec<u8> {
    let at = |x: f64, y: f64| Point::new(x, y);
    let mut pixels = vec![0; SIZE[0] * SIZE[1] * 4];
    for (k, pixel) in pixels.chunks_exact_mut(4).enumerate() {
        let p = at((k % SIZE[0]) as f64 + 0.5, (k / SIZE[0]) as f64 + 0.5);
        let mut paint = |distance: f64, fill: [u8; 3]| {
            if distance < LINE {
                let colour = if distance > -LINE { INK } else { fill };
                pixel[..3].copy_from_slice(&colour);
                pixel[3] = 255;
            }
        };
        let mark = |distance: f64| distance - LINE;
        // From back to front: legs, the other arm, body, head, this arm.
        for x in [124.0, 176.0] {
            paint(
                capsule(p, at(150.0 + 0.4 * (x - 150.0), 240.0), at(x, 330.0), 17.0),
                TROUSERS,
            );
        }
        paint(capsule(p, at(114.0, 142.0), at(70.0, 190.0), 14.0), SLEEVE);
        paint(capsule(p, at(60.0, 200.0), at(60.0, 200.0), 15.0), HAND);
        let body = (p - at(150.0, 180.0)).abs() - at(30.0, 52.0);
        let body = body.sup(&Point::zeros()).norm() + body.x.max(body.y).min(0.0) - 14.0;
        paint(body, SHIRT);
        let stripe = (p.y - 150.0).abs() - 5.0;
        if body < -LINE && stripe < 0.0 {
            pixel[..3].copy_from_slice(&WHITE);
        }
        let mut paint = |distance: f64, fill: [u8; 3]| {
            if distance < LINE {
                let colour = if distance > -LINE { INK } else { fill };
                pixel[..3].copy_from_slice(&colour);
                pixel[3] = 255;
            }
        };
        for y in [205.0, 222.0] {
            paint(mark((p - at(150.0, y)).norm() - 3.0), INK);
        }
        paint((p - at(150.0, 70.0)).norm() - 48.0, SKIN);
        for x in [132.0, 170.0] {
            paint(mark((p - at(x, 62.0)).norm() - 5.0), INK);
        }
        paint(mark(capsule(p, at(138.0, 92.0), at(164.0, 90.0), 1.0)), INK);
        let [shoulder, elbow, hand] = arm;
        let sleeve = capsule(p, shoulder, elbow, ARM).min(capsule(p, elbow, hand, ARM));
        paint(sleeve, SLEEVE);
        let cuff = capsule(
            p,
            elbow + (hand - elbow) * 0.35,
            elbow + (hand - elbow) * 0.5,
            ARM - LINE,
        );
        if sleeve < -LINE && cuff < 0.0 && capsule(p, elbow, elbow, ARM + 4.0) > 0.0 {
            pixel[..3].copy_from_slice(&WHITE);
        }
        let mut paint = |distance: f64, fill: [u8; 3]| {
            if distance < LINE {
                let colour = if distance > -LINE { INK } else { fill };
                pixel[..3].copy_from_slice(&colour);
                pixel[3] = 255;
            }
        };
        paint(mark((p - elbow).norm() - 5.0), WHITE);
        paint(capsule(p, hand, hand, 16.0), HAND);
    }
    pixels
}

pub(crate) fn layer() -> LayerSpec {
    let poses = vec![
        PoseSpec::drawn("stretched", figure(stretched())),
        PoseSpec::drawn("across", figure(across())),
    ];
    LayerSpec::new("figure", poses)
}

fn mapped(layer: &LayerSpec) -> Mapping {
    let (mapping, _) = map_layer(layer).expect("a mapping");
    mapping.check().expect("a valid mapping");
    mapping
}

/// Where the mesh takes a place of the first pose in the second.
fn carried(mapping: &Mapping, place: Point) -> Point {
    let triangles = mapping.poses.topology().triangles();
    let positions = mapping.poses.positions();
    let bound = PointLocator::new(triangles, &positions[0]).bind(place).expect("a mesh");
    bound.at(&positions[1])
}

#[test]
fn an_arm_in_front_of_the_chest_is_found_and_lies_in_front() {
    let mapping = mapped(&layer());
    let diagonal = mapping.outlines[1].diagonal();
    assert_eq!(
        mapping
            .overlaps
            .poses
            .iter()
            .map(|known| known.pose)
            .collect::<Vec<_>>(),
        [1]
    );
    for (from, to) in stretched().into_iter().zip(across()).skip(1) {
        let off = (carried(&mapping, from) - to).norm() / diagonal;
        assert!(off < 0.03, "{from} -> {} instead of {to}", carried(&mapping, from));
    }
    // What does not move stays.
    for place in [[150.0, 70.0], [60.0, 200.0], [124.0, 320.0], [150.0, 222.0]].map(Point::from) {
        let off = (carried(&mapping, place) - place).norm() / diagonal;
        assert!(off < 0.01, "{place} -> {}", carried(&mapping, place));
    }
    let depth = mapping.overlaps.depth(1).expect("depths");
    let triangles = mapping.poses.topology().triangles();
    let at = |pose: usize, place: Point| -> Vec<usize> {
        let positions = &mapping.poses.positions()[pose];
        let holds = |t: &usize| {
            let corners = triangles[*t].map(|v| positions[v]);
            inbetween::mesh::geometry::barycentric(corners, place).is_some_and(|b| b.iter().all(|b| *b >= 0.0))
        };
        (0..triangles.len()).filter(holds).collect()
    };
    let elbow = at(0, stretched()[1]);
    let there = at(1, across()[1]);
    assert!(there.len() > 1, "elbow and chest");
    let nearest = there
        .iter()
        .max_by(|a, b| depth[**a].total_cmp(&depth[**b]))
        .expect("a triangle");
    let limb = |t: usize| mapping.overlaps.triangle_limb[t];
    assert!(
        limb(elbow[0]).is_some() && limb(*nearest) == limb(elbow[0]),
        "{:?}",
        limb(*nearest)
    );
    // And all of it comes back from its file.
    assert_eq!(
        Mapping::from_json(&mapping.to_json()).expect("a file").overlaps,
        mapping.overlaps
    );
}

#[test]
fn landmarks_lie_on_the_outline_of_one_drawing_and_inside_another() {
    // The tip of a hand and the middle of its arm, each at the edge of the sleeve or the hand that is seen in both.
    let marks = |[_, elbow, hand]: Arm| {
        let along = (hand - elbow).normalize();
        let across = Point::new(along.y, -along.x);
        [hand + along * 16.0, elbow + (hand - elbow) * 0.2 + across * ARM]
    };
    let mut marked = layer();
    for (k, (from, to)) in marks(stretched()).into_iter().zip(marks(across())).enumerate() {
        let at = vec![Some(from), Some(to)];
        marked.landmarks.push(LandmarkSpec::new(format!("mark {k}"), at));
    }
    let (mapping, report) = map_layer(&marked).expect("a mapping");
    mapping.check().expect("a valid mapping");
    assert_eq!(mapping.overlaps.poses.len(), 1);
    let diagonal = mapping.outlines[1].diagonal();
    for (landmark, to) in report.landmarks.iter().zip(marks(across())) {
        assert_eq!(landmark.given, [true, true]);
        let off = (landmark.at[1][0] - to).norm() / diagonal;
        assert!(off < 2e-3, "{} at {} instead of {to}", landmark.name, landmark.at[1][0]);
    }
}

#[test]
fn frames_are_painted_from_back_to_front_and_show_what_was_hidden() {
    let places = vec![vec![0.0, 0.0], vec![1.0, 0.0]];
    let animation = Animation::visiting(places.iter().map(Vec::as_slice), true).expect("an animation");
    let mut spec = CharacterSpec::new(vec![layer()]).with_places(places);
    spec.camera = inbetween::pipeline::CameraRule::Drawing;
    let character = Character::new(&spec, &animation, SIZE).expect("a character");
    let colour = |weights: [f64; 2], place: Point| {
        let posed = character.posed_of(&weights).expect("a place");
        let frame = character.paint(&posed);
        let p = character.camera().to_pixels(place);
        frame.pixels[p.y as usize * frame.width + p.x as usize]
    };
    let is_near = |found: [u8; 4], wanted: [u8; 3]| found.iter().zip(wanted).all(|(a, b)| a.abs_diff(b) < 40);
    let [_, elbow, hand] = across();
    let chest = elbow + (hand - elbow) * 0.2;
    assert!(
        is_near(colour([0.0, 1.0], chest), SLEEVE),
        "{:?}",
        colour([0.0, 1.0], chest)
    );
    assert!(
        is_near(colour([1.0, 0.0], chest), SHIRT),
        "{:?}",
        colour([1.0, 0.0], chest)
    );
    assert!(is_near(colour([1.0, 0.0], stretched()[2]), HAND));
    // Half-way the arm is elsewhere: the chest is whole, though half of the drawings hide it.
    assert!(
        is_near(colour([0.5, 0.5], elbow), SHIRT),
        "{:?}",
        colour([0.5, 0.5], elbow)
    );
}

#[test]
fn nothing_is_sought_where_that_is_not_wanted_or_all_drawings_are_open() {
    let mut layer = layer();
    layer.overlaps = OverlapSearch::Refuse;
    assert!(mapped(&layer).overlaps.is_empty());
    let raised = [SHOULDER, [250.0, 106.0], [300.0, 68.0]].map(Point::from);
    let open = vec![
        PoseSpec::drawn("stretched", figure(stretched())),
        PoseSpec::drawn("raised", figure(raised)),
    ];
    assert!(mapped(&LayerSpec::new("figure", open)).overlaps.is_empty());
}
