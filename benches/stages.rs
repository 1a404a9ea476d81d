//! What each stage costs, and what four drawings cost from their pixels to the mesh: `cargo bench`, a few minutes.
//!
//! - `stages`: matching, simplification, triangulation, refinement and one blended frame, on outlines of 100 to 2000
//!   points in 4 poses, and of 500 points in 2 to 16. The shapes are wavy discs, each pose with its own phase and depth
//!   of waves, so that matching and triangulation have real work to do.
//! - `mesh sizes`: triangulation of polygons of 50 to 400 vertices, and refinement to finer edges, both in 4 poses.
//! - `pixels to mesh`: a figure with arms and legs in 4 postures, drawn in memory, with about 1000 outline points each;
//!   the whole way, then every stage of it.
//!
//! Everything runs on one thread, so that growth is the algorithms' and not the machine's. Times of one run can be
//! compared with one another; times of different machines cannot.

use std::io::Cursor;

use brief::brief;
use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, criterion_group, criterion_main};
use image::{ImageFormat, Rgba, RgbaImage};
use inbetween::blend::{BlendOptions, RigidBlend};
use inbetween::compatible::{CompatibleMesh, RefineOptions, SimplifyOptions, refine, simplify, triangulate};
use inbetween::input::{BitmapOptions, read_bitmap};
use inbetween::matching::{MatchOptions, match_rings};
use inbetween::math::Point;
use inbetween::outline::{Outline, Ring};
use inbetween::pose::PoseSet;

#[path = "common/brief.rs"]
mod brief;

/// Outline points and poses: first the points grow, then the poses.
const SIZES: [(usize, usize); 8] = [
    (100, 4),
    (250, 4),
    (500, 4),
    (1000, 4),
    (2000, 4),
    (500, 2),
    (500, 8),
    (500, 16),
];

/// Width and height of a figure's picture in pixels.
const CANVAS: u32 = 204;
/// Pixels a unit of the figure, which stands on 180 units: its outline then has about 1000 points.
const SCALE: f64 = 204.0 / 180.0;

/// A disc whose rim has seven waves; poses differ in the depth and the place of the waves.
fn wavy(points: usize, pose: usize, poses: usize) -> Outline {
    let (depth, phase) = (0.25 + 0.21 * pose as f64 / poses as f64, 0.4 * pose as f64);
    let rim = (0..points).map(|k| {
        let angle = std::f64::consts::TAU * k as f64 / points as f64;
        let radius = 100.0 * (1.0 + depth * (7.0 * angle + phase).sin() * (0.6 + 0.4 * (angle + 0.3).cos()));
        Point::new(radius * angle.cos(), radius * angle.sin())
    });
    let ring = Ring::new(rim).expect("distinct finite points");
    Outline::new(ring, Vec::new()).expect("a star-shaped ring is simple")
}

/// The bytes of a picture of a figure whose limbs swing with the pose. Uncompressed: reading it is copying pixels.
fn figure(pose: usize) -> Vec<u8> {
    let swing = 0.35 * pose as f64;
    let towards = |from: Point, angle: f64, length: f64| from + Point::new(angle.cos(), angle.sin()) * length;
    let (neck, hip) = (Point::new(90.0, 62.0), Point::new(90.0, 105.0));
    let mut bones = vec![
        (neck, hip, 11.0),
        (Point::new(90.0, 36.0), Point::new(90.0, 40.0), 15.0),
    ];
    bones.push((neck, Point::new(90.0, 40.0), 6.0));
    for (joint, upper, lower, length) in [
        (neck, 0.1 + swing, -0.9 + swing, 38.0),
        (neck, 3.0 - 0.6 * swing, 4.0 - 0.8 * swing, 38.0),
        (hip, 1.0 - 0.3 * swing, 1.3 + 0.2 * swing, 33.0),
        (hip, 2.2 + 0.2 * swing, 1.8 + 0.3 * swing, 33.0),
    ] {
        let knee = towards(joint, upper, length);
        bones.push((joint, knee, 6.5));
        bones.push((knee, towards(knee, lower, length), 5.0));
    }
    let image = RgbaImage::from_fn(CANVAS, CANVAS, |x, y| {
        let pixel = Point::new(f64::from(x) + 0.5, f64::from(y) + 0.5) / SCALE;
        let outside = bones.iter().map(|&(from, to, radius)| {
            let along = to - from;
            let share = ((pixel - from).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
            (pixel - from - along * share).norm() - radius
        });
        let coverage = (0.5 - SCALE * outside.fold(f64::INFINITY, f64::min)).clamp(0.0, 1.0);
        Rgba([70, 90, 160, (255.0 * coverage).round() as u8])
    });
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, ImageFormat::Bmp).expect("a bitmap");
    bytes.into_inner()
}

fn outline_of(bytes: &[u8]) -> Outline {
    read_bitmap(bytes, &BitmapOptions::default()).expect("a figure").outline
}

/// Measures every stage of the mapping of `outlines`, each on what the one before it hands on.
#[expect(clippy::print_stdout, reason = "a time means little without the sizes it belongs to")]
fn mapping_stages(group: &mut BenchmarkGroup<'_, WallTime>, name: &str, outlines: &[Outline]) -> CompatibleMesh {
    let rings: Vec<Ring> = outlines.iter().map(|outline| outline.outer().clone()).collect();
    let options = MatchOptions::default();
    group.bench_function(format!("match/{name}"), |b| {
        b.iter(|| match_rings(&rings, &[], &options));
    });
    let correspondences = [match_rings(&rings, &[], &options).expect("a match").correspondence];

    let options = SimplifyOptions::default();
    group.bench_function(format!("simplify/{name}"), |b| {
        b.iter(|| simplify(outlines, &correspondences, &[], &options));
    });
    let polygons = simplify(outlines, &correspondences, &[], &options)
        .expect("simplified")
        .polygons;

    group.bench_function(format!("triangulate/{name}"), |b| {
        b.iter(|| triangulate(&polygons, &[]))
    });
    let (mesh, _) = triangulate(&polygons, &[]).expect("triangulated");

    let options = RefineOptions::default();
    group.bench_function(format!("refine/{name}"), |b| b.iter(|| refine(&mesh, &options)));
    let (refined, _) = refine(&mesh, &options).expect("refined");
    println!(
        "{name}: {} outline points in all, {} vertices simplified, {} Steiner points, {} vertices refined",
        rings.iter().map(|ring| ring.points().len()).sum::<usize>(),
        polygons[0].outer().points().len(),
        mesh.steiner,
        refined.positions[0].len()
    );
    refined
}

/// All stages in a row, without a look at the time between them.
fn pixels_to_mesh(drawings: &[Vec<u8>]) -> CompatibleMesh {
    let outlines: Vec<Outline> = drawings.iter().map(|bytes| outline_of(bytes)).collect();
    let rings: Vec<Ring> = outlines.iter().map(|outline| outline.outer().clone()).collect();
    let matched = match_rings(&rings, &[], &MatchOptions::default()).expect("a match");
    let simplified =
        simplify(&outlines, &[matched.correspondence], &[], &SimplifyOptions::default()).expect("simplified");
    let (mesh, _) = triangulate(&simplified.polygons, &[]).expect("triangulated");
    refine(&mesh, &RefineOptions::default()).expect("refined").0
}

fn stages(criterion: &mut Criterion) {
    let mut group = brief(criterion, "stages");
    for (points, poses) in SIZES {
        let outlines: Vec<Outline> = (0..poses).map(|pose| wavy(points, pose, poses)).collect();
        let name = format!("{points} points x {poses} poses");
        let mesh = mapping_stages(&mut group, &name, &outlines);

        let named = mesh.positions.into_iter().enumerate();
        let named = named.map(|(pose, positions)| (format!("p{pose}"), positions));
        let set = PoseSet::new(mesh.topology, named.collect()).expect("a pose set");
        let blend = RigidBlend::new(&set, &BlendOptions::default()).expect("a blend");
        let weights = vec![1.0 / poses as f64; poses];
        let (mut scratch, mut out) = (blend.scratch(), Vec::new());
        group.bench_function(format!("blend a frame/{name}"), |b| {
            b.iter(|| blend.blend(&weights, &mut scratch, &mut out));
        });
    }
}

/// Simplification leaves about 30 vertices of a wavy disc, however many points it has. What the two stages after it cost
/// on larger polygons and meshes is measured here: polygons as they are, and finer edges.
fn mesh_sizes(criterion: &mut Criterion) {
    let mut group = brief(criterion, "mesh sizes");
    for vertices in [50, 100, 200, 400] {
        let polygons: Vec<Outline> = (0..4).map(|pose| wavy(vertices, pose, 4)).collect();
        group.bench_function(format!("triangulate/{vertices} vertices x 4 poses"), |b| {
            b.iter(|| triangulate(&polygons, &[]));
        });
    }
    let polygons: Vec<Outline> = (0..4).map(|pose| wavy(50, pose, 4)).collect();
    let (mesh, _) = triangulate(&polygons, &[]).expect("triangulated");
    for edge_length in [0.08, 0.04, 0.02] {
        let mut options = RefineOptions::default();
        options.edge_length = edge_length;
        let (refined, _) = refine(&mesh, &options).expect("refined");
        let vertices = refined.positions[0].len();
        group.bench_function(format!("refine/to {vertices} vertices x 4 poses"), |b| {
            b.iter(|| refine(&mesh, &options));
        });
    }
}

fn whole(criterion: &mut Criterion) {
    let drawings: Vec<Vec<u8>> = (0..4).map(figure).collect();
    let outlines: Vec<Outline> = drawings.iter().map(|bytes| outline_of(bytes)).collect();
    let mut group = brief(criterion, "pixels to mesh");
    group.bench_function("whole/figure", |b| b.iter(|| pixels_to_mesh(&drawings)));
    group.bench_function("input/figure", |b| {
        b.iter(|| drawings.iter().map(|bytes| outline_of(bytes)).collect::<Vec<_>>());
    });
    mapping_stages(&mut group, "figure", &outlines);
}

fn on_one_thread(criterion: &mut Criterion) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread();
    pool.build_global().expect("no pool before this one");
    whole(criterion);
    mesh_sizes(criterion);
    stages(criterion);
}

criterion_group!(benches, on_one_thread);
criterion_main!(benches);
