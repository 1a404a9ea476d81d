//! Loose parts: which pieces of a drawing belong to it, and which of them is its body.
//!
//! A drawing's outline is that of its largest piece. What lies apart from it is dirt (a few pixels), or a loose part, which is handed on with
//! an outline and paint of its own ([`LoosePart`]): whoever has all drawings can tell which parts they have in common.

use super::{InputError, InputNote, PartOptions, PartRule, PlaceRule};
use crate::math::Point;

/// The most loose parts that are handed on, the largest of them.
const MOST_LOOSE: usize = 64;

/// A piece before it is an outline.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    pub(super) area: f64,
    pub(super) centroid: Point,
}

/// The pieces that are used, by index.
#[derive(Debug, PartialEq)]
pub(super) struct Chosen {
    pub(super) largest: usize,
    /// All others that are handed on, with whether they were asked for, in the order of the pieces.
    pub(super) loose: Vec<(usize, bool)>,
    /// Those that do not belong to the drawing.
    pub(super) dropped: Vec<usize>,
    /// Places that name none of the pieces.
    passed_over: Vec<Point>,
}

/// Chooses among the pieces of a drawing, of which `strips` belong to the sheet unless they are asked for. `dirt` is the area below which
/// a piece of a drawing whose largest has the given area is dirt; `at` says which piece a place means. `None` where there is no piece.
pub(super) fn choose(
    pieces: &[Piece],
    strips: &[usize],
    options: &PartOptions,
    dirt: impl Fn(f64) -> f64,
    at: impl Fn(Point) -> Option<usize>,
) -> Result<Option<Chosen>, InputError> {
    let by_area = |a: &usize, b: &usize| pieces[*a].area.total_cmp(&pieces[*b].area).then(b.cmp(a));
    let whole = (0..pieces.len())
        .filter(|piece| !strips.contains(piece))
        .max_by(by_area);
    let mut passed_over = Vec::new();
    let mut named = |places: &[Point], spared: Option<usize>| -> Result<Vec<usize>, InputError> {
        let mut named = Vec::new();
        for &place in places {
            match at(place).filter(|piece| Some(*piece) != spared) {
                Some(piece) => named.push(piece),
                None if options.places == PlaceRule::SeveralDrawings => passed_over.push(place),
                None => return Err(InputError::NoPartThere { x: place.x, y: place.y }),
            }
        }
        Ok(named)
    };
    let spared = whole.filter(|_| options.places == PlaceRule::SeveralDrawings);
    let (kept, mut dropped) = (named(&options.keep, None)?, named(&options.drop, spared)?);
    dropped.extend(strips.iter().filter(|strip| !kept.contains(strip)));
    let is_left = |piece: &usize| !dropped.contains(piece);
    let Some(largest) = (0..pieces.len()).filter(is_left).max_by(by_area) else {
        return match pieces.is_empty() {
            true => Ok(None),
            false => Err(InputError::AllDropped),
        };
    };
    let least = dirt(pieces[largest].area);
    let is_part = |piece: &usize| options.rule == PartRule::Apart && pieces[*piece].area >= least;
    let mut loose: Vec<usize> = (0..pieces.len())
        .filter(|piece| *piece != largest && is_left(piece) && (kept.contains(piece) || is_part(piece)))
        .collect();
    loose.sort_by(|a, b| kept.contains(b).cmp(&kept.contains(a)).then(by_area(b, a)));
    loose.truncate(MOST_LOOSE);
    loose.sort_unstable();
    Ok(Some(Chosen {
        largest,
        loose: loose.into_iter().map(|piece| (piece, kept.contains(&piece))).collect(),
        dropped,
        passed_over,
    }))
}

/// What is said of the pieces that the outline goes without.
pub(super) fn note_pieces(pieces: &[Piece], chosen: &Chosen, dirt: f64, notes: &mut Vec<InputNote>) {
    notes.extend(
        chosen
            .passed_over
            .iter()
            .map(|&place| InputNote::PlacePassedOver { place }),
    );
    let others = (0..pieces.len()).filter(|piece| *piece != chosen.largest && !chosen.dropped.contains(piece));
    let (specks, loose): (Vec<Piece>, Vec<Piece>) = others.map(|k| pieces[k]).partition(|piece| piece.area < dirt);
    let area = |pieces: &[Piece]| pieces.iter().map(|piece| piece.area).sum();
    if let Some(most) = loose.iter().copied().reduce(|a, b| if b.area > a.area { b } else { a }) {
        notes.push(InputNote::PartsLeftOut {
            count: loose.len(),
            area: area(&loose),
            place: most.centroid,
        });
    }
    if !specks.is_empty() {
        notes.push(InputNote::SpecksLeftOut {
            count: specks.len(),
            area: area(&specks),
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pieces(areas: &[f64]) -> Vec<Piece> {
        let piece = |(k, &area): (usize, &f64)| Piece {
            area,
            centroid: Point::new(10.0 * k as f64, 0.0),
        };
        areas.iter().enumerate().map(piece).collect()
    }

    fn chosen(areas: &[f64], options: &PartOptions) -> Result<Option<Chosen>, InputError> {
        let at = |place: Point| (place.y == 0.0).then_some((place.x / 10.0) as usize);
        choose(&pieces(areas), &[], options, |area| 0.01 * area, at)
    }

    #[test]
    fn dirt_stays_away_unless_it_is_asked_for() {
        let areas = [5.0, 1000.0, 200.0];
        let loose = |options: &PartOptions| chosen(&areas, options).expect("a choice").map(|chosen| chosen.loose);
        assert_eq!(loose(&PartOptions::default()), Some(vec![(2, false)]));
        let keep = vec![Point::zeros()];
        let kept = PartOptions {
            keep: keep.clone(),
            ..PartOptions::default()
        };
        assert_eq!(loose(&kept), Some(vec![(0, true), (2, false)]));
        let rule = PartRule::Largest;
        let options = PartOptions {
            rule,
            keep,
            ..PartOptions::default()
        };
        assert_eq!(loose(&options), Some(vec![(0, true)]));
    }

    #[test]
    fn what_is_dropped_is_not_the_largest_either() {
        let options = |x: &[f64]| PartOptions {
            drop: x.iter().map(|x| Point::new(*x, 0.0)).collect(),
            ..PartOptions::default()
        };
        let largest = |options| {
            chosen(&[5.0, 1000.0, 200.0], &options)
                .expect("a choice")
                .map(|chosen| chosen.largest)
        };
        assert_eq!(largest(options(&[10.0])), Some(2));
        assert!(matches!(
            chosen(&[5.0, 9.0], &options(&[0.0, 10.0])),
            Err(InputError::AllDropped)
        ));
        let beside = PartOptions {
            keep: vec![Point::new(3.0, 7.0)],
            ..PartOptions::default()
        };
        assert!(matches!(chosen(&[5.0], &beside), Err(InputError::NoPartThere { .. })));
        assert_eq!(chosen(&[], &PartOptions::default()).expect("nothing"), None);
    }

    #[test]
    fn places_of_several_drawings_are_passed_over_where_they_name_nothing_and_never_take_the_whole_away() {
        let nowhere = Point::new(3.0, 7.0);
        let [speck, whole, part] = [0.0, 10.0, 20.0].map(|x| Point::new(x, 0.0));
        let options = PartOptions {
            keep: vec![speck, nowhere],
            drop: vec![part, whole],
            places: PlaceRule::SeveralDrawings,
            ..PartOptions::default()
        };
        let found = chosen(&[5.0, 1000.0, 200.0], &options)
            .expect("a choice")
            .expect("pieces");
        assert_eq!((found.largest, found.loose.as_slice()), (1, &[(0, true)][..]));
        assert_eq!(found.passed_over, [nowhere, whole]);
    }
}
