//! Where a thing that a pose lacks grows from there, and shrinks to.
//!
//! 1. Of the things that both the pose and one that has it know, the nearest to it is its neighbour.
//! 2. A thing like its neighbour, in colour and roughly in size or in size and form, comes out of it: a drop that divides. It begins in
//!    the neighbour's middle.
//! 3. Any other begins where it would be if it had moved with its neighbour, and grown with the whole figure: an eyebrow that appears
//!    above its eye.

use super::{PartGroups, PartShape};
use crate::math::Point;

/// The most by which mean channels of things of one kind differ, from black to white.
const SAME_COLOUR: f64 = 0.12;
/// The most by which areas of things of one kind and colour differ, as a factor.
const SIMILAR_SIZE: f64 = 6.0;
/// The most by which areas of things of one kind differ, whatever their colours, as a factor.
const SAME_SIZE: f64 = 1.3;
/// The most by which their elongations differ.
const SAME_FORM: f64 = 0.15;

/// Where a thing begins in a pose that lacks it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Origin {
    /// The pose that it is a copy of there: the first that has it.
    pub of: usize,
    /// Where it begins, in source units of the pose that lacks it.
    pub place: Point,
}

/// Where thing `thing` begins in pose `pose`, which lacks it. `None` if no pose has it.
#[must_use]
pub(crate) fn origin(groups: &PartGroups, poses: &[Vec<PartShape>], thing: usize, pose: usize) -> Option<Origin> {
    let (of, own) =
        (groups.things[thing].iter().enumerate()).find_map(|(other, part)| Some((other, &poses[other][(*part)?])))?;
    let neighbours = groups.things.iter().filter_map(|other| {
        let (there, here) = (&poses[of][other[of]?], &poses[pose][other[pose]?]);
        Some((gap(own, there), there, here))
    });
    let Some((_, there, here)) = neighbours.min_by(|a, b| a.0.total_cmp(&b.0)) else {
        // Nothing in common: where it is.
        return Some(Origin {
            of,
            place: own.centroid,
        });
    };
    let is_within = |factor: f64| (1.0 / factor..factor).contains(&(own.area / there.area));
    let has_colour = (own.colour.iter().zip(&there.colour)).all(|(a, b)| (a - b).abs() < SAME_COLOUR);
    let has_form = (own.elongation - there.elongation).abs() < SAME_FORM;
    let place = if has_colour && is_within(SIMILAR_SIZE) || has_form && is_within(SAME_SIZE) {
        here.centroid
    } else {
        let area = |parts: &[PartShape]| -> f64 { parts.iter().map(|part| part.area).sum() };
        let scale = (area(&poses[pose]) / area(&poses[of])).sqrt();
        here.centroid + (own.centroid - there.centroid) * scale
    };
    Some(Origin { of, place })
}

/// How far the boxes of two parts are apart; by their middles where they meet.
fn gap(a: &PartShape, b: &PartShape) -> f64 {
    let between = (b.bounds[0] - a.bounds[1])
        .sup(&(a.bounds[0] - b.bounds[1]))
        .sup(&Point::zeros());
    // A small part of the way between the middles decides among those that meet.
    between.norm() + 1e-3 * (a.centroid - b.centroid).norm()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(x: f64, y: f64, side: f64, colour: [f64; 4]) -> PartShape {
        let centroid = Point::new(x, y);
        let half = Point::repeat(0.5 * side);
        PartShape {
            area: side * side,
            centroid,
            bounds: [centroid - half, centroid + half],
            colour,
            elongation: 0.0,
            landmarks: vec![],
        }
    }

    const SKIN: [f64; 4] = [0.9, 0.7, 0.6, 1.0];
    const INK: [f64; 4] = [0.1, 0.1, 0.1, 1.0];

    #[test]
    fn a_drop_comes_out_of_the_one_that_divides_and_an_eyebrow_above_its_head() {
        let groups = PartGroups {
            things: vec![vec![Some(0), Some(0)], vec![None, Some(1)]],
            dust: vec![vec![], vec![]],
        };
        let divided = [
            vec![part(50.0, 50.0, 20.0, SKIN)],
            vec![part(30.0, 50.0, 14.0, SKIN), part(70.0, 50.0, 14.0, SKIN)],
        ];
        let place = Point::new(50.0, 50.0);
        assert_eq!(origin(&groups, &divided, 1, 0), Some(Origin { of: 1, place }));
        let raised = [
            vec![part(150.0, 50.0, 40.0, SKIN)],
            vec![part(50.0, 50.0, 40.0, SKIN), part(55.0, 20.0, 6.0, INK)],
        ];
        let found = origin(&groups, &raised, 1, 0).expect("an origin");
        assert!((found.place - Point::new(155.0, 20.0)).norm() < 0.5, "{found:?}");
    }
}
