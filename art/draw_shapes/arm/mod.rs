//! An arm with a hand on a skeleton, as in figure 9 of "Shape by Example": eight examples over the adjectives "shoulder",
//! "elbow", "wrist" and "gender".
//!
//! The arm is stretched out along x, the biceps up (y), the thumb up, the palm away from the viewer (z). Lengths are in
//! decimetres.
//!
//! - [`topology`]: rings of twenty vertices along the arm, of eight along fingers and thumb, and the faces between them;
//! - [`body`]: how thick the arm is, and its muscles, which depend on the pose and the gender;
//! - [`hand`]: fingers and thumb;
//! - [`bend`]: bends a straight arm as a modeller would, keeping its cross-sections.
//!
//! Where transforms are blended half-way the skin shrinks less than half as much as at the example, so that half of the
//! example's correction is too much there. The pseudo-examples take less of it.

mod bend;
mod body;
mod hand;
mod topology;

use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;

use inbetween::math::Point3;

use crate::object::{self, rounded};
use bend::{ELBOW, Joint, SHOULDER, WRIST};
use body::Build;
use topology::{Site, Topology};

const POSES: [(&str, f64, f64); 4] = [
    ("straight", 0.0, 0.0),
    ("elbow_bent", 0.0, 1.0),
    ("shoulder_up", 1.0, 0.0),
    ("shoulder_down", -1.0, 0.0),
];
const GENDERS: [(&str, f64); 2] = [("female", 0.0), ("male", 1.0)];

const SCENE: &str = r#"
# Half of a bend's correction is more than half-way bends need.
[[pseudo_example]]
from = { shoulder = 0.0, elbow = 0.3, wrist = 0.0, gender = 0.0 }
at = { shoulder = 0.0, elbow = 0.5, wrist = 0.0, gender = 0.0 }

[[pseudo_example]]
from = { shoulder = 0.0, elbow = 0.3, wrist = 0.0, gender = 1.0 }
at = { shoulder = 0.0, elbow = 0.5, wrist = 0.0, gender = 1.0 }

[[pseudo_example]]
from = { shoulder = 0.35, elbow = 0.0, wrist = 0.0, gender = 0.5 }
at = { shoulder = 0.5, elbow = 0.0, wrist = 0.0, gender = 0.5 }

[[pseudo_example]]
from = { shoulder = -0.35, elbow = 0.0, wrist = 0.0, gender = 0.5 }
at = { shoulder = -0.5, elbow = 0.0, wrist = 0.0, gender = 0.5 }

# The wrist changes nothing but the pose.
[[pseudo_example]]
from = { shoulder = 0.0, elbow = 0.0, wrist = 0.0, gender = 0.5 }
at = { shoulder = 0.0, elbow = 0.0, wrist = 1.0, gender = 0.5 }

[[pseudo_example]]
from = { shoulder = 0.0, elbow = 0.0, wrist = 0.0, gender = 0.5 }
at = { shoulder = 0.0, elbow = 0.0, wrist = -1.0, gender = 0.5 }

[skeleton]
weights = "arm.weights.json"

[[skeleton.joint]]
name = "torso"
origin = [-0.9, 0.0, 0.0]

[[skeleton.joint]]
name = "upper"
parent = "torso"
origin = [0.0, 0.0, 0.0]
turns = [{ adjective = "shoulder", axis = [0.0, 0.0, 1.0], degrees = 45.0 }]

[[skeleton.joint]]
name = "forearm"
parent = "upper"
origin = [3.0, 0.0, 0.0]
turns = [{ adjective = "elbow", axis = [0.0, 0.0, 1.0], degrees = 90.0 }]

[[skeleton.joint]]
name = "hand"
parent = "forearm"
origin = [5.5, 0.0, 0.0]
turns = [{ adjective = "wrist", axis = [0.0, 1.0, 0.0], degrees = 50.0 }]

[subdivision]
steps = 1
limit = true

[sheet]
across = { adjective = "elbow", from = 0.0, to = 1.25, columns = 6 }
up = { adjective = "gender", from = 0.0, to = 1.25, rows = 6 }
fixed = { shoulder = 0.0, wrist = 0.0 }
view = { yaw = 15.0, pitch = 10.0 }

[animation]
fps = 24
loop = true
keys = [
    { time = 0.0, at = { shoulder = -0.6, elbow = 0.0, wrist = 0.0, gender = 0.0 } },
    { time = 1.0, at = { shoulder = 0.0, elbow = 1.0, wrist = 0.6, gender = 0.2 } },
    { time = 1.8, at = { shoulder = 0.0, elbow = 0.2, wrist = -0.4, gender = 0.5 } },
    { time = 2.8, at = { shoulder = 0.5, elbow = 1.0, wrist = 0.4, gender = 1.0 } },
    { time = 3.8, at = { shoulder = 0.0, elbow = 0.3, wrist = 0.0, gender = 0.7 } },
    { time = 4.8, at = { shoulder = -0.6, elbow = 0.0, wrist = 0.0, gender = 0.0 } },
]
"#;

/// Models the forms and writes the scene and the skin's weights.
pub(crate) fn draw(folder: &Path) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(folder)?;
    let Topology { sites, faces } = topology::arm();
    let mut scene = String::from(
        "version = 1\nadjectives = [\"shoulder\", \"elbow\", \"wrist\", \"gender\"]\nradial = \"b-spline\"\n",
    );
    for (gender_name, gender) in GENDERS {
        for (pose_name, shoulder, elbow) in POSES {
            let build = Build {
                gender,
                shoulder,
                elbow,
            };
            let positions: Vec<Point3> = sites
                .iter()
                .map(|site| {
                    let straight = build.place(site);
                    let bent = ELBOW.bend(straight, site.station(), elbow);
                    SHOULDER.bend(bent, site.station(), shoulder)
                })
                .collect();
            let name = format!("{gender_name}_{pose_name}");
            object::save(&folder.join(format!("{name}.obj")), &positions, &faces)?;
            write!(
                scene,
                "\n[[example]]\nname = \"{name}\"\nform = \"{name}.obj\"\n\
                 at = {{ shoulder = {shoulder:.1}, elbow = {elbow:.1}, wrist = 0.0, gender = {gender:.1} }}\n"
            )?;
        }
    }
    std::fs::write(folder.join("scene.toml"), scene + SCENE)?;
    std::fs::write(folder.join("arm.weights.json"), weights(&sites)?)?;
    Ok(())
}

/// The weights of the skin, as a JSON document with one line a vertex.
fn weights(sites: &[Site]) -> Result<String, Box<dyn Error>> {
    let mut text = String::from("{\n\"joints\": [\"torso\", \"upper\", \"forearm\", \"hand\"],\n\"weights\": [\n");
    for (index, site) in sites.iter().enumerate() {
        let shares = [SHOULDER, ELBOW, WRIST].map(|joint: Joint| joint.share(site.station()));
        // Rounded so that they still sum to 1: what goes beyond one joint is taken from what reached it.
        let beyond = shares.map(|share| (share * 1e4).round() / 1e4);
        let own = [1.0 - beyond[0], beyond[0] - beyond[1], beyond[1] - beyond[2], beyond[2]];
        let entries: Vec<String> = own
            .iter()
            .enumerate()
            .filter(|(_, weight)| **weight > 0.0)
            .map(|(joint, &weight)| format!("[{joint},{}]", rounded(weight)))
            .collect();
        let end = if index + 1 < sites.len() { "," } else { "" };
        writeln!(text, "[{}]{end}", entries.join(","))?;
    }
    text += "]\n}\n";
    Ok(text)
}
