// @ts-check
// The pad: the pose space as a plane, poses as thumbnails in it, the probe that is dragged through.
import { Drag, choosePose, edit, look, moveTo, notYet, on, rounded, store } from './state.js';
import { byId, clamp, focused, follow, found, h, onceAFrame, s, set, short, targetOf, updateAll } from './dom.js';
import { numberField, segments, toggle } from './controls.js';
import { niceStep, PadView, shownPlane } from './plane.js';
import { paintMap, legend } from './maps.js';
import { copyThumbnail, drawThumbnail } from './thumbnail.js';
import { recordSample, recordStart, recordStop, recording } from './recorder.js';

/** @import { Op, Place, Pose, PseudoPose } from './answers.js' */

/** Pixels that a pointer may move before a press becomes a drag. */
const STILL = 4;
/** Pixels within which the probe snaps to a pose. */
const NEAR = 9;

const pad = byId('pad');
const canvas = h('canvas', { class: 'map', 'aria-hidden': 'true' });
const lines = s('svg', { class: 'lines', 'aria-hidden': 'true' });
/** The ends of pseudo-poses, over the poses: near one they would be under its thumbnail. */
const ends = s('svg', { class: 'lines', role: 'group', 'aria-label': 'Pseudo-poses' });
const poses = h('div', { class: 'poses' });
const probe = h('button', { type: 'button', class: 'probe', id: 'probe', 'aria-roledescription': 'two-dimensional slider' });
const caption = legend();
/** @type {PadView} */
let view = notYet();
let frozen = false;
/** @type {Place[]} */
let pathPlaces = [];

function measure() {
  if (!store.scene) return;
  const side = pad.clientWidth;
  if (!frozen || !view) view = new PadView(shownPlane(), side);
  view.side = side;
}

/** The grid that places snap to. */
const step = () => niceStep(view.plane.diagonal / 40);

/** @type {(place: Place, free?: boolean) => Place} */
function snapped(place, free = false) {
  if (!store.view.snap || free) return place.map((value) => rounded(value));
  const here = view.pixel(place);
  for (const pose of store.scene.poses) {
    const there = view.pixel(pose.at);
    if (Math.hypot(here[0] - there[0], here[1] - there[1]) < NEAR) return pose.at.slice(0, 2);
  }
  return place.map((value) => rounded(Math.round(value / step()) * step(), 6));
}

/**
 * The place under the pointer, in all dimensions; those that the pad does not show stay.
 * @type {(event: PointerEvent, base: Place, offset?: Place) => Place}
 */
function placeUnder(event, base, offset = [0, 0]) {
  const box = pad.getBoundingClientRect();
  const pixel = [event.clientX - box.left - offset[0], event.clientY - box.top - offset[1]].map((v) => clamp(v, 0, box.width));
  const place = snapped(view.place(pixel), event.altKey);
  return base.map((value, d) => (d < 2 ? place[d] : value));
}

// The probe.

/** @type {(event: PointerEvent) => void} */
function dragProbe(event) {
  if (event.button !== 0 || !store.scene?.poses.length) return;
  event.preventDefault();
  probe.focus({ preventScroll: true });
  const here = view.pixel(store.place);
  const box = pad.getBoundingClientRect();
  const grabbed = targetOf(event).closest('.probe') ? [event.clientX - box.left - here[0], event.clientY - box.top - here[1]] : [0, 0];
  /** @type {(next: PointerEvent, ended: boolean) => void} */
  const to = (next, ended) => {
    // What the browser has put together into one event is drawn as one frame, but recorded as it was.
    const all = recording() && next.getCoalescedEvents ? next.getCoalescedEvents() : [next];
    for (const one of all.length ? all : [next]) if (recording()) recordSample(one.timeStamp, placeUnder(one, store.place, grabbed));
    moveTo(placeUnder(next, store.place, grabbed));
    if (ended) {
      pad.classList.remove('dragging');
      if (recording()) recordStop();
    }
  };
  pad.classList.add('dragging');
  recordStart(event.timeStamp, placeUnder(event, store.place, grabbed));
  moveTo(placeUnder(event, store.place, grabbed));
  follow(event, to);
}
pad.addEventListener('pointerdown', dragProbe);

/**
 * Moves the probe by steps of the keys.
 * @type {(way: number[], fine: boolean) => void}
 */
export function nudge([dx, dy], fine) {
  const by = fine ? step() / 5 : step();
  const [low, size] = [view.plane.low, view.plane.size];
  moveTo(store.place.map((value, d) => (d > 1 ? value : clamp(rounded(value + [dx, dy][d] * by, 6), low[d], low[d] + size))));
}

function drawProbe() {
  if (!view) return;
  const [x, y] = view.pixel(store.place);
  probe.style.transform = `translate(${x}px, ${y}px)`;
  probe.setAttribute('aria-label', `Probe at ${store.place.map((v) => short(v)).join(', ')}. Arrow keys move it.`);
}

// The poses.

/** @type {Map<string, HTMLButtonElement>} */
const thumbnails = new Map();

/**
 * What a pose is drawn on.
 * @type {(element: HTMLElement) => HTMLCanvasElement}
 */
const pictureIn = (element) => /** @type {HTMLCanvasElement} */ (element.firstChild);

/** @type {(pose: Pose, index: number) => HTMLButtonElement} */
function thumbnail(pose, index) {
  const picture = h('canvas', { 'aria-hidden': 'true' });
  const button = h('button', { type: 'button', class: 'pose', 'data-pose': pose.name }, picture, h('span', { class: 'name' }));
  button.addEventListener('pointerdown', (event) => dragPose(event, button));
  button.addEventListener('dblclick', () => moveTo(store.scene.poses[index].at.slice()));
  button.addEventListener('keydown', (event) => {
    const own = store.scene.poses[indexOf(button)];
    const at = own && stepped(event, own.at);
    if (at) {
      edit([{ op: 'move_pose', pose: own.name, at }], `move pose '${own.name}'`, `arrow ${own.name}`);
    } else if (event.key === 'Enter' || event.key === ' ') {
      event.preventDefault();
      goTo(own);
    }
  });
  return button;
}

/**
 * Where an arrow key takes a place of the plane; undefined for other keys.
 * @type {(event: KeyboardEvent, at: Place) => Place | undefined}
 */
function stepped(event, at) {
  const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
  if (!way) return undefined;
  event.preventDefault();
  event.stopPropagation();
  const by = event.shiftKey ? step() / 5 : step();
  return at.map((v, d) => (d < 2 ? rounded(v + way[d] * by, 6) : v));
}

/** @type {(button: HTMLElement) => number} */
const indexOf = (button) => store.scene.poses.findIndex((pose) => pose.name === button.dataset.pose);

/** @type {(pose: Pose) => void} */
function goTo(pose) {
  choosePose(store.scene.poses.indexOf(pose));
  moveTo(pose.at.slice());
}

/** @type {(event: PointerEvent, button: HTMLElement) => void} */
function dragPose(event, button) {
  if (event.button !== 0 || recording()) return;
  event.preventDefault();
  event.stopPropagation();
  button.focus({ preventScroll: true });
  const pose = store.scene.poses[indexOf(button)];
  const start = [event.clientX, event.clientY];
  const here = view.pixel(pose.at);
  const box = pad.getBoundingClientRect();
  const grabbed = [event.clientX - box.left - here[0], event.clientY - box.top - here[1]];
  const drag = new Drag(`move pose '${pose.name}'`);
  let moved = false;
  /** @type {(Op & { at: Place }) | null} */
  let op = null;
  let stopped = false;
  /** @type {(key: KeyboardEvent) => void} */
  const stop = (key) => {
    if (key.key !== 'Escape' || !moved) return;
    stopped = true;
    drag.cancel();
  };
  window.addEventListener('keydown', stop);
  follow(event, (next, ended) => {
    if (!stopped && (moved || Math.hypot(next.clientX - start[0], next.clientY - start[1]) >= STILL)) {
      moved = true;
      frozen = true;
      op = { op: 'move_pose', pose: pose.name, at: placeUnder(next, pose.at, grabbed) };
      place(button, op.at);
      button.classList.add('held');
      if (!ended) drag.to([op]);
    }
    if (!ended) return;
    window.removeEventListener('keydown', stop);
    button.classList.remove('held');
    frozen = false;
    if (stopped) return;
    if (op) drag.end([op]).then(drawAll);
    else goTo(store.scene.poses[indexOf(button)] ?? pose);
  });
}

/** @type {(element: HTMLElement, at: Place) => void} */
function place(element, at) {
  const [x, y] = view.pixel(at);
  element.style.transform = `translate(${x}px, ${y}px)`;
}

function drawPoses() {
  const names = new Set(store.scene.poses.map((pose) => pose.name));
  for (const [name, element] of thumbnails) {
    if (!names.has(name)) {
      element.remove();
      thumbnails.delete(name);
    }
  }
  const version = store.state?.revisions.pictures ?? 0;
  store.scene.poses.forEach((pose, index) => {
    const element = thumbnails.get(pose.name) ?? thumbnail(pose, index);
    if (!thumbnails.has(pose.name)) {
      thumbnails.set(pose.name, element);
      poses.append(element);
    }
    // Until there is a mesh, the drawing itself; then the pose as it is drawn (`thumbnail` events).
    const source = `api/drawing?layer=${pose.layers[0] ?? 0}&pose=${index}&max=256&v=${version}`;
    const picture = pictureIn(element);
    if (picture.dataset.source !== source) {
      picture.dataset.source = source;
      if (!(store.state.revisions.shape > 0)) drawThumbnail(picture, source);
    }
    if (element.lastChild) element.lastChild.textContent = pose.name;
    element.classList.toggle('chosen', store.pose === index);
    element.classList.toggle('copy', pose.kind === 'deformed');
    element.classList.toggle('wrong', (store.state?.problems ?? []).some((problem) => problem.pose === pose.name));
    const where = pose.at.map((v) => short(v)).join(', ');
    element.setAttribute('aria-label', `Pose ${pose.name} at ${where}. Enter goes there, arrow keys move it.`);
    if (!element.classList.contains('held')) place(element, pose.at);
  });
}

// Lines: axes, walls, the path, pseudo-poses.

function drawLines() {
  const side = view.side;
  [lines, ends].forEach((svg) => set(svg, { viewBox: `0 0 ${side} ${side}` }));
  /** @type {(places: Place[], name: string) => SVGElement} */
  const polyline = (places, name) => s('polyline', { class: name, points: places.map((p) => view.pixel(p).join(',')).join(' ') });
  const made = [];
  const { low, size } = view.plane;
  const unit = niceStep(size / 6);
  const [[left, bottom], [right, top]] = [low, low.map((value) => value + size)];
  for (let k = Math.ceil(left / unit); k * unit <= right; k++) {
    made.push(polyline([[k * unit, bottom], [k * unit, top]], k === 0 ? 'axis' : 'grid'));
  }
  for (let k = Math.ceil(bottom / unit); k * unit <= top; k++) {
    made.push(polyline([[left, k * unit], [right, k * unit]], k === 0 ? 'axis' : 'grid'));
  }
  for (const wall of store.scene.pose_space?.walls ?? []) made.push(polyline(wall, 'wall'));
  if (pathPlaces.length > 1) made.push(polyline(pathPlaces, 'path'));
  const keys = store.gesture?.keys ?? store.scene.animation?.keys ?? [];
  for (const key of keys) {
    const [x, y] = view.pixel(key.at);
    made.push(s('circle', { class: store.gesture ? 'key fresh' : 'key', cx: x, cy: y, r: 2.5 }));
  }
  if (store.gesture) {
    made.push(polyline(store.gesture.samples.map(([, ...at]) => at), 'samples'));
    if (store.gesture.path) made.push(polyline(store.gesture.path.map(([, ...at]) => at), 'path fresh'));
  }
  for (const { from, at } of store.scene.pseudo_poses) made.push(polyline([from, at], 'pseudo'));
  lines.replaceChildren(...made);
  const held = focused()?.dataset?.pseudo;
  ends.replaceChildren(...store.scene.pseudo_poses.flatMap(pseudoPose));
  if (held) found(ends, `[data-pseudo="${held}"]`)?.focus({ preventScroll: true });
}

/** @type {(pseudo: PseudoPose, index: number) => SVGElement[]} */
function pseudoPose(pseudo, index) {
  return /** @type {const} */ (['from', 'at']).map((name) => {
    const [x, y] = view.pixel(pseudo[name]);
    const what = name === 'at' ? `Pseudo-pose ${index + 1}: here` : `Pseudo-pose ${index + 1}: shows what was here`;
    const dot = s('circle', {
      class: `pseudo ${name}`, cx: x, cy: y, r: name === 'at' ? 5 : 3.5, tabindex: '0', role: 'button',
      'aria-label': `${what}. Arrow keys move it.`, 'data-pseudo': `${index} ${name}`,
    });
    dot.append(s('title', {}, what));
    dot.addEventListener('pointerdown', (event) => dragPseudo(event, pseudo, index, name));
    dot.addEventListener('keydown', (event) => {
      const to = stepped(event, pseudo[name]);
      if (to) edit([{ op: 'move_pseudo_pose', index, [name]: to }], 'move a pseudo-pose', `arrow ${what}`);
    });
    return dot;
  });
}

/** @type {(event: PointerEvent, pseudo: PseudoPose, index: number, name: 'from' | 'at') => void} */
function dragPseudo(event, pseudo, index, name) {
  event.preventDefault();
  event.stopPropagation();
  const drag = new Drag('move a pseudo-pose');
  let op = null;
  const box = pad.getBoundingClientRect();
  const here = view.pixel(pseudo[name]);
  const grabbed = [event.clientX - box.left - here[0], event.clientY - box.top - here[1]];
  // The dot is drawn anew while it is dragged; the pad stays.
  pad.setPointerCapture(event.pointerId);
  frozen = true;
  follow({ currentTarget: pad, pointerId: event.pointerId }, (next, ended) => {
    op = { op: 'move_pseudo_pose', index, [name]: placeUnder(next, pseudo[name], grabbed) };
    if (!ended) return drag.to([op]);
    frozen = false;
    drag.end([op]).then(drawAll);
  });
}

// Everything.

const drawMap = onceAFrame(() => view && paintMap(canvas, view, caption));

function drawAll() {
  if (!store.scene) return;
  measure();
  drawLines();
  drawPoses();
  drawProbe();
  drawMap();
}

/**
 * The path that is played, shown in the plane.
 * @type {(places: Place[]) => void}
 */
export function showPath(places) {
  pathPlaces = places;
  if (view) drawLines();
}

// What stands above and below.

const map = segments('What the plane shows', [['plain', 'Plain'], ['weight', 'Weight'], ['validity', 'Validity']],
  () => store.view.map, (value) => look({ map: value }));
const snap = toggle('snap', 'Snap to the grid and to poses (hold Alt for none)', () => store.view.snap, (value) => look({ snap: value }));
byId('pad-tools').append(h('h2', {}, 'Plane'), h('span', { class: 'grow' }), map, snap);
pad.append(canvas, lines, poses, ends, probe, caption.element);

const fields = byId('place');
let fieldsFor = -1;
function drawFields() {
  const dimension = store.scene.dimension;
  if (fieldsFor !== dimension) {
    fieldsFor = dimension;
    const names = dimension <= 3 ? ['x', 'y', 'z'] : Array.from({ length: dimension }, (_, d) => `p${d + 1}`);
    /** @type {(d: number) => HTMLElement} */
    const field = (d) => {
      const input = numberField(names[d], () => store.place[d] ?? 0,
        (value) => moveTo(store.place.map((v, k) => (k === d ? value : v))), { step: 0.01 });
      return h('label', { class: 'field' }, h('span', {}, names[d]), input);
    };
    const home = h('button', {
      type: 'button', class: 'bordered', title: 'Go to the first pose (Home)', onclick: () => goTo(store.scene.poses[0]),
    }, 'Home');
    fields.replaceChildren(...Array.from({ length: dimension }, (_, d) => field(d)), h('span', { class: 'grow' }), home);
  }
  updateAll(fields, 'input');
}

on('scene gesture pose', () => {
  drawAll();
  drawFields();
});
on('place', () => {
  drawProbe();
  drawFields();
});
on('thumbnail', ({ pose, canvas: from, box }) => {
  const element = thumbnails.get(store.scene.poses[pose]?.name);
  if (element) copyThumbnail(pictureIn(element), from, box);
});
on('weights', drawMap);
on('view', () => {
  map.update();
  snap.update();
  drawMap();
  pad.dataset.map = store.view.map;
});
on('theme', drawAll);
new ResizeObserver(drawAll).observe(pad);
export { goTo };
