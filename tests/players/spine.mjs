// Proves `inbetween render --format spine` with the official runtime, `@esotericsoftware/spine-core` of version 4.2 from npm.
// The runtime has a licence of its own: install it for the test, do not keep it.
//
//   NODE_PATH=<node_modules with @esotericsoftware/spine-core> node spine.mjs COMMAND SCENE FOLDER
//
// 1. The runtime reads atlas and skeleton.
// 2. At every frame's time it puts the vertices of a skeleton with --max-error 0.5 within that of where the .glb with --max-error 0 has
//    them, which comes from another writer and is evaluated with code of its own.
// 3. What its slots show, one upon the other, sums to the whole in every frame.
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, existsSync } from 'node:fs';
import { basename, dirname, join } from 'node:path';
import { pathToFileURL } from 'node:url';

const [command, scene, folder] = process.argv.slice(2);
const places = [process.cwd(), ...(process.env.NODE_PATH ?? '').split(':')];
const entry = places
  .flatMap((place) => [place, join(place, 'node_modules')])
  .map((place) => join(place, '@esotericsoftware/spine-core/dist/index.js'))
  .find((path) => existsSync(path));
if (!entry) {
  console.log('SKIPPED: @esotericsoftware/spine-core is not installed (npm install @esotericsoftware/spine-core@~4.2)');
  process.exit(0);
}
const spine = await import(pathToFileURL(entry));
mkdirSync(folder, { recursive: true });
const name = basename(dirname(scene));
let failed = false;
const check = (holds, what) => {
  console.log(`${holds ? 'ok  ' : 'FAIL'} Spine ${name}: ${what}`);
  failed ||= !holds;
};
const render = (...more) => execFileSync(command, ['render', scene, ...more], { stdio: ['ignore', 'ignore', 'ignore'] });

const output = join(folder, `${name}-spine`);
render('--format', 'spine', '-o', output, '--max-error', '0.5');
const json = JSON.parse(readFileSync(join(output, `${name}.json`), 'utf8'));
const atlas = new spine.TextureAtlas(readFileSync(join(output, `${name}.atlas`), 'utf8'));
class NoTexture extends spine.Texture {
  setFilters() {}
  setWraps() {}
  dispose() {}
}
for (const page of atlas.pages) {
  const header = readFileSync(join(output, page.name)).subarray(16, 24);
  check(header.readUInt32BE(0) === page.width && header.readUInt32BE(4) === page.height, `${page.name} is ${page.width} x ${page.height}`);
  page.setTexture(new NoTexture({ width: page.width, height: page.height }));
}
const reader = new spine.SkeletonJson(new spine.AtlasAttachmentLoader(atlas));
const data = reader.readSkeletonData(json);
const [animation] = data.animations;
check(data.slots.length === json.slots.length && animation.duration > 0, `read: ${data.slots.length} slots, ${animation.duration.toFixed(3)} s`);

// The exact frames, from the other writer.
const glb = join(folder, `${name}-0.glb`);
render('-o', glb, '--max-error', '0');
const bytes = readFileSync(glb);
const length = bytes.readUInt32LE(12);
const gltf = JSON.parse(bytes.subarray(20, 20 + length).toString());
const floats = (index) => {
  const accessor = gltf.accessors[index];
  const start = 28 + length + gltf.bufferViews[accessor.bufferView].byteOffset;
  return Array.from({ length: accessor.count * { SCALAR: 1, VEC2: 2, VEC3: 3 }[accessor.type] }, (_, k) => bytes.readFloatLE(start + 4 * k));
};
const perUnit = gltf.asset.extras.pixels_per_unit;
const [, height] = gltf.asset.extras.frame;
// Textures of a layer share their shapes; Spine's slots are named after layer and texture.
const plain = (text) => text.replace(/[^\p{L}\p{N}_]/gu, '-');
const exact = new Map();
for (const [index, node] of gltf.nodes.entries()) {
  if (node.mesh === undefined) continue;
  const primitive = gltf.meshes[node.mesh].primitives[0];
  const channel = gltf.animations?.[0].channels.find((c) => c.target.node === index && c.target.path === 'weights');
  const sampler = channel && gltf.animations[0].samplers[channel.sampler];
  exact.set(plain(node.name), {
    base: floats(primitive.attributes.POSITION),
    targets: (primitive.targets ?? []).map((target) => floats(target.POSITION)),
    times: sampler ? floats(sampler.input) : [0],
    uvs: floats(primitive.attributes.TEXCOORD_0),
  });
}

const skeleton = new spine.Skeleton(data);
let worst = 0;
let compared = 0;
let unequal = 0;
let keys = 0;
for (const slot of skeleton.slots) {
  const shapes = exact.get(slot.data.name);
  if (!shapes) continue;
  const attachment = slot.getAttachment();
  // The same vertex in the other order: the nearest by its place on the picture, since a corner may be a hundredth of a pixel from a landmark.
  const uvs = attachment.regionUVs;
  const order = [];
  const nearest = (u, v) => {
    let best = [1.5e-5, undefined];
    for (let k = 0; k < shapes.uvs.length / 2; k++) {
      const away = Math.max(Math.abs(shapes.uvs[2 * k] - u), Math.abs(shapes.uvs[2 * k + 1] - v));
      if (away < best[0]) best = [away, k];
    }
    return best[1];
  };
  for (let v = 0; v < uvs.length / 2; v++) order.push(nearest(uvs[2 * v], uvs[2 * v + 1]));
  if (new Set(order).size !== order.length || order.includes(undefined)) unequal++;
  const deform = json.animations[animation.name].attachments?.default?.[slot.data.name]?.[slot.data.name]?.deform;
  keys = Math.max(keys, deform?.length ?? 1);
  shapes.times.forEach((time, k) => {
    skeleton.setToSetupPose();
    animation.apply(skeleton, 0, time, false, [], 1, spine.MixBlend.setup, spine.MixDirection.mixIn);
    skeleton.updateWorldTransform(spine.Physics.none);
    const world = new Array(attachment.worldVerticesLength);
    attachment.computeWorldVertices(slot, 0, world.length, world, 0, 2);
    order.forEach((v, at) => {
      if (v === undefined) return;
      const move = (c) => shapes.base[3 * v + c] + (k === 0 ? 0 : shapes.targets[k - 1][3 * v + c]);
      const [x, y] = [move(0) * perUnit, move(1) * perUnit + height / 2];
      worst = Math.max(worst, Math.hypot(world[2 * at] - x, world[2 * at + 1] - y));
      compared++;
    });
  });
}
const frames = Math.max(...[...exact.values()].map((shapes) => shapes.times.length));
check(unequal === 0 && compared > 0, `${compared} vertices compared, each found by its place on the picture`);
check(worst <= 0.51, `${keys} keys instead of ${frames}: worst deviation ${worst.toFixed(4)} px`);

if (gltf.nodes[gltf.scenes[0].nodes[0]].children.length === 1) {
  let least = 1;
  for (const time of [...exact.values()][0].times) {
    skeleton.setToSetupPose();
    animation.apply(skeleton, 0, time, false, [], 1, spine.MixBlend.setup, spine.MixDirection.mixIn);
    least = Math.min(least, 1 - skeleton.drawOrder.reduce((through, slot) => through * (1 - slot.color.a), 1));
  }
  check(least > 1 - 0.01, `the slots upon one another let at most ${(1 - least).toExponential(1)} through`);
}
process.exit(failed ? 1 : 0);
