// @ts-check
// A mesh with its skirt on the graphics card.
import { Skirt } from './skirt.js';

/** @import { Mesh } from './answers.js' */
/** @import { Gl } from './gl.js' */

export class SkirtedMesh {
  /**
   * `coordinates`: for each texture, where it is at each vertex, x, y.
   * @param {Gl} gl
   * @param {Mesh} mesh
   * @param {Float32Array[]} coordinates
   */
  constructor(gl, mesh, coordinates) {
    this.gl = gl;
    this.skirt = new Skirt(mesh);
    const { corners, inside, values } = this.skirt;
    this.inside = corners.subarray(0, inside);
    this.array = gl.createVertexArray();
    this.indices = gl.createBuffer();
    this.places = gl.createBuffer();
    this.coordinates = gl.createBuffer();
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.indices);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, corners, gl.STATIC_DRAW);
    gl.bindVertexArray(null);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.coordinates);
    gl.bufferData(gl.ARRAY_BUFFER, values.byteLength * coordinates.length, gl.STATIC_DRAW);
    coordinates.forEach((of, k) => gl.bufferSubData(gl.ARRAY_BUFFER, k * values.byteLength, this.skirt.carried(of)));
  }

  /**
   * Makes ready to be drawn where `points` are: attribute k is where the k-th of the chosen textures is, the last one the place.
   * @type {(points: Float32Array, textures: number[]) => void}
   */
  bind(points, textures) {
    const { gl, skirt } = this;
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.coordinates);
    textures.forEach((texture, k) => attribute(gl, k, texture * skirt.values.byteLength));
    gl.bindBuffer(gl.ARRAY_BUFFER, this.places);
    gl.bufferData(gl.ARRAY_BUFFER, skirt.places(points), gl.STREAM_DRAW);
    attribute(gl, textures.length, 0);
  }

  draw() {
    const { gl, skirt } = this;
    gl.enable(gl.CULL_FACE);
    gl.drawElements(gl.TRIANGLES, skirt.inside, gl.UNSIGNED_INT, 0);
    // Wherever the skirt folds, it is still the boundary's colour.
    gl.disable(gl.CULL_FACE);
    gl.drawElements(gl.TRIANGLES, skirt.outside, gl.UNSIGNED_INT, this.inside.byteLength);
  }

  free() {
    const { gl } = this;
    gl.deleteVertexArray(this.array);
    [this.indices, this.places, this.coordinates].forEach((buffer) => gl.deleteBuffer(buffer));
  }
}

/**
 * Lets an attribute be pairs of numbers from the buffer that is bound.
 * @type {(gl: Gl, location: number, offset: number) => void}
 */
export function attribute(gl, location, offset) {
  gl.enableVertexAttribArray(location);
  gl.vertexAttribPointer(location, 2, gl.FLOAT, false, 0, offset);
}
