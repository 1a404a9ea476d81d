// @ts-check
// Boxes and areas of points x, y, x, y.

/** @import { Flat } from './answers.js' */

/**
 * The corners of the box around points.
 * @type {(points: Flat) => [number[], number[]]}
 */
export function extent(points) {
  const [low, high] = [[Infinity, Infinity], [-Infinity, -Infinity]];
  for (let k = 0; k < points.length; k++) {
    low[k & 1] = Math.min(low[k & 1], points[k]);
    high[k & 1] = Math.max(high[k & 1], points[k]);
  }
  return [low, high];
}

/**
 * The box around several lists of points.
 * @type {(lists: Flat[]) => [number[], number[]]}
 */
export function extentOfAll(lists) {
  const boxes = lists.map(extent);
  return [
    [0, 1].map((d) => Math.min(...boxes.map(([low]) => low[d]))),
    [0, 1].map((d) => Math.max(...boxes.map(([, high]) => high[d]))),
  ];
}

/** @type {(points: Flat) => number} */
export function diagonal(points) {
  const [low, high] = extent(points);
  return Math.hypot(high[0] - low[0], high[1] - low[1]);
}

/**
 * Twice the area of a ring of vertices, with its sign.
 * @type {(ring: Flat, points: Flat) => number}
 */
export function ringArea(ring, points) {
  let area = 0;
  for (let k = 0; k < ring.length; k++) {
    const [i, j] = [ring[k], ring[(k + 1) % ring.length]];
    area += points[2 * i] * points[2 * j + 1] - points[2 * j] * points[2 * i + 1];
  }
  return area;
}

/**
 * Twice the area of a triangle, negative where it is turned over.
 * @type {(points: Flat, a: number, b: number, c: number) => number}
 */
function doubledArea(points, a, b, c) {
  const x = points[2 * a];
  const y = points[2 * a + 1];
  return (points[2 * b] - x) * (points[2 * c + 1] - y) - (points[2 * b + 1] - y) * (points[2 * c] - x);
}

/** @type {(corners: Uint32Array, points: Flat) => boolean} */
export const isUpright = ([a, b, c], points) => doubledArea(points, a, b, c) > 0;

/**
 * The area of the triangles that are not turned over.
 * @type {(triangles: Uint32Array, points: Flat) => number}
 */
export function trianglesArea(triangles, points) {
  let doubled = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    doubled += Math.max(0, doubledArea(points, triangles[t], triangles[t + 1], triangles[t + 2]));
  }
  return 0.5 * doubled;
}
