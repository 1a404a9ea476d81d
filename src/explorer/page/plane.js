// @ts-check
// The part of the pose space that the pad shows, and how places get to pixels. x runs right, y up.
import { store } from './state.js';

/** @import { Place } from './answers.js' */

/** @typedef {{ low: Place, size: number, diagonal: number }} Plane */

/** Free room around the poses, of the box's diagonal. */
const MARGIN = 0.22;

/**
 * The square of the plane that is shown: {low: [x, y], size}. In one dimension y is nothing.
 * @type {() => Plane}
 */
export function shownPlane() {
  const places = store.scene.poses.map((pose) => [pose.at[0] ?? 0, pose.at[1] ?? 0]);
  for (const pseudo of store.scene.pseudo_poses) places.push([pseudo.at[0] ?? 0, pseudo.at[1] ?? 0]);
  if (places.length === 0) places.push([0, 0]);
  const low = [0, 1].map((d) => Math.min(...places.map((p) => p[d])));
  const high = [0, 1].map((d) => Math.max(...places.map((p) => p[d])));
  const diagonal = Math.hypot(high[0] - low[0], high[1] - low[1]) || 1;
  const size = Math.max(high[0] - low[0], high[1] - low[1]) + 2 * MARGIN * diagonal;
  return { low: [0, 1].map((d) => 0.5 * (low[d] + high[d] - size)), size, diagonal };
}

/** Places <-> pixels of a pad `side` pixels wide. */
export class PadView {
  /**
   * @param {Plane} plane
   * @param {number} side
   */
  constructor(plane, side) {
    this.plane = plane;
    this.side = side;
  }

  /** @type {(place: Place) => Place} */
  pixel([x, y = 0]) {
    const { low, size } = this.plane;
    return [((x - low[0]) / size) * this.side, (1 - (y - low[1]) / size) * this.side];
  }

  /** @type {(pixel: Place) => Place} */
  place([px, py]) {
    const { low, size } = this.plane;
    return [low[0] + (px / this.side) * size, low[1] + (1 - py / this.side) * size];
  }
}

/**
 * A round number near `value`: 1, 2 or 5 times a power of ten.
 * @type {(value: number) => number}
 */
export function niceStep(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  const steps = [1, 2, 5, 10].map((step) => step * power);
  return steps.reduce((best, step) => (Math.abs(Math.log(step / value)) < Math.abs(Math.log(best / value)) ? step : best));
}
