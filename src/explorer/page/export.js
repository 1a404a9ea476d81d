// @ts-check
// The export dialog: what to render, the command that does it, its progress.
import { postJson } from './api.js';
import { found, h } from './dom.js';
import { iconButton } from './controls.js';
import { Newest } from './newest.js';
import { asked, on, store } from './state.js';
import { toast } from './toasts.js';

const FORMATS = [
  ['gif', 'GIF, animated'], ['png', 'PNG, animated'], ['webp', 'WebP, animated'], ['svg', 'SVG, animated'], ['json', 'Lottie'],
  ['mp4', 'MP4 (needs ffmpeg)'], ['webm', 'WebM (needs ffmpeg)'], ['glb', 'glTF, binary'], ['', 'PNG sequence in a folder'],
];

/** @type {(label: string, control: HTMLElement) => HTMLElement} */
const field = (label, control) => h('label', { class: 'row' }, h('span', { class: 'label' }, label), control);
const output = h('input', { type: 'text', id: 'export-output', autofocus: true, spellcheck: 'false', autocomplete: 'off' });
const format = h('select', { onchange: () => {
  const stem = output.value.replace(/\.[a-z0-9]+$/i, '');
  output.value = format.value ? `${stem}.${format.value}` : stem;
  changed();
} }, FORMATS.map(([value, text]) => h('option', { value }, text)));
const width = h('input', { type: 'number', min: 1, 'aria-label': 'Width' });
const height = h('input', { type: 'number', min: 1, 'aria-label': 'Height' });
const fps = h('input', { type: 'number', min: 1 });
const frames = h('input', { type: 'text', placeholder: 'all, or 1-48' });
/** @type {(choices: string[][]) => HTMLSelectElement} */
const select = (choices) => h('select', {}, choices.map(([value, text]) => h('option', { value }, text)));
const background = select([['', 'As in the scene'], ['transparent', 'Transparent'], ['white', 'White'], ['black', 'Black']]);
const supersample = select([['', 'Default'], ['1', '1'], ['2', '2 × 2'], ['3', '3 × 3'], ['4', '4 × 4']]);
const command = h('code', { class: 'command', tabindex: '0' });
const bar = h('progress', { max: 1, value: 0, 'aria-label': 'Progress' });
const said = h('p', { class: 'small said', role: 'status' });
const start = h('button', { type: 'submit', class: 'main', id: 'export-start' }, 'Render');
const cancel = h('button', {
  type: 'button', class: 'bordered', id: 'export-cancel', onclick: () => asked('export/cancel', {}),
}, 'Cancel render');
const form = h('form', { method: 'dialog', onsubmit: (event) => {
  event.preventDefault();
  asked('export', fields());
} },
h('header', {}, h('h2', {}, 'Export'), h('span', { class: 'grow' }), iconButton('close', 'Close', () => dialog.close())),
field('Format', format), field('File', output),
h('div', { class: 'row' }, h('span', { class: 'label' }, 'Size'),
  h('div', { class: 'controls' }, width, h('span', { class: 'faint' }, '×'), height)),
field('Frames a second', fps), field('Frames', frames), field('Background', background), field('Samples', supersample),
h('div', { class: 'command-line' }, command, iconButton('copy', 'Copy the command', () => copied(command.textContent))),
h('div', { class: 'progress hidden' }, bar, said),
h('footer', {}, cancel, h('span', { class: 'grow' }), start));
const dialog = h('dialog', { class: 'dialog', 'aria-label': 'Export' }, form);
document.body.append(dialog);
form.addEventListener('input', () => changed());
form.addEventListener('keydown', (event) => event.stopPropagation());

/** @type {(input: HTMLInputElement) => number | undefined} */
const number = (input) => (input.value === '' ? undefined : Number(input.value));

function fields() {
  const { size = [], fps: own } = store.scene.animation ?? {};
  const sized = number(width) && number(height) && (number(width) !== size[0] || number(height) !== size[1]);
  const all = {
    output: output.value || undefined,
    size: sized ? [number(width), number(height)] : undefined,
    fps: number(fps) !== own ? number(fps) : undefined,
    frames: frames.value.trim() || undefined,
    background: background.value || undefined,
    supersample: supersample.value ? Number(supersample.value) : undefined,
  };
  return Object.fromEntries(Object.entries(all).filter(([, value]) => value !== undefined));
}

const requests = new Newest();
async function changed() {
  const mine = requests.begin();
  start.disabled = output.value.trim() === '';
  try {
    const answer = await postJson('command', { verb: 'render', ...fields() });
    if (requests.is(mine)) command.textContent = answer.command;
  } catch (error) {
    if (requests.is(mine)) command.textContent = /** @type {Error} */ (error).message;
  }
}

export function openExport() {
  if (!store.scene?.animation) return;
  const { size, fps: own } = store.scene.animation;
  if (!output.value) output.value = `${store.scene.name}.gif`;
  [width.value, height.value, fps.value] = [size[0], size[1], own].map(String);
  showJob();
  changed();
  dialog.showModal();
}

function showJob() {
  const job = store.state?.job;
  const running = job?.state === 'running';
  found(form, '.progress')?.classList.toggle('hidden', !job);
  cancel.classList.toggle('hidden', !running);
  start.disabled = running;
  if (!job) return;
  if (job.total > 0) bar.value = job.done / job.total;
  else if (running) bar.removeAttribute('value');
  if (job.state === 'done') bar.value = 1;
  said.dataset.state = job.state;
  const left = job.left > 1 ? `, ${Math.ceil(job.left)} s left` : '';
  said.textContent = {
    running: () => `${job.output}: ${job.total ? `frame ${job.done} of ${job.total}` : 'starting'}${left}`,
    done: () => `${job.output}: done in ${job.seconds.toFixed(1)} s`,
    failed: () => `${job.output}: ${job.message ?? 'failed'}`,
    cancelled: () => `${job.output}: cancelled`,
  }[job.state]();
}

/** @type {string | null} */
let told = null;
on('state', () => {
  const job = store.state.job;
  const hasEnded = job && told !== null && told !== `${job.id} ${job.state}` && job.state !== 'running';
  if (hasEnded && !dialog.open) {
    toast(said.textContent || `${job.output}: ${job.state}`, { kind: job.state === 'failed' ? 'problem' : 'note' });
  }
  showJob();
  told = job ? `${job.id} ${job.state}` : '';
});

/**
 * Puts a text where it can be pasted.
 * @type {(text: string) => Promise<void>}
 */
export async function copied(text) {
  try {
    await navigator.clipboard.writeText(text);
    toast('Copied', { detail: text });
  } catch {
    toast('The clipboard cannot be used here', { detail: text });
  }
}

export async function copyCommand() {
  try {
    const answer = await postJson('command', { verb: 'frame', at: store.place });
    document.documentElement.dataset.copied = answer.command;
    await copied(answer.command);
  } catch (error) {
    toast(/** @type {Error} */ (error).message, { kind: 'problem' });
  }
}
