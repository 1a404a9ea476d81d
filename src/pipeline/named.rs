//! What the names of SVG elements say of the correspondence.
//!
//! An artist who copies a drawing and moves its curves leaves ids and path commands as they were. So where two drawings have an element with the
//! same id and the same commands, its points correspond one by one; where the commands differ, the middles of small elements do. Only what is
//! seen counts: points that later elements cover, in either drawing, say nothing of what is drawn there.

use crate::input::{ArtElement, Drawing, Subpath};
use crate::math::Point;
use crate::math::point::bounding_box;
use crate::outline::Ring;

/// An element is small if its box has at most this share of the figure's diagonal: wherever its middle is exactly, it is there.
const SMALL: f64 = 0.12;
/// Straight pieces that stand for a curve where it is asked what covers a point.
const PIECES: usize = 6;
/// Opacity from which an element hides what is behind it.
const OPAQUE: f64 = 0.6;
/// Points of one element that are used at most, evenly taken.
const MOST_POINTS: usize = 96;

/// Places of two drawings that correspond by the names of their elements; none where one of them is no SVG drawing or has no names.
pub(super) fn named_pairs(first: &Drawing, second: &Drawing) -> Vec<[Point; 2]> {
    let (Some(one), Some(other)) = (&first.art, &second.art) else {
        return Vec::new();
    };
    let (covers, other_covers) = (covers(&one.elements), covers(&other.elements));
    let diagonal = first.outline.diagonal();
    let mut pairs = Vec::new();
    for (k, element) in one
        .elements
        .iter()
        .enumerate()
        .filter(|(_, e)| e.id.is_some() && e.opacity > 0.0)
    {
        let twin = other
            .elements
            .iter()
            .position(|e| e.id == element.id && e.opacity > 0.0);
        let Some(j) = twin else {
            continue;
        };
        let found = corresponding(element, &other.elements[j], diagonal);
        let stride = found.len().div_ceil(MOST_POINTS).max(1);
        let is_seen = |&[a, b]: &[Point; 2]| !is_covered(&covers[k + 1..], a) && !is_covered(&other_covers[j + 1..], b);
        pairs.extend(found.into_iter().step_by(stride).filter(is_seen));
    }
    pairs
}

/// Places that correspond in two elements of one name.
fn corresponding(first: &ArtElement, second: &ArtElement, diagonal: f64) -> Vec<[Point; 2]> {
    let commands = |element: &ArtElement| -> Vec<(usize, bool)> {
        let subpaths = element.subpaths.iter();
        subpaths
            .map(|subpath| (subpath.cubics.len(), subpath.is_closed))
            .collect()
    };
    if commands(first) == commands(second) {
        let places = |element: &ArtElement| -> Vec<Point> {
            element.subpaths.iter().flat_map(Subpath::ends_and_middles).collect()
        };
        return places(first)
            .into_iter()
            .zip(places(second))
            .map(|(a, b)| [a, b])
            .collect();
    }
    let boxed = |element: &ArtElement| bounding_box(element.subpaths.iter().flat_map(Subpath::points));
    match (boxed(first), boxed(second)) {
        (Some((low, high)), Some((other_low, other_high))) if (high - low).norm() <= SMALL * diagonal => {
            vec![[(low + high) * 0.5, (other_low + other_high) * 0.5]]
        }
        _ => Vec::new(),
    }
}

/// What an element hides: nothing, or what is inside these polygons.
type Cover = Vec<Ring>;

fn covers(elements: &[ArtElement]) -> Vec<Cover> {
    let cover = |element: &ArtElement| -> Cover {
        if element.fill.is_none() || element.opacity < OPAQUE {
            return Vec::new();
        }
        // Without three distinct points nothing is inside.
        let rings = element.subpaths.iter().map(|subpath| Ring::new(flattened(subpath)));
        rings.filter_map(Result::ok).collect()
    };
    elements.iter().map(cover).collect()
}

fn flattened(subpath: &Subpath) -> Vec<Point> {
    let mut places = vec![subpath.start];
    let mut from = subpath.start;
    for &[a, b, to] in &subpath.cubics {
        for k in 1..=PIECES {
            let t = k as f64 / PIECES as f64;
            let s = 1.0 - t;
            places.push(from * (s * s * s) + a * (3.0 * s * s * t) + b * (3.0 * s * t * t) + to * (t * t * t));
        }
        from = to;
    }
    places
}

/// Whether any of the covers has the point inside, by the even-odd rule.
fn is_covered(covers: &[Cover], p: Point) -> bool {
    let is_inside = |cover: &Cover| cover.iter().filter(|ring| ring.contains(p)).count() % 2 == 1;
    covers.iter().any(is_inside)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::{SvgOptions, read_svg};

    fn drawing(inside: &str) -> Drawing {
        let svg = format!(
            r##"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100"><rect id="body" x="10" y="10" width="80" height="80" fill="#888"/>{inside}</svg>"##
        );
        read_svg(svg.as_bytes(), &SvgOptions::default()).expect("a drawing")
    }

    #[test]
    fn equal_commands_correspond_point_by_point_and_small_elements_by_their_middles() {
        let first = drawing(r#"<circle id="eye" cx="30" cy="30" r="5"/><path id="nose" d="M50 50l2 4h-4z"/>"#);
        let second = drawing(r#"<circle id="eye" cx="60" cy="40" r="5"/><path id="nose" d="M70 52l2 4l-2 2l-2 -2z"/>"#);
        let pairs = named_pairs(&first, &second);
        let offsets = |near: Point| -> Vec<Point> {
            let of = pairs.iter().filter(|[a, _]| (a - near).norm() < 6.0);
            of.map(|[a, b]| b - a).collect()
        };
        let eye = offsets(Point::new(30.0, 30.0));
        assert!(
            eye.len() >= 8 && eye.iter().all(|d| (d - Point::new(30.0, 10.0)).norm() < 1e-3),
            "{eye:?}"
        );
        assert_eq!(offsets(Point::new(50.0, 52.0)), [Point::new(20.0, 3.0)]);
        // The body's corners, which nothing covers.
        assert!(offsets(Point::new(10.0, 10.0)).contains(&Point::zeros()));
    }

    #[test]
    fn what_is_covered_says_nothing() {
        let with_hat = |x: f64| {
            drawing(&format!(
                r#"<circle id="eye" cx="{x}" cy="30" r="5"/><rect id="mask" x="15" y="15" width="70" height="30"/>"#
            ))
        };
        let pairs = named_pairs(&with_hat(30.0), &with_hat(60.0));
        assert!(pairs.iter().all(|[a, b]| (a - b).norm() < 1e-9), "{pairs:?}");
    }
}
