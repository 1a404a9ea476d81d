//! The routes below `api/`, whichever way a request comes.

use std::sync::Arc;
use std::time::Duration;

use super::document::Document;
use super::http::{Request, Response};
use super::problem::Refusal;
use super::session::Session;
use super::{correspondences, export, figures, frames, gesture, grids, handles, keeping, meshes, scene_json};

/// How long the state is waited for.
const LONGEST_WAIT: Duration = Duration::from_secs(25);

/// The answer to a request for a route.
pub(super) fn answer(route: &str, request: &Request, session: &Arc<Session>) -> Response {
    match request.method.as_str() {
        "GET" | "POST" => computed(route, request, session).unwrap_or_else(|refusal| refusal.response()),
        _ => Response::text(405, "GET or POST\n"),
    }
}

fn computed(route: &str, request: &Request, session: &Arc<Session>) -> Result<Response, Refusal> {
    let json = |value| Ok(Response::json(&value));
    let body = &request.body;
    match (request.method.as_str(), route) {
        ("GET", "state") => match request.value("after") {
            None => json(session.state_json()),
            Some(after) => {
                let after = after.parse().map_err(|_| Refusal::bad("`after` is no number"))?;
                json(session.state_after(after, LONGEST_WAIT))
            }
        },
        ("GET", "text") => Ok(Response::text(200, &session.text())),
        ("GET", "scene") => json(scene_json::scene(session)),
        ("GET", "frame") => frames::frame(request, session),
        ("GET", "curves") => frames::curves(request, session),
        ("GET", "weights") => frames::weights(request, session),
        ("GET", "puppet") => meshes::puppet(session),
        ("GET", "mesh") => meshes::mesh(session),
        ("GET", "surface") => meshes::surface(session),
        ("GET", "texture") => meshes::texture(request, session),
        ("GET", "drawing") => correspondences::drawing(request, session),
        ("GET", "correspondences") => correspondences::correspondences(request, session),
        ("GET", "figure") => figures::figure(request, session),
        ("GET", "sheet") => figures::sheet(request, session),
        ("GET", "grid") => grids::weights(request, session),
        ("GET", "validity") => grids::validity(request, session),
        ("POST", "carry") => correspondences::carry(body, session),
        ("POST", "edit") => json(session.edit(body)?),
        ("POST", "undo") => json(session.step(Document::undo)?),
        ("POST", "redo") => json(session.step(Document::redo)?),
        ("POST", "save") => json(session.save()),
        ("POST", "keep") => json(keeping::keep(body, session)?),
        ("POST", "conflict") => json(session.end_conflict(body)?),
        ("POST", "deform") => handles::deform(body, session),
        ("POST", "reach") => handles::reach_place(body, session),
        ("POST", "path") => json(gesture::path(body, session)?),
        ("POST", "gesture") => json(gesture::gesture(body, session)?),
        ("POST", "export") => json(export::start(body, session)?),
        ("POST", "export/cancel") => json(export::cancel(session)?),
        ("POST", "command") => json(export::command(body, session)?),
        ("GET", "socket") => Err(Refusal::bad("open a WebSocket here")),
        (_, route) if ROUTES.contains(&route) => Ok(Response::text(405, "another method is meant\n")),
        _ => Ok(Response::text(404, "there is no such address\n")),
    }
}

/// All routes.
const ROUTES: &[&str] = &[
    "state",
    "text",
    "scene",
    "frame",
    "curves",
    "weights",
    "puppet",
    "mesh",
    "surface",
    "texture",
    "drawing",
    "correspondences",
    "figure",
    "sheet",
    "grid",
    "validity",
    "carry",
    "edit",
    "undo",
    "redo",
    "save",
    "keep",
    "conflict",
    "deform",
    "reach",
    "path",
    "gesture",
    "export",
    "export/cancel",
    "command",
    "socket",
];
