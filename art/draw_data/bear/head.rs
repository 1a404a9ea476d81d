//! The head: ears, face, and what it feels.

use kurbo::{Affine, BezPath, Point, Vec2};

use super::attitude::Attitude;
use super::shapes::{curve, radial};
use super::{FUR, FUR_DARK, FUR_LIGHT, INK, LINE, Part};
use crate::curves::{at, grown, smooth_closed};
use crate::svg::{Gradient, GradientShape, Group, Look};

const MUZZLE: &str = "#f8e0bb";
const MUZZLE_DARK: &str = "#e2b585";
const EAR: &str = "#d98b76";
const CHEEK: &str = "#f0705f";
const MOUTH: &str = "#8c2b33";
const TONGUE: &str = "#ef7f80";
const WHITE: &str = "#fffaf0";

/// From the neck to the middle of the head.
const NECK: f64 = 84.0;
/// The outline without ears, clockwise from the top.
const SKULL: [(f64, f64); 10] = [
    (0.0, -97.0),
    (60.0, -85.0),
    (100.0, -44.0),
    (117.0, 14.0),
    (98.0, 66.0),
    (0.0, 99.0),
    (-98.0, 66.0),
    (-117.0, 14.0),
    (-100.0, -44.0),
    (-60.0, -85.0),
];
const EAR_RADIUS: f64 = 36.0;

/// The head, placed.
struct Head {
    frame: Affine,
    /// Where the face is on the ball of the head.
    look: Vec2,
    eyes: f64,
    mouth: f64,
}

impl Head {
    fn place(&self, x: f64, y: f64) -> Point {
        self.frame * at(x, y)
    }

    /// A point of the face; what stands out more moves further as the head turns.
    fn face(&self, x: f64, y: f64, out: f64) -> Point {
        self.frame * (at(x, y) + self.look * out)
    }

    fn ear(&self, sign: f64) -> Point {
        self.frame * (at(sign * 84.0, -78.0) - self.look * 0.25)
    }

    fn oval(&self, middle: Point, width: f64, height: f64) -> BezPath {
        let origin = self.place(0.0, 0.0);
        super::shapes::ellipse(
            middle,
            self.place(width, 0.0) - origin,
            self.place(0.0, height) - origin,
        )
    }
}

pub(super) fn draw(attitude: &Attitude, neck: Point) -> Part {
    let tilt = Affine::rotate(attitude.tilt_deg.to_radians());
    let head = Head {
        frame: Affine::translate(neck.to_vec2()) * tilt * Affine::translate((0.0, attitude.nod - NECK)),
        look: attitude.look,
        eyes: attitude.eyes,
        mouth: attitude.mouth,
    };
    let mut group = Group::new("head");
    let mut landmarks = Vec::new();
    draw_ears(&mut group, &mut landmarks, &head);
    draw_skull(&mut group, &mut landmarks, &head);
    draw_eyes(&mut group, &mut landmarks, &head);
    draw_muzzle(&mut group, &mut landmarks, &head);
    Part { group, landmarks }
}

fn draw_ears(group: &mut Group, landmarks: &mut Vec<(String, Point)>, head: &Head) {
    for (side, sign) in [("left", -1.0), ("right", 1.0)] {
        let middle = head.ear(sign);
        let ear = head.oval(middle, EAR_RADIUS, EAR_RADIUS);
        group.path(format!("ear-{side}"), Look::filled(FUR).lined(INK, LINE), ear);
        let shade = format!("ear-shade-{side}");
        group.gradient(radial(&shade, middle, 21.0, &[FUR_DARK, EAR]));
        let inside = head.oval(middle, 20.0, 21.0);
        group.path(format!("ear-{side}-inside"), Look::shaded(&shade), inside);
        let out = head.place(sign * 0.71, -0.71) - head.place(0.0, 0.0);
        landmarks.push((format!("{side}_ear_tip"), middle + out * (EAR_RADIUS + 0.5 * LINE)));
        landmarks.push((format!("{side}_ear"), middle));
    }
}

fn draw_skull(group: &mut Group, landmarks: &mut Vec<(String, Point)>, head: &Head) {
    let ring: Vec<Point> = SKULL.iter().map(|&(x, y)| head.place(x, y)).collect();
    let light = head.face(-10.0, -30.0, 0.8);
    group.gradient(radial("fur", light, 120.0, &[FUR_LIGHT, FUR_LIGHT, FUR]));
    group.path("skull", Look::shaded("fur").lined(INK, LINE), smooth_closed(&ring));
    for (k, (x, length)) in [(-11.0, 16.0), (1.0, 23.0), (13.0, 15.0)].into_iter().enumerate() {
        let tuft = [(x, -88.0), (x, -84.0), (0.8 * x, -80.0), (0.6 * x, -88.0 + length)];
        let tuft = curve(tuft.map(|(x, y)| head.place(x, y)));
        group.path(format!("tuft{}", k + 1), Look::line(FUR_DARK, 5.0), tuft);
    }
    for (side, sign) in [("left", -1.0), ("right", 1.0)] {
        let middle = head.face(sign * 74.0, 26.0, 0.5);
        let blush = format!("blush-{side}");
        group.gradient(Gradient {
            id: blush.clone(),
            shape: GradientShape::Radial(middle, 22.0),
            stops: vec![(0.0, CHEEK, 0.75), (1.0, CHEEK, 0.0)],
        });
        group.path(
            format!("cheek-{side}"),
            Look::shaded(&blush),
            head.oval(middle, 22.0, 22.0),
        );
        landmarks.push((format!("{side}_cheek"), middle));
    }
    let outer = grown(&ring, 0.5 * LINE);
    for (name, k) in [("crown", 0), ("right_side", 3), ("left_side", 7)] {
        landmarks.push((name.to_owned(), outer[k]));
    }
}

fn draw_eyes(group: &mut Group, landmarks: &mut Vec<(String, Point)>, head: &Head) {
    let mix = |closed: f64, open: f64| closed + (open - closed) * head.eyes;
    for (side, sign) in [("left", -1.0), ("right", 1.0)] {
        let (x, y) = (sign * 43.0, -14.0);
        // Closed, an arch that is thickest in its middle.
        let ring: Vec<Point> = [
            (1.0, 0.0, 0.32),
            (0.7, 0.7, 0.02),
            (0.0, 1.0, -0.26),
            (-0.7, 0.7, 0.02),
            (-1.0, 0.0, 0.32),
            (-0.75, -0.7, -0.24),
            (0.0, -1.0, -0.62),
            (0.75, -0.7, -0.24),
        ]
        .map(|(across, open, closed)| head.face(x + mix(17.0, 10.5) * across, y + mix(18.0 * closed, 14.0 * open), 0.8))
        .to_vec();
        group.path(
            format!("eye-{side}"),
            Look::filled(INK).lined(INK, 2.0),
            smooth_closed(&ring),
        );
        if head.eyes > 0.0 {
            let light = head.oval(head.face(x - 3.0, y - 5.0, 0.8), 3.6, 4.2);
            group.path(format!("eye-{side}-light"), Look::filled(WHITE), light);
        }
        let brow = [
            (sign * 60.0, -42.0),
            (sign * 52.0, -51.0),
            (sign * 40.0, -52.0),
            (sign * 30.0, -47.0),
        ];
        let lift = -5.0 * head.mouth;
        let brow = curve(brow.map(|(x, y)| head.face(x, y + lift, 0.7)));
        group.path(format!("brow-{side}"), Look::line(FUR_DARK, 7.0), brow);
        landmarks.push((format!("{side}_eye"), head.face(x, y, 0.8)));
        landmarks.push((format!("{side}_brow"), head.face(sign * 46.0, -50.0 + lift, 0.7)));
    }
}

fn draw_muzzle(group: &mut Group, landmarks: &mut Vec<(String, Point)>, head: &Head) {
    let open = head.mouth;
    let middle = head.face(0.0, 38.0 + 3.0 * open, 1.0);
    group.gradient(radial(
        "muzzle-light",
        head.face(0.0, 26.0, 1.0),
        56.0,
        &[MUZZLE, MUZZLE, MUZZLE_DARK],
    ));
    group.path(
        "muzzle",
        Look::shaded("muzzle-light"),
        head.oval(middle, 52.0, 37.0 + 4.0 * open),
    );
    // The lips meet in the middle below the nose; the lower one falls.
    let lips = |down: f64| {
        [
            (-26.0, 44.0),
            (-13.0, 53.0 + 0.6 * down),
            (0.0, 48.0 + down),
            (13.0, 53.0 + 0.6 * down),
            (26.0, 44.0),
        ]
        .map(|(x, y)| head.face(x, y, 1.1))
    };
    let upper = lips(0.0);
    let lower = lips(4.0 + 20.0 * open);
    let mut mouth = BezPath::new();
    mouth.move_to(upper[0]);
    mouth.quad_to(upper[1], upper[2]);
    mouth.quad_to(upper[3], upper[4]);
    mouth.quad_to(lower[3], lower[2]);
    mouth.quad_to(lower[1], lower[0]);
    mouth.close_path();
    group.path("mouth", Look::filled(MOUTH).lined(INK, 4.0), mouth);
    if open > 0.4 {
        let tongue = head.oval(head.face(0.0, 47.0 + 15.0 * open, 1.1), 9.0, 5.0 * open);
        group.path("tongue", Look::filled(TONGUE), tongue);
    }
    let groove = [(0.0, 28.0), (0.0, 36.0), (0.0, 42.0), (0.0, 48.0)];
    group.path(
        "groove",
        Look::line(INK, 3.5),
        curve(groove.map(|(x, y)| head.face(x, y, 1.15))),
    );
    let nose = [
        (0.0, 8.0),
        (17.0, 10.0),
        (20.0, 18.0),
        (9.0, 29.0),
        (0.0, 32.0),
        (-9.0, 29.0),
        (-20.0, 18.0),
        (-17.0, 10.0),
    ];
    let nose = nose.map(|(x, y)| head.face(x, y, 1.25));
    group.gradient(radial(
        "nose-light",
        head.face(-5.0, 12.0, 1.25),
        22.0,
        &["#6b4a44", INK],
    ));
    group.path("nose", Look::shaded("nose-light").lined(INK, 3.0), smooth_closed(&nose));
    landmarks.push(("nose".to_owned(), head.face(0.0, 18.0, 1.25)));
    landmarks.push(("muzzle_left".to_owned(), head.face(-34.0, 44.0, 1.1)));
    landmarks.push(("muzzle_right".to_owned(), head.face(34.0, 44.0, 1.1)));
    landmarks.push(("chin".to_owned(), head.face(0.0, 66.0 + 10.0 * open, 1.0)));
}
