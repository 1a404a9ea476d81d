//! Krita: a ZIP archive of tiled layers with `maindoc.xml`, which says how they lie over one another.
//!
//! The first child of a group is the one in front. Layers of pixels in RGB or greyscale of 8 and 16 bits are read (module `tiles`), and the first transparency mask of
//! a layer or group. A layer that inherits alpha is clipped by all that is behind it in its group. Vector, file, clone, fill and filter layers hold no pixels.

mod lzf;
mod tiles;

use std::collections::BTreeMap;

use roxmltree::Node;

use super::archive::{Archive, is_called, number, parse_xml, place, side};
use super::tree::TreeBuilder;
use super::{
    BlendMode, CanvasSize, Clipping, InputError, Layer, LayerContent, LayerNote, LayeredError, LayeredFile,
    LayeredKind, Mask, PixelSource, Tile, Work, canvas_of,
};
use crate::input::decode::LARGEST_COUNT;
use tiles::{Colours, TiledLayer};

/// The description of the tree.
const MAIN: &str = "maindoc.xml";
/// The longest layer, in bytes: 16 bits a channel of the most pixels, not compressed.
const LONGEST_LAYER: usize = 8 * LARGEST_COUNT as usize;

#[derive(Debug)]
struct Krita<'a> {
    archive: Archive<'a>,
    canvas: CanvasSize,
    layers: Vec<Placed>,
    masks: Vec<Placed>,
}

/// A tiled layer of the archive and where it lies.
#[derive(Debug)]
struct Placed {
    file: String,
    at: [i64; 2],
    /// What its pixels are, by the name that the file has for it.
    colours: String,
}

impl Krita<'_> {
    /// The pixels of a layer, with those where it has no tile.
    fn read(&self, placed: &Placed, work: &mut Work) -> Result<TiledLayer, LayeredError> {
        let colours = Colours::named(&placed.colours)?;
        work.spend(self.archive.claimed_length(&placed.file) / 4)?;
        let bytes = self.archive.read(&placed.file, LONGEST_LAYER)?;
        let usual = format!("{}.defaultpixel", placed.file);
        let usual = if self.archive.has(&usual) {
            self.archive.read(&usual, 64)?
        } else {
            Vec::new().into()
        };
        tiles::read(&bytes, &usual, colours, placed.at, self.canvas, work)
    }
}

impl PixelSource for Krita<'_> {
    fn tile(&self, layer: usize, _frame: usize, work: &mut Work) -> Result<Option<Tile>, LayeredError> {
        let TiledLayer { area, pixels, usual } = self.read(&self.layers[layer], work)?;
        if usual[3] == 0 {
            return Ok(area.map(|area| Tile {
                area,
                pixels,
                opacity: u16::MAX,
            }));
        }
        let Some(whole) = self.canvas.area(0, 0, self.canvas.width, self.canvas.height) else {
            return Ok(None);
        };
        work.spend(self.canvas.count() as u64)?;
        let mut all = vec![usual; self.canvas.count()];
        if let Some(area) = area {
            let rows = all.chunks_exact_mut(self.canvas.width).skip(area.top);
            for (row, own) in rows.zip(pixels.chunks_exact(area.width())) {
                row[area.left..area.right].copy_from_slice(own);
            }
        }
        Ok(Some(Tile {
            area: whole,
            pixels: all,
            opacity: u16::MAX,
        }))
    }

    fn mask(&self, mask: usize, work: &mut Work) -> Result<Mask, LayeredError> {
        let TiledLayer { area, pixels, usual } = self.read(&self.masks[mask], work)?;
        let values = || pixels.iter().map(|pixel| pixel[3]).collect();
        Ok(Mask {
            inside: area.map(|area| (area, values())),
            outside: usual[3],
        })
    }
}

pub(super) fn open(bytes: &[u8]) -> Result<LayeredFile<'_>, InputError> {
    let archive = Archive::open(bytes)?;
    let text = archive.read_text(MAIN)?;
    let document = parse_xml(&text, MAIN)?;
    let Some(image) = document.descendants().find(|node| is_called(*node, "image")) else {
        return Err(LayeredError::damaged("it has no picture").into());
    };
    let canvas = canvas_of(side(image, "width")?, side(image, "height")?)?;
    let mut reader = Reader {
        files: archive.names_by_end("/layers/"),
        colours: image.attribute("colorspacename").unwrap_or("RGBA"),
        tree: TreeBuilder::default(),
        layers: Vec::new(),
        masks: Vec::new(),
    };
    reader.layers_in(image)?;
    let Reader {
        tree, layers, masks, ..
    } = reader;
    Ok(LayeredFile {
        kind: LayeredKind::Krita,
        canvas,
        layers: tree.finish()?,
        frame_count: 1,
        tags: Vec::new(),
        pixels: Box::new(Krita {
            archive,
            canvas,
            layers,
            masks,
        }),
    })
}

struct Reader<'r> {
    /// The files of layers and masks, by their names in the folder of layers.
    files: BTreeMap<&'r str, &'r str>,
    /// Those of layers that do not say their own.
    colours: &'r str,
    tree: TreeBuilder,
    layers: Vec<Placed>,
    masks: Vec<Placed>,
}

impl Reader<'_> {
    /// The layers of the image or of a group, from back to front.
    fn layers_in(&mut self, parent: Node<'_, '_>) -> Result<(), LayeredError> {
        let Some(list) = parent.children().find(|node| is_called(*node, "layers")) else {
            return Ok(());
        };
        for node in list.children().rev().filter(|node| is_called(*node, "layer")) {
            let kind = node
                .attribute("nodetype")
                .or(node.attribute("layertype"))
                .unwrap_or_default();
            if kind == "grouplayer" {
                self.tree.begin()?;
                self.layers_in(node)?;
                let children = self.tree.end();
                let mut layer = self.layer_of(node)?;
                layer.content = LayerContent::Group {
                    children,
                    is_isolated: node.attribute("passthrough") != Some("1"),
                };
                self.tree.push(layer)?;
                continue;
            }
            let mut layer = self.layer_of(node)?;
            if kind == "paintlayer" {
                self.painted(node, &mut layer)?;
            } else {
                layer.notes.push(LayerNote::NoPixels {
                    what: match kind {
                        "shapelayer" => "a vector layer".to_owned(),
                        "filelayer" => "a picture in another file".to_owned(),
                        "clonelayer" => "a clone of another layer".to_owned(),
                        "generatorlayer" => "a fill layer".to_owned(),
                        "adjustmentlayer" => "a filter layer".to_owned(),
                        "referenceimages" => "reference pictures".to_owned(),
                        other => format!("a layer of the kind '{other}'"),
                    },
                });
            }
            self.tree.push(layer)?;
        }
        Ok(())
    }

    fn painted(&mut self, node: Node<'_, '_>, layer: &mut Layer) -> Result<(), LayeredError> {
        let name = node.attribute("filename").unwrap_or_default();
        let Some(file) = self.files.get(name) else {
            return Err(LayeredError::damaged(format!("it lacks the file '{name}'")).of_layer(&layer.name));
        };
        if node.attribute("keyframes").is_some() {
            layer.notes.push(LayerNote::Animated);
        }
        layer.content = LayerContent::Pixels(Some(self.layers.len()));
        self.layers.push(Placed {
            file: (*file).to_owned(),
            at: [place(node, "x")?, place(node, "y")?],
            colours: node.attribute("colorspacename").unwrap_or(self.colours).to_owned(),
        });
        Ok(())
    }

    /// Everything of a layer or group but what is in it.
    fn layer_of(&mut self, node: Node<'_, '_>) -> Result<Layer, LayeredError> {
        let name = node
            .attribute("name")
            .filter(|name| !name.is_empty())
            .unwrap_or("layer");
        let mut layer = Layer::new(name.to_owned());
        layer.is_visible = node.attribute("visible") != Some("0");
        layer.opacity = (number(node, "opacity", 255.0)? / 255.0).clamp(0.0, 1.0);
        match node.attribute("compositeop").unwrap_or("normal") {
            "normal" => {}
            "multiply" => layer.blend = BlendMode::Multiply,
            cutting @ ("erase" | "clear" | "destination-in" | "destination-atop") => {
                layer.notes.push(LayerNote::CutsOut {
                    mode: cutting.to_owned(),
                });
            }
            other => layer.notes.push(LayerNote::BlendMode { mode: other.to_owned() }),
        }
        if node.attribute("layerstyle").is_some() {
            layer.notes.push(LayerNote::Effects);
        }
        // A letter a channel, alpha last; 0 switches it off.
        let flags = node.attribute("channelflags").unwrap_or_default();
        if let Some((alpha, colours)) = flags.as_bytes().split_last() {
            if *alpha == b'0' {
                layer.clipping = Clipping::Behind;
            }
            if colours.contains(&b'0') {
                layer.notes.push(LayerNote::Mask {
                    what: "switching off of channels".to_owned(),
                });
            }
        }
        self.read_masks(node, &mut layer)?;
        Ok(layer)
    }

    fn read_masks(&mut self, node: Node<'_, '_>, layer: &mut Layer) -> Result<(), LayeredError> {
        // Those of a group stand among what is in it.
        let list = node
            .children()
            .filter(|child| is_called(*child, "masks") || is_called(*child, "layers"));
        let masks = list
            .flat_map(|list| list.children())
            .filter(|child| is_called(*child, "mask"));
        for mask in masks.filter(|mask| mask.attribute("visible") != Some("0")) {
            let kind = mask.attribute("nodetype").unwrap_or_default();
            let name = mask.attribute("filename").unwrap_or_default();
            let file = self.files.get(format!("{name}.pixelselection").as_str());
            let what = match (kind, file) {
                // What is selected is no part of the picture.
                ("selectionmask", _) => continue,
                ("transparencymask", None) => {
                    layer.notes.push(LayerNote::VectorMask);
                    continue;
                }
                ("transparencymask", Some(file)) if layer.mask.is_none() => {
                    layer.mask = Some(self.masks.len());
                    self.masks.push(Placed {
                        file: (*file).to_owned(),
                        at: [place(mask, "x")?, place(mask, "y")?],
                        colours: tiles::MASK.to_owned(),
                    });
                    continue;
                }
                ("transparencymask", Some(_)) => "second transparency mask",
                ("filtermask", _) => "filter mask",
                ("transformmask", _) => "transform mask",
                ("colorizemask", _) => "colorize mask",
                _ => "mask",
            };
            layer.notes.push(LayerNote::Mask { what: what.to_owned() });
        }
        Ok(())
    }
}
