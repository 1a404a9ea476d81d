// What the server answers, in the words of its own description (`explorer/mod.rs`, which says what each field means). For the checker
// alone: nothing here is served. Places are lists of numbers, as many as the space has dimensions, or x, y of a drawing.

export type Place = number[];
/** x, y, x, y, ... */
export type Flat = ArrayLike<number>;

export interface Problem {
  message: string;
  where?: 'file' | 'pose' | 'landmark' | 'layer' | 'space' | 'mapping' | 'animation' | null;
  pose?: string | null;
  landmark?: string | null;
  layer?: string | null;
  line?: number | null;
}

/** `api/state`, and the answer to an edit. */
export interface State {
  seq: number;
  revisions: Revisions;
  working: boolean;
  dragging: boolean;
  saved: boolean;
  conflict: boolean;
  temporary: boolean;
  save_error: string | null;
  undo: string | null;
  redo: string | null;
  problems: Problem[];
  timings: { mapping_ms: number | null } | null;
  job: Job | null;
}
export interface Revisions {
  scene: number;
  weights: number;
  shape: number;
  pictures: number;
}
export interface Job {
  id: number;
  output: string;
  command: string;
  done: number;
  total: number;
  seconds: number;
  left: number;
  state: 'running' | 'done' | 'failed' | 'cancelled';
  message: string | null;
}

/** `api/scene`. What a scene whose text cannot be read lacks may be missing. */
export interface Scene {
  name: string;
  file: string;
  revision: number;
  dimension: number;
  poses: Pose[];
  pseudo_poses: PseudoPose[];
  pose_space?: { provider: Provider; radial: string; walls?: Place[][] };
  blend?: { stretch: Stretch; guard: string };
  texture?: { sharpness: number; blending: string; register: string; drawing: string };
  layers: { name: string; poses: number[] }[];
  landmarks: Landmark[];
  animation: Animation | null;
  box: Place[] | null;
  camera: { scale: number; shift: Place } | null;
  notes?: string[];
  problems?: Problem[];
}
export interface Pose {
  name: string;
  at: Place;
  kind: 'drawn' | 'deformed' | 'layered';
  source: string | null;
  deform_of: string | null;
  handles: Handle[];
  mirror: boolean;
  layers: number[];
}
export interface PseudoPose {
  from: Place;
  at: Place;
}
export interface Handle {
  from: Place;
  to: Place;
}
/** A landmark is at one place of a pose or, if it is a `path`, along several. */
export type Landmark = PointLandmark | PathLandmark;
export interface PointLandmark {
  name: string;
  layer?: number;
  path: false;
  at: Record<string, Place>;
}
export interface PathLandmark {
  name: string;
  layer?: number;
  path: true;
  at: Record<string, Place[]>;
}
export interface Animation {
  fps: number;
  loop: boolean;
  size: number[];
  background: string;
  /** Frames for which a drawing is shown. */
  hold: number;
  own_keys: boolean;
  keys: Key[];
}
export interface Key {
  time: number;
  at: Place;
  hold?: number;
  spacing?: number[];
}
export type Provider = 'biharmonic' | 'rbf';
export type Stretch = 'linear' | 'limited' | 'log';

/** A block of `api/frame`. */
export interface Frame {
  shape: number;
  revision: number;
  inverted: number;
  weights: ArrayLike<number>;
  textureWeights: ArrayLike<number>;
  /** Layers from back to front. */
  order: number[];
  layers: Shape[];
  /** Where the probe was, of the frame that is shown. */
  place?: Place;
}
/** A layer of a frame. */
export interface Shape {
  opacity: number;
  positions: Float32Array;
  weights: Float32Array;
  textureWeights: Float32Array;
  inverted: Uint32Array;
  rings: Float32Array[];
}

/** `api/puppet`. */
export interface Puppet {
  shape: number;
  pictures: number;
  nearest: boolean;
  layers: PuppetLayer[];
}
export interface PuppetLayer {
  name: string;
  poses: number[];
  vertices: number;
  triangles: number;
  texture_of: number[];
  curves: boolean;
  textures: Texture[];
}
export interface Texture {
  pose: number;
  colour: Sheet;
  drawing: Sheet;
}
/** A picture and where it lies: texel = (drawing unit - origin) * scale. */
export interface Sheet {
  width: number;
  height: number;
  origin: Place;
  scale: number;
}

/** A layer of `api/mesh`. */
export interface Mesh {
  vertices: number;
  triangles: Uint32Array;
  poses: Float32Array[];
  rings: Uint32Array[];
}
/** A layer of `api/surface`: `anchors`, one a pose, say what carries its vertices. */
export interface FineMesh {
  vertices: number;
  triangles: Uint32Array;
  anchors: { carriers: Uint32Array; shares: Float32Array }[];
  rings: Uint32Array[];
}

/** `api/correspondences`. */
export interface Correspondences {
  shape: number;
  reference: number;
  poses: MatchPose[];
  links?: Link[];
  suggestions?: { pose: number; from: number; to: number; cost: number }[];
  landmarks?: KnownLandmark[];
}
/** The first three are left out where the page said that it knows them. */
export interface MatchPose {
  outline: number[] | null;
  holes: number[][];
  salient?: { at: Place }[];
  pose: number;
  name: string;
  drawn: boolean;
  mark: string;
  picture: Sheet | null;
  looks_mirrored: boolean;
}
export interface Link {
  at: Place[];
  landmark: string | null;
  /** Its colour, which the page adds. */
  hue?: string;
}
export interface KnownLandmark {
  name: string;
  kind: 'outline' | 'rim' | 'inside' | 'line';
  at: Place[][];
}

/** `api/figure`. */
export interface Figure {
  name: string;
  bitmap: boolean;
  taken: string;
  mark: string;
  sheet: Sheet | null;
  pieces: Piece[];
  notes?: string[];
  reading: Reading;
  usual: Reading;
  own: string[];
  keep: Place[];
  drop: Place[];
  problem: Problem | null;
}
export interface Piece {
  role: 'body' | 'part' | 'kept' | 'dropped';
  outline: number[];
  holes: number[][];
}
export interface Reading {
  figure: string;
  gap: number;
  paper: string;
  threshold: number;
}

/** `api/path`. */
export interface Path {
  duration: number;
  fps: number;
  start?: number;
  /** Whether places are held from frame to frame. */
  held?: boolean;
  at: Place[];
}
/** `api/gesture`. */
export interface GestureKeys {
  keys: Key[];
  error: number;
  path: number[][];
}

/** One operation of `api/edit`. */
export type Op = { op: string } & Record<string, unknown>;
/** The answer to an edit; `names` were made up for it. */
export type Edited = State & { names?: string[] };

/** JSON that is answered, by the route that is asked. */
export interface Got {
  state: State;
  scene: Scene;
  puppet: Puppet;
  correspondences: Correspondences;
  figure: Figure;
  weights: { weights: number[]; texture_weights: number[] }[];
}
export interface Posted {
  edit: Edited;
  undo: State;
  redo: State;
  save: State;
  keep: State;
  conflict: State;
  export: State;
  'export/cancel': State;
  reach: { at: Place };
  carry: { poses: string[]; at: (Place | null)[] };
  path: Path;
  gesture: GestureKeys;
  command: { command: string };
}
/** Routes that only change the state and answer it. */
export type StateRoute = 'edit' | 'undo' | 'redo' | 'save' | 'keep' | 'conflict' | 'export' | 'export/cancel';
