//! One frame from one blended mesh.
//!
//! 1. The colours: each pixel's centre (with supersampling, each of K x K samples) lies in at most one triangle of the
//!    mesh. There the textures are looked up through the triangle's affine map, one bilinear look-up each, and averaged
//!    with the texture weights, premultiplied.
//! 2. The edge: the exact area of each pixel inside the blended outline.
//! 3. Pixels inside the outline that no sample reached (less than a sample beyond the mesh, or under a fold) take the
//!    nearest colour.
//! 4. A pixel at the edge is colour times area.
//!
//! The frame is painted in bands of rows, in parallel. A band is painted row by row across all triangles, which reads textures
//! in long runs; each pixel is written once, by integers alone, so the bands do not show. Most pixels are wholly
//! inside and are never multiplied by an area.
//!
//! Cost: #samples inside times #textures that count there, #edges of the outline, #triangles a band.

use std::sync::Arc;

use rayon::prelude::*;

use super::band::{BAND_ROWS, Band, BandPainter, Shown, Window, fill_unreached};
use super::colour_blend::{ColourBlend, Linear, Plain};
use super::coverage::edges;
use super::nearest_texel::{NearestTexture, paint_nearest};
use super::raster::PlacedVertices;
use super::sampler::whole_weights;
use super::{Camera, Frame, Silhouette, Texture};
use crate::math::Point;
use crate::mesh::geometry;
use crate::pose::{Mapping, TextureMesh};

/// A texture that counts for less than this changes no channel by half a step and is not looked up.
const FAINTEST_WEIGHT: f64 = 1e-3;
/// A texture and the pose on whose drawing it was made.
#[derive(Debug, Clone)]
pub struct PoseTexture {
    /// The texture.
    pub texture: Texture,
    /// The pose whose positions are places of its picture.
    pub drawn_on: usize,
}

/// How a painter paints.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct PaintOptions {
    /// How colours are averaged. Default: [`ColourBlend::Plain`].
    pub blending: ColourBlend,
    /// Colour samples along a pixel's side, 1 to [`PaintOptions::MOST_SAMPLES`]; others are moved there. More show finer
    /// detail where the mesh is turned or squeezed, and take longer; textures should be made for as many
    /// ([`Texture::new`]). The edge is exact with any. Default: 1. [`Sampling::Nearest`] looks at one.
    pub supersample: usize,
    /// How colours are taken from textures. Default: [`Sampling::Smooth`].
    pub sampling: Sampling,
}

/// How colours are taken from textures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Sampling {
    /// Interpolated between texels; the outline is anti-aliased.
    #[default]
    Smooth,
    /// The nearest texel; a pixel is inside the figure or it is not. For pixel art.
    Nearest,
}

impl Sampling {
    /// What each is called in scene files.
    pub const NAMED: [(&'static str, Self); 2] = [("smooth", Self::Smooth), ("nearest", Self::Nearest)];
}

impl PaintOptions {
    /// The most samples along a pixel's side.
    pub const MOST_SAMPLES: usize = 4;
}

impl Default for PaintOptions {
    fn default() -> Self {
        Self {
            blending: ColourBlend::Plain,
            supersample: 1,
            sampling: Sampling::Smooth,
        }
    }
}

/// Paints frames of one character: built once, used from any number of threads.
#[derive(Debug, Clone)]
pub struct Painter {
    triangles: Vec<[usize; 3]>,
    /// What the triangles are of, where that is not the mapping's mesh itself.
    mesh: Option<Arc<TextureMesh>>,
    /// `None`: drawn on a pose that is not there.
    textures: Vec<Option<OnMesh>>,
    /// The texture that each pose shows.
    texture_of: Vec<usize>,
    silhouette: Silhouette,
    camera: Camera,
    options: PaintOptions,
}

/// By drawing of `count`, the sum of the weights of the poses that show it; `drawing_of` has the drawing of every pose.
pub(super) fn weights_of_drawings(
    count: usize,
    drawing_of: impl IntoIterator<Item = usize>,
    weights: &[f64],
) -> Vec<f64> {
    let mut sums = vec![0.0; count];
    for (drawing, weight) in drawing_of.into_iter().zip(weights) {
        if let Some(sum) = sums.get_mut(drawing) {
            *sum += weight;
        }
    }
    sums
}

/// A texture bound to the mesh.
#[derive(Debug, Clone)]
struct OnMesh {
    texture: Texture,
    /// #vertices, in texels.
    texels: Vec<Point>,
    /// How many texels the mesh covers.
    area: f64,
}

impl OnMesh {
    /// With the vertices of `triangles` at `places` of the drawing.
    fn new(texture: Texture, triangles: &[[usize; 3]], places: &[Point]) -> Self {
        let texels: Vec<Point> = places.iter().map(|p| texture.to_texels(*p)).collect();
        let area = |t: &[usize; 3]| geometry::signed_area(geometry::corners(&texels, *t));
        Self {
            area: triangles.iter().map(area).sum(),
            texels,
            texture,
        }
    }
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
        options: PaintOptions,
    ) -> Self {
        Self::registered(mapping, None, textures, texture_of, silhouette, camera, options)
    }

    /// As [`Self::new`], with the textures on a mesh that has their registration; it has the poses of the mapping.
    #[must_use]
    pub fn registered(
        mapping: &Mapping,
        mesh: Option<Arc<TextureMesh>>,
        textures: Vec<PoseTexture>,
        texture_of: Vec<usize>,
        silhouette: Silhouette,
        camera: Camera,
        options: PaintOptions,
    ) -> Self {
        let positions = mapping.poses.positions();
        let triangles = match &mesh {
            Some(mesh) => mesh.topology().triangles(),
            None => mapping.poses.topology().triangles(),
        };
        let bound = |of: PoseTexture| {
            let positions = positions.get(of.drawn_on)?;
            Some(match &mesh {
                Some(mesh) => OnMesh::new(of.texture, triangles, &mesh.on_drawing(of.drawn_on, positions)),
                None => OnMesh::new(of.texture, triangles, positions),
            })
        };
        Self {
            triangles: triangles.to_vec(),
            mesh: mesh.clone(),
            textures: textures.into_iter().map(bound).collect(),
            texture_of,
            silhouette,
            camera,
            options: PaintOptions {
                supersample: options.supersample.clamp(1, PaintOptions::MOST_SAMPLES),
                ..options
            },
        }
    }

    /// The camera.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Which texture each pose shows.
    #[must_use]
    pub fn texture_of(&self) -> &[usize] {
        &self.texture_of
    }

    /// The frame of the shape whose #vertices positions are `positions`, blended with `weights`, its textures with
    /// `texture_weights`, one a pose; those that are not positive show nothing. The background is clear.
    #[must_use]
    pub fn paint(&self, positions: &[Point], weights: &[f64], texture_weights: &[f64]) -> Frame {
        let rings = match self.options.sampling {
            Sampling::Smooth => self.silhouette.at(positions, weights),
            Sampling::Nearest => Vec::new(),
        };
        self.paint_within((positions, weights, texture_weights), (&self.triangles, false), rings)
    }

    /// A frame as of [`Self::paint`], cut out by `rings` instead of the silhouette and of some triangles of the mapping's mesh alone, which may lie over one another: from
    /// back to front.
    pub(super) fn paint_patch(
        &self,
        (positions, weights, texture_weights): (&[Point], &[f64], &[f64]),
        triangles: &[[usize; 3]],
        rings: Vec<Vec<Point>>,
    ) -> Frame {
        self.paint_within((positions, weights, texture_weights), (triangles, true), rings)
    }

    fn paint_within(
        &self,
        (positions, weights, texture_weights): (&[Point], &[f64], &[f64]),
        (triangles, in_order): (&[[usize; 3]], bool),
        rings: Vec<Vec<Point>>,
    ) -> Frame {
        let carried = self.mesh.as_ref().map(|mesh| mesh.at(positions, weights));
        let vertices = carried.as_deref().unwrap_or(positions);
        if self.options.sampling == Sampling::Nearest {
            return self.paint_nearest(vertices, texture_weights);
        }
        let [columns, rows] = self.camera.size();
        let mut frame = Frame::filled(columns, rows, [0; 4]);
        let rings: Vec<Vec<Point>> = rings
            .into_iter()
            .map(|ring| ring.into_iter().map(|p| self.camera.to_pixels(p)).collect())
            .collect();
        let Some(window) = Window::around(rings.iter().flatten(), columns, rows) else {
            return frame;
        };
        let shift = Point::new(window.left as f64, window.top as f64);
        let mut edges_of_bands = vec![Vec::new(); window.height.div_ceil(BAND_ROWS)];
        for ring in &rings {
            for edge in edges(ring) {
                let edge = edge.map(|p| p - shift);
                // Casts saturate; an edge above the window belongs to no band.
                let band = |y: f64| (y / BAND_ROWS as f64) as usize;
                let (top, bottom) = (edge[0].y.min(edge[1].y), edge[0].y.max(edge[1].y));
                let last = band(bottom).min(edges_of_bands.len() - 1);
                if bottom > 0.0 {
                    for edges in edges_of_bands.iter_mut().take(last + 1).skip(band(top)) {
                        edges.push(edge);
                    }
                }
            }
        }
        let samples = self.options.supersample as f64;
        let placed: Vec<Point> = vertices
            .iter()
            .map(|p| (self.camera.to_pixels(*p) - shift) * samples)
            .collect();
        let vertices = PlacedVertices::new(&placed);
        let shown = self.shown(&vertices, triangles, texture_weights);
        if shown.is_empty() {
            return frame;
        }
        let painter = BandPainter {
            triangles,
            in_order,
            vertices: &vertices,
            shown: &shown,
            window: &window,
            columns,
            samples: self.options.supersample,
        };
        let pixels = &mut frame.pixels[window.top * columns..(window.top + window.height) * columns];
        let bands: Vec<Band> = pixels
            .par_chunks_mut(BAND_ROWS * columns)
            .zip(&edges_of_bands)
            .enumerate()
            .map(|(band, (pixels, edges))| {
                // One texture alone is the same in either light, and most frames of an animation rest on a pose.
                if self.options.blending == ColourBlend::Plain || shown.len() == 1 {
                    painter.band(band * BAND_ROWS, pixels, edges, Plain)
                } else {
                    painter.band(band * BAND_ROWS, pixels, edges, Linear::new())
                }
            })
            .collect();
        fill_unreached(pixels, &window, columns, &bands);
        pixels
            .par_chunks_mut(BAND_ROWS * columns)
            .zip(&bands)
            .for_each(|(pixels, band)| band.cut_out(pixels));
        frame
    }

    /// The frame by nearest texels.
    fn paint_nearest(&self, positions: &[Point], texture_weights: &[f64]) -> Frame {
        let counting = self.counting(texture_weights);
        let weights: Vec<f64> = counting.iter().map(|(_, weight)| *weight).collect();
        let shown: Vec<NearestTexture<'_>> = (counting.iter().zip(whole_weights(&weights)))
            .map(|((of, _), weight)| NearestTexture {
                texture: &of.texture,
                texels: &of.texels,
                weight,
            })
            .collect();
        let placed: Vec<Point> = positions.iter().map(|p| self.camera.to_pixels(*p)).collect();
        paint_nearest(
            &self.triangles,
            &placed,
            &shown,
            self.camera.size(),
            self.options.blending,
        )
    }

    /// The textures that count, with their weights.
    fn counting(&self, texture_weights: &[f64]) -> Vec<(&OnMesh, f64)> {
        let of_textures = weights_of_drawings(self.textures.len(), self.texture_of.iter().copied(), texture_weights);
        let total: f64 = of_textures.iter().filter(|weight| **weight > 0.0).sum();
        self.textures
            .iter()
            .zip(of_textures)
            .filter_map(|(of, weight)| Some((of.as_ref()?, weight)))
            .filter(|(_, weight)| weight.is_finite() && *weight > FAINTEST_WEIGHT * total)
            .collect()
    }

    /// The textures that count, in the pictures that fit their size in the frame.
    fn shown<'a>(
        &'a self,
        vertices: &PlacedVertices,
        triangles: &[[usize; 3]],
        texture_weights: &[f64],
    ) -> Vec<Shown<'a>> {
        let counting = self.counting(texture_weights);
        let weights: Vec<f64> = counting.iter().map(|(_, weight)| *weight).collect();
        let samples = vertices.covered_area(triangles);
        counting
            .iter()
            .zip(whole_weights(&weights))
            .map(|((of, _), weight)| {
                let (level, smaller) = of.texture.level_for((of.area / samples).sqrt());
                Shown {
                    level,
                    texels: &of.texels,
                    scale: 1.0 / smaller,
                    weight,
                }
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::coverage::Coverage;
    use super::*;
    use crate::input::Picture;
    use crate::matching::Correspondence;
    use crate::mesh::Topology;
    use crate::outline::{Outline, Ring};
    use crate::pose::{Matching, PoseSet};

    /// Two drawings, a wide red and a tall blue rectangle, each in a mesh that is 2 larger on every side.
    fn painter() -> (Painter, Mapping) {
        painter_with(PaintOptions::default())
    }

    fn painter_with(options: PaintOptions) -> (Painter, Mapping) {
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
            overlaps: crate::pose::Overlaps::default(),
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
            Painter::new(&mapping, textures, vec![0, 1], silhouette, camera, options),
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
    fn samples_and_light_change_averages_and_nothing_else() {
        let options = |supersample, blending| PaintOptions {
            blending,
            supersample,
            ..PaintOptions::default()
        };
        let (plain, mapping) = painter();
        let [a, b] = [0, 1].map(|k| &mapping.poses.positions()[k]);
        let middle: Vec<Point> = a.iter().zip(b).map(|(p, q)| (p + q) * 0.5).collect();
        for supersample in [0, 1, 2, 3, 4, 99] {
            for (blending, expected) in [(ColourBlend::Plain, 128), (ColourBlend::Linear, 188)] {
                let (painter, _) = painter_with(options(supersample, blending));
                // A pose looks the same, its edge included.
                let pose = painter.paint(a, &[1.0, 0.0], &[1.0, 0.0]);
                assert!(
                    pose == plain.paint(a, &[1.0, 0.0], &[1.0, 0.0]),
                    "{supersample}, {blending:?}"
                );
                let frame = painter.paint(&middle, &[0.5, 0.5], &[0.5, 0.5]);
                let centre = frame.pixels[30 * 60 + 30];
                assert!(centre[0].abs_diff(expected) <= 1 && centre[3] == 255, "{centre:?}");
            }
        }
    }

    #[test]
    fn any_number_of_threads_paints_the_same() {
        let (painter, mapping) = painter();
        let positions = &mapping.poses.positions()[1];
        let frames = [1, 2, 5].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .expect("threads");
            pool.install(|| painter.paint(positions, &[0.3, 0.7], &[0.3, 0.7]))
        });
        assert!(frames[0] == frames[1] && frames[1] == frames[2]);
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
