// @ts-check
// What of a layer is to be drawn: where it can be on the canvas, which of its textures count, how finely. The same for whoever draws it.
import { extentOfAll, trianglesArea } from './geometry.js';

/** @import { Mesh, Shape, Texture } from './answers.js' */

/** @typedef {{ number: number, weight: number, level: number }} ShownTexture */

/** A texture that counts for less is not drawn. */
const FAINTEST = 1e-3;
/** Texels that a pixel may span before a smaller picture is used, as in `render::texture`. */
const MOST_TEXELS_A_PIXEL = 2.28;

/**
 * Where a texture is at each vertex of a mesh, x, y, from 0 to 1 over the picture; `puppet` is a layer of `api/puppet`.
 * @type {(texture: Texture, mesh: Mesh) => Float32Array}
 */
export function texturePlaces({ pose, colour: { width, height, origin, scale } }, mesh) {
  return mesh.poses[pose].map((value, k) => ((value - origin[k & 1]) * scale) / (k & 1 ? height : width));
}

/**
 * How many texels of a texture a mesh covers.
 * @type {(texture: Texture, mesh: Mesh) => number}
 */
export const texelsOf = ({ pose, colour: { scale } }, mesh) => trianglesArea(mesh.triangles, mesh.poses[pose]) * scale * scale;

/**
 * The pixels of a canvas that rings can touch: left, top, right, bottom; null if there are none. `view`: scale and shift.
 * @type {(rings: Float32Array[], view: number[], canvas: { width: number, height: number }) => number[] | null}
 */
export function windowOf(rings, [scale, x, y], { width, height }) {
  const [low, high] = extentOfAll(rings);
  const window = [
    Math.max(0, Math.floor(low[0] * scale + x) - 1), Math.max(0, Math.floor(low[1] * scale + y) - 1),
    Math.min(width, Math.ceil(high[0] * scale + x) + 1), Math.min(height, Math.ceil(high[1] * scale + y) + 1),
  ];
  return window[0] < window[2] && window[1] < window[3] ? window : null;
}

/**
 * The textures of a layer ({texels: how many of each its mesh covers}) that count in a shape, the heaviest first, `most` of them:
 * {number, weight, level}; weights sum to 1, level 0 is the picture itself, each further one half as wide.
 * @type {(layer: { texels: number[], triangles: Uint32Array }, shape: Shape, scale: number, most: number) => ShownTexture[]}
 */
export function shownTextures({ texels, triangles }, shape, scale, most) {
  const total = shape.textureWeights.reduce((sum, weight) => sum + Math.max(weight, 0), 0);
  // One level for all of a texture, as the command does it.
  const seen = Math.max(trianglesArea(triangles, shape.positions) * scale ** 2, 1e-6);
  const shown = texels
    .map((count, number) => ({
      number,
      weight: shape.textureWeights[number],
      level: Math.max(0, Math.ceil(Math.log2(Math.sqrt(count / seen) / MOST_TEXELS_A_PIXEL))),
    }))
    .filter(({ weight }) => weight > FAINTEST * total)
    .sort((a, b) => b.weight - a.weight)
    .slice(0, most);
  const whole = shown.reduce((sum, { weight }) => sum + weight, 0);
  shown.forEach((texture) => (texture.weight /= whole));
  return shown;
}
