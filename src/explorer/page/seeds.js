// @ts-check
// For each pixel of a grid the nearest of some pixels: what `render::nearest_seed` does.
//
// Two sweeps pass on the nearest seed known so far to the eight neighbours (Danielsson 1980).

/** What is no pixel, and no seed. */
export const NONE = 0xffffffff;

/**
 * For each pixel the number of the nearest one that `values` has something other than NONE for; NONE if there is none.
 * @type {(values: Uint32Array, width: number, height: number) => Uint32Array}
 */
export function nearestSeeds(values, width, height) {
  const nearest = values.map((value, at) => (value === NONE ? NONE : at));
  /** @type {(x: number, y: number, seed: number) => number} */
  const far = (x, y, seed) => ((seed % width) - x) ** 2 + (Math.floor(seed / width) - y) ** 2;
  /** @type {(x: number, y: number, dx: number, dy: number) => void} */
  const relax = (x, y, dx, dy) => {
    const [nx, ny] = [x + dx, y + dy];
    if (nx < 0 || ny < 0 || nx >= width || ny >= height) return;
    const candidate = nearest[ny * width + nx];
    const at = y * width + x;
    if (candidate !== NONE && (nearest[at] === NONE || far(x, y, candidate) < far(x, y, nearest[at]))) nearest[at] = candidate;
  };
  /** @type {(y: number, step: number, ways: number[][]) => void} */
  const sweep = (y, step, ways) => {
    for (let k = 0; k < width; k++) for (const [dx, dy] of ways) relax(step > 0 ? k : width - 1 - k, y, dx, dy);
  };
  for (let y = 0; y < height; y++) {
    sweep(y, 1, [[-1, 0], [-1, -1], [0, -1], [1, -1]]);
    sweep(y, -1, [[1, 0]]);
  }
  for (let y = height - 1; y >= 0; y--) {
    sweep(y, -1, [[1, 0], [1, 1], [0, 1], [-1, 1]]);
    sweep(y, 1, [[-1, 0]]);
  }
  return nearest;
}
