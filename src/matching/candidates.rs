//! Matches by what is drawn, in two steps with a registration between them.
//!
//! [`RingCandidates::new`] proposes matches of every pose to the reference (module `drawn`); whoever knows where the reference's places are
//! in the other poses chooses among them, and [`RingCandidates::settled`] moves every row there, along the outline.

use rayon::prelude::*;

use super::coarse::Form;
use super::drawn::{Drawn, DrawnMatch, match_drawn};
use super::frame::{Model, ModelCurve};
use super::landmark::{Landmark, validated};
use super::n_way::{self, StarMatch};
use super::pair::{self, Pin};
use super::{MatchError, MatchOptions, RingMatch};
use crate::appearance::Profile;
use crate::math::Point;
use crate::outline::Ring;

/// How many matches of a pose are proposed.
const MOST_CANDIDATES: usize = 4;
/// Candidates whose cost exceeds the least by more than this factor and this difference are not proposed, but for the upright one.
const CANDIDATE_MARGIN: f32 = 1.5;
const CANDIDATE_COST: f32 = 0.1;
/// How far a row may move from where its candidate has it, in perimeters, unless half of the rows say that all go further and there is no landmark.
const SETTLE_REACH: f64 = 0.03;
/// Of so many rows one is asked how far all go.
const TURN_STRIDE: usize = 8;

/// Proposed matches of N closed curves to one of them.
#[derive(Debug, Clone)]
pub struct RingCandidates {
    forms: Vec<Form>,
    reference: usize,
    given: Vec<Landmark>,
    landmarks: Vec<Landmark>,
    star: StarMatch,
    /// By pose.
    proposed: Vec<Vec<DrawnMatch>>,
}

impl RingCandidates {
    /// Proposes matches; `profiles` say what is drawn inside each ring, from its parameter 0 on.
    ///
    /// # Errors
    /// As [`match_rings`](super::match_rings).
    pub fn new(
        rings: &[Ring],
        profiles: &[Profile],
        landmarks: &[Landmark],
        options: &MatchOptions,
    ) -> Result<Self, MatchError> {
        let mut landmarks = validated(landmarks, rings.len())?;
        let forms = n_way::forms(rings, options)?;
        let reference = options.reference.unwrap_or_else(|| n_way::most_central(&forms));
        let given = landmarks.clone();
        n_way::carry_to_reference(&forms, reference, &mut landmarks, options)?;
        let star = n_way::unmatched(&forms, reference, &landmarks);
        let drawn = |pose: usize| Drawn {
            form: &forms[pose],
            profile: profiles.get(pose),
        };
        let proposed = (0..forms.len())
            .into_par_iter()
            .map(|pose| {
                if pose == reference {
                    return Ok(Vec::new());
                }
                let mut found = match_drawn(
                    &star.frame,
                    drawn(reference),
                    drawn(pose),
                    &star.pins[pose],
                    MOST_CANDIDATES,
                    options.turn_of(pose),
                );
                let least = found.iter().map(|matched| matched.cost).fold(f32::INFINITY, f32::min);
                let mut is_first = true;
                found.retain(|matched| {
                    std::mem::take(&mut is_first) || matched.cost <= CANDIDATE_MARGIN * least + CANDIDATE_COST
                });
                if found.is_empty() {
                    Err(MatchError::NoMatch { pose })
                } else {
                    Ok(found)
                }
            })
            .collect::<Result<Vec<_>, MatchError>>()?;
        Ok(Self {
            forms,
            reference,
            given,
            landmarks,
            star,
            proposed,
        })
    }

    /// The pose that the others are matched to.
    #[must_use]
    pub fn reference(&self) -> usize {
        self.reference
    }

    /// How many matches of `pose` are proposed, the one that turns it least first; none of the reference.
    #[must_use]
    pub fn count(&self, pose: usize) -> usize {
        self.proposed.get(pose).map_or(0, Vec::len)
    }

    /// Corresponding points of the reference and of `pose` by its match number `candidate`, in source units and in order.
    #[must_use]
    pub fn pairs(&self, pose: usize, candidate: usize) -> Option<(Vec<Point>, Vec<Point>)> {
        let matched = self.proposed.get(pose)?.get(candidate)?;
        let points = |pose: usize, parameters: &[f64]| {
            let curve = &self.forms[pose].curve;
            parameters.iter().map(|t| curve.in_source(curve.at(*t))).collect()
        };
        Some((
            points(self.reference, &self.star.frame.rows),
            points(pose, &matched.parameters),
        ))
    }

    /// The match that begins with candidate number `chosen[pose]` of every pose and takes each row to the place of the outline nearest to
    /// where `carried` takes the reference's point; landmarks stay. Where it knows nothing, the row stays. Where it takes a landmark to another place
    /// than the artist, what it says around is taken relative to the landmarks: they know more.
    ///
    /// # Errors
    /// As [`match_rings`](super::match_rings).
    pub fn settled(
        mut self,
        rings: &[Ring],
        chosen: &[usize],
        options: &MatchOptions,
        carried: &(dyn Fn(usize, Point) -> Option<Point> + Sync),
    ) -> Result<RingMatch, MatchError> {
        let StarMatch { frame, pins, matches } = &mut self.star;
        let reference = &self.forms[self.reference];
        let places: Vec<Point> = (frame.rows.iter())
            .map(|t| reference.curve.in_source(reference.curve.at(*t)))
            .collect();
        let model = Model::new(vec![ModelCurve {
            form: reference,
            parameters: &frame.rows,
            measured: &frame.measured,
        }]);
        *matches = (self.proposed.par_iter().enumerate())
            .map(|(pose, proposed)| {
                let candidate = proposed
                    .get(chosen.get(pose).copied().unwrap_or(0))
                    .or(proposed.first())?;
                let form = &self.forms[pose];
                let mut parameters = candidate.parameters.clone();
                let wanted = |place: &Point| Some(form.curve.normalised(carried(pose, *place)?));
                let turned = |t: f64, place: &Point| Some(form.curve.nearest_within(wanted(place)?, t, 0.5) - t);
                let strays: Vec<(usize, f64)> = (pins[pose].iter())
                    .filter_map(|pin| Some((pin.row, turned(parameters[pin.row], &places[pin.row])?)))
                    .collect();
                if strays.iter().any(|(_, stray)| stray.abs() > SETTLE_REACH) {
                    for (row, (t, place)) in parameters.iter_mut().zip(&places).enumerate() {
                        if let Some(wanted) = wanted(place) {
                            let stray = stray_at(&strays, row, places.len());
                            *t = form.curve.nearest_within(wanted, *t + stray, SETTLE_REACH) - stray;
                        }
                    }
                    return Some(closed(&model, form, parameters, &pins[pose]));
                }
                let rows = parameters.iter().zip(&places).step_by(TURN_STRIDE);
                let turn = median(rows.filter_map(|(t, place)| turned(*t, place)).collect());
                // Landmarks say themselves how the curve is turned.
                if turn.abs() > SETTLE_REACH && strays.is_empty() {
                    parameters.iter_mut().for_each(|t| *t += turn);
                }
                for (t, place) in parameters.iter_mut().zip(&places) {
                    if let Some(wanted) = wanted(place) {
                        *t = form.curve.nearest_within(wanted, *t, SETTLE_REACH);
                    }
                }
                Some(closed(&model, form, parameters, &pins[pose]))
            })
            .collect();
        n_way::assembled(
            rings,
            &self.forms,
            self.reference,
            [&self.given, &self.landmarks],
            self.star,
            options.mirror_hints,
        )
    }
}

/// What strays by `strays` at some rows, in order, strays by at `row` of `count`: linear between them, around.
fn stray_at(strays: &[(usize, f64)], row: usize, count: usize) -> f64 {
    let after = strays.partition_point(|(own, _)| *own <= row);
    let pins = strays.len().max(1);
    let (Some(from), Some(to)) = (strays.get((after + pins - 1) % pins), strays.get(after % pins)) else {
        return 0.0;
    };
    let rows = |from: usize, to: usize| (to + count - from) % count;
    let span = match rows(from.0, to.0) {
        0 => count,
        span => span,
    };
    // Half a turn one way is half a turn the other way.
    let grows = (to.1 - from.1) - (to.1 - from.1).round();
    from.1 + grows * rows(from.0, row) as f64 / span as f64
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// The match with these parameters, made to increase and to go through the pins exactly.
fn closed(model: &Model, form: &Form, mut parameters: Vec<f64>, pins: &[Pin]) -> pair::PairMatch {
    pair::increasing(&mut parameters, pins);
    pair::limited(&mut parameters, pins);
    let mut matched = pair::measured(model, form, parameters);
    n_way::through_pins(&mut matched, pins);
    matched
}
