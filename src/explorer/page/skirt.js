// @ts-check
// A mesh with a skirt around it: a band beyond the boundary that carries its colours on, since the outline that cuts them is finer than
// the boundary.
import { diagonal, ringArea } from './geometry.js';

/** @import { Flat, Mesh } from './answers.js' */

/** How far the skirt reaches, of the drawing's size. */
const REACH = 0.04;

export class Skirt {
  /** @param {Mesh} mesh */
  constructor({ vertices, triangles, rings, poses }) {
    this.vertices = vertices;
    this.reach = REACH * diagonal(poses[0]);
    this.rim = rings.flatMap((ring, r) => rimOf(ring, (ringArea(ring, poses[0]) > 0) === (r === 0)));
    const skirt = skirtOf(rings, vertices);
    /** Corners of the triangles in the order in which they are drawn, what is drawn first staying: the last one of the mesh first,
     * its corners in their order; then those of the skirt. */
    this.corners = new Uint32Array(triangles.length + skirt.length);
    for (let k = 0; k < triangles.length; k++) this.corners[k] = triangles[triangles.length - 3 - 3 * Math.floor(k / 3) + (k % 3)];
    this.corners.set(skirt, triangles.length);
    this.inside = triangles.length;
    this.outside = skirt.length;
    this.values = new Float32Array(2 * (vertices + this.rim.length));
  }

  /**
   * Where the vertices are, and behind them those of the skirt's outer side. What is answered is overwritten by the next call.
   * @type {(points: Float32Array) => Float32Array}
   */
  places(points) {
    return this.skirted(points, this.reach);
  }

  /**
   * Values x, y of the vertices, and behind them those of the outer side, which are those of the boundary.
   * @type {(values: Float32Array) => Float32Array}
   */
  carried(values) {
    return this.skirted(values, 0);
  }

  /** @type {(points: Float32Array, reach: number) => Float32Array} */
  skirted(points, reach) {
    const { values } = this;
    values.set(points);
    let to = 2 * this.vertices;
    for (const [vertex, before, after] of this.rim) {
      const x = points[2 * after] - points[2 * before];
      const y = points[2 * after + 1] - points[2 * before + 1];
      const far = reach / Math.max(Math.hypot(x, y), 1e-6);
      values[to++] = points[2 * vertex] + far * y;
      values[to++] = points[2 * vertex + 1] - far * x;
    }
    return values;
  }
}

/**
 * Of each vertex of a ring: itself and the two beside it, such that outward is to the left of the way between them.
 * @type {(ring: Uint32Array, forward: boolean) => number[][]}
 */
function rimOf(ring, forward) {
  /** @type {(k: number) => number} */
  const at = (k) => ring[(k + ring.length) % ring.length];
  return Array.from(ring, (vertex, k) => (forward ? [vertex, at(k - 1), at(k + 1)] : [vertex, at(k + 1), at(k - 1)]));
}

/**
 * Two triangles an edge of the boundary; the outer vertices are numbered on from `outer`.
 * @type {(rings: Uint32Array[], outer: number) => number[]}
 */
function skirtOf(rings, outer) {
  /** @type {number[]} */
  const corners = [];
  for (const ring of rings) {
    for (let k = 0; k < ring.length; k++) {
      const next = (k + 1) % ring.length;
      corners.push(ring[k], ring[next], outer + next, ring[k], outer + next, outer + k);
    }
    outer += ring.length;
  }
  return corners;
}
