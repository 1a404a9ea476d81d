// @ts-check
// How the figure of a drawing is told from its sheet: settings of the pose that is chosen, or of all that say nothing themselves.
import { iconButton, menu, numberField, row } from './controls.js';
import { focused, found, h } from './dom.js';
import { figures } from './figures.js';
import { edit, on, store } from './state.js';

/** @import { Reading } from './answers.js' */
/**
 * What is set: `notes` are shown with it.
 * @typedef {{
 *   title: string, reading: Reading, own: string[], isBitmap: boolean, notes: string[],
 *   put: (key: string, value: unknown) => void,
 * }} Subject
 */

/** @type {[string, string][]} */
const FIGURE = [['auto', 'By evidence'], ['alpha', 'Cut out'], ['background', 'Painted on a background'], ['lines', 'Lines on paper']];
/** @type {[string, string][]} */
const PAPER = [['keep', 'Belongs to the figure'], ['clear', 'Is transparent']];

/** Stands in the inspector while the sheets are shown. */
export const readingPanel = h('div', { id: 'reading' });

/**
 * What the controls show and do: the settings, which of them are the pose's own, and how one is set.
 * @type {() => Subject | null}
 */
function subject() {
  const figure = store.pose === null ? undefined : figures.get(store.pose);
  if (figure && store.pose !== null) {
    const { name } = store.scene.poses[store.pose] ?? {};
    return {
      title: `Figure of ${name}`, reading: figure.reading, own: figure.own, isBitmap: figure.bitmap,
      notes: figure.problem ? [figure.problem.message] : figure.notes ?? [],
      put: (key, value) => edit([{ op: 'set_pose', pose: name, key, value }], `set ${key} of '${name}'`),
    };
  }
  const any = [...figures.values()];
  if (any.length === 0) return null;
  return {
    title: 'Figures of all drawings', reading: any[0].usual, own: [], isBitmap: any.some(({ bitmap }) => bitmap),
    notes: any.some(({ bitmap }) => bitmap) ? ['Click on a drawing to say it for that one alone.'] : [],
    put: (key, value) => edit([{ op: 'set', table: 'input', key, value }], `set ${key} of all drawings`),
  };
}

function build() {
  const now = store.view.main === 'drawings' && store.scene ? subject() : null;
  if (!now) return readingPanel.replaceChildren();
  const { reading, own, put } = now;
  /** @type {(label: string, key: keyof Reading, control: HTMLElement) => HTMLElement} */
  const field = (label, key, control) => row(label, control,
    own.includes(key) ? iconButton('close', `${label}: as for all drawings`, () => put(key, null)) : null);
  /** @type {<K extends keyof Reading>(key: K) => [() => Reading[K], (value: Reading[K]) => void]} */
  const said = (key) => [() => reading[key], (value) => put(key, value)];
  const active = focused();
  const label = active && readingPanel.contains(active) ? active.getAttribute('aria-label') : null;
  readingPanel.replaceChildren(h('section', { class: 'section' }, h('h3', {}, now.title),
    now.isBitmap ? [
      field('Told', 'figure', menu('How the figure is told', FIGURE, ...said('figure'))),
      field('Gaps', 'gap', numberField('Widest gap that is closed, of the diagonal', ...said('gap'), { step: 0.005 })),
      field('Paper', 'paper', menu('The paper inside lines', PAPER, ...said('paper'))),
      field('Coverage', 'threshold', numberField('Coverage that counts as inside', ...said('threshold'), { step: 0.05 })),
    ] : h('p', { class: 'faint small' }, 'The figure of an SVG drawing is what is drawn in it.'),
    now.notes.map((note) => h('p', { class: 'faint small' }, note))));
  if (label) found(readingPanel, `[aria-label="${CSS.escape(label)}"]`)?.focus();
}

on('figures pose view', build);
