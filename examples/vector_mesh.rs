//! A frame of curves as triangles for an engine: the face between two of its drawings, as a glTF file of coloured triangles.
//!
//! `cargo run --release --features lyon --example vector_mesh -- face.glb` also says how many parts keep their indices
//! from one frame of the animation to the next.

use std::error::Error;
use std::path::Path;

use inbetween::export::VectorTessellator;
use inbetween::scene::Scene;
use serde_json::json;

/// A vertex as this program's shaders would have it: place in pixels, colour in linear light, alpha.
struct Vertex([f32; 3], [f32; 4]);

fn main() -> Result<(), Box<dyn Error>> {
    let target = std::env::args().nth(1).ok_or("usage: vector_mesh FILE.glb")?;
    let scene = Scene::open(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/data/face/scene.toml")))?;
    let character = scene.character([512, 512], 1)?;
    let mut tessellator = VectorTessellator::new(0.1)?;
    let linear = |c: f32| {
        if c <= 0.040_45 {
            c / 12.92
        } else {
            ((c + 0.055) / 1.055).powf(2.4)
        }
    };
    let (mut kept, mut parts, frames) = (0, 0, scene.animation.frame_count());
    let mut mesh = None;
    for index in 0..frames {
        let curves = character.draw(&character.posed(&scene.animation, index)?);
        let made = tessellator.tessellate(&curves, |vertex| {
            let ([x, y], [red, green, blue, alpha]) = (vertex.position, vertex.colour);
            // Later parts lie in front of earlier ones; glTF's y points up.
            Vertex(
                [x, -y, vertex.part as f32 * 0.01],
                [linear(red), linear(green), linear(blue), alpha],
            )
        })?;
        kept += made.parts.iter().filter(|part| part.indices_are_kept).count();
        parts += made.parts.len();
        mesh.get_or_insert(made);
    }
    let mesh = mesh.ok_or("the animation has no frame")?;
    let mut stdout = std::io::stdout();
    let (vertices, triangles) = (mesh.vertices.len(), mesh.indices.len() / 3);
    std::io::Write::write_fmt(
        &mut stdout,
        format_args!(
            "{vertices} vertices, {triangles} triangles; over {frames} frames {kept} of {parts} parts keep their indices\n"
        ),
    )?;
    Ok(std::fs::write(target, glb(&mesh.vertices, &mesh.indices))?)
}

/// A binary glTF file of one mesh.
fn glb(vertices: &[Vertex], indices: &[u32]) -> Vec<u8> {
    let positions: Vec<u8> = vertices.iter().flat_map(|v| v.0).flat_map(f32::to_le_bytes).collect();
    let colours: Vec<u8> = vertices.iter().flat_map(|v| v.1).flat_map(f32::to_le_bytes).collect();
    let order: Vec<u8> = indices.iter().flat_map(|index| index.to_le_bytes()).collect();
    let corner = |pick: fn(f32, f32) -> f32| {
        let fold = |d: usize| vertices.iter().map(|v| v.0[d]).reduce(pick).unwrap_or(0.0);
        [fold(0), fold(1), fold(2)]
    };
    let (first, second) = (positions.len(), positions.len() + colours.len());
    let count = vertices.len();
    let document = json!({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "buffers": [{"byteLength": second + order.len()}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": first, "target": 34962},
            {"buffer": 0, "byteOffset": first, "byteLength": colours.len(), "target": 34962},
            {"buffer": 0, "byteOffset": second, "byteLength": order.len(), "target": 34963},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3", "min": corner(f32::min), "max": corner(f32::max)},
            {"bufferView": 1, "componentType": 5126, "count": count, "type": "VEC4"},
            {"bufferView": 2, "componentType": 5125, "count": indices.len(), "type": "SCALAR"},
        ],
        "materials": [{"doubleSided": true, "alphaMode": "BLEND", "extensions": {"KHR_materials_unlit": {}}}],
        "extensionsUsed": ["KHR_materials_unlit"],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "COLOR_0": 1}, "indices": 2, "material": 0}]}],
    });
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let data = [positions, colours, order].concat();
    let words = |numbers: &[usize]| -> Vec<u8> { numbers.iter().flat_map(|n| (*n as u32).to_le_bytes()).collect() };
    let head = [
        b"glTF".to_vec(),
        words(&[2, 28 + text.len() + data.len(), text.len()]),
        b"JSON".to_vec(),
    ]
    .concat();
    [head, text, words(&[data.len()]), b"BIN\0".to_vec(), data].concat()
}
