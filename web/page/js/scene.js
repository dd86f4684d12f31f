// @ts-check
// Opens scenes, and moves their camera.

/** Scenes that are being opened: what is recorded of an old one meanwhile would be of no use. */
let scenesOpening = 0;
/** The scene that was asked for last, open or not yet. */
let askedScene = "";
/** How many scenes have been opened: a file may come back under its name with other content. */
let scenesOpened = 0;

/** What answers about the scene depend on: they are asked anew for another one. */
const sceneKey = () => `${state.scene} ${scenesOpened}`;

/** The pivot about which the camera turns. */
let pivot = /** @type {Vector} */ ([0, 0, 0]);

/**
 * Opens a built-in scene, or one of some files, by its name; the engine's words say what is wrong with it.
 * @param {{name: string, files?: {name: string, bytes: ArrayBuffer}[], folder?: boolean}} what
 * @param {{byHand?: boolean, camera?: Partial<Camera>, pixel?: Pixel | null}} [options]
 * @returns {Promise<boolean>}
 */
async function openScene(what, { byHand = false, camera = {}, pixel = null } = {}) {
  const own = what.files !== undefined;
  /** @type {Opened} */
  let opened;
  scenesOpening++;
  askedScene = what.name;
  try {
    opened = await engine.call("open", what);
  } catch (error) {
    askedScene = state.scene;
    showTrouble(messageOf(error));
    say(messageOf(error));
    return false;
  } finally {
    scenesOpening--;
  }
  scenesOpened++;
  showTrouble(opened.warnings.join("\n"));
  pivot = pivotOf(opened.camera);
  const started = patched(opened.camera, camera);
  change({
    opened,
    own,
    byHand: byHand || state.byHand,
    scene: own ? what.name : opened.name,
    camera: started,
    pixel: pixelWithin(started, pixel),
  });
  say(`scene ${state.scene} is open`);
  return true;
}

/**
 * The pixel if the image has it, otherwise the one in the middle.
 * @param {Camera} camera
 * @param {Pixel | null} pixel
 * @returns {Pixel}
 */
function pixelWithin({ height, width }, pixel) {
  if (pixel && pixel[0] < height && pixel[1] < width) return pixel;
  return [Math.floor(height / 2), Math.floor(width / 2)];
}

/** What the scene's camera looks at, or a point before it. @param {Camera} camera @returns {Vector} */
const pivotOf = ({ eye, direction, look_at: target }) =>
  target ?? add(eye, scaled(unit(direction), Math.max(lengthOf(eye), 4)));

/**
 * The camera with other values. Where it stands or looks elsewhere, direction and up say so, and no longer what it looked at.
 * @param {Camera} camera
 * @param {Partial<Camera>} patch
 * @returns {Camera}
 */
function patched(camera, patch) {
  if (!patch.eye && !patch.direction && !patch.up) return { ...camera, ...patch };
  const { look_at: _target, u: _u, v: _v, w: _w, ...rest } = camera;
  return { ...rest, ...patch };
}

/** @param {Partial<Camera>} patch */
function moveCamera(patch) {
  if (!state.camera) return;
  const camera = patched(state.camera, patch);
  for (const key of /** @type {const} */ (["eye", "direction", "up"]))
    camera[key] = /** @type {Vector} */ (camera[key].map(tidy));
  for (const key of /** @type {const} */ (["vw", "vh", "d"])) camera[key] = tidy(camera[key]);
  change({ camera, pixel: pixelWithin(camera, state.pixel) });
}

/**
 * Turns the camera about its pivot.
 * @param {number} right  The angle about the up vector, in radians.
 * @param {number} down  The angle about the camera's right.
 */
function orbit(right, down) {
  if (!state.camera) return;
  const { eye, direction, up } = state.camera;
  const axis = unit(up);
  const level = unit(cross(direction, axis));
  // The direction stays away from the up vector: there the frame would turn over.
  const fromUp = Math.acos(clamp(dot(unit(direction), axis), -1, 1));
  const tilt = clamp(down, fromUp - Math.PI + 0.05, fromUp - 0.05);
  /** @param {Vector} vector */
  const turn = (vector) => turned(turned(vector, level, -tilt), axis, -right);
  const direct = turn(direction);
  moveCamera({ eye: add(pivot, turn(subtract(eye, pivot))), direction: direct });
}

/**
 * Moves the eye towards the pivot; a parallel camera sees a smaller or larger part of the world instead.
 * @param {number} factor  Less than 1 is nearer.
 */
function approach(factor) {
  if (!state.camera) return;
  const { eye, vw, vh, projection } = state.camera;
  if (projection === "parallel") moveCamera({ vw: vw * factor, vh: vh * factor });
  else moveCamera({ eye: add(pivot, scaled(subtract(eye, pivot), factor)) });
}

function cameraBack() {
  if (!state.opened) return;
  pivot = pivotOf(state.opened.camera);
  change({ camera: state.opened.camera, pixel: pixelWithin(state.opened.camera, state.pixel) });
  say("the scene's own camera");
}

/** The lecture's first camera. Its viewport is 1 by 1, so the image becomes as wide as it is high. */
function canonicalCamera() {
  if (!state.camera) return;
  moveCamera({
    eye: [0, 0, 0],
    direction: [0, 0, -1],
    up: [0, 1, 0],
    vw: 1,
    vh: 1,
    d: 1,
    projection: "perspective",
    width: state.camera.height,
  });
  say("the canonical camera: eye at the origin, looking down the negative z axis");
}

/**
 * Changes the projection as the program does: eye and frame stay, the viewport is scaled.
 * @param {ProjectionName} projection
 */
async function project(projection) {
  if (!state.camera || state.camera.projection === projection) return;
  try {
    const { camera } = await engine.call("camera", { camera: state.camera, projection });
    change({ camera });
    say(`${projection} projection`);
  } catch (error) {
    showTrouble(messageOf(error));
  }
}
