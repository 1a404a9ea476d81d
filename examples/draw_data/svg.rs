//! SVG files with one filled path an element: no strokes, no transforms, no groups.

use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;

use kurbo::{BezPath, PathEl, Point};

/// A drawing under construction: named shapes, the backmost first.
#[derive(Debug)]
pub(crate) struct Drawing {
    width: f64,
    height: f64,
    title: String,
    elements: Vec<(String, &'static str, BezPath)>,
}

impl Drawing {
    /// An empty drawing of the given size in user units.
    pub(crate) fn new(width: f64, height: f64, title: &str) -> Self {
        Self {
            width,
            height,
            title: title.to_owned(),
            elements: Vec::new(),
        }
    }

    /// Puts a filled path on top.
    pub(crate) fn fill(&mut self, id: impl Into<String>, colour: &'static str, path: BezPath) {
        self.elements.push((id.into(), colour, path));
    }

    /// Writes the file.
    pub(crate) fn save(&self, file: &Path) -> Result<(), Box<dyn Error>> {
        let (width, height) = (self.width, self.height);
        let mut text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">\n"
        );
        writeln!(text, "  <title>{}</title>", self.title)?;
        for (id, colour, path) in &self.elements {
            writeln!(
                text,
                "  <path id=\"{id}\" fill=\"{colour}\" d=\"{}\"/>",
                path_data(path)
            )?;
        }
        text.push_str("</svg>\n");
        std::fs::write(file, text)?;
        Ok(())
    }
}

fn path_data(path: &BezPath) -> String {
    let mut data = String::new();
    for element in path.elements() {
        let (letter, points): (char, &[Point]) = match element {
            PathEl::MoveTo(a) => ('M', &[*a]),
            PathEl::LineTo(a) => ('L', &[*a]),
            PathEl::QuadTo(a, b) => ('Q', &[*a, *b]),
            PathEl::CurveTo(a, b, c) => ('C', &[*a, *b, *c]),
            PathEl::ClosePath => ('Z', &[]),
        };
        data.push(letter);
        let numbers: Vec<String> = points
            .iter()
            .map(|p| format!("{},{}", rounded(p.x), rounded(p.y)))
            .collect();
        data.push_str(&numbers.join(" "));
    }
    data
}

/// Hundredths of a user unit are far below what can be seen.
pub(crate) fn rounded(value: f64) -> f64 {
    let value = (value * 100.0).round() / 100.0;
    if value == 0.0 { 0.0 } else { value }
}
