// @ts-check
// Triangles row by row: which pixels of a window each one has first, and what the textures show there.

/** @import { LightMix, PlainMix, Seen } from './mixing.js' */
/** @import { Skirt } from './skirt.js' */
/** @import { Padded } from './texels.js' */

/**
 * @typedef {{
 *   skirt: Skirt, places: Float32Array, areas: Uint8Array, textures: PlacedTexture[], mix: PlainMix | LightMix, seen: Seen,
 * }} Painted
 */
/** @typedef {{ weight: number, texels: Padded, at: Float32Array }} PlacedTexture */

/** Numbers that a texture has in a triangle: u, v at its first corner, and what they change by in x and in y. */
const PLANE = 6;

export class Scan {
  /**
   * For `most` textures at once.
   * @param {number} most
   */
  constructor(most) {
    this.planes = new Float64Array(PLANE * most);
    this.taken = new Uint32Array(0);
    this.turn = 0;
    // What is painted, and where.
    /** @type {Skirt} */
    this.skirt;
    /** @type {Float32Array} */
    this.places;
    /** @type {Uint8Array} */
    this.areas;
    /** @type {PlacedTexture[]} */
    this.textures;
    /** @type {PlainMix | LightMix} */
    this.mix;
    /** @type {Seen} */
    this.seen;
    /** @type {Uint32Array} */
    this.pixels;
    this.width = 0;
    this.height = 0;
    this.origin = 0;
    this.stride = 0;
  }

  /**
   * Paints the triangles of a `skirt` into a window of `pixels` (straight red, green, blue, alpha), which has `stride` pixels a row; every
   * pixel of it is written. `places`: x, y of each vertex in pixels of the window. `areas`: how much of each of its pixels is covered, 0
   * to 255. `textures`: [{weight, texels, at}], `at` being x, y in texels at each vertex, added up by `mix`; `seen`: {opacity, tint}.
   * @type {(what: Painted, window: number[], pixels: Uint32Array, stride: number) => void}
   */
  paint(what, [left, top, right, bottom], pixels, stride) {
    Object.assign(this, what, { width: right - left, height: bottom - top, origin: top * stride + left, pixels, stride });
    if (this.taken.length < this.width * this.height) {
      this.taken = new Uint32Array(this.width * this.height);
      this.turn = 0;
    }
    this.turn++;
    for (let row = 0; row < this.height; row++) pixels.fill(0, this.origin + row * stride, this.origin + row * stride + this.width);
    const { corners, inside } = this.skirt;
    for (let k = 0; k < corners.length; k += 3) this.triangle(corners[k], corners[k + 1], corners[k + 2], k < inside);
  }

  /**
   * Of the mesh itself only what is not turned over.
   * @type {(a: number, b: number, c: number, isInside: boolean) => void}
   */
  triangle(a, b, c, isInside) {
    const { places } = this;
    const ax = places[2 * a];
    const ay = places[2 * a + 1];
    const bx = places[2 * b];
    const by = places[2 * b + 1];
    const cx = places[2 * c];
    const cy = places[2 * c + 1];
    const doubled = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
    if (!(isInside ? doubled > 0 : doubled !== 0)) return;
    // Of a pixel its middle counts.
    const first = Math.max(0, Math.ceil(Math.min(ay, by, cy) - 0.5));
    const end = Math.min(this.height, Math.ceil(Math.max(ay, by, cy) - 0.5));
    let isReady = false;
    for (let row = first; row < end; row++) {
      const y = row + 0.5;
      // Two of the edges pass through the row.
      const p = ay <= y !== by <= y ? crossing(ax, ay, bx, by, y) : crossing(bx, by, cx, cy, y);
      const q = ay <= y !== cy <= y ? crossing(ax, ay, cx, cy, y) : crossing(bx, by, cx, cy, y);
      const from = Math.max(0, Math.ceil((p < q ? p : q) - 0.5));
      const to = Math.min(this.width, Math.ceil((p < q ? q : p) - 0.5));
      if (from >= to) continue;
      if (!isReady) {
        this.layPlanes(a, b, c, bx - ax, by - ay, cx - ax, cy - ay, doubled);
        isReady = true;
      }
      this.row(row, from, to, ax, ay);
    }
  }

  /**
   * The maps from the triangle to each texture.
   * @type {(a: number, b: number, c: number, bx: number, by: number, cx: number, cy: number, doubled: number) => void}
   */
  layPlanes(a, b, c, bx, by, cx, cy, doubled) {
    const { planes, textures } = this;
    for (let k = 0; k < textures.length; k++) {
      const { at } = textures[k];
      for (let d = 0; d < 2; d++) {
        const origin = at[2 * a + d];
        const toB = at[2 * b + d] - origin;
        const toC = at[2 * c + d] - origin;
        planes[PLANE * k + d] = origin;
        planes[PLANE * k + 2 + d] = (toB * cy - toC * by) / doubled;
        planes[PLANE * k + 4 + d] = (toC * bx - toB * cx) / doubled;
      }
    }
  }

  /**
   * The pixels of a row that are covered and have nothing yet, run by run.
   * @type {(row: number, from: number, to: number, ax: number, ay: number) => void}
   */
  row(row, from, to, ax, ay) {
    const { areas, taken, turn } = this;
    const start = row * this.width;
    let at = from;
    while (at < to) {
      if (areas[start + at] === 0 || taken[start + at] === turn) {
        at++;
        continue;
      }
      const begin = at;
      while (at < to && areas[start + at] > 0 && taken[start + at] !== turn) taken[start + at++] = turn;
      this.run(row, begin, at, begin + 0.5 - ax, row + 0.5 - ay);
    }
  }

  /**
   * Pixels side by side; `x` and `y` lead from the triangle's first corner to the middle of the first of them.
   * @type {(row: number, from: number, to: number, x: number, y: number) => void}
   */
  run(row, from, to, x, y) {
    const { planes, textures, mix, areas, pixels, seen } = this;
    const count = to - from;
    mix.begin(count);
    for (let k = 0, p = 0; k < textures.length; k++, p += PLANE) {
      const u = planes[p] + x * planes[p + 2] + y * planes[p + 4];
      const v = planes[p + 1] + x * planes[p + 3] + y * planes[p + 5];
      mix.add(textures[k].texels, u, v, planes[p + 2], planes[p + 3], count, textures[k].weight);
    }
    const area = row * this.width + from;
    const pixel = this.origin + row * this.stride + from;
    for (let k = 0; k < count; k++) pixels[pixel + k] = mix.pixel(k, areas[area + k], seen);
  }
}

/**
 * Where an edge crosses a height; the same to the last bit for both triangles that have it.
 * @type {(ax: number, ay: number, bx: number, by: number, y: number) => number}
 */
function crossing(ax, ay, bx, by, y) {
  return ay < by ? ax + ((y - ay) * (bx - ax)) / (by - ay) : bx + ((y - by) * (ax - bx)) / (ay - by);
}
