//! The scene file: every key of `scene.toml`.
//!
//! A scene is a TOML file beside its drawings. Only `version` and the poses are needed. A key that does not exist is refused, with the number of its
//! line, as is a value that a key does not take. Where a comment below begins with a value, that is what counts without the key. Coordinates are pixels of
//! a picture, x to the right and y down, or the user units of an SVG file.
//!
//! ```toml
//! version = 1
//! reference = "stand"             # chosen: the pose to which all others are matched
//!
//! [input]                         # see the chapter on drawings
//! figure = "auto"                 # "auto": "alpha", "background", "lines"
//! gap = 0.01                      # 0.01: from 0 to 0.2
//! paper = "keep"                  # "keep": "clear"
//! threshold = 0.5                 # 0.5: above 0 and below 1
//! holes = "match"                 # "match": "keep", "fill"
//! parts = "layers"                # "layers": "largest"
//! overlaps = "auto"               # "auto": "refuse"; parts that lie over one another
//! cells = [4, 2]                  # none: columns and rows of sheets
//!
//! [mesh]                          # see the chapter on blending
//! simplify = 0.02                 # 0.02: above 0, at most 0.5
//! edge_length = 0.05              # 0.05: from 0.002 to 1
//!
//! [pose_space]                    # see the chapter on the pose space
//! provider = "biharmonic"         # "biharmonic": "rbf"
//! radial = "b-spline"             # "b-spline": "thin-plate" (of "rbf")
//! epsilon = 0.001                 # 0.001: how soon biharmonic weights level out
//! bounded = false                 # false: true keeps biharmonic weights between 0 and 1
//! walls = []                      # none: polylines that influence may not cross
//!
//! [blend]                         # see the chapter on blending
//! reference = "canonical"         # "canonical": a pose
//! stretch = "linear"              # "linear": "limited", "log"
//! guard = "off"                   # "off": "repair"
//! anchor = "centroid"             # "centroid": a landmark, or a list of them
//!
//! [texture]                       # see the chapter on blending
//! sharpness = 0.5                 # 0.5: from 0 to 1
//! blending = "plain"              # "plain": "linear"
//! drawing = "curves"              # "curves": "pixels"
//! sampling = "smooth"             # "smooth": "nearest"
//! register = "auto"               # "auto": "off"
//!
//! [[pose]]
//! name = "stand"
//! source = "stand.png"            # relative to this file, not outside its folder
//! at = [0.0, 0.0]                 # found: all poses have a place or none
//! mirror = false                  # false: true, "auto"
//! turns = 0                       # 0: whole turns added to its rotation
//! keep = []                       # none: places of loose parts that belong to the figure
//! drop = []                       # none: places of parts that do not
//! figure = "lines"                # as [input] says; `gap`, `paper` and `threshold` likewise
//! order = ["arm", "trunk"]        # as it is seen: limbs from back to front; layers in a scene with layers
//!
//! [[pose]]
//! name = "wave"
//! source = "waves.gif"
//! frame = 2                       # the first picture: which one of an animated file
//! at = [1.0, 0.0]
//!
//! [[pose]]
//! name = "jump"
//! source = "sheet.png"
//! cell = [1, 0]                   # the whole picture: which cell of a sheet
//! at = [0.0, 1.0]
//!
//! [[pose]]
//! name = "smile"
//! source = "smile.svg"
//! element = "head"                # everything: the SVG element whose outline is meant, or the path of a layer in a layered file
//! at = [0.0, -1.0]
//!
//! [[pose]]
//! name = "sway"
//! deform_of = "stand"             # instead of `source`
//! handles = [ { from = [120.0, 80.0], to = [150.0, 60.0] }, { from = [60.0, 200.0], to = [60.0, 200.0] } ]
//! at = [-1.0, 0.0]
//!
//! [[landmark]]                    # any number, see the chapter on landmarks
//! name = "nose"
//! at = { stand = [120.5, 40.0], wave = [131.0, 44.0] }
//!
//! [[landmark]]
//! name = "belt"
//! path = true                     # false: true for lines
//! at = { stand = [[88, 210], [120, 216], [151, 209]] }
//!
//! [[part]]                        # any number: a limb that lies over others, see the chapter on drawings
//! name = "arm"
//! at = { stand = [150.0, 200.0], wave = [96.0, 140.0] }
//! cut = { stand = [[140.0, 170.0], [165.0, 172.0]] }     # where the figure widens
//!
//! [[region]]                      # any number, see the chapter on blending
//! landmark = "nose"
//! radius = 0.1
//! stiffness = 20.0                # 1
//! stretch_limit = 1.2             # no limit
//!
//! [[pseudo_pose]]                 # any number, see the chapter on the pose space
//! from = [0.4, 0.0]
//! at = [0.6, 0.0]
//!
//! [animation]
//! fps = 24                        # 24: at most 1000
//! loop = true                     # true without keys, false with keys
//! size = [1280, 720]              # [1280, 720], or the canvas where the camera shows it
//! background = "transparent"      # "transparent": "white", "black", "#rrggbb", "#rrggbbaa"
//! camera = "fit"                  # "fit": "drawing"
//! hold = 1                        # 1: 2 or 3 frames a drawing; a key may have its own
//! keys = [ { time = 0.0, at = [0.0, 0.0] }, { time = 1.0, at = [1.0, 0.0], spacing = [0.1, 0.5] } ]     # through all poses, evenly
//! ```
//!
//! A scene with layers has these keys besides:
//!
//! ```toml
//! [[layer]]                       # from back to front
//! name = "body"
//!
//! [[layer]]
//! name = "arm"
//! anchor = { layer = "body", at = "shoulder" }        # none: what the layer hangs on, by a landmark of its own
//!
//! [[pose]]
//! name = "stand"
//! source = { body = "body.png", arm = "arm.png" }     # a file a layer, or one SVG or layered file and `element`
//! order = ["arm", "body"]         # as listed above: the layers of this pose from back to front
//!
//! [[pose]]
//! name = "wave"
//! source = "wave.svg"
//! element = { body = "body", arm = "left_arm" }
//!
//! [[pose]]
//! name = "bow"
//! deform_of = "stand"
//! handles = [ { layer = "body", from = [120.0, 80.0], to = [150.0, 60.0] } ]
//!
//! [[landmark]]
//! name = "shoulder"
//! layer = "arm"                   # needed in a scene with layers
//! at = { stand = [88.0, 120.0], wave = [90.0, 118.0] }
//! ```
//!
//! The scene of a shape in space is a file of another kind; [`ShapeScene`](crate::scene::ShapeScene) has all its keys.
//!
//! The next chapter: [`shapes_in_space`](super::shapes_in_space).
