// Making elements. Nothing here writes markup or style attributes from text, so nothing in a scene can become either.

const SVG = 'http://www.w3.org/2000/svg';

/**
 * An element. `properties`: `class`, `on...` for listeners, `style` an object of CSS properties (set by the style object, which the
 * page's content policy permits); other names are attributes; null, undefined and false leave one out, true gives it no value.
 */
export function h(tag, properties = {}, ...children) {
  return filled(document.createElement(tag), properties, children);
}

/** An SVG element, likewise. */
export function s(tag, properties = {}, ...children) {
  return filled(document.createElementNS(SVG, tag), properties, children);
}

function filled(element, properties, children) {
  for (const [name, value] of Object.entries(properties)) {
    if (name.startsWith('on')) element.addEventListener(name.slice(2).toLowerCase(), value);
    else if (name === 'style') Object.entries(value).forEach(([key, v]) => element.style.setProperty(key, v));
    else if (value === true) element.setAttribute(name, '');
    else if (value !== null && value !== undefined && value !== false) element.setAttribute(name, value);
  }
  element.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

/** The element with an id of the page. */
export const byId = (id) => document.getElementById(id);

/** Sets attributes of an SVG element. */
export function set(element, attributes) {
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  return element;
}

/** A number as people write it: no more digits than `digits`, no needless zeros. */
export function short(value, digits = 3) {
  const text = value.toFixed(digits);
  return (text.includes('.') ? text.replace(/\.?0+$/, '') : text).replace(/^-0$/, '0');
}

/** With a true minus sign and all digits, for columns. */
export function fixed(value, digits = 2) {
  const text = value.toFixed(digits);
  return Number(text) < 0 ? `−${text.slice(1)}` : text.replace('-', '');
}

export const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

/** One call a displayed frame, however often it is asked for. */
export function onceAFrame(work) {
  let asked = false;
  return () => {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => {
      asked = false;
      work();
    });
  };
}

/** Follows a pointer from `pointerdown` to its end; `move(event, ended)` is called with every place. */
export function follow(event, move) {
  const target = event.currentTarget;
  target.setPointerCapture(event.pointerId);
  const moved = (next) => next.pointerId === event.pointerId && move(next, false);
  const ended = (next) => {
    if (next.pointerId !== event.pointerId) return;
    target.removeEventListener('pointermove', moved);
    target.removeEventListener('pointerup', ended);
    target.removeEventListener('pointercancel', ended);
    move(next, true);
  };
  target.addEventListener('pointermove', moved);
  target.addEventListener('pointerup', ended);
  target.addEventListener('pointercancel', ended);
}
