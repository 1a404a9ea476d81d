//! Pictures of the drawings, and what requests call layers and poses.

use inbetween::export::texture_png;
use inbetween::math::Point;
use inbetween::pipeline::LayerShape;
use inbetween::render::{PuppetTexture, Sampling, Texture};
use inbetween::scene::Workbench;
use serde_json::{Value, json};

use super::http::Request;
use super::problem::Refusal;

/// How many texels a pixel of the animation's frames may have: pages are zoomed, and screens are finer than frames.
const TEXELS_A_PIXEL: f64 = 2.0;

/// A place on a pose of a layer, from the file's coordinates to drawing units: reflected and moved as the pose is.
pub(super) fn as_used(bench: &Workbench, layer: usize, pose: &str, place: Point) -> Point {
    drawing_of(bench, layer, pose).map_or(place, |drawing| bench.as_used(layer, drawing, place))
}

/// The place of the file that [`as_used`] takes to `place`.
pub(super) fn as_drawn(bench: &Workbench, layer: usize, pose: &str, place: Point) -> Point {
    drawing_of(bench, layer, pose).map_or(place, |drawing| bench.as_drawn(layer, drawing, place))
}

/// Which drawing of a layer a pose shows.
fn drawing_of(bench: &Workbench, layer: usize, pose: &str) -> Option<usize> {
    let spec = bench.spec().layers.get(layer)?;
    let index = spec.poses.iter().position(|own| own.name == pose)?;
    let (root, _) = spec.drawing_of(index)?;
    spec.drawn_poses().iter().position(|drawn| *drawn == root)
}

/// The texture of each pose of a layer.
pub(super) fn texture_of(bench: &Workbench, layer: usize) -> Vec<usize> {
    bench.spec().layers[layer].shown_drawings()
}

/// The shape of the layer that the body of a request is about.
pub(super) fn shape_of(bench: &Workbench, layer: usize) -> Result<&LayerShape, Refusal> {
    let shape = bench.layers().get(layer);
    shape.ok_or_else(|| Refusal::bad("there is no such layer"))
}

/// The pose of a layer, of this shape, that the body of a request is about.
pub(super) fn pose_of(shape: &LayerShape, layer: usize, name: &str) -> Result<usize, Refusal> {
    let found = shape.mapping().poses.index_of(name);
    found.ok_or_else(|| Refusal::bad(format!("layer {layer} has no pose '{name}'")))
}

/// The layer that a request is about.
pub(super) fn asked_layer(request: &Request, bench: &Workbench) -> Result<usize, Refusal> {
    index(request, "layer", bench.layers().len())
}

pub(super) fn index(request: &Request, name: &str, count: usize) -> Result<usize, Refusal> {
    let index = match request.value(name) {
        None => Some(0),
        Some(text) => text.parse().ok(),
    };
    index
        .filter(|index| *index < count)
        .ok_or_else(|| Refusal::bad(format!("`{name}` must be a number from 0 to {}", count.max(1) - 1)))
}

/// A picture with its place.
pub(super) struct Placed {
    pub(super) texture: PuppetTexture,
    origin: Point,
    scale: f64,
}

impl Placed {
    pub(super) fn place(&self) -> Value {
        json!({
            "width": self.texture.width, "height": self.texture.height,
            "origin": [self.origin.x, self.origin.y], "scale": self.scale,
        })
    }
}

/// Which picture of a drawing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Kind {
    /// Colours that reach beyond the edge, to be cut by the frame's outline.
    Colour,
    /// The drawing's own pixels, and outside of its outline the nearest of them: for frames that show nearest texels.
    Nearest,
    /// Which of these lie inside the outline: opaque ones.
    Inside,
    /// The drawing with its own edge.
    Drawing,
}

impl Kind {
    /// What frames of a scene are made of.
    pub(super) fn of_frames(bench: &Workbench) -> Self {
        match bench.scene().sampling {
            Sampling::Smooth => Self::Colour,
            Sampling::Nearest => Self::Nearest,
        }
    }
}

/// The picture of a layer's drawing.
pub(super) fn picture(bench: &Workbench, layer: usize, index: usize, kind: Kind) -> Placed {
    let drawing = &bench.drawings(layer)[index];
    let fineness = TEXELS_A_PIXEL * bench.camera().scale();
    match kind {
        Kind::Colour => placed(&Texture::new(&drawing.picture, &drawing.outline, fineness), straight),
        Kind::Nearest => placed(&Texture::for_nearest(&drawing.picture, &drawing.outline), straight),
        Kind::Inside => placed(
            &Texture::for_nearest(&drawing.picture, &drawing.outline),
            |texture, i| {
                let is_inside = texture.texels_inside().get(i).copied().unwrap_or_default();
                [255, 255, 255, if is_inside { 255 } else { 0 }]
            },
        ),
        Kind::Drawing => {
            let corners = outline_box(drawing.outline.outer().points());
            let texture = PuppetTexture::new("", &drawing.picture, &drawing.outline, &corners, fineness);
            // Where the picture's corner lies follows from where those of the outline's box do.
            let scale = (texture.places[1].x - texture.places[0].x) / (corners[1].x - corners[0].x);
            Placed {
                origin: corners[0] - texture.places[0] / scale,
                scale,
                texture,
            }
        }
    }
}

/// A texture, whose pixels are what `pixel` says.
fn placed(texture: &Texture, pixel: impl Fn(&Texture, usize) -> [u8; 4]) -> Placed {
    let [width, height] = texture.size();
    let origin = texture.to_texels(Point::zeros());
    let scale = texture.to_texels(Point::new(1.0, 0.0)).x - origin.x;
    Placed {
        texture: PuppetTexture {
            name: String::new(),
            width,
            height,
            pixels: (0..width * height).map(|i| pixel(texture, i)).collect(),
            places: Vec::new(),
        },
        origin: Point::zeros() - origin / scale,
        scale,
    }
}

/// The colour of a texel, not multiplied by its alpha.
fn straight(texture: &Texture, i: usize) -> [u8; 4] {
    let [width, _] = texture.size();
    let (x, y) = ((i % width) as f32 + 0.5, (i / width) as f32 + 0.5);
    let [r, g, b, a] = texture.sample(x, y);
    let divided = |c: f32| (c * 255.0 / a.max(1.0)).round().min(255.0) as u8;
    [divided(r), divided(g), divided(b), a.round() as u8]
}

/// The lowest and the highest corner.
fn outline_box(points: &[Point]) -> [Point; 2] {
    let (low, high) = inbetween::math::point::bounding_box(points).unwrap_or_default();
    [low, high]
}

/// A picture as a PNG file.
pub(super) fn png(texture: &PuppetTexture) -> Result<Vec<u8>, Refusal> {
    texture_png(texture).map_err(Refusal::failed)
}
