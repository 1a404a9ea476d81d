// @ts-check
// What was taken for the figure of each drawing, asked for while the sheets are shown.
import { getJson, problemOf } from './api.js';
import { Newest } from './newest.js';
import { emit, on, store } from './state.js';

/** @import { Figure } from './answers.js' */

/**
 * By pose: `api/figure`.
 * @type {Map<number, Figure>}
 */
export const figures = new Map();

/** Whether each layer has drawings of its own: loose parts are layers, too, but on one sheet. */
export const isLayered = () => store.scene.poses.some((pose) => pose.kind === 'layered');

/** The layer whose sheets are shown. */
export const layerOfSheets = () => (isLayered() ? store.layer : 0);

/** The poses with a sheet of their own. */
export function posesWithSheets() {
  const layer = store.scene.layers[layerOfSheets()];
  const all = store.scene.poses.map((_, pose) => pose);
  return all.filter((pose) => store.scene.poses[pose].kind !== 'deformed' && (!isLayered() || layer?.poses.includes(pose)));
}

let asked = '';
const reads = new Newest();
async function read() {
  if (store.view.main !== 'drawings' || !store.scene?.poses.length) return;
  const { revisions } = store.state;
  const now = JSON.stringify([layerOfSheets(), revisions.scene, revisions.pictures]);
  if (now === asked) return;
  asked = now;
  const mine = reads.begin();
  const poses = posesWithSheets();
  const found = await Promise.all(poses.map((pose) => getJson('figure', { layer: layerOfSheets(), pose }).catch((error) => {
    emit('refused', problemOf(error));
    return null;
  })));
  if (!reads.is(mine)) return;
  figures.clear();
  poses.forEach((pose, k) => found[k] && figures.set(pose, found[k]));
  emit('figures');
}

on('state view layer', read);
