//! Outlines in correspondence, and meshes side by side.

use tiny_skia::Color;

use super::canvas::{Canvas, Fit};
use super::{TEXT_PX, hue};
use crate::math::Point;
use crate::mesh::geometry;
use crate::outline::ArcLength;
use crate::pose::Mapping;

/// Coloured pieces of an outline.
const PIECES: usize = 360;
/// Numbered points of an outline.
const NUMBERS: usize = 16;

/// The outer rings, coloured by the matching, with numbered links between neighbouring poses; holes in grey.
pub(super) fn draw_outlines(canvas: &mut Canvas, mapping: &Mapping, fits: &[Fit]) {
    let matching = &mapping.matching.outer;
    let curves: Vec<ArcLength> = mapping.outlines.iter().map(|o| ArcLength::new(o.outer())).collect();
    let reference = mapping.matching.reference;
    // Evenly along the reference, so that neither colours nor numbers crowd.
    let at = |pose: usize, share: f64| fits[pose].place(curves[pose].at(matching.carry(reference, pose, share)));
    let numbered: Vec<f64> = (0..NUMBERS).map(|k| k as f64 / NUMBERS as f64).collect();
    for &share in &numbered {
        let link: Vec<Point> = (0..curves.len()).map(|pose| at(pose, share)).collect();
        canvas.line(&link, 0.7, faint(hue(share, 0.6)));
    }
    for (pose, outline) in mapping.outlines.iter().enumerate() {
        for hole in outline.holes() {
            let points: Vec<Point> = (0..=hole.len()).map(|k| fits[pose].place(hole.point(k))).collect();
            canvas.line(&points, 1.0, Color::from_rgba8(120, 120, 120, 255));
        }
        for piece in 0..PIECES {
            let [from, to] = [piece, piece + 1].map(|k| k as f64 / PIECES as f64);
            // Between the two the outline's own vertices.
            let [start, end] = [from, to].map(|share| matching.carry(reference, pose, share.rem_euclid(1.0)));
            let length = (end - start).rem_euclid(1.0);
            let steps = 2 + (length * 400.0) as usize;
            let points: Vec<Point> = (0..=steps)
                .map(|k| fits[pose].place(curves[pose].at(start + length * k as f64 / steps as f64)))
                .collect();
            canvas.line(&points, 2.2, hue(from, 0.6));
        }
    }
    for pose in 0..curves.len() {
        for (number, &share) in numbered.iter().enumerate() {
            let place = at(pose, share);
            canvas.dot(place, 3.2, hue(share, 0.5));
            let label = [place.x + 5.0, place.y - 0.5 * TEXT_PX];
            canvas.text(
                &(number + 1).to_string(),
                label,
                0.7 * TEXT_PX,
                Color::from_rgba8(30, 30, 30, 255),
            );
        }
    }
}

/// The mesh on every pose, `below` pixels under its outline.
pub(super) fn draw_meshes(canvas: &mut Canvas, mapping: &Mapping, fits: &[Fit], below: f64) {
    let triangles = mapping.poses.topology().triangles();
    let shift = Point::new(0.0, below);
    for (positions, fit) in mapping.poses.positions().iter().zip(fits) {
        let placed: Vec<Point> = positions.iter().map(|p| fit.place(*p) + shift).collect();
        for (k, corners) in triangles.iter().enumerate() {
            let [a, b, c] = geometry::corners(&placed, *corners);
            // The golden ratio spreads hues so that neighbours differ; the colour is the triangle's in every pose.
            canvas.fill(&[a, b, c], faint(hue(k as f64 * 0.618_034, 0.66)));
        }
        for corners in triangles {
            let [a, b, c] = geometry::corners(&placed, *corners);
            canvas.line(&[a, b, c, a], 0.6, Color::from_rgba8(60, 60, 60, 160));
        }
        for ring in &mapping.rings {
            let mut points: Vec<Point> = ring.iter().map(|v| placed[*v]).collect();
            points.extend(points.first().copied());
            canvas.line(&points, 1.4, Color::from_rgba8(20, 20, 20, 255));
        }
    }
}

fn faint(mut colour: Color) -> Color {
    colour.set_alpha(0.45);
    colour
}
