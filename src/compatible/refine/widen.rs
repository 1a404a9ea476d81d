//! Widens small angles: a vertex next to one moves so that the smallest angle around it grows.

use rayon::prelude::*;

use super::super::editable::EditableMesh;
use super::star::{self, Stars};
use crate::math::Point;

/// Sweeps over the vertices that need it.
const SWEEPS: usize = 6;

/// Directions that a move is tried in.
const DIRECTIONS: usize = 8;

/// The first step, as a share of the distance to the nearest neighbour, and how often it is halved.
const FIRST_STEP: f64 = 0.4;
const HALVINGS: usize = 5;

/// Moves the vertices whose triangles have an angle below `enough_rad`, in each pose by itself, by pattern search on
/// the smallest angle around them. The search stops at `enough_rad`: past it the moves would only add distortion.
pub(super) fn widen(mesh: &mut EditableMesh, stars: &Stars, enough_rad: f64) {
    mesh.positions.par_iter_mut().for_each(|positions| {
        for _ in 0..SWEEPS {
            for (vertex, opposite) in stars.iter() {
                let start = positions[vertex];
                if star::smallest_angle_rad(positions, start, opposite) < enough_rad {
                    positions[vertex] = search(positions, start, opposite, enough_rad);
                }
            }
        }
    });
}

fn search(positions: &[Point], start: Point, opposite: &[(usize, usize)], enough_rad: f64) -> Point {
    let mut best = start;
    let mut best_angle = star::smallest_angle_rad(positions, start, opposite);
    let nearest = opposite
        .iter()
        .map(|&(a, _)| (positions[a] - start).norm())
        .fold(f64::INFINITY, f64::min);
    let mut step = FIRST_STEP * nearest;
    for _ in 0..=HALVINGS {
        let mut moved = false;
        for k in 0..DIRECTIONS {
            let direction = std::f64::consts::TAU * k as f64 / DIRECTIONS as f64;
            let place = best + Point::new(direction.cos(), direction.sin()) * step;
            if !star::is_positive(positions, place, opposite) {
                continue;
            }
            let angle = star::smallest_angle_rad(positions, place, opposite).min(enough_rad);
            if angle > best_angle {
                (best, best_angle, moved) = (place, angle, true);
            }
        }
        if best_angle >= enough_rad {
            break;
        }
        if !moved {
            step *= 0.5;
        }
    }
    best
}
