//! The tree of a sampled drawing.

use std::collections::BTreeMap;

use super::KeyedError;
use crate::export::{box_of, png_bytes};
use crate::math::Point;
use crate::render::Frame;
use crate::render::{
    Fill, FillRule, Gradient, GradientKind, LineCap, LineJoin, Paint, Placement, Spread, Stroke, VectorGroup,
    VectorNode, VectorPicture, VectorShape,
};

/// What is seen less than this is not seen: half a step of an 8-bit alpha.
const INVISIBLE: f64 = 0.5 / 255.0;

/// Nodes of one parent.
#[derive(Debug, Default)]
pub(in crate::export) struct Siblings {
    /// In the order of the first sample.
    pub(in crate::export) nodes: Vec<Node>,
    /// The orders they are drawn in, back to front, as places in `nodes`; each order once.
    pub(in crate::export) orders: Vec<Vec<usize>>,
    /// Which of the orders each sample has.
    pub(in crate::export) order_at: Vec<usize>,
    places: BTreeMap<String, usize>,
}

/// A node with the values of all samples.
#[derive(Debug)]
pub(in crate::export) enum Node {
    Group(Group),
    Shape(Box<Shape>),
    Picture(Picture),
}

#[derive(Debug)]
pub(in crate::export) struct Group {
    pub(in crate::export) id: String,
    pub(in crate::export) opacity: Vec<f64>,
    /// The rings' points one after the other, a list a sample.
    pub(in crate::export) clip: Option<Clip>,
    pub(in crate::export) siblings: Siblings,
}

#[derive(Debug)]
pub(in crate::export) struct Clip {
    /// How many points each ring has.
    pub(in crate::export) rings: Vec<usize>,
    /// All rings' points, a list a sample.
    pub(in crate::export) points: Vec<Vec<Point>>,
}

#[derive(Debug)]
pub(in crate::export) struct Picture {
    pub(in crate::export) id: String,
    pub(in crate::export) opacity: Vec<f64>,
    /// The picture of each whole frame, as a place in the pictures; `None` where nothing is drawn.
    pub(in crate::export) frames: Vec<Option<usize>>,
}

#[derive(Debug)]
pub(in crate::export) struct Shape {
    pub(in crate::export) id: String,
    pub(in crate::export) opacity: Vec<f64>,
    pub(in crate::export) pieces: Vec<Piece>,
    /// Each piece's start and the three points of each of its cubics, piece after piece; a list a sample.
    pub(in crate::export) points: Vec<Vec<Point>>,
    pub(in crate::export) fill: Option<(PaintTrack, FillRule)>,
    pub(in crate::export) stroke: Option<StrokeTrack>,
}

/// What does not change of a chain of curves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::export) struct Piece {
    pub(in crate::export) cubics: usize,
    pub(in crate::export) is_closed: bool,
}

impl Piece {
    /// How many points it has in a shape's list.
    pub(in crate::export) fn points(self) -> usize {
        1 + 3 * self.cubics
    }
}

#[derive(Debug)]
pub(in crate::export) enum PaintTrack {
    Solid(Vec<[f64; 4]>),
    Gradient(GradientTrack),
}

#[derive(Debug)]
pub(in crate::export) struct GradientTrack {
    pub(in crate::export) is_radial: bool,
    pub(in crate::export) spread: Spread,
    pub(in crate::export) placement: Vec<Placement>,
    /// Of radial gradients.
    pub(in crate::export) focus: Vec<Point>,
    /// Offset and colour of each stop, a list a sample.
    pub(in crate::export) stops: Vec<Vec<[f64; 5]>>,
}

#[derive(Debug)]
pub(in crate::export) struct StrokeTrack {
    pub(in crate::export) paint: PaintTrack,
    pub(in crate::export) cap: LineCap,
    pub(in crate::export) join: LineJoin,
    pub(in crate::export) miter_limit: f64,
    pub(in crate::export) width: Vec<f64>,
    pub(in crate::export) dashes: Vec<Vec<f64>>,
    pub(in crate::export) dash_offset: Vec<f64>,
}

/// What is wrong with a node of a sample.
#[derive(Debug)]
pub(super) enum Fault {
    Unlike { id: String, what: &'static str },
    Picture { id: String, reason: String },
}

impl Fault {
    fn unlike(id: &str, what: &'static str) -> Self {
        Self::Unlike {
            id: id.to_owned(),
            what,
        }
    }

    pub(super) fn at(self, sample: usize) -> KeyedError {
        match self {
            Self::Unlike { id, what } => KeyedError::Unlike { sample, id, what },
            Self::Picture { id, reason } => KeyedError::Picture { id, reason },
        }
    }
}

/// Pictures of whole frames, each but once.
#[derive(Debug, Default)]
pub(in crate::export) struct Pictures {
    pub(in crate::export) files: Vec<PictureFile>,
}

/// A picture as a PNG file.
#[derive(Debug, PartialEq, Eq)]
pub(in crate::export) struct PictureFile {
    /// Left, top, columns and rows in the frame.
    pub(in crate::export) place: [usize; 4],
    pub(in crate::export) png: Vec<u8>,
}

impl Pictures {
    fn keep(&mut self, picture: &VectorPicture) -> Result<Option<usize>, Fault> {
        let frame = &picture.frame;
        let Some(place) = box_of(frame.width, frame.height, |i| frame.pixels[i][3] > 0) else {
            return Ok(None);
        };
        let [left, top, width, height] = place;
        let pixels = (top..top + height)
            .flat_map(|y| frame.pixels[y * frame.width + left..][..width].iter().copied())
            .collect();
        let cut = Frame { width, height, pixels };
        let png = png_bytes(&cut).map_err(|error| Fault::Picture {
            id: picture.id.clone(),
            reason: error.to_string(),
        })?;
        let file = PictureFile { place, png };
        let known = self.files.iter().position(|other| *other == file);
        Ok(Some(known.unwrap_or_else(|| {
            self.files.push(file);
            self.files.len() - 1
        })))
    }
}

impl Siblings {
    /// The tree of a sample, without the values.
    pub(super) fn like(nodes: &[VectorNode]) -> Self {
        Self {
            nodes: nodes.iter().map(Node::like).collect(),
            orders: Vec::new(),
            order_at: Vec::new(),
            places: nodes
                .iter()
                .enumerate()
                .map(|(k, node)| (node.id().to_owned(), k))
                .collect(),
        }
    }

    pub(super) fn add(&mut self, nodes: &[VectorNode], is_frame: bool, pictures: &mut Pictures) -> Result<(), Fault> {
        let mut order = Vec::with_capacity(nodes.len());
        for node in nodes {
            let place = self.places.get(node.id()).copied();
            match place {
                Some(place) if !order.contains(&place) => order.push(place),
                _ => return Err(Fault::unlike(node.id(), "the place in the tree")),
            }
        }
        if let Some(missing) = (0..self.nodes.len()).find(|place| !order.contains(place)) {
            return Err(Fault::unlike(self.nodes[missing].id(), "the presence"));
        }
        for (node, place) in nodes.iter().zip(&order) {
            self.nodes[*place].add(node, is_frame, pictures)?;
        }
        let known = self.orders.iter().position(|other| *other == order);
        self.order_at.push(known.unwrap_or(self.orders.len()));
        if known.is_none() {
            self.orders.push(order);
        }
        Ok(())
    }

    /// From which samples on which order is drawn: a sample and an order each.
    pub(in crate::export) fn runs(&self) -> Vec<(usize, usize)> {
        runs(&self.order_at)
    }
}

/// Where a list of values changes: each place, and the value from there on.
pub(in crate::export) fn runs<T: PartialEq + Copy>(values: &[T]) -> Vec<(usize, T)> {
    let mut runs: Vec<(usize, T)> = Vec::new();
    for (k, value) in values.iter().enumerate() {
        if runs.last().is_none_or(|(_, last)| last != value) {
            runs.push((k, *value));
        }
    }
    runs
}

impl Node {
    fn like(node: &VectorNode) -> Self {
        match node {
            VectorNode::Group(group) => Self::Group(Group {
                id: group.id.clone(),
                opacity: Vec::new(),
                clip: group.clip.as_ref().map(|rings| Clip {
                    rings: rings.iter().map(Vec::len).collect(),
                    points: Vec::new(),
                }),
                siblings: Siblings::like(&group.nodes),
            }),
            VectorNode::Shape(shape) => Self::Shape(Box::new(Shape {
                id: shape.id.clone(),
                opacity: Vec::new(),
                pieces: pieces(shape),
                points: Vec::new(),
                fill: shape
                    .fill
                    .as_ref()
                    .map(|fill| (PaintTrack::like(&fill.paint), fill.rule)),
                stroke: shape.stroke.as_ref().map(StrokeTrack::like),
            })),
            VectorNode::Picture(picture) => Self::Picture(Picture {
                id: picture.id.clone(),
                opacity: Vec::new(),
                frames: Vec::new(),
            }),
        }
    }

    pub(in crate::export) fn id(&self) -> &str {
        match self {
            Self::Group(group) => &group.id,
            Self::Shape(shape) => &shape.id,
            Self::Picture(picture) => &picture.id,
        }
    }

    fn opacity(&self) -> &[f64] {
        match self {
            Self::Group(group) => &group.opacity,
            Self::Shape(shape) => &shape.opacity,
            Self::Picture(picture) => &picture.opacity,
        }
    }

    /// At which samples it is seen, if its parent is seen at those given; `None` if at none.
    pub(in crate::export) fn seen(&self, parent: &[bool]) -> Option<Vec<bool>> {
        let seen: Vec<bool> = parent
            .iter()
            .zip(self.opacity())
            .map(|(parent, opacity)| *parent && *opacity > INVISIBLE)
            .collect();
        seen.contains(&true).then_some(seen)
    }

    fn add(&mut self, node: &VectorNode, is_frame: bool, pictures: &mut Pictures) -> Result<(), Fault> {
        match (self, node) {
            (Self::Group(track), VectorNode::Group(group)) => track.add(group, is_frame, pictures),
            (Self::Shape(track), VectorNode::Shape(shape)) => track.add(shape),
            (Self::Picture(track), VectorNode::Picture(picture)) => {
                track.opacity.push(picture.opacity);
                if is_frame {
                    track.frames.push(pictures.keep(picture)?);
                }
                Ok(())
            }
            _ => Err(Fault::unlike(node.id(), "the kind")),
        }
    }
}

impl Group {
    fn add(&mut self, group: &VectorGroup, is_frame: bool, pictures: &mut Pictures) -> Result<(), Fault> {
        self.opacity.push(group.opacity);
        match (&mut self.clip, &group.clip) {
            (None, None) => {}
            (Some(clip), Some(rings)) if rings.iter().map(Vec::len).eq(clip.rings.iter().copied()) => {
                clip.points.push(rings.concat());
            }
            _ => return Err(Fault::unlike(&group.id, "the clip")),
        }
        self.siblings.add(&group.nodes, is_frame, pictures)
    }
}

fn pieces(shape: &VectorShape) -> Vec<Piece> {
    shape
        .subpaths
        .iter()
        .map(|subpath| Piece {
            cubics: subpath.cubics.len(),
            is_closed: subpath.is_closed,
        })
        .collect()
}

impl Shape {
    fn add(&mut self, shape: &VectorShape) -> Result<(), Fault> {
        let unlike = |what| Fault::unlike(&shape.id, what);
        if pieces(shape) != self.pieces {
            return Err(unlike("the number of curves"));
        }
        self.opacity.push(shape.opacity);
        self.points.push(
            shape
                .subpaths
                .iter()
                .flat_map(|subpath| std::iter::once(subpath.start).chain(subpath.cubics.iter().flatten().copied()))
                .collect(),
        );
        match (&mut self.fill, &shape.fill) {
            (None, None) => {}
            (Some((track, rule)), Some(Fill { paint, rule: same })) if rule == same => {
                track.add(paint).map_err(unlike)?;
            }
            _ => return Err(unlike("the fill")),
        }
        match (&mut self.stroke, &shape.stroke) {
            (None, None) => Ok(()),
            (Some(track), Some(stroke)) => track.add(stroke).map_err(unlike),
            _ => Err(unlike("the stroke")),
        }
    }
}

impl PaintTrack {
    fn like(paint: &Paint) -> Self {
        match paint {
            Paint::Solid(_) => Self::Solid(Vec::new()),
            Paint::Gradient(gradient) => Self::Gradient(GradientTrack {
                is_radial: matches!(gradient.kind, GradientKind::Radial { .. }),
                spread: gradient.spread,
                placement: Vec::new(),
                focus: Vec::new(),
                stops: Vec::new(),
            }),
        }
    }

    fn add(&mut self, paint: &Paint) -> Result<(), &'static str> {
        match (self, paint) {
            (Self::Solid(colours), Paint::Solid(colour)) => {
                colours.push(*colour);
                Ok(())
            }
            (Self::Gradient(track), Paint::Gradient(gradient)) => track.add(gradient),
            _ => Err("the kind of paint"),
        }
    }
}

impl GradientTrack {
    fn add(&mut self, gradient: &Gradient) -> Result<(), &'static str> {
        let focus = match gradient.kind {
            GradientKind::Linear if !self.is_radial => Point::zeros(),
            GradientKind::Radial { focus } if self.is_radial => focus,
            _ => return Err("the kind of gradient"),
        };
        let is_first = self.stops.is_empty();
        if self.spread != gradient.spread || !is_first && self.stops[0].len() != gradient.stops.len() {
            return Err("the spread or the number of stops");
        }
        self.placement.push(gradient.placement);
        self.focus.push(focus);
        self.stops.push(
            gradient
                .stops
                .iter()
                .map(|stop| {
                    let [red, green, blue, alpha] = stop.colour;
                    [stop.offset, red, green, blue, alpha]
                })
                .collect(),
        );
        Ok(())
    }
}

impl StrokeTrack {
    fn like(stroke: &Stroke) -> Self {
        Self {
            paint: PaintTrack::like(&stroke.paint),
            cap: stroke.cap,
            join: stroke.join,
            miter_limit: stroke.miter_limit,
            width: Vec::new(),
            dashes: Vec::new(),
            dash_offset: Vec::new(),
        }
    }

    fn add(&mut self, stroke: &Stroke) -> Result<(), &'static str> {
        let is_first = self.width.is_empty();
        if self.cap != stroke.cap || self.join != stroke.join {
            return Err("the line's caps or joins");
        }
        if !is_first && self.dashes[0].len() != stroke.dashes.len() {
            return Err("the number of dashes");
        }
        self.width.push(stroke.width);
        self.dashes.push(stroke.dashes.clone());
        self.dash_offset.push(stroke.dash_offset);
        self.paint.add(&stroke.paint)
    }
}
