// A mesh on the graphics card, with a skirt around it: a band beyond the boundary that carries its colours on, since the outline that
// cuts them is finer than the boundary.

/** How far the skirt reaches, of the drawing's size. */
const REACH = 0.04;

export class SkirtedMesh {
  /** `coordinates`: for each texture, where it is at each vertex, x, y. The first triangles are drawn over the last. */
  constructor(gl, { vertices, triangles, rings, poses }, coordinates) {
    this.gl = gl;
    this.vertices = vertices;
    this.reach = REACH * diagonal(poses[0]);
    this.rim = rings.flatMap((ring, r) => rimOf(ring, (ringArea(ring, poses[0]) > 0) === (r === 0)));
    const skirt = skirtOf(rings, vertices);
    const indices = new Uint32Array(triangles.length + skirt.length);
    // The last triangle is drawn first, its corners in their order.
    for (let k = 0; k < triangles.length; k++) indices[k] = triangles[triangles.length - 3 - 3 * Math.floor(k / 3) + (k % 3)];
    indices.set(skirt, triangles.length);
    [this.inside, this.outside] = [indices.subarray(0, triangles.length), skirt.length];
    this.values = new Float32Array(2 * (vertices + this.rim.length));
    this.array = gl.createVertexArray();
    [this.indices, this.places, this.coordinates] = [0, 1, 2].map(() => gl.createBuffer());
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.indices);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
    gl.bindVertexArray(null);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.coordinates);
    gl.bufferData(gl.ARRAY_BUFFER, this.values.byteLength * coordinates.length, gl.STATIC_DRAW);
    coordinates.forEach((of, k) => gl.bufferSubData(gl.ARRAY_BUFFER, k * this.values.byteLength, this.skirted(of, 0)));
  }

  /** Values x, y of the vertices, and behind them those of the skirt's outer side, `reach` beyond. */
  skirted(points, reach) {
    const { values } = this;
    values.set(points);
    let to = 2 * this.vertices;
    for (const [vertex, before, after] of this.rim) {
      const [x, y] = [points[2 * after] - points[2 * before], points[2 * after + 1] - points[2 * before + 1]];
      const far = reach / Math.max(Math.hypot(x, y), 1e-6);
      values[to++] = points[2 * vertex] + far * y;
      values[to++] = points[2 * vertex + 1] - far * x;
    }
    return values;
  }

  /** Makes ready to be drawn where `points` are: attribute k is where the k-th of the chosen textures is, the last one the place. */
  bind(points, textures) {
    const { gl, values } = this;
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.coordinates);
    textures.forEach((texture, k) => attribute(gl, k, texture * values.byteLength));
    gl.bindBuffer(gl.ARRAY_BUFFER, this.places);
    gl.bufferData(gl.ARRAY_BUFFER, this.skirted(points, this.reach), gl.STREAM_DRAW);
    attribute(gl, textures.length, 0);
  }

  draw() {
    const { gl } = this;
    gl.enable(gl.CULL_FACE);
    gl.drawElements(gl.TRIANGLES, this.inside.length, gl.UNSIGNED_INT, 0);
    // Wherever the skirt folds, it is still the boundary's colour.
    gl.disable(gl.CULL_FACE);
    gl.drawElements(gl.TRIANGLES, this.outside, gl.UNSIGNED_INT, this.inside.byteLength);
  }

  free() {
    const { gl } = this;
    gl.deleteVertexArray(this.array);
    [this.indices, this.places, this.coordinates].forEach((buffer) => gl.deleteBuffer(buffer));
  }
}

/** Lets an attribute be pairs of numbers from the buffer that is bound. */
export function attribute(gl, location, offset) {
  gl.enableVertexAttribArray(location);
  gl.vertexAttribPointer(location, 2, gl.FLOAT, false, 0, offset);
}

/** Of each vertex of a ring: itself and the two beside it, such that outward is to the left of the way between them. */
function rimOf(ring, forward) {
  const at = (k) => ring[(k + ring.length) % ring.length];
  return Array.from(ring, (vertex, k) => (forward ? [vertex, at(k - 1), at(k + 1)] : [vertex, at(k + 1), at(k - 1)]));
}

/** Two triangles an edge of the boundary; the outer vertices are numbered on from `outer`. */
function skirtOf(rings, outer) {
  const corners = [];
  for (const ring of rings) {
    for (let k = 0; k < ring.length; k++) {
      const next = (k + 1) % ring.length;
      corners.push(ring[k], ring[next], outer + next, ring[k], outer + next, outer + k);
    }
    outer += ring.length;
  }
  return corners;
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

function diagonal(points) {
  const [low, high] = extent(points);
  return Math.hypot(high[0] - low[0], high[1] - low[1]);
}
