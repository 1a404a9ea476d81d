//! What is allocated, counted and not promised: nothing by a frame, little by damaged layered files.

#[path = "../it/layered/art.rs"]
mod art;
#[path = "../it/layered/ase.rs"]
mod ase;
#[path = "../it/layered/kra.rs"]
mod kra;
#[path = "../it/layered/ora.rs"]
mod ora;
#[path = "../it/layered/picture.rs"]
mod picture;
#[path = "../it/layered/psd.rs"]
mod psd;
#[path = "../it/layered/zip.rs"]
mod zip;

mod damaged_layers;

use inbetween::blend::{Anchor, BlendOptions, RigidBlend, SoftAnchor, Stretch};
use inbetween::math::{Point, Point3};
use inbetween::mesh::Topology;
use inbetween::pose::PoseSet;
use inbetween::render::{ColourBlend, Frame};
use inbetween::shape3d::{Example, Form, FormBlender, FormLayout, FormTopology, ImageBlend, Shape};
use inbetween::weights::{PseudoPose, RbfOptions, WeightProvider};

/// What `work` allocates on this thread; the counter replaces the allocator of the whole test.
fn allocations(work: impl FnOnce()) -> u64 {
    allocation_counter::measure(work).count_total
}

/// A strip of `columns` x 4 vertices, bent more from pose to pose.
fn poses(columns: usize, count: usize) -> PoseSet {
    let quads = (0..3).flat_map(|j| (1..columns).map(move |i| j * columns + i));
    let triangles = quads.flat_map(|b| [[b - 1, b, b + columns], [b - 1, b + columns, b - 1 + columns]]);
    let topology = Topology::new(4 * columns, triangles.collect()).expect("a grid");
    let bend = |curvature: f64| -> Vec<Point> {
        let place = |v: usize| {
            let (angle, radius) = ((v % columns) as f64 * curvature, 1.0 / curvature - (v / columns) as f64);
            Point::new(radius * angle.sin(), -radius * angle.cos())
        };
        (0..4 * columns).map(place).collect()
    };
    let named = (1..=count).map(|k| {
        let curvature = 0.1 * k as f64 / count as f64;
        (format!("{curvature}"), bend(curvature))
    });
    PoseSet::new(topology, named.collect()).expect("poses")
}

#[test]
fn the_counter_counts() {
    assert!(allocations(|| drop(std::hint::black_box(vec![1_u8]))) > 0);
}

#[test]
fn a_frame_allocates_nothing() {
    let poses = poses(60, 3);
    let soft = [(0, 1.0), (59, 10.0)].map(|(vertex, stiffness)| SoftAnchor {
        point: vertex,
        stiffness,
    });
    for stretch in [Stretch::Linear, Stretch::Limited, Stretch::Log] {
        for anchor in [Anchor::Centroid, Anchor::Point(3), Anchor::Soft(soft.to_vec())] {
            let mut options = BlendOptions::default();
            options.stretch = stretch;
            options.anchor = anchor;
            let blend = RigidBlend::new(&poses, &options).expect("a blend");
            let mut scratch = blend.scratch();
            let mut positions = Vec::with_capacity(blend.vertex_count());
            let counted = allocations(|| {
                for k in 0..10 {
                    let w = 0.1 * f64::from(k);
                    let moved = [Some(Point::new(w, 2.0))];
                    blend
                        .blend(&[w, 0.7 - w, 0.3], &mut scratch, &mut positions)
                        .expect("a frame");
                    blend
                        .blend_anchored(&[w, 0.7 - w, 0.3], &moved, &mut scratch, &mut positions)
                        .expect("a frame");
                }
            });
            assert_eq!(counted, 0, "{options:?}");
        }
    }
}

#[test]
fn weights_and_blends_of_forms_allocate_nothing() {
    let topology = FormTopology::from_triangles(50, vec![[0, 1, 2]]).expect("a triangle");
    let example = |k: usize| {
        let position = |v: usize| Point3::new(v as f64, k as f64, 0.1 * (v * k) as f64);
        Example {
            form: Form::new(&topology, (0..50).map(position).collect()).expect("a form"),
            at: vec![k as f64, (k * k) as f64],
        }
    };
    let pseudo = PseudoPose {
        from: vec![1.5, 2.0],
        at: vec![1.5, 3.0],
    };
    let mut options = RbfOptions::default();
    options.pseudo_poses = vec![pseudo];
    let shape = Shape::new(topology.clone(), (0..6).map(example).collect(), &options).expect("a shape");
    let textures: Vec<Frame> = (0..6).map(|k| Frame::filled(19, 5, [k, 2 * k, 255 - k, 200])).collect();
    let images = ImageBlend::new(&textures, ColourBlend::Linear).expect("one size");
    let blender = FormBlender::new(&shape, FormLayout::Planar);
    let mut weights = Vec::with_capacity(shape.forms().len());
    let mut values = vec![0.0; blender.value_count()];
    let mut positions = vec![Point3::zeros(); 50];
    let mut pixels = vec![[0; 4]; 19 * 5];
    let counted = allocations(|| {
        for k in 0..10 {
            let at = [0.3 * f64::from(k), 2.0];
            shape.weights().weights(&at, &mut weights).expect("a place");
            blender.blend(&weights, &mut values).expect("buffers");
            shape.blend(&weights, &mut positions).expect("buffers");
            images.blend_into(&weights, &mut pixels).expect("buffers");
        }
    });
    assert_eq!(counted, 0);
}

#[test]
fn a_pose_more_takes_64_bytes_a_vertex() {
    // On this thread alone, so that all is counted.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread();
    let pool = pool.build().expect("a pool");
    let bytes = |count: usize| {
        let poses = poses(400, count);
        let mut kept = None;
        let counted = allocation_counter::measure(|| {
            kept = Some(pool.install(|| RigidBlend::new(&poses, &BlendOptions::default())));
        });
        assert!(kept.is_some_and(|blend| blend.is_ok()));
        counted.bytes_current
    };
    let vertices = 4 * 400;
    let a_pose_and_vertex = (bytes(12) - bytes(4)) as f64 / (8 * vertices) as f64;
    // A strip has 1.5 triangles a vertex; a mesh without end has 2.
    assert!((48.0..=49.0).contains(&a_pose_and_vertex), "{a_pose_and_vertex}");
}
