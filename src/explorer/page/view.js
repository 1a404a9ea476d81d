// @ts-check
// How the frame lies on the stage: zoom, and from one's coordinates to the other's.
import { byId, clamp } from './dom.js';
import { emit, store } from './state.js';

/** @import { Place } from './answers.js' */
/** @import { Grid } from './painter.js' */

const stage = byId('stage');

/** Free room around the frame when it is fitted, in CSS pixels. */
const ROOM = 20;
/** CSS pixels a frame pixel at most: of sprites every pixel is looked at. */
const LARGEST = 64;
/**
 * `null`: fitted. Otherwise CSS pixels a frame pixel and the frame's corner.
 * @type {Grid | null}
 */
let zoomed = null;
/**
 * Of the frame: fallbacks for scenes without animation.
 * @type {() => number[]}
 */
export const frameSize = () => store.scene?.animation?.size ?? [512, 512];

/**
 * CSS pixels a frame pixel, and where the frame's corner is.
 * @type {() => Grid}
 */
export function frameView() {
  if (zoomed) return zoomed;
  const [width, height] = frameSize();
  const [w, h_] = [stage.clientWidth, stage.clientHeight];
  const fitted = Math.max(0.02, Math.min((w - 2 * ROOM) / width, (h_ - 2 * ROOM) / height));
  // Squares are all of one size.
  const scale = store.puppet?.nearest && fitted > 1 ? Math.floor(fitted * devicePixelRatio) / devicePixelRatio : fitted;
  return { scale, x: Math.round((w - width * scale) / 2), y: Math.round((h_ - height * scale) / 2) };
}

/**
 * Pixels of the frame a drawing unit, and where the origin of drawings is.
 * @type {() => Grid}
 */
export function frameGrid() {
  const { scale, shift: [x, y] } = store.scene?.camera ?? { scale: 1, shift: [0, 0] };
  return { scale, x, y };
}

/**
 * CSS pixels a drawing unit, and where the origin of drawings is.
 * @type {() => Grid}
 */
export function drawingView() {
  const { scale, x, y } = frameView();
  const grid = frameGrid();
  return { scale: scale * grid.scale, x: x + grid.x * scale, y: y + grid.y * scale };
}

/** @type {(place: Place, view?: Grid) => Place} */
export const toDrawing = ([x, y], view = drawingView()) => [(x - view.x) / view.scale, (y - view.y) / view.scale];
/** @type {(place: Place, view?: Grid) => Place} */
export const toStage = ([x, y], view = drawingView()) => [x * view.scale + view.x, y * view.scale + view.y];

export function fit() {
  zoomed = null;
  emit('zoom');
}

/**
 * Zooms by a factor around a place of the stage; its middle if there is none.
 * @type {(factor: number, around?: Place) => void}
 */
export function zoomBy(factor, [px, py] = [stage.clientWidth / 2, stage.clientHeight / 2]) {
  const { scale, x, y } = frameView();
  const next = clamp(scale * factor, 0.05, LARGEST);
  zoomed = { scale: next, x: px - ((px - x) * next) / scale, y: py - ((py - y) * next) / scale };
  emit('zoom');
}

/** One frame pixel a CSS pixel. */
export function actualSize() {
  const [width, height] = frameSize();
  zoomed = { scale: 1, x: Math.round((stage.clientWidth - width) / 2), y: Math.round((stage.clientHeight - height) / 2) };
  emit('zoom');
}

/** @type {(dx: number, dy: number) => void} */
export function panBy(dx, dy) {
  const { scale, x, y } = frameView();
  zoomed = { scale, x: x + dx, y: y + dy };
  emit('zoom');
}
