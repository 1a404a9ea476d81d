// @ts-check
// What the pictures of a layer are painted on: its mesh, or a finer one on which they are registered to one another, which the mesh
// carries.
import { ringArea } from './geometry.js';

/** @import { FineMesh, Mesh, Shape } from './answers.js' */
/** @import { Words } from './api.js' */

export class Surface {
  /**
   * `mesh`: a layer of `api/mesh`; `fine`: one of `api/surface`, or null. It has what a mesh has: vertices, triangles, poses, rings.
   * @param {Mesh} mesh
   * @param {FineMesh | null} fine
   */
  constructor(mesh, fine) {
    this.fine = fine;
    const { vertices, triangles, rings } = fine ?? mesh;
    this.vertices = vertices;
    this.triangles = triangles;
    this.rings = rings;
    this.poses = fine ? mesh.poses.map((positions, pose) => this.added(positions, pose, 1, new Float32Array(2 * vertices))) : mesh.poses;
    // The outer boundary first.
    if (fine) this.rings = rings.slice().sort((a, b) => Math.abs(ringArea(b, this.poses[0])) - Math.abs(ringArea(a, this.poses[0])));
  }

  /**
   * A layer of a frame, with the positions of this surface's vertices. `weights`: of its poses.
   * @type {(shape: Shape) => Shape}
   */
  carried(shape) {
    if (!this.fine) return shape;
    const positions = new Float32Array(2 * this.vertices);
    shape.weights.forEach((weight, pose) => weight !== 0 && this.added(shape.positions, pose, weight, positions));
    return { ...shape, positions };
  }

  /**
   * Adds to `sum` `weight` times where the vertices are that a mesh at `positions` carries as in a pose.
   * @type {(positions: Float32Array, pose: number, weight: number, sum: Float32Array) => Float32Array}
   */
  added(positions, pose, weight, sum) {
    const { carriers, shares } = /** @type {FineMesh} */ (this.fine).anchors[pose];
    for (let vertex = 0, k = 0; vertex < this.vertices; vertex++) {
      for (let corner = 0; corner < 3; corner++, k++) {
        const share = weight * shares[k];
        sum[2 * vertex] += share * positions[2 * carriers[k]];
        sum[2 * vertex + 1] += share * positions[2 * carriers[k] + 1];
      }
    }
    return sum;
  }
}

/**
 * The layers of `api/surface`: null where a mesh is its own.
 * @type {(words: Words) => (FineMesh | null)[]}
 */
export function readSurfaces(words) {
  /** @type {(FineMesh | null)[]} */
  const layers = [];
  while (!words.done) {
    const vertices = words.u32();
    if (vertices === 0) {
      layers.push(null);
      continue;
    }
    const [triangles, poses, rings] = words.u32s(3);
    layers.push({
      vertices,
      triangles: words.u32s(3 * triangles),
      anchors: Array.from({ length: poses }, () => ({ carriers: words.u32s(3 * vertices), shares: words.f32s(3 * vertices) })),
      rings: Array.from({ length: rings }, () => words.u32s(words.u32())),
    });
  }
  return layers;
}
