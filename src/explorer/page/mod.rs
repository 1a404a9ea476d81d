//! The page's files, as they are served.

/// A file of the page: its name in the address, its type, its bytes.
type PageFile = (&'static str, &'static str, &'static [u8]);

const HTML: &str = "text/html; charset=utf-8";
const CSS: &str = "text/css; charset=utf-8";
const JAVASCRIPT: &str = "text/javascript; charset=utf-8";
const SVG: &str = "image/svg+xml";

/// All of them.
const FILES: &[PageFile] = &[
    ("", HTML, include_bytes!("index.html")),
    ("style.css", CSS, include_bytes!("style.css")),
    ("main.js", JAVASCRIPT, include_bytes!("main.js")),
    ("icon.svg", SVG, include_bytes!("icon.svg")),
];

/// The file of this name: its type and its bytes.
pub(super) fn file(name: &str) -> Option<(&'static str, &'static [u8])> {
    FILES
        .iter()
        .find(|(own, ..)| *own == name)
        .map(|(_, content_type, bytes)| (*content_type, *bytes))
}
