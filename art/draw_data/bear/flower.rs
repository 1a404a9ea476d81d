//! The flower that the bear brings.

use kurbo::{Point, Vec2};

use super::shapes::{Spine, circle, curve, ellipse, radial};
use super::{INK, Part};
use crate::curves::{right_of, smooth_closed};
use crate::svg::{Group, Look};

const PETAL: &str = "#ffa3b5";
const PETAL_DARK: &str = "#e0456f";
const MIDDLE: &str = "#ffd84f";
const MIDDLE_DARK: &str = "#e79a22";
const STEM: &str = "#5aa845";
const LEAF: &str = "#7cc257";

/// From the hand to the bloom.
const STEM_LENGTH: f64 = 104.0;
const STEM_BELOW: f64 = 36.0;
const STEM_WIDTH: f64 = 9.0;
const PETALS: u32 = 6;
/// From the middle of the bloom to those of the petals.
const PETAL_DISTANCE: f64 = 25.0;
const PETAL_LENGTH: f64 = 19.0;
const PETAL_WIDTH: f64 = 15.0;
const LINE: f64 = 4.0;

/// The flower held at `grip`.
pub(super) fn draw(grip: Point, heading_deg: f64, bend_deg: f64) -> Part {
    let stem = Spine::new(grip, heading_deg, bend_deg, STEM_LENGTH);
    let bloom = stem.place(0.0, STEM_LENGTH);
    let ahead = (stem.place(0.0, STEM_LENGTH + 1.0) - bloom).normalize();
    let mut group = Group::new("flower");
    group.gradient(radial("petal", bloom, 46.0, &[PETAL_DARK, PETAL]));
    group.gradient(radial(
        "flower-middle-light",
        bloom,
        17.0,
        &[MIDDLE, MIDDLE, MIDDLE_DARK],
    ));
    let mut line = kurbo::BezPath::new();
    crate::curves::smooth_through(
        &mut line,
        &stem.places(&[
            (0.0, -STEM_BELOW),
            (0.0, 0.0),
            (0.0, 0.5 * STEM_LENGTH),
            (0.0, STEM_LENGTH),
        ]),
    );
    group.path("stem-line", Look::line(INK, STEM_WIDTH + 2.0 * LINE), line.clone());
    group.path("stem", Look::line(STEM, STEM_WIDTH), line);
    let leaf = [
        (1.0, 26.0),
        (14.0, 30.0),
        (31.0, 44.0),
        (38.0, 54.0),
        (20.0, 50.0),
        (5.0, 42.0),
    ];
    group.path(
        "leaf",
        Look::filled(LEAF).lined(INK, LINE),
        smooth_closed(&stem.places(&leaf)),
    );
    group.path(
        "leaf-vein",
        Look::line(STEM, 2.5),
        curve([(4.0, 32.0), (12.0, 36.0), (20.0, 41.0), (27.0, 46.0)].map(|(x, up)| stem.place(x, up))),
    );
    let mut landmarks = vec![
        (
            "stem_end".to_owned(),
            stem.place(0.0, -STEM_BELOW - 0.5 * STEM_WIDTH - LINE),
        ),
        ("stem".to_owned(), grip),
        ("stem_middle".to_owned(), stem.place(0.0, 0.5 * STEM_LENGTH)),
        ("bloom".to_owned(), bloom),
    ];
    for k in 0..PETALS {
        // The first points ahead; they go round clockwise.
        let angle_rad = std::f64::consts::TAU * f64::from(k) / f64::from(PETALS);
        let out: Vec2 = ahead * angle_rad.cos() + right_of(ahead) * angle_rad.sin();
        let middle = bloom + out * PETAL_DISTANCE;
        let petal = ellipse(middle, out * PETAL_LENGTH, right_of(out) * PETAL_WIDTH);
        group.path(format!("petal{}", k + 1), Look::shaded("petal").lined(INK, LINE), petal);
        let tip = bloom + out * (PETAL_DISTANCE + PETAL_LENGTH + 0.5 * LINE);
        landmarks.push((format!("petal_{}", k + 1), tip));
    }
    group.path(
        "flower-middle",
        Look::shaded("flower-middle-light").lined(INK, LINE),
        circle(bloom, 15.0),
    );
    Part { group, landmarks }
}
