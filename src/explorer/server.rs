//! Connections and routes: one thread a connection, nothing shared but the [`Session`].

use std::io::BufReader;
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use anyhow::Context as _;

use super::document::Document;
use super::http::{NoRequest, Request, Response};
use super::problem::Refusal;
use super::security::Gate;
use super::session::Session;
use super::{correspondences, export, frames, gesture, grids, handles, meshes, page, scene_json};

/// Connections at a time; a browser opens six.
const MOST_CONNECTIONS: usize = 64;
/// How long a connection may say nothing.
const LONGEST_SILENCE: Duration = Duration::from_secs(120);
/// How long the state is waited for.
const LONGEST_WAIT: Duration = Duration::from_secs(25);

/// A server that listens, but does not answer yet.
pub(crate) struct Server {
    listener: TcpListener,
    gate: Gate,
}

impl Server {
    /// Listens on the loopback address, at `port` or a free one.
    pub(crate) fn bind(port: Option<u16>) -> anyhow::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port.unwrap_or(0))).with_context(|| match port {
            Some(port) => format!("cannot listen at port {port}; take another, or leave --port out"),
            None => "cannot listen on the loopback address".to_owned(),
        })?;
        let gate = Gate::new(listener.local_addr()?.port())?;
        Ok(Self { listener, gate })
    }

    /// The page's address.
    pub(crate) fn address(&self) -> String {
        self.gate.address()
    }

    /// Answers until the process ends.
    pub(crate) fn run(self, session: &Arc<Session>) {
        let open = Arc::new(AtomicUsize::new(0));
        for stream in self.listener.incoming() {
            // One that broke already.
            let Ok(stream) = stream else { continue };
            if open.load(Ordering::Relaxed) >= MOST_CONNECTIONS {
                continue;
            }
            open.fetch_add(1, Ordering::Relaxed);
            let (session, gate, counted) = (Arc::clone(session), self.gate.clone(), Arc::clone(&open));
            let thread = std::thread::Builder::new()
                .name("connection".to_owned())
                .spawn(move || {
                    serve(&stream, &gate, &session);
                    counted.fetch_sub(1, Ordering::Relaxed);
                });
            if thread.is_err() {
                open.fetch_sub(1, Ordering::Relaxed);
            }
        }
    }
}

/// Answers the requests of one connection.
fn serve(stream: &TcpStream, gate: &Gate, session: &Arc<Session>) {
    // Without it small answers may wait for 40 ms.
    let _ = stream.set_nodelay(true);
    // One that says nothing makes room for another.
    let _ = stream.set_read_timeout(Some(LONGEST_SILENCE));
    let mut from = BufReader::new(stream);
    let mut to = stream;
    loop {
        let (response, keeps) = match Request::read(&mut from) {
            Ok(request) => {
                // A bug in one answer does not end the connection.
                let answer = || answer(&request, gate, session);
                let response = std::panic::catch_unwind(std::panic::AssertUnwindSafe(answer))
                    .unwrap_or_else(|_| Refusal::failed("this request failed inside inbetween").response());
                (response, request.keeps_connection())
            }
            Err(NoRequest::Bad(status)) => (Response::text(status, "this request is not understood\n"), false),
            Err(NoRequest::Closed) => return,
        };
        if response.write(&mut to, keeps).is_err() || !keeps {
            return;
        }
    }
}

fn answer(request: &Request, gate: &Gate, session: &Arc<Session>) -> Response {
    let Some(path) = gate.admitted(request) else {
        return Response::text(403, "open the address that inbetween printed\n");
    };
    let Some(route) = path.strip_prefix("api/") else {
        return match (page::file(path), request.method.as_str()) {
            (Some((content_type, bytes)), "GET") => Response::new(content_type, bytes),
            (Some(_), _) => Response::text(405, "GET this\n"),
            (None, _) => Response::text(404, "there is no such page\n"),
        };
    };
    let is_json = || {
        let content_type = request.header("content-type").unwrap_or_default();
        content_type.split(';').next().map(str::trim) == Some("application/json")
    };
    match request.method.as_str() {
        "GET" => {}
        "POST" if !is_json() => return Response::text(415, "POST application/json\n"),
        "POST" => {}
        _ => return Response::text(405, "GET or POST\n"),
    }
    api(route, request, session).unwrap_or_else(|refusal| refusal.response())
}

/// The routes of the page of the [explorer](super).
fn api(route: &str, request: &Request, session: &Arc<Session>) -> Result<Response, Refusal> {
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
        ("GET", "texture") => meshes::texture(request, session),
        ("GET", "drawing") => correspondences::drawing(request, session),
        ("GET", "correspondences") => correspondences::correspondences(request, session),
        ("GET", "grid") => grids::weights(request, session),
        ("GET", "validity") => grids::validity(request, session),
        ("POST", "carry") => correspondences::carry(body, session),
        ("POST", "edit") => json(session.edit(body)?),
        ("POST", "undo") => json(session.step(Document::undo)?),
        ("POST", "redo") => json(session.step(Document::redo)?),
        ("POST", "save") => json(session.save()),
        ("POST", "conflict") => json(session.end_conflict(body)?),
        ("POST", "deform") => handles::deform(body, session),
        ("POST", "reach") => handles::reach_place(body, session),
        ("POST", "path") => json(gesture::path(body, session)?),
        ("POST", "gesture") => json(gesture::gesture(body, session)?),
        ("POST", "export") => json(export::start(body, session)?),
        ("POST", "export/cancel") => json(export::cancel(session)?),
        ("POST", "command") => json(export::command(body, session)?),
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
    "texture",
    "drawing",
    "correspondences",
    "grid",
    "validity",
    "carry",
    "edit",
    "undo",
    "redo",
    "save",
    "conflict",
    "deform",
    "reach",
    "path",
    "gesture",
    "export",
    "export/cancel",
    "command",
];
