//! A writer of OpenRaster files.

use std::fmt::Write as _;

use super::art::{Content, Node};
use super::picture::png;
use super::zip::{self, Packing, escaped};

/// An OpenRaster file with these layers, from back to front. Masks are not written: the format has none. One clipped by what is behind it is `svg:src-atop`.
pub(crate) fn write(size: [u32; 2], nodes: &[Node], packing: Packing) -> Vec<u8> {
    zip::write(&files(size, nodes), packing)
}

/// The files in it.
pub(crate) fn files([width, height]: [u32; 2], nodes: &[Node]) -> Vec<(String, Vec<u8>)> {
    let mut files = vec![("mimetype".to_owned(), b"image/openraster".to_vec())];
    let mut xml = format!(
        "<?xml version='1.0' encoding='UTF-8'?>\n<image version=\"0.0.6\" w=\"{width}\" h=\"{height}\">\n<stack>\n"
    );
    let mut pictures = Vec::new();
    write_stack(nodes, &mut xml, &mut pictures);
    xml.push_str("</stack>\n</image>\n");
    files.push(("stack.xml".to_owned(), xml.into_bytes()));
    files.append(&mut pictures);
    files
}

fn write_stack(nodes: &[Node], xml: &mut String, pictures: &mut Vec<(String, Vec<u8>)>) {
    for node in nodes.iter().rev() {
        let operation = match (node.is_multiplied, node.is_clipped) {
            (true, _) => "svg:multiply",
            (false, true) => "svg:src-atop",
            (false, false) => "svg:src-over",
        };
        let settings = format!(
            "name=\"{}\" visibility=\"{}\" opacity=\"{:.6}\" composite-op=\"{operation}\"",
            escaped(&node.name),
            if node.is_visible { "visible" } else { "hidden" },
            f64::from(node.opacity) / 255.0
        );
        match &node.content {
            Content::Group(children) => {
                let isolation = if node.passes_through { "auto" } else { "isolate" };
                let _ = writeln!(xml, "<stack {settings} isolation=\"{isolation}\">");
                write_stack(children, xml, pictures);
                xml.push_str("</stack>\n");
            }
            Content::Pixels(patch) => {
                let file = format!("data/layer{}.png", pictures.len());
                let _ = writeln!(
                    xml,
                    "<layer {settings} src=\"{file}\" x=\"{}\" y=\"{}\"/>",
                    patch.left, patch.top
                );
                pictures.push((file, png(patch)));
            }
        }
    }
}
