//! Every stage of the pipeline as a picture, from the drawings of `data/walker` to frames.
//!
//! `cargo run --release --example stages -- FOLDER` writes `1-input.png` to `8-frames.png` there. Here the stages are called
//! one by one; `Scene::character` does the same, for every scene, in one call.

pub(crate) mod common;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use inbetween::blend::{BlendOptions, RigidBlend};
use inbetween::compatible::{CompatibleMesh, RingPoint, refine, simplify, triangulate};
use inbetween::export::png_bytes;
use inbetween::input::Drawing;
use inbetween::matching::{Correspondence, Landmark, MatchOptions, match_rings};
use inbetween::math::{Point, point};
use inbetween::outline::{ArcLength, Outline, Ring};
use inbetween::pose::PoseSet;
use inbetween::scene::Scene;
use inbetween::weights::WeightProvider;
use tiny_skia::{Color, Path as Curve, Pixmap, PixmapPaint, Transform};

use common::{Sheet, outline_of};

/// Columns and rows of one pose's cell, in pixels.
const CELL: [u32; 2] = [192, 216];
/// How many steps from one pose to another are shown.
const STEPS: usize = 5;

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("usage: stages FOLDER")?);
    std::fs::create_dir_all(&folder)?;
    let scene = Scene::open(Path::new(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/data/walker/scene.toml"
    )))?;

    let layer = scene.layer_spec(0)?;
    let drawings: Vec<Arc<Drawing>> = layer.drawn().map(|drawn| Arc::clone(&drawn.drawing)).collect();
    save(draw_input(&drawings)?, &folder, "1-input")?;

    let outlines: Vec<Outline> = drawings.iter().map(|drawing| drawing.outline.clone()).collect();
    let rings: Vec<Ring> = outlines.iter().map(|outline| outline.outer().clone()).collect();
    let curves: Vec<ArcLength> = rings.iter().map(ArcLength::new).collect();
    let (landmarks, inside) = landmarks(&scene, &curves, &outlines);
    let mut options = MatchOptions::default();
    options.reference = scene.reference;
    let matched = match_rings(&rings, &landmarks, &options)?;
    save(
        draw_matching(&curves, &matched.correspondence, matched.reference)?,
        &folder,
        "2-matching",
    )?;

    let on_outer = |t: &Option<f64>| t.map(|parameter| RingPoint { ring: 0, parameter });
    let kept: Vec<Vec<RingPoint>> = landmarks
        .iter()
        .filter_map(|l| l.at.iter().map(on_outer).collect())
        .collect();
    let simplified = simplify(&outlines, &[matched.correspondence], &kept, &scene.mesh.simplify)?;
    save(draw_polygons(&outlines, &simplified.polygons)?, &folder, "3-simplified")?;

    let (bare, _) = triangulate(&simplified.polygons, &inside)?;
    save(draw_meshes(&bare, &bare.positions)?, &folder, "4-triangulated")?;

    let (mesh, _) = refine(&bare, &scene.mesh.refine)?;
    save(draw_meshes(&mesh, &mesh.positions)?, &folder, "5-refined")?;

    let provider = scene.weights(None)?;
    save(draw_weights(&scene, &provider)?, &folder, "6-weights")?;

    let names = scene.names();
    let poses = PoseSet::new(
        mesh.topology.clone(),
        names.into_iter().zip(mesh.positions.clone()).collect(),
    )?;
    let blend = RigidBlend::new(&poses, &BlendOptions::default())?;
    let (mut scratch, mut blended) = (blend.scratch(), Vec::new());
    for weights in steps(&scene)? {
        let mut positions = Vec::new();
        blend.blend(&weights, &mut scratch, &mut positions)?;
        blended.push(positions);
    }
    save(draw_meshes(&mesh, &blended)?, &folder, "7-blended")?;

    let character = scene.character(CELL.map(|side| side as usize), 1)?;
    let mut strip = row_of(STEPS)?;
    for (step, weights) in steps(&scene)?.into_iter().enumerate() {
        strip.paste([step as u32 * CELL[0], 0], &character.frame_of(&weights)?)?;
    }
    save(strip, &folder, "8-frames")
}

/// The scene's landmarks: those on the outlines as arc-length parameters, and those inside as places.
fn landmarks(scene: &Scene, curves: &[ArcLength], outlines: &[Outline]) -> (Vec<Landmark>, Vec<Vec<Point>>) {
    let (mut on_outline, mut inside) = (Vec::new(), Vec::new());
    for landmark in &scene.landmarks {
        let places: Option<Vec<Point>> = landmark.at.iter().copied().collect();
        let deep = |(pose, place): (usize, &Point)| {
            let (_, distance) = curves[pose].nearest(*place);
            outlines[pose].contains(*place) && distance > 0.01 * outlines[pose].diagonal()
        };
        match places.filter(|places| places.iter().enumerate().all(deep)) {
            Some(places) => inside.push(places),
            None => {
                let pairs = landmark.at.iter().zip(curves);
                on_outline.push(Landmark {
                    name: landmark.name.clone(),
                    at: pairs.map(|(place, curve)| place.map(|p| curve.nearest(p).0)).collect(),
                });
            }
        }
    }
    (on_outline, inside)
}

/// Weights that lead from the wave to the jump, without the poses between them.
fn steps(scene: &Scene) -> Result<Vec<Vec<f64>>, String> {
    let pose = |name: &str| {
        let found = scene.poses.iter().position(|pose| pose.name == name);
        found.ok_or(format!("the scene has no pose '{name}'"))
    };
    let (from, to) = (pose("wave")?, pose("jump")?);
    let at_step = |step: usize| {
        let mut weights = vec![0.0; scene.poses.len()];
        weights[to] = step as f64 / (STEPS - 1) as f64;
        weights[from] = 1.0 - weights[to];
        weights
    };
    Ok((0..STEPS).map(at_step).collect())
}

fn draw_input(drawings: &[Arc<Drawing>]) -> Result<Sheet, String> {
    let mut strip = row_of(drawings.len())?;
    for (pose, drawing) in drawings.iter().enumerate() {
        let fit = Fit::new(pose, drawing.outline.outer().points());
        let picture = &drawing.picture;
        let mut pixels = Pixmap::new(picture.width as u32, picture.height as u32).ok_or("an empty picture")?;
        for (to, from) in pixels.data_mut().chunks_exact_mut(4).zip(&picture.pixels) {
            to.copy_from_slice(from);
        }
        let corner = fit.place(picture.origin);
        let scale = (fit.scale / picture.pixels_per_unit) as f32;
        let place = Transform::from_row(scale, 0.0, 0.0, scale, corner.x as f32, corner.y as f32);
        let paint = PixmapPaint {
            quality: tiny_skia::FilterQuality::Bicubic,
            ..PixmapPaint::default()
        };
        strip.pixels.draw_pixmap(0, 0, pixels.as_ref(), &paint, place, None);
        for ring in drawing.outline.rings() {
            strip.line(&fit.closed(ring.points()), 1.5, Color::from_rgba8(230, 30, 60, 255));
        }
    }
    Ok(strip)
}

/// Points of equal colour correspond.
fn draw_matching(curves: &[ArcLength], matching: &Correspondence, reference: usize) -> Result<Sheet, String> {
    const PIECES: usize = 240;
    const DOTS: usize = 24;
    const POINTS_A_PIECE: usize = 12;
    let mut strip = row_of(curves.len())?;
    for (pose, curve) in curves.iter().enumerate() {
        let sampled: Vec<Point> = (0..2048).map(|k| curve.at(k as f64 / 2048.0)).collect();
        let fit = Fit::new(pose, &sampled);
        let at = |share: f64| matching.carry(reference, pose, share.rem_euclid(1.0));
        for piece in 0..PIECES {
            let [start, end] = [piece, piece + 1].map(|k| at(k as f64 / PIECES as f64));
            let length = (end - start).rem_euclid(1.0) / POINTS_A_PIECE as f64;
            let points: Vec<Point> = (0..=POINTS_A_PIECE)
                .map(|k| fit.place(curve.at(start + length * k as f64)))
                .collect();
            strip.line(&outline_of(&points, false), 3.0, hue(piece as f64 / PIECES as f64));
        }
        for dot in 0..DOTS {
            let share = dot as f64 / DOTS as f64;
            strip.dot(fit.place(curve.at(at(share))), 3.5, hue(share));
        }
    }
    Ok(strip)
}

fn draw_polygons(outlines: &[Outline], polygons: &[Outline]) -> Result<Sheet, String> {
    let mut strip = row_of(outlines.len())?;
    for (pose, (outline, polygon)) in outlines.iter().zip(polygons).enumerate() {
        let fit = Fit::new(pose, polygon.outer().points());
        let inside = fit.closed(outline.outer().points());
        strip.fill(&inside, Color::from_rgba8(200, 208, 220, 255));
        let boundary = polygon.outer().points();
        strip.line(&fit.closed(boundary), 1.2, Color::from_rgba8(40, 40, 40, 255));
        for (vertex, p) in boundary.iter().enumerate() {
            strip.dot(fit.place(*p), 2.4, hue(vertex as f64 / boundary.len() as f64));
        }
    }
    Ok(strip)
}

/// One mesh at several positions; a triangle keeps its colour.
fn draw_meshes(mesh: &CompatibleMesh, shown: &[Vec<Point>]) -> Result<Sheet, String> {
    let mut strip = row_of(shown.len())?;
    for (cell, positions) in shown.iter().enumerate() {
        let fit = Fit::new(cell, positions);
        let triangles = mesh.topology.triangles();
        // The golden ratio spreads hues so that neighbours differ.
        for (k, corners) in triangles.iter().enumerate() {
            let curve = fit.closed(&corners.map(|v| positions[v]));
            strip.fill(&curve, pale(hue(k as f64 * 0.618_034)));
        }
        for corners in triangles {
            let curve = fit.closed(&corners.map(|v| positions[v]));
            strip.line(&curve, 0.5, Color::from_rgba8(60, 60, 60, 255));
        }
    }
    Ok(strip)
}

/// The weight of every pose over the pose space: white is 0 and less, full colour 1; lines every tenth.
fn draw_weights(scene: &Scene, provider: &dyn WeightProvider) -> Result<Sheet, Box<dyn Error>> {
    let places: Vec<Point> = scene
        .poses
        .iter()
        .map(|pose| Point::new(pose.at[0], pose.at[1]))
        .collect();
    let (low, high) = point::bounding_box(&places).ok_or("a scene without poses")?;
    let middle = (low + high) * 0.5;
    let unit = 1.7 * (high - low).max() / f64::from(CELL[0].max(CELL[1]));
    let mut strip = row_of(places.len())?;
    let mut weights = Vec::new();
    for row in 0..CELL[1] {
        for column in 0..CELL[0] {
            let from_centre = Point::new(
                f64::from(column) - 0.5 * f64::from(CELL[0]),
                f64::from(row) - 0.5 * f64::from(CELL[1]),
            );
            let place = middle + from_centre * unit;
            provider.weights(&[place.x, place.y], &mut weights)?;
            for (pose, weight) in weights.iter().enumerate() {
                let [r, g, b] = {
                    let full = hue(pose as f64 / places.len() as f64);
                    [full.red(), full.green(), full.blue()]
                };
                // Ten flat steps, whose borders are the lines of equal weight.
                let share = ((weight * 10.0).round() / 10.0).clamp(0.0, 1.0) as f32;
                let mixed = |c: f32| (255.0 * (1.0 - share + share * c)).round() as u8;
                let index = (row * strip.pixels.width() + pose as u32 * CELL[0] + column) as usize;
                let colour = tiny_skia::ColorU8::from_rgba(mixed(r), mixed(g), mixed(b), 255);
                strip.pixels.pixels_mut()[index] = colour.premultiply();
            }
        }
    }
    for pose in 0..places.len() {
        for (other, place) in places.iter().enumerate() {
            let cell = Point::new(f64::from(pose as u32 * CELL[0]), 0.0);
            let centre = Point::new(0.5 * f64::from(CELL[0]), 0.5 * f64::from(CELL[1]));
            let radius = if other == pose { 5.0 } else { 3.0 };
            strip.dot(
                cell + centre + (place - middle) * (1.0 / unit),
                radius,
                hue(other as f64 / places.len() as f64),
            );
        }
    }
    Ok(strip)
}

/// Where points go so that a pose fills its cell.
struct Fit {
    scale: f64,
    shift: Point,
}

impl Fit {
    fn new(cell: usize, points: &[Point]) -> Self {
        let (low, high) = point::bounding_box(points).unwrap_or_default();
        let size = Point::new(f64::from(CELL[0]), f64::from(CELL[1]));
        let scale = 0.92 * size.component_div(&(high - low)).min();
        let corner = Point::new(cell as f64 * size.x, 0.0);
        Self {
            scale,
            shift: corner + size * 0.5 - (low + high) * (0.5 * scale),
        }
    }

    fn place(&self, p: Point) -> Point {
        p * self.scale + self.shift
    }

    fn closed(&self, points: &[Point]) -> Option<Curve> {
        let placed: Vec<Point> = points.iter().map(|p| self.place(*p)).collect();
        outline_of(&placed, true)
    }
}

fn save(sheet: Sheet, folder: &Path, name: &str) -> Result<(), Box<dyn Error>> {
    std::fs::write(folder.join(format!("{name}.png")), png_bytes(&sheet.into_frame())?)?;
    Ok(())
}

/// A row of cells on white.
fn row_of(cells: usize) -> Result<Sheet, String> {
    Sheet::new([CELL[0] * cells as u32, CELL[1]])
}

/// A clear colour of a hue in turns.
fn hue(turns: f64) -> Color {
    let channel = |shift: f64| {
        let wave = 0.5 + 0.5 * (std::f64::consts::TAU * (turns - shift)).cos();
        (0.15 + 0.7 * wave) as f32
    };
    Color::from_rgba(channel(0.0), channel(1.0 / 3.0), channel(2.0 / 3.0), 1.0).unwrap_or(Color::BLACK)
}

/// Half way to white.
fn pale(colour: Color) -> Color {
    let half = |c: f32| 0.5 + 0.5 * c;
    Color::from_rgba(half(colour.red()), half(colour.green()), half(colour.blue()), 1.0).unwrap_or(Color::WHITE)
}
