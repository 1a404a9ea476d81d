// @ts-check
// The bar at the top, and the one over the picture.
import { asked, emit, look, on, store } from './state.js';
import { byId, found, h } from './dom.js';
import { iconButton, segments, toggle } from './controls.js';
import { icon } from './icons.js';
import { copyCommand, openExport } from './export.js';
import { isLayered } from './figures.js';
import { openKeep } from './keep.js';
import { openKeys } from './keyboard.js';
import { actualSize, fit, frameView, zoomBy } from './view.js';
import { flipTheme, isDark } from './theme.js';

/** What is said over the sheets. */
const PARTS = 'Click on a part to leave it out or take it back, elsewhere to ask for a part.';
const ONE_LAYER = 'One layer of each drawing; which one is chosen with the landmarks.';

const app = byId('app');
const undo = iconButton('undo', 'Undo', () => asked('undo', {}), { id: 'undo' });
const redo = iconButton('redo', 'Redo', () => asked('redo', {}), { id: 'redo' });
const theme = iconButton('moon', 'Dark or light', () => flipTheme());
const panel = toggle('panel', 'Inspector', () => app.dataset.inspector !== 'closed', (open) => {
  app.dataset.inspector = open ? 'open' : 'closed';
  panel.update();
});
if (innerWidth < 1200) {
  app.dataset.inspector = 'closed';
  panel.update();
}
const save = h('button', {
  type: 'button', class: 'main hidden', id: 'keep', title: 'Name a folder for the scene', onclick: openKeep,
}, 'Save…');
byId('bar-tools').append(undo, redo, h('span', { class: 'rule' }),
  h('button', { type: 'button', id: 'copy-command', title: 'Copy the command that draws this frame (C)', onclick: copyCommand },
    icon('command'), h('span', { class: 'wide' }, 'Copy as command')),
  h('button', { type: 'button', class: 'bordered', id: 'export', title: 'Render the animation (E)', onclick: openExport },
    icon('export'), 'Export…'), save,
  h('span', { class: 'rule' }), iconButton('keyboard', 'Keys', openKeys), theme, panel);

const saved = byId('saved');
const banner = h('div', { class: 'banner hidden', role: 'alert' });
found(app, '.centre')?.prepend(banner);

function drawState() {
  const { state } = store;
  const steps = [{ button: undo, label: state.undo, name: 'Undo' }, { button: redo, label: state.redo, name: 'Redo' }];
  for (const { button, label, name } of steps) {
    button.disabled = !label;
    button.title = label ? `${name}: ${label}` : name;
    button.setAttribute('aria-label', button.title);
  }
  const [kind, text] = store.lost ? ['bad', 'The server does not answer']
    : state.save_error ? ['bad', 'Not saved']
      : state.working ? ['busy', 'Mapping…']
        : state.temporary && state.saved ? ['busy', 'Not saved in a folder yet']
        : state.saved ? ['good', 'Saved'] : ['busy', 'Editing…'];
  save.classList.toggle('hidden', !state.temporary);
  byId('scene-file').textContent = state.temporary ? '' : store.scene?.file ?? '';
  saved.dataset.kind = kind;
  saved.replaceChildren(h('span', { class: 'dot' }), text);
  saved.title = state.save_error ?? (state.timings?.mapping_ms ? `Last mapping: ${Math.round(state.timings.mapping_ms)} ms` : '');
  document.documentElement.dataset.seq = String(state.seq);
  document.documentElement.dataset.working = String(state.working);
  const broken = !(state.revisions.shape > 0);
  const first = state.problems?.[0];
  const shown = state.conflict || state.save_error || broken || first;
  banner.classList.toggle('hidden', !shown);
  if (!shown) return;
  if (state.conflict) {
    const text = 'The scene file was changed by another program, and there are edits here that are not in it.';
    banner.replaceChildren(icon('warn'), h('span', { class: 'grow' }, text),
      h('button', { type: 'button', class: 'bordered', onclick: () => asked('conflict', { take: 'theirs' }) }, 'Read the file'),
      h('button', { type: 'button', class: 'bordered', onclick: () => asked('conflict', { take: 'mine' }) }, 'Keep what is here'));
  } else if (state.save_error) {
    banner.replaceChildren(icon('warn'), h('span', { class: 'grow' }, `Not saved: ${state.save_error}`),
      h('button', { type: 'button', class: 'bordered', onclick: () => asked('save', {}) }, 'Try again'));
  } else {
    const parts = [first?.landmark && `landmark ${first.landmark}`, first?.pose && `pose ${first.pose}`,
      first?.line && `line ${first.line}`];
    const where = parts.filter(Boolean).join(', ');
    const tab = first?.where === 'landmark' ? 'landmarks' : 'problems';
    banner.replaceChildren(icon('warn'), h('span', { class: 'grow' }, first?.message ?? 'The scene cannot be mapped.',
      where ? h('span', { class: 'faint' }, ` ${where}`) : null,
      broken ? null : h('span', { class: 'faint' }, ' The last good shape is shown.')),
      h('button', { type: 'button', class: 'bordered', onclick: () => emit('tab', tab) }, 'Show'));
  }
}

// Over the picture.

const main = segments('View', [['picture', 'Picture'], ['matches', 'Matches'], ['drawings', 'Drawings']],
  () => store.view.main, (value) => look({ main: value }));
const tool = segments('Dragging the picture', [
  ['reach', icon('reach'), 'Pose: drag the drawing along the plane'], ['bend', icon('bend'), 'Bend: drag handles to a new pose'],
  ['pan', icon('hand'), 'Move the view'],
], () => store.view.tool, (value) => look({ tool: value }));
const onion = segments('Onion skin', [['off', 'None'], ['poses', 'Poses'], ['path', 'Path']],
  () => store.view.onion, (value) => look({ onion: value }));
const mesh = toggle('mesh', 'Mesh (M)', () => store.view.mesh, (value) => look({ mesh: value }));
mesh.id = 'mesh';
const places = toggle('places', 'The place under the pointer, in all drawings (P)',
  () => store.view.places, (value) => look({ places: value }));
places.id = 'show-places';
const marks = segments('New landmarks', [
  ['point', icon('point'), 'Points: click where it is (L)'], ['line', icon('line'), 'Lines: click from point to point (L)'],
], () => store.view.mark, (value) => look({ mark: value }));
const percent = h('button', { type: 'button', class: 'percent', title: 'Actual size (Shift 0)', id: 'actual-size', onclick: actualSize });
const ofPicture = [tool, h('span', { class: 'onion' }, icon('onion'), onion), places];
const told = h('span', { class: 'faint small clip' });
byId('picture-tools').append(main, h('span', { class: 'rule' }), ...ofPicture, marks, mesh, told, h('span', { class: 'grow' }),
  h('span', { class: 'tools zoom' }, iconButton('minus', 'Zoom out', () => zoomBy(0.8)), percent,
    iconButton('plus', 'Zoom in', () => zoomBy(1.25)), iconButton('fit', 'Fit (0)', fit)));

function drawView() {
  [main, tool, onion, marks, mesh, places].forEach((control) => control.update());
  const shown = store.view.main;
  const zoom = found(byId('picture-tools'), '.zoom');
  [...ofPicture, zoom].forEach((element) => element?.classList.toggle('hidden', shown !== 'picture'));
  marks.classList.toggle('hidden', shown !== 'matches');
  mesh.classList.toggle('hidden', shown === 'drawings');
  told.classList.toggle('hidden', shown !== 'drawings');
  if (store.scene) told.textContent = isLayered() ? ONE_LAYER : PARTS;
}

on('state', drawState);
on('view', drawView);
on('toggle-mesh', () => look({ mesh: !store.view.mesh }));
on('tool', (value) => look({ tool: value }));
on('zoom scene', () => (percent.textContent = `${Math.round(frameView().scale * 100)} %`));
on('theme', () => theme.replaceChildren(icon(isDark() ? 'sun' : 'moon')));
theme.replaceChildren(icon(isDark() ? 'sun' : 'moon'));
on('scene', () => {
  byId('scene-name').textContent = store.scene.name;
  document.title = `${store.scene.name} – inbetween`;
});
