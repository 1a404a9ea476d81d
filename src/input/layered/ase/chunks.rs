//! The chunks of an Aseprite file's frames.

use std::collections::BTreeMap;

use crate::input::layered::tree::MOST_LAYERS;
use crate::input::layered::{Bytes, LayeredError};

/// The mark of a frame.
const FRAME: u16 = 0xf1fa;
/// The kinds of chunks that are read.
const OLD_PALETTE: u16 = 0x0004;
const OLDEST_PALETTE: u16 = 0x0011;
const LAYER: u16 = 0x2004;
const CEL: u16 = 0x2005;
const TAGS: u16 = 0x2018;
const PALETTE: u16 = 0x2019;

/// What the frames hold.
#[derive(Debug)]
pub(super) struct Chunks<'a> {
    has_layer_opacity: bool,
    has_group_opacity: bool,
    pub(super) layers: Vec<LayerChunk>,
    /// Of each frame so far.
    pub(super) frames: Vec<BTreeMap<usize, Cel<'a>>>,
    /// Names with first and last frames.
    pub(super) tags: Vec<(String, usize, usize)>,
    /// Red, green, blue and alpha of each index.
    pub(super) palette: Vec<[u8; 4]>,
    /// Whether the palette is one with alpha, beside which older ones do not count.
    has_new_palette: bool,
}

impl Chunks<'_> {
    pub(super) fn new(has_layer_opacity: bool, has_group_opacity: bool) -> Self {
        Self {
            has_layer_opacity,
            has_group_opacity,
            layers: Vec::new(),
            frames: Vec::new(),
            tags: Vec::new(),
            palette: Vec::new(),
            has_new_palette: false,
        }
    }
}

/// What a layer holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum LayerKind {
    Image,
    Group,
    Tiles,
    /// A picture to draw by.
    Reference,
}

/// A layer or group.
#[derive(Debug)]
pub(super) struct LayerChunk {
    pub(super) name: String,
    pub(super) kind: LayerKind,
    /// How many groups it is in.
    pub(super) depth: usize,
    pub(super) is_visible: bool,
    pub(super) is_background: bool,
    pub(super) blend: u16,
    pub(super) opacity: u8,
}

/// The drawing of a layer in a frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cel<'a> {
    pub(super) at: [i64; 2],
    pub(super) opacity: u8,
    /// Whether it lies in front of or behind other layers than its own does.
    pub(super) is_moved: bool,
    pub(super) content: CelContent<'a>,
}

/// What a cel shows.
#[derive(Debug, Clone, Copy)]
pub(super) enum CelContent<'a> {
    Raw {
        size: [usize; 2],
        bytes: &'a [u8],
    },
    Deflated {
        size: [usize; 2],
        bytes: &'a [u8],
    },
    /// What the cel of the layer in another frame shows.
    Linked(usize),
    Tiles,
}

/// Reads the chunks of one more frame, after the length of the frame.
pub(super) fn read_chunks<'a>(mut frame: Bytes<'a>, chunks: &mut Chunks<'a>) -> Result<(), LayeredError> {
    if frame.le_u16()? != FRAME {
        return Err(LayeredError::damaged("a frame does not begin as one"));
    }
    let old_count = u32::from(frame.le_u16()?);
    frame.take(4)?;
    let count = match frame.le_u32()? {
        0 => old_count,
        count => count,
    };
    let mut cels = BTreeMap::new();
    for _ in 0..count {
        if frame.is_empty() {
            break;
        }
        let length = (frame.le_u32()? as usize).checked_sub(6);
        let length = length.ok_or_else(|| LayeredError::damaged("a chunk is shorter than its own head"))?;
        let kind = frame.le_u16()?;
        let mut chunk = frame.part(length, "a chunk")?;
        match kind {
            LAYER => read_layer(&mut chunk, chunks)?,
            CEL => {
                let (layer, cel) = read_cel(&mut chunk)?;
                cels.entry(layer).or_insert(cel);
            }
            TAGS => read_tags(&mut chunk, chunks)?,
            PALETTE => read_palette(&mut chunk, chunks)?,
            OLD_PALETTE | OLDEST_PALETTE if !chunks.has_new_palette => {
                read_old_palette(&mut chunk, chunks, kind == OLDEST_PALETTE)?;
            }
            _ => {}
        }
    }
    chunks.frames.push(cels);
    Ok(())
}

fn text(chunk: &mut Bytes<'_>) -> Result<String, LayeredError> {
    let length = chunk.le_u16()?;
    Ok(String::from_utf8_lossy(chunk.take(length.into())?).into_owned())
}

fn read_layer(chunk: &mut Bytes<'_>, chunks: &mut Chunks<'_>) -> Result<(), LayeredError> {
    const VISIBLE: u16 = 1;
    const BACKGROUND: u16 = 8;
    const REFERENCE: u16 = 64;
    if chunks.layers.len() == MOST_LAYERS {
        return Err(LayeredError::TooMany {
            what: "layers",
            found: MOST_LAYERS + 1,
            most: MOST_LAYERS,
        });
    }
    let flags = chunk.le_u16()?;
    let kind = match chunk.le_u16()? {
        0 if flags & REFERENCE != 0 => LayerKind::Reference,
        0 => LayerKind::Image,
        1 => LayerKind::Group,
        2 => LayerKind::Tiles,
        other => {
            return Err(LayeredError::damaged(format!(
                "it has a layer of an unknown kind, {other}"
            )));
        }
    };
    let depth = usize::from(chunk.le_u16()?);
    chunk.take(4)?;
    let (blend, opacity) = (chunk.le_u16()?, chunk.byte()?);
    chunk.take(3)?;
    let counts = match kind {
        LayerKind::Group => chunks.has_group_opacity,
        LayerKind::Image | LayerKind::Tiles | LayerKind::Reference => chunks.has_layer_opacity,
    };
    let is_group = kind == LayerKind::Group;
    chunks.layers.push(LayerChunk {
        name: text(chunk)?,
        kind,
        depth,
        is_visible: flags & VISIBLE != 0,
        is_background: flags & BACKGROUND != 0,
        blend: if is_group && !counts { 0 } else { blend },
        opacity: if counts { opacity } else { u8::MAX },
    });
    Ok(())
}

/// The number of a layer, and what it has in the frame.
fn read_cel<'a>(chunk: &mut Bytes<'a>) -> Result<(usize, Cel<'a>), LayeredError> {
    let layer = usize::from(chunk.le_u16()?);
    let at = [chunk.le_i16()?.into(), chunk.le_i16()?.into()];
    let opacity = chunk.byte()?;
    let kind = chunk.le_u16()?;
    let is_moved = chunk.le_i16()? != 0;
    chunk.take(5)?;
    let size = |chunk: &mut Bytes<'a>| -> Result<[usize; 2], LayeredError> {
        Ok([chunk.le_u16()?.into(), chunk.le_u16()?.into()])
    };
    let content = match kind {
        0 => CelContent::Raw {
            size: size(chunk)?,
            bytes: chunk.rest(),
        },
        1 => CelContent::Linked(chunk.le_u16()?.into()),
        2 => CelContent::Deflated {
            size: size(chunk)?,
            bytes: chunk.rest(),
        },
        3 => CelContent::Tiles,
        other => {
            return Err(LayeredError::damaged(format!(
                "it has a drawing of an unknown kind, {other}"
            )));
        }
    };
    let cel = Cel {
        at,
        opacity,
        is_moved,
        content,
    };
    Ok((layer, cel))
}

fn read_tags(chunk: &mut Bytes<'_>, chunks: &mut Chunks<'_>) -> Result<(), LayeredError> {
    let count = chunk.le_u16()?;
    chunk.take(8)?;
    for _ in 0..count {
        let (first, last) = (chunk.le_u16()?, chunk.le_u16()?);
        chunk.take(13)?;
        chunks.tags.push((text(chunk)?, first.into(), last.into()));
    }
    Ok(())
}

/// The most colours of a palette.
const MOST_COLOURS: usize = 1 << 16;

fn read_palette(chunk: &mut Bytes<'_>, chunks: &mut Chunks<'_>) -> Result<(), LayeredError> {
    chunks.has_new_palette = true;
    chunk.take(4)?;
    let (first, last) = (chunk.le_u32()? as usize, chunk.le_u32()? as usize);
    chunk.take(8)?;
    if last >= MOST_COLOURS {
        return Err(LayeredError::TooMany {
            what: "colours in its palette",
            found: last.saturating_add(1),
            most: MOST_COLOURS,
        });
    }
    for index in first..=last {
        const NAMED: u16 = 1;
        let flags = chunk.le_u16()?;
        let colour = [chunk.byte()?, chunk.byte()?, chunk.byte()?, chunk.byte()?];
        if flags & NAMED != 0 {
            text(chunk)?;
        }
        set_colour(&mut chunks.palette, index, colour);
    }
    Ok(())
}

/// Packets of colours without alpha, the oldest ones of six bits.
fn read_old_palette(chunk: &mut Bytes<'_>, chunks: &mut Chunks<'_>, is_oldest: bool) -> Result<(), LayeredError> {
    let mut index = 0;
    for _ in 0..chunk.le_u16()? {
        index += usize::from(chunk.byte()?);
        let count = match chunk.byte()? {
            0 => 256,
            count => usize::from(count),
        };
        for _ in 0..count {
            let colour = [chunk.byte()?, chunk.byte()?, chunk.byte()?];
            let whole = |value: u8| if is_oldest { value << 2 | value >> 4 } else { value };
            let [red, green, blue] = colour.map(whole);
            if index < MOST_COLOURS {
                set_colour(&mut chunks.palette, index, [red, green, blue, u8::MAX]);
            }
            index += 1;
        }
    }
    Ok(())
}

fn set_colour(palette: &mut Vec<[u8; 4]>, index: usize, colour: [u8; 4]) {
    if palette.len() <= index {
        palette.resize(index + 1, [0, 0, 0, u8::MAX]);
    }
    palette[index] = colour;
}

/// What the program calls a blend mode.
pub(super) fn blend_name(mode: u16) -> &'static str {
    const NAMES: [&str; 19] = [
        "normal",
        "multiply",
        "screen",
        "overlay",
        "darken",
        "lighten",
        "colour dodge",
        "colour burn",
        "hard light",
        "soft light",
        "difference",
        "exclusion",
        "hue",
        "saturation",
        "colour",
        "luminosity",
        "addition",
        "subtract",
        "divide",
    ];
    NAMES.get(usize::from(mode)).copied().unwrap_or("unknown")
}
