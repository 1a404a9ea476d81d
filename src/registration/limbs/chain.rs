//! Chains of bands, which bend where one band meets the next.

use std::collections::VecDeque;

use crate::math::Point;
use crate::registration::lattice::Lattice;

/// Bands that follow one another.
#[derive(Debug, Clone)]
pub(super) struct Chain {
    /// From where it hangs to its end.
    pub(super) nodes: Vec<usize>,
    /// The chain that it hangs on; `None` of the root.
    pub(super) parent: Option<usize>,
}

/// The chains of a tree of bands; those that `firsts` begin are chains of their own.
pub(super) fn chains(parents: &[usize], firsts: &[usize]) -> Vec<Chain> {
    let children = |node: usize| (0..parents.len()).filter(move |child| parents[*child] == node);
    let mut chains = vec![Chain {
        nodes: vec![0],
        parent: None,
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
        let number = chains.len();
        for &node in &nodes {
            waiting.extend(
                children(node)
                    .filter(|child| !nodes.contains(child))
                    .map(|child| (child, number)),
            );
        }
        chains.push(Chain {
            nodes,
            parent: Some(parent),
        });
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
