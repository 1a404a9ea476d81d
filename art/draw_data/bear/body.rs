//! The body: boots, trousers, coat and scarf, and the head on it.

use kurbo::{BezPath, Point, Vec2};

use super::attitude::Attitude;
use super::shapes::{Spine, button, curve, linear, radial};
use super::{BRASS, CLOTH, CLOTH_DARK, FUR_DARK, HEIGHT, INK, LINE, Part, WIDTH, head};
use crate::curves::{at, grown, smooth_closed, smooth_through};
use crate::svg::{Group, Look};

const TROUSERS: &str = "#4c3a4f";
const BOOT: &str = "#6d3b26";
const BOOT_LIGHT: &str = "#96592f";
const SCARF: &str = "#f3b33e";
const SCARF_DARK: &str = "#d98a2b";
const SCARF_STRIPE: &str = "#c7492f";
const SEAM: &str = "#1b4d57";

/// The boots' soles.
const GROUND: f64 = HEIGHT - 26.0;
/// From the hips to the neck.
const BACK: f64 = 228.0;
/// From the middle to the boots' middles.
const STEP: f64 = 62.0;

/// The coat's outline, clockwise from the neck: to the right and up from the hips.
const COAT: [(f64, f64); 15] = [
    (0.0, 240.0),
    (50.0, 232.0),
    (88.0, 210.0),
    (107.0, 150.0),
    (120.0, 70.0),
    (126.0, 0.0),
    (137.0, -72.0),
    (72.0, -86.0),
    (0.0, -90.0),
    (-72.0, -86.0),
    (-137.0, -72.0),
    (-126.0, 0.0),
    (-120.0, 70.0),
    (-107.0, 150.0),
    (-88.0, 210.0),
];
/// Which of these points carry a landmark; the others are under the head, or under the scarf.
const COAT_LANDMARKS: [(&str, usize); 8] = [
    ("right_chest", 3),
    ("right_waist", 4),
    ("right_hip", 5),
    ("right_hem", 6),
    ("left_hem", 10),
    ("left_hip", 11),
    ("left_waist", 12),
    ("left_chest", 13),
];
const BUTTONS: [(f64, f64); 3] = [(16.0, 128.0), (17.0, 66.0), (18.0, 4.0)];

/// The back, from the middle of the hips.
pub(super) fn back(attitude: &Attitude) -> Spine {
    let hips = at(0.5 * WIDTH, 528.0) + attitude.hips;
    Spine::new(hips, 0.15 * attitude.lean_deg, attitude.lean_deg, BACK)
}

pub(super) fn draw(attitude: &Attitude, back: &Spine) -> Part {
    let mut group = Group::new("body");
    let mut landmarks = Vec::new();
    for (side, sign) in [("left", -1.0), ("right", 1.0)] {
        draw_leg(&mut group, &mut landmarks, back, side, sign);
    }
    draw_coat(&mut group, &mut landmarks, back);
    draw_scarf(&mut group, &mut landmarks, back);
    let head = head::draw(attitude, back.place(0.0, BACK));
    group.group(head.group);
    landmarks.extend(head.landmarks);
    Part { group, landmarks }
}

fn draw_leg(group: &mut Group, landmarks: &mut Vec<(String, Point)>, back: &Spine, side: &str, sign: f64) {
    let foot = at(0.5 * WIDTH + sign * STEP, GROUND);
    let boot = |x: f64, up: f64| foot + Vec2::new(sign * x, -up);
    // The trousers hang from under the coat, wherever it is, into the boots.
    let leg = [
        back.place(sign * 92.0, -40.0),
        boot(32.0, 46.0),
        boot(0.0, 42.0),
        boot(-32.0, 46.0),
        back.place(sign * 32.0, -40.0),
    ];
    group.path(
        format!("trousers-{side}"),
        Look::filled(TROUSERS).lined(INK, LINE),
        crate::curves::polygon(&leg),
    );
    // Clockwise on the right, from the heel's top on the inside.
    let points = [
        (-34.0, 52.0),
        (0.0, 57.0),
        (33.0, 52.0),
        (37.0, 34.0),
        (52.0, 22.0),
        (50.0, 3.0),
        (10.0, 0.0),
        (-32.0, 2.0),
        (-38.0, 24.0),
    ];
    let mut ring: Vec<Point> = points.map(|(x, up)| boot(x, up)).to_vec();
    let leather = format!("leather-{side}");
    group.gradient(linear(&leather, boot(0.0, 57.0), boot(0.0, 0.0), &[BOOT_LIGHT, BOOT]));
    group.path(
        format!("boot-{side}"),
        Look::shaded(&leather).lined(INK, LINE),
        smooth_closed(&ring),
    );
    for (k, up) in [36.0, 46.0].into_iter().enumerate() {
        let lace = curve([(-12.0, up), (-4.0, up - 4.0), (6.0, up - 4.0), (14.0, up)].map(|(x, up)| boot(x, up)));
        group.path(format!("lace-{side}{}", k + 1), Look::line(BRASS, 3.0), lace);
    }
    if sign < 0.0 {
        ring.reverse();
    }
    let mut outer = grown(&ring, 0.5 * LINE);
    if sign < 0.0 {
        outer.reverse();
    }
    for (name, k) in [("toe", 4), ("sole", 6), ("heel", 8)] {
        landmarks.push((format!("{side}_{name}"), outer[k]));
    }
    landmarks.push((format!("{side}_boot"), boot(0.0, 28.0)));
}

fn draw_coat(group: &mut Group, landmarks: &mut Vec<(String, Point)>, back: &Spine) {
    let ring = back.places(&COAT);
    group.gradient(linear(
        "coat-cloth",
        back.place(-60.0, 230.0),
        back.place(60.0, -90.0),
        &[CLOTH, CLOTH, CLOTH_DARK],
    ));
    group.path(
        "coat",
        Look::shaded("coat-cloth").lined(INK, LINE),
        smooth_closed(&ring),
    );
    let line = |points: &[(f64, f64)]| -> BezPath {
        let mut path = BezPath::new();
        smooth_through(&mut path, &back.places(points));
        path
    };
    let opening = [(0.0, 196.0), (1.0, 120.0), (2.0, 20.0), (0.0, -87.0)];
    group.path("opening", Look::line(INK, 4.0), line(&opening));
    for (side, sign) in [("left", -1.0), ("right", 1.0)] {
        let hem = [(sign * 128.0, -52.0), (sign * 70.0, -68.0), (sign * 10.0, -71.0)];
        group.path(format!("hem-{side}"), Look::line(SEAM, 3.0), line(&hem));
        let lapel = [
            (0.0, 164.0),
            (sign * 40.0, 190.0),
            (sign * 62.0, 226.0),
            (sign * 20.0, 232.0),
        ];
        let lapel = crate::curves::polygon(&back.places(&lapel));
        group.path(format!("lapel-{side}"), Look::filled(CLOTH_DARK).lined(INK, 3.5), lapel);
        let pocket = [(sign * 52.0, 20.0), (sign * 74.0, 15.0), (sign * 96.0, 22.0)];
        group.path(format!("pocket-{side}"), Look::line(SEAM, 7.0), line(&pocket));
        landmarks.push((format!("{side}_pocket"), back.place(sign * 74.0, 15.0)));
        landmarks.push((format!("{side}_hem_seam"), back.place(sign * 70.0, -68.0)));
        landmarks.push((format!("{side}_armhole"), back.place(sign * 92.0, 186.0)));
    }
    for (k, &(x, up)) in BUTTONS.iter().enumerate() {
        button(group, &format!("button{}", k + 1), back.place(x, up), 9.0);
        landmarks.push((format!("button_{}", k + 1), back.place(x, up)));
    }
    let outer = grown(&ring, 0.5 * LINE);
    landmarks.extend(COAT_LANDMARKS.map(|(name, k)| (name.to_owned(), outer[k])));
}

fn draw_scarf(group: &mut Group, landmarks: &mut Vec<(String, Point)>, back: &Spine) {
    let end = [
        (-40.0, 216.0),
        (-14.0, 214.0),
        (-12.0, 160.0),
        (-20.0, 122.0),
        (-36.0, 119.0),
        (-54.0, 124.0),
        (-48.0, 166.0),
    ];
    group.gradient(linear(
        "scarf-wool",
        back.place(0.0, 236.0),
        back.place(0.0, 120.0),
        &[SCARF, SCARF_DARK],
    ));
    group.path(
        "scarf-end",
        Look::shaded("scarf-wool").lined(INK, 4.0),
        smooth_closed(&back.places(&end)),
    );
    for (k, up) in [138.0, 152.0].into_iter().enumerate() {
        let stripe = [(-47.0, up), (-38.0, up - 3.0), (-28.0, up - 4.0), (-20.0, up - 2.0)];
        let stripe = curve(stripe.map(|(x, up)| back.place(x, up)));
        group.path(format!("scarf-stripe{}", k + 1), Look::line(SCARF_STRIPE, 6.0), stripe);
    }
    let around = [
        (0.0, 244.0),
        (58.0, 240.0),
        (76.0, 226.0),
        (60.0, 206.0),
        (0.0, 194.0),
        (-60.0, 206.0),
        (-76.0, 226.0),
        (-58.0, 240.0),
    ];
    group.path(
        "scarf",
        Look::shaded("scarf-wool").lined(INK, LINE),
        smooth_closed(&back.places(&around)),
    );
    group.gradient(radial(
        "knot-wool",
        back.place(-30.0, 208.0),
        26.0,
        &[SCARF, SCARF_DARK],
    ));
    let knot = super::shapes::ellipse(
        back.place(-27.0, 204.0),
        back.place(20.0, 204.0) - back.place(0.0, 204.0),
        back.place(0.0, 186.0) - back.place(0.0, 204.0),
    );
    group.path("scarf-knot", Look::shaded("knot-wool").lined(INK, 4.0), knot);
    group.path(
        "scarf-fold",
        Look::line(FUR_DARK, 3.0),
        curve([(6.0, 203.0), (24.0, 203.0), (40.0, 208.0), (54.0, 216.0)].map(|(x, up)| back.place(x, up))),
    );
    landmarks.push(("scarf_knot".to_owned(), back.place(-27.0, 204.0)));
    landmarks.push(("scarf_end".to_owned(), back.place(-36.0, 134.0)));
}
