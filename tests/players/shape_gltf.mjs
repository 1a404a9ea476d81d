// Proves `inbetween shape render -o X.glb` with the Khronos validator, and evaluates it with code of its own.
//
//   NODE_PATH=<node_modules with gltf-validator> node shape_gltf.mjs COMMAND SCENE FOLDER
//
// 1. The validator finds no error and no warning.
// 2. At every frame, morph targets and skin put the vertices of a file with --max-error 0, which has a key at every frame, where the
//    OBJ file of that frame has them, but for single precision; those of a file with the default within what it promises.
// 3. The targets are called like the examples, but the first.
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, readdirSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { basename, dirname, join } from 'node:path';

const [command, scene, folder] = process.argv.slice(2);
const require = createRequire(import.meta.url);
const load = (name) =>
  require(require.resolve(name, { paths: [process.cwd(), ...(process.env.NODE_PATH ?? '').split(':'), dirname(new URL(import.meta.url).pathname)] }));
const validator = load('gltf-validator');
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
const name = basename(dirname(scene));
const SHARE = 0.0005;
const SINGLE = 2e-6;
let failed = false;
const check = (holds, what) => {
  console.log(`${holds ? 'ok  ' : 'FAIL'} shape glTF ${name}: ${what}`);
  failed ||= !holds;
};
const run = (...args) => execFileSync(command, ['--quiet', 'shape', 'render', scene, ...args], { stdio: ['ignore', 'ignore', 'inherit'] });

function read(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const length = view.getUint32(12, true);
  const json = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + length)));
  const binary = 20 + length + 8;
  const width = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16 };
  const take = { 5121: [1, 'getUint8'], 5123: [2, 'getUint16'], 5125: [4, 'getUint32'], 5126: [4, 'getFloat32'] };
  const numbers = (index) => {
    const accessor = json.accessors[index];
    const start = binary + (json.bufferViews[accessor.bufferView].byteOffset ?? 0) + (accessor.byteOffset ?? 0);
    const [bytesEach, get] = take[accessor.componentType];
    return Float64Array.from({ length: accessor.count * width[accessor.type] }, (_, k) => view[get](start + bytesEach * k, true));
  };
  return { json, numbers };
}

// Column-major 4 x 4 matrices.
const times = (a, b) => Array.from({ length: 16 }, (_, k) => [0, 1, 2, 3].reduce((sum, m) => sum + a[4 * m + (k % 4)] * b[4 * Math.floor(k / 4) + m], 0));
function matrix({ translation: t = [0, 0, 0], rotation: [x, y, z, w] = [0, 0, 0, 1], scale: s = [1, 1, 1] }) {
  return [
    (1 - 2 * (y * y + z * z)) * s[0], 2 * (x * y + z * w) * s[0], 2 * (x * z - y * w) * s[0], 0,
    2 * (x * y - z * w) * s[1], (1 - 2 * (x * x + z * z)) * s[1], 2 * (y * z + x * w) * s[1], 0,
    2 * (x * z + y * w) * s[2], 2 * (y * z - x * w) * s[2], (1 - 2 * (x * x + y * y)) * s[2], 0,
    t[0], t[1], t[2], 1,
  ];
}
function mixed(a, b, part, path) {
  if (path !== 'rotation') return a.map((v, k) => v + (b[k] - v) * part);
  let dot = a.reduce((sum, v, k) => sum + v * b[k], 0);
  const sign = dot < 0 ? -1 : 1;
  const angle = Math.acos(Math.min(1, Math.abs(dot)));
  const [from, to] = angle < 1e-6 ? [1 - part, part] : [Math.sin((1 - part) * angle) / Math.sin(angle), Math.sin(part * angle) / Math.sin(angle)];
  return a.map((v, k) => v * from + b[k] * to * sign);
}

function model(bytes) {
  const { json, numbers } = read(bytes);
  const mesh = json.meshes[0];
  const primitive = mesh.primitives[0];
  const base = numbers(primitive.attributes.POSITION);
  const targets = (primitive.targets ?? []).map((target) => numbers(target.POSITION));
  const sets = Object.keys(primitive.attributes).filter((key) => key.startsWith('JOINTS_'));
  const influences = sets.map((key) => [numbers(primitive.attributes[key]), numbers(primitive.attributes[key.replace('JOINTS', 'WEIGHTS')])]);
  const skin = json.skins?.[0];
  const inverse = skin && numbers(skin.inverseBindMatrices);
  const parents = new Map(json.nodes.flatMap((node, k) => (node.children ?? []).map((child) => [child, k])));
  const animation = json.animations?.[0];
  const channels = (animation?.channels ?? []).map(({ sampler, target }) => {
    const { input, output } = animation.samplers[sampler];
    return { ...target, times: numbers(input), values: numbers(output) };
  });
  const at = (channel, time) => {
    const { times, values, path } = channel;
    const size = values.length / times.length;
    const key = (k) => Array.from(values.subarray(k * size, (k + 1) * size));
    let next = times.findIndex((t) => t > time);
    next = Math.max(1, next < 0 ? times.length - 1 : next);
    const part = Math.min(1, Math.max(0, (time - times[next - 1]) / (times[next] - times[next - 1])));
    return mixed(key(next - 1), key(next), part, path);
  };
  const state = (time) => {
    let weights = mesh.weights ?? [];
    const nodes = json.nodes.map((node) => ({ ...node }));
    for (const channel of channels) {
      const value = at(channel, time);
      if (channel.path === 'weights') weights = value;
      else nodes[channel.node][channel.path] = value;
    }
    const points = Float64Array.from(base);
    targets.forEach((target, k) => target.forEach((move, c) => (points[c] += weights[k] * move)));
    if (skin) {
      const world = (k) => (parents.has(k) ? times(world(parents.get(k)), matrix(nodes[k])) : matrix(nodes[k]));
      const joints = skin.joints.map((k, j) => times(world(k), Array.from(inverse.subarray(16 * j, 16 * j + 16))));
      for (let v = 0; v < points.length / 3; v++) {
        const p = [points[3 * v], points[3 * v + 1], points[3 * v + 2]];
        const moved = [0, 0, 0];
        for (const [joint, weight] of influences) {
          for (let k = 4 * v; k < 4 * v + 4; k++) {
            if (weight[k] === 0) continue;
            const m = joints[joint[k]];
            for (let c = 0; c < 3; c++) moved[c] += weight[k] * (m[c] * p[0] + m[4 + c] * p[1] + m[8 + c] * p[2] + m[12 + c]);
          }
        }
        points.set(moved, 3 * v);
      }
    }
    return { points, weights };
  };
  return { json, state, keys: channels[0]?.times.length ?? 1 };
}

const exactPath = join(folder, 'exact.glb');
const loosePath = join(folder, 'loose.glb');
run('-o', exactPath, '--max-error', '0');
run('-o', loosePath);
run('-o', join(folder, 'obj'));
const [exactBytes, looseBytes] = [exactPath, loosePath].map((path) => new Uint8Array(readFileSync(path)));
for (const [kind, bytes] of [['exact', exactBytes], ['default', looseBytes]]) {
  const { issues } = await validator.validateBytes(bytes, { maxIssues: 20 });
  check(issues.numErrors === 0 && issues.numWarnings === 0, `${kind}: ${issues.numErrors} errors, ${issues.numWarnings} warnings, ${bytes.length} bytes`);
  for (const message of issues.messages.filter((m) => m.severity < 2)) console.log(`     ${message.code} ${message.pointer} ${message.message}`);
}

const frames = readdirSync(join(folder, 'obj')).filter((file) => file.endsWith('.obj')).sort().map((file) =>
  Float64Array.from(readFileSync(join(folder, 'obj', file), 'utf8').split('\n').filter((line) => line.startsWith('v ')).flatMap((line) => line.split(' ').slice(1).map(Number))));
const fps = Number(/^\s*fps\s*=\s*([\d.]+)/m.exec(readFileSync(scene, 'utf8'))?.[1] ?? 24);
const exact = model(exactBytes);
const loose = model(looseBytes);
const extent = [0, 1, 2].map((c) => {
  let [low, high] = [Infinity, -Infinity];
  for (let k = c; k < frames[0].length; k += 3) [low, high] = [Math.min(low, frames[0][k]), Math.max(high, frames[0][k])];
  return high - low;
});
const diagonal = Math.hypot(...extent);

// Which vertex of the OBJ file each of the glTF file is: doubled at seams, in another order. Vertices at one place in some frame are told
// apart by the others.
const moments = [0, Math.floor(frames.length / 3), Math.floor((2 * frames.length) / 3), frames.length - 1];
const shown = moments.map((k) => exact.state(k / fps).points);
const count = shown[0].length / 3;
const cell = (p, k) => Math.round(p[k] / (1e-4 * diagonal));
const grid = new Map();
for (let v = 0; v < frames[0].length / 3; v++) {
  for (let k = 0; k < 8; k++) {
    const key = [0, 1, 2].map((c) => Math.floor(frames[0][3 * v + c] / (1e-4 * diagonal)) + ((k >> c) & 1)).join();
    grid.set(key, [...(grid.get(key) ?? []), v]);
  }
}
const partner = new Int32Array(count);
for (let v = 0; v < count; v++) {
  const apart = (u) => Math.max(...moments.map((frame, m) => Math.hypot(...[0, 1, 2].map((c) => shown[m][3 * v + c] - frames[frame][3 * u + c]))));
  const key = [0, 1, 2].map((c) => cell(shown[0], 3 * v + c)).join();
  const best = (grid.get(key) ?? []).reduce((best, u) => (best < 0 || apart(u) < apart(best) ? u : best), -1);
  partner[v] = best;
}
check(partner.every((u) => u >= 0), `${count} vertices are those of ${new Set(partner).size} in the OBJ files`);
const worst = (file) => {
  let most = 0;
  frames.forEach((frame, k) => {
    const { points } = file.state(k / fps);
    for (let v = 0; v < count; v++) {
      const u = Math.max(0, partner[v]);
      most = Math.max(most, Math.hypot(points[3 * v] - frame[3 * u], points[3 * v + 1] - frame[3 * u + 1], points[3 * v + 2] - frame[3 * u + 2]));
    }
  });
  return most / diagonal;
};
const [exactWorst, looseWorst] = [worst(exact), worst(loose)];
check(exactWorst <= SINGLE, `a key a frame: at most ${exactWorst.toExponential(1)} of the diagonal from the OBJ files, over ${frames.length} frames`);
// The promise is a share of the diagonal of all examples' common box, which is no smaller than a frame's by much.
check(looseWorst <= 2 * SHARE, `${loose.keys} keys instead of ${exact.keys}: at most ${looseWorst.toExponential(1)} of the diagonal`);

const names = exact.json.meshes[0].extras?.targetNames ?? [];
const examples = [...readFileSync(scene, 'utf8').matchAll(/\[\[example\]\]\s*name\s*=\s*"([^"]*)"/g)].map((m) => m[1]);
check(names.join() === examples.slice(1).join(), `targets are the examples but the first: ${names.join(', ')}`);
process.exit(failed ? 1 : 0);
