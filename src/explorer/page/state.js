// What the page knows, and who wants to hear when it changes.
//
// Events: `changing` (what changed is being asked for), `scene`, `state`, `shape` (meshes or pictures), `weights` (weights of the same
// places may differ), `place` (the probe), `frame` (a frame arrived), `view` (what is shown and how), `pose` (another pose is looked
// at), `gesture` (a path to be saved); `match` (the match arrived), `match-stale` (it is not what was edited), `layer` (the matches
// show another one), `marks` (what is chosen or new), `held` (where it is dragged); `pointed` (another point of the figure is under the
// pointer); `bent` (a frame that handles bend); `figures` (what was taken for the figures arrived); `drawn` and `matched` (frame or
// match are on the screen).
import { getJson, getWords, postJson, readMeshes, Refused } from './api.js';

/** Height of a window, in CSS pixels, from which on the strip of all drawings leaves enough to the picture. */
const ROOM_FOR_PLACES = 760;

export const store = {
  /** `api/state`, `api/scene`, `api/puppet`, `api/mesh`. */
  state: null,
  scene: null,
  puppet: null,
  meshes: [],
  /** Where the probe is, and the frame there. */
  place: [0, 0],
  frame: null,
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

const listeners = new Map();

/** Calls `listener` at each of these events, until what is returned is called. */
export function on(names, listener) {
  for (const name of names.split(' ')) {
    if (!listeners.has(name)) listeners.set(name, []);
    listeners.get(name).push(listener);
  }
  return () => names.split(' ').forEach((name) => listeners.set(name, listeners.get(name).filter((other) => other !== listener)));
}

/** Calls `listener` at each of these events at which what `of` says is not what it said before. */
export function onChange(names, of, listener) {
  let before;
  on(names, (detail) => {
    const now = JSON.stringify(of());
    if (now === before) return;
    before = now;
    listener(detail);
  });
}

export function emit(name, detail) {
  for (const listener of listeners.get(name) ?? []) listener(detail);
}

/** Changes what is shown. */
export function look(changes) {
  Object.assign(store.view, changes);
  emit('view', changes);
}

export function choosePose(pose) {
  store.pose = pose;
  emit('pose');
}

/** Moves the probe. */
export function moveTo(place) {
  store.place = place.map((value) => (Object.is(value, -0) ? 0 : value));
  emit('place');
}

export const poseNamed = (name) => store.scene.poses.findIndex((pose) => pose.name === name);

/** Numbers as they are written into a scene: short, and precise enough. */
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
let sceneText = null;

/** Takes a state that the server answered, one after the other. */
export function take(state) {
  taking = taking.then(() => taken(state)).catch((error) => console.error(error));
  return taking;
}

async function taken(state) {
  if (store.state && state.seq < store.state.seq) return;
  store.state = state;
  const changed = (name) => state.revisions[name] !== revisions[name];
  const [scene, weights] = [changed('scene'), changed('weights')];
  const shape = changed('shape') || changed('pictures');
  revisions = { ...state.revisions };
  try {
    const meshes = shape && state.revisions.shape > 0;
    emit('changing', { meshes });
    const [wholeScene, puppet, words] = await Promise.all([
      scene || shape || weights ? getJson('scene') : null,
      meshes ? getJson('puppet') : null,
      meshes ? getWords('mesh') : null,
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
    if (meshes) {
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

let told = () => {};

/** Who is told of an edit that was refused. */
export function tellRefusals(listener) {
  told = listener;
}

/** One step of undo; of edits with the same `merge`, one after the other, all are one step. */
export async function edit(ops, label, merge) {
  return asked('edit', { ops, label, phase: 'done', merge });
}

export async function asked(route, body) {
  try {
    const state = await postJson(route, body);
    await take(state);
    return state;
  } catch (error) {
    told(error.problem ?? { message: error.message });
    return null;
  }
}

/** An edit that follows a pointer: while one request is on its way only the newest other waits. */
export class Drag {
  constructor(label) {
    this.label = label;
    this.waiting = null;
    this.sending = null;
    this.begun = false;
  }

  to(ops) {
    this.begun = true;
    this.waiting = { ops, label: this.label, phase: 'drag' };
    this.sending ??= this.send();
  }

  async send() {
    while (this.waiting) {
      const body = this.waiting;
      this.waiting = null;
      try {
        await take(await postJson('edit', body));
      } catch (error) {
        if (body.phase !== 'drag') told(error.problem ?? { message: error.message });
      }
    }
    this.sending = null;
  }

  async end(ops) {
    if (!this.begun) return;
    this.waiting = { ops, label: this.label, phase: 'done' };
    await (this.sending ??= this.send());
  }

  async cancel() {
    if (!this.begun) return;
    this.waiting = { ops: [], label: this.label, phase: 'cancel' };
    await (this.sending ??= this.send());
  }
}
