// @ts-check
// The view from outside: the camera, its rays and what they hit; perspective becoming parallel before the viewer's eyes.

/** @type {Outside | null} */
let outsideNow = null;
/** @type {ViewingRay[]} */
let raysNow = [];
/** @type {Observer3 | null} */
let observerNow = null;
let outsideFor = "";
let observedScene = "";

/** The rays that are asked for at most, in a row, a column, or on each side of the image. */
const MOST_RAYS = { row: 40, column: 40, all: 12 };

const askOutside = debounced(30, async () => {
  if (viewOf(state.chapter) !== "outside" || !state.camera || !state.pixel) return;
  const {
    camera,
    pixel: [row, column],
  } = state;
  const wantedFor = JSON.stringify([sceneKey(), camera, row, column, state.rays]);
  if (wantedFor === outsideFor) return;
  outsideFor = wantedFor;
  const which = {
    one: { row, column },
    row: { row, most: MOST_RAYS.row },
    column: { column, most: MOST_RAYS.column },
    all: { all: MOST_RAYS.all },
  }[state.rays];
  try {
    const outside = await engine.call("outside", { camera });
    const { rays } = await engine.call("rays", { camera, ...which });
    if (state.rays !== "one") rays.push(...(await engine.call("rays", { camera, row, column })).rays);
    if (wantedFor !== outsideFor) return;
    turnInto(outside, rays);
  } catch (error) {
    outsideFor = "";
    showTrouble(messageOf(error));
  }
});

/** Where a ray that hits nothing is cut off. @param {Outside} outside */
const farAway = (outside) =>
  1.5 * Math.max(lengthOf(subtract(outside.eye, pivot)), lengthOf(subtract(outside.eye, outside.corners[0])));

/**
 * @param {Outside} outside
 * @param {ViewingRay} ray
 * @returns {DrawnRay}
 */
function drawnRay(outside, { row, column, origin, direction, point }) {
  const far = scaled(direction, farAway(outside) / lengthOf(direction));
  return { row, column, origin, through: add(origin, direction), end: point ?? add(origin, far), hit: point !== null };
}

/** @type {{outside: Outside, rays: DrawnRay[]} | null} */
let stageBefore = null;
let turning = 0;

/**
 * Shows another camera; where the projection has changed, its rays move from the one to the other.
 * @param {Outside} outside
 * @param {ViewingRay[]} rays
 */
function turnInto(outside, rays) {
  const changedProjection = outsideNow && outsideNow.projection !== outside.projection && observedScene === state.scene;
  stageBefore =
    changedProjection && outsideNow
      ? { outside: outsideNow, rays: raysNow.map((ray) => drawnRay(/** @type {Outside} */ (outsideNow), ray)) }
      : null;
  const isMoved = JSON.stringify(outside) !== JSON.stringify(outsideNow);
  outsideNow = outside;
  raysNow = rays;
  if (!observerNow || observedScene !== state.scene) observerNow = besideCamera(outside, pivot);
  observedScene = state.scene;
  // A camera that moves by sliders moves often, too.
  if (isMoved) {
    observerNow.turns = true;
    drawAtRest();
  }
  tellRays();
  // A wider viewport needs more distance to be seen.
  const [near, far] = [observerNow.size, Math.max(observerNow.size, 0.85 * besideCamera(outside, pivot).size)];
  const started = performance.now();
  const turn = ++turning;
  const step = (/** @type {number} */ now) => {
    if (turn !== turning) return;
    const part = stageBefore && !lessMotion.matches ? clamp((now - started) / 1100, 0, 1) : 1;
    const smooth = part * part * (3 - 2 * part);
    if (observerNow && far > near) observerNow.size = near + (far - near) * smooth;
    drawOutside(smooth);
    if (part < 1) requestAnimationFrame(step);
  };
  requestAnimationFrame(step);
}

/** @param {number} [part]  Of the way from the projection before. */
function drawOutside(part = 1) {
  const canvas = canvasById("outside");
  const { camera, pixel, rays: which } = state;
  if (!outsideNow || !observerNow || !camera || canvas.offsetParent === null) return;
  const { clientWidth: width, clientHeight: height } = canvas;
  if (width === 0 || height === 0) return;
  const { outside, rays } = part < 1 && stageBefore ? onTheWay(outsideNow, stageBefore, part) : stageAtRest(outsideNow);
  // What is drawn belongs to the picture, which comes later: the observer may have moved on by then.
  const observer = { ...observerNow, turns: observerNow.turns === true || part < 1 };
  const map = stageMap(observer, width, height);
  const draw = (/** @type {Surface | null} */ surface) => {
    const prepared = prepareCanvas(canvas);
    // With another size it is drawn anew.
    if (!prepared || prepared.width !== width || prepared.height !== height) return;
    const drawing = { context: prepared.context, map, surface, isQuick: observer.turns };
    // For those who ask what is drawn: tests, and who measures frames.
    canvas.dataset.observer = JSON.stringify(surface?.camera ?? null);
    drawObjects(drawing, outside, observer);
    drawRays(drawing, rays, which === "one");
    const chosen = rays.filter(({ row, column }) => row === pixel?.[0] && column === pixel[1]);
    if (which !== "one") drawRays(drawing, chosen, true);
    drawCamera(drawing, outside, camera, pixel, 0.16 * observer.size);
  };
  observe({ observer, map, cut: cutOf(map, outside, rays, observer), draw });
}

/** @param {Outside} outside */
const stageAtRest = (outside) => ({ outside, rays: raysNow.map((ray) => drawnRay(outside, ray)) });

/**
 * The stage between two projections.
 * @param {Outside} after
 * @param {{outside: Outside, rays: DrawnRay[]}} before
 * @param {number} part
 */
function onTheWay(after, before, part) {
  const stage = stageAtRest(after);
  const corners = after.corners.map((corner, index) => between(before.outside.corners[index], corner, part));
  // Between the two, rays are only drawn; what they would hit is not asked, and not shown.
  const rays = stage.rays.map((ray) => {
    const old = before.rays.find(({ row, column }) => row === ray.row && column === ray.column) ?? ray;
    const [origin, end] = [between(old.origin, ray.origin, part), between(old.end, ray.end, part)];
    return { ...ray, origin, end, hit: false, moving: true };
  });
  return { outside: { ...after, projection: /** @type {ProjectionName} */ ("parallel"), corners }, rays };
}

function tellRays() {
  const text = byId("outside-text");
  if (!state.camera || !outsideNow) return;
  const step = gridStep(state.camera);
  const grid =
    step === 1
      ? "The grid is that of the pixels."
      : `The grid has a line every ${step} pixels.`;
  if (state.rays === "one" && raysNow.length === 1) {
    const [{ row, column, origin, direction, t, id }] = raysNow;
    text.textContent = `Pixel (${row}, ${column}): p = ${vectorText(origin)}, d = ${vectorText(direction)}. ${t === null ? "The ray hits nothing." : `It hits id ${id} at t = ${short(t)}.`} ${grid}`;
  } else {
    const hits = raysNow.filter(({ t }) => t !== null).length;
    text.textContent = `${counted(raysNow.length, "ray")}, of which ${hits} ${hits === 1 ? "hits" : "hit"} something. ${grid}`;
  }
  text.textContent += " Dashed: behind something.";
  if (outsideNow.planes.length > 0) text.textContent += " A net: an endless plane.";
  say(text.textContent);
}

let drawsSoon = false;

/** Draws with the next frame of the screen, once for all that has moved until then. */
function drawSoon() {
  if (drawsSoon) return;
  drawsSoon = true;
  requestAnimationFrame(() => {
    drawsSoon = false;
    if (observerNow) observerNow.turns = true;
    drawOutside();
    drawAtRest();
  });
}

const drawAtRest = debounced(180, () => {
  if (observerNow) observerNow.turns = false;
  drawOutside();
});

/** @param {number} right @param {number} up  In radians. */
function turnObserver(right, up) {
  if (!observerNow) return;
  const { from, up: axis } = observerNow;
  const level = unit(cross(axis, from));
  const height = Math.acos(clamp(dot(from, axis), -1, 1));
  const lift = clamp(up, height - Math.PI + 0.08, height - 0.08);
  observerNow.from = unit(turned(turned(from, level, -lift), axis, -right));
  drawSoon();
}

/**
 * @param {string} key
 * @param {boolean} shift
 * @returns {boolean} whether the key is one of these
 */
function outsideByKey(key, shift) {
  const arrows = /** @type {Record<string, [number, number]>} */ ({
    ArrowUp: [0, 1],
    ArrowDown: [0, -1],
    ArrowLeft: [-1, 0],
    ArrowRight: [1, 0],
  });
  const arrow = arrows[key];
  if (arrow && shift) turnObserver(arrow[0] * KEY_TURN, arrow[1] * KEY_TURN);
  else if (arrow) movePixel(-arrow[1], arrow[0]);
  else return false;
  return true;
}

function beginOutside() {
  const canvas = canvasById("outside");
  /** @type {{id: number, x: number, y: number} | null} */
  let press = null;
  canvas.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || press) return;
    press = { id: event.pointerId, x: event.clientX, y: event.clientY };
    canvas.setPointerCapture(event.pointerId);
    canvas.classList.add("dragged");
  });
  canvas.addEventListener("pointermove", (event) => {
    if (press?.id !== event.pointerId) return;
    const turn = Math.PI / canvas.clientHeight;
    turnObserver((event.clientX - press.x) * turn, (event.clientY - press.y) * turn);
    [press.x, press.y] = [event.clientX, event.clientY];
  });
  const release = (/** @type {PointerEvent} */ event) => {
    if (press?.id !== event.pointerId) return;
    press = null;
    canvas.classList.remove("dragged");
  };
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", release);
  canvas.addEventListener(
    "wheel",
    (event) => {
      if (event.ctrlKey || !observerNow) return;
      event.preventDefault();
      observerNow.size *= 1.1 ** clamp(event.deltaY / 100, -3, 3);
      drawSoon();
    },
    { passive: false },
  );
  canvas.addEventListener("keydown", (event) => {
    if (outsideByKey(event.key, event.shiftKey)) event.preventDefault();
  });
  byId("outside-back").addEventListener("click", () => {
    if (!outsideNow) return;
    observerNow = besideCamera(outsideNow, pivot);
    drawOutside();
  });
  onChoice("projection-outside", (value) => project(/** @type {ProjectionName} */ (value)));
  onChoice("rays", (value) => change({ rays: /** @type {State["rays"]} */ (value) }));
  drawWhenShown(canvas, () => drawOutside());
  watch(["rays"], () => setChoice("rays", state.rays));
  watch(["chapter", "scene", "camera", "pixel", "rays"], askOutside);
  watch(["chapter"], () => requestAnimationFrame(() => drawOutside()));
}
