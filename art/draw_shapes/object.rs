//! Polygon meshes and their files.

use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;

use inbetween::math::Point3;

/// Polygons over vertices that are counted, not placed.
#[derive(Debug, Default)]
pub(crate) struct Polygons {
    pub(crate) vertex_count: usize,
    pub(crate) faces: Vec<Vec<usize>>,
}

impl Polygons {
    /// New vertices, as many as asked for.
    pub(crate) fn add(&mut self, count: usize) -> Vec<usize> {
        let from = self.vertex_count;
        self.vertex_count += count;
        (from..self.vertex_count).collect()
    }

    /// Quadrangles between two rings of equally many vertices, positive seen from outside if the rings are positive seen from
    /// where `next` is.
    pub(crate) fn tube(&mut self, ring: &[usize], next: &[usize]) {
        let count = ring.len();
        for (index, (&a, &b)) in ring.iter().zip(next).enumerate() {
            let (c, d) = (next[(index + 1) % count], ring[(index + 1) % count]);
            self.faces.push(vec![a, d, c, b]);
        }
    }

    /// Triangles from the sides of a ring to a point beyond it.
    pub(crate) fn cap(&mut self, ring: &[usize], tip: usize) {
        for (index, &a) in ring.iter().enumerate() {
            self.faces.push(vec![a, ring[(index + 1) % ring.len()], tip]);
        }
    }
}

/// Writes a form as a Wavefront OBJ file.
pub(crate) fn save(path: &Path, positions: &[Point3], faces: &[Vec<usize>]) -> Result<(), Box<dyn Error>> {
    let mut text = String::new();
    for at in positions {
        writeln!(text, "v {} {} {}", rounded(at.x), rounded(at.y), rounded(at.z))?;
    }
    for face in faces {
        text.push('f');
        for vertex in face {
            write!(text, " {}", vertex + 1)?;
        }
        text.push('\n');
    }
    std::fs::write(path, text)?;
    Ok(())
}

/// A number with at most four decimals, and no trailing zeros.
pub(crate) fn rounded(number: f64) -> String {
    let text = format!("{number:.4}");
    let short = text.trim_end_matches('0').trim_end_matches('.');
    if short == "-0" {
        "0".to_owned()
    } else {
        short.to_owned()
    }
}
