//! SVG files of paths: filled, lined or both, alone or in groups, in plain colours or in gradients. No transforms.

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
    elements: Vec<Element>,
}

#[derive(Debug)]
enum Element {
    Path(String, Look, BezPath),
    Group(Group),
}

/// Named shapes that belong together, the backmost first, and the gradients that they are painted with.
#[derive(Debug)]
pub(crate) struct Group {
    id: String,
    gradients: Vec<Gradient>,
    elements: Vec<Element>,
}

/// What a path is painted with.
#[derive(Debug, Clone)]
pub(crate) struct Look {
    fill: String,
    /// Colour and width; ends and corners are round.
    line: Option<(&'static str, f64)>,
}

/// A gradient in the drawing's coordinates.
#[derive(Debug)]
pub(crate) struct Gradient {
    pub(crate) id: String,
    pub(crate) shape: GradientShape,
    /// Where (0 to 1), which colour, how opaque.
    pub(crate) stops: Vec<(f64, &'static str, f64)>,
}

#[derive(Debug)]
pub(crate) enum GradientShape {
    /// From one point to another.
    Linear(Point, Point),
    /// From a point to a circle around it of this radius.
    Radial(Point, f64),
}

impl Look {
    /// Filled with a colour.
    pub(crate) fn filled(colour: &'static str) -> Self {
        Self {
            fill: colour.to_owned(),
            line: None,
        }
    }

    /// Filled with the gradient of this id.
    pub(crate) fn shaded(gradient: &str) -> Self {
        Self {
            fill: format!("url(#{gradient})"),
            line: None,
        }
    }

    /// A line, not filled.
    pub(crate) fn line(colour: &'static str, width: f64) -> Self {
        Self {
            fill: "none".to_owned(),
            line: Some((colour, width)),
        }
    }

    /// The same with a line around it.
    pub(crate) fn lined(self, colour: &'static str, width: f64) -> Self {
        Self {
            line: Some((colour, width)),
            ..self
        }
    }
}

impl Group {
    /// An empty group.
    pub(crate) fn new(id: impl Into<String>) -> Self {
        Self {
            id: id.into(),
            gradients: Vec::new(),
            elements: Vec::new(),
        }
    }

    /// Makes a gradient known.
    pub(crate) fn gradient(&mut self, gradient: Gradient) {
        self.gradients.push(gradient);
    }

    /// Puts a path on top.
    pub(crate) fn path(&mut self, id: impl Into<String>, look: Look, path: BezPath) {
        self.elements.push(Element::Path(id.into(), look, path));
    }

    /// Puts a group on top.
    pub(crate) fn group(&mut self, group: Self) {
        self.elements.push(Element::Group(group));
    }
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
        self.elements.push(Element::Path(id.into(), Look::filled(colour), path));
    }

    /// Puts a group on top.
    pub(crate) fn group(&mut self, group: Group) {
        self.elements.push(Element::Group(group));
    }

    /// Writes the file.
    pub(crate) fn save(&self, file: &Path) -> Result<(), Box<dyn Error>> {
        let (width, height) = (self.width, self.height);
        let mut text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">\n"
        );
        writeln!(text, "  <title>{}</title>", self.title)?;
        for element in &self.elements {
            write_element(&mut text, element, 1)?;
        }
        text.push_str("</svg>\n");
        std::fs::write(file, text)?;
        Ok(())
    }
}

fn write_element(text: &mut String, element: &Element, depth: usize) -> std::fmt::Result {
    let indent = "  ".repeat(depth);
    match element {
        Element::Path(id, look, path) => {
            write!(text, "{indent}<path id=\"{id}\" fill=\"{}\"", look.fill)?;
            if let Some((colour, width)) = look.line {
                write!(
                    text,
                    " stroke=\"{colour}\" stroke-width=\"{width}\" stroke-linecap=\"round\" stroke-linejoin=\"round\""
                )?;
            }
            writeln!(text, " d=\"{}\"/>", path_data(path))
        }
        Element::Group(group) => {
            writeln!(text, "{indent}<g id=\"{}\">", group.id)?;
            for gradient in &group.gradients {
                write_gradient(text, gradient, depth + 1)?;
            }
            for inner in &group.elements {
                write_element(text, inner, depth + 1)?;
            }
            writeln!(text, "{indent}</g>")
        }
    }
}

fn write_gradient(text: &mut String, gradient: &Gradient, depth: usize) -> std::fmt::Result {
    let indent = "  ".repeat(depth);
    let id = &gradient.id;
    let (tag, place) = match gradient.shape {
        GradientShape::Linear(from, to) => {
            let [x1, y1, x2, y2] = [from.x, from.y, to.x, to.y].map(rounded);
            (
                "linearGradient",
                format!("x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\""),
            )
        }
        GradientShape::Radial(middle, radius) => {
            let [cx, cy, r] = [middle.x, middle.y, radius].map(rounded);
            ("radialGradient", format!("cx=\"{cx}\" cy=\"{cy}\" r=\"{r}\""))
        }
    };
    writeln!(
        text,
        "{indent}<{tag} id=\"{id}\" gradientUnits=\"userSpaceOnUse\" {place}>"
    )?;
    for (offset, colour, opacity) in &gradient.stops {
        write!(text, "{indent}  <stop offset=\"{offset}\" stop-color=\"{colour}\"")?;
        if *opacity < 1.0 {
            write!(text, " stop-opacity=\"{opacity}\"")?;
        }
        writeln!(text, "/>")?;
    }
    writeln!(text, "{indent}</{tag}>")
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
