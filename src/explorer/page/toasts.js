// @ts-check
// Short messages, and what the server refuses.
import { byId, h } from './dom.js';
import { iconButton } from './controls.js';
import { icon } from './icons.js';
import { on, tellRefusals } from './state.js';

/** @import { Problem } from './answers.js' */

const root = byId('toasts');
const SECONDS = 7;

/** @type {(message: string, how?: { kind?: 'note' | 'problem', detail?: string | null }) => void} */
export function toast(message, { kind = 'note', detail = null } = {}) {
  const same = Array.from(root.children).find((other) => /** @type {HTMLElement} */ (other).dataset.message === message);
  same?.remove();
  const text = h('div', { class: 'grow' }, h('p', {}, message), detail && h('p', { class: 'faint small' }, detail));
  const element = h('div', { class: `toast ${kind}`, 'data-message': message }, kind === 'problem' ? icon('warn') : null, text,
    iconButton('close', 'Close this message', () => element.remove()));
  root.append(element);
  while (root.children.length > 3) root.firstChild?.remove();
  setTimeout(() => element.remove(), SECONDS * 1000);
}

/** @type {(problem: Problem) => void} */
function refused(problem) {
  const parts = [problem.landmark && `landmark ${problem.landmark}`, problem.pose && `pose ${problem.pose}`,
    problem.line && `line ${problem.line}`];
  const where = parts.filter(Boolean).join(', ');
  toast(problem.message, { kind: 'problem', detail: where || null });
}
tellRefusals(refused);
on('refused', refused);
