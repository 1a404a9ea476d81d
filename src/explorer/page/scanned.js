// @ts-check
// Draws frames as `puppet.js` does, on the processor: where a browser has no graphics card, WebGL2 is missing or slower than this, since
// its price is one a triangle.
import { coveredAreas } from './areas.js';
import { brushOff } from './dom.js';
import { isUpright } from './geometry.js';
import { LightMix, PlainMix } from './mixing.js';
import { Scan } from './scan.js';
import { shownTextures, texelsOf, texturePlaces, windowOf } from './shown.js';
import { Skirt } from './skirt.js';
import { Squares } from './squares.js';
import { Texels } from './texels.js';

/** @import { Frame, Mesh, Puppet } from './answers.js' */
/** @import { Grid, Looks, PaintedAs, Wires } from './painter.js' */
/** @import { PlacedTexture } from './scan.js' */
/** @import { ShownTexture } from './shown.js' */
/** @import { Surface } from './surface.js' */

/**
 * @typedef {{
 *   skirt: Skirt, triangles: Uint32Array, edges: Edges | null, texels: number[], pictures: Texels[], places: Float32Array[],
 *   scaled: Record<string, Float32Array>,
 * }} Layer
 */
/** @typedef {{ of: Uint32Array, ends: Uint32Array }} Edges The edges of triangles. */

/** Textures that are drawn at once; of more, the heaviest. */
const MOST_TEXTURES = 64;

export class ScannedPainter {
  /**
   * `context`: the canvas's own, two-dimensional.
   * @param {HTMLCanvasElement} canvas
   * @param {CanvasRenderingContext2D} context
   */
  constructor(canvas, context) {
    this.canvas = canvas;
    this.context = context;
    /** @type {Layer[]} */
    this.layers = [];
    /** @type {Texels[][]} */
    this.pictures = [];
    this.scan = new Scan(MOST_TEXTURES);
    /** @type {number[]} */
    this.view;
    /** @type {ImageData} */
    this.image;
    /** @type {Uint32Array} */
    this.pixels;
    /** @type {OffscreenCanvasRenderingContext2D | null} */
    this.sheet = null;
    /** @type {{ plain: PlainMix, light: LightMix }} */
    this.mixes;
    /**
     * Of scenes that show nearest texels.
     * @type {Squares | null}
     */
    this.squares = null;
  }

  /**
   * As `PuppetPainter.load`.
   * @type {(puppet: Puppet, surfaces: Surface[], bitmaps: ImageBitmap[][] | null, masks?: ImageBitmap[][] | null) => void}
   */
  load(puppet, surfaces, bitmaps, masks) {
    if (bitmaps) this.squares = puppet.nearest ? new Squares() : null;
    this.squares?.load(puppet, surfaces, bitmaps, masks);
    if (bitmaps) this.pictures = bitmaps.map((layer) => layer.map((bitmap) => new Texels(bitmap)));
    this.layers = puppet.layers.map(({ textures }, k) => {
      const mesh = surfaces[k];
      const skirt = new Skirt(mesh);
      return {
        skirt,
        triangles: mesh.triangles,
        /** When they are wanted. */
        edges: null,
        texels: textures.map((of) => texelsOf(of, mesh)),
        pictures: this.pictures[k],
        // From 0 to 1 over the picture, of the skirt's vertices too.
        places: textures.map((of) => skirt.carried(texturePlaces(of, mesh)).slice()),
        scaled: {},
      };
    });
  }

  /**
   * Clears the canvas. `view`: {scale, x, y}, from drawing units to pixels of the canvas.
   * @type {(view: Grid) => void}
   */
  begin(view) {
    const { canvas } = this;
    this.view = [view.scale, view.x, view.y];
    this.context.clearRect(0, 0, canvas.width, canvas.height);
    this.isClear = true;
    if (this.image?.width === canvas.width && this.image.height === canvas.height) return;
    this.image = new ImageData(canvas.width, canvas.height);
    this.pixels = new Uint32Array(this.image.data.buffer);
    this.sheet = null;
    this.mixes = { plain: new PlainMix(canvas.width), light: new LightMix(canvas.width) };
  }

  /**
   * Draws a frame on what is there; nearest texels on the `grid` of the scene's frames.
   * @type {(frame: Frame, how: PaintedAs) => void}
   */
  frame(frame, { opacity = 1, tint = [0, 0, 0, 0], inLight = false, grid }) {
    if (this.squares) {
      this.squareFrame(this.squares, frame, opacity, { tint, inLight }, grid);
      return;
    }
    const mix = inLight ? this.mixes.light : this.mixes.plain;
    for (const k of frame.order) {
      const shape = frame.layers[k];
      const layer = this.layers[k];
      if (!layer || shape.opacity <= 0) continue;
      const window = windowOf(shape.rings, this.view, this.canvas);
      const shown = shownTextures(layer, shape, this.view[0], MOST_TEXTURES);
      if (!window || shown.length === 0) continue;
      const places = layer.skirt.places(shape.positions);
      for (let i = 0; i < places.length; i++) places[i] = places[i] * this.view[0] + this.view[1 + (i & 1)] - window[i & 1];
      this.scan.paint({
        skirt: layer.skirt,
        places,
        areas: coveredAreas(shape.rings, this.view, window),
        textures: texturesAt(layer, shown, mix),
        mix,
        seen: { opacity: opacity * shape.opacity, tint },
      }, window, this.pixels, this.canvas.width);
      this.put(window);
    }
  }

  /**
   * Draws a frame's pixels as squares.
   * @type {(squares: Squares, frame: Frame, opacity: number, looks: Looks, grid: Grid) => void}
   */
  squareFrame(squares, frame, opacity, looks, grid) {
    const { context, view: [scale, x, y] } = this;
    const size = scale / grid.scale;
    context.imageSmoothingEnabled = false;
    for (const k of frame.order) {
      const shape = frame.layers[k];
      const painted = shape.opacity > 0 ? squares.paint(k, shape, grid, looks) : null;
      if (!painted) continue;
      const { left, top, image } = painted;
      const sheet = new OffscreenCanvas(image.width, image.height);
      brushOff(sheet).putImageData(image, 0, 0);
      context.globalAlpha = opacity * shape.opacity;
      context.drawImage(sheet, (left - grid.x) * size + x, (top - grid.y) * size + y, image.width * size, image.height * size);
    }
    context.globalAlpha = 1;
    this.isClear = false;
  }

  /**
   * Puts what was painted over what is there.
   * @type {(window: number[]) => void}
   */
  put([left, top, right, bottom]) {
    const [width, height] = [right - left, bottom - top];
    const { canvas, context } = this;
    if (this.isClear) {
      context.putImageData(this.image, 0, 0, left, top, width, height);
    } else {
      this.sheet ??= brushOff(new OffscreenCanvas(canvas.width, canvas.height), { willReadFrequently: true });
      this.sheet.putImageData(this.image, 0, 0, left, top, width, height);
      context.drawImage(this.sheet.canvas, left, top, width, height, left, top, width, height);
    }
    this.isClear = false;
  }

  /** What is drawn is done. */
  finish() {}

  /**
   * The meshes of a frame, over it. Colours are premultiplied.
   * @type {(frame: Frame, meshes: Mesh[], how: Wires) => void}
   */
  wires(frame, meshes, { line, wrong, thickness = 0.5 }) {
    const { context, view: [scale, x, y] } = this;
    for (const k of frame.order) {
      if (!this.layers[k]) continue;
      const { triangles } = meshes[k];
      if (this.layers[k].edges?.of !== triangles) this.layers[k].edges = { of: triangles, ends: edgesOf(triangles) };
      const edges = this.layers[k].edges.ends;
      const { positions } = frame.layers[k];
      /** @type {(step: 'moveTo' | 'lineTo', vertex: number) => void} */
      const go = (step, vertex) => context[step](positions[2 * vertex] * scale + x, positions[2 * vertex + 1] * scale + y);
      context.lineWidth = 2 * thickness;
      context.beginPath();
      for (let e = 0; e < edges.length; e += 2) {
        go('moveTo', edges[e]);
        go('lineTo', edges[e + 1]);
      }
      context.strokeStyle = css(line);
      context.stroke();
      context.beginPath();
      for (let t = 0; t < triangles.length; t += 3) {
        const corners = triangles.subarray(t, t + 3);
        if (isUpright(corners, positions)) continue;
        go('moveTo', corners[0]);
        go('lineTo', corners[1]);
        go('lineTo', corners[2]);
        context.closePath();
      }
      context.fillStyle = css(wrong.map((part) => 0.45 * part));
      context.fill();
      context.strokeStyle = css(wrong);
      context.stroke();
    }
  }
}

/**
 * Textures in the size in which they are shown, and where they are at each vertex, in texels from the middle of the first.
 * @type {(layer: Layer, shown: ShownTexture[], mix: PlainMix | LightMix) => PlacedTexture[]}
 */
function texturesAt(layer, shown, mix) {
  const weights = mix.weights(shown.map(({ weight }) => weight));
  return shown.map(({ number, level }, k) => {
    const texels = layer.pictures[number].at(level);
    const key = `${number}/${texels.width}`;
    layer.scaled[key] ??= layer.places[number].map((value, i) => value * (i & 1 ? texels.height : texels.width) - 0.5);
    return { weight: weights[k], texels, at: layer.scaled[key] };
  });
}

/**
 * The edges of triangles, each once: two vertices.
 * @type {(triangles: Uint32Array) => Uint32Array}
 */
function edgesOf(triangles) {
  const known = new Map();
  for (let k = 0; k < triangles.length; k++) {
    const [a, b] = [triangles[k], triangles[k % 3 === 2 ? k - 2 : k + 1]];
    known.set(Math.min(a, b) * 2 ** 26 + Math.max(a, b), [a, b]);
  }
  return Uint32Array.from([...known.values()].flat());
}

/**
 * A premultiplied colour for a canvas.
 * @type {(colour: number[]) => string}
 */
function css([red, green, blue, alpha]) {
  /** @type {(value: number) => number} */
  const part = (value) => Math.round((255 * value) / alpha);
  return `rgb(${part(red)} ${part(green)} ${part(blue)} / ${alpha})`;
}
