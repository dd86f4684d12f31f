// @ts-check
// Has both orders draw the scene whenever it or its camera changes: one request at a time, and always the latest.

/** The latest pictures, and their size. @type {(Rendered & {height: number, width: number}) | null} */
let drawn = null;

/** Which request is wanted next, and whether one is under way. */
let wanted = false;
let underWay = false;
/** Frames that were drawn since the page began. */
let framesDrawn = 0;

/** @type {(() => void)[]} */
const drawnListeners = [];

/** @param {() => void} listener */
function onDrawn(listener) {
  drawnListeners.push(listener);
}

/** Ends the wait for the first picture, or for the reason why there is none. @type {() => void} */
let endWait = () => {};
/** @type {Promise<void>} */
const firstAnswer = new Promise((resolve) => (endWait = resolve));

let telling = false;

/** Shows what was drawn with the next frame of the screen, while the worker draws on. */
function tellDrawn() {
  if (telling) return;
  telling = true;
  requestAnimationFrame(() => {
    telling = false;
    for (const listener of drawnListeners) listener();
    endWait();
  });
}

/** The rules that hold in this chapter: only "Break it" has others than the exact ones. */
function rulesNow() {
  const breaking = viewOf(state.chapter) === "break";
  return { objectRule: (breaking && state.objectRule) || null, imageRule: (breaking && state.imageRule) || null };
}

/** The picture that the engine is asked about: its camera, its size and its rules. */
function askedPicture() {
  const { camera } = state;
  return { camera, height: camera?.height, width: camera?.width, ...rulesNow() };
}

async function drawAgain() {
  wanted = true;
  if (underWay) return;
  underWay = true;
  while (state.camera && (wanted || lacksIds())) {
    if (!wanted) {
      await takeIds();
      continue;
    }
    wanted = false;
    const { camera } = state;
    try {
      const rendered = await engine.call("render", { ...askedPicture(), withoutIds: true });
      drawn = { ...rendered, height: camera.height, width: camera.width };
      framesDrawn++;
      if (troubleIsOfDrawing) showTrouble("");
      troubleIsOfDrawing = false;
      tellDrawn();
    } catch (error) {
      showTrouble(messageOf(error));
      troubleIsOfDrawing = true;
      endWait();
    }
    await makeMoves();
  }
  underWay = false;
  restful();
}
let troubleIsOfDrawing = false;

const lacksIds = () => drawn !== null && !drawn.object.ids && !troubleIsOfDrawing;

/** Takes the ids of the last frames, once no other frame is wanted. */
async function takeIds() {
  try {
    const { object, image } = await engine.call("ids");
    if (drawn) [drawn.object.ids, drawn.image.ids] = [object, image];
    tellDrawn();
  } catch (error) {
    showTrouble(messageOf(error));
    troubleIsOfDrawing = true;
  }
  await makeMoves();
}

/** Counts the work once the camera rests, where that is quick. */
const restful = debounced(350, () => {
  if (drawn && !drawn.object.work && took(drawn.object) + took(drawn.image) < 120) countWork();
});

/** Counts what the loops do for the picture that is shown. */
async function countWork() {
  const { camera } = state;
  if (!camera || underWay) return;
  underWay = true;
  try {
    const rendered = await engine.call("render", { ...askedPicture(), counts: true });
    if (camera === state.camera) {
      drawn = { ...rendered, height: camera.height, width: camera.width };
      tellDrawn();
    }
  } catch (error) {
    showTrouble(messageOf(error));
  }
  await makeMoves();
  underWay = false;
  if (wanted) drawAgain();
}

/** What moves the camera with the next frame. @type {Set<() => void>} */
const moves = new Set();

/**
 * Moves the camera before the next frame is asked for: at once, or as soon as the one under way is there. A pointer moves
 * more often than frames are drawn, and a camera that no frame has costs the page its time all the same.
 * @param {() => void} move  Called once, however often it is given meanwhile.
 */
function moveWithNextFrame(move) {
  if (underWay) moves.add(move);
  else move();
}

/** Makes the moves that wait, and lets the watchers hear of them: they want another frame. */
async function makeMoves() {
  const waiting = [...moves];
  moves.clear();
  for (const move of waiting) move();
  await null;
}

/** What an order took for its frame, in milliseconds. @param {OrderPicture} picture */
const took = ({ ms: { visibility, shading } }) => visibility + shading;

function beginDrawing() {
  watch(["camera", "objectRule", "imageRule"], drawAgain);
  let rules = JSON.stringify(rulesNow());
  watch(["chapter"], () => {
    const now = JSON.stringify(rulesNow());
    if (now !== rules) drawAgain();
    rules = now;
  });
}
