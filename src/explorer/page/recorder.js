// @ts-check
// Samples of the pointer while a gesture is recorded: armed, then from the press to the release.
import { emit } from './state.js';

/** @import { Place } from './answers.js' */

let armed = false;
/** @type {number[][] | null} */
let samples = null;
let begun = 0;

export const isArmed = () => armed;
export const recording = () => samples !== null;

/** @type {(value: boolean) => void} */
export function arm(value) {
  armed = value;
  samples = null;
  emit('recording');
}

/** @type {(time: number, place: Place) => void} */
export function recordStart(time, place) {
  if (!armed) return;
  begun = time;
  samples = [[0, ...place]];
  emit('recording');
}

/** @type {(time: number, place: Place) => void} */
export function recordSample(time, place) {
  if (!samples) return;
  const t = Math.max(0, (time - begun) / 1000);
  const last = samples[samples.length - 1];
  if (t > last[0]) samples.push([t, ...place]);
  else if (t === last[0]) samples[samples.length - 1] = [t, ...place];
}

export function recordStop() {
  const recorded = samples ?? [];
  armed = false;
  samples = null;
  emit('recording');
  if (recorded.length > 1) emit('recorded', recorded);
}
