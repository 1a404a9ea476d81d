//! Connections: one thread each, nothing shared but the [`Session`].

use std::io::BufReader;
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use anyhow::Context as _;

use super::http::{NoRequest, Request, Response};
use super::problem::Refusal;
use super::security::Gate;
use super::session::Session;
use super::{page, routes, socket};

/// Connections at a time; a browser opens six.
const MOST_CONNECTIONS: usize = 64;
/// How long a connection may say nothing.
const LONGEST_SILENCE: Duration = Duration::from_secs(120);
/// Where a connection becomes a [`socket`].
const SOCKET: &str = "api/socket";

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
                if let Some(key) = socket::key(&request)
                    && gate.admitted(&request) == Some(SOCKET)
                {
                    // It waits for whatever the page asks next.
                    let _ = stream.set_read_timeout(None);
                    let answered = |asked: &Request| unbroken(|| routes::answer(&asked.path, asked, session));
                    return socket::serve(stream, from.buffer(), key, answered);
                }
                (unbroken(|| answer(&request, gate, session)), request.keeps_connection())
            }
            Err(NoRequest::Bad(status)) => (Response::text(status, "this request is not understood\n"), false),
            Err(NoRequest::Closed) => return,
        };
        if response.write(&mut to, keeps).is_err() || !keeps {
            return;
        }
    }
}

/// A bug in one answer does not end the connection.
fn unbroken(answer: impl FnOnce() -> Response) -> Response {
    std::panic::catch_unwind(std::panic::AssertUnwindSafe(answer))
        .unwrap_or_else(|_| Refusal::failed("this request failed inside inbetween").response())
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
    if request.method == "POST" && !is_json() {
        return Response::text(415, "POST application/json\n");
    }
    routes::answer(route, request, session)
}
