//! Wavefront OBJ: one form a file, with texture coordinates, and a material beside it where there is a texture.
//!
//! Faces are written as they were modelled, quadrangles as quadrangles. Coordinates have nine digits after the first digit of the
//! largest one: blends are sums, and their last digits are rounding. So an example of a shape, whose file has fewer
//! digits than that, is written with the coordinates that it was read with.

use std::fmt::Write as _;
use std::path::Path;

use super::{ExportError, PendingFile};
use crate::math::Point3;
use crate::shape3d::FormFace;

/// Digits of a coordinate after the first digit of the largest.
const DIGITS: i32 = 9;

/// A form as it is written.
#[derive(Debug, Clone, Copy)]
pub struct ObjForm<'a> {
    /// What it is called in the file.
    pub name: &'a str,
    /// Positions, #vertices.
    pub positions: &'a [Point3],
    /// Unit normals, #vertices, or none.
    pub normals: &'a [Point3],
    /// Faces. Their corners have texture coordinates, all of them or none.
    pub faces: &'a [FormFace],
    /// Places in the texture, from its lower left corner.
    pub texture_coordinates: &'a [[f64; 2]],
    /// The stem of the `.mtl` file beside it.
    pub material: Option<&'a str>,
}

/// The text of an `.obj` file.
#[must_use]
pub fn obj_text(form: &ObjForm<'_>) -> String {
    let mut text = String::with_capacity(64 * form.positions.len());
    let _ = writeln!(text, "# inbetween {}", env!("CARGO_PKG_VERSION"));
    if let Some(material) = form.material {
        let _ = writeln!(text, "mtllib {material}.mtl");
    }
    let _ = writeln!(text, "o {}", form.name.replace(char::is_whitespace, "_"));
    let largest = form.positions.iter().map(|p| p.amax()).fold(0.0, f64::max);
    add_lines(&mut text, "v", form.positions.iter().map(|p| [p.x, p.y, p.z]), largest);
    add_lines(&mut text, "vt", form.texture_coordinates.iter().copied(), 1.0);
    add_lines(&mut text, "vn", form.normals.iter().map(|n| [n.x, n.y, n.z]), 1.0);
    if form.material.is_some() {
        text.push_str("usemtl texture\n");
    }
    for face in form.faces {
        text.push('f');
        for (corner, vertex) in face.vertices.iter().enumerate() {
            let vertex = vertex + 1;
            let place = face.texture.get(corner).map(|place| place + 1);
            let _ = match (place, form.normals.is_empty()) {
                (None, true) => write!(text, " {vertex}"),
                (Some(place), true) => write!(text, " {vertex}/{place}"),
                (None, false) => write!(text, " {vertex}//{vertex}"),
                (Some(place), false) => write!(text, " {vertex}/{place}/{vertex}"),
            };
        }
        text.push('\n');
    }
    text
}

/// The text of an `.mtl` file that shows the picture `texture` beside it.
#[must_use]
pub fn mtl_text(texture: &str) -> String {
    format!("newmtl texture\nKd 1 1 1\nKs 0.04 0.04 0.04\nNs 40\nillum 2\nmap_Kd {texture}\n")
}

/// A picture and the material that shows it: `STEM.png` and `STEM.mtl`.
#[derive(Debug, Clone, Copy)]
pub struct ObjTexture<'a> {
    /// The stem of both files' names.
    pub stem: &'a str,
    /// The picture as a PNG file.
    pub png: &'a [u8],
}

impl ObjTexture<'_> {
    /// Opens both files in a folder, filled but not yet named.
    ///
    /// # Errors
    /// [`ExportError`] if the system refuses.
    pub fn pending(&self, folder: &Path) -> Result<Vec<PendingFile>, ExportError> {
        let picture = format!("{}.png", self.stem);
        let material = mtl_text(&picture);
        [
            (folder.join(picture), self.png),
            (folder.join(format!("{}.mtl", self.stem)), material.as_bytes()),
        ]
        .into_iter()
        .map(|(path, bytes)| PendingFile::filled(&path, bytes))
        .collect()
    }
}

/// Writes a form, and its texture with its material beside it.
///
/// # Errors
/// [`ExportError`] if the system refuses; then none of the files is there.
pub fn write_obj(target: &Path, form: &ObjForm<'_>, texture: Option<&ObjTexture<'_>>) -> Result<(), ExportError> {
    let folder = target.parent().unwrap_or(Path::new(""));
    let mut files = match texture {
        Some(texture) => texture.pending(folder)?,
        None => Vec::new(),
    };
    files.push(PendingFile::filled(target, obj_text(form).as_bytes())?);
    PendingFile::commit_all(files)
}

fn add_lines<const WIDTH: usize>(
    text: &mut String,
    word: &str,
    values: impl Iterator<Item = [f64; WIDTH]>,
    largest: f64,
) {
    let first_digit = if largest.is_normal() {
        largest.log10().floor() as i32
    } else {
        0
    };
    let decimals = (DIGITS - first_digit).clamp(0, 300) as usize;
    for value in values {
        text.push_str(word);
        for number in value {
            let written = format!("{number:.decimals$}");
            let short = match written.contains('.') {
                true => written.trim_end_matches('0').trim_end_matches('.'),
                false => &written,
            };
            text.push(' ');
            text.push_str(if short == "-0" { "0" } else { short });
        }
        text.push('\n');
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn face(vertices: &[usize], texture: &[usize]) -> FormFace {
        FormFace {
            vertices: vertices.to_vec(),
            texture: texture.to_vec(),
        }
    }

    #[test]
    fn a_quadrangle_stays_one_and_rounding_is_not_written() {
        let positions = [
            Point3::new(-0.0, 0.1 + 0.2, 1.0),
            Point3::new(100.0, 1e-12, 2.480_599_999_999_999_6),
            Point3::new(-2.5, 1.0 / 3.0, 0.0),
            Point3::zeros(),
        ];
        let mut form = ObjForm {
            name: "a b",
            positions: &positions,
            normals: &[],
            faces: &[face(&[0, 1, 2, 3], &[])],
            texture_coordinates: &[],
            material: None,
        };
        let text = obj_text(&form);
        let lines: Vec<&str> = text.lines().skip(1).collect();
        assert_eq!(
            lines,
            [
                "o a_b",
                "v 0 0.3 1",
                "v 100 0 2.4806",
                "v -2.5 0.3333333 0",
                "v 0 0 0",
                "f 1 2 3 4"
            ]
        );
        let textured = [face(&[0, 1, 2], &[1, 0, 1])];
        form.faces = &textured;
        form.texture_coordinates = &[[0.25, 1.0], [0.0, 0.5]];
        form.material = Some("a");
        let text = obj_text(&form);
        assert!(
            text.contains("mtllib a.mtl\n") && text.contains("vt 0.25 1\nvt 0 0.5\nusemtl texture\nf 1/2 2/1 3/2\n")
        );
        let normals = [Point3::z(); 4];
        form.normals = &normals;
        assert!(obj_text(&form).contains("vn 0 0 1\n") && obj_text(&form).ends_with("f 1/2/1 2/1/2 3/2/3\n"));
    }

    #[test]
    fn large_and_small_forms_keep_their_digits() {
        for scale in [1e-30, 1e-3, 1.0, 1e9, 1e12] {
            let positions = [Point3::new(1.0 / 3.0, -2.0 / 3.0, 1.0) * scale];
            let form = ObjForm {
                name: "a",
                positions: &positions,
                normals: &[],
                faces: &[],
                texture_coordinates: &[],
                material: None,
            };
            let text = obj_text(&form);
            let line = text.lines().last().expect("a vertex");
            let read: Vec<f64> = line[2..]
                .split(' ')
                .map(|word| word.parse().expect("a number"))
                .collect();
            assert!(
                (Point3::from_column_slice(&read) - positions[0]).amax() <= 1e-9 * scale,
                "{line}"
            );
        }
    }

    #[test]
    fn form_material_and_picture_appear_together() {
        let folder = tempfile::tempdir().expect("a folder");
        let form = ObjForm {
            name: "a",
            positions: &[Point3::zeros()],
            normals: &[],
            faces: &[],
            texture_coordinates: &[],
            material: Some("a"),
        };
        let texture = ObjTexture { stem: "a", png: b"png" };
        write_obj(&folder.path().join("a.obj"), &form, Some(&texture)).expect("written");
        let material = std::fs::read_to_string(folder.path().join("a.mtl")).expect("there");
        assert!(material.ends_with("map_Kd a.png\n"));
        assert_eq!(std::fs::read(folder.path().join("a.png")).expect("there"), b"png");
        write_obj(&folder.path().join("none/a.obj"), &form, None).expect_err("no such folder");
    }
}
