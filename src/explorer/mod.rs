//! `inbetween explore`: a server on this machine behind the interactive page.
//!
//! The page ([`page`]) is plain HTML, CSS and JavaScript in the binary. It asks this server for everything that is computed, and
//! tells it every edit; the server owns the scene's text, its undo and the file. Files here: [`http`] (the protocol), [`security`]
//! (who is answered), [`server`] (connections), [`socket`] (those that stay open), [`routes`], [`session`] and [`state`] (the state), [`document`] (the scene's text, undo, saving),
//! [`keeping`] (scenes that were begun for drawings), [`edit`] (edits of the text), [`model`] (what is computed of a scene), [`worker`] (heavy work, and the look at the disk), and
//! one file a group of answers.
//!
//! # How a page talks to it
//!
//! The address is `http://127.0.0.1:PORT/TOKEN/`; everything is below it, so a page uses relative addresses only (`api/scene`). The
//! token is 128 random bits in hexadecimal. Answers:
//!
//! - 403 without the right token, if `Host` is not `127.0.0.1:PORT` or `localhost:PORT`, if `Origin` is sent and is not
//!   `http://` with one of these, or if `Sec-Fetch-Site` is sent and is neither `same-origin` nor `none`. There are no CORS headers.
//! - 404 for an address that does not exist; 405 for a known one with another method.
//! - 400 for a request that makes no sense, 409 for one that the present state does not allow (there is no mesh yet; an edit that
//!   the scene's format refuses; nothing to undo). Both, like 500, have a JSON body: `{"error": PROBLEM}`.
//! - 200 otherwise. Every answer has `Content-Security-Policy: default-src 'self'; ...`, `Cache-Control: no-store` (but pictures with
//!   `v=`, which may be kept), `Referrer-Policy: no-referrer`, `X-Content-Type-Options: nosniff`.
//!
//! POST bodies are JSON with `Content-Type: application/json` (415 otherwise). JSON numbers read back to the same f64. Binary
//! answers are little-endian, everything in them is 4 bytes wide (u32 or f32), so they can be viewed as `Uint32Array` and
//! `Float32Array`.
//!
//! `api/socket` is a WebSocket for many small requests in a row, over which the page asks for nearly all it asks for: a text message
//! `METHOD ROUTE?QUERY`, a line break and the body; the answer is a binary message, the status (u32), then the body. One at a time. The routes
//! are those below, without `api/`.
//!
//! Coordinates: *places* are points of the pose space, #dimensions numbers. *Drawing units* are source pixels or SVG user units,
//! x right, y down, of the drawings as they are used: those of a pose with `mirror = true` are reflected already, and so is
//! whatever is sent back (the server reflects it when it writes the scene). Poses are named or counted in the scene's order from
//! 0; `layer` is counted likewise (a scene without layers has layer 0), default 0.
//!
//! A *PROBLEM* is
//! `{"message": "...", "where": null | "file" | "pose" | "landmark" | "layer" | "space" | "mapping" | "animation", "pose": null | "NAME",
//! "landmark": null | "NAME", "layer": null | "NAME", "line": null | LINE}`: text for the artist, and the place in the page where it belongs.
//!
//! # State and time
//!
//! | route | |
//! |---|---|
//! | `GET api/state` | the state at once |
//! | `GET api/state?after=SEQ` | the state as soon as its `seq` is not SEQ; after 25 s at the latest (long poll) |
//!
//! ```json
//! {"seq": 17,
//!  "revisions": {"scene": 4, "weights": 9, "shape": 2, "pictures": 1},
//!  "working": false, "dragging": false,
//!  "saved": true, "conflict": false, "temporary": false, "save_error": null,
//!  "undo": "move pose 'jump'", "redo": null,
//!  "problems": [PROBLEM, ...],
//!  "timings": {"mapping_ms": 96.1},
//!  "job": null}
//! ```
//! What to ask again when a number of `revisions` has changed: `scene`: `api/scene`; `weights`: frames, grids; `shape`: `api/mesh`,
//! `api/puppet`, `api/correspondences`, frames; `pictures`: textures and drawings (their `v=`), `api/puppet`. `shape` 0: there is
//! no mesh (a broken scene). `working`: a newer scene than the one shown is being computed. `problems` are those of the newest
//! scene; what is shown is the last good one. `saved` is false while a drag lasts, or if the file could not be written
//! (`save_error`). `temporary`: the scene was begun for drawings and lies in a temporary folder until `api/keep`. `conflict`: the file was changed outside while something here was not saved. `timings`: how long the last mapping
//! took, from its edit to the new shape. `job`: see *Export*.
//!
//! # The scene
//!
//! `GET api/scene`:
//! ```json
//! {"name": "walker", "file": "data/walker/scene.toml", "revision": 4, "dimension": 2,
//!  "layout": "given",                                    // or "automatic"
//!  "poses": [{"name": "stand", "at": [0, 0], "kind": "drawn",  // or "deformed", "layered"
//!             "source": "stand.png", "drawing": 0,       // the pose whose drawing it shows
//!             "deform_of": null, "handles": [], "mirror": false, "turns": 0, "layers": [0]}, ...],
//!  "pseudo_poses": [{"from": [0.8, 0.6], "at": [1, 0.9]}, ...],
//!  "pose_space": {"provider": "biharmonic", "radial": "b-spline", "epsilon": 0.001, "bounded": false, "walls": [[[x, y], ...]]},
//!  "blend": {"reference": "canonical", "stretch": "linear", "guard": "off"},
//!  "texture": {"sharpness": 0.5, "blending": "plain", "register": "auto", "drawing": "curves"},
//!  "mesh": {"simplify": 0.02, "edge_length": 0.05},
//!  "layers": [{"name": "walker", "poses": [0, 1, 2]}, ...],
//!  "landmarks": [{"name": "nose", "layer": 0, "line": 31, "path": false, "at": {"stand": [120.5, 40], ...}}, ...],
//!  "animation": {"fps": 24, "loop": false, "size": [1280, 720], "background": "transparent",   // or "#rrggbbaa"
//!                "hold": 1, "own_keys": true, "keys": [{"time": 0, "at": [0, 0], "hold": 2, "spacing": [0.2, 0.5]}, ...],
//!                "duration": 6.2, "frame_count": 149},                  // a key has `hold` and `spacing` where the file does
//!  "box": [[-1, -1], [1, 1]],                            // of the poses; null unless the dimension is 2
//!  "domain": [[-2.4, -2.4], [2.4, 2.4]],                 // what `inbetween weights --grid` covers
//!  "camera": {"scale": 0.7, "shift": [12, 30]},          // frame pixel = drawing unit * scale + shift; null without a mesh
//!  "notes": ["pose 'run': ..."], "problems": [PROBLEM, ...]}
//! ```
//! A landmark with `path` true has polylines in `at`. Of a scene whose text cannot be read at all, every list is empty and
//! `problems` says why; `GET api/text` answers the text of the file (text/plain).
//!
//! # Frames
//!
//! `GET api/frame?at=X,Y` (or `weights=W0,W1,...`; either may be repeated; or `poses=all`, every pose by itself) answers one block after the other, in that order. Optional:
//! `provider=biharmonic|rbf`, `sharpness=0..1`, `stretch=linear|limited|log` in place of the scene's, for comparison (the first frame with another `stretch` takes some 10 ms longer);
//! `silhouette=1` adds the blended outlines, `tolerance=T` with as few points as keep them within T drawing units of the whole (0).
//!
//! One block, u32 unless f32 is said, #N poses, #L layers:
//!
//! | content | count |
//! |---|---|
//! | bytes of this block | 1 |
//! | revisions `shape`, `weights` | 2 |
//! | N, L | 2 |
//! | triangles that are inverted, over all layers | 1 |
//! | weights (f32), sum 1 | N |
//! | texture weights (f32), sum 1 | N |
//! | layers from back to front | L |
//! | *for each layer:* V vertices, P poses that have it, K textures, T triangles, R rings | 5 |
//! | opacity (f32) | 1 |
//! | positions x, y (f32), drawing units | 2 V |
//! | weights of its poses (f32) | P |
//! | weights of its textures (f32), sum 1 | K |
//! | inverted triangles: triangle t is bit `t % 32` of word `t / 32` | ceil(T / 32) |
//! | *for each ring of the layer's outline, outer first:* C points, then x, y (f32) | 1 + 2 C |
//!
//! Without `silhouette=1`, R is 0. Positions are those that `inbetween frame --at` draws (a frame pixel is `position * scale +
//! shift`, see `camera`). 409 if there is no mesh; weights alone: `GET api/weights?at=X,Y` (may be repeated) answers
//! `[{"weights": [...], "texture_weights": [...]}, ...]` and needs no mesh.
//!
//! A frame is drawn by drawing, in the layers' order, each layer's mesh once a texture with its weight, added up
//! (premultiplied), times the layer's opacity. Textures `kind=colour` reach beyond the drawing's edge and are opaque there: the sum is
//! to be cut by the silhouette (even-odd), as `inbetween frame` does it. Textures `kind=drawing` have the drawing's own alpha.
//!
//! `GET api/curves?at=X,Y` with the same options: the frame as `inbetween frame` renders it, in pixels of the frame and without a
//! background, as SVG. It takes longer than `api/frame`: the first one makes the art, so it is for a probe that rests.
//!
//! # Meshes and pictures
//!
//! `GET api/puppet`:
//! ```json
//! {"shape": 2, "pictures": 1, "nearest": false,
//!  "layers": [{"name": "walker", "poses": [0, 1, 2], "vertices": 512, "triangles": 930,
//!              "texture_of": [0, 1, 2],                  // per pose of the layer
//!              "curves": false,                          // whether its frames are curves when they are rendered
//!              "textures": [{"pose": 0,                  // among the poses of the layer
//!                            "colour": {"width": 640, "height": 720, "origin": [-1.5, 0], "scale": 1},
//!                            "drawing": {"width": 320, ...}}, ...]}]}  // texel = (drawing unit - origin) * scale
//! ```
//! The texture coordinate of vertex v in texture k is `(position of v in pose textures[k].pose - origin) * scale / [width, height]`
//! with the numbers of the kind of picture that is used; places outside take the colour of the border (`CLAMP_TO_EDGE`).
//!
//! `GET api/mesh`: for each layer u32 V, T, P, R; 3 T vertex indices; P times V positions x, y (f32), in drawing units; for each of the R
//! boundary rings (outer first) its number of vertices and the vertices.
//!
//! `GET api/surface`: what the pictures are painted on. For each layer u32 0 where that is its mesh; otherwise u32 V, T, P, R of a finer mesh; 3 T vertex
//! indices; P times 3 V vertices of the layer's mesh and 3 V shares (f32): vertex k is in a pose where these carry it (at a frame: the sum over the
//! poses, by their weights in it); R rings as above, in any order.
//!
//! `GET api/texture?layer=0&index=0&kind=colour|inside|drawing&v=PICTURES`: PNG, straight alpha, of the size that the puppet says.
//! Where `nearest` is true, frames show nearest texels: `colour` has the drawing's own pixels, `inside` is opaque where they lie inside its
//! outline; a frame's pixel is inside where at least half of the textures' weight is.
//!
//! `GET api/drawing?layer=0&pose=2&max=256&v=PICTURES`: PNG of a pose's picture, scaled down so that no side exceeds `max`; there as
//! soon as the drawing can be read, mesh or not (a copy shows its original's). Its place: `api/correspondences`, `pictures`.
//!
//! # Correspondences
//!
//! `GET api/correspondences?layer=0&samples=0&known=MARK,MARK`:
//! ```json
//! {"shape": 2, "reference": 0,
//!  "poses": [{"pose": 0, "name": "stand", "drawn": true,   // a copy is not drawn: no landmark can be put on it
//!             "mark": "9f3c61d20b7a4e58",    // of its outline: who says that it is known is not sent the next three again
//!             "outline": [x, y, x, y, ...], "holes": [[x, y, ...], ...],
//!             "salient": [{"at": [x, y], "scale": 0.02, "curvature": 3.1}, ...],  // scale: the widest smoothing it survives
//!             "picture": {"origin": [0, 0], "scale": 1, "width": 640, "height": 720},
//!             "cost": 0.4, "looks_mirrored": false}, ...],  // the poses of the layer
//!  "links": [{"at": [[x, y], ...], "landmark": null}, ...],  // numbered from 1; one point a pose of the layer
//!  "costs": [[0.3, ...], ...],                              // per pose, from link k to the next: how unlike the outlines are
//!  "suggestions": [{"pose": 2, "from": 3, "to": 4, "cost": 2.9}, ...],  // between these links (from 0) a landmark would help
//!  "landmarks": [{"name": "nose", "kind": "outline",    // or "rim" (of a hole), "inside", "line"
//!                 "given": [true, false, ...], "at": [[[x, y]], ...]}, ...],   // per pose the points of it
//!  "samples": [[x, y, x, y, ...], ...]}                   // per pose as many corresponding points as asked for, at most 4096
//! ```
//! `links` are those of `inbetween show`. Without a mesh only `poses` are filled, as far as their drawings can be read (`outline`
//! and `picture` are null otherwise), and `shape` is 0. While a landmark that was moved is not mapped yet, or cannot be, `landmarks`
//! are those of the match that is shown; those of the newest scene are in `api/scene`.
//!
//! `POST api/carry {"layer": 0, "pose": "stand", "at": [x, y]}` answers `{"kind": "outline" | "rim" | "inside", "poses": ["stand", ...],
//! "at": [[x, y], ...]}`: where the present match has this point on every pose of the layer; what a new landmark begins with.
//!
//! # Figures
//!
//! `GET api/figure?layer=0&pose=2`: what was taken for the figure of a drawing, in the coordinates of its file, whether or not the pose is
//! reflected; `layer` is one that the scene names:
//! ```json
//! {"name": "run", "bitmap": true,                          // `reading` does not concern SVG drawings
//!  "taken": "lines",                                       // as what the figure of a bitmap was taken: or "alpha", "background"
//!  "mark": "1f3a-18c2d5e9",                                // of the file: `v` of its sheet
//!  "sheet": {"origin": [0, 0], "scale": 1, "width": 640, "height": 720},  // null if it cannot be read
//!  "pieces": [{"role": "body", "outline": [x, y, ...], "holes": [[x, y, ...], ...]}, ...],  // or "part", "kept", "dropped"
//!  "notes": ["the figure is what the lines enclose, with its inside"],
//!  "reading": {"figure": "lines", "gap": 0.01, "paper": "keep", "threshold": 0.5},
//!  "usual": {"figure": "auto", ...},                       // of poses that do not say it themselves
//!  "own": ["figure"],                                      // what this one says itself
//!  "keep": [[x, y], ...], "drop": [[x, y], ...],
//!  "problem": null}                                        // PROBLEM if it cannot be read as it is said
//! ```
//! With `keep=X,Y` the answer is 409 if no piece is there that could be kept. `GET api/sheet?layer=0&pose=2&max=1600&v=MARK`: PNG of the
//! drawing's whole sheet, nothing taken out.
//!
//! # Grids
//!
//! `GET api/grid?box=X0,Y0,X1,Y1&columns=64&rows=64&provider=`: weights at cell centres (as `inbetween weights --grid`): u32
//! columns, rows, N; then row by row, from Y0, N weights (f32) a cell. At most 512 x 512.
//!
//! `GET api/validity?box=...&columns=32&rows=32&provider=`: u32 columns, rows; then a cell: u32 inverted triangles, f32 largest
//! stretch, f32 stretch that 95 % of the triangles stay below. Stretch of a triangle: how many times longer or shorter than in the
//! pose that it is most like. At most 128 x 128.
//!
//! # Edits
//!
//! `POST api/edit {"ops": [OP, ...], "label": "move pose 'jump'", "phase": "done"}`; answers the state, with `"revision"` of the
//! scene. All ops of a request are one step of undo; so are edits with the same
//! `"merge": "WORD"` in direct succession (arrow keys). The answer has `"names"` too, those that were made up. `phase`:
//! - `"done"` (default): the edit is taken, saved, and can be undone.
//! - `"drag"`: shown but not saved; replaces what the drag before showed (ops are always applied to the text before the first
//!   `drag`). Weights follow at once, meshes as soon as they can; requests that are overtaken are left out.
//! - `"cancel"`: ends a drag, back to the text before it (`ops` may be empty).
//!
//! 409 if the format refuses the result, nothing has changed then. A result that the format takes but that cannot be mapped (an
//! impossible landmark) is taken; `problems` explains it.
//!
//! | op | fields |
//! |---|---|
//! | `move_pose` | `pose`, `at` (a scene with automatic layout gets the places that are shown) |
//! | `add_landmark` | `name` (optional: the answer's `names`), `layer` (name, in scenes with layers), `at`: {pose: [x, y]} or with `path` true {pose: [[x, y], ...]} |
//! | `move_landmark` | `landmark`, `at`: {pose: [x, y] or points}; other poses stay |
//! | `unset_landmark` | `landmark`, `pose` |
//! | `rename_landmark` | `landmark`, `name` |
//! | `remove_landmark` | `landmark` |
//! | `add_pseudo_pose` | `from`, `at` |
//! | `move_pseudo_pose` | `index`, `from` and/or `at` |
//! | `remove_pseudo_pose` | `index` |
//! | `set` | `table` (`pose_space`, `blend`, `texture`, `mesh`, `input`, `animation`), `key`, `value`; null removes the key |
//! | `set_keys` | `keys` [{`time`, `at`, `hold` and `spacing` optional}], `loop` and `fps` optional |
//! | `add_deformed_pose` | `name` (optional), `of`, `at`, `handles` [{`from`, `to`, `layer`}] |
//! | `set_handles` | `pose`, `handles` |
//! | `remove_pose` | `pose` (a copy, or a drawn pose without copies; its places in landmarks go, too) |
//! | `set_pose` | `pose`, `key` (`mirror`, `turns`, `name`, `figure`, `gap`, `paper`, `threshold`), `value`; null removes the key |
//! | `mark_part` | `pose`, `list` (`keep`, `drop`), `at`, in the coordinates of the file |
//! | `unmark_part` | `pose`, `list`, `index` |
//!
//! | route | |
//! |---|---|
//! | `POST api/undo`, `POST api/redo` | one step; the file gets back its bytes. Answer the state; 409 if there is none |
//! | `POST api/save` | tries again to save, after a `save_error` |
//! | `POST api/keep {"folder": "cat"}` | writes a `temporary` scene and its drawings into a folder, relative to where `explore` was started, and goes on there; 409 if a scene or other drawings of these names are there |
//! | `POST api/conflict {"take": "mine" \| "theirs"}` | ends a conflict: writes what is here, or reads what is there (which can be undone) |
//!
//! # Handles
//!
//! `POST api/deform {"layer": 0, "pose": "stand", "handles": [{"from": [x, y], "to": [x, y]}], "steps": 20}`: the pose deformed as rigidly as
//! possible: u32 V, inverted triangles; V positions x, y (f32). Answers with the same `from`s share a factorisation, and go on from where the
//! last one ended; `steps` bounds the work (default 40).
//!
//! `POST api/reach {"layer": 0, "at": [X, Y], "start": [X, Y], "points": [{"from": [x, y], "to": [x, y]}], "provider": null}`: inverse
//! posing: the place of the pose space whose drawing brings the points nearest to their targets. `at` is where they were taken hold
//! of (`from` lies on the drawing there); the search goes downhill from `start` (default `at`; a drag gives the place it has reached)
//! or, with `"search": "everywhere"`, looks anywhere. Answers `{"at": [...], "weights": [...], "reached": [[x, y], ...], "error": 1.5}`,
//! `error` in drawing units.
//!
//! # Animation and gestures
//!
//! `POST api/path {"keys": [{"time", "at", "hold", "spacing"}], "loop": false, "fps": 24, "hold": 1}` (all optional: the scene's otherwise): the path as
//! it will be played: `{"duration", "frame_count", "fps", "start", "held": false, "at": [[X, Y], ...]}`, one place a frame; `held` says
//! that places are held from frame to frame, not moved between.
//!
//! `POST api/gesture {"samples": [[t, X, Y], ...], "smoothing": 0.05, "tolerance": 0.02, "duration": null, "loop": false}`: a recorded
//! path as keys for `set_keys`: smoothed over `smoothing` seconds, retimed to `duration` seconds, reduced to the fewest keys whose path stays
//! within `tolerance` (of the diagonal of the poses' box): `{"keys": [...], "error": 0.01, "path": [[t, X, Y], ...]}`.
//!
//! # Export
//!
//! `POST api/export {"output": "walker.gif", "format": null, "size": [480, 540], "fps": 24, "frames": "1-10", "supersample": 2,
//! "background": "white", "max_error": 0.5}` (all but `output` optional) runs `inbetween render` of the file as it is saved; `output` is
//! relative to the folder where `explore` was started. Answers the state; its `job` is
//! `{"id": 1, "output": "walker.gif", "command": "inbetween render ...", "done": 12, "total": 48, "seconds": 1.5, "left": 4.5,
//! "state": "running" | "done" | "failed" | "cancelled", "message": "..."}`. One at a time (409). `POST api/export/cancel` ends it.
//!
//! `POST api/command {"verb": "frame" | "render" | "weights", ...}` answers `{"command": "inbetween frame ..."}`, quoted for a shell: `frame` takes
//! `at` and `output`, `render` the fields of an export, `weights` `at` and `provider`.

mod correspondences;
mod document;
mod draggers;
mod edit;
mod export;
mod figures;
mod frames;
mod gesture;
mod grids;
mod handles;
mod http;
mod jobs;
mod keeping;
mod meshes;
mod model;
mod page;
mod picture_cache;
mod pictures;
mod problem;
mod reweighting;
mod routes;
mod scene_json;
mod security;
mod server;
mod session;
mod socket;
mod stamp;
mod state;
mod thinning;
mod wire;
mod worker;

use std::path::PathBuf;
use std::sync::Arc;

pub(crate) use self::keeping::{Begun, DrawingCopy};
use self::server::Server;
use self::session::Session;

/// What is opened.
#[derive(Debug)]
pub(crate) enum Opened {
    /// A scene file.
    Scene(PathBuf),
    /// A scene that was begun for drawings.
    Begun(Begun),
}

/// A scene that is explored: its state and the server that answers for it.
pub(crate) struct Explorer {
    server: Server,
    session: Arc<Session>,
}

impl Explorer {
    /// Opens a scene and listens, at `port` or a free one. A broken scene is opened as far as it can be.
    pub(crate) fn open(opened: Opened, port: Option<u16>) -> anyhow::Result<Self> {
        let session = Arc::new(match opened {
            Opened::Scene(file) => Session::open(&file),
            Opened::Begun(begun) => Session::begun(begun),
        });
        let server = Server::bind(port)?;
        let working = Arc::clone(&session);
        std::thread::Builder::new()
            .name("worker".to_owned())
            .spawn(move || worker::run(&working))?;
        let watched = Arc::clone(&session);
        std::thread::Builder::new()
            .name("watch".to_owned())
            .spawn(move || worker::watch(&watched))?;
        Ok(Self { server, session })
    }

    /// The page's address.
    pub(crate) fn address(&self) -> String {
        self.server.address()
    }

    /// Answers until the process ends.
    pub(crate) fn run(self) {
        self.server.run(&self.session);
    }
}
