// @ts-check
// Frames of where the probe is: one request at a time, and the newest place wins.
import { getJson, getWords, query, readFrames, Refused } from './api.js';
import { emit, on, store } from './state.js';

/** @import { Frame, Place } from './answers.js' */
/** @import { Comparison, ShownFrame } from './state.js' */

let wanted = false;
let asking = false;
/** @type {(() => void)[]} */
const waiting = [];
/**
 * Milliseconds from request to answer of the latest frames.
 * @type {number[]}
 */
export const roundTrips = [];

// Pointers move once a displayed frame, so that is how often frames are asked for.

/** Pixels of the screen that an outline may be off: the area of a pixel that it covers changes by as much at most. */
const OUTLINES_WITHIN = 0.04;
let asked = Infinity;
/** @type {() => { silhouette: number, tolerance: number }} */
export const outlines = () => ({ silhouette: 1, tolerance: OUTLINES_WITHIN * store.pixel });

/**
 * What a comparison shows in place of the scene's own settings.
 * @type {() => Comparison}
 */
export const instead = () => store.view.compare ?? {};

async function ask() {
  if (asking || !wanted || !store.scene?.poses.length) return;
  asking = true;
  wanted = false;
  const place = store.place.slice();
  /** @type {ShownFrame | null} */
  let frame = null;
  try {
    frame = store.state.revisions.shape > 0 ? await askFrame(place) : await askWeights(place);
  } catch (error) {
    if (!(error instanceof Refused)) await new Promise((wait) => setTimeout(wait, 500));
  }
  asking = false;
  // The next one is on its way while this one is drawn.
  if (wanted) ask();
  // A frame of meshes that are not here yet would be drawn with the wrong triangles; when they are, another one is asked for.
  if (frame && (frame.shape === 0 || frame.shape === store.puppet?.shape)) {
    store.frame = frame;
    emit('frame');
  }
  if (!wanted && !asking) waiting.splice(0).forEach((done) => done());
}

/** @type {(place: Place) => Promise<ShownFrame>} */
async function askFrame(place) {
  const started = performance.now();
  asked = store.pixel;
  const words = await getWords('frame', { at: place, ...outlines(), ...instead() });
  roundTrips.push(performance.now() - started);
  if (roundTrips.length > 240) roundTrips.shift();
  const [frame] = readFrames(words);
  frame.place = place;
  return /** @type {ShownFrame} */ (frame);
}

/**
 * Of a scene without a mesh the weights alone.
 * @type {(place: Place) => Promise<ShownFrame>}
 */
async function askWeights(place) {
  const [{ weights, texture_weights: textureWeights }] = await getJson('weights', { at: place });
  return { place, weights, textureWeights, shape: 0, revision: store.state.revisions.weights, inverted: 0, order: [], layers: [] };
}

/** Wants the frame of where the probe is now. What is wanted for several reasons at once is asked for once. */
export function wantFrame() {
  wanted = true;
  queueMicrotask(ask);
}

/**
 * Resolves when what is shown is where the probe is.
 * @type {() => Promise<void>}
 */
export function settled() {
  if (!wanted && !asking) return Promise.resolve();
  return new Promise((done) => waiting.push(done));
}

// Where matches are shown, nobody sees the picture: the match of a new shape comes first.
let isPutOff = false;
function wantPutOff() {
  if (!isPutOff) return;
  isPutOff = false;
  wantFrame();
}
on('place', wantFrame);
on('shape', () => (isPutOff = store.view.main === 'matches'));
on('weights', () => isPutOff || wantFrame());
on('matched', (shape) => shape === store.puppet?.shape && wantPutOff());
on('refused', wantPutOff);
on('view', (changes) => {
  if ('compare' in changes) wantFrame();
  if (store.view.main === 'picture') wantPutOff();
});
// Outlines for a smaller picture are too coarse for a larger one.
on('drawn', () => store.pixel < asked && wantFrame());

/**
 * Frames of poses or places, for what lies behind the picture; `thin`: with outlines that are as fine as can be seen.
 * @type {(name: 'poses' | 'at' | 'weights', values: (string | Place)[], thin?: boolean) => Promise<Frame[]>}
 */
export async function framesOf(name, values, thin = true) {
  if (values.length === 0 || !(store.state?.revisions.shape > 0)) return [];
  const search = values.map((value) => `${name}=${value}`).join('&');
  try {
    const words = await getWords(`frame${query(thin ? outlines() : { silhouette: 1 })}&${search}`);
    return readFrames(words).filter((frame) => frame.shape === store.puppet?.shape);
  } catch (error) {
    if (error instanceof Refused) return [];
    throw error;
  }
}
