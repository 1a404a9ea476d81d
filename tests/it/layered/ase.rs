//! A writer of Aseprite files.

use std::io::Write as _;

use super::art::{Content, Node, Patch};

/// How a file is written.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Options {
    /// 32 for colours, 16 for greys, 8 for indices into a palette of greys of which 0 is clear.
    pub(crate) bits: u16,
    pub(crate) is_deflated: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            bits: 32,
            is_deflated: true,
        }
    }
}

/// An Aseprite file with one frame.
pub(crate) fn write(size: [u32; 2], nodes: &[Node], options: Options) -> Vec<u8> {
    let mut layers = Vec::new();
    let mut cels = Vec::new();
    let mut count = 0;
    write_layers(nodes, 0, options, &mut layers, &mut cels, &mut count);
    layers.append(&mut cels);
    if options.bits == 8 {
        layers.push(palette());
    }
    file(size, &[layers], options)
}

/// An animated file: the layers of the first frame, and for each frame the patch of every layer, or the frame that it is linked to.
pub(crate) fn write_frames(
    size: [u32; 2],
    layers: &[&str],
    frames: &[Vec<Drawn>],
    tags: &[(&str, u16, u16)],
) -> Vec<u8> {
    let options = Options::default();
    let mut all: Vec<Vec<Vec<u8>>> = Vec::new();
    for (number, drawn) in frames.iter().enumerate() {
        let mut chunks = Vec::new();
        if number == 0 {
            for layer in layers {
                let node = Node::group(layer, Vec::new());
                chunks.push(layer_chunk(&node, 0, 0));
            }
            let mut body = (tags.len() as u16).to_le_bytes().to_vec();
            body.extend([0; 8]);
            for (name, first, last) in tags {
                body.extend(first.to_le_bytes());
                body.extend(last.to_le_bytes());
                body.extend([0; 13]);
                put_text(&mut body, name);
            }
            chunks.push(chunk(0x2018, body));
        }
        for (layer, drawn) in drawn.iter().enumerate() {
            match drawn {
                Drawn::Nothing => {}
                Drawn::Patch(patch) => chunks.push(cel(layer as u16, patch, options)),
                Drawn::Linked(frame) => {
                    let mut body = (layer as u16).to_le_bytes().to_vec();
                    body.extend([0, 0, 0, 0, 255, 1, 0, 0, 0, 0, 0, 0, 0, 0]);
                    body.extend(frame.to_le_bytes());
                    chunks.push(chunk(0x2005, body));
                }
            }
        }
        all.push(chunks);
    }
    file(size, &all, options)
}

/// What a layer has in a frame.
#[derive(Debug, Clone)]
pub(crate) enum Drawn {
    Nothing,
    Patch(Patch<[u8; 4]>),
    Linked(u16),
}

fn file([width, height]: [u32; 2], frames: &[Vec<Vec<u8>>], options: Options) -> Vec<u8> {
    let mut bytes = vec![0; 4];
    bytes.extend(0xa5e0_u16.to_le_bytes());
    bytes.extend((frames.len() as u16).to_le_bytes());
    bytes.extend((width as u16).to_le_bytes());
    bytes.extend((height as u16).to_le_bytes());
    bytes.extend(options.bits.to_le_bytes());
    // Opacities of layers and groups count.
    bytes.extend(3_u32.to_le_bytes());
    bytes.resize(128, 0);
    for chunks in frames {
        let length: usize = 16 + chunks.iter().map(Vec::len).sum::<usize>();
        bytes.extend((length as u32).to_le_bytes());
        bytes.extend(0xf1fa_u16.to_le_bytes());
        bytes.extend((chunks.len() as u16).to_le_bytes());
        bytes.extend(100_u16.to_le_bytes());
        bytes.extend([0; 2]);
        bytes.extend((chunks.len() as u32).to_le_bytes());
        bytes.extend(chunks.concat());
    }
    let length = bytes.len() as u32;
    bytes[..4].copy_from_slice(&length.to_le_bytes());
    bytes
}

fn chunk(kind: u16, body: Vec<u8>) -> Vec<u8> {
    let mut bytes = (body.len() as u32 + 6).to_le_bytes().to_vec();
    bytes.extend(kind.to_le_bytes());
    bytes.extend(body);
    bytes
}

fn put_text(bytes: &mut Vec<u8>, text: &str) {
    bytes.extend((text.len() as u16).to_le_bytes());
    bytes.extend(text.as_bytes());
}

fn write_layers(
    nodes: &[Node],
    depth: u16,
    options: Options,
    layers: &mut Vec<Vec<u8>>,
    cels: &mut Vec<Vec<u8>>,
    count: &mut u16,
) {
    for node in nodes {
        let number = *count;
        *count += 1;
        match &node.content {
            Content::Group(children) => {
                layers.push(layer_chunk(node, 1, depth));
                write_layers(children, depth + 1, options, layers, cels, count);
            }
            Content::Pixels(patch) => {
                layers.push(layer_chunk(node, 0, depth));
                cels.push(cel(number, patch, options));
            }
        }
    }
}

fn layer_chunk(node: &Node, kind: u16, depth: u16) -> Vec<u8> {
    let mut body = u16::from(node.is_visible).to_le_bytes().to_vec();
    body.extend(kind.to_le_bytes());
    body.extend(depth.to_le_bytes());
    body.extend([0; 4]);
    body.extend(u16::from(node.is_multiplied).to_le_bytes());
    body.extend([node.opacity, 0, 0, 0]);
    put_text(&mut body, &node.name);
    chunk(0x2004, body)
}

fn cel(layer: u16, patch: &Patch<[u8; 4]>, options: Options) -> Vec<u8> {
    let mut body = layer.to_le_bytes().to_vec();
    body.extend((patch.left as i16).to_le_bytes());
    body.extend((patch.top as i16).to_le_bytes());
    body.push(255);
    body.extend(if options.is_deflated { 2_u16 } else { 0 }.to_le_bytes());
    body.extend([0; 7]);
    body.extend((patch.width as u16).to_le_bytes());
    body.extend((patch.height as u16).to_le_bytes());
    let pixels: Vec<u8> = match options.bits {
        32 => patch.values.concat(),
        16 => patch.values.iter().flat_map(|pixel| [pixel[0], pixel[3]]).collect(),
        _ => patch
            .values
            .iter()
            .map(|pixel| if pixel[3] < 128 { 0 } else { pixel[0].max(1) })
            .collect(),
    };
    if options.is_deflated {
        let mut encoder = flate2::write::ZlibEncoder::new(&mut body, flate2::Compression::fast());
        encoder.write_all(&pixels).expect("deflated");
        encoder.finish().expect("deflated");
    } else {
        body.extend(pixels);
    }
    chunk(0x2005, body)
}

/// Greys.
fn palette() -> Vec<u8> {
    let mut body = 256_u32.to_le_bytes().to_vec();
    body.extend(0_u32.to_le_bytes());
    body.extend(255_u32.to_le_bytes());
    body.extend([0; 8]);
    for grey in 0..=255 {
        body.extend([0, 0, grey, grey, grey, 255]);
    }
    chunk(0x2019, body)
}
