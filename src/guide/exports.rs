//! Exports: what comes out, for which program, and how it is rendered on many computers.
//!
//! # Kinds of output
//!
//! `render` takes the kind of output from the name of the file, or from `--format` where a name cannot say it. A name without an ending, or that
//! of a folder, is a folder of PNG files.
//!
//! | output | written as | what is kept | proven in |
//! |---|---|---|---|
//! | frames | a folder of `NAME.0001.png`, … | everything | Pillow |
//! | frames as curves | a folder, `--format svg-sequence` | curves; layers of bitmaps are pictures in it | an XML parser |
//! | GIF | `.gif` | 256 colours for the whole animation, dithered without flicker; transparency all or nothing; at most 50 frames a second | Pillow |
//! | APNG | `.apng` | everything | Pillow |
//! | WebP | `.webp` | everything, lossless | Pillow |
//! | sprite sheet | `.png` and `.json`, `--format sprites` | everything; frames are cut to what is drawn and packed | Pillow |
//! | MP4 | `.mp4`, needs ffmpeg | no transparency: white is behind, or `--background`; odd sides are padded to even ones | ffprobe, ffmpeg |
//! | WebM | `.webm`, needs ffmpeg | transparency | ffprobe, ffmpeg |
//! | animated SVG | `.svg` (SMIL) | curves with keys | Chromium |
//! | Lottie | `.json` | curves with keys; no elliptic gradients | lottie-web, the Lottie schema |
//! | glTF 2.0 | `.glb` | textured meshes with morph targets; the drawing that counts most is shown | the Khronos validator |
//! | Spine | a folder, or a `.json` with its pictures beside it, `--format spine` | textured meshes with deform keys, all drawings mixed | Spine's runtime |
//! | runtime data | `.inb`, or `--format runtime` | meshes, poses, weights and textures, to be posed while it plays | its own reader |
//!
//! The JSON of a sprite sheet has the array form that TexturePacker and Aseprite write. The proofs are run by `.ci/players`, in the programs of
//! the last column. A single frame is a matter of `frame`, which writes `.png` or `.svg`:
//!
//! ```text
//! inbetween render cat/scene.toml -o cat.webm --size 1920x1080 --fps 30
//! inbetween render cat/scene.toml -o cat.png --format sprites --size 240x270 --fps 12
//! inbetween frame cat/scene.toml --at 0.3,0.1 -o between.svg
//! ```
//!
//! `--size`, `--fps`, `--camera` and `--background` take the place of what the scene says. `--supersample 4` looks at 4 x 4 points of each pixel, for the final
//! pictures. `--frames 1-10,20` or `--frames 1-99:2` renders some frames only; formats of
//! moving curves need frames in a row. `--certify` writes beside the output what holds of each frame, whatever kind of output that is ([certified
//! frames](super::blending#certified-frames)).
//!
//! # Formats with keys
//!
//! Animated SVG, Lottie, glTF and Spine have keys, between which players go straight. Keys are placed so that no point is farther than `--max-error` pixels, a half
//! without it, from where the frames have it; the error that was reached is told. Smaller errors make larger files.
//!
//! Files of moving curves are large, since every path has keys of its own; a snake of 549 curves in 122 frames has 10 MB, before the compression that web
//! servers do. Layers of bitmaps are one picture a frame in SVG and Lottie files. If a character consists of bitmaps, a video, WebP, glTF or Spine is the smaller file.
//!
//! # Meshes of figures that lie over themselves
//!
//! Where an arm lies in front of the chest in some poses ([`drawings`](super::drawings)), one mesh could not say what is in front. So glTF and Spine files have a mesh for each
//! part that is painted at once, called after the layer and the limb, as in `hero/trunk` and `hero/limb 2.1`: each with pictures that are whole where another part hides them,
//! and in the order of depth that frames have, which changes over time (`drawOrder` in Spine, the depth of nodes in glTF). Neighbours overlap by a ring of triangles in which
//! both show the same, so that no seam opens. Limbs that lie over nothing stay with the trunk. Pixel art is drawn as one mesh, as its frames are.
//!
//! # Runtime data
//!
//! A `.inb` file holds everything that a frame is computed from and nothing that can be computed from it: a game poses the character while it plays, from
//! weights of its own. It is documented byte for byte, and read, in [`export::runtime`](crate::export::runtime). A layer that lies over itself is blended as one mesh and drawn
//! region by region; the file says which lies in front in each pose, and how a player orders them in between.
//!
//! # Long renders, and many computers
//!
//! A long render says how long it will take. A file appears under its name when it is complete; a run that is killed leaves none that is torn. A
//! folder of frames that was begun is finished by
//!
//! ```text
//! inbetween render cat/scene.toml -o frames --frames 101-200 --threads 8 --resume
//! ```
//!
//! `--resume` leaves out frames that are complete, of this scene and these settings: every file carries a hash of all that it was made
//! from. Any share of the frames can be rendered on any computer, with any number of threads, to the same bytes; that is all a render farm
//! needs. The repository's folder `farm` has a template in the Open Job Description and a script for Slurm. `--progress json` tells progress
//! to programs. The exit code is 0 when everything is written, 1 for bad input, failed work or a certificate that does not hold, and 2 for wrong usage.
//!
//! # From programs
//!
//! With `--json` every verb ends with one object on the last line of standard error, whatever else it prints; `--quiet` leaves the rest out but for errors.
//!
//! ```json
//! {
//!   "verb": "map", "done": false, "made": [], "said": [],
//!   "notes": [ { "kind": "looks-reflected", "pose": "run", "text": "pose 'run' would match better ..." } ],
//!   "error": {
//!     "kind": "landmark-off-outline", "file": "cat/scene.toml", "line": 14, "pose": "stand", "landmark": "nose", "place": [120.5, 40.0],
//!     "text": "cat/scene.toml:14: landmark 'nose': ...", "remedy": "move (120.5, 40.0) onto the outline, ..."
//!   }
//! }
//! ```
//!
//! `made` names the file or folder that was made, `said` has the lines that say what was done. `error` is `null` if `done` is true. Of a note or an error, `kind` is the name of the library's
//! variant ([`NoteKind`](crate::pipeline::NoteKind), [`PipelineError`](crate::pipeline::PipelineError)) in small letters, `usage` for a wrong command line, `io` for what the system refuses, and
//! `other`; what is not known is left out. Places are those of the pose's drawing.
//!
//! The next chapter: [`explorer`](super::explorer).
