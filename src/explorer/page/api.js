// @ts-check
// Requests to the server behind the page. Addresses are relative: the token is part of the page's own address.
import { exchange } from './connections.js';

/** @import { Frame, Got, Mesh, Posted, Problem, Shape } from './answers.js' */
/** @import { Answer, Method } from './connections.js' */

/** @typedef {{ [name: string]: string | number | number[] | string[] | null | undefined }} Fields */

/** An answer that says why there is none: `problem` is what the server wrote. */
export class Refused extends Error {
  /**
   * @param {number} status
   * @param {Problem | null} problem
   */
  constructor(status, problem) {
    super(problem?.message ?? `the server answered ${status}`);
    this.status = status;
    this.problem = problem;
  }
}

/**
 * What went wrong, as it is told to the artist.
 * @type {(error: unknown) => Problem}
 */
export function problemOf(error) {
  const { problem, message } = /** @type {Refused} */ (error);
  return problem ?? { message };
}

/** @type {(method: Method, route: string, body?: unknown) => Promise<Answer>} */
async function asked(method, route, body) {
  const answer = await exchange(method, route, body);
  if (answer.status === 200) return answer;
  let problem = null;
  try {
    problem = JSON.parse(answer.text()).error;
  } catch { /* an answer that is no JSON */ }
  throw new Refused(answer.status, problem);
}

/**
 * `{at: [1, 2], box: null}` as `?at=1,2`.
 * @type {(fields: Fields) => string}
 */
export function query(fields) {
  const search = new URLSearchParams();
  for (const [name, value] of Object.entries(fields)) {
    if (value === null || value === undefined || value === '') continue;
    search.append(name, Array.isArray(value) ? value.join(',') : String(value));
  }
  const text = search.toString().replaceAll('%2C', ',');
  return text && `?${text}`;
}

/** @type {<R extends keyof Got>(route: R, fields?: Fields) => Promise<Got[R]>} */
export async function getJson(route, fields = {}) {
  return JSON.parse((await asked('GET', `${route}${query(fields)}`)).text());
}

/**
 * The 4-byte numbers of a binary answer.
 * @type {(route: string, fields?: Fields) => Promise<Words>}
 */
export async function getWords(route, fields = {}) {
  return new Words((await asked('GET', `${route}${query(fields)}`)).bytes);
}

/** @type {<R extends keyof Posted>(route: R, body?: object) => Promise<Posted[R]>} */
export async function postJson(route, body = {}) {
  return JSON.parse((await asked('POST', route, body)).text());
}

/** @type {(route: string, body?: object) => Promise<Words>} */
export async function postWords(route, body = {}) {
  return new Words((await asked('POST', route, body)).bytes);
}

/** Little-endian u32 and f32 read one after the other. */
export class Words {
  /** @param {Uint8Array} bytes */
  constructor({ buffer, byteOffset, byteLength }) {
    this.whole = new Uint32Array(buffer, byteOffset, byteLength / 4);
    this.real = new Float32Array(buffer, byteOffset, byteLength / 4);
    this.next = 0;
  }

  get done() {
    return this.next >= this.whole.length;
  }

  u32() {
    return this.whole[this.next++];
  }

  f32() {
    return this.real[this.next++];
  }

  /** @type {(count: number) => Uint32Array} */
  u32s(count) {
    return this.whole.subarray(this.next, (this.next += count));
  }

  /** @type {(count: number) => Float32Array} */
  f32s(count) {
    return this.real.subarray(this.next, (this.next += count));
  }
}

/**
 * The blocks of `api/frame`.
 * @type {(words: Words) => Frame[]}
 */
export function readFrames(words) {
  const frames = [];
  while (!words.done) frames.push(readFrame(words));
  return frames;
}

/** @type {(words: Words) => Frame} */
function readFrame(words) {
  words.u32();
  const [shape, revision, poses, layers, inverted] = words.u32s(5);
  const weights = words.f32s(poses);
  const textureWeights = words.f32s(poses);
  const order = Array.from(words.u32s(layers));
  const shapes = Array.from({ length: layers }, () => {
    const vertices = words.u32();
    const own = words.u32();
    const textures = words.u32();
    const triangles = words.u32();
    const rings = words.u32();
    return {
      opacity: words.f32(),
      positions: words.f32s(2 * vertices),
      weights: words.f32s(own),
      textureWeights: words.f32s(textures),
      inverted: words.u32s(Math.ceil(triangles / 32)),
      rings: Array.from({ length: rings }, () => words.f32s(2 * words.u32())),
    };
  });
  return { shape, revision, inverted, weights, textureWeights, order, layers: shapes };
}

/**
 * The layers of `api/mesh`.
 * @type {(words: Words) => Mesh[]}
 */
export function readMeshes(words) {
  const meshes = [];
  while (!words.done) {
    const [vertices, triangles, poses, rings] = words.u32s(4);
    meshes.push({
      vertices,
      triangles: words.u32s(3 * triangles),
      poses: Array.from({ length: poses }, () => words.f32s(2 * vertices)),
      rings: Array.from({ length: rings }, () => words.u32s(words.u32())),
    });
  }
  return meshes;
}
