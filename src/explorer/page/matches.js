// @ts-check
// Correspondences: the outlines of all poses side by side, what matches what, and the landmarks that say so.
import { getJson, problemOf } from './api.js';
import { attachCross } from './cross.js';
import { byId, clamp, h, onceAFrame, placeInSvg, s, set, targetOf } from './dom.js';
import { icon } from './icons.js';
import { drawTray, press, pressTwice, tray } from './marking.js';
import { drawCell } from './marks.js';
import { match, takeMatch } from './match.js';
import { Newest } from './newest.js';
import { attachPointer, pointOnPose } from './pointed.js';
import { emit, on, store } from './state.js';
import { tile } from './tiling.js';

/** @import { MatchPose, Place } from './answers.js' */
/** @import { Cell } from './match.js' */

const root = h('div', { class: 'matches hidden', id: 'matches' });
byId('stage').append(root);

/** @type {Cell[]} */
let cells = [];

const reads = new Newest();
/** The reads whose answers are not here yet. */
let reading = 0;
async function read() {
  if (!store.scene?.poses.length) return;
  const mine = reads.begin();
  reading++;
  try {
    const layer = store.layer;
    const before = match.data;
    const answer = await getJson('correspondences', { layer, samples: 0, known: before?.poses.map((pose) => pose.mark) });
    if (layer !== store.layer || !reads.is(mine)) return;
    takeMatch(answer, before);
  } catch (error) {
    emit('refused', problemOf(error));
    draw();
    return;
  } finally {
    reading--;
  }
  build();
  draw();
  emit('match');
}

// The cells, one a pose.

let built = '';
function build() {
  const poses = match.data.poses.map((pose) => [pose.name, pose.drawn, pose.picture]);
  const key = JSON.stringify([store.layer, poses, store.state.revisions.pictures]);
  if (built === key) return;
  built = key;
  cells = match.data.poses.map((pose, index) => {
    const box = bounds(pose);
    const drawing = s('svg', {
      class: 'drawing', 'aria-label': `Drawing of ${pose.name}: arrow keys move a cross, Space puts a landmark there`,
      preserveAspectRatio: 'xMidYMid meet',
    });
    const names = ['picture', 'mesh', 'outline', 'links', 'marks', 'spot', 'cross'];
    const layers = /** @type {Cell['layers']} */ (Object.fromEntries(names.map((name) => [name, s('g', { class: name })])));
    drawing.append(...Object.values(layers));
    const warning = h('span', { class: 'warning' });
    const where = h('span', { class: 'faint small', role: 'status' });
    const caption = h('figcaption', {}, h('b', {}, pose.name),
      index === match.data.reference ? h('span', { class: 'faint small' }, 'reference') : null,
      pose.drawn ? null : h('span', { class: 'faint small' }, 'copy'), where, h('span', { class: 'grow' }), warning);
    const element = h('figure', { class: `cell${pose.drawn ? '' : ' copy'}` }, caption, drawing);
    /** @type {Cell} */
    const cell = { pose, index, box, view: box, drawing, layers, warning, where, element, cross: null };
    // A copy has no drawing of its own: what it would show is bent otherwise.
    if (pose.picture && pose.drawn) {
      const { origin, scale, width, height } = pose.picture;
      const source = `api/drawing?layer=${store.layer}&pose=${pose.pose}&max=640&v=${store.state.revisions.pictures}`;
      const lies = { x: origin[0], y: origin[1], width: width / scale, height: height / scale };
      layers.picture.append(s('image', { href: source, ...lies, preserveAspectRatio: 'none' }));
    }
    set(drawing, { viewBox: box.join(' ') });
    attachCross(cell, unit, (place) => pointFrom(cell, place));
    attachPointer(drawing, (event) => pointFrom(cell, placeUnder(event, cell)));
    drawing.addEventListener('wheel', (event) => zoomCell(event, cell), { passive: false });
    drawing.addEventListener('dblclick', (event) => pressTwice(event, cell) || showBox(cell, cell.box));
    drawing.addEventListener('pointerdown', (event) => press(event, cell));
    return cell;
  });
  root.replaceChildren(...cells.map((cell) => cell.element), tray);
  arrange();
}

/** @type {(pose: MatchPose) => number[]} */
function bounds(pose) {
  const points = pose.outline ?? [];
  if (points.length === 0 && pose.picture) {
    const { origin, scale, width, height } = pose.picture;
    return [origin[0], origin[1], width / scale, height / scale];
  }
  const x = points.filter((_, k) => k % 2 === 0);
  const y = points.filter((_, k) => k % 2 === 1);
  const [left, top, right, bottom] = [Math.min(...x), Math.min(...y), Math.max(...x), Math.max(...y)];
  const room = 0.07 * Math.max(right - left, bottom - top);
  return points.length ? [left - room, top - room, right - left + 2 * room, bottom - top + 2 * room] : [0, 0, 100, 100];
}

/** @type {(cell: Cell, view: number[]) => void} */
function showBox(cell, view) {
  cell.view = view;
  set(cell.drawing, { viewBox: view.join(' ') });
  draw();
}

/**
 * The place of a drawing under the pointer.
 * @type {(event: MouseEvent, cell: Cell) => Place}
 */
function placeUnder(event, cell) {
  const { x, y } = placeInSvg(cell.drawing, event);
  return [x, y];
}

/**
 * Points at a place of a drawing, on all drawings; on the mesh of the match that is shown.
 * @type {(cell: Cell, place: Place) => void}
 */
function pointFrom(cell, place) {
  if (match.data.shape !== store.puppet?.shape) return;
  const pose = match.data.poses[cell.index];
  if (pose.outline) pointOnPose(store.layer, cell.index, [pose.outline, ...pose.holes], place);
}

/**
 * Around the pointer, never farther than the whole drawing.
 * @type {(event: WheelEvent, cell: Cell) => void}
 */
function zoomCell(event, cell) {
  event.preventDefault();
  const [px, py] = placeUnder(event, cell);
  const [left, top, w, h_] = cell.view;
  const factor = clamp(Math.exp(event.deltaY * 0.0016), (0.04 * cell.box[2]) / w, cell.box[2] / w);
  const x = clamp(px - (px - left) * factor, cell.box[0], cell.box[0] + cell.box[2] - w * factor);
  const y = clamp(py - (py - top) * factor, cell.box[1], cell.box[1] + cell.box[3] - h_ * factor);
  showBox(cell, [x, y, w * factor, h_ * factor]);
}

function arrange() {
  if (cells.length === 0) return;
  tile(root, cells.map(({ box }) => box[2] / box[3]));
  cells.forEach((cell) => (cell.size = null));
  draw();
}

/**
 * Drawing units of one CSS pixel in a cell.
 * @type {(cell: Cell) => number}
 */
const unit = (cell) => {
  const [, , w, h_] = cell.view;
  // Asking the browser makes it lay the page out.
  cell.size ??= [Math.max(cell.drawing.clientWidth, 1), Math.max(cell.drawing.clientHeight, 1)];
  return Math.max(w / cell.size[0], h_ / cell.size[1]);
};

const draw = onceAFrame(() => {
  const { data } = match;
  if (!data || store.view.main !== 'matches') return;
  for (const cell of cells) {
    cell.pose = data.poses[cell.index];
    drawCell(cell, unit(cell));
    cell.warning.replaceChildren(...(cell.pose.looks_mirrored ? [icon('warn'), 'looks mirrored'] : []));
  }
  drawTray();
  emit('matched', data.shape);
});

/**
 * The link or landmark under the pointer is shown on all drawings.
 * @type {(target: Element | null) => void}
 */
function point(target) {
  const link = target?.closest?.('[data-link]')?.getAttribute('data-link');
  const mark = target?.closest?.('[data-landmark]')?.getAttribute('data-landmark');
  const now = link !== null && link !== undefined ? Number(link) : mark ?? null;
  if (now === match.pointed) return;
  match.pointed = now;
  draw();
}
root.addEventListener('pointerover', (event) => event.buttons === 0 && point(match.fresh?.open ? null : targetOf(event)));
root.addEventListener('pointerleave', () => point(null));

on('view', (changes) => {
  root.classList.toggle('hidden', store.view.main !== 'matches');
  if ('main' in changes && store.view.main === 'matches') {
    arrange();
    read();
  } else draw();
});
/** Whether the answer for the shape that is on its way has been asked for. */
let isAhead = false;
on('changing', ({ meshes }) => {
  isAhead = meshes && store.view.main === 'matches';
  if (isAhead) read();
});
on('shape', () => isAhead || read());
on('match-stale layer', read);
on('scene', () => match.data || read());
// What is about to be drawn with the answer is not drawn before it.
on('scene state', () => reading > 0 || draw());
on('marks held pointed', draw);
new ResizeObserver(arrange).observe(root);
