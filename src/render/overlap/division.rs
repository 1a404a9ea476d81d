//! A mesh that lies over itself, divided into as few regions as can be painted one after another.
//!
//! Mapping -> [`Division`]: by triangle its region, and for every pose which region lies in front of which.
//!
//! 1. Pieces: triangles of one limb that hang together and are equally near in all poses.
//! 2. Where pieces lie over one another in a pose, and by what depth, is seen on a grid of cells.
//! 3. Neighbouring pieces are united as long as nothing of them lies over one another and everything else lies in front of all of them or behind all of them,
//!    wherever it does.

use std::collections::BTreeMap;

use super::depth_order::DepthOrder;
use crate::math::{Point, for_each_cell, point};
use crate::pose::Mapping;

/// Cells along the diagonal of a pose.
const CELLS: f64 = 200.0;
/// Pieces lie over one another if they do in this many cells at least, and neighbours in this share of the smaller one besides: they meet at a joint.
const LEAST_CELLS: usize = 4;
const JOINT_SHARE: f64 = 0.25;

/// The regions of a mesh.
#[derive(Debug, Clone)]
pub(super) struct Division {
    /// By triangle.
    pub(super) region_of: Vec<usize>,
    pub(super) order: DepthOrder,
}

impl Division {
    pub(super) fn new(mapping: &Mapping) -> Self {
        let triangles = mapping.poses.topology().triangles();
        let (piece_of, count) = pieces(mapping);
        let mut neighbours = vec![false; count * count];
        for (t, other) in mapping.poses.topology().adjacent_triangles() {
            let (own, other) = (piece_of[t], piece_of[other]);
            neighbours[own * count + other] = true;
            neighbours[other * count + own] = true;
        }
        let mut in_front: Vec<Vec<i8>> = (0..mapping.poses.len())
            .map(|pose| match mapping.overlaps.depth(pose) {
                Some(depth) => relations(
                    triangles,
                    &mapping.poses.positions()[pose],
                    depth,
                    &piece_of,
                    count,
                    &neighbours,
                ),
                None => vec![0; count * count],
            })
            .collect();
        let mut region_of_piece: Vec<usize> = (0..count).collect();
        // Larger unions first would need a search; in the order of their numbers pieces grow from the trunk on.
        loop {
            let mut united = None;
            'pairs: for a in 0..count {
                for b in a + 1..count {
                    let hang_together =
                        (region_of_piece[a] == a && region_of_piece[b] == b) && neighbours[a * count + b];
                    if hang_together && in_front.iter().all(|known| can_unite(known, count, a, b)) {
                        united = Some((a, b));
                        break 'pairs;
                    }
                }
            }
            let Some((a, b)) = united else { break };
            for region in region_of_piece.iter_mut().filter(|region| **region == b) {
                *region = a;
            }
            for other in 0..count {
                for (own, theirs) in [
                    (a * count + other, b * count + other),
                    (other * count + a, other * count + b),
                ] {
                    neighbours[own] |= neighbours[theirs];
                    for known in &mut in_front {
                        if known[own] == 0 {
                            known[own] = known[theirs];
                        }
                    }
                }
            }
        }
        let mut numbers = vec![usize::MAX; count];
        let mut regions = Vec::new();
        for &region in &region_of_piece {
            if numbers[region] == usize::MAX {
                numbers[region] = regions.len();
                regions.push(region);
            }
        }
        let of_regions = |known: &Vec<i8>| -> Vec<i8> {
            let pairs = regions.iter().flat_map(|a| regions.iter().map(move |b| (*a, *b)));
            pairs.map(|(a, b)| known[a * count + b]).collect()
        };
        Self {
            region_of: piece_of.iter().map(|piece| numbers[region_of_piece[*piece]]).collect(),
            order: DepthOrder {
                count: regions.len(),
                in_front: in_front.iter().map(of_regions).collect(),
            },
        }
    }
}

/// Whether two neighbouring regions can be painted at once.
fn can_unite(in_front: &[i8], count: usize, a: usize, b: usize) -> bool {
    let others = (0..count).filter(|other| *other != a && *other != b);
    let mut signs = others.map(|other| in_front[a * count + other] * in_front[b * count + other]);
    in_front[a * count + b] == 0 && signs.all(|sign| sign >= 0)
}

/// By triangle, its piece; and how many there are.
fn pieces(mapping: &Mapping) -> (Vec<usize>, usize) {
    let topology = mapping.poses.topology();
    let (triangles, around) = (topology.triangles(), topology.neighbours());
    let overlaps = &mapping.overlaps;
    // Depths differ by parts of a whole within what is equally near.
    let kind = |t: usize| -> (Option<usize>, Vec<u64>) {
        let depths = overlaps.poses.iter().map(|known| known.depth[t].floor().to_bits());
        (overlaps.triangle_limb.get(t).copied().flatten(), depths.collect())
    };
    let kinds: Vec<_> = (0..triangles.len()).map(kind).collect();
    let mut piece_of = vec![usize::MAX; triangles.len()];
    let mut count = 0;
    for start in 0..triangles.len() {
        if piece_of[start] != usize::MAX {
            continue;
        }
        piece_of[start] = count;
        let mut waiting = vec![start];
        while let Some(t) = waiting.pop() {
            for &other in around[t].iter().flatten() {
                if piece_of[other] == usize::MAX && kinds[other] == kinds[t] {
                    piece_of[other] = count;
                    waiting.push(other);
                }
            }
        }
        count += 1;
    }
    (piece_of, count)
}

/// #pieces x #pieces: 1 where the first lies in front of the second, -1 where it lies behind.
fn relations(
    triangles: &[[usize; 3]],
    positions: &[Point],
    depth: &[f64],
    piece_of: &[usize],
    count: usize,
    neighbours: &[bool],
) -> Vec<i8> {
    let mut in_front = vec![0; count * count];
    let Some((low, high)) = point::bounding_box(positions) else {
        return in_front;
    };
    let side = (high - low).norm() / CELLS;
    if side.is_nan() || side <= 0.0 {
        return in_front;
    }
    let size = [(high.x - low.x) / side, (high.y - low.y) / side].map(|length| length as usize + 1);
    // By cell, the nearest depth of every piece there.
    let mut cells: Vec<BTreeMap<usize, f64>> = vec![BTreeMap::new(); size[0] * size[1]];
    for (t, triangle) in triangles.iter().enumerate() {
        let corners = triangle.map(|v| (positions[v] - low) / side);
        for_each_cell(corners, size, |cell, _| {
            let nearest = cells[cell].entry(piece_of[t]).or_insert(depth[t]);
            *nearest = nearest.max(depth[t]);
        });
    }
    let mut sizes = vec![0usize; count];
    let mut votes: BTreeMap<(usize, usize), (usize, isize)> = BTreeMap::new();
    for cell in &cells {
        for (k, (a, own)) in cell.iter().enumerate() {
            sizes[*a] += 1;
            for (b, other) in cell.iter().skip(k + 1) {
                let vote = votes.entry((*a, *b)).or_default();
                vote.0 += 1;
                vote.1 += if own > other { 1 } else { -1 };
            }
        }
    }
    for ((a, b), (cells, vote)) in votes {
        let joint = if neighbours[a * count + b] {
            JOINT_SHARE * sizes[a].min(sizes[b]) as f64
        } else {
            0.0
        };
        if cells >= LEAST_CELLS && cells as f64 > joint {
            let sign = if vote >= 0 { 1 } else { -1 };
            in_front[a * count + b] = sign;
            in_front[b * count + a] = -sign;
        }
    }
    in_front
}
