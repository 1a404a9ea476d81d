//! ZIP archives, as OpenRaster and Krita files are.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Read;

use flate2::bufread::DeflateDecoder;
use rawzip::{CompressionMethod, ZipArchive, ZipArchiveEntryWayfinder, ZipSliceArchive};
use roxmltree::{Document, Node, ParsingOptions};

use super::LayeredError;

/// The most files in an archive: a few for each layer.
const MOST_ENTRIES: usize = 100_000;
/// The longest description of a tree, in bytes.
const LONGEST_TREE: usize = 16 << 20;
/// The most elements, attributes and texts of a description.
const MOST_NODES: u32 = 1 << 20;

/// An archive whose directory is read.
pub(super) struct Archive<'a> {
    archive: ZipSliceArchive<&'a [u8]>,
    entries: BTreeMap<String, Entry>,
}

#[derive(Clone, Copy)]
struct Entry {
    place: ZipArchiveEntryWayfinder,
    method: CompressionMethod,
}

impl std::fmt::Debug for Archive<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_list().entries(self.entries.keys()).finish()
    }
}

fn damaged(error: &dyn std::fmt::Display) -> LayeredError {
    LayeredError::damaged(format!("its ZIP archive cannot be read ({error})"))
}

impl<'a> Archive<'a> {
    pub(super) fn open(bytes: &'a [u8]) -> Result<Self, LayeredError> {
        let archive = ZipArchive::from_slice(bytes).map_err(|error| damaged(&error))?;
        let mut entries = BTreeMap::new();
        let mut listed = archive.entries();
        while let Some(entry) = listed.next_entry().map_err(|error| damaged(&error))? {
            if entries.len() == MOST_ENTRIES {
                return Err(LayeredError::TooMany {
                    what: "files in its archive",
                    found: MOST_ENTRIES + 1,
                    most: MOST_ENTRIES,
                });
            }
            let name = String::from_utf8_lossy(entry.file_path().as_ref()).into_owned();
            let (place, method) = (entry.wayfinder(), entry.compression_method());
            entries.insert(name, Entry { place, method });
        }
        Ok(Self { archive, entries })
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.entries.contains_key(name)
    }

    /// The names that have `mark` in them, by what follows it last.
    pub(super) fn names_by_end(&self, mark: &str) -> BTreeMap<&str, &str> {
        let names = self.entries.keys().map(String::as_str);
        let ends = names.filter_map(|name| name.rsplit_once(mark).map(|(_, end)| (end, name)));
        ends.filter(|(end, _)| !end.is_empty()).collect()
    }

    /// How long a file of the archive claims to be.
    pub(super) fn claimed_length(&self, name: &str) -> u64 {
        self.entries
            .get(name)
            .map_or(0, |entry| entry.place.uncompressed_size_hint())
    }

    /// The bytes of a file of the archive.
    ///
    /// # Errors
    /// If there is none of this name, it is longer than `longest`, or it is damaged.
    pub(super) fn read(&self, name: &str, longest: usize) -> Result<Cow<'_, [u8]>, LayeredError> {
        let Some(entry) = self.entries.get(name) else {
            return Err(LayeredError::damaged(format!("it lacks the file '{name}'")));
        };
        let within = |error: &dyn std::fmt::Display| {
            LayeredError::damaged(format!("the file '{name}' in it cannot be read ({error})"))
        };
        let too_long = || LayeredError::damaged(format!("the file '{name}' in it is longer than {longest} bytes"));
        let found = self.archive.get_entry(entry.place).map_err(|error| within(&error))?;
        let mut bytes = Vec::new();
        match entry.method {
            CompressionMethod::STORE => {
                let mut read = found.verifying_reader(found.data());
                if found.data().len() > longest {
                    return Err(too_long());
                }
                std::io::copy(&mut read, &mut std::io::sink()).map_err(|error| within(&error))?;
                return Ok(Cow::Borrowed(found.data()));
            }
            CompressionMethod::DEFLATE => {
                let inflated = found.verifying_reader(DeflateDecoder::new(found.data()));
                let most = (longest as u64).saturating_add(1);
                inflated
                    .take(most)
                    .read_to_end(&mut bytes)
                    .map_err(|error| within(&error))?;
            }
            _ => return Err(within(&"it is compressed in an unknown way")),
        }
        if bytes.len() > longest {
            return Err(too_long());
        }
        Ok(Cow::Owned(bytes))
    }

    /// The text of the description of the tree.
    pub(super) fn read_text(&self, name: &str) -> Result<String, LayeredError> {
        let bytes = self.read(name, LONGEST_TREE)?.into_owned();
        String::from_utf8(bytes).map_err(|_| LayeredError::damaged(format!("the file '{name}' in it is no UTF-8 text")))
    }
}

/// A description in XML.
pub(super) fn parse_xml<'t>(text: &'t str, name: &str) -> Result<Document<'t>, LayeredError> {
    let options = ParsingOptions {
        allow_dtd: true,
        nodes_limit: MOST_NODES,
        ..ParsingOptions::default()
    };
    Document::parse_with_options(text, options)
        .map_err(|error| LayeredError::damaged(format!("the file '{name}' in it cannot be read ({error})")))
}

/// Whether an element is called so, in whatever namespace and with whatever capitals.
pub(super) fn is_called(node: Node<'_, '_>, name: &str) -> bool {
    node.is_element() && node.tag_name().name().eq_ignore_ascii_case(name)
}

/// A number of an attribute; `usual` where there is none.
pub(super) fn number(node: Node<'_, '_>, attribute: &str, usual: f64) -> Result<f64, LayeredError> {
    let Some(text) = node.attribute(attribute) else {
        return Ok(usual);
    };
    let number: Result<f64, _> = text.trim().parse();
    number.ok().filter(|number| number.is_finite()).ok_or_else(|| {
        LayeredError::damaged(format!(
            "`{attribute}` of '{}' is no number",
            node.attribute("name").unwrap_or("a layer")
        ))
    })
}

/// A place of an attribute, in whole pixels.
pub(super) fn place(node: Node<'_, '_>, attribute: &str) -> Result<i64, LayeredError> {
    // What lies further out than any canvas is not seen.
    const FAR: f64 = 1e9;
    Ok(number(node, attribute, 0.0)?.round().clamp(-FAR, FAR) as i64)
}

/// A side of the canvas.
pub(super) fn side(node: Node<'_, '_>, attribute: &str) -> Result<u32, LayeredError> {
    Ok(number(node, attribute, 0.0)?.round().clamp(0.0, f64::from(u32::MAX)) as u32)
}
