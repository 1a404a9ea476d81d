// Draws frames as `inbetween frame` does: the textures of all poses on the mesh, added up by their weights, cut by the exact area
// that the blended outline covers of each pixel. Where triangles overlap, the last one is seen: they are drawn from the last to the
// first, each pixel once (by the depth buffer).
import { coveredAreas } from './areas.js';
import { context, PointTexture, pictureTexture, program, texture } from './gl.js';
import { MESH, textured } from './shaders.js';

/** A texture that counts for less is not drawn. */
const FAINTEST = 1e-3;
/** Textures that are drawn at once; of more, the heaviest. WebGL2 has 16 for sure, and two hold places and areas. */
const MOST_TEXTURES = 13;
/** Texels that a pixel may span before a smaller picture is used, as in `render::texture`. */
const MOST_TEXELS_A_PIXEL = 2.28;
/** How far colours reach beyond the mesh, of the drawing's size: the outline is finer than the mesh's boundary. */
const SKIRT = 0.04;

export class PuppetPainter {
  constructor(canvas) {
    this.canvas = canvas;
    this.gl = context(canvas);
    this.layers = [];
    this.pictures = [];
    if (this.gl) this.build();
  }

  build() {
    this.programs = [];
    this.mesh = program(this.gl, ...MESH);
    this.areas = null;
  }

  /** Takes `api/puppet`, the meshes and, per layer and texture, a bitmap; without bitmaps the pictures that are there stay. */
  load(puppet, meshes, bitmaps) {
    if (!this.gl) return;
    this.layers.forEach((layer) => this.free(layer));
    if (bitmaps) {
      this.pictures.flat().forEach((picture) => this.gl.deleteTexture(picture));
      this.pictures = bitmaps.map((layer) => layer.map((bitmap) => pictureTexture(this.gl, bitmap)));
    }
    this.layers = puppet.layers.map((layer, k) => this.layer(layer, meshes[k], this.pictures[k]));
  }

  layer(puppet, mesh, pictures) {
    const { gl } = this;
    const drawn = new PointTexture(gl, mesh.vertices, puppet.textures.length);
    const textures = puppet.textures.map((of, k) => {
      const { width, height, origin, scale } = of.colour;
      drawn.fill(mesh.poses[of.pose], k);
      return {
        picture: pictures[k],
        row: k * drawn.rows,
        area: areaOf(mesh.triangles, mesh.poses[of.pose]) * scale * scale,
        texels: [scale / width, scale / height, (-origin[0] * scale) / width, (-origin[1] * scale) / height],
      };
    });
    const corners = new Uint32Array(4 * mesh.triangles.length);
    // The last triangle first, its corners in their order.
    for (let k = 0, to = 0; k < mesh.triangles.length; k++, to += 4) {
      const vertex = mesh.triangles[mesh.triangles.length - 3 - 3 * Math.floor(k / 3) + (k % 3)];
      corners.fill(vertex, to, to + 3);
    }
    const [low, high] = extent(mesh.poses[0]);
    return {
      textures,
      drawn,
      triangles: mesh.triangles,
      places: new PointTexture(gl, mesh.vertices),
      count: mesh.triangles.length,
      inside: this.corners(corners),
      skirt: this.corners(skirt(mesh)),
      skirtCount: mesh.rings.reduce((sum, ring) => sum + 6 * ring.length, 0),
      reach: SKIRT * Math.hypot(high[0] - low[0], high[1] - low[1]),
    };
  }

  corners(values) {
    const { gl } = this;
    const array = gl.createVertexArray();
    const buffer = gl.createBuffer();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribIPointer(0, 4, gl.UNSIGNED_INT, 0, 0);
    gl.bindVertexArray(null);
    return { array, buffer };
  }

  free(layer) {
    const { gl } = this;
    layer.drawn.free();
    layer.places.free();
    for (const { array, buffer } of [layer.inside, layer.skirt]) {
      gl.deleteVertexArray(array);
      gl.deleteBuffer(buffer);
    }
  }

  /** Clears the canvas. `view`: {scale, x, y}, from drawing units to pixels of the canvas. */
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

  /** Draws a frame on what is there. */
  frame(frame, { opacity = 1, tint = [0, 0, 0, 0], inLight = false } = {}) {
    const { gl } = this;
    for (const k of frame.order) {
      const shape = frame.layers[k];
      const layer = this.layers[k];
      if (!layer || shape.opacity <= 0) continue;
      const window = this.window(shape.rings);
      if (!window) continue;
      this.fillAreas(shape.rings, window);
      gl.enable(gl.SCISSOR_TEST);
      gl.scissor(window[0], this.canvas.height - window[3], window[2] - window[0], window[3] - window[1]);
      this.drawLayer(layer, shape, opacity * shape.opacity, tint, inLight);
    }
  }

  /** The pixels that some rings can touch: left, top, right, bottom. */
  window(rings) {
    let [left, top, right, bottom] = [Infinity, Infinity, -Infinity, -Infinity];
    for (const ring of rings) {
      for (let k = 0; k < ring.length; k += 2) {
        left = Math.min(left, ring[k]);
        right = Math.max(right, ring[k]);
        top = Math.min(top, ring[k + 1]);
        bottom = Math.max(bottom, ring[k + 1]);
      }
    }
    const [scale, x, y] = this.view;
    const { width, height } = this.canvas;
    const window = [
      Math.max(0, Math.floor(left * scale + x) - 1), Math.max(0, Math.floor(top * scale + y) - 1),
      Math.min(width, Math.ceil(right * scale + x) + 1), Math.min(height, Math.ceil(bottom * scale + y) + 1),
    ];
    return window[0] < window[2] && window[1] < window[3] ? window : null;
  }

  drawLayer(layer, shape, opacity, tint, inLight) {
    const { gl, canvas } = this;
    const total = shape.textureWeights.reduce((sum, weight) => sum + Math.max(weight, 0), 0);
    const shown = layer.textures
      .map((of, k) => ({ ...of, weight: shape.textureWeights[k] }))
      .filter(({ weight }) => weight > FAINTEST * total)
      .sort((a, b) => b.weight - a.weight)
      .slice(0, MOST_TEXTURES);
    if (shown.length === 0) return;
    const whole = shown.reduce((sum, { weight }) => sum + weight, 0);
    const { made, at } = (this.programs[shown.length] ??= program(gl, ...textured(shown.length)));
    gl.useProgram(made);
    gl.activeTexture(gl.TEXTURE0);
    layer.places.fill(shape.positions);
    bound(gl, 0, layer.places.texture);
    bound(gl, 1, this.areas.texture);
    bound(gl, 2, layer.drawn.texture);
    gl.uniform1i(at.places, 0);
    gl.uniform1i(at.areas, 1);
    gl.uniform1i(at.drawn, 2);
    gl.uniform2f(at.size, canvas.width, canvas.height);
    gl.uniform3fv(at.view, this.view);
    gl.uniform1f(at.skirt, layer.reach);
    gl.uniform1f(at.height, canvas.height);
    gl.uniform1f(at.opacity, opacity);
    gl.uniform4fv(at.tint, tint);
    gl.uniform1i(at.in_light, inLight);
    gl.uniform1iv(at['rows[0]'], shown.map(({ row }) => row));
    gl.uniform4fv(at['texels[0]'], shown.flatMap(({ texels }) => texels));
    gl.uniform1fv(at['weights[0]'], shown.map(({ weight }) => weight / whole));
    // One level for all of a texture, as the command does it.
    const seen = Math.max(areaOf(layer.triangles, shape.positions) * this.view[0] ** 2, 1e-6);
    const level = (area) => Math.max(0, Math.ceil(Math.log2(Math.sqrt(area / seen) / MOST_TEXELS_A_PIXEL)));
    gl.uniform1fv(at['levels[0]'], shown.map(({ area }) => level(area)));
    shown.forEach(({ picture }, k) => {
      bound(gl, 3 + k, picture);
      gl.uniform1i(at[`picture${k}`], 3 + k);
    });
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LESS);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.CULL_FACE);
    gl.bindVertexArray(layer.inside.array);
    gl.drawArrays(gl.TRIANGLES, 0, layer.count);
    // The skirt: only where nothing is yet.
    gl.disable(gl.CULL_FACE);
    gl.bindVertexArray(layer.skirt.array);
    gl.drawArrays(gl.TRIANGLES, 0, layer.skirtCount);
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.SCISSOR_TEST);
  }

  /** Fills the texture of areas where the window is; its rows count from the top. */
  fillAreas(rings, window) {
    const { gl, canvas } = this;
    if (this.areas?.width !== canvas.width || this.areas.height !== canvas.height) {
      gl.deleteTexture(this.areas?.texture ?? null);
      this.areas = { width: canvas.width, height: canvas.height, texture: texture(gl, gl.R8, canvas.width, canvas.height) };
    }
    bound(gl, 1, this.areas.texture);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, window[0], window[1], window[2] - window[0], window[3] - window[1], gl.RED, gl.UNSIGNED_BYTE, coveredAreas(rings, this.view, window));
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 4);
  }

  /** The mesh of a frame, over it. Colours are premultiplied. */
  wires(frame, { line, wrong, thickness = 0.5 }) {
    const { gl, canvas } = this;
    const { made, at } = this.mesh;
    gl.useProgram(made);
    gl.uniform2f(at.size, canvas.width, canvas.height);
    gl.uniform3fv(at.view, this.view);
    gl.uniform1i(at.places, 0);
    gl.uniform4fv(at.line, line);
    gl.uniform4fv(at.wrong, wrong);
    gl.uniform1f(at.thickness, thickness);
    for (const k of frame.order) {
      const layer = this.layers[k];
      if (!layer) continue;
      gl.activeTexture(gl.TEXTURE0);
      layer.places.fill(frame.layers[k].positions);
      bound(gl, 0, layer.places.texture);
      gl.bindVertexArray(layer.inside.array);
      gl.drawArrays(gl.TRIANGLES, 0, layer.count);
    }
  }
}

function bound(gl, unit, what) {
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(gl.TEXTURE_2D, what);
}

/** Two triangles an edge of the boundary, from it outward. */
function skirt(mesh) {
  const corners = [];
  mesh.rings.forEach((ring, r) => {
    const count = ring.length;
    const at = (k) => ring[(k + count) % count];
    // Outward is to one side of an outer ring that runs clockwise on the screen, and to the other otherwise; of holes alike.
    const clockwise = ringArea(ring, mesh.poses[0]) > 0;
    const forward = clockwise === (r === 0);
    for (let k = 0; k < count; k++) {
      const corner = (i, side) => (forward ? [at(i), at(i - 1), at(i + 1), side] : [at(i), at(i + 1), at(i - 1), side]);
      corners.push(...corner(k, 0), ...corner(k + 1, 0), ...corner(k + 1, 1), ...corner(k, 0), ...corner(k + 1, 1), ...corner(k, 1));
    }
  });
  return new Uint32Array(corners);
}

/** The area of the triangles that are not inverted. */
function areaOf(triangles, points) {
  let doubled = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [2 * triangles[t], 2 * triangles[t + 1], 2 * triangles[t + 2]];
    doubled += Math.max(0, (points[b] - points[a]) * (points[c + 1] - points[a + 1]) - (points[b + 1] - points[a + 1]) * (points[c] - points[a]));
  }
  return 0.5 * doubled;
}

function ringArea(ring, points) {
  let area = 0;
  for (let k = 0; k < ring.length; k++) {
    const [i, j] = [ring[k], ring[(k + 1) % ring.length]];
    area += points[2 * i] * points[2 * j + 1] - points[2 * j] * points[2 * i + 1];
  }
  return area;
}

/** The corners of the box around points x, y, x, y. */
export function extent(points) {
  const [low, high] = [[Infinity, Infinity], [-Infinity, -Infinity]];
  for (let k = 0; k < points.length; k++) {
    low[k & 1] = Math.min(low[k & 1], points[k]);
    high[k & 1] = Math.max(high[k & 1], points[k]);
  }
  return [low, high];
}
