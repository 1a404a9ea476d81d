//! A blob that bends to either side and gets thicker, as in figures 4 and 5 of "Shape by Example".
//!
//! A sphere of 642 vertices is drawn out along y. As it gets thicker it gets shorter. The bent forms are so narrow inside the
//! bend that a thick one, which the examples do not show bent, passes through itself there; two pseudo-examples put it right.

use std::error::Error;
use std::path::Path;

use inbetween::math::{Point3, smooth_step};
use inbetween::shape3d::{LoopSubdivision, SubdividedPositions, SubdivisionOptions};

use crate::object;

/// How far the ends of a bent form are turned, each to its side.
const BEND_DEGREES: f64 = 70.0;
/// Half of the length over which it bends.
const BEND_LENGTH: f64 = 0.88;
/// How square the outline is; 2 is an ellipse.
const SQUARENESS: f64 = 2.7;

struct Blob {
    name: &'static str,
    bend: f64,
    thickness: f64,
    /// Half of its length and its radius.
    size: [f64; 2],
}

const BLOBS: [Blob; 5] = [
    Blob {
        name: "straight",
        bend: 0.0,
        thickness: 0.5,
        size: [1.6, 0.42],
    },
    Blob {
        name: "left",
        bend: -1.0,
        thickness: 0.5,
        size: [1.6, 0.42],
    },
    Blob {
        name: "right",
        bend: 1.0,
        thickness: 0.5,
        size: [1.6, 0.42],
    },
    Blob {
        name: "thin",
        bend: 0.0,
        thickness: 0.0,
        size: [1.72, 0.2],
    },
    Blob {
        name: "thick",
        bend: 0.0,
        thickness: 1.0,
        size: [1.05, 1.05],
    },
];

const SCENE: &str = r#"
[[pseudo_example]]
from = { bend = -0.6, thickness = 0.8 }
at = { bend = -1.0, thickness = 1.0 }

[[pseudo_example]]
from = { bend = 0.6, thickness = 0.8 }
at = { bend = 1.0, thickness = 1.0 }

[subdivision]
steps = 1
limit = true

[sheet]
across = { adjective = "bend", from = -1.0, to = 1.0, columns = 5 }
up = { adjective = "thickness", from = 0.0, to = 1.0, rows = 5 }
view = { yaw = 15.0, pitch = 15.0 }

[animation]
fps = 24
loop = true
keys = [
    { time = 0.0, at = { bend = 0.0, thickness = 0.5 } },
    { time = 0.8, at = { bend = 1.0, thickness = 0.6 } },
    { time = 1.6, at = { bend = 0.0, thickness = 1.0 } },
    { time = 2.4, at = { bend = -1.0, thickness = 0.6 } },
    { time = 3.2, at = { bend = 0.0, thickness = 0.0 } },
    { time = 4.0, at = { bend = 0.0, thickness = 0.5 } },
]
"#;

/// Models the forms and writes the scene.
pub(crate) fn draw(folder: &Path) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(folder)?;
    let Sphere { points, triangles } = sphere()?;
    let faces: Vec<Vec<usize>> = triangles.iter().map(|triangle| triangle.to_vec()).collect();
    let mut scene = String::from("version = 1\nadjectives = [\"bend\", \"thickness\"]\nradial = \"b-spline\"\n");
    for blob in &BLOBS {
        let positions: Vec<Point3> = points.iter().map(|&on_sphere| blob.place(on_sphere)).collect();
        let file = format!("{}.obj", blob.name);
        object::save(&folder.join(&file), &positions, &faces)?;
        scene += &format!(
            "\n[[example]]\nname = \"{}\"\nform = \"{file}\"\nat = {{ bend = {:.1}, thickness = {:.1} }}\n",
            blob.name, blob.bend, blob.thickness
        );
    }
    std::fs::write(folder.join("scene.toml"), scene + SCENE)?;
    Ok(())
}

impl Blob {
    /// Where a point of the unit sphere goes.
    fn place(&self, on_sphere: Point3) -> Point3 {
        let around = libm::hypot(on_sphere.x, on_sphere.z);
        let reach = libm::pow(
            libm::pow(around, SQUARENESS) + libm::pow(on_sphere.y.abs(), SQUARENESS),
            -1.0 / SQUARENESS,
        );
        let [length, radius] = self.size;
        let straight = Point3::new(
            on_sphere.x * reach * radius,
            on_sphere.y * reach * length,
            on_sphere.z * reach * radius,
        );
        // The middle line is followed from the middle of the form.
        const STEPS: usize = 256;
        let step = straight.y / STEPS as f64;
        let mut middle = Point3::zeros();
        for index in 0..STEPS {
            let (sin, cos) = libm::sincos(self.turn_rad((index as f64 + 0.5) * step));
            middle += Point3::new(sin, cos, 0.0) * step;
        }
        let (sin, cos) = libm::sincos(self.turn_rad(straight.y));
        // Bent forms are moved back to where the straight one is.
        middle + Point3::new(cos, -sin, 0.0) * straight.x + Point3::z() * straight.z - Point3::x() * (0.4 * self.bend)
    }

    /// How far the middle line is turned at a height.
    fn turn_rad(&self, height: f64) -> f64 {
        let share = 2.0 * smooth_step(height, -BEND_LENGTH, BEND_LENGTH) - 1.0;
        self.bend * BEND_DEGREES.to_radians() * share
    }
}

/// Points of the unit sphere and the triangles between them.
struct Sphere {
    points: Vec<Point3>,
    triangles: Vec<[usize; 3]>,
}

/// The icosahedron divided three times, on the unit sphere.
fn sphere() -> Result<Sphere, Box<dyn Error>> {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut corners = Vec::new();
    for (one, other) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
        corners.push(Point3::new(0.0, one, other));
        corners.push(Point3::new(one, other, 0.0));
        corners.push(Point3::new(other, 0.0, one));
    }
    // Three corners at the distance of an edge, which is 2, are a face.
    let is_edge = |a: usize, b: usize| (corners[a] - corners[b]).norm() < 2.1;
    let mut triangles = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if is_edge(a, b) && is_edge(b, c) && is_edge(c, a) {
                    let is_outwards = (corners[b] - corners[a])
                        .cross(&(corners[c] - corners[a]))
                        .dot(&corners[a])
                        > 0.0;
                    triangles.push(if is_outwards { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    // Step by step, each on the sphere, so that triangles stay even.
    let mut once = SubdivisionOptions::default();
    once.steps = 1;
    once.positions = SubdividedPositions::Refined;
    for _ in 0..3 {
        let finer = LoopSubdivision::new(corners.len(), &triangles, &once)?;
        corners = finer.positions(&corners)?.iter().map(|at| at.normalize()).collect();
        triangles = finer.triangles().to_vec();
    }
    Ok(Sphere {
        points: corners,
        triangles,
    })
}
