//! Landmarks: points that an artist names on several poses.

use super::MatchError;
use crate::math::wrapped;
use crate::outline::parameter_gap;

/// Landmarks nearer to one another than this, in perimeters, are at the same place: less than a tenth of a pixel on any
/// drawing, and far more than rounding.
const COINCIDENT: f64 = 1e-5;

/// A point of the outline named on some or all poses.
#[derive(Debug, Clone, PartialEq)]
pub struct Landmark {
    /// Its name.
    pub name: String,
    /// For each pose, the normalised arc-length parameter of its place on the ring; `None` where the pose lacks it.
    pub at: Vec<Option<f64>>,
}

/// The landmarks with parameters in `[0, 1)`, proven to be in one cyclic order on all poses.
///
/// # Errors
/// [`MatchError`] that names the landmark and the pose.
pub(super) fn validated(landmarks: &[Landmark], poses: usize) -> Result<Vec<Landmark>, MatchError> {
    let mut valid = landmarks.to_vec();
    for landmark in &mut valid {
        if landmark.at.len() != poses {
            return Err(MatchError::LandmarkEntries {
                landmark: landmark.name.clone(),
                found: landmark.at.len(),
                expected: poses,
            });
        }
        for (pose, at) in landmark.at.iter_mut().enumerate() {
            if let Some(t) = at {
                if !t.is_finite() {
                    return Err(MatchError::LandmarkPlace {
                        landmark: landmark.name.clone(),
                        pose,
                    });
                }
                *t = wrapped(*t) % 1.0;
            }
        }
    }
    for pose in 0..poses {
        refuse_coincident(&valid, pose)?;
        for other in 0..pose {
            refuse_disorder(&valid, pose, other)?;
        }
    }
    Ok(valid)
}

fn refuse_coincident(landmarks: &[Landmark], pose: usize) -> Result<(), MatchError> {
    let mut placed: Vec<(f64, &str)> = landmarks
        .iter()
        .filter_map(|l| Some((l.at[pose]?, l.name.as_str())))
        .collect();
    placed.sort_by(|a, b| a.0.total_cmp(&b.0));
    for k in 0..placed.len() {
        let ((a, first), (b, second)) = (placed[k], placed[(k + 1) % placed.len()]);
        if placed.len() > 1 && parameter_gap(a, b) < COINCIDENT {
            return Err(MatchError::LandmarksCoincide {
                first: first.to_owned(),
                second: second.to_owned(),
                pose,
            });
        }
    }
    Ok(())
}

fn refuse_disorder(landmarks: &[Landmark], pose: usize, other: usize) -> Result<(), MatchError> {
    let mut shared: Vec<(f64, f64, usize)> = landmarks
        .iter()
        .enumerate()
        .filter_map(|(index, l)| Some((l.at[other]?, l.at[pose]?, index)))
        .collect();
    shared.sort_by(|a, b| a.0.total_cmp(&b.0));
    let parameters: Vec<f64> = shared.iter().map(|s| s.1).collect();
    if descents(&parameters) <= 1 {
        return Ok(());
    }
    // The one to blame is the one without which the order would be possible.
    let culprit = (0..shared.len())
        .find(|without| {
            let mut rest = parameters.clone();
            rest.remove(*without);
            descents(&rest) <= 1
        })
        .or_else(|| (0..shared.len()).find(|k| parameters[(k + 1) % shared.len()] < parameters[*k]))
        .unwrap_or(0);
    Err(MatchError::LandmarkOrder {
        landmark: landmarks[shared[culprit].2].name.clone(),
        pose,
        other,
    })
}

/// How often a cyclic sequence falls; once if it runs around once.
fn descents(values: &[f64]) -> usize {
    (0..values.len())
        .filter(|k| values[(k + 1) % values.len()] < values[*k])
        .count()
}
