// @ts-check
// Who draws frames: the graphics card, or, where there is none, the processor.
import { brushOf } from './dom.js';
import { PuppetPainter } from './puppet.js';
import { ScannedPainter } from './scanned.js';

/** @import { Frame, Mesh, Puppet } from './answers.js' */
/** @import { Surface } from './surface.js' */

/** @typedef {{ scale: number, x: number, y: number }} Grid From drawing units to pixels: a scale and a shift. */
/**
 * How a frame is drawn: a tint is red, green, blue, and how much of it.
 * @typedef {{ opacity?: number, tint?: number[], inLight?: boolean }} Looks
 */
/** @typedef {Looks & { grid: Grid }} PaintedAs */
/** @typedef {{ line: number[], wrong: number[], thickness?: number }} Wires Colours, premultiplied, and half the width of lines. */
/**
 * Who draws frames on a canvas: `PuppetPainter` and `ScannedPainter` are such.
 * @typedef {{
 *   layers: object[],
 *   build?: () => void,
 *   load: (puppet: Puppet, surfaces: Surface[], bitmaps: ImageBitmap[][] | null, masks?: ImageBitmap[][] | null) => void,
 *   begin: (view: Grid) => void,
 *   frame: (frame: Frame, how: PaintedAs) => void,
 *   wires: (frame: Frame, meshes: Mesh[], how: Wires) => void,
 *   finish: () => void,
 * }} Painter
 */

/** What draws WebGL without a card calls itself. */
const SOFTWARE = /swiftshader|llvmpipe|softpipe|lavapipe|basic render/i;

/** Whether WebGL2 is there and drawn by a card. Asked of a canvas of its own: one that has had a context gets no other. */
function hasCard() {
  const gl = document.createElement('canvas').getContext('webgl2', { failIfMajorPerformanceCaveat: true });
  if (!gl) return false;
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  const name = gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return !SOFTWARE.test(name);
}

/**
 * The painter of a canvas, which says in `dataset.painter` which it is: `card` or `processor`. `?painter=` in the page's address asks for
 * one.
 * @type {(canvas: HTMLCanvasElement) => Painter}
 */
export function painterOf(canvas) {
  const asked = new URLSearchParams(location.search).get('painter');
  const wanted = asked ?? (hasCard() ? 'card' : 'processor');
  /** @type {WebGLContextAttributes} */
  const settings = { alpha: true, antialias: false, depth: true, stencil: false, premultipliedAlpha: true };
  const gl = wanted === 'card' ? canvas.getContext('webgl2', settings) : null;
  canvas.dataset.painter = gl ? 'card' : 'processor';
  return gl ? new PuppetPainter(canvas, gl) : new ScannedPainter(canvas, brushOf(canvas, { willReadFrequently: true }));
}
