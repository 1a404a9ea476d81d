//! The joints that vertices follow.

use serde_json::json;

use super::{ARRAY_BUFFER, GltfBuffer, UNSIGNED_SHORT, push};

const UNSIGNED_BYTE: u32 = 5121;

impl GltfBuffer {
    /// Four joints a vertex.
    pub(in crate::export) fn add_joints(&mut self, joints: &[[u16; 4]]) -> usize {
        let small = joints.as_flattened().iter().all(|&joint| joint <= u16::from(u8::MAX));
        let (kind, bytes): (u32, Vec<u8>) = if small {
            (
                UNSIGNED_BYTE,
                joints.as_flattened().iter().map(|&joint| joint as u8).collect(),
            )
        } else {
            let bytes = joints.as_flattened().iter().flat_map(|joint| joint.to_le_bytes());
            (UNSIGNED_SHORT, bytes.collect())
        };
        let view = self.add_view(&bytes, Some(ARRAY_BUFFER));
        let accessor = json!({ "bufferView": view, "componentType": kind, "count": joints.len(), "type": "VEC4" });
        push(&mut self.accessors, accessor)
    }
}
