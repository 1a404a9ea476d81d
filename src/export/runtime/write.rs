//! A character -> bytes.

use super::{
    CANONICAL, MAGIC, Precision, RuntimeError, RuntimeFile, RuntimeLayer, RuntimePoint, RuntimeTexture, VERSION,
    VERSION_WITH_REGIONS, read_runtime,
};
use crate::blend::{Anchor, FrameGuard, Reference, Stretch};
use crate::math::{Point, point};
use crate::mesh::MeshPoint;

/// The bytes of a file, and what reading them gives: positions are rounded.
///
/// # Errors
/// [`RuntimeError`] if the character is not sound, or if rounding its positions turns a triangle over: then take
/// [`Precision::Single`].
pub fn runtime_bytes(file: &RuntimeFile, precision: Precision) -> Result<(Vec<u8>, RuntimeFile), RuntimeError> {
    let has_regions = file.layers.iter().any(|layer| layer.regions.is_some());
    let mut writer = Writer {
        bytes: Vec::new(),
        precision,
        version: if has_regions { VERSION_WITH_REGIONS } else { VERSION },
    };
    writer.file(file)?;
    let read = read_runtime(&writer.bytes)?;
    Ok((writer.bytes, read))
}

struct Writer {
    bytes: Vec<u8>,
    precision: Precision,
    version: u16,
}

impl Writer {
    fn file(&mut self, file: &RuntimeFile) -> Result<(), RuntimeError> {
        self.bytes.extend(MAGIC);
        self.bytes.extend(self.version.to_le_bytes());
        self.bytes.extend([u8::from(self.precision == Precision::Quantised), 0]);
        self.bytes.extend(file.size.iter().flat_map(|side| side.to_le_bytes()));
        self.double(file.texture_sharpness);
        let dimension = file.poses.first().map_or(0, |pose| pose.at.len());
        for count in [file.poses.len(), dimension, file.layers.len()] {
            self.count(count)?;
        }
        for pose in &file.poses {
            if pose.at.len() != dimension || pose.order.len() != file.layers.len() {
                return Err(unsuitable("the poses do not have one dimension, or lack layers"));
            }
            self.string(&pose.name)?;
            pose.at.iter().for_each(|x| self.double(*x));
            self.counts(&pose.order)?;
        }
        self.bytes.push(u8::from(file.field.is_some()));
        if let Some(field) = &file.field {
            field.low.iter().chain(&field.high).for_each(|x| self.double(*x));
            self.counts(&[field.columns, field.rows])?;
            self.singles(&field.weights);
        }
        self.double(file.animation.fps);
        self.bytes.push(u8::from(file.animation.is_loop));
        self.count(file.animation.weights.len())?;
        file.animation.weights.iter().for_each(|weights| self.singles(weights));
        file.layers.iter().try_for_each(|layer| self.layer(layer))
    }

    fn layer(&mut self, layer: &RuntimeLayer) -> Result<(), RuntimeError> {
        let topology = layer.mesh.topology();
        let vertices = topology.vertex_count();
        self.string(&layer.name)?;
        self.count(layer.poses.len())?;
        self.counts(&layer.poses)?;
        self.counts(&layer.texture_of)?;
        self.counts(&[vertices, topology.triangles().len()])?;
        for vertex in topology.triangles().as_flattened() {
            self.index(*vertex, vertices)?;
        }
        self.count(layer.rings.len())?;
        for ring in &layer.rings {
            self.count(ring.len())?;
            ring.iter().try_for_each(|vertex| self.index(*vertex, vertices))?;
        }
        self.options(layer, vertices)?;
        self.bytes.push(u8::from(layer.tie.is_some()));
        if let Some(tie) = &layer.tie {
            self.count(tie.to)?;
            self.point(&tie.own)?;
            self.point(&tie.other)?;
        }
        self.positions(layer);
        self.textures(&layer.textures)?;
        if self.version < VERSION_WITH_REGIONS {
            return Ok(());
        }
        let Some(regions) = &layer.regions else {
            return self.count(0);
        };
        self.count(regions.regions.len())?;
        for region in &regions.regions {
            self.string(&region.name)?;
            self.count(region.vertices.len())?;
            (region.vertices.iter()).try_for_each(|vertex| self.index(*vertex, vertices))?;
            self.count(region.triangles.len())?;
            for vertex in region.triangles.as_flattened() {
                // As wide as the layer's own, though there are fewer.
                self.index(*vertex, vertices)?;
            }
            self.textures(&region.textures)?;
        }
        for sign in regions.order.in_front().iter().flatten() {
            self.bytes.extend(sign.to_le_bytes());
        }
        Ok(())
    }

    fn textures(&mut self, textures: &[RuntimeTexture]) -> Result<(), RuntimeError> {
        self.count(textures.len())?;
        for texture in textures {
            self.string(&texture.name)?;
            self.count(texture.png.len())?;
            self.bytes.extend(&texture.png);
            for part in texture.places.iter().flat_map(|p| [p.x, p.y]) {
                match self.precision {
                    Precision::Single => self.bytes.extend((part as f32).to_le_bytes()),
                    Precision::Quantised => {
                        let steps = (part.clamp(0.0, 1.0) * f64::from(u16::MAX)).round() as u16;
                        self.bytes.extend(steps.to_le_bytes());
                    }
                }
            }
        }
        Ok(())
    }

    fn options(&mut self, layer: &RuntimeLayer, vertices: usize) -> Result<(), RuntimeError> {
        let options = &layer.options;
        match options.reference {
            Reference::Canonical => self.bytes.extend(CANONICAL.to_le_bytes()),
            Reference::Pose(pose) => self.count(pose)?,
        }
        self.bytes.push(match options.stretch {
            Stretch::Linear => 0,
            Stretch::Limited => 1,
            Stretch::Log => 2,
        });
        self.bytes.push(match options.guard {
            FrameGuard::Off => 0,
            FrameGuard::Repair => 1,
        });
        match &options.anchor {
            Anchor::Centroid => self.bytes.push(0),
            Anchor::Point(vertex) => {
                self.bytes.push(1);
                self.index(*vertex, vertices)?;
            }
            Anchor::Soft(anchors) => {
                self.bytes.push(2);
                self.count(anchors.len())?;
                for anchor in anchors {
                    self.index(anchor.point, vertices)?;
                    self.double(anchor.stiffness);
                }
            }
        }
        self.count(options.turns.len())?;
        self.bytes
            .extend(options.turns.iter().flat_map(|turns| turns.to_le_bytes()));
        self.count(options.regions.len())?;
        for region in &options.regions {
            self.index(region.point, vertices)?;
            for number in [region.radius, region.stiffness, region.stretch_limit] {
                self.double(number);
            }
        }
        Ok(())
    }

    fn positions(&mut self, layer: &RuntimeLayer) {
        let all = || layer.mesh.positions().iter().flatten();
        match self.precision {
            Precision::Single => {
                for p in all() {
                    self.bytes.extend((p.x as f32).to_le_bytes());
                    self.bytes.extend((p.y as f32).to_le_bytes());
                }
            }
            Precision::Quantised => {
                let (low, high) = point::bounding_box(all()).unwrap_or_default();
                let (low, step) = steps(low, high);
                for number in [low.x, low.y, step] {
                    self.double(number);
                }
                for p in all() {
                    let counted = (p - low) / step;
                    self.bytes.extend((counted.x.round() as u16).to_le_bytes());
                    self.bytes.extend((counted.y.round() as u16).to_le_bytes());
                }
            }
        }
    }

    fn point(&mut self, point: &RuntimePoint) -> Result<(), RuntimeError> {
        for MeshPoint { vertices, shares } in point {
            for (vertex, share) in vertices.iter().zip(shares) {
                self.count(*vertex)?;
                self.double(*share);
            }
        }
        Ok(())
    }

    fn string(&mut self, text: &str) -> Result<(), RuntimeError> {
        let length = u16::try_from(text.len()).map_err(|_| unsuitable("a name is longer than 65,535 bytes"))?;
        self.bytes.extend(length.to_le_bytes());
        self.bytes.extend(text.as_bytes());
        Ok(())
    }

    fn counts(&mut self, counts: &[usize]) -> Result<(), RuntimeError> {
        counts.iter().try_for_each(|count| self.count(*count))
    }

    fn count(&mut self, count: usize) -> Result<(), RuntimeError> {
        let count = u32::try_from(count).map_err(|_| unsuitable("a count is beyond 32 bits"))?;
        self.bytes.extend(count.to_le_bytes());
        Ok(())
    }

    fn index(&mut self, vertex: usize, vertices: usize) -> Result<(), RuntimeError> {
        if vertex >= vertices {
            return Err(unsuitable("a vertex is meant that does not exist"));
        }
        if super::read::is_short(vertices) {
            self.bytes.extend((vertex as u16).to_le_bytes());
            return Ok(());
        }
        self.count(vertex)
    }

    fn double(&mut self, number: f64) {
        self.bytes.extend(number.to_le_bytes());
    }

    fn singles(&mut self, numbers: &[f32]) {
        self.bytes
            .extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
    }
}

/// Where steps are counted from, and how large they are: a power of two, so that rounding twice is rounding once.
fn steps(low: Point, high: Point) -> (Point, f64) {
    let extent = (high - low).max();
    let mut step = 1.0;
    // One step is kept free for the lowest place, which is rounded downwards.
    const STEPS: f64 = 65_534.0;
    while extent > STEPS * step && step < 1e30 {
        step *= 2.0;
    }
    while extent <= STEPS * step / 2.0 && step > 1e-9 {
        step /= 2.0;
    }
    (low.map(|c| (c / step).floor() * step), step)
}

fn unsuitable(what: &str) -> RuntimeError {
    RuntimeError::Unsuitable(what.to_owned())
}
