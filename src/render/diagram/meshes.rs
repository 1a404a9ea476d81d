//! The mesh on every pose.

use tiny_skia::Color;

use super::canvas::Canvas;
use super::layout::Cell;
use super::{Diagram, INK, TEXT_PX, faint, hue, mark_size, worst_colour};
use crate::math::Point;
use crate::mesh::geometry;
use crate::pose::LandmarkKind;

/// How many of a pose's triangles are marked: one in so many, but not fewer or more than these.
const MARKED_SHARE: usize = 100;
const MARKED: (usize, usize) = (3, 8);

/// Draws the mesh of every pose in its cell, with the triangles of the smallest angles in that pose marked.
pub(super) fn draw(canvas: &mut Canvas, diagram: &Diagram, cells: &[Cell]) {
    let mapping = diagram.mapping;
    let triangles = mapping.poses.topology().triangles();
    for (pose, (positions, cell)) in mapping.poses.positions().iter().zip(cells).enumerate() {
        let placed: Vec<Point> = positions.iter().map(|p| cell.fit.place(*p)).collect();
        for (k, corners) in triangles.iter().enumerate() {
            // The golden ratio spreads hues so that neighbours differ; the colour is the triangle's in every pose.
            let colour = faint(hue(k as f64 * 0.618_034, 0.7));
            canvas.fill(&geometry::corners(&placed, *corners), colour);
        }
        for corners in triangles {
            let [a, b, c] = geometry::corners(&placed, *corners);
            canvas.line(&[a, b, c, a], 0.6, Color::from_rgba8(90, 90, 90, 150));
        }
        for ring in &mapping.rings {
            let mut points: Vec<Point> = ring.iter().map(|v| placed[*v]).collect();
            points.extend(points.first().copied());
            canvas.line(&points, 1.4, INK);
        }
        let worst = smallest_angles(positions, triangles);
        for (k, _) in &worst {
            let [a, b, c] = geometry::corners(&placed, triangles[*k]);
            canvas.fill(&[a, b, c], worst_colour());
            canvas.line(&[a, b, c, a], 1.6, worst_colour());
        }
        for landmark in diagram.landmarks {
            let line: Vec<Point> = landmark.at[pose].iter().map(|p| cell.fit.place(*p)).collect();
            match (landmark.kind, line.first()) {
                (LandmarkKind::Line, _) => canvas.line(&line, 2.2, INK),
                (_, Some(place)) => canvas.square(*place, mark_size(diagram) - 1.0, INK),
                (_, None) => {}
            }
        }
        if let Some((k, angle_deg)) = worst.first() {
            let [a, b, c] = geometry::corners(&placed, triangles[*k]);
            let middle = (a + b + c) / 3.0;
            let reach = [a, b, c].iter().map(|p| (p - middle).norm()).fold(0.0, f64::max);
            canvas.circle(middle, reach + 6.0, 2.0, worst_colour());
            let words = format!("SMALLEST ANGLE {angle_deg:.1} DEGREES");
            canvas.text_around(&words, cell.foot(), 0.9 * TEXT_PX, INK);
        }
    }
}

/// The triangles with the smallest angles at some positions, and those angles in degrees, the smallest first.
fn smallest_angles(positions: &[Point], triangles: &[[usize; 3]]) -> Vec<(usize, f64)> {
    let mut angles: Vec<(usize, f64)> = triangles
        .iter()
        .map(|corners| geometry::smallest_angle_rad(geometry::corners(positions, *corners)).to_degrees())
        .enumerate()
        .collect();
    angles.sort_by(|a, b| a.1.total_cmp(&b.1));
    angles.truncate((triangles.len() / MARKED_SHARE).clamp(MARKED.0, MARKED.1));
    angles
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_thinnest_triangle_comes_first() {
        let positions = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 0.1]].map(Point::from);
        let found = smallest_angles(&positions, &[[0, 1, 2], [0, 2, 3]]);
        assert_eq!(found.iter().map(|(k, _)| *k).collect::<Vec<_>>(), [1, 0]);
        assert!(found[0].1 < 3.0 && (found[1].1 - 45.0).abs() < 1e-12);
    }
}
