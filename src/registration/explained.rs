//! How far a registration explains a drawing, and where it does so least.

use super::lattice::Lattice;
use super::pair::Registered;
use super::template::{DOUBT, MOST_DIFFERENCE};

/// Steps in which what is left at every vertex is averaged with its neighbours', so that a place is one that can be seen.
const SMOOTHINGS: usize = 2;

/// What a registered pose has of the reference's drawing.
pub(super) struct Found {
    /// The share of the vertices around which the drawings are alike.
    pub(super) share: f64,
    /// The vertex around which they are least alike.
    pub(super) least: usize,
}

impl Found {
    pub(super) fn new(lattice: &Lattice, registered: &Registered) -> Self {
        let residuals = &registered.residuals;
        let alike = residuals.iter().filter(|left| **left < DOUBT * MOST_DIFFERENCE).count();
        let mut smooth = residuals.clone();
        for _ in 0..SMOOTHINGS {
            smooth = (0..smooth.len())
                .map(|v| {
                    let around = &lattice.neighbours[v];
                    let sum: f32 = around.iter().map(|&w| smooth[w]).sum();
                    (smooth[v] + sum) / (1 + around.len()) as f32
                })
                .collect();
        }
        let least = (0..smooth.len()).max_by(|a, b| smooth[*a].total_cmp(&smooth[*b]));
        Self {
            share: alike as f64 / residuals.len().max(1) as f64,
            least: least.unwrap_or(0),
        }
    }
}
