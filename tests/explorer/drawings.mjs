// Opens drawings, not a scene, in the page of `inbetween explore`: what is written where, what is taken for the figure, and how that is
// corrected by clicks.
//
//   node drawings.mjs COMMAND FOLDER
//
// COMMAND is a built `inbetween`. The drawings are made here: a painted figure on paper, a ball apart from it, and a speck.
import { existsSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { api, browser as launched, drawn, edited, report, saved, serve, state, until } from './driver.mjs';
import { encodePng } from './picture.mjs';

const [command, out] = process.argv.slice(2, 4).map((path) => resolve(path));
const folder = join(out, 'paper');
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });

const { check, errors, run: prove } = report('drawings');

// The drawings.

const [WIDTH, HEIGHT] = [240, 200];
const [BODY, BALL, SPECK] = [[90, 110, 44], [186, 60, 16], [30, 170, 1]];
/** Shades of grey between neighbouring pixels of the paper. */
const GRAIN = 3;

/** A disc with a lobe that is turned by an angle, a ball, a speck; everything `shift` pixels to the right. */
function sheet(angle, shift = 0) {
  const within = (x, y, [cx, cy, r]) => Math.hypot(x - cx - shift, y - cy) < r;
  const lobe = [BODY[0] + 50 * Math.cos(angle), BODY[1] + 50 * Math.sin(angle), 17];
  return encodePng(WIDTH, HEIGHT, (column, row) => {
    const [x, y] = [column + 0.5, row + 0.5];
    if (within(x, y, BODY) || within(x, y, lobe)) return [58, 112, 190, 255];
    if (within(x, y, BALL)) return [214, 90, 60, 255];
    if (within(x, y, SPECK)) return [60, 60, 60, 255];
    const paper = 246 - ((column * 7 + row * 13) % GRAIN);
    return [paper, paper - 2, paper - 8, 255];
  });
}

const SHEETS = { 'turn10.png': sheet(1.2), 'turn2.png': sheet(0.6), 'turn1.png': sheet(0) };
for (const [name, bytes] of Object.entries(SHEETS)) writeFileSync(join(folder, name), bytes);

const { address, end } = await serve(command, Object.keys(SHEETS).map((name) => join('paper', name)), out);
const browser = await launched();
await prove(proofs, () => browser.close(), end);

async function proofs() {
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, deviceScaleFactor: 1, colorScheme: 'light' });
  const page = await context.newPage();
  page.on('pageerror', (error) => errors.push(error.message));
  await page.goto(`${address}?painter=processor`);
  await drawn(page);
  const scene = await api(page, 'scene');
  check(scene.poses.map(({ name }) => name).join() === 'turn1,turn2,turn10', 'a pose each, in the order of their numbers');
  check(readdirSync(folder).length === 3 && (await state(page)).temporary, 'nothing is written beside the drawings');
  await figures(page);
  await parts(page, scene.file);
  await kinds(page, scene.file);
  await repainted(page);
  await keep(page, scene.file);
  check(errors.length === 0, `the page reports no error${errors.length > 0 ? `: ${errors.join('; ')}` : ''}`);
}

function figure(page, pose) {
  return api(page, `figure?pose=${pose}`);
}

/** Waits until the sheets show the newest figures. */
async function shown(page) {
  await until(page, async () => {
    const { revisions, working } = await (await fetch('api/state')).json();
    const { figures: drawnOf } = document.documentElement.dataset;
    return !working && Number(drawnOf) === revisions.scene && document.querySelectorAll('#sheets .piece').length > 0;
  }, null, { timeout: 20000 });
}

function boxOf(outline) {
  const along = (d) => outline.filter((_, k) => (k & 1) === d);
  return [Math.min, Math.max].flatMap((most) => [0, 1].map((d) => most(...along(d))));
}

/** The whole sheet, and over it the outlines where they are. */
async function figures(page) {
  await page.click('[data-value="drawings"]');
  await shown(page);
  await page.waitForFunction(() => [...document.querySelectorAll('#sheets image')].length === 3);
  await page.waitForTimeout(300);
  await page.screenshot({ path: join(out, 'drawings-sheets.png') });
  const size = await page.evaluate(async () => {
    const bitmap = await createImageBitmap(await (await fetch(document.querySelector('#sheets image').getAttribute('href'))).blob());
    const context = new OffscreenCanvas(1, 1).getContext('2d');
    context.drawImage(bitmap, 0, 0);
    return { width: bitmap.width, height: bitmap.height, corner: Array.from(context.getImageData(0, 0, 1, 1).data) };
  });
  const isPaper = size.corner[3] === 255 && size.corner[0] > 230;
  check(size.width === WIDTH && size.height === HEIGHT && isPaper, 'each sheet is shown whole, with its paper');
  const { pieces, taken } = await figure(page, 0);
  const near = (outline, [x, y, r]) => boxOf(outline).every((value, k) => Math.abs(value - [x - r, y - r, x + r, y + r][k]) < 1.5);
  const ball = pieces.find(({ role }) => role === 'part');
  check(taken === 'background' && pieces.length === 2 && near(ball.outline, BALL), 'the body and the ball are found where they are drawn');
  const [body] = pieces.filter(({ role }) => role === 'body');
  const drawnBox = await page.$eval('#sheets .piece.body path:not(.halo)', (path) => {
    const { x, y, width, height } = path.getBBox();
    return [x, y, x + width, y + height];
  });
  check(boxOf(body.outline).every((value, k) => Math.abs(value - drawnBox[k]) < 0.01), 'and their outlines are drawn over the sheet');
}

/** Where a place of a pose's sheet is on the screen. */
function onScreen(page, pose, place) {
  return page.evaluate(([k, [x, y]]) => {
    const point = new DOMPoint(x, y).matrixTransform(document.querySelectorAll('#sheets .sheet')[k].getScreenCTM());
    return [point.x, point.y];
  }, [pose, place]);
}

async function roles(page, pose) {
  return (await figure(page, pose)).pieces.map(({ role }) => role).sort().join();
}

/** Undoes all there is. */
async function undone(page) {
  for (let now = await state(page); now.undo !== null; now = await saved(page)) {
    await page.click('#undo');
    // Until it has reached the server.
    const isNewer = async (old) => (await (await fetch('api/state')).json()).revisions.scene > old;
    await until(page, isNewer, now.revisions.scene);
  }
}

/** A part is left out and taken back; a speck is asked for; on bare paper there is nothing to ask for. */
async function parts(page, file) {
  const text = () => readFileSync(file, 'utf8');
  const before = text();
  await page.mouse.click(...(await onScreen(page, 0, BALL)));
  await edited(page, 'leave out a part');
  await shown(page);
  check(/drop = \[\[/.test(text()) && await roles(page, 0) === 'body,dropped', 'a click leaves the ball out, and the scene says so');
  await page.screenshot({ path: join(out, 'drawings-dropped.png') });
  await page.mouse.click(...(await onScreen(page, 0, [BALL[0] + 8, BALL[1]])));
  await edited(page, 'take back a part');
  await shown(page);
  check(text() === before && await roles(page, 0) === 'body,part', 'another one takes it back, to the byte');
  await page.mouse.click(...(await onScreen(page, 0, SPECK)));
  await edited(page, 'ask for a part');
  await shown(page);
  check(/keep = \[\[/.test(text()) && await roles(page, 0) === 'body,kept,part', 'a click on a speck asks for it');
  await page.mouse.click(...(await onScreen(page, 1, [WIDTH - 12, HEIGHT - 12])));
  await page.waitForSelector('.toast.problem');
  const said = (await page.textContent('.toast.problem p')).slice(0, 60);
  check((await figure(page, 1)).keep.length === 0, `on bare paper there is nothing to ask for: ${said}…`);
  await page.locator('#sheets .piece.part').first().focus();
  await page.keyboard.press('Enter');
  await edited(page, 'leave out a part');
  check(true, 'the keyboard leaves a part out, too');
  await undone(page);
  check(text() === before, 'undo restores the bytes');
  await shown(page);
}

/** How the figure is told is said for one pose, shown at once, and taken back; for all. */
async function kinds(page, file) {
  const text = () => readFileSync(file, 'utf8');
  const before = text();
  await page.click('#sheets .cell[data-pose="turn2"] .name');
  await page.waitForSelector('#reading h3:has-text("turn2")');
  await page.getByLabel('How the figure is told').selectOption('alpha');
  await edited(page, 'set figure');
  await shown(page);
  const { own, problem } = await figure(page, 1);
  const warned = await page.locator('#sheets .cell[data-pose="turn2"] .warning').textContent();
  const isSaid = own.join() === 'figure' && warned === 'cannot be used';
  check(isSaid, `told by alpha, its sheet says that it cannot be used: ${problem.message.slice(0, 80)}…`);
  check(/name = "turn2"\nsource = "turn2.png"[^[]*figure = "alpha"/.test(text()), 'the scene says it of that pose');
  await page.screenshot({ path: join(out, 'drawings-wrong.png') });
  await page.getByLabel('How the figure is told').selectOption('lines');
  await until(page, async () => (await (await fetch('api/figure?pose=1')).json()).taken === 'lines');
  await saved(page);
  await shown(page);
  const caption = await page.locator('#sheets .cell[data-pose="turn2"] figcaption').textContent();
  check(/lines/.test(caption) && (await state(page)).problems.length === 0, 'told by its lines, it is mapped again');
  await page.getByLabel('Told: as for all drawings').click();
  await edited(page, 'set figure');
  await shown(page);
  check(text() === before && (await figure(page, 1)).own.length === 0, 'and is freed of it again');
  const threshold = page.getByLabel('Coverage that counts as inside');
  await threshold.fill('0.4');
  await threshold.press('Enter');
  await edited(page, 'set threshold');
  check((await figure(page, 1)).reading.threshold === 0.4, 'a number is set likewise');
  await undone(page);
  check(text() === before, 'undo restores the bytes');
}

/** A drawing is painted over where it is. */
async function repainted(page) {
  const before = await state(page);
  writeFileSync(join(folder, 'turn2.png'), sheet(0.6, 9));
  const isNew = async (old) => (await (await fetch('api/state')).json()).revisions.pictures !== old;
  await until(page, isNew, before.revisions.pictures, { timeout: 20000 });
  await shown(page);
  const [left] = boxOf((await figure(page, 1)).pieces[0].outline);
  check(Math.abs(left - (BODY[0] - BODY[2] + 9)) < 1.5, 'a drawing that is painted over is taken again');
}

/** The scene gets a folder. */
async function keep(page, file) {
  await page.click('[data-value="picture"]');
  await drawn(page);
  mkdirSync(join(out, 'taken'), { recursive: true });
  writeFileSync(join(out, 'taken', 'scene.toml'), 'version = 1\n');
  rmSync(join(out, 'kept'), { recursive: true, force: true });
  await page.click('#keep');
  await page.locator('#keep-folder').fill('taken');
  await page.click('#keep-here');
  await page.waitForFunction(() => document.querySelector('.dialog [role="alert"]')?.textContent.includes('exists'));
  await page.screenshot({ path: join(out, 'drawings-keep.png') });
  check(readFileSync(join(out, 'taken', 'scene.toml'), 'utf8') === 'version = 1\n', 'a scene that is there is not written over');
  await page.locator('#keep-folder').fill('kept');
  await page.click('#keep-here');
  await until(page, async () => !(await (await fetch('api/state')).json()).temporary);
  await drawn(page);
  const kept = readdirSync(join(out, 'kept')).sort().join();
  const isThere = kept === 'scene.toml,turn1.png,turn10.png,turn2.png';
  check(isThere && !existsSync(file), `"Save…" writes ${kept}, and the temporary folder goes`);
  await page.locator('#probe').focus();
  const { poses } = await api(page, 'scene');
  await page.evaluate(async ([pose, at]) => {
    const { edit } = await import('./state.js');
    await edit([{ op: 'move_pose', pose, at }], `move pose '${pose}'`);
  }, [poses[0].name, poses[0].at.map((value) => value + 0.25)]);
  await edited(page, 'move pose');
  check(/at = \[/.test(readFileSync(join(out, 'kept', 'scene.toml'), 'utf8')), 'from then on edits are saved there');
}
