//! The text of an SVG file, made ready for the parser: its encoding, its variables, and without its background.
//!
//! 1. UTF-8 only; other encodings are told apart, so that the refusal can name them.
//! 2. `var(--name, fallback)` is replaced by the value that `--name` is given anywhere in the file, the one of `:root` first, or by
//!    its fallback. The parser knows no variables, and would draw in black.
//! 3. Elements can be blanked: replaced by spaces, so that every line keeps its number.

use std::borrow::Cow;
use std::ops::Range;

use usvg::roxmltree;

/// The deepest that variables are defined by others.
const DEEPEST: usize = 8;
/// The most variables that are replaced: far more than any drawing has.
const MOST_VARIABLES: usize = 100_000;

/// Elements that put paint on the page.
const DRAWN: [&str; 8] = [
    "rect", "path", "polygon", "polyline", "circle", "ellipse", "line", "use",
];

/// Elements whose content is drawn elsewhere, or never.
const STORES: [&str; 8] = [
    "defs", "clipPath", "mask", "pattern", "symbol", "marker", "filter", "switch",
];

/// The text of a file, or what is wrong with its encoding.
pub(super) fn decode(bytes: &[u8]) -> Result<&str, String> {
    let is_utf16 = bytes.starts_with(&[0xff, 0xfe])
        || bytes.starts_with(&[0xfe, 0xff])
        || bytes.starts_with(b"<\0")
        || bytes.starts_with(b"\0<");
    if is_utf16 {
        return Err("it is in UTF-16; save it as UTF-8".to_owned());
    }
    std::str::from_utf8(bytes).map_err(|_| match declared(bytes) {
        Some(name) if !name.eq_ignore_ascii_case("utf-8") => {
            format!("it is in {name}, as its first line says; save it as UTF-8")
        }
        _ => "it is not UTF-8 text, perhaps Latin-1 (ISO 8859-1); save it as UTF-8".to_owned(),
    })
}

/// The encoding that the XML declaration names.
fn declared(bytes: &[u8]) -> Option<String> {
    let line: String = bytes.iter().take(200).map(|&b| char::from(b)).collect();
    let declaration = line
        .split("?>")
        .next()
        .filter(|text| text.trim_start().starts_with("<?xml"))?;
    let value = declaration
        .split("encoding")
        .nth(1)?
        .trim_start()
        .strip_prefix('=')?
        .trim_start();
    let quote = value.chars().next().filter(|c| matches!(c, '"' | '\''))?;
    value[1..].split(quote).next().map(str::to_owned)
}

/// The text with its variables replaced, and the names of those that have no value.
pub(super) fn with_variables(text: &str) -> (Cow<'_, str>, Vec<String>) {
    let mut missing = Vec::new();
    if !text.contains("var(") {
        return (Cow::Borrowed(text), missing);
    }
    let mut text = text.to_owned();
    let values = definitions(&text);
    let mut replaced = 0;
    for _ in 0..DEEPEST {
        let mut out = String::with_capacity(text.len());
        let mut rest = text.as_str();
        let mut changed = false;
        while let Some(at) = rest.find("var(") {
            let Some(length) = balanced(&rest[at + 4..]) else { break };
            let inner = &rest[at + 4..at + 4 + length];
            let (name, fallback) = match inner.split_once(',') {
                Some((name, fallback)) => (name.trim(), Some(fallback.trim())),
                None => (inner.trim(), None),
            };
            replaced += 1;
            if !name.starts_with("--") || replaced > MOST_VARIABLES {
                break;
            }
            let value = values
                .iter()
                .find(|(own, _)| own == name)
                .map(|(_, value)| value.as_str());
            out.push_str(&rest[..at]);
            match value.or(fallback) {
                Some(value) => out.push_str(&value.replace(['\n', '\r'], " ")),
                None => {
                    if !missing.iter().any(|known| known == name) {
                        missing.push(name.to_owned());
                    }
                    out.push_str("none");
                }
            }
            changed = true;
            rest = &rest[at + 5 + length..];
        }
        out.push_str(rest);
        text = out;
        if !changed {
            break;
        }
    }
    (Cow::Owned(text), missing)
}

/// How many bytes come before the bracket that closes one already open.
fn balanced(text: &str) -> Option<usize> {
    let mut depth = 1;
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            b'(' => depth += 1,
            b')' => depth -= 1,
            b'<' | b'>' | b'{' | b'}' => return None,
            _ => {}
        }
        if depth == 0 {
            return Some(at);
        }
    }
    None
}

/// Every `--name: value` of the text; of several values of a name that of `:root`, else the last.
fn definitions(text: &str) -> Vec<(String, String)> {
    let mut found: Vec<(String, String)> = Vec::new();
    let mut of_root: Vec<String> = Vec::new();
    let mut from = 0;
    while let Some(at) = text[from..].find("--").map(|at| from + at) {
        from = at + 2;
        let word = |c: char| c.is_alphanumeric() || c == '-' || c == '_';
        let name_end = at + 2 + text[at + 2..].find(|c: char| !word(c)).unwrap_or(text.len() - at - 2);
        let begins = text[..at]
            .chars()
            .next_back()
            .is_some_and(|c| c.is_whitespace() || "{;\"'".contains(c));
        let after = text[name_end..].trim_start();
        let Some(value) = after.strip_prefix(':').filter(|_| begins) else {
            continue;
        };
        let end = value.find([';', '}', '"', '<']).unwrap_or(value.len());
        let (name, value) = (text[at..name_end].to_owned(), value[..end].trim().to_owned());
        let selector = text[..at].rsplit_once('{').map_or("", |(before, _)| before);
        let is_root = selector.trim_end().ends_with(":root");
        match found.iter_mut().find(|(own, _)| *own == name) {
            Some(_) if of_root.contains(&name) && !is_root => {}
            Some(known) => known.1 = value,
            None => found.push((name.clone(), value)),
        }
        if is_root {
            of_root.push(name);
        }
    }
    found
}

/// Where the first element stands that puts paint on the page.
pub(super) fn first_drawn(document: &roxmltree::Document) -> Option<Range<usize>> {
    let is_stored = |node: &roxmltree::Node| node.ancestors().any(|up| STORES.contains(&up.tag_name().name()));
    document
        .descendants()
        .find(|node| node.is_element() && DRAWN.contains(&node.tag_name().name()) && !is_stored(node))
        .map(|node| node.range())
}

/// The text with an element replaced by spaces.
pub(super) fn blanked(text: &str, element: Range<usize>) -> String {
    let mut out = String::with_capacity(text.len());
    out.push_str(&text[..element.start]);
    out.extend(
        text[element.clone()]
            .chars()
            .map(|c| if c == '\n' { '\n' } else { ' ' }),
    );
    out.push_str(&text[element.end..]);
    out
}
