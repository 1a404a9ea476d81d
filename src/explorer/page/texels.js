// @ts-check
// Pictures as texels in memory, in sizes from the whole down by halves.
import { brushOff } from './dom.js';

/** @typedef {Pixels & { stride: number }} Padded With the last column and row twice. */

/** @typedef {{ width: number, height: number, data: Uint32Array }} Pixels */

/** Red and blue of a texel; green and alpha of one that is moved by 8 bits. */
export const PAIR = 0xff00ff;

export class Texels {
  /** @param {ImageBitmap} bitmap */
  constructor(bitmap) {
    const { width, height } = bitmap;
    const context = brushOff(new OffscreenCanvas(width, height), { willReadFrequently: true });
    context.drawImage(bitmap, 0, 0);
    const { data } = context.getImageData(0, 0, width, height);
    /** @type {Pixels[]} */
    this.levels = [{ width, height, data: new Uint32Array(data.buffer) }];
    /** @type {Padded[]} */
    this.padded = [];
  }

  /**
   * The texels of a level, or of the smallest there is, with the last column and row twice: {width, height, stride, data}.
   * @type {(level: number) => Padded}
   */
  at(level) {
    while (this.levels.length <= level) {
      const last = this.levels[this.levels.length - 1];
      if (last.width === 1 && last.height === 1) break;
      this.levels.push(halved(last));
    }
    const found = Math.min(level, this.levels.length - 1);
    return (this.padded[found] ??= padded(this.levels[found]));
  }
}

/**
 * Half as wide and high: each texel the mean of four.
 * @type {(texels: Pixels) => Pixels}
 */
function halved({ width, height, data }) {
  const [columns, rows] = [Math.max(1, width >> 1), Math.max(1, height >> 1)];
  const half = new Uint32Array(columns * rows);
  for (let y = 0; y < rows; y++) {
    const [upper, lower] = [2 * y * width, Math.min(2 * y + 1, height - 1) * width];
    for (let x = 0; x < columns; x++) {
      const [left, right] = [2 * x, Math.min(2 * x + 1, width - 1)];
      let [even, odd] = [0x20002, 0x20002];
      for (const texel of [data[upper + left], data[upper + right], data[lower + left], data[lower + right]]) {
        even += texel & PAIR;
        odd += (texel >>> 8) & PAIR;
      }
      half[y * columns + x] = ((even >>> 2) & PAIR) | (((odd >>> 2) & PAIR) << 8);
    }
  }
  return { width: columns, height: rows, data: half };
}

/** @type {(texels: Pixels) => Padded} */
function padded({ width, height, data }) {
  const stride = width + 1;
  const wide = new Uint32Array(stride * (height + 1));
  for (let y = 0; y <= height; y++) {
    const row = Math.min(y, height - 1) * width;
    wide.set(data.subarray(row, row + width), y * stride);
    wide[y * stride + width] = data[row + width - 1];
  }
  return { width, height, stride, data: wide };
}
