//! What painting a frame costs, beside what drawing one texture costs elsewhere: `cargo bench --bench raster`, a minute.
//!
//! 1920 x 1080, a mesh of 510 triangles over most of the frame, four textures of 1024 to 1920 texels. In one run, so that
//! the ratios mean something on any machine:
//! - `tiny-skia`: *one* of the textures, triangle by triangle: `fill_path` with a bilinear pattern, a transform for each
//!   triangle, no anti-aliasing, into a picture that is already there;
//! - `1 thread`, `2 threads`: the painter, all four textures counting, edge and new picture included;
//! - on one thread, what else it can do: one texture, light averaged, 2 x 2 samples a pixel.

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};
use inbetween::input::Picture;
use inbetween::matching::Correspondence;
use inbetween::math::Point;
use inbetween::mesh::Topology;
use inbetween::outline::{Outline, Ring};
use inbetween::pose::{Mapping, Matching, PoseSet};
use inbetween::render::{Camera, ColourBlend, PaintOptions, Painter, PoseTexture, Silhouette, Texture};
use tiny_skia::{FillRule, FilterQuality, Paint, PathBuilder, Pattern, Pixmap, SpreadMode, Transform};

const SIZE: [usize; 2] = [1920, 1080];
/// Quads of the mesh.
const QUADS: [usize; 2] = [17, 15];
/// Texels along the longer side of each pose's texture.
const TEXELS: [usize; 4] = [1920, 1600, 1280, 1024];

fn mapping() -> Mapping {
    let [columns, rows] = QUADS.map(|quads| quads + 1);
    let vertex = |i: usize, j: usize| j * columns + i;
    let triangles = (1..rows)
        .flat_map(|j| (1..columns).map(move |i| (i, j)))
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [vertex(i - 1, j - 1), vertex(i, j - 1), vertex(i, j), vertex(i - 1, j)];
            [[a, b, c], [a, c, d]]
        })
        .collect();
    let place = |pose: usize, x: f64, y: f64| {
        let phase = pose as f64 * 1.3;
        Point::new(
            SIZE[0] as f64 * x + 25.0 * (7.0 * y + phase).sin(),
            SIZE[1] as f64 * y + 25.0 * (5.0 * x + 2.0 * phase).sin(),
        )
    };
    let poses = (0..TEXELS.len())
        .map(|pose| {
            let positions = (0..columns * rows).map(|v| {
                let (i, j) = (v % columns, v / columns);
                place(pose, i as f64 / QUADS[0] as f64, j as f64 / QUADS[1] as f64)
            });
            (format!("pose {pose}"), positions.collect())
        })
        .collect();
    // A little inside the mesh all around.
    let outline = |pose: usize| {
        let points = (0..400).map(|k| {
            let (side, t) = (k / 100, 0.005 + 0.99 * (k % 100) as f64 / 100.0);
            let (x, y) = [(t, 0.005), (0.995, t), (1.0 - t, 0.995), (0.005, 1.0 - t)][side];
            place(pose, x, y)
        });
        Outline::new(Ring::new(points).expect("a ring"), vec![]).expect("simple")
    };
    let ring = (0..columns)
        .map(|i| vertex(i, 0))
        .chain((1..rows).map(|j| vertex(columns - 1, j)))
        .chain((0..columns - 1).rev().map(|i| vertex(i, rows - 1)))
        .chain((1..rows - 1).rev().map(|j| vertex(0, j)));
    Mapping {
        poses: PoseSet::new(Topology::new(columns * rows, triangles).expect("a mesh"), poses).expect("poses"),
        outlines: (0..TEXELS.len()).map(outline).collect(),
        rings: vec![ring.collect()],
        steiner: 0,
        matching: Matching {
            reference: 0,
            outer: Correspondence::identity(TEXELS.len(), 400),
        },
        overlaps: inbetween::pose::Overlaps::default(),
    }
}

/// Waves of colour, `texels` wide, over the units of the frame and a border.
fn picture(pose: usize) -> Picture {
    let texels = TEXELS[pose];
    let border = 50.0;
    let pixels_per_unit = texels as f64 / (SIZE[0] as f64 + 2.0 * border);
    let height = ((SIZE[1] as f64 + 2.0 * border) * pixels_per_unit).ceil() as usize;
    let wave = |t: usize, u: f64| (127.5 + 127.0 * (t as f64 * u).sin()) as u8;
    Picture {
        width: texels,
        height,
        pixels: (0..texels * height)
            .map(|i| {
                let (x, y) = (i % texels, i / texels);
                [wave(x, 0.07), wave(y, 0.05), wave(x + y, 0.3), 255]
            })
            .collect(),
        origin: Point::new(-border, -border),
        pixels_per_unit,
    }
}

fn painter(mapping: &Mapping, options: PaintOptions) -> Painter {
    let shown: Vec<Point> = mapping
        .outlines
        .iter()
        .flat_map(|o| o.outer().points().to_vec())
        .collect();
    let camera = Camera::fitting(&shown, SIZE);
    let textures = (0..TEXELS.len()).map(|drawn_on| PoseTexture {
        texture: Texture::new(&picture(drawn_on), &mapping.outlines[drawn_on], camera.scale()),
        drawn_on,
    });
    let silhouette = Silhouette::new(mapping);
    Painter::new(
        mapping,
        textures.collect(),
        (0..TEXELS.len()).collect(),
        silhouette,
        camera,
        options,
    )
}

/// Draws the first texture with tiny-skia.
struct Elsewhere {
    texture: Pixmap,
    /// Corners in the frame, and the map from texels to it.
    triangles: Vec<([Point; 3], Transform)>,
}

impl Elsewhere {
    fn new(mapping: &Mapping, positions: &[Point], camera: &Camera) -> Self {
        let picture = picture(0);
        let mut texture = Pixmap::new(picture.width as u32, picture.height as u32).expect("a picture");
        texture.data_mut().copy_from_slice(picture.pixels.as_flattened());
        let triangles = mapping.poses.topology().triangles().iter().map(|corners| {
            let from = corners.map(|v| (mapping.poses.positions()[0][v] - picture.origin) * picture.pixels_per_unit);
            let to = corners.map(|v| camera.to_pixels(positions[v]));
            let edges = |[a, b, c]: [Point; 3]| inbetween::math::Matrix::from_columns(&[b - a, c - a]);
            let linear = edges(to) * edges(from).try_inverse().expect("area");
            let shift = to[0] - linear * from[0];
            let [a, b, c, d, e, f] = [
                linear[(0, 0)],
                linear[(1, 0)],
                linear[(0, 1)],
                linear[(1, 1)],
                shift.x,
                shift.y,
            ]
            .map(|v| v as f32);
            (to, Transform::from_row(a, b, c, d, e, f))
        });
        Self {
            triangles: triangles.collect(),
            texture,
        }
    }

    fn draw(&self, frame: &mut Pixmap) {
        for (corners, transform) in &self.triangles {
            let mut path = PathBuilder::new();
            let [a, b, c] = corners.map(|p| (p.x as f32, p.y as f32));
            path.move_to(a.0, a.1);
            path.line_to(b.0, b.1);
            path.line_to(c.0, c.1);
            path.close();
            let path = path.finish().expect("a path");
            let paint = Paint {
                shader: Pattern::new(
                    self.texture.as_ref(),
                    SpreadMode::Pad,
                    FilterQuality::Bilinear,
                    1.0,
                    *transform,
                ),
                anti_alias: false,
                ..Paint::default()
            };
            frame.fill_path(&path, &paint, FillRule::Winding, Transform::identity(), None);
        }
    }
}

fn frames(criterion: &mut Criterion) {
    let mapping = mapping();
    let plain = painter(&mapping, PaintOptions::default());
    let weights = [0.25; 4];
    let positions: Vec<Point> = (0..mapping.poses.topology().vertex_count())
        .map(|v| mapping.poses.positions().iter().map(|pose| pose[v]).sum::<Point>() * 0.25)
        .collect();
    let elsewhere = Elsewhere::new(&mapping, &positions, plain.camera());
    let mut picture = Pixmap::new(SIZE[0] as u32, SIZE[1] as u32).expect("a picture");

    let mut group = criterion.benchmark_group("1920 x 1080");
    group
        .sample_size(20)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(3));
    group.bench_function("tiny-skia, one texture", |b| {
        b.iter(|| elsewhere.draw(black_box(&mut picture)))
    });
    let pool = |threads: usize| {
        let builder = rayon::ThreadPoolBuilder::new().num_threads(threads);
        builder.build().expect("threads")
    };
    let four = weights;
    let one = [1.0, 0.0, 0.0, 0.0];
    let mut light = PaintOptions::default();
    light.blending = ColourBlend::Linear;
    let mut fine = PaintOptions::default();
    fine.supersample = 2;
    for (name, threads, painter, texture_weights) in [
        ("four textures, 1 thread", 1, &plain, four),
        ("four textures, 2 threads", 2, &plain, four),
        ("one texture, 1 thread", 1, &plain, one),
        (
            "four textures in linear light, 1 thread",
            1,
            &self::painter(&mapping, light),
            four,
        ),
        (
            "four textures, 2 x 2 samples, 1 thread",
            1,
            &self::painter(&mapping, fine),
            four,
        ),
    ] {
        let pool = pool(threads);
        group.bench_function(name, |b| {
            b.iter(|| pool.install(|| painter.paint(black_box(&positions), &weights, &texture_weights)));
        });
    }
    group.finish();
}

criterion_group!(benches, frames);
criterion_main!(benches);
