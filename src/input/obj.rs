//! Forms in Wavefront OBJ files.
//!
//! Bytes -> [`ObjForm`]: positions (`v`), texture coordinates (`vt`) and faces (`f`) with any number of corners.
//!
//! - Indices count from 1, or backwards from the last one if negative; a corner is `v`, `v/vt`, `v//vn` or `v/vt/vn`.
//! - A line that ends in `\` goes on in the next; lines end in LF, CR LF or CR; `#` begins a comment.
//! - Of a vertex the first three numbers count (weights and colours after them are left out), of a texture coordinate
//!   the first two (a missing second one is 0).
//! - Normals are checked to be numbers and left out: blended forms get their own. Groups, objects, materials, lines, curves and
//!   words that are not known are left out, too: all faces of the file are one form.
//! - Faces with more than three corners are triangulated as [`FormTopology::new`] says; their corners are kept.
//!
//! What cannot be used is refused with its line.
//!
//! Cost: linear in the bytes, but for faces with many corners.

use std::path::{Path, PathBuf};

use crate::math::Point3;
use crate::shape3d::{Form, FormError, FormFace, FormTopology};

/// Longest piece of a file that is quoted in a message, in characters.
const LONGEST_QUOTE: usize = 40;

/// What an OBJ file holds: a form, and the topology that it is of.
#[derive(Debug, Clone, PartialEq)]
pub struct ObjForm {
    /// Faces, triangles and texture coordinates.
    pub topology: FormTopology,
    /// Where the vertices lie.
    pub form: Form,
}

/// Why an OBJ file cannot be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ObjError {
    /// The file cannot be opened or read.
    #[error("cannot read {}: {source}; check the path and its permissions", path.display())]
    Unreadable {
        /// Which file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// There is no vertex in the file.
    #[error("there is no vertex (a line that begins with 'v') in the file: is it a Wavefront OBJ file?")]
    NoVertex,
    /// A line cannot be used.
    #[error("line {line}: {problem}")]
    Line {
        /// Of the file, from 1; the first one of a statement that goes on in the next.
        line: usize,
        /// What is wrong with it.
        problem: ObjProblem,
    },
    /// A face cannot be used.
    #[error("line {line}: {problem}")]
    Face {
        /// Of the file, from 1.
        line: usize,
        /// What is wrong with it; faces and vertices are counted from 0.
        problem: FormError,
    },
    /// The faces or vertices make no form.
    #[error(transparent)]
    Form(#[from] FormError),
}

/// What is wrong with a line of an OBJ file.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ObjProblem {
    /// A number cannot be read, is not finite or too large.
    #[error("'{text}' is no number that is finite and at most {:e}", Form::LARGEST_COORDINATE)]
    Number {
        /// As written.
        text: String,
    },
    /// There are too few numbers.
    #[error("'{word}' needs at least {needed} numbers, but {found} follow")]
    TooFew {
        /// Of the statement.
        word: &'static str,
        /// How many are needed.
        needed: usize,
        /// How many there are.
        found: usize,
    },
    /// A corner of a face cannot be read.
    #[error("'{text}' is no corner of a face; write v, v/vt, v//vn or v/vt/vn with whole numbers other than 0")]
    Corner {
        /// As written.
        text: String,
    },
    /// An index means something that does not exist.
    #[error("the {what} {index} does not exist: there are {count}")]
    OutOfRange {
        /// What it counts.
        what: &'static str,
        /// As written.
        index: i64,
        /// How many there are, before this line if the index is negative.
        count: usize,
    },
    /// Some corners of a face have texture coordinates, others none.
    #[error("some corners of the face have texture coordinates and others none; export all or none")]
    MixedTexture,
}

/// The form in the OBJ file at `path`.
///
/// # Errors
/// As [`read_obj`], and [`ObjError::Unreadable`].
pub fn open_obj(path: &Path) -> Result<ObjForm, ObjError> {
    let bytes = std::fs::read(path).map_err(|source| ObjError::Unreadable {
        path: path.to_owned(),
        source,
    })?;
    read_obj(&bytes)
}

/// The form in the bytes of an OBJ file.
///
/// ```
/// use inbetween::input::read_obj;
///
/// # fn main() -> Result<(), inbetween::input::ObjError> {
/// let square = read_obj(b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")?;
/// assert_eq!(square.topology.faces().len(), 1);
/// assert_eq!(square.topology.triangles().len(), 2);
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// [`ObjError`] with the line, if a number or an index cannot be used, or there are no faces.
pub fn read_obj(bytes: &[u8]) -> Result<ObjForm, ObjError> {
    let mut reader = Reader::default();
    for_each_statement(bytes, |line, statement| {
        reader
            .take(line, statement)
            .map_err(|problem| ObjError::Line { line, problem })
    })?;
    reader.finish()
}

/// Calls `work` with the number of the first line and the text of each statement, comments and continuations resolved.
fn for_each_statement(bytes: &[u8], mut work: impl FnMut(usize, &str) -> Result<(), ObjError>) -> Result<(), ObjError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    // Files of old Macintoshes have no LF at all.
    let end = if bytes.contains(&b'\n') { b'\n' } else { b'\r' };
    let mut statement = String::new();
    let mut begun = 1;
    for (line, bytes) in bytes.split(|byte| *byte == end).enumerate() {
        if statement.is_empty() {
            begun = line + 1;
        }
        // Names may be in any encoding; numbers are in all of them the same.
        let text = String::from_utf8_lossy(bytes);
        let text = text.trim_end();
        let code = text.split('#').next().unwrap_or("");
        if let Some(part) = code.strip_suffix('\\') {
            statement.push_str(part);
            statement.push(' ');
            continue;
        }
        if statement.is_empty() {
            work(begun, code)?;
        } else {
            statement.push_str(code);
            work(begun, &statement)?;
            statement.clear();
        }
    }
    if statement.is_empty() {
        Ok(())
    } else {
        work(begun, &statement)
    }
}

/// What has been read so far.
#[derive(Default)]
struct Reader {
    positions: Vec<Point3>,
    texture_coordinates: Vec<[f64; 2]>,
    normal_count: usize,
    faces: Vec<FormFace>,
    face_lines: Vec<usize>,
    /// The largest indices seen, with their lines: they may mean what comes later.
    furthest: Furthest,
}

/// The largest positive index of each kind, as written, and its line.
#[derive(Default)]
struct Furthest {
    vertex: (usize, usize),
    texture: (usize, usize),
    normal: (usize, usize),
}

impl Reader {
    fn take(&mut self, line: usize, statement: &str) -> Result<(), ObjProblem> {
        let mut words = statement.split_ascii_whitespace();
        match words.next() {
            Some("v") => {
                let place = numbers::<3>("v", 3, words)?;
                self.positions.push(Point3::from(place));
            }
            Some("vt") => self.texture_coordinates.push(numbers::<2>("vt", 1, words)?),
            Some("vn") => {
                numbers::<3>("vn", 3, words)?;
                self.normal_count += 1;
            }
            // `fo` is how the first versions of the format called a face.
            Some("f" | "fo") => self.take_face(line, words)?,
            _ => {}
        }
        Ok(())
    }

    fn take_face<'a>(&mut self, line: usize, corners: impl Iterator<Item = &'a str>) -> Result<(), ObjProblem> {
        let mut face = FormFace::default();
        for text in corners {
            let refused = || ObjProblem::Corner { text: quoted(text) };
            let mut parts = text.split('/');
            let mut index = || match parts.next() {
                None | Some("") => Ok(None),
                Some(number) => match number.parse::<i64>() {
                    Ok(index) if index != 0 => Ok(Some(index)),
                    _ => Err(refused()),
                },
            };
            let (vertex, texture, normal) = (index()?.ok_or_else(refused)?, index()?, index()?);
            if parts.next().is_some() {
                return Err(refused());
            }
            let furthest = &mut self.furthest;
            let vertex = resolved("vertex", vertex, self.positions.len(), line, &mut furthest.vertex)?;
            face.vertices.push(vertex);
            if let Some(texture) = texture {
                let count = self.texture_coordinates.len();
                let texture = resolved("texture coordinate", texture, count, line, &mut furthest.texture)?;
                face.texture.push(texture);
            }
            if let Some(normal) = normal {
                resolved("normal", normal, self.normal_count, line, &mut furthest.normal)?;
            }
        }
        if !face.texture.is_empty() && face.texture.len() != face.vertices.len() {
            return Err(ObjProblem::MixedTexture);
        }
        self.faces.push(face);
        self.face_lines.push(line);
        Ok(())
    }

    fn finish(self) -> Result<ObjForm, ObjError> {
        if self.positions.is_empty() {
            return Err(ObjError::NoVertex);
        }
        let furthest = [
            ("vertex", self.furthest.vertex, self.positions.len()),
            (
                "texture coordinate",
                self.furthest.texture,
                self.texture_coordinates.len(),
            ),
            ("normal", self.furthest.normal, self.normal_count),
        ];
        for (what, (index, line), count) in furthest {
            if index > count {
                let index = index as i64;
                let problem = ObjProblem::OutOfRange { what, index, count };
                return Err(ObjError::Line { line, problem });
            }
        }
        let of_line = |problem: FormError| match problem {
            FormError::TooFewCorners { face, .. }
            | FormError::TooManyCorners { face, .. }
            | FormError::RepeatedVertex { face, .. } => ObjError::Face {
                line: self.face_lines[face],
                problem,
            },
            problem => ObjError::Form(problem),
        };
        let topology = FormTopology::new(&self.positions, self.faces, self.texture_coordinates).map_err(of_line)?;
        let form = Form::new(&topology, self.positions)?;
        Ok(ObjForm { topology, form })
    }
}

/// An index as written, from 0; remembers the furthest one.
fn resolved(
    what: &'static str,
    index: i64,
    count: usize,
    line: usize,
    furthest: &mut (usize, usize),
) -> Result<usize, ObjProblem> {
    let out_of_range = ObjProblem::OutOfRange { what, index, count };
    let distance = usize::try_from(index.unsigned_abs()).map_err(|_| out_of_range.clone())?;
    if index < 0 {
        return count.checked_sub(distance).ok_or(out_of_range);
    }
    if distance > furthest.0 {
        *furthest = (distance, line);
    }
    Ok(distance - 1)
}

/// The first `N` numbers, of which at least `needed` must be there.
fn numbers<'a, const N: usize>(
    word: &'static str,
    needed: usize,
    words: impl Iterator<Item = &'a str>,
) -> Result<[f64; N], ObjProblem> {
    let mut found = [0.0; N];
    let mut count = 0;
    for (number, text) in found.iter_mut().zip(words) {
        *number = match text.parse::<f64>() {
            Ok(value) if value.abs() <= Form::LARGEST_COORDINATE => value,
            _ => return Err(ObjProblem::Number { text: quoted(text) }),
        };
        count += 1;
    }
    if count >= needed {
        Ok(found)
    } else {
        Err(ObjProblem::TooFew {
            word,
            needed,
            found: count,
        })
    }
}

fn quoted(text: &str) -> String {
    text.chars().take(LONGEST_QUOTE).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A quadrangle and a triangle, in every spelling.
    const HOUSE: &str = "# a house\r\nmtllib house.mtl\no house\r\n\
        v 0 0 0 1.0\nv 2 0 0 0.5 0.5 0.5\nv 2 1 0\nv 0 1 0\nv\t1 1.5e0 -0.0 # roof\n\
        vt 0 0\nvt 1 0 0\nvt 1 1\nvt 0 1\nvt 0.5\nvn 0 0 1\ns 1\ng walls\nusemtl brick\n\
        f 1/1/1 2/2/1 \\\n  3/3/1 4/4/1\nf -3/-3/-1 -1/-1/-1 -2/-2/-1\nl 1 2\n";

    fn line_of(error: ObjError) -> usize {
        match error {
            ObjError::Line { line, .. } | ObjError::Face { line, .. } => line,
            other => panic!("no line: {other}"),
        }
    }

    #[test]
    fn every_spelling_of_a_face_is_read() {
        let house = read_obj(HOUSE.as_bytes()).expect("a house");
        assert_eq!(house.form.positions()[4], Point3::new(1.0, 1.5, 0.0));
        let faces = house.topology.faces();
        assert_eq!(faces[0].vertices, [0, 1, 2, 3]);
        assert_eq!(
            (&faces[1].vertices[..], &faces[1].texture[..]),
            (&[2, 4, 3][..], &[2, 4, 3][..])
        );
        assert_eq!(house.topology.triangles().len(), 3);
        assert_eq!(house.topology.texture_coordinates()[4], [0.5, 0.0]);
        // A mark at the beginning, line ends of other systems, no texture.
        let plain = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1//1 2//1 3//1\nvn 0 0 1";
        let expected = read_obj(plain.as_bytes()).expect("a triangle");
        assert!(!expected.topology.has_texture());
        for end in ["\n", "\r\n", "\r"] {
            let text = format!("\u{feff}{}", plain.replace('\n', end));
            assert_eq!(read_obj(text.as_bytes()).expect("a triangle"), expected);
        }
        // Names in Latin-1, and a face before its vertices.
        let mixed = b"o caf\xe9\nf 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
        assert_eq!(read_obj(mixed).expect("a triangle"), expected);
    }

    #[test]
    fn mistakes_are_refused_with_their_line() {
        let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
        for (rest, line, said) in [
            ("f 1 2 4\n", 4, "vertex 4 does not exist: there are 3"),
            ("\nf 1 2 -4\n", 5, "vertex -4 does not exist"),
            ("f 1 2 0\n", 4, "'0' is no corner"),
            ("f 1 2 x\n", 4, "'x' is no corner"),
            ("f 1/1/1/1 2 3\n", 4, "'1/1/1/1' is no corner"),
            ("f 1/ 2 /3\n", 4, "'/3' is no corner"),
            ("vt 0 0\nf 1/1 2/1 3\n", 5, "others none"),
            ("f 1/1 2/1 3/1\n", 4, "texture coordinate 1 does not exist"),
            ("f 1//1 2//1 3//1\n", 4, "normal 1 does not exist"),
            ("f 1 2\n", 4, "2 corners"),
            ("f 1 2 3 2\n", 4, "vertex 1 more than once"),
            ("v 1 \\\n  nan 3\nf 1 2 3\n", 4, "'nan' is no number"),
            ("v 1 1e13 3\n", 4, "'1e13' is no number"),
            ("v 1,5 2 3\n", 4, "'1,5' is no number"),
            ("v 1 2\n", 4, "needs at least 3 numbers, but 2 follow"),
            ("f 1 2 99999999999999999999\n", 4, "is no corner"),
        ] {
            let error = read_obj(format!("{triangle}{rest}").as_bytes()).expect_err(rest);
            assert!(error.to_string().contains(said), "{error} instead of {said}");
            assert_eq!(line_of(error), line, "{rest}");
        }
        assert!(matches!(read_obj(b""), Err(ObjError::NoVertex)));
        assert!(matches!(
            read_obj(triangle.as_bytes()),
            Err(ObjError::Form(FormError::NoFace))
        ));
        assert!(open_obj(Path::new("there/is/no.obj")).is_err());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn no_bytes_make_it_panic(
            pieces in prop::collection::vec(
                prop::sample::select(vec![
                    "v ", "vt ", "vn ", "f ", "1 ", "-1 ", "2/1 ", "3//1 ", "0.5 ", "\\\n", "\n", "\r", "#", "1e999 ", "/", "4 ", "\u{e9}",
                ]),
                0..60,
            ),
        ) {
            let text = format!("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 1\n{}", pieces.concat());
            if let Ok(read) = read_obj(text.as_bytes()) {
                prop_assert!(read.topology.triangles().iter().flatten().all(|&v| v < read.form.positions().len()));
            }
        }
    }
}
