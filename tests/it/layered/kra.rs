//! A writer of Krita files.

use std::fmt::Write as _;

use super::art::{Content, Node, Patch};
use super::zip::{self, Packing, escaped};

/// Columns and rows of a tile.
const SIDE: i32 = 64;

/// How layers are written.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Options {
    /// 8 or 16.
    pub(crate) depth: u32,
    /// Whether tiles are compressed.
    pub(crate) is_compressed: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            depth: 8,
            is_compressed: true,
        }
    }
}

/// A Krita file with these layers, from back to front. One that is clipped inherits alpha, which is that of all behind it.
pub(crate) fn write(size: [u32; 2], nodes: &[Node], options: Options) -> Vec<u8> {
    zip::write(&files(size, nodes, options), Packing::Deflated)
}

/// The files in it.
pub(crate) fn files([width, height]: [u32; 2], nodes: &[Node], options: Options) -> Vec<(String, Vec<u8>)> {
    let mut files = vec![("mimetype".to_owned(), b"application/x-krita".to_vec())];
    let space = if options.depth == 8 { "RGBA" } else { "RGBA16" };
    let mut xml = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!DOCTYPE DOC PUBLIC '-//KDE//DTD krita 2.0//EN' \
         'http://www.calligra.org/DTD/krita-2.0.dtd'>\n<DOC xmlns=\"http://www.calligra.org/DTD/krita\" syntaxVersion=\"2.0\">\n\
         <IMAGE name=\"hero\" width=\"{width}\" height=\"{height}\" colorspacename=\"{space}\">\n"
    );
    let mut layers = Vec::new();
    write_layers(nodes, None, options, &mut xml, &mut layers);
    xml.push_str("</IMAGE>\n</DOC>\n");
    files.push(("maindoc.xml".to_owned(), xml.into_bytes()));
    files.append(&mut layers);
    files
}

/// The layers of the image or of a group, among which the mask of the group stands.
fn write_layers(
    nodes: &[Node],
    mask: Option<&Patch<u8>>,
    options: Options,
    xml: &mut String,
    files: &mut Vec<(String, Vec<u8>)>,
) {
    xml.push_str("<layers>\n");
    write_mask(mask, options, xml, files);
    for node in nodes.iter().rev() {
        let name = format!("layer{}", files.len());
        let kind = match node.content {
            Content::Group(_) => "grouplayer",
            Content::Pixels(_) => "paintlayer",
        };
        // Tiles lie at multiples of their side: what is left of the place is the layer's own.
        let [x, y] = match &node.content {
            Content::Group(_) => [0, 0],
            Content::Pixels(patch) => [patch.left.rem_euclid(SIDE), patch.top.rem_euclid(SIDE)],
        };
        let _ = writeln!(
            xml,
            "<layer nodetype=\"{kind}\" name=\"{}\" filename=\"{name}\" x=\"{x}\" y=\"{y}\" opacity=\"{}\" visible=\"{}\" \
             compositeop=\"{}\" channelflags=\"{}\" passthrough=\"{}\">",
            escaped(&node.name),
            node.opacity,
            u8::from(node.is_visible),
            if node.is_multiplied { "multiply" } else { "normal" },
            if node.is_clipped { "1110" } else { "" },
            u8::from(node.passes_through),
        );
        match &node.content {
            Content::Group(children) => {
                files.push((format!("hero/layers/{name}.note"), Vec::new()));
                write_layers(children, node.mask.as_ref(), options, xml, files);
            }
            Content::Pixels(patch) => {
                let bytes = |pixel: [u8; 4]| -> Vec<u8> {
                    let [red, green, blue, alpha] = pixel;
                    let all = [blue, green, red, alpha];
                    match options.depth {
                        8 => all.to_vec(),
                        _ => all.iter().flat_map(|&value| [value, value]).collect(),
                    }
                };
                files.push((format!("hero/layers/{name}"), tiled(patch, [x, y], bytes, options)));
                let clear = vec![0; options.depth as usize / 2];
                files.push((format!("hero/layers/{name}.defaultpixel"), clear));
            }
        }
        if let (Content::Pixels(_), Some(_)) = (&node.content, &node.mask) {
            xml.push_str("<masks>\n");
            write_mask(node.mask.as_ref(), options, xml, files);
            xml.push_str("</masks>\n");
        }
        xml.push_str("</layer>\n");
    }
    xml.push_str("</layers>\n");
}

fn write_mask(mask: Option<&Patch<u8>>, options: Options, xml: &mut String, files: &mut Vec<(String, Vec<u8>)>) {
    let Some(mask) = mask else { return };
    let name = format!("mask{}", files.len());
    let _ = writeln!(
        xml,
        "<mask nodetype=\"transparencymask\" name=\"mask\" filename=\"{name}\" visible=\"1\" x=\"0\" y=\"0\"/>"
    );
    let file = format!("hero/layers/{name}.pixelselection");
    files.push((file.clone(), tiled(mask, [0, 0], |value| vec![value], options)));
    files.push((format!("{file}.defaultpixel"), vec![0]));
}

/// A patch as tiles of a layer that lies at `at`.
fn tiled<T: Copy + Default>(patch: &Patch<T>, at: [i32; 2], bytes: impl Fn(T) -> Vec<u8>, options: Options) -> Vec<u8> {
    let size = bytes(T::default()).len();
    let (left, top) = (patch.left - at[0], patch.top - at[1]);
    let from = [left.div_euclid(SIDE), top.div_euclid(SIDE)];
    let to = [
        (left + patch.width as i32 - 1).div_euclid(SIDE),
        (top + patch.height as i32 - 1).div_euclid(SIDE),
    ];
    let mut tiles = Vec::new();
    let mut count = 0;
    for row in from[1]..=to[1] {
        for column in from[0]..=to[0] {
            let places = (0..SIDE * SIDE).map(|k| [column * SIDE + k % SIDE - left, row * SIDE + k / SIDE - top]);
            let values = places.map(|[x, y]| {
                let is_inside = (0..patch.width as i32).contains(&x) && (0..patch.height as i32).contains(&y);
                let index = (y * patch.width as i32 + x) as usize;
                bytes(if is_inside { patch.values[index] } else { T::default() })
            });
            let pixels: Vec<Vec<u8>> = values.collect();
            let stored = if options.is_compressed {
                let planes: Vec<u8> = (0..size)
                    .flat_map(|k| pixels.iter().map(move |pixel| pixel[k]))
                    .collect();
                [vec![1], lzf(&planes)].concat()
            } else {
                [vec![0], pixels.concat()].concat()
            };
            tiles.extend(format!("{},{},LZF,{}\n", column * SIDE, row * SIDE, stored.len()).into_bytes());
            tiles.extend(stored);
            count += 1;
        }
    }
    let head = format!("VERSION 2\nTILEWIDTH {SIDE}\nTILEHEIGHT {SIDE}\nPIXELSIZE {size}\nDATA {count}\n");
    [head.into_bytes(), tiles].concat()
}

/// LZF: repetitions of the byte before, and of the row before, as copies.
fn lzf(bytes: &[u8]) -> Vec<u8> {
    let mut packed = Vec::new();
    let mut literals: Vec<u8> = Vec::new();
    let flush = |literals: &mut Vec<u8>, packed: &mut Vec<u8>| {
        for run in literals.chunks(32) {
            packed.push(run.len() as u8 - 1);
            packed.extend(run);
        }
        literals.clear();
    };
    let mut at = 0;
    while at < bytes.len() {
        let same = |distance: usize| {
            let pairs = (at..bytes.len()).take(264);
            pairs
                .take_while(|&k| k >= distance && bytes[k] == bytes[k - distance])
                .count()
        };
        let distance = if same(1) >= same(SIDE as usize * 5) {
            1
        } else {
            SIDE as usize * 5
        };
        let length = same(distance);
        if length < 3 {
            literals.push(bytes[at]);
            at += 1;
            continue;
        }
        flush(&mut literals, &mut packed);
        let (high, low) = (((distance - 1) >> 8) as u8, ((distance - 1) & 255) as u8);
        if length - 2 < 7 {
            packed.extend([((length - 2) as u8) << 5 | high, low]);
        } else {
            packed.extend([7 << 5 | high, (length - 9) as u8, low]);
        }
        at += length;
    }
    flush(&mut literals, &mut packed);
    packed
}
