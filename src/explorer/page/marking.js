// @ts-check
// The pointer on the drawings: landmarks are chosen, dragged, and made; points, and lines of points.
import { postJson, problemOf } from './api.js';
import { clamp, follow, h, placeInSvg, targetOf } from './dom.js';
import { icon } from './icons.js';
import { choose, drawnPoses, match, placesOf } from './match.js';
import { Drag, edit, emit, rounded, store } from './state.js';

/** @import { Place } from './answers.js' */
/** @import { Cell, FreshLine } from './match.js' */

/** CSS pixels that a pointer may tremble while it clicks. */
const TREMBLE = 3;

/** @type {(event: MouseEvent, cell: Cell) => Place} */
function placeUnder(event, cell) {
  const point = placeInSvg(cell.drawing, event);
  const [left, top, w, h_] = cell.box;
  return [rounded(clamp(point.x, left, left + w), 2), rounded(clamp(point.y, top, top + h_), 2)];
}

/**
 * A press on the drawing of a pose.
 * @type {(event: PointerEvent, cell: Cell) => void}
 */
export function press(event, cell) {
  if (event.button !== 0 || !cell.pose.drawn) return;
  event.preventDefault();
  const open = match.fresh?.open;
  if (open) {
    if (open === cell.pose.name) extend(cell, placeUnder(event, cell));
    return;
  }
  /** @type {SVGElement | null} */
  const group = targetOf(event).closest('.mark, .line');
  if (group?.classList.contains('line')) return dragLine(event, cell, group.dataset.landmark || null);
  if (group) return dragged(event, cell, group.dataset.landmark || null, (next) => placeUnder(next, cell));
  start(cell, placeUnder(event, cell));
}

/**
 * The same from the keyboard, at a place: the next point of a line, the place of a new landmark on this pose, or a new one.
 * @type {(cell: Cell, at: Place) => void}
 */
export function put(cell, at) {
  const { fresh } = match;
  const pose = cell.pose.name;
  if (fresh?.open) {
    if (fresh.open === pose) extend(cell, at);
  } else if (fresh && !fresh.path) {
    fresh.at[pose] = at;
    emit('held');
  } else start(cell, at);
}

/**
 * The end of a line that is being drawn on this pose follows.
 * @type {(cell: Cell, at: Place) => boolean}
 */
export function trailTo(cell, at) {
  const { fresh } = match;
  const points = fresh?.open === cell.pose.name && fresh.at[cell.pose.name];
  if (points) points[points.length - 1] = at;
  return Boolean(points);
}

/**
 * A second press at once: takes a point out of a line, or ends one. True if it meant something here.
 * @type {(event: MouseEvent, cell: Cell) => boolean}
 */
export function pressTwice(event, cell) {
  if (match.fresh?.open) {
    close();
    return true;
  }
  /** @type {SVGElement | null} */
  const group = targetOf(event).closest('.mark, .line');
  /** @type {SVGElement | null} */
  const node = targetOf(event).closest('[data-node]');
  if (node) removeNode(cell, group?.dataset.landmark || null, Number(node.dataset.node));
  return Boolean(group);
}

// Landmarks that are there.

/**
 * Drags a point of a line; between two points, a new one.
 * @type {(event: PointerEvent, cell: Cell, name: string | null) => void}
 */
function dragLine(event, cell, name) {
  /** @type {SVGElement | null} */
  const node = targetOf(event).closest('[data-node]');
  const wasChosen = name === null || match.chosen === name;
  const points = pointsOf(cell, name);
  if (!points) return;
  if (!node && !wasChosen) return choose(name);
  const index = node ? Number(node.dataset.node) : segmentAt(points, placeUnder(event, cell)) + 1;
  dragged(event, cell, name, (next) => [...points.slice(0, index), placeUnder(next, cell), ...points.slice(node ? index + 1 : index)]);
}

/** @type {(cell: Cell, name: string | null) => Place[] | undefined} */
function pointsOf(cell, name) {
  const landmark = store.scene.landmarks.find((other) => other.name === name);
  const { fresh } = match;
  const points = name !== null ? landmark && placesOf(landmark, cell.pose.name, cell.index)?.points
    : fresh?.path ? fresh.at[cell.pose.name] : undefined;
  return points?.map((p) => p.map((v) => rounded(v, 2)));
}

/**
 * The edge of a line that is nearest to a place.
 * @type {(points: Place[], at: Place) => number}
 */
function segmentAt(points, [x, y]) {
  let [best, where] = [Infinity, 0];
  for (let k = 0; k + 1 < points.length; k++) {
    const [[ax, ay], [bx, by]] = [points[k], points[k + 1]];
    const along = clamp(((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / ((bx - ax) ** 2 + (by - ay) ** 2 || 1), 0, 1);
    const far = Math.hypot(ax + along * (bx - ax) - x, ay + along * (by - ay) - y);
    if (far < best) [best, where] = [far, k];
  }
  return where;
}

/** @type {(cell: Cell, name: string | null, index: number) => void} */
function removeNode(cell, name, index) {
  const points = pointsOf(cell, name);
  if (!points || points.length < 3) return;
  const at = points.filter((_, k) => k !== index);
  if (name === null) {
    /** @type {FreshLine} */ (match.fresh).at[cell.pose.name] = at;
    emit('marks');
  } else {
    edit([{ op: 'move_landmark', landmark: name, at: { [cell.pose.name]: at } }], `change landmark '${name}'`);
  }
}

/**
 * Follows the pointer; `placed(event)` is what the landmark's place on this pose then is.
 * @type {(event: PointerEvent, cell: Cell, name: string | null, placed: (event: PointerEvent) => Place | Place[]) => void}
 */
function dragged(event, cell, name, placed) {
  const start = [event.clientX, event.clientY];
  const drag = name === null ? null : new Drag(`move landmark '${name}'`);
  const pose = cell.pose.name;
  let moved = false;
  if (name !== null) choose(name);
  cell.drawing.setPointerCapture(event.pointerId);
  follow({ currentTarget: cell.drawing, pointerId: event.pointerId }, (next, ended) => {
    moved ||= Math.hypot(next.clientX - start[0], next.clientY - start[1]) > TREMBLE;
    if (!moved) return;
    const at = placed(next);
    if (drag) {
      const ops = [{ op: 'move_landmark', landmark: name, at: { [pose]: at } }];
      match.held = { name, cell: cell.index, at };
      if (ended) {
        drag.end(ops).then(() => {
          match.held = null;
          emit('match-stale');
        });
      } else drag.to(ops);
    } else if (match.fresh) {
      /** @type {Record<string, Place | Place[]>} */ (match.fresh.at)[pose] = at;
    }
    emit('held');
  });
}

// New ones.

/**
 * A new line or point, as is chosen.
 * @type {(cell: Cell, at: Place) => void}
 */
function start(cell, at) {
  if (store.view.mark === 'line') begin(cell, at);
  else propose(cell, at);
}

/**
 * Where the present match has a place of a pose, on all drawn poses; without a match, the same place.
 * @type {(cell: Cell, at: Place) => Promise<Record<string, Place>>}
 */
async function carried(cell, at) {
  const drawn = drawnPoses();
  if (!(store.state.revisions.shape > 0)) return Object.fromEntries(drawn.map((name) => [name, at]));
  const answer = await postJson('carry', { layer: store.layer, pose: cell.pose.name, at });
  const all = answer.poses.map((name, k) => ({ name, place: answer.at[k] ?? [] }));
  const known = all.filter(({ name, place }) => drawn.includes(name) && place.length > 0);
  return Object.fromEntries(known.map(({ name, place }) => [name, place.map((v) => rounded(v, 2))]));
}

/**
 * A new point: where it would lie on all poses.
 * @type {(cell: Cell, at: Place) => Promise<void>}
 */
async function propose(cell, at) {
  match.chosen = null;
  try {
    match.fresh = { path: false, at: await carried(cell, at), open: null };
  } catch (error) {
    emit('refused', problemOf(error));
  }
  emit('marks');
}

/**
 * A new line begins on one drawing.
 * @type {(cell: Cell, at: Place) => void}
 */
function begin(cell, at) {
  match.chosen = null;
  match.fresh = { path: true, at: { [cell.pose.name]: [at, at] }, open: cell.pose.name, cell };
  /** @type {(event: PointerEvent) => void} */
  const trail = (event) => {
    if (trailTo(cell, placeUnder(event, cell))) emit('held');
    else cell.drawing.removeEventListener('pointermove', trail);
  };
  cell.drawing.addEventListener('pointermove', trail);
  emit('marks');
}

/**
 * The next point; the last one follows the pointer.
 * @type {(cell: Cell, at: Place) => void}
 */
function extend(cell, at) {
  const points = /** @type {FreshLine} */ (match.fresh).at[cell.pose.name];
  const before = points[points.length - 2];
  if (before[0] !== at[0] || before[1] !== at[1]) points.splice(points.length - 1, 1, at, at);
  emit('held');
}

/** The line is drawn: where it would lie on all poses. */
async function close() {
  const { open, cell, at } = /** @type {Required<FreshLine>} */ (match.fresh);
  if (open === null) return;
  // Without the point that follows the pointer.
  const points = at[open].slice(0, -1);
  if (points.length < 2) return;
  try {
    const all = await Promise.all(points.map((p) => carried(cell, p)));
    const poses = drawnPoses().filter((name) => all.every((places) => places[name]));
    const lines = poses.map((name) => [name, name === open ? points : all.map((places) => places[name])]);
    match.fresh = { path: true, at: Object.fromEntries(lines), open: null };
  } catch (error) {
    emit('refused', problemOf(error));
  }
  emit('marks');
}

export const tray = h('div', { class: 'floating hidden', role: 'group', 'aria-label': 'New landmark' });
const named = { type: 'text', placeholder: 'Name (optional)', 'aria-label': 'Name of the new landmark' };
const nameField = h('input', { ...named, onkeydown: (event) => {
  event.stopPropagation();
  if (event.key === 'Enter') addFresh();
  if (event.key === 'Escape') escapeMatches();
} });
const hint = h('span', { class: 'faint hint' });
const done = h('button', { type: 'button', class: 'main', id: 'end-line', onclick: () => close() }, 'End the line');
const add = h('button', { type: 'button', class: 'main', id: 'add-landmark', onclick: () => addFresh() });
tray.append(h('span', {}, icon('key')), hint, nameField,
  h('button', { type: 'button', onclick: () => escapeMatches() }, 'Cancel'), done, add);

export function drawTray() {
  const { fresh } = match;
  tray.classList.toggle('hidden', !fresh);
  if (!fresh) return;
  const open = Boolean(fresh.open);
  hint.textContent = open ? 'Click from point to point; click twice to end the line.'
    : fresh.path ? 'Drag points, or the line between them; click a point twice to take it out.'
      : 'Drag the markers to where they belong.';
  [nameField, add].forEach((element) => element.classList.toggle('hidden', open));
  done.classList.toggle('hidden', !open);
  done.disabled = Boolean(fresh.open) && fresh.at[fresh.open ?? ''].length < 3;
  add.textContent = fresh.path ? 'Add line' : 'Add landmark';
}

/** Adds the new landmark; a line that is still being drawn ends first. */
export async function addFresh() {
  const { fresh } = match;
  if (!fresh) return false;
  if (fresh.open) {
    close();
    return true;
  }
  const layered = store.scene.layers.length > 1 ? { layer: store.scene.layers[store.layer].name } : {};
  const name = nameField.value.trim();
  const known = new Set(store.scene.landmarks.map((landmark) => landmark.name));
  const op = { op: 'add_landmark', at: fresh.at, path: fresh.path, ...layered, ...(name ? { name } : {}) };
  const state = await edit([op], fresh.path ? 'add a line' : 'add a landmark');
  if (!state) return true;
  match.fresh = null;
  nameField.value = '';
  choose(store.scene.landmarks.find((landmark) => !known.has(landmark.name))?.name ?? null);
  emit('match-stale');
  return true;
}

export function escapeMatches() {
  if (!match.fresh && !match.chosen) return false;
  match.fresh = null;
  choose(null);
  return true;
}
