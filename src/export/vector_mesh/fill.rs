//! Fills: triangles by lyon, or those of the frame before.

use std::cmp::Ordering;

use lyon_tessellation::path::EndpointId;
use lyon_tessellation::{
    FillGeometryBuilder, FillOptions, FillTessellator, FillVertex, GeometryBuilder, GeometryBuilderError,
    TessellationError, VertexId, VertexSource,
};

use super::Triangles;
use super::known::{Known, Sampled};
use crate::math::{Point, SinglePrecision, predicate};
use crate::outline::{Ring, simplicity};
use crate::render::FillRule;

/// The triangles of the frame before in the places of this one; `None` if they are not a tessellation of it, or may not be.
///
/// Triangles that cover a path's inside, each once, and whose vertices are points of the path, have the path as the boundary of
/// their sum. That stays so when the points move, so that every place is in as many triangles, counted by their orientation, as the
/// path winds around it. If no triangle is turned over, that is: in as many triangles as the winding number, and the places
/// covered are those where it is not 0. They may be covered more than once where the path overlaps itself; if that would show, the
/// path must not meet itself.
pub(super) fn kept(old: &Known, sampled: &Sampled, rule: FillRule, overlaps_show: bool) -> Option<Triangles> {
    if old.sources.is_empty() || old.rule != Some(rule) {
        return None;
    }
    let positions: Vec<Point> = old.sources.iter().map(|&source| sampled.points[source]).collect();
    let mut common = Ordering::Equal;
    for triangle in old.indices.chunks_exact(3) {
        let [a, b, c] = [triangle[0], triangle[1], triangle[2]].map(|index| positions[index as usize]);
        let own = predicate::orientation(a, b, c);
        if common.then(own) != own && own != Ordering::Equal {
            return None;
        }
        common = common.then(own);
    }
    if overlaps_show && meets_itself(sampled) {
        return None;
    }
    Some(Triangles {
        positions,
        indices: old.indices.clone(),
        sources: old.sources.clone(),
    })
}

fn meets_itself(sampled: &Sampled) -> bool {
    let rings: Result<Vec<Ring>, _> = sampled
        .drawn()
        .map(|(_, points, _)| Ring::new(points.iter().copied()))
        .collect();
    // Where points fall together, the question is not worth an answer.
    rings.map_or(true, |rings| simplicity::first_meeting(&rings).is_some())
}

/// The triangles of the inside, by lyon.
pub(super) fn triangles(sampled: &Sampled, rule: FillRule) -> Result<Triangles, TessellationError> {
    let options = FillOptions::default().with_fill_rule(match rule {
        FillRule::NonZero => lyon_tessellation::FillRule::NonZero,
        FillRule::EvenOdd => lyon_tessellation::FillRule::EvenOdd,
    });
    let mut output = Output {
        single: sampled.single,
        endpoints: Vec::new(),
        vertices: Vec::new(),
        indices: Vec::new(),
        begins_at: (0, 0),
    };
    let (path, endpoints) = super::stroke::lyon_path(sampled, true)?;
    output.endpoints = endpoints;
    FillTessellator::new().tessellate_with_ids(path.id_iter(), &path, None, &options, &mut output)?;
    let sources: Option<Vec<usize>> = output.vertices.iter().map(|(_, source)| *source).collect();
    let place = |(place, source): &(Point, Option<usize>)| source.map_or(*place, |source| sampled.points[source]);
    Ok(Triangles {
        positions: output.vertices.iter().map(place).collect(),
        indices: output.indices,
        sources: sources.unwrap_or_default(),
    })
}

/// Takes what lyon makes.
struct Output {
    single: SinglePrecision,
    /// Which point of the path an endpoint is.
    endpoints: Vec<(EndpointId, usize)>,
    /// Where, and which point of the path, if it is one and only one.
    vertices: Vec<(Point, Option<usize>)>,
    indices: Vec<u32>,
    begins_at: (usize, usize),
}

impl GeometryBuilder for Output {
    fn begin_geometry(&mut self) {
        self.begins_at = (self.vertices.len(), self.indices.len());
    }

    fn add_triangle(&mut self, a: VertexId, b: VertexId, c: VertexId) {
        self.indices.extend([a.0, b.0, c.0]);
    }

    fn abort_geometry(&mut self) {
        self.vertices.truncate(self.begins_at.0);
        self.indices.truncate(self.begins_at.1);
    }
}

impl FillGeometryBuilder for Output {
    fn add_fill_vertex(&mut self, vertex: FillVertex<'_>) -> Result<VertexId, GeometryBuilderError> {
        let id = u32::try_from(self.vertices.len()).map_err(|_| GeometryBuilderError::TooManyVertices)?;
        let position = vertex.position();
        let mut sources = vertex.sources();
        let source = match (sources.next(), sources.next()) {
            (Some(VertexSource::Endpoint { id }), None) => {
                let found = self.endpoints.binary_search_by_key(&id.0, |(endpoint, _)| endpoint.0);
                found.ok().map(|place| self.endpoints[place].1)
            }
            _ => None,
        };
        self.vertices
            .push((self.single.to_double([position.x, position.y]), source));
        Ok(VertexId(id))
    }
}
