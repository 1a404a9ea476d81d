// @ts-check
// The page's icons: strokes on a grid of 16, in the colour of the text around them.
import { s } from './dom.js';

/** @type {Record<string, string[]>} */
const PATHS = {
  undo: ['M6 3.5 2.5 7 6 10.5', 'M2.5 7h7a3.5 3.5 0 0 1 0 7H7'],
  redo: ['M10 3.5 13.5 7 10 10.5', 'M13.5 7h-7a3.5 3.5 0 0 0 0 7H9'],
  copy: ['M5.5 5.5h8v8h-8z', 'M10.5 5.5v-3h-8v8h3'],
  command: ['M2.5 3h11v10h-11z', 'm5 6.2 2 1.9-2 1.9', 'M8.5 10.2h2.6'],
  export: ['M8 10V2.5', 'M4.8 5.5 8 2.3l3.2 3.2', 'M2.5 9.5v4h11v-4'],
  keyboard: ['M1.5 4h13v8.5h-13z', 'M4.2 6.7h.1M7 6.7h.1M9.6 6.7h.1M12 6.7h.1M4.5 9.8h7'],
  sun: [
    'M8 5a3 3 0 1 0 0 6 3 3 0 0 0 0-6z',
    'M8 1.2v1.6M8 13.2v1.6M1.2 8h1.6M13.2 8h1.6M3.2 3.2l1.1 1.1M11.7 11.7l1.1 1.1M12.8 3.2l-1.1 1.1M4.3 11.7l-1.1 1.1',
  ],
  moon: ['M13.4 9.8A5.8 5.8 0 0 1 6.2 2.6a5.8 5.8 0 1 0 7.2 7.2z'],
  play: ['M4.5 2.8v10.4L13 8z'],
  pause: ['M5 3v10M11 3v10'],
  record: ['M8 3.6a4.4 4.4 0 1 0 0 8.8 4.4 4.4 0 0 0 0-8.8z'],
  stop: ['M4 4h8v8H4z'],
  loop: ['M3 8a4.2 4.2 0 0 1 4.2-4.2h5', 'm10.2 1.6 2.4 2.2-2.4 2.2', 'M13 8a4.2 4.2 0 0 1-4.2 4.2h-5', 'm5.8 14.4-2.4-2.2 2.4-2.2'],
  fit: ['M2.5 6V2.5H6M10 2.5h3.5V6M13.5 10v3.5H10M6 13.5H2.5V10'],
  plus: ['M8 3v10M3 8h10'],
  minus: ['M3 8h10'],
  close: ['m4 4 8 8M12 4l-8 8'],
  hand: ['M5.2 8.2V4.1a1.1 1.1 0 0 1 2.2 0v3.2M7.4 7V2.9a1.1 1.1 0 0 1 2.2 0V7'
    + 'M9.6 7.2V3.9a1.1 1.1 0 0 1 2.2 0v5.3c0 3-1.5 5-4.2 5-2 0-3-.9-3.9-2.5L2 8.9c-.5-1 .9-1.8 1.6-.9l1.6 1.9'],
  reach: ['M2.5 13.5 9 7', 'M9 3.5a3.5 3.5 0 1 1 0 7 3.5 3.5 0 0 1 0-7z', 'M9 6.9h.1'],
  bend: ['M2.8 12.2C3 6.5 6.5 3.4 12 3.6', 'M2.8 10.7a1.5 1.5 0 1 0 0 3 1.5 1.5 0 0 0 0-3zM12.6 2.1a1.5 1.5 0 1 0 0 3 1.5 1.5 0 0 0 0-3z'],
  mesh: ['m8 2 6 10.5H2z', 'm5 7.2 6 .1-3 5.2z'],
  onion: ['M5.6 3a5 5 0 1 0 0 10 5 5 0 0 0 0-10z', 'M9 3.6a5 5 0 0 1 0 8.8', 'M11.6 4.4a5 5 0 0 1 0 7.2'],
  compare: ['M8 1.8v12.4', 'M6 3.5H2.5v9H6', 'M10 3.5h3.5v9H10'],
  panel: ['M2 3h12v10H2z', 'M10 3v10'],
  places: ['M8 4.6a3.4 3.4 0 1 0 0 6.8 3.4 3.4 0 0 0 0-6.8z', 'M8 1.5v3M8 11.5v3M1.5 8h3M11.5 8h3', 'M8 8h.1'],
  snap: ['M3 3h.1M8 3h.1M13 3h.1M3 8h.1M8 8h.1M13 8h.1M3 13h.1M8 13h.1M13 13h.1'],
  warn: ['M8 2 14.5 13.5h-13z', 'M8 6.5v3.2M8 11.6h.1'],
  trash: ['M2.8 4.3h10.4M6 4.3V2.6h4v1.7M4.2 4.3l.6 9.1h6.4l.6-9.1'],
  point: ['m8 4.2 3.8 3.8L8 11.8 4.2 8z'],
  line: ['M2.8 12 6.6 6l3.2 3.6L13.2 4', 'M2.8 12h.1M6.6 6h.1M9.8 9.6h.1M13.2 4h.1'],
  key: ['m8 3.2 4.8 4.8L8 12.8 3.2 8z'],
  save: ['M3 8.5 6.6 12 13 4.5'],
  link: ['M3.6 4.6a1.6 1.6 0 1 0 0 .1zM15 11.4a1.6 1.6 0 1 0 0 .1z', 'm5 6 6.6 4.4'],
  pseudo: ['M2.5 13.5 11 5', 'M6.5 4.6h4.9v4.9'],
};

/**
 * An icon; what it stands for is said by the label of what holds it.
 * @type {(name: string) => SVGSVGElement}
 */
export function icon(name) {
  const filled = ['play', 'record', 'stop'].includes(name);
  return s('svg', { class: `icon${filled ? ' filled' : ''}`, viewBox: '0 0 16 16', 'aria-hidden': 'true', focusable: 'false' },
    PATHS[name].map((d) => s('path', { d })));
}
