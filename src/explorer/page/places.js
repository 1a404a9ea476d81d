// @ts-check
// A strip of all poses below the picture, with the point under the pointer marked on each: `pointed.js` says where that is.
import { brushOf, byId, clamp, h, s, set } from './dom.js';
import { attachPointer, pointAway, pointIn, pointInFrame, sayPoint } from './pointed.js';
import { on, store } from './state.js';
import { drawingView, toDrawing } from './view.js';

/** @import { Frame, Place } from './answers.js' */
/** @import { Thumbnail } from './state.js' */

/**
 * A pose on the strip; without a frame until it was drawn.
 * @typedef {{
 *   canvas: HTMLCanvasElement, mark: HTMLElement, sheet: HTMLElement, element: HTMLElement, frame?: Frame, place?: (at: Place) => Place,
 * }} Card
 */

/** CSS pixels of a card's drawing at most. */
const [WIDTH, HEIGHT] = [132, 84];
/** CSS pixels that an arrow key moves the cross, and with Shift. */
const STEP = 10;
const FINE_STEP = 1;
/** @type {Record<string, number[]>} */
const WAYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

const stage = byId('stage');
const picture = byId('picture');
const strip = h('section', { class: 'strip hidden', id: 'places', 'aria-label': 'The place under the pointer in all drawings' });
stage.after(strip);
const cross = s('path');
stage.append(s('svg', { class: 'overlay cross', 'aria-hidden': 'true' }, cross));

/**
 * A pose's name -> its card.
 * @type {Map<string, Card>}
 */
const cards = new Map();

/** @type {(name: string) => Card} */
function card(name) {
  const canvas = h('canvas', { 'aria-hidden': 'true' });
  const mark = h('span', { class: 'spot hidden', 'aria-hidden': 'true' });
  const sheet = h('div', { class: 'sheet' }, canvas, mark);
  return { canvas, mark, sheet, element: h('figure', { 'data-pose': name }, sheet, h('figcaption', { class: 'clip', title: name }, name)) };
}

function build() {
  const names = store.scene.poses.map((pose) => pose.name);
  for (const name of cards.keys()) if (!names.includes(name)) cards.delete(name);
  for (const name of names) if (!cards.has(name)) cards.set(name, card(name));
  const elements = names.map((name) => cards.get(name)?.element ?? null).filter((element) => element !== null);
  const stays = strip.children.length === elements.length && elements.every((element, k) => strip.children[k] === element);
  if (!stays) strip.replaceChildren(...elements);
}

/**
 * Takes a pose as the painter has drawn it: `view` takes its frame to pixels of `box`.
 * @type {(drawn: Thumbnail) => void}
 */
function takeThumbnail({ pose, canvas, box: [left, top, width, height], view, frame }) {
  const own = cards.get(store.scene.poses[pose]?.name);
  if (!own) return;
  const scale = Math.min(WIDTH / width, HEIGHT / height);
  Object.assign(own.canvas, { width, height });
  Object.assign(own.sheet.style, { width: `${width * scale}px`, height: `${height * scale}px` });
  brushOf(own.canvas).drawImage(canvas, left, top, width, height, 0, 0, width, height);
  own.frame = frame;
  own.place = ([x, y]) => [(x * view.scale + view.x - left) * scale, (y * view.scale + view.y - top) * scale];
}

function mark() {
  if (!isShown()) return;
  store.scene.poses.forEach(({ name }, pose) => {
    const own = cards.get(name);
    /** @type {Place | null} */
    const at = own?.frame && own.frame.shape === store.puppet?.shape ? pointIn(pose, own.frame) : null;
    own?.mark.classList.toggle('hidden', !at);
    if (!at || !own?.place) return;
    const [x, y] = own.place(at);
    own.mark.style.transform = `translate(${x}px, ${y}px)`;
  });
}

const isShown = () => store.view.places && store.view.main === 'picture' && store.state?.revisions.shape > 0;
const isFree = () => store.view.tool !== 'bend';

attachPointer(picture, (event) => {
  if (!isFree()) return;
  const box = stage.getBoundingClientRect();
  pointInFrame(toDrawing([event.clientX - box.left, event.clientY - box.top]));
});

// The same by keys: a cross on the picture.

/**
 * Where the cross is, in CSS pixels of the stage.
 * @type {Place | null}
 */
let at = null;

/** @type {(to: Place | null) => void} */
function move(to) {
  at = to?.map((value, axis) => clamp(value, 0, [stage.clientWidth, stage.clientHeight][axis])) ?? null;
  const [x, y] = at ?? [];
  /** @type {(way: number[], far: number) => string} */
  const end = ([dx, dy], far) => `${x + far * dx} ${y + far * dy}`;
  set(cross, { d: at ? Object.values(WAYS).map((way) => `M${end(way, 3)}L${end(way, 16)}`).join('') : '' });
  if (at) pointInFrame(toDrawing(at));
  else pointAway();
  sayPoint();
}

/** The middle of the foremost layer: something is drawn near it as a rule. */
function startOf() {
  const view = drawingView();
  const rings = store.frame?.layers[store.frame.order[store.frame.order.length - 1]]?.rings[0] ?? [];
  const middle = [0, 1].map((d) => rings.reduce((sum, value, k) => ((k & 1) === d ? sum + value : sum), 0) / Math.max(rings.length / 2, 1));
  return [middle[0] * view.scale + view.x, middle[1] * view.scale + view.y];
}

set(picture, { tabindex: 0 });
picture.addEventListener('focus', () => picture.matches(':focus-visible') && store.frame && isFree() && move(startOf()));
picture.addEventListener('blur', () => at && move(null));
picture.addEventListener('keydown', (event) => {
  const way = WAYS[event.key];
  if (!at || !way || event.ctrlKey || event.metaKey || event.altKey) return;
  const step = event.shiftKey ? FINE_STEP : STEP;
  move(at.map((value, axis) => value + way[axis] * step));
  event.preventDefault();
  event.stopPropagation();
});

on('thumbnail', takeThumbnail);
on('scene', build);
on('pointed', mark);
on('view state', () => strip.classList.toggle('hidden', !isShown()));
