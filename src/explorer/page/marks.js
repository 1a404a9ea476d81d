// @ts-check
// What is drawn over the drawing of a pose: outline, links, mesh, landmarks.
import { s, set } from './dom.js';
import { isUpright } from './geometry.js';
import { match, ownLandmarks, placesOf, pointsAt } from './match.js';
import { pointOn } from './pointed.js';
import { store } from './state.js';

/** @import { Flat, MatchPose, Place } from './answers.js' */
/** @import { Cell, Layer } from './match.js' */

/** @typedef {'given' | 'carried' | 'fresh'} Kind */
/**
 * All that the mark of a landmark shows.
 * @typedef {{
 *   name: string | null, points: Place[], px: number, kind: Kind, marked: boolean, chosen: boolean, wrong: boolean, hue: string | null,
 *   label: string | null, before: boolean,
 * }} Looks
 */

/**
 * Whether a layer of a cell was not made of the very same things already: what is not touched is not painted again.
 * @type {(layer: Layer, of: unknown[]) => boolean}
 */
function isStale(layer, of) {
  const before = layer.madeOf;
  layer.madeOf = of;
  return before?.length !== of.length || of.some((value, k) => !Object.is(value, before[k]));
}

/** @type {(layer: Layer, of: unknown[], make: () => SVGElement[]) => void} */
function fill(layer, of, make) {
  if (isStale(layer, of)) layer.replaceChildren(...make());
}

/**
 * Draws all but the picture; `px`: drawing units of a CSS pixel.
 * @type {(cell: Cell, px: number) => void}
 */
export function drawCell(cell, px) {
  const { layers, index } = cell;
  const { data, pointed } = match;
  const pose = data.poses[index];
  /** @type {(points: number[]) => string} */
  const ring = (points) => `M${pairs(points).map((p) => p.join(' ')).join('L')}Z`;
  fill(layers.outline, [pose.outline, px], () => [
    ...(pose.outline ? [s('path', { d: [pose.outline, ...pose.holes].map(ring).join(''), 'stroke-width': 1.5 * px })] : []),
    ...salient(pose, px),
  ]);
  const mesh = store.view.mesh && data.shape > 0 ? store.meshes[store.layer]?.poses[index] : null;
  fill(layers.mesh, [mesh, px], () => (mesh ? [meshPath(index, px)] : []));
  const links = data.links ?? [];
  fill(layers.links, [pose, px, pointed], () => {
    const roomy = perimeter(pose.outline ?? []) / px / Math.max(links.length, 1) > 24;
    return links.flatMap((link, k) => (link.landmark ? [] : numbered(link.at[index], k, link.hue ?? '', px, roomy)));
  });
  drawMarks(cell, px);
  const point = pointOn(store.layer, index);
  fill(layers.spot, [...(point ?? []), px], () => (point ? [spot(point, px)] : []));
  fill(layers.cross, [cell.cross, px], () => (cell.cross ? [cross(cell.cross, px)] : []));
}

/**
 * Where the point under the pointer is.
 * @type {(at: Place, px: number) => SVGElement}
 */
const spot = ([cx, cy], px) => s('g', {},
  s('circle', { class: 'halo', cx, cy, r: 6 * px, 'stroke-width': 4.5 * px }), s('circle', { cx, cy, r: 6 * px, 'stroke-width': 2 * px }),
  s('circle', { class: 'middle', cx, cy, r: 1.5 * px }));

/**
 * Where the keyboard is.
 * @type {(at: Place, px: number) => SVGElement}
 */
const cross = ([x, y], px) => {
  /** @type {(way: number[]) => string} */
  const arm = ([dx, dy]) => `M${x + 3 * dx * px} ${y + 3 * dy * px}L${x + 16 * dx * px} ${y + 16 * dy * px}`;
  return s('path', { d: [[-1, 0], [1, 0], [0, -1], [0, 1]].map(arm).join(''), 'stroke-width': 2 * px });
};

/** @type {(flat: Flat) => number} */
function perimeter(flat) {
  let sum = 0;
  for (let k = 0; k < flat.length; k += 2) {
    sum += Math.hypot(flat[(k + 2) % flat.length] - flat[k], flat[(k + 3) % flat.length] - flat[k + 1]);
  }
  return sum;
}

/** @type {(flat: Flat) => Place[]} */
const pairs = (flat) => Array.from({ length: flat.length / 2 }, (_, k) => [flat[2 * k], flat[2 * k + 1]]);

/** @type {(pose: MatchPose, px: number) => SVGElement[]} */
const salient = (pose, px) =>
  (pose.salient ?? []).map(({ at: [x, y] }) => s('circle', { class: 'salient', cx: x, cy: y, r: 2 * px, 'stroke-width': px }));

/** @type {(at: Place | null, k: number, colour: string, px: number, roomy: boolean) => SVGElement[]} */
function numbered(at, k, colour, px, roomy) {
  if (!at) return [];
  const isPointed = match.pointed === k;
  const shown = roomy || isPointed;
  const [x, y] = at;
  const label = s('text', { x, y: y + 3.1 * px, 'font-size': 8.5 * px, 'text-anchor': 'middle' });
  label.textContent = String(k + 1);
  const disc = s('circle', { cx: x, cy: y, r: (shown ? (isPointed ? 9 : 7) : 3.5) * px });
  disc.style.fill = colour;
  return [s('g', { class: 'link', 'data-link': k }, disc, shown ? label : null)];
}

/** @type {(index: number, px: number) => SVGElement} */
function meshPath(index, px) {
  const mesh = store.meshes[store.layer];
  const points = mesh.poses[index];
  /** @type {(v: number) => string} */
  const at = (v) => `${points[2 * v].toFixed(1)} ${points[2 * v + 1].toFixed(1)}`;
  let good = '';
  let wrong = '';
  for (let t = 0; t < mesh.triangles.length; t += 3) {
    const corners = mesh.triangles.subarray(t, t + 3);
    const [a, b, c] = corners;
    const path = `M${at(a)}L${at(b)} ${at(c)}Z`;
    if (isUpright(corners, points)) good += path;
    else wrong += path;
  }
  return s('g', { 'stroke-width': 0.6 * px }, s('path', { d: good }), s('path', { class: 'wrong', d: wrong }));
}

/**
 * The landmarks of a pose: given ones solid, carried ones hollow or dashed. Those that look as before stay.
 * @type {(cell: Cell, px: number) => void}
 */
function drawMarks(cell, px) {
  const { data, chosen, pointed, held } = match;
  const problems = (store.state.problems ?? []).map((problem) => problem.landmark);
  const made = [data, store.scene, px, cell.view, chosen, pointed, held, JSON.stringify([match.fresh, problems])];
  if (!isStale(cell.layers.marks, made)) return;
  const before = cell.marks ?? new Map();
  /** @type {Map<string, SVGElement>} */
  const marks = new Map();
  cell.marks = marks;
  /** @type {(name: string | null, path: boolean, places: Place[], kind: Kind) => void} */
  const add = (name, path, places, kind) => {
    const looks = looksOf(cell, name, path, places, px, kind);
    const key = JSON.stringify(looks);
    marks.set(key, before.get(key) ?? (path ? lineMark : mark)(looks));
  };
  for (const landmark of ownLandmarks()) {
    const places = placesOf(landmark, cell.pose.name, cell.index);
    if (places) add(landmark.name, landmark.path, places.points, places.given ? 'given' : 'carried');
  }
  const fresh = match.fresh?.at[cell.pose.name];
  if (match.fresh && fresh) add(null, match.fresh.path, pointsAt(match.fresh.path, fresh), 'fresh');
  for (const [key, element] of before) if (!marks.has(key)) element.remove();
  // What is pointed at is drawn over the others.
  /** @type {(element: Element) => boolean} */
  const isMarked = (element) => element.classList.contains('marked');
  const elements = [...marks.values()];
  for (const element of [...elements.filter((e) => !isMarked(e)), ...elements.filter(isMarked)]) {
    if (element.parentNode !== cell.layers.marks || isMarked(element)) cell.layers.marks.append(element);
  }
}

/**
 * All that the mark of a landmark shows.
 * @type {(cell: Cell, name: string | null, path: boolean, points: Place[], px: number, kind: Kind) => Looks}
 */
function looksOf(cell, name, path, points, px, kind) {
  const { data, chosen, pointed, known } = match;
  const marked = name !== null && (name === chosen || name === pointed);
  const link = marked ? (data.links ?? []).findIndex((other) => other.landmark === name) : -1;
  const own = name === null ? undefined : known.get(name);
  return {
    name, points, px, kind, marked,
    chosen: name !== null && name === chosen,
    wrong: name !== null && (store.state.problems ?? []).some((p) => p.landmark === name),
    hue: own?.kind === 'outline' ? own.hue : null,
    label: marked ? (link >= 0 ? `${link + 1} ${name}` : name) : null,
    // To the side where there is room.
    before: points[0][0] > cell.view[0] + 0.55 * cell.view[2],
  };
}

/** @type {(base: string, looks: Looks) => string} */
const classes = (base, looks) =>
  [base, looks.kind, looks.marked && 'marked', looks.chosen && 'chosen', looks.wrong && 'wrong'].filter(Boolean).join(' ');

/** @type {(looks: Looks) => SVGElement | null} */
function labelled({ points: [[x, y]], px, label, before }) {
  if (label === null) return null;
  const text = s('text', { class: 'name', x: x + 10 * px, y: y + 4 * px, 'font-size': 11 * px, 'stroke-width': 3 * px });
  text.textContent = label;
  return before ? set(text, { 'text-anchor': 'end', x: x - 10 * px }) : text;
}

/** @type {(looks: Looks) => SVGElement} */
function mark(looks) {
  const { name, points: [[x, y]], px, kind, marked, hue } = looks;
  const r = (marked || name === null ? 7 : 4) * px;
  const shape = s('path', { d: `M${x} ${y - r}L${x + r} ${y}L${x} ${y + r}L${x - r} ${y}Z`, 'stroke-width': 1.5 * px });
  if (hue) shape.style.setProperty(kind === 'given' ? 'fill' : 'stroke', hue);
  return s('g', { class: classes('mark', looks), 'data-landmark': name ?? '' }, s('circle', { class: 'reach', cx: x, cy: y, r: 9 * px }),
    shape, s('title', {}, name ?? 'New landmark'), labelled(looks));
}

/**
 * A line; its points can be taken hold of where it is looked at, or new.
 * @type {(looks: Looks) => SVGElement}
 */
function lineMark(looks) {
  const { name, points, px, marked } = looks;
  const along = points.map((p) => p.join(',')).join(' ');
  const nodes = marked || name === null ? points.map(([x, y], k) => s('g', { 'data-node': k },
    s('circle', { class: 'reach', cx: x, cy: y, r: 8 * px }),
    s('circle', { class: 'node', cx: x, cy: y, r: 4 * px, 'stroke-width': 1.5 * px }))) : [];
  const dashes = looks.kind === 'carried' ? `${5 * px} ${3 * px}` : null;
  return s('g', { class: classes('line', looks), 'data-landmark': name ?? '' },
    s('polyline', { class: 'reach', points: along, 'stroke-width': 12 * px }),
    s('polyline', { class: 'stroke', points: along, 'stroke-width': 2 * px, 'stroke-dasharray': dashes }),
    nodes, s('title', {}, name ?? 'New line'), labelled(looks));
}
