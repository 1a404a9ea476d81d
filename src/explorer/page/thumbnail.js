// @ts-check
// A drawing, made small: without the clear border around it.
import { brushOf, brushOff } from './dom.js';

/** Pixels along a thumbnail's side. */
const SIDE = 128;
/** Alpha that counts as drawn. */
const SEEN = 8;

/** @type {(canvas: HTMLCanvasElement, source: string) => Promise<void>} */
export async function drawThumbnail(canvas, source) {
  const answer = await fetch(source);
  if (!answer.ok) return;
  const bitmap = await createImageBitmap(await answer.blob());
  const [left, top, right, bottom] = drawn(bitmap);
  const [width, height] = [right - left, bottom - top];
  copyThumbnail(canvas, bitmap, [left, top, width, height]);
  bitmap.close();
}

/**
 * A part of a picture, as large as it can be.
 * @type {(canvas: HTMLCanvasElement, from: CanvasImageSource, box: number[]) => void}
 */
export function copyThumbnail(canvas, from, [left, top, width, height]) {
  const scale = SIDE / Math.max(width, height);
  Object.assign(canvas, { width: SIDE, height: SIDE });
  const context = brushOf(canvas);
  context.imageSmoothingQuality = 'high';
  context.drawImage(from, left, top, width, height, (SIDE - width * scale) / 2, (SIDE - height * scale) / 2, width * scale, height * scale);
}

/**
 * The box around what is not clear.
 * @type {(bitmap: ImageBitmap) => number[]}
 */
function drawn(bitmap) {
  const { width, height } = bitmap;
  const context = brushOff(new OffscreenCanvas(width, height), { willReadFrequently: true });
  context.drawImage(bitmap, 0, 0);
  const { data } = context.getImageData(0, 0, width, height);
  let [left, top, right, bottom] = [width, height, 0, 0];
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      if (data[4 * (y * width + x) + 3] < SEEN) continue;
      left = Math.min(left, x);
      right = Math.max(right, x + 1);
      top = Math.min(top, y);
      bottom = y + 1;
    }
  }
  return left < right ? [left, top, right, bottom] : [0, 0, width, height];
}
