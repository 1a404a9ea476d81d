//! Round trips, and bytes that are no character.

use proptest::prelude::*;

use super::*;
use crate::blend::{Anchor, FrameGuard, Reference, Region, RigidBlend, SoftAnchor, Stretch};
use crate::export::puppet_motion::testing::turning;
use crate::export::puppet_motion::texture_png;
use crate::mesh::{MeshPoint, Topology};

/// The two squares, the second hung on the first.
fn character() -> RuntimeFile {
    let puppet = turning().puppet;
    let point = |count: usize| {
        let point = MeshPoint {
            vertices: [0, 1, 2],
            shares: [0.5, 0.25, 0.25],
        };
        vec![point; count]
    };
    let layers: Vec<RuntimeLayer> = puppet
        .layers
        .iter()
        .enumerate()
        .map(|(k, layer)| RuntimeLayer {
            name: layer.name.clone(),
            poses: (0..layer.poses.len()).collect(),
            texture_of: layer.poses.iter().map(|pose| pose.texture).collect(),
            mesh: PoseSet::new(
                Topology::new(5, layer.triangles.clone()).expect("a mesh"),
                ["red", "blue"]
                    .iter()
                    .zip(&layer.poses)
                    .map(|(name, pose)| ((*name).to_owned(), pose.positions.clone()))
                    .collect(),
            )
            .expect("poses"),
            rings: layer.rings.clone(),
            options: BlendOptions {
                reference: if k == 0 {
                    Reference::Pose(1)
                } else {
                    Reference::Canonical
                },
                stretch: if k == 0 { Stretch::Log } else { Stretch::Limited },
                anchor: if k == 0 {
                    Anchor::Soft(vec![SoftAnchor {
                        point: 2,
                        stiffness: 30.0,
                    }])
                } else {
                    Anchor::Point(3)
                },
                turns: if k == 0 { vec![0, 1] } else { vec![] },
                regions: vec![Region {
                    point: 4,
                    radius: 0.2,
                    stiffness: 2.0,
                    stretch_limit: f64::INFINITY,
                }],
                guard: if k == 0 { FrameGuard::Repair } else { FrameGuard::Off },
            },
            tie: (k == 1).then(|| RuntimeTie {
                to: 0,
                own: point(1),
                other: point(1),
            }),
            textures: layer
                .textures
                .iter()
                .map(|texture| RuntimeTexture {
                    name: texture.name.clone(),
                    png: texture_png(texture).expect("a picture"),
                    places: texture
                        .places
                        .iter()
                        .map(|p| Point::new(p.x / 8.0, p.y / 4.0))
                        .collect(),
                })
                .collect(),
            regions: None,
        })
        .collect();
    RuntimeFile {
        size: [200, 100],
        texture_sharpness: 0.5,
        poses: ["red", "blue"]
            .iter()
            .enumerate()
            .map(|(k, name)| RuntimePose {
                name: (*name).to_owned(),
                at: vec![k as f64, 0.1],
                order: if k == 0 { vec![1, 0] } else { vec![0, 1] },
            })
            .collect(),
        field: Some(WeightField {
            low: [0.0, 0.0],
            high: [1.0, 2.0],
            columns: 2,
            rows: 2,
            weights: vec![1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.5, 0.5],
        }),
        animation: RuntimeAnimation {
            fps: 24.0,
            is_loop: true,
            weights: vec![vec![1.0, 0.0], vec![0.25, 0.75]],
        },
        layers,
    }
}

/// The same with the first square in two halves, the second of which lies in front in the second pose.
fn divided() -> RuntimeFile {
    let mut file = character();
    let layer = &mut file.layers[0];
    let textures = std::mem::take(&mut layer.textures);
    let region = |name: &str, vertices: [usize; 4]| RuntimeRegion {
        name: name.to_owned(),
        vertices: vertices.to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        textures: (textures.iter())
            .map(|texture| RuntimeTexture {
                places: vertices.map(|v| texture.places[v]).to_vec(),
                ..texture.clone()
            })
            .collect(),
    };
    layer.regions = Some(RuntimeRegions {
        regions: vec![region("trunk", [0, 1, 2, 3]), region("arm", [0, 1, 3, 4])],
        order: DepthOrder::new(2, vec![vec![0; 4], vec![0, -1, 1, 0]]).expect("two regions"),
    });
    file
}

fn farthest(a: &[Point], b: &[Point]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

#[test]
fn what_was_read_is_written_and_read_again_unchanged() {
    for (given, precision) in [
        (character(), Precision::Single),
        (character(), Precision::Quantised),
        (divided(), Precision::Single),
        (divided(), Precision::Quantised),
    ] {
        let (bytes, read) = runtime_bytes(&given, precision).expect("a file");
        let (again, twice) = runtime_bytes(&read, precision).expect("a file");
        assert_eq!(read, twice);
        assert_eq!(bytes, again);
        assert_eq!(bytes[4], if given.layers[0].regions.is_some() { 2 } else { 1 });
        // All but what is rounded is as it was given.
        let mut unrounded = read.clone();
        for (layer, given) in unrounded.layers.iter_mut().zip(&given.layers) {
            for (read, given) in layer.mesh.positions().iter().zip(given.mesh.positions()) {
                assert!(farthest(read, given) <= 1.0 / 512.0 * std::f64::consts::FRAC_1_SQRT_2);
            }
            let drawn = |layer: &RuntimeLayer| -> Vec<RuntimeTexture> {
                let regions = layer.regions.iter().flat_map(|regions| &regions.regions);
                let own = layer.textures.iter();
                own.chain(regions.flat_map(|region| &region.textures))
                    .cloned()
                    .collect()
            };
            for (read, given) in drawn(layer).iter().zip(drawn(given)) {
                assert!(farthest(&read.places, &given.places) < 2e-5);
            }
            layer.mesh = given.mesh.clone();
            layer.textures.clone_from(&given.textures);
            let regions = layer.regions.iter_mut().flat_map(|regions| &mut regions.regions);
            let of_given = given.regions.iter().flat_map(|regions| &regions.regions);
            for (read, given) in regions.zip(of_given) {
                read.textures.clone_from(&given.textures);
            }
        }
        assert_eq!(unrounded, given);
    }
}

#[test]
fn frames_are_those_of_the_character() {
    let given = character();
    let (_, read) = runtime_bytes(&given, Precision::Quantised).expect("a file");
    for (a, b) in given.layers.iter().zip(&read.layers) {
        let weights = if a.poses.len() == 2 { vec![0.3, 0.7] } else { vec![1.0] };
        let frame = |layer: &RuntimeLayer| {
            let blend = RigidBlend::new(&layer.mesh, &layer.options).expect("a blend");
            let mut positions = Vec::new();
            blend
                .blend(&weights, &mut blend.scratch(), &mut positions)
                .expect("a frame");
            positions
        };
        // Half a step of 1/512 in each pose, and what the solve makes of it.
        assert!(farthest(&frame(a), &frame(b)) < 2.0 / 512.0);
    }
}

#[test]
fn weights_are_bilinear_and_hold_beyond_the_border() {
    let field = character().field.expect("a field");
    assert_eq!(field.at([0.0, 1.0], 2), [1.0, 0.0]);
    assert_eq!(field.at([0.5, 0.0], 2), [0.5, 0.5]);
    assert_eq!(field.at([1.0, 1.0], 2), [0.25, 0.75]);
    assert_eq!(field.at([9.0, -9.0], 2), [0.0, 1.0]);
    assert_eq!(field.at([f64::NAN, 0.0], 2), [1.0, 0.0]);
}

#[test]
fn unsound_characters_are_refused() {
    type Break = fn(&mut RuntimeFile);
    let broken: [(Break, &str); 9] = [
        (|c| c.poses.clear(), "poses"),
        (|c| c.poses[0].order = vec![0, 0], "lacks a layer"),
        (|c| c.poses[1].at = vec![0.0], "dimension"),
        (|c| c.layers[1].poses = vec![5], "does not exist"),
        (|c| c.layers[0].texture_of[1] = 2, "texture"),
        (|c| c.layers[0].rings[0][1] = 5, "vertex"),
        (|c| c.layers[0].textures[0].png = vec![1; 30], "PNG"),
        (|c| c.animation.weights[1][1] = 0.5, "sum to 1"),
        (
            |c| {
                let corner = MeshPoint {
                    vertices: [0; 3],
                    shares: [0.0; 3],
                };
                c.layers[0].tie = Some(RuntimeTie {
                    to: 1,
                    own: vec![corner; 2],
                    other: vec![corner; 2],
                })
            },
            "circle",
        ),
    ];
    for (damage, said) in broken {
        let mut file = character();
        damage(&mut file);
        let refusal = runtime_bytes(&file, Precision::Single)
            .expect_err("it is broken")
            .to_string();
        assert!(refusal.contains(said), "{refusal}");
    }
    type BreakRegions = fn(&mut RuntimeRegions);
    let broken: [(BreakRegions, &str); 4] = [
        (|r| r.regions[1].vertices[3] = 5, "vertex"),
        (|r| r.regions[1].vertices.swap(0, 1), "increase"),
        (|r| r.regions[0].triangles[1][2] = 4, "lacks"),
        (|r| r.regions[0].textures.truncate(1), "texture"),
    ];
    for (damage, said) in broken {
        let mut file = divided();
        file.layers[0].regions.iter_mut().for_each(damage);
        let refusal = runtime_bytes(&file, Precision::Single)
            .expect_err("it is broken")
            .to_string();
        assert!(refusal.contains(said), "{refusal}");
    }
    // Thinner than a step: a quantised triangle has no area.
    let mut file = character();
    let mut thin = file.layers[1].mesh.positions()[0].clone();
    for p in &mut thin {
        p.y = 50.0 + (p.y - 50.0) * 1e-6;
    }
    let topology = file.layers[1].mesh.topology().clone();
    file.layers[1].mesh = PoseSet::new(topology, vec![("red".to_owned(), thin)]).expect("poses");
    let refusal = runtime_bytes(&file, Precision::Quantised)
        .expect_err("it is thin")
        .to_string();
    assert!(refusal.contains("no area"), "{refusal}");
}

#[test]
fn other_files_and_later_versions_are_named() {
    assert_eq!(read_runtime(b""), Err(RuntimeError::NotOurs));
    assert_eq!(read_runtime(b"glTF\x02\0\0\0"), Err(RuntimeError::NotOurs));
    for character in [character(), divided()] {
        let (mut bytes, _) = runtime_bytes(&character, Precision::Single).expect("a file");
        let version = std::mem::replace(&mut bytes[4], 3);
        assert_eq!(read_runtime(&bytes), Err(RuntimeError::Version { found: 3 }));
        bytes[4] = version;
        for length in 0..bytes.len() {
            assert!(read_runtime(&bytes[..length]).is_err(), "cut at {length}");
        }
        bytes.push(0);
        assert!(read_runtime(&bytes).is_err());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn damaged_bytes_are_read_or_refused(
        changes in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        precision in prop::sample::select(vec![Precision::Single, Precision::Quantised]),
        given in prop::sample::select(vec![character(), divided()]),
    ) {
        let (mut bytes, _) = runtime_bytes(&given, precision).expect("a file");
        for (place, value) in changes {
            let place = place.index(bytes.len());
            bytes[place] = value;
        }
        if let Ok(read) = read_runtime(&bytes) {
            for layer in &read.layers {
                // Options may still be nonsense, but never more than an error.
                let _ = RigidBlend::new(&layer.mesh, &layer.options);
            }
        }
    }

    #[test]
    fn random_bytes_are_refused(tail in proptest::collection::vec(any::<u8>(), 0..300)) {
        prop_assert!(read_runtime(&tail).is_err());
        let mut bytes = b"INBT\x01\0\0\0".to_vec();
        bytes.extend(tail);
        prop_assert!(read_runtime(&bytes).is_err());
    }
}
