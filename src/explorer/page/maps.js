// @ts-check
// What can be seen below the poses in the plane: one pose's weight everywhere, or where the drawing breaks.
import { getWords } from './api.js';
import { store } from './state.js';
import { brushOf, brushOff, h, s, set } from './dom.js';
import { Newest } from './newest.js';

/** @import { Words } from './api.js' */
/** @import { PadView } from './plane.js' */
/** @import { View } from './state.js' */

/** @typedef {{ element: HTMLElement, show: (kind: View['map']) => void }} Legend */
/** @typedef {{ key: string, kind: 'weight' | 'validity', words: Words, cells: number }} Known */

const WEIGHT_CELLS = 72;
const VALIDITY_CELLS = 28;
/** Stretches that count as none and as bad. */
const EASY = 1.25;
const HARD = 4;

const requests = new Newest();
/** @type {Known | null} */
let known = null;

/**
 * Paints the map that is chosen. While one is asked for, the last one stays.
 * @type {(canvas: HTMLCanvasElement, view: PadView, caption: Legend) => Promise<void>}
 */
export async function paintMap(canvas, view, caption) {
  const kind = store.scene.dimension === 2 ? store.view.map : 'plain';
  caption.show(kind);
  if (kind === 'plain') {
    known = null;
    brushOf(canvas).clearRect(0, 0, canvas.width, canvas.height);
    return;
  }
  const pixels = Math.round(view.side * devicePixelRatio);
  if (canvas.width !== pixels) canvas.width = canvas.height = pixels;
  const { low, size } = view.plane;
  const box = [low[0], low[1], low[0] + size, low[1] + size];
  const key = JSON.stringify([kind, box, store.state.revisions.weights, store.state.revisions.shape, store.view.compare]);
  if (known?.key !== key) {
    const mine = requests.begin();
    const cells = kind === 'weight' ? WEIGHT_CELLS : VALIDITY_CELLS;
    try {
      const provider = store.view.compare?.provider;
      const words = await getWords(kind === 'weight' ? 'grid' : 'validity', { box, columns: cells, rows: cells, provider });
      if (!requests.is(mine)) return;
      known = { key, kind, words, cells };
    } catch {
      if (known?.kind !== kind) return;
    }
  }
  if (known.kind === 'weight') paintWeights(canvas, known);
  else paintValidity(canvas, known);
}

/** @type {(name: string) => number[]} */
const colour = (name) => {
  const text = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  return [1, 3, 5].map((k) => parseInt(text.slice(k, k + 2), 16));
};

/** @type {(canvas: HTMLCanvasElement, known: Known) => void} */
function paintWeights(canvas, { words, cells }) {
  words.next = 2;
  const poses = words.u32();
  const values = words.f32s(cells * cells * poses);
  const pose = Math.min(store.pose ?? 0, poses - 1);
  /** @type {(i: number, j: number) => number} */
  const at = (i, j) => values[(j * cells + i) * poses + pose];
  const [accent, warn, wrong] = [colour('--accent'), colour('--warn'), colour('--wrong')];
  const image = new ImageData(cells, cells);
  for (let j = 0; j < cells; j++) {
    for (let i = 0; i < cells; i++) {
      const weight = at(i, j);
      const [rgb, amount] = weight < 0 ? [warn, Math.min(-weight * 1.1, 0.5)]
        : weight > 1 ? [wrong, Math.min(0.35 + (weight - 1), 0.7)] : [accent, weight * 0.62];
      image.data.set([...rgb, 255 * amount], 4 * ((cells - 1 - j) * cells + i));
    }
  }
  smooth(canvas, image);
  const context = brushOf(canvas);
  /** @type {(colour: number[], alpha: number) => string} */
  const rgb = (c, alpha) => `rgb(${c.join(' ')} / ${alpha})`;
  context.lineWidth = devicePixelRatio;
  context.setLineDash([]);
  for (const level of [0.25, 0.5, 0.75]) contour(context, canvas.width, cells, at, level, rgb(accent, 0.5));
  context.lineWidth = 1.6 * devicePixelRatio;
  contour(context, canvas.width, cells, at, -1e-4, rgb(warn, 0.95));
  contour(context, canvas.width, cells, at, 1 + 1e-4, rgb(wrong, 0.95));
}

/** @type {(canvas: HTMLCanvasElement, image: ImageData) => void} */
function smooth(canvas, image) {
  const small = new OffscreenCanvas(image.width, image.height);
  brushOff(small).putImageData(image, 0, 0);
  const context = brushOf(canvas);
  context.clearRect(0, 0, canvas.width, canvas.height);
  context.imageSmoothingQuality = 'high';
  context.drawImage(small, 0, 0, canvas.width, canvas.height);
}

/**
 * Where a grid of values at cell centres crosses a level: one line a cell, by linear interpolation along its sides.
 * @type {(
 *   context: CanvasRenderingContext2D, pixels: number, cells: number, at: (i: number, j: number) => number, level: number, style: string,
 * ) => void}
 */
function contour(context, pixels, cells, at, level, style) {
  const cell = pixels / cells;
  /** @type {(i: number, j: number) => [number, number]} */
  const point = (i, j) => [(i + 0.5) * cell, (cells - j - 0.5) * cell];
  context.beginPath();
  for (let j = 0; j + 1 < cells; j++) {
    for (let i = 0; i + 1 < cells; i++) {
      /** @type {[number, number][]} */
      const corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
      const values = corners.map(([a, b]) => at(a, b) - level);
      /** @type {[number, number][]} */
      const crossings = [];
      for (let k = 0; k < 4; k++) {
        const [a, b] = [values[k], values[(k + 1) % 4]];
        if (a < 0 === b < 0) continue;
        const [p, q] = [point(...corners[k]), point(...corners[(k + 1) % 4])];
        const part = a / (a - b);
        crossings.push([p[0] + part * (q[0] - p[0]), p[1] + part * (q[1] - p[1])]);
      }
      for (let k = 0; k + 1 < crossings.length; k += 2) {
        context.moveTo(...crossings[k]);
        context.lineTo(...crossings[k + 1]);
      }
    }
  }
  context.strokeStyle = style;
  context.stroke();
}

/** @type {(canvas: HTMLCanvasElement, known: Known) => void} */
function paintValidity(canvas, { words, cells }) {
  words.next = 2;
  const [good, warn, wrong] = [colour('--good'), colour('--warn'), colour('--wrong')];
  const image = new ImageData(cells, cells);
  for (let j = 0; j < cells; j++) {
    for (let i = 0; i < cells; i++) {
      const inverted = words.u32();
      words.f32();
      const stretch = words.f32();
      const strained = Math.min(Math.max(Math.log(stretch / EASY) / Math.log(HARD / EASY), 0), 1);
      const rgb = inverted > 0 ? wrong : good.map((c, k) => c + (warn[k] - c) * Math.min(2 * strained, 1));
      const amount = inverted > 0 ? Math.min(0.4 + 0.05 * inverted, 0.75) : 0.16 + 0.44 * strained;
      image.data.set([...rgb, 255 * amount], 4 * ((cells - 1 - j) * cells + i));
    }
  }
  const small = new OffscreenCanvas(cells, cells);
  brushOff(small).putImageData(image, 0, 0);
  const context = brushOf(canvas);
  context.clearRect(0, 0, canvas.width, canvas.height);
  context.imageSmoothingEnabled = false;
  context.drawImage(small, 0, 0, canvas.width, canvas.height);
  context.imageSmoothingEnabled = true;
}

/**
 * What the colours mean.
 * @type {() => Legend}
 */
export function legend() {
  const element = h('div', { class: 'legend hidden', 'aria-live': 'polite' });
  /** @type {(name: string) => SVGElement} */
  const swatch = (name) => s('svg', { class: `swatch ${name}`, viewBox: '0 0 10 10', 'aria-hidden': 'true' },
    set(s('rect'), { width: 10, height: 10, rx: 2 }));
  /** @type {{ [kind: string]: () => (string | Node)[] }} */
  const said = {
    weight: () => [
      h('b', {}, store.scene.poses[store.pose ?? 0]?.name ?? ''),
      swatch('accent'), 'weight', swatch('warn'), 'below 0', swatch('wrong'), 'above 1',
    ],
    validity: () => [swatch('good'), 'sound', swatch('warn'), 'stretched', swatch('wrong'), 'folds'],
  };
  return {
    element,
    show(kind) {
      element.classList.toggle('hidden', kind === 'plain');
      if (said[kind]) element.replaceChildren(...said[kind]());
    },
  };
}
