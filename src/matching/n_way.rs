//! N-way matching: every outline to one reference, on one common set of rows (NWM 3.1).
//!
//! Rings and landmarks -> [`RingMatch`].
//!
//! 1. Measure every outline; check that landmarks come in one cyclic order on all poses.
//! 2. Choose the reference, unless told: the first pose, or the one with clearly the least sum of coarse matching costs.
//! 3. A landmark that the reference lacks is carried there from the poses that have it, one landmark after the other.
//! 4. Match every pose to the reference (module `pair`), in parallel.
//! 5. With three poses and more, match each again to all others at once ([`match_jointly`]): what the reference does not
//!    show, or shows in a posture of its own, the others may.
//!
//! *Differences from the paper*: NWM matches pairs to a base pose from a first point that the user gives; here the start is
//! found, all N have a say, and landmarks hold for all poses at once, a pose may lack some, and they are met exactly.
//!
//! Cost: O(N) matches, each comparing with up to N - 1 curves, and O(N^2) coarse ones to choose the reference.

use rayon::prelude::*;

use super::coarse::{Form, coarse_matches};
use super::curve::Samples;
use super::drawn::{Drawn, match_drawn};
use super::frame::{Frame, Model, ModelCurve};
use super::landmark::{Landmark, validated};
use super::monotone::CyclicMap;
use super::pair::{self, Known, PairMatch, Pin, match_pose};
use super::reflection::{MIRROR_SAMPLES, reflection_ratio};
use super::{Correspondence, MatchError, SalientPoint};
use crate::math::wrapped;
use crate::outline::Ring;

/// Samples of the coarse matches that choose the reference.
const OVERVIEW_SAMPLES: usize = 64;
/// Another pose than the first becomes the reference if its sum of costs is below this share of the first's: artists
/// draw the neutral pose first.
const CENTRAL_MARGIN: f32 = 0.8;
/// A pose looks mirrored if its reflection is nearer to the reference by this factor.
const MIRROR_MARGIN: f64 = 0.7;

/// With this many landmarks in common their cyclic order says which way a pose faces.
const ORIENTING_LANDMARKS: usize = 3;

/// How outlines are matched.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct MatchOptions {
    /// The pose that all others are matched to. Default: the first, or the one that is
    /// clearly the most alike to all others.
    pub reference: Option<usize>,
    /// Whether poses are also compared with their reflections. Default: they are.
    pub mirror_hints: MirrorHints,
    /// By how much every pose is expected to be turned from the reference, in radians: ties go to the match that comes nearest. Default: not
    /// at all. The holes of a drawing are expected to turn with it.
    pub turns_rad: Vec<f64>,
}

impl MatchOptions {
    /// By how much `pose` is expected to be turned.
    pub(super) fn turn_of(&self, pose: usize) -> f64 {
        self.turns_rad.get(pose).copied().unwrap_or(0.0)
    }
}

/// Whether poses are compared with their reflections.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum MirrorHints {
    /// They are; [`PoseMatch::looks_mirrored`] says the outcome.
    #[default]
    Look,
    /// They are not, which saves about a third of the time.
    Skip,
}

/// N outlines on one parameter.
#[derive(Debug, Clone)]
pub struct RingMatch {
    /// The pose that the others were matched to.
    pub reference: usize,
    /// The corresponding parameters.
    pub correspondence: Correspondence,
    /// By how much every pose is turned from the reference as a whole, in radians.
    pub turns_rad: Vec<f64>,
    /// How it came about.
    pub report: MatchReport,
}

/// What an artist may want to know about a match.
#[derive(Debug, Clone, PartialEq)]
pub struct MatchReport {
    /// One entry a pose.
    pub poses: Vec<PoseMatch>,
}

/// How one pose was matched.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseMatch {
    /// The elastic cost of its match to the other poses, in the mean: difference in turning (rad, times 2.5 a perimeter) and
    /// stretch. Of two poses, to the reference; 0 for the reference itself.
    pub cost: f64,
    /// The same by row of the correspondence, as a density: a match is doubtful where it is high.
    pub mismatch: Vec<f64>,
    /// Whether its reflection would match clearly better. Not asked where three landmarks or more say how it faces.
    pub looks_mirrored: bool,
    /// How much worse its reflection fits the reference than itself, as a ratio of distances; 1 for the reference, or if not looked for.
    pub reflection_ratio: f64,
    /// Its salient points.
    pub salient: Vec<SalientPoint>,
    /// The landmarks that its match goes through, by number.
    pub landmarks: Vec<usize>,
}

/// Matches N closed curves.
///
/// The correspondence has at least 512 rows; each landmark is a row. It does not depend on where the rings start, on their
/// place, size or rotation (but for what rounding makes of them, about 1e-4 of the perimeter, and for the tie-break between matches of a rotationally symmetric shape, which takes the
/// least rotation), nor, the reference kept, on the order of the poses. All rings have to run the same way.
///
/// # Errors
/// [`MatchError`] if landmarks contradict one another or an outline is degenerate.
///
/// # Examples
/// ```
/// use inbetween::{matching::{MatchOptions, match_rings}, math::Point, outline::Ring};
/// let square = Ring::new([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]].map(Point::from))?;
/// let wide = Ring::new([[9.0, 0.0], [9.0, 3.0], [0.0, 3.0], [0.0, 0.0]].map(Point::from))?;
/// let matched = match_rings(&[square, wide], &[], &MatchOptions::default())?;
/// // The corner (4, 0), a quarter around, corresponds to (9, 0), the first point of the second ring.
/// let corner = matched.correspondence.carry(0, 1, 0.25);
/// assert!(corner < 0.01 || corner > 0.99);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn match_rings(rings: &[Ring], landmarks: &[Landmark], options: &MatchOptions) -> Result<RingMatch, MatchError> {
    match_rings_beside(rings, landmarks, options, || ()).map(|(matched, ())| matched)
}

/// As [`match_rings`], with other work beside the step that takes one pose after the other.
pub(crate) fn match_rings_beside<T: Send>(
    rings: &[Ring],
    landmarks: &[Landmark],
    options: &MatchOptions,
    beside: impl FnOnce() -> T + Send,
) -> Result<(RingMatch, T), MatchError> {
    let count = rings.len();
    let mut landmarks = validated(landmarks, count)?;
    let forms = forms(rings, options)?;
    let reference = options.reference.unwrap_or_else(|| most_central(&forms));
    let given = landmarks.clone();
    carry_to_reference(&forms, reference, &mut landmarks, options)?;

    let all: Vec<usize> = (0..count).collect();
    let to_reference = || match_some(&forms, reference, &landmarks, &all, options);
    let (star, beside) = if count < 3 {
        let (star, beside) = rayon::join(to_reference, beside);
        (star?, beside)
    } else {
        let mut star = to_reference()?;
        let ((), beside) = rayon::join(|| match_jointly(&forms, &mut star, options), beside);
        (star, beside)
    };
    let matched = assembled(
        rings,
        &forms,
        reference,
        [&given, &landmarks],
        star,
        options.mirror_hints,
    )?;
    Ok((matched, beside))
}

/// The curves, measured.
pub(super) fn forms(rings: &[Ring], options: &MatchOptions) -> Result<Vec<Form>, MatchError> {
    let count = rings.len();
    if count == 0 {
        return Err(MatchError::NoPose);
    }
    if let Some(reference) = options.reference.filter(|reference| *reference >= count) {
        return Err(MatchError::NoSuchReference { reference, count });
    }
    (rings.par_iter().enumerate())
        .map(|(pose, ring)| Form::new(ring).map_err(|source| MatchError::Degenerate { pose, source }))
        .collect()
}

/// The matches of all poses with what there is to say of them. Of the landmarks, first those that were given, then with those that the
/// reference lacked.
pub(super) fn assembled(
    rings: &[Ring],
    forms: &[Form],
    reference: usize,
    [given, landmarks]: [&[Landmark]; 2],
    star: StarMatch,
    mirror_hints: MirrorHints,
) -> Result<RingMatch, MatchError> {
    let count = rings.len();
    let StarMatch { frame, matches, .. } = star;
    let rows = (0..frame.rows.len())
        .map(|row| {
            let of_pose = |pose: usize| match &matches[pose] {
                Some(matched) => matched.parameters[row],
                None => frame.rows[row],
            };
            (0..count).map(of_pose).collect()
        })
        .collect();
    let reference_samples = forms[reference].even_samples(MIRROR_SAMPLES);
    let poses = (0..count)
        .into_par_iter()
        .map(|pose| {
            let said = given
                .iter()
                .filter(|l| l.at[reference].is_some() && l.at[pose].is_some())
                .count();
            let skip = mirror_hints == MirrorHints::Skip || said >= ORIENTING_LANDMARKS;
            let reflection_ratio = if pose == reference || skip {
                1.0
            } else {
                reflection_ratio((&forms[reference], &reference_samples), &rings[pose], &forms[pose])
            };
            let (cost, mismatch) = match &matches[pose] {
                Some(matched) => (matched.cost, matched.mismatch.clone()),
                None => (0.0, vec![0.0; frame.rows.len()]),
            };
            PoseMatch {
                cost,
                mismatch,
                looks_mirrored: reflection_ratio < MIRROR_MARGIN,
                reflection_ratio,
                salient: forms[pose].salient.clone(),
                landmarks: (0..given.len())
                    .filter(|k| given[*k].at[pose].is_some() && landmarks[*k].at[reference].is_some())
                    .collect(),
            }
        })
        .collect();
    let turns_rad = (0..count)
        .map(|pose| match &matches[pose] {
            Some(matched) => pair::turn_rad(&forms[reference], &frame.rows, &forms[pose], &matched.parameters),
            None => 0.0,
        })
        .collect();
    Ok(RingMatch {
        reference,
        turns_rad,
        correspondence: Correspondence::new(rows)?,
        report: MatchReport { poses },
    })
}

/// The first pose, unless another's sum of coarse costs to all others is clearly less; then the one with the least.
pub(super) fn most_central(forms: &[Form]) -> usize {
    let count = forms.len();
    if count < 3 {
        return 0;
    }
    let pairs: Vec<(usize, usize)> = (0..count).flat_map(|i| (0..i).map(move |j| (j, i))).collect();
    let samples: Vec<Samples> = forms
        .par_iter()
        .map(|form| form.even_samples(OVERVIEW_SAMPLES))
        .collect();
    let costs: Vec<f32> = pairs
        .par_iter()
        .map(|(i, j)| {
            let matches = coarse_matches(&samples[*i], &samples[*j], 1);
            matches.first().map_or(f32::INFINITY, |matched| matched.cost)
        })
        .collect();
    let mut sums = vec![0.0; count];
    for ((i, j), cost) in pairs.iter().zip(costs) {
        sums[*i] += cost;
        sums[*j] += cost;
    }
    let best = (0..count).fold(0, |best, pose| if sums[pose] < sums[best] { pose } else { best });
    if sums[best] < CENTRAL_MARGIN * sums[0] { best } else { 0 }
}

/// Gives the reference every landmark that it lacks and at least two poses have: the mean of where the matches of those
/// poses put it. A landmark of fewer poses ties nothing together.
pub(super) fn carry_to_reference(
    forms: &[Form],
    reference: usize,
    landmarks: &mut [Landmark],
    options: &MatchOptions,
) -> Result<(), MatchError> {
    for missing in 0..landmarks.len() {
        let having: Vec<(usize, f64)> = (0..forms.len())
            .filter_map(|pose| Some((pose, landmarks[missing].at[pose]?)))
            .collect();
        if landmarks[missing].at[reference].is_some() || having.len() < 2 {
            continue;
        }
        let wanted: Vec<usize> = having.iter().map(|(pose, _)| *pose).collect();
        let StarMatch { frame, matches, .. } = match_some(forms, reference, landmarks, &wanted, options)?;
        let places: Vec<f64> = having
            .iter()
            .filter_map(|(pose, t)| {
                let matched = matches[*pose].as_ref()?;
                Some(CyclicMap::through(matched.parameters.clone(), frame.rows.clone()).at(*t))
            })
            .collect();
        // The mean of nearby places of a circle, relative to the first of them.
        let offset: f64 = places
            .iter()
            .map(|place| place - places[0] - (place - places[0]).round())
            .sum();
        let mean = places[0] + offset / places.len() as f64;
        landmarks[missing].at[reference] = Some(wrapped(mean) % 1.0);
    }
    Ok(())
}

/// Matches of some poses to the reference, which has none itself.
#[derive(Debug, Clone)]
pub(super) struct StarMatch {
    pub(super) frame: Frame,
    pub(super) pins: Vec<Vec<Pin>>,
    pub(super) matches: Vec<Option<PairMatch>>,
}

/// The reference's rows and where landmarks set them, nothing matched yet.
pub(super) fn unmatched(forms: &[Form], reference: usize, landmarks: &[Landmark]) -> StarMatch {
    let mut placed: Vec<f64> = landmarks.iter().filter_map(|l| l.at[reference]).collect();
    placed.sort_by(f64::total_cmp);
    let frame = Frame::new(&forms[reference], &placed);
    let pins = (0..forms.len())
        .map(|pose| pins(&frame, reference, landmarks, pose))
        .collect();
    StarMatch {
        frame,
        pins,
        matches: vec![None; forms.len()],
    }
}

/// Matches some poses to the reference.
fn match_some(
    forms: &[Form],
    reference: usize,
    landmarks: &[Landmark],
    wanted: &[usize],
    options: &MatchOptions,
) -> Result<StarMatch, MatchError> {
    let StarMatch { frame, pins, .. } = unmatched(forms, reference, landmarks);
    let model = Model::new(vec![ModelCurve {
        form: &forms[reference],
        parameters: &frame.rows,
        measured: &frame.measured,
    }]);
    let matches = (0..forms.len())
        .into_par_iter()
        .map(|pose| {
            if pose == reference || !wanted.contains(&pose) {
                return Ok(None);
            }
            let expected = options.turn_of(pose);
            let upright = upright(&frame, [&forms[reference], &forms[pose]], &pins[pose], expected);
            let known = upright.as_deref().map_or(Known::Nothing, Known::Upright);
            pinned_match(&frame, &model, &forms[pose], &pins[pose], known, expected)
                .ok_or(MatchError::NoMatch { pose })
                .map(Some)
        })
        .collect::<Result<Vec<_>, MatchError>>()?;
    Ok(StarMatch { frame, pins, matches })
}

/// Matches every pose again to all others as they stand, the reference among them, the worst matched first. One after the
/// other: of two poses that disagree, only one has to move. Once: more rounds gain nothing, of poses that cannot agree now these
/// win, now those.
fn match_jointly(forms: &[Form], matched: &mut StarMatch, options: &MatchOptions) {
    let StarMatch { frame, pins, matches } = matched;
    let mut order: Vec<(f64, usize)> = matches
        .iter()
        .enumerate()
        .filter_map(|(pose, matched)| Some((matched.as_ref()?.cost, pose)))
        .collect();
    if order.len() < 2 {
        return;
    }
    order.sort_by(|a, b| b.0.total_cmp(&a.0));
    for &(_, pose) in &order {
        let others = (0..forms.len()).filter(|other| *other != pose).map(|other| {
            // The reference alone has no match: the rows are its own.
            let (parameters, measured) = match &matches[other] {
                Some(matched) => (&matched.parameters, &matched.measured),
                None => (&frame.rows, &frame.measured),
            };
            ModelCurve {
                form: &forms[other],
                parameters,
                measured,
            }
        });
        let model = Model::new(others.collect());
        let current = matches[pose].as_ref();
        let known = current.map_or(Known::Nothing, |matched| Known::Current(&matched.parameters));
        if let Some(again) = pinned_match(frame, &model, &forms[pose], &pins[pose], known, options.turn_of(pose)) {
            matches[pose] = Some(again);
        }
    }
}

/// The rows that landmarks of the reference set on a pose, in order.
fn pins(frame: &Frame, reference: usize, landmarks: &[Landmark], pose: usize) -> Vec<Pin> {
    let mut pins: Vec<Pin> = landmarks
        .iter()
        .filter_map(|l| {
            let (at_reference, parameter) = (l.at[reference]?, l.at[pose]?);
            let row = frame.row_of(at_reference)?;
            Some(Pin { row, parameter })
        })
        .collect();
    pins.sort_by_key(|pin| pin.row);
    pins
}

/// The parameters of the match that turns the drawing least; none with pins, which say how it is turned.
fn upright(frame: &Frame, [reference, pose]: [&Form; 2], pins: &[Pin], expected_rad: f64) -> Option<Vec<f64>> {
    if !pins.is_empty() {
        return None;
    }
    let [reference, pose] = [reference, pose].map(|form| Drawn { form, profile: None });
    let found = match_drawn(frame, reference, pose, &[], 1, expected_rad);
    found.into_iter().next().map(|matched| matched.parameters)
}

/// A match that goes through the pins exactly as given, not as rounded on the way.
fn pinned_match(
    frame: &Frame,
    model: &Model,
    form: &Form,
    pins: &[Pin],
    known: Known,
    expected_rad: f64,
) -> Option<PairMatch> {
    let mut matched = match_pose(frame, model, form, pins, known, expected_rad)?;
    through_pins(&mut matched, pins);
    Some(matched)
}

/// The pins exactly as given, but for whole turns, not as rounded on the way.
pub(super) fn through_pins(matched: &mut PairMatch, pins: &[Pin]) {
    for pin in pins {
        let turns = (matched.parameters[pin.row] - pin.parameter).round();
        matched.parameters[pin.row] = pin.parameter + turns;
    }
}

#[cfg(test)]
mod tests;
