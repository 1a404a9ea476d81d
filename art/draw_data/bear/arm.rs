//! An arm: paw, sleeve and cuff, from the shoulder down.

use kurbo::{BezPath, Point, Vec2};

use super::attitude::ArmAngles;
use super::shapes::{Spine, button, curve, linear, radial};
use super::{CLOTH, CLOTH_DARK, FUR, FUR_DARK, FUR_LIGHT, INK, LINE, Part};
use crate::curves::{Limb, grown, hanging, right_of, smooth_closed};
use crate::svg::{Group, Look};

/// On the back, from its middle.
const SHOULDER: (f64, f64) = (92.0, 186.0);
const UPPER: f64 = 104.0;
const LOWER: f64 = 112.0;
const HALF_WIDTHS: [f64; 3] = [36.0, 33.0, 29.0];
const ROUNDNESS: f64 = 0.75;
/// Where the sleeve's outline has points, along the arm.
const STATIONS: [f64; 8] = [0.0, 0.14, 0.28, 0.42, 0.56, 0.7, 0.84, 1.0];
/// Where the cuff begins.
const CUFF: f64 = 0.86;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Side {
    /// On the picture's left.
    Near,
    /// On the picture's right.
    Far,
}

/// An arm, placed.
pub(super) struct Arm {
    side: Side,
    limb: Limb,
    shoulder: Point,
    wrist: Point,
    /// Direction of the lower bone.
    along: Vec2,
}

impl Arm {
    pub(super) fn new(back: &Spine, side: Side, angles: ArmAngles) -> Self {
        let sign = match side {
            Side::Near => -1.0,
            Side::Far => 1.0,
        };
        let shoulder = back.place(sign * SHOULDER.0, SHOULDER.1);
        let elbow = shoulder + hanging(sign * angles.upper) * UPPER;
        let along = hanging(sign * angles.lower);
        let wrist = elbow + along * LOWER;
        Self {
            side,
            limb: Limb::new([shoulder, elbow, wrist], HALF_WIDTHS, ROUNDNESS),
            shoulder,
            wrist,
            along,
        }
    }

    /// The middle of the paw.
    pub(super) fn grip(&self) -> Point {
        self.wrist + self.along * 24.0
    }

    fn id(&self, part: &str) -> String {
        match self.side {
            Side::Near => format!("arm-{part}"),
            Side::Far => format!("far-arm-{part}"),
        }
    }

    /// Across the arm, so that the thumb and the button are on the side of the body when it hangs down.
    fn across(&self, across: f64) -> f64 {
        match self.side {
            Side::Near => -across,
            Side::Far => across,
        }
    }

    /// A point of the paw: along the arm from the wrist, and towards the thumb.
    fn paw(&self, along: f64, thumb: f64) -> Point {
        self.wrist + self.along * along + right_of(self.along) * self.across(thumb)
    }

    /// Clockwise: up the one side of the arm, over the shoulder, down the other.
    fn sleeve(&self) -> Vec<Point> {
        let up = STATIONS.iter().rev().map(|&t| self.limb.place(t, 1.0));
        let down = STATIONS.iter().map(|&t| self.limb.place(t, -1.0));
        let across = self.limb.place(0.0, 1.0) - self.shoulder;
        let back = -Vec2::new(across.y, -across.x);
        let cap = [(0.72, 0.7), (0.0, 1.0), (-0.72, 0.7)].map(|(a, b)| self.shoulder + across * a + back * b);
        up.chain(cap).chain(down).collect()
    }

    /// Clockwise from the tip.
    fn paw_ring(&self) -> Vec<Point> {
        let points = [
            (58.0, 2.0),
            (50.0, 22.0),
            (40.0, 31.0),
            (22.0, 36.0),
            (2.0, 28.0),
            (-18.0, 18.0),
            (-18.0, -18.0),
            (4.0, -27.0),
            (28.0, -30.0),
            (49.0, -21.0),
        ];
        let ring: Vec<Point> = points.map(|(along, thumb)| self.paw(along, thumb)).to_vec();
        match self.side {
            Side::Near => ring.into_iter().rev().collect(),
            Side::Far => ring,
        }
    }

    fn cuff_ring(&self) -> Vec<Point> {
        [
            (CUFF, 1.14),
            (CUFF, 0.0),
            (CUFF, -1.14),
            (1.0, -1.22),
            (1.0, 0.0),
            (1.0, 1.22),
        ]
        .map(|(t, across)| {
            // The cuff's edges are round, as those of a tube.
            self.limb.place(t, across) + self.along * (3.0 * (1.0 - across.abs()))
        })
        .to_vec()
    }

    pub(super) fn draw(&self) -> Part {
        let mut group = Group::new(match self.side {
            Side::Near => "arm",
            Side::Far => "far_arm",
        });
        let (fur, cloth) = (self.id("fur"), self.id("cloth"));
        group.gradient(radial(&fur, self.paw(34.0, 6.0), 52.0, &[FUR_LIGHT, FUR]));
        group.gradient(linear(&cloth, self.shoulder, self.wrist, &[CLOTH, CLOTH, CLOTH_DARK]));
        group.path(
            self.id("paw"),
            Look::shaded(&fur).lined(INK, LINE),
            smooth_closed(&self.paw_ring()),
        );
        for (k, thumb) in [-9.0, 8.0].into_iter().enumerate() {
            let finger = curve(
                [(58.0, thumb), (52.0, thumb), (47.0, 0.9 * thumb), (42.0, 0.8 * thumb)].map(|(a, t)| self.paw(a, t)),
            );
            group.path(self.id(&format!("finger{}", k + 1)), Look::line(INK, 3.5), finger);
        }
        let thumb = curve([(34.0, 20.0), (28.0, 13.0), (20.0, 14.0), (16.0, 20.0)].map(|(a, t)| self.paw(a, t)));
        group.path(self.id("thumb"), Look::line(INK, 3.5), thumb);
        let sleeve = smooth_closed(&self.sleeve());
        group.path(self.id("sleeve"), Look::shaded(&cloth).lined(INK, LINE), sleeve);
        group.path(
            self.id("patch"),
            Look::filled(FUR_DARK).lined(INK, 2.5),
            self.elbow_patch(),
        );
        for (k, t) in [0.34, 0.68].into_iter().enumerate() {
            let side = self.across(1.0);
            let fold = [(t, 0.82), (t + 0.02, 0.6), (t + 0.05, 0.4), (t + 0.06, 0.2)];
            let fold = curve(fold.map(|(t, across)| self.limb.place(t, side * across)));
            group.path(self.id(&format!("fold{}", k + 1)), Look::line(CLOTH_DARK, 4.0), fold);
        }
        let cuff = crate::curves::polygon(&self.cuff_ring());
        group.path(self.id("cuff"), Look::filled(CLOTH_DARK).lined(INK, LINE), cuff);
        button(
            &mut group,
            &self.id("button"),
            self.limb.place(0.93, self.across(0.62)),
            5.5,
        );
        Part {
            group,
            landmarks: self.landmarks(),
        }
    }

    fn elbow_patch(&self) -> BezPath {
        let points: Vec<Point> = (0..8)
            .map(|k| {
                let (sin, cos) = (f64::from(k) * std::f64::consts::FRAC_PI_4).sin_cos();
                self.limb.place(0.49 + 0.075 * cos, self.across(-0.3 + 0.38 * sin))
            })
            .collect();
        smooth_closed(&points)
    }

    /// Around the outline, then inside.
    fn landmarks(&self) -> Vec<(String, Point)> {
        let name = |part: &str| match self.side {
            Side::Near => part.to_owned(),
            Side::Far => format!("far_{part}"),
        };
        let sleeve = grown(&self.sleeve(), 0.5 * LINE);
        let count = STATIONS.len();
        let station = |k: usize, is_right: bool| {
            if is_right {
                sleeve[count - 1 - k]
            } else {
                sleeve[count + 3 + k]
            }
        };
        let is_right_outside = self.side == Side::Near;
        let mut paw = grown(&self.paw_ring(), 0.5 * LINE);
        if self.side == Side::Near {
            paw.reverse();
        }
        let mut points = vec![
            ("shoulder_top", sleeve[count + 1]),
            ("sleeve_outside_upper", station(2, is_right_outside)),
            ("sleeve_outside_lower", station(5, is_right_outside)),
            ("paw_outside", paw[8]),
            ("paw_tip", paw[0]),
            ("paw_thumb", paw[3]),
            ("sleeve_inside_lower", station(5, !is_right_outside)),
            ("sleeve_inside_upper", station(2, !is_right_outside)),
        ];
        let inside = |t: f64, across: f64| self.limb.place(t, self.across(across));
        points.extend([
            ("shoulder", self.shoulder),
            ("upper_arm", inside(0.25, 0.0)),
            ("elbow", inside(0.49, -0.3)),
            ("forearm", inside(0.72, 0.0)),
            ("cuff_inside", inside(0.93, 0.62)),
            ("cuff_outside", inside(0.93, -0.7)),
            ("grip", self.grip()),
        ]);
        points.into_iter().map(|(part, point)| (name(part), point)).collect()
    }
}
