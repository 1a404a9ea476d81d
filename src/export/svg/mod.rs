//! SVG: one frame, and the body of the animated kind.
//!
//! Groups carry opacity and clip, shapes fills, strokes and gradients in the frame's pixels, pictures are PNG data. An element
//! has the id of its node, with what XML does not take replaced. What cannot be seen is left out.
//!
//! One writer serves both kinds: a still frame is an animation of one sample, in which nothing changes.
//!
//! - A linear gradient needs no transform: its colours lie across the line from where its first to where its last colour is, which
//!   is found from the map that places it. A radial one has its map as `gradientTransform`.
//! - Siblings that are not always drawn in one order are defined once and used once an order, the orders shown in turn.

mod element;
mod paint;
mod text;

pub(super) use element::Element;
pub(super) use paint::linear_ends;
pub(super) use text::number;

use base64::Engine as _;
use element::Ids;
use text::{curves, rings};

use super::keyed::{
    Group, KeyOptions, KeyReport, KeyedError, KeyedVector, Node, Picture, Planner, SampleTiming, Shape, Siblings, runs,
};
use super::smil::Clock;
use super::{Label, Repetition};
use crate::render::{FillRule, VectorFrame};

/// Decimals of lengths in a still frame.
const STILL_DECIMALS: usize = 3;
/// Decimals of opacities and offsets.
pub(super) const SHARE_DECIMALS: usize = 3;

/// One frame as an SVG document.
///
/// The same frame gives the same text. Numbers have at most three decimals.
///
/// # Errors
/// [`KeyedError`] if a picture cannot be encoded or two siblings share an id.
pub fn svg_text(frame: &VectorFrame) -> Result<String, KeyedError> {
    let timing = SampleTiming {
        fps: 1.0,
        frame_count: 1,
        samples_a_frame: 1,
        repetition: Repetition::Once,
    };
    let mut keyed = KeyedVector::empty(timing);
    keyed.add(frame)?;
    let options = KeyOptions::default();
    Ok(document(&keyed, &options, STILL_DECIMALS).0)
}

/// The same with a label in a comment at its end.
///
/// # Errors
/// As [`svg_text`].
pub fn svg_text_with(frame: &VectorFrame, label: &Label) -> Result<String, KeyedError> {
    Ok(svg_text(frame)? + &label.comment())
}

/// A sampled drawing as a document, with `decimals` of lengths.
pub(super) fn document(keyed: &KeyedVector, options: &KeyOptions, decimals: usize) -> (String, KeyReport) {
    let mut writer = SvgWriter {
        keyed,
        planner: Planner::new(&keyed.timing, options),
        clock: Clock::new(&keyed.timing, options.interpolation),
        decimals,
        ids: Ids::default(),
        definitions: Vec::new(),
    };
    let seen = vec![true; keyed.timing.sample_count()];
    let nodes = writer.siblings(&keyed.siblings, &seen);
    let [width, height] = keyed.size.map(|side| side.to_string());
    let mut root = Element::new("svg")
        .with("xmlns", "http://www.w3.org/2000/svg")
        .with("xmlns:xlink", "http://www.w3.org/1999/xlink")
        .with("viewBox", format!("0 0 {width} {height}"))
        .with("width", width.clone())
        .with("height", height.clone());
    if !writer.definitions.is_empty() {
        let mut definitions = Element::new("defs");
        definitions.extend(writer.definitions);
        root.push(definitions);
    }
    if let Some([red, green, blue, alpha]) = keyed.background {
        let mut rectangle = Element::new("rect")
            .with("width", width)
            .with("height", height)
            .with("fill", format!("#{red:02x}{green:02x}{blue:02x}"));
        if alpha < 255 {
            rectangle.set("fill-opacity", number(f64::from(alpha) / 255.0, SHARE_DECIMALS));
        }
        root.push(rectangle);
    }
    root.extend(nodes);
    let mut text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n".to_owned();
    root.write(&mut text, 0);
    (text, writer.planner.into_report())
}

struct SvgWriter<'a> {
    keyed: &'a KeyedVector,
    planner: Planner<'a>,
    clock: Clock,
    decimals: usize,
    ids: Ids,
    definitions: Vec<Element>,
}

impl SvgWriter<'_> {
    fn siblings(&mut self, siblings: &Siblings, seen: &[bool]) -> Vec<Element> {
        if siblings.orders.len() < 2 {
            return siblings
                .nodes
                .iter()
                .filter_map(|node| self.node(node, seen))
                .map(|(_, e)| e)
                .collect();
        }
        let mut names = Vec::with_capacity(siblings.nodes.len());
        for node in &siblings.nodes {
            let element = self.node(node, seen);
            names.push(element.map(|(name, element)| {
                self.definitions.push(element);
                name
            }));
        }
        let changes = siblings.runs();
        let mut orders = Vec::with_capacity(siblings.orders.len());
        for (k, order) in siblings.orders.iter().enumerate() {
            let mut group = Element::new("g");
            let shown = |is_shown: bool| if is_shown { "inline" } else { "none" }.to_owned();
            let values: Vec<_> = changes
                .iter()
                .map(|(sample, order)| (*sample, shown(*order == k)))
                .collect();
            self.clock.switch(&mut group, "display", &values);
            group.extend(order.iter().filter_map(|place| {
                let name = names[*place].as_ref()?;
                Some(Element::new("use").with("xlink:href", format!("#{name}")))
            }));
            orders.push(group);
        }
        orders
    }

    /// A node and its name; `None` if it is never seen.
    fn node(&mut self, node: &Node, seen: &[bool]) -> Option<(String, Element)> {
        let seen = node.seen(seen)?;
        let name = self.ids.take(node.id());
        let element = match node {
            Node::Group(group) => self.group(&name, group, &seen),
            Node::Shape(shape) => self.shape(&name, shape, &seen),
            Node::Picture(picture) => self.picture(&name, picture),
        };
        Some((name, element))
    }

    fn group(&mut self, name: &str, group: &Group, seen: &[bool]) -> Element {
        let mut element = Element::new("g").with("id", name);
        self.share(&mut element, "opacity", &group.opacity);
        if let Some(clip) = &group.clip {
            let clip_name = self.ids.take(&format!("{name}-clip"));
            let points = self.planner.settled(&clip.points, seen);
            let keys = self.planner.pixels(&points);
            let mut path = Element::new("path");
            let decimals = self.decimals;
            self.clock
                .animate(&mut path, "d", &keys, |k| rings(&clip.rings, &points[k], decimals));
            let mut clip_path = Element::new("clipPath").with("id", clip_name.clone());
            clip_path.push(path);
            self.definitions.push(clip_path);
            element.set("clip-path", format!("url(#{clip_name})"));
        }
        let children = self.siblings(&group.siblings, seen);
        element.extend(children);
        element
    }

    fn shape(&mut self, name: &str, shape: &Shape, seen: &[bool]) -> Element {
        let mut element = Element::new("path").with("id", name);
        let points = self.planner.settled(&shape.points, seen);
        let keys = self.planner.pixels(&points);
        let decimals = self.decimals;
        self.clock.animate(&mut element, "d", &keys, |k| {
            curves(&shape.pieces, &points[k], decimals)
        });
        match &shape.fill {
            Some((paint, rule)) => {
                self.paint(&mut element, paint::Part::Fill, name, paint, seen);
                if *rule == FillRule::EvenOdd {
                    element.set("fill-rule", "evenodd");
                }
            }
            None => element.set("fill", "none"),
        }
        if let Some(stroke) = &shape.stroke {
            self.stroke(&mut element, name, stroke, seen);
        }
        self.share(&mut element, "opacity", &shape.opacity);
        element
    }

    fn picture(&mut self, name: &str, picture: &Picture) -> Element {
        let mut element = Element::new("g").with("id", name);
        self.share(&mut element, "opacity", &picture.opacity);
        let changes = runs(&picture.frames);
        let mut drawn: Vec<usize> = changes.iter().filter_map(|(_, file)| *file).collect();
        drawn.sort_unstable();
        drawn.dedup();
        for k in drawn {
            let file = &self.keyed.pictures.files[k];
            let [left, top, width, height] = file.place.map(|length| length.to_string());
            let mut image = Element::new("image")
                .with("x", left)
                .with("y", top)
                .with("width", width)
                .with("height", height)
                .with("xlink:href", data_uri(&file.png));
            let step = self.keyed.timing.samples_a_frame.max(1);
            let shown: Vec<_> = changes
                .iter()
                .map(|(frame, file)| {
                    let value = if *file == Some(k) { "inline" } else { "none" };
                    (frame * step, value.to_owned())
                })
                .collect();
            self.clock.switch(&mut image, "display", &shown);
            element.push(image);
        }
        element
    }

    /// An attribute from 0 to 1 that is 1 where it is not said.
    fn share(&mut self, element: &mut Element, name: &'static str, values: &[f64]) {
        let samples: Vec<Vec<f64>> = values.iter().map(|value| vec![*value]).collect();
        let keys = self.planner.steps(&samples);
        let text = |k: usize| number(values[k], SHARE_DECIMALS);
        if keys.len() > 1 || text(keys[0]) != "1" {
            self.clock.animate(element, name, &keys, text);
        }
    }
}

/// A PNG file as a URI.
pub(super) fn data_uri(png: &[u8]) -> String {
    format!(
        "data:image/png;base64,{}",
        base64::engine::general_purpose::STANDARD.encode(png)
    )
}

#[cfg(test)]
mod tests;
