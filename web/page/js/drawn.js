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
  while (wanted && state.camera) {
    wanted = false;
    const { camera } = state;
    try {
      const rendered = await engine.call("render", askedPicture());
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
  }
  underWay = false;
  restful();
}
let troubleIsOfDrawing = false;

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
  underWay = false;
  if (wanted) drawAgain();
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
