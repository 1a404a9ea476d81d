// @ts-check
// The inspector: the scene's settings, its landmarks, keys and problems, one tab each.
import { byId, focused, found, h } from './dom.js';
import { iconButton, menu, numberField, row, segments, slider } from './controls.js';
import { icon } from './icons.js';
import { readingPanel } from './reading.js';
import { choosePose, Drag, edit, look, moveTo, on, onChange, rounded, store } from './state.js';

/** @import { Op, Place, Problem } from './answers.js' */
/** @import { Child, Updated } from './dom.js' */
/** @import { Comparison } from './state.js' */

/** @typedef {NonNullable<Problem['where']>} Where */

const root = byId('inspector');
const TABS = [['scene', 'Scene'], ['landmarks', 'Landmarks'], ['keys', 'Keys'], ['problems', 'Problems']];
let current = 'scene';

const tabs = TABS.map(([name, label]) => h('button', {
  type: 'button', role: 'tab', id: `tab-${name}`, 'aria-controls': `panel-${name}`, 'data-tab': name, onclick: () => showTab(name),
}, label));
const list = h('div', { class: 'tabs', role: 'tablist', 'aria-label': 'Inspector' }, tabs);
list.addEventListener('keydown', (event) => {
  const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
  if (!by) return;
  event.preventDefault();
  event.stopPropagation();
  const next = tabs[(tabs.findIndex((tab) => tab.dataset.tab === current) + by + tabs.length) % tabs.length];
  showTab(next.dataset.tab ?? current);
  next.focus();
});
const panels = Object.fromEntries(TABS.map(([name]) => {
  const panel = h('div', { class: 'panel', role: 'tabpanel', id: `panel-${name}`, 'aria-labelledby': `tab-${name}`, tabindex: '-1' });
  return [name, panel];
}));
root.append(list, ...Object.values(panels));

/** @type {(name: string) => void} */
export function showTab(name) {
  current = name;
  for (const tab of tabs) {
    const chosen = tab.dataset.tab === name;
    tab.setAttribute('aria-selected', String(chosen));
    tab.tabIndex = chosen ? 0 : -1;
    panels[tab.dataset.tab ?? name].classList.toggle('hidden', !chosen);
  }
}
showTab('scene');

/** @type {(title: string, ...children: Child[]) => HTMLElement} */
const section = (title, ...children) => h('section', { class: 'section' }, h('h3', {}, title), ...children);
/** @type {(table: string, key: string, value: unknown) => Promise<unknown>} */
const setting = (table, key, value) => edit([{ op: 'set', table, key, value }], `set ${key.replaceAll('_', ' ')}`);

// The scene's settings. Built once a scene; afterwards only values change.

/** @type {Updated[]} */
const updated = [];
/** @type {<C extends Updated>(control: C) => C} */
const live = (control) => {
  updated.push(control);
  return control;
};

/**
 * A slider that shows its effect while it moves, and becomes one edit.
 * @type {(
 *   label: string, range: { min: number, max: number, step: number }, value: () => number, table: string, key: string,
 * ) => HTMLElement}
 */
function dragged(label, range, value, table, key) {
  /** @type {Drag | null} */
  let drag = null;
  /** @type {(value: number) => Op[]} */
  const op = (v) => [{ op: 'set', table, key, value: rounded(v) }];
  return live(slider(label, range, value, (v) => (drag ??= new Drag(`set ${key}`)).to(op(v)), (v) => {
    if (drag) drag.end(op(v));
    else edit(op(v), `set ${key}`);
    drag = null;
  }));
}

function buildScene() {
  const { scene } = store;
  updated.length = 0;
  /** @type {() => Partial<NonNullable<typeof scene.pose_space>>} */
  const space = () => store.scene.pose_space ?? {};
  const radial = live(menu('Radial function', [['b-spline', 'B-spline'], ['thin-plate', 'Thin plate']],
    () => space().radial, (v) => setting('pose_space', 'radial', v)));
  /** @type {(HTMLElement | null)[]} */
  const children = [
    problemsOf('file', 'space'),
    readingPanel,
    poseSection(),
    section('Weights',
      row('Provider', live(segments('Provider', [['biharmonic', 'Biharmonic'], ['rbf', 'Radial']],
        () => space().provider, (v) => setting('pose_space', 'provider', v)))),
      row('Radial', radial)),
    section('Shape',
      row('Stretch', live(segments('Stretch', [['linear', 'Linear'], ['limited', 'Limited'], ['log', 'Log']],
        () => store.scene.blend?.stretch, (v) => setting('blend', 'stretch', v)))),
      row('Folds', live(segments('Guard against folds', [['off', 'Leave'], ['repair', 'Repair']],
        () => store.scene.blend?.guard, (v) => setting('blend', 'guard', v))))),
    section('Texture',
      dragged('Sharpness', { min: 0, max: 1, step: 0.01 }, () => store.scene.texture?.sharpness ?? 0.5, 'texture', 'sharpness'),
      row('Colours', live(segments('Blending of colours', [['plain', 'As stored'], ['linear', 'Light']],
        () => store.scene.texture?.blending, (v) => setting('texture', 'blending', v)))),
      drawingRow()),
    section('Compare',
      h('p', { class: 'faint small' }, 'B is shown in place of the scene’s own settings while it is on. Hold B to flip.'),
      compareSection()),
    scene.dimension === 2 ? pseudoSection() : null,
  ];
  panels.scene.replaceChildren(...children.filter((part) => part !== null));
}

/** SVG drawings can be carried as curves, which are shown where the probe rests. */
function drawingRow() {
  if (!store.scene.poses.some((pose) => /\.svg$/i.test(pose.source ?? ''))) return null;
  const drawing = live(segments('Drawing', [['curves', 'Curves'], ['pixels', 'Pixels']],
    () => store.scene.texture?.drawing, (v) => setting('texture', 'drawing', v)));
  return [row('Drawing', drawing),
    h('p', { class: 'faint small' }, 'Curves are shown where the probe rests; while it moves, pixels.')];
}

// The pose that is looked at.

function poseSection() {
  const index = store.pose ?? -1;
  const pose = store.scene.poses[index];
  if (!pose) return null;
  const now = () => store.scene.poses[store.pose ?? -1];
  /** @type {(axis: number, value: number) => Promise<unknown>} */
  const move = (axis, value) => {
    const at = now().at.map((v, k) => (k === axis ? value : v));
    return edit([{ op: 'move_pose', pose: pose.name, at }], `move pose '${pose.name}'`);
  };
  const place = pose.at.map((_, d) =>
    live(numberField(`${pose.name}, ${'xyz'[d] ?? d}`, () => now()?.at[d] ?? 0, (value) => move(d, value))));
  const mirrored = h('input', {
    type: 'checkbox', 'aria-label': 'Mirrored', checked: pose.mirror === true, disabled: pose.kind !== 'drawn',
    onchange: ({ target }) =>
      edit([{ op: 'set_pose', pose: pose.name, key: 'mirror', value: target.checked }], `mirror pose '${pose.name}'`),
  });
  const remove = async () => {
    if (await edit([{ op: 'remove_pose', pose: pose.name }], `remove pose '${pose.name}'`)) choosePose(null);
  };
  const own = section(`Pose ${pose.name}`,
    row('Place', ...place),
    row('Mirrored', mirrored),
    pose.deform_of ? row('Bent from', h('span', {}, pose.deform_of))
      : row('Drawing', h('span', { class: 'clip', title: pose.source ?? '' }, pose.source ?? '–')),
    problemsOf('pose', null, pose.name),
    h('div', { class: 'buttons' },
      h('button', { type: 'button', class: 'bordered', onclick: () => moveTo(pose.at.slice()) }, 'Go there'),
      h('button', { type: 'button', class: 'bordered', onclick: remove }, 'Remove'),
      h('button', { type: 'button', onclick: () => choosePose(null) }, 'Done')));
  own.classList.add('of-pose');
  return own;
}

// A and B.

/** @type {Comparison} */
let other = { provider: 'rbf' };
/** @type {keyof Comparison} */
let compared = 'provider';

/** @type {(shown: boolean) => void} */
export function compare(shown) {
  look({ compare: shown ? { ...other } : null });
}

function compareSection() {
  /** @type {[keyof Comparison, string][]} */
  const settings = [['provider', 'Provider'], ['stretch', 'Stretch'], ['sharpness', 'Sharpness']];
  const what = menu('What B changes', settings, () => compared, (value) => {
    compared = value;
    const own = store.scene;
    /** @type {Record<keyof Comparison, Comparison>} */
    const others = {
      provider: { provider: own.pose_space?.provider === 'rbf' ? 'biharmonic' : 'rbf' },
      stretch: { stretch: own.blend?.stretch === 'log' ? 'linear' : 'log' },
      sharpness: { sharpness: (own.texture?.sharpness ?? 0) > 0.5 ? 0 : 1 },
    };
    other = others[value];
    if (store.view.compare) compare(true);
    draw();
  });
  const values = {
    provider: () => segments('Provider of B', [['biharmonic', 'Biharmonic'], ['rbf', 'Radial']],
      () => other.provider, (v) => change({ provider: v })),
    stretch: () => segments('Stretch of B', [['linear', 'Linear'], ['limited', 'Limited'], ['log', 'Log']],
      () => other.stretch, (v) => change({ stretch: v })),
    sharpness: () => slider('B', { min: 0, max: 1, step: 0.01 },
      () => other.sharpness ?? 0, (v) => change({ sharpness: v }), (v) => change({ sharpness: v })),
  };
  const place = h('div', {});
  /** @type {(value: Comparison) => void} */
  const change = (value) => {
    other = value;
    /** @type {(ChildNode & Updated) | null} */ (place.firstChild)?.update();
    if (store.view.compare) compare(true);
  };
  const draw = () => place.replaceChildren(values[compared]());
  draw();
  const ab = live(segments('Shown', [['a', 'A: scene'], ['b', 'B']],
    () => (store.view.compare ? 'b' : 'a'), (value) => compare(value === 'b')));
  ab.id = 'compare';
  return [row('Change', what), h('div', { class: 'indent' }, place), row('Show', ab)];
}

/** Where the probe is, as a scene says it. */
const probe = () => store.place.map((v) => rounded(v));

// Pseudo-poses.

function pseudoSection() {
  const { scene } = store;
  /** @type {(place: Place) => string} */
  const text = (place) => place.map((v) => rounded(v, 2)).join(', ');
  const shown = scene.pseudo_poses.map((pseudo, index) => h('div', { class: 'item' },
    h('span', { class: 'grow clip' }, `${text(pseudo.from)} → ${text(pseudo.at)}`),
    iconButton('trash', `Remove pseudo-pose ${index + 1}`, () => edit([{ op: 'remove_pseudo_pose', index }], 'remove a pseudo-pose'))));
  return section('Pseudo-poses',
    h('p', { class: 'faint small' }, 'A place that shows the weights of another one. Drag its ends in the plane.'),
    ...shown,
    h('div', { class: 'buttons' }, h('button', {
      type: 'button', class: 'bordered', id: 'add-pseudo',
      onclick: () => edit([{ op: 'add_pseudo_pose', from: probe(), at: probe() }], 'add a pseudo-pose'),
    }, icon('plus'), 'At the probe')));
}

// Keys.

/**
 * What a key says about the time of drawings, shortly.
 * @type {(key: import('./answers.js').Key) => string}
 */
const timingOf = ({ hold, spacing }) => [hold && `on ${['ones', 'twos', 'threes'][hold - 1]}`, spacing && `spaced ${spacing.join(' ')}`]
  .filter(Boolean).join(', ');

function buildKeys() {
  const { animation } = store.scene;
  if (!animation) return panels.keys.replaceChildren(h('p', { class: 'empty' }, 'There is no animation.'));
  const keys = animation.keys.map((key) => ({ ...key, at: key.at.slice() }));
  const closes = animation.loop && keys.length > 2 && keys[0].at.join() === keys[keys.length - 1].at.join();
  /** @type {(label: string) => Promise<unknown>} */
  const changed = (label) => {
    const sorted = keys.slice().sort((a, b) => a.time - b.time);
    // The first key has no way that a chart could space.
    delete sorted[0]?.spacing;
    return edit([{ op: 'set_keys', keys: sorted }], label);
  };
  const rows = keys.map((key, index) => h('tr', {},
    h('td', {}, numberField(`Time of key ${index + 1}`, () => key.time, (value) => {
      key.time = value;
      changed('move a key');
    }, { digits: 3, step: 0.05 })),
    ...key.at.map((_, d) => h('td', {}, numberField(`${'xyz'[d] ?? d} of key ${index + 1}`, () => key.at[d], (value) => {
      // A loop that ends where it begins still does.
      if (closes && (index === 0 || index === keys.length - 1)) [keys[0], keys[keys.length - 1]].forEach((end) => (end.at[d] = value));
      key.at[d] = value;
      changed('move a key');
    }))),
    h('td', { class: 'faint small' }, timingOf(key)),
    h('td', {}, iconButton('reach', `Go to key ${index + 1}`, () => moveTo(key.at.slice()))),
    h('td', {}, iconButton('trash', `Remove key ${index + 1}`, () => { keys.splice(index, 1); changed('remove a key'); }))));
  const names = keys[0]?.at.map((_, d) => h('th', { scope: 'col' }, 'xyz'[d] ?? `p${d + 1}`)) ?? [];
  /** @type {(text: string) => HTMLElement} */
  const unseen = (text) => h('th', {}, h('span', { class: 'unseen' }, text));
  const headings = h('tr', {}, h('th', { scope: 'col' }, 'Time'), names, unseen('Timing'), unseen('Go'), unseen('Remove'));
  const { size } = animation;
  const sizes = [0, 1].map((d) => numberField(['Width', 'Height'][d], () => size[d],
    (v) => setting('animation', 'size', size.map((own, k) => (k === d ? Math.round(v) : own))), { step: 10 }));
  panels.keys.replaceChildren(
    h('div', { class: 'section' },
      problemsOf('animation'),
      animation.own_keys ? null : h('p', { class: 'faint small' },
        'The scene has no keys of its own: the path visits every pose. Changing one makes them the scene’s own.'),
      h('table', { class: 'keys' }, h('thead', {}, headings), h('tbody', {}, rows)),
      h('div', { class: 'buttons' }, h('button', {
        type: 'button', class: 'bordered',
        onclick: () => {
          keys.push({ time: rounded((keys.at(-1)?.time ?? -1) + 1, 3), at: probe() });
          changed('add a key');
        },
      }, icon('plus'), 'Key at the probe'))),
    section('Playing',
      row('Frame rate', numberField('Frames a second', () => animation.fps, (v) => setting('animation', 'fps', v), { step: 1 })),
      row('Drawn on', segments('Drawn on', [['1', 'Ones'], ['2', 'Twos'], ['3', 'Threes']],
        () => String(animation.hold), (v) => setting('animation', 'hold', Number(v)))),
      row('Frame size', ...sizes)));
}

// Problems.

/**
 * The problems that belong somewhere, as they are shown there.
 * @type {(where: Where, also?: Where | null, name?: string | null) => HTMLElement | null}
 */
export function problemsOf(...[where, also = null, name = null]) {
  const named = /** @type {'pose' | 'landmark'} */ (where);
  const own = (store.state?.problems ?? store.scene?.problems ?? []).filter((problem) =>
    (problem.where === where || (also && problem.where === also)) && (!name || problem[named] === name));
  return own.length > 0 ? h('div', { class: 'problems' }, own.map(problemItem)) : null;
}

/** @type {(problem: Problem) => HTMLElement} */
function problemItem(problem) {
  const parts = [problem.landmark && `landmark ${problem.landmark}`, problem.pose && `pose ${problem.pose}`,
    problem.layer && `layer ${problem.layer}`, problem.line && `line ${problem.line}`];
  const where = parts.filter(Boolean).join(', ');
  return h('div', { class: 'problem' }, icon('warn'),
    h('div', {}, h('p', {}, problem.message), where && h('p', { class: 'faint small' }, where)));
}

function buildProblems() {
  const problems = store.state?.problems ?? [];
  const notes = store.scene?.notes ?? [];
  const tab = byId('tab-problems');
  tab.replaceChildren('Problems', ...(problems.length > 0 ? [h('span', { class: 'count' }, String(problems.length))] : []));
  panels.problems.replaceChildren(
    problems.length > 0 ? h('section', { class: 'section' }, problems.map(problemItem))
      : h('p', { class: 'empty' }, 'The scene has no problems.'),
    ...(notes.length > 0 ? [section('Notes', notes.map((note) => h('p', { class: 'small' }, note)))] : []));
}

// Landmarks: filled by landmarks.js.
export const landmarksPanel = panels.landmarks;

const busy = () => panels.scene.contains(focused()) && focused()?.matches('input[type="range"], select');
let shape = '';
// Landmarks have their own panel.
const besides = () => [store.pose, store.state?.problems, { ...store.scene, landmarks: null, revision: null, notes: null }];
onChange('scene pose', besides, () => {
  // While a control is held it must not be made anew.
  const { poses, pseudo_poses: pseudo, dimension } = store.scene;
  const now = JSON.stringify([store.pose, poses.map((pose) => [pose.name, pose.mirror]), pseudo, dimension]);
  if (now !== shape || !busy()) {
    shape = now;
    const label = focused()?.getAttribute('aria-label');
    const inside = panels.scene.contains(focused());
    const scrolled = panels.scene.scrollTop;
    buildScene();
    panels.scene.scrollTop = scrolled;
    if (inside && label) found(panels.scene, `[aria-label="${CSS.escape(label)}"]`)?.focus();
  } else {
    updated.forEach((control) => control.update());
  }
});
onChange('scene', () => [store.scene.animation, store.state?.problems], () => {
  const active = focused();
  if (!active || !panels.keys.contains(active) || active.tagName === 'BUTTON') return buildKeys();
  const label = active.getAttribute('aria-label');
  buildKeys();
  found(panels.keys, `[aria-label="${CSS.escape(label ?? '')}"]`)?.focus();
});
on('state scene', buildProblems);
on('view', () => updated.forEach((control) => control.update()));
