// @ts-check
// What the matches show: the present match, the landmark that is looked at, the one that is being made or moved.
import { emit, notYet, store } from './state.js';

/** @import { Correspondences, KnownLandmark, Landmark, MatchPose, Place } from './answers.js' */

/** @typedef {SVGGElement & { madeOf?: unknown[] }} Layer What is drawn over a drawing, and of what it was made. */
/**
 * The drawing of a pose: `box` is all of it, `view` what is seen of it (left, top, width, height); `size` in CSS pixels, once it was asked
 * for; `cross` where the keyboard is; `marks` those of its landmarks, by what they show.
 * @typedef {{
 *   pose: MatchPose, index: number, box: number[], view: number[], size?: number[] | null, drawing: SVGSVGElement,
 *   layers: Record<'picture' | 'mesh' | 'outline' | 'links' | 'marks' | 'spot' | 'cross', Layer>,
 *   warning: HTMLElement, where: HTMLElement, element: HTMLElement, cross: Place | null, marks?: Map<string, SVGElement>,
 * }} Cell
 */
/** @typedef {KnownLandmark & { hue: string }} Known */
/** @typedef {{ path: false, at: Record<string, Place>, open?: null }} FreshPoint */
/** @typedef {{ path: true, at: Record<string, Place[]>, open: string | null, cell?: Cell }} FreshLine */
/** @typedef {{ name: string | null, cell: number, at: Place | Place[] }} Held */
/**
 * @typedef {{
 *   data: Correspondences, known: Map<string, Known>, chosen: string | null, pointed: string | number | null,
 *   fresh: FreshPoint | FreshLine | null, held: Held | null,
 * }} Match
 */

/** @type {Match} */
export const match = {
  /** `api/correspondences`; null before the first answer. */
  data: notYet(),
  /** What the mapping knows of each landmark by its name, and its colour. */
  known: new Map(),
  /** The landmark that is looked at, by name; the link (a number) or landmark (a name) under the pointer. */
  chosen: null,
  pointed: null,
  /** A landmark that is not added yet: {path, at: {pose: [x, y] or, of a line, points}, open: the pose on which a line is being drawn}. */
  fresh: null,
  /** One that is being dragged: {name, cell, at}. */
  held: null,
};

/**
 * Takes an answer, which leaves out the outlines that are those of the match before.
 * @type {(data: Correspondences, before: Correspondences | null) => void}
 */
export function takeMatch(data, before) {
  match.data = data;
  for (const pose of data.poses.filter((pose) => pose.outline === undefined)) {
    const own = before?.poses.find((other) => other.mark === pose.mark);
    const { outline, holes, salient } = /** @type {MatchPose} */ (own);
    Object.assign(pose, { outline, holes, salient });
  }
  /** @type {(landmark: KnownLandmark) => Known} */
  const coloured = (landmark) => ({ ...landmark, hue: hue(landmark.kind === 'line' ? null : landmark.at[data.reference]?.[0]) });
  match.known = new Map((data.landmarks ?? []).map((landmark) => [landmark.name, coloured(landmark)]));
  data.links?.forEach((link) => (link.hue = hue(link.at[data.reference])));
}

/** Places of an outline that are told apart by their hue. */
const HUES = 720;

/**
 * A colour for what lies at a place of the reference's outline: once around the circle of hues.
 * @type {(at: Place | null | undefined) => string}
 */
function hue(at) {
  const outline = match.data.poses[match.data.reference]?.outline;
  if (!outline || !at) return 'hsl(226 70% 52%)';
  let [best, where] = [Infinity, 0];
  const step = 2 * Math.max(1, Math.floor(outline.length / 2 / HUES));
  for (let k = 0; k < outline.length; k += step) {
    const far = (outline[k] - at[0]) ** 2 + (outline[k + 1] - at[1]) ** 2;
    if (far < best) [best, where] = [far, k];
  }
  return `hsl(${Math.round((360 * where) / outline.length)} 74% 44%)`;
}

/**
 * The names of the poses with drawings of their own.
 * @type {() => string[]}
 */
export const drawnPoses = () => match.data?.poses.filter((pose) => pose.drawn).map((pose) => pose.name) ?? [];

/**
 * The points of a landmark on a pose: those of a line, or the only one.
 * @type {(path: boolean, at: Place | Place[]) => Place[]}
 */
export const pointsAt = (path, at) => /** @type {Place[]} */ (path ? at : [at]);

/**
 * Where a landmark is on a pose: `points` (one, or those of a line), and whether the scene says so; null if nobody knows.
 * @type {(landmark: Landmark, pose: string, index: number) => { points: Place[], given: boolean } | null}
 */
export function placesOf(landmark, pose, index) {
  const own = landmark.at[pose];
  const { held } = match;
  if (held?.name === landmark.name && held.cell === index) return { points: pointsAt(landmark.path, held.at), given: true };
  if (own) return { points: pointsAt(landmark.path, own), given: true };
  const carried = match.known.get(landmark.name)?.at[index];
  if (!carried?.length) return null;
  return { points: landmark.path ? carried : carried.slice(0, 1), given: false };
}

/** @type {(name: string | null) => void} */
export function choose(name) {
  match.chosen = name;
  emit('marks');
}

/** The landmarks of the layer that is shown. */
export const ownLandmarks = () => store.scene.landmarks.filter((landmark) => (landmark.layer ?? 0) === store.layer);
