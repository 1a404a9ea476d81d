// @ts-check
// The sheets of all drawings, whole, with what was taken for the figure on each.
import { byId, focused, found, h, onceAFrame, placeInSvg, s, set, targetOf } from './dom.js';
import { figures, posesWithSheets } from './figures.js';
import { icon } from './icons.js';
import { askFor, drawFigure, drawSheet } from './sheet.js';
import { choosePose, on, store } from './state.js';
import { tile } from './tiling.js';

/** @import { Cell, ReadFigure } from './sheet.js' */

const root = h('div', { class: 'sheets', id: 'sheets' });
/** @type {(name: string) => SVGElement} */
const line = (name) => s('svg', { class: `swatch ${name}`, viewBox: '0 0 16 8' }, s('path', { d: 'M1 4H15' }));
/** @type {(name: string, text: string) => HTMLElement} */
const swatch = (name, text) => h('span', {}, line(name), text);
const legend = h('div', { class: 'key', 'aria-hidden': 'true' },
  swatch('body', 'Body'), swatch('part', 'Loose part'), swatch('dropped', 'Left out'));
const frame = h('div', { class: 'sheets-frame hidden' }, root, legend);
byId('stage').append(frame);

/**
 * By pose.
 * @type {Map<number, Cell>}
 */
let cells = new Map();

/** @type {Record<string, string>} */
const TAKEN = { alpha: 'cut out', background: 'painted', lines: 'lines' };

function build() {
  const poses = posesWithSheets();
  const stays = cells.size === poses.length && poses.every((pose) => cells.get(pose)?.name === store.scene.poses[pose].name);
  if (stays) return;
  cells = new Map(poses.map((pose) => [pose, makeCell(pose)]));
  root.replaceChildren(...[...cells.values()].map((cell) => cell.element));
}

/** @type {(pose: number) => Cell} */
function makeCell(pose) {
  const { name } = store.scene.poses[pose];
  const drawing = s('svg', { class: 'sheet', preserveAspectRatio: 'xMidYMid meet', role: 'group', 'aria-label': `Sheet of ${name}` });
  const parts = ['picture', 'veil', 'pieces', 'places'];
  const layers = /** @type {Cell['layers']} */ (Object.fromEntries(parts.map((part) => [part, s('g', { class: part })])));
  drawing.append(...Object.values(layers));
  const taken = h('span', { class: 'faint small' });
  const warning = h('span', { class: 'warning' });
  const label = `Say how the figure of ${name} is told`;
  const choose = h('button', { type: 'button', class: 'name', 'aria-label': label, onclick: () => choosePose(pose) }, h('b', {}, name));
  const caption = h('figcaption', {}, choose, taken, h('span', { class: 'grow' }), warning);
  const element = h('figure', { class: 'cell', 'data-pose': name }, caption, drawing);
  const cell = { name, drawing, layers, taken, warning, element };
  drawing.addEventListener('click', (event) => {
    choosePose(pose);
    if (targetOf(event).closest('.choice, .place')) return;
    const { x, y } = placeInSvg(drawing, event);
    // On the figure itself there is nothing to be asked for.
    if (!targetOf(event).closest('.piece')) askFor(cell, pose, [x, y]);
  });
  return cell;
}

const draw = onceAFrame(() => {
  if (store.view.main !== 'drawings' || !store.scene) return;
  build();
  const shapes = [...cells.keys()].map((pose) => figures.get(pose)?.sheet).map((sheet) => (sheet ? sheet.width / sheet.height : 1));
  tile(root, shapes);
  const label = focused()?.closest?.('.sheets g')?.getAttribute('aria-label');
  for (const [pose, cell] of cells) {
    const figure = figures.get(pose);
    cell.element.classList.toggle('chosen', store.pose === pose);
    cell.taken.textContent = TAKEN[figure?.taken ?? ''] ?? '';
    cell.warning.replaceChildren(...(figure?.problem ? [icon('warn'), 'cannot be used'] : []));
    cell.warning.title = figure?.problem?.message ?? '';
    if (!figure?.sheet) continue;
    const { origin, scale, width, height } = figure.sheet;
    set(cell.drawing, { viewBox: [origin[0], origin[1], width / scale, height / scale].join(' ') });
    const read = /** @type {ReadFigure} */ (figure);
    drawSheet(cell, read, pose);
    const { clientWidth, clientHeight } = cell.drawing;
    drawFigure(cell, read, Math.max(width / Math.max(clientWidth, 1), height / Math.max(clientHeight, 1)) / scale);
  }
  if (label) found(root, `[aria-label="${CSS.escape(label)}"]`)?.focus();
  document.documentElement.dataset.figures = String(store.state.revisions.scene);
});

on('view', () => {
  frame.classList.toggle('hidden', store.view.main !== 'drawings');
  draw();
});
on('figures scene pose', draw);
new ResizeObserver(draw).observe(root);
