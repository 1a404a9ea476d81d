// @ts-check
// The picture: the frame where the probe is, with what can be laid under and over it.
import { byId, h, onceAFrame, short } from './dom.js';
import { curves, placeCurves } from './curves.js';
import { emit, on, store } from './state.js';
import { getWords } from './api.js';
import { framesOf } from './frames.js';
import { extentOfAll } from './geometry.js';
import { Newest } from './newest.js';
import { painterOf } from './painter.js';
import { readSurfaces, Surface } from './surface.js';
import { drawingView, frameGrid, frameSize, frameView, panBy, zoomBy } from './view.js';
import { attachHandles, drawHandles, pictureDrag } from './handles.js';

/** @import { Frame, Puppet } from './answers.js' */
/** @import { PaintedAs } from './painter.js' */

const stage = byId('stage');
const paper = h('div', { class: 'paper', 'aria-hidden': 'true' });
const canvas = h('canvas', { class: 'picture', id: 'picture', role: 'img', 'aria-label': 'The drawing at the probe' });
const note = h('p', { class: 'note' });
const badge = h('button', { type: 'button', class: 'badge hidden', title: 'Show the mesh' });
stage.append(paper, canvas, curves, note, badge);
attachHandles(stage);

const painter = painterOf(canvas);

/** What is said in place of a picture. */
const UNMAPPED = 'There is no drawing yet: the scene cannot be mapped. Drawings shows what was taken for the figure of each.';
/** The colours of meshes, premultiplied. */
const WIRES = { line: [0.2 * 0.8, 0.33 * 0.8, 0.85 * 0.8, 0.8], wrong: [0.82, 0.18, 0.15, 1] };

/** @type {Frame[]} */
let under = [];
/** @type {Puppet | null} */
let loaded = null;

/**
 * A colour of the style as premultiplied red, green, blue, alpha.
 * @type {(name: string, alpha: number) => number[]}
 */
function styled(name, alpha) {
  const text = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  return [...[1, 3, 5].map((k) => (parseInt(text.slice(k, k + 2), 16) / 255) * alpha), alpha];
}

function draw() {
  if (store.view.main !== 'picture') {
    if (store.frame) tellWhat();
    return;
  }
  const ratio = devicePixelRatio;
  const [width, height] = [Math.round(stage.clientWidth * ratio), Math.round(stage.clientHeight * ratio)];
  if (width === 0 || height === 0) return;
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  const corner = frameView();
  const [w, h_] = frameSize();
  paper.style.transform = `translate(${corner.x}px, ${corner.y}px)`;
  paper.style.width = `${w * corner.scale}px`;
  paper.style.height = `${h_ * corner.scale}px`;
  placeCurves(corner, [w, h_]);
  const background = store.scene?.animation?.background;
  paper.style.background = background && background !== 'transparent' ? background : '';
  paper.classList.toggle('hidden', !store.frame?.layers.length);
  note.textContent = store.scene && !(store.state.revisions.shape > 0) ? UNMAPPED : '';
  // While new meshes are on their way the last picture stays.
  if (store.frame?.layers.length && (loaded !== store.puppet || store.frame.shape !== loaded?.shape)) return;
  if (!store.frame?.layers.length) {
    if (store.frame) tellWhat();
    return;
  }
  const view = drawingView();
  store.pixel = 1 / (view.scale * ratio);
  painter.begin({ scale: view.scale * ratio, x: view.x * ratio, y: view.y * ratio });
  const looks = { inLight: store.scene.texture?.blending === 'linear', grid: frameGrid() };
  const accent = styled('--accent', 1);
  under.forEach((frame) => paint(frame, { ...looks, opacity: 0.2, tint: [...accent.slice(0, 3), 0.45] }));
  const shown = handled() ?? store.frame;
  if (shown.layers.length === painter.layers.length) {
    paint(shown, looks);
    if (store.view.mesh) painter.wires(shown, store.meshes, { ...WIRES, thickness: 0.35 * ratio });
  }
  drawHandles();
  const inverted = shown.inverted;
  badge.classList.toggle('hidden', !(inverted > 0));
  badge.textContent = `${inverted} inverted ${inverted === 1 ? 'triangle' : 'triangles'}`;
  const at = store.place.map((v) => short(v)).join(', ');
  const folds = inverted > 0 ? `, ${inverted} triangles inverted` : '';
  const label = `The drawing at ${at}${folds}: arrow keys move a cross, whose place is told for all drawings`;
  canvas.setAttribute('aria-label', label);
  tellWhat();
  emit('drawn');
}

/** What is shown, for whoever waits for it from outside. */
function tellWhat() {
  canvas.dataset.at = store.frame.place.join(',');
  canvas.dataset.shape = String(store.frame.shape);
  canvas.dataset.weights = String(store.frame.revision);
}

/**
 * A frame with a layer's mesh that is being bent by handles, if there is one.
 * @type {Frame | null}
 */
let bent = null;
on('bent', (frame) => {
  bent = frame;
  redraw();
});
const handled = () => (store.view.tool === 'bend' ? bent : null);

export const redraw = onceAFrame(draw);
/** The same without waiting for the next displayed frame, and until it is done. */
export function drawNow() {
  draw();
  painter.finish();
}

// The poses as they are drawn, for the pad.

/** Milliseconds without another shape after which textures are registered and thumbnails drawn. */
const RESTING_AFTER = 400;
/** Pixels of a thumbnail while it is drawn. */
const THUMBNAIL = 192;
let resting = 0;

async function drawThumbnails() {
  const frames = await framesOf('poses', ['all']);
  if (frames.length !== store.scene.poses.length) return;
  // Drawn into the picture's own canvas and copied before anybody sees it.
  const side = Math.min(THUMBNAIL, canvas.width, canvas.height);
  frames.forEach((frame, pose) => {
    const shown = frame.layers.filter((layer) => layer.opacity > 0).flatMap((layer) => layer.rings);
    if (shown.length === 0 || frame.layers.length !== painter.layers.length || side < 16) return;
    const [low, high] = extentOfAll(shown);
    const scale = (side - 4) / Math.max(high[0] - low[0], high[1] - low[1]);
    const view = { scale, x: 2 - low[0] * scale, y: 2 - low[1] * scale };
    painter.begin(view);
    paint(frame, { inLight: store.scene.texture?.blending === 'linear', grid: frameGrid() });
    const box = [0, 0, Math.ceil((high[0] - low[0]) * scale) + 4, Math.ceil((high[1] - low[1]) * scale) + 4];
    emit('thumbnail', { pose, canvas, view, frame, box });
  });
  draw();
}

/**
 * What the pictures of each layer are painted on.
 * @type {Surface[]}
 */
let surfaces = [];
/** @type {(frame: Frame, how: PaintedAs) => void} */
const paint = (frame, how) => painter.frame({ ...frame, layers: frame.layers.map((shape, k) => surfaces[k].carried(shape)) }, how);

const loads = new Newest();
/**
 * The revision of the pictures that the painter has.
 * @type {number | null}
 */
let pictures = null;
/**
 * Whether they are to be registered to one another.
 * @type {string | undefined}
 */
let registered;
/**
 * One of the pictures of a layer.
 * @type {(layer: number, index: number, kind: string) => Promise<ImageBitmap>}
 */
async function picture(layer, index, kind) {
  const answer = await fetch(`api/texture?layer=${layer}&index=${index}&kind=${kind}&v=${store.puppet.pictures}`);
  return createImageBitmap(await answer.blob(), { premultiplyAlpha: 'none', colorSpaceConversion: 'none' });
}

async function load() {
  const mine = loads.begin();
  const { puppet, meshes } = store;
  clearTimeout(resting);
  registered = store.scene?.texture?.register;
  try {
    /** @type {(kind: string) => Promise<ImageBitmap[][]>} */
    const all = (kind) => Promise.all(puppet.layers.map((layer, l) => Promise.all(layer.textures.map((_, k) => picture(l, k, kind)))));
    const isKnown = pictures === puppet.pictures;
    const [bitmaps, masks] = await Promise.all([isKnown ? null : all('colour'), isKnown || !puppet.nearest ? null : all('inside')]);
    if (!loads.is(mine)) return;
    surfaces = meshes.map((mesh) => new Surface(mesh, null));
    painter.load(puppet, surfaces, bitmaps, masks);
    pictures = puppet.pictures;
    loaded = puppet;
    document.documentElement.dataset.shape = String(puppet.shape);
    redraw();
    drawUnder();
    clearTimeout(resting);
    resting = setTimeout(rest, RESTING_AFTER);
  } catch (error) {
    console.error(error);
  }
}

/** What takes longer than a picture may: while edits follow one another, nobody waits for it. */
async function rest() {
  const mine = loads.count;
  try {
    const finer = readSurfaces(await getWords('surface'));
    if (!loads.is(mine)) return;
    if (finer.some(Boolean)) {
      surfaces = store.meshes.map((mesh, k) => new Surface(mesh, finer[k]));
      if (loaded) painter.load(loaded, surfaces, null);
      redraw();
    }
    await drawThumbnails();
  } catch (error) {
    console.error(error);
  }
}

canvas.addEventListener('webglcontextlost', (event) => event.preventDefault());
canvas.addEventListener('webglcontextrestored', () => {
  painter.build?.();
  pictures = null;
  load();
});

// What lies behind.

async function drawUnder() {
  const { onion } = store.view;
  if (onion === 'off' || !store.scene) {
    under = [];
  } else if (onion === 'poses') {
    under = await framesOf('poses', ['all']);
  } else {
    const path = store.path ?? [];
    const wanted = 7;
    const count = Math.min(wanted, path.length);
    const places = Array.from({ length: count }, (_, k) => path[Math.round((k / wanted) * (path.length - 1))]);
    under = await framesOf('at', places);
  }
  redraw();
}

// The pointer.

canvas.addEventListener('wheel', (event) => {
  event.preventDefault();
  const box = stage.getBoundingClientRect();
  if (event.ctrlKey || event.metaKey || !event.shiftKey) {
    const factor = Math.exp(-event.deltaY * (event.ctrlKey ? 0.01 : 0.0016));
    zoomBy(factor, [event.clientX - box.left, event.clientY - box.top]);
  } else panBy(-event.deltaX, -event.deltaY);
}, { passive: false });
canvas.addEventListener('pointerdown', (event) => {
  if (event.button === 1 || store.view.tool === 'pan') {
    event.preventDefault();
    let last = [event.clientX, event.clientY];
    canvas.setPointerCapture(event.pointerId);
    canvas.classList.add('panning');
    /** @type {(next: PointerEvent) => void} */
    const move = (next) => {
      panBy(next.clientX - last[0], next.clientY - last[1]);
      last = [next.clientX, next.clientY];
    };
    const end = () => {
      canvas.classList.remove('panning');
      canvas.removeEventListener('pointermove', move);
    };
    canvas.addEventListener('pointermove', move);
    canvas.addEventListener('pointerup', end, { once: true });
    canvas.addEventListener('pointercancel', end, { once: true });
  } else if (event.button === 0) {
    pictureDrag(event);
  }
});
badge.addEventListener('click', () => emit('toggle-mesh'));

// What is hidden waits: while landmarks are dragged, meshes come faster than they could be loaded.
const loadIfSeen = () => store.view.main === 'picture' && store.puppet && loaded !== store.puppet && load();
on('shape', loadIfSeen);
on('scene', () => loaded && store.scene?.texture && store.scene.texture.register !== registered && load());
// At once: it is shown with the next displayed frame, not the one after.
on('frame', draw);
on('scene zoom theme', redraw);
on('view', (changes) => {
  stage.dataset.tool = store.view.tool;
  if ('main' in changes) loadIfSeen();
  redraw();
  if ('onion' in changes) drawUnder();
});
on('weights path', () => store.view.onion !== 'off' && drawUnder());
new ResizeObserver(() => {
  emit('zoom');
  draw();
}).observe(stage);
