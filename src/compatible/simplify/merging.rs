//! How one pose merges the ends of an edge into one point without losing area.
//!
//! For the edge `b c` with outer neighbours `a` and `d`, each pose has its own ways:
//! - `b` is reflex or straight: `b` goes, the new vertex is `c`;
//! - `c` is reflex or straight: `c` goes, the new vertex is `b`;
//! - both are convex and turn by less than 180 degrees together: the new vertex is the apex where the lines `a b` and
//!   `d c` meet.
//!
//! Where two ways are open, the pose takes the one that deviates less from its outline, or, where the merged vertices have to keep
//! corresponding (module `drift`), the one that does so best. Holes need no rule of their own: they run the
//! other way round, so that the shape is on the left of every edge, and "reflex" means a right turn for all rings alike.
//!
//! A landmark stays where it is: of an edge that ends in one only the other end may go.

use super::original::OriginalRing;
use crate::math::{Point, point, predicate, wrapped};

/// A vertex counts as straight if it is convex by less than this, as a fraction of the pose's size: points that
/// were interpolated on an edge lie off it by rounding, a few 1e-16.
const STRAIGHT: f64 = 1e-14;

/// A way to merge the ends of an edge in one pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Merge {
    pub(super) point: Point,
    pub(super) parameter: f64,
    pub(super) deviation: f64,
}

/// An edge `b c` between its neighbours `a` and `d`, in one pose.
pub(super) struct EdgeInPose<'a> {
    /// The outline it has to stay close to.
    pub(super) ring: &'a OriginalRing,
    /// The length that deviations are relative to.
    pub(super) size: f64,
    /// Of `a`, `b`, `c`, `d`.
    pub(super) points: [Point; 4],
    pub(super) parameters: [f64; 4],
    /// Whether `b` and `c` are landmarks.
    pub(super) keeps: [bool; 2],
}

impl EdgeInPose<'_> {
    /// The ways to merge the ends that deviate by `tolerance` of the pose's size at most; of equal ones the first is preferred.
    pub(super) fn merges(&self, tolerance: f64) -> Vec<Merge> {
        let [pa, pb, pc, pd] = self.points;
        let [ta, tb, tc, td] = self.parameters;
        let limit = tolerance * self.size;
        let straight = STRAIGHT * self.size;
        let can_drop = |before: Point, vertex: Point, after: Point| {
            !predicate::is_positive(before, vertex, after)
                || point::cross(vertex - before, after - before) <= straight * (after - before).norm()
        };
        let mut merges = Vec::new();
        let mut offer = |merge: Merge| {
            if merge.deviation <= limit {
                merges.push(merge);
            }
        };
        let [keeps_b, keeps_c] = self.keeps;
        if !keeps_b && can_drop(pa, pb, pc) {
            offer(Merge {
                point: pc,
                parameter: tc,
                deviation: self.ring.deviation((ta, tc), pa, pc, limit),
            });
        }
        if !keeps_c && can_drop(pb, pc, pd) {
            offer(Merge {
                point: pb,
                parameter: tb,
                deviation: self.ring.deviation((tb, td), pb, pd, limit),
            });
        }
        let both_convex = predicate::is_positive(pa, pb, pc) && predicate::is_positive(pb, pc, pd);
        if both_convex && !keeps_b && !keeps_c {
            let (into, out) = (pb - pa, pd - pc);
            let denominator = point::cross(into, out);
            if denominator > 0.0 {
                let apex = pb + into * (point::cross(pc - pb, out) / denominator);
                let distance = point::nearest_on_segment(apex, pb, pc).1;
                if distance <= 2.0 * limit {
                    offer(self.apex_merge(apex, limit));
                }
            }
        }
        merges
    }

    /// The merge at `apex`: it stands for the outline point nearest to it, and deviates by that point's distance or by what
    /// the two new edges leave.
    fn apex_merge(&self, apex: Point, limit: f64) -> Merge {
        let [pa, pb, pc, pd] = self.points;
        let [ta, tb, tc, td] = self.parameters;
        // A point of the chain, or failing that the middle of its parameters.
        let middle = wrapped(tb + 0.5 * wrapped(tc - tb));
        let nearest = (self.ring)
            .between(tb, tc)
            .map(|(t, p)| ((p - apex).norm(), t))
            .min_by(|x, y| x.0.total_cmp(&y.0));
        let to_edge = point::nearest_on_segment(apex, pb, pc).1;
        let (distance, parameter) = nearest.map_or((to_edge, middle), |(distance, t)| (distance, t));
        let before = self.ring.deviation((ta, parameter), pa, apex, limit);
        let after = self.ring.deviation((parameter, td), apex, pd, limit);
        Merge {
            point: apex,
            parameter,
            deviation: distance.max(before).max(after),
        }
    }
}
