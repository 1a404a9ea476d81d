// @ts-check
// Dragging the drawing itself: along the plane (inverse posing), or away from it, by handles, as a new pose.
import { postJson, postWords, problemOf } from './api.js';
import { follow, h, s, set } from './dom.js';
import { framesOf } from './frames.js';
import { onMesh, partsIn, placed } from './located.js';
import { OneAtATime } from './newest.js';
import { drawingView, toDrawing, toStage } from './view.js';
import { edit, emit, moveTo, notYet, on, rounded, store } from './state.js';

/** @import { Flat, Frame, Handle, Place } from './answers.js' */
/** @import { MeshPoint } from './located.js' */

/** @typedef {MeshPoint & { outside: number }} Carrier A point of an outline; it may be that far outside of its triangle. */

/** @type {HTMLElement} */
let stage = notYet();
/** @type {SVGSVGElement} */
let overlay = notYet();
/**
 * Of the pose that is bent: where they were on its drawing, and where they are.
 * @type {Handle[]}
 */
let handles = [];
/** @type {{ anchor: MeshPoint, layer: number, to: Place } | null} */
let reaching = null;
/** @type {HTMLElement} */
let bar = notYet();

/** @type {(on_stage: HTMLElement) => void} */
export function attachHandles(on_stage) {
  stage = on_stage;
  overlay = s('svg', { class: 'overlay', 'aria-hidden': 'true' });
  bar = h('div', { class: 'floating upper hidden', role: 'group', 'aria-label': 'Handles' });
  stage.append(overlay, bar);
}

/** @type {(event: PointerEvent) => Place} */
function under(event) {
  const box = stage.getBoundingClientRect();
  return toDrawing([event.clientX - box.left, event.clientY - box.top]);
}

/**
 * A press on the picture.
 * @type {(event: PointerEvent) => void}
 */
export function pictureDrag(event) {
  if (!store.frame) return;
  if (store.view.tool === 'bend') return bendPress(event);
  reach(event);
}

// Inverse posing.

/** @type {(event: PointerEvent) => void} */
function reach(event) {
  const from = under(event);
  const hit = layerUnder(from);
  const anchor = hit === null ? null : onLayer(hit, from);
  if (hit === null || !anchor) return;
  const begun = store.place.slice();
  const search = new OneAtATime(async (/** @type {Place} */ to) => {
    const provider = store.view.compare?.provider ?? null;
    try {
      const answer = await postJson('reach', { layer: hit, at: begun, start: store.place, points: [{ from, to }], provider });
      if (reaching) moveTo(answer.at.map((v) => rounded(v)));
    } catch (error) {
      emit('refused', problemOf(error));
      search.forget();
    }
  });
  reaching = { anchor, layer: hit, to: from };
  follow(event, (next, ended) => {
    if (ended) {
      reaching = null;
      drawHandles();
      return;
    }
    const to = under(next);
    if (reaching) reaching.to = to;
    search.want(to);
    drawHandles();
  });
}

/**
 * The foremost layer with a triangle under a place of the drawing.
 * @type {(place: Place) => number | null}
 */
function layerUnder(place) {
  for (const k of store.frame.order.slice().reverse()) if (onLayer(k, place)) return k;
  return null;
}

/**
 * The point of a layer's mesh under a place.
 * @type {(layer: number, place: Place, points?: Flat) => MeshPoint | null}
 */
const onLayer = (layer, place, points = store.frame.layers[layer].positions) => onMesh(store.meshes[layer].triangles, points, place);

// A new pose by handles: on the drawing of the pose that is chosen, or the nearest.

/** @type {() => number} */
function basePose() {
  if (store.pose !== null) return store.pose;
  const weights = Array.from(store.frame?.weights ?? [1]);
  return weights.indexOf(Math.max(...weights));
}

/** @type {(pose: number) => number} */
const layerPose = (pose) => store.puppet.layers[store.layer].poses.indexOf(pose);

/** The pose that is bent, or whose copy is; -1 if there is none. */
let basis = -1;
/**
 * The bent pose whose handles are moved; null: a new one.
 * @type {string | null}
 */
let editing = null;
/**
 * A layer, a ring: how the outline of the pose is carried by the mesh.
 * @type {Carrier[][][]}
 */
let edges = [];
/** Shows the pose that is going to be bent. */
async function beginBend() {
  handles = [];
  basis = basePose();
  // A pose that is bent already is bent on: its handles are those of the scene.
  const pose = store.scene.poses[basis];
  editing = pose.kind === 'deformed' && store.puppet.layers.length === 1 ? pose.name : null;
  if (editing) {
    handles = pose.handles.map(({ from, to }) => ({ from: from.slice(), to: to.slice() }));
    basis = store.scene.poses.findIndex((other) => other.name === pose.deform_of);
  }
  latest = null;
  edges = [];
  const own = layerPose(basis);
  if (own < 0) {
    basis = -1;
    emit('refused', { message: `the layer ${store.puppet.layers[store.layer].name} is not in this pose` });
    return;
  }
  // All points of the outline: it is to be bent.
  const [frame] = await framesOf('weights', [store.scene.poses.map((_, k) => Number(k === basis))], false);
  edges = (frame?.layers ?? []).map((layer, k) => layer.rings.map((ring) => carriers(k, layer.positions, ring)));
  await deform();
}

/**
 * The points of a ring as parts of the triangles that they lie in, or nearest to.
 * @type {(layer: number, points: Flat, ring: Flat) => Carrier[]}
 */
function carriers(layer, points, ring) {
  const { triangles } = store.meshes[layer];
  const carried = [];
  for (let k = 0; k < ring.length; k += 2) {
    /** @type {Carrier} */
    let best = { corners: [], parts: [], outside: Infinity };
    for (let t = 0; t < triangles.length && best.outside > 0; t += 3) {
      const corners = [triangles[t], triangles[t + 1], triangles[t + 2]];
      const parts = partsIn(corners, points, ring[k], ring[k + 1]);
      const outside = Math.max(0, -Math.min(...parts)) * (1 + Math.max(0, -Math.min(...parts)));
      if (outside < best.outside) best = { outside, corners, parts };
    }
    carried.push(best);
  }
  return carried;
}

/** @type {Float32Array | null} */
let latest = null;
const shownBent = () => latest ?? store.meshes[store.layer].poses[layerPose(basis)];

/** Bends the pose by the handles as they are when it is their turn. */
const bending = new OneAtATime(async () => {
  if (handles.length === 0) {
    latest = null;
    emit('bent', bentFrame(shownBent(), 0));
    return;
  }
  const pose = store.scene.poses[basis];
  try {
    const moved = handles.map(({ from, to }) => ({ from, to }));
    const words = await postWords('deform', { layer: store.layer, pose: pose.name, handles: moved });
    const vertices = words.u32();
    const inverted = words.u32();
    const positions = words.f32s(2 * vertices);
    latest = positions;
    emit('bent', bentFrame(positions, inverted));
  } catch (error) {
    emit('refused', problemOf(error));
  }
});
const deform = () => bending.want(undefined);

/**
 * A frame of one pose, with one layer's vertices elsewhere.
 * @type {(positions: Float32Array, inverted: number) => Frame}
 */
function bentFrame(positions, inverted) {
  /** @type {(count: number, index: number) => Float32Array} */
  const single = (count, index) => Float32Array.from({ length: count }, (_, k) => Number(k === index));
  return {
    ...store.frame, inverted, place: store.place,
    layers: store.puppet.layers.map((layer, k) => {
      const own = layer.poses.indexOf(basis);
      const points = k === store.layer ? positions : store.meshes[k].poses[Math.max(own, 0)];
      const rings = (edges[k] ?? []).map((ring) => Float32Array.from(ring.flatMap((carrier) => placed(carrier, points))));
      return {
        opacity: own < 0 ? 0 : 1, positions: points, rings, inverted: new Uint32Array(0),
        weights: single(layer.poses.length, Math.max(own, 0)),
        textureWeights: single(layer.textures.length, layer.texture_of[Math.max(own, 0)]),
      };
    }),
  };
}

/** @type {(event: PointerEvent) => void} */
function bendPress(event) {
  if (basis < 0) return;
  const at = under(event);
  const view = drawingView();
  let handle = handles.find(({ to }) => Math.hypot(...toStage(to, view).map((v, d) => v - toStage(at, view)[d])) < 10);
  if (!handle) {
    const own = store.meshes[store.layer].poses[layerPose(basis)];
    const shown = shownBent();
    const hit = onLayer(store.layer, at, shown);
    if (!hit) return;
    handle = { from: placed(hit, own), to: at };
    handles.push(handle);
    deform();
  }
  drawHandles();
  follow(event, (next, ended) => {
    if (ended && next.type === 'pointercancel') return;
    handle.to = under(next).map((v) => rounded(v, 2));
    deform();
    drawHandles();
  });
}

async function keep() {
  const of = store.scene.poses[basis];
  const many = store.scene.layers.length > 1 || store.scene.layers[0]?.name !== store.scene.name;
  const layer = many ? store.scene.layers[store.layer].name : undefined;
  const written = handles.map(({ from, to }) => ({ from: from.map((v) => rounded(v, 2)), to: to.map((v) => rounded(v, 2)) }));
  const op = editing ? {
    op: 'set_handles', pose: editing, handles: written,
  } : {
    op: 'add_deformed_pose', of: of.name, at: store.place.map((v) => rounded(v)),
    handles: written.map((handle) => ({ ...handle, ...(layer ? { layer } : {}) })),
  };
  const state = await edit([op], editing ? `move handles of '${editing}'` : `add a pose bent from '${of.name}'`);
  if (state) emit('tool', 'reach');
}

// Drawing them.

export function drawHandles() {
  if (!overlay) return;
  const view = drawingView();
  /** @type {SVGElement[]} */
  const made = [];
  if (reaching) {
    const [a, b] = [toStage(placed(reaching.anchor, store.frame.layers[reaching.layer].positions), view), toStage(reaching.to, view)];
    made.push(s('line', { class: 'pull', x1: a[0], y1: a[1], x2: b[0], y2: b[1] }), dot('anchor', a, 4), dot('target', b, 5));
  }
  if (store.view.tool === 'bend') handles.forEach(({ to }) => made.push(dot('handle', toStage(to, view), 6)));
  overlay.replaceChildren(...made);
  bar.classList.toggle('hidden', store.view.tool !== 'bend');
  if (store.view.tool === 'bend') drawBar();
}

/** @type {(name: string, at: Place, r: number) => SVGElement} */
const dot = (name, [cx, cy], r) => set(s('circle', { class: name }), { cx, cy, r });

let said = '';
function drawBar() {
  const pose = store.scene.poses[basis]?.name ?? '';
  // Buttons that are made again under a finger that presses them are not pressed.
  const now = `${pose} ${editing ?? ''} ${handles.length}`;
  if (said === now) return;
  said = now;
  const hint = editing ? 'Drag its handles, or click to add one.'
    : handles.length < 2 ? 'Click on the drawing to pin it, drag to bend it.' : 'Becomes a pose at the probe.';
  const disabled = handles.length === 0;
  const clear = () => {
    handles = [];
    deform();
    said = '';
    drawHandles();
  };
  bar.replaceChildren(
    h('span', {}, 'Bending ', h('b', {}, editing ?? pose)), h('span', { class: 'faint clip' }, hint),
    h('button', { type: 'button', class: 'bordered', disabled, onclick: clear }, 'Clear'),
    h('button', { type: 'button', class: 'main', id: 'keep-bent', disabled, onclick: keep }, editing ? 'Save handles' : 'Add pose'));
}

on('view', (changes) => {
  if (!('tool' in changes)) return;
  latest = null;
  emit('bent', null);
  said = '';
  if (store.view.tool === 'bend' && store.frame) beginBend();
  drawHandles();
});
on('place', () => store.view.tool === 'bend' && drawHandles());
