//! The regions of a mesh that lies over itself: which triangles each has, how it is called, where its edge runs, and its mesh apart from the others.

use super::depth_order::DepthOrder;
use super::division::Division;
use super::rim::{Boundary, Rim, boundary_loops};
use super::stretch::AtRest;
use crate::math::{Point, point};
use crate::mesh::geometry;
use crate::pose::Mapping;
use crate::render::Silhouette;

/// Rings of triangles by which a region is painted beyond its rim, and by which its rim lies beyond it.
const PAINTED_RINGS: usize = 2;
const RIM_RINGS: usize = 1;

/// What a region is called in which most triangles belong to no limb.
const TRUNK: &str = "trunk";

/// The regions of a mapping that can be painted one after another.
#[derive(Debug, Clone)]
pub(crate) struct Regions {
    order: DepthOrder,
    /// By triangle.
    region_of: Vec<usize>,
    open: usize,
    /// By region, the triangles that it is painted with.
    painted: Vec<Vec<usize>>,
    /// The mesh in the open pose.
    rest: AtRest,
    rims: Vec<Vec<Rim>>,
    meshes: Vec<RegionMesh>,
    names: Vec<String>,
    /// By pose, the rings of its silhouette.
    shown: Vec<Vec<Vec<Point>>>,
}

/// A region as a mesh of its own.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RegionMesh {
    /// Which vertices of the whole mesh it has, in order.
    pub(crate) vertices: Vec<usize>,
    /// Three of its own vertices each, by their places in `vertices`.
    pub(crate) triangles: Vec<[usize; 3]>,
    /// Its boundary, of its own vertices: the outer ring first.
    pub(crate) rings: Vec<Vec<usize>>,
}

impl Regions {
    /// The regions of `mapping`, whose outline `silhouette` carries.
    #[must_use]
    pub(crate) fn new(mapping: &Mapping, silhouette: &Silhouette) -> Self {
        let Division { region_of, order } = Division::new(mapping);
        let triangles = mapping.poses.topology().triangles();
        let positions = mapping.poses.positions();
        let unit = |pose: usize| -> Vec<f64> { (0..positions.len()).map(|k| f64::from(u8::from(k == pose))).collect() };
        let shown: Vec<Vec<Vec<Point>>> = (0..positions.len())
            .map(|pose| silhouette.at(&positions[pose], &unit(pose)))
            .collect();
        let open = (0..positions.len())
            .find(|pose| mapping.overlaps.depth(*pose).is_none())
            .unwrap_or(0);
        let boundary = Boundary::new(&mapping.rings, &shown[open], &positions[open]);
        let own: Vec<Vec<usize>> = (0..order.region_count())
            .map(|region| (0..triangles.len()).filter(|t| region_of[*t] == region).collect())
            .collect();
        let within_rims: Vec<Vec<[usize; 3]>> = (own.iter())
            .map(|own| corners(triangles, &with_rings(triangles, own, RIM_RINGS)))
            .collect();
        Self {
            names: names(mapping, &own),
            order,
            region_of,
            open,
            rims: within_rims.iter().map(|within| boundary.rims(within)).collect(),
            meshes: within_rims
                .iter()
                .map(|within| RegionMesh::new(within, &positions[open]))
                .collect(),
            painted: (own.iter())
                .map(|own| with_rings(triangles, own, PAINTED_RINGS))
                .collect(),
            rest: AtRest::new(mapping.poses.topology(), &positions[open]),
            shown,
        }
    }

    /// How many there are.
    #[must_use]
    pub(crate) fn count(&self) -> usize {
        self.painted.len()
    }

    /// Which lies in front of which.
    #[must_use]
    pub(crate) fn order(&self) -> &DepthOrder {
        &self.order
    }

    /// The region that a triangle is of.
    #[must_use]
    pub(crate) fn region_of(&self, triangle: usize) -> usize {
        self.region_of[triangle]
    }

    /// A pose that does not lie over itself.
    #[must_use]
    pub(crate) fn open_pose(&self) -> usize {
        self.open
    }

    /// By region, the name of the limb that most of its triangles belong to; no two are called alike.
    #[must_use]
    pub(crate) fn names(&self) -> &[String] {
        &self.names
    }

    /// The triangles, by number, that a region is painted with: its own and those around them.
    pub(super) fn painted(&self, region: usize) -> &[usize] {
        &self.painted[region]
    }

    /// The mesh in a pose that does not lie over itself.
    pub(super) fn rest(&self) -> &AtRest {
        &self.rest
    }

    /// The edge of a region in a pose, in source units.
    pub(super) fn rims_at(&self, region: usize, pose: usize, mapping: &Mapping) -> Vec<Vec<Point>> {
        self.rims_in(region, &self.shown[pose], &mapping.poses.positions()[pose])
    }

    /// The edge of a region where the rings of the silhouette and the vertices of the mesh are there.
    pub(super) fn rims_in(&self, region: usize, rings: &[Vec<Point>], positions: &[Point]) -> Vec<Vec<Point>> {
        self.rims[region].iter().map(|rim| rim.at(rings, positions)).collect()
    }

    /// About so many points of a region's edge, as far apart as the same number around it are in an open pose: by point, its places in all poses. Those that another part of
    /// the region lies over in some pose are left out, since the edge is not seen there.
    #[must_use]
    pub(crate) fn edge_points(&self, region: usize, mapping: &Mapping, count: usize) -> Vec<Vec<Point>> {
        let poses = 0..mapping.poses.len();
        let at = |rim: &Rim, pose: usize| rim.at(&self.shown[pose], &mapping.poses.positions()[pose]);
        let steps = |ring: &[Point]| -> Vec<f64> {
            let next = ring.iter().cycle().skip(1);
            ring.iter().zip(next).map(|(a, b)| (b - a).norm()).collect()
        };
        let length = |rim: &&Rim| steps(&at(rim, self.open)).iter().sum::<f64>();
        let longest = self.rims[region].iter().max_by(|a, b| length(a).total_cmp(&length(b)));
        let Some(rim) = longest else { return Vec::new() };
        let rings: Vec<Vec<Point>> = poses.map(|pose| at(rim, pose)).collect();
        let (steps, total) = (steps(&rings[self.open]), length(&rim));
        let mut travelled = 0.0;
        let mut points = Vec::new();
        for (node, step) in steps.iter().enumerate() {
            let is_next = travelled * count as f64 >= points.len() as f64 * total && points.len() < count;
            if is_next {
                points.push(node);
            }
            travelled += step;
        }
        let places = |node: usize| -> Option<Vec<Point>> { rings.iter().map(|ring| ring.get(node).copied()).collect() };
        let mesh = &self.meshes[region];
        let holding = |pose: usize, place: Point| -> Vec<[usize; 3]> {
            let positions = &mapping.poses.positions()[pose];
            let holds = |triangle: &&[usize; 3]| {
                let corners = triangle.map(|v| positions[mesh.vertices[v]]);
                let shares = geometry::barycentric(corners, place);
                shares.is_some_and(|shares| shares.iter().all(|share| *share >= 0.0))
            };
            mesh.triangles.iter().filter(holds).copied().collect()
        };
        let is_seen = |places: &Vec<Point>| {
            let own: Vec<usize> = holding(self.open, places[self.open]).concat();
            let is_own = |triangle: &[usize; 3]| triangle.iter().any(|v| own.contains(v));
            (0..places.len()).all(|pose| holding(pose, places[pose]).iter().all(is_own))
        };
        points.into_iter().filter_map(places).filter(is_seen).collect()
    }

    /// A region as a mesh of its own: the triangles that its edge runs around, or passes through.
    #[must_use]
    pub(crate) fn mesh(&self, region: usize) -> &RegionMesh {
        &self.meshes[region]
    }
}

impl RegionMesh {
    /// Some triangles of a mesh whose vertices are at `positions` in a pose that does not lie over itself.
    fn new(triangles: &[[usize; 3]], positions: &[Point]) -> Self {
        let mut vertices: Vec<usize> = triangles.iter().flatten().copied().collect();
        vertices.sort_unstable();
        vertices.dedup();
        let mut place_of = vec![0; positions.len()];
        for (place, v) in vertices.iter().enumerate() {
            place_of[*v] = place;
        }
        let mut rings: Vec<(f64, Vec<usize>)> = (boundary_loops(triangles).iter())
            .map(|edges| {
                let areas = edges.iter().map(|(a, b)| point::cross(positions[*a], positions[*b]));
                (areas.sum(), edges.iter().map(|(a, _)| place_of[*a]).collect())
            })
            .collect();
        // Holes run the other way.
        rings.sort_by(|(a, _), (b, _)| b.total_cmp(a));
        Self {
            triangles: triangles.iter().map(|triangle| triangle.map(|v| place_of[v])).collect(),
            rings: rings.into_iter().map(|(_, ring)| ring).collect(),
            vertices,
        }
    }
}

/// By region, what it is called.
fn names(mapping: &Mapping, own: &[Vec<usize>]) -> Vec<String> {
    let overlaps = &mapping.overlaps;
    let mut names: Vec<String> = Vec::new();
    for own in own {
        // The trunk is the last of them.
        let mut counts = vec![0usize; overlaps.limbs.len() + 1];
        for t in own {
            let limb = overlaps.triangle_limb.get(*t).copied().flatten();
            counts[limb.unwrap_or(overlaps.limbs.len()).min(overlaps.limbs.len())] += 1;
        }
        // Of equals the first.
        let most = (0..counts.len()).rev().max_by_key(|limb| counts[*limb]);
        let name = most
            .and_then(|limb| overlaps.limbs.get(limb))
            .map_or(TRUNK, String::as_str);
        let numbered = (2..).map(|number| format!("{name}#{number}"));
        let mut choices = std::iter::once(name.to_owned()).chain(numbered);
        names.extend(choices.find(|choice| !names.contains(choice)));
    }
    names
}

/// Some triangles and those around them, in order.
fn with_rings(triangles: &[[usize; 3]], own: &[usize], rings: usize) -> Vec<usize> {
    let mut is_in = vec![false; triangles.len()];
    own.iter().for_each(|t| is_in[*t] = true);
    let most = triangles.iter().flatten().max().map_or(0, |v| v + 1);
    for _ in 0..rings {
        let mut touched = vec![false; most];
        let inside = (0..triangles.len()).filter(|t| is_in[*t]);
        inside.flat_map(|t| triangles[t]).for_each(|v| touched[v] = true);
        for (t, triangle) in triangles.iter().enumerate() {
            is_in[t] |= triangle.iter().any(|v| touched[*v]);
        }
    }
    (0..triangles.len()).filter(|t| is_in[*t]).collect()
}

fn corners(triangles: &[[usize; 3]], numbers: &[usize]) -> Vec<[usize; 3]> {
    numbers.iter().map(|t| triangles[*t]).collect()
}
