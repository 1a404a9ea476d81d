//! The mesh on every pose, and what corresponds inside: a chequered colour wheel on the reference, carried to the others. Where a pose lies over itself, it is
//! drawn from back to front, its limbs with their edges and names.

use std::collections::BTreeMap;

use tiny_skia::Color;

use super::canvas::Canvas;
use super::layout::Cell;
use super::{Diagram, INK, TEXT_PX, hue, mark_size, worst_colour};
use crate::math::{Point, Point3, point};
use crate::mesh::geometry;
use crate::pose::{LandmarkKind, Mapping};

/// How many of a pose's triangles are marked: one in so many, but not fewer or more than these.
const MARKED_SHARE: usize = 100;
const MARKED: (usize, usize) = (3, 8);

/// Pieces along a side of a triangle that are coloured by themselves.
const PIECES: usize = 3;
/// Squares of the chequer along the reference's diagonal.
const SQUARES: f64 = 24.0;
/// The height of the names of limbs, of a line of text.
const LIMB_SHARE: f64 = 0.8;
/// The lightness of its squares, in turn.
const LIGHTNESS: [f64; 2] = [0.58, 0.9];

/// Draws the mesh of every pose in its cell, with the triangles of the smallest angles in that pose marked.
pub(super) fn draw(canvas: &mut Canvas, diagram: &Diagram, cells: &[Cell]) {
    let mapping = diagram.mapping;
    let triangles = mapping.poses.topology().triangles();
    let wheel = Wheel::new(&mapping.poses.positions()[mapping.matching.reference]);
    for (pose, (positions, cell)) in mapping.poses.positions().iter().zip(cells).enumerate() {
        let placed: Vec<Point> = positions.iter().map(|p| cell.fit.place(*p)).collect();
        match mapping.overlaps.depth(pose) {
            Some(depth) => draw_from_back_to_front(canvas, mapping, &wheel, &placed, depth),
            None => {
                for corners in triangles {
                    wheel.fill(canvas, &placed, *corners);
                }
                for corners in triangles {
                    draw_edges(canvas, geometry::corners(&placed, *corners));
                }
                for ring in &mapping.rings {
                    let mut points: Vec<Point> = ring.iter().map(|v| placed[*v]).collect();
                    points.extend(points.first().copied());
                    canvas.line(&points, 1.4, INK);
                }
            }
        }
        if !mapping.overlaps.is_empty() {
            name_limbs(canvas, mapping, &placed);
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

fn draw_edges(canvas: &mut Canvas, [a, b, c]: [Point; 3]) {
    canvas.line(&[a, b, c, a], 0.6, Color::from_rgba8(90, 90, 90, 150));
}

/// A mesh that lies over itself: what is nearer hides what lies behind it, lines and all.
fn draw_from_back_to_front(canvas: &mut Canvas, mapping: &Mapping, wheel: &Wheel<'_>, placed: &[Point], depth: &[f64]) {
    let topology = mapping.poses.topology();
    let triangles = topology.triangles();
    let around = topology.neighbours();
    let limb = |t: usize| limb_name(mapping, t);
    let mut order: Vec<usize> = (0..triangles.len()).collect();
    order.sort_by(|a, b| depth[*a].total_cmp(&depth[*b]));
    for t in order {
        let corners = geometry::corners(placed, triangles[t]);
        wheel.fill(canvas, placed, triangles[t]);
        draw_edges(canvas, corners);
        for (k, other) in around[t].iter().enumerate() {
            if other.is_none_or(|other| limb(other) != limb(t)) {
                canvas.line(&[corners[k], corners[(k + 1) % 3]], 1.4, INK);
            }
        }
    }
}

/// The name of the limb that a triangle belongs to, whose parts have numbers behind a point.
fn limb_name(mapping: &Mapping, triangle: usize) -> Option<&str> {
    let limb = (*mapping.overlaps.triangle_limb.get(triangle)?)?;
    let name = mapping.overlaps.limbs.get(limb)?;
    Some(name.rsplit_once('.').map_or(name.as_str(), |(name, _)| name))
}

/// Writes the name of every limb in its middle.
fn name_limbs(canvas: &mut Canvas, mapping: &Mapping, placed: &[Point]) {
    let triangles = mapping.poses.topology().triangles();
    let mut middles: BTreeMap<&str, (Point, usize)> = BTreeMap::new();
    for (t, corners) in triangles.iter().enumerate() {
        if let Some(name) = limb_name(mapping, t) {
            let [a, b, c] = geometry::corners(placed, *corners);
            let (sum, count) = middles.entry(name).or_insert((Point::zeros(), 0));
            *sum += (a + b + c) / 3.0;
            *count += 1;
        }
    }
    for (name, (sum, count)) in middles {
        canvas.text_around(name, sum / count as f64, LIMB_SHARE * TEXT_PX, INK);
    }
}

/// A colour for every place of the reference.
struct Wheel<'a> {
    reference: &'a [Point],
    middle: Point,
    square: f64,
}

impl<'a> Wheel<'a> {
    fn new(reference: &'a [Point]) -> Self {
        Self {
            reference,
            middle: reference.iter().sum::<Point>() / reference.len().max(1) as f64,
            square: point::diagonal(reference) / SQUARES,
        }
    }

    /// Fills a triangle of a pose with the colours that it has on the reference.
    fn fill(&self, canvas: &mut Canvas, placed: &[Point], triangle: [usize; 3]) {
        let on_reference = geometry::corners(self.reference, triangle);
        let here = geometry::corners(placed, triangle);
        for weights in pieces() {
            let middle = (weights[0] + weights[1] + weights[2]) / 3.0;
            let colour = self.colour(at(&on_reference, middle));
            let [a, b, c] = weights.map(|w| at(&here, w));
            canvas.fill(&[a, b, c], colour);
            // Over the seams that smooth edges leave.
            canvas.line(&[a, b, c, a], 0.8, colour);
        }
    }

    fn colour(&self, place: Point) -> Color {
        let away = place - self.middle;
        let turns = away.y.atan2(away.x) / std::f64::consts::TAU;
        let squares = away / self.square;
        let parity = (squares.x.floor() + squares.y.floor()).rem_euclid(2.0);
        hue(turns, LIGHTNESS[usize::from(parity >= 1.0)])
    }
}

/// The pieces of a triangle, each by the weights of its corners.
fn pieces() -> impl Iterator<Item = [Point3; 3]> {
    let corner = |i: usize, j: usize| Point3::new((PIECES - i - j) as f64, i as f64, j as f64) / PIECES as f64;
    (0..PIECES).flat_map(move |i| {
        (0..PIECES - i).flat_map(move |j| {
            let first = [corner(i, j), corner(i + 1, j), corner(i, j + 1)];
            let second = (i + j + 1 < PIECES).then(|| [corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]);
            std::iter::once(first).chain(second)
        })
    })
}

fn at([a, b, c]: &[Point; 3], weights: Point3) -> Point {
    a * weights.x + b * weights.y + c * weights.z
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
    fn the_pieces_of_a_triangle_are_as_large_together_as_it_is() {
        let whole = [[0.0, 0.0], [6.0, 0.0], [0.0, 3.0]].map(Point::from);
        let areas = pieces().map(|weights| geometry::signed_area(weights.map(|w| at(&whole, w))));
        let areas: Vec<f64> = areas.collect();
        assert_eq!(areas.len(), PIECES * PIECES);
        assert!(areas.iter().all(|area| (area - 1.0).abs() < 1e-12), "{areas:?}");
    }

    #[test]
    fn the_thinnest_triangle_comes_first() {
        let positions = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 0.1]].map(Point::from);
        let found = smallest_angles(&positions, &[[0, 1, 2], [0, 2, 3]]);
        assert_eq!(found.iter().map(|(k, _)| *k).collect::<Vec<_>>(), [1, 0]);
        assert!(found[0].1 < 3.0 && (found[1].1 - 45.0).abs() < 1e-12);
    }
}
