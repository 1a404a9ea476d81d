//! The page's files, as they are served: plain HTML, CSS and JavaScript modules, one idea a file. `main.js` imports the others,
//! which hear of everything by the events of `state.js`.
//!
//! Their types stand in their comments, those of the server's answers in `answers.d.ts`; `tsc --noEmit -p src/explorer/page` checks them,
//! by `tsconfig.json`. Neither of these two is served.

/// A file of the page: its name in the address, its type, its bytes.
type PageFile = (&'static str, &'static str, &'static [u8]);

const HTML: &str = "text/html; charset=utf-8";
const CSS: &str = "text/css; charset=utf-8";
const JAVASCRIPT: &str = "text/javascript; charset=utf-8";
const SVG: &str = "image/svg+xml";

/// JavaScript modules under their own names.
macro_rules! modules {
    ($($name:literal),* $(,)?) => {
        &[$(($name, JAVASCRIPT, include_bytes!($name))),*]
    };
}

/// What is not a module.
const FRAME: &[PageFile] = &[
    ("", HTML, include_bytes!("index.html")),
    ("style.css", CSS, include_bytes!("style.css")),
    ("parts.css", CSS, include_bytes!("parts.css")),
    ("icon.svg", SVG, include_bytes!("icon.svg")),
];

const MODULES: &[PageFile] = modules![
    "api.js",
    "areas.js",
    "bars.js",
    "bench.js",
    "connections.js",
    "controls.js",
    "cross.js",
    "curves.js",
    "dom.js",
    "export.js",
    "figures.js",
    "frames.js",
    "geometry.js",
    "gl.js",
    "handles.js",
    "icons.js",
    "inspector.js",
    "keep.js",
    "keyboard.js",
    "landmarks.js",
    "located.js",
    "main.js",
    "maps.js",
    "marking.js",
    "marks.js",
    "match.js",
    "matches.js",
    "mixing.js",
    "newest.js",
    "pad.js",
    "painter.js",
    "picture.js",
    "places.js",
    "plane.js",
    "pointed.js",
    "puppet.js",
    "reading.js",
    "recorder.js",
    "scan.js",
    "scanned.js",
    "seeds.js",
    "shaders.js",
    "sheet.js",
    "sheets.js",
    "shown.js",
    "skirt.js",
    "skirted.js",
    "squares.js",
    "state.js",
    "surface.js",
    "texels.js",
    "theme.js",
    "thumbnail.js",
    "tiling.js",
    "timeline.js",
    "toasts.js",
    "view.js",
    "weights.js",
];

/// The file of this name: its type and its bytes.
pub(super) fn file(name: &str) -> Option<(&'static str, &'static [u8])> {
    FRAME
        .iter()
        .chain(MODULES)
        .find(|(own, ..)| *own == name)
        .map(|(_, content_type, bytes)| (*content_type, *bytes))
}
