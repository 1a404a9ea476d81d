// @ts-check
// The timeline: play, scrub, record a gesture, smooth and retime it, save it into the scene.
import { postJson, problemOf } from './api.js';
import { byId, clamp, follow, fixed, found, h, targetOf, updateAll } from './dom.js';
import { arm, isArmed, recording } from './recorder.js';
import { iconButton, numberField, slider, toggle } from './controls.js';
import { icon } from './icons.js';
import { Newest } from './newest.js';
import { edit, emit, moveTo, on, onChange, rounded, store } from './state.js';
import { showPath } from './pad.js';

/** @import { Path, Place } from './answers.js' */

/**
 * What `api/gesture` is asked with.
 * @typedef {{ smoothing: number, tolerance: number, duration: number | null, loop: boolean }} Settings
 */

const root = byId('timeline');

/** @type {Path | null} */
let path = null; // of api/path
let playing = false;
let loops = false;
let time = 0;
/** @type {Settings} */
let settings = { smoothing: 0.06, tolerance: 0.01, duration: null, loop: false };

const duration = () => path?.duration ?? 0;

/**
 * The place at a time: between the frames that the server has computed, straight, or the last one's if they are held.
 * @type {(path: Path, t: number) => Place}
 */
function placeAt(path, t) {
  const { at, fps, start = 0 } = path;
  const here = clamp((t - start) * fps, 0, at.length - 1);
  // Rounding must not show the frame before.
  if (path.held) return at[Math.floor(here + 1e-6)];
  const [k, part] = [Math.floor(here), here % 1];
  const next = at[Math.min(k + 1, at.length - 1)];
  return at[k].map((value, d) => value + part * (next[d] - value));
}

/** Whether it is the timeline that moves the probe. */
let leads = false;

/** @type {(t: number) => void} */
function seek(t) {
  time = clamp(t, 0, duration());
  leads = true;
  if (path?.at.length) moveTo(placeAt(path, time + (path.start ?? 0)).map((v) => rounded(v, 6)));
  leads = false;
  drawHead();
}

// Playing.

let last = 0;
/** @type {(now: number) => void} */
function tick(now) {
  if (!playing) return;
  let next = time + Math.min((now - last) / 1000, 0.25);
  last = now;
  if (next >= duration()) {
    if (loops && duration() > 0) next %= duration();
    else {
      seek(duration());
      return play(false);
    }
  }
  seek(next);
  requestAnimationFrame(tick);
}

/** @type {(value?: boolean) => void} */
export function play(value = !playing) {
  if (value && duration() <= 0) return;
  playing = value;
  if (playing) {
    if (time >= duration() - 1e-6) time = 0;
    last = performance.now();
    requestAnimationFrame(tick);
  }
  playButton.replaceChildren(icon(playing ? 'pause' : 'play'));
  playButton.setAttribute('aria-label', playing ? 'Pause' : 'Play');
}

/**
 * One frame on or back.
 * @type {(by: number) => void}
 */
export function stepFrame(by) {
  if (!path) return;
  play(false);
  seek(time + by / path.fps);
}

// Parts.

const playButton = iconButton('play', 'Play', () => play(), { id: 'play', title: 'Play or pause (Space)' });
const recordButton = iconButton('record', 'Record a gesture', () => arm(!isArmed()), {
  id: 'record', class: 'square record', title: 'Record: then drag through the plane (R)',
});
const loopButton = toggle('loop', 'Loop', () => loops, (value) => {
  loops = value;
  if (store.gesture) resolve({ loop: value });
  loopButton.update();
});
const clock = h('span', { class: 'clock' });
const marks = h('div', { class: 'marks' });
const head = h('div', { class: 'playhead' });
const track = h('div', {
  class: 'track', id: 'scrub', role: 'slider', tabindex: '0', 'aria-label': 'Time', 'aria-valuemin': '0',
}, marks, head);
track.addEventListener('pointerdown', (event) => {
  if (event.button !== 0 || !path) return;
  play(false);
  /** @type {(next: PointerEvent) => void} */
  const to = (next) => {
    const box = track.getBoundingClientRect();
    seek(((next.clientX - box.left) / box.width) * duration());
  };
  to(event);
  follow(event, to);
});
track.addEventListener('keydown', (event) => {
  const by = { ArrowLeft: -1, ArrowRight: 1, PageDown: -10, PageUp: 10 }[event.key];
  const end = { Home: 0, End: duration() }[event.key];
  if (by === undefined && end === undefined) return;
  event.preventDefault();
  event.stopPropagation();
  if (by !== undefined) stepFrame(by);
  else if (end !== undefined) seek(end);
});
const hint = h('span', { class: 'hint faint' });
const tools = h('div', { class: 'gesture hidden' });
root.append(h('div', { class: 'transport' }, recordButton, playButton, loopButton, clock, track),
  h('div', { class: 'under' }, hint, tools));

function drawHead() {
  const part = duration() > 0 ? time / duration() : 0;
  head.style.left = `${100 * part}%`;
  clock.textContent = `${fixed(time, 2)} / ${fixed(duration(), 2)} s`;
  track.setAttribute('aria-valuemax', duration().toFixed(2));
  track.setAttribute('aria-valuenow', time.toFixed(2));
  track.setAttribute('aria-valuetext', `${time.toFixed(2)} of ${duration().toFixed(2)} seconds`);
}

function drawMarks() {
  const keys = store.gesture?.keys ?? store.scene?.animation?.keys ?? [];
  const start = keys[0]?.time ?? 0;
  marks.replaceChildren(...keys.map((key, index) => {
    const mark = h('span', { class: 'mark-key', title: `Key ${index + 1}: ${key.time} s` });
    mark.style.left = `${duration() > 0 ? (100 * (key.time - start)) / duration() : 0}%`;
    if (!store.gesture) mark.addEventListener('pointerdown', (event) => dragKey(event, index));
    return mark;
  }));
  root.classList.toggle('fresh', Boolean(store.gesture));
}

/**
 * Moves a key in time, between its neighbours.
 * @type {(event: PointerEvent, index: number) => void}
 */
function dragKey(event, index) {
  if (event.button !== 0) return;
  event.stopPropagation();
  const keys = (store.scene.animation?.keys ?? []).map((key) => ({ ...key }));
  const box = track.getBoundingClientRect();
  const start = keys[0].time;
  const total = duration();
  const low = index > 0 ? keys[index - 1].time + 0.01 : keys[0].time;
  const high = index + 1 < keys.length ? keys[index + 1].time - 0.01 : Infinity;
  let moved = false;
  follow(event, (next, ended) => {
    const t = rounded(clamp(start + ((next.clientX - box.left) / box.width) * total, low, high), 2);
    moved ||= Math.abs(next.clientX - event.clientX) > 3;
    if (moved && index > 0) {
      keys[index].time = t;
      targetOf(event).style.left = `${(100 * (t - start)) / total}%`;
    }
    if (!ended) return;
    if (moved && index > 0) edit([{ op: 'set_keys', keys }], 'move a key');
    else seek(keys[index].time - start);
  });
}

// The path of the scene or of the gesture.

async function readPath() {
  if (!store.scene?.animation) return;
  try {
    const body = store.gesture?.keys ? { keys: store.gesture.keys, loop: loops } : {};
    path = await postJson('path', body);
  } catch {
    path = null;
  }
  store.path = path?.at ?? [];
  showPath(store.path);
  time = clamp(time, 0, duration());
  drawMarks();
  drawHead();
  emit('path');
}

// Gestures.

const requests = new Newest();
/** @type {(changes?: Partial<Settings>) => Promise<void>} */
async function resolve(changes = {}) {
  settings = { ...settings, ...changes };
  if (!store.gesture) return;
  const mine = requests.begin();
  try {
    const answer = await postJson('gesture', { samples: store.gesture.samples, ...settings });
    if (!requests.is(mine) || !store.gesture) return;
    Object.assign(store.gesture, answer);
    emit('gesture');
    await readPath();
    drawGesture();
  } catch (error) {
    emit('refused', problemOf(error));
  }
}

let built = false;
function drawGesture() {
  tools.classList.toggle('hidden', !store.gesture);
  hint.classList.toggle('hidden', Boolean(store.gesture));
  root.classList.toggle('armed', isArmed());
  root.classList.toggle('recording', recording());
  recordButton.setAttribute('aria-pressed', String(isArmed() || recording()));
  hint.textContent = recording() ? 'Recording… let go to end the gesture.'
    : isArmed() ? 'Press in the plane and drag: the gesture is recorded as you make it.'
      : store.scene?.animation?.own_keys
        ? `${store.scene.animation.keys.length} keys. Drag one to move it in time; record to replace them, with their holds and spacing.`
        : 'The path visits every pose. Record a gesture, or add keys.';
  if (!store.gesture) {
    built = false;
    return;
  }
  if (!built) {
    built = true;
    tools.replaceChildren(
      slider('Smooth', { min: 0, max: 0.5, step: 0.01 },
        () => settings.smoothing, (v) => resolve({ smoothing: v }), (v) => resolve({ smoothing: v })),
      slider('Simplify', { min: 0.001, max: 0.05, step: 0.001, digits: 3 },
        () => settings.tolerance, (v) => resolve({ tolerance: v }), (v) => resolve({ tolerance: v })),
      h('label', { class: 'field' }, h('span', {}, 'Seconds'), numberField('Duration in seconds', () => rounded(duration(), 2),
        (v) => v > 0 && resolve({ duration: v }), { step: 0.1, digits: 2, id: 'gesture-seconds' })),
      h('span', { class: 'keys faint' }), h('span', { class: 'grow' }),
      h('button', { type: 'button', onclick: discard }, 'Discard'),
      h('button', { type: 'button', class: 'main', id: 'save-gesture', onclick: keep }, 'Save to scene'));
  }
  const count = found(tools, '.keys');
  if (count) count.textContent = store.gesture.keys ? `${store.gesture.keys.length} keys` : '';
  updateAll(tools, 'input, .slider');
}

function discard() {
  store.gesture = null;
  emit('gesture');
  readPath();
  drawGesture();
}

async function keep() {
  const keys = store.gesture?.keys;
  if (!keys) return;
  const written = keys.map((key) => ({ time: rounded(key.time, 3), at: key.at.map((v) => rounded(v)) }));
  const state = await edit([{ op: 'set_keys', keys: written, loop: loops }], 'record a gesture');
  if (state) discard();
}

export function escapeGesture() {
  if (isArmed()) arm(false);
  else if (store.gesture) discard();
  else return false;
  return true;
}

// Whoever takes the probe, or bends a pose where it is, takes it from the playback.
on('place', () => {
  if (playing && !leads) play(false);
});
on('view', ({ tool }) => {
  if (playing && tool === 'bend') play(false);
});
on('recorded', (samples) => {
  store.gesture = { samples };
  settings.duration = null;
  time = 0;
  resolve({ loop: loops }).then(() => play(true));
});
on('recording', () => {
  if (recording()) play(false);
  drawGesture();
});
let first = true;
onChange('scene', () => store.scene.animation, () => {
  if (first || !store.gesture) loops = Boolean(store.scene.animation?.loop);
  first = false;
  loopButton.update();
  readPath();
  drawGesture();
});
