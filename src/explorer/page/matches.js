// Correspondences: the outlines of all poses side by side, what matches what, and the landmarks that say so.
import { getJson, postJson } from './api.js';
import { byId, clamp, follow, h, onceAFrame, s, set } from './dom.js';
import { iconButton } from './controls.js';
import { icon } from './icons.js';
import { Drag, edit, emit, look, on, rounded, store } from './state.js';
import { landmarksPanel, problemsOf } from './inspector.js';

const root = h('div', { class: 'matches hidden', id: 'matches' });
byId('stage').append(root);

let data = null;
let cells = [];
let chosen = null; // the landmark that is looked at
let fresh = null; // a landmark that is not added yet: {kind, at: {pose: [x, y]}}
let dragging = false;
let showMesh = false;

async function read() {
  if (!store.scene?.poses.length) return;
  try {
    const layer = store.layer;
    const answer = await getJson('correspondences', { layer, samples: 0 });
    if (layer !== store.layer) return;
    data = answer;
  } catch (error) {
    emit('refused', error.problem ?? { message: error.message });
    return;
  }
  build();
  draw();
  drawList();
}

// The cells, one a pose.

let built = '';
function build() {
  const key = JSON.stringify([store.layer, data.poses.map((pose) => [pose.name, pose.drawn, pose.picture]), store.state.revisions.pictures]);
  if (built === key) return;
  built = key;
  cells = data.poses.map((pose, index) => {
    const box = bounds(pose);
    const drawing = s('svg', { class: 'drawing', role: 'group', 'aria-label': `Drawing of ${pose.name}`, preserveAspectRatio: 'xMidYMid meet' });
    const layers = Object.fromEntries(['picture', 'mesh', 'outline', 'links', 'marks'].map((name) => [name, s('g', { class: name })]));
    drawing.append(...Object.values(layers));
    const warning = h('span', { class: 'warning' });
    const element = h('figure', { class: `cell${pose.drawn ? '' : ' copy'}` }, h('figcaption', {}, h('b', {}, pose.name), index === data.reference ? h('span', { class: 'faint small' }, 'reference') : null, pose.drawn ? null : h('span', { class: 'faint small' }, 'copy'), h('span', { class: 'grow' }), warning), drawing);
    const cell = { pose, index, box, drawing, layers, warning, element };
    // A copy has no drawing of its own: what it would show is bent otherwise.
    if (pose.picture && pose.drawn) {
      const { origin, scale, width, height } = pose.picture;
      const source = `api/drawing?layer=${store.layer}&pose=${pose.pose}&max=640&v=${store.state.revisions.pictures}`;
      layers.picture.append(s('image', { href: source, x: origin[0], y: origin[1], width: width / scale, height: height / scale, preserveAspectRatio: 'none' }));
    }
    cell.view = box;
    set(drawing, { viewBox: box.join(' ') });
    drawing.addEventListener('wheel', (event) => zoomCell(event, cell), { passive: false });
    drawing.addEventListener('dblclick', (event) => event.target.closest('.mark') || showBox(cell, cell.box));
    drawing.addEventListener('pointerdown', (event) => press(event, cell));
    return cell;
  });
  root.replaceChildren(...cells.map((cell) => cell.element), tray);
  arrange();
}

function bounds(pose) {
  const points = pose.outline ?? [];
  if (points.length === 0 && pose.picture) {
    const { origin, scale, width, height } = pose.picture;
    return [origin[0], origin[1], width / scale, height / scale];
  }
  const x = points.filter((_, k) => k % 2 === 0);
  const y = points.filter((_, k) => k % 2 === 1);
  const [left, top, right, bottom] = [Math.min(...x), Math.min(...y), Math.max(...x), Math.max(...y)];
  const room = 0.07 * Math.max(right - left, bottom - top);
  return points.length ? [left - room, top - room, right - left + 2 * room, bottom - top + 2 * room] : [0, 0, 100, 100];
}

function showBox(cell, view) {
  cell.view = view;
  set(cell.drawing, { viewBox: view.join(' ') });
  draw();
}

/** Around the pointer, never farther than the whole drawing. */
function zoomCell(event, cell) {
  event.preventDefault();
  const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(cell.drawing.getScreenCTM().inverse());
  const [left, top, w, h_] = cell.view;
  const factor = clamp(Math.exp(event.deltaY * 0.0016), (0.04 * cell.box[2]) / w, cell.box[2] / w);
  const x = clamp(point.x - (point.x - left) * factor, cell.box[0], cell.box[0] + cell.box[2] - w * factor);
  const y = clamp(point.y - (point.y - top) * factor, cell.box[1], cell.box[1] + cell.box[3] - h_ * factor);
  showBox(cell, [x, y, w * factor, h_ * factor]);
}

/** As many columns as make the drawings largest. */
function arrange() {
  if (cells.length === 0) return;
  const [width, height] = [root.clientWidth - 24, root.clientHeight - 24];
  const shapes = cells.map(({ box }) => box[2] / box[3]);
  let best = [0, 1];
  for (let columns = 1; columns <= cells.length; columns++) {
    const rows = Math.ceil(cells.length / columns);
    const [w, h_] = [(width - 10 * (columns - 1)) / columns - 12, (height - 10 * (rows - 1)) / rows - 42];
    const size = Math.min(...shapes.map((shape) => Math.min(w, h_ * shape) / Math.sqrt(shape)));
    if (size > best[0]) best = [size, columns];
  }
  root.style.setProperty('--columns', best[1]);
  root.style.setProperty('--rows', Math.ceil(cells.length / best[1]));
  draw();
}

/** Drawing units of one CSS pixel in a cell. */
const unit = (cell) => {
  const [, , w, h_] = cell.view;
  return Math.max(w / Math.max(cell.drawing.clientWidth, 1), h_ / Math.max(cell.drawing.clientHeight, 1));
};

/** A colour for what lies at a place of the reference's outline: once around the circle of hues. */
function hue(at) {
  const outline = data.poses[data.reference]?.outline;
  if (!outline || !at) return 'hsl(226 70% 52%)';
  let [best, where] = [Infinity, 0];
  for (let k = 0; k < outline.length; k += 2) {
    const far = Math.hypot(outline[k] - at[0], outline[k + 1] - at[1]);
    if (far < best) [best, where] = [far, k];
  }
  return `hsl(${Math.round((360 * where) / outline.length)} 74% 44%)`;
}

const draw = onceAFrame(() => {
  if (!data || store.view.main !== 'matches') return;
  for (const cell of cells) {
    const { layers, index } = cell;
    const pose = data.poses[index];
    cell.pose = pose;
    const px = unit(cell);
    const ring = (points) => `M${pairs(points).map((p) => p.join(' ')).join('L')}Z`;
    layers.outline.replaceChildren(...(pose.outline ? [s('path', { d: [pose.outline, ...pose.holes].map(ring).join(''), 'stroke-width': 1.5 * px })] : []));
    layers.outline.append(...salient(pose, px));
    layers.mesh.replaceChildren(...(showMesh && data.shape > 0 ? [meshPath(index, px)] : []));
    const links = data.links ?? [];
    const roomy = perimeter(pose.outline ?? []) / px / Math.max(links.length, 1) > 24;
    layers.links.replaceChildren(...links.flatMap((link, k) => (link.landmark ? [] : numbered(link.at[index], k, hue(link.at[data.reference]), px, roomy))));
    layers.marks.replaceChildren(...marks(cell, px));
    cell.warning.replaceChildren(...(pose.looks_mirrored ? [icon('warn'), 'looks mirrored'] : []));
  }
  drawTray();
});

/** The link or landmark under the pointer, shown on all drawings. */
let pointed = null;
function point(target) {
  const link = target?.closest?.('[data-link]');
  const mark = target?.closest?.('[data-landmark]');
  const now = link ? Number(link.dataset.link) : mark ? mark.dataset.landmark : null;
  if (now === pointed) return;
  pointed = now;
  draw();
}
root.addEventListener('pointerover', (event) => event.buttons === 0 && point(event.target));
root.addEventListener('pointerleave', () => point(null));

function perimeter(flat) {
  let sum = 0;
  for (let k = 0; k < flat.length; k += 2) sum += Math.hypot(flat[(k + 2) % flat.length] - flat[k], flat[(k + 3) % flat.length] - flat[k + 1]);
  return sum;
}

const pairs = (flat) => Array.from({ length: flat.length / 2 }, (_, k) => [flat[2 * k], flat[2 * k + 1]]);

const salient = (pose, px) => (pose.salient ?? []).map(({ at: [x, y] }) => s('circle', { class: 'salient', cx: x, cy: y, r: 2 * px, 'stroke-width': px }));

function numbered(at, k, colour, px, roomy) {
  if (!at) return [];
  const shown = roomy || pointed === k;
  const [x, y] = at;
  const label = s('text', { x, y: y + 3.1 * px, 'font-size': 8.5 * px, 'text-anchor': 'middle' });
  label.textContent = k + 1;
  const disc = s('circle', { cx: x, cy: y, r: (shown ? (pointed === k ? 9 : 7) : 3.5) * px });
  disc.style.fill = colour;
  return [s('g', { class: 'link', 'data-link': k }, disc, shown ? label : null)];
}

function meshPath(index, px) {
  const mesh = store.meshes[store.layer];
  const points = mesh.poses[index];
  const at = (v) => `${points[2 * v].toFixed(1)} ${points[2 * v + 1].toFixed(1)}`;
  let good = '';
  let wrong = '';
  for (let t = 0; t < mesh.triangles.length; t += 3) {
    const [a, b, c] = mesh.triangles.subarray(t, t + 3);
    const area = (points[2 * b] - points[2 * a]) * (points[2 * c + 1] - points[2 * a + 1]) - (points[2 * b + 1] - points[2 * a + 1]) * (points[2 * c] - points[2 * a]);
    const path = `M${at(a)}L${at(b)} ${at(c)}Z`;
    if (area > 0) good += path;
    else wrong += path;
  }
  return s('g', { 'stroke-width': 0.6 * px }, s('path', { d: good }), s('path', { class: 'wrong', d: wrong }));
}

/** The landmarks of a pose: given ones solid, carried ones hollow. */
function marks(cell, px) {
  const made = [];
  for (const landmark of store.scene.landmarks) {
    if ((landmark.layer ?? 0) !== store.layer || landmark.path) continue;
    const own = landmark.at[cell.pose.name];
    const known = data.landmarks?.find((other) => other.name === landmark.name);
    const at = own ?? known?.at[cell.index]?.[0];
    if (!at) continue;
    made.push(mark(cell, landmark.name, held(landmark.name, cell) ?? at, px, own ? 'given' : 'carried'));
  }
  // What is pointed at is drawn over the others.
  made.sort((a, b) => Number(a.classList.contains('marked')) - Number(b.classList.contains('marked')));
  if (fresh?.at[cell.pose.name]) made.push(mark(cell, null, fresh.at[cell.pose.name], px, 'fresh'));
  return made;
}

let holding = null;
const held = (name, cell) => (holding?.name === name && holding.cell === cell.index ? holding.at : null);

function mark(cell, name, [x, y], px, kind) {
  const marked = name !== null && (name === chosen || name === pointed);
  const r = (marked || name === null ? 7 : 4) * px;
  const shape = s('path', { d: `M${x} ${y - r}L${x + r} ${y}L${x} ${y + r}L${x - r} ${y}Z`, 'stroke-width': 1.5 * px });
  const link = (data.links ?? []).findIndex((other) => other.landmark === name && name !== null);
  const known = data.landmarks?.find((other) => other.name === name);
  if (known?.kind === 'outline') shape.style.setProperty(kind === 'given' ? 'fill' : 'stroke', hue(known.at[data.reference]?.[0]));
  const problem = name && (store.state.problems ?? []).some((p) => p.landmark === name);
  const group = s('g', { class: `mark ${kind}${marked ? ' marked' : ''}${name !== null && name === chosen ? ' chosen' : ''}${problem ? ' wrong' : ''}`, 'data-landmark': name ?? '' }, s('circle', { class: 'reach', cx: x, cy: y, r: 9 * px }), shape, s('title', {}, name ?? 'New landmark'));
  if (marked) {
    const label = s('text', { class: 'name', x: x + 10 * px, y: y + 4 * px, 'font-size': 11 * px, 'stroke-width': 3 * px });
    label.textContent = link >= 0 ? `${link + 1} ${name}` : name;
    // To the side where there is room.
    if (x > cell.view[0] + 0.55 * cell.view[2]) set(label, { 'text-anchor': 'end', x: x - 10 * px });
    group.append(label);
  }
  return group;
}

// The pointer.

function placeUnder(event, cell) {
  const matrix = cell.drawing.getScreenCTM().inverse();
  const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix);
  const [left, top, w, h_] = cell.box;
  return [rounded(clamp(point.x, left, left + w), 2), rounded(clamp(point.y, top, top + h_), 2)];
}

function press(event, cell) {
  if (event.button !== 0 || !cell.pose.drawn) return;
  event.preventDefault();
  const group = event.target.closest('.mark');
  if (group) return dragMark(event, cell, group.dataset.landmark || null);
  propose(cell, placeUnder(event, cell));
}

function dragMark(event, cell, name) {
  const start = [event.clientX, event.clientY];
  const drag = name === null ? null : new Drag(`move landmark '${name}'`);
  const pose = cell.pose.name;
  let moved = false;
  if (name !== null) choose(name);
  cell.drawing.setPointerCapture(event.pointerId);
  follow({ currentTarget: cell.drawing, pointerId: event.pointerId }, (next, ended) => {
    moved ||= Math.hypot(next.clientX - start[0], next.clientY - start[1]) > 3;
    if (moved) {
      const at = placeUnder(next, cell);
      const ops = [{ op: 'move_landmark', landmark: name, at: { [pose]: at } }];
      if (name === null) fresh.at[pose] = at;
      else {
        dragging = true;
        holding = { name, cell: cell.index, at };
        if (!ended) drag.to(ops);
      }
      if (ended && drag) {
        dragging = false;
        drag.end(ops).then(() => {
          holding = null;
          read();
        });
      }
    }
    draw();
  });
}

/** Where a new landmark would lie on all poses. */
async function propose(cell, at) {
  chosen = null;
  if (!(store.state.revisions.shape > 0)) {
    fresh = { kind: 'outline', at: Object.fromEntries(data.poses.filter((pose) => pose.drawn).map((pose) => [pose.name, at])) };
  } else {
    try {
      const answer = await postJson('carry', { layer: store.layer, pose: cell.pose.name, at });
      const drawn = new Set(data.poses.filter((pose) => pose.drawn).map((pose) => pose.name));
      const all = answer.poses.map((name, k) => [name, answer.at[k]]).filter(([name, place]) => drawn.has(name) && place);
      fresh = { kind: answer.kind, at: Object.fromEntries(all.map(([name, place]) => [name, place.map((v) => rounded(v, 2))])) };
    } catch (error) {
      emit('refused', error.problem ?? { message: error.message });
      return;
    }
  }
  draw();
  drawList();
}

const tray = h('div', { class: 'floating hidden', role: 'group', 'aria-label': 'New landmark' });
const nameField = h('input', { type: 'text', placeholder: 'Name (optional)', 'aria-label': 'Name of the new landmark', onkeydown: (event) => {
  event.stopPropagation();
  if (event.key === 'Enter') addFresh();
  if (event.key === 'Escape') escapeMatches();
} });
tray.append(h('span', {}, icon('key')), h('span', { class: 'faint hint' }, 'Drag the markers to where they belong.'), nameField,
  h('button', { type: 'button', onclick: () => escapeMatches() }, 'Cancel'),
  h('button', { type: 'button', class: 'main', id: 'add-landmark', onclick: () => addFresh() }, 'Add landmark'));
const drawTray = () => tray.classList.toggle('hidden', !fresh);

export async function addFresh() {
  if (!fresh) return false;
  const layered = store.scene.layers.length > 1 ? { layer: store.scene.layers[store.layer].name } : {};
  const name = nameField.value.trim();
  const known = new Set(store.scene.landmarks.map((landmark) => landmark.name));
  const state = await edit([{ op: 'add_landmark', at: fresh.at, ...layered, ...(name ? { name } : {}) }], 'add a landmark');
  if (!state) return true;
  fresh = null;
  nameField.value = '';
  chosen = store.scene.landmarks.find((landmark) => !known.has(landmark.name))?.name ?? null;
  read();
  return true;
}

export function escapeMatches() {
  if (!fresh && !chosen) return false;
  fresh = null;
  chosen = null;
  draw();
  drawList();
  return true;
}

function choose(name) {
  chosen = name;
  draw();
  drawList();
  landmarksPanel.querySelector('.opened')?.scrollIntoView({ block: 'nearest' });
}

// The list of landmarks.

function drawList() {
  const landmarks = store.scene.landmarks.filter((landmark) => (landmark.layer ?? 0) === store.layer);
  const several = store.puppet?.layers.length > 1;
  const layers = several ? h('select', { 'aria-label': 'Layer', onchange: (event) => { store.layer = Number(event.target.value); fresh = null; read(); } },
    store.puppet.layers.map((layer, k) => h('option', { value: k, selected: k === store.layer }, layer.name))) : null;
  const items = landmarks.map((landmark) => {
    const own = landmark.name === chosen;
    const count = Object.keys(landmark.at).length;
    const item = h('div', { class: `item${own ? ' chosen' : ''}` },
      h('button', { type: 'button', class: 'grow name clip', 'aria-pressed': String(own), onclick: () => { look({ main: 'matches' }); choose(landmark.name); } }, landmark.name),
      h('span', { class: 'faint small', title: 'poses that say where it is' }, landmark.path ? 'line' : `${count}/${data?.poses.filter((pose) => pose.drawn).length ?? count}`),
      iconButton('trash', `Remove landmark ${landmark.name}`, () => edit([{ op: 'remove_landmark', landmark: landmark.name }], `remove landmark '${landmark.name}'`)));
    const problems = problemsOf('landmark', null, landmark.name);
    return own ? h('div', { class: 'opened' }, item, problems, details(landmark)) : h('div', {}, item, problems);
  });
  const unplaced = (store.state?.problems ?? []).filter((problem) => problem.where === 'mapping');
  const suggestions = (data?.suggestions ?? []).map(({ pose, from, to, cost }) => h('p', { class: 'small' }, `${data.poses.find((p) => p.pose === pose)?.name ?? data.poses[pose]?.name ?? ''}: between ${from + 1} and ${to + 1}`, h('span', { class: 'faint' }, ` (${cost.toFixed(1)})`)));
  landmarksPanel.replaceChildren(...[
    h('section', { class: 'section' },
      several ? h('div', { class: 'row' }, h('span', { class: 'label' }, 'Layer'), layers) : null,
      h('p', { class: 'faint small' }, 'Open Matches and click on a drawing to add a landmark to all poses.'),
      unplaced.length > 0 ? problemsOf('mapping') : null,
      h('div', { class: 'list' }, items)),
    suggestions.length > 0 ? h('section', { class: 'section' }, h('h3', {}, 'A landmark would help'), suggestions) : null,
  ].filter(Boolean));
}

function details(landmark) {
  const rename = h('input', { type: 'text', value: landmark.name, 'aria-label': 'Name of the landmark', onkeydown: (event) => event.stopPropagation(), onchange: async (event) => {
    const name = event.target.value.trim();
    if (!name || name === landmark.name) return;
    if (await edit([{ op: 'rename_landmark', landmark: landmark.name, name }], `rename landmark '${landmark.name}'`)) chosen = name;
    drawList();
  } });
  const poses = Object.keys(landmark.at).map((pose) => h('div', { class: 'row small' }, h('span', { class: 'label' }, pose),
    h('span', { class: 'faint grow' }, landmark.path ? 'line' : landmark.at[pose].map((v) => rounded(v, 1)).join(', ')),
    iconButton('close', `Let the match place ${landmark.name} on ${pose}`, () => edit([{ op: 'unset_landmark', landmark: landmark.name, pose }], `free landmark '${landmark.name}' on '${pose}'`))));
  return h('div', { class: 'details' }, rename, ...poses);
}

export function setMesh(value) {
  showMesh = value;
  draw();
}

on('view', (changes) => {
  root.classList.toggle('hidden', store.view.main !== 'matches');
  showMesh = store.view.mesh;
  if ('main' in changes && store.view.main === 'matches') {
    arrange();
    read();
  } else draw();
});
on('shape', read);
on('scene', () => {
  if (!dragging && data) drawList();
  if (!data) read();
  draw();
});
on('state', () => {
  if (store.scene && !landmarksPanel.contains(document.activeElement)) drawList();
  draw();
});
new ResizeObserver(arrange).observe(root);
