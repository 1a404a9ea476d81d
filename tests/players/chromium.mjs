// Takes pictures of an animation as Chromium plays it.
//
//   node chromium.mjs FILE FOLDER FPS WIDTHxHEIGHT FRAME...
//
// FILE is an animated SVG or a Lottie JSON file; frames count from 1; the pictures are FOLDER/NAME.0001.png and so on,
// with what is transparent left so. playwright-core and lottie-web are looked for in $PLAYERS/node_modules, Chromium at
// $CHROMIUM.
import { createRequire } from 'node:module';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { basename, join, resolve } from 'node:path';
import { tmpdir } from 'node:os';
import { pathToFileURL } from 'node:url';

const players = process.env.PLAYERS ?? ".";
const require = createRequire(join(players, 'node_modules', 'none.js'));
const { chromium } = require('playwright-core');

const [file, folder, fpsText, sizeText, ...frameTexts] = process.argv.slice(2);
const fps = Number(fpsText);
const [width, height] = sizeText.split('x').map(Number);
const frames = frameTexts.map(Number);
const name = basename(file).replace(/\.[^.]*$/, '');
mkdirSync(folder, { recursive: true });

const profile = mkdtempSync(join(tmpdir(), 'players-'));
const context = await chromium.launchPersistentContext(profile, {
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
  headless: true,
  viewport: { width, height },
  deviceScaleFactor: 1,
  args: ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
    '--disable-component-update', '--disable-sync', '--force-color-profile=srgb', '--disable-dev-shm-usage', '--hide-scrollbars'],
});
let failed = false;
try {
  const page = await context.newPage();
  page.on('pageerror', (error) => { console.error(`error in the page: ${error.message}`); failed = true; });
  if (file.endsWith('.svg')) {
    await page.goto(pathToFileURL(resolve(file)).href);
    await page.evaluate(() => document.documentElement.pauseAnimations());
  } else {
    // Files, because what goes through the protocol must be small.
    const script = pathToFileURL(join(players, 'node_modules', 'lottie-web', 'build', 'player', 'lottie_svg.js')).href;
    writeFileSync(join(profile, 'data.js'), `window.drawing = ${readFileSync(file, 'utf8')};`);
    writeFileSync(join(profile, 'page.html'), `<!doctype html><body style="margin:0;overflow:hidden;background:transparent">
      <div id="stage" style="width:${width}px;height:${height}px"></div><script src="${script}"></script><script src="data.js"></script>`);
    await page.goto(pathToFileURL(join(profile, 'page.html')).href);
    await page.evaluate(() => new Promise((done, refuse) => {
      const player = lottie.loadAnimation({
        container: document.getElementById('stage'), renderer: 'svg', loop: false, autoplay: false, animationData: window.drawing,
      });
      player.addEventListener('data_failed', () => refuse(new Error('lottie-web refuses the file')));
      player.addEventListener('error', (event) => refuse(new Error(String(event.nativeError ?? event))));
      window.player = player;
      if (player.isLoaded) done(); else player.addEventListener('DOMLoaded', () => done());
    }));
  }
  for (const frame of frames) {
    await page.evaluate(async ([index, seconds]) => {
      if (window.player) window.player.goToAndStop(index, true);
      else document.documentElement.setCurrentTime(seconds);
      const images = [...document.querySelectorAll('image')];
      await Promise.all(images.map((image) => image.decode?.().catch(() => undefined)));
      await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    }, [frame - 1, (frame - 1) / fps]);
    const path = join(folder, `${name}.${String(frame).padStart(4, '0')}.png`);
    await page.screenshot({ path, omitBackground: true, animations: 'allow' });
  }
} finally {
  await context.close();
  rmSync(profile, { recursive: true, force: true });
}
process.exit(failed ? 1 : 0);
