// @ts-check
// Draws frames as `inbetween frame` does: the textures of all poses on the mesh, added up by their weights, cut by the exact area
// that the blended outline covers of each pixel. Where triangles overlap, the last one is seen: they are drawn from the last to the
// first, each pixel once (by the depth buffer).
import { coveredAreas } from './areas.js';
import { pictureTexture, program, texture } from './gl.js';
import { MESH, SQUARES, textured } from './shaders.js';
import { shownTextures, texelsOf, texturePlaces, windowOf } from './shown.js';
import { attribute, SkirtedMesh } from './skirted.js';
import { Squares } from './squares.js';

/** @import { Frame, Mesh, Puppet, PuppetLayer, Shape } from './answers.js' */
/** @import { Gl, Program } from './gl.js' */
/** @import { Grid, Looks, PaintedAs, Wires } from './painter.js' */
/** @import { Surface } from './surface.js' */

/** @typedef {{ width: number, height: number, texture: WebGLTexture }} Areas */
/** @typedef {{ pictures: WebGLTexture[], texels: number[], triangles: Uint32Array, mesh: SkirtedMesh }} Layer */

/** Textures that are drawn at once; of more, the heaviest. WebGL2 has 15 varyings for sure, and 16 attributes and pictures, of which
 * one holds places and one areas. */
const MOST_TEXTURES = 15;

export class PuppetPainter {
  /**
   * `gl`: the canvas's own context.
   * @param {HTMLCanvasElement} canvas
   * @param {Gl} gl
   */
  constructor(canvas, gl) {
    this.canvas = canvas;
    this.gl = gl;
    /** @type {number[]} */
    this.view;
    /** @type {Layer[]} */
    this.layers;
    /** @type {WebGLTexture[][]} */
    this.pictures;
    /** @type {Record<string, Program>} */
    this.programs;
    /** @type {Program} */
    this.mesh;
    /** @type {{ array: WebGLVertexArrayObject, buffer: WebGLBuffer }} */
    this.corners;
    /** @type {Areas | null} */
    this.areas;
    /** @type {Squares | null} */
    this.squares;
    this.build();
  }

  /** Everything anew, as when the context was lost. */
  build() {
    this.layers = [];
    this.pictures = [];
    this.programs = {};
    this.mesh = program(this.gl, ...MESH);
    this.corners = { array: this.gl.createVertexArray(), buffer: this.gl.createBuffer() };
    this.areas = null;
    /** Of scenes that show nearest texels. */
    this.squares = null;
  }

  /**
   * Takes `api/puppet`, a `Surface` a layer and, per layer and texture, a bitmap, of nearest texels also a mask; without bitmaps the
   * pictures that are there stay.
   * @type {(puppet: Puppet, surfaces: Surface[], bitmaps: ImageBitmap[][] | null, masks?: ImageBitmap[][] | null) => void}
   */
  load(puppet, surfaces, bitmaps, masks) {
    if (bitmaps) this.squares = puppet.nearest ? new Squares() : null;
    this.squares?.load(puppet, surfaces, bitmaps, masks);
    this.layers.forEach((layer) => layer.mesh.free());
    if (bitmaps) {
      this.pictures.flat().forEach((picture) => this.gl.deleteTexture(picture));
      this.pictures = bitmaps.map((layer) => layer.map((bitmap) => pictureTexture(this.gl, bitmap)));
    }
    this.layers = puppet.layers.map((layer, k) => this.layer(layer, surfaces[k], this.pictures[k]));
  }

  /** @type {(layer: PuppetLayer, mesh: Mesh, pictures: WebGLTexture[]) => Layer} */
  layer({ textures }, mesh, pictures) {
    return {
      pictures,
      texels: textures.map((of) => texelsOf(of, mesh)),
      triangles: mesh.triangles,
      mesh: new SkirtedMesh(this.gl, mesh, textures.map((of) => texturePlaces(of, mesh))),
    };
  }

  /**
   * Clears the canvas. `view`: {scale, x, y}, from drawing units to pixels of the canvas.
   * @type {(view: Grid) => void}
   */
  begin(view) {
    const { gl, canvas } = this;
    this.view = [view.scale, view.x, view.y];
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.frontFace(gl.CW);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  }

  /**
   * Draws a frame on what is there; nearest texels on the `grid` of the scene's frames.
   * @type {(frame: Frame, how: PaintedAs) => void}
   */
  frame(frame, { opacity = 1, tint = [0, 0, 0, 0], inLight = false, grid }) {
    const { gl } = this;
    if (this.squares) {
      this.squareFrame(this.squares, frame, opacity, { tint, inLight }, grid);
      return;
    }
    for (const k of frame.order) {
      const shape = frame.layers[k];
      const layer = this.layers[k];
      if (!layer || shape.opacity <= 0) continue;
      const window = windowOf(shape.rings, this.view, this.canvas);
      if (!window) continue;
      this.fillAreas(shape.rings, window);
      gl.enable(gl.SCISSOR_TEST);
      gl.scissor(window[0], this.canvas.height - window[3], window[2] - window[0], window[3] - window[1]);
      this.drawLayer(layer, shape, opacity * shape.opacity, tint, inLight);
    }
  }

  /**
   * Draws a frame's pixels as squares.
   * @type {(squares: Squares, frame: Frame, opacity: number, looks: Looks, grid: Grid) => void}
   */
  squareFrame(squares, frame, opacity, looks, grid) {
    const { gl, canvas, view: [scale, x, y] } = this;
    const size = scale / grid.scale;
    const { made, at } = (this.programs.squares ??= program(gl, ...SQUARES));
    gl.useProgram(made);
    gl.uniform1i(at.picture, 0);
    gl.uniform2f(at.size, canvas.width, canvas.height);
    gl.bindVertexArray(null);
    for (const k of frame.order) {
      const shape = frame.layers[k];
      const painted = shape.opacity > 0 ? squares.paint(k, shape, grid, looks) : null;
      if (!painted) continue;
      const { left, top, image } = painted;
      gl.activeTexture(gl.TEXTURE0);
      const picture = texture(gl, gl.RGBA8, image.width, image.height);
      gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, image.width, image.height, gl.RGBA, gl.UNSIGNED_BYTE, image.data);
      gl.uniform4f(at.box, (left - grid.x) * size + x, (top - grid.y) * size + y, image.width * size, image.height * size);
      gl.uniform1f(at.opacity, opacity * shape.opacity);
      gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
      gl.deleteTexture(picture);
    }
  }

  /** @type {(layer: Layer, shape: Shape, opacity: number, tint: number[], inLight: boolean) => void} */
  drawLayer(layer, shape, opacity, tint, inLight) {
    const { gl, canvas } = this;
    const shown = shownTextures(layer, shape, this.view[0], MOST_TEXTURES);
    if (shown.length === 0) return;
    const { made, at } = (this.programs[`${shown.length},${inLight}`] ??= program(gl, ...textured(shown.length, inLight)));
    gl.useProgram(made);
    bound(gl, 0, /** @type {Areas} */ (this.areas).texture);
    gl.uniform1i(at.areas, 0);
    gl.uniform2f(at.size, canvas.width, canvas.height);
    gl.uniform3fv(at.view, this.view);
    gl.uniform1f(at.height, canvas.height);
    gl.uniform1f(at.opacity, opacity);
    gl.uniform4fv(at.tint, tint);
    gl.uniform1fv(at['weights[0]'], shown.map(({ weight }) => weight));
    gl.uniform1fv(at['levels[0]'], shown.map(({ level }) => level));
    shown.forEach(({ number }, k) => {
      bound(gl, 1 + k, layer.pictures[number]);
      gl.uniform1i(at[`picture${k}`], 1 + k);
    });
    layer.mesh.bind(shape.positions, shown.map(({ number }) => number));
    // What is drawn first stays: the skirt is only where nothing is yet.
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LESS);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    layer.mesh.draw();
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.SCISSOR_TEST);
  }

  /**
   * Fills the texture of areas where the window is; its rows count from the top.
   * @type {(rings: Float32Array[], window: number[]) => void}
   */
  fillAreas(rings, window) {
    const { gl, canvas } = this;
    if (this.areas?.width !== canvas.width || this.areas.height !== canvas.height) {
      gl.deleteTexture(this.areas?.texture ?? null);
      this.areas = { width: canvas.width, height: canvas.height, texture: texture(gl, gl.R8, canvas.width, canvas.height) };
    }
    bound(gl, 0, this.areas.texture);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    const areas = coveredAreas(rings, this.view, window);
    const [left, top, right, bottom] = window;
    gl.texSubImage2D(gl.TEXTURE_2D, 0, left, top, right - left, bottom - top, gl.RED, gl.UNSIGNED_BYTE, areas);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 4);
  }

  /** Waits until what was drawn is done. */
  finish() {
    this.gl.readPixels(0, 0, 1, 1, this.gl.RGBA, this.gl.UNSIGNED_BYTE, new Uint8Array(4));
  }

  /**
   * The meshes of a frame, over it. Colours are premultiplied.
   * @type {(frame: Frame, meshes: Mesh[], how: Wires) => void}
   */
  wires(frame, meshes, { line, wrong, thickness = 0.5 }) {
    const { gl, canvas } = this;
    const { made, at } = this.mesh;
    gl.useProgram(made);
    gl.uniform2f(at.size, canvas.width, canvas.height);
    gl.uniform3fv(at.view, this.view);
    gl.uniform4fv(at.line, line);
    gl.uniform4fv(at.wrong, wrong);
    gl.uniform1f(at.thickness, thickness);
    gl.bindVertexArray(this.corners.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.corners.buffer);
    for (const k of frame.order) {
      if (!this.layers[k]) continue;
      const { triangles } = meshes[k];
      const { positions } = frame.layers[k];
      // Each triangle has its own corners, so that they can be told apart.
      const corners = new Float32Array(2 * triangles.length);
      triangles.forEach((vertex, to) => corners.set(positions.subarray(2 * vertex, 2 * vertex + 2), 2 * to));
      gl.bufferData(gl.ARRAY_BUFFER, corners, gl.STREAM_DRAW);
      attribute(gl, 0, 0);
      gl.drawArrays(gl.TRIANGLES, 0, triangles.length);
    }
  }
}

/** @type {(gl: Gl, unit: number, what: WebGLTexture) => void} */
function bound(gl, unit, what) {
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(gl.TEXTURE_2D, what);
}
