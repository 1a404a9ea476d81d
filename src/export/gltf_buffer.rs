//! The binary part of a glTF file, and the container around both parts.
//!
//! Numbers in, accessors out: each list of numbers is a view of its own in one buffer, at an address that is a multiple of four.
//! What refers to them (meshes, skins, animations) belongs to those who write them.

#[cfg(feature = "shape3d")]
mod joints;

use serde_json::{Value, json};

use super::MotionError;

const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;
/// Filters of textures.
pub(super) const NEAREST: u32 = 9728;
pub(super) const LINEAR: u32 = 9729;
pub(super) const LINEAR_MIPMAP_LINEAR: u32 = 9987;

/// The buffer so far, with its views and accessors.
#[derive(Default)]
pub(super) struct GltfBuffer {
    pub(super) bytes: Vec<u8>,
    pub(super) views: Vec<Value>,
    pub(super) accessors: Vec<Value>,
}

impl GltfBuffer {
    /// Bytes as they are; the index of their view.
    pub(super) fn add_view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let mut view = json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.bytes.extend_from_slice(bytes);
        push(&mut self.views, view)
    }

    /// Places of vertices, or their moves, with their box.
    pub(super) fn add_positions(&mut self, positions: &[[f32; 3]]) -> usize {
        let accessor = self.add_floats(positions, Some(ARRAY_BUFFER));
        self.bound(accessor, positions);
        accessor
    }

    /// Anything else that vertices have.
    pub(super) fn add_attribute<const WIDTH: usize>(&mut self, values: &[[f32; WIDTH]]) -> usize {
        self.add_floats(values, Some(ARRAY_BUFFER))
    }

    /// Corners of triangles, in as few bytes as they take.
    pub(super) fn add_indices(&mut self, indices: &[usize]) -> usize {
        let largest = indices.iter().copied().max().unwrap_or(0);
        // The largest value of a type is not an index but a restart.
        let (kind, bytes): (u32, Vec<u8>) = if largest < usize::from(u16::MAX) {
            (
                UNSIGNED_SHORT,
                indices.iter().flat_map(|&i| (i as u16).to_le_bytes()).collect(),
            )
        } else {
            (
                UNSIGNED_INT,
                indices.iter().flat_map(|&i| (i as u32).to_le_bytes()).collect(),
            )
        };
        let view = self.add_view(&bytes, Some(ELEMENT_ARRAY_BUFFER));
        let accessor = json!({ "bufferView": view, "componentType": kind, "count": indices.len(), "type": "SCALAR" });
        push(&mut self.accessors, accessor)
    }

    /// Times of keys, with their range.
    pub(super) fn add_times(&mut self, times: &[f32]) -> usize {
        let times: Vec<[f32; 1]> = times.iter().map(|&time| [time]).collect();
        let accessor = self.add_floats(&times, None);
        self.bound(accessor, &times);
        accessor
    }

    /// Numbers of an animation.
    pub(super) fn add_scalars(&mut self, values: &[f32]) -> usize {
        self.add_floats(values.as_chunks::<1>().0, None)
    }

    /// Vectors of an animation, or matrices.
    pub(super) fn add_values<const WIDTH: usize>(&mut self, values: &[[f32; WIDTH]]) -> usize {
        self.add_floats(values, None)
    }

    fn add_floats<const WIDTH: usize>(&mut self, values: &[[f32; WIDTH]], target: Option<u32>) -> usize {
        let bytes: Vec<u8> = values.as_flattened().iter().flat_map(|v| v.to_le_bytes()).collect();
        let view = self.add_view(&bytes, target);
        let shape = match WIDTH {
            16 => "MAT4",
            4 => "VEC4",
            3 => "VEC3",
            2 => "VEC2",
            _ => "SCALAR",
        };
        let accessor = json!({ "bufferView": view, "componentType": FLOAT, "count": values.len(), "type": shape });
        push(&mut self.accessors, accessor)
    }

    /// States the least and greatest of each component.
    fn bound<const WIDTH: usize>(&mut self, accessor: usize, values: &[[f32; WIDTH]]) {
        let extreme = |component: usize, pick: fn(f32, f32) -> f32| {
            values.iter().map(|value| value[component]).reduce(pick).unwrap_or(0.0)
        };
        let low: Vec<f32> = (0..WIDTH).map(|c| extreme(c, f32::min)).collect();
        let high: Vec<f32> = (0..WIDTH).map(|c| extreme(c, f32::max)).collect();
        self.accessors[accessor]["min"] = json!(low);
        self.accessors[accessor]["max"] = json!(high);
    }
}

/// Adds to a list; the index there.
pub(super) fn push(list: &mut Vec<Value>, value: Value) -> usize {
    list.push(value);
    list.len() - 1
}

/// Lists of a document may be missing, but not empty.
pub(super) fn without_empty_lists(document: &mut Value) {
    if let Some(members) = document.as_object_mut() {
        members.retain(|_, member| member.as_array().is_none_or(|list| !list.is_empty()));
    }
}

/// Header, JSON chunk, binary chunk.
pub(super) fn container(document: &Value, mut binary: Vec<u8>) -> Result<Vec<u8>, MotionError> {
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let total = 12 + 8 + text.len() + 8 + binary.len();
    let total = u32::try_from(total).map_err(|_| MotionError::TooLarge { bytes: total })?;
    let mut bytes = Vec::with_capacity(total as usize);
    bytes.extend(b"glTF");
    bytes.extend(2u32.to_le_bytes());
    bytes.extend(total.to_le_bytes());
    for (kind, chunk) in [(b"JSON", &text), (b"BIN\0", &binary)] {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    Ok(bytes)
}

#[cfg(test)]
pub(in crate::export) mod testing {
    use serde_json::Value;

    /// A `.glb` file, read again.
    pub(in crate::export) struct GltfRead {
        pub(in crate::export) json: Value,
        pub(in crate::export) binary: Vec<u8>,
    }

    impl GltfRead {
        pub(in crate::export) fn new(bytes: &[u8]) -> Self {
            let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes")) as usize;
            assert_eq!((&bytes[..4], word(4), word(8)), (b"glTF".as_slice(), 2, bytes.len()));
            let text = 20..20 + word(12);
            assert_eq!(word(text.end) + text.end + 8, bytes.len());
            Self {
                json: serde_json::from_slice(&bytes[text.clone()]).expect("JSON"),
                binary: bytes[text.end + 8..].to_vec(),
            }
        }

        pub(in crate::export) fn bytes(&self, accessor: &Value) -> &[u8] {
            let accessor = &self.json["accessors"][accessor.as_u64().expect("an index") as usize];
            let view = &self.json["bufferViews"][accessor["bufferView"].as_u64().expect("an index") as usize];
            let start = view["byteOffset"].as_u64().expect("a place") as usize;
            &self.binary[start..start + view["byteLength"].as_u64().expect("a length") as usize]
        }

        pub(in crate::export) fn floats(&self, accessor: &Value) -> Vec<f32> {
            let chunks = self.bytes(accessor).as_chunks::<4>().0.iter();
            chunks.map(|b| f32::from_le_bytes(*b)).collect()
        }
    }
}
