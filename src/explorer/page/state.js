// @ts-check
// What the page knows, and who wants to hear when it changes.
//
// Events: `changing` (what changed is being asked for), `scene`, `state`, `shape` (meshes or pictures), `weights` (weights of the same
// places may differ), `place` (the probe), `frame` (a frame arrived), `view` (what is shown and how), `pose` (another pose is looked
// at), `gesture` (a path to be saved); `match` (the match arrived), `match-stale` (it is not what was edited), `layer` (the matches
// show another one), `marks` (what is chosen or new), `held` (where it is dragged); `pointed` (another point of the figure is under the
// pointer); `bent` (a frame that handles bend); `figures` (what was taken for the figures arrived); `drawn` and `matched` (frame or
// match are on the screen).
import { getJson, getWords, postJson, problemOf, readMeshes, Refused } from './api.js';
import { OneAtATime } from './newest.js';

/** @import { Edited, Frame, GestureKeys, Mesh, Op, Place, Posted, Problem, Provider, Puppet } from './answers.js' */
/** @import { Revisions, Scene, State, StateRoute, Stretch } from './answers.js' */
/** @import { Grid } from './painter.js' */

/** @typedef {'reach' | 'pan' | 'bend'} Tool */
/** @typedef {{ provider?: Provider, stretch?: Stretch, sharpness?: number }} Comparison Settings in place of the scene's own. */
/**
 * What is shown and how.
 * @typedef {{
 *   main: 'picture' | 'matches' | 'drawings', map: 'plain' | 'weight' | 'validity', tool: Tool, onion: 'off' | 'poses' | 'path',
 *   mark: 'point' | 'line', mesh: boolean, places: boolean, snap: boolean, compare: Comparison | null,
 * }} View
 */
/**
 * A recorded path: time and place of each sample; its keys once they are found.
 * @typedef {{ samples: number[][] } & Partial<GestureKeys>} Gesture
 */
/** @typedef {Frame & { place: Place }} ShownFrame */
/**
 * A pose as it was just drawn.
 * @typedef {{ pose: number, canvas: HTMLCanvasElement, view: Grid, frame: Frame, box: number[] }} Thumbnail
 */
/**
 * What the page knows. Of `state`, `scene`, `puppet` and `frame` nothing is there before the first answer; what an event calls can rely on
 * what it tells of, and only what may run before that asks.
 * @typedef {{
 *   state: State, scene: Scene, puppet: Puppet, meshes: Mesh[], place: Place, frame: ShownFrame, pixel: number, pose: number | null,
 *   layer: number, view: View, gesture: Gesture | null, path?: Place[], lost?: boolean,
 * }} Store
 */
/**
 * What each event tells.
 * @typedef {{
 *   changing: { meshes: boolean }, scene: void, state: void, shape: void, weights: void, place: void, frame: void,
 *   view: Partial<View>, pose: void, gesture: void, match: void, 'match-stale': void, layer: void, marks: void, held: void,
 *   pointed: void, bent: Frame | null, figures: void, drawn: void, matched: number, tab: string, 'toggle-mesh': void, tool: Tool,
 *   zoom: void, theme: void, refused: Problem, thumbnail: Thumbnail, path: void, recording: void, recorded: number[][],
 * }} Events
 */
/**
 * The names in a list with spaces between them.
 * @template {string} S
 * @typedef {S extends `${infer First} ${infer Rest}` ? First | Names<Rest> : S} Names
 */
/**
 * A list of events that there are.
 * @template {string} S
 * @typedef {Names<S> extends keyof Events ? S : never} Heard
 */

/** Height of a window, in CSS pixels, from which on the strip of all drawings leaves enough to the picture. */
const ROOM_FOR_PLACES = 760;

/**
 * What is not there yet.
 * @type {() => never}
 */
export const notYet = () => /** @type {never} */ (/** @type {unknown} */ (null));

/** @type {Store} */
export const store = {
  /** `api/state`, `api/scene`, `api/puppet`, `api/mesh`. */
  state: notYet(),
  scene: notYet(),
  puppet: notYet(),
  meshes: [],
  /** Where the probe is, and the frame there. */
  place: [0, 0],
  frame: notYet(),
  /** Drawing units a pixel of the screen, as it was drawn last; 0 before that. */
  pixel: 0,
  /** The pose that is looked at, or null. */
  pose: null,
  layer: 0,
  view: {
    main: 'picture', // or 'matches', 'drawings'
    map: 'plain', // or 'weight', 'validity'
    tool: 'reach', // or 'pan', 'bend'
    onion: 'off', // or 'poses', 'path'
    mark: 'point', // or 'line': what a click on a drawing begins
    mesh: false,
    places: innerHeight >= ROOM_FOR_PLACES, // the point under the pointer, in all drawings
    snap: false,
    compare: null, // settings shown beside the scene's own
  },
  gesture: null,
};

/** @type {Map<string, Function[]>} */
const listeners = new Map();

/**
 * Calls `listener` at each of these events, until what is returned is called.
 * @type {<S extends string>(names: Heard<S>, listener: (detail: Events[Names<S> & keyof Events]) => void) => () => void}
 */
export function on(names, listener) {
  for (const name of names.split(' ')) {
    if (!listeners.has(name)) listeners.set(name, []);
    listeners.get(name)?.push(listener);
  }
  return () => names.split(' ').forEach((name) => listeners.set(name, (listeners.get(name) ?? []).filter((other) => other !== listener)));
}

/**
 * Calls `listener` at each of these events at which what `of` says is not what it said before.
 * @type {<S extends string>(names: Heard<S>, of: () => unknown, listener: (detail: Events[Names<S> & keyof Events]) => void) => void}
 */
export function onChange(names, of, listener) {
  /** @type {string | undefined} */
  let before;
  on(names, (detail) => {
    const now = JSON.stringify(of());
    if (now === before) return;
    before = now;
    listener(detail);
  });
}

/** @type {<N extends keyof Events>(name: N, ...detail: undefined extends Events[N] ? [] : [Events[N]]) => void} */
export function emit(name, detail) {
  for (const listener of listeners.get(name) ?? []) listener(detail);
}

/**
 * Changes what is shown.
 * @type {(changes: Partial<View>) => void}
 */
export function look(changes) {
  Object.assign(store.view, changes);
  emit('view', changes);
}

/** @type {(pose: number | null) => void} */
export function choosePose(pose) {
  store.pose = pose;
  emit('pose');
}

/**
 * Moves the probe.
 * @type {(place: Place) => void}
 */
export function moveTo(place) {
  store.place = place.map((value) => (Object.is(value, -0) ? 0 : value));
  emit('place');
}

/** @type {(name: string) => number} */
export const poseNamed = (name) => store.scene.poses.findIndex((pose) => pose.name === name);

/**
 * Numbers as they are written into a scene: short, and precise enough.
 * @type {(value: number, digits?: number) => number}
 */
export const rounded = (value, digits = 4) => Number(value.toFixed(digits));

// Following the server.

let revisions = { scene: -1, weights: -1, shape: -1, pictures: -1 };

/** Reads all there is, then follows the server's changes for good. */
export async function start() {
  await take(await getJson('state'));
  follow();
}

async function follow() {
  for (;;) {
    try {
      await take(await getJson('state', { after: store.state.seq }));
      if (store.lost) {
        store.lost = false;
        emit('state');
      }
    } catch (error) {
      if (error instanceof Refused && error.status === 403) return;
      store.lost = true;
      emit('state');
      await new Promise((wait) => setTimeout(wait, 1000));
    }
  }
}

let taking = Promise.resolve();
/** @type {string | null} */
let sceneText = null;

/**
 * Takes a state that the server answered, one after the other.
 * @type {(state: State) => Promise<void>}
 */
export function take(state) {
  taking = taking.then(() => taken(state)).catch((error) => console.error(error));
  return taking;
}

/** @type {(state: State) => Promise<void>} */
async function taken(state) {
  if (store.state && state.seq < store.state.seq) return;
  store.state = state;
  /** @type {(name: keyof Revisions) => boolean} */
  const changed = (name) => state.revisions[name] !== revisions[name];
  const [scene, weights] = [changed('scene'), changed('weights')];
  const shape = changed('shape') || changed('pictures');
  revisions = { ...state.revisions };
  try {
    const meshes = shape && state.revisions.shape > 0;
    emit('changing', { meshes });
    const [wholeScene, shapes] = await Promise.all([
      scene || shape || weights ? getJson('scene') : null,
      meshes ? Promise.all([getJson('puppet'), getWords('mesh')]) : null,
    ]);
    if (wholeScene) {
      store.scene = wholeScene;
      if (store.place.length !== store.scene.dimension && store.scene.poses.length > 0) {
        store.place = store.scene.poses[0].at.slice();
      }
      // Most revisions of a drag are what was shown at once, computed.
      const text = JSON.stringify({ ...wholeScene, revision: null });
      if (text !== sceneText) emit('scene');
      sceneText = text;
    }
    if (shapes) {
      const [puppet, words] = shapes;
      store.puppet = puppet;
      store.meshes = readMeshes(words);
      store.layer = Math.min(store.layer, puppet.layers.length - 1);
      emit('shape');
    }
    if (shape || weights) emit('weights');
  } catch (error) {
    if (!(error instanceof Refused)) throw error;
  }
  emit('state');
}

// Edits.

/** @type {(problem: Problem) => void} */
let told = () => {};

/**
 * Who is told of an edit that was refused.
 * @type {(listener: (problem: Problem) => void) => void}
 */
export function tellRefusals(listener) {
  told = listener;
}

/**
 * One step of undo; of edits with the same `merge`, one after the other, all are one step.
 * @type {(ops: Op[], label: string, merge?: string) => Promise<Edited | null>}
 */
export async function edit(ops, label, merge) {
  return asked('edit', { ops, label, phase: 'done', merge });
}

/** @type {<R extends StateRoute>(route: R, body: object) => Promise<Posted[R] | null>} */
export async function asked(route, body) {
  try {
    const state = await postJson(route, body);
    await take(state);
    return state;
  } catch (error) {
    told(problemOf(error));
    return null;
  }
}

/** @typedef {{ ops: Op[], label: string, phase: 'drag' | 'done' | 'cancel' }} DragEdit */

/** @type {(body: DragEdit) => Promise<void>} */
async function sendDragged(body) {
  try {
    await take(await postJson('edit', body));
  } catch (error) {
    if (body.phase !== 'drag') told(problemOf(error));
  }
}

/** An edit that follows a pointer: while one request is on its way only the newest other waits. */
export class Drag {
  /** @param {string} label */
  constructor(label) {
    this.label = label;
    this.edits = new OneAtATime(sendDragged);
    this.begun = false;
  }

  /** @type {(ops: Op[]) => void} */
  to(ops) {
    this.begun = true;
    this.edits.want({ ops, label: this.label, phase: 'drag' });
  }

  /** @type {(ops: Op[]) => Promise<void>} */
  async end(ops) {
    if (this.begun) await this.edits.want({ ops, label: this.label, phase: 'done' });
  }

  async cancel() {
    if (this.begun) await this.edits.want({ ops: [], label: this.label, phase: 'cancel' });
  }
}
