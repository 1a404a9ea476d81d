// A running `inbetween explore`, a browser for its page, and waiting for what the page shows.
//
// playwright-core is looked for in $PLAYERS/node_modules, Chromium at $CHROMIUM.
import { spawn } from 'node:child_process';
import { createRequire } from 'node:module';
import { resolve } from 'node:path';

const { chromium } = createRequire(resolve(process.env.PLAYERS ?? '.', 'node_modules', 'none.js'))('playwright-core');

/** Starts `inbetween explore` in a folder: its address, and how it is ended. */
export async function serve(command, words, folder) {
  const server = spawn(command, ['explore', ...words, '--no-open'], { cwd: folder, stdio: ['ignore', 'pipe', 'inherit'] });
  const address = await new Promise((done, refuse) => {
    server.stdout.once('data', (data) => done(String(data).trim()));
    server.once('exit', () => refuse(new Error('the server has ended')));
  });
  return { address, end: () => server.kill() };
}

export const browser = () => chromium.launch({
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
  headless: true,
  args: ['--no-sandbox', '--disable-gpu', '--enable-unsafe-swiftshader', '--disable-quic', '--no-first-run',
    '--disable-background-networking', '--disable-component-update', '--disable-sync', '--force-color-profile=srgb',
    '--disable-dev-shm-usage', '--hide-scrollbars'],
});

export const api = (page, route) => page.evaluate(async (asked) => (await fetch(`api/${asked}`)).json(), route);

/** Waits until what a function finds out in the page holds. Playwright's own waiting takes a promise for a yes. */
export async function until(page, holds, given = null, { timeout = 30000 } = {}) {
  const end = Date.now() + timeout;
  while (!(await page.evaluate(holds, given))) {
    if (Date.now() > end) throw new Error(`not within ${timeout} ms: ${holds}`);
    await page.waitForTimeout(30);
  }
}

export const state = (page) => api(page, 'state');

/** Waits until the page shows the newest state, at a place if one is given. */
export async function drawn(page, at = null) {
  await page.waitForSelector('html[data-ready="true"]', { state: 'attached', timeout: 30000 });
  for (;;) {
    const now = await state(page);
    if (now.working) {
      await page.waitForTimeout(50);
      continue;
    }
    await page.waitForFunction(([seq, weights, shape, place]) => {
      const { dataset } = document.getElementById('picture');
      return Number(document.documentElement.dataset.seq) >= seq && Number(dataset.weights) >= weights && Number(dataset.shape) >= shape &&
        (place === null || dataset.at === place);
    }, [now.seq, now.revisions.weights, now.revisions.shape, at && at.join(',')], { timeout: 15000 });
    // One more displayed frame, so that it is on the screen.
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    return now;
  }
}

/** The same when everything is in the file. */
export async function saved(page) {
  for (;;) {
    const now = await drawn(page);
    if (now.saved && !now.dragging) return now;
    await page.waitForTimeout(30);
  }
}

/** The same after an edit has reached the server. */
export async function edited(page, label) {
  await until(page, async (wanted) => (await (await fetch('api/state')).json()).undo?.startsWith(wanted), label);
  return saved(page);
}

/** The proofs of a page: `check` says what holds, `errors` is what the page reports, and `run` ends with an exit code that says whether all of it is well. */
export function report(name) {
  let failed = false;
  const errors = [];
  return {
    errors,
    check(holds, what) {
      console.log(`${holds ? 'ok  ' : 'FAIL'} explorer ${name}: ${what}`);
      failed ||= !holds;
    },
    async run(proofs, ...ends) {
      try {
        await proofs();
      } catch (error) {
        console.log(`FAIL explorer ${name}: ${error.stack}`);
        errors.forEach((text) => console.log(`     the page says: ${text}`));
        failed = true;
      } finally {
        for (const end of ends) await end();
      }
      process.exit(failed ? 1 : 0);
    },
  };
}
