//! The reference's working pixels that a fine mesh covers.

use crate::math::Point;
use crate::mesh::{Topology, geometry};

/// No pixel of the grid.
pub(super) const NONE: u32 = u32::MAX;

/// A pixel whose middle a triangle covers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Covered {
    pub(super) triangle: [u32; 3],
    /// Barycentric.
    pub(super) shares: [f32; 3],
    /// The covered pixels to the left, to the right, above and below, or [`NONE`].
    pub(super) around: [u32; 4],
}

/// A fine mesh on the reference, in working pixels.
#[derive(Debug)]
pub(super) struct Surface {
    pub(super) triangles: Vec<[usize; 3]>,
    pub(super) vertices: Vec<Point>,
    /// The vertices next to each.
    pub(super) neighbours: Vec<Vec<usize>>,
}

/// The pixels that a surface covers, or every second or third of them along and across: a picture that is blurred needs no more.
#[derive(Debug)]
pub(super) struct Grid {
    /// Working pixels from one to the next.
    pub(super) step: usize,
    pub(super) pixels: Vec<Covered>,
}

impl Surface {
    pub(super) fn new(topology: &Topology, vertices: &[Point]) -> Self {
        Self {
            triangles: topology.triangles().to_vec(),
            vertices: vertices.to_vec(),
            neighbours: topology.vertex_neighbours(),
        }
    }
}

impl Grid {
    /// Of a picture of this many columns and rows; where triangles overlap, the last one is taken.
    pub(super) fn new(surface: &Surface, size: [usize; 2], step: usize) -> Self {
        let [width, height] = size.map(|side| side.div_ceil(step));
        let vertices: Vec<Point> = surface.vertices.iter().map(|v| v / step as f64).collect();
        let mut at: Vec<Option<([usize; 3], [f32; 3])>> = vec![None; width * height];
        for triangle in &surface.triangles {
            let corners = geometry::corners(&vertices, *triangle);
            let [a, b, c] = corners;
            let (low, high) = (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
            // Casts saturate.
            let columns = (low.x - 0.5).ceil().max(0.0) as usize..((high.x + 0.5).floor().max(0.0) as usize).min(width);
            let rows = (low.y - 0.5).ceil().max(0.0) as usize..((high.y + 0.5).floor().max(0.0) as usize).min(height);
            for row in rows {
                for column in columns.clone() {
                    let middle = Point::new(column as f64 + 0.5, row as f64 + 0.5);
                    if let Some(shares) = geometry::barycentric(corners, middle)
                        && shares.iter().all(|share| *share >= 0.0)
                    {
                        at[row * width + column] = Some((*triangle, shares.map(|share| share as f32)));
                    }
                }
            }
        }
        let mut number = vec![NONE; width * height];
        let mut count = 0;
        for (number, at) in number.iter_mut().zip(&at) {
            if at.is_some() {
                *number = count;
                count += 1;
            }
        }
        let mut pixels = Vec::with_capacity(count as usize);
        for (k, at) in at.iter().enumerate() {
            let Some((triangle, shares)) = at else { continue };
            let (column, row) = (k % width, k / width);
            let beside = |is_there: bool, k: usize| if is_there { number[k] } else { NONE };
            pixels.push(Covered {
                triangle: triangle.map(|v| v as u32),
                shares: *shares,
                around: [
                    beside(column > 0, k.wrapping_sub(1)),
                    beside(column + 1 < width, k + 1),
                    beside(row > 0, k.wrapping_sub(width)),
                    beside(row + 1 < height, k + width),
                ],
            });
        }
        Self { step, pixels }
    }
}
