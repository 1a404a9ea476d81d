// What the matches show: the present match, the landmark that is looked at, the one that is being made or moved.
import { emit, store } from './state.js';

export const match = {
  /** `api/correspondences`. */
  data: null,
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

/** Takes an answer, which leaves out the outlines that are those of the match before. */
export function takeMatch(data, before) {
  match.data = data;
  for (const pose of data.poses.filter((pose) => pose.outline === undefined)) {
    const { outline, holes, salient } = before.poses.find((other) => other.mark === pose.mark);
    Object.assign(pose, { outline, holes, salient });
  }
  const coloured = (landmark) => ({ ...landmark, hue: hue(landmark.kind === 'line' ? null : landmark.at[data.reference]?.[0]) });
  match.known = new Map((data.landmarks ?? []).map((landmark) => [landmark.name, coloured(landmark)]));
  data.links?.forEach((link) => (link.hue = hue(link.at[data.reference])));
}

/** Places of an outline that are told apart by their hue. */
const HUES = 720;

/** A colour for what lies at a place of the reference's outline: once around the circle of hues. */
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

/** The names of the poses with drawings of their own. */
export const drawnPoses = () => match.data?.poses.filter((pose) => pose.drawn).map((pose) => pose.name) ?? [];

/** Where a landmark is on a pose: `points` (one, or those of a line), and whether the scene says so; null if nobody knows. */
export function placesOf(landmark, pose, index) {
  const own = landmark.at[pose];
  const { held } = match;
  if (held?.name === landmark.name && held.cell === index) return { points: landmark.path ? held.at : [held.at], given: true };
  if (own) return { points: landmark.path ? own : [own], given: true };
  const carried = match.known.get(landmark.name)?.at[index];
  if (!carried?.length) return null;
  return { points: landmark.path ? carried : carried.slice(0, 1), given: false };
}

export function choose(name) {
  match.chosen = name;
  emit('marks');
}

/** The landmarks of the layer that is shown. */
export const ownLandmarks = () => store.scene.landmarks.filter((landmark) => (landmark.layer ?? 0) === store.layer);
