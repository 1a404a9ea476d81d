// Draws frames as `inbetween frame` does: the textures of all poses on the mesh, added up by their weights, cut by the exact area
// that the blended outline covers of each pixel.
import { context, PointTexture, pictureTexture, program, Target } from './gl.js';
import { AREA, CUT, MESH, TEXTURED } from './shaders.js';

/** A texture that counts for less is not drawn. */
const FAINTEST = 1e-3;
/** How far colours reach beyond the mesh, of the drawing's size: the outline is finer than the mesh's boundary. */
const SKIRT = 0.04;

export class PuppetPainter {
  constructor(canvas) {
    this.canvas = canvas;
    this.gl = context(canvas);
    this.layers = [];
    if (!this.gl) return;
    this.build();
  }

  build() {
    const { gl } = this;
    this.textured = program(gl, ...TEXTURED);
    this.area = program(gl, ...AREA);
    this.cut = program(gl, ...CUT);
    this.mesh = program(gl, ...MESH);
    this.colours = new Target(gl, gl.RGBA16F, true);
    this.areas = new Target(gl, gl.areaFormat, false);
    this.nothing = gl.createVertexArray();
    this.edges = gl.createVertexArray();
    this.edgeBuffer = gl.createBuffer();
    gl.bindVertexArray(this.edges);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.edgeBuffer);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 4, gl.FLOAT, false, 0, 0);
    gl.vertexAttribDivisor(0, 1);
    gl.bindVertexArray(null);
  }

  /** Takes `api/puppet`, the meshes and, per layer and texture, a bitmap. */
  load(puppet, meshes, bitmaps) {
    if (!this.gl) return;
    this.layers.forEach((layer) => this.free(layer));
    this.layers = puppet.layers.map((layer, k) => this.layer(layer, meshes[k], bitmaps[k]));
  }

  layer(puppet, mesh, bitmaps) {
    const { gl } = this;
    const textures = puppet.textures.map((texture, k) => {
      const { width, height, origin, scale } = texture.colour;
      return {
        picture: pictureTexture(gl, bitmaps[k]),
        drawn: new PointTexture(gl, mesh.vertices).fill(mesh.poses[texture.pose]),
        texels: [scale / width, scale / height, (-origin[0] * scale) / width, (-origin[1] * scale) / height],
      };
    });
    const corners = new Uint32Array(4 * mesh.triangles.length);
    mesh.triangles.forEach((vertex, k) => corners.set([vertex, vertex, vertex, 0], 4 * k));
    const [low, high] = extent(mesh.poses[0]);
    return {
      textures,
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
    layer.textures.forEach(({ picture, drawn }) => (gl.deleteTexture(picture), drawn.free()));
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
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.disable(gl.SCISSOR_TEST);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
  }

  /** Draws a frame on what is there. */
  frame(frame, { opacity = 1, tint = [0, 0, 0, 0], inLight = false } = {}) {
    for (const k of frame.order) {
      const shape = frame.layers[k];
      const layer = this.layers[k];
      if (!layer || shape.opacity <= 0) continue;
      const window = this.window(shape.rings);
      if (!window) continue;
      layer.places.fill(shape.positions);
      this.drawColours(layer, shape, window, inLight);
      this.drawAreas(shape.rings, window);
      this.drawCut(window, opacity * shape.opacity, tint, inLight);
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

  drawColours(layer, shape, window, inLight) {
    const { gl, canvas } = this;
    const { made, at } = this.textured;
    this.colours.bind(canvas.width, canvas.height);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(window[0], window[1], window[2] - window[0], window[3] - window[1]);
    gl.clearColor(0, 0, 0, 0);
    gl.depthMask(true);
    gl.colorMask(true, true, true, true);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.useProgram(made);
    gl.uniform2f(at.size, canvas.width, canvas.height);
    gl.uniform3fv(at.view, this.view);
    gl.uniform1f(at.skirt, layer.reach);
    gl.uniform1i(at.places, 0);
    gl.uniform1i(at.drawn, 1);
    gl.uniform1i(at.picture, 2);
    gl.uniform1i(at.in_light, inLight);
    bound(gl, 0, layer.places.texture);
    const total = shape.textureWeights.reduce((sum, weight) => sum + Math.max(weight, 0), 0);
    const shown = layer.textures
      .map((texture, k) => ({ ...texture, weight: shape.textureWeights[k] }))
      .filter(({ weight }) => weight > FAINTEST * total);
    const whole = shown.reduce((sum, { weight }) => sum + weight, 0);
    gl.enable(gl.DEPTH_TEST);
    gl.frontFace(gl.CCW);
    gl.disable(gl.BLEND);
    // Depth first: each pixel belongs to one triangle, whatever the number of textures.
    const pass = () => {
      gl.uniform1f(at.triangles, layer.count / 3);
      gl.enable(gl.CULL_FACE);
      gl.bindVertexArray(layer.inside.array);
      gl.drawArrays(gl.TRIANGLES, 0, layer.count);
      gl.disable(gl.CULL_FACE);
    };
    gl.colorMask(false, false, false, false);
    gl.depthFunc(gl.LEQUAL);
    if (shown.length > 0) bound(gl, 1, shown[0].drawn.texture), bound(gl, 2, shown[0].picture);
    pass();
    gl.colorMask(true, true, true, true);
    gl.depthMask(false);
    gl.enable(gl.BLEND);
    for (const texture of shown) {
      bound(gl, 1, texture.drawn.texture);
      bound(gl, 2, texture.picture);
      gl.uniform4fv(at.texels, texture.texels);
      gl.uniform1f(at.weight, texture.weight / whole);
      gl.depthFunc(gl.EQUAL);
      gl.blendFunc(gl.ONE, gl.ONE);
      pass();
    }
    // Skirts overlap each other: only where nothing is yet, so one after the other would add up. The heaviest texture serves.
    const heaviest = shown.reduce((best, texture) => (!best || texture.weight > best.weight ? texture : best), null);
    if (heaviest) {
      bound(gl, 1, heaviest.drawn.texture);
      bound(gl, 2, heaviest.picture);
      gl.uniform4fv(at.texels, heaviest.texels);
      gl.uniform1f(at.weight, 1);
      gl.uniform1f(at.triangles, 0);
      gl.depthFunc(gl.LEQUAL);
      gl.blendFunc(gl.ONE_MINUS_DST_ALPHA, gl.ONE);
      gl.bindVertexArray(layer.skirt.array);
      gl.drawArrays(gl.TRIANGLES, 0, layer.skirtCount);
    }
    gl.disable(gl.DEPTH_TEST);
  }

  drawAreas(rings, window) {
    const { gl, canvas } = this;
    const { made, at } = this.area;
    const ends = ringEdges(rings);
    this.areas.bind(canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.useProgram(made);
    gl.uniform2f(at.size, canvas.width, canvas.height);
    gl.uniform3fv(at.view, this.view);
    gl.uniform4fv(at.window, window);
    gl.bindVertexArray(this.edges);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.edgeBuffer);
    gl.bufferData(gl.ARRAY_BUFFER, ends, gl.STREAM_DRAW);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, ends.length / 4);
  }

  drawCut(window, opacity, tint, inLight) {
    const { gl, canvas } = this;
    const { made, at } = this.cut;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.scissor(window[0], canvas.height - window[3], window[2] - window[0], window[3] - window[1]);
    gl.useProgram(made);
    gl.uniform1i(at.colours, 0);
    gl.uniform1i(at.areas, 1);
    gl.uniform1f(at.height, canvas.height);
    gl.uniform1f(at.opacity, opacity);
    gl.uniform1i(at.in_light, inLight);
    gl.uniform4fv(at.tint, tint);
    bound(gl, 0, this.colours.texture);
    bound(gl, 1, this.areas.texture);
    gl.bindVertexArray(this.nothing);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.disable(gl.SCISSOR_TEST);
  }

  /** The mesh of a frame, over it. Colours are premultiplied. */
  wires(frame, { line, wrong, thickness = 0.5 }) {
    const { gl, canvas } = this;
    const { made, at } = this.mesh;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.useProgram(made);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.disable(gl.CULL_FACE);
    gl.uniform2f(at.size, canvas.width, canvas.height);
    gl.uniform3fv(at.view, this.view);
    gl.uniform1f(at.triangles, 0);
    gl.uniform1i(at.places, 0);
    gl.uniform4fv(at.line, line);
    gl.uniform4fv(at.wrong, wrong);
    gl.uniform1f(at.thickness, thickness);
    for (const k of frame.order) {
      const layer = this.layers[k];
      if (!layer) continue;
      layer.places.fill(frame.layers[k].positions);
      bound(gl, 0, layer.places.texture);
      gl.bindVertexArray(layer.inside.array);
      gl.drawArrays(gl.TRIANGLES, 0, layer.count);
    }
  }
}

function bound(gl, unit, texture) {
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(gl.TEXTURE_2D, texture);
}

/** The edges of all rings, as x, y, x, y. */
function ringEdges(rings) {
  const ends = new Float32Array(2 * rings.reduce((sum, ring) => sum + ring.length, 0));
  let next = 0;
  for (const ring of rings) {
    const count = ring.length;
    for (let k = 0; k < count; k += 2, next += 4) {
      ends[next] = ring[k];
      ends[next + 1] = ring[k + 1];
      ends[next + 2] = ring[(k + 2) % count];
      ends[next + 3] = ring[(k + 3) % count];
    }
  }
  return ends;
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
