// @ts-check
// The frame itself, where drawings are carried as curves: once the probe rests, what is rendered takes the place of the pixels.
import { query } from './api.js';
import { h } from './dom.js';
import { instead } from './frames.js';
import { Newest } from './newest.js';
import { on, store } from './state.js';

/** @import { Grid } from './painter.js' */

/** Milliseconds without another frame after which the probe rests. */
const RESTS_AFTER = 90;

export const curves = h('img', { class: 'curves hidden', alt: '', 'aria-hidden': 'true', draggable: 'false' });
let resting = 0;
const requests = new Newest();

const isWanted = () => store.view.main === 'picture' && store.view.onion === 'off' && !store.view.mesh && store.view.tool !== 'bend' &&
  store.frame?.layers.length > 0 && (store.puppet?.layers ?? []).some((layer) => layer.curves);

/** @type {(value: boolean) => void} */
function show(value) {
  curves.classList.toggle('hidden', !value);
  curves.parentElement?.classList.toggle('curved', value);
}

/** The pixels are shown again, until the probe rests. */
function hide() {
  requests.begin();
  show(false);
  clearTimeout(resting);
  if (isWanted()) resting = setTimeout(load, RESTS_AFTER);
}

async function load() {
  const mine = requests.begin();
  const { frame } = store;
  curves.src = `api/curves${query({ at: frame.place, ...instead() })}&v=${frame.shape}.${frame.revision}`;
  try {
    await curves.decode();
  } catch {
    return;
  }
  if (!requests.is(mine) || frame !== store.frame || !isWanted()) return;
  show(true);
  document.documentElement.dataset.curves = frame.place.join(',');
}

/**
 * Lays it where the frame is.
 * @type {(corner: Grid, size: number[]) => void}
 */
export function placeCurves({ scale, x, y }, [width, height]) {
  curves.style.transform = `translate(${x}px, ${y}px)`;
  curves.style.width = `${width * scale}px`;
  curves.style.height = `${height * scale}px`;
}

on('frame view scene shape', hide);
