//! Numbers of an SVG file, looked at before anything is built from them.
//!
//! The parser turns coordinates into single precision and drops paths that are not finite without a word. Here every
//! number of a geometric attribute is read as written, so that a stray `1e300` or `NaN` is refused by name.

use usvg::roxmltree;

use super::InputError;
use crate::outline::Ring;

/// Attributes that hold coordinates, lengths or transforms.
const GEOMETRIC: [&str; 21] = [
    "d",
    "points",
    "x",
    "y",
    "x1",
    "y1",
    "x2",
    "y2",
    "cx",
    "cy",
    "r",
    "rx",
    "ry",
    "dx",
    "dy",
    "width",
    "height",
    "viewBox",
    "transform",
    "stroke-width",
    "stroke-dasharray",
];

/// Refuses a document in which a number is not finite or larger than any outline may be.
pub(super) fn check_numbers(document: &roxmltree::Document) -> Result<(), InputError> {
    for node in document.descendants().filter(roxmltree::Node::is_element) {
        for attribute in node.attributes() {
            if !GEOMETRIC.contains(&attribute.name()) {
                continue;
            }
            if let Some(number) = first_unusable(attribute.value()) {
                let place = document.text_pos_at(node.range().start);
                return Err(InputError::BadNumber {
                    element: match node.attribute("id") {
                        Some(id) => format!("{} '{id}'", node.tag_name().name()),
                        None => node.tag_name().name().to_owned(),
                    },
                    attribute: attribute.name().to_owned(),
                    line: place.row,
                    number: number.to_owned(),
                    limit: Ring::LARGEST_COORDINATE,
                });
            }
        }
    }
    Ok(())
}

/// The first number in `text` that is not finite or too large, as written.
fn first_unusable(text: &str) -> Option<&str> {
    let bytes = text.as_bytes();
    let mut at = 0;
    while at < bytes.len() {
        let rest = &bytes[at..];
        if rest.len() >= 3 && (rest[..3].eq_ignore_ascii_case(b"nan") || rest[..3].eq_ignore_ascii_case(b"inf")) {
            return text.get(at..at + 3);
        }
        if !(bytes[at].is_ascii_digit() || bytes[at] == b'.') {
            at += 1;
            continue;
        }
        let start = at;
        let digits = |mut k: usize| {
            while k < bytes.len() && bytes[k].is_ascii_digit() {
                k += 1;
            }
            k
        };
        at = digits(at);
        if bytes.get(at) == Some(&b'.') {
            at = digits(at + 1);
        }
        if matches!(bytes.get(at), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(bytes.get(at + 1), Some(b'+' | b'-')));
            let end = digits(at + 1 + sign);
            // `em` and `ex` are units, not exponents.
            if end > at + 1 + sign {
                at = end;
            }
        }
        let number = &text[start..at];
        // A lone point is no number.
        if number
            .parse::<f64>()
            .is_ok_and(|value| value > Ring::LARGEST_COORDINATE)
        {
            return Some(number);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_unusable_numbers_are_found() {
        for fine in [
            "M10-5.5.5e2l3 4Z",
            "rotate(12) scale(1e3)",
            "translate(1.5em,2ex)",
            "9999999",
            "",
            ".",
            "1e",
            "1e-300",
        ] {
            assert_eq!(first_unusable(fine), None, "{fine}");
        }
        for (text, number) in [
            ("M0 0L1e300 2", "1e300"),
            ("M0 0L1e999 2", "1e999"),
            ("M-1e9 0", "1e9"),
            ("M0,NaN", "NaN"),
            ("10 -Infinity", "Inf"),
            ("123456789012", "123456789012"),
        ] {
            assert_eq!(first_unusable(text), Some(number), "{text}");
        }
    }
}
