//! The scene, as the page needs it.

use inbetween::animation::{Background, Key};
use inbetween::blend::{FrameGuard, Reference, Stretch};
use inbetween::math::Point;
use inbetween::pipeline::{ArtChoice, Facing, HandleMove, LayerShape, Register};
use inbetween::render::{ColourBlend, Sampling};
use inbetween::scene::{Layout, PoseSource, Provider, Scene, Workbench};
use inbetween::weights::{Radial, Range};
use serde_json::{Map, Value, json};

use super::pictures::as_used;
use super::session::Session;

/// `GET api/scene`.
pub(super) fn scene(session: &Session) -> Value {
    let shown = session.shown();
    let mut answer = shown
        .scene
        .as_ref()
        .map_or_else(nothing, |scene| of(scene, shown.bench.as_deref()));
    let bench = shown.bench.as_ref();
    let camera = bench.map(|bench| {
        let shift = bench.camera().to_pixels(Point::zeros());
        json!({"scale": bench.camera().scale(), "shift": [shift.x, shift.y]})
    });
    let rest = json!({
        "file": session.file().display().to_string(),
        "revision": shown.revisions.scene,
        "camera": camera,
        "notes": bench.map_or_else(Vec::new, |bench| bench.notes().iter().map(ToString::to_string).collect()),
        "problems": shown.problems,
    });
    if let Some(animation) = answer.get_mut("animation").and_then(Value::as_object_mut) {
        animation.insert("own_keys".to_owned(), has_own_keys(&session.text()).into());
    }
    if let (Value::Object(answer), Value::Object(rest)) = (&mut answer, rest) {
        answer.extend(rest);
        if shown.scene.is_none() {
            let name = session
                .file()
                .file_name()
                .map(|name| name.to_string_lossy().into_owned());
            answer.insert("name".to_owned(), name.into());
        }
    }
    answer
}

/// Whether the keys are the file's own, not the places of the poses.
fn has_own_keys(text: &str) -> bool {
    let document = text.parse::<toml_edit::DocumentMut>().ok();
    let keys = document
        .as_ref()
        .and_then(|document| document.get("animation")?.get("keys")?.as_array());
    keys.is_some_and(|keys| !keys.is_empty())
}

/// Of a scene whose text cannot be read.
fn nothing() -> Value {
    json!({
        "dimension": 0, "layout": "given", "poses": [], "pseudo_poses": [], "pose_space": null, "blend": null,
        "texture": null, "mesh": null, "layers": [], "landmarks": [], "animation": null, "box": null, "domain": null,
    })
}

fn of(scene: &Scene, bench: Option<&Workbench>) -> Value {
    let settings = &scene.pose_space;
    let plane = plane(scene);
    json!({
        "name": scene.short_name(),
        "dimension": scene.dimension(),
        "layout": match scene.layout { Layout::Given => "given", Layout::Automatic => "automatic" },
        "poses": (0..scene.poses.len()).map(|pose| pose_json(scene, bench, pose)).collect::<Vec<_>>(),
        "pseudo_poses": scene.pseudo_poses.iter().map(|p| json!({"from": p.from, "at": p.at})).collect::<Vec<_>>(),
        "pose_space": {
            "provider": name_of(&Provider::NAMED, &settings.provider),
            "radial": match settings.radial { Radial::BSpline => "b-spline", Radial::ThinPlate => "thin-plate" },
            "epsilon": settings.epsilon,
            "bounded": settings.range == Range::Unit,
            "walls": settings.walls,
        },
        "blend": {
            "reference": match scene.blend.reference {
                Reference::Canonical => "canonical",
                Reference::Pose(pose) => scene.poses.get(pose).map_or("canonical", |pose| &pose.name),
            },
            "stretch": name_of(&Stretch::NAMED, &scene.blend.stretch),
            "guard": match scene.blend.guard { FrameGuard::Off => "off", FrameGuard::Repair => "repair" },
        },
        "texture": {
            "sharpness": scene.texture_sharpness,
            "register": name_of(&Register::NAMED, &scene.register),
            "blending": match scene.colour_blend { ColourBlend::Plain => "plain", ColourBlend::Linear => "linear" },
            "sampling": name_of(&Sampling::NAMED, &scene.sampling),
            "drawing": match scene.art { ArtChoice::Curves => "curves", ArtChoice::Pixels => "pixels" },
        },
        "mesh": {"simplify": scene.mesh.simplify.tolerance, "edge_length": scene.mesh.refine.edge_length},
        "layers": layers(scene, bench),
        "landmarks": landmarks(scene, bench),
        "animation": animation(scene),
        "box": plane.map(|(low, high)| [low, high]),
        "domain": plane.map(|(low, high)| {
            let diagonal = (high[0] - low[0]).hypot(high[1] - low[1]);
            let reach = if diagonal > 0.0 { 0.5 * diagonal } else { 1.0 };
            [low.map(|v| v - reach), high.map(|v| v + reach)]
        }),
    })
}

/// The box of the poses in a plane.
pub(super) fn plane(scene: &Scene) -> Option<([f64; 2], [f64; 2])> {
    let places: Option<Vec<[f64; 2]>> = scene
        .poses
        .iter()
        .map(|pose| pose.at.as_slice().try_into().ok())
        .collect();
    let places = places?;
    let fold = |start: f64, pick: fn(f64, f64) -> f64| [0, 1].map(|d| places.iter().map(|p| p[d]).fold(start, pick));
    Some((fold(f64::INFINITY, f64::min), fold(f64::NEG_INFINITY, f64::max)))
}

fn pose_json(scene: &Scene, bench: Option<&Workbench>, index: usize) -> Value {
    let pose = &scene.poses[index];
    let mut handles = Vec::new();
    let mut mirror = json!(false);
    let (mut source, mut deform_of) = (Value::Null, Value::Null);
    let kind = match &pose.source {
        PoseSource::Drawn(drawn) => {
            source = drawn.file.display().to_string().into();
            mirror = match drawn.facing {
                Facing::AsDrawn => json!(false),
                Facing::Mirrored => json!(true),
                Facing::Auto => json!("auto"),
            };
            "drawn"
        }
        PoseSource::Deformed(copy) => {
            deform_of = scene.poses[copy.copy.of].name.clone().into();
            let place = |place| used(bench, 0, &pose.name, place);
            let handle = |handle: &HandleMove| json!({"from": place(handle.from), "to": place(handle.to)});
            handles.extend(copy.copy.handles.iter().map(handle));
            "deformed"
        }
        PoseSource::Layered => "layered",
    };
    let layers: Vec<usize> = if let Some(bench) = bench {
        let shapes = bench.layers().iter().enumerate();
        let has_pose = |shape: &LayerShape| shape.mapping().poses.index_of(&pose.name).is_some();
        shapes.filter(|(_, shape)| has_pose(shape)).map(|(k, _)| k).collect()
    } else if scene.layers.is_empty() {
        vec![0]
    } else {
        (0..scene.layers.len())
            .filter(|&k| scene.layers[k].poses.contains(&index))
            .collect()
    };
    json!({
        "name": pose.name, "at": pose.at, "kind": kind, "source": source,
        "drawing": scene.originals()[index], "deform_of": deform_of, "handles": handles,
        "mirror": mirror, "turns": pose.turns, "layers": layers,
    })
}

/// What a choice is called.
fn name_of<T: PartialEq>(named: &[(&'static str, T)], choice: &T) -> Option<&'static str> {
    named.iter().find(|(_, own)| own == choice).map(|(name, _)| *name)
}

fn layers(scene: &Scene, bench: Option<&Workbench>) -> Vec<Value> {
    // Those that the drawings fell into, too.
    if let Some(bench) = bench {
        let of_shape = |shape: &LayerShape| json!({"name": shape.name(), "poses": shape.poses()});
        return bench.layers().iter().map(of_shape).collect();
    }
    if scene.layers.is_empty() {
        let all: Vec<usize> = (0..scene.poses.len()).collect();
        return vec![json!({"name": scene.short_name(), "poses": all})];
    }
    let layer = |layer: &inbetween::scene::SceneLayer| json!({"name": layer.name, "poses": layer.poses});
    scene.layers.iter().map(layer).collect()
}

/// A place of the file in drawing units.
fn used(bench: Option<&Workbench>, layer: usize, pose: &str, place: Point) -> [f64; 2] {
    bench.map_or(place, |bench| as_used(bench, layer, pose, place)).into()
}

/// What is said of each pose, by its name.
fn by_pose<T>(scene: &Scene, at: &[Option<T>], value: impl Fn(&str, &T) -> Value) -> Map<String, Value> {
    let given = scene.poses.iter().zip(at);
    given
        .filter_map(|(pose, at)| Some((pose.name.clone(), value(&pose.name, at.as_ref()?))))
        .collect()
}

fn landmarks(scene: &Scene, bench: Option<&Workbench>) -> Vec<Value> {
    let points = scene.landmarks.iter().map(|landmark| {
        let layer = landmark.layer.unwrap_or(0);
        let at = by_pose(scene, &landmark.at, |pose, place| {
            json!(used(bench, layer, pose, *place))
        });
        json!({"name": landmark.name, "layer": layer, "line": landmark.line, "path": false, "at": at})
    });
    let paths = scene.paths.iter().map(|path| {
        let layer = path.layer.unwrap_or(0);
        let at = by_pose(scene, &path.at, |pose, line: &Vec<Point>| {
            line.iter()
                .map(|place| json!(used(bench, layer, pose, *place)))
                .collect::<Vec<_>>()
                .into()
        });
        json!({"name": path.name, "layer": layer, "line": path.line, "path": true, "at": at})
    });
    points.chain(paths).collect()
}

fn animation(scene: &Scene) -> Value {
    let animation = &scene.animation;
    json!({
        "fps": animation.fps,
        "loop": animation.is_loop(),
        "size": animation.size,
        "background": match animation.background {
            Background::Transparent => "transparent".to_owned(),
            Background::Colour([r, g, b, a]) => format!("#{r:02x}{g:02x}{b:02x}{a:02x}"),
        },
        "hold": animation.hold.frames(),
        "keys": animation.given_keys().map(key_json).collect::<Vec<_>>(),
        "duration": animation.duration(),
        "frame_count": animation.frame_count(),
    })
}

/// A key as `set_keys` takes it.
fn key_json(key: &Key) -> Value {
    let mut text = json!({"time": key.time, "at": key.at});
    if let Some(hold) = key.hold {
        text["hold"] = hold.frames().into();
    }
    if !key.spacing.is_empty() {
        text["spacing"] = json!(key.spacing);
    }
    text
}
