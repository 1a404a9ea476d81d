//! Requests over a connection that stays open: the WebSocket at `api/socket`.
//!
//! For a browser a request of its own is costly: 3 to 5 ms on a machine that is drawing, of the 17 between two displayed frames. A message
//! on an open connection takes one. The messages are requests and answers like any others, in turn:
//!
//! - to here, text: `METHOD ROUTE?QUERY`, and after a line break the body;
//! - from here, binary: the status as u32, little-endian, then the body.
//!
//! The protocol is tungstenite's (RFC 6455); who may open one is asked before, as of every request.

use std::io::Write as _;
use std::net::TcpStream;

use tungstenite::handshake::derive_accept_key;
use tungstenite::protocol::{Role, WebSocketConfig};
use tungstenite::{Message, WebSocket};

use super::http::{MOST_BODY, Request, Response};

/// The key of a request that asks for a WebSocket.
pub(super) fn key(request: &Request) -> Option<&str> {
    let says = |name: &str, word: &str| {
        let words = request.header(name).unwrap_or_default().split(',');
        words.map(str::trim).any(|own| own.eq_ignore_ascii_case(word))
    };
    let is_asked_for = request.method == "GET"
        && says("upgrade", "websocket")
        && says("connection", "upgrade")
        && says("sec-websocket-version", "13");
    request.header("sec-websocket-key").filter(|_| is_asked_for)
}

/// Answers the messages of a connection whose request had this `key` until it ends; `read` is what was read of it beyond the request.
pub(super) fn serve(stream: &TcpStream, read: &[u8], key: &str, answer: impl Fn(&Request) -> Response) {
    let accepted = derive_accept_key(key.as_bytes());
    let head = format!(
        "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: {accepted}\r\n\r\n"
    );
    let mut to = stream;
    if to.write_all(head.as_bytes()).is_err() {
        return;
    }
    let limits = WebSocketConfig::default()
        .max_message_size(Some(MOST_BODY))
        .max_frame_size(Some(MOST_BODY));
    let mut socket = WebSocket::from_partially_read(stream, read.to_vec(), Role::Server, Some(limits));
    // An error is the end, also the one that says so.
    while let Ok(message) = socket.read() {
        let response = match message {
            Message::Text(text) => match Request::from_message(&text) {
                Some(request) => answer(&request),
                None => Response::text(400, "this message is not understood\n"),
            },
            Message::Binary(_) => Response::text(400, "send text\n"),
            // Answered by `read` itself.
            Message::Ping(_) | Message::Pong(_) | Message::Close(_) | Message::Frame(_) => continue,
        };
        if socket.send(Message::binary(packed(&response))).is_err() {
            return;
        }
    }
}

fn packed(response: &Response) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(4 + response.body.len());
    bytes.extend_from_slice(&u32::from(response.status).to_le_bytes());
    bytes.extend_from_slice(&response.body);
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asking(headers: &str) -> Request {
        Request::read(&mut format!("GET /t/api/socket HTTP/1.1\r\nHost: localhost:1\r\n{headers}\r\n").as_bytes())
            .expect("a request")
    }

    #[test]
    fn a_socket_is_asked_for_in_full() {
        let whole = "Upgrade: WebSocket\r\nConnection: keep-alive, Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: abc\r\n";
        assert_eq!(key(&asking(whole)), Some("abc"));
        for line in whole.split_inclusive("\r\n") {
            assert_eq!(key(&asking(&whole.replace(line, ""))), None, "{line}");
        }
    }

    #[test]
    fn an_answer_is_its_status_and_its_body() {
        assert_eq!(packed(&Response::text(409, "no")), [0x99, 1, 0, 0, b'n', b'o']);
    }
}
