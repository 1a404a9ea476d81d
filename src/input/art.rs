//! A drawing as curves: an SVG file's elements in drawing order, ready to be carried by a mesh.
//!
//! Everything is resolved: transforms are applied, shapes are cubics, styles are computed, groups are flattened. An
//! element's id is its own, or that of the nearest group around it that has one; a second element with the same id is
//! `id/2`, and so on in document order, so that a group of several paths corresponds child by child to a group of the same
//! name in another drawing.

use super::{Fill, Stroke};
use super::{Paint, Placement, Subpath};
use crate::math::Point;

/// A drawing as curves, in user units: the coordinates of [`Drawing::outline`](super::Drawing::outline).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Art {
    /// From back to front.
    pub elements: Vec<ArtElement>,
}

/// A path with its style.
#[derive(Debug, Clone, PartialEq)]
pub struct ArtElement {
    /// Its name in the file, or that of the group around it; unique in the drawing.
    pub id: Option<String>,
    /// The path's pieces.
    pub subpaths: Vec<Subpath>,
    /// The inside, drawn before the stroke.
    pub fill: Option<Fill>,
    /// The line.
    pub stroke: Option<Stroke>,
    /// Of fill and stroke together, in [0, 1]; groups' opacities are multiplied in. 0 for what is hidden.
    pub opacity: f64,
}

impl Art {
    /// The drawing reflected left to right: x becomes `axis - x`.
    #[must_use]
    pub fn mirrored(&self, axis: f64) -> Self {
        self.mapped(&Placement {
            along_x: Point::new(-1.0, 0.0),
            along_y: Point::new(0.0, 1.0),
            origin: Point::new(axis, 0.0),
        })
    }

    /// The drawing moved by `shift`.
    #[must_use]
    pub fn moved(&self, shift: Point) -> Self {
        self.mapped(&Placement {
            along_x: Point::new(1.0, 0.0),
            along_y: Point::new(0.0, 1.0),
            origin: shift,
        })
    }

    /// The drawing with every point and gradient mapped. Widths and dashes of strokes stay.
    fn mapped(&self, map: &Placement) -> Self {
        Self {
            elements: self.elements.iter().map(|element| element.mapped(map)).collect(),
        }
    }
}

impl ArtElement {
    fn mapped(&self, map: &Placement) -> Self {
        let mut element = self.clone();
        for subpath in &mut element.subpaths {
            subpath.start = map.place(subpath.start);
            for p in subpath.cubics.iter_mut().flatten() {
                *p = map.place(*p);
            }
        }
        let fill = element.fill.iter_mut().map(|fill| &mut fill.paint);
        let stroke = element.stroke.iter_mut().map(|stroke| &mut stroke.paint);
        for paint in fill.chain(stroke) {
            if let Paint::Gradient(gradient) = paint {
                gradient.placement = map.after(&gradient.placement);
            }
        }
        element
    }
}

impl Placement {
    /// The map that moves nothing.
    pub const IDENTITY: Self = Self {
        along_x: Point::new(1.0, 0.0),
        along_y: Point::new(0.0, 1.0),
        origin: Point::new(0.0, 0.0),
    };

    /// Where a point goes.
    #[must_use]
    pub fn place(&self, p: Point) -> Point {
        self.along_x * p.x + self.along_y * p.y + self.origin
    }

    /// Where a displacement goes.
    #[must_use]
    pub fn turn(&self, direction: Point) -> Point {
        self.along_x * direction.x + self.along_y * direction.y
    }

    /// First `first`, then this map.
    #[must_use]
    pub fn after(&self, first: &Self) -> Self {
        Self {
            along_x: self.turn(first.along_x),
            along_y: self.turn(first.along_y),
            origin: self.place(first.origin),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::{Gradient, GradientKind, Spread, Stop};

    #[test]
    fn mirroring_moves_curves_and_gradients_alike_and_twice_is_nothing() {
        let placement = Placement {
            along_x: Point::new(2.0, 1.0),
            along_y: Point::new(0.0, 1.0),
            origin: Point::new(3.0, 4.0),
        };
        let art = Art {
            elements: vec![ArtElement {
                id: None,
                subpaths: vec![Subpath {
                    start: Point::new(1.0, 2.0),
                    cubics: vec![[Point::new(2.0, 2.0), Point::new(3.0, 3.0), Point::new(4.0, 0.0)]],
                    is_closed: false,
                }],
                fill: Some(Fill {
                    paint: Paint::Gradient(Gradient {
                        kind: GradientKind::Linear,
                        placement,
                        spread: Spread::Pad,
                        stops: vec![Stop {
                            offset: 0.0,
                            colour: [1.0; 4],
                        }],
                    }),
                    rule: Default::default(),
                }),
                stroke: None,
                opacity: 1.0,
            }],
        };
        let once = art.mirrored(10.0);
        assert_eq!(once.elements[0].subpaths[0].start, Point::new(9.0, 2.0));
        let Some(Paint::Gradient(gradient)) = once.elements[0].fill.as_ref().map(|fill| &fill.paint) else {
            panic!("a gradient");
        };
        let of_gradient = Point::new(0.5, 0.25);
        let before = placement.place(of_gradient);
        assert_eq!(
            gradient.placement.place(of_gradient),
            Point::new(10.0 - before.x, before.y)
        );
        assert_eq!(once.mirrored(10.0), art);
    }
}
