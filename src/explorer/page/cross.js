// @ts-check
// The keyboard on the drawings of the matches: a cross that arrow keys move, and a landmark or a line where it is.
import { clamp, set } from './dom.js';
import { match } from './match.js';
import { put, trailTo } from './marking.js';
import { pointAway, sayPoint } from './pointed.js';
import { emit, rounded } from './state.js';

/** @import { Place } from './answers.js' */
/** @import { Cell } from './match.js' */

/** Pixels that an arrow key moves the cross, and with Shift. */
const STEP = 10;
const FINE_STEP = 1;

/** @type {Record<string, number[]>} */
const WAYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/**
 * Lets the keyboard into a cell; `unit(cell)`: drawing units of a pixel; `point(place)` is told where the cross is.
 * @type {(cell: Cell, unit: (cell: Cell) => number, point: (place: Place) => void) => void}
 */
export function attachCross(cell, unit, point) {
  const { drawing } = cell;
  set(drawing, { tabindex: 0, role: 'application', 'aria-roledescription': 'drawing' });
  drawing.addEventListener('focus', () => {
    // A pointer shows where it is by itself.
    if (cell.pose.drawn && drawing.matches(':focus-visible')) move(cell, startOf(cell), point);
  });
  drawing.addEventListener('blur', () => {
    if (cell.cross) pointAway();
    cell.cross = null;
    tell(cell);
    emit('held');
  });
  drawing.addEventListener('keydown', (event) => {
    if (!cell.cross || event.ctrlKey || event.metaKey || event.altKey) return;
    const way = WAYS[event.key];
    if (way) {
      const step = (event.shiftKey ? FINE_STEP : STEP) * unit(cell);
      move(cell, cell.cross.map((value, axis) => value + way[axis] * step), point);
    } else if (event.key === ' ') put(cell, cell.cross);
    else return;
    event.preventDefault();
    event.stopPropagation();
  });
}

/**
 * The new landmark, if there is one here, or the middle of the drawing.
 * @type {(cell: Cell) => Place}
 */
function startOf({ pose, box: [left, top, width, height] }) {
  const { fresh } = match;
  const own = fresh && !fresh.path ? fresh.at[pose.name] : null;
  return own ? own : [left + 0.5 * width, top + 0.5 * height];
}

/** @type {(cell: Cell, to: Place, point: (place: Place) => void) => void} */
function move(cell, [x, y], point) {
  const [left, top, width, height] = cell.view;
  cell.cross = [rounded(clamp(x, left, left + width), 2), rounded(clamp(y, top, top + height), 2)];
  trailTo(cell, cell.cross);
  tell(cell);
  point(cell.cross);
  sayPoint();
  emit('held');
}

/** @type {(cell: Cell) => void} */
function tell(cell) {
  cell.where.textContent = cell.cross ? cell.cross.map((value) => value.toFixed(1)).join(', ') : '';
}
