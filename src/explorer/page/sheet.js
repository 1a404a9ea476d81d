// @ts-check
// One sheet with what was taken for the figure on it: the body, loose parts, what was left out. A click on a part leaves it out or takes
// it back; a click on something else that is drawn asks for it.
import { getJson, problemOf } from './api.js';
import { s, set } from './dom.js';
import { layerOfSheets } from './figures.js';
import { crossingsAt, isInside } from './located.js';
import { edit, emit, rounded } from './state.js';

/** @import { Figure, Op, Piece, Place, Sheet } from './answers.js' */
/** @import { Properties } from './dom.js' */

/** @typedef {Figure & { sheet: Sheet }} ReadFigure Of a sheet that could be read. */
/** @typedef {'keep' | 'drop'} List */
/**
 * The sheet of a pose and what is drawn over it.
 * @typedef {{
 *   name: string, drawing: SVGSVGElement, layers: Record<'picture' | 'veil' | 'pieces' | 'places', SVGGElement>,
 *   taken: HTMLElement, warning: HTMLElement, element: HTMLElement,
 * }} Cell
 */

/** @type {Record<Piece['role'], [string, string]>} */
const SAID = {
  body: ['The body of the figure', 'leave it out'],
  part: ['A loose part', 'leave it out'],
  kept: ['A part that was asked for', 'forget it'],
  dropped: ['Left out', 'take it back'],
};

/** @type {(points: number[]) => string} */
const ring = (points) => `M${Array.from({ length: points.length / 2 }, (_, k) => `${points[2 * k]} ${points[2 * k + 1]}`).join('L')}Z`;
/** @type {(piece: Piece) => string} */
const rings = ({ outline, holes }) => [outline, ...holes].map(ring).join('');

/**
 * Draws a figure over its sheet; `px`: drawing units of a CSS pixel.
 * @type {(cell: Cell, figure: ReadFigure, px: number) => void}
 */
export function drawFigure(cell, figure, px) {
  const { origin: [x, y], scale, width, height } = figure.sheet;
  const [w, h] = [width / scale, height / scale];
  const shown = figure.pieces.filter(({ role }) => role !== 'dropped');
  const veil = s('path', { class: 'veil', d: `M${x} ${y}H${x + w}V${y + h}H${x}Z${shown.map(rings).join('')}`, 'fill-rule': 'evenodd' });
  cell.layers.veil.replaceChildren(veil);
  // The body first: what is small lies over it.
  cell.layers.pieces.replaceChildren(...figure.pieces.map((piece) => pieceMark(cell, figure, piece, px)));
  /** @type {(list: List) => SVGElement[]} */
  const marks = (list) => figure[list].map((at, index) => placeMark(cell, list, at, index, px));
  cell.layers.places.replaceChildren(...marks('keep'), ...marks('drop'));
}

/** @type {(cell: Cell, figure: Figure, piece: Piece, px: number) => SVGElement} */
function pieceMark(cell, figure, piece, px) {
  const [what, action] = SAID[piece.role];
  const isAlone = piece.role === 'body' && figure.pieces.filter(({ role }) => role !== 'dropped').length === 1;
  const can = !isAlone;
  const text = can ? `${what}: click to ${action}` : what;
  const dashes = piece.role === 'dropped' ? `${5 * px} ${4 * px}` : null;
  const looks = { d: rings(piece), 'stroke-width': 1.75 * px, 'stroke-dasharray': dashes, 'fill-rule': 'evenodd' };
  const halo = s('path', { ...looks, class: 'halo', 'stroke-width': 4 * px, 'stroke-dasharray': null });
  const path = [halo, s('path', looks, s('title', {}, text))];
  const toggle = () => change(cell, figure, piece);
  return can ? s('g', {
    class: `piece ${piece.role} choice`, tabindex: 0, role: 'button', 'aria-label': `${text.replace('click', 'press')} (${cell.name})`,
    onclick: toggle, onkeydown: pressed(toggle),
  }, path) : s('g', { class: `piece ${piece.role}` }, path);
}

/** @type {(action: () => void) => (event: KeyboardEvent) => void} */
const pressed = (action) => (event) => {
  if (event.key !== 'Enter' && event.key !== ' ') return;
  event.preventDefault();
  event.stopPropagation();
  action();
};

/**
 * A place that the scene names.
 * @type {(cell: Cell, list: List, at: Place, index: number, px: number) => SVGElement}
 */
function placeMark(cell, list, [x, y], index, px) {
  const label = `${list === 'keep' ? 'A part here is asked for' : 'A part here is left out'}: click to forget it`;
  /** @type {(event?: Event) => void} */
  const forget = (event) => {
    event?.stopPropagation();
    edit([{ op: 'unmark_part', pose: cell.name, list, index }], `forget a part of '${cell.name}'`);
  };
  const r = 4 * px;
  const plus = `M${x - r} ${y}H${x + r}M${x} ${y - r}V${y + r}`;
  const times = `M${x - r} ${y - r}L${x + r} ${y + r}M${x - r} ${y + r}L${x + r} ${y - r}`;
  return s('g', {
    class: `place ${list}`, tabindex: 0, role: 'button', 'aria-label': label.replace('click', 'press'),
    onclick: forget, onkeydown: pressed(forget),
  }, s('circle', { cx: x, cy: y, r: 7 * px }), s('path', { d: list === 'keep' ? plus : times, 'stroke-width': 1.75 * px }),
  s('title', {}, label));
}

/**
 * Takes a piece out of the figure, or back into it.
 * @type {(cell: Cell, figure: Figure, piece: Piece) => Promise<unknown>}
 */
function change(cell, figure, { role, outline, holes }) {
  /** @type {(list: List) => { at: Place, index: number }[]} */
  const within = (list) => figure[list].map((at, index) => ({ at, index })).filter(({ at }) => isInside([outline], at));
  /** @type {(list: List) => Op[]} */
  const forget = (list) => within(list).reverse().map(({ index }) => ({ op: 'unmark_part', pose: cell.name, list, index }));
  if (role === 'dropped') return edit(forget('drop'), `take back a part of '${cell.name}'`);
  if (role === 'kept') return edit(forget('keep'), `forget a part of '${cell.name}'`);
  const drop = { op: 'mark_part', pose: cell.name, list: 'drop', at: placeIn([outline, ...holes]) };
  return edit([...forget('keep'), drop], `leave out a part of '${cell.name}'`);
}

/** Rows that are tried, of the height of a ring. */
const ROWS = 16;

/**
 * A place well inside of rings: the middle of the longest run of some rows through them.
 * @type {(all: number[][]) => Place}
 */
export function placeIn(all) {
  const ys = all[0].filter((_, k) => k & 1);
  const [low, high] = [ys.reduce((a, b) => Math.min(a, b)), ys.reduce((a, b) => Math.max(a, b))];
  /** @type {{ length: number, at: Place } | null} */
  let best = null;
  for (let row = 1; row < ROWS; row++) {
    const y = low + ((high - low) * row) / ROWS;
    const crossings = crossingsAt(all, y).sort((a, b) => a - b);
    for (let k = 0; k + 1 < crossings.length; k += 2) {
      const length = crossings[k + 1] - crossings[k];
      if (!best || length > best.length) best = { length, at: [(crossings[k] + crossings[k + 1]) / 2, y] };
    }
  }
  return (best?.at ?? [all[0][0], all[0][1]]).map((value) => rounded(value, 2));
}

/**
 * Asks for what is drawn at a place, if there is something.
 * @type {(cell: Cell, pose: number, place: Place) => Promise<void>}
 */
export async function askFor(cell, pose, place) {
  const at = place.map((value) => rounded(value, 2));
  try {
    await getJson('figure', { layer: layerOfSheets(), pose, keep: at });
    await edit([{ op: 'mark_part', pose: cell.name, list: 'keep', at }], `ask for a part of '${cell.name}'`);
  } catch (error) {
    emit('refused', problemOf(error));
  }
}

/**
 * Puts a sheet's picture where it lies.
 * @type {(cell: Cell, figure: ReadFigure, pose: number) => void}
 */
export function drawSheet(cell, figure, pose) {
  const { origin, scale, width, height } = figure.sheet;
  const source = `api/sheet?layer=${layerOfSheets()}&pose=${pose}&max=1600&v=${figure.mark}`;
  const image = /** @type {Element | null} */ (cell.layers.picture.firstChild) ?? s('image', { preserveAspectRatio: 'none' });
  if (image.getAttribute('href') !== source) set(image, { href: source });
  set(image, { x: origin[0], y: origin[1], width: width / scale, height: height / scale });
  if (!image.parentNode) cell.layers.picture.append(image);
}
