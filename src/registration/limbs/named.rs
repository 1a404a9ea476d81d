//! What an artist says of limbs: where they are, where they begin, which lies in front.
//!
//! A name's place and cut in the reference -> [`Region`], whose bands are a limb; what is said of a pose -> pins of the search and pairs of parts that are in order.

use super::comparison::{BARE, Comparison, Layer};
use crate::math::Point;
use crate::math::predicate::touch;
use crate::registration::lattice::Lattice;

/// A place this far from the figure, in spacings, is none of it.
const OUTSIDE: f64 = 1.5;

/// A limb that an artist names: a place on it in the reference, and a line across the figure where it begins, or no point.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NamedLimb {
    pub(crate) at: Point,
    pub(crate) cut: Vec<Point>,
}

/// Why there is no limb where one is named.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LimbProblem {
    /// The place is not on the figure.
    #[error("it is not on the figure; put it on the limb")]
    Outside,
    /// The place is on what belongs to no limb.
    #[error(
        "nothing stands apart from the rest there; put it on a part that does, in a drawing that shows it, or draw a `cut` across the figure where it begins"
    )]
    Trunk,
    /// The cut leaves the limb and the middle of the figure together.
    #[error("its `cut` does not part it from the middle of the figure; draw it right across, from outside to outside")]
    NotParted,
}

/// What an artist says of limbs, by number, in a pose.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Said {
    pub(crate) seen: Vec<Seen>,
    /// From back to front; `None` is the trunk.
    pub(crate) order: Vec<Option<usize>>,
}

/// A limb that is seen about a place of a pose, which is nearly that of a place of the reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Seen {
    pub(crate) limb: usize,
    pub(crate) from: Point,
    pub(crate) to: Point,
}

impl NamedLimb {
    pub(in crate::registration) fn mapped(&self, map: impl Fn(Point) -> Point) -> Self {
        Self {
            at: map(self.at),
            cut: self.cut.iter().map(|p| map(*p)).collect(),
        }
    }
}

impl Said {
    /// The same with places of the reference and of the pose mapped.
    pub(in crate::registration) fn mapped(
        &self,
        of_reference: impl Fn(Point) -> Point,
        of_pose: impl Fn(Point) -> Point,
    ) -> Self {
        let seen = self.seen.iter().map(|seen| Seen {
            limb: seen.limb,
            from: of_reference(seen.from),
            to: of_pose(seen.to),
        });
        Self {
            seen: seen.collect(),
            order: self.order.clone(),
        }
    }

    /// Pairs of parts of which the first lies in front of the second: a limb is in front where it is seen, but for limbs whose order is said. `limb_of` has the limb of
    /// every part.
    pub(super) fn in_front(
        &self,
        limb_of: &[Option<usize>],
        layers: &[Layer],
        comparison: &Comparison<'_>,
    ) -> Vec<[usize; 2]> {
        let parts = 0..limb_of.len();
        let place = |part: usize| self.order.iter().position(|limb| *limb == limb_of[part]);
        let mut pairs = Vec::new();
        for (front, back) in parts.clone().flat_map(|a| parts.clone().map(move |b| (a, b))) {
            let is_said = match (place(front), place(back)) {
                (Some(front), Some(back)) => front > back,
                _ => self.seen.iter().any(|seen| {
                    let cell = comparison.cell_at(seen.to);
                    let is_there = |part: usize| layers[part][cell] != BARE;
                    let is_own = |part: usize| limb_of[part] == Some(seen.limb);
                    is_own(front) && !is_own(back) && is_there(front) && is_there(back)
                }),
            };
            if is_said {
                pairs.push([front, back]);
            }
        }
        pairs
    }
}

/// The part of a lattice that an artist means by a limb.
#[derive(Debug, Clone)]
pub(super) struct Region {
    /// The vertex that its place is nearest to.
    pub(super) vertex: usize,
    /// By vertex, whether it is on this side of the cut; empty without a cut.
    is_in: Vec<bool>,
    /// The vertices along the cut, on this side.
    base: Vec<usize>,
}

impl Region {
    pub(super) fn new(lattice: &Lattice, limb: &NamedLimb) -> Result<Self, LimbProblem> {
        let (vertex, away) = lattice.cell_at(limb.at).ok_or(LimbProblem::Outside)?;
        if f64::from(away) > OUTSIDE * lattice.spacing {
            return Err(LimbProblem::Outside);
        }
        let mut region = Self {
            vertex,
            is_in: Vec::new(),
            base: Vec::new(),
        };
        if limb.cut.is_empty() {
            return Ok(region);
        }
        let is_cut = |v: usize, w: usize| {
            let (a, b) = (lattice.points[v], lattice.points[w]);
            limb.cut.windows(2).any(|line| touch(a, b, line[0], line[1]))
        };
        region.is_in = vec![false; lattice.points.len()];
        region.is_in[vertex] = true;
        let mut waiting = vec![vertex];
        while let Some(v) = waiting.pop() {
            let mut is_base = false;
            for &w in &lattice.neighbours[v] {
                if is_cut(v, w) {
                    is_base = true;
                } else if !region.is_in[w] {
                    region.is_in[w] = true;
                    waiting.push(w);
                }
            }
            if is_base {
                region.base.push(v);
            }
        }
        region.base.sort_unstable();
        let depths = lattice.depths();
        let root = (0..depths.len()).max_by(|a, b| depths[*a].total_cmp(&depths[*b]));
        if region.base.is_empty() || root.is_none_or(|root| region.is_in[root]) {
            return Err(LimbProblem::NotParted);
        }
        Ok(region)
    }

    /// Whether it has a cut.
    pub(super) fn is_parted(&self) -> bool {
        !self.is_in.is_empty()
    }

    /// Its vertices that are not taken, in bands of this width from its tip to the cut; none without a cut.
    pub(super) fn bands(&self, lattice: &Lattice, width: f64, is_taken: &[bool]) -> Vec<Vec<usize>> {
        let within: Vec<bool> = (self.is_in.iter().zip(is_taken))
            .map(|(is_in, is_taken)| *is_in && !is_taken)
            .collect();
        let base: Vec<usize> = self.base.iter().copied().filter(|v| within[*v]).collect();
        if base.is_empty() {
            return Vec::new();
        }
        let from_base = lattice.distances_within(&base, &within);
        let reached = (0..from_base.len()).filter(|v| from_base[*v].is_finite());
        let Some(tip) = reached.max_by(|a, b| from_base[*a].total_cmp(&from_base[*b])) else {
            return Vec::new();
        };
        let from_tip = lattice.distances_within(&[tip], &within);
        let mut bands: Vec<Vec<usize>> = Vec::new();
        for v in (0..from_tip.len()).filter(|v| from_tip[*v].is_finite()) {
            let band = (from_tip[v] / width) as usize;
            if bands.len() <= band {
                bands.resize(band + 1, Vec::new());
            }
            bands[band].push(v);
        }
        bands.retain(|band| !band.is_empty());
        bands
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bar of 300 x 60 pixels with a disc at its left end.
    fn figure() -> Lattice {
        let mask: Vec<bool> = (0..400 * 200)
            .map(|k| {
                let p = Point::new((k % 400) as f64 + 0.5, (k / 400) as f64 + 0.5);
                (p - Point::new(80.0, 100.0)).norm() < 60.0
                    || (80.0..380.0).contains(&p.x) && (p.y - 100.0).abs() < 30.0
            })
            .collect();
        Lattice::new(&mask, 400, 10.0)
    }

    fn limb(at: [f64; 2], cut: &[[f64; 2]]) -> NamedLimb {
        NamedLimb {
            at: at.into(),
            cut: cut.iter().map(|p| Point::from(*p)).collect(),
        }
    }

    #[test]
    fn a_cut_parts_what_lies_behind_it_in_bands_from_its_tip() {
        let lattice = figure();
        let region = Region::new(&lattice, &limb([330.0, 100.0], &[[250.0, 50.0], [250.0, 150.0]])).expect("a region");
        let bands = region.bands(&lattice, 20.0, &vec![false; lattice.points.len()]);
        assert!((5..=9).contains(&bands.len()), "{} bands", bands.len());
        let parted: Vec<f64> = bands.iter().flatten().map(|v| lattice.points[*v].x).collect();
        let expected = lattice.points.iter().filter(|p| p.x > 250.0).count();
        assert!(parted.iter().all(|x| *x > 250.0) && parted.len() == expected);
        let mean = |band: &Vec<usize>| band.iter().map(|v| lattice.points[*v].x).sum::<f64>() / band.len() as f64;
        assert!(bands.windows(2).all(|pair| mean(&pair[0]) > mean(&pair[1])));
    }

    #[test]
    fn a_place_off_the_figure_and_a_cut_that_does_not_part_are_refused() {
        let lattice = figure();
        let problem = |limb| Region::new(&lattice, &limb).map(|_| ());
        assert_eq!(problem(limb([300.0, 180.0], &[])), Err(LimbProblem::Outside));
        let half = limb([330.0, 100.0], &[[250.0, 50.0], [250.0, 100.0]]);
        assert_eq!(problem(half), Err(LimbProblem::NotParted));
        // The middle of the figure is no limb.
        let wrong_side = limb([80.0, 100.0], &[[250.0, 50.0], [250.0, 150.0]]);
        assert_eq!(problem(wrong_side), Err(LimbProblem::NotParted));
        assert_eq!(problem(limb([330.0, 100.0], &[])), Ok(()));
    }
}
