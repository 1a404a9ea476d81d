// Opens drawings, not a scene, in the page of `inbetween explore`: what is written where.
//
//   node drawings.mjs COMMAND FOLDER
//
// COMMAND is a built `inbetween`. The drawings are made here: a painted figure on paper, a ball apart from it, and a speck.
import { existsSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { api, browser as launched, drawn, edited, serve, state, until } from './driver.mjs';
import { encodePng } from './picture.mjs';

const [command, out] = process.argv.slice(2, 4).map((path) => resolve(path));
const folder = join(out, 'paper');
rmSync(folder, { recursive: true, force: true });
mkdirSync(folder, { recursive: true });

let failed = false;
const errors = [];
const check = (holds, what) => {
  console.log(`${holds ? 'ok  ' : 'FAIL'} explorer drawings: ${what}`);
  failed ||= !holds;
};

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
try {
  await proofs();
} catch (error) {
  console.log(`FAIL explorer drawings: ${error.stack}`);
  errors.forEach((text) => console.log(`     the page says: ${text}`));
  failed = true;
} finally {
  await browser.close();
  end();
}
process.exit(failed ? 1 : 0);

async function proofs() {
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, deviceScaleFactor: 1, colorScheme: 'light' });
  const page = await context.newPage();
  page.on('pageerror', (error) => errors.push(error.message));
  await page.goto(`${address}?painter=processor`);
  await drawn(page);
  const scene = await api(page, 'scene');
  check(scene.poses.map(({ name }) => name).join() === 'turn1,turn2,turn10', 'a pose each, in the order of their numbers');
  check(readdirSync(folder).length === 3 && (await state(page)).temporary, 'nothing is written beside the drawings');
  await repainted(page);
  await keep(page, scene.file);
  check(errors.length === 0, `the page reports no error${errors.length > 0 ? `: ${errors.join('; ')}` : ''}`);
}

/** A drawing is painted over where it is. */
async function repainted(page) {
  const before = await state(page);
  writeFileSync(join(folder, 'turn2.png'), sheet(0.6, 9));
  const isNew = async (old) => (await (await fetch('api/state')).json()).revisions.pictures !== old;
  await until(page, isNew, before.revisions.pictures, { timeout: 20000 });
  check(true, 'a drawing that is painted over is taken again');
}

/** The scene gets a folder. */
async function keep(page, file) {
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
