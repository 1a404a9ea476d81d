// Writes a scene of pixel art: sprites of a figure with a lamp, 32 x 32 pixels, shown four times as large.
//
//   node sprites.mjs FOLDER
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { encodePng } from './picture.mjs';

const [folder] = process.argv.slice(2);
mkdirSync(folder, { recursive: true });

const [CLEAR, INK] = [[0, 0, 0, 0], [38, 26, 52, 255]];
const [SKIN, COAT, BOOT, LAMP] = [[244, 196, 150, 255], [62, 128, 196, 255], [120, 72, 48, 255], [250, 214, 92, 255]];

/** What is drawn at a pixel, the last box that has it: [left, top, right, bottom, colour]; around all of them a line of ink. */
function sprite(boxes) {
  const has = (x, y) => ([left, top, right, bottom]) => x >= left && x < right && y >= top && y < bottom;
  const filled = (x, y) => boxes.findLast(has(x, y))?.[4] ?? null;
  const isNear = (x, y) => [[-1, 0], [1, 0], [0, -1], [0, 1]].some(([dx, dy]) => filled(x + dx, y + dy));
  return (x, y) => filled(x, y) ?? (isNear(x, y) ? INK : CLEAR);
}

/** The figure with its arm and its legs moved by so many pixels. */
const figure = (arm, stride, bob) => sprite([
  [11, 4 + bob, 20, 12 + bob, SKIN],
  [13, 7 + bob, 14, 9 + bob, INK], [17, 7 + bob, 18, 9 + bob, INK],
  [10, 12 + bob, 21, 22 + bob, COAT],
  [20, 13 + bob + arm, 26, 16 + bob + arm, COAT], [26, 12 + bob + arm, 29, 16 + bob + arm, LAMP],
  [11 - stride, 21 + bob, 14 - stride, 28, BOOT], [17 + stride, 21 + bob, 20 + stride, 28, BOOT],
]);

const POSES = [
  ['stand', figure(3, 0, 0), [0, 0]], ['lift', figure(-2, 0, 0), [0, 1]],
  ['stride', figure(2, 2, 1), [1, 0]], ['duck', figure(1, 1, 3), [1, 1]],
];
for (const [name, colour] of POSES) writeFileSync(join(folder, `${name}.png`), encodePng(32, 32, colour));
writeFileSync(join(folder, 'scene.toml'), `version = 1

[texture]
sampling = "nearest"

[animation]
camera = "drawing"
size = [128, 128]
${POSES.map(([name, , at]) => `
[[pose]]
name = "${name}"
source = "${name}.png"
at = [${at.map((value) => value.toFixed(1)).join(', ')}]
`).join('')}`);
