//! Bends a straight arm at a joint as a modeller would.

use inbetween::math::{Point3, smooth_step};

/// A joint on the x axis that turns about z.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Joint {
    /// Where it is along the arm.
    station: f64,
    /// How far on either side the skin is shared.
    reach: f64,
    /// For one unit of its adjective.
    degrees: f64,
}

pub(crate) const SHOULDER: Joint = Joint {
    station: 0.0,
    reach: 0.8,
    degrees: 45.0,
};
pub(crate) const ELBOW: Joint = Joint {
    station: 3.0,
    reach: 0.55,
    degrees: 90.0,
};
/// Never bent in an example.
pub(crate) const WRIST: Joint = Joint {
    station: 5.5,
    reach: 0.3,
    degrees: 0.0,
};

impl Joint {
    /// How much the skin at a station of the arm follows what is beyond this joint.
    pub(crate) fn share(self, station: f64) -> f64 {
        smooth_step(station, self.station - self.reach, self.station + self.reach)
    }

    /// Where a point of the straight arm goes, whose cross-section is at `station`. Cross-sections stay what they are; the
    /// middle line goes round an arc, and beyond the joint it is where the skeleton has it.
    pub(crate) fn bend(self, straight: Point3, station: f64, amount: f64) -> Point3 {
        let angle_rad = self.degrees.to_radians() * amount;
        let along = |to: f64| {
            const STEPS: usize = 200;
            let from = self.station - self.reach;
            let step = (to - from) / STEPS as f64;
            (0..STEPS).fold(Point3::new(from, 0.0, 0.0), |at, index| {
                let (sin, cos) = libm::sincos(angle_rad * self.share(from + (index as f64 + 0.5) * step));
                at + Point3::new(cos, sin, 0.0) * step
            })
        };
        let share = self.share(station);
        let (sin, cos) = libm::sincos(angle_rad * share);
        let turned = |at: Point3| Point3::new(cos * at.x - sin * at.y, sin * at.x + cos * at.y, at.z);
        if share <= 0.0 {
            return straight;
        }
        // The arc is shorter than the corner of the skeleton, so that the arm would come out too far: it is drawn back.
        let end = self.station + self.reach;
        let (end_sin, end_cos) = libm::sincos(angle_rad);
        let corner = Point3::new(self.station + self.reach * end_cos, self.reach * end_sin, 0.0);
        let excess = along(end) - corner;
        let middle = along(station.min(end)) - excess * share;
        let offset = straight - Point3::new(station.min(end), 0.0, 0.0);
        middle + turned(offset)
    }
}
