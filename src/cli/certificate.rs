//! Certificates of frames as JSON, and what they say in words.

use inbetween::blend::{Certificate, Distortion};
use inbetween::math::Point;
use serde::Serialize;

/// A certificate's fields. What is not finite is `null`.
#[derive(Serialize)]
pub(crate) struct CertificateText {
    positive: bool,
    simple: bool,
    overlaps: Vec<[String; 2]>,
    largest_distortion: f64,
    largest_area: f64,
    of_poses: PosesText,
}

#[derive(Serialize)]
struct PosesText {
    distortion: f64,
    area: f64,
}

impl CertificateText {
    /// The worst of some certificates; of one, what it says. Of none, what holds of a frame in which nothing is seen.
    pub(crate) fn worst_of<'a>(certificates: impl Iterator<Item = &'a Certificate> + Clone) -> Self {
        let worst =
            |of: fn(&Certificate) -> Distortion| certificates.clone().map(of).fold(Distortion::NONE, Distortion::max);
        let (largest, of_poses) = (worst(|c| c.largest), worst(|c| c.of_poses));
        let overlaps = certificates.clone().flat_map(|certificate| &certificate.overlaps);
        Self {
            positive: certificates.clone().all(|certificate| certificate.positive),
            simple: certificates.clone().all(|certificate| certificate.simple),
            overlaps: overlaps.map(|overlap| overlap.limbs.clone()).collect(),
            largest_distortion: largest.distortion,
            largest_area: largest.area,
            of_poses: PosesText {
                distortion: of_poses.distortion,
                area: of_poses.area,
            },
        }
    }
}

/// What is broken in a frame whose vertices are at `positions` (#vertices), where, and what helps; nothing if the certificate holds. `repair` is what switches the guard on,
/// unless it is on.
pub(crate) fn defect(
    certificate: &Certificate,
    triangles: &[[usize; 3]],
    positions: &[Point],
    repair: Option<&str>,
) -> Option<String> {
    let near = |place: Point| format!("near ({:.1}, {:.1})", place.x, place.y);
    let inverted = certificate.inverted.first().map(|&triangle| {
        let corners = triangles[triangle].map(|vertex| positions[vertex]);
        let remedy = repair.map_or_else(
            || "the guard found no way; a pose between, or landmarks where the poses differ most, help".to_owned(),
            |repair| format!("{repair} repairs it"),
        );
        format!(
            "{} not positive, the first, number {triangle}, {} of the drawings; {remedy}",
            match certificate.inverted_count {
                1 => "1 triangle is".to_owned(),
                count => format!("{count} triangles are"),
            },
            near(corners.iter().sum::<Point>() / 3.0)
        )
    });
    let crossed = certificate.crossings.first().map(|crossing| {
        let [[a, b], [c, d]] = crossing.edges;
        format!(
            "the outline crosses itself {}, the first time {} of the drawings, where the edge from vertex {a} to {b} meets that from {c} to {d}; landmarks on the parts \
             that meet, or a pose between that leads them past one another, help",
            match certificate.crossing_count {
                1 => "once".to_owned(),
                count => format!("{count} times"),
            },
            near(crossing.place)
        )
    });
    let found: Vec<String> = inverted.into_iter().chain(crossed).collect();
    (!found.is_empty()).then(|| found.join("; "))
}
