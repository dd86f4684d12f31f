// @ts-check
// Steers the camera on a picture: drag to turn, wheel or two fingers to move; a click chooses a pixel; keys do the same.

/** Pixels of the screen from which on a press is a drag. */
const DRAG = 4;

/** Where pointers and wheels have moved the camera since the last frame. */
const steered = { right: 0, down: 0, factor: 1 };

/** @param {{right?: number, down?: number, factor?: number}} by  Angles, and a factor for the distance. */
function steerBy({ right = 0, down = 0, factor = 1 }) {
  steered.right += right;
  steered.down += down;
  steered.factor *= factor;
  moveWithNextFrame(takeSteering);
}

function takeSteering() {
  const { right, down, factor } = steered;
  [steered.right, steered.down, steered.factor] = [0, 0, 1];
  if (right !== 0 || down !== 0) orbit(right, down);
  if (factor !== 1) approach(factor);
}

/** @param {HTMLCanvasElement} canvas */
function steer(canvas) {
  /** @typedef {{id: number, x: number, y: number, moved: boolean}} Press */
  /** The first pointer that is down, and a second finger beside it. @type {Press | null} */
  let press = null;
  /** @type {Press | null} */
  let finger = null;
  const apart = () => (press && finger ? Math.max(Math.hypot(press.x - finger.x, press.y - finger.y), 1) : 1);
  canvas.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || finger || (press && event.pointerType !== "touch")) return;
    const down = { id: event.pointerId, x: event.clientX, y: event.clientY, moved: false };
    canvas.setPointerCapture(event.pointerId);
    if (!press) press = down;
    else [press.moved, finger] = [true, down];
  });
  canvas.addEventListener("pointermove", (event) => {
    const one = [press, finger].find((down) => down?.id === event.pointerId);
    if (one && finger) {
      // Two fingers: what is between them keeps its size on the screen.
      const before = apart();
      [one.x, one.y] = [event.clientX, event.clientY];
      steerBy({ factor: before / apart() });
      return;
    }
    if (!press || press.id !== event.pointerId) {
      const pixel = pixelUnder(canvas, event);
      readOut(pixel ?? state.pixel);
      touchReason(pixel ?? state.pixel);
      return;
    }
    const [right, down] = [event.clientX - press.x, event.clientY - press.y];
    if (!press.moved && Math.hypot(right, down) < DRAG) return;
    press.moved = true;
    canvas.classList.add("dragged");
    [press.x, press.y] = [event.clientX, event.clientY];
    const turn = Math.PI / canvas.clientHeight;
    steerBy({ right: right * turn, down: down * turn });
  });
  const release = (/** @type {PointerEvent} */ event) => {
    if (finger && [press, finger].some((down) => down?.id === event.pointerId)) {
      // The finger that stays goes on as a drag, from where it is.
      press = press?.id === event.pointerId ? { ...finger, moved: true } : press;
      finger = null;
      return;
    }
    if (!press || press.id !== event.pointerId) return;
    const { moved } = press;
    press = null;
    canvas.classList.remove("dragged");
    if (moved || event.type === "pointercancel") return;
    const pixel = pixelUnder(canvas, event);
    if (pixel) change({ pixel });
  };
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", release);
  canvas.addEventListener("pointerleave", () => {
    readOut(state.pixel);
    touchReason(state.pixel);
  });
  canvas.addEventListener(
    "wheel",
    (event) => {
      // With Control the browser zooms the page.
      if (event.ctrlKey) return;
      event.preventDefault();
      const lines = event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? event.deltaY / 100 : event.deltaY / 3;
      steerBy({ factor: 1.12 ** clamp(lines, -3, 3) });
    },
    { passive: false },
  );
  canvas.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (steerByKey(event.key, event.shiftKey)) event.preventDefault();
  });
}

/** Radians a press of a key. */
const KEY_TURN = Math.PI / 36;

/**
 * @param {string} key
 * @param {boolean} shift
 * @returns {boolean} whether the key is one of these
 */
function steerByKey(key, shift) {
  const arrows = /** @type {Record<string, [number, number]>} */ ({
    ArrowUp: [-1, 0],
    ArrowDown: [1, 0],
    ArrowLeft: [0, -1],
    ArrowRight: [0, 1],
  });
  const arrow = arrows[key];
  if (arrow && shift) steerBy({ right: arrow[1] * KEY_TURN, down: arrow[0] * KEY_TURN });
  else if (arrow) movePixel(...arrow);
  else return false;
  return true;
}
