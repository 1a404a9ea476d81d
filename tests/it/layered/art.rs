//! Layered art for tests, whatever the format that it is written in.

/// A layer or group.
#[derive(Debug, Clone)]
pub(crate) struct Node {
    pub(crate) name: String,
    pub(crate) is_visible: bool,
    pub(crate) opacity: u8,
    pub(crate) is_multiplied: bool,
    pub(crate) is_clipped: bool,
    /// Of a group: what is in it lies directly on what is behind it.
    pub(crate) passes_through: bool,
    pub(crate) mask: Option<Patch<u8>>,
    pub(crate) content: Content,
}

/// What is in it.
#[derive(Debug, Clone)]
pub(crate) enum Content {
    /// Straight pixels.
    Pixels(Patch<[u8; 4]>),
    /// From back to front.
    Group(Vec<Node>),
}

/// A rectangle of values, which may lie partly outside of the canvas.
#[derive(Debug, Clone)]
pub(crate) struct Patch<T> {
    pub(crate) left: i32,
    pub(crate) top: i32,
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) values: Vec<T>,
}

impl<T> Patch<T> {
    pub(crate) fn new([left, top]: [i32; 2], [width, height]: [u32; 2], value: impl Fn(i32, i32) -> T) -> Self {
        let places = (0..height as i32).flat_map(|y| (0..width as i32).map(move |x| (x, y)));
        Self {
            left,
            top,
            width,
            height,
            values: places.map(|(x, y)| value(left + x, top + y)).collect(),
        }
    }
}

impl Node {
    pub(crate) fn layer(name: &str, patch: Patch<[u8; 4]>) -> Self {
        Self {
            name: name.to_owned(),
            is_visible: true,
            opacity: 255,
            is_multiplied: false,
            is_clipped: false,
            passes_through: false,
            mask: None,
            content: Content::Pixels(patch),
        }
    }

    pub(crate) fn group(name: &str, children: Vec<Self>) -> Self {
        Self {
            content: Content::Group(children),
            ..Self::layer(name, Patch::new([0, 0], [0, 0], |_, _| [0; 4]))
        }
    }
}

/// The canvas of the figure.
pub(crate) const SIZE: [u32; 2] = [96, 72];

/// An ellipse with smooth edges, shaded so that every pixel's colour is its own.
pub(crate) fn ellipse(centre: [f64; 2], radii: [f64; 2], colour: [u8; 3]) -> Patch<[u8; 4]> {
    let low = [0, 1].map(|k| (centre[k] - radii[k]).floor() as i32 - 1);
    let side = [0, 1].map(|k| (2.0 * radii[k]).ceil() as u32 + 3);
    Patch::new(low, side, |x, y| {
        let away = [f64::from(x) + 0.5 - centre[0], f64::from(y) + 0.5 - centre[1]];
        let within = 1.0 - (away[0] / radii[0]).hypot(away[1] / radii[1]);
        let coverage = (within * radii[0].min(radii[1]) + 0.5).clamp(0.0, 1.0);
        let [red, green, blue] = colour;
        let alpha = (coverage * 255.0).round() as u8;
        if alpha == 0 {
            return [0; 4];
        }
        [red ^ (x & 7) as u8, green ^ (y & 7) as u8, blue, alpha]
    })
}

/// A body with an arm in front of it in three poses, each pose a group of parts.
pub(crate) fn poses() -> Vec<Node> {
    let pose = |name: &str, shift: f64, hand: [f64; 2]| {
        let body = ellipse([40.0 + shift, 38.0], [20.0, 24.0 + shift / 2.0], [200, 60, 40]);
        let arm = ellipse(hand, [16.0, 7.0], [40, 80, 190]);
        Node::group(name, vec![Node::layer("body", body), Node::layer("arm", arm)])
    };
    vec![
        pose("stand", 0.0, [58.0, 40.0]),
        pose("lean", 6.0, [66.0, 30.0]),
        pose("wave", 3.0, [62.0, 20.0]),
    ]
}
