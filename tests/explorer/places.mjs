// The point under the pointer, in all drawings: the middle of a triangle of the mesh is pointed at, and what is marked elsewhere is
// compared with the middle of the same triangle there.

/** Waits until marks that follow the pointer are drawn. */
const shown = (page) => page.evaluate(async () => {
  for (let k = 0; k < 3; k++) await new Promise((done) => requestAnimationFrame(done));
});

/** Of each layer a triangle that is seen in the frame, as far from its layer's edge as any: {layer, triangle, at on the screen}. */
const targets = (page) => page.evaluate(async () => {
  const { store } = await import('./state.js');
  const { toStage } = await import('./view.js');
  const { isInside } = await import('./located.js');
  const { order, layers } = store.frame;
  const box = document.getElementById('stage').getBoundingClientRect();
  return order.flatMap((layer, depth) => {
    const { positions, rings, opacity } = layers[layer];
    const { triangles } = store.meshes[layer];
    const above = order.slice(depth + 1).filter((k) => layers[k].opacity > 0);
    let best = null;
    for (let t = 0; t < triangles.length; t += 3) {
      const [a, b, c] = triangles.subarray(t, t + 3);
      const at = [0, 1].map((d) => (positions[2 * a + d] + positions[2 * b + d] + positions[2 * c + d]) / 3);
      const [ux, uy, vx, vy] = [b, c].flatMap((v) => [0, 1].map((d) => positions[2 * v + d] - positions[2 * a + d]));
      const size = ux * vy - uy * vx;
      const isSeen = isInside(rings, at) && !above.some((k) => isInside(layers[k].rings, at));
      if (opacity > 0 && isSeen && (!best || size > best.size)) best = { size, layer, triangle: [a, b, c], at };
    }
    if (!best) return [];
    const [x, y] = toStage(best.at);
    return [{ layer, triangle: best.triangle, at: [x + box.x, y + box.y] }];
  });
});

/** What is marked on the strip: of each pose how far the mark is from where the triangle is drawn, in pixels; null without a mark. */
const onStrip = (page, { layer, triangle }) => page.evaluate(async ([own, corners]) => {
  const { store } = await import('./state.js');
  const { framesOf } = await import('./frames.js');
  const frames = await framesOf('poses', ['all']);
  return store.scene.poses.map(({ name }, pose) => {
    const figure = document.querySelector(`#places figure[data-pose="${CSS.escape(name)}"]`);
    const mark = figure.querySelector('.spot');
    const has = store.puppet.layers[own].poses.includes(pose);
    if (mark.classList.contains('hidden')) return { has, far: null };
    const rings = frames[pose].layers.filter((layer) => layer.opacity > 0).flatMap((layer) => layer.rings);
    const points = rings.flatMap((ring) => Array.from(ring));
    const along = (d) => points.filter((_, k) => (k & 1) === d);
    const [low, high] = [Math.min, Math.max].map((most) => [0, 1].map((d) => along(d).reduce((a, b) => most(a, b))));
    const { positions } = frames[pose].layers[own];
    const at = [0, 1].map((d) => corners.reduce((sum, v) => sum + positions[2 * v + d], 0) / 3);
    const [sheet, spot] = [figure.querySelector('.sheet').getBoundingClientRect(), mark.getBoundingClientRect()];
    const scale = Math.min(sheet.width / (high[0] - low[0]), sheet.height / (high[1] - low[1]));
    const middle = [sheet.x + sheet.width / 2, sheet.y + sheet.height / 2];
    const wanted = [0, 1].map((d) => middle[d] + (at[d] - (low[d] + high[d]) / 2) * scale);
    return { has, far: Math.hypot(spot.x + spot.width / 2 - wanted[0], spot.y + spot.height / 2 - wanted[1]) };
  });
}, [layer, triangle]);

/** On the picture, with the pointer and with keys. */
export async function placesOfPicture({ page, check, drawn }) {
  // A canvas that nothing was drawn on is 300 pixels wide.
  const areDrawn = () => [...document.querySelectorAll('#places canvas')].every((canvas) => canvas.width !== 300);
  await page.waitForFunction(areDrawn, null, { timeout: 20000 });
  const poses = await page.evaluate(async () => (await import('./state.js')).store.scene.poses.length);
  const seen = new Map();
  for (let pose = 1; pose <= Math.min(poses, 9); pose++) {
    await page.locator('#probe').focus();
    await page.keyboard.press(String(pose));
    await drawn(page);
    for (const target of await targets(page)) {
      if (seen.has(target.layer)) continue;
      await page.mouse.move(...target.at);
      await shown(page);
      seen.set(target.layer, await onStrip(page, target));
    }
  }
  const all = [...seen.values()].flat();
  const right = all.every(({ has, far }) => (has ? far !== null && far < 4 : far === null));
  const far = Math.max(...all.map((one) => one.far ?? 0));
  const where = `in ${seen.size} layers, ${far.toFixed(1)} pixels off at most`;
  check(right && seen.size > 0, `the point under the pointer is marked on all poses that have it, ${where}`);
  const quiet = await page.evaluate(async () => {
    const { on } = await import('./state.js');
    let count = 0;
    const off = on('pointed frame drawn', () => count++);
    await new Promise((done) => setTimeout(done, 300));
    off();
    return count;
  });
  check(quiet === 0, 'nothing is done for it while the pointer rests');
  await page.locator('#show-places').focus();
  await page.keyboard.press('Shift+Tab');
  const isThere = () => page.evaluate(() => document.activeElement.id === 'picture');
  for (let k = 0; k < 40 && !(await isThere()); k++) await page.keyboard.press('Tab');
  await page.keyboard.press('ArrowUp');
  await shown(page);
  const said = await page.locator('p[role="status"].unseen').textContent();
  const marked = await page.locator('#places .spot:not(.hidden)').count();
  const isHeard = marked > 0 && said.split('; ').length === marked;
  check(isHeard, `a cross moved by keys marks it, too, and a reader hears: ${said.slice(0, 60)}…`);
  await page.locator('#probe').focus();
  check(await page.locator('#places .spot:not(.hidden)').count() === 0, 'and it is gone with the cross');
  await page.keyboard.press('p');
  check(await page.locator('#places').isHidden(), 'the strip can be put away');
  await page.keyboard.press('p');
  await page.keyboard.press('Home');
  await drawn(page);
}

/** On the drawings of the matches: exactly the same parts of the same triangle. */
export async function placesOfMatches({ page, check, sent }) {
  await page.click('[data-value="matches"]');
  await page.waitForSelector('#matches .cell .outline path', { state: 'attached' });
  const target = await page.evaluate(async () => {
    const { store } = await import('./state.js');
    const { triangles, poses } = store.meshes[store.layer];
    const { isInside } = await import('./located.js');
    const { match } = await import('./match.js');
    const svg = document.querySelector('#matches .cell .drawing');
    const corners = (t) => Array.from(triangles.subarray(3 * t, 3 * t + 3));
    const middle = (t, points) => [0, 1].map((d) => corners(t).reduce((sum, v) => sum + points[2 * v + d] / 3, 0));
    const { outline, holes } = match.data.poses[0];
    for (let t = 0; 3 * t < triangles.length; t++) {
      const own = middle(t, poses[0]);
      const { x, y } = new DOMPoint(...own).matrixTransform(svg.getScreenCTM());
      const isFree = isInside([outline, ...holes], own) && document.elementFromPoint(x, y) === svg.querySelector('image');
      if (isFree) return { x, y, wanted: poses.map((points) => middle(t, points)) };
    }
    return null;
  });
  const before = sent.length;
  await page.mouse.move(target.x - 1, target.y);
  await page.mouse.move(target.x, target.y);
  await shown(page);
  const found = await page.$$eval('#matches .cell', (cells) => cells.map((cell) => {
    const mark = cell.querySelector('.spot .middle');
    const at = mark && ['cx', 'cy'].map((name) => Number(mark.getAttribute(name)));
    return at && { at, unit: 1 / cell.querySelector('.drawing').getScreenCTM().a };
  }));
  // The state is always waited for.
  const asked = sent.slice(before).filter((request) => !request.startsWith('GET state'));
  const off = ({ at, unit }, wanted) => Math.hypot(at[0] - wanted[0], at[1] - wanted[1]) / unit;
  const far = found.map((mark, k) => (mark ? off(mark, target.wanted[k]) : Infinity));
  const most = Math.max(...far);
  check(most < 4, `over a drawing of the matches it is marked on all ${found.length}, ${most.toFixed(2)} pixels off at most`);
  check(asked.length === 0, 'and nothing is asked of the server for it');
  await page.click('[data-value="picture"]');
}
