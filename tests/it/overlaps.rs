//! A figure with an arm in front of its chest, beside the same figure with the arm stretched out.

use inbetween::animation::Animation;
use inbetween::input::BitmapOptions;
use inbetween::math::Point;
use inbetween::mesh::PointLocator;
use inbetween::pipeline::{LandmarkSpec, LimbSpec, OverlapSearch, map_layer};
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

/// Of the triangles of the second pose that hold a place the nearest one, and how many there are.
fn nearest(mapping: &Mapping, place: Point) -> (usize, usize) {
    let depth = mapping.overlaps.depth(1).expect("depths");
    let there = triangles_at(mapping, 1, place);
    let nearest = there.iter().max_by(|a, b| depth[**a].total_cmp(&depth[**b]));
    (*nearest.expect("a triangle"), there.len())
}

/// The triangles of a pose that hold a place.
fn triangles_at(mapping: &Mapping, pose: usize, place: Point) -> Vec<usize> {
    let triangles = mapping.poses.topology().triangles();
    let positions = &mapping.poses.positions()[pose];
    let holds = |t: &usize| {
        let corners = triangles[*t].map(|v| positions[v]);
        inbetween::mesh::geometry::barycentric(corners, place).is_some_and(|b| b.iter().all(|b| *b >= 0.0))
    };
    (0..triangles.len()).filter(holds).collect()
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
    let elbow = triangles_at(&mapping, 0, stretched()[1]);
    let (nearest, count) = nearest(&mapping, across()[1]);
    assert!(count > 1, "elbow and chest");
    let limb = |t: usize| mapping.overlaps.triangle_limb[t];
    assert!(
        limb(elbow[0]).is_some() && limb(nearest) == limb(elbow[0]),
        "{:?}",
        limb(nearest)
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

/// The layer with its arm named by its hand, and where it begins.
fn with_named_arm(cut: Option<Vec<Point>>) -> LayerSpec {
    let mut named = layer();
    let mut arm = LimbSpec::new("arm", vec![Some(stretched()[2]), Some(across()[2])]);
    arm.cut[0] = cut;
    named.limbs.push(arm);
    named
}

#[test]
fn a_limb_is_called_as_the_artist_names_it_and_lies_where_its_order_says() {
    let is_arm = |mapping: &Mapping, t: usize| {
        let limb = mapping.overlaps.triangle_limb[t];
        limb.is_some_and(|limb| mapping.overlaps.limbs[limb].starts_with("arm."))
    };
    let mut named = with_named_arm(None);
    let mapping = mapped(&named);
    assert!(is_arm(&mapping, nearest(&mapping, across()[1]).0));
    // The drawing shows it in front; the artist's word counts more.
    named.limb_orders = vec![Vec::new(), vec!["arm".to_owned(), LimbSpec::TRUNK.to_owned()]];
    let behind = mapped(&named);
    let (nearest, count) = nearest(&behind, across()[1]);
    assert!(count > 1 && !is_arm(&behind, nearest));
}

#[test]
fn a_limb_begins_at_its_cut() {
    let [_, elbow, hand] = stretched();
    let along = (hand - elbow).normalize();
    let aside = Point::new(-along.y, along.x) * 30.0;
    let mapping = mapped(&with_named_arm(Some(vec![elbow - aside, elbow + aside])));
    let triangles = mapping.poses.topology().triangles();
    let positions = &mapping.poses.positions()[0];
    let mut count = 0;
    for (t, limb) in mapping.overlaps.triangle_limb.iter().enumerate() {
        if limb.is_some_and(|limb| mapping.overlaps.limbs[limb].starts_with("arm.")) {
            let middle = triangles[t].iter().map(|v| positions[*v]).sum::<Point>() / 3.0;
            // About half a spacing of the search's lattice.
            assert!((middle - elbow).dot(&along) > -6.0, "{middle}");
            count += 1;
        }
    }
    assert!(count > 5, "{count} triangles");
}

#[test]
fn what_is_said_of_limbs_that_cannot_be_names_the_limb_and_the_remedy() {
    let refusal = |layer: &LayerSpec| map_layer(layer).expect_err("a refusal").to_string();
    let mut on_belly = with_named_arm(None);
    on_belly.limbs[0].at[0] = Some(Point::new(150.0, 190.0));
    let text = refusal(&on_belly);
    assert!(
        text.contains("part 'arm'") && text.contains("'stretched'") && text.contains("`cut`"),
        "{text}"
    );
    let mut unknown = with_named_arm(None);
    unknown.limb_orders = vec![Vec::new(), vec!["arm".to_owned(), "tail".to_owned()]];
    let text = refusal(&unknown);
    assert!(
        text.contains("'tail'") && text.contains("'across'") && text.contains("'arm'"),
        "{text}"
    );
    let mut hidden = with_named_arm(None);
    hidden.limbs[0].at[0] = None;
    let text = refusal(&hidden);
    assert!(text.contains("'stretched'") && text.contains("give it one"), "{text}");
    let mut refused = with_named_arm(None);
    refused.overlaps = OverlapSearch::Refuse;
    let text = refusal(&refused);
    assert!(text.contains("overlaps"), "{text}");
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
    // At the pose that lies over itself there is its drawing, at joints as elsewhere.
    let alone = character.paint(&character.posed_of(&[0.0, 1.0]).expect("a place"));
    let drawing = figure(across());
    // But for its edge, which is smooth.
    let both = alone.pixels.iter().zip(&drawing.picture.pixels);
    let inside: Vec<_> = both.filter(|(a, b)| a[3] == 255 && b[3] == 255).collect();
    let differs = |(a, b): &&(&[u8; 4], &[u8; 4])| a.iter().zip(b.iter()).any(|(a, b)| a.abs_diff(*b) > 16);
    let different = inside.iter().filter(differs).count();
    assert!(
        inside.len() > 25_000 && 200 * different < inside.len(),
        "{different} of {}",
        inside.len()
    );
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
