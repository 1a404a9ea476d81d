//! Vector frames as triangles for engines (feature `lyon`): fills and strokes as one vertex buffer and one index buffer.
//!
//! [`VectorFrame`] -> [`VectorMesh`], frame after frame by one [`VectorTessellator`], which remembers what it made of each shape:
//!
//! 1. Curves are divided into equal steps of their parameters, as few as keep every chord within the tolerance; their number is a
//!    power of two and stays until a frame needs more (`known.rs`). So a vertex is the same point of the shape in every frame.
//! 2. Coordinates go to single precision, in which lyon works: the middle of the shape's box to the origin, its size to 1. Those that
//!    are not finite, or further away than [`VectorTessellator::FURTHEST`], are refused before: lyon takes them in release builds.
//! 3. A fill is tessellated by lyon once. In later frames its triangles are kept as they are as long as none of them turns over in the
//!    new frame, and, where overlaps would show, its outline does not meet itself (`fill.rs`). Where outlines cross, lyon invents vertices,
//!    and the fill is tessellated anew in every frame.
//! 4. A stroke is tessellated by lyon in every frame, after its dashes have been cut (`stroke.rs`). Its corners decide how many triangles
//!    it has, so its indices stay as long as no corner turns the other way.
//! 5. The caller's vertex constructor makes its own vertices from positions (pixels of the frame) and colours.
//!
//! [`MeshPart::indices_are_kept`] says whether a part has the indices of the frame before, in the same place: an engine then uploads
//! vertices alone.
//!
//! Limits: colours of gradients are those at the vertices, linear between them. A group that is translucent as a whole has that
//! opacity in each of its parts, and overlaps show. A clip is a part to be drawn into a stencil. Edges are not anti-aliased.
//!
//! Cost: linear in the vertices where indices are kept (a fill whose overlaps would show: n log n), n log n where they are not.

mod colour;
mod fill;
mod known;
mod stroke;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::ops::Range;

use self::colour::Painted;
use self::known::{Known, Sampled};
use crate::math::{NotSingle, Point};
use crate::render::{FillRule, Subpath, VectorFrame, VectorNode, VectorShape};

/// A vertex, to be made into one of the caller's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshVertex {
    /// In pixels of the frame: x to the right, y down.
    pub position: [f32; 2],
    /// Red, green, blue, alpha, not premultiplied, each in [0, 1], in the encoding of sRGB. Clips and pictures are white.
    pub colour: [f32; 4],
    /// Which part of the mesh it belongs to.
    pub part: usize,
}

/// What a part of a mesh is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum PartKind {
    /// The inside of a shape.
    Fill,
    /// The line of a shape.
    Stroke,
    /// What is seen of a group: to be drawn into a stencil, not to be seen itself.
    Clip,
    /// A rectangle for a picture, two triangles: upper left, upper right, lower right, lower left.
    Picture,
}

/// A part of a mesh: consecutive vertices and indices.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshPart {
    /// The id of the shape, group or picture.
    pub id: String,
    /// What of it.
    pub kind: PartKind,
    /// Its vertices.
    pub vertices: Range<usize>,
    /// Its indices, three a triangle.
    pub indices: Range<usize>,
    /// The part of kind [`PartKind::Clip`] within which it is seen, if any.
    pub clip: Option<usize>,
    /// Whether its indices are, number by number and place by place, those of the frame before.
    pub indices_are_kept: bool,
}

/// A frame as triangles.
#[derive(Debug, Clone, PartialEq)]
pub struct VectorMesh<V> {
    /// The caller's vertices.
    pub vertices: Vec<V>,
    /// Three a triangle. Triangles have no common orientation.
    pub indices: Vec<u32>,
    /// From back to front.
    pub parts: Vec<MeshPart>,
}

impl<V> VectorMesh<V> {
    /// Whether all indices are those of the frame before.
    #[must_use]
    pub fn indices_are_kept(&self) -> bool {
        self.parts.iter().all(|part| part.indices_are_kept)
    }
}

/// Why a frame has no mesh.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum VectorMeshError {
    /// The tolerance is no length.
    #[error("the tolerance is {0} pixels; it must be positive and finite")]
    BadTolerance(f64),
    /// A coordinate is not finite or too far away.
    #[error("'{id}' has a point at ({x}, {y}); meshes reach at most {furthest:e} pixels from the frame's corner", furthest = VectorTessellator::FURTHEST)]
    TooFar {
        /// The shape's or group's id.
        id: String,
        /// The place.
        x: f64,
        /// The place.
        y: f64,
    },
    /// lyon refuses.
    #[error("'{id}' cannot be tessellated: {source}")]
    Tessellation {
        /// The shape's or group's id.
        id: String,
        /// What lyon says.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// Indices take four bytes.
    #[error("the mesh has {0} vertices, more than indices of four bytes can name; draw the frame in parts")]
    TooManyVertices(usize),
}

/// Makes meshes of vector frames, and keeps indices from one frame to the next where it can.
#[derive(Debug)]
pub struct VectorTessellator {
    tolerance_px: f64,
    known: BTreeMap<(String, PartKind), Known>,
    /// The parts of the frame before: what indices are compared with.
    before: Vec<MeshPart>,
}

impl VectorTessellator {
    /// The furthest coordinate, in pixels: single precision still tells a sixteenth of a pixel there.
    pub const FURTHEST: f64 = 1e6;

    /// For meshes whose edges are at most `tolerance_px` pixels from their curves.
    ///
    /// # Errors
    /// [`VectorMeshError::BadTolerance`] if it is not positive and finite.
    pub fn new(tolerance_px: f64) -> Result<Self, VectorMeshError> {
        if !(tolerance_px > 0.0 && tolerance_px.is_finite()) {
            return Err(VectorMeshError::BadTolerance(tolerance_px));
        }
        Ok(Self {
            tolerance_px,
            known: BTreeMap::new(),
            before: Vec::new(),
        })
    }

    /// The mesh of a frame, of vertices that `vertex` makes. What is clear, and subpaths shrunk to a point, have no triangles, but
    /// keep their parts.
    ///
    /// # Errors
    /// [`VectorMeshError`] if a coordinate is not finite or too far away, or there are too many vertices. The next frame is then
    /// tessellated as if it were the first.
    pub fn tessellate<V>(
        &mut self,
        frame: &VectorFrame,
        vertex: impl FnMut(MeshVertex) -> V,
    ) -> Result<VectorMesh<V>, VectorMeshError> {
        let known = std::mem::take(&mut self.known);
        let mut before = std::mem::take(&mut self.before);
        let mut making = Making {
            tolerance_px: self.tolerance_px,
            known,
            made: BTreeMap::new(),
            mesh: VectorMesh {
                vertices: Vec::new(),
                indices: Vec::new(),
                parts: Vec::new(),
            },
            vertex,
        };
        making.add_all(&frame.nodes, 1.0, None)?;
        let Making { made, mut mesh, .. } = making;
        if mesh.parts.len() != before.len() {
            before.clear();
        }
        for (k, part) in mesh.parts.iter_mut().enumerate() {
            let is_in_its_place = before.get(k).is_some_and(|old| {
                (&old.id, old.kind, old.clip) == (&part.id, part.kind, part.clip)
                    && (&old.vertices, &old.indices) == (&part.vertices, &part.indices)
            });
            part.indices_are_kept &= is_in_its_place;
        }
        self.known = made;
        self.before.clone_from(&mesh.parts);
        Ok(mesh)
    }
}

/// A mesh under construction.
struct Making<V, F> {
    tolerance_px: f64,
    known: BTreeMap<(String, PartKind), Known>,
    made: BTreeMap<(String, PartKind), Known>,
    mesh: VectorMesh<V>,
    vertex: F,
}

impl<V, F: FnMut(MeshVertex) -> V> Making<V, F> {
    fn add_all(&mut self, nodes: &[VectorNode], opacity: f64, clip: Option<usize>) -> Result<(), VectorMeshError> {
        for node in nodes {
            match node {
                VectorNode::Shape(shape) => self.add_shape(shape, opacity, clip)?,
                VectorNode::Group(group) => {
                    let within = match &group.clip {
                        Some(rings) => {
                            let subpaths: Vec<Subpath> = rings.iter().filter_map(|ring| closed(ring)).collect();
                            let place = self.mesh.parts.len();
                            self.add_fill(
                                &group.id,
                                PartKind::Clip,
                                &subpaths,
                                FillRule::NonZero,
                                &Painted::WHITE,
                                clip,
                            )?;
                            Some(place)
                        }
                        None => clip,
                    };
                    self.add_all(&group.nodes, opacity * group.opacity.clamp(0.0, 1.0), within)?;
                }
                VectorNode::Picture(picture) => {
                    let [width, height] = [picture.frame.width, picture.frame.height].map(|side| side as f64);
                    let corners = [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]].map(Point::from);
                    let white = Painted::white(opacity * picture.opacity.clamp(0.0, 1.0));
                    self.add_part(
                        &picture.id,
                        PartKind::Picture,
                        &corners,
                        &[0, 1, 2, 0, 2, 3],
                        true,
                        &white,
                        clip,
                    )?;
                }
            }
        }
        Ok(())
    }

    fn add_shape(&mut self, shape: &VectorShape, opacity: f64, clip: Option<usize>) -> Result<(), VectorMeshError> {
        let opacity = opacity * shape.opacity.clamp(0.0, 1.0);
        if let Some(fill) = &shape.fill {
            let paint = Painted::new(&fill.paint, opacity);
            self.add_fill(&shape.id, PartKind::Fill, &shape.subpaths, fill.rule, &paint, clip)?;
        }
        if let Some(stroke) = &shape.stroke {
            let (key, sampled) = self.sampled(&shape.id, PartKind::Stroke, &shape.subpaths, 0.5 * stroke.width)?;
            let triangles = stroke::triangles(&sampled, stroke, self.tolerance_px);
            let triangles = triangles.map_err(|source| tessellation(&shape.id, source))?;
            let paint = Painted::new(&stroke.paint, opacity);
            let old = self.known.get(&key);
            let is_kept = old.is_some_and(|old| old.indices == triangles.indices);
            self.add_part(
                &shape.id,
                PartKind::Stroke,
                &triangles.positions,
                &triangles.indices,
                is_kept,
                &paint,
                clip,
            )?;
            self.made.insert(key, Known::of_stroke(sampled, triangles.indices));
        }
        Ok(())
    }

    fn add_fill(
        &mut self,
        id: &str,
        kind: PartKind,
        subpaths: &[Subpath],
        rule: FillRule,
        paint: &Painted<'_>,
        clip: Option<usize>,
    ) -> Result<(), VectorMeshError> {
        let (key, sampled) = self.sampled(id, kind, subpaths, 0.0)?;
        let old = self.known.get(&key).filter(|old| old.is_of(&sampled));
        let overlaps_show = rule == FillRule::EvenOdd || paint.is_translucent();
        let kept = old.and_then(|old| fill::kept(old, &sampled, rule, overlaps_show));
        let is_kept = kept.is_some();
        let triangles = match kept {
            Some(triangles) => triangles,
            None => fill::triangles(&sampled, rule).map_err(|source| tessellation(id, source))?,
        };
        self.add_part(id, kind, &triangles.positions, &triangles.indices, is_kept, paint, clip)?;
        self.made.insert(key, Known::of_fill(sampled, rule, triangles));
        Ok(())
    }

    /// The points of a path, and what it is known by. `reach` is how far lines reach beyond them.
    fn sampled(
        &self,
        id: &str,
        kind: PartKind,
        subpaths: &[Subpath],
        reach: f64,
    ) -> Result<((String, PartKind), Sampled), VectorMeshError> {
        let too_far = |p: &Point| VectorMeshError::TooFar {
            id: id.to_owned(),
            x: p.x,
            y: p.y,
        };
        // Written so that NaN fails too.
        let is_near = |p: &&Point| p.amax() <= VectorTessellator::FURTHEST;
        if let Some(p) = subpaths.iter().flat_map(Subpath::points).find(|p| !is_near(p)) {
            return Err(too_far(p));
        }
        if !is_near(&&Point::repeat(reach)) {
            return Err(too_far(&Point::repeat(reach)));
        }
        let key = (id.to_owned(), kind);
        let sampled = Sampled::new(subpaths, self.tolerance_px, self.known.get(&key));
        let sampled = sampled.map_err(|NotSingle::NotFinite { x, y }| too_far(&Point::new(x, y)))?;
        Ok((key, sampled))
    }

    #[expect(clippy::too_many_arguments, reason = "a part has as many properties")]
    fn add_part(
        &mut self,
        id: &str,
        kind: PartKind,
        positions: &[Point],
        indices: &[u32],
        indices_are_kept: bool,
        paint: &Painted<'_>,
        clip: Option<usize>,
    ) -> Result<(), VectorMeshError> {
        let mesh = &mut self.mesh;
        let part = mesh.parts.len();
        let (first, first_index) = (mesh.vertices.len(), mesh.indices.len());
        let Ok(offset) = u32::try_from(first + positions.len()).map(|_| first as u32) else {
            return Err(VectorMeshError::TooManyVertices(first + positions.len()));
        };
        for &p in positions {
            mesh.vertices.push((self.vertex)(MeshVertex {
                position: [p.x as f32, p.y as f32],
                colour: paint.at(p),
                part,
            }));
        }
        mesh.indices.extend(indices.iter().map(|index| offset + index));
        mesh.parts.push(MeshPart {
            id: id.to_owned(),
            kind,
            vertices: first..mesh.vertices.len(),
            indices: first_index..mesh.indices.len(),
            clip,
            indices_are_kept,
        });
        Ok(())
    }
}

/// Triangles of one part; indices count from its first vertex.
#[derive(Debug, Default, Clone, PartialEq)]
struct Triangles {
    positions: Vec<Point>,
    indices: Vec<u32>,
    /// For each vertex the point of the path that it is; empty if one is none.
    sources: Vec<usize>,
}

fn closed(ring: &[Point]) -> Option<Subpath> {
    let mut subpath = Subpath::starting_at(*ring.first()?);
    for p in &ring[1..] {
        subpath.line_to(*p);
    }
    subpath.is_closed = true;
    Some(subpath)
}

fn tessellation(id: &str, source: lyon_tessellation::TessellationError) -> VectorMeshError {
    VectorMeshError::Tessellation {
        id: id.to_owned(),
        source: Box::new(source),
    }
}
