// Edits of the scene by pointer and keys, each undone to the byte: line landmarks, keys in time, pseudo-poses; and what happens when
// somebody else writes the file in the middle of one.
//
// Every proof takes what `explorer.mjs` drives the page with: {page, scene, check, centre, drag, drawn, edited, saved, padPoint}.
import { readFileSync, writeFileSync } from 'node:fs';
import { api, until } from './driver.mjs';

/** Undoes all there is, and compares the file with what it was. */
async function undone({ page, scene, check, saved }, bytes, what) {
  for (let steps = 0; steps < 20 && (await api(page, 'state')).undo !== null; steps++) {
    await page.click('#undo');
    await saved(page);
  }
  check(Buffer.compare(readFileSync(scene), bytes) === 0, `undo restores the bytes after ${what}`);
}

/** A landmark by keys alone: a cross is moved to a free place inside a drawing, a landmark put there, and moved on another drawing. */
export async function landmarkByKeys(tools) {
  const { page, scene, check, edited } = tools;
  const bytes = readFileSync(scene);
  await page.locator('#probe').focus();
  await page.keyboard.press('v');
  await page.waitForSelector('#matches .cell .outline path', { state: 'attached' });
  const { poses } = await api(page, 'correspondences');
  const cells = poses.map((pose, k) => [pose, page.locator('#matches .cell').nth(k)]).filter(([pose]) => pose.drawn);
  const cross = (cell) => cell.locator('[role="status"]').textContent().then((text) => text.split(', ').map(Number));
  const [[first, cell], [second, other]] = cells;
  await cell.locator('.drawing').focus();
  const isFree = () => cell.locator('.drawing').evaluate(async (svg) => {
    // The cross is drawn with the next displayed frame.
    await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    const { x, y, width, height } = svg.querySelector('.cross').getBBox();
    const at = Object.assign(svg.createSVGPoint(), { x: x + width / 2, y: y + height / 2 });
    const near = [...svg.querySelectorAll('.mark, .line, .link')].some((mark) => {
      const box = mark.getBBox();
      return at.x > box.x - 4 && at.x < box.x + box.width + 4 && at.y > box.y - 4 && at.y < box.y + box.height + 4;
    });
    return !near && svg.querySelector('.outline path').isPointInFill(at);
  });
  for (let k = 0; k < 60 && !(await isFree()); k++) await page.keyboard.press(k % 7 === 6 ? 'ArrowUp' : Math.floor(k / 7) % 2 ? 'ArrowLeft' : 'ArrowRight');
  const wanted = await cross(cell);
  await page.keyboard.press(' ');
  await page.waitForSelector('#add-landmark', { state: 'visible' });
  await other.locator('.drawing').focus();
  const carried = await cross(other);
  await page.keyboard.press('Shift+ArrowRight');
  await page.keyboard.press(' ');
  const moved = await cross(other);
  check(moved[0] > carried[0] && moved[1] === carried[1], 'an arrow key moves the cross on a drawing');
  await page.keyboard.press('Enter');
  await edited(page, 'add a landmark');
  const { at } = (await api(page, 'scene')).landmarks.at(-1);
  const isAt = (place, [x, y]) => Math.abs(place[0] - x) < 0.06 && Math.abs(place[1] - y) < 0.06;
  check(isAt(at[first.name], wanted) && isAt(at[second.name], moved), 'a landmark is added and moved by keys alone');
  await undone(tools, bytes, 'a landmark by keys');
  await page.click('[data-value="picture"]');
}

/** A line is drawn on one drawing, lands on all, is a chain of edges of the mesh, and is bent by one of its points. */
export async function lines(tools) {
  const { page, scene, check, centre, drag, edited } = tools;
  const bytes = readFileSync(scene);
  await page.click('[data-value="matches"]');
  await page.waitForSelector('#matches .cell .outline path', { state: 'attached' });
  await page.click('#tab-landmarks');
  await page.keyboard.press('l');
  const before = await api(page, 'correspondences');
  const drawn = before.poses.filter((pose) => pose.drawn);
  const cell = page.locator('#matches .cell').nth(before.poses.indexOf(drawn[0]));
  // Two places well inside the first drawing, away from all marks, as near to one another as 40 pixels allow.
  const spots = await cell.locator('.drawing').evaluate((svg) => {
    const path = svg.querySelector('.outline path');
    const [matrix, box] = [svg.getScreenCTM(), svg.getBoundingClientRect()];
    const free = [];
    const isFree = (x, y) => {
      const { x: u, y: v } = new DOMPoint(x, y).matrixTransform(matrix.inverse());
      const point = svg.createSVGPoint();
      Object.assign(point, { x: u, y: v });
      return path.isPointInFill(point) && !document.elementFromPoint(x, y)?.closest('.mark, .line, .link');
    };
    const around = [[0, 0], [7, 0], [-7, 0], [0, 7], [0, -7]];
    for (let x = box.x + 8; x < box.right - 8; x += 6) {
      for (let y = box.y + 8; y < box.bottom - 8; y += 6) if (around.every(([dx, dy]) => isFree(x + dx, y + dy))) free.push([x, y]);
    }
    let best = null;
    for (const p of free) {
      for (const q of free) {
        const far = Math.hypot(p[0] - q[0], p[1] - q[1]);
        if (far >= 24 && (!best || far < best.far)) best = { far, spots: [p, q] };
      }
    }
    return best?.spots ?? null;
  });
  if (!spots) {
    await page.keyboard.press('l');
    await page.click('[data-value="picture"]');
    return;
  }
  await page.mouse.click(...spots[0]);
  await page.mouse.move(...spots[1]);
  await page.mouse.dblclick(...spots[1]);
  await page.waitForSelector('#add-landmark', { state: 'visible' });
  check(await page.locator('.line.fresh').count() === drawn.length, `a line that is drawn on one drawing is proposed on all ${drawn.length}`);
  await page.click('#add-landmark');
  await edited(page, 'add a line');
  const scenes = await api(page, 'scene');
  const { name, path, at } = scenes.landmarks.at(-1);
  const after = await api(page, 'correspondences');
  const known = after.landmarks.find((landmark) => landmark.name === name);
  check(path && Object.values(at).every((points) => points.length === 2) && String(readFileSync(scene)).includes('path = true'), 'the line is in the file');
  check(known?.kind === 'line' && known.at.every((points) => points.length >= 2) && after.shape > before.shape, 'the mesh has it in every pose');
  const [x, y] = await centre(cell, '.line.chosen [data-node="1"] .node');
  await drag(page, [x, y], [x + 5, y - 4], 5, 40);
  await edited(page, 'move landmark');
  const bent = (await api(page, 'scene')).landmarks.at(-1).at[drawn[0].name];
  check(bent.length === 2 && Math.hypot(bent[1][0] - at[drawn[0].name][1][0], bent[1][1] - at[drawn[0].name][1][1]) > 0.5, 'a point of the line is dragged');
  const middle = (p, q) => [(p[0] + q[0]) / 2, (p[1] + q[1]) / 2];
  const ends = [await centre(cell, '.line.chosen [data-node="0"] .node'), await centre(cell, '.line.chosen [data-node="1"] .node')];
  const between = middle(...ends);
  await drag(page, between, [between[0] + 3, between[1] + 6], 5, 40);
  await until(page, async (own) => (await (await fetch('api/scene')).json()).landmarks.at(-1).at[own].length === 3, drawn[0].name, { timeout: 10000 });
  check(true, 'dragging the line between two points makes a third');
  await page.keyboard.press('l');
  await undone(tools, bytes, 'a line');
  await page.click('[data-value="picture"]');
  await tools.drawn(page);
}

/** A key of the animation is dragged along the timeline. */
export async function keysInTime(tools) {
  const { page, scene, check, edited, drag } = tools;
  const bytes = readFileSync(scene);
  const { keys } = (await api(page, 'scene')).animation;
  if (keys.length < 3) return;
  // The one with most room behind it.
  const room = keys.map((key, k) => (k > 0 && k + 1 < keys.length ? keys[k + 1].time - key.time : 0));
  const index = room.indexOf(Math.max(...room));
  const box = await page.locator('.mark-key').nth(index).boundingBox();
  const from = [box.x + box.width / 2, box.y + box.height / 2];
  await drag(page, from, [from[0] + 9, from[1]], 4, 30);
  await edited(page, 'move a key');
  const moved = (await api(page, 'scene')).animation.keys;
  check(moved[index].time > keys[index].time && moved.length === keys.length, `key ${index + 1} of ${moved.length} is dragged from ${keys[index].time} to ${moved[index].time} s`);
  await undone(tools, bytes, 'a key');
}

/** A pseudo-pose is added where the probe is, moved by pointer and key, and changes the weights. */
export async function pseudoPoses(tools) {
  const { page, scene, check, drag, drawn, edited } = tools;
  const bytes = readFileSync(scene);
  await page.keyboard.press('Home');
  await page.locator('#probe').focus();
  // Away from the thumbnails, which lie over it.
  for (let k = 0; k < 20; k++) await page.keyboard.press(k % 2 ? 'ArrowRight' : 'ArrowUp');
  const now = await drawn(page);
  const at = (await page.getAttribute('#picture', 'data-at')).split(',').map(Number);
  await page.click('#tab-scene');
  await page.click('#add-pseudo');
  await edited(page, 'add a pseudo-pose');
  check((await api(page, 'scene')).pseudo_poses.length === 1 && (await api(page, 'state')).revisions.weights > now.revisions.weights, 'a pseudo-pose is added where the probe is, and the weights are solved again');
  const weightsAt = async () => (await page.evaluate(async (place) => (await (await fetch(`api/weights?at=${place}`)).json())[0].weights, at.join(',')));
  const plain = await weightsAt();
  const dot = await page.locator('circle.pseudo.at').boundingBox();
  const from = [dot.x + dot.width / 2, dot.y + dot.height / 2];
  // From under the probe, which lies over it.
  await page.keyboard.press('Home');
  await drawn(page);
  await drag(page, from, [from[0] + 26, from[1] - 14], 6, 40);
  await edited(page, 'move a pseudo-pose');
  const dragged = (await api(page, 'scene')).pseudo_poses[0];
  check(Math.hypot(dragged.at[0] - at[0], dragged.at[1] - at[1]) > 0.05 && Math.hypot(dragged.from[0] - at[0], dragged.from[1] - at[1]) < 1e-3, `dragging it moves the place where it shows what was there (${dragged.from} shown at ${dragged.at})`);
  const other = await weightsAt();
  check(other.some((weight, k) => Math.abs(weight - plain[k]) > 1e-3), 'and changes the weights around');
  await page.locator('circle.pseudo.at').focus();
  await page.keyboard.press('ArrowLeft');
  await until(page, async (old) => (await (await fetch('api/scene')).json()).pseudo_poses[0].at[0] < old, dragged.at[0]);
  check(true, 'an arrow key moves it, too');
  await tools.saved(page);
  await page.getByLabel('Remove pseudo-pose 1').click();
  await until(page, async () => (await (await fetch('api/scene')).json()).pseudo_poses.length === 0);
  check(true, 'and it is removed');
  await undone(tools, bytes, 'pseudo-poses');
}

/** The file is written by somebody else while a pose is dragged. */
export async function conflict(tools) {
  const { page, scene, check, drawn } = tools;
  const text = readFileSync(scene, 'utf8');
  const theirs = `${text}\n# written elsewhere\n`;
  const { poses } = await api(page, 'scene');
  const element = page.locator(`.pose[data-pose="${poses[1].name}"]`);
  const meanwhile = async () => {
    const box = await element.boundingBox();
    const [x, y] = [box.x + box.width / 2, box.y + 6];
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 10, y + 12, { steps: 4 });
    await until(page, async () => (await (await fetch('api/state')).json()).dragging);
    writeFileSync(scene, theirs);
    await page.mouse.up();
    // The last of the drag has arrived, too.
    await until(page, async () => {
      const now = await (await fetch('api/state')).json();
      return now.conflict && !now.dragging;
    }, null, { timeout: 10000 });
    await page.waitForSelector('.banner:not(.hidden)');
  };
  await meanwhile();
  check(readFileSync(scene, 'utf8') === theirs, 'what somebody else has written meanwhile is not overwritten');
  await page.getByRole('button', { name: 'Read the file' }).click();
  await until(page, async () => !(await (await fetch('api/state')).json()).conflict);
  const read = (await api(page, 'scene')).poses[1].at;
  check(read.join() === poses[1].at.join() && readFileSync(scene, 'utf8') === theirs, 'the file is read instead where the artist says so');
  writeFileSync(scene, text);
  await page.waitForTimeout(1200);
  await drawn(page);
  await meanwhile();
  await page.getByRole('button', { name: 'Keep what is here' }).click();
  await until(page, async () => {
    const now = await (await fetch('api/state')).json();
    return !now.conflict && now.saved;
  });
  const kept = readFileSync(scene, 'utf8');
  check(kept !== theirs && kept !== text && !kept.includes('written elsewhere'), 'or what is here is kept, and written');
  writeFileSync(scene, text);
  await until(page, async (old) => (await (await fetch('api/scene')).json()).poses[1].at.join() === old, poses[1].at.join(), { timeout: 10000 });
  await drawn(page);
}
