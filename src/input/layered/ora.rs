//! OpenRaster: a ZIP archive of PNG pictures with `stack.xml`, which says how they lie over one another.
//!
//! The first child of a stack is the one in front. A stack with `isolation = "auto"` passes through what is behind it unless it is translucent or blended.
//! Places of stacks, which newer versions of the specification no longer have, are added to those of what is in them, as MyPaint does. `alpha-preserve`,
//! which Krita writes, clips a layer by all that is behind it, as `svg:src-atop` does. What cuts out of what is behind it (`svg:dst-in` and the like) is not
//! drawn, which a note says.

use roxmltree::Node;

use super::archive::{Archive, is_called, number, parse_xml, place, side};
use super::raster::cropped;
use super::tree::TreeBuilder;
use super::{
    BlendMode, CanvasSize, Clipping, InputError, Layer, LayerContent, LayerNote, LayeredError, LayeredFile,
    LayeredKind, Mask, PixelSource, Tile, Work, canvas_of,
};
use crate::input::PictureChoice;
use crate::input::decode::{LARGEST_COUNT, decode, upright_size};

/// The description of the tree.
const STACK: &str = "stack.xml";
/// The longest picture, in bytes: 16 bits a channel of the most pixels, not compressed.
const LONGEST_PICTURE: usize = 8 * LARGEST_COUNT as usize;

#[derive(Debug)]
struct OpenRaster<'a> {
    archive: Archive<'a>,
    canvas: CanvasSize,
    pictures: Vec<Placed>,
}

/// A picture of the archive and where it lies.
#[derive(Debug)]
struct Placed {
    file: String,
    left: i64,
    top: i64,
}

impl PixelSource for OpenRaster<'_> {
    fn tile(&self, layer: usize, _frame: usize, work: &mut Work) -> Result<Option<Tile>, LayeredError> {
        let Placed { file, left, top } = &self.pictures[layer];
        let unreadable = |error: InputError| LayeredError::damaged(format!("the picture '{file}': {error}"));
        work.spend(self.archive.claimed_length(file) / 4)?;
        let bytes = self.archive.read(file, LONGEST_PICTURE)?;
        let [width, height] = upright_size(&bytes, PictureChoice::Only).map_err(unreadable)?;
        let Some(area) = self.canvas.area(*left, *top, width as usize, height as usize) else {
            return Ok(None);
        };
        work.spend(u64::from(width) * u64::from(height))?;
        let image = decode(&bytes).map_err(unreadable)?.image;
        let (pixels, _) = image.as_raw().as_chunks::<4>();
        Ok(Some(Tile {
            area,
            pixels: cropped(pixels, image.width() as usize, [*left, *top], area),
            opacity: u16::MAX,
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
    let archive = Archive::open(bytes)?;
    let text = archive.read_text(STACK)?;
    let document = parse_xml(&text, STACK)?;
    let image = document.root_element();
    let canvas = canvas_of(side(image, "w")?, side(image, "h")?)?;
    let mut reader = Reader {
        tree: TreeBuilder::default(),
        pictures: Vec::new(),
    };
    let Some(root) = image.children().find(|node| is_called(*node, "stack")) else {
        return Err(LayeredError::damaged("it has no stack of layers").into());
    };
    reader.stack(root, [0, 0])?;
    Ok(LayeredFile {
        kind: LayeredKind::OpenRaster,
        canvas,
        layers: reader.tree.finish()?,
        frame_count: 1,
        tags: Vec::new(),
        pixels: Box::new(OpenRaster {
            archive,
            canvas,
            pictures: reader.pictures,
        }),
    })
}

struct Reader {
    tree: TreeBuilder,
    pictures: Vec<Placed>,
}

impl Reader {
    /// What is in a stack, from back to front.
    fn stack(&mut self, stack: Node<'_, '_>, [left, top]: [i64; 2]) -> Result<(), LayeredError> {
        let at = [left + place(stack, "x")?, top + place(stack, "y")?];
        for node in stack.children().rev().filter(Node::is_element) {
            if is_called(node, "stack") {
                self.group(node, at)?;
            } else if is_called(node, "layer") {
                self.layer(node, at)?;
            } else if is_called(node, "text") || is_called(node, "filter") {
                let mut layer = layer_of(node, node.tag_name().name())?;
                layer.notes.push(LayerNote::NoPixels {
                    what: if is_called(node, "text") {
                        "live text"
                    } else {
                        "a filter"
                    }
                    .to_owned(),
                });
                self.tree.push(layer)?;
            }
        }
        Ok(())
    }

    fn group(&mut self, node: Node<'_, '_>, at: [i64; 2]) -> Result<(), LayeredError> {
        self.tree.begin()?;
        self.stack(node, at)?;
        let children = self.tree.end();
        let mut layer = layer_of(node, "group")?;
        let is_plain = layer.opacity >= 1.0
            && layer.blend == BlendMode::Normal
            && layer.clipping == Clipping::None
            && layer.notes.is_empty();
        layer.content = LayerContent::Group {
            children,
            is_isolated: node.attribute("isolation") == Some("isolate") || !is_plain,
        };
        self.tree.push(layer)
    }

    fn layer(&mut self, node: Node<'_, '_>, at: [i64; 2]) -> Result<(), LayeredError> {
        let mut layer = layer_of(node, "layer")?;
        let file = node.attribute("src").unwrap_or_default();
        if file.to_lowercase().ends_with(".svg") {
            layer.notes.push(LayerNote::NoPixels {
                what: "a vector drawing".to_owned(),
            });
        } else {
            layer.content = LayerContent::Pixels(Some(self.pictures.len()));
            self.pictures.push(Placed {
                file: file.to_owned(),
                left: at[0] + place(node, "x")?,
                top: at[1] + place(node, "y")?,
            });
        }
        self.tree.push(layer)
    }
}

/// Everything of a layer or stack but what is in it.
fn layer_of(node: Node<'_, '_>, unnamed: &str) -> Result<Layer, LayeredError> {
    let name = node
        .attribute("name")
        .filter(|name| !name.is_empty())
        .unwrap_or(unnamed);
    let mut layer = Layer::new(name.to_owned());
    layer.is_visible = node.attribute("visibility") != Some("hidden");
    layer.opacity = number(node, "opacity", 1.0)?.clamp(0.0, 1.0);
    match node.attribute("composite-op").unwrap_or("svg:src-over") {
        "svg:src-over" => {}
        "svg:multiply" => layer.blend = BlendMode::Multiply,
        "svg:src-atop" => layer.clipping = Clipping::Behind,
        cutting @ ("svg:dst-in" | "svg:dst-out" | "svg:dst-atop" | "svg:clear") => {
            layer.notes.push(LayerNote::CutsOut {
                mode: cutting.to_owned(),
            });
        }
        other => layer.notes.push(LayerNote::BlendMode { mode: other.to_owned() }),
    }
    if node.attribute("alpha-preserve") == Some("true") {
        layer.clipping = Clipping::Behind;
    }
    Ok(layer)
}
