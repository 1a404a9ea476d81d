//! The face: four vector drawings of one head, calm or laughing, turned to the left or to the right.
//!
//! The features lie on a ball and are projected from it, so that turning foreshortens them as it should. Every drawing
//! is made by the same program from three numbers (turn, and how far eyes and mouth laugh): the elements, their names
//! and the number of their curves are equal in all four.

use std::error::Error;
use std::path::Path;

use kurbo::{BezPath, Point, Vec2};

use crate::curves::{at, brush, grown, smooth_closed, smooth_through};
use crate::scene::{self, Pose, Scene};
use crate::svg::Drawing;

const SIZE: f64 = 560.0;
/// Thickness of the ink line around the head.
const LINE: f64 = 6.5;
/// Thickness of ink lines inside it.
const FINE: f64 = 5.0;

const INK: &str = "#33202e";
const SKIN: &str = "#ffd0a6";
const SKIN_SHADE: &str = "#f2b089";
const CHEEK: &str = "#f89a83";
const FRECKLE: &str = "#d9694f";
const EAR_INSIDE: &str = "#e58d72";
const NOSE: &str = "#d9775c";
const HAIR: &str = "#d9542b";
const HAIR_DARK: &str = "#b23d22";
const HAIR_LIGHT: &str = "#f07a3f";
const WHITE: &str = "#fffdf6";
const IRIS: &str = "#3f8f6b";
const MOUTH: &str = "#7d2136";
const TEETH: &str = "#fffdf6";
const TONGUE: &str = "#f0717a";

const KEYS: &str = "\
# Round the square: turn, laugh, turn back laughing, calm down; every face is held for a moment.
keys = [
  { time = 0.0, at = [0.0, 0.0] },
  { time = 0.4, at = [0.0, 0.0] },
  { time = 0.9, at = [1.0, 0.0] },
  { time = 1.3, at = [1.0, 0.0] },
  { time = 1.65, at = [1.0, 1.0] },
  { time = 2.05, at = [1.0, 1.0] },
  { time = 2.55, at = [0.0, 1.0] },
  { time = 2.95, at = [0.0, 1.0] },
  { time = 3.4, at = [0.0, 0.0] },
]
";

/// One drawing of the head.
#[derive(Debug, Clone, Copy)]
struct Look {
    name: &'static str,
    /// Turn of the head to the picture's right, degrees.
    turn_deg: f64,
    /// 0 calm, 1 laughing.
    laugh: f64,
    /// Place in pose space.
    at: [f64; 2],
}

const LOOKS: [Look; 4] = [
    Look {
        name: "calm_left",
        turn_deg: -TURN_DEG,
        laugh: 0.0,
        at: [0.0, 0.0],
    },
    Look {
        name: "calm_right",
        turn_deg: TURN_DEG,
        laugh: 0.0,
        at: [1.0, 0.0],
    },
    Look {
        name: "laugh_left",
        turn_deg: -TURN_DEG,
        laugh: 1.0,
        at: [0.0, 1.0],
    },
    Look {
        name: "laugh_right",
        turn_deg: TURN_DEG,
        laugh: 1.0,
        at: [1.0, 1.0],
    },
];

/// Draws the four heads into `folder`.
pub(crate) fn draw(folder: &Path) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(folder)?;
    let mut poses = Vec::new();
    for look in LOOKS {
        let mut drawing = Drawing::new(SIZE, SIZE, &format!("face, {}", look.name));
        let head = Head::new(look);
        draw_head(&mut drawing, &head);
        drawing.save(&folder.join(format!("{}.svg", look.name)))?;
        let line = grown(&outline(&head), LINE);
        poses.push(Pose {
            name: look.name,
            file: format!("{}.svg", look.name),
            at: look.at,
            landmarks: landmarks(&head, &line),
        });
    }
    scene::save(
        folder,
        &Scene {
            element: Some("head"),
            poses,
            landmarks: &LANDMARKS,
            mesh: "",
            sharpness: 0.9,
            size_px: [480, 480],
            keys: KEYS,
        },
    )
}

/// What the hair does on the forehead and what eyes and mouth do when they open, which one mesh cannot guess.
const LANDMARKS: [&str; 12] = [
    "fringe_1",
    "fringe_3",
    "fringe_5",
    "fringe_7",
    "left_sideburn",
    "right_sideburn",
    "left_brow_outside",
    "left_eye_outside",
    "left_eye_bottom",
    "right_eye_bottom",
    "mouth_bottom",
    "right_mouth_corner",
];

/// The points of the head that are known: around its outline, then inside.
fn landmarks(head: &Head, line: &[Point]) -> Vec<(String, Point)> {
    let mut points: Vec<(String, Point)> = OUTLINE_LANDMARKS
        .iter()
        .map(|&(name, k)| (name.to_owned(), line[k]))
        .collect();
    let inside = grown(&outline(head), -UNDER_LINE);
    points.extend(RIM_LANDMARKS.map(|(name, k)| (name.to_owned(), inside[k])));
    let mut add = |name: String, across_deg: f64, down: f64| points.push((name, head.on_face(across_deg, down)));
    let corner = mouth_corner(head);
    for (side, sign) in [("left", -1.0), ("right", 1.0)] {
        // Around the eyes and the mouth, not along them: what opens and closes inside is not pulled about.
        add(format!("{side}_eye_inside"), 11.0 * sign, 4.0);
        add(format!("{side}_eye_outside"), 37.0 * sign, 4.0);
        add(format!("{side}_eye_outside_top"), 33.5 * sign, -20.0);
        add(format!("{side}_eye_outside_bottom"), 33.5 * sign, 28.0);
        add(format!("{side}_eye_top"), 24.0 * sign, -31.0);
        add(format!("{side}_eye_bottom"), 24.0 * sign, 38.0);
        let [inner, _, middle, outer] = brow(head, sign);
        add(format!("{side}_brow_inside"), inner.0, inner.1);
        add(format!("{side}_brow_middle"), middle.0, middle.1);
        add(format!("{side}_brow_outside"), outer.0, outer.1);
        add(format!("{side}_cheek"), 36.0 * sign, head.mix(70.0, 58.0));
        add(format!("{side}_mouth_corner"), (corner.0 + 4.0) * sign, corner.1);
    }
    add("mouth_top".to_owned(), 0.0, head.mix(86.0, 76.0));
    add("mouth_bottom".to_owned(), 0.0, head.mix(118.0, 154.0));
    for (name, k) in HAIRLINE_LANDMARKS {
        let (across_deg, down) = fringe(head)[k];
        add(name.to_owned(), across_deg, down);
    }
    points.push(("nose".to_owned(), nose_at(head, 0.0, 44.0)));
    points
}

/// The ball that the features lie on.
struct Head {
    turn_rad: f64,
    laugh: f64,
    middle: Point,
}

/// How far the head turns to either side.
const TURN_DEG: f64 = 16.0;
/// The ball's rim, degrees from the middle of the picture: nothing on the face goes round it.
const RIM_DEG: f64 = 71.0;
const BALL_WIDTH: f64 = 166.0;
const BALL_HEIGHT: f64 = 168.0;

impl Head {
    fn new(look: Look) -> Self {
        // A laughing head is thrown up a little.
        let middle = at(0.5 * SIZE, 302.0 - 8.0 * look.laugh);
        Self {
            turn_rad: look.turn_deg.to_radians(),
            laugh: look.laugh,
            middle,
        }
    }

    /// Between the calm and the laughing value.
    fn mix(&self, calm: f64, laughing: f64) -> f64 {
        calm + (laughing - calm) * self.laugh
    }

    /// -1 turned left, 1 turned right.
    fn turn(&self) -> f64 {
        self.turn_rad.sin() / TURN_DEG.to_radians().sin()
    }

    /// The point of the face at `across` (degrees from its middle) and `down` (pixels from the ball's equator).
    fn on_face(&self, across_deg: f64, down: f64) -> Point {
        let latitude_rad = (down / BALL_HEIGHT).clamp(-0.98, 0.98).asin();
        let rim_rad = RIM_DEG.to_radians();
        let longitude_rad = (across_deg.to_radians() + self.turn_rad).clamp(-rim_rad, rim_rad);
        let x = BALL_WIDTH * longitude_rad.sin() * latitude_rad.cos().powf(0.6);
        self.middle + Vec2::new(x, down)
    }

    /// A closed curve of the face.
    fn ring(&self, points: &[(f64, f64)]) -> Vec<Point> {
        points
            .iter()
            .map(|&(across_deg, down)| self.on_face(across_deg, down))
            .collect()
    }

    /// An ellipse of the face: its middle, and its radii in degrees across and pixels down.
    fn spot(&self, middle: (f64, f64), radii: (f64, f64)) -> BezPath {
        let points: Vec<(f64, f64)> = (0..8)
            .map(|k| {
                let (sin, cos) = (f64::from(k) * std::f64::consts::FRAC_PI_4).sin_cos();
                (middle.0 + radii.0 * cos, middle.1 + radii.1 * sin)
            })
            .collect();
        smooth_closed(&self.ring(&points))
    }

    /// A stroke on the face.
    fn stroke(&self, points: &[(f64, f64)], middle_width: f64, end_width: f64) -> BezPath {
        brush(&self.ring(points), middle_width, end_width)
    }
}

fn draw_head(drawing: &mut Drawing, head: &Head) {
    let outline = outline(head);
    drawing.fill("head", INK, smooth_closed(&grown(&outline, LINE)));
    drawing.fill("skin", SKIN, smooth_closed(&outline));
    drawing.fill("jaw-shade", SKIN_SHADE, jaw_shade(head, &outline));
    draw_ears(drawing, head);
    draw_cheeks(drawing, head);
    draw_eyes(drawing, head);
    draw_nose(drawing, head);
    draw_mouth(drawing, head);
    draw_hair(drawing, head, &outline);
    draw_brows(drawing, head);
}

/// The skin's and hair's outline, clockwise from the chin; the ink line lies outside it.
fn outline(head: &Head) -> Vec<Point> {
    let (turn, middle) = (head.turn(), head.middle);
    let jaw = head.mix(0.0, 16.0);
    let puff = head.mix(0.0, 5.0);
    // The chin follows the turn most, the skull the least; the ear that comes forward is the larger one.
    let lower = 26.0 * turn;
    let cheek = 1.0 * turn;
    let (left_ear, right_ear) = (1.0 + 0.22 * turn, 1.0 - 0.22 * turn);
    let ears = -16.0 * turn;
    let sway = -9.0 * turn;
    let points = [
        // Chin, left jaw, left cheek.
        (lower, 172.0 + jaw),
        (-52.0 + lower, 162.0 + 0.9 * jaw),
        (-126.0 + 0.45 * lower, 118.0 + 0.5 * jaw),
        (-146.0 - puff + cheek, 62.0),
        // Left ear.
        (-158.0 - 2.0 * left_ear + ears * 0.4, 50.0),
        (-176.0 - 8.0 * left_ear + ears * 0.4, 46.0),
        (-181.0 - 16.0 * left_ear + ears * 0.4, 12.0),
        (-176.0 - 8.0 * left_ear + ears * 0.4, -18.0),
        (-162.0 + ears * 0.3, -24.0),
        // Hair: left side, fringe bumps up to the tuft.
        (-170.0 + 0.5 * sway, -60.0),
        (-150.0 + sway, -118.0),
        (-100.0 + sway, -168.0),
        (-44.0 + sway, -190.0),
        // The tuft: two curls.
        (-22.0 + 1.4 * sway, -203.0),
        (-18.0 + 2.0 * sway, -232.0),
        (-2.0 + 2.6 * sway, -254.0),
        (16.0 + 2.6 * sway, -246.0),
        (18.0 + 2.2 * sway, -228.0),
        (30.0 + 2.2 * sway, -234.0),
        (50.0 + 2.4 * sway, -232.0),
        (56.0 + 2.0 * sway, -212.0),
        (50.0 + 1.4 * sway, -194.0),
        // Hair: right side.
        (104.0 + sway, -168.0),
        (152.0 + sway, -118.0),
        (170.0 + 0.5 * sway, -60.0),
        // Right ear.
        (162.0 + ears * 0.3, -24.0),
        (176.0 + 8.0 * right_ear + ears * 0.4, -18.0),
        (181.0 + 16.0 * right_ear + ears * 0.4, 12.0),
        (176.0 + 8.0 * right_ear + ears * 0.4, 46.0),
        (158.0 + 2.0 * right_ear + ears * 0.4, 50.0),
        // Right cheek, right jaw.
        (146.0 + puff + cheek, 62.0),
        (126.0 + 0.45 * lower, 118.0 + 0.5 * jaw),
        (52.0 + lower, 162.0 + 0.9 * jaw),
    ];
    points.map(|(x, y)| middle + Vec2::new(x, y)).to_vec()
}

/// Which points of the outline carry a landmark.
const OUTLINE_LANDMARKS: [(&str, usize); 15] = [
    ("chin", 0),
    ("left_jaw", 2),
    ("left_lobe", 4),
    ("left_ear", 6),
    ("left_ear_top", 8),
    ("left_hair", 10),
    ("left_tuft_root", 12),
    ("tuft", 15),
    ("tuft_notch", 17),
    ("right_tuft_root", 21),
    ("right_hair", 23),
    ("right_ear_top", 25),
    ("right_ear", 27),
    ("right_lobe", 29),
    ("right_jaw", 31),
];
/// Which points of the outline carry a second landmark, [`UNDER_LINE`] inside the ink: it keeps the line's thickness
/// where the hair behind it is stretched.
const RIM_LANDMARKS: [(&str, usize); 4] = [
    ("left_temple_inside", 9),
    ("left_hair_inside", 10),
    ("right_hair_inside", 23),
    ("right_temple_inside", 24),
];
const UNDER_LINE: f64 = 4.5;
/// Which points of the hairline carry a landmark, from the right to the left.
const HAIRLINE_LANDMARKS: [(&str, usize); 11] = [
    ("right_sideburn", 1),
    ("right_temple", 3),
    ("fringe_1", 4),
    ("fringe_2", 5),
    ("fringe_3", 6),
    ("fringe_4", 7),
    ("fringe_5", 8),
    ("fringe_6", 9),
    ("fringe_7", 10),
    ("left_temple", 11),
    ("left_sideburn", 13),
];
/// Where in the outline the hair begins (behind the left ear) and ends (behind the right one).
const HAIR_POINTS: std::ops::RangeInclusive<usize> = 8..=25;

/// A shadow along the right cheek, the jaw and under the chin; its outer edge is the outline itself.
fn jaw_shade(head: &Head, outline: &[Point]) -> BezPath {
    let last = outline.len() - 1;
    let edge = [
        outline[last - 2],
        outline[last - 1],
        outline[last],
        outline[0],
        outline[1],
    ];
    let mut path = BezPath::new();
    smooth_through(&mut path, &edge);
    let inwards = [0.0, 0.13, 0.16, 0.09, 0.0];
    let inner: Vec<Point> = edge
        .iter()
        .zip(inwards)
        .rev()
        .map(|(point, share)| point.lerp(head.middle, share))
        .collect();
    smooth_through(&mut path, &inner);
    path.close_path();
    path
}

fn draw_ears(drawing: &mut Drawing, head: &Head) {
    let ears = -16.0 * head.turn();
    for (id, sign) in [("ear-left", -1.0), ("ear-right", 1.0)] {
        let size = 1.0 - 0.22 * sign * head.turn();
        let place = |x: f64, y: f64| head.middle + Vec2::new(sign * (170.0 + x * size) + ears * 0.4, y);
        let inside = [
            place(-4.0, 34.0),
            place(10.0, 28.0),
            place(14.0, 12.0),
            place(9.0, -4.0),
            place(-2.0, -6.0),
        ];
        let mut ring = inside.to_vec();
        ring.extend([place(3.0, 4.0), place(5.0, 14.0), place(2.0, 24.0)]);
        drawing.fill(id, EAR_INSIDE, smooth_closed(&ring));
    }
}

fn draw_cheeks(drawing: &mut Drawing, head: &Head) {
    let down = head.mix(70.0, 58.0);
    for (id, sign) in [("cheek-left", -1.0), ("cheek-right", 1.0)] {
        drawing.fill(
            id,
            CHEEK,
            head.spot((36.0 * sign, down), (head.mix(10.0, 12.0), head.mix(15.0, 18.0))),
        );
        for (k, (across, below)) in [(-4.5, -3.0), (0.5, 4.0), (5.0, -4.5)].into_iter().enumerate() {
            let freckle = head.spot((sign * (36.0 + across), down + below), (1.1, 2.6));
            drawing.fill(format!("freckle-{}-{}", &id[6..], k + 1), FRECKLE, freckle);
        }
    }
}

/// An open eye, the arch of a laughing one, and the line along the middle of that arch, point by point.
const OPEN_EYE: [(f64, f64); 8] = [
    (1.0, 0.0),
    (0.72, 0.72),
    (0.0, 1.0),
    (-0.72, 0.72),
    (-1.0, 0.0),
    (-0.72, -0.72),
    (0.0, -1.0),
    (0.72, -0.72),
];
const CLOSED_EYE: [(f64, f64); 8] = [
    (1.0, 0.42),
    (0.72, -0.02),
    (0.0, -0.3),
    (-0.72, -0.02),
    (-1.0, 0.42),
    (-0.78, -0.32),
    (0.0, -0.72),
    (0.78, -0.32),
];
const CLOSED_LIDS: [(f64, f64); 8] = [
    (0.74, -0.13),
    (0.72, -0.1694),
    (0.0, -0.5094),
    (-0.72, -0.1694),
    (-0.74, -0.13),
    (-0.72, -0.1706),
    (0.0, -0.5106),
    (0.72, -0.1706),
];

fn draw_eyes(drawing: &mut Drawing, head: &Head) {
    // A calm eye is an upright oval. Laughing closes it to an arch of ink: the white, the iris and the pupil are shut in
    // between lids that meet, far thinner than a pixel, so that they open again with the eye.
    for (side, sign) in [("left", -1.0), ("right", 1.0)] {
        let between = |closed: [(f64, f64); 8]| -> Vec<Point> {
            let place = |(&(x, y), (u, v)): (&(f64, f64), (f64, f64))| {
                (
                    24.0 * sign + head.mix(9.5 * x, 11.5 * u),
                    head.mix(4.0 + 27.0 * y, 6.0 + 30.0 * v),
                )
            };
            head.ring(&OPEN_EYE.iter().zip(closed).map(place).collect::<Vec<_>>())
        };
        let line = grown(&between(CLOSED_EYE), head.mix(FINE, 0.5 * FINE));
        drawing.fill(format!("eye-line-{side}"), INK, smooth_closed(&line));
        drawing.fill(format!("eye-{side}"), WHITE, smooth_closed(&between(CLOSED_LIDS)));
        let (x, y) = (24.0 * sign + head.mix(2.4, 0.0) * head.turn(), head.mix(7.0, -9.3));
        let (width, height) = (head.mix(1.0, 0.3), head.mix(1.0, 0.001));
        drawing.fill(
            format!("iris-{side}"),
            IRIS,
            head.spot((x, y), (6.4 * width, 19.0 * height)),
        );
        drawing.fill(
            format!("pupil-{side}"),
            INK,
            head.spot((x, y), (3.8 * width, 11.5 * height)),
        );
        let glint = (x + 2.0 * width, y - 8.0 * height);
        drawing.fill(
            format!("glint-{side}"),
            WHITE,
            head.spot(glint, (2.0 * width, 5.5 * height)),
        );
    }
}

/// The line along a brow, from its inner end.
fn brow(head: &Head, sign: f64) -> [(f64, f64); 4] {
    let up = head.mix(2.0, -5.0);
    let arch = head.mix(-5.0, -12.0);
    [
        (13.0 * sign, -44.0 + up + head.mix(0.0, 3.0)),
        (19.0 * sign, -48.0 + up + 0.8 * arch),
        (26.0 * sign, -48.0 + up + arch),
        (33.0 * sign, -40.0 + up + 0.4 * arch),
    ]
}

fn draw_brows(drawing: &mut Drawing, head: &Head) {
    for (id, sign) in [("brow-left", -1.0), ("brow-right", 1.0)] {
        drawing.fill(id, INK, head.stroke(&brow(head, sign), 12.0, 5.0));
    }
}

/// A point of the nose. It stands out of the ball, so it moves further than the rest.
fn nose_at(head: &Head, across_deg: f64, down: f64) -> Point {
    head.on_face(across_deg, down + head.mix(0.0, -4.0)) + Vec2::new(12.0 * head.turn(), 0.0)
}

fn draw_nose(drawing: &mut Drawing, head: &Head) {
    let place = |across: f64, down: f64| nose_at(head, across, down);
    let ball = [
        place(-6.5, 44.0),
        place(-5.0, 35.0),
        place(0.0, 31.0),
        place(5.0, 35.0),
        place(6.5, 44.0),
        place(4.5, 53.0),
        place(0.0, 56.0),
        place(-4.5, 53.0),
    ];
    drawing.fill("nose", NOSE, smooth_closed(&ball));
    let shine = [
        place(-2.6, 41.0),
        place(-1.0, 38.0),
        place(1.0, 39.0),
        place(0.2, 43.0),
        place(-1.8, 44.0),
    ];
    drawing.fill("nose-shine", "#f0a488", smooth_closed(&shine));
}

/// The right corner of the mouth.
fn mouth_corner(head: &Head) -> (f64, f64) {
    (head.mix(15.0, 24.0), head.mix(88.0, 76.0))
}

fn draw_mouth(drawing: &mut Drawing, head: &Head) {
    let corner = mouth_corner(head);
    let upper = [
        (-corner.0, corner.1),
        (-0.5 * corner.0, head.mix(97.0, 83.0)),
        (0.0, head.mix(100.0, 85.0)),
        (0.5 * corner.0, head.mix(97.0, 83.0)),
        (corner.0, corner.1),
    ];
    let lower = [
        (0.80 * corner.0, head.mix(93.4, 114.0)),
        (0.42 * corner.0, head.mix(99.0, 139.0)),
        (0.0, head.mix(101.4, 146.0)),
        (-0.42 * corner.0, head.mix(99.0, 139.0)),
        (-0.80 * corner.0, head.mix(93.4, 114.0)),
    ];
    let ring: Vec<(f64, f64)> = upper.iter().chain(&lower).copied().collect();
    let line = head.ring(&ring);
    drawing.fill(
        "mouth-line",
        INK,
        smooth_closed(&grown(&line, FINE * head.mix(0.7, 0.62))),
    );
    drawing.fill("mouth", MOUTH, smooth_closed(&line));
    let inner = |points: &[(f64, f64)]| smooth_closed(&head.ring(points));
    let teeth = [
        (-0.80 * corner.0, head.mix(93.0, 82.0)),
        (-0.42 * corner.0, head.mix(98.0, 86.0)),
        (0.0, head.mix(100.0, 88.0)),
        (0.42 * corner.0, head.mix(98.0, 86.0)),
        (0.80 * corner.0, head.mix(93.0, 82.0)),
        (0.66 * corner.0, head.mix(95.9, 94.0)),
        (0.0, head.mix(100.9, 101.0)),
        (-0.66 * corner.0, head.mix(95.9, 94.0)),
    ];
    // Behind closed lips it is dark.
    drawing.fill("teeth", if head.laugh > 0.5 { TEETH } else { INK }, inner(&teeth));
    let tongue = [
        (-0.48 * corner.0, head.mix(97.6, 133.0)),
        (-0.26 * corner.0, head.mix(99.0, 121.0)),
        (0.0, head.mix(100.4, 124.0)),
        (0.26 * corner.0, head.mix(99.0, 121.0)),
        (0.48 * corner.0, head.mix(97.6, 133.0)),
        (0.30 * corner.0, head.mix(98.8, 141.0)),
        (0.0, head.mix(100.8, 144.0)),
        (-0.30 * corner.0, head.mix(98.8, 141.0)),
    ];
    drawing.fill("tongue", if head.laugh > 0.5 { TONGUE } else { INK }, inner(&tongue));
}

/// How far the left and the right side of the head are turned away, 0 to 1.
fn away(head: &Head) -> (f64, f64) {
    ((-head.turn()).max(0.0), head.turn().max(0.0))
}

/// The hairline: sideburn, fringe in bumps, sideburn. The sideburn that turns away gets short.
fn fringe(head: &Head) -> [(f64, f64); 15] {
    let lift = head.mix(0.0, -4.0);
    let (left, right) = away(head);
    [
        (66.0 - 20.0 * right, -14.0 - 12.0 * right),
        (58.0 - 14.0 * right, 18.0 - 54.0 * right),
        (52.0 - 9.0 * right, -30.0 - 19.0 * right),
        (46.0 - 4.0 * right, -72.0),
        (34.0, -98.0 + lift),
        (23.0, -88.0 + lift),
        (12.0, -107.0 + lift),
        (-2.0, -82.0 + lift),
        (-14.0, -107.0 + lift),
        (-27.0, -87.0 + lift),
        (-40.0, -96.0 + lift),
        (-48.0 + 6.0 * left, -66.0),
        (-52.0 + 9.0 * left, -30.0 - 19.0 * left),
        (-58.0 + 14.0 * left, 18.0 - 54.0 * left),
        (-66.0 + 20.0 * left, -14.0 - 12.0 * left),
    ]
}

fn draw_hair(drawing: &mut Drawing, head: &Head, outline: &[Point]) {
    let crown = &outline[HAIR_POINTS];
    let (left, right) = away(head);
    let line = head.ring(&fringe(head));
    let mut border = BezPath::new();
    smooth_through(&mut border, crown);
    let mut under: Vec<Point> = vec![crown[crown.len() - 1]];
    under.extend(&line);
    under.push(crown[0]);
    // A line of ink around the hair, then the hair itself.
    let mut ring: Vec<Point> = crown.to_vec();
    let last = crown.len() - 1;
    for (end, before, after, away) in [
        (0, crown[1], line[line.len() - 1], left),
        (last, crown[last - 1], line[0], right),
    ] {
        ring[end] = crown[end].lerp(head.middle, 0.04).lerp(before.midpoint(after), away);
    }
    ring.extend(&line);
    drawing.fill("hair-line", INK, smooth_closed(&grown(&ring, 0.9 * FINE)));
    smooth_through(&mut border, &under);
    border.close_path();
    drawing.fill("hair", HAIR, border);
    let sway = -9.0 * head.turn();
    let strands: [(&str, [(f64, f64); 4]); 3] = [
        (
            "strand-left",
            [(-14.0, -186.0), (-48.0, -170.0), (-76.0, -148.0), (-92.0, -124.0)],
        ),
        (
            "strand-middle",
            [(12.0, -190.0), (8.0, -166.0), (10.0, -142.0), (18.0, -122.0)],
        ),
        (
            "strand-right",
            [(38.0, -184.0), (74.0, -164.0), (104.0, -132.0), (122.0, -94.0)],
        ),
    ];
    for (id, points) in strands {
        let line = points.map(|(x, y)| head.middle + Vec2::new(x + 1.3 * sway, y));
        drawing.fill(id, HAIR_DARK, brush(&line, 7.0, 2.5));
    }
    let light = |points: &[(f64, f64)], width: f64| {
        let line: Vec<Point> = points
            .iter()
            .map(|&(x, y)| head.middle + Vec2::new(x + sway, y))
            .collect();
        brush(&line, width, 3.0)
    };
    drawing.fill(
        "shine-left",
        HAIR_LIGHT,
        light(
            &[(-122.0, -116.0), (-110.0, -133.0), (-93.0, -149.0), (-74.0, -161.0)],
            16.0,
        ),
    );
    drawing.fill(
        "shine-right",
        HAIR_LIGHT,
        light(&[(6.0, -172.0), (22.0, -171.0), (38.0, -168.0)], 11.0),
    );
}
