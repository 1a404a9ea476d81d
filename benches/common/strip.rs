//! The meshes that blends are measured on.

use inbetween::math::Point;
use inbetween::mesh::Topology;
use inbetween::pose::PoseSet;

/// A strip that is bent more from pose to pose, with vertices off the grid.
pub(crate) fn poses(columns: usize, rows: usize, count: usize) -> PoseSet {
    let vertex = |i: usize, j: usize| j * columns + i;
    let mut triangles = Vec::new();
    for j in 1..rows {
        for i in 1..columns {
            let [a, b, c, d] = [vertex(i - 1, j - 1), vertex(i, j - 1), vertex(i, j), vertex(i - 1, j)];
            triangles.extend(if (i + j) % 2 == 0 {
                [[a, b, c], [a, c, d]]
            } else {
                [[a, b, d], [b, c, d]]
            });
        }
    }
    let topology = Topology::new(columns * rows, triangles).expect("a grid");
    let flat: Vec<Point> = (0..columns * rows)
        .map(|v| {
            let (x, y) = ((v % columns) as f64, (v / columns) as f64);
            Point::new(x + 0.3 * (1.7 * y).sin() * (0.9 * x).cos(), y + 0.3 * (2.1 * x).sin())
        })
        .collect();
    let bent = |pose: usize| {
        let curvature = (0.1 + 1.9 * pose as f64 / count as f64) * std::f64::consts::PI / columns as f64;
        let place = |p: &Point| {
            let (sine, cosine) = (curvature * p.x).sin_cos();
            let radius = 1.0 / curvature + rows as f64 - p.y;
            Point::new(radius * sine, -radius * cosine)
        };
        (format!("pose {pose}"), flat.iter().map(place).collect())
    };
    PoseSet::new(topology, (0..count).map(bent).collect()).expect("poses")
}
