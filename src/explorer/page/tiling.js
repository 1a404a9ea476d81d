// @ts-check
// Tiles of different shapes side by side: as many columns as make them largest.

/** Pixels of a tile that its content does not have: left and right, above and below. */
const EDGE = [12, 42];
/** Pixels between tiles, and around all of them on both sides together. */
const GAP = 10;
const MARGIN = 24;

/**
 * Says in `--columns` and `--rows` of `root` how tiles are laid out whose contents have these widths, their heights being 1.
 * @type {(root: HTMLElement, shapes: number[]) => void}
 */
export function tile(root, shapes) {
  const [width, height] = [root.clientWidth - MARGIN, root.clientHeight - MARGIN];
  let best = [0, 1];
  for (let columns = 1; columns <= shapes.length; columns++) {
    const rows = Math.ceil(shapes.length / columns);
    const [w, h] = [(width - GAP * (columns - 1)) / columns - EDGE[0], (height - GAP * (rows - 1)) / rows - EDGE[1]];
    const size = Math.min(...shapes.map((shape) => Math.min(w, h * shape) / Math.sqrt(shape)));
    if (size > best[0]) best = [size, columns];
  }
  root.style.setProperty('--columns', String(best[1]));
  root.style.setProperty('--rows', String(Math.ceil(shapes.length / best[1])));
}
