// @ts-check
// Frames of pixel art, for either painter: every pixel of a frame is one texel of each drawing, and is inside the figure or is not. What
// `render::nearest_texel` does, on the grid of the command's own frames, however large they are shown.
import { trianglesArea } from './geometry.js';
import { NONE, nearestSeeds } from './seeds.js';
import { shownTextures, texelsOf } from './shown.js';
import { Texels } from './texels.js';

/** @import { Mesh, Puppet, Shape, Texture } from './answers.js' */
/** @import { Grid, Looks } from './painter.js' */
/** @import { ShownTexture } from './shown.js' */
/** @import { Pixels } from './texels.js' */

/** @typedef {{ decode: (value: number) => number, encode: (light: number) => number }} Light */
/** @typedef {{ left: number, top: number, width: number, height: number }} Box */
/** @typedef {Masked & { places: Float32Array, part: number }} Part A texture, where it is at each vertex, and how much of the whole. */
/** @typedef {{ triangles: Uint32Array, texels: number[], places: Float32Array[] }} Layer */
/** @typedef {Pixels & { inside: Uint32Array }} Masked Texels, and for each 1 where it lies inside its outline. */

/** How far from the mesh a texel may reach: as in the command. */
const REACH_TEXELS = 1.5;
/** Steps of a texture's weight. */
const WHOLE = 1 << 14;
/** Textures that count at once; of more, the heaviest. */
const MOST_TEXTURES = 64;

/** @type {(value: number) => number} */
const lightOf = (value) => (value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4);
/** @type {(light: number) => number} */
const valueOf = (light) => (light <= 0.0031308 ? 12.92 * light : 1.055 * light ** (1 / 2.4) - 0.055);
/** @type {Light} */
const LIGHT = { decode: (value) => lightOf(value / 255), encode: (light) => 255 * valueOf(light) };
/** @type {Light} */
const PLAIN = { decode: (value) => value, encode: (value) => value };

export class Squares {
  constructor() {
    /** @type {Masked[][]} */
    this.pictures = [];
    /** @type {Layer[]} */
    this.layers = [];
  }

  /**
   * As `PuppetPainter.load`; `masks`: pictures that are opaque where a texel lies inside its outline.
   * @type {(puppet: Puppet, meshes: Mesh[], bitmaps: ImageBitmap[][] | null, masks?: ImageBitmap[][] | null) => void}
   */
  load(puppet, meshes, bitmaps, masks) {
    /** @type {(bitmap: ImageBitmap) => Pixels} */
    const pixels = (bitmap) => new Texels(bitmap).levels[0];
    if (bitmaps) {
      this.pictures = bitmaps.map((layer, k) => layer.map((bitmap, t) => {
        const { data, width, height } = pixels(bitmap);
        return { data, width, height, inside: pixels(/** @type {ImageBitmap[][]} */ (masks)[k][t]).data.map((texel) => texel >>> 31) };
      }));
    }
    this.layers = puppet.layers.map(({ textures }, k) => {
      const { triangles, poses } = meshes[k];
      // In texels, x, y at each vertex.
      /** @type {(texture: Texture) => Float32Array} */
      const placed = ({ pose, colour: { origin, scale } }) => poses[pose].map((value, i) => (value - origin[i & 1]) * scale);
      return { triangles, texels: textures.map((of) => texelsOf(of, meshes[k])), places: textures.map(placed) };
    });
  }

  /**
   * A layer of a frame on a grid, `{scale, x, y}` from drawing units to its pixels: {left, top, image}, or null if nothing is seen.
   * @type {(k: number, shape: Shape, grid: Grid, looks?: Looks) => { left: number, top: number, image: ImageData } | null}
   */
  paint(k, shape, { scale, x, y }, { tint = [0, 0, 0, 0], inLight = false } = {}) {
    const layer = this.layers[k];
    const shown = shownTextures(layer, shape, scale, MOST_TEXTURES);
    if (shown.length === 0) return null;
    const placed = Float64Array.from(shape.positions, (value, i) => value * scale + (i & 1 ? y : x));
    const reach = reachOf(layer, shown, placed);
    const box = boxOf(placed, reach);
    if (!box) return null;
    const triangleOf = trianglesAt(layer.triangles, placed, box, reach);
    const textures = shown.map(({ number, weight }) => {
      const part = Math.round(weight * WHOLE);
      return { ...this.pictures[k][number], places: layer.places[number], part };
    });
    textures[0].part += WHOLE - textures.reduce((sum, { part }) => sum + part, 0);
    const mean = new Mean(textures, inLight && shown.length > 1 ? LIGHT : PLAIN, tint);
    const image = new ImageData(box.width, box.height);
    const pixels = new Uint32Array(image.data.buffer);
    const maps = new Map();
    for (let at = 0; at < pixels.length; at++) {
      const t = triangleOf[at];
      if (t === NONE) continue;
      if (!maps.has(t)) maps.set(t, textures.map(({ places }) => mapOf(layer.triangles.subarray(t, t + 3), placed, places)));
      pixels[at] = mean.at(maps.get(t), box.left + (at % box.width) + 0.5, box.top + Math.floor(at / box.width) + 0.5);
    }
    return { left: box.left, top: box.top, image };
  }
}

/**
 * How far beyond the mesh texels may be seen, in pixels.
 * @type {(layer: Layer, shown: ShownTexture[], placed: Float64Array) => number}
 */
function reachOf({ triangles, texels }, shown, placed) {
  const area = trianglesArea(triangles, placed);
  const largest = Math.max(...shown.map(({ number }) => Math.sqrt(area / texels[number])));
  return largest > 0 && Number.isFinite(largest) ? REACH_TEXELS * largest + 1 : 0;
}

/** @type {(placed: Float64Array, reach: number) => Box | null} */
function boxOf(placed, reach) {
  /** @type {(d: number) => Float64Array} */
  const along = (d) => placed.filter((_, i) => (i & 1) === d);
  const [low, high] = [Math.min, Math.max].map((most) => [0, 1].map((d) => along(d).reduce((a, b) => most(a, b))));
  const [left, top] = low.map((value) => Math.floor(value - reach));
  const [width, height] = [Math.ceil(high[0] + reach) - left, Math.ceil(high[1] + reach) - top];
  return reach > 0 && width > 0 && height > 0 ? { left, top, width, height } : null;
}

/**
 * For each pixel of a box where the triangle begins whose map it is taken by: the last one there, or one within reach.
 * @type {(triangles: Uint32Array, placed: Float64Array, box: Box, reach: number) => Uint32Array}
 */
function trianglesAt(triangles, placed, { left, top, width, height }, reach) {
  const covered = new Uint32Array(width * height).fill(NONE);
  for (let t = 0; t < triangles.length; t += 3) {
    const corners = Array.from(triangles.subarray(t, t + 3), (v) => [placed[2 * v] - left, placed[2 * v + 1] - top]);
    const [[ax, ay], [bx, by], [cx, cy]] = corners;
    if (!((bx - ax) * (cy - ay) - (by - ay) * (cx - ax) > 0)) continue;
    const first = Math.max(0, Math.ceil(Math.min(ay, by, cy) - 0.5));
    const end = Math.min(height, Math.ceil(Math.max(ay, by, cy) - 0.5));
    for (let row = first; row < end; row++) {
      const crossings = [[0, 1], [1, 2], [2, 0]].flatMap(([i, j]) => crossing(corners[i], corners[j], row + 0.5));
      const from = Math.max(0, Math.ceil(Math.min(...crossings) - 0.5));
      const to = Math.min(width, Math.ceil(Math.max(...crossings) - 0.5));
      if (from < to) covered.fill(t, row * width + from, row * width + to);
    }
  }
  const nearest = nearestSeeds(covered, width, height);
  return covered.map((_, at) => {
    const seed = nearest[at];
    if (seed === NONE) return NONE;
    const [dx, dy] = [(at % width) - (seed % width), Math.floor(at / width) - Math.floor(seed / width)];
    return dx * dx + dy * dy <= reach * reach ? covered[seed] : NONE;
  });
}

/**
 * Where an edge crosses a height, from the upper end on; the same to the last bit for both triangles that have it.
 * @type {(a: number[], b: number[], y: number) => number[]}
 */
function crossing([ax, ay], [bx, by], y) {
  if (ay <= y === by <= y) return [];
  return [ay < by ? ax + ((y - ay) * (bx - ax)) / (by - ay) : bx + ((y - by) * (ax - bx)) / (ay - by)];
}

/**
 * The affine map from a triangle among `from` to the same one among `to`: x of x, x of y, x of 1, then the same of y.
 * @type {(corners: Uint32Array, from: Float64Array, to: Float32Array) => number[]}
 */
function mapOf([a, b, c], from, to) {
  const [ax, ay] = [from[2 * a], from[2 * a + 1]];
  const [ux, uy, vx, vy] = [from[2 * b] - ax, from[2 * b + 1] - ay, from[2 * c] - ax, from[2 * c + 1] - ay];
  const area = ux * vy - uy * vx;
  return [0, 1].flatMap((d) => {
    const origin = to[2 * a + d];
    const [toB, toC] = [to[2 * b + d] - origin, to[2 * c + d] - origin];
    const [alongX, alongY] = [(toB * vy - toC * uy) / area, (toC * ux - toB * vx) / area];
    return [alongX, alongY, origin - alongX * ax - alongY * ay];
  });
}

/** The mean of texels by their parts of a whole; clear where most of the weight is outside. */
class Mean {
  /**
   * @param {Part[]} textures
   * @param {Light} light
   * @param {number[]} tint
   */
  constructor(textures, light, tint) {
    this.textures = textures;
    this.light = light;
    this.tint = tint;
  }

  /** @type {(maps: number[][], x: number, y: number) => number} */
  at(maps, x, y) {
    const { textures, light: { decode, encode }, tint } = this;
    let [red, green, blue, alpha, inside] = [0, 0, 0, 0, 0];
    for (let k = 0; k < textures.length; k++) {
      const { data, width, height, inside: mask, part } = textures[k];
      const map = maps[k];
      const [u, v] = [Math.floor(map[0] * x + map[1] * y + map[2]), Math.floor(map[3] * x + map[4] * y + map[5])];
      const at = Math.min(Math.max(v, 0), height - 1) * width + Math.min(Math.max(u, 0), width - 1);
      if (u >= 0 && v >= 0 && u < width && v < height) inside += part * mask[at];
      const texel = data[at];
      const seen = (texel >>> 24) * part;
      red += seen * decode(texel & 255);
      green += seen * decode((texel >>> 8) & 255);
      blue += seen * decode((texel >>> 16) & 255);
      alpha += seen;
    }
    if (2 * inside < WHOLE || alpha === 0) return 0;
    /** @type {(sum: number, d: number) => number} */
    const channel = (sum, d) => Math.round(encode(sum / alpha) * (1 - tint[3]) + 255 * tint[d] * tint[3]);
    return (channel(red, 0) | (channel(green, 1) << 8) | (channel(blue, 2) << 16) | (Math.round(alpha / WHOLE) << 24)) >>> 0;
  }
}
