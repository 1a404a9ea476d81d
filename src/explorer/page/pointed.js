// @ts-check
// The point of the figure under the pointer, and its place in every drawing. The meshes carry it: it keeps its triangle and its part of
// each corner in every embedding, all of which are here already. Nothing is looked for while the pointer rests.
import { h, onceAFrame } from './dom.js';
import { isInside, onMesh, placed } from './located.js';
import { emit, on, store } from './state.js';

/** @import { Flat, Frame, Place } from './answers.js' */
/** @import { MeshPoint } from './located.js' */

/** @typedef {MeshPoint & { layer: number }} FigurePoint */

/**
 * {layer, corners, parts}, or null.
 * @type {FigurePoint | null}
 */
let point = null;

/** What a screen reader says of the point: where it is, when keys move it. */
const spoken = h('p', { class: 'unseen', role: 'status' });
document.body.append(spoken);

/** @type {(found: FigurePoint | null) => void} */
function show(found) {
  if (!found && !point) return;
  point = found;
  emit('pointed');
}

/**
 * The foremost layer that is drawn at a place of the frame.
 * @type {(place: Place) => FigurePoint | null}
 */
function inFrame(place) {
  const { frame, meshes, puppet } = store;
  if (!frame || frame.shape !== puppet?.shape) return null;
  for (const layer of frame.order.slice().reverse()) {
    const { opacity, rings, positions } = frame.layers[layer];
    const found = opacity > 0 && isInside(rings, place) && onMesh(meshes[layer].triangles, positions, place);
    if (found) return { layer, ...found };
  }
  return null;
}

/**
 * A place of a pose's own drawing; `rings` are its outline and holes.
 * @type {(layer: number, index: number, rings: Flat[], place: Place) => FigurePoint | null}
 */
function onPose(layer, index, rings, place) {
  const mesh = store.meshes[layer];
  const points = mesh?.poses[index];
  const found = points && isInside(rings, place) && onMesh(mesh.triangles, points, place);
  return found ? { layer, ...found } : null;
}

/** @type {(place: Place) => void} */
export const pointInFrame = (place) => show(inFrame(place));
/** @type {(layer: number, index: number, rings: Flat[], place: Place) => void} */
export const pointOnPose = (layer, index, rings, place) => show(onPose(layer, index, rings, place));
export const pointAway = () => show(null);

/**
 * Where the point is in the frame of a pose; null if the pose lacks its layer.
 * @type {(pose: number, frame: Frame) => Place | null}
 */
export function pointIn(pose, frame) {
  if (!point || !store.puppet?.layers[point.layer]?.poses.includes(pose)) return null;
  const positions = frame.layers[point.layer]?.positions;
  return positions ? placed(point, positions) : null;
}

/**
 * Where the point is on the drawing of a pose of a layer, in drawing units; null if it is on another layer.
 * @type {(layer: number, index: number) => Place | null}
 */
export function pointOn(layer, index) {
  const points = point?.layer === layer ? store.meshes[layer]?.poses[index] : null;
  return point && points ? placed(point, points) : null;
}

/** Says where the point is: on every drawing that has it. */
export function sayPoint() {
  const layer = point?.layer ?? 0;
  const poses = point ? store.puppet.layers[layer].poses : [];
  const where = poses.map((pose, k) => `${store.scene.poses[pose]?.name}: ${pointOn(layer, k)?.map((v) => v.toFixed(1)).join(', ')}`);
  spoken.textContent = where.join('; ');
}

/**
 * Calls `found(event)` where the pointer has come to, once a displayed frame, unless a button is pressed.
 * @type {(element: HTMLElement | SVGElement, found: (event: PointerEvent) => void) => void}
 */
export function attachPointer(element, found) {
  /** @type {PointerEvent | null} */
  let latest = null;
  const look = onceAFrame(() => latest && found(latest));
  /** @type {HTMLElement} */ (element).addEventListener('pointermove', (event) => {
    if (event.buttons !== 0) return;
    latest = event;
    look();
  });
  element.addEventListener('pointerleave', () => {
    latest = null;
    pointAway();
  });
}

// Triangles are those of one mesh.
on('shape', pointAway);
on('view', (changes) => ('main' in changes || 'tool' in changes) && pointAway());
