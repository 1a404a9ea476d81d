//! Which ring of the outlines a landmark is on: none of them, the outer one, or the rim of a hole.
//!
//! 1. Deeper inside than [`INTERIOR_DEPTH`] on every pose that has it, a landmark is an interior one.
//! 2. Otherwise it is on the outer rings, or on rims, whichever of the two it can be snapped to on all of these poses; where both can be, as
//!    where a wall between outline and hole is thin, on those that it is nearer to in all.
//! 3. Otherwise it is refused: there is a pose where it is at another kind of place than elsewhere, or at none.

use super::PipelineError;
use super::error::LandmarkPlace;
use super::landmarks::{as_drawn, as_used};
use super::spec::LayerSpec;
use crate::matching::{HoleTieError, HoleTies};
use crate::math::Point;
use crate::outline::{ArcLength, Outline, parameter_gap};

/// How far a landmark may lie from the ring it is snapped to, as a fraction of the pose's diagonal: a few times the
/// width of an ink line.
const LANDMARK_REACH: f64 = 0.03;

/// A landmark that in every pose lies inside the shape by more than this, as a fraction of the diagonal, is an interior
/// one: about the width of an ink line.
pub const INTERIOR_DEPTH: f64 = 0.01;

/// A landmark this near to a vertex of the outline, in perimeters, is at that vertex: half a pixel of an outline of two
/// thousand. The mesh has vertices at both, and the edge between would be as short as what the artist's decimals leave.
const CORNER_REACH: f64 = 2.5e-4;

/// The outline of a pose, measured.
pub(super) struct MeasuredOutline<'a> {
    outline: &'a Outline,
    rings: Vec<ArcLength>,
    /// Its diagonal.
    size: f64,
}

impl<'a> MeasuredOutline<'a> {
    pub(super) fn new(outline: &'a Outline) -> Self {
        Self {
            outline,
            rings: outline.rings().iter().map(ArcLength::new).collect(),
            size: outline.diagonal(),
        }
    }
}

/// The place of a ring that is nearest to a landmark.
#[derive(Debug, Clone, Copy)]
pub(super) struct Nearest {
    /// 0 is the outer one.
    pub(super) ring: usize,
    /// Of the nearest point, or a vertex beside it.
    pub(super) parameter: f64,
    /// To that point, in source units.
    pub(super) distance: f64,
}

impl Nearest {
    fn on(ring: usize, curve: &ArcLength, place: Point) -> Self {
        let (nearest, distance) = curve.nearest(place);
        // Of the vertices, the nearer end of the edge that it lies on.
        let corners = curve.vertex_parameters();
        let (edge, _) = curve.locate(nearest);
        let ends = [edge, (edge + 1) % corners.len()].map(|vertex| corners[vertex]);
        let corner = ends
            .into_iter()
            .min_by(|a, b| parameter_gap(*a, nearest).total_cmp(&parameter_gap(*b, nearest)));
        let parameter = corner
            .filter(|t| parameter_gap(*t, nearest) <= CORNER_REACH)
            .unwrap_or(nearest);
        Self {
            ring,
            parameter,
            distance,
        }
    }
}

/// A landmark's place on one pose.
#[derive(Debug, Clone)]
pub(super) struct Found {
    pub(super) place: Point,
    /// On the outer ring.
    pub(super) outer: Nearest,
    /// On the nearest rim, if there is a hole.
    pub(super) rim: Option<Nearest>,
    pub(super) inside: bool,
    /// The pose's diagonal.
    size: f64,
}

impl Found {
    /// A place of the source, on the pose that `measured` is the outline of; `pose` counts the drawn poses.
    pub(super) fn new(layer: &LayerSpec, measured: &MeasuredOutline, pose: usize, place: Point) -> Self {
        let place = as_used(layer, pose, place);
        let nearest = |(ring, curve): (usize, &ArcLength)| Nearest::on(ring, curve, place);
        let rims = measured.rings.iter().enumerate().skip(1).map(nearest);
        Self {
            place,
            outer: nearest((0, &measured.rings[0])),
            rim: rims.min_by(|a, b| a.distance.total_cmp(&b.distance)),
            inside: measured.outline.contains(place),
            size: measured.size,
        }
    }

    /// Whether it is inside and away from the outer ring.
    pub(super) fn is_inward(&self) -> bool {
        self.inside && self.outer.distance > INTERIOR_DEPTH * self.size
    }

    /// Whether it is inside and away from all rings.
    fn is_deep(&self) -> bool {
        self.is_inward() && self.rim.is_none_or(|rim| rim.distance > INTERIOR_DEPTH * self.size)
    }

    /// By how much of the pose's diagonal it is off the outer ring, or off the nearest rim; `None` if that is out of reach.
    fn off(&self, ring: MarkedRing) -> Option<f64> {
        let nearest = match ring {
            MarkedRing::Outer => self.outer,
            MarkedRing::Rim => self.rim?,
        };
        let share = nearest.distance / self.size;
        (share <= LANDMARK_REACH).then_some(share)
    }

    pub(super) fn is_at_outer(&self) -> bool {
        self.off(MarkedRing::Outer).is_some()
    }

    /// What kind of place it is by itself.
    fn kind(&self) -> LandmarkPlace {
        if self.is_deep() {
            return LandmarkPlace::Inside;
        }
        match [self.off(MarkedRing::Outer), self.off(MarkedRing::Rim)] {
            [Some(outer), Some(rim)] if rim < outer => LandmarkPlace::Rim,
            [Some(_), _] => LandmarkPlace::Outline,
            [None, Some(_)] => LandmarkPlace::Rim,
            [None, None] => LandmarkPlace::Nowhere,
        }
    }

    /// The refusal of a landmark that is not where it could be snapped to.
    pub(super) fn off_outline(&self, layer: &LayerSpec, landmark: &str, pose: usize) -> PipelineError {
        let rim = self.rim.map_or(f64::INFINITY, |rim| rim.distance);
        PipelineError::LandmarkOffOutline {
            landmark: landmark.to_owned(),
            pose: layer.poses[pose].name.clone(),
            distance: self.outer.distance.min(rim),
            largest: LANDMARK_REACH * self.size,
            x: self.place.x,
            y: self.place.y,
        }
    }
}

/// Which rings a landmark is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum MarkedRing {
    Outer,
    Rim,
}

/// The rings that a landmark is on; `None` if it lies inside. `found` has one place a pose, as far as it is given; there is one at least.
///
/// # Errors
/// [`PipelineError`] if the places are of different kinds, or one is away from everything.
pub(super) fn marked_ring(
    layer: &LayerSpec,
    landmark: &str,
    found: &[Option<Found>],
    measured: &[MeasuredOutline],
) -> Result<Option<MarkedRing>, PipelineError> {
    if found.iter().flatten().all(Found::is_deep) {
        return Ok(None);
    }
    let total = |ring| -> Option<f64> { found.iter().flatten().map(|found| found.off(ring)).sum() };
    match [total(MarkedRing::Outer), total(MarkedRing::Rim)] {
        [Some(outer), Some(rim)] if rim < outer => Ok(Some(MarkedRing::Rim)),
        [Some(_), _] => Ok(Some(MarkedRing::Outer)),
        [None, Some(_)] => Ok(Some(MarkedRing::Rim)),
        [None, None] => Err(refusal(layer, landmark, found, measured)),
    }
}

/// Why a landmark is on no ring and not inside either.
fn refusal(layer: &LayerSpec, landmark: &str, found: &[Option<Found>], measured: &[MeasuredOutline]) -> PipelineError {
    let given = || (found.iter().enumerate()).filter_map(|(pose, found)| Some((pose, found.as_ref()?)));
    let first_at = |place: LandmarkPlace| given().find(|(_, found)| found.kind() == place);
    let (ring, place) = match first_at(LandmarkPlace::Rim) {
        Some(_) => (MarkedRing::Rim, LandmarkPlace::Rim),
        None => (MarkedRing::Outer, LandmarkPlace::Outline),
    };
    let Some((pose, stray)) = given().find(|(_, found)| found.off(ring).is_none()) else {
        return PipelineError::LandmarkNowhere {
            landmark: landmark.to_owned(),
        };
    };
    let is_covered = || {
        let near = |opening| ArcLength::new(opening).nearest(stray.place).1 <= LANDMARK_REACH * stray.size;
        measured[pose].outline.openings().iter().any(near)
    };
    let stray_place = match stray.kind() {
        LandmarkPlace::Inside if is_covered() => LandmarkPlace::CoveredRim,
        kind => kind,
    };
    let is_plain =
        stray_place == LandmarkPlace::Nowhere || (ring, stray_place) == (MarkedRing::Outer, LandmarkPlace::Inside);
    let Some((other, _)) = first_at(place).filter(|_| !is_plain) else {
        return stray.off_outline(layer, landmark, pose);
    };
    let as_written = as_drawn(layer, pose, stray.place);
    PipelineError::LandmarkPlaces {
        landmark: landmark.to_owned(),
        pose: layer.poses[pose].name.clone(),
        place: stray_place,
        x: as_written.x,
        y: as_written.y,
        other: layer.poses[other].name.clone(),
        other_place: place,
    }
}

/// What the landmarks of a layer of drawn poses say of the holes of their outlines, before it is known which of them all poses have. A landmark that is on
/// a rim in some poses only speaks for these.
///
/// # Errors
/// [`PipelineError`] if landmarks contradict one another.
pub(super) fn hole_ties(layer: &LayerSpec, outlines: &[Outline]) -> Result<HoleTies, PipelineError> {
    let measured: Vec<MeasuredOutline> = outlines.iter().map(MeasuredOutline::new).collect();
    let marks: Vec<Vec<Option<usize>>> = (layer.landmarks.iter())
        .map(|landmark| {
            let places = landmark.at.iter().zip(&measured).enumerate();
            let found: Vec<Option<Found>> = places
                .map(|(pose, (place, measured))| place.map(|place| Found::new(layer, measured, pose, place)))
                .collect();
            let ring = marked_ring(layer, &landmark.name, &found, &measured);
            let is_on_rim = |found: &&Found| match &ring {
                Ok(ring) => *ring == Some(MarkedRing::Rim),
                Err(_) => found.kind() == LandmarkPlace::Rim,
            };
            let hole = |found: &Option<Found>| Some(found.as_ref().filter(is_on_rim)?.rim?.ring - 1);
            found.iter().map(hole).collect()
        })
        .collect();
    let names: Vec<&str> = layer.landmarks.iter().map(|landmark| landmark.name.as_str()).collect();
    HoleTies::new(&marks).map_err(|error| tie_refusal(&layer.names(), &names, error))
}

/// The refusal of landmarks on rims, with the names of the poses and their own.
pub(super) fn tie_refusal(poses: &[String], landmarks: &[&str], error: HoleTieError) -> PipelineError {
    let named = |landmark: usize| landmarks.get(landmark).copied().unwrap_or_default().to_owned();
    let pose_name = |pose: usize| poses.get(pose).cloned().unwrap_or_default();
    match error {
        HoleTieError::Contradiction {
            first,
            second,
            outline,
            other,
        } => PipelineError::LandmarkHoles {
            first: named(first),
            second: named(second),
            pose: pose_name(outline),
            other: other.map(pose_name),
        },
        HoleTieError::NoHoleLeft { landmark, reference } => PipelineError::LandmarkWithoutHole {
            landmark: named(landmark),
            pose: pose_name(reference),
        },
    }
}
