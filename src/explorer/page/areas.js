// @ts-check
// How much of each pixel the silhouette covers, exactly: what `render::coverage` does.
//
// Each edge adds, in every row it crosses, the signed area to its right within the pixels it passes and the full height to all further
// pixels; a running sum along the row turns these differences into winding number times area. Costs the edges and the pixels, once
// each, which machines without a graphics card do far faster this way than by drawing one strip an edge.

let sums = new Float32Array(0);
let bytes = new Uint8Array(0);

/**
 * The covered part of each pixel of a window [left, top, right, bottom], 0 to 255, row by row. Rings are x, y in drawing units;
 * `view` is the scale and the shift from these to pixels. What is answered is overwritten by the next call.
 * @type {(rings: Float32Array[], view: number[], window: number[]) => Uint8Array}
 */
export function coveredAreas(rings, [scale, shiftX, shiftY], [left, top, right, bottom]) {
  const [width, height] = [right - left, bottom - top];
  const stride = width + 2;
  if (sums.length < stride * height) {
    sums = new Float32Array(stride * height);
    bytes = new Uint8Array(stride * height);
  } else {
    sums.fill(0, 0, stride * height);
  }
  for (const ring of rings) {
    const count = ring.length;
    if (count < 6) continue;
    let x0 = ring[count - 2] * scale + shiftX - left;
    let y0 = ring[count - 1] * scale + shiftY - top;
    for (let k = 0; k < count; k += 2) {
      const x1 = ring[k] * scale + shiftX - left;
      const y1 = ring[k + 1] * scale + shiftY - top;
      if (y0 < y1) addEdge(x0, y0, x1, y1, 1, stride, width, height);
      else if (y1 < y0) addEdge(x1, y1, x0, y0, -1, stride, width, height);
      x0 = x1;
      y0 = y1;
    }
  }
  let to = 0;
  for (let row = 0; row < height; row++) {
    let sum = 0;
    let from = row * stride;
    for (let column = 0; column < width; column++) {
      sum += sums[from++];
      const area = sum < 0 ? -sum : sum;
      bytes[to++] = area >= 1 ? 255 : area * 255 + 0.5;
    }
  }
  return bytes.subarray(0, width * height);
}

/**
 * An edge that runs down from (x0, y0) to (x1, y1).
 * @type {(x0: number, y0: number, x1: number, y1: number, sign: number, stride: number, width: number, height: number) => void}
 */
function addEdge(x0, y0, x1, y1, sign, stride, width, height) {
  if (y1 <= 0 || y0 >= height) return;
  const slope = (x1 - x0) / (y1 - y0);
  let y = y0;
  let x = x0;
  if (y < 0) {
    x -= y * slope;
    y = 0;
  }
  const end = y1 < height ? y1 : height;
  while (y < end) {
    const row = Math.floor(y);
    const next = row + 1 < end ? row + 1 : end;
    const xNext = next === y1 ? x1 : x + (next - y) * slope;
    addSpan(row * stride, x < xNext ? x : xNext, x < xNext ? xNext : x, sign * (next - y), width);
    y = next;
    x = xNext;
  }
}

/**
 * A piece within one row, from `a` to `b`, of a signed height.
 * @type {(row: number, a: number, b: number, height: number, width: number) => void}
 */
function addSpan(row, a, b, height, width) {
  if (b <= 0) {
    sums[row] += height;
    return;
  }
  if (a >= width) return;
  if (a < 0 || b > width) {
    // What is beyond the window's sides counts as if it ran along them.
    const part = height / (b - a);
    if (a < 0) {
      sums[row] += -a * part;
      height += a * part;
      a = 0;
    }
    if (b > width) {
      height -= (b - width) * part;
      b = width;
    }
  }
  const first = Math.floor(a);
  const last = Math.ceil(b);
  if (last <= first + 1) {
    const covered = height * (1 - (0.5 * (a + b) - first));
    sums[row + first] += covered;
    sums[row + first + 1] += height - covered;
    return;
  }
  const rise = height / (b - a);
  let before = 0;
  for (let column = first; column < last; column++) {
    // The area to the right of the edge within this pixel.
    const from = a > column ? a : column;
    const to = b < column + 1 ? b : column + 1;
    const fallen = (from - a) * rise;
    const area = fallen + (to - from) * rise * (column + 1 - 0.5 * (from + to));
    sums[row + column] += area - before;
    before = area;
  }
  sums[row + last] += height - before;
}
