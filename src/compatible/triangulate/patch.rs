//! Solves small patches of a compatible triangulation anew, with fewer Steiner points.
//!
//! A patch is a set of triangles that form a disc: those around a few Steiner points near one another, those between
//! them, and sometimes the triangles next to them. Its boundary is a polygon in every pose; where divide and conquer gets
//! by with fewer points than the patch has inside, its solution takes the patch's place. Where nothing is gained any more,
//! patches are solved with as many points as they have, but differently, which often frees their neighbours.
//!
//! This is a large-neighbourhood search: the divide and conquer takes its decisions one after another, and here each is
//! taken again with its surroundings settled. Bounded by [`WORK`].

use std::collections::{BTreeMap, BTreeSet};

use super::division::{Division, Effort};
use crate::compatible::editable::EditableMesh;
use crate::math::{Point, predicate};

/// Steiner points of the patches that are tried around every Steiner point.
const STARS: std::ops::RangeInclusive<usize> = 2..=6;

/// Likewise where the patch is widened.
const WIDENED: std::ops::RangeInclusive<usize> = 1..=4;

/// Patches bounded by more vertices are left as they are.
const LARGEST_RING: usize = 64;

/// The work that may be spent, in cubes of the vertices of a patch times poses; about a second.
pub(super) const WORK: usize = 10_000_000;

/// Steiner points of a patch that is solved with as many, at most.
const LARGEST_SHAKEN: usize = 4;

/// Different solutions of a patch that are asked for.
const VARIANTS: usize = 4;

/// Passes over all Steiner points, at most.
const PASSES: usize = 12;

/// The next Steiner point of a patch is at most this many triangles away from it.
const FARTHEST: usize = 4;

/// What a patch consists of besides the triangles around its Steiner points and between them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Extent {
    /// Nothing.
    Stars,
    /// All triangles that share an edge with those.
    Widened,
}

/// What no patch may take away.
#[derive(Debug, Clone, Default)]
pub(super) struct Kept {
    /// Vertices with smaller numbers.
    pub(super) below: usize,
    /// Edges of lines inside, from both ends.
    pub(super) edges: BTreeSet<(usize, usize)>,
}

/// Solves patches anew and remembers which ones cannot be done better.
#[derive(Debug)]
pub(super) struct Resolver<'a> {
    kept: &'a Kept,
    /// Per polygon without a better solution, with how many vertices none was found. The vertices of a mesh never move
    /// and their numbers are not used again, so a polygon stands for its patch.
    failed: BTreeMap<Vec<usize>, usize>,
    /// What is left of the work.
    work: usize,
    /// Whether a patch was left because of the work.
    is_exhausted: bool,
    state: u64,
}

impl<'a> Resolver<'a> {
    pub(super) fn new(kept: &'a Kept, work: usize) -> Self {
        Self {
            kept,
            failed: BTreeMap::new(),
            work,
            is_exhausted: false,
            state: 0,
        }
    }

    /// Solves patches anew, first the plain ones and then the widened ones; returns how many vertices that saved.
    pub(super) fn resolve(&mut self, mesh: &mut EditableMesh) -> usize {
        self.resolve_all(mesh, Extent::Stars, STARS) + self.resolve_all(mesh, Extent::Widened, WIDENED)
    }

    fn resolve_all(
        &mut self,
        mesh: &mut EditableMesh,
        extent: Extent,
        sizes: std::ops::RangeInclusive<usize>,
    ) -> usize {
        let mut saved = 0;
        for pass in 0..PASSES {
            let before = saved;
            let mut vertex = self.kept.below;
            while vertex < mesh.vertex_count() {
                for size in sizes.clone() {
                    if mesh.degree(vertex) == 0 {
                        break;
                    }
                    let patch = self.patch_around(mesh, vertex, size, extent, pass);
                    saved += patch.map_or(0, |patch| {
                        let fewer = patch.inner.len() - 1;
                        self.resolve_patch(mesh, patch, fewer, 0)
                    });
                }
                vertex += 1;
            }
            if saved == before || self.is_exhausted {
                break;
            }
        }
        saved
    }

    /// Solves patches anew with as many vertices as they have, so that neighbouring ones may find a better solution;
    /// returns how many vertices that saved by chance.
    pub(super) fn shake(&mut self, mesh: &mut EditableMesh) -> usize {
        let mut saved = 0;
        for vertex in self.kept.below..mesh.vertex_count() {
            if mesh.degree(vertex) == 0 {
                continue;
            }
            let size = 1 + self.random() % LARGEST_SHAKEN;
            let extent = if self.random().is_multiple_of(2) {
                Extent::Stars
            } else {
                Extent::Widened
            };
            let (choice, variant) = (self.random(), self.random() % VARIANTS);
            let patch = self.patch_around(mesh, vertex, size, extent, choice);
            saved += patch.map_or(0, |patch| {
                let equal = patch.inner.len();
                self.resolve_patch(mesh, patch, equal, variant)
            });
        }
        saved
    }

    /// Whether a patch was left because the work is used up.
    pub(super) fn is_exhausted(&self) -> bool {
        self.is_exhausted
    }

    /// A number that looks random: a fixed linear congruential sequence (Knuth's MMIX constants).
    fn random(&mut self) -> usize {
        self.state = self
            .state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.state >> 40) as usize
    }

    /// The patch around `vertex` and the next Steiner points, `size` in all; `choice` picks among those equally far away.
    fn patch_around(
        &self,
        mesh: &EditableMesh,
        vertex: usize,
        size: usize,
        extent: Extent,
        choice: usize,
    ) -> Option<Patch> {
        let mut triangles: BTreeSet<[usize; 3]> = mesh.triangles_at(vertex).map(smallest_first).collect();
        let mut members = vec![vertex];
        while members.len() < size {
            let (next, between) = self.next_member(mesh, &triangles, &members, choice)?;
            triangles.extend(between);
            triangles.extend(mesh.triangles_at(next).map(smallest_first));
            members.push(next);
        }
        if extent == Extent::Widened {
            let beside: Vec<[usize; 3]> = triangles.iter().flat_map(|&t| beside(mesh, t)).collect();
            triangles.extend(beside);
        }
        Patch::new(triangles, self.kept)
    }

    /// The nearest Steiner point that is not a member, over triangles that share edges, and the triangles between.
    fn next_member(
        &self,
        mesh: &EditableMesh,
        triangles: &BTreeSet<[usize; 3]>,
        members: &[usize],
        choice: usize,
    ) -> Option<(usize, Vec<[usize; 3]>)> {
        // Per triangle reached, the one before it.
        let mut reached: BTreeMap<[usize; 3], Option<[usize; 3]>> = triangles.iter().map(|&t| (t, None)).collect();
        let mut layer: Vec<[usize; 3]> = triangles.iter().copied().collect();
        for _ in 0..=FARTHEST {
            let mut found: BTreeMap<usize, (usize, [usize; 3])> = BTreeMap::new();
            for &triangle in &layer {
                for v in triangle {
                    if v >= self.kept.below && !members.contains(&v) {
                        found.entry(v).or_insert((0, triangle)).0 += 1;
                    }
                }
            }
            let mut found: Vec<(usize, (usize, [usize; 3]))> = found.into_iter().collect();
            // Most triangles in common first.
            found.sort_by_key(|&(v, (shared, _))| (std::cmp::Reverse(shared), v));
            if let Some(&(v, (_, triangle))) = found.get(choice % found.len().max(1)) {
                let path = std::iter::successors(Some(triangle), |t| reached.get(t).copied().flatten()).collect();
                return Some((v, path));
            }
            let mut next = Vec::new();
            for triangle in layer {
                for other in beside(mesh, triangle) {
                    reached.entry(other).or_insert_with(|| {
                        next.push(other);
                        Some(triangle)
                    });
                }
            }
            layer = next;
        }
        None
    }

    /// Solves the patch with at most `allowance` vertices, if that succeeds; returns how many were saved.
    fn resolve_patch(&mut self, mesh: &mut EditableMesh, patch: Patch, allowance: usize, variant: usize) -> usize {
        let Patch { ring, inner, triangles } = patch;
        let work = ring.len().pow(3) * mesh.pose_count();
        let known = variant == 0 && self.failed.get(&ring).is_some_and(|&failed| failed >= allowance);
        if known || ring.len() > LARGEST_RING {
            return 0;
        }
        let Some(left) = self.work.checked_sub(work) else {
            self.is_exhausted = true;
            return 0;
        };
        self.work = left;
        let Some(solution) = solve(mesh, &ring, allowance, variant) else {
            if variant == 0 {
                self.failed.insert(ring, allowance);
            }
            return 0;
        };
        for [a, b, _] in triangles {
            mesh.remove_at_edge(a, b);
        }
        let start = ring.len();
        let added = solution.positions[0].len() - start;
        let mut numbers = ring;
        for k in start..start + added {
            numbers.push(mesh.add_vertex(solution.positions.iter().map(|positions| positions[k])));
        }
        for triangle in solution.triangles {
            mesh.add(triangle.map(|k| numbers[k]));
        }
        inner.len() - added
    }
}

/// A triangulation of the polygon `ring` with at most `allowance` further vertices; proven positive.
fn solve(mesh: &EditableMesh, ring: &[usize], allowance: usize, variant: usize) -> Option<Division> {
    let positions = mesh
        .positions
        .iter()
        .map(|positions| ring.iter().map(|&v| positions[v]).collect())
        .collect();
    let mut division = Division::within(positions, allowance, Effort::Quick(variant));
    division.solve((0..ring.len()).collect()).ok()?;
    let positive = |&[a, b, c]: &[usize; 3]| {
        let positive_in = |positions: &Vec<Point>| predicate::is_positive(positions[a], positions[b], positions[c]);
        division.positions.iter().all(positive_in)
    };
    division.triangles.iter().all(positive).then_some(division)
}

/// The triangle with its smallest vertex first: one name for each.
fn smallest_first([a, b, c]: [usize; 3]) -> [usize; 3] {
    if a < b && a < c {
        [a, b, c]
    } else if b < c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

/// The triangles that share an edge with this one.
fn beside(mesh: &EditableMesh, triangle: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
    crate::mesh::directed_edges(triangle)
        .into_iter()
        .filter_map(|(a, b)| Some(smallest_first([b, a, mesh.opposite(b, a)?])))
}

/// Triangles that form a disc.
#[derive(Debug)]
struct Patch {
    /// Its boundary, from the smallest vertex on.
    ring: Vec<usize>,
    /// Its other vertices.
    inner: Vec<usize>,
    triangles: BTreeSet<[usize; 3]>,
}

impl Patch {
    /// `None` if the boundary is not one cycle through distinct vertices, or what has to stay is inside.
    fn new(triangles: BTreeSet<[usize; 3]>, kept: &Kept) -> Option<Self> {
        let edges: BTreeSet<(usize, usize)> = triangles.iter().flat_map(|&t| crate::mesh::directed_edges(t)).collect();
        let mut after: BTreeMap<usize, usize> = BTreeMap::new();
        for &(a, b) in &edges {
            if edges.contains(&(b, a)) {
                if kept.edges.contains(&(a, b)) {
                    return None;
                }
            } else if after.insert(a, b).is_some() {
                return None;
            }
        }
        let (&start, _) = after.first_key_value()?;
        let mut ring = vec![start];
        let mut at = *after.get(&start)?;
        while at != start {
            ring.push(at);
            at = *after.get(&at)?;
        }
        let vertices: BTreeSet<usize> = triangles.iter().flatten().copied().collect();
        let inner: Vec<usize> = vertices.into_iter().filter(|v| !after.contains_key(v)).collect();
        let may_go = !inner.is_empty() && inner.iter().all(|&v| v >= kept.below);
        // With one boundary cycle, a disc has ring + 2 inner - 2 triangles.
        let is_disc = ring.len() == after.len() && triangles.len() + 2 == ring.len() + 2 * inner.len();
        (may_go && is_disc).then_some(Self { ring, inner, triangles })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A regular hexagon around vertex 6, in one pose.
    fn wheel() -> EditableMesh {
        let mut positions: Vec<Point> = (0..6)
            .map(|k| f64::from(k) * std::f64::consts::FRAC_PI_3)
            .map(|angle| Point::new(angle.cos(), angle.sin()))
            .collect();
        positions.push(Point::zeros());
        let triangles: Vec<[usize; 3]> = (0..6).map(|k| [k, (k + 1) % 6, 6]).collect();
        EditableMesh::new(vec![positions], &triangles)
    }

    fn below(below: usize) -> Kept {
        Kept {
            below,
            ..Kept::default()
        }
    }

    #[test]
    fn a_needless_hub_is_taken_out_of_its_patch() {
        let mut mesh = wheel();
        let kept = below(6);
        let mut resolver = Resolver::new(&kept, WORK);
        let patch = resolver.patch_around(&mesh, 6, 1, Extent::Stars, 0).expect("a disc");
        assert_eq!((patch.ring.len(), &patch.inner[..]), (6, &[6][..]));
        assert_eq!(resolver.resolve_patch(&mut mesh, patch, 0, 0), 1);
        assert_eq!((mesh.triangles().count(), mesh.degree(6)), (4, 0));
    }

    /// What the last round saved, in which the work was used up, was not counted once.
    #[test]
    fn what_is_saved_before_the_work_is_used_up_counts() {
        let hubs = 12;
        let mut positions: Vec<Point> = Vec::new();
        let mut triangles = Vec::new();
        for wheel in 0..hubs {
            let middle = Point::new(4.0 * wheel as f64, 0.0);
            let rim = (0..6).map(|k| f64::from(k) * std::f64::consts::FRAC_PI_3);
            positions.extend(rim.map(|angle| middle + Point::new(angle.cos(), angle.sin())));
            triangles.extend((0..6).map(|k| [6 * wheel + k, 6 * wheel + (k + 1) % 6, 6 * hubs + wheel]));
        }
        positions.extend((0..hubs).map(|wheel| Point::new(4.0 * wheel as f64, 0.0)));
        let mut mesh = EditableMesh::new(vec![positions], &triangles);
        let kept = below(6 * hubs);
        // Enough for two hexagons and a half.
        let mut resolver = Resolver::new(&kept, 5 * 6usize.pow(3) / 2);
        let mut saved = 0;
        while !resolver.is_exhausted() {
            saved += resolver.shake(&mut mesh);
        }
        let gone = (6 * hubs..7 * hubs).filter(|&hub| mesh.degree(hub) == 0).count();
        assert_eq!((saved, gone), (2, 2));
    }

    #[test]
    fn a_vertex_that_has_to_stay_is_never_inside_a_patch() {
        let mesh = wheel();
        let kept = below(7);
        assert!(
            Resolver::new(&kept, WORK)
                .patch_around(&mesh, 6, 1, Extent::Widened, 0)
                .is_none()
        );
    }

    #[test]
    fn an_edge_that_has_to_stay_is_never_inside_a_patch() {
        // Two hubs with an edge between the quadrilaterals around them.
        let triangles = || {
            [[0, 1, 4], [1, 2, 4], [2, 0, 4], [0, 2, 5], [2, 3, 5], [3, 0, 5]]
                .map(smallest_first)
                .into()
        };
        assert!(Patch::new(triangles(), &below(4)).is_some());
        let kept = Kept {
            edges: [(0, 2), (2, 0)].into(),
            ..below(4)
        };
        assert!(Patch::new(triangles(), &kept).is_none());
    }

    #[test]
    fn an_annulus_and_two_discs_are_no_patch() {
        let ring: BTreeSet<[usize; 3]> = (0..4)
            .flat_map(|k| {
                let l = (k + 1) % 4;
                [[k, l, 4 + k], [l, 4 + l, 4 + k]]
            })
            .map(smallest_first)
            .collect();
        assert!(Patch::new(ring, &below(0)).is_none());
        assert!(Patch::new([[0, 1, 2], [3, 4, 5]].into(), &below(0)).is_none());
    }
}
