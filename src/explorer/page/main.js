// @ts-check
// The page: its parts come alive by being imported, and hear of everything by events.
import './theme.js';
import './toasts.js';
import './frames.js';
import './picture.js';
import './places.js';
import './pad.js';
import './weights.js';
import './timeline.js';
import { showTab } from './inspector.js';
import './matches.js';
import './sheets.js';
import './landmarks.js';
import './export.js';
import './keyboard.js';
import './bars.js';
import { byId, h } from './dom.js';
import { settled } from './frames.js';
import { look, on, start } from './state.js';

on('tab', (name) => {
  byId('app').dataset.inspector = 'open';
  showTab(name);
});

try {
  await start();
  look({});
  byId('app').setAttribute('aria-busy', 'false');
  await settled();
  document.documentElement.dataset.ready = 'true';
  if (new URLSearchParams(location.search).has('bench')) (await import('./bench.js')).measure();
} catch (error) {
  byId('stage').replaceChildren(h('p', { class: 'note' }, `The page cannot be opened: ${/** @type {Error} */ (error).message}`));
  throw error;
}
