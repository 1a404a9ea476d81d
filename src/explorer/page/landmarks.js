// @ts-check
// The list of landmarks: names, places as numbers, what would help.
import { iconButton, numberField } from './controls.js';
import { focused, found, h } from './dom.js';
import { landmarksPanel, problemsOf } from './inspector.js';
import { choose, drawnPoses, match, ownLandmarks } from './match.js';
import { edit, emit, look, on, rounded, store } from './state.js';

/** @import { Landmark, PointLandmark } from './answers.js' */
/** @import { FieldEvent } from './dom.js' */

let listed = '';
function drawList() {
  if (!store.scene) return;
  const { data, chosen } = match;
  const drawn = data ? drawnPoses().length : null;
  /** @type {(landmark: Landmark) => unknown[]} */
  const shown = ({ name, layer, path, at }) => [name, layer ?? 0, path, name === chosen ? at : Object.keys(at).length];
  const names = store.puppet?.layers.map((layer) => layer.name);
  const key = JSON.stringify([
    store.layer, chosen, store.scene.landmarks.map(shown), drawn, data?.suggestions, store.state?.problems, names,
  ]);
  if (key === listed) return;
  listed = key;
  const several = store.puppet?.layers.length > 1;
  /** @type {(event: FieldEvent) => void} */
  const chooseLayer = (event) => {
    store.layer = Number(event.target.value);
    match.fresh = null;
    emit('layer');
  };
  const layers = several ? h('select', { 'aria-label': 'Layer', onchange: chooseLayer },
    store.puppet.layers.map((layer, k) => h('option', { value: k, selected: k === store.layer }, layer.name))) : null;
  const items = ownLandmarks().map((landmark) => {
    const own = landmark.name === chosen;
    const count = Object.keys(landmark.at).length;
    const item = h('div', { class: `item${own ? ' chosen' : ''}` },
      h('button', { type: 'button', class: 'grow name clip', 'aria-pressed': String(own), onclick: () => {
        look({ main: 'matches' });
        choose(landmark.name);
      } }, landmark.name),
      h('span', { class: 'faint small', title: 'poses that say where it is' }, `${landmark.path ? 'line ' : ''}${count}/${drawn ?? count}`),
      iconButton('trash', `Remove landmark ${landmark.name}`,
        () => edit([{ op: 'remove_landmark', landmark: landmark.name }], `remove landmark '${landmark.name}'`)));
    const problems = problemsOf('landmark', null, landmark.name);
    return own ? h('div', { class: 'opened' }, item, problems, details(landmark)) : h('div', {}, item, problems);
  });
  const unplaced = (store.state?.problems ?? []).filter((problem) => problem.where === 'mapping');
  /** @type {(pose: number) => string} */
  const nameOf = (pose) => data.poses.find((p) => p.pose === pose)?.name ?? data.poses[pose]?.name ?? '';
  const suggestions = (data?.suggestions ?? []).map(({ pose, from, to, cost }) => h('p', { class: 'small' },
    `${nameOf(pose)}: between ${from + 1} and ${to + 1}`, h('span', { class: 'faint' }, ` (${cost.toFixed(1)})`)));
  const active = focused();
  const label = active && landmarksPanel.contains(active) ? active.getAttribute('aria-label') : null;
  /** @type {(HTMLElement | null)[]} */
  const sections = [
    h('section', { class: 'section' },
      several ? h('div', { class: 'row' }, h('span', { class: 'label' }, 'Layer'), layers) : null,
      h('p', { class: 'faint small' }, 'Open Matches and click on a drawing to add a landmark to all poses, or draw a line there.'),
      unplaced.length > 0 ? problemsOf('mapping') : null,
      h('div', { class: 'list' }, items)),
    suggestions.length > 0 ? h('section', { class: 'section' }, h('h3', {}, 'A landmark would help'), suggestions) : null,
  ];
  landmarksPanel.replaceChildren(...sections.filter((part) => part !== null));
  if (label) found(landmarksPanel, `[aria-label="${CSS.escape(label)}"]`)?.focus();
}

/** @type {(landmark: Landmark) => HTMLElement} */
function details(landmark) {
  const named = { type: 'text', value: landmark.name, 'aria-label': 'Name of the landmark' };
  const rename = h('input', { ...named, onkeydown: (event) => event.stopPropagation(), onchange: async (event) => {
    const name = event.target.value.trim();
    if (!name || name === landmark.name) return;
    if (await edit([{ op: 'rename_landmark', landmark: landmark.name, name }], `rename landmark '${landmark.name}'`)) choose(name);
  } });
  const poses = Object.keys(landmark.at).map((pose) => h('div', { class: 'row small' }, h('span', { class: 'label' }, pose),
    landmark.path ? h('span', { class: 'faint grow' }, `${landmark.at[pose].length} points`)
      : [0, 1].map((axis) => coordinate(landmark, pose, axis)),
    iconButton('close', `Let the match place ${landmark.name} on ${pose}`,
      () => edit([{ op: 'unset_landmark', landmark: landmark.name, pose }], `free landmark '${landmark.name}' on '${pose}'`))));
  return h('div', { class: 'details' }, rename, ...poses);
}

/** @type {(landmark: PointLandmark, pose: string, axis: number) => HTMLElement} */
function coordinate(landmark, pose, axis) {
  /** @type {(value: number) => void} */
  const move = (value) => {
    const at = landmark.at[pose].map((old, k) => (k === axis ? rounded(value, 2) : old));
    const { name } = landmark;
    edit([{ op: 'move_landmark', landmark: name, at: { [pose]: at } }], `move landmark '${name}'`, `landmark ${name} ${pose}`);
  };
  const field = numberField(`${'xy'[axis]} of ${landmark.name} on ${pose}`, () => landmark.at[pose][axis], move, { digits: 2, step: 1 });
  field.update();
  return field;
}

on('marks', () => {
  drawList();
  landmarksPanel.querySelector('.opened')?.scrollIntoView({ block: 'nearest' });
});
on('scene state', () => {
  if (!match.held && !landmarksPanel.querySelector('input[data-typed]')) drawList();
});
on('match', drawList);
