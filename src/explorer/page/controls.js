// @ts-check
// Controls that several parts of the page are made of.
import { h } from './dom.js';
import { icon } from './icons.js';

/** @import { Child, Properties, Updated } from './dom.js' */

/**
 * A button that shows an icon and says its label.
 * @type {(name: string, label: string, onclick: () => void, properties?: Properties) => HTMLButtonElement}
 */
export function iconButton(name, label, onclick, properties = {}) {
  return h('button', { type: 'button', class: 'square', 'aria-label': label, title: label, onclick, ...properties }, icon(name));
}

/**
 * A button that is on or off; `isOn` is asked by `update`.
 * @type {(name: string, label: string, isOn: () => boolean, flip: (value: boolean) => void) => HTMLButtonElement & Updated}
 */
export function toggle(name, label, isOn, flip) {
  const button = /** @type {HTMLButtonElement & Updated} */ (iconButton(name, label, () => flip(!isOn())));
  button.update = () => button.setAttribute('aria-pressed', String(isOn()));
  button.update();
  return button;
}

/**
 * One of some values: [value, text or icon, label]. Arrow keys go from one to the next.
 * @type {<V extends string>(
 *   label: string, choices: [V, string | SVGElement, string?][], current: () => V | null | undefined, choose: (value: V) => void,
 * ) => HTMLDivElement & Updated}
 */
export function segments(label, choices, current, choose) {
  const buttons = choices.map(([value, shown, title]) =>
    h('button', {
      type: 'button', role: 'radio', 'aria-label': title ?? shown, title: title ?? null, 'data-value': value,
      class: title && typeof shown !== 'string' ? 'square' : null,
      onclick: () => choose(value),
    }, shown));
  const group = /** @type {HTMLDivElement & Updated} */ (h('div', { class: 'segments', role: 'radiogroup', 'aria-label': label }, buttons));
  group.addEventListener('keydown', (event) => {
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    event.stopPropagation();
    const here = buttons.indexOf(/** @type {HTMLButtonElement} */ (document.activeElement));
    const next = buttons[(here + step + buttons.length) % buttons.length];
    next.click();
    next.focus();
  });
  group.update = () => {
    for (const button of buttons) {
      const chosen = button.dataset.value === String(current());
      button.setAttribute('aria-checked', String(chosen));
      button.tabIndex = chosen ? 0 : -1;
    }
  };
  group.update();
  return group;
}

/**
 * A number: `take(value)` is called when a new one is entered. `update` shows what `current` says.
 * @type {(
 *   label: string, current: () => number | null | undefined, take: (value: number) => void,
 *   options?: Properties & { step?: number, digits?: number },
 * ) => HTMLInputElement & Updated}
 */
export function numberField(label, current, take, { step = 0.01, digits = 4, ...properties } = {}) {
  const made = h('input', { type: 'number', step: 'any', 'aria-label': label, inputmode: 'decimal', ...properties });
  const input = /** @type {HTMLInputElement & Updated} */ (made);
  input.update = () => {
    const value = current();
    if (document.activeElement === input && input.dataset.typed) return;
    input.value = value === null || value === undefined ? '' : String(Number(value.toFixed(digits)));
  };
  const entered = () => {
    delete input.dataset.typed;
    const value = Number(input.value);
    if (input.value !== '' && Number.isFinite(value) && value !== current()) take(value);
    else input.update();
  };
  input.addEventListener('input', () => (input.dataset.typed = '1'));
  input.addEventListener('change', entered);
  input.addEventListener('keydown', (event) => {
    event.stopPropagation();
    if (event.key === 'Enter') entered();
    if (event.key === 'Escape') {
      delete input.dataset.typed;
      input.update();
      input.blur();
    }
    const direction = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (direction) {
      event.preventDefault();
      input.value = String(Number((Number(input.value) + direction * step * (event.shiftKey ? 10 : 1)).toFixed(6)));
      entered();
    }
  });
  input.update();
  return input;
}

/**
 * A slider with its number. `drag(value)` while it moves, `take(value)` when it is let go.
 * @type {(
 *   label: string, range: { min: number, max: number, step: number, digits?: number }, current: () => number,
 *   drag: ((value: number) => void) | null, take: (value: number) => void,
 * ) => HTMLLabelElement & Updated}
 */
export function slider(label, { min, max, step, digits = 2 }, current, drag, take) {
  const number = h('output', { class: 'number' });
  const input = h('input', { type: 'range', min, max, step, 'aria-label': label });
  let held = false;
  /** @type {(value: number) => unknown} */
  const show = (value) => (number.textContent = value.toFixed(digits));
  input.addEventListener('input', () => {
    held = true;
    show(Number(input.value));
    drag?.(Number(input.value));
  });
  input.addEventListener('change', () => {
    held = false;
    take(Number(input.value));
  });
  input.addEventListener('keydown', (event) => event.stopPropagation());
  const whole = /** @type {HTMLLabelElement & Updated} */ (h('label', { class: 'slider' }, h('span', {}, label), input, number));
  whole.update = () => {
    if (held) return;
    input.value = String(current());
    show(current());
  };
  whole.update();
  return whole;
}

/**
 * A choice from a menu.
 * @type {<V extends string>(
 *   label: string, choices: [V, string][], current: () => V | undefined, take: (value: V) => void,
 * ) => HTMLSelectElement & Updated}
 */
export function menu(label, choices, current, take) {
  const made = h('select', { 'aria-label': label, onchange: () => take(/** @type {typeof choices[number][0]} */ (select.value)) },
    choices.map(([value, text]) => h('option', { value }, text)));
  const select = /** @type {HTMLSelectElement & Updated} */ (made);
  select.update = () => (select.value = String(current()));
  select.update();
  return select;
}

/**
 * A label beside a control.
 * @type {(label: string, ...controls: Child[]) => HTMLDivElement}
 */
export const row = (label, ...controls) =>
  h('div', { class: 'row' }, h('span', { class: 'label' }, label), h('div', { class: 'controls' }, ...controls));
