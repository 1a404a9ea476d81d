//! As much of HTTP/1.1 as a browser on the same machine needs: requests read (their heads by `httparse`), answers written, connections
//! kept.
//!
//! Every answer goes out in one piece and without delay (`TCP_NODELAY`): a frame must not wait for a full packet. Small server crates
//! write head and body apart and leave the delay on, which costs up to 40 ms an answer.

use std::io::{self, BufRead, Read, Write};

use percent_encoding::percent_decode_str;

/// Of every answer. Nothing is loaded from elsewhere, nobody frames the page, and its address is told to nobody.
const HEADERS: &str = "Content-Security-Policy: default-src 'self'; img-src 'self' blob: data:; base-uri 'none'; \
    form-action 'none'; frame-ancestors 'none'; object-src 'none'\r\n\
    Referrer-Policy: no-referrer\r\nX-Content-Type-Options: nosniff\r\nX-Frame-Options: DENY\r\n\
    Cross-Origin-Resource-Policy: same-origin\r\nCross-Origin-Opener-Policy: same-origin\r\n";

/// The longest head of a request.
const MOST_HEAD: u64 = 32 * 1024;
/// The most headers of a request.
const MOST_HEADERS: usize = 64;
/// The longest body of a request.
pub(super) const MOST_BODY: usize = 16 * 1024 * 1024;

/// A request.
#[derive(Debug, Clone, Default)]
pub(crate) struct Request {
    pub(crate) method: String,
    /// Decoded, without the query.
    pub(crate) path: String,
    /// Decoded, in order.
    pub(crate) query: Vec<(String, String)>,
    /// Names in lower case.
    headers: Vec<(String, String)>,
    pub(crate) body: Vec<u8>,
}

/// Why there is no request.
#[derive(Debug)]
pub(crate) enum NoRequest {
    /// The other side has closed the connection, or it broke.
    Closed,
    /// It is none that is understood; the status that says so.
    Bad(u16),
}

impl From<io::Error> for NoRequest {
    fn from(_: io::Error) -> Self {
        Self::Closed
    }
}

impl Request {
    /// Reads the next request of a connection.
    pub(crate) fn read(from: &mut impl BufRead) -> Result<Self, NoRequest> {
        let bytes = head(&mut from.take(MOST_HEAD))?;
        let mut headers = [httparse::EMPTY_HEADER; MOST_HEADERS];
        let mut head = httparse::Request::new(&mut headers);
        match head.parse(&bytes) {
            Ok(httparse::Status::Complete(_)) => {}
            Err(httparse::Error::TooManyHeaders) => return Err(NoRequest::Bad(431)),
            Ok(httparse::Status::Partial) | Err(_) => return Err(NoRequest::Bad(400)),
        }
        let (path, query) = target(head.path.unwrap_or_default()).ok_or(NoRequest::Bad(400))?;
        let header = |header: &httparse::Header<'_>| {
            let value = std::str::from_utf8(header.value).map_err(|_| NoRequest::Bad(400))?;
            Ok((header.name.to_ascii_lowercase(), value.trim().to_owned()))
        };
        let mut request = Self {
            method: head.method.unwrap_or_default().to_owned(),
            path,
            query,
            headers: head.headers.iter().map(header).collect::<Result<_, NoRequest>>()?,
            body: Vec::new(),
        };
        // Two of these could be read in two ways.
        let doubled = |name: &str| request.headers.iter().filter(|(n, _)| n == name).count() > 1;
        if doubled("host") || doubled("content-length") || request.header("transfer-encoding").is_some() {
            return Err(NoRequest::Bad(400));
        }
        if let Some(length) = request.header("content-length") {
            let length: usize = length.parse().map_err(|_| NoRequest::Bad(400))?;
            if length > MOST_BODY {
                return Err(NoRequest::Bad(413));
            }
            let mut body = vec![0; length];
            from.read_exact(&mut body)?;
            request.body = body;
        }
        Ok(request)
    }

    /// The request that a message `METHOD ROUTE?QUERY`, a line break, and the body is; the route is its path.
    pub(crate) fn from_message(text: &str) -> Option<Self> {
        let (line, body) = text.split_once('\n')?;
        let (method, of) = line.split_once(' ')?;
        let (path, query) = target(of)?;
        Some(Self {
            method: method.to_owned(),
            path,
            query,
            headers: Vec::new(),
            body: body.as_bytes().to_vec(),
        })
    }

    /// A header by its name in lower case.
    pub(crate) fn header(&self, name: &str) -> Option<&str> {
        self.headers.iter().find(|(n, _)| n == name).map(|(_, v)| v.as_str())
    }

    /// Whether the connection is kept after it.
    pub(crate) fn keeps_connection(&self) -> bool {
        !self
            .header("connection")
            .is_some_and(|value| value.eq_ignore_ascii_case("close"))
    }

    /// A value of the query.
    pub(crate) fn value(&self, name: &str) -> Option<&str> {
        self.query.iter().find(|(n, _)| n == name).map(|(_, v)| v.as_str())
    }
}

/// The bytes up to the empty line that ends a head.
fn head(from: &mut impl BufRead) -> Result<Vec<u8>, NoRequest> {
    let mut bytes = Vec::new();
    loop {
        let before = bytes.len();
        from.read_until(b'\n', &mut bytes)?;
        let line = &bytes[before..];
        match line {
            [] if before == 0 => return Err(NoRequest::Closed),
            // Either cut off, or too long.
            line if line.last() != Some(&b'\n') => return Err(NoRequest::Bad(431)),
            // A client may send an empty line before a request.
            b"\n" | b"\r\n" if bytes.iter().any(|byte| !byte.is_ascii_whitespace()) => return Ok(bytes),
            _ => {}
        }
    }
}

/// The path and the query of a target, decoded.
fn target(text: &str) -> Option<(String, Vec<(String, String)>)> {
    let (path, query) = text.split_once('?').unwrap_or((text, ""));
    Some((decoded(path)?, pairs(query)?))
}

/// Undoes the percent encoding; nothing if it is none. A plus is the sign of a number rather than a space.
fn decoded(text: &str) -> Option<String> {
    let is_code = |code: &str| {
        code.get(..2)
            .is_some_and(|digits| digits.bytes().all(|d| d.is_ascii_hexdigit()))
    };
    if !text.split('%').skip(1).all(is_code) {
        return None;
    }
    Some(percent_decode_str(text).decode_utf8().ok()?.into_owned())
}

fn pairs(query: &str) -> Option<Vec<(String, String)>> {
    query
        .split('&')
        .filter(|part| !part.is_empty())
        .map(|part| {
            let (name, value) = part.split_once('=').unwrap_or((part, ""));
            Some((decoded(name)?, decoded(value)?))
        })
        .collect()
}

/// An answer.
#[derive(Debug, Clone)]
pub(crate) struct Response {
    pub(crate) status: u16,
    pub(crate) content_type: &'static str,
    pub(crate) body: Vec<u8>,
    /// Whether the browser may keep it.
    pub(crate) may_be_kept: bool,
}

impl Response {
    pub(crate) fn new(content_type: &'static str, body: impl Into<Vec<u8>>) -> Self {
        Self {
            status: 200,
            content_type,
            body: body.into(),
            may_be_kept: false,
        }
    }

    pub(crate) fn binary(body: Vec<u8>) -> Self {
        Self::new("application/octet-stream", body)
    }

    pub(crate) fn json(value: &serde_json::Value) -> Self {
        Self::new("application/json", value.to_string())
    }

    /// A short text for people.
    pub(crate) fn text(status: u16, text: &str) -> Self {
        Self {
            status,
            ..Self::new("text/plain; charset=utf-8", text)
        }
    }

    pub(crate) fn with_status(self, status: u16) -> Self {
        Self { status, ..self }
    }

    /// Writes it in one piece.
    pub(crate) fn write(&self, to: &mut impl Write, keeps_connection: bool) -> io::Result<()> {
        let mut out = Vec::with_capacity(self.body.len() + 512);
        let reason = match self.status {
            200 => "OK",
            400 => "Bad Request",
            403 => "Forbidden",
            404 => "Not Found",
            405 => "Method Not Allowed",
            409 => "Conflict",
            413 => "Content Too Large",
            415 => "Unsupported Media Type",
            431 => "Request Header Fields Too Large",
            _ => "Internal Server Error",
        };
        let cache = if self.may_be_kept {
            "private, max-age=31536000, immutable"
        } else {
            "no-store"
        };
        let connection = if keeps_connection { "keep-alive" } else { "close" };
        write!(
            out,
            "HTTP/1.1 {} {reason}\r\nContent-Type: {}\r\nContent-Length: {}\r\nConnection: {connection}\r\n\
             Cache-Control: {cache}\r\n{}\r\n",
            self.status,
            self.content_type,
            self.body.len(),
            HEADERS,
        )?;
        out.extend_from_slice(&self.body);
        to.write_all(&out)?;
        to.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Request, NoRequest> {
        Request::read(&mut text.as_bytes())
    }

    #[test]
    fn a_request_is_taken_apart() {
        let text =
            "POST /t/api/frame?at=-1,%2B2&x=+1&at=0 HTTP/1.1\r\nHost: localhost:1\r\nContent-Length: 2\r\n\r\n{}rest";
        let request = read(text).expect("a request");
        assert_eq!(
            (request.method.as_str(), request.path.as_str()),
            ("POST", "/t/api/frame")
        );
        let all: Vec<&str> = request.query.iter().map(|(_, value)| value.as_str()).collect();
        assert_eq!(all, ["-1,+2", "+1", "0"]);
        assert_eq!(request.value("x"), Some("+1"));
        assert_eq!(
            (request.header("host"), request.body.as_slice()),
            (Some("localhost:1"), &b"{}"[..])
        );
        assert!(request.keeps_connection());
    }

    #[test]
    fn a_message_is_a_request_without_headers() {
        let request = Request::from_message("POST edit?x=%2B1\n{\"a\":\n1}").expect("a request");
        assert_eq!((request.method.as_str(), request.path.as_str()), ("POST", "edit"));
        assert_eq!(
            (request.value("x"), &request.body[..]),
            (Some("+1"), &b"{\"a\":\n1}"[..])
        );
        for bad in ["", "GET state", "GET\n", "GET %zz\n"] {
            assert!(Request::from_message(bad).is_none(), "{bad}");
        }
    }

    #[test]
    fn what_could_be_read_in_two_ways_is_refused() {
        for bad in [
            "GET /\r\n\r\n",
            "GET / HTTP/2\r\n\r\n",
            "GET /%zz HTTP/1.1\r\n\r\n",
            "GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n",
            "GET / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n",
            "GET / HTTP/1.1\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\nab",
            "GET / HTTP/1.1\r\nContent-Length: x\r\n\r\n",
            "GET / HTTP/1.1\r\nA b: c\r\n\r\n",
            "GET / HTTP/1.1\r\nA: \u{1}\r\n\r\n",
        ] {
            assert!(matches!(read(bad), Err(NoRequest::Bad(400))), "{bad}");
        }
        let long = format!("GET /{} HTTP/1.1\r\n\r\n", "a".repeat(40_000));
        assert!(matches!(read(&long), Err(NoRequest::Bad(431))));
        assert!(matches!(
            read("GET / HTTP/1.1\r\nContent-Length: 99999999\r\n\r\n"),
            Err(NoRequest::Bad(413))
        ));
        assert!(matches!(read(""), Err(NoRequest::Closed)));
    }
}
