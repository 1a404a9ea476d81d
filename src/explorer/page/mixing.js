// @ts-check
// A run of pixels in a row, made of look-ups in several textures.
//
// A look-up is bilinear with 8 bits between texels, as on a graphics card. Red and blue, and green and alpha, go through one
// multiplication together: 255 times 256 parts fills 16 bits and no more, of a texel as of a weight.
import { PAIR } from './texels.js';

/** @import { Padded } from './texels.js' */

/** @typedef {{ opacity: number, tint: number[] }} Seen How what is painted is seen. */

/** Added before the lower 8 bits of both of a pair go. */
const HALF = 0x800080;

/** Colours added up as they are stored. Weights are in 256ths: what is shown is off by half a value at most. */
export class PlainMix {
  /** @param {number} most */
  constructor(most) {
    this.even = new Int32Array(most);
    this.odd = new Int32Array(most);
  }

  /**
   * Weights that sum to 1 as this takes them; what rounding leaves is the first one's.
   * @type {(weights: number[]) => number[]}
   */
  weights(weights) {
    const parts = weights.map((weight) => Math.round(256 * weight));
    parts[0] += 256 - parts.reduce((sum, part) => sum + part, 0);
    return parts;
  }

  /**
   * A run of `count` pixels, with nothing in it.
   * @type {(count: number) => void}
   */
  begin(count) {
    for (let k = 0; k < count; k++) this.even[k] = this.odd[k] = 0;
  }

  /**
   * Adds look-ups: the first at u, v in texels from the middle of the first one, each next one further by du, dv.
   * @type {(texels: Padded, u: number, v: number, du: number, dv: number, count: number, weight: number) => void}
   */
  add({ width, height, stride, data }, u, v, du, dv, count, weight) {
    const { even, odd } = this;
    const lastColumn = width - 1;
    const lastRow = height - 1;
    for (let k = 0; k < count; k++, u += du, v += dv) {
      const x = u > 0 ? (u < lastColumn ? u : lastColumn) : 0;
      const y = v > 0 ? (v < lastRow ? v : lastRow) : 0;
      const column = x | 0;
      const row = y | 0;
      const at = row * stride + column;
      const a = data[at];
      const b = data[at + 1];
      const c = data[at + stride];
      const d = data[at + stride + 1];
      let low = a & PAIR;
      let high = (a >>> 8) & PAIR;
      if (a !== b || a !== c || a !== d) {
        const right = ((x - column) * 256) | 0;
        const below = ((y - row) * 256) | 0;
        const last = (right * below) >> 8;
        const second = right - last;
        const third = below - last;
        const first = 256 - right - third;
        const lows = Math.imul(low, first) + Math.imul(b & PAIR, second) + Math.imul(c & PAIR, third) + Math.imul(d & PAIR, last);
        low = ((lows + HALF) >>> 8) & PAIR;
        const upper = Math.imul(high, first) + Math.imul((b >>> 8) & PAIR, second);
        const lower = Math.imul((c >>> 8) & PAIR, third) + Math.imul((d >>> 8) & PAIR, last);
        high = ((upper + lower + HALF) >>> 8) & PAIR;
      }
      if (high >= 0xff0000) {
        even[k] += Math.imul(low, weight);
        odd[k] += Math.imul(high, weight);
      } else {
        // Colours count by their alpha.
        const alpha = high >>> 16;
        const part = (weight * alpha + 127) / 255 | 0;
        even[k] += Math.imul(low, part);
        odd[k] += Math.imul(high & 0xff, part) + ((alpha * weight) << 16);
      }
    }
  }

  /**
   * Pixel `k` of the run, of which so much is covered (0 to 255), as red, green, blue, alpha; none if nothing is there.
   * @type {(k: number, area: number, seen: Seen) => number}
   */
  pixel(k, area, { opacity, tint }) {
    const alpha = this.odd[k] >>> 16;
    if (alpha === 0) return 0;
    if (alpha === 0xff00 && tint[3] === 0 && opacity === 1) {
      return (((this.even[k] + HALF) >>> 8) & PAIR) | ((this.odd[k] + 0x80) & 0xff00) | (area << 24);
    }
    const scale = (255 * (1 - tint[3])) / alpha;
    const red = (this.even[k] & 0xffff) * scale + 255 * tint[0] * tint[3];
    const green = (this.odd[k] & 0xffff) * scale + 255 * tint[1] * tint[3];
    const blue = (this.even[k] >>> 16) * scale + 255 * tint[2] * tint[3];
    return packed(red, green, blue, (alpha * area * opacity) / 0xff00);
  }
}

/** Steps of light that are told apart when it becomes a value: a quarter of a value where they are steepest. */
const LIGHTS = 16384;
/** @type {(value: number) => number} */
const lightOf = (value) => (value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4);
/** @type {(light: number) => number} */
const valueOf = (light) => (light <= 0.0031308 ? 12.92 * light : 1.055 * light ** (1 / 2.4) - 0.055);

/** Colours added up as light. */
export class LightMix {
  /** @param {number} most */
  constructor(most) {
    /** Red, green, blue, alpha of each pixel; colours times alpha. */
    this.sums = new Float64Array(4 * most);
    this.lights = Float64Array.from({ length: 256 }, (_, k) => lightOf(k / 255));
    this.values = Float64Array.from({ length: LIGHTS + 1 }, (_, k) => 255 * valueOf(k / LIGHTS));
  }

  /** @type {(weights: number[]) => number[]} */
  weights(weights) {
    return weights;
  }

  /** @type {(count: number) => void} */
  begin(count) {
    this.sums.fill(0, 0, 4 * count);
  }

  /** @type {(texels: Padded, u: number, v: number, du: number, dv: number, count: number, weight: number) => void} */
  add({ width, height, stride, data }, u, v, du, dv, count, weight) {
    const { sums, lights } = this;
    for (let k = 0; k < 4 * count; k += 4, u += du, v += dv) {
      const x = Math.min(Math.max(u, 0), width - 1);
      const y = Math.min(Math.max(v, 0), height - 1);
      const at = (y | 0) * stride + (x | 0);
      const [right, below] = [x - (x | 0), y - (y | 0)];
      let [red, green, blue, alpha] = [0, 0, 0, 0];
      for (let corner = 0; corner < 4; corner++) {
        const texel = data[at + (corner & 1) + (corner >> 1) * stride];
        const part = (corner & 1 ? right : 1 - right) * (corner >> 1 ? below : 1 - below);
        red += part * (texel & 0xff);
        green += part * ((texel >>> 8) & 0xff);
        blue += part * ((texel >>> 16) & 0xff);
        alpha += part * (texel >>> 24);
      }
      const part = (weight * alpha) / 255;
      sums[k] += part * light(lights, red);
      sums[k + 1] += part * light(lights, green);
      sums[k + 2] += part * light(lights, blue);
      sums[k + 3] += part;
    }
  }

  /** @type {(k: number, area: number, seen: Seen) => number} */
  pixel(k, area, { opacity, tint }) {
    const alpha = this.sums[4 * k + 3];
    if (!(alpha > 0)) return 0;
    /** @type {(channel: number) => number} */
    const value = (channel) => {
      const own = this.values[Math.min(LIGHTS, ((this.sums[4 * k + channel] / alpha) * LIGHTS + 0.5) | 0)];
      return own * (1 - tint[3]) + 255 * tint[channel] * tint[3];
    };
    return packed(value(0), value(1), value(2), alpha * area * opacity);
  }
}

/**
 * The light of a value between 0 and 255.
 * @type {(lights: Float64Array, value: number) => number}
 */
function light(lights, value) {
  const below = Math.min(value | 0, 254);
  return lights[below] + (value - below) * (lights[below + 1] - lights[below]);
}

/**
 * Rounding may lead beyond what a byte holds.
 * @type {(value: number) => number}
 */
const byte = (value) => (value < 254.5 ? value + 0.5 : 255);
/** @type {(red: number, green: number, blue: number, alpha: number) => number} */
const packed = (red, green, blue, alpha) => byte(red) | (byte(green) << 8) | (byte(blue) << 16) | (byte(alpha) << 24);
