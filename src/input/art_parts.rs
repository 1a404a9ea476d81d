//! The curves of a drawing divided among its pieces.
//!
//! Art and the outlines of the pieces -> for every subpath the piece that it belongs to.
//!
//! 1. A subpath whose box meets that of one piece alone belongs to that piece.
//! 2. Otherwise points along it are asked for the piece in which they lie or which is nearest, and the subpath belongs to the piece that
//!    is nearest to all of them. If a point is further from it than [`SLACK`] of the drawing's diagonal and half the line's width, the
//!    subpath is in several pieces, as a dashed line is, and the drawing cannot be divided as curves.
//!
//! Cost: O(#points of the subpaths in question x #points of the outlines).

use super::{Art, ArtElement, Subpath};
use crate::math::{Point, point};
use crate::outline::{ArcLength, Outline};

/// How far from its piece a curve may be, as a fraction of the drawing's diagonal: flattening and the patches of outlines that touch
/// themselves.
const SLACK: f64 = 2e-3;

/// Which piece each subpath of each element belongs to.
#[derive(Debug)]
pub(super) struct DividedArt<'a> {
    art: &'a Art,
    pieces: Vec<Vec<usize>>,
}

impl<'a> DividedArt<'a> {
    /// Divides `art` among pieces with these outer polygons and holes.
    ///
    /// # Errors
    /// Which element is in several pieces.
    pub(super) fn new(art: &'a Art, outlines: &[Outline]) -> Result<Self, String> {
        let pieces: Vec<PieceShape> = outlines.iter().map(PieceShape::new).collect();
        let all = outlines.iter().flat_map(|outline| outline.outer().points());
        let slack = SLACK * point::diagonal(all);
        let of_element = |element: &ArtElement| -> Result<Vec<usize>, String> {
            let width = element.stroke.as_ref().map_or(0.0, |stroke| stroke.width);
            let is_seen = element.opacity > 0.0 && (element.fill.is_some() || element.stroke.is_some());
            let of_subpath = |subpath: &Subpath| piece_of(subpath, &pieces, slack + 0.5 * width);
            let found = element.subpaths.iter().map(|subpath| {
                let (piece, is_within) = of_subpath(subpath);
                if is_seen && !is_within {
                    let name = element.id.as_deref().unwrap_or("without a name");
                    return Err(format!("element '{name}' is in several loose parts"));
                }
                Ok(piece)
            });
            found.collect()
        };
        Ok(Self {
            pieces: art.elements.iter().map(of_element).collect::<Result<_, _>>()?,
            art,
        })
    }

    /// The art in the pieces that are `wanted`.
    pub(super) fn only(&self, wanted: impl Fn(usize) -> bool) -> Art {
        let elements = self
            .art
            .elements
            .iter()
            .zip(&self.pieces)
            .filter_map(|(element, pieces)| {
                let own = element.subpaths.iter().zip(pieces).filter(|(_, piece)| wanted(**piece));
                let subpaths: Vec<Subpath> = own.map(|(subpath, _)| subpath.clone()).collect();
                (!subpaths.is_empty()).then(|| ArtElement {
                    subpaths,
                    id: element.id.clone(),
                    fill: element.fill.clone(),
                    stroke: element.stroke.clone(),
                    opacity: element.opacity,
                })
            });
        Art {
            elements: elements.collect(),
        }
    }

    /// The place of the first element of a piece in the drawing order; the number of elements if it has none.
    pub(super) fn first_of(&self, piece: usize) -> usize {
        let found = self.pieces.iter().position(|pieces| pieces.contains(&piece));
        found.unwrap_or(self.pieces.len())
    }
}

struct PieceShape<'a> {
    outline: &'a Outline,
    rings: Vec<ArcLength>,
    bounds: (Point, Point),
}

impl<'a> PieceShape<'a> {
    fn new(outline: &'a Outline) -> Self {
        Self {
            outline,
            rings: outline.rings().iter().map(ArcLength::new).collect(),
            bounds: point::bounding_box(outline.outer().points()).unwrap_or_default(),
        }
    }

    fn distance(&self, p: Point) -> f64 {
        if self.outline.contains(p) {
            return 0.0;
        }
        self.rings
            .iter()
            .map(|ring| ring.nearest(p).1)
            .fold(f64::INFINITY, f64::min)
    }

    fn meets(&self, low: Point, high: Point, slack: f64) -> bool {
        let (own_low, own_high) = self.bounds;
        let (a, b) = (own_low.sup(&low), own_high.inf(&high));
        a.x <= b.x + slack && a.y <= b.y + slack
    }
}

/// The piece that a subpath belongs to, and whether it lies in it.
fn piece_of(subpath: &Subpath, pieces: &[PieceShape<'_>], slack: f64) -> (usize, bool) {
    let on_curve = subpath.ends_and_middles();
    let (low, high) = point::bounding_box(&on_curve).unwrap_or_default();
    let near: Vec<usize> = (0..pieces.len())
        .filter(|&k| pieces[k].meets(low, high, slack))
        .collect();
    if let [only] = near[..] {
        return (only, true);
    }
    let farthest = |k: usize| on_curve.iter().map(|p| pieces[k].distance(*p)).fold(0.0, f64::max);
    let asked = if near.is_empty() {
        (0..pieces.len()).collect()
    } else {
        near
    };
    let distances = asked.into_iter().map(|k| (k, farthest(k)));
    let nearest = distances.min_by(|a, b| a.1.total_cmp(&b.1));
    nearest.map_or((0, true), |(piece, distance)| (piece, distance <= slack))
}
