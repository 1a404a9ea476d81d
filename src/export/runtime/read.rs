//! Bytes -> a character, whatever the bytes.

use super::{
    CANONICAL, MAGIC, RuntimeAnimation, RuntimeError, RuntimeFile, RuntimeLayer, RuntimePoint, RuntimePose,
    RuntimeRegion, RuntimeRegions, RuntimeTexture, RuntimeTie, VERSION, VERSION_WITH_REGIONS, WeightField,
};
use crate::blend::{Anchor, BlendOptions, FrameGuard, Reference, Region, SoftAnchor, Stretch};
use crate::math::{Point, predicate};
use crate::mesh::{MeshPoint, Topology, geometry};
use crate::pose::PoseSet;
use crate::render::DepthOrder;

/// How far from 1 weights may sum.
const SUM_TOLERANCE: f64 = 1e-4;
/// The largest position: as for outlines.
const LARGEST_COORDINATE: f64 = 1e7;
/// What every PNG file begins with.
const PNG: [u8; 8] = [0x89, b'P', b'N', b'G', b'\r', b'\n', 0x1a, b'\n'];

/// Reads a character. What it takes in memory is bounded by a multiple of the bytes given.
///
/// # Errors
/// [`RuntimeError`] if they are no sound character.
pub fn read_runtime(bytes: &[u8]) -> Result<RuntimeFile, RuntimeError> {
    let mut reader = Reader {
        bytes,
        at: 0,
        has_regions: false,
    };
    if reader.take(4, "the header").ok() != Some(&MAGIC) {
        return Err(RuntimeError::NotOurs);
    }
    let found = u16::from_le_bytes(reader.array("the header")?);
    if found != VERSION && found != VERSION_WITH_REGIONS {
        return Err(RuntimeError::Version { found });
    }
    reader.has_regions = found == VERSION_WITH_REGIONS;
    let is_quantised = reader.choice(2, "precision")? == 1;
    reader.choice(1, "reserved byte")?;
    let size = [reader.word("the header")?, reader.word("the header")?];
    let texture_sharpness = reader.finite("the header")?;
    if size.contains(&0) || !(0.0..=1.0).contains(&texture_sharpness) {
        return reader.damaged("a frame without pixels, or a sharpness outside 0 to 1");
    }
    let [pose_count, dimension, layer_count] = [(); 3].map(|()| reader.word("the header"));
    let (pose_count, dimension, layer_count) = (pose_count? as usize, dimension? as usize, layer_count? as usize);
    reader.room(pose_count, 2 + dimension * 8 + layer_count * 4, "the poses")?;
    if pose_count == 0 || layer_count == 0 || dimension == 0 {
        return reader.damaged("there are no poses, no layers or no dimension");
    }
    let poses: Vec<RuntimePose> = (0..pose_count)
        .map(|_| {
            let name = reader.string()?;
            let at = (0..dimension)
                .map(|_| reader.finite("a place"))
                .collect::<Result<_, _>>()?;
            let order = reader.indices(layer_count, layer_count, "the order of layers")?;
            let mut sorted = order.clone();
            sorted.sort_unstable();
            if !sorted.into_iter().eq(0..layer_count) {
                return reader.damaged("an order lacks a layer");
            }
            Ok(RuntimePose { name, at, order })
        })
        .collect::<Result<_, _>>()?;
    let field = match reader.choice(2, "weights over the plane")? {
        0 => None,
        _ => Some(reader.field(pose_count, dimension)?),
    };
    let animation = reader.animation(pose_count)?;
    // A layer takes some 40 bytes at least.
    reader.room(layer_count, 40, "the layers")?;
    let layers: Vec<RuntimeLayer> = (0..layer_count)
        .map(|_| reader.layer(&poses, layer_count, is_quantised))
        .collect::<Result<_, _>>()?;
    for layer in &layers {
        if let Some(tie) = &layer.tie {
            let vertices = layers[tie.to].mesh.topology().vertex_count();
            if tie
                .other
                .iter()
                .any(|point| point.vertices.iter().any(|&v| v >= vertices))
            {
                return reader.damaged("a tie holds a vertex that does not exist");
            }
        }
    }
    if layers.iter().any(|layer| hangs_in_a_circle(layer, &layers)) {
        return reader.damaged("layers hang on one another in a circle");
    }
    if reader.at != bytes.len() {
        return reader.damaged("more follows than belongs to the file");
    }
    Ok(RuntimeFile {
        size,
        texture_sharpness,
        poses,
        field,
        animation,
        layers,
    })
}

/// Whether vertices of a mesh of so many are stored in two bytes.
pub(super) fn is_short(vertices: usize) -> bool {
    vertices <= 1 << 16
}

fn hangs_in_a_circle(layer: &RuntimeLayer, layers: &[RuntimeLayer]) -> bool {
    let mut tie = layer.tie.as_ref();
    for _ in 0..=layers.len() {
        match tie {
            None => return false,
            Some(to) => tie = layers[to.to].tie.as_ref(),
        }
    }
    true
}

struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Whether the file is of the version in which layers have them.
    has_regions: bool,
}

impl<'a> Reader<'a> {
    fn layer(
        &mut self,
        poses: &[RuntimePose],
        layer_count: usize,
        is_quantised: bool,
    ) -> Result<RuntimeLayer, RuntimeError> {
        let name = self.string()?;
        let pose_count = self.word("a layer")? as usize;
        let own = self.indices(pose_count, poses.len(), "a layer's poses")?;
        let texture_of = self.indices(pose_count, usize::MAX, "a layer's textures")?;
        if own.windows(2).any(|pair| pair[0] >= pair[1]) {
            return self.damaged("the poses of a layer do not increase");
        }
        let (vertices, triangle_count) = (self.word("a mesh")? as usize, self.word("a mesh")? as usize);
        let corners = self.vertices(triangle_count.saturating_mul(3), vertices, "the triangles")?;
        let triangles: Vec<[usize; 3]> = corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
        let ring_count = self.word("the rings")? as usize;
        self.room(ring_count, 4, "the rings")?;
        let rings = (0..ring_count)
            .map(|_| {
                let count = self.word("a ring")? as usize;
                self.vertices(count, vertices, "a ring")
            })
            .collect::<Result<_, _>>()?;
        let options = self.options(pose_count, vertices)?;
        let tie = match self.choice(2, "tie")? {
            0 => None,
            _ => {
                let to = self.word("a tie")? as usize;
                if to >= layer_count {
                    return self.damaged("a layer hangs on one that does not exist");
                }
                let own = self.point(pose_count, vertices)?;
                let other = self.point(pose_count, usize::MAX)?;
                Some(RuntimeTie { to, own, other })
            }
        };
        let positions = self.positions(pose_count, vertices, is_quantised)?;
        if !positions.is_empty() && vertices > triangles.len().saturating_mul(3) {
            return self.damaged("a vertex belongs to no triangle");
        }
        for (index, &triangle) in triangles.iter().enumerate() {
            for embedding in &positions {
                let [a, b, c] = geometry::corners(embedding, triangle);
                if !predicate::is_positive(a, b, c) {
                    return self.damaged(&format!(
                        "triangle {index} of layer '{name}' is turned over or has no area in some pose"
                    ));
                }
            }
        }
        let textures = self.textures(vertices, is_quantised)?;
        let regions = if self.has_regions {
            self.regions(pose_count, vertices, is_quantised)?
        } else {
            None
        };
        let drawn = regions
            .iter()
            .flat_map(|all| &all.regions)
            .map(|region| &region.textures);
        let mut shown = drawn.chain(regions.is_none().then_some(&textures));
        if shown.any(|textures| texture_of.iter().any(|&texture| texture >= textures.len())) {
            return self.damaged("a pose shows a texture that does not exist");
        }
        let names = own.iter().map(|&pose| poses[pose].name.clone());
        let mesh = Topology::new(vertices, triangles)
            .map_err(|error| error.to_string())
            .and_then(|topology| {
                PoseSet::new(topology, names.zip(positions).collect()).map_err(|error| error.to_string())
            });
        let mesh = match mesh {
            Ok(mesh) => mesh,
            Err(what) => return self.damaged(&what),
        };
        Ok(RuntimeLayer {
            name,
            poses: own,
            texture_of,
            mesh,
            rings,
            options,
            tie,
            textures,
            regions,
        })
    }

    fn textures(&mut self, vertices: usize, is_quantised: bool) -> Result<Vec<RuntimeTexture>, RuntimeError> {
        let count = self.word("the textures")? as usize;
        self.room(count, 6, "the textures")?;
        (0..count).map(|_| self.texture(vertices, is_quantised)).collect()
    }

    /// The regions of a layer of so many poses and vertices.
    fn regions(
        &mut self,
        pose_count: usize,
        vertices: usize,
        is_quantised: bool,
    ) -> Result<Option<RuntimeRegions>, RuntimeError> {
        let count = self.word("the regions of a layer")? as usize;
        if count == 0 {
            return Ok(None);
        }
        // A region takes some 14 bytes at least.
        self.room(count, 14, "the regions of a layer")?;
        let regions = (0..count).map(|_| {
            let name = self.string()?;
            let own_count = self.word("a region of a layer")? as usize;
            let own = self.vertices(own_count, vertices, "a region of a layer")?;
            if own.windows(2).any(|pair| pair[0] >= pair[1]) {
                return self.damaged("the vertices of a region do not increase");
            }
            let triangle_count = self.word("a region of a layer")? as usize;
            let corners = self.vertices(triangle_count.saturating_mul(3), vertices, "a region of a layer")?;
            if corners.iter().any(|&corner| corner >= own_count) {
                return self.damaged("a triangle of a region has a vertex that the region lacks");
            }
            Ok(RuntimeRegion {
                name,
                triangles: corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
                vertices: own,
                textures: self.textures(own_count, is_quantised)?,
            })
        });
        let regions = regions.collect::<Result<_, _>>()?;
        let size = count.saturating_mul(count);
        self.room(pose_count, size, "the order of regions")?;
        let signs = self.take(pose_count * size, "the order of regions")?;
        if signs.iter().any(|sign| ![0, 1, u8::MAX].contains(sign)) {
            return self.damaged("an order of regions has another number than -1, 0 and 1");
        }
        let of_poses = signs
            .chunks_exact(size)
            .map(|signs| signs.iter().map(|sign| *sign as i8).collect());
        match DepthOrder::new(count, of_poses.collect()) {
            Some(order) => Ok(Some(RuntimeRegions { regions, order })),
            None => self.damaged("an order of regions is incomplete"),
        }
    }

    fn options(&mut self, pose_count: usize, vertices: usize) -> Result<BlendOptions, RuntimeError> {
        let reference = match self.word("a reference")? {
            CANONICAL => Reference::Canonical,
            pose if (pose as usize) < pose_count => Reference::Pose(pose as usize),
            _ => return self.damaged("the reference is a pose that does not exist"),
        };
        let stretch = match self.choice(3, "stretch")? {
            0 => Stretch::Linear,
            1 => Stretch::Limited,
            _ => Stretch::Log,
        };
        let guard = match self.choice(2, "guard")? {
            0 => FrameGuard::Off,
            _ => FrameGuard::Repair,
        };
        let anchor = match self.choice(3, "anchor")? {
            0 => Anchor::Centroid,
            1 => Anchor::Point(self.vertex(vertices, "an anchor")?),
            _ => {
                let count = self.word("the anchors")? as usize;
                self.room(count, 10, "the anchors")?;
                let anchors = (0..count).map(|_| {
                    Ok(SoftAnchor {
                        point: self.vertex(vertices, "an anchor")?,
                        stiffness: self.finite("an anchor")?,
                    })
                });
                Anchor::Soft(anchors.collect::<Result<_, _>>()?)
            }
        };
        let turn_count = self.word("the turns")? as usize;
        if turn_count != 0 && turn_count != pose_count {
            return self.damaged("there is not one number of turns a pose");
        }
        self.room(turn_count, 4, "the turns")?;
        let turns = (0..turn_count)
            .map(|_| Ok(i32::from_le_bytes(self.array("the turns")?)))
            .collect::<Result<_, _>>()?;
        let region_count = self.word("the regions")? as usize;
        self.room(region_count, 26, "the regions")?;
        let regions = (0..region_count).map(|_| {
            let region = Region {
                point: self.vertex(vertices, "a region")?,
                radius: self.finite("a region")?,
                stiffness: self.finite("a region")?,
                stretch_limit: self.double("a region")?,
            };
            if region.stretch_limit.is_nan() {
                return self.damaged("a limit of stretch is no number");
            }
            Ok(region)
        });
        Ok(BlendOptions {
            reference,
            stretch,
            regions: regions.collect::<Result<_, _>>()?,
            anchor,
            turns,
            guard,
        })
    }

    fn field(&mut self, pose_count: usize, dimension: usize) -> Result<WeightField, RuntimeError> {
        let mut corner = || Ok([self.finite("the grid of weights")?, self.finite("the grid of weights")?]);
        let (low, high): ([f64; 2], [f64; 2]) = (corner()?, corner()?);
        let columns = self.word("the grid of weights")? as usize;
        let rows = self.word("the grid of weights")? as usize;
        if dimension != 2 || columns < 2 || rows < 2 || low[0] >= high[0] || low[1] >= high[1] {
            return self.damaged("the grid of weights has no extent, or the poses lie in no plane");
        }
        let count = columns.saturating_mul(rows).saturating_mul(pose_count);
        Ok(WeightField {
            low,
            high,
            columns,
            rows,
            weights: self.weights(count, pose_count, "the grid of weights")?,
        })
    }

    fn animation(&mut self, pose_count: usize) -> Result<RuntimeAnimation, RuntimeError> {
        let fps = self.finite("the animation")?;
        let is_loop = self.choice(2, "loop")? == 1;
        let frames = self.word("the animation")? as usize;
        if fps <= 0.0 {
            return self.damaged("the animation has no frames a second");
        }
        let weights = self.weights(frames.saturating_mul(pose_count), pose_count, "the animation")?;
        Ok(RuntimeAnimation {
            fps,
            is_loop,
            weights: weights.chunks_exact(pose_count).map(<[f32]>::to_vec).collect(),
        })
    }

    /// Rows of weights, each of which sums to 1.
    fn weights(&mut self, count: usize, pose_count: usize, what: &'static str) -> Result<Vec<f32>, RuntimeError> {
        let weights = self.singles(count, what)?;
        let sums_to_1 = |row: &[f32]| (row.iter().map(|w| f64::from(*w)).sum::<f64>() - 1.0).abs() <= SUM_TOLERANCE;
        if weights.chunks_exact(pose_count).all(sums_to_1) {
            Ok(weights)
        } else {
            self.damaged("weights do not sum to 1")
        }
    }

    fn positions(
        &mut self,
        pose_count: usize,
        vertices: usize,
        is_quantised: bool,
    ) -> Result<Vec<Vec<Point>>, RuntimeError> {
        let count = pose_count.saturating_mul(vertices).saturating_mul(2);
        let numbers: Vec<f64> = if is_quantised {
            let low = Point::new(self.finite("the positions")?, self.finite("the positions")?);
            let step = self.finite("the positions")?;
            self.room(count, 2, "the positions")?;
            let steps = self.take(count * 2, "the positions")?.chunks_exact(2);
            let number = |(k, b): (usize, &[u8])| low[k % 2] + f64::from(u16::from_le_bytes([b[0], b[1]])) * step;
            steps.enumerate().map(number).collect()
        } else {
            self.singles(count, "the positions")?
                .into_iter()
                .map(f64::from)
                .collect()
        };
        if !numbers.iter().all(|number| number.abs() <= LARGEST_COORDINATE) {
            return self.damaged("a position is out of reach");
        }
        let embedding = |numbers: &[f64]| numbers.chunks_exact(2).map(|p| Point::new(p[0], p[1])).collect();
        Ok(numbers.chunks_exact((vertices * 2).max(1)).map(embedding).collect())
    }

    fn texture(&mut self, vertices: usize, is_quantised: bool) -> Result<RuntimeTexture, RuntimeError> {
        let name = self.string()?;
        let length = self.word("a picture")? as usize;
        let png = self.take(length, "a picture")?.to_vec();
        if !png.starts_with(&PNG) {
            return self.damaged("a picture is no PNG file");
        }
        let count = vertices.saturating_mul(2);
        let parts: Vec<f64> = if is_quantised {
            self.room(count, 2, "places on a picture")?;
            let steps = self.take(count * 2, "places on a picture")?.chunks_exact(2);
            let part = |b: &[u8]| f64::from(u16::from_le_bytes([b[0], b[1]])) / f64::from(u16::MAX);
            steps.map(part).collect()
        } else {
            let parts = self.singles(count, "places on a picture")?;
            parts.into_iter().map(f64::from).collect()
        };
        Ok(RuntimeTexture {
            name,
            png,
            places: parts.chunks_exact(2).map(|p| Point::new(p[0], p[1])).collect(),
        })
    }

    fn point(&mut self, pose_count: usize, vertices: usize) -> Result<RuntimePoint, RuntimeError> {
        self.room(pose_count, 36, "a tie")?;
        (0..pose_count)
            .map(|_| {
                let (mut corners, mut shares) = ([0; 3], [0.0; 3]);
                for (corner, share) in corners.iter_mut().zip(&mut shares) {
                    *corner = self.word("a tie")? as usize;
                    *share = self.finite("a tie")?;
                    if *corner >= vertices {
                        return self.damaged("a tie holds a vertex that does not exist");
                    }
                }
                Ok(MeshPoint {
                    vertices: corners,
                    shares,
                })
            })
            .collect()
    }

    fn string(&mut self) -> Result<String, RuntimeError> {
        let length = u16::from_le_bytes(self.array("a name")?);
        let bytes = self.take(usize::from(length), "a name")?;
        match std::str::from_utf8(bytes) {
            Ok(text) => Ok(text.to_owned()),
            Err(_) => self.damaged("a name is not UTF-8"),
        }
    }

    /// Indices of 32 bits.
    fn indices(&mut self, count: usize, below: usize, what: &'static str) -> Result<Vec<usize>, RuntimeError> {
        self.room(count, 4, what)?;
        let read = |b: &[u8]| u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as usize;
        let indices: Vec<usize> = self.take(count * 4, what)?.chunks_exact(4).map(read).collect();
        if indices.iter().any(|index| *index >= below) {
            return self.damaged(&format!("{what} name something that does not exist"));
        }
        Ok(indices)
    }

    fn vertices(&mut self, count: usize, vertices: usize, what: &'static str) -> Result<Vec<usize>, RuntimeError> {
        self.room(count, if is_short(vertices) { 2 } else { 4 }, what)?;
        (0..count).map(|_| self.vertex(vertices, what)).collect()
    }

    fn vertex(&mut self, vertices: usize, what: &'static str) -> Result<usize, RuntimeError> {
        let vertex = if is_short(vertices) {
            usize::from(u16::from_le_bytes(self.array(what)?))
        } else {
            self.word(what)? as usize
        };
        if vertex < vertices {
            Ok(vertex)
        } else {
            self.damaged(&format!("{what} names vertex {vertex} of {vertices}"))
        }
    }

    fn singles(&mut self, count: usize, what: &'static str) -> Result<Vec<f32>, RuntimeError> {
        self.room(count, 4, what)?;
        let read = |b: &[u8]| f32::from_le_bytes([b[0], b[1], b[2], b[3]]);
        let numbers: Vec<f32> = self.take(count * 4, what)?.chunks_exact(4).map(read).collect();
        if numbers.iter().all(|number| number.is_finite()) {
            Ok(numbers)
        } else {
            self.damaged(&format!("a number in {what} is not finite"))
        }
    }

    fn finite(&mut self, what: &'static str) -> Result<f64, RuntimeError> {
        let number = self.double(what)?;
        if number.is_finite() {
            Ok(number)
        } else {
            self.damaged(&format!("a number in {what} is not finite"))
        }
    }

    fn double(&mut self, what: &'static str) -> Result<f64, RuntimeError> {
        Ok(f64::from_le_bytes(self.array(what)?))
    }

    fn word(&mut self, what: &'static str) -> Result<u32, RuntimeError> {
        Ok(u32::from_le_bytes(self.array(what)?))
    }

    /// A byte below `count`.
    fn choice(&mut self, count: u8, what: &'static str) -> Result<u8, RuntimeError> {
        let [byte] = self.array(what)?;
        if byte < count {
            Ok(byte)
        } else {
            self.damaged(&format!("{what}: {byte} means nothing"))
        }
    }

    fn array<const N: usize>(&mut self, what: &'static str) -> Result<[u8; N], RuntimeError> {
        let bytes = self.take(N, what)?;
        let mut array = [0; N];
        array.copy_from_slice(bytes);
        Ok(array)
    }

    fn take(&mut self, count: usize, what: &'static str) -> Result<&'a [u8], RuntimeError> {
        self.room(count, 1, what)?;
        let taken = &self.bytes[self.at..self.at + count];
        self.at += count;
        Ok(taken)
    }

    /// Refuses a count of things of `size` bytes that cannot follow.
    fn room(&self, count: usize, size: usize, what: &'static str) -> Result<(), RuntimeError> {
        let length = self.bytes.len();
        match count.checked_mul(size) {
            Some(needed) if needed <= length - self.at => Ok(()),
            _ => Err(RuntimeError::Short { length, what }),
        }
    }

    fn damaged<T>(&self, what: &str) -> Result<T, RuntimeError> {
        Err(RuntimeError::Damaged {
            at: self.at,
            what: what.to_owned(),
        })
    }
}
