// Proves `inbetween render -o X.glb` with the Khronos validator, and evaluates the animation with code of its own.
//
//   NODE_PATH=<node_modules with gltf-validator> node gltf.mjs COMMAND SCENE FOLDER
//
// 1. The validator finds no error and no warning.
// 2. At every frame's time, the vertices of a file with --max-error 0.5 are within that of the vertices of one with --max-error 0,
//    which has a key at every frame.
// 3. Where the scene has no layers: some frame of the exact file has the vertices of each pose in `inbetween map`, but for one
//    scale and shift for all poses (the camera), if the animation rests on a pose at all.
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { basename, dirname, join } from 'node:path';

const [command, scene, folder] = process.argv.slice(2);
const require = createRequire(import.meta.url);
const load = (name) =>
  require(require.resolve(name, { paths: [process.cwd(), ...(process.env.NODE_PATH ?? '').split(':'), dirname(new URL(import.meta.url).pathname)] }));
const validator = load('gltf-validator');
mkdirSync(folder, { recursive: true });
const name = basename(dirname(scene));
let failed = false;
const check = (holds, what) => {
  console.log(`${holds ? 'ok  ' : 'FAIL'} glTF ${name}: ${what}`);
  failed ||= !holds;
};

function render(maxError) {
  const path = join(folder, `${name}-${maxError}.glb`);
  execFileSync(command, ['render', scene, '-o', path, '--max-error', String(maxError)], { stdio: ['ignore', 'ignore', 'ignore'] });
  return new Uint8Array(readFileSync(path));
}

function read(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const length = view.getUint32(12, true);
  const json = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + length)));
  const binary = 20 + length + 8;
  const width = { SCALAR: 1, VEC2: 2, VEC3: 3 };
  const floats = (index) => {
    const accessor = json.accessors[index];
    const start = binary + (json.bufferViews[accessor.bufferView].byteOffset ?? 0) + (accessor.byteOffset ?? 0);
    return Float64Array.from({ length: accessor.count * width[accessor.type] }, (_, k) => view.getFloat32(start + 4 * k, true));
  };
  return { json, floats };
}

// The first mesh of each layer, in the order of the file: base, targets, animation.
function layers({ json, floats }) {
  const animation = json.animations?.[0];
  const root = json.nodes[json.scenes[0].nodes[0]];
  return root.children.filter((layer) => json.nodes[layer].children).map((layer) => {
    const node = json.nodes[layer].children[0];
    const primitive = json.meshes[json.nodes[node].mesh].primitives[0];
    const channel = animation?.channels.find((c) => c.target.node === node && c.target.path === 'weights');
    const sampler = channel && animation.samplers[channel.sampler];
    return {
      base: floats(primitive.attributes.POSITION),
      targets: (primitive.targets ?? []).map((target) => floats(target.POSITION)),
      times: sampler ? floats(sampler.input) : [0],
      weights: sampler ? floats(sampler.output) : [],
    };
  });
}

function shape({ base, targets, times, weights }, time) {
  const result = Float64Array.from(base);
  if (targets.length === 0) return result;
  let next = times.findIndex((t) => t > time);
  next = Math.max(1, next < 0 ? times.length - 1 : next);
  const part = Math.min(1, Math.max(0, (time - times[next - 1]) / (times[next] - times[next - 1])));
  targets.forEach((target, k) => {
    const weight = weights[(next - 1) * targets.length + k] * (1 - part) + weights[next * targets.length + k] * part;
    if (weight !== 0) target.forEach((move, c) => (result[c] += weight * move));
  });
  return result;
}

function farthest(a, b) {
  let worst = 0;
  for (let v = 0; v < a.length; v += 3) worst = Math.max(worst, Math.hypot(a[v] - b[v], a[v + 1] - b[v + 1]));
  return worst;
}

const exactBytes = render(0);
const looseBytes = render(0.5);
for (const [kind, bytes] of [['exact', exactBytes], ['0.5 px', looseBytes]]) {
  const { issues } = await validator.validateBytes(bytes, { maxIssues: 20 });
  check(issues.numErrors === 0 && issues.numWarnings === 0, `${kind}: ${issues.numErrors} errors, ${issues.numWarnings} warnings, ${bytes.length} bytes`);
  for (const message of issues.messages.filter((m) => m.severity < 2)) console.log(`     ${message.code} ${message.pointer} ${message.message}`);
}
const exactFile = read(exactBytes);
const exact = layers(exactFile);
const loose = layers(read(looseBytes));
const perUnit = exactFile.json.asset.extras.pixels_per_unit;
let worst = 0;
let keys = 0;
exact.forEach((layer, k) => {
  for (const time of layer.times) worst = Math.max(worst, farthest(shape(layer, time), shape(loose[k], time)) * perUnit);
  keys = Math.max(keys, loose[k].times.length);
});
const frames = Math.max(...exact.map((layer) => layer.times.length));
check(worst <= 0.501, `${keys} keys instead of ${frames}: worst deviation ${worst.toFixed(4)} px`);

if (!/^\s*\[\[layer\]\]/m.test(readFileSync(scene, 'utf8'))) {
  const mapping = JSON.parse(execFileSync(command, ['map', scene, '-o', '-'], { maxBuffer: 1 << 30, stdio: ['ignore', 'pipe', 'ignore'] }));
  const layer = exact[0];
  const shapes = Array.from(layer.times, (time) => shape(layer, time));
  // Least squares for scale and shift from the file's y-down pixels to the pose.
  const fit = (vertices, points) => {
    const mean = (f) => vertices.reduce((sum, _, v) => sum + f(v), 0) / vertices.length;
    const [mx, my, px, py] = [mean((v) => vertices[v][0]), mean((v) => vertices[v][1]), mean((v) => points[3 * v]), mean((v) => -points[3 * v + 1])];
    let above = 0, below = 0;
    vertices.forEach(([x, y], v) => {
      above += (x - mx) * (points[3 * v] - px) + (y - my) * (-points[3 * v + 1] - py);
      below += (x - mx) ** 2 + (y - my) ** 2;
    });
    const scale = above / below;
    const shift = [px - scale * mx, py - scale * my];
    let residual = 0;
    vertices.forEach(([x, y], v) => {
      residual = Math.max(residual, Math.hypot(points[3 * v] - scale * x - shift[0], -points[3 * v + 1] - scale * y - shift[1]));
    });
    return { scale, shift, residual: residual * perUnit };
  };
  let met = [];
  for (const pose of mapping.poses) {
    const fits = shapes.map((points) => fit(pose.vertices, points)).filter((f) => f.residual < 0.01);
    if (fits.length > 0) met.push({ pose: pose.name, ...fits[0] });
  }
  const spread = (f) => Math.max(...met.map(f)) - Math.min(...met.map(f));
  if (met.length === 0) console.log(`     glTF ${name}: no frame lies on a pose`);
  else
    check(
      spread((m) => m.scale) < 1e-5 && spread((m) => m.shift[0]) < 1e-3 && spread((m) => m.shift[1]) < 1e-3,
      `frames meet ${met.length} of ${mapping.poses.length} poses of the mapping within ${Math.max(...met.map((m) => m.residual)).toExponential(1)} px, one camera`,
    );
}
process.exit(failed ? 1 : 0);
