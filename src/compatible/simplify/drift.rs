//! How far the vertices of a tuple have drifted from corresponding.
//!
//! A merge keeps `b` in one pose and `c` in another, or takes the corner between them; so the vertices of a tuple come to stand for places of
//! their outlines that no longer correspond, and the mesh, which takes them to one another, slides along the outline by that much. Where the
//! correspondence is to be trusted to less than the tolerance, that distance counts as a deviation does.

use super::merging::Merge;
use crate::matching::Correspondence;
use crate::math::wrapped;
use crate::outline::parameter_gap;

/// Correspondences that merged vertices are held to.
#[derive(Debug)]
pub(super) struct Drift<'a> {
    /// One a ring.
    pub(super) correspondences: &'a [Correspondence],
    /// The perimeter over the length that deviations are relative to: #poses x #rings.
    pub(super) perimeters: Vec<Vec<f64>>,
    /// The largest distance along the outline, relative to the same length.
    pub(super) largest: f64,
}

impl Drift<'_> {
    /// Of the ways that every pose has, with their relative deviations, those that correspond best: each pose's choice with the larger of
    /// its deviation and its drift. `parameters` are those of both ends of the edge, on every pose. `None` if none is near enough.
    pub(super) fn together(
        &self,
        ring: usize,
        ways: &[Vec<(Merge, f64)>],
        parameters: &[[f64; 2]],
    ) -> Option<Vec<(Merge, f64)>> {
        let correspondence = &self.correspondences[ring];
        let mut best: Option<(f64, Vec<(Merge, f64)>)> = None;
        for share in [0.0, 0.5, 1.0] {
            let coordinate = self.mean_coordinate(ring, parameters, share);
            let chosen: Option<Vec<(Merge, f64)>> = (ways.iter().enumerate())
                .map(|(pose, ways)| {
                    let wanted = correspondence.parameter(pose, coordinate);
                    let with_drift = ways.iter().filter_map(|&(merge, deviation)| {
                        let drift = parameter_gap(merge.parameter, wanted) * self.perimeters[pose][ring];
                        (drift <= self.largest).then_some((merge, deviation.max(drift)))
                    });
                    with_drift.min_by(|a, b| a.1.total_cmp(&b.1))
                })
                .collect();
            if let Some(chosen) = chosen {
                let worst = chosen.iter().map(|(_, error)| *error).fold(0.0, f64::max);
                if best.as_ref().is_none_or(|(least, _)| worst < *least) {
                    best = Some((worst, chosen));
                }
            }
        }
        best.map(|(_, chosen)| chosen)
    }

    /// The row coordinate that is this share of the way along an edge, in the mean over the poses.
    fn mean_coordinate(&self, ring: usize, parameters: &[[f64; 2]], share: f64) -> f64 {
        let correspondence = &self.correspondences[ring];
        let rows = correspondence.rows().len() as f64;
        let coordinates = parameters.iter().enumerate().map(|(pose, &[from, to])| {
            let t = from + share * wrapped(to - from);
            correspondence.row_coordinate(pose, t)
        });
        let mut first = None;
        let (mut sum, mut count) = (0.0, 0.0);
        for coordinate in coordinates {
            let origin = *first.get_or_insert(coordinate);
            let off = coordinate - origin;
            sum += off - rows * (off / rows).round();
            count += 1.0;
        }
        first.map_or(0.0, |origin| origin + sum / count)
    }
}
