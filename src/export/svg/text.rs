//! Numbers, paths and colours as text.

use std::fmt::Write as _;

use crate::export::keyed::Piece;
use crate::math::Point;

/// A number with at most so many decimals, without zeros at its end and without a minus before zero.
pub(in crate::export) fn number(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return "0".to_owned();
    }
    let text = format!("{value:.decimals$}");
    let short = if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        &text
    };
    if short == "-0" {
        "0".to_owned()
    } else {
        short.to_owned()
    }
}

/// Numbers with spaces between them.
pub(in crate::export) fn numbers(values: &[f64], decimals: usize) -> String {
    let texts: Vec<String> = values.iter().map(|value| number(*value, decimals)).collect();
    texts.join(" ")
}

/// A path of absolute `M`, `C` and `Z` commands.
pub(in crate::export) fn curves(pieces: &[Piece], points: &[Point], decimals: usize) -> String {
    let mut text = String::new();
    let mut rest = points;
    for piece in pieces {
        let (own, after) = rest.split_at(piece.points());
        rest = after;
        push(&mut text, 'M', &own[..1], decimals);
        for cubic in own[1..].chunks_exact(3) {
            push(&mut text, 'C', cubic, decimals);
        }
        if piece.is_closed {
            text.push('Z');
        }
    }
    text
}

/// Closed rings as a path of absolute `M`, `L` and `Z` commands.
pub(in crate::export) fn rings(sizes: &[usize], points: &[Point], decimals: usize) -> String {
    let mut text = String::new();
    let mut rest = points;
    for size in sizes {
        let (own, after) = rest.split_at(*size);
        rest = after;
        for (k, point) in own.iter().enumerate() {
            push(
                &mut text,
                if k == 0 { 'M' } else { 'L' },
                std::slice::from_ref(point),
                decimals,
            );
        }
        if *size > 0 {
            text.push('Z');
        }
    }
    text
}

fn push(text: &mut String, command: char, points: &[Point], decimals: usize) {
    text.push(command);
    for (k, point) in points.iter().enumerate() {
        if k > 0 {
            text.push(' ');
        }
        // Writing to a string cannot fail.
        let _ = write!(text, "{} {}", number(point.x, decimals), number(point.y, decimals));
    }
}

/// Red, green and blue as `#rrggbb`.
pub(in crate::export) fn colour(rgb: &[f64]) -> String {
    rgb.iter().take(3).fold("#".to_owned(), |mut text, c| {
        let byte = (c.clamp(0.0, 1.0) * 255.0).round() as u8;
        let _ = write!(text, "{byte:02x}");
        text
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(number(1.0, 3), "1");
        assert_eq!(number(100.0, 0), "100");
        assert_eq!(number(0.1239, 3), "0.124");
        assert_eq!(number(-0.0004, 3), "0");
        assert_eq!(number(-12.5, 3), "-12.5");
        assert_eq!(number(f64::NAN, 3), "0");
        assert_eq!(colour(&[1.0, 0.5, -1.0, 0.2]), "#ff8000");
    }

    #[test]
    fn commands_are_absolute_and_complete() {
        let points: Vec<Point> = (0..5).map(|k| Point::new(f64::from(k), 0.5)).collect();
        let pieces = [
            Piece {
                cubics: 1,
                is_closed: true,
            },
            Piece {
                cubics: 0,
                is_closed: false,
            },
        ];
        assert_eq!(curves(&pieces, &points, 2), "M0 0.5C1 0.5 2 0.5 3 0.5ZM4 0.5");
        assert_eq!(rings(&[2, 3], &points, 2), "M0 0.5L1 0.5ZM2 0.5L3 0.5L4 0.5Z");
    }
}
