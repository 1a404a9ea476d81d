//! Chains of bands, which bend where one band meets the next.

use std::collections::VecDeque;

use crate::math::Point;
use crate::registration::lattice::Lattice;

/// Chains of more bands than this are cut into pieces of about so many: a snake may be found as far as its neck, and lost beyond.
const MOST_BANDS: usize = 14;
const BANDS_A_PIECE: f64 = 8.0;

/// Bands that follow one another.
#[derive(Debug, Clone)]
pub(super) struct Chain {
    /// From where it hangs to its end.
    pub(super) nodes: Vec<usize>,
    /// The chain that it hangs on; `None` of the root.
    pub(super) parent: Option<usize>,
    /// Whether it goes on where the one that it hangs on was cut.
    pub(super) continues: bool,
}

/// The chains of a tree of bands; those that `firsts` begin are chains of their own.
pub(super) fn chains(parents: &[usize], firsts: &[usize]) -> Vec<Chain> {
    let children = |node: usize| (0..parents.len()).filter(move |child| parents[*child] == node);
    let mut chains = vec![Chain {
        nodes: vec![0],
        parent: None,
        continues: false,
    }];
    let mut waiting: VecDeque<(usize, usize)> = children(0).map(|child| (child, 0)).collect();
    while let Some((first, parent)) = waiting.pop_front() {
        let mut nodes = vec![first];
        while let Some(&last) = nodes.last() {
            let mut next = children(last);
            match (next.next(), next.next()) {
                (Some(only), None) if !firsts.contains(&only) => nodes.push(only),
                _ => break,
            }
        }
        let count = if nodes.len() > MOST_BANDS {
            (nodes.len() as f64 / BANDS_A_PIECE).round() as usize
        } else {
            1
        };
        let end_of = |piece: usize| piece * nodes.len() / count;
        let mut parent = parent;
        for piece in 0..count {
            let own = &nodes[end_of(piece)..end_of(piece + 1)];
            let number = chains.len();
            for &node in own {
                waiting.extend(
                    children(node)
                        .filter(|child| !nodes.contains(child))
                        .map(|child| (child, number)),
                );
            }
            chains.push(Chain {
                nodes: own.to_vec(),
                parent: Some(parent),
                continues: piece > 0,
            });
            parent = number;
        }
    }
    chains
}

/// Where every band meets the one that it hangs on: between the vertices of both that are neighbours.
pub(super) fn joints(lattice: &Lattice, nodes: &[Vec<usize>], parents: &[usize], node_of: &[usize]) -> Vec<Point> {
    let joint = |(node, vertices): (usize, &Vec<usize>)| {
        let parent = parents[node];
        let (mut own, mut other) = ((Point::zeros(), 0usize), (Point::zeros(), 0usize));
        for &v in vertices {
            for &w in lattice.neighbours[v].iter().filter(|w| node_of[**w] == parent) {
                own = (own.0 + lattice.points[v], own.1 + 1);
                other = (other.0 + lattice.points[w], other.1 + 1);
            }
        }
        if own.1 > 0 {
            return (own.0 + other.0) / (2 * own.1) as f64;
        }
        vertices.iter().map(|v| lattice.points[*v]).sum::<Point>() / vertices.len().max(1) as f64
    };
    nodes.iter().enumerate().map(joint).collect()
}
