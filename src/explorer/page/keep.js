// @ts-check
// The dialog that names a folder for a scene that was begun for drawings.
import { postJson } from './api.js';
import { iconButton } from './controls.js';
import { h } from './dom.js';
import { store, take } from './state.js';
import { toast } from './toasts.js';

const folder = h('input', { type: 'text', id: 'keep-folder', autofocus: true, spellcheck: 'false', autocomplete: 'off' });
const said = h('p', { class: 'small said', role: 'alert', 'data-state': 'failed' });
const form = h('form', { method: 'dialog', onsubmit: (event) => {
  event.preventDefault();
  keep();
} },
h('header', {}, h('h2', {}, 'Save the scene'), h('span', { class: 'grow' }), iconButton('close', 'Close', () => dialog.close())),
h('label', { class: 'row' }, h('span', { class: 'label' }, 'Folder'), folder),
h('p', { class: 'explained faint small' },
  'The scene file is written there, with copies of the drawings that are not there yet. From then on every edit is saved there at once.'),
h('div', { class: 'explained' }, said),
h('footer', {}, h('span', { class: 'grow' }), h('button', { type: 'submit', class: 'main', id: 'keep-here' }, 'Save here')));
const dialog = h('dialog', { class: 'dialog', 'aria-label': 'Save the scene' }, form);
document.body.append(dialog);
form.addEventListener('keydown', (event) => event.stopPropagation());

async function keep() {
  try {
    await take(await postJson('keep', { folder: folder.value }));
    dialog.close();
    toast('Saved', { detail: store.scene.file });
  } catch (error) {
    said.textContent = /** @type {Error} */ (error).message;
  }
}

export function openKeep() {
  if (!folder.value) folder.value = store.scene?.name ?? '';
  said.textContent = '';
  dialog.showModal();
  folder.select();
}
