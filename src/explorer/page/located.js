// @ts-check
// Points on meshes: in which triangle a place lies, and where the same part of the triangle is in another embedding.

/** @import { Flat, Place } from './answers.js' */

/**
 * A point of a mesh: the vertices of its triangle, and how much of each it is made of.
 * @typedef {{ corners: number[], parts: number[] }} MeshPoint
 */

/**
 * How much of each corner a place is made of; not numbers where the triangle is flat.
 * @type {(corners: ArrayLike<number> & Iterable<number>, points: Flat, x: number, y: number) => number[]}
 */
export function partsIn([a, b, c], points, x, y) {
  const [ax, ay] = [points[2 * a], points[2 * a + 1]];
  const [ux, uy, vx, vy] = [points[2 * b] - ax, points[2 * b + 1] - ay, points[2 * c] - ax, points[2 * c + 1] - ay];
  const area = ux * vy - uy * vx;
  const [p, q] = [((x - ax) * vy - (y - ay) * vx) / area, (ux * (y - ay) - uy * (x - ax)) / area];
  return [1 - p - q, p, q];
}

/**
 * The triangle that is seen at a place, which is the last one there, and the parts of its corners: {corners, parts}, or null.
 * @type {(triangles: Uint32Array, points: Flat, place: Place) => MeshPoint | null}
 */
export function onMesh(triangles, points, [x, y]) {
  for (let t = triangles.length - 3; t >= 0; t -= 3) {
    const corners = triangles.subarray(t, t + 3);
    const parts = partsIn(corners, points, x, y);
    if (Math.min(...parts) >= 0) return { corners: Array.from(corners), parts };
  }
  return null;
}

/**
 * Where a point of a mesh is in an embedding.
 * @type {(point: MeshPoint, points: Flat) => Place}
 */
export function placed({ corners, parts }, points) {
  return [0, 1].map((d) => corners.reduce((sum, v, k) => sum + parts[k] * points[2 * v + d], 0));
}

/**
 * Where rings of points x, y cross a height.
 * @type {(rings: Flat[], y: number) => number[]}
 */
export function crossingsAt(rings, y) {
  const found = [];
  for (const ring of rings) {
    for (let k = 0, before = ring.length - 2; k < ring.length; before = k, k += 2) {
      const [ax, ay, bx, by] = [ring[before], ring[before + 1], ring[k], ring[k + 1]];
      if (ay <= y !== by <= y) found.push(ax + ((y - ay) * (bx - ax)) / (by - ay));
    }
  }
  return found;
}

/**
 * Whether a place lies inside rings of points x, y, by the even-odd rule.
 * @type {(rings: Flat[], place: Place) => boolean}
 */
export const isInside = (rings, [x, y]) => crossingsAt(rings, y).filter((crossing) => x < crossing).length % 2 === 1;
