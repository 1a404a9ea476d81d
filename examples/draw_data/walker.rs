//! The walker: five bitmaps of one figure, drawn from a skeleton.
//!
//! The figure is seen from the front. Its limbs stay apart from the body and from one another in every pose, so each
//! pose is one outline without holes, and going round it meets the same features in the same order: pompom, ear, thumb,
//! hand, shoe, crotch, shoe, hand, thumb, ear. What is drawn inside a part is fixed to that part, so the five pictures
//! coincide when they are warped onto one another.

use std::error::Error;
use std::path::Path;

use kurbo::{Affine, BezPath, Circle, Ellipse, Point, Rect, RoundedRect, Shape, Vec2};

use crate::canvas::{Canvas, Rgb, moved};
use crate::curves::{Limb, at, brush, hanging, polygon, right_of, smooth_closed, smooth_through};
use crate::scene::{self, Pose, Scene};

const WIDTH_PX: u32 = 640;
const HEIGHT_PX: u32 = 720;
/// Where the soles stand.
const GROUND_PX: f64 = 684.0;
/// Bones of a leg, pixels.
const THIGH: f64 = 82.0;
const SHIN: f64 = 78.0;
const HIP_RADIUS: f64 = 28.0;
/// Thickness of the ink line around the figure.
const LINE: f64 = 5.5;
/// Thickness of ink lines inside the figure.
const FINE: f64 = 3.6;

const INK: Rgb = [0x2b, 0x1f, 0x33];
const SKIN: Rgb = [0xff, 0xd2, 0xae];
const CHEEK: Rgb = [0xf7, 0x9a, 0x86];
const HAIR: Rgb = [0x8a, 0x4b, 0x2d];
const HAT: Rgb = [0xe2, 0x4b, 0x3b];
const CREAM: Rgb = [0xff, 0xf3, 0xdc];
const RIB: Rgb = [0xe6, 0xcd, 0xac];
const SWEATER: Rgb = [0xf6, 0xb5, 0x3c];
const SCARF: Rgb = [0x2f, 0xa7, 0x9b];
const TROUSERS: Rgb = [0x3d, 0x5f, 0x97];
const TURN_UP: Rgb = [0x8f, 0xae, 0xd6];
const SHOE: Rgb = [0x8c, 0x51, 0x38];
const TONGUE: Rgb = [0xf0, 0x6f, 0x6a];
const MOUTH: Rgb = [0x7c, 0x23, 0x35];

const ANIMATION: &str = "\
[animation]
fps = 24
loop = true
size = [480, 540]
background = \"white\"
# Two steps to either side with a little hop between them, a jump, a wave.
keys = [
  { time = 0.0, at = [0.0, 0.0] },
  { time = 0.35, at = [-1.0, 0.0] },
  { time = 0.7, at = [0.0, 0.15] },
  { time = 1.05, at = [1.0, 0.0] },
  { time = 1.4, at = [0.0, 0.15] },
  { time = 1.75, at = [-1.0, 0.0] },
  { time = 2.1, at = [0.0, 0.15] },
  { time = 2.45, at = [1.0, 0.0] },
  { time = 2.85, at = [0.0, 0.0] },
  { time = 3.2, at = [0.0, 1.0] },
  { time = 3.35, at = [0.0, 1.0] },
  { time = 3.7, at = [0.0, 0.0] },
  { time = 4.15, at = [0.0, -1.0] },
  { time = 4.4, at = [0.0, -0.72] },
  { time = 4.65, at = [0.0, -1.0] },
  { time = 4.9, at = [0.0, -0.72] },
  { time = 5.15, at = [0.0, -1.0] },
  { time = 5.7, at = [0.0, 0.0] },
]
";

/// The side of the picture that a limb is on.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Side {
    Left,
    Right,
}

impl Side {
    fn sign(self) -> f64 {
        match self {
            Self::Left => -1.0,
            Self::Right => 1.0,
        }
    }
}

/// How a leg is posed.
#[derive(Debug, Clone, Copy)]
enum Stance {
    /// The shoe stands where it stands in the upright pose; the knee gives way outwards.
    Planted,
    /// The leg is in the air.
    Free(LimbAngles),
}

/// Two bones and what hangs on them. Angles in degrees from straight down, outwards positive.
#[derive(Debug, Clone, Copy)]
struct LimbAngles {
    upper: f64,
    lower: f64,
    /// Hand: relative to the forearm, thumb side positive. Foot: toe lifted, from level.
    tip: f64,
}

#[derive(Debug, Clone, Copy)]
enum Mouth {
    Smile,
    Open,
}

/// One drawing of the figure.
#[derive(Debug, Clone, Copy)]
struct Posture {
    name: &'static str,
    /// Place in pose space.
    at: [f64; 2],
    /// Where the middle of the hips is.
    hips: Point,
    /// Torso and head, clockwise from upright, degrees. The head's is measured from the picture, not from the torso.
    lean_deg: f64,
    tilt_deg: f64,
    /// How far the cap's tip flops to the right, degrees from upright.
    flop_deg: f64,
    /// Where the eyes look, pixels.
    look: Vec2,
    mouth: Mouth,
    left_arm: LimbAngles,
    right_arm: LimbAngles,
    left_leg: Stance,
    right_leg: Stance,
}

impl Posture {
    fn torso(&self) -> Affine {
        Affine::translate(self.hips.to_vec2()) * Affine::rotate(self.lean_deg.to_radians())
    }

    fn head(&self) -> Affine {
        let neck = self.torso() * at(0.0, -150.0);
        Affine::translate(neck.to_vec2()) * Affine::rotate(self.tilt_deg.to_radians())
    }
}

const fn limb(upper: f64, lower: f64, tip: f64) -> LimbAngles {
    LimbAngles { upper, lower, tip }
}

fn postures() -> [Posture; 5] {
    let stand = Posture {
        name: "stand",
        at: [0.0, 0.0],
        hips: at(320.0, 486.0),
        lean_deg: 0.0,
        tilt_deg: -2.0,
        flop_deg: 58.0,
        look: Vec2::new(0.0, 0.0),
        mouth: Mouth::Smile,
        left_arm: limb(50.0, 22.0, 0.0),
        right_arm: limb(50.0, 22.0, 0.0),
        left_leg: Stance::Planted,
        right_leg: Stance::Planted,
    };
    let stride_left = Posture {
        name: "stride_left",
        at: [-1.0, 0.0],
        hips: at(346.0, 484.0),
        lean_deg: 5.0,
        tilt_deg: -4.0,
        flop_deg: 74.0,
        look: Vec2::new(-3.0, 0.0),
        left_arm: limb(72.0, 52.0, 6.0),
        right_arm: limb(58.0, 108.0, 4.0),
        left_leg: Stance::Free(limb(56.0, 8.0, 14.0)),
        ..stand
    };
    let stride_right = Posture {
        name: "stride_right",
        at: [1.0, 0.0],
        hips: at(294.0, 484.0),
        lean_deg: -5.0,
        tilt_deg: 4.0,
        flop_deg: 36.0,
        look: Vec2::new(3.0, 0.0),
        left_arm: stride_left.right_arm,
        right_arm: stride_left.left_arm,
        right_leg: stride_left.left_leg,
        ..stand
    };
    let jump = Posture {
        name: "jump",
        at: [0.0, 1.0],
        hips: at(320.0, 420.0),
        tilt_deg: 2.0,
        flop_deg: 22.0,
        look: Vec2::new(0.0, -3.0),
        mouth: Mouth::Open,
        left_arm: limb(96.0, 138.0, 0.0),
        right_arm: limb(96.0, 138.0, 0.0),
        left_leg: Stance::Free(limb(58.0, 6.0, -16.0)),
        right_leg: Stance::Free(limb(58.0, 6.0, -16.0)),
        ..stand
    };
    let wave = Posture {
        name: "wave",
        at: [0.0, -1.0],
        hips: at(306.0, 488.0),
        lean_deg: -4.0,
        tilt_deg: -7.0,
        flop_deg: 62.0,
        look: Vec2::new(2.0, -1.0),
        mouth: Mouth::Open,
        left_arm: limb(52.0, 26.0, 0.0),
        right_arm: limb(92.0, 140.0, 8.0),
        ..stand
    };
    [stand, stride_left, stride_right, jump, wave]
}

/// Draws the five poses into `folder`.
pub(crate) fn draw(folder: &Path) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(folder)?;
    let mut poses = Vec::new();
    for posture in postures() {
        let mut canvas = Canvas::new(WIDTH_PX, HEIGHT_PX)?;
        draw_figure(&mut canvas, &posture);
        let file = format!("{}.png", posture.name);
        canvas.save(&folder.join(&file))?;
        let (tip, direction) = cap_end(posture.flop_deg);
        let top = posture.head() * (tip + direction * (POMPOM_RADIUS + LINE));
        poses.push(Pose {
            name: posture.name,
            file,
            at: posture.at,
            landmarks: vec![("pompom", top)],
        });
    }
    scene::save(
        folder,
        &Scene {
            element: None,
            poses,
            animation: ANIMATION,
        },
    )
}

fn draw_figure(canvas: &mut Canvas, posture: &Posture) {
    let (torso, head) = (posture.torso(), posture.head());
    let legs =
        [(Side::Left, posture.left_leg), (Side::Right, posture.right_leg)].map(|(s, l)| Leg::new(posture.hips, s, l));
    let arms = [(Side::Left, posture.left_arm), (Side::Right, posture.right_arm)].map(|(s, l)| Arm::new(torso, s, l));
    draw_shoes(canvas, &legs);
    draw_trousers(canvas, torso, &legs);
    for arm in &arms {
        arm.draw_hand(canvas);
    }
    draw_sweater(canvas, torso, &arms);
    draw_cap_tip(canvas, head, posture.flop_deg);
    draw_scarf(canvas, torso);
    draw_head(canvas, head, posture);
    draw_cap(canvas, head, posture.flop_deg);
}

struct Leg {
    limb: Limb,
    hip: Point,
    foot: Affine,
}

impl Leg {
    fn new(hips: Point, side: Side, stance: Stance) -> Self {
        let sign = side.sign();
        let hip = hips + Vec2::new(31.0 * sign, 4.0);
        let (knee, ankle, toe_lift_deg) = match stance {
            Stance::Planted => {
                let ankle = at(0.5 * f64::from(WIDTH_PX) + 62.0 * sign, GROUND_PX - 40.0);
                (knee_between(hip, ankle, sign), ankle, 0.0)
            }
            Stance::Free(angles) => {
                let knee = hip + hanging(sign * angles.upper) * THIGH;
                (knee, knee + hanging(sign * angles.lower) * SHIN, angles.tip)
            }
        };
        let limb = Limb::new([hip, knee, ankle], [HIP_RADIUS, 23.0, 22.0], 0.7);
        // The foot is drawn for the right side; on the left it is mirrored.
        let foot = Affine::translate(ankle.to_vec2())
            * Affine::scale_non_uniform(sign, 1.0)
            * Affine::rotate(-toe_lift_deg.to_radians());
        Self { limb, hip, foot }
    }
}

/// The knee of a leg from `hip` to `ankle`, bent towards `sign`.
fn knee_between(hip: Point, ankle: Point, sign: f64) -> Point {
    let reach = ankle - hip;
    let distance = reach.hypot().min(THIGH + SHIN);
    let along = (distance * distance + THIGH * THIGH - SHIN * SHIN) / (2.0 * distance);
    let across = (THIGH * THIGH - along * along).max(0.0).sqrt();
    let direction = reach.normalize();
    hip + direction * along - right_of(direction) * (across * sign)
}

fn draw_shoes(canvas: &mut Canvas, legs: &[Leg; 2]) {
    let upper = smooth_closed(&[
        at(-27.0, 30.0),
        at(-26.0, 6.0),
        at(-20.0, -10.0),
        at(4.0, -13.0),
        at(24.0, -6.0),
        at(44.0, 4.0),
        at(64.0, 8.0),
        at(78.0, 20.0),
        at(76.0, 31.0),
        at(40.0, 33.0),
        at(0.0, 33.0),
    ]);
    let sole = RoundedRect::from_rect(Rect::new(-32.0, 26.0, 84.0, 40.0), 7.0).to_path(0.05);
    for leg in legs {
        let (upper, sole) = (moved(leg.foot, &upper), moved(leg.foot, &sole));
        canvas.ink(&upper, LINE, INK);
        canvas.ink(&sole, LINE, INK);
        canvas.fill(&upper, SHOE);
        let heel = moved(leg.foot, &Ellipse::new((-30.0, 22.0), (26.0, 40.0), 0.0).to_path(0.05));
        canvas.shade(&heel, &upper);
        let cap = moved(leg.foot, &Ellipse::new((82.0, 34.0), (28.0, 30.0), 0.0).to_path(0.05));
        canvas.fill_inside(&cap, &upper, CREAM);
        canvas.ink(&sole, FINE * 0.5, INK);
        canvas.fill(&sole, CREAM);
        for x in [22.0, 34.0, 46.0] {
            let lace = [
                at(x, 2.0 + 0.25 * (x - 22.0)),
                at(x - 4.0, 10.0 + 0.2 * (x - 22.0)),
                at(x - 5.0, 19.0),
            ];
            canvas.fill(&moved(leg.foot, &brush(&lace, 4.2, 2.6)), CREAM);
        }
    }
}

fn draw_trousers(canvas: &mut Canvas, torso: Affine, legs: &[Leg; 2]) {
    let seat = moved(
        torso,
        &smooth_closed(&[
            at(-60.0, -30.0),
            at(0.0, -40.0),
            at(60.0, -30.0),
            at(59.0, 6.0),
            at(36.0, 20.0),
            at(0.0, 25.0),
            at(-36.0, 20.0),
            at(-59.0, 6.0),
        ]),
    );
    let mut parts = vec![seat];
    for leg in legs {
        parts.push(leg.limb.body());
        parts.push(Circle::new(leg.hip, HIP_RADIUS).to_path(0.05));
    }
    for part in &parts {
        canvas.ink(part, LINE, INK);
    }
    for part in &parts {
        canvas.fill(part, TROUSERS);
    }
    for leg in legs {
        // Turned-up hem.
        let hem = leg.limb.patch(0.87, 1.0, -1.14, 1.14);
        canvas.ink(&hem, LINE * 0.75, INK);
        canvas.fill(&hem, TURN_UP);
        canvas.shade(&leg.limb.shadow(0.05, -1.0), &leg.limb.patch(0.0, 1.0, -1.14, 1.14));
    }
}

struct Arm {
    limb: Limb,
    shoulder: Point,
    hand: Affine,
    side: Side,
}

impl Arm {
    fn new(torso: Affine, side: Side, angles: LimbAngles) -> Self {
        let sign = side.sign();
        let shoulder = torso * at(44.0 * sign, -122.0);
        let elbow = shoulder + hanging(sign * angles.upper) * 74.0;
        let forearm = hanging(sign * angles.lower);
        let wrist = elbow + forearm * 70.0;
        let limb = Limb::new([shoulder, elbow, wrist], [24.0, 20.0, 19.0], 0.75);
        // The hand's x axis continues the forearm, its y axis points to the thumb.
        let hand = Affine::translate(wrist.to_vec2())
            * Affine::rotate(forearm.atan2())
            * Affine::scale_non_uniform(1.0, -sign)
            * Affine::rotate(angles.tip.to_radians());
        Self {
            limb,
            shoulder,
            hand,
            side,
        }
    }

    fn draw_hand(&self, canvas: &mut Canvas) {
        let mitten = moved(
            self.hand,
            &smooth_closed(&[
                at(0.0, -19.0),
                at(22.0, -27.0),
                at(48.0, -27.0),
                at(68.0, -14.0),
                at(72.0, 4.0),
                at(64.0, 20.0),
                at(46.0, 25.0),
                at(41.0, 31.0),
                at(46.0, 44.0),
                at(40.0, 56.0),
                at(26.0, 57.0),
                at(14.0, 44.0),
                at(6.0, 24.0),
                at(-4.0, 10.0),
            ]),
        );
        canvas.ink(&mitten, LINE, INK);
        canvas.fill(&mitten, HAT);
        let shade = moved(
            self.hand,
            &smooth_closed(&[
                at(0.0, -40.0),
                at(80.0, -40.0),
                at(90.0, 0.0),
                at(66.0, -8.0),
                at(48.0, -17.0),
                at(20.0, -18.0),
                at(0.0, -10.0),
            ]),
        );
        canvas.shade(&shade, &mitten);
        let crease = moved(
            self.hand,
            &brush(&[at(39.0, 30.0), at(33.0, 23.0), at(30.0, 14.0)], FINE, FINE * 0.7),
        );
        canvas.fill(&crease, INK);
    }

    fn draw_cuff(&self, canvas: &mut Canvas) {
        let cuff = moved(self.hand, &RoundedRect::new(-12.0, -23.0, 9.0, 23.0, 8.0).to_path(0.05));
        canvas.ink(&cuff, LINE * 0.8, INK);
        canvas.fill(&cuff, CREAM);
        let shade = moved(self.hand, &RoundedRect::new(-12.0, -23.0, 9.0, -8.0, 4.0).to_path(0.05));
        canvas.shade(&shade, &cuff);
    }
}

fn draw_sweater(canvas: &mut Canvas, torso: Affine, arms: &[Arm; 2]) {
    let trunk = moved(
        torso,
        &smooth_closed(&[
            at(-64.0, -10.0),
            at(-66.0, -40.0),
            at(-62.0, -90.0),
            at(-54.0, -128.0),
            at(-34.0, -146.0),
            at(0.0, -150.0),
            at(34.0, -146.0),
            at(54.0, -128.0),
            at(62.0, -90.0),
            at(66.0, -40.0),
            at(64.0, -10.0),
            at(0.0, -3.0),
        ]),
    );
    let mut parts = vec![trunk.clone()];
    for arm in arms {
        parts.push(arm.limb.body());
        parts.push(Circle::new(arm.shoulder, 24.0).to_path(0.05));
    }
    for part in &parts {
        canvas.ink(part, LINE, INK);
    }
    for part in &parts {
        canvas.fill(part, SWEATER);
    }
    for arm in arms {
        canvas.fill(&arm.limb.patch(0.48, 0.62, -1.0, 1.0), CREAM);
        // The side away from the thumb lies in shadow.
        canvas.shade(&arm.limb.shadow(0.22, arm.side.sign()), &arm.limb.body());
    }
    for (top, bottom) in [(-72.0, -50.0), (-22.0, 10.0)] {
        let mut stripe = BezPath::new();
        smooth_through(&mut stripe, &[at(-80.0, top), at(0.0, top + 6.0), at(80.0, top)]);
        stripe.line_to(at(80.0, bottom));
        smooth_through(
            &mut stripe,
            &[at(80.0, bottom), at(0.0, bottom + 6.0), at(-80.0, bottom)],
        );
        stripe.close_path();
        canvas.fill_inside(&moved(torso, &stripe), &trunk, CREAM);
    }
    let side = [
        at(80.0, 10.0),
        at(38.0, 10.0),
        at(50.0, -50.0),
        at(46.0, -96.0),
        at(58.0, -130.0),
        at(90.0, -60.0),
    ];
    canvas.shade(&moved(torso, &smooth_closed(&side)), &trunk);
    for arm in arms {
        arm.draw_cuff(canvas);
    }
    // Where the sleeves meet the body: a short crease.
    for sign in [-1.0, 1.0] {
        let crease = brush(
            &[at(60.0 * sign, -92.0), at(54.0 * sign, -102.0), at(50.0 * sign, -114.0)],
            FINE,
            1.6,
        );
        canvas.fill(&moved(torso, &crease), INK);
    }
}

fn draw_scarf(canvas: &mut Canvas, torso: Affine) {
    let tail = moved(
        torso,
        &smooth_closed(&[
            at(8.0, -140.0),
            at(30.0, -140.0),
            at(36.0, -110.0),
            at(42.0, -80.0),
            at(26.0, -74.0),
            at(10.0, -80.0),
            at(10.0, -110.0),
        ]),
    );
    canvas.ink(&tail, FINE, INK);
    canvas.fill(&tail, SCARF);
    let fringe = moved(
        torso,
        &polygon(&[at(0.0, -92.0), at(50.0, -96.0), at(50.0, -88.0), at(0.0, -84.0)]),
    );
    canvas.fill_inside(&fringe, &tail, CREAM);
    let wrap = moved(
        torso,
        &smooth_closed(&[
            at(-54.0, -150.0),
            at(-50.0, -162.0),
            at(0.0, -160.0),
            at(50.0, -162.0),
            at(54.0, -150.0),
            at(44.0, -134.0),
            at(0.0, -122.0),
            at(-44.0, -134.0),
        ]),
    );
    canvas.ink(&wrap, LINE * 0.8, INK);
    canvas.fill(&wrap, SCARF);
    let shade = moved(
        torso,
        &smooth_closed(&[
            at(-46.0, -160.0),
            at(0.0, -146.0),
            at(46.0, -160.0),
            at(40.0, -170.0),
            at(-40.0, -170.0),
        ]),
    );
    canvas.shade(&shade, &wrap);
}

fn draw_head(canvas: &mut Canvas, head: Affine, posture: &Posture) {
    let place = |path: BezPath| moved(head, &path);
    let ears: Vec<BezPath> = [-1.0, 1.0]
        .map(|sign| place(Ellipse::new((88.0 * sign, -58.0), (17.0, 20.0), 0.0).to_path(0.05)))
        .into();
    let face = place(smooth_closed(&[
        at(0.0, 4.0),
        at(48.0, -6.0),
        at(80.0, -36.0),
        at(88.0, -74.0),
        at(84.0, -116.0),
        at(0.0, -150.0),
        at(-84.0, -116.0),
        at(-88.0, -74.0),
        at(-80.0, -36.0),
        at(-48.0, -6.0),
    ]));
    for part in ears.iter().chain([&face]) {
        canvas.ink(part, LINE, INK);
    }
    for part in ears.iter().chain([&face]) {
        canvas.fill(part, SKIN);
    }
    let shade = place(smooth_closed(&[
        at(-60.0, 14.0),
        at(-40.0, -8.0),
        at(0.0, -6.0),
        at(46.0, -18.0),
        at(70.0, -44.0),
        at(76.0, -90.0),
        at(110.0, -90.0),
        at(100.0, -10.0),
        at(20.0, 30.0),
    ]));
    canvas.shade(&shade, &face);
    for sign in [-1.0, 1.0] {
        let inner = brush(
            &[at(90.0 * sign, -68.0), at(97.0 * sign, -60.0), at(91.0 * sign, -50.0)],
            FINE * 1.2,
            2.0,
        );
        canvas.fill(&place(inner), [0xd9, 0x83, 0x6c]);
        canvas.fill(
            &place(Ellipse::new((54.0 * sign, -36.0), (15.0, 10.0), 0.0).to_path(0.05)),
            CHEEK,
        );
    }
    draw_features(canvas, head, posture);
    // Hair under the cap.
    let fringe = place(smooth_closed(&[
        at(-86.0, -120.0),
        at(-84.0, -84.0),
        at(-76.0, -70.0),
        at(-66.0, -88.0),
        at(-48.0, -98.0),
        at(-30.0, -90.0),
        at(-6.0, -101.0),
        at(22.0, -93.0),
        at(48.0, -101.0),
        at(68.0, -88.0),
        at(77.0, -70.0),
        at(84.0, -84.0),
        at(86.0, -120.0),
        at(0.0, -146.0),
    ]));
    canvas.ink(&fringe, FINE * 0.5, INK);
    canvas.fill(&fringe, HAIR);
}

fn draw_features(canvas: &mut Canvas, head: Affine, posture: &Posture) {
    let place = |path: BezPath| moved(head, &path);
    let look = posture.look;
    for sign in [-1.0, 1.0] {
        let middle = at(35.0 * sign, -68.0) + look;
        canvas.fill(&place(Ellipse::new(middle, (10.5, 15.0), 0.0).to_path(0.05)), INK);
        canvas.fill(
            &place(Circle::new(middle + Vec2::new(3.5, -6.0), 4.2).to_path(0.05)),
            CREAM,
        );
        canvas.fill(
            &place(Circle::new(middle + Vec2::new(-3.5, 6.0), 2.1).to_path(0.05)),
            CREAM,
        );
    }
    let nose = brush(
        &[at(-9.0, -47.0), at(-3.0, -42.0), at(4.0, -42.0), at(10.0, -47.0)],
        FINE * 1.3,
        FINE * 0.7,
    );
    canvas.fill(&place(nose), [0xc9, 0x6b, 0x55]);
    match posture.mouth {
        Mouth::Smile => {
            let line = [
                at(-28.0, -30.0),
                at(-16.0, -21.0),
                at(0.0, -17.5),
                at(16.0, -21.0),
                at(28.0, -30.0),
            ];
            canvas.fill(&place(brush(&line, FINE * 1.5, FINE * 0.9)), INK);
        }
        Mouth::Open => {
            let mouth = place(smooth_closed(&[
                at(-28.0, -31.0),
                at(0.0, -27.0),
                at(28.0, -31.0),
                at(22.0, -16.0),
                at(0.0, -8.0),
                at(-22.0, -16.0),
            ]));
            canvas.ink(&mouth, FINE * 0.6, INK);
            canvas.fill(&mouth, MOUTH);
            let tongue = place(Ellipse::new((0.0, -8.0), (15.0, 9.0), 0.0).to_path(0.05));
            canvas.fill_inside(&tongue, &mouth, TONGUE);
        }
    }
}

/// The cap's soft tip with its pompom; it lies behind the cap's dome.
fn draw_cap_tip(canvas: &mut Canvas, head: Affine, flop_deg: f64) {
    let (tip, pompom) = cap_tip(flop_deg);
    let (tip, pompom) = (
        moved(head, &tip.body()),
        Circle::new(head * pompom, POMPOM_RADIUS).to_path(0.05),
    );
    canvas.ink(&tip, LINE, INK);
    canvas.ink(&pompom, LINE, INK);
    canvas.fill(&tip, HAT);
}

const POMPOM_RADIUS: f64 = 22.0;
/// Where the cap's tip begins to flop over.
const CAP_BEND: Point = Point::new(2.0, -188.0);

fn cap_tip(flop_deg: f64) -> (Limb, Point) {
    let root = at(0.0, -140.0);
    let (pompom, direction) = cap_end(flop_deg);
    let end = pompom - direction * (POMPOM_RADIUS - 6.0);
    (Limb::new([root, CAP_BEND, end], [60.0, 30.0, 13.0], 0.9), pompom)
}

/// The middle of the pompom, and the direction in which the cap's tip points there.
fn cap_end(flop_deg: f64) -> (Point, Vec2) {
    let direction = -hanging(-flop_deg);
    (CAP_BEND + direction * (32.0 + POMPOM_RADIUS), direction)
}

fn draw_cap(canvas: &mut Canvas, head: Affine, flop_deg: f64) {
    let place = |path: BezPath| moved(head, &path);
    let dome = place(smooth_closed(&[
        at(-86.0, -112.0),
        at(-74.0, -144.0),
        at(-40.0, -166.0),
        at(0.0, -173.0),
        at(40.0, -166.0),
        at(74.0, -144.0),
        at(86.0, -112.0),
        at(0.0, -126.0),
    ]));
    canvas.ink(&dome, LINE, INK);
    let (tip, pompom) = cap_tip(flop_deg);
    canvas.fill(&place(tip.body()), HAT);
    canvas.fill(&dome, HAT);
    let shade = place(smooth_closed(&[
        at(96.0, -100.0),
        at(56.0, -124.0),
        at(50.0, -150.0),
        at(28.0, -170.0),
        at(60.0, -180.0),
        at(110.0, -140.0),
    ]));
    canvas.shade(&shade, &dome);
    let ball = Circle::new(head * pompom, POMPOM_RADIUS).to_path(0.05);
    canvas.ink(&ball, LINE * 0.7, INK);
    canvas.fill(&ball, CREAM);
    let under = Circle::new(head * (pompom + Vec2::new(9.0, 10.0)), POMPOM_RADIUS).to_path(0.05);
    canvas.shade(&under, &ball);
    let light = Circle::new(head * (pompom - Vec2::new(4.0, 4.0)), POMPOM_RADIUS).to_path(0.05);
    canvas.fill_inside(&light, &ball, CREAM);
    let brim = place(smooth_closed(&[
        at(-92.0, -100.0),
        at(-93.0, -118.0),
        at(-82.0, -130.0),
        at(-40.0, -139.0),
        at(0.0, -142.0),
        at(40.0, -139.0),
        at(82.0, -130.0),
        at(93.0, -118.0),
        at(92.0, -100.0),
        at(80.0, -94.0),
        at(40.0, -104.0),
        at(0.0, -107.0),
        at(-40.0, -104.0),
        at(-80.0, -94.0),
    ]));
    canvas.ink(&brim, LINE * 0.8, INK);
    canvas.fill(&brim, CREAM);
    let under = place(smooth_closed(&[
        at(100.0, -90.0),
        at(60.0, -92.0),
        at(58.0, -120.0),
        at(66.0, -140.0),
        at(110.0, -130.0),
    ]));
    canvas.shade(&under, &brim);
    for x in [-66.0_f64, -40.0, -14.0, 14.0, 40.0, 66.0] {
        let drop = 0.0017 * x * x;
        let rib = brush(
            &[at(x * 0.98, -131.0 + drop), at(x, -123.0 + drop), at(x, -115.0 + drop)],
            FINE * 0.8,
            1.4,
        );
        canvas.fill(&place(rib), RIB);
    }
}
