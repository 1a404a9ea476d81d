//! Aseprite: layers, frames, and cels, which are the drawing of one layer in one frame.
//!
//! Bytes -> the tree, the tags, and where each cel's bytes are. Chunks that are not about pictures are passed over. A cel may be linked to that of another frame. RGBA, greyscale
//! and indexed colours are read (module `pixels`). Groups lie directly on what is behind them unless they are translucent or blended. Limits: layers of tiles hold no pixels
//! that are read; an embedded colour profile does not count.

mod chunks;
mod pixels;

use std::collections::{BTreeMap, BTreeSet};

use super::raster::opacity_of;
use super::tree::TreeBuilder;
use super::{
    BlendMode, Bytes, CanvasSize, FrameTag, InputError, Layer, LayerContent, LayerNote, LayeredError, LayeredFile,
    LayeredKind, Mask, PixelSource, Tile, Work, canvas_of,
};
use chunks::{Cel, CelContent, Chunks, LayerChunk, LayerKind, read_chunks};
use pixels::Colours;

/// The most frames that are read.
const MOST_FRAMES: usize = 10_000;

#[derive(Debug)]
struct Aseprite<'a> {
    canvas: CanvasSize,
    colours: Colours,
    /// For each frame its cels, by their layers.
    frames: Vec<BTreeMap<usize, Cel<'a>>>,
    /// Of each layer, whether nothing in it is transparent by its index.
    backgrounds: Vec<bool>,
}

impl PixelSource for Aseprite<'_> {
    fn tile(&self, layer: usize, frame: usize, work: &mut Work) -> Result<Option<Tile>, LayeredError> {
        let find = |frame: usize| self.frames.get(frame)?.get(&layer);
        let Some(cel) = find(frame) else { return Ok(None) };
        let mut stored = cel;
        // A link leads to a cel with pixels.
        if let CelContent::Linked(other) = cel.content {
            let Some(linked) = find(other) else { return Ok(None) };
            stored = linked;
        }
        let (size, bytes, is_deflated) = match stored.content {
            CelContent::Raw { size, bytes } => (size, bytes, false),
            CelContent::Deflated { size, bytes } => (size, bytes, true),
            CelContent::Tiles => return Ok(None),
            CelContent::Linked(other) => {
                return Err(LayeredError::damaged(format!(
                    "its drawing in frame {frame} is linked to frame {other}, which has none of its own"
                )));
            }
        };
        // A link has the place of the cel that it leads to.
        let Some(area) = self.canvas.area(stored.at[0], stored.at[1], size[0], size[1]) else {
            return Ok(None);
        };
        work.spend((size[0] * size[1]) as u64)?;
        let pixels = self.colours.read(
            (bytes, is_deflated),
            size,
            stored.at,
            area,
            self.backgrounds.get(layer) == Some(&true),
        )?;
        Ok(Some(Tile {
            area,
            pixels,
            opacity: opacity_of(f64::from(cel.opacity) / 255.0),
        }))
    }

    fn mask(&self, _mask: usize, _work: &mut Work) -> Result<Mask, LayeredError> {
        // Nothing of this format has one.
        Ok(Mask {
            inside: None,
            outside: u8::MAX,
        })
    }
}

pub(super) fn open(bytes: &[u8]) -> Result<LayeredFile<'_>, InputError> {
    /// Of the header: opacities of layers, and of groups, count.
    const LAYER_OPACITY: u32 = 1;
    const GROUP_OPACITY: u32 = 2;
    let mut file = Bytes::new(bytes, "the Aseprite file");
    file.take(6)?;
    let frame_count = usize::from(file.le_u16()?);
    let (width, height) = (file.le_u16()?, file.le_u16()?);
    let depth = file.le_u16()?;
    let flags = file.le_u32()?;
    file.take(10)?;
    let clear_index = file.byte()?;
    file.take(99)?;
    let canvas = canvas_of(width.into(), height.into())?;
    if frame_count == 0 {
        return Err(LayeredError::damaged("it has no frame").into());
    }
    if frame_count > MOST_FRAMES {
        return Err(LayeredError::TooMany {
            what: "frames",
            found: frame_count,
            most: MOST_FRAMES,
        }
        .into());
    }
    let mut chunks = Chunks::new(flags & LAYER_OPACITY != 0, flags & GROUP_OPACITY != 0);
    for _ in 0..frame_count {
        let length = (file.le_u32()? as usize)
            .checked_sub(4)
            .ok_or_else(|| LayeredError::damaged("a frame is shorter than its own head"))?;
        let frame = file.part(length, "a frame")?;
        read_chunks(frame, &mut chunks)?;
    }
    let colours = Colours::of(depth, chunks.palette, clear_index)?;
    let backgrounds = chunks.layers.iter().map(|layer| layer.is_background).collect();
    let cels = chunks.frames.iter().flatten();
    let moved: BTreeSet<usize> = cels.filter(|(_, cel)| cel.is_moved).map(|(layer, _)| *layer).collect();
    let last = frame_count - 1;
    let tags = chunks.tags.into_iter().map(|(name, first, end)| FrameTag {
        name,
        first: first.min(last),
        last: end.min(last),
    });
    Ok(LayeredFile {
        kind: LayeredKind::Aseprite,
        canvas,
        tags: tags.collect(),
        layers: tree_of(chunks.layers, &moved)?,
        frame_count,
        pixels: Box::new(Aseprite {
            canvas,
            colours,
            frames: chunks.frames,
            backgrounds,
        }),
    })
}

/// Layers, from back to front, each with how many groups it is in; a group comes before what is in it.
fn tree_of(chunks: Vec<LayerChunk>, moved: &BTreeSet<usize>) -> Result<Vec<Layer>, LayeredError> {
    let mut tree = TreeBuilder::default();
    let mut groups: Vec<Layer> = Vec::new();
    for (number, chunk) in chunks.into_iter().enumerate() {
        while groups.len() > chunk.depth {
            close(&mut tree, &mut groups)?;
        }
        let kind = chunk.kind;
        let mut layer = layer_of(chunk);
        if kind == LayerKind::Group {
            tree.begin()?;
            groups.push(layer);
            continue;
        }
        match kind {
            LayerKind::Tiles => layer.notes.push(LayerNote::NoPixels {
                what: "a layer of tiles".to_owned(),
            }),
            LayerKind::Reference => {
                layer.notes.push(LayerNote::NoPixels {
                    what: "a reference picture".to_owned(),
                });
            }
            LayerKind::Group | LayerKind::Image => layer.content = LayerContent::Pixels(Some(number)),
        }
        if moved.contains(&number) {
            layer.notes.push(LayerNote::DepthMoved);
        }
        tree.push(layer)?;
    }
    while !groups.is_empty() {
        close(&mut tree, &mut groups)?;
    }
    tree.finish()
}

/// Closes the innermost group.
fn close(tree: &mut TreeBuilder, groups: &mut Vec<Layer>) -> Result<(), LayeredError> {
    let Some(mut group) = groups.pop() else { return Ok(()) };
    let children = tree.end();
    group.content = LayerContent::Group {
        children,
        is_isolated: group.opacity < 1.0 || group.blend != BlendMode::Normal,
    };
    tree.push(group)
}

fn layer_of(chunk: LayerChunk) -> Layer {
    let mut layer = Layer::new(if chunk.name.is_empty() {
        "layer".to_owned()
    } else {
        chunk.name
    });
    layer.is_visible = chunk.is_visible;
    layer.opacity = f64::from(chunk.opacity) / 255.0;
    match chunk.blend {
        0 => {}
        1 => layer.blend = BlendMode::Multiply,
        other => layer.notes.push(LayerNote::BlendMode {
            mode: chunks::blend_name(other).to_owned(),
        }),
    }
    layer
}
