//! The weight map.

use tiny_skia::Color;

use super::canvas::{Canvas, Fit};
use super::labels::{Area, Labels, Need};
use super::{DiagramPose, SPACE_PX, TEXT_PX, pose_colour};
use crate::math::Point;

/// How far the map reaches beyond the poses, as a fraction of the larger side of their box.
const REACH: f64 = 0.35;
/// The side of a coloured square, in pixels.
const STEP_PX: usize = 2;

/// Draws the pose space in a square at `corner`: one dimension as a band, of more than two the first two with the others
/// as in the first pose.
pub(super) fn draw(
    canvas: &mut Canvas,
    poses: &[DiagramPose],
    path: &[Vec<f64>],
    weights: &dyn Fn(&[f64]) -> Option<Vec<f64>>,
    corner: [f64; 2],
) {
    let plane = |at: &[f64]| Point::new(at.first().copied().unwrap_or(0.0), at.get(1).copied().unwrap_or(0.0));
    let places: Vec<Point> = poses.iter().map(|pose| plane(&pose.at)).collect();
    let (low, high) = crate::math::point::bounding_box(&places).unwrap_or_default();
    let side = match (high - low).max() {
        side if side > 0.0 => side,
        _ => 1.0,
    } * (1.0 + 2.0 * REACH);
    let middle = (low + high) * 0.5;
    let square = [middle - Point::repeat(0.5 * side), middle + Point::repeat(0.5 * side)];
    // Fits leave a tenth free: undone here, the map fills its square.
    let fit = Fit::new(&square, corner.map(|c| c - SPACE_PX / 18.0), SPACE_PX / 0.9);
    let place_of = |x: f64, y: f64| {
        let mut at = poses[0].at.clone();
        let p = square[0] + Point::new(x, y) * (side / SPACE_PX);
        for (coordinate, value) in at.iter_mut().zip([p.x, p.y]) {
            *coordinate = value;
        }
        at
    };
    let cells = SPACE_PX as usize / STEP_PX;
    let at_cell: Vec<Option<Vec<f64>>> = (0..cells * cells)
        .map(|k| {
            let centre = |index: usize| (index as f64 + 0.5) * STEP_PX as f64;
            weights(&place_of(centre(k % cells), centre(k / cells)))
        })
        .collect();
    let heaviest = |k: usize| {
        let weights = at_cell.get(k)?.as_ref()?;
        (0..weights.len()).max_by(|a, b| weights[*a].total_cmp(&weights[*b]))
    };
    for (k, weights) in at_cell.iter().enumerate() {
        let (column, row) = (k % cells, k / cells);
        let is_border = (column + 1 < cells && heaviest(k) != heaviest(k + 1))
            || (row + 1 < cells && heaviest(k) != heaviest(k + cells));
        let shade = if is_border { 0.6 } else { 1.0 };
        let colour = weights.as_ref().map_or(Color::WHITE, |weights| mixed(weights, shade));
        for (dx, dy) in (0..STEP_PX * STEP_PX).map(|k| (k % STEP_PX, k / STEP_PX)) {
            let x = corner[0] as usize + column * STEP_PX + dx;
            canvas.pixel(x as u32, (corner[1] as usize + row * STEP_PX + dy) as u32, colour);
        }
    }
    let along: Vec<Point> = path.iter().map(|at| fit.place(plane(at))).collect();
    canvas.line(&along, 3.0, Color::from_rgba8(255, 255, 255, 160));
    canvas.line(&along, 1.2, Color::from_rgba8(40, 40, 40, 220));
    let corner = Point::from(corner);
    let mut labels = Labels::within(Area {
        low: corner,
        high: corner + Point::repeat(SPACE_PX),
    });
    for (pose, place) in places.iter().enumerate() {
        let place = fit.place(*place);
        canvas.dot(place, 6.0, pose_colour(pose, poses.len()));
        labels.keep_free(Area::around(place, Point::repeat(6.0)));
    }
    labels.avoid(&along);
    for (said, place) in poses.iter().zip(&places) {
        let size = Canvas::text_size(&said.name, TEXT_PX) + Point::repeat(4.0);
        if let Some(placed) = labels.place(fit.place(*place), size, Point::new(1.0, 0.0), Need::Must) {
            canvas.text_around(&said.name, placed.area.middle(), TEXT_PX, Color::BLACK);
        }
    }
}

/// The mean of the poses' colours by their weights, made darker by `shade`.
fn mixed(weights: &[f64], shade: f64) -> Color {
    let mut sum = [0.0f64; 3];
    for (pose, weight) in weights.iter().enumerate() {
        let colour = pose_colour(pose, weights.len());
        for (s, c) in sum.iter_mut().zip([colour.red(), colour.green(), colour.blue()]) {
            *s += weight * f64::from(c);
        }
    }
    let [r, g, b] = sum.map(|s| (shade * (0.25 + 0.75 * s)).clamp(0.0, 1.0) as f32);
    Color::from_rgba(r, g, b, 1.0).unwrap_or(Color::WHITE)
}
