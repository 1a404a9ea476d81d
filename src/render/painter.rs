//! One frame from one blended mesh.
//!
//! 1. The colours: the mesh is rasterised at [`SAMPLES`]^2 samples a pixel; at each, the textures are
//!    looked up through the triangle's affine map and averaged with the texture weights, premultiplied. A pixel's
//!    colour is the mean of its samples.
//! 2. The edge: the exact area of each pixel inside the blended outline.
//! 3. The pixel is colour times area. Pixels inside the outline that no sample reached (less than a sample beyond the
//!    mesh) take the mean of their neighbours.

use super::coverage::Coverage;
use super::{Camera, Frame, Silhouette, Texture, raster};
use crate::math::Point;
use crate::mesh::geometry;
use crate::pose::Mapping;

/// Colour samples along a pixel's side.
const SAMPLES: usize = 2;
/// A texture that counts for less than this changes no channel by half a step and is not looked up.
const FAINTEST_WEIGHT: f64 = 1e-3;
/// How often colours are spread by one pixel to where the outline leaves the mesh.
const SPREADS: usize = 3;

/// A texture and the pose on whose drawing it was made.
#[derive(Debug, Clone)]
pub struct PoseTexture {
    /// The texture.
    pub texture: Texture,
    /// The pose whose positions are places of its picture.
    pub drawn_on: usize,
}

/// Paints frames of one character: built once, used from any number of threads.
#[derive(Debug, Clone)]
pub struct Painter {
    triangles: Vec<[usize; 3]>,
    /// #textures x #vertices, in texels of the texture.
    texels: Vec<Vec<Point>>,
    textures: Vec<Texture>,
    /// The texture that each pose shows.
    texture_of: Vec<usize>,
    silhouette: Silhouette,
    camera: Camera,
}

impl Painter {
    /// A painter of `mapping` seen by `camera`. Each texture is drawn on one pose; `texture_of` says which texture each pose
    /// shows. Poses that show the same one (deformed copies) need no picture of their own: the mesh warps it.
    ///
    /// A texture whose pose is not in the mapping, and a pose whose texture does not exist, are not painted.
    #[must_use]
    pub fn new(
        mapping: &Mapping,
        textures: Vec<PoseTexture>,
        texture_of: Vec<usize>,
        silhouette: Silhouette,
        camera: Camera,
    ) -> Self {
        let positions = mapping.poses.positions();
        let texels = |of: &PoseTexture| {
            positions[of.drawn_on]
                .iter()
                .map(|p| of.texture.to_texels(*p))
                .collect()
        };
        let is_known = |of: &PoseTexture| of.drawn_on < positions.len();
        Self {
            triangles: mapping.poses.topology().triangles().to_vec(),
            texels: textures.iter().filter(|of| is_known(of)).map(texels).collect(),
            textures: textures.into_iter().filter(is_known).map(|of| of.texture).collect(),
            texture_of,
            silhouette,
            camera,
        }
    }

    /// The camera.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The frame of the shape whose #vertices positions are `positions`, blended with `weights`, its textures with
    /// `texture_weights`. The background is clear.
    #[must_use]
    pub fn paint(&self, positions: &[Point], weights: &[f64], texture_weights: &[f64]) -> Frame {
        let [columns, rows] = self.camera.size();
        let mut frame = Frame::filled(columns, rows, [0; 4]);
        let rings: Vec<Vec<Point>> = self
            .silhouette
            .at(positions, weights)
            .into_iter()
            .map(|ring| ring.into_iter().map(|p| self.camera.to_pixels(p)).collect())
            .collect();
        let Some(window) = Window::around(rings.iter().flatten(), columns, rows) else {
            return frame;
        };
        let shift = Point::new(window.left as f64, window.top as f64);
        let rings: Vec<Vec<Point>> = rings
            .into_iter()
            .map(|r| r.into_iter().map(|p| p - shift).collect())
            .collect();
        let coverage = Coverage::of(rings.iter().map(Vec::as_slice), window.width, window.height);
        let placed: Vec<Point> = positions.iter().map(|p| self.camera.to_pixels(*p) - shift).collect();
        let mut colours = self.colours(&placed, texture_weights, window.width, window.height);
        spread(&mut colours, &coverage);
        for (i, (colour, area)) in colours.iter().zip(coverage.areas()).enumerate() {
            if *area > 0.0 && colour.count > 0.0 {
                let (x, y) = (window.left + i % window.width, window.top + i / window.width);
                frame.pixels[y * columns + x] = colour.sum.map(|c| (c / colour.count * area + 0.5) as u8);
            }
        }
        frame
    }

    fn colours(&self, placed: &[Point], texture_weights: &[f64], width: usize, height: usize) -> Vec<Mean> {
        let mut colours = vec![Mean::default(); width * height];
        let mut of_textures = vec![0.0; self.textures.len()];
        for (texture, weight) in self.texture_of.iter().zip(texture_weights) {
            if let Some(sum) = of_textures.get_mut(*texture) {
                *sum += weight;
            }
        }
        let counting: Vec<(usize, f32)> = of_textures
            .iter()
            .enumerate()
            .filter(|(_, weight)| weight.abs() >= FAINTEST_WEIGHT)
            .map(|(texture, weight)| (texture, *weight as f32))
            .collect();
        let total: f32 = counting.iter().map(|(_, weight)| weight).sum();
        let samples: Vec<Point> = placed.iter().map(|p| p * SAMPLES as f64).collect();
        let mut maps: Vec<AffineMap> = Vec::new();
        let mut mapped_triangle = usize::MAX;
        raster::for_each_span(&self.triangles, &samples, width * SAMPLES, height * SAMPLES, |span| {
            if span.triangle != mapped_triangle {
                mapped_triangle = span.triangle;
                let corners = self.triangles[span.triangle];
                maps.clear();
                maps.extend(counting.iter().map(|(texture, _)| {
                    AffineMap::between(
                        geometry::corners(&samples, corners),
                        geometry::corners(&self.texels[*texture], corners),
                    )
                }));
            }
            let row = &mut colours[span.row / SAMPLES * width..(span.row / SAMPLES + 1) * width];
            for column in span.start..span.end {
                row[column / SAMPLES].count += 1.0;
            }
            for ((texture, weight), map) in counting.iter().zip(&maps) {
                let texture = &self.textures[*texture];
                let weight = weight / total;
                let start = map.apply(Point::new(span.start as f64 + 0.5, span.row as f64 + 0.5));
                let (u, v) = (start.x as f32, start.y as f32);
                let (du, dv) = (map.along_x.x as f32, map.along_x.y as f32);
                for column in span.start..span.end {
                    let steps = (column - span.start) as f32;
                    let colour = texture.sample(u + steps * du, v + steps * dv);
                    let sum = &mut row[column / SAMPLES].sum;
                    for (s, c) in sum.iter_mut().zip(colour) {
                        *s += weight * c;
                    }
                }
            }
        });
        colours
    }
}

/// The samples of a pixel added up.
#[derive(Debug, Clone, Copy, Default)]
struct Mean {
    sum: [f32; 4],
    count: f32,
}

/// The part of the frame that a shape touches.
struct Window {
    left: usize,
    top: usize,
    width: usize,
    height: usize,
}

impl Window {
    fn around<'a>(points: impl Iterator<Item = &'a Point>, columns: usize, rows: usize) -> Option<Self> {
        let (low, high) = crate::math::point::bounding_box(points.filter(|p| crate::math::point::is_finite(**p)))?;
        // Casts saturate, so a shape far outside gives an empty window.
        let left = low.x.floor().max(0.0) as usize;
        let top = low.y.floor().max(0.0) as usize;
        let width = (high.x.ceil().max(0.0) as usize).min(columns).saturating_sub(left);
        let height = (high.y.ceil().max(0.0) as usize).min(rows).saturating_sub(top);
        (width > 0 && height > 0).then_some(Self {
            left,
            top,
            width,
            height,
        })
    }
}

/// The affine map that takes one triangle to another.
struct AffineMap {
    along_x: Point,
    along_y: Point,
    shift: Point,
}

impl AffineMap {
    fn between(from: [Point; 3], to: [Point; 3]) -> Self {
        // Rasterised triangles have area; one that rounding alone made positive maps to its corner.
        let inverse = geometry::edge_matrix(from)
            .try_inverse()
            .unwrap_or_else(crate::math::Matrix::zeros);
        let linear = geometry::edge_matrix(to) * inverse;
        Self {
            along_x: linear.column(0).into_owned(),
            along_y: linear.column(1).into_owned(),
            shift: to[0] - linear * from[0],
        }
    }

    fn apply(&self, p: Point) -> Point {
        self.along_x * p.x + self.along_y * p.y + self.shift
    }
}

/// Gives pixels inside the outline without a sample the mean of their neighbours'.
fn spread(colours: &mut [Mean], coverage: &Coverage) {
    let (width, height) = (coverage.width(), coverage.height());
    for _ in 0..SPREADS {
        let mut found = Vec::new();
        for (i, _) in colours
            .iter()
            .enumerate()
            .filter(|(i, c)| c.count == 0.0 && coverage.areas()[*i] > 0.0)
        {
            let (x, y) = (i % width, i / width);
            let mut mean = Mean::default();
            for ny in y.saturating_sub(1)..(y + 2).min(height) {
                for nx in x.saturating_sub(1)..(x + 2).min(width) {
                    let neighbour = colours[ny * width + nx];
                    if neighbour.count > 0.0 {
                        mean.count += 1.0;
                        for (s, c) in mean.sum.iter_mut().zip(neighbour.sum) {
                            *s += c / neighbour.count;
                        }
                    }
                }
            }
            if mean.count > 0.0 {
                found.push((i, mean));
            }
        }
        for (i, mean) in found {
            colours[i] = mean;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::Picture;
    use crate::matching::Correspondence;
    use crate::mesh::Topology;
    use crate::outline::{Outline, Ring};
    use crate::pose::{Matching, PoseSet};

    /// Two drawings, a wide red and a tall blue rectangle, each in a mesh that is 2 larger on every side.
    fn painter() -> (Painter, Mapping) {
        let boxes = [[10.0, 20.0, 50.0, 40.0], [20.0, 10.0, 40.0, 50.0]];
        let corner = |[l, t, r, b]: [f64; 4], by: f64| {
            [[l - by, t - by], [r + by, t - by], [r + by, b + by], [l - by, b + by]]
                .map(Point::from)
                .to_vec()
        };
        let outlines: Vec<Outline> = boxes
            .iter()
            .map(|b| Outline::new(Ring::new(corner(*b, 0.0)).expect("a ring"), vec![]).expect("simple"))
            .collect();
        let poses = boxes
            .iter()
            .enumerate()
            .map(|(k, b)| (format!("p{k}"), corner(*b, 2.0)))
            .collect();
        let mapping = Mapping {
            poses: PoseSet::new(Topology::new(4, vec![[0, 1, 2], [0, 2, 3]]).expect("a mesh"), poses).expect("poses"),
            outlines,
            rings: vec![vec![0, 1, 2, 3]],
            steiner: 0,
            matching: Matching {
                reference: 0,
                // Corners correspond, although the sides have different lengths.
                outer: Correspondence::new(vec![
                    vec![0.0, 0.0],
                    vec![1.0 / 3.0, 1.0 / 6.0],
                    vec![0.5, 0.5],
                    vec![5.0 / 6.0, 2.0 / 3.0],
                ])
                .expect("monotone"),
            },
        };
        let textures = [[255, 0, 0, 255], [0, 0, 255, 255]]
            .iter()
            .zip(&mapping.outlines)
            .enumerate()
            .map(|(drawn_on, (colour, outline))| {
                let areas = Coverage::of([outline.outer().points()], 60, 60);
                let picture = Picture {
                    width: 60,
                    height: 60,
                    pixels: areas
                        .areas()
                        .iter()
                        .map(|a| if *a > 0.5 { *colour } else { [0; 4] })
                        .collect(),
                    origin: Point::zeros(),
                    pixels_per_unit: 1.0,
                };
                PoseTexture {
                    texture: Texture::new(&picture, outline, 1.0),
                    drawn_on,
                }
            })
            .collect();
        let camera = Camera::fitting(&[Point::new(0.0, 0.0), Point::new(60.0, 60.0)], [60, 60]);
        let silhouette = Silhouette::new(&mapping);
        (
            Painter::new(&mapping, textures, vec![0, 1], silhouette, camera),
            mapping,
        )
    }

    #[test]
    fn a_pose_is_its_drawing_with_an_edge_of_full_colour() {
        let (painter, mapping) = painter();
        let frame = painter.paint(&mapping.poses.positions()[0], &[1.0, 0.0], &[1.0, 0.0]);
        let area: f64 = frame.pixels.iter().map(|p| f64::from(p[3]) / 255.0).sum();
        let expected = 800.0 * painter.camera().scale().powi(2);
        assert!((area - expected).abs() < 2.0, "{area} for {expected}");
        // Premultiplied red: as much red as alpha, nothing else, at every pixel.
        assert!(frame.pixels.iter().all(|p| p[0] == p[3] && p[1] == 0 && p[2] == 0));
    }

    #[test]
    fn halfway_the_colours_mix_and_the_edge_stays_crisp() {
        let (painter, mapping) = painter();
        let [a, b] = [0, 1].map(|k| &mapping.poses.positions()[k]);
        let middle: Vec<Point> = a.iter().zip(b).map(|(p, q)| (p + q) * 0.5).collect();
        let frame = painter.paint(&middle, &[0.5, 0.5], &[0.5, 0.5]);
        let centre = frame.pixels[30 * 60 + 30];
        assert!(
            centre[0].abs_diff(128) <= 1 && centre[2].abs_diff(128) <= 1 && centre[3] == 255,
            "{centre:?}"
        );
        // A blend of alphas would leave a wide half-clear rim; here at most the pixels on the four sides are.
        let partly = frame.pixels.iter().filter(|p| p[3] > 0 && p[3] < 255).count();
        assert!(partly <= 4 * 32, "{partly}");
    }

    #[test]
    fn a_copy_shows_the_picture_of_the_pose_it_copies() {
        let (mut painter, mapping) = painter();
        // As if the tall box were a deformed copy of the wide one.
        painter.texture_of = vec![0, 0];
        for weights in [[0.0, 1.0], [0.5, 0.5]] {
            let frame = painter.paint(&mapping.poses.positions()[1], &[0.0, 1.0], &weights);
            assert!(frame.pixels.iter().all(|p| p[0] == p[3] && p[2] == 0), "red only");
            assert_eq!(frame.pixels[30 * 60 + 30], [255, 0, 0, 255]);
        }
    }

    #[test]
    fn a_shape_outside_the_frame_paints_nothing() {
        let (painter, mapping) = painter();
        for shift in [1e5, 1e300, f64::NAN] {
            let far: Vec<Point> = mapping.poses.positions()[0]
                .iter()
                .map(|p| p + Point::new(shift, shift))
                .collect();
            let frame = painter.paint(&far, &[1.0, 0.0], &[1.0, 0.0]);
            assert!(frame.pixels.iter().all(|p| p[3] == 0));
        }
    }
}
