//! What the rigid blend is good for, against what could be done instead, from the scenes in `data`.
//!
//! `cargo run --release --example blending -- FOLDER` writes three pictures there, after figures 3, 4 and 1 of "N-way
//! morphing for 2D animation":
//!
//! - `linear-against-rigid.png`: in-betweens whose vertices move along straight lines, and those of
//!   [`RigidBlend`](inbetween::blend::RigidBlend).
//! - `shear-limiting.png`: poses beyond the drawings, with each [`Stretch`](inbetween::blend::Stretch).
//! - `morphing-against-deformation.png`: one drawing bent towards another by handles, and the morph between the two.

pub(crate) mod common;
#[path = "common/palette.rs"]
pub(crate) mod palette;

use std::error::Error;
use std::path::{Path, PathBuf};

use inbetween::blend::{BlendOptions, RigidBlend, Stretch};
use inbetween::math::{Point, point};
use inbetween::pipeline::{LayerSpec, map_layer};
use inbetween::pose::{HandleDeformation, Mapping};
use inbetween::render::{Camera, Frame, PaintOptions, Painter, PoseTexture, Silhouette, Texture};
use inbetween::scene::Scene;
use inbetween::texture::texture_weights;
use tiny_skia::Color;

use common::{Sheet, outline_of};
use palette::png_with_palette;

/// Columns of one shape's cell, in pixels.
const CELL_WIDTH: u32 = 184;
/// How many steps from one pose to another are shown.
const STEPS: usize = 5;

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("usage: blending FOLDER")?);
    std::fs::create_dir_all(&folder)?;
    let [walker, snake, face] = [Cast::read("walker")?, Cast::read("snake")?, Cast::read("face")?];
    save(linear_against_rigid(&snake, &walker)?, &folder, "linear-against-rigid")?;
    save(shear_limiting(&face)?, &folder, "shear-limiting")?;
    let sheet = morphing_against_deformation(&walker)?;
    save(sheet, &folder, "morphing-against-deformation")
}

/// Of each of two characters a row of linear in-betweens and a row of rigid ones.
fn linear_against_rigid(snake: &Cast, walker: &Cast) -> Result<Sheet, Box<dyn Error>> {
    let shown = [(snake, ["straight", "coil"], 106), (walker, ["stand", "jump"], 202)];
    let mut sheet = Sheet::new([
        CELL_WIDTH * STEPS as u32,
        shown.iter().map(|(_, _, height)| 2 * height).sum(),
    ])?;
    let mut top = 0;
    for (cast, [from, to], height) in shown {
        let rigid = cast.blend(Stretch::default())?;
        let [mut by_line, mut by_rotation] = [Vec::new(), Vec::new()];
        for step in 0..STEPS {
            let share = step as f64 / (STEPS - 1) as f64;
            let weights = cast.weights(&[(from, 1.0 - share), (to, share)])?;
            by_line.push(Shape::linear(cast, &weights));
            by_rotation.push(Shape::rigid(&rigid, &weights)?);
        }
        top = cast.paint_rows(&mut sheet, top, height, &[by_line, by_rotation])?;
    }
    Ok(sheet)
}

/// A row for each way of blending stretches; from left to right further and further beyond the drawings.
fn shear_limiting(face: &Cast) -> Result<Sheet, Box<dyn Error>> {
    const BEYOND: [f64; 5] = [1.0, 1.2, 1.4, 1.6, 1.8];
    const HEIGHT: u32 = 150;
    let mut rows = Vec::new();
    for stretch in [Stretch::Linear, Stretch::Limited, Stretch::Log] {
        let blend = face.blend(stretch)?;
        let row: Result<Vec<Shape>, Box<dyn Error>> = (BEYOND.iter())
            .map(|weight| {
                Shape::rigid(
                    &blend,
                    &face.weights(&[("calm_left", 1.0 - weight), ("calm_right", *weight)])?,
                )
            })
            .collect();
        rows.push(row?);
    }
    let mut sheet = Sheet::new([CELL_WIDTH * BEYOND.len() as u32, HEIGHT * rows.len() as u32])?;
    face.paint_rows(&mut sheet, 0, HEIGHT, &rows)?;
    Ok(sheet)
}

/// Two rows, one a drawing to be reached, whose outline is drawn over everything: the drawing that is deformed, deformed by few
/// handles, deformed by many, and the morph.
fn morphing_against_deformation(walker: &Cast) -> Result<Sheet, Box<dyn Error>> {
    const SOURCE: &str = "stand";
    const TARGETS: [&str; 2] = ["jump", "stride_left"];
    const FEW: [&str; 4] = ["left_crease", "right_crease", "left_cap", "right_cap"];
    const MORE: [&str; 7] = [
        "nose",
        "left_sleeve_middle",
        "right_sleeve_middle",
        "left_hem_end",
        "right_hem_end",
        "left_knee_middle",
        "right_knee_middle",
    ];
    const HEIGHT: u32 = 218;
    const COLUMNS: usize = 4;
    let many: Vec<&str> = FEW.into_iter().chain(MORE).collect();
    let mut sheet = Sheet::new([CELL_WIDTH * COLUMNS as u32, HEIGHT * TARGETS.len() as u32])?;
    for (row, target) in TARGETS.into_iter().enumerate() {
        let source = walker.weights(&[(SOURCE, 1.0)])?;
        let mut shapes = vec![Shape::linear(walker, &source)];
        let mut dots = vec![Vec::new()];
        for handles in [FEW.as_slice(), &many] {
            let [from, to] = [walker.places(SOURCE, handles)?, walker.places(target, handles)?];
            let rest = &walker.mapping.poses.positions()[walker.pose(SOURCE)?];
            let deformation = HandleDeformation::new(walker.mapping.poses.topology(), rest, &from)?;
            let mut positions = Vec::new();
            deformation.drag(&to, &mut deformation.scratch(), &mut positions)?;
            shapes.push(Shape {
                positions,
                weights: source.clone(),
            });
            dots.push(to);
        }
        let blend = walker.blend(Stretch::default())?;
        shapes.push(Shape::rigid(&blend, &walker.weights(&[(target, 1.0)])?)?);
        dots.push(Vec::new());

        let outline = walker.mapping.outlines[walker.pose(target)?].outer().points();
        let silhouettes: Vec<Point> = shapes.iter().flat_map(|shape| walker.edge(shape)).collect();
        let camera = Camera::fitting(
            silhouettes.iter().chain(outline),
            [CELL_WIDTH as usize, HEIGHT as usize],
        );
        let painter = walker.painter(camera);
        for (column, (shape, dots)) in shapes.iter().zip(&dots).enumerate() {
            let corner = [column as u32 * CELL_WIDTH, row as u32 * HEIGHT];
            sheet.paste(corner, &walker.paint(&painter, shape)?)?;
            let shift = Point::new(f64::from(corner[0]), f64::from(corner[1]));
            let placed: Vec<Point> = outline.iter().map(|p| camera.to_pixels(*p) + shift).collect();
            sheet.line(&outline_of(&placed, true), 1.3, Color::from_rgba8(225, 0, 190, 255));
            for dot in dots {
                sheet.dot(camera.to_pixels(*dot) + shift, 2.4, Color::from_rgba8(20, 20, 20, 255));
            }
        }
    }
    Ok(sheet)
}

fn save(sheet: Sheet, folder: &Path, name: &str) -> Result<(), Box<dyn Error>> {
    let bytes = png_with_palette(&sheet.into_frame())?;
    Ok(std::fs::write(folder.join(format!("{name}.png")), bytes)?)
}

/// A shape to be painted.
struct Shape {
    /// #vertices.
    positions: Vec<Point>,
    /// How much each pose counts in it.
    weights: Vec<f64>,
}

impl Shape {
    /// Every vertex at the mean of its places.
    fn linear(cast: &Cast, weights: &[f64]) -> Self {
        let poses = cast.mapping.poses.positions();
        let mean = |vertex: usize| poses.iter().zip(weights).map(|(pose, w)| pose[vertex] * *w).sum();
        Self {
            positions: (0..cast.mapping.poses.topology().vertex_count()).map(mean).collect(),
            weights: weights.to_vec(),
        }
    }

    fn rigid(blend: &RigidBlend, weights: &[f64]) -> Result<Self, Box<dyn Error>> {
        let mut positions = Vec::new();
        blend.blend(weights, &mut blend.scratch(), &mut positions)?;
        Ok(Self {
            positions,
            weights: weights.to_vec(),
        })
    }
}

/// A scene that is read and mapped.
struct Cast {
    scene: Scene,
    layer: LayerSpec,
    mapping: Mapping,
    silhouette: Silhouette,
}

impl Cast {
    /// Reads `data/NAME/scene.toml`.
    fn read(name: &str) -> Result<Self, Box<dyn Error>> {
        let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("data");
        let scene = Scene::open(&data.join(name).join("scene.toml"))?;
        let layer = scene.layer_spec(0)?;
        let (mapping, _) = map_layer(&layer)?;
        Ok(Self {
            silhouette: Silhouette::new(&mapping),
            scene,
            layer,
            mapping,
        })
    }

    fn pose(&self, name: &str) -> Result<usize, String> {
        let found = self.mapping.poses.index_of(name);
        found.ok_or(format!("the scene has no pose '{name}'"))
    }

    /// The given weights of the given poses, 0 for the others.
    fn weights(&self, given: &[(&str, f64)]) -> Result<Vec<f64>, String> {
        let mut weights = vec![0.0; self.mapping.poses.len()];
        for (name, weight) in given {
            weights[self.pose(name)?] = *weight;
        }
        Ok(weights)
    }

    /// Where the named points, which are known beside the scene, are in a drawing.
    fn places(&self, pose: &str, points: &[&str]) -> Result<Vec<Point>, Box<dyn Error>> {
        let known = std::fs::read_to_string(self.scene.file.with_file_name("truth.toml"))?;
        let known: toml::Table = known.parse()?;
        let known = known.get("landmark").and_then(toml::Value::as_array);
        let place = |name: &&str| -> Option<Point> {
            let point = (known?.iter()).find(|point| point.get("name").and_then(toml::Value::as_str) == Some(*name))?;
            let at = point.get("at")?.get(pose)?.as_array()?;
            Some(Point::new(at.first()?.as_float()?, at.get(1)?.as_float()?))
        };
        let place = |name: &&str| place(name).ok_or_else(|| format!("no point '{name}' is known there").into());
        points.iter().map(place).collect()
    }

    fn blend(&self, stretch: Stretch) -> Result<RigidBlend, Box<dyn Error>> {
        let mut options = BlendOptions::default();
        options.stretch = stretch;
        options.turns = self.scene.poses.iter().map(|pose| pose.turns).collect();
        Ok(RigidBlend::new(&self.mapping.poses, &options)?)
    }

    /// The outer edge of a shape.
    fn edge(&self, shape: &Shape) -> Vec<Point> {
        let rings = self.silhouette.at(&shape.positions, &shape.weights);
        rings.into_iter().next().unwrap_or_default()
    }

    fn painter(&self, camera: Camera) -> Painter {
        let drawn = self.layer.drawn_poses();
        let textures = (self.layer.drawn().zip(&drawn))
            .map(|(drawn, &drawn_on)| PoseTexture {
                texture: Texture::new(&drawn.drawing.picture, &drawn.drawing.outline, camera.scale()),
                drawn_on,
            })
            .collect();
        // A deformed copy shows the drawing that it is a copy of.
        Painter::new(
            &self.mapping,
            textures,
            self.layer.shown_drawings(),
            self.silhouette.clone(),
            camera,
            PaintOptions::default(),
        )
    }

    fn paint(&self, painter: &Painter, shape: &Shape) -> Result<Frame, Box<dyn Error>> {
        let textures = texture_weights(&shape.weights, self.scene.texture_sharpness)?;
        Ok(painter.paint(&shape.positions, &shape.weights, &textures))
    }

    /// Paints rows of shapes from `top` on, all at one scale, each in the middle of its cell; gives the bottom.
    fn paint_rows(
        &self,
        sheet: &mut Sheet,
        mut top: u32,
        height: u32,
        rows: &[Vec<Shape>],
    ) -> Result<u32, Box<dyn Error>> {
        let middle = |shape: &Shape| {
            let (low, high) = point::bounding_box(&self.edge(shape)).unwrap_or_default();
            (low + high) * 0.5
        };
        let mut shown = Vec::new();
        for shape in rows.iter().flatten() {
            let middle = middle(shape);
            shown.extend(self.edge(shape).into_iter().map(|p| p - middle));
        }
        let painter = self.painter(Camera::fitting(&shown, [CELL_WIDTH as usize, height as usize]));
        for row in rows {
            for (column, shape) in row.iter().enumerate() {
                let middle = middle(shape);
                let centred = Shape {
                    positions: shape.positions.iter().map(|p| p - middle).collect(),
                    weights: shape.weights.clone(),
                };
                sheet.paste([column as u32 * CELL_WIDTH, top], &self.paint(&painter, &centred)?)?;
            }
            top += height;
        }
        Ok(top)
    }
}
