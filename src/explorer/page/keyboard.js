// @ts-check
// Keys that work wherever the focus is, but in fields; and the list of them.
import { h, targetOf } from './dom.js';
import { iconButton } from './controls.js';
import { copyCommand, openExport } from './export.js';
import { arm, isArmed } from './recorder.js';
import { addFresh, escapeMatches } from './marking.js';
import { compare } from './inspector.js';
import { goTo, nudge } from './pad.js';
import { actualSize, fit, zoomBy } from './view.js';
import { asked, look, store } from './state.js';
import { escapeGesture, play, stepFrame } from './timeline.js';

/** @type {<T>(values: T[], value: T) => T} */
const cycle = (values, value) => values[(values.indexOf(value) + 1) % values.length];

/**
 * [keys as they are shown, what they do, match, action]
 * @type {[string[], string, ((event: Pick<KeyboardEvent, 'key' | 'code'>) => boolean) | null, ((event: KeyboardEvent) => void)?][]}
 */
const KEYS = [
  [['←', '↑', '↓', '→'], 'Move the probe; with Shift, finely', null],
  [['1', '…', '9'], 'Go to a pose', null],
  [['Home'], 'Go to the first pose', (e) => e.key === 'Home', () => goTo(store.scene.poses[0])],
  [['Space'], 'Play or pause', (e) => e.key === ' ', () => play()],
  [[',', '.'], 'One frame back or on', (e) => e.key === ',' || e.key === '.', (e) => stepFrame(e.key === ',' ? -1 : 1)],
  [['R'], 'Record a gesture', (e) => e.key === 'r', () => arm(!isArmed())],
  [['M'], 'Mesh', (e) => e.key === 'm', () => look({ mesh: !store.view.mesh })],
  [['P'], 'The place under the pointer, in all drawings', (e) => e.key === 'p', () => look({ places: !store.view.places })],
  [['O'], 'Onion skin: off, poses, path', (e) => e.key === 'o', () => look({ onion: cycle(['off', 'poses', 'path'], store.view.onion) })],
  [['W'], 'The plane shows: nothing, weight, validity', (e) => e.key === 'w',
    () => look({ map: cycle(['plain', 'weight', 'validity'], store.view.map) })],
  [['S'], 'Snap', (e) => e.key === 's', () => look({ snap: !store.view.snap })],
  [['B'], 'Compare: hold for B', null],
  [['Tab', 'V'], 'Picture, matches or drawings', (e) => e.key === 'v',
    () => look({ main: cycle(['picture', 'matches', 'drawings'], store.view.main) })],
  [['L'], 'New landmarks: points or lines', (e) => e.key === 'l', () => look({ mark: store.view.mark === 'line' ? 'point' : 'line' })],
  [['0'], 'Fit; with Shift, actual size', (e) => e.code === 'Digit0', (e) => (e.shiftKey ? actualSize() : fit())],
  [['+', '−'], 'Zoom', (e) => ['+', '=', '-'].includes(e.key), (e) => zoomBy(e.key === '-' ? 0.8 : 1.25)],
  [['C'], 'Copy as command', (e) => e.key === 'c', () => copyCommand()],
  [['E'], 'Export', (e) => e.key === 'e', () => openExport()],
  [['←', '↑', '↓', '→', 'Space'], 'On a drawing of the matches: move a cross; put a landmark or the next point of a line there', null],
  [['←', '↑', '↓', '→'], 'On the picture: move a cross, whose place is shown in all drawings', null],
  [['Tab', 'Enter'], 'On the drawings: go from part to part; leave it out or take it back', null],
  [['Enter'], 'End the line; add the new landmark', null],
  [['Ctrl', 'Z'], 'Undo; with Shift, redo', null],
  [['?'], 'This list', (e) => e.key === '?', () => openKeys()],
];
KEYS.find(([keys]) => keys[1] === 'V')?.[0].shift();

const dialog = h('dialog', { class: 'dialog keys-dialog', 'aria-label': 'Keys' },
  h('header', {}, h('h2', {}, 'Keys'), h('span', { class: 'grow' }), iconButton('close', 'Close', () => dialog.close())),
  h('dl', {}, KEYS.flatMap(([keys, text]) => [h('dt', {}, keys.map((key) => h('kbd', {}, key))), h('dd', {}, text)])));
document.body.append(dialog);
dialog.addEventListener('click', (event) => event.target === dialog && dialog.close());

export const openKeys = () => dialog.showModal();

/** @type {(target: HTMLElement) => Element | null} */
const inField = (target) => target.closest?.('input:not([type="range"], [type="checkbox"]), select, textarea, dialog');

window.addEventListener('keydown', (event) => {
  const modified = event.ctrlKey || event.metaKey;
  const isUndo = modified && !event.altKey && ['z', 'y', 'Z'].includes(event.key);
  if (isUndo && !document.querySelector('dialog[open]') && /** @type {HTMLInputElement} */ (event.target).type !== 'text') {
    event.preventDefault();
    const redo = event.key === 'y' || event.shiftKey;
    if (redo ? store.state?.redo : store.state?.undo) asked(redo ? 'redo' : 'undo', {});
    return;
  }
  if (modified || event.altKey || inField(targetOf(event)) || !store.scene?.poses.length) return;
  if (event.key === 'Escape') {
    if (escapeMatches() || escapeGesture()) event.preventDefault();
    return;
  }
  if (event.key === ' ' && targetOf(event).closest('button:not(.probe), [role="tab"]')) return;
  if (event.key === 'Enter' && !targetOf(event).closest('button')) {
    addFresh();
    return;
  }
  if (event.key.toLowerCase() === 'b' && !event.repeat) {
    compare(!store.view.compare);
    return;
  }
  const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
  if (way) {
    event.preventDefault();
    nudge(way, event.shiftKey);
    return;
  }
  const digit = /^Digit([1-9])$/.exec(event.code);
  const numbered = digit && !event.shiftKey ? store.scene.poses[Number(digit[1]) - 1] : null;
  if (numbered) {
    goTo(numbered);
    return;
  }
  const pressed = { key: event.key.length === 1 ? event.key.toLowerCase() : event.key, code: event.code };
  const bound = KEYS.find(([, , match]) => match?.(pressed));
  if (!bound) return;
  event.preventDefault();
  bound[3]?.(event);
});
window.addEventListener('keyup', (event) => {
  if (event.key.toLowerCase() === 'b' && !inField(targetOf(event)) && store.view.compare) compare(false);
});
