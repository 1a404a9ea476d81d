//! The mapping file: [`Mapping`] <-> JSON. No file is opened here.
//!
//! Format `inbetween.mapping`, version 1: poses with their full-resolution outlines and their #vertices positions, the
//! triangles, the boundary rings, the number of Steiner points and the matching as rows of arc-length parameters.
//! A pose that lies over itself is named in `immersed`, with a depth a triangle, and its parameters in the matching are `null`; `limbs` and `triangle_limb`
//! name the parts that move.
//! Numbers are printed so that they read back to the same `f64`.
//!
//! [`Mapping::from_json`] checks shapes and counts, so that what it returns can be used; whether the mesh is a valid
//! embedding is [`Mapping::check`]'s question. [`PoseSet::from_mapping_json`] asks less: blending needs no outlines, and
//! a hand-made file may have some that cross.

use serde::{Deserialize, Serialize};

use super::{Mapping, Matching, OverlappingPose, Overlaps, PoseSet, PoseSetError};
use crate::matching::{Correspondence, CorrespondenceError};
use crate::math::Point;
use crate::mesh::{Topology, TopologyError};
use crate::outline::{ArcLength, Outline, OutlineError, Ring, RingError};

/// The name of the format.
const FORMAT: &str = "inbetween.mapping";
/// The version of the format.
const VERSION: u32 = 1;
/// The fewest rows of the matching that are written: readers interpolate linearly between them.
const FEWEST_SAMPLES: usize = 256;

/// Why a text is no mapping.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MappingFileError {
    /// It is no JSON, or a key is missing or has the wrong type.
    #[error("not a mapping: {0}; `inbetween map` and `inbetween triangulate` write one")]
    Json(String),
    /// Another format or version.
    #[error("the format is '{format}' version {version}, but this release reads '{FORMAT}' version {VERSION}")]
    Version {
        /// What the file says.
        format: String,
        /// What the file says.
        version: u32,
    },
    /// Numbers of poses, vertices or rings disagree, or an index is out of range.
    #[error("{0}")]
    Counts(String),
    /// The matching names a pose that does not exist.
    #[error("the matching's reference '{0}' is no pose")]
    UnknownReference(String),
    /// A vertex is not finite or too large.
    #[error("pose '{pose}': vertex {vertex} at ({x}, {y}) is not finite or too far out")]
    BadVertex {
        /// The pose's name.
        pose: String,
        /// Which vertex.
        vertex: usize,
        /// Its x.
        x: f64,
        /// Its y.
        y: f64,
    },
    /// The triangles are no mesh.
    #[error("the triangles are no mesh: {0}")]
    Topology(#[from] TopologyError),
    /// The poses are no pose set.
    #[error(transparent)]
    Poses(#[from] PoseSetError),
    /// A pose's boundary is no closed curve.
    #[error("pose '{pose}': ring {ring} of its outline: {source}")]
    Ring {
        /// The pose's name.
        pose: String,
        /// Which ring; 0 is the outer one.
        ring: usize,
        /// What is wrong.
        source: RingError,
    },
    /// A pose's boundary is no outline.
    #[error("pose '{pose}': {source}")]
    Outline {
        /// The pose's name.
        pose: String,
        /// What is wrong.
        source: OutlineError,
    },
    /// A ring of a polygon runs the wrong way.
    #[error("pose '{pose}': {} runs the wrong way; outer rings have positive area (x y' - x' y summed), holes negative: reverse its points",
        if *ring == 0 { "its outline".to_owned() } else { format!("hole {}", ring - 1) })]
    WrongWay {
        /// The pose's name.
        pose: String,
        /// Which ring; 0 is the outer one.
        ring: usize,
    },
    /// The matching is no correspondence.
    #[error("the matching: {0}")]
    Matching(#[from] CorrespondenceError),
}

#[derive(Serialize, Deserialize)]
struct MappingText {
    format: String,
    version: u32,
    /// What is mapped of a character with several layers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    layer: Option<String>,
    poses: Vec<PoseText>,
    triangles: Vec<[usize; 3]>,
    rings: Vec<Vec<usize>>,
    steiner: usize,
    /// Poses that lie over themselves, and the limbs that do.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    immersed: Vec<ImmersedText>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    limbs: Vec<String>,
    /// -1 of the trunk.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    triangle_limb: Vec<i64>,
    matching: MatchingText,
}

#[derive(Serialize, Deserialize)]
struct ImmersedText {
    pose: String,
    depth: Vec<f64>,
}

#[derive(Serialize, Deserialize)]
struct PoseText {
    name: String,
    outline: Vec<[f64; 2]>,
    #[serde(default)]
    holes: Vec<Vec<[f64; 2]>>,
    vertices: Vec<[f64; 2]>,
    /// All pieces of a drawing that has several.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    parts: Vec<PartText>,
}

#[derive(Serialize, Deserialize)]
struct PartText {
    outline: Vec<[f64; 2]>,
    holes: Vec<Vec<[f64; 2]>>,
}

impl PartText {
    fn of(outline: &Outline) -> Self {
        let holes = outline.holes().iter().chain(outline.openings());
        Self {
            outline: pairs(outline.outer().points()),
            holes: holes.map(|hole| pairs(hole.points())).collect(),
        }
    }
}

#[derive(Serialize, Deserialize)]
struct MatchingText {
    reference: String,
    /// `null` in poses that lie over themselves: part of their boundary is hidden.
    samples: Vec<Vec<Option<f64>>>,
}

impl Mapping {
    /// The mapping as JSON text, with a final line break.
    #[must_use]
    pub fn to_json(&self) -> String {
        self.to_json_of(None, &[])
    }

    /// The same of one layer of several, with its name, and of drawings of several pieces: `parts` has for each pose the outlines of
    /// all of them, or none. Readers need neither.
    #[must_use]
    pub fn to_json_of(&self, layer: Option<&str>, parts: &[Vec<Outline>]) -> String {
        let names = self.poses.names();
        let pose = |(pose, outline): (usize, &Outline)| {
            let PartText { outline, holes } = PartText::of(outline);
            PoseText {
                name: names[pose].clone(),
                outline,
                holes,
                vertices: pairs(&self.poses.positions()[pose]),
                parts: parts.get(pose).into_iter().flatten().map(PartText::of).collect(),
            }
        };
        let text = MappingText {
            format: FORMAT.to_owned(),
            version: VERSION,
            layer: layer.map(str::to_owned),
            poses: self.outlines.iter().take(names.len()).enumerate().map(pose).collect(),
            triangles: self.poses.topology().triangles().to_vec(),
            rings: self.rings.clone(),
            steiner: self.steiner,
            immersed: (self.overlaps.poses.iter())
                .map(|known| ImmersedText {
                    pose: names.get(known.pose).cloned().unwrap_or_default(),
                    depth: known.depth.clone(),
                })
                .collect(),
            limbs: self.overlaps.limbs.clone(),
            triangle_limb: (self.overlaps.triangle_limb.iter())
                .map(|limb| limb.map_or(-1, |limb| i64::try_from(limb).unwrap_or(-1)))
                .collect(),
            matching: MatchingText {
                reference: names.get(self.matching.reference).cloned().unwrap_or_default(),
                samples: self.written_samples(),
            },
        };
        let mut json = serde_json::to_string(&text).expect("invariant: numbers, strings and lists are always JSON");
        json.push('\n');
        json
    }

    /// The rows of the matching, without the parameters of poses whose boundary is hidden.
    fn written_samples(&self) -> Vec<Vec<Option<f64>>> {
        let is_seen = |pose: usize| self.overlaps.depth(pose).is_none();
        let written = |row: Vec<f64>| {
            let parameters = row.into_iter().enumerate();
            parameters.map(|(pose, t)| is_seen(pose).then_some(t)).collect()
        };
        samples(&self.matching.outer).into_iter().map(written).collect()
    }

    /// Reads a mapping.
    ///
    /// # Errors
    /// [`MappingFileError`] if the text is no mapping, or its counts disagree.
    pub fn from_json(text: &str) -> Result<Self, MappingFileError> {
        let text = parse(text)?;
        let reference = text
            .poses
            .iter()
            .position(|pose| pose.name == text.matching.reference)
            .ok_or_else(|| MappingFileError::UnknownReference(text.matching.reference.clone()))?;
        let is_hidden: Vec<bool> = (text.poses.iter())
            .map(|pose| text.immersed.iter().any(|known| known.pose == pose.name))
            .collect();
        let outer = Correspondence::new(filled(&text.matching.samples, &is_hidden, reference)?)?;
        if outer.pose_count() != text.poses.len() {
            return Err(MappingFileError::Counts(format!(
                "{} poses, but the matching's rows have {} parameters",
                text.poses.len(),
                outer.pose_count()
            )));
        }
        let open = text.rings.len().saturating_sub(1);
        let outlines = text
            .poses
            .iter()
            .map(|pose| outline(pose, open))
            .collect::<Result<_, _>>()?;
        let overlaps = overlaps(&text)?;
        Ok(Self {
            overlaps,
            outlines,
            rings: text.rings.clone(),
            steiner: text.steiner,
            matching: Matching { reference, outer },
            poses: pose_set(text)?,
        })
    }
}

impl PoseSet {
    /// Reads only the mesh and its embeddings from the text of a mapping file.
    ///
    /// # Errors
    /// [`MappingFileError`] if the text is no mapping, or its counts disagree.
    pub fn from_mapping_json(text: &str) -> Result<Self, MappingFileError> {
        pose_set(parse(text)?)
    }
}

impl Overlaps {
    /// Reads only where the mesh lies over itself from the text of a mapping file.
    ///
    /// # Errors
    /// [`MappingFileError`] if the text is no mapping, or its counts disagree.
    pub fn from_mapping_json(text: &str) -> Result<Self, MappingFileError> {
        overlaps(&parse(text)?)
    }
}

/// Polygons whose vertices correspond: what `inbetween triangulate` reads.
#[derive(Debug, Clone, PartialEq)]
pub struct Polygons {
    /// The poses' names.
    pub names: Vec<String>,
    /// The polygons, one a pose, all with the same number of rings and of points in each.
    pub outlines: Vec<Outline>,
}

#[derive(Deserialize)]
struct PolygonsText {
    poses: Vec<PolygonText>,
}

#[derive(Deserialize)]
struct PolygonText {
    name: String,
    outline: Vec<[f64; 2]>,
    #[serde(default)]
    holes: Vec<Vec<[f64; 2]>>,
}

impl Polygons {
    /// Reads `{"poses": [{"name", "outline": [[x, y], ...], "holes": [...]}]}`.
    ///
    /// # Errors
    /// [`MappingFileError`] if the text is something else, counts differ between poses, a ring runs the wrong way or
    /// repeats a point, or a polygon crosses itself.
    pub fn from_json(text: &str) -> Result<Self, MappingFileError> {
        let text: PolygonsText =
            serde_json::from_str(text).map_err(|error| MappingFileError::Json(error.to_string()))?;
        let Some(first) = text.poses.first() else {
            return Err(MappingFileError::Poses(PoseSetError::NoPose));
        };
        let counts = |pose: &PolygonText| -> Vec<usize> {
            std::iter::once(pose.outline.len())
                .chain(pose.holes.iter().map(Vec::len))
                .collect()
        };
        let expected = counts(first);
        let mut names: Vec<String> = Vec::new();
        let mut outlines = Vec::new();
        for pose in &text.poses {
            if counts(pose) != expected {
                return Err(MappingFileError::Counts(format!(
                    "pose '{}' has rings of {:?} points, pose '{}' of {expected:?}; vertices must correspond one to one",
                    pose.name,
                    counts(pose),
                    first.name
                )));
            }
            if names.contains(&pose.name) {
                return Err(PoseSetError::SameName(pose.name.clone()).into());
            }
            let rings = rings(&pose.name, &pose.outline, &pose.holes)?;
            // Whether it crosses itself comes first: the area of a crossing ring says nothing.
            let outline = assemble(&pose.name, rings.clone())?;
            for (ring, (points, given)) in rings.iter().zip(&expected).enumerate() {
                if points.len() != *given {
                    return Err(MappingFileError::Counts(format!(
                        "pose '{}': ring {ring} repeats a point next to itself; remove the repetition in every pose",
                        pose.name
                    )));
                }
                if (points.signed_area() > 0.0) != (ring == 0) {
                    return Err(MappingFileError::WrongWay {
                        pose: pose.name.clone(),
                        ring,
                    });
                }
            }
            names.push(pose.name.clone());
            outlines.push(outline);
        }
        Ok(Self { names, outlines })
    }

    /// The matching of the outer rings that the numbering of the vertices states, dense enough to be written.
    #[must_use]
    pub fn matching(&self) -> Correspondence {
        let measured: Vec<ArcLength> = self.outlines.iter().map(|o| ArcLength::new(o.outer())).collect();
        let count = self.outlines.first().map_or(0, |o| o.outer().len());
        let rows = (0..count)
            .map(|k| measured.iter().map(|m| m.vertex_parameters()[k]).collect())
            .collect();
        // Vertices of a ring of positive area are in order along it; equal parameters could only come from edges
        // 1e-16 of the perimeter long.
        Correspondence::new(rows).unwrap_or_else(|_| Correspondence::identity(self.names.len(), count))
    }
}

fn parse(text: &str) -> Result<MappingText, MappingFileError> {
    let text: MappingText = serde_json::from_str(text).map_err(|error| MappingFileError::Json(error.to_string()))?;
    if text.format != FORMAT || text.version != VERSION {
        return Err(MappingFileError::Version {
            format: text.format,
            version: text.version,
        });
    }
    Ok(text)
}

fn pose_set(text: MappingText) -> Result<PoseSet, MappingFileError> {
    let vertex_count = text.poses.first().map_or(0, |pose| pose.vertices.len());
    if let Some(bad) = text.rings.iter().flatten().find(|v| **v >= vertex_count) {
        return Err(MappingFileError::Counts(format!(
            "a ring names vertex {bad}, but there are {vertex_count}"
        )));
    }
    let mut poses = Vec::with_capacity(text.poses.len());
    for pose in text.poses {
        for (vertex, [x, y]) in pose.vertices.iter().enumerate() {
            // Written so that NaN fails too.
            if !(x.abs() <= Ring::LARGEST_COORDINATE && y.abs() <= Ring::LARGEST_COORDINATE) {
                return Err(MappingFileError::BadVertex {
                    pose: pose.name.clone(),
                    vertex,
                    x: *x,
                    y: *y,
                });
            }
        }
        poses.push((pose.name, pose.vertices.into_iter().map(Point::from).collect()));
    }
    Ok(PoseSet::new(Topology::new(vertex_count, text.triangles)?, poses)?)
}

/// The outline of a pose whose first `open` holes are those of the mesh; the others are covered by it.
fn outline(pose: &PoseText, open: usize) -> Result<Outline, MappingFileError> {
    let whole = assemble(&pose.name, rings(&pose.name, &pose.outline, &pose.holes)?)?;
    let open: Vec<usize> = (0..whole.holes().len().min(open)).collect();
    Ok(whole.with_holes_in_order(&open))
}

fn rings(name: &str, outer: &[[f64; 2]], holes: &[Vec<[f64; 2]>]) -> Result<Vec<Ring>, MappingFileError> {
    std::iter::once(outer)
        .chain(holes.iter().map(Vec::as_slice))
        .enumerate()
        .map(|(ring, points)| {
            Ring::new(points.iter().copied().map(Point::from)).map_err(|source| MappingFileError::Ring {
                pose: name.to_owned(),
                ring,
                source,
            })
        })
        .collect()
}

fn assemble(name: &str, rings: Vec<Ring>) -> Result<Outline, MappingFileError> {
    let mut rings = rings.into_iter();
    let outer = rings.next().expect("invariant: the outer ring is always there");
    Outline::new(outer, rings.collect()).map_err(|source| MappingFileError::Outline {
        pose: name.to_owned(),
        source,
    })
}

/// Rows of the matching in which hidden boundaries have the reference's parameters.
fn filled(
    samples: &[Vec<Option<f64>>],
    is_hidden: &[bool],
    reference: usize,
) -> Result<Vec<Vec<f64>>, MappingFileError> {
    let row = |(number, row): (usize, &Vec<Option<f64>>)| {
        let own = row.get(reference).copied().flatten();
        let parameter = |(pose, t): (usize, &Option<f64>)| {
            t.or(if is_hidden.get(pose) == Some(&true) { own } else { None })
                .ok_or_else(|| {
                    MappingFileError::Counts(format!(
                        "row {number} of the matching has no parameter for pose {pose}, which does not lie over itself"
                    ))
                })
        };
        row.iter().enumerate().map(parameter).collect()
    };
    samples.iter().enumerate().map(row).collect()
}

/// Where the mesh lies over itself.
fn overlaps(text: &MappingText) -> Result<Overlaps, MappingFileError> {
    let triangles = text.triangles.len();
    let poses = text.immersed.iter().map(|known| {
        let pose = text.poses.iter().position(|pose| pose.name == known.pose);
        match pose.filter(|_| known.depth.len() == triangles) {
            Some(pose) => Ok(OverlappingPose {
                pose,
                depth: known.depth.clone(),
            }),
            None => Err(MappingFileError::Counts(format!(
                "'immersed' names pose '{}' with {} depths; the mesh has {triangles} triangles",
                known.pose,
                known.depth.len()
            ))),
        }
    });
    let poses = poses.collect::<Result<Vec<_>, _>>()?;
    let limb = |limb: &i64| match usize::try_from(*limb) {
        Ok(limb) if limb < text.limbs.len() => Ok(Some(limb)),
        Err(_) if *limb == -1 => Ok(None),
        _ => Err(MappingFileError::Counts(format!(
            "'triangle_limb' has {limb}, but there are {} limbs",
            text.limbs.len()
        ))),
    };
    let triangle_limb: Vec<Option<usize>> = text.triangle_limb.iter().map(limb).collect::<Result<_, _>>()?;
    if !triangle_limb.is_empty() && triangle_limb.len() != triangles {
        return Err(MappingFileError::Counts(format!(
            "'triangle_limb' has {} entries for {triangles} triangles",
            triangle_limb.len()
        )));
    }
    Ok(Overlaps {
        poses,
        limbs: text.limbs.clone(),
        triangle_limb,
    })
}

fn pairs(points: &[Point]) -> Vec<[f64; 2]> {
    points.iter().map(|p| [p.x, p.y]).collect()
}

/// The rows, each gap divided evenly until there are [`FEWEST_SAMPLES`]: the same piecewise linear mapping.
fn samples(correspondence: &Correspondence) -> Vec<Vec<f64>> {
    let count = correspondence.rows().len();
    let pieces = FEWEST_SAMPLES.div_ceil(count);
    if pieces == 1 {
        return correspondence.rows().to_vec();
    }
    (0..count)
        .flat_map(|row| (0..pieces).map(move |piece| row as f64 + piece as f64 / pieces as f64))
        .map(|coordinate| {
            (0..correspondence.pose_count())
                .map(|pose| correspondence.parameter(pose, coordinate))
                .collect()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square with a centre vertex, and a copy that is sheared by awkward numbers.
    fn mapping() -> Mapping {
        let topology = Topology::new(5, vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]).expect("a mesh");
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 0.5]].map(Point::from);
        let moved: Vec<Point> = corners.iter().map(|p| Point::new(p.x + 0.1 * p.y, p.y / 3.0)).collect();
        let ring = |p: &[Point]| Outline::new(Ring::new(p[..4].to_vec()).expect("a ring"), vec![]).expect("simple");
        Mapping {
            outlines: vec![ring(&corners), ring(&moved)],
            poses: PoseSet::new(
                topology,
                vec![("a".to_owned(), corners.to_vec()), ("b".to_owned(), moved)],
            )
            .expect("poses"),
            rings: vec![vec![0, 1, 2, 3]],
            steiner: 1,
            matching: Matching {
                reference: 1,
                outer: Correspondence::new(vec![vec![0.0, 0.1], vec![0.25, 0.3], vec![0.5, 0.7], vec![0.75, 0.9]])
                    .expect("monotone"),
            },
            overlaps: crate::pose::Overlaps::default(),
        }
    }

    #[test]
    fn numbers_come_back_the_same() {
        let mapping = mapping();
        let back = Mapping::from_json(&mapping.to_json()).expect("a mapping");
        assert_eq!(back.poses, mapping.poses);
        assert_eq!(back.outlines, mapping.outlines);
        assert_eq!(
            (back.rings, back.steiner, back.matching.reference),
            (mapping.rings.clone(), 1, 1)
        );
        assert!(back.matching.outer.rows().len() >= FEWEST_SAMPLES);
        for k in 0..100 {
            let t = f64::from(k) / 100.0;
            let gap = (back.matching.outer.carry(0, 1, t) - mapping.matching.outer.carry(0, 1, t)).abs();
            assert!(gap < 1e-12, "{t}: {gap}");
        }
        assert_eq!(PoseSet::from_mapping_json(&mapping.to_json()), Ok(mapping.poses));
    }

    #[test]
    fn what_is_no_mapping_is_refused() {
        let good = mapping().to_json();
        assert!(matches!(Mapping::from_json("[1,"), Err(MappingFileError::Json(_))));
        let with = |from: &str, to: &str| {
            assert!(good.contains(from), "{from}");
            Mapping::from_json(&good.replace(from, to)).expect_err("it is refused")
        };
        assert!(matches!(
            with("\"version\":1", "\"version\":7"),
            MappingFileError::Version { version: 7, .. }
        ));
        assert!(matches!(
            with("\"reference\":\"b\"", "\"reference\":\"c\""),
            MappingFileError::UnknownReference(_)
        ));
        assert!(matches!(with("[3,0,4]", "[3,0,9]"), MappingFileError::Topology(_)));
        assert!(matches!(
            with("[[0,1,2,3]]", "[[0,1,2,9]]"),
            MappingFileError::Counts(_)
        ));
        assert!(matches!(
            with("[0.5,0.5]", "[1e300,0.5]"),
            MappingFileError::BadVertex { vertex: 4, .. }
        ));
        assert!(matches!(
            with("\"name\":\"b\"", "\"name\":\"a\""),
            MappingFileError::UnknownReference(_)
        ));
    }

    #[test]
    fn polygons_must_correspond_and_run_the_right_way() {
        let read = |b: &str| {
            Polygons::from_json(&format!(
                r#"{{"poses":[{{"name":"a","outline":[[0,0],[2,0],[2,2]]}},{{"name":"b","outline":{b}}}]}}"#
            ))
        };
        let polygons = read("[[0,0],[4,0],[4,1]]").expect("polygons");
        assert_eq!(polygons.matching().rows().len(), 3);
        assert!(matches!(
            read("[[0,0],[4,1],[4,0]]"),
            Err(MappingFileError::WrongWay { ring: 0, .. })
        ));
        assert!(matches!(
            read("[[0,0],[4,0],[4,1],[0,1]]"),
            Err(MappingFileError::Counts(_))
        ));
        assert!(matches!(
            read("[[0,0],[0,0],[4,1]]"),
            Err(MappingFileError::Ring { .. })
        ));
    }
}
