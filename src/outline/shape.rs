//! One pose's shape: an outer ring with holes.

use super::{Ring, simplicity};
use crate::math::Point;

/// Why rings are no outline.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OutlineError {
    /// Two edges cross or touch where they should not. Ring 0 is the outer one.
    #[error(
        "edge {} of ring {} and edge {} of ring {} meet near ({x:.3}, {y:.3}); an outline must not cross or touch itself",
        first.1, first.0, second.1, second.0
    )]
    EdgesMeet {
        /// Ring and edge.
        first: (usize, usize),
        /// Ring and edge.
        second: (usize, usize),
        /// Where, in source units.
        x: f64,
        /// Where, in source units.
        y: f64,
    },
    /// A ring encloses no area.
    #[error("ring {ring} encloses no area")]
    NoArea {
        /// Which ring; 0 is the outer one.
        ring: usize,
    },
    /// A hole lies outside the outer ring, or inside another hole.
    #[error("hole {hole} does not lie directly inside the outer ring")]
    HoleOutside {
        /// Which hole, from 0.
        hole: usize,
    },
}

/// The shape of one pose: a simple outer ring of positive area and simple holes of negative area inside it. No two
/// rings touch.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    rings: Vec<Ring>,
    openings: Vec<Ring>,
}

impl Outline {
    /// An outline from its outer ring and holes. Rings that run the wrong way are reversed.
    ///
    /// # Errors
    /// [`OutlineError`] if edges meet, a ring has no area, or a hole is not inside the outer ring.
    pub fn new(outer: Ring, holes: Vec<Ring>) -> Result<Self, OutlineError> {
        // Asked of the rings as given, so that the edge numbers are the caller's.
        let given: Vec<Ring> = std::iter::once(outer).chain(holes).collect();
        if let Some(meeting) = simplicity::first_meeting(&given) {
            return Err(OutlineError::EdgesMeet {
                first: meeting.first,
                second: meeting.second,
                x: meeting.place.x,
                y: meeting.place.y,
            });
        }
        let mut rings = Vec::with_capacity(given.len());
        for (index, ring) in given.into_iter().enumerate() {
            let area = ring.signed_area();
            if area == 0.0 {
                return Err(OutlineError::NoArea { ring: index });
            }
            rings.push(if (area > 0.0) == (index == 0) {
                ring
            } else {
                ring.reversed()
            });
        }
        for (hole, ring) in rings[1..].iter().enumerate() {
            let inside_another = rings[1..]
                .iter()
                .enumerate()
                .any(|(other, r)| other != hole && r.contains(ring.point(0)));
            if !rings[0].contains(ring.point(0)) || inside_another {
                return Err(OutlineError::HoleOutside { hole });
            }
        }
        Ok(Self {
            rings,
            openings: Vec::new(),
        })
    }

    /// The outer ring.
    #[must_use]
    pub fn outer(&self) -> &Ring {
        &self.rings[0]
    }

    /// The holes.
    #[must_use]
    pub fn holes(&self) -> &[Ring] {
        &self.rings[1..]
    }

    /// The outer ring, then the holes.
    #[must_use]
    pub fn rings(&self) -> &[Ring] {
        &self.rings
    }

    /// What is open in the drawing, but no hole of its outline: a mesh covers it, and the picture's transparency shows it.
    #[must_use]
    pub fn openings(&self) -> &[Ring] {
        &self.openings
    }

    /// The outline with these rings as its openings, in place of those that it has.
    #[must_use]
    pub fn with_openings(mut self, openings: Vec<Ring>) -> Self {
        self.openings = openings;
        self
    }

    /// The outline, and its openings, with every point mapped.
    ///
    /// # Errors
    /// [`OutlineError`] if what comes of it is none.
    pub fn map(&self, mut f: impl FnMut(Point) -> Point) -> Result<Self, OutlineError> {
        let mut mapped = |rings: &[Ring]| -> Result<Vec<Ring>, OutlineError> {
            let rings = rings.iter().enumerate();
            rings
                .map(|(ring, points)| points.map(&mut f).map_err(|_| OutlineError::NoArea { ring }))
                .collect()
        };
        let mut rings = mapped(&self.rings)?;
        let openings = mapped(&self.openings)?;
        let holes = rings.split_off(1);
        Ok(Self::new(rings.swap_remove(0), holes)?.with_openings(openings))
    }

    /// The outline with the holes of the given indices, in that order; its other holes become openings.
    #[must_use]
    pub fn with_holes_in_order(&self, kept: &[usize]) -> Self {
        let holes = self.holes();
        let covered = (0..holes.len()).filter(|hole| !kept.contains(hole));
        let rings = std::iter::once(self.outer()).chain(kept.iter().filter_map(|&hole| holes.get(hole)));
        Self {
            rings: rings.cloned().collect(),
            openings: covered
                .map(|hole| holes[hole].clone())
                .chain(self.openings.iter().cloned())
                .collect(),
        }
    }

    /// The outline with its openings as holes, after those that it has.
    #[must_use]
    pub fn opened(&self) -> Self {
        Self {
            rings: self.rings.iter().chain(&self.openings).cloned().collect(),
            openings: Vec::new(),
        }
    }

    /// The outline without its holes.
    #[must_use]
    pub fn filled(&self) -> Self {
        Self {
            rings: vec![self.rings[0].clone()],
            openings: Vec::new(),
        }
    }

    /// The area, holes subtracted; positive.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.rings.iter().map(Ring::signed_area).sum()
    }

    /// The diagonal of the bounding box: the size that relative tolerances refer to.
    #[must_use]
    pub fn diagonal(&self) -> f64 {
        self.outer().diagonal()
    }

    /// Whether `p` is inside the outer ring and in no hole. Points on a ring may go either way.
    #[must_use]
    pub fn contains(&self, p: Point) -> bool {
        self.rings.iter().fold(false, |inside, ring| inside != ring.contains(p))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[[f64; 2]]) -> Ring {
        Ring::new(points.iter().copied().map(Point::from)).expect("a ring")
    }

    #[test]
    fn winding_is_normalised() {
        let outer = ring(&[[0.0, 0.0], [0.0, 4.0], [4.0, 4.0], [4.0, 0.0]]);
        let hole = ring(&[[1.0, 1.0], [2.0, 1.0], [2.0, 2.0], [1.0, 2.0]]);
        let outline = Outline::new(outer, vec![hole]).expect("an outline");
        assert_eq!(outline.area(), 15.0);
        assert!(outline.outer().signed_area() > 0.0 && outline.holes()[0].signed_area() < 0.0);
        assert!(outline.contains(Point::new(3.0, 3.0)) && !outline.contains(Point::new(1.5, 1.5)));
    }

    #[test]
    fn crossing_and_stray_holes_are_named() {
        let bow_tie = ring(&[[0.0, 0.0], [3.0, 2.0], [3.0, 0.0], [0.0, 1.0]]);
        let error = Outline::new(bow_tie, vec![]).expect_err("it crosses");
        assert!(
            matches!(
                error,
                OutlineError::EdgesMeet {
                    first: (0, 0),
                    second: (0, 2),
                    ..
                }
            ),
            "{error}"
        );
        let outer = ring(&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]]);
        let stray = ring(&[[5.0, 5.0], [5.0, 6.0], [6.0, 6.0]]);
        assert_eq!(
            Outline::new(outer, vec![stray]),
            Err(OutlineError::HoleOutside { hole: 0 })
        );
    }
}
