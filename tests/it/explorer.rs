//! `inbetween explore`: who is answered, what, and what becomes of the scene file.

#![cfg(feature = "explorer")]

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use inbetween::export::{png_bytes, svg_text};
use inbetween::math::Point;

use inbetween::render::Frame;
use inbetween::scene::Scene;
use serde_json::{Value, json};
use tungstenite::protocol::Role;
use tungstenite::{Message, WebSocket};

/// How long anything may take on a busy machine.
const PATIENCE: Duration = Duration::from_secs(120);

fn inbetween() -> Command {
    Command::new(env!("CARGO_BIN_EXE_inbetween"))
}

/// A running explorer of a copy of a scene; ended when dropped.
struct Explorer {
    child: Child,
    folder: tempfile::TempDir,
    port: u16,
    token: String,
}

impl Drop for Explorer {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// An answer.
struct Answer {
    status: u16,
    head: String,
    body: Vec<u8>,
}

impl Answer {
    fn json(&self) -> Value {
        serde_json::from_slice(&self.body).unwrap_or_else(|_| panic!("{}", String::from_utf8_lossy(&self.body)))
    }

    fn words(&self) -> Vec<u32> {
        assert_eq!(self.status, 200, "{}", String::from_utf8_lossy(&self.body));
        let words = self.body.chunks_exact(4);
        words.map(|w| u32::from_le_bytes([w[0], w[1], w[2], w[3]])).collect()
    }
}

fn floats(words: &[u32]) -> Vec<f32> {
    words.iter().map(|word| f32::from_bits(*word)).collect()
}

impl Explorer {
    /// Explores a copy of `data/NAME`, with its text changed.
    fn of(name: &str, change: impl FnOnce(String) -> String) -> Self {
        let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("data").join(name);
        let folder = tempfile::tempdir().expect("a folder");
        for entry in std::fs::read_dir(data).expect("the data") {
            let entry = entry.expect("an entry");
            std::fs::copy(entry.path(), folder.path().join(entry.file_name())).expect("copied");
        }
        let scene = folder.path().join("scene.toml");
        let text = change(std::fs::read_to_string(&scene).expect("readable"));
        std::fs::write(&scene, text).expect("written");
        Self::within(folder)
    }

    /// Explores the scene of a folder.
    fn within(folder: tempfile::TempDir) -> Self {
        Self::started(folder, &["scene.toml"])
    }

    /// Explores what the arguments name, in a folder.
    fn started(folder: tempfile::TempDir, arguments: &[&str]) -> Self {
        let mut child = inbetween()
            .args(["explore", "--no-open"])
            .args(arguments)
            .env("TMPDIR", folder.path())
            .current_dir(folder.path())
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .spawn()
            .expect("it starts");
        let mut address = String::new();
        let printed = child.stdout.take().expect("piped");
        BufReader::new(printed).read_line(&mut address).expect("an address");
        let rest = address
            .trim()
            .strip_prefix("http://127.0.0.1:")
            .expect("on this machine");
        let (port, token) = rest.split_once('/').expect("a token");
        Self {
            child,
            folder,
            port: port.parse().expect("a port"),
            token: token.trim_end_matches('/').to_owned(),
        }
    }

    fn scene(&self) -> PathBuf {
        self.folder.path().join("scene.toml")
    }

    fn text(&self) -> String {
        std::fs::read_to_string(self.scene()).expect("readable")
    }

    /// Sends these very lines.
    fn raw(&self, head: &str, body: &str) -> Answer {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).expect("it listens");
        stream.set_read_timeout(Some(PATIENCE)).expect("set");
        write!(
            stream,
            "{head}Connection: close\r\nContent-Length: {}\r\n\r\n{body}",
            body.len()
        )
        .expect("sent");
        let mut bytes = Vec::new();
        stream.read_to_end(&mut bytes).expect("an answer");
        let end = bytes.windows(4).position(|w| w == b"\r\n\r\n").expect("a head");
        let head = String::from_utf8(bytes[..end].to_vec()).expect("text");
        let status = head.split(' ').nth(1).and_then(|s| s.parse().ok()).expect("a status");
        Answer {
            status,
            head,
            body: bytes[end + 4..].to_vec(),
        }
    }

    fn get(&self, route: &str) -> Answer {
        let head = format!(
            "GET /{}/{route} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n",
            self.token, self.port
        );
        self.raw(&head, "")
    }

    fn post(&self, route: &str, body: &Value) -> Answer {
        let head = format!(
            "POST /{}/{route} HTTP/1.1\r\nHost: localhost:{}\r\nOrigin: http://localhost:{}\r\nContent-Type: application/json\r\n",
            self.token, self.port, self.port
        );
        self.raw(&head, &body.to_string())
    }

    /// The first state of which this is true.
    fn state_when(&self, is_it: impl Fn(&Value) -> bool) -> Value {
        let start = Instant::now();
        let mut state = self.get("api/state").json();
        while !is_it(&state) {
            assert!(start.elapsed() < PATIENCE, "still {state}");
            state = self.get(&format!("api/state?after={}", state["seq"])).json();
        }
        state
    }

    /// When everything is computed.
    fn settled(&self) -> Value {
        self.state_when(|state| state["working"] == false)
    }

    fn weights(&self, place: &str) -> Vec<f64> {
        let answer = self.get(&format!("api/weights?at={place}")).json();
        serde_json::from_value(answer[0]["weights"].clone()).expect("weights")
    }

    fn edit(&self, ops: Value) -> Answer {
        self.post("api/edit", &json!({ "ops": ops }))
    }
}

/// The weights that the command gives.
fn command_weights(scene: &Path, place: &str) -> Vec<f64> {
    let output = inbetween()
        .args(["weights"])
        .arg(scene)
        .arg(format!("--at={place}"))
        .output()
        .expect("it runs");
    assert!(output.status.success());
    let answer: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    serde_json::from_value(answer["weights"].clone()).expect("weights")
}

fn as_it_is(text: String) -> String {
    text
}

#[test]
fn only_the_own_page_is_answered() {
    let explorer = Explorer::of("clown", as_it_is);
    let page = explorer.get("");
    assert_eq!(page.status, 200);
    assert!(
        page.head.contains("default-src 'self'") && !page.head.to_lowercase().contains("access-control"),
        "{}",
        page.head
    );
    let (port, token) = (explorer.port, &explorer.token);
    let own = format!("Host: 127.0.0.1:{port}\r\n");
    for (request, headers) in [
        ("GET /".to_owned(), own.clone()),
        ("GET /api/state".to_owned(), own.clone()),
        (
            "GET /00000000000000000000000000000000/api/state".to_owned(),
            own.clone(),
        ),
        (format!("GET /{token}/api/state"), String::new()),
        (
            format!("GET /{token}/api/state"),
            format!("Host: evil.example:{port}\r\n"),
        ),
        (
            format!("GET /{token}/api/state"),
            format!("{own}Origin: http://evil.example\r\n"),
        ),
        (
            format!("GET /{token}/api/state"),
            format!("{own}Sec-Fetch-Site: cross-site\r\n"),
        ),
        (
            format!("POST /{token}/api/undo"),
            format!("{own}Origin: null\r\nContent-Type: application/json\r\n"),
        ),
    ] {
        let answer = explorer.raw(&format!("{request} HTTP/1.1\r\n{headers}"), "");
        assert_eq!(answer.status, 403, "{request} {headers}");
        assert!(!String::from_utf8_lossy(&answer.body).contains(token.as_str()));
    }
    let plain = explorer.raw(
        &format!("POST /{token}/api/edit HTTP/1.1\r\n{own}Content-Type: text/plain\r\n"),
        "{}",
    );
    assert_eq!(plain.status, 415);
    assert_eq!(explorer.get("../../etc/passwd").status, 404);
    assert_eq!(explorer.get("api/nothing").status, 404);
    assert_eq!(explorer.get("api/edit").status, 405);
    assert_eq!(explorer.post("api/undo", &json!({})).status, 409);
}

#[test]
fn a_connection_that_stays_open_answers_the_same() {
    let explorer = Explorer::of("clown", as_it_is);
    explorer.settled();
    let upgrade = "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
    let asking = |token: &str, origin: &str| {
        let mut stream = TcpStream::connect(("127.0.0.1", explorer.port)).expect("it listens");
        stream.set_read_timeout(Some(PATIENCE)).expect("set");
        write!(
            stream,
            "GET /{token}/api/socket HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nOrigin: {origin}\r\n{upgrade}\r\n",
            explorer.port
        )
        .expect("sent");
        let mut from = BufReader::new(stream);
        let mut head = String::new();
        while !head.ends_with("\r\n\r\n") {
            assert!(from.read_line(&mut head).expect("an answer") > 0, "{head}");
        }
        (head, from.into_inner())
    };
    let own = format!("http://127.0.0.1:{}", explorer.port);
    for (token, origin) in [
        (explorer.token.as_str(), "http://evil.example"),
        ("0123456789abcdef0123456789abcdef", own.as_str()),
    ] {
        assert!(asking(token, origin).0.starts_with("HTTP/1.1 403 "), "{token} {origin}");
    }
    let (head, stream) = asking(&explorer.token, &own);
    // The example of RFC 6455, 1.3.
    assert!(head.contains("s3pPLMBiTxaQ9kYGzzhZRbK+xOo="), "{head}");
    let mut socket = WebSocket::from_raw_socket(stream, Role::Client, None);
    let mut asked = |message: Message| {
        socket.send(message).expect("sent");
        let bytes = socket.read().expect("an answer").into_data();
        let status = u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
        (status, bytes[4..].to_vec())
    };
    for route in ["frame?at=0.3,0.4&silhouette=1", "mesh", "scene", "weights?at=%2B0.1,0"] {
        let by_itself = explorer.get(&format!("api/{route}"));
        let answer = asked(Message::text(format!("GET {route}\n")));
        assert_eq!(answer, (u32::from(by_itself.status), by_itself.body), "{route}");
    }
    for (message, status) in [
        (Message::text("GET frame\n"), 400),
        (Message::text("GET"), 400),
        (Message::binary(vec![1, 2, 3]), 400),
        (Message::text("GET nothing\n"), 404),
        (Message::text("PUT scene\n"), 405),
        (Message::text("POST undo\n{}"), 409),
    ] {
        assert_eq!(asked(message.clone()).0, status, "{message}");
    }
    let edit = json!({"ops": [{"op": "set", "table": "texture", "key": "sharpness", "value": 0.25}]});
    assert_eq!(asked(Message::text(format!("POST edit\n{edit}"))).0, 200);
    assert!(explorer.text().contains("sharpness = 0.25"));
}

#[test]
fn frames_are_those_of_the_command() {
    for name in ["clown", "bear"] {
        let explorer = Explorer::of(name, as_it_is);
        assert_eq!(explorer.settled()["problems"], json!([]));
        let scene = Scene::open(&explorer.scene()).expect("a scene");
        let character = scene
            .character(scene.animation.size.map(|side| side as usize), 1)
            .expect("a character");
        for place in [[0.3, 0.0], [0.8, 0.4]] {
            let place = &place[..scene.dimension()];
            let text = place.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
            let words = explorer.get(&format!("api/frame?at={text}&silhouette=1")).words();
            let posed = character.posed_at(place).expect("posed");
            let (poses, layers) = (words[3] as usize, words[4] as usize);
            assert_eq!(
                (words[0] as usize, poses, layers),
                (4 * words.len(), scene.poses.len(), posed.layers.len())
            );
            assert_eq!(words[5] as usize, posed.flipped());
            let order: Vec<usize> = words[6 + 2 * poses..][..layers].iter().map(|k| *k as usize).collect();
            assert_eq!(order, posed.order);
            let mut at = 6 + 2 * poses + layers;
            for (layer, shape) in posed.layers.iter().zip(character.layers()) {
                let [v, p, k, t, r] = [0, 1, 2, 3, 4].map(|i| words[at + i] as usize);
                assert_eq!((v, p), (layer.positions.len(), layer.weights.len()));
                assert_eq!(t, shape.mapping().poses.topology().triangles().len());
                assert_eq!(floats(&words[at + 5..=at + 5]), [layer.opacity as f32]);
                let wanted: Vec<f32> = layer.positions.iter().flat_map(|q| [q.x as f32, q.y as f32]).collect();
                assert_eq!(floats(&words[at + 6..][..2 * v]), wanted, "{name} at {place:?}");
                let textures = floats(&words[at + 6 + 2 * v + p..][..k]);
                assert!((textures.iter().sum::<f32>() - 1.0).abs() < 1e-5);
                at += 6 + 2 * v + p + k + t.div_ceil(32);
                let outlines = at;
                for _ in 0..r {
                    at += 1 + 2 * words[at] as usize;
                }
                if layers == 1 {
                    // With thin outlines it differs in them alone.
                    let thin = explorer
                        .get(&format!("api/frame?at={text}&silhouette=1&tolerance=0.5"))
                        .words();
                    assert_eq!(thin[6..outlines], words[6..outlines]);
                    assert!(2 * (thin.len() - outlines) < words.len() - outlines);
                }
            }
            assert_eq!(at, words.len());
            let curves = explorer.get(&format!("api/curves?at={text}"));
            let mut frame = character.draw(&posed);
            frame.background = None;
            assert_eq!(
                String::from_utf8(curves.body).expect("text"),
                svg_text(&frame).expect("a frame")
            );
        }
        let puppet = explorer.get("api/puppet").json();
        assert_eq!(puppet["layers"][0]["curves"], json!(name == "bear"));
        // Every pose by itself, one after the other.
        let alone = explorer.get("api/frame?poses=all").words();
        let mut at = 0;
        for pose in 0..scene.poses.len() {
            let weights = floats(&alone[at + 6..][..scene.poses.len()]);
            assert!((0..weights.len()).all(|k| weights[k] == f32::from(u8::from(k == pose))));
            at += alone[at] as usize / 4;
        }
        assert_eq!(at, alone.len());
        let camera = &explorer.get("api/scene").json()["camera"];
        let origin = character.camera().to_pixels(Point::zeros());
        assert_eq!(
            (camera["scale"].as_f64(), camera["shift"][0].as_f64()),
            (Some(character.camera().scale()), Some(origin.x))
        );
        let mesh = explorer.get("api/mesh").words();
        assert_eq!(
            mesh[0] as usize,
            character.layers()[0].mapping().poses.topology().vertex_count()
        );
        let picture = explorer.get("api/texture?layer=0&index=0&kind=drawing");
        assert_eq!(&picture.body[1..4], b"PNG");
        assert_eq!(&explorer.get("api/drawing?pose=1&max=64").body[1..4], b"PNG");
        assert_eq!(explorer.get("api/frame?at=nowhere").status, 400);
        assert_eq!(explorer.get("api/frame?at=1,2,3,4,5").status, 400);
        assert_eq!(explorer.get("api/frame").status, 400);
        assert_eq!(
            explorer.get("api/frame?at=0.1,0.1&silhouette=1&tolerance=-1").status,
            400
        );
    }
}

#[test]
fn an_edit_is_saved_and_undo_gives_the_bytes_back() {
    let explorer = Explorer::of("bear", |text| text.replace("version = 1", "version = 1   # kept\r"));
    let before = explorer.text();
    let name = explorer.get("api/scene").json()["poses"][1]["name"].clone();
    explorer.settled();
    let there = explorer.weights("0.4,0.3");
    assert_eq!(there, command_weights(&explorer.scene(), "0.4,0.3"));
    // While it is dragged, the weights follow and the file stays.
    let ops = json!([{"op": "move_pose", "pose": name, "at": [0.37, 0.91]}]);
    let dragged = explorer.post("api/edit", &json!({"ops": ops, "phase": "drag"})).json();
    assert_eq!((&dragged["dragging"], &dragged["saved"]), (&json!(true), &json!(false)));
    let moved = explorer.weights("0.37,0.91");
    assert!((moved[1] - 1.0).abs() < 1e-6, "{moved:?}");
    assert_eq!(explorer.text(), before);
    let cancelled = explorer.post("api/edit", &json!({"ops": [], "phase": "cancel"})).json();
    assert_eq!(cancelled["dragging"], false);
    explorer.settled();
    assert_eq!(explorer.weights("0.4,0.3"), there);
    // Let go, it is saved.
    let done = explorer.edit(ops).json();
    assert_eq!(
        (
            &done["saved"],
            done["undo"].as_str().map(|label| label.contains("move pose"))
        ),
        (&json!(true), Some(true))
    );
    assert!(explorer.text().contains("[0.37, 0.91]") && explorer.text().contains("# kept"));
    explorer.settled();
    assert_eq!(
        explorer.weights("0.4,0.3"),
        command_weights(&explorer.scene(), "0.4,0.3")
    );
    assert_eq!(explorer.post("api/undo", &json!({})).status, 200);
    assert_eq!(explorer.text(), before);
    assert_eq!(explorer.post("api/redo", &json!({})).status, 200);
    assert!(explorer.text().contains("[0.37, 0.91]"));
    // What the format refuses changes nothing.
    let other = explorer.get("api/scene").json()["poses"][0]["at"].clone();
    let refused = explorer.edit(json!([{"op": "move_pose", "pose": name, "at": other}]));
    assert_eq!(
        (refused.status, refused.json()["error"]["where"].as_str()),
        (409, Some("space"))
    );
    assert!(explorer.text().contains("[0.37, 0.91]"));
}

#[test]
fn a_change_from_outside_is_noticed() {
    let explorer = Explorer::of("clown", as_it_is);
    let first = explorer.settled();
    let before = explorer.text();
    std::fs::write(explorer.scene(), format!("{before}\n# later\n")).expect("written");
    explorer.state_when(|state| state["undo"] == "change from outside");
    assert!(String::from_utf8_lossy(&explorer.get("api/text").body).contains("# later"));
    // In the middle of a drag it is asked about.
    let name = explorer.get("api/scene").json()["poses"][0]["name"].clone();
    let ops = json!([{"op": "set_pose", "pose": name, "key": "turns", "value": 1}]);
    explorer.post("api/edit", &json!({"ops": ops, "phase": "drag"}));
    std::fs::write(explorer.scene(), format!("{before}\n# theirs\n")).expect("written");
    explorer.state_when(|state| state["conflict"] == true);
    explorer.edit(ops);
    assert!(explorer.text().contains("# theirs"), "it is not overwritten");
    let taken = explorer.post("api/conflict", &json!({"take": "theirs"})).json();
    assert_eq!((&taken["conflict"], &taken["saved"]), (&json!(false), &json!(true)));
    explorer.post("api/undo", &json!({}));
    assert!(explorer.text().contains("turns = 1"), "what was here can be had back");
    // Drawings, too, if what is drawn has changed.
    let state = explorer.settled();
    let drawing = explorer.folder.path().join("stand.png");
    let bytes = std::fs::read(&drawing).expect("readable");
    let mut darker = image::load_from_memory(&bytes).expect("a picture").into_rgba8();
    darker.pixels_mut().for_each(|pixel| pixel.0[0] /= 2);
    darker.save(&drawing).expect("written");
    let again = explorer.state_when(|later| later["revisions"]["pictures"] != state["revisions"]["pictures"]);
    assert_ne!(again["revisions"]["pictures"], first["revisions"]["pictures"]);
}

#[test]
fn a_click_near_a_rim_is_a_place_of_that_rim_on_all_poses() {
    let folder = tempfile::tempdir().expect("a folder");
    let poses = [("left", 60.0), ("right", 90.0)];
    for (name, x) in poses {
        let drawing = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"150\" height=\"120\"><path fill-rule=\"evenodd\" \
             d=\"M5 5 L145 10 L140 110 L10 115 Z M{} 40 L{} 60 L{} 80 L{} 60 Z\"/></svg>",
            x,
            x + 25.0,
            x,
            x - 20.0
        );
        std::fs::write(folder.path().join(format!("{name}.svg")), drawing).expect("written");
    }
    let pose =
        |(name, x): (&str, f64)| format!("[[pose]]\nname = \"{name}\"\nsource = \"{name}.svg\"\nat = [{x}, 0]\n");
    let text = format!("version = 1\n{}{}", pose(poses[0]), pose(poses[1]));
    std::fs::write(folder.path().join("scene.toml"), text).expect("written");
    let explorer = Explorer::within(folder);
    explorer.settled();
    // A little inside the hole, near its right corner.
    let carried = explorer
        .post("api/carry", &json!({"pose": "left", "at": [84.0, 60.0]}))
        .json();
    assert_eq!(carried["kind"], "rim");
    let at = |pose: usize| [0, 1].map(|axis| carried["at"][pose][axis].as_f64().expect("a number"));
    // Both holes are |x - middle| / a + |y - 60| / 20 = 1, with a = 25 to the right.
    for (pose, middle) in [(0, 60.0), (1, 90.0)] {
        let [x, y] = at(pose);
        let off = (x - middle) / 25.0 + (y - 60.0).abs() / 20.0 - 1.0;
        assert!(x > middle && off.abs() < 0.02, "{x} {y}");
    }
    assert!((at(0)[0] - 84.5).abs() < 1.0);
    // It becomes a landmark, which is one of the rim.
    explorer.edit(json!([{"op": "add_landmark", "at": {"left": at(0), "right": at(1)}}]));
    assert_eq!(explorer.settled()["problems"], json!([]));
    assert_eq!(
        explorer.get("api/correspondences").json()["landmarks"][0]["kind"],
        "rim"
    );
    // Away from the rim on one pose it explains itself.
    explorer.edit(json!([{"op": "move_landmark", "landmark": "landmark_1", "at": {"right": [60.0, 95.0]}}]));
    let problems = explorer.settled()["problems"].clone();
    assert_eq!(
        (&problems[0]["landmark"], &problems[0]["pose"]),
        (&json!("landmark_1"), &json!("right"))
    );
}

#[test]
fn landmarks_change_the_match_or_explain_themselves() {
    let explorer = Explorer::of("clown", as_it_is);
    let state = explorer.settled();
    let found = explorer.get("api/correspondences?samples=16").json();
    let (poses, links) = (
        found["poses"].as_array().expect("poses"),
        found["links"].as_array().expect("links"),
    );
    assert_eq!(
        (poses.len(), found["samples"][1].as_array().map(Vec::len)),
        (6, Some(32))
    );
    assert!(links.len() > 4 && links[0]["at"].as_array().map(Vec::len) == Some(6));
    let names: Vec<&str> = poses.iter().filter_map(|pose| pose["name"].as_str()).collect();
    // A point of the outline becomes a landmark that is a little off on the second pose.
    let along = explorer.get("api/correspondences?samples=512").json();
    let sample = |pose: usize, k: usize| json!([along["samples"][pose][2 * k], along["samples"][pose][2 * k + 1]]);
    let carried = explorer
        .post("api/carry", &json!({"pose": names[0], "at": sample(0, 7)}))
        .json();
    assert_eq!(carried["kind"], "outline");
    // Where another landmark lies between, it is refused; somewhere there is room.
    let (mut name, mut mapped) = (String::new(), Value::Null);
    for k in (7..500).step_by(31) {
        let at = json!({names[0]: sample(0, k), names[1]: sample(1, k + 1)});
        let added = explorer.edit(json!([{"op": "add_landmark", "at": at}])).json();
        name = added["names"][0].as_str().expect("a name").to_owned();
        mapped = explorer.settled();
        if mapped["problems"] == json!([]) {
            break;
        }
        explorer.post("api/undo", &json!({}));
        explorer.settled();
    }
    assert_eq!(mapped["problems"], json!([]));
    assert_ne!(mapped["revisions"]["shape"], state["revisions"]["shape"]);
    assert_eq!(mapped["revisions"]["pictures"], state["revisions"]["pictures"]);
    // The drawn outlines are those of before, and not sent to who has them; a copy is bent otherwise.
    let marks: Vec<&str> = poses.iter().filter_map(|pose| pose["mark"].as_str()).collect();
    let placed = explorer
        .get(&format!("api/correspondences?known={}", marks.join(",")))
        .json();
    for (pose, before) in placed["poses"].as_array().expect("poses").iter().zip(poses) {
        let is_sent = pose["mark"] != before["mark"];
        assert!(!(is_sent && pose["drawn"] == true), "{}", pose["name"]);
        for part in ["outline", "holes", "salient"] {
            assert!(before[part].is_array());
            assert_eq!(pose.get(part).is_some(), is_sent, "{} {part}", pose["name"]);
        }
    }
    let is_placed = |landmark: &Value| landmark["name"] == name.as_str();
    assert!(placed["landmarks"].as_array().expect("landmarks").iter().any(is_placed));
    // Far off the outline it cannot be; the mesh stays.
    explorer.edit(json!([{"op": "move_landmark", "landmark": name, "at": {names[1]: [-500, -500]}}]));
    let refused = explorer.settled();
    assert_eq!(refused["problems"][0]["landmark"], name.as_str(), "{refused}");
    assert_eq!(refused["problems"][0]["pose"], names[1]);
    assert_eq!(refused["revisions"]["shape"], mapped["revisions"]["shape"]);
    explorer.post("api/undo", &json!({}));
    assert_eq!(explorer.settled()["problems"], json!([]));
}

#[test]
fn a_broken_scene_opens_as_far_as_it_can() {
    let explorer = Explorer::of("clown", |text| format!("{text}\n[mush]\n"));
    let state = explorer.settled();
    assert!(state["problems"][0]["line"].as_u64().is_some(), "{state}");
    let scene = explorer.get("api/scene").json();
    assert_eq!((&scene["poses"], &scene["camera"]), (&json!([]), &Value::Null));
    assert_eq!(explorer.get("api/frame?at=0,0").status, 409);
    // Put right outside, it opens.
    let text = explorer.text().replace("[mush]", "");
    std::fs::write(explorer.scene(), &text).expect("written");
    let opened = explorer.state_when(|state| state["revisions"]["shape"] != 0);
    assert_eq!(opened["problems"], json!([]));
    drop(explorer);
    // A drawing is missing: places and weights are there.
    let explorer = Explorer::of("clown", |text| text.replace("cheer.png", "gone.png"));
    let state = explorer.settled();
    assert_eq!(state["problems"][0]["pose"], "cheer", "{state}");
    assert_eq!(explorer.weights("0.5,0").len(), 6);
    let drawn = explorer.get("api/correspondences").json();
    let has_outline: Vec<bool> = (0..6).map(|k| drawn["poses"][k]["outline"].is_array()).collect();
    assert_eq!(
        has_outline,
        [true, false, true, true, true, false],
        "the missing one and its copy"
    );
}

#[test]
fn a_gesture_is_saved_and_renders() {
    let explorer = Explorer::of("clown", as_it_is);
    explorer.settled();
    let samples: Vec<[f64; 3]> = (0..=60)
        .map(|k| f64::from(k) / 60.0)
        .map(|t| [t, t * t, 0.1 * t])
        .collect();
    let fitted = explorer
        .post(
            "api/gesture",
            &json!({"samples": samples, "tolerance": 0.01, "duration": 2}),
        )
        .json();
    let keys = fitted["keys"].as_array().expect("keys");
    assert!(
        (2..10).contains(&keys.len()) && fitted["error"].as_f64().is_some_and(|e| e <= 0.011),
        "{fitted}"
    );
    let path = explorer
        .post("api/path", &json!({"keys": keys, "fps": 12, "loop": false}))
        .json();
    assert_eq!(
        (path["frame_count"].as_u64(), path["duration"].as_f64()),
        (Some(25), Some(2.0))
    );
    explorer.edit(json!([
        {"op": "set_keys", "keys": keys, "loop": false, "fps": 12},
        {"op": "set", "table": "animation", "key": "size", "value": [24, 32]},
    ]));
    let scene = Scene::open(&explorer.scene()).expect("a scene");
    let (animation, last) = (&scene.animation, path["at"].as_array().expect("places").len() - 1);
    assert_eq!((animation.frame_count(), animation.fps), (25, 12.0));
    assert_eq!(json!(animation.at(animation.time_of_frame(last))), path["at"][last]);
    assert_eq!(explorer.get("api/scene").json()["animation"]["own_keys"], true);
    let started = explorer
        .post("api/export", &json!({"output": "out.gif", "frames": "1-3"}))
        .json();
    assert!(
        started["job"]["command"]
            .as_str()
            .is_some_and(|c| c == "inbetween render scene.toml -o out.gif --frames=1-3")
    );
    let done = explorer.state_when(|state| state["job"]["state"] != "running");
    assert_eq!(
        (&done["job"]["state"], &done["job"]["done"]),
        (&json!("done"), &json!(3)),
        "{done}"
    );
    assert!(explorer.folder.path().join("out.gif").is_file());
    // One that is cancelled leaves nothing.
    explorer.post(
        "api/export",
        &json!({"output": "long.gif", "size": [1200, 1600], "supersample": 4}),
    );
    assert_eq!(explorer.post("api/export", &json!({"output": "other.gif"})).status, 409);
    assert_eq!(explorer.post("api/export/cancel", &json!({})).status, 200);
    let cancelled = explorer.state_when(|state| state["job"]["state"] != "running");
    assert_eq!(cancelled["job"]["state"], "cancelled");
    let left: Vec<String> = std::fs::read_dir(explorer.folder.path())
        .expect("a folder")
        .filter_map(|entry| entry.expect("an entry").file_name().into_string().ok())
        .filter(|name| name.contains("long") || name.starts_with('.'))
        .collect();
    assert_eq!(left, Vec::<String>::new());
}

#[test]
fn the_drawing_can_be_taken_hold_of() {
    let explorer = Explorer::of("bear", as_it_is);
    explorer.settled();
    let scene = explorer.get("api/scene").json();
    let mesh = explorer.get("api/mesh").words();
    let (vertices, triangles) = (mesh[0] as usize, mesh[1] as usize);
    let first = &floats(&mesh[4 + 3 * triangles..][..2 * vertices]);
    let layer_pose = scene["layers"][0]["poses"][0].as_u64().expect("a pose") as usize;
    let pose = scene["poses"][layer_pose]["name"].clone();
    let vertex = |k: usize| [f64::from(first[2 * k]), f64::from(first[2 * k + 1])];
    // Moved all alike, it is moved.
    let handles: Vec<Value> = [0, vertices / 2]
        .map(|k| json!({"from": vertex(k), "to": [vertex(k)[0] + 10.0, vertex(k)[1]]}))
        .to_vec();
    let dragged = explorer
        .post("api/deform", &json!({"pose": pose, "handles": handles, "steps": 600}))
        .words();
    assert_eq!((dragged[0] as usize, dragged[1]), (vertices, 0));
    for (moved, rest) in floats(&dragged[2..]).chunks_exact(2).zip(first.chunks_exact(2)) {
        assert!(
            (moved[0] - rest[0] - 10.0).abs() < 0.1 && (moved[1] - rest[1]).abs() < 0.1,
            "{moved:?} {rest:?}"
        );
    }
    // A point of the drawing at one place is asked for where it is at another.
    let positions = |place: &str| {
        let words = explorer.get(&format!("api/frame?at={place}")).words();
        let (poses, layers) = (words[3] as usize, words[4] as usize);
        floats(&words[6 + 2 * poses + layers + 6..][..2 * vertices])
    };
    let (here, there) = (positions("0.1,0.1"), positions("0.25,0.2"));
    let far = (0..vertices)
        .max_by_key(|&k| (1e3 * (here[2 * k] - there[2 * k]).hypot(here[2 * k + 1] - there[2 * k + 1])) as i64);
    let k = far.expect("a vertex");
    let point = json!({"from": [here[2 * k], here[2 * k + 1]], "to": [there[2 * k], there[2 * k + 1]]});
    let reached = explorer
        .post("api/reach", &json!({"at": [0.1, 0.1], "points": [point]}))
        .json();
    assert!(reached["error"].as_f64().is_some_and(|error| error < 1.0), "{reached}");
    // And maps over the plane.
    let grid = explorer.get("api/grid?box=-1,-1,1,1&columns=8&rows=4").words();
    assert_eq!((grid[0], grid[1], grid.len()), (8, 4, 3 + 8 * 4 * grid[2] as usize));
    let validity = explorer.get("api/validity?box=-1,-1,1,1&columns=4&rows=3").words();
    assert_eq!((validity[0], validity[1], validity.len()), (4, 3, 2 + 3 * 12));
}

/// A folder with a picture of a red disc beside a small one, as `drawing.png`; twice side by side as `sheet.png`.
fn folder_of_drawings() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let picture = |places: &[f64]| {
        let width = 120 * places.len();
        let mut frame = Frame::filled(width, 100, [0; 4]);
        for (k, pixel) in frame.pixels.iter_mut().enumerate() {
            let (x, y) = ((k % width) as f64 + 0.5, (k / width) as f64 + 0.5);
            let is_in = |a: f64, b: f64, radius: f64| (x - a).hypot(y - b) < radius;
            if places
                .iter()
                .any(|left| is_in(left + 45.0, 55.0, 30.0) || is_in(left + 95.0, 20.0, 8.0))
            {
                *pixel = [200, 40, 40, 255];
            }
        }
        png_bytes(&frame).expect("encoded")
    };
    std::fs::write(folder.path().join("drawing.png"), picture(&[0.0])).expect("written");
    std::fs::write(folder.path().join("sheet.png"), picture(&[0.0, 125.0])).expect("written");
    folder
}

#[test]
fn what_was_taken_for_the_figure_is_told_and_can_be_corrected() {
    let folder = folder_of_drawings();
    std::fs::copy(folder.path().join("drawing.png"), folder.path().join("other.png")).expect("copied");
    let explorer = Explorer::started(folder, &["drawing.png", "other.png"]);
    explorer.settled();
    let figure = || explorer.get("api/figure?layer=0&pose=0").json();
    let roles = |figure: &Value| -> Vec<String> {
        let pieces = figure["pieces"].as_array().expect("pieces");
        pieces
            .iter()
            .map(|piece| piece["role"].as_str().expect("a role").to_owned())
            .collect()
    };
    let found = figure();
    assert_eq!(
        (&found["name"], &found["taken"]),
        (&json!("drawing"), &json!("alpha")),
        "{found}"
    );
    assert_eq!(roles(&found), ["body", "part"]);
    // The sheet is the drawing's file, or smaller as asked.
    let sheet = explorer.get("api/sheet?layer=0&pose=0&max=60");
    assert_eq!((sheet.status, &sheet.body[1..4]), (200, b"PNG".as_slice()));
    let size = |from: usize| u32::from_be_bytes(sheet.body[from..from + 4].try_into().expect("four bytes"));
    assert_eq!([size(16), size(20)], [60, 50]);
    // A click leaves a part out.
    let dropped = explorer.edit(json!([{"op": "mark_part", "pose": "drawing", "list": "drop", "at": [95.0, 20.0]}]));
    assert_eq!(dropped.status, 200, "{}", String::from_utf8_lossy(&dropped.body));
    let found = figure();
    assert_eq!(roles(&found), ["body", "dropped"], "{found}");
    assert_eq!(found["drop"], json!([[95.0, 20.0]]));
    // Where nothing is drawn there is nothing to keep, nor is there a drawing of another number.
    assert_ne!(explorer.get("api/figure?layer=0&pose=0&keep=10,10").status, 200);
    assert_ne!(explorer.get("api/figure?layer=0&pose=7").status, 200);
    assert_ne!(explorer.get("api/sheet?layer=0&pose=0&max=wide").status, 200);
}

#[test]
fn drawings_are_kept_in_a_folder_when_that_is_asked_for() {
    let explorer = Explorer::started(folder_of_drawings(), &["sheet.png", "--cells", "2x1"]);
    let state = explorer.settled();
    assert_eq!(state["temporary"], true, "{state}");
    assert_ne!(explorer.post("api/keep", &json!({"folder": " "})).status, 200);
    let kept = explorer.folder.path().join("kept");
    let answer = explorer.post("api/keep", &json!({ "folder": kept }));
    assert_eq!(answer.status, 200, "{}", String::from_utf8_lossy(&answer.body));
    let scene = Scene::open(&kept.join("scene.toml")).expect("a scene");
    assert_eq!(scene.poses.len(), 2);
    let there = std::fs::read(kept.join("sheet.png")).expect("a drawing");
    assert_eq!(
        there,
        std::fs::read(explorer.folder.path().join("sheet.png")).expect("the original")
    );
    // It has a folder now, and edits go there.
    assert_ne!(
        explorer
            .post("api/keep", &json!({"folder": explorer.folder.path().join("again")}))
            .status,
        200
    );
    let moved = explorer.edit(json!([{"op": "set_pose", "pose": "sheet-1", "key": "mirror", "value": true}]));
    assert_eq!(moved.status, 200, "{}", String::from_utf8_lossy(&moved.body));
    let text = std::fs::read_to_string(kept.join("scene.toml")).expect("readable");
    assert!(text.contains("mirror = true"), "{text}");
}
