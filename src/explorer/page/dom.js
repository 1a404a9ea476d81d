// @ts-check
// Making elements. Nothing here writes markup or style attributes from text, so nothing in a scene can become either.

/** @typedef {Event & { target: HTMLInputElement }} FieldEvent An event of a field, also of a menu: both have a `value`. */
/**
 * Attributes of an element, and what listens to it.
 * @typedef {{
 *   onclick?: (event: MouseEvent) => void, onchange?: (event: FieldEvent) => void, onkeydown?: (event: KeyboardEvent) => void,
 *   onsubmit?: (event: Event) => void, style?: Record<string, string>, [attribute: string]: unknown,
 * }} Properties
 */
/** @typedef {Node | string | null | undefined | false} Leaf */
/** @typedef {Leaf | (Leaf | (Leaf | Leaf[])[])[]} Child What is put into an element: lists of it, too; what is nothing is left out. */
/** @typedef {{ update: () => void }} Updated What a control has: it shows what is so now. */
/** @typedef {{ currentTarget: EventTarget | null, pointerId: number }} Pressed What is followed of a `pointerdown`. */

const SVG = 'http://www.w3.org/2000/svg';

/**
 * An element. `properties`: `class`, `on...` for listeners, `style` an object of CSS properties (set by the style object, which the
 * page's content policy permits); other names are attributes; null, undefined and false leave one out, true gives it no value.
 * @type {<K extends keyof HTMLElementTagNameMap>(tag: K, properties?: Properties, ...children: Child[]) => HTMLElementTagNameMap[K]}
 */
export function h(tag, properties = {}, ...children) {
  return filled(document.createElement(tag), properties, children);
}

/**
 * An SVG element, likewise.
 * @type {<K extends keyof SVGElementTagNameMap>(tag: K, properties?: Properties, ...children: Child[]) => SVGElementTagNameMap[K]}
 */
export function s(tag, properties = {}, ...children) {
  return filled(document.createElementNS(SVG, tag), properties, children);
}

/** @type {(element: HTMLElement | SVGElement, properties: Record<string, string>) => void} */
const setStyle = (element, properties) =>
  Object.entries(properties).forEach(([key, value]) => element.style.setProperty(key, value));

/** @type {<E extends HTMLElement | SVGElement>(element: E, properties: Properties, children: Child[]) => E} */
function filled(element, properties, children) {
  for (const [name, value] of Object.entries(properties)) {
    if (name.startsWith('on')) element.addEventListener(name.slice(2).toLowerCase(), /** @type {EventListener} */ (value));
    else if (name === 'style') setStyle(element, /** @type {Record<string, string>} */ (value));
    else if (value === true) element.setAttribute(name, '');
    else if (value !== null && value !== undefined && value !== false) element.setAttribute(name, String(value));
  }
  const all = /** @type {Leaf[]} */ (children.flat(Infinity));
  element.append(...all.filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

/**
 * The element with an id of the page.
 * @type {<K extends string>(id: K) => K extends 'picture' ? HTMLCanvasElement : HTMLElement}
 */
export const byId = (id) => /** @type {never} */ (document.getElementById(id));

/**
 * The first element within another that a selector finds.
 * @type {(root: ParentNode, selector: string) => HTMLElement | null}
 */
export const found = (root, selector) => root.querySelector(selector);

/**
 * The element that has the focus.
 * @type {() => HTMLElement | null}
 */
export const focused = () => /** @type {HTMLElement | null} */ (document.activeElement);

/**
 * Controls within an element, which are made to show what is so now.
 * @type {(root: ParentNode, selector: string) => void}
 */
export function updateAll(root, selector) {
  /** @type {NodeListOf<HTMLElement & Partial<Updated>>} */
  const controls = root.querySelectorAll(selector);
  controls.forEach((control) => control.update?.());
}

/**
 * Where a place of the window is in an SVG element, in its own units.
 * @type {(drawing: SVGSVGElement, event: MouseEvent) => { x: number, y: number }}
 */
export function placeInSvg(drawing, event) {
  const matrix = /** @type {DOMMatrix} */ (drawing.getScreenCTM());
  return new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix.inverse());
}

/**
 * The element that an event is about.
 * @type {(event: Event) => HTMLElement}
 */
export const targetOf = (event) => /** @type {HTMLElement} */ (event.target);

/**
 * What draws on a canvas.
 * @type {(canvas: HTMLCanvasElement, settings?: CanvasRenderingContext2DSettings) => CanvasRenderingContext2D}
 */
export const brushOf = (canvas, settings) => /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d', settings));

/**
 * The same of a canvas that nobody sees.
 * @type {(canvas: OffscreenCanvas, settings?: CanvasRenderingContext2DSettings) => OffscreenCanvasRenderingContext2D}
 */
export const brushOff = (canvas, settings) => /** @type {OffscreenCanvasRenderingContext2D} */ (canvas.getContext('2d', settings));

/**
 * Sets attributes of an SVG element.
 * @type {<E extends Element>(element: E, attributes: Record<string, string | number>) => E}
 */
export function set(element, attributes) {
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  return element;
}

/**
 * A number as people write it: no more digits than `digits`, no needless zeros.
 * @type {(value: number, digits?: number) => string}
 */
export function short(value, digits = 3) {
  const text = value.toFixed(digits);
  return (text.includes('.') ? text.replace(/\.?0+$/, '') : text).replace(/^-0$/, '0');
}

/**
 * With a true minus sign and all digits, for columns.
 * @type {(value: number, digits?: number) => string}
 */
export function fixed(value, digits = 2) {
  const text = value.toFixed(digits);
  return Number(text) < 0 ? `−${text.slice(1)}` : text.replace('-', '');
}

/** @type {(value: number, low: number, high: number) => number} */
export const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

/**
 * One call a displayed frame, however often it is asked for.
 * @type {(work: () => void) => () => void}
 */
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

/**
 * Follows a pointer from `pointerdown` to its end; `move(event, ended)` is called with every place.
 * @type {(event: Pressed, move: (event: PointerEvent, ended: boolean) => void) => void}
 */
export function follow(event, move) {
  const target = /** @type {HTMLElement} */ (event.currentTarget);
  target.setPointerCapture(event.pointerId);
  /** @type {(next: PointerEvent) => unknown} */
  const moved = (next) => next.pointerId === event.pointerId && move(next, false);
  /** @type {(next: PointerEvent) => void} */
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
