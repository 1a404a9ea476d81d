//! The match in sections between numbered links, and how unlike the outlines are in each.
//!
//! A mapping, the report of its match and its landmarks in, [`Sections`] out.
//!
//! 1. Links: the landmarks on the outline; the reference's salient points, those of the widest scale first, unless too near
//!    to one that is there; and the middles of the widest gaps.
//!    Poses that lie over themselves have none: part of their outline is hidden, and there is nothing to compare.
//! 2. The cost of a section is the mean of the match's mismatch between two links, over the length it has on average
//!    on both outlines. The reference has no mismatch of its own: it shows the largest of the others.
//!
//! Cost O((#rows + #links^2) x #poses).

use crate::matching::MatchReport;
use crate::math::wrapped;
use crate::outline::{ArcLength, parameter_gap};
use crate::pose::{LandmarkKind, Mapping, PlacedLandmark};

/// Links on salient points keep this distance, in perimeters of the reference: nearer numbers cannot be read.
const NEAREST_LINKS: f64 = 0.028;
/// And landmarks this, which are listed in the artist's order: shorter sections say nothing.
const NEAREST_LANDMARKS: f64 = 0.018;
/// Salient points become links up to this many links.
const MOST_LINKS: usize = 18;
/// Gaps wider than this are halved, in perimeters of the reference.
const WIDEST_GAP: f64 = 0.09;

/// One numbered point of all outlines.
#[derive(Debug, Clone, PartialEq)]
pub struct Link {
    /// Its arc-length parameter on every pose.
    pub at: Vec<f64>,
    /// The landmark that it is, by its place in the list given.
    pub landmark: Option<usize>,
}

/// The outlines of all poses, cut at numbered links.
#[derive(Debug, Clone, PartialEq)]
pub struct Sections {
    reference: usize,
    links: Vec<Link>,
    /// #poses x #links.
    costs: Vec<Vec<f64>>,
}

impl Sections {
    /// A landmark in a section is worth trying from this cost on: drawings of one character mostly stay below half of it,
    /// silhouettes of different animals come beyond it in most places.
    pub const DOUBTFUL_COST: f64 = 2.5;
    /// And from this many times the mean of the pose's sections on: where all are unlike, the worst are worth a look.
    pub const DOUBTFUL_SHARE: f64 = 1.5;

    /// Chooses the links and measures the sections between them.
    #[must_use]
    pub fn new(mapping: &Mapping, report: &MatchReport, landmarks: &[PlacedLandmark]) -> Self {
        let matching = &mapping.matching;
        let reference = matching.reference;
        let mut chosen: Vec<(f64, Option<usize>)> = Vec::new();
        if let Some(outline) = mapping.outlines.get(reference) {
            let curve = ArcLength::new(outline.outer());
            for (index, landmark) in landmarks.iter().enumerate() {
                if landmark.kind == LandmarkKind::OnOutline
                    && let Some(place) = landmark.at.get(reference).and_then(|places| places.first())
                {
                    let t = curve.nearest(*place).0;
                    if !chosen
                        .iter()
                        .any(|(other, _)| parameter_gap(*other, t) < NEAREST_LANDMARKS)
                    {
                        chosen.push((t, Some(index)));
                    }
                }
            }
        }
        let mut salient = report
            .poses
            .get(reference)
            .map_or_else(Vec::new, |pose| pose.salient.clone());
        salient.sort_by(|a, b| {
            (b.scale, b.curvature.abs())
                .partial_cmp(&(a.scale, a.curvature.abs()))
                .unwrap_or(std::cmp::Ordering::Equal)
        });
        for point in salient {
            let is_near = |(t, _): &(f64, Option<usize>)| parameter_gap(*t, point.parameter) < NEAREST_LINKS;
            if chosen.len() < MOST_LINKS && !chosen.iter().any(is_near) {
                chosen.push((point.parameter, None));
            }
        }
        fill_gaps(&mut chosen);
        let poses = mapping.poses.len();
        let links: Vec<Link> = chosen
            .into_iter()
            .map(|(t, landmark)| Link {
                at: (0..poses)
                    .map(|pose| matching.outer.carry(reference, pose, t))
                    .collect(),
                landmark,
            })
            .collect();
        let rows: Vec<f64> = links
            .iter()
            .map(|link| matching.outer.row_coordinate(reference, link.at[reference]))
            .collect();
        let of_pose = |pose: usize| -> Vec<f64> {
            // Where parts lie over one another, outlines do not correspond.
            if mapping.overlaps.depth(pose).is_some() {
                return vec![0.0; rows.len()];
            }
            let mismatch = report.poses.get(pose).map_or(&[][..], |matched| &matched.mismatch);
            let between = |k: usize| (rows[k], rows[(k + 1) % rows.len()]);
            (0..rows.len())
                .map(|k| mean_mismatch(mapping, pose, mismatch, between(k)))
                .collect()
        };
        let mut costs: Vec<Vec<f64>> = (0..poses).map(of_pose).collect();
        if reference < poses {
            let largest = |k: usize| costs.iter().map(|of_pose| of_pose[k]).fold(0.0, f64::max);
            costs[reference] = (0..links.len()).map(largest).collect();
        }
        Self {
            reference,
            links,
            costs,
        }
    }

    /// The links, in order along the outlines; link `k` is shown as number `k + 1`.
    #[must_use]
    pub fn links(&self) -> &[Link] {
        &self.links
    }

    /// The pose that the others were matched to.
    #[must_use]
    pub fn reference(&self) -> usize {
        self.reference
    }

    /// The mean mismatch per unit of length from link `k` to the next one, by `k`; of the reference, the largest of any
    /// pose. Empty for a pose that is not there.
    #[must_use]
    pub fn costs(&self, pose: usize) -> &[f64] {
        self.costs.get(pose).map_or(&[], Vec::as_slice)
    }

    /// The section of a pose that costs most: from that link to the next one.
    #[must_use]
    pub fn worst(&self, pose: usize) -> Option<usize> {
        let costs = self.costs.get(pose)?;
        (0..costs.len()).reduce(|best, k| if costs[k] > costs[best] { k } else { best })
    }

    /// The sections of a pose where a landmark is worth trying, the worst first.
    #[must_use]
    pub fn doubtful(&self, pose: usize) -> Vec<usize> {
        let Some(costs) = self.costs.get(pose) else {
            return Vec::new();
        };
        let mean = costs.iter().sum::<f64>() / costs.len().max(1) as f64;
        let most = costs.iter().copied().fold(0.0, f64::max);
        // The worst counts even where all are nearly as bad.
        let least = Self::DOUBTFUL_COST.max((Self::DOUBTFUL_SHARE * mean).min(most));
        let mut doubtful: Vec<usize> = (0..costs.len()).filter(|k| costs[*k] >= least).collect();
        doubtful.sort_by(|a, b| costs[*b].total_cmp(&costs[*a]));
        doubtful
    }

    /// The numbers of the links that section `k` runs between.
    #[must_use]
    pub fn numbers(&self, k: usize) -> (usize, usize) {
        (k + 1, (k + 1) % self.links.len().max(1) + 1)
    }
}

/// Sorts parameters and puts more between them until no gap is wide.
fn fill_gaps(chosen: &mut Vec<(f64, Option<usize>)>) {
    if chosen.is_empty() {
        chosen.push((0.0, None));
    }
    chosen.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut filled = Vec::new();
    for (k, &(from, landmark)) in chosen.iter().enumerate() {
        let to = match chosen.get(k + 1) {
            Some((to, _)) => *to,
            None => chosen[0].0 + 1.0,
        };
        filled.push((from, landmark));
        let pieces = ((to - from) / WIDEST_GAP).ceil().max(1.0) as usize;
        filled.extend((1..pieces).map(|piece| ((from + (to - from) * piece as f64 / pieces as f64) % 1.0, None)));
    }
    filled.sort_by(|a, b| a.0.total_cmp(&b.0));
    *chosen = filled;
}

/// The mean of a mismatch, given per unit of length by row, between two row coordinates.
fn mean_mismatch(mapping: &Mapping, pose: usize, mismatch: &[f64], (from, to): (f64, f64)) -> f64 {
    let (reference, outer) = (mapping.matching.reference, &mapping.matching.outer);
    let rows = outer.rows();
    let count = rows.len() as f64;
    let end = if to > from { to } else { to + count };
    let (mut cost, mut length) = (0.0, 0.0);
    let mut row = from.floor();
    while row < end {
        let share = (row + 1.0).min(end) - row.max(from);
        let here = row as usize % rows.len();
        let step = |pose: usize| wrapped(rows[(here + 1) % rows.len()][pose] - rows[here][pose]);
        let own = share * 0.5 * (step(reference) + step(pose));
        cost += own * mismatch.get(here).copied().unwrap_or(0.0);
        length += own;
        row += 1.0;
    }
    if length > 0.0 { cost / length } else { 0.0 }
}
