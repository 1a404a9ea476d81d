// Drives the page of `inbetween explore` in headless Chromium, with real pointer and key events, and checks what it shows and does.
//
//   node explorer.mjs COMMAND SCENE FOLDER [all|look] [card|processor]
//
// With `look` only what the page shows is compared, nothing is edited. The last word is who paints (`?painter=`): WebGL2, which is
// computed on the processor where there is no graphics card, or the page's own painter, which it takes by itself then.
//
// COMMAND is a built `inbetween`. The scene is copied into FOLDER first and edited there; pictures of the page go there, too.
// `driver.mjs` says where the browser is looked for. Checks that a scene gives no occasion for (it has no plane, no landmarks) are left out.
import { execFileSync } from 'node:child_process';
import { cpSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { request } from 'node:http';
import { basename, dirname, join, resolve } from 'node:path';
import { browser as launched, drawn, edited, report, saved, serve, state, until } from './driver.mjs';
import { conflict, keysInTime, landmarkByKeys, lines, pseudoPoses } from './edits.mjs';
import { decodePng, difference } from './picture.mjs';
import { placesOfMatches, placesOfPicture } from './places.mjs';

const [command, original, folder] = process.argv.slice(2, 5).map((path) => resolve(path));
const looksOnly = process.argv[5] === 'look';
const painter = process.argv[6] ?? 'card';
const name = basename(dirname(original));
rmSync(join(folder, name), { recursive: true, force: true });
mkdirSync(folder, { recursive: true });
cpSync(dirname(original), join(folder, name), { recursive: true });
const scene = join(folder, name, basename(original));
const run = (...rest) => execFileSync(command, rest, { cwd: folder, stdio: ['ignore', 'pipe', 'ignore'] });

const { check, errors, run: prove } = report(name);

const { address, end } = await serve(command, [scene], folder);
const browser = await launched();
await prove(proofs, () => browser.close(), end);

async function proofs() {
  await strangers();
  const context = await browser.newContext({ viewport: { width: 1440, height: 1000 }, deviceScaleFactor: 1, colorScheme: 'light' });
  const page = await context.newPage();
  const outside = [];
  page.on('pageerror', (error) => errors.push(error.message));
  page.on('console', (message) => message.type() === 'error' && errors.push(`${message.text()} ${message.location().url.replace(address, '')}`));
  const kept = [];
  const sent = [];
  page.on('websocket', (socket) => {
    (socket.url().startsWith(address.replace('http:', 'ws:')) ? kept : outside).push(socket.url());
    socket.on('framesent', ({ payload }) => sent.push(String(payload)));
  });
  page.on('request', (asked) => !asked.url().startsWith(address) && !/^(blob|data):/.test(asked.url()) && outside.push(asked.url()));
  await page.goto(`${address}?painter=${painter}`);
  const answer = await page.evaluate(async () => (await fetch('api/scene')).json());
  const plane = answer.dimension === 2;
  await drawn(page);
  check(await page.getAttribute('#picture', 'data-painter') === painter, `painted by the ${painter}`);
  check(await page.title() === `${answer.name} – inbetween`, 'the page opens and draws');
  await page.screenshot({ path: join(folder, `${name}-page.png`) });

  if (painter === 'processor') await mixes(page);
  await pixels(page, answer, answer.poses[0].at, 'at the first pose');
  if (plane) await probe(page, answer);
  const tools = { page, scene, check, centre, drag, drawn, edited, saved, padPoint, sent };
  await placesOfPicture(tools);
  await placesOfMatches(tools);
  await drawn(page);
  if (looksOnly) return reports(outside, kept);
  await keys(page);
  if (plane) await movedPose(page, answer);
  await landmark(page);
  await landmarkByKeys(tools);
  await lines(tools);
  if (plane) await gesture(page, answer);
  await keysInTime(tools);
  if (plane) await pseudoPoses(tools);
  if (plane) await maps(page);
  await onPicture(page);
  await outsideChange(page);
  if (plane) await conflict(tools);
  await exported(page);
  await labels(page);
  reports(outside, kept);
}

function reports(outside, kept) {
  check(errors.length === 0, `the page reports no error${errors.length > 0 ? `: ${errors.join('; ')}` : ''}`);
  check(kept.length > 0 && kept.length <= 6, `${kept.length} connections stayed open for its requests`);
  check(outside.length === 0, `the page asks for nothing elsewhere${outside.length > 0 ? `: ${outside}` : ''}`);
}

// Who else asks.

async function strangers() {
  const { port, pathname } = new URL(address);
  const asked = (path, headers = {}) => new Promise((done, refuse) => {
    request({ host: '127.0.0.1', port, path, headers }, (answer) => {
      answer.resume();
      done(answer.statusCode);
    }).on('error', refuse).end();
  });
  check(await asked(`${pathname}api/state`) === 200, 'the right token is answered');
  check(await asked(pathname.replace(/.\/$/, (end) => (end[0] === '0' ? '1/' : '0/')) + 'api/state') === 403, 'a wrong token is refused');
  check(await asked('/') === 403, 'no token is refused');
  check(await asked(`${pathname}api/state`, { Origin: 'http://localhost:1' }) === 403, 'a second origin is refused');
  check(await asked(`${pathname}api/state`, { Host: `elsewhere.example:${port}` }) === 403, 'another host is refused');
  // The same from a page of another origin, by the browser's own rules.
  const other = await browser.newPage();
  await other.route('http://elsewhere.test/', (route) => route.fulfill({ contentType: 'text/html', body: '<!doctype html><title>elsewhere</title>' }));
  await other.goto('http://elsewhere.test/');
  const read = await other.evaluate((url) => fetch(url).then(() => 'read', () => 'refused'), `${address}api/state`);
  check(read === 'refused', 'a page of another origin reads nothing, even with the token');
  await other.close();
}

async function shownPlace(page) {
  return (await page.getAttribute('#picture', 'data-at')).split(',').map(Number);
}

async function weights(page) {
  const rows = await page.$$eval('#weights .weight', (all) => all.map((row) => row.getAttribute('aria-label')));
  return rows.map((row) => Number(/weight (-?[\d.]+)/.exec(row)[1]));
}

/** Two textures of any colour and alpha, added up by the page's own painter, against the sums themselves. */
async function mixes(page) {
  const off = await page.evaluate(async () => {
    const { LightMix, PlainMix } = await import('./mixing.js');
    let state = 1;
    const random = (most) => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0) % (most + 1);
    const light = (value) => (value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4);
    const value = (part) => (part <= 0.0031308 ? 12.92 * part : 1.055 * part ** (1 / 2.4) - 0.055);
    const same = (part) => part;
    return [[new PlainMix(1), same, same], [new LightMix(1), light, value]].map(([mix, into, back]) => {
      let worst = 0;
      for (let k = 0; k < 4000; k++) {
        const colours = [0, 1].map(() => [random(255), random(255), 255 - 255 * (k & 1), k % 3 ? random(255) : 255]);
        const weights = [0.5 + random(128) / 256, 0];
        weights[1] = 1 - weights[0];
        mix.begin(1);
        mix.weights(weights).forEach((weight, t) => {
          const [r, g, b, a] = colours[t];
          mix.add({ width: 1, height: 1, stride: 2, data: new Uint32Array(4).fill(r | (g << 8) | (b << 16) | (a << 24)) }, 0, 0, 0, 0, 1, weight);
        });
        const pixel = mix.pixel(0, 255, { opacity: 1, tint: [0, 0, 0, 0] });
        const alpha = weights[0] * colours[0][3] + weights[1] * colours[1][3];
        worst = Math.max(worst, Math.abs((pixel >>> 24) - alpha));
        for (let c = 0; c < 3 && alpha > 0; c++) {
          const sum = [0, 1].reduce((all, t) => all + weights[t] * colours[t][3] * into(colours[t][c] / 255), 0);
          // What is nearly clear may be off by more: nobody sees it.
          worst = Math.max(worst, (Math.abs(((pixel >>> (8 * c)) & 255) - 255 * back(sum / alpha)) * alpha) / 255);
        }
      }
      return worst;
    });
  });
  check(off.every((worst) => worst < 1.6), `the painter's sums of textures are off by at most ${off.map((worst) => worst.toFixed(2)).join(' and, in light, ')} of 255`);
}

/** The frame on the screen against that of the command, at one pixel a pixel. */
async function pixels(page, { animation }, at, what) {
  await page.click('#actual-size');
  await drawn(page, at);
  const curves = await page.evaluate(async () => (await (await fetch('api/puppet')).json()).layers.some((layer) => layer.curves));
  // Curves are shown where the probe rests.
  if (curves) await page.waitForFunction((place) => document.documentElement.dataset.curves === place && document.querySelector('.curves:not(.hidden)'), at.join(','));
  const clip = await page.evaluate(() => {
    const { x, y, width, height } = document.querySelector('.paper').getBoundingClientRect();
    const stage = document.getElementById('stage').getBoundingClientRect();
    return { x: Math.max(x, stage.x), y: Math.max(y, stage.y), width: Math.min(x + width, stage.right) - Math.max(x, stage.x), height: Math.min(y + height, stage.bottom) - Math.max(y, stage.y), left: Math.max(0, stage.x - x), top: Math.max(0, stage.y - y) };
  });
  const { left, top, ...box } = clip;
  const shown = decodePng(await page.screenshot({ clip: box, path: join(folder, `${name}-shown.png`) }));
  const file = join(folder, `${name}-frame.png`);
  const paper = animation.background === 'transparent' ? ['--background', 'white'] : [];
  run('frame', scene, `--at=${at.join(',')}`, '-o', file, '--quiet', ...paper);
  const wanted = decodePng(readFileSync(file));
  const { mean, far, count } = difference(shown, wanted, [left, top]);
  // Curves are drawn by another rasteriser, which smooths every edge a little differently.
  check(mean < 1 && far / count < (curves ? 0.003 : 0.001), `the drawing ${what}${curves ? ', as curves,' : ''} is that of \`inbetween frame\`: mean difference ${mean.toFixed(2)} of 255, ${far} of ${count} pixels differ by more than 40`);
  await page.keyboard.press('0');
}

async function padPoint(page, answer, place) {
  const box = await page.locator('#pad').boundingBox();
  // Two poses tell how places become pixels.
  const centre = async (pose) => page.locator(`.pose[data-pose="${pose.name}"]`).evaluate((element) => {
    const { m41, m42 } = new DOMMatrix(getComputedStyle(element).transform);
    return [m41, m42];
  });
  const [a, b] = [answer.poses[0], answer.poses.find((pose) => Math.abs(pose.at[0] - answer.poses[0].at[0]) > 1e-6) ?? answer.poses.find((pose) => pose.at[1] !== answer.poses[0].at[1])];
  const [p, q] = [await centre(a), await centre(b)];
  const scale = Math.hypot(q[0] - p[0], q[1] - p[1]) / Math.hypot(b.at[0] - a.at[0], b.at[1] - a.at[1]);
  return [box.x + p[0] + (place[0] - a.at[0]) * scale, box.y + p[1] - (place[1] - a.at[1]) * scale];
}

async function drag(page, from, to, steps = 8, pause = 0) {
  await page.mouse.move(...from);
  await page.mouse.down();
  for (let k = 1; k <= steps; k++) {
    await page.mouse.move(from[0] + ((to[0] - from[0]) * k) / steps, from[1] + ((to[1] - from[1]) * k) / steps);
    if (pause) await page.waitForTimeout(pause);
  }
  await page.mouse.up();
}

/** A place in the box of the poses that is none of theirs. */
function inside({ box: [[x0, y0], [x1, y1]] }, [a, b]) {
  return [x0 + a * (x1 - x0), y0 + b * (y1 - y0)];
}

async function probe(page, answer) {
  await page.keyboard.press('Home');
  await drawn(page, answer.poses[0].at);
  const before = await weights(page);
  const target = await padPoint(page, answer, inside(answer, [0.63, 0.58]));
  const handle = await page.locator('#probe').boundingBox();
  await drag(page, [handle.x + handle.width / 2, handle.y + handle.height / 2], target);
  await drawn(page);
  const at = await shownPlace(page);
  const wanted = inside(answer, [0.63, 0.58]);
  const near = Math.hypot(at[0] - wanted[0], at[1] - wanted[1]);
  check(near < 0.02 * Math.hypot(answer.box[1][0] - answer.box[0][0], answer.box[1][1] - answer.box[0][1]), 'dragging the probe takes it along');
  const after = await weights(page);
  check(after.some((weight, k) => Math.abs(weight - before[k]) > 0.05), 'dragging the probe changes the weights');
  const line = JSON.parse(String(run('weights', scene, `--at=${at.join(',')}`)).trim().split('\n')[0]);
  const own = line.weights ?? line;
  check(after.every((weight, k) => Math.abs(weight - own[k]) < 2e-3), 'the weights are those of `inbetween weights`');
  await pixels(page, answer, at, 'where the probe was dragged');
}

async function keys(page) {
  await page.keyboard.press('Home');
  await drawn(page);
  const before = await shownPlace(page);
  await page.locator('#probe').focus();
  await page.keyboard.press('ArrowRight');
  await page.waitForFunction((old) => document.getElementById('picture').dataset.at !== old, before.join(','));
  const after = await shownPlace(page);
  check(after[0] > before[0], 'an arrow key moves the probe');
  await page.keyboard.press('2');
  await drawn(page);
  const second = await page.evaluate(async () => (await (await fetch('api/scene')).json()).poses[1].at.join(','));
  check((await shownPlace(page)).join(',') === second, 'a number goes to a pose');
  const field = page.locator('#place input').first();
  await field.fill(String(before[0]));
  await field.press('Enter');
  await page.waitForFunction((x) => Number(document.getElementById('picture').dataset.at.split(',')[0]) === x, before[0]);
  check(true, 'a number that is typed moves the probe');
  await page.locator('#probe').focus();
}

async function movedPose(page, answer) {
  const bytes = readFileSync(scene);
  await page.keyboard.press('Home');
  await drawn(page);
  const place = inside(answer, [0.7, 0.68]);
  const probeAt = await padPoint(page, answer, place);
  await page.mouse.click(...probeAt);
  await drawn(page);
  const before = await weights(page);
  const moved = answer.poses[1];
  const from = await page.locator(`.pose[data-pose="${moved.name}"]`).boundingBox();
  const start = [from.x + from.width / 2, from.y + 6];
  const pad = await page.locator('#pad').boundingBox();
  const toMiddle = [pad.x + pad.width / 2 - start[0], pad.y + pad.height / 2 - start[1]];
  await page.mouse.move(...start);
  await page.mouse.down();
  for (let k = 1; k <= 6; k++) {
    await page.mouse.move(start[0] + toMiddle[0] * 0.05 * k, start[1] + toMiddle[1] * 0.05 * k + 4 * k);
    await page.waitForTimeout(30);
  }
  await drawn(page);
  const during = await weights(page);
  check(during.some((weight, k) => Math.abs(weight - before[k]) > 0.01), 'dragging a pose changes the weights while it is dragged');
  check(Buffer.compare(readFileSync(scene), bytes) === 0, 'a drag that has not ended is not in the file');
  await page.mouse.up();
  await edited(page, 'move pose');
  const text = readFileSync(scene, 'utf8');
  check(text !== String(bytes), 'the move is in the file');
  const comments = (all) => all.split('\n').filter((line) => line.trim().startsWith('#')).join('\n');
  check(comments(text) === comments(String(bytes)), 'its comments stay');
  await page.keyboard.press('Control+z');
  await until(page, async () => (await (await fetch('api/state')).json()).undo === null);
  await saved(page);
  check(Buffer.compare(readFileSync(scene), bytes) === 0, 'undo restores the bytes');
  const undone = await weights(page);
  check(undone.every((weight, k) => Math.abs(weight - before[k]) < 2e-3), 'and the weights');
}

/** Where something lies in a cell; in one go, since marks are drawn anew all the time. */
function centre(cell, selector) {
  return cell.locator('.drawing').evaluate((svg, wanted) => {
    const { x, y, width, height } = svg.querySelector(wanted).getBoundingClientRect();
    return [x + width / 2, y + height / 2];
  }, selector);
}

async function landmark(page) {
  const bytes = readFileSync(scene);
  await page.click('[data-value="matches"]');
  await page.waitForSelector('#matches .cell .outline path', { state: 'attached' });
  await page.click('#tab-landmarks');
  const read = () => page.evaluate(async () => (await fetch('api/correspondences?samples=64')).json());
  const before = await read();
  const drawnPoses = before.poses.filter((pose) => pose.drawn);
  if (drawnPoses.length < 2) return;
  // A click on the outline of the first drawing, away from other landmarks.
  const cell = page.locator('#matches .cell').nth(before.poses.indexOf(drawnPoses[0]));
  const spot = await cell.locator('.drawing').evaluate((svg) => {
    const path = svg.querySelector('.outline path');
    const matrix = svg.getScreenCTM();
    const total = path.getTotalLength();
    const marks = Array.from(svg.querySelectorAll('.mark .reach')).map((mark) => mark.getBoundingClientRect()).map((box) => [box.x + box.width / 2, box.y + box.height / 2]);
    let best = null;
    for (let k = 0; k < 400; k++) {
      const point = path.getPointAtLength((total * k) / 400).matrixTransform(matrix);
      const far = Math.min(60, ...marks.map(([x, y]) => Math.hypot(x - point.x, y - point.y)));
      if (!best || far > best.far) best = { far, at: [point.x, point.y] };
    }
    return best.at;
  });
  await page.mouse.click(...spot);
  await page.waitForSelector('#add-landmark', { state: 'visible' });
  const count = await page.locator('.mark.fresh').count();
  check(count === drawnPoses.length, `a click proposes a landmark on all ${drawnPoses.length} drawings`);
  // Drag it a little on another drawing, so that the match has to change.
  const other = page.locator('#matches .cell').nth(before.poses.indexOf(drawnPoses[1]));
  const at = await centre(other, '.mark.fresh .reach');
  const along = await other.locator('.drawing').evaluate((svg, [x, y]) => {
    const path = svg.querySelector('.outline path');
    const matrix = svg.getScreenCTM();
    const total = path.getTotalLength();
    let best = { far: Infinity };
    const points = Array.from({ length: 1500 }, (_, k) => path.getPointAtLength((total * k) / 1500).matrixTransform(matrix));
    points.forEach((point, k) => {
      const far = Math.hypot(point.x - x, point.y - y);
      if (far < best.far) best = { far, k };
    });
    for (let k = best.k; ; k++) {
      const point = points[k % points.length];
      if (Math.hypot(point.x - x, point.y - y) > 7) return [point.x, point.y];
      if (k > best.k + 700) return [x, y];
    }
  }, at);
  await drag(page, at, along);
  await page.click('#add-landmark');
  await edited(page, 'add a landmark');
  const started = await state(page);
  const after = await read();
  const scale = Math.max(...before.poses.map((pose) => pose.picture.height / pose.picture.scale));
  const shift = Math.max(...after.samples.flatMap((points, k) => points.map((value, i) => Math.abs(value - before.samples[k][i]))));
  check(shift > 0.002 * scale, `the landmark changes the match (by up to ${shift.toFixed(1)} units), mapped in ${started.timings?.mapping_ms?.toFixed(0)} ms`);
  check(String(readFileSync(scene)).includes('[[landmark]]'), 'the landmark is in the file');
  await page.screenshot({ path: join(folder, `${name}-matches.png`) });
  // It is dragged on.
  const own = await page.evaluate(async () => (await (await fetch('api/scene')).json()).landmarks.at(-1).name);
  await drag(page, await centre(other, `.mark[data-landmark="${own}"] .reach`), at, 5, 40);
  await edited(page, 'move landmark');
  const moved = await read();
  const again = Math.max(...moved.samples.flatMap((points, k) => points.map((value, i) => Math.abs(value - after.samples[k][i]))));
  check(again > 0.001 * scale, `dragging the landmark changes the match again, by up to ${again.toFixed(2)} units`);
  await page.locator('#probe').focus();
  await page.click('#undo');
  await edited(page, 'add a landmark');
  await page.click('#undo');
  await until(page, async () => (await (await fetch('api/state')).json()).undo === null);
  await saved(page);
  check(Buffer.compare(readFileSync(scene), bytes) === 0, 'undo of the button restores the bytes');
  await page.click('[data-value="picture"]');
  await drawn(page);
}

/** Whether a screenshot of an element changes by what is done. */
async function changes(page, selector, work) {
  const before = decodePng(await page.locator(selector).screenshot());
  await work();
  await page.waitForTimeout(600);
  const after = decodePng(await page.locator(selector).screenshot());
  return difference(after, before).mean > 0.2;
}

async function maps(page) {
  check(await changes(page, '#pad', () => page.click('[data-value="weight"]')), 'the weight map is shown');
  check(await changes(page, '#pad', () => page.locator('#weights .weight').nth(1).click()), 'and that of another pose');
  check(await changes(page, '#pad', () => page.click('[data-value="validity"]')), 'the validity map is shown');
  await page.click('[data-value="plain"]');
  check(await changes(page, '#stage', () => page.click('#mesh')), 'the mesh is laid over the picture');
  await page.click('#mesh');
  check(await changes(page, '#stage', () => page.click('[data-value="poses"]')), 'the poses are laid under it');
  await page.click('[data-value="off"]');
  await page.locator('#probe').focus();
  await page.keyboard.press('Home');
  for (let k = 0; k < 6; k++) await page.keyboard.press('ArrowRight');
  await drawn(page);
  const own = await weights(page);
  await page.keyboard.down('b');
  await page.waitForFunction((old) => document.querySelector('#weights').textContent !== old, await page.textContent('#weights'));
  const other = await weights(page);
  await page.keyboard.up('b');
  check(other.some((weight, k) => Math.abs(weight - own[k]) > 1e-3), 'while B is held the other provider is shown');
  await page.waitForFunction((old) => document.querySelector('#weights').textContent !== old, await page.textContent('#weights')).catch(() => {});
}

async function onPicture(page) {
  const bytes = readFileSync(scene);
  await page.keyboard.press('Home');
  await drawn(page);
  // Somewhere on the drawing: the middle of a triangle near its edge.
  const spot = await page.evaluate(async () => {
    const { store } = await import('./state.js');
    const { toStage } = await import('./view.js');
    const k = store.frame.order.at(-1);
    const { positions } = store.frame.layers[k];
    const { triangles } = store.meshes[k];
    const middle = (t) => [0, 1].map((d) => (positions[2 * triangles[t] + d] + positions[2 * triangles[t + 1] + d] + positions[2 * triangles[t + 2] + d]) / 3);
    let best = null;
    for (let t = 0; t < triangles.length; t += 3) {
      const at = middle(t);
      if (!best || at[0] < best[0]) best = at;
    }
    const box = document.getElementById('stage').getBoundingClientRect();
    const [x, y] = toStage(best);
    return [x + box.x, y + box.y];
  });
  const before = await shownPlace(page);
  await drag(page, spot, [spot[0] + 14, spot[1] - 40], 6, 40);
  await page.waitForTimeout(500);
  await drawn(page);
  check((await shownPlace(page)).join() !== before.join(), 'dragging the drawing moves the probe to where it reaches');
  await page.keyboard.press('Home');
  await drawn(page);
  const count = (await page.evaluate(async () => (await (await fetch('api/scene')).json()).poses.length));
  await page.click('[data-value="bend"]');
  await page.waitForTimeout(400);
  await page.mouse.click((await page.locator('#stage').boundingBox()).x + (await page.locator('#stage').boundingBox()).width / 2, spot[1] + 20);
  await drag(page, spot, [spot[0] - 8, spot[1] - 50], 6, 40);
  await page.locator('#place input').first().fill('0.37');
  await page.locator('#place input').first().press('Enter');
  await page.click('#keep-bent');
  await edited(page, 'add a pose');
  await until(page, async (wanted) => (await (await fetch('api/scene')).json()).poses.length === wanted, count + 1, { timeout: 20000 }).catch(() => {});
  const after = await page.evaluate(async () => (await (await fetch('api/scene')).json()).poses);
  const made = after.find((pose) => pose.kind === 'deformed' && Math.abs(pose.at[0] - 0.37) < 1e-9);
  check(after.length === count + 1 && made, `handles make a new pose, '${made?.name}', at ${made?.at}`);
  await page.locator('#probe').focus();
  await page.keyboard.press('Control+z');
  await until(page, async () => (await (await fetch('api/state')).json()).undo === null);
  await saved(page);
  check(Buffer.compare(readFileSync(scene), bytes) === 0, 'undo restores the bytes after a new pose');
}

async function gesture(page, answer) {
  const bytes = readFileSync(scene);
  await page.click('#record');
  const start = await padPoint(page, answer, inside(answer, [0.2, 0.4]));
  await page.mouse.move(...start);
  await page.mouse.down();
  for (let k = 1; k <= 24; k++) {
    await page.mouse.move(...(await padPoint(page, answer, inside(answer, [0.2 + 0.025 * k, 0.4 + 0.25 * Math.sin(k / 5)]))));
    await page.waitForTimeout(12);
  }
  await page.mouse.up();
  await page.waitForSelector('#save-gesture', { state: 'visible' });
  await page.locator('#gesture-seconds').fill('1');
  await page.locator('#gesture-seconds').press('Enter');
  await page.waitForFunction(() => /\/ 1\.00 s/.test(document.querySelector('.clock').textContent));
  check(true, 'a recorded gesture is retimed');
  await page.screenshot({ path: join(folder, `${name}-gesture.png`) });
  await page.click('#save-gesture');
  await page.waitForSelector('#save-gesture', { state: 'hidden' });
  await edited(page, 'record a gesture');
  const now = await page.evaluate(async () => (await (await fetch('api/scene')).json()).animation);
  const text = String(readFileSync(scene));
  check(now.own_keys && text.includes('[animation]') && Math.abs(now.duration - 1) < 0.06, `the gesture is in the file: ${now.keys.length} keys in ${now.duration.toFixed(2)} s`);
  run('render', scene, '-o', join(folder, `${name}-gesture.gif`), '--size', '120x120', '--quiet');
  check(readFileSync(join(folder, `${name}-gesture.gif`)).subarray(0, 4).toString() === 'GIF8', 'and renders');
  await page.keyboard.press('Control+z');
  await until(page, async () => (await (await fetch('api/state')).json()).undo === null);
  await saved(page);
  check(Buffer.compare(readFileSync(scene), bytes) === 0, 'undo restores the bytes after a gesture');
  await page.keyboard.press('Control+Shift+z');
  await until(page, async () => (await (await fetch('api/state')).json()).redo === null);
  await saved(page);
  check(String(readFileSync(scene)) === text, 'redo brings the gesture back');
  await page.keyboard.press('Control+z');
  await saved(page);
}

async function outsideChange(page) {
  const text = readFileSync(scene, 'utf8');
  const names = await page.evaluate(async () => (await (await fetch('api/scene')).json()).poses.map((pose) => pose.name));
  writeFileSync(scene, text.replaceAll(`"${names[1]}"`, '"renamed_elsewhere"').replaceAll(new RegExp(`([{,]\\s*)${names[1]}(\\s*=)`, 'g'), '$1renamed_elsewhere$2'));
  await page.waitForSelector('.pose[data-pose="renamed_elsewhere"]', { timeout: 10000 });
  check(true, 'a change of the file from outside is shown');
  writeFileSync(scene, 'version = 1\nthis is not TOML');
  await page.waitForSelector('.banner:not(.hidden)', { timeout: 10000 });
  await page.waitForFunction(() => /line|expected|TOML/i.test(document.querySelector('.banner').textContent), null, { timeout: 10000 });
  check(await page.locator('#picture').getAttribute('data-at') !== null, 'a broken scene says so, and the last good one stays');
  writeFileSync(scene, text);
  await page.waitForSelector('.banner.hidden', { state: 'attached', timeout: 10000 });
  await page.waitForSelector(`.pose[data-pose="${names[1]}"]`, { timeout: 10000 });
  await drawn(page);
  check(true, 'a scene that is mended is shown again');
}

async function exported(page) {
  await page.locator('#probe').focus();
  await page.click('#copy-command');
  await page.waitForFunction(() => document.documentElement.dataset.copied);
  const copied = await page.evaluate(() => document.documentElement.dataset.copied);
  check(/^inbetween frame /.test(copied), `copy as command: ${copied}`);
  await page.click('#export');
  await page.locator('#export-output').fill(`${name}-export.gif`);
  await page.locator('#export-output').press('Tab');
  await page.getByLabel('Frames', { exact: true }).fill('1-3');
  await page.waitForFunction(() => document.querySelector('.dialog .command').textContent.includes('1-3'));
  await page.click('#export-start');
  await until(page, async () => ['done', 'failed'].includes((await (await fetch('api/state')).json()).job?.state), null, { timeout: 60000 });
  await page.waitForFunction(() => ['done', 'failed'].includes(document.querySelector('.said').dataset.state), null, { timeout: 5000 });
  const said = await page.textContent('.said');
  check(/done in/.test(said), `the export says: ${said}`);
  check(readFileSync(join(folder, `${name}-export.gif`)).subarray(0, 4).toString() === 'GIF8', 'the export dialog renders');
  await page.keyboard.press('Escape');
}

/** What a screen reader needs: everything that can be reached has a name. */
async function labels(page) {
  const nameless = await page.evaluate(() => {
    const named = (element) => element.getAttribute('aria-label') || element.textContent.trim() || element.title || element.labels?.length > 0 || element.getAttribute('aria-labelledby');
    return Array.from(document.querySelectorAll('button, input, select, [role="slider"], [role="img"], [tabindex="0"]')).filter((element) => !named(element)).map((element) => element.outerHTML.slice(0, 80));
  });
  check(nameless.length === 0, `every control has a name${nameless.length > 0 ? `: not ${nameless.join(' ')}` : ''}`);
}
