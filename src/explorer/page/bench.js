// @ts-check
// `?bench`: what a drag costs here, measured by the page: request, answer, drawing, displayed frames.
import { getWords, readFrames } from './api.js';
import { byId, h } from './dom.js';
import { outlines, settled, wantFrame } from './frames.js';
import { drawNow } from './picture.js';
import { Drag, look, moveTo, on, store } from './state.js';

/** @import { Place } from './answers.js' */

const REQUESTS = 300;
const DRAWINGS = 60;
const SECONDS = 5;
const LANDMARKS = 12;

/** @type {(values: number[]) => number[]} */
const sorted = (values) => values.slice().sort((a, b) => a - b);
/** @type {(values: number[], part: number) => number} */
const quantile = (values, part) => sorted(values)[Math.min(values.length - 1, Math.floor(part * values.length))];
/** @type {(values: number[]) => string} */
const shown = (values) => `${quantile(values, 0.5).toFixed(2)} ms (95 %: ${quantile(values, 0.95).toFixed(2)} ms)`;

/**
 * A place on a curve that passes through the whole box.
 * @type {(t: number) => Place}
 */
function along(t) {
  const { box, dimension, poses } = store.scene;
  if (!box || dimension !== 2) return poses[Math.floor(t) % poses.length].at;
  const [[x0, y0], [x1, y1]] = box;
  return [0.5 * (x0 + x1) + 0.5 * (x1 - x0) * Math.sin(2.3 * t), 0.5 * (y0 + y1) + 0.5 * (y1 - y0) * Math.sin(3.1 * t + 0.5)];
}

/** Moves landmarks, one after the other, until the match and the mesh are there again; leaves the scene as it was. */
async function moveLandmarks() {
  const { landmarks, poses } = store.scene;
  const movable = landmarks.filter((landmark) => !landmark.path).filter((landmark) => (landmark.layer ?? 0) === store.layer);
  /** @type {number[]} */
  const times = [];
  if (movable.length === 0) return times;
  const opened = once('matched', () => true);
  look({ main: 'matches' });
  await opened;
  await rest();
  for (let k = 0; k < LANDMARKS; k++) {
    const { name, at } = movable[Math.floor((k * movable.length) / LANDMARKS)];
    const pose = Object.keys(at).find((own) => poses.some((other) => other.name === own)) ?? '';
    const [x, y] = at[pose];
    const drag = new Drag('measure');
    const before = store.state.revisions.shape;
    const seen = once('matched', (shape) => Number(shape) > before);
    const started = performance.now();
    drag.to([{ op: 'move_landmark', landmark: name, at: { [pose]: [x + 1.5, y + 0.5] } }]);
    if (await seen) times.push(performance.now() - started);
    const shape = store.state.revisions.shape;
    await drag.cancel();
    for (let wait = 0; wait < 40 && store.state.revisions.shape === shape; wait++) await new Promise((go) => setTimeout(go, 50));
    await rest();
  }
  look({ main: 'picture' });
  return times;
}

/**
 * Until an event that is meant; false if none comes.
 * @type {(name: 'drawn' | 'matched', isMeant: (shape: number | void) => boolean, patience?: number) => Promise<boolean>}
 */
function once(name, isMeant, patience = 5000) {
  return new Promise((done) => {
    /** @type {(came: boolean) => void} */
    const end = (came) => {
      stop();
      clearTimeout(giveUp);
      done(came);
    };
    const stop = on(name, (detail) => isMeant(detail) && end(true));
    const giveUp = setTimeout(() => end(false), patience);
  });
}

/** What follows a change when nobody drags (the camera is found anew, pictures are drawn) is over soon. */
const rest = () => new Promise((go) => setTimeout(go, 400));

/** @type {() => Promise<number>} */
const displayed = () => new Promise((done) => requestAnimationFrame(done));

export async function measure() {
  // A page may open before its scene is mapped.
  if (!(store.pixel > 0)) await once('drawn', () => true, 600_000);
  const table = h('table', {});
  const dialog = h('dialog', { class: 'dialog bench', 'aria-label': 'Measurements' }, h('header', {}, h('h2', {}, 'Measurements')), table);
  document.body.append(dialog);
  /** @type {(name: string, value: string) => void} */
  const say = (name, value) => table.append(h('tr', {}, h('th', { scope: 'row' }, name), h('td', {}, value)));
  /** @type {Record<string, unknown>} */
  const result = { painter: byId('picture').dataset.painter };
  /** @type {(of: 'vertices' | 'triangles') => number} */
  const total = (of) => store.puppet.layers.reduce((sum, layer) => sum + layer[of], 0);
  const counts = `${total('vertices')} vertices, ${total('triangles')} triangles, ${store.scene.poses.length} poses`;
  say('Scene', `${store.scene.name}: ${counts}`);
  const { width, height, dataset } = byId('picture');
  say('Canvas', `${width} × ${height} pixels, painted by the ${dataset.painter === 'card' ? 'graphics card' : 'processor'}`);

  /** @type {number[]} */
  const requests = [];
  let bytes = 0;
  for (let k = 0; k < REQUESTS; k++) {
    const started = performance.now();
    const words = await getWords('frame', { at: along(k / 20), ...outlines() });
    readFrames(words);
    requests.push(performance.now() - started);
    bytes = words.whole.byteLength;
  }
  result.request = { median: quantile(requests, 0.5), high: quantile(requests, 0.95), bytes };
  say('Request to frame', `${shown(requests)}, ${(bytes / 1024).toFixed(1)} KB`);

  await settled();
  /** @type {number[]} */
  const drawings = [];
  for (let k = 0; k < DRAWINGS; k++) {
    const started = performance.now();
    drawNow();
    drawings.push(performance.now() - started);
    await displayed();
  }
  result.drawing = { median: quantile(drawings, 0.5), high: quantile(drawings, 0.95) };
  say('Drawing a frame', shown(drawings));

  // What a drag does: a new place each displayed frame; how many are drawn, and how late.
  /** @type {Map<string, number>} */
  const moved = new Map();
  /** @type {number[]} */
  const latencies = [];
  let drawn = 0;
  let counting = true;
  on('drawn', () => {
    const key = store.frame.place.join(',');
    if (!counting || !moved.has(key)) return;
    latencies.push(performance.now() - (moved.get(key) ?? NaN));
    moved.delete(key);
    drawn++;
  });
  const begun = performance.now();
  let displays = 0;
  while (performance.now() - begun < SECONDS * 1000) {
    const place = along((performance.now() - begun) / 900);
    moved.set(place.map((v) => v).join(','), performance.now());
    moveTo(place);
    await displayed();
    displays++;
  }
  counting = false;
  const seconds = (performance.now() - begun) / 1000;
  const latency = { median: quantile(latencies, 0.5), high: quantile(latencies, 0.95) };
  result.drag = { drawn: drawn / seconds, displayed: displays / seconds, latency };
  say('While dragging', `${(drawn / seconds).toFixed(1)} frames a second drawn, ${(displays / seconds).toFixed(1)} displayed`);
  say('From moving to drawn', shown(latencies));
  wantFrame();
  const matches = await moveLandmarks();
  if (matches.length > 0) {
    result.landmark = { median: quantile(matches, 0.5), high: quantile(matches, 0.95) };
    say('From moving a landmark to the new match and mesh', shown(matches));
  }
  dialog.append(h('output', { class: 'hidden', id: 'bench-result' }, JSON.stringify(result)));
  dialog.showModal();
}
