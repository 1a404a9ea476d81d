//! Photoshop: PSD, and PSB for large documents.
//!
//! Bytes -> the tree, and where each channel's bytes are.
//!
//! 1. The header: canvas, bits a channel, colours. RGB and greyscale of 8 and 16 bits are read.
//! 2. The layer section: records (module `records`), then the channels' bytes. Of 16-bit files it stands in a block `Lr16` of its own.
//! 3. Records become a tree: a group is written as a divider behind what is in it, and its own record in front.
//! 4. A file without layers has one, called "Background": the picture that every file keeps of the whole.
//!
//! Pixels are decoded in module `channels`. Limits: the masks and settings of Photoshop's newer kinds of blending (knockout, blend-if, channels that are
//! switched off) do not count.

mod channels;
mod records;

use super::tree::TreeBuilder;
use super::{
    BlendMode, Bytes, CanvasSize, Clipping, InputError, Layer, LayerContent, LayerNote, LayeredError, LayeredFile,
    LayeredKind, Mask, PixelSource, Tile, Work, canvas_of,
};
use channels::{Channel, Depth, Rectangle};
use records::{Record, Role, Version, read_records};

/// What the layer of a file without layers is called, as Photoshop does.
const FLAT_NAME: &str = "Background";

/// Where the pixels are.
#[derive(Debug)]
struct Photoshop<'a> {
    canvas: CanvasSize,
    depth: Depth,
    version: Version,
    layers: Vec<Painted<'a>>,
    masks: Vec<MaskChannel<'a>>,
}

/// The channels of a layer.
#[derive(Debug)]
struct Painted<'a> {
    rectangle: Rectangle,
    /// Red, green and blue; three times the same in greyscale.
    colours: [Channel<'a>; 3],
    /// `None` where everything is opaque.
    alpha: Option<Channel<'a>>,
}

/// A mask of pixels.
#[derive(Debug)]
struct MaskChannel<'a> {
    rectangle: Rectangle,
    outside: u8,
    channel: Channel<'a>,
}

impl PixelSource for Photoshop<'_> {
    fn tile(&self, layer: usize, _frame: usize, work: &mut Work) -> Result<Option<Tile>, LayeredError> {
        let painted = &self.layers[layer];
        let Some(area) = painted.rectangle.on(self.canvas) else {
            return Ok(None);
        };
        let mut pixels = vec![[0, 0, 0, u8::MAX]; area.width() * area.height()];
        let all = painted.colours.iter().chain(&painted.alpha);
        for (part, channel) in all.enumerate() {
            work.spend(painted.rectangle.cost(area) / 4)?;
            let mut place = 0;
            channel.rows(&painted.rectangle, area, self.depth, self.version, |row| {
                for &value in row {
                    pixels[place][part] = value;
                    place += 1;
                }
            })?;
        }
        Ok(Some(Tile {
            area,
            pixels,
            opacity: u16::MAX,
        }))
    }

    fn mask(&self, mask: usize, work: &mut Work) -> Result<Mask, LayeredError> {
        let mask = &self.masks[mask];
        let Some(area) = mask.rectangle.on(self.canvas) else {
            return Ok(Mask {
                inside: None,
                outside: mask.outside,
            });
        };
        work.spend(mask.rectangle.cost(area) / 4)?;
        let mut values = Vec::with_capacity(area.width() * area.height());
        mask.channel
            .rows(&mask.rectangle, area, self.depth, self.version, |row| {
                values.extend_from_slice(row);
            })?;
        Ok(Mask {
            inside: Some((area, values)),
            outside: mask.outside,
        })
    }
}

/// What the header says.
struct Header {
    version: Version,
    depth: Depth,
    /// How many channels the picture of the whole has.
    channels: u16,
    /// How many of them are of colour: one in greyscale.
    colours: usize,
    canvas: CanvasSize,
}

pub(super) fn open(bytes: &[u8]) -> Result<LayeredFile<'_>, InputError> {
    let mut file = Bytes::new(bytes, "a section of the PSD file");
    let header = read_header(&mut file)?;
    let colour_table = file.be_u32().map_err(InputError::from)?;
    file.take(colour_table as usize)?;
    let resources = file.be_u32().map_err(InputError::from)?;
    file.take(resources as usize)?;
    let length = header.version.length(&mut file)?;
    let section = file.part(length, "the section of layers")?;
    let records = read_records(section, header.version, header.depth)?;
    let mut source = Photoshop {
        canvas: header.canvas,
        depth: header.depth,
        version: header.version,
        layers: Vec::new(),
        masks: Vec::new(),
    };
    let layers = if records.is_empty() {
        flat(&mut source, file, &header)?
    } else {
        tree_of(&mut source, records, header.colours)?
    };
    Ok(LayeredFile {
        kind: LayeredKind::Photoshop,
        canvas: header.canvas,
        layers,
        frame_count: 1,
        tags: Vec::new(),
        pixels: Box::new(source),
    })
}

fn read_header(file: &mut Bytes<'_>) -> Result<Header, InputError> {
    const REMEDY: &str = "convert the picture to RGB colour with 8 or 16 bits a channel";
    file.take(4)?;
    let version = match file.be_u16()? {
        1 => Version::Small,
        2 => Version::Large,
        other => return Err(LayeredError::damaged(format!("it says that it is version {other} of PSD")).into()),
    };
    file.take(6)?;
    let channels = file.be_u16()?;
    let (height, width) = (file.be_u32()?, file.be_u32()?);
    let depth = match file.be_u16()? {
        8 => Depth::Eight,
        16 => Depth::Sixteen,
        other => {
            return Err(LayeredError::Unsupported {
                what: format!("{other} bits a channel are"),
                remedy: REMEDY,
            }
            .into());
        }
    };
    let colours = match file.be_u16()? {
        3 if channels >= 3 => 3,
        1 if channels >= 1 => 1,
        1 | 3 => return Err(LayeredError::damaged(format!("it has only {channels} channels")).into()),
        other => {
            let name = match other {
                0 => "pictures of two colours are",
                2 => "indexed colours are",
                4 => "CMYK colours are",
                7 => "separate channels are",
                8 => "duotone colours are",
                9 => "Lab colours are",
                _ => "unknown colours are",
            };
            return Err(LayeredError::Unsupported {
                what: name.to_owned(),
                remedy: REMEDY,
            }
            .into());
        }
    };
    Ok(Header {
        version,
        depth,
        channels,
        colours,
        canvas: canvas_of(width, height)?,
    })
}

/// The whole picture as the only layer.
fn flat<'a>(source: &mut Photoshop<'a>, mut file: Bytes<'a>, header: &Header) -> Result<Vec<Layer>, LayeredError> {
    let rectangle = Rectangle::whole(source.canvas);
    let compression = file.be_u16()?;
    let all = channels::divide_merged(
        file.rest(),
        compression,
        &rectangle,
        (header.depth, header.version),
        header.channels.into(),
    )?;
    let last = header.colours - 1;
    let whole = [0, 1, 2].map(|k: usize| all[k.min(last)]);
    let mut tree = TreeBuilder::default();
    let mut layer = Layer::new(FLAT_NAME.to_owned());
    layer.content = LayerContent::Pixels(Some(0));
    source.layers.push(Painted {
        rectangle,
        colours: whole,
        alpha: None,
    });
    tree.push(layer)?;
    tree.finish()
}

/// Records, from back to front, as a tree.
fn tree_of<'a>(
    source: &mut Photoshop<'a>,
    records: Vec<Record<'a>>,
    colours: usize,
) -> Result<Vec<Layer>, LayeredError> {
    let mut tree = TreeBuilder::default();
    for record in records {
        match record.role {
            Role::Divider => tree.begin()?,
            Role::Group { passes_through } => {
                let children = tree.end();
                let mut layer = layer_of(source, &record);
                layer.content = LayerContent::Group {
                    children,
                    is_isolated: !passes_through,
                };
                tree.push(layer)?;
            }
            Role::Layer => {
                let mut layer = layer_of(source, &record);
                let has_none = layer
                    .notes
                    .iter()
                    .any(|note| matches!(note, LayerNote::NoPixels { .. }));
                let number = if has_none {
                    None
                } else {
                    painted_of(source, &record, colours)
                };
                if number.is_none() && !has_none {
                    layer.notes.extend(record.unpainted());
                }
                layer.content = LayerContent::Pixels(number);
                tree.push(layer)?;
            }
        }
    }
    tree.finish()
}

/// Everything of a record but what is in it.
fn layer_of<'a>(source: &mut Photoshop<'a>, record: &Record<'a>) -> Layer {
    let mut layer = Layer::new(record.name.clone());
    layer.is_visible = record.is_visible;
    layer.opacity = f64::from(record.opacity) / 255.0 * f64::from(record.fill) / 255.0;
    layer.clipping = if record.is_clipped {
        Clipping::Base
    } else {
        Clipping::None
    };
    layer.notes.clone_from(&record.notes);
    match &record.blend {
        b"norm" | b"pass" => {}
        b"mul " => layer.blend = BlendMode::Multiply,
        other => layer.notes.push(LayerNote::BlendMode {
            mode: String::from_utf8_lossy(other).trim_end().to_owned(),
        }),
    }
    if let Some(mask) = record.mask
        && let Some(channel) = record.channel(records::MASK)
    {
        layer.mask = Some(source.masks.len());
        source.masks.push(MaskChannel {
            rectangle: mask.rectangle,
            outside: mask.outside,
            channel,
        });
    }
    layer
}

/// The number of a record's pixels; `None` if it has none.
fn painted_of<'a>(source: &mut Photoshop<'a>, record: &Record<'a>, colours: usize) -> Option<usize> {
    if record.rectangle.is_empty() {
        return None;
    }
    let colour = |k: usize| record.channel(i16::try_from(k.min(colours - 1)).unwrap_or(0));
    let colours = [colour(0)?, colour(1)?, colour(2)?];
    source.layers.push(Painted {
        rectangle: record.rectangle,
        colours,
        alpha: record.channel(records::ALPHA),
    });
    Some(source.layers.len() - 1)
}
