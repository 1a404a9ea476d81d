//! Lottie JSON, after the specification 1.0.1 of the Lottie Animation Community.
//!
//! Shapes are shape layers, groups precompositions, pictures image assets, the background a solid layer. Every property
//! that changes has keys of its own, linear between them, at times in frames, which may be fractions. Names of layers
//! are the ids of nodes.
//!
//! - Lottie lists what is in front first.
//! - A path of several pieces is several `sh` under one fill. Tangents are relative to their vertex.
//! - A clip is a list of masks, one a ring: rings that turn as the largest one does add, the others cut out. Rings of one
//!   kind that overlap count once, as under the non-zero rule.
//! - Siblings whose order changes are precompositions that are referred to once for every time an order is drawn.
//! - A picture is one image layer a stretch of equal frames, from its first frame to the next picture's.
//!
//! Limits of the format, said in the report where they are met: a radial gradient is round, with the area of the
//! ellipse that is meant; a gradient ends in its last colour and is not repeated.

mod paint;
mod property;

use serde_json::{Value, json};

use super::keyed::{Group, Node, Picture, Piece, Planner, Shape, Siblings, runs};
use super::svg::data_uri;
use super::{KeyOptions, KeyReport, KeyedError, KeyedVector};
use crate::math::Point;
use crate::math::point::cross;
use property::{Timeline, pair, rounded};

/// The version of lottie-web whose keys these are: values at keys only, no ends of keys.
const FORMAT: &str = "5.7.0";
/// The version of the specification: 1.0.1.
const SPECIFICATION: u32 = 10_001;
/// Ends nearer than this, in pixels, are one vertex.
const SAME_PX: f64 = 1e-6;

impl KeyedVector {
    /// The drawing as Lottie JSON, named `name`. The same samples give the same text.
    ///
    /// # Errors
    /// [`KeyedError`] if samples are missing.
    pub fn to_lottie(&self, name: &str, options: &KeyOptions) -> Result<(String, KeyReport), KeyedError> {
        let samples = self.complete()?;
        let mut writer = LottieWriter {
            keyed: self,
            planner: Planner::new(&self.timing, options),
            timeline: Timeline::new(&self.timing, options.interpolation),
            assets: Vec::new(),
            images: vec![None; self.pictures.files.len()],
        };
        let mut layers = writer.siblings(&self.siblings, &vec![true; samples]);
        if let Some([red, green, blue, alpha]) = self.background {
            let [width, height] = self.size;
            let opacity = rounded(f64::from(alpha) / 2.55, 3);
            layers.push(writer.layer(
                1,
                "background",
                json!({"a": 0, "k": opacity}),
                json!({"sw": width, "sh": height, "sc": format!("#{red:02x}{green:02x}{blue:02x}")}),
            ));
        }
        number_layers(&mut layers);
        let animation = json!({
            "v": FORMAT,
            "ver": SPECIFICATION,
            "nm": name,
            "fr": rounded(self.timing.fps, 6),
            "ip": 0,
            "op": self.timing.frame_count,
            "w": self.size[0],
            "h": self.size[1],
            "ddd": 0,
            "assets": writer.assets,
            "layers": layers,
        });
        Ok((animation.to_string(), writer.planner.into_report()))
    }
}

struct LottieWriter<'a> {
    keyed: &'a KeyedVector,
    planner: Planner<'a>,
    timeline: Timeline,
    assets: Vec<Value>,
    /// The asset of each picture that is in use.
    images: Vec<Option<String>>,
}

impl LottieWriter<'_> {
    /// The layers of siblings, from front to back.
    fn siblings(&mut self, siblings: &Siblings, seen: &[bool]) -> Vec<Value> {
        let changes = siblings.runs();
        if changes.len() < 2 {
            let layers: Vec<Vec<Value>> = siblings.nodes.iter().map(|node| self.node(node, seen)).collect();
            return layers.into_iter().rev().flatten().collect();
        }
        let whole: Vec<Option<String>> = siblings
            .nodes
            .iter()
            .map(|node| {
                let layers = self.node(node, seen);
                (!layers.is_empty()).then(|| self.precomposition(node.id(), layers))
            })
            .collect();
        let mut layers = Vec::new();
        for (k, (sample, order)) in changes.iter().enumerate() {
            let start = self.keyed.timing.frame_of(*sample);
            let end = match changes.get(k + 1) {
                Some((next, _)) => self.keyed.timing.frame_of(*next),
                None => self.keyed.timing.frame_count as f64,
            };
            // A loop's last sample is the first frame again.
            if start >= end {
                continue;
            }
            for place in siblings.orders[*order].iter().rev() {
                if let Some(asset) = &whole[*place] {
                    let layer = self.reference(siblings.nodes[*place].id(), asset, json!({"a": 0, "k": 100}));
                    layers.push(shown_between(layer, start, end));
                }
            }
        }
        layers
    }

    /// The layers of a node, none if it is never seen.
    fn node(&mut self, node: &Node, seen: &[bool]) -> Vec<Value> {
        let Some(seen) = node.seen(seen) else {
            return Vec::new();
        };
        match node {
            Node::Group(group) => vec![self.group(group, &seen)],
            Node::Shape(shape) => vec![self.shape(shape, &seen)],
            Node::Picture(picture) => self.picture(picture),
        }
    }

    fn group(&mut self, group: &Group, seen: &[bool]) -> Value {
        let inner = self.siblings(&group.siblings, seen);
        let asset = self.precomposition(&group.id, inner);
        let opacity = self.percent(&group.opacity);
        let mut layer = self.reference(&group.id, &asset, opacity);
        if let Some(clip) = &group.clip {
            let points = self.planner.settled(&clip.points, seen);
            layer["hasMask"] = json!(true);
            layer["masksProperties"] = self.masks(&clip.rings, &points);
        }
        layer
    }

    fn masks(&mut self, rings: &[usize], points: &[Vec<Point>]) -> Value {
        let keys = self.planner.pixels(points);
        let mut starts = Vec::with_capacity(rings.len());
        let mut start = 0;
        for size in rings {
            starts.push(start..start + size);
            start += size;
        }
        let areas: Vec<f64> = starts.iter().map(|own| twice_area(&points[0][own.clone()])).collect();
        let largest = areas
            .iter()
            .copied()
            .fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
        let adds = |k: usize| areas[k] * largest >= 0.0;
        let mut order: Vec<usize> = (0..rings.len()).collect();
        order.sort_by_key(|k| !adds(*k));
        let masks: Vec<Value> = order
            .into_iter()
            .map(|k| {
                let path = self
                    .timeline
                    .single(&keys, |sample| polygon(&points[sample][starts[k].clone()]));
                json!({
                    "inv": false,
                    "mode": if adds(k) { "a" } else { "s" },
                    "pt": path,
                    "o": {"a": 0, "k": 100},
                    "x": {"a": 0, "k": 0},
                })
            })
            .collect();
        Value::Array(masks)
    }

    fn shape(&mut self, shape: &Shape, seen: &[bool]) -> Value {
        let points = self.planner.settled(&shape.points, seen);
        let keys = self.planner.pixels(&points);
        let mut items = Vec::new();
        let mut start = 0;
        for piece in &shape.pieces {
            let own = start..start + piece.points();
            start = own.end;
            let meets = points
                .iter()
                .all(|sample| (sample[own.start] - sample[own.end - 1]).norm() <= SAME_PX);
            let path = self
                .timeline
                .single(&keys, |sample| bezier(*piece, &points[sample][own.clone()], meets));
            items.push(json!({"ty": "sh", "ks": path}));
        }
        if let Some(stroke) = &shape.stroke {
            items.push(self.stroke(stroke, seen));
        }
        if let Some((paint, rule)) = &shape.fill {
            items.push(self.fill(paint, *rule, seen));
        }
        items.push(json!({
            "ty": "tr",
            "a": {"a": 0, "k": [0, 0]},
            "p": {"a": 0, "k": [0, 0]},
            "s": {"a": 0, "k": [100, 100]},
            "r": {"a": 0, "k": 0},
            "o": {"a": 0, "k": 100},
            "sk": {"a": 0, "k": 0},
            "sa": {"a": 0, "k": 0},
        }));
        let opacity = self.percent(&shape.opacity);
        let group = json!({"ty": "gr", "nm": shape.id, "np": items.len() - 1, "it": items});
        self.layer(4, &shape.id, opacity, json!({"shapes": [group]}))
    }

    fn picture(&mut self, picture: &Picture) -> Vec<Value> {
        let opacity = self.percent(&picture.opacity);
        let is_steady = opacity["a"] == 0;
        let own = if is_steady {
            opacity.clone()
        } else {
            json!({"a": 0, "k": 100})
        };
        let changes = runs(&picture.frames);
        let mut layers = Vec::new();
        for (k, (frame, file)) in changes.iter().enumerate() {
            let Some(file) = file else { continue };
            let end = changes
                .get(k + 1)
                .map_or(self.keyed.timing.frame_count, |(next, _)| *next);
            let asset = self.image(*file);
            let mut layer = self.layer(2, &picture.id, own.clone(), json!({"refId": asset}));
            let [left, top, ..] = self.keyed.pictures.files[*file].place;
            layer["ks"]["p"] = json!({"a": 0, "k": [left, top, 0]});
            layers.push(shown_between(layer, *frame as f64, end as f64));
        }
        if is_steady || layers.is_empty() {
            return layers;
        }
        let asset = self.precomposition(&picture.id, layers);
        vec![self.reference(&picture.id, &asset, opacity)]
    }

    fn image(&mut self, file: usize) -> String {
        if let Some(id) = &self.images[file] {
            return id.clone();
        }
        let picture = &self.keyed.pictures.files[file];
        let id = format!("picture-{}", self.assets.len());
        let [_, _, width, height] = picture.place;
        self.assets
            .push(json!({"id": id, "w": width, "h": height, "u": "", "p": data_uri(&picture.png), "e": 1}));
        self.images[file] = Some(id.clone());
        id
    }

    fn precomposition(&mut self, name: &str, mut layers: Vec<Value>) -> String {
        let id = format!("group-{}", self.assets.len());
        number_layers(&mut layers);
        self.assets.push(json!({"id": id, "nm": name, "layers": layers}));
        id
    }

    fn reference(&self, name: &str, asset: &str, opacity: Value) -> Value {
        let [width, height] = self.keyed.size;
        self.layer(0, name, opacity, json!({"refId": asset, "w": width, "h": height}))
    }

    fn layer(&self, kind: u32, name: &str, opacity: Value, own: Value) -> Value {
        let mut layer = json!({
            "ty": kind,
            "nm": name,
            "ip": 0,
            "op": self.keyed.timing.frame_count,
            "st": 0,
            "sr": 1,
            "bm": 0,
            "ddd": 0,
            "ao": 0,
            "ks": {
                "a": {"a": 0, "k": [0, 0, 0]},
                "p": {"a": 0, "k": [0, 0, 0]},
                "s": {"a": 0, "k": [100, 100, 100]},
                "r": {"a": 0, "k": 0},
                "o": opacity,
            },
        });
        if let (Value::Object(layer), Value::Object(own)) = (&mut layer, own) {
            layer.extend(own);
        }
        layer
    }

    /// An opacity from 0 to 1 in percent.
    fn percent(&mut self, values: &[f64]) -> Value {
        let samples: Vec<Vec<f64>> = values.iter().map(|value| vec![*value]).collect();
        let keys = self.planner.steps(&samples);
        self.timeline.scalar(&keys, |k| rounded(values[k] * 100.0, 2))
    }
}

fn shown_between(mut layer: Value, start: f64, end: f64) -> Value {
    layer["ip"] = rounded(start, 6);
    layer["op"] = rounded(end, 6);
    layer
}

/// Gives layers of one composition the numbers that players tell them apart by.
fn number_layers(layers: &mut [Value]) {
    for (k, layer) in layers.iter_mut().enumerate() {
        layer["ind"] = json!(k + 1);
    }
}

/// A chain of curves; `meets` says that its end is its start.
fn bezier(piece: Piece, points: &[Point], meets: bool) -> Value {
    let zero = Point::zeros();
    let mut vertices = vec![points[0]];
    let mut incoming = vec![zero];
    let mut outgoing = Vec::with_capacity(piece.cubics + 1);
    for cubic in points[1..].chunks_exact(3) {
        let from = vertices[vertices.len() - 1];
        outgoing.push(cubic[0] - from);
        incoming.push(cubic[1] - cubic[2]);
        vertices.push(cubic[2]);
    }
    if piece.is_closed && meets && piece.cubics > 0 {
        vertices.pop();
        if let Some(last) = incoming.pop() {
            incoming[0] = last;
        }
    } else {
        outgoing.push(zero);
    }
    let list = |points: Vec<Point>| Value::Array(points.into_iter().map(pair).collect());
    json!({"c": piece.is_closed, "v": list(vertices), "i": list(incoming), "o": list(outgoing)})
}

fn polygon(points: &[Point]) -> Value {
    let vertices: Vec<Value> = points.iter().copied().map(pair).collect();
    let zeros = vec![json!([0, 0]); points.len()];
    json!({"c": true, "v": vertices, "i": zeros, "o": zeros})
}

fn twice_area(points: &[Point]) -> f64 {
    (0..points.len())
        .map(|k| cross(points[k], points[(k + 1) % points.len()]))
        .sum()
}

#[cfg(test)]
mod tests;
