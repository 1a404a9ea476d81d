//! N-way matching: every outline to one reference, on one common set of rows (NWM 3.1).
//!
//! Rings and landmarks -> [`RingMatch`].
//!
//! 1. Measure every outline; check that landmarks come in one cyclic order on all poses.
//! 2. Choose the reference, unless told: the pose with the least sum of coarse matching costs to all others.
//! 3. A landmark that the reference lacks is carried there from the poses that have it, one landmark after the other.
//! 4. Match every pose to the reference (module `pair`), in parallel.
//!
//! *Differences from the paper*: NWM matches pairs from a first point that the user gives; here the start is found, and
//! landmarks hold for all N poses at once, a pose may lack some, and they are met exactly.
//!
//! Cost: O(N) matches, and O(N^2) coarse ones to choose the reference.

use rayon::prelude::*;

use super::coarse::{Form, coarse_matches};
use super::landmark::{Landmark, validated};
use super::monotone::CyclicMap;
use super::pair::{PairMatch, Pin, Reference};
use super::{Correspondence, MatchError, SalientPoint};
use crate::outline::Ring;

/// Samples of the coarse matches that choose the reference and look for mirrored poses.
const OVERVIEW_SAMPLES: usize = 64;
/// A pose looks mirrored if its reflection matches at less than this share of its own cost.
const MIRROR_MARGIN: f32 = 0.75;

/// How outlines are matched.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MatchOptions {
    /// The pose that all others are matched to. Default: the one with the least cost to all others.
    pub reference: Option<usize>,
    /// Whether poses are also compared with their reflections. Default: they are.
    pub mirror_hints: MirrorHints,
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
    /// The elastic cost of its match to the reference: difference in turning (rad, times 2.5 a perimeter) and stretch.
    pub cost: f64,
    /// The same by row of the correspondence, as a density: a match is doubtful where it is high.
    pub mismatch: Vec<f64>,
    /// Whether its reflection would match clearly better.
    pub looks_mirrored: bool,
    /// Its salient points.
    pub salient: Vec<SalientPoint>,
    /// The landmarks that its match goes through, by number.
    pub landmarks: Vec<usize>,
}

/// Matches N closed curves.
///
/// The correspondence has at least 512 rows; each landmark is a row. It does not depend on where the rings start, on their
/// place, size or rotation (but for the tie-break between matches of a rotationally symmetric shape, which takes the
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
    let count = rings.len();
    if count == 0 {
        return Err(MatchError::NoPose);
    }
    if let Some(reference) = options.reference
        && reference >= count
    {
        return Err(MatchError::NoSuchReference { reference, count });
    }
    let mut landmarks = validated(landmarks, count)?;
    let forms = rings
        .par_iter()
        .enumerate()
        .map(|(pose, ring)| Form::new(ring).map_err(|source| MatchError::Degenerate { pose, source }))
        .collect::<Result<Vec<Form>, MatchError>>()?;
    let reference = options.reference.unwrap_or_else(|| most_central(&forms));
    let given = landmarks.clone();
    carry_to_reference(&forms, reference, &mut landmarks)?;

    let (frame, matches) = match_all(&forms, reference, &landmarks)?;
    let rows = (0..frame.len())
        .map(|row| {
            let of_pose = |pose: usize| match &matches[pose] {
                Some(matched) => matched.parameters[row],
                None => frame[row],
            };
            (0..count).map(of_pose).collect()
        })
        .collect();
    let poses = (0..count)
        .into_par_iter()
        .map(|pose| {
            let looks_mirrored = pose != reference
                && options.mirror_hints == MirrorHints::Look
                && looks_mirrored(&forms[reference], &rings[pose], &forms[pose]);
            let (cost, mismatch) = match &matches[pose] {
                Some(matched) => (matched.cost, matched.mismatch.clone()),
                None => (0.0, vec![0.0; frame.len()]),
            };
            PoseMatch {
                cost,
                mismatch,
                looks_mirrored,
                salient: forms[pose].salient.clone(),
                landmarks: (0..given.len()).filter(|k| given[*k].at[pose].is_some()).collect(),
            }
        })
        .collect();
    Ok(RingMatch {
        reference,
        correspondence: Correspondence::new(rows)?,
        report: MatchReport { poses },
    })
}

/// The pose with the least sum of coarse costs to the others; the first such pose.
fn most_central(forms: &[Form]) -> usize {
    let count = forms.len();
    if count < 3 {
        return 0;
    }
    let pairs: Vec<(usize, usize)> = (0..count).flat_map(|i| (0..i).map(move |j| (j, i))).collect();
    let costs: Vec<f32> = pairs
        .par_iter()
        .map(|(i, j)| {
            let matches = coarse_matches(&forms[*i], &forms[*j], OVERVIEW_SAMPLES, 1);
            matches.first().map_or(f32::INFINITY, |matched| matched.cost)
        })
        .collect();
    let mut sums = vec![0.0; count];
    for ((i, j), cost) in pairs.iter().zip(costs) {
        sums[*i] += cost;
        sums[*j] += cost;
    }
    (0..count).fold(0, |best, pose| if sums[pose] < sums[best] { pose } else { best })
}

fn looks_mirrored(reference: &Form, ring: &Ring, form: &Form) -> bool {
    let best = |other: &Form| {
        let matches = coarse_matches(reference, other, OVERVIEW_SAMPLES, 1);
        matches.first().map_or(f32::INFINITY, |matched| matched.cost)
    };
    Form::mirrored(ring).is_ok_and(|mirrored| best(&mirrored) < MIRROR_MARGIN * best(form))
}

/// Gives the reference every landmark that it lacks: the mean of where the matches of the poses that have it put it.
fn carry_to_reference(forms: &[Form], reference: usize, landmarks: &mut [Landmark]) -> Result<(), MatchError> {
    while let Some(missing) = landmarks.iter().position(|l| l.at[reference].is_none()) {
        let having: Vec<usize> = (0..forms.len())
            .filter(|pose| landmarks[missing].at[*pose].is_some())
            .collect();
        // A landmark of one pose, or of none, ties nothing together.
        if having.len() < 2 {
            landmarks[missing].at.fill(None);
            landmarks[missing].at[reference] = Some(f64::NAN);
            continue;
        }
        let settled: Vec<Landmark> = landmarks
            .iter()
            .filter(|l| l.at[reference].is_some_and(f64::is_finite))
            .cloned()
            .collect();
        let (frame, matches) = match_some(forms, reference, &settled, &having)?;
        let mut first = None;
        let mut offset = 0.0;
        for pose in &having {
            let (Some(matched), Some(t)) = (&matches[*pose], landmarks[missing].at[*pose]) else {
                continue;
            };
            let back = CyclicMap::through(matched.parameters.clone(), frame.clone());
            let place = back.at(t);
            let anchor = *first.get_or_insert(place);
            // The mean of nearby places of a circle, relative to the first of them.
            offset += place - anchor - (place - anchor).round();
        }
        let place = first.unwrap_or(0.0) + offset / having.len() as f64;
        landmarks[missing].at[reference] = Some(place.rem_euclid(1.0) % 1.0);
    }
    for landmark in landmarks.iter_mut() {
        if landmark.at[reference].is_some_and(f64::is_nan) {
            landmark.at[reference] = None;
        }
    }
    Ok(())
}

type Matches = (Vec<f64>, Vec<Option<PairMatch>>);

fn match_all(forms: &[Form], reference: usize, landmarks: &[Landmark]) -> Result<Matches, MatchError> {
    let all: Vec<usize> = (0..forms.len()).collect();
    match_some(forms, reference, landmarks, &all)
}

/// The reference's parameters by row, and the matches of some poses to them; the reference itself has none.
fn match_some(
    forms: &[Form],
    reference: usize,
    landmarks: &[Landmark],
    wanted: &[usize],
) -> Result<Matches, MatchError> {
    let mut placed: Vec<f64> = landmarks.iter().filter_map(|l| l.at[reference]).collect();
    placed.sort_by(f64::total_cmp);
    let frame = Reference::new(&forms[reference], &placed);
    let matches = (0..forms.len())
        .into_par_iter()
        .map(|pose| {
            if pose == reference || !wanted.contains(&pose) {
                return Ok(None);
            }
            let mut pins: Vec<Pin> = landmarks
                .iter()
                .filter_map(|l| {
                    let (at_reference, parameter) = (l.at[reference]?, l.at[pose]?);
                    let row = frame.row_of(at_reference)?;
                    Some(Pin { row, parameter })
                })
                .collect();
            pins.sort_by_key(|pin| pin.row);
            let mut matched = frame
                .match_pose(&forms[pose], &pins)
                .ok_or(MatchError::NoMatch { pose })?;
            for pin in &pins {
                // Exactly as given, not as rounded on the way.
                let turns = (matched.parameters[pin.row] - pin.parameter).round();
                matched.parameters[pin.row] = pin.parameter + turns;
            }
            Ok(Some(matched))
        })
        .collect::<Result<Vec<_>, MatchError>>()?;
    Ok((frame.rows, matches))
}

#[cfg(test)]
mod tests;
