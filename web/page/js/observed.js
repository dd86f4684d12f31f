// @ts-check
// The scene as the observer from outside sees it, in object order: the engine draws it. At most one picture is under way; of
// those that are wanted meanwhile, the last one comes next.

/** The pixels of a picture at rest, at most: up to four for one of the screen, so that edges are smooth. */
const MOST_AT_REST = 3_000_000;
/** The pixels of a picture while the observer turns: as many as are drawn in time, and the limits of that. */
let turningPixels = 250_000;
const TURNING = { least: 40_000, most: 400_000, ms: 12 };

/**
 * @typedef {object} Wanted
 * @property {Observer3} observer
 * @property {StageMap} map
 * @property {number} cut  What is nearer to the observer is cut away, so that it does not hide the camera.
 * @property {(surface: Surface | null) => void} draw
 */

/** @type {Surface | null} */
let surfaceNow = null;
/** @type {Wanted | null} */
let wantedNext = null;
let isObserving = false;

/** Draws once the picture is there: at once if nothing has changed. @param {Wanted} wanted */
function observe(wanted) {
  if (surfaceNow?.key === keyOf(wanted)) {
    wantedNext = null;
    return wanted.draw(surfaceNow);
  }
  wantedNext = wanted;
  if (!isObserving) void observeNext();
}

async function observeNext() {
  isObserving = true;
  while (wantedNext) {
    const wanted = wantedNext;
    wantedNext = null;
    try {
      surfaceNow = await surfaceFor(wanted);
      wanted.draw(surfaceNow);
    } catch (error) {
      // The camera is shown in any case.
      wanted.draw(null);
      showTrouble(messageOf(error));
    }
  }
  isObserving = false;
}

/** @param {Wanted} wanted */
const keyOf = ({ observer, map, cut }) =>
  JSON.stringify([sceneKey(), observer, map.width, map.height, cut, devicePixelRatio]);

/**
 * The observer as a camera of the engine: its picture lies on the canvas exactly as the map places points there.
 * @param {Wanted} wanted
 */
function observersCamera({ observer: { centre, from, turns }, map, cut }) {
  const { width, height, scale } = map;
  const onScreen = width * height * devicePixelRatio ** 2;
  const most = turns ? Math.min(turningPixels, onScreen) : Math.min(4 * onScreen, Math.max(MOST_AT_REST, onScreen));
  const finer = Math.sqrt(most / (width * height));
  return {
    projection: "parallel",
    eye: add(centre, scaled(from, cut)),
    u: map.right,
    v: map.above,
    w: from,
    d: width / scale,
    vw: width / scale,
    vh: height / scale,
    width: Math.max(1, Math.round(width * finer)),
    height: Math.max(1, Math.round(height * finer)),
  };
}

/** @param {Wanted} wanted @returns {Promise<Surface>} */
async function surfaceFor(wanted) {
  const key = keyOf(wanted);
  const begun = performance.now();
  const camera = observersCamera(wanted);
  const { rgba, t, width, height } = await engine.call("observed", { camera });
  if (wanted.observer.turns) {
    const share = TURNING.ms / (performance.now() - begun);
    turningPixels = clamp(turningPixels * clamp(share, 0.7, 1.2), TURNING.least, TURNING.most);
  }
  const sheet = surfaceNow?.sheet ?? document.createElement("canvas");
  paintPixels(sheet, rgba, width, height);
  return { key, camera, sheet, t, columns: width, rows: height, cut: wanted.cut };
}
