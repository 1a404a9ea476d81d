//! Meshes, and the pictures that are drawn on them.

use serde_json::{Value, json};

use super::http::{Request, Response};
use super::pictures::{Kind, asked_layer, index, texture_of};
use super::problem::Refusal;
use super::session::Session;
use super::wire::Words;

/// `GET api/puppet`.
pub(super) fn puppet(session: &Session) -> Result<Response, Refusal> {
    let shown = session.shown();
    let bench = shown.bench()?;
    let layer = |k: usize| {
        let shape = &bench.layers()[k];
        let drawn = bench.spec().layers[k].drawn_poses();
        let texture = |index: usize| {
            json!({
                "pose": drawn[index],
                "colour": session.pictures.picture(&shown, k, index, Kind::of_frames(bench)).0,
                "drawing": session.pictures.picture(&shown, k, index, Kind::Drawing).0,
            })
        };
        json!({
            "name": shape.name(), "poses": shape.poses(),
            "vertices": shape.mapping().poses.topology().vertex_count(),
            "triangles": shape.mapping().poses.topology().triangles().len(),
            "texture_of": texture_of(bench, k), "curves": bench.is_drawn_as_curves(k),
            "textures": (0..drawn.len()).map(texture).collect::<Vec<_>>(),
        })
    };
    let layers: Vec<Value> = (0..bench.layers().len()).map(layer).collect();
    Ok(Response::json(&json!({
        "shape": shown.revisions.shape, "pictures": shown.revisions.pictures,
        "nearest": Kind::of_frames(bench) == Kind::Nearest, "layers": layers,
    })))
}

/// `GET api/mesh`.
pub(super) fn mesh(session: &Session) -> Result<Response, Refusal> {
    let shown = session.shown();
    let mut bytes = Vec::new();
    let mut words = Words(&mut bytes);
    for shape in shown.bench()?.layers() {
        let (poses, rings) = (&shape.mapping().poses, &shape.mapping().rings);
        let triangles = poses.topology().triangles();
        words.u32(poses.topology().vertex_count());
        words.u32(triangles.len());
        words.u32(poses.len());
        words.u32(rings.len());
        for vertex in triangles.iter().flatten() {
            words.u32(*vertex);
        }
        for positions in poses.positions() {
            words.points(positions);
        }
        for ring in rings {
            words.u32(ring.len());
            for vertex in ring {
                words.u32(*vertex);
            }
        }
    }
    Ok(Response::binary(bytes))
}

/// `GET api/surface`: what pictures are painted on where that is not the mesh itself. It takes longer than a mesh: who only looks at meshes does not ask.
pub(super) fn surface(session: &Session) -> Result<Response, Refusal> {
    let shown = session.shown();
    let bench = shown.bench()?;
    let mut bytes = Vec::new();
    let mut words = Words(&mut bytes);
    for layer in 0..bench.layers().len() {
        let Some(mesh) = bench.texture_mesh(layer) else {
            words.u32(0);
            continue;
        };
        let rings = mesh.topology().boundary_loops();
        words.u32(mesh.topology().vertex_count());
        words.u32(mesh.topology().triangles().len());
        words.u32(mesh.anchors().len());
        words.u32(rings.len());
        for vertex in mesh.topology().triangles().iter().flatten() {
            words.u32(*vertex);
        }
        for anchors in mesh.anchors() {
            for vertex in anchors.iter().flat_map(|anchor| anchor.vertices) {
                words.u32(vertex);
            }
            for share in anchors.iter().flat_map(|anchor| anchor.shares) {
                words.f32(share);
            }
        }
        for ring in &rings {
            words.u32(ring.len());
            for vertex in ring {
                words.u32(*vertex);
            }
        }
    }
    Ok(Response::binary(bytes))
}

/// `GET api/texture`.
pub(super) fn texture(request: &Request, session: &Session) -> Result<Response, Refusal> {
    let shown = session.shown();
    let bench = shown.bench()?;
    let layer = asked_layer(request, bench)?;
    let index = index(request, "index", bench.drawings(layer).len())?;
    let kind = match request.value("kind") {
        None | Some("colour") => Kind::of_frames(bench),
        Some("inside") => Kind::Inside,
        Some("drawing") => Kind::Drawing,
        Some(other) => {
            return Err(Refusal::bad(format!(
                "kind '{other}' is neither colour, inside nor drawing"
            )));
        }
    };
    let (_, png) = session.pictures.picture(&shown, layer, index, kind);
    Ok(Response {
        may_be_kept: request.value("v").is_some(),
        ..Response::new("image/png", png?.as_ref().clone())
    })
}
