// @ts-check
// Keys for the whole page, and the list of them.

/** @type {[string[], string][]} */
const KEYS = [
  [["Page Down", "Page Up"], "the next chapter, the one before"],
  [["f"], "presenter mode: large type for the lecture room"],
  [["t"], "light or dark"],
  [["←", "→", "↑", "↓"], "on a picture: choose a pixel; with Shift, anywhere: turn the camera, or the view from outside"],
  [["+", "−"], "move the camera nearer, farther"],
  [["0"], "the scene's own camera; from outside: turn back"],
  [["c"], "the canonical camera"],
  [["p"], "perspective or parallel"],
  [["space"], "steps: play or pause"],
  [[",", "."], "steps: one back, one on; with Shift: to the next object or row"],
  [["Home", "End"], "steps: to the start, to the end"],
  [["s"], "steps: swap the loops"],
  [["m"], "steps: every pair, bounding boxes, hierarchy"],
  [["1", "2", "3"], "steps: object order, image order, both"],
  [["r"], "from outside: other rays; break it: the next rule of object order, with Shift of image order"],
  [["h"], "questions: the next hint"],
  [["n"], "questions and quiz: another one"],
  [["?"], "this list; Esc closes it"],
];

/** Whether a key belongs to the field that has the focus. @param {EventTarget | null} target */
function takesKeys(target) {
  return (
    target instanceof HTMLElement &&
    target.matches("input:not([type=range], [type=radio], [type=checkbox]), select, textarea")
  );
}

/** @param {KeyboardEvent} event */
function obeyKey(event) {
  const { key } = event;
  if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
  if (byIdDialog().open) return;
  if (key === "Escape") {
    closeChapters();
    return;
  }
  if (key === "PageDown" || key === "PageUp") {
    if (takesKeys(event.target) && !(event.target instanceof HTMLInputElement)) return;
    turnChapter(key === "PageDown" ? 1 : -1);
    event.preventDefault();
    return;
  }
  if (takesKeys(event.target)) return;
  const onControl = event.target instanceof HTMLElement && event.target.matches("input, button, summary, a");
  if (viewOf(state.chapter) === "loops" && obeyStepKey(key, onControl)) event.preventDefault();
  else if (event.shiftKey && !onControl && turnByKey(key)) event.preventDefault();
  else if (inputById("letters").checked && obeyLetter(key)) event.preventDefault();
}

/** Turns what the chapter shows, without its picture having the focus. @param {string} key @returns {boolean} */
function turnByKey(key) {
  const view = viewOf(state.chapter);
  if (WITHOUT_SCENE.has(view) || view === "loops") return false;
  return view === "outside" ? outsideByKey(key, true) : steerByKey(key, true);
}

/**
 * @param {string} key
 * @param {boolean} onControl
 * @returns {boolean}
 */
function obeyStepKey(key, onControl) {
  if (key === " " && !onControl) togglePlaying();
  else if (key === "Home" && !onControl) stepBy(-clockEnd);
  else if (key === "End" && !onControl) stepBy(clockEnd);
  else if ((key === "ArrowRight" || key === "ArrowLeft") && !onControl) stepBy(key === "ArrowRight" ? 1 : -1);
  else if (!inputById("letters").checked) return false;
  else if (key === "." || key === ",") stepBy(key === "." ? 1 : -1);
  else if (key === ">" || key === "<" || key === ":" || key === ";") toMark(key === ">" || key === ":" ? 1 : -1);
  else if (key === "s") swapLoops();
  else if (key === "m")
    change({ method: after(/** @type {const} */ (["textbook", "boxes", "hierarchy"]), state.method) });
  else if (key === "1" || key === "2" || key === "3")
    change({ loops: /** @type {const} */ (["object", "image", "both"])[Number(key) - 1] });
  else return false;
  return true;
}

/**
 * The value after this one, and after the last the first.
 * @template T
 * @param {readonly T[]} values
 * @param {T} value
 */
const after = (values, value) => values[(values.indexOf(value) + 1) % values.length];

/** @param {OrderName} order */
function nextRule(order) {
  const names = ["", ...rules[order].map(({ name }) => name)];
  change({ [`${order}Rule`]: after(names, state[`${order}Rule`]) });
  say(`${ORDERS[order][0]}: ${state[`${order}Rule`] || "exact"}`);
}

/** @param {string} key @returns {boolean} */
function obeyLetter(key) {
  const view = viewOf(state.chapter);
  if (key === "?") byIdDialog().showModal();
  else if (key === "f") togglePresenting();
  else if (key === "t") toggleTheme();
  else if (key === "h" && view === "questions") giveHint();
  else if (key === "n" && (view === "questions" || view === "quiz")) change({ seed: newSeed() });
  else if (WITHOUT_SCENE.has(view)) return false;
  else if (key === "r" && view === "outside")
    change({ rays: after(/** @type {const} */ (["one", "row", "column", "all"]), state.rays) });
  else if (view === "break" && (key === "r" || key === "R")) nextRule(key === "r" ? "object" : "image");
  else if (key === "+" || key === "=") steerBy({ factor: 1 / 1.12 });
  else if (key === "-") steerBy({ factor: 1.12 });
  else if (key === "0" && view === "outside") byId("outside-back").click();
  else if (key === "0") cameraBack();
  else if (key === "c") canonicalCamera();
  else if (key === "p") project(state.camera?.projection === "parallel" ? "perspective" : "parallel");
  else return false;
  return true;
}

const byIdDialog = () => /** @type {HTMLDialogElement} */ (byId("keys"));

function beginKeys() {
  byId("keys-list").append(
    ...KEYS.map(([keys, what]) =>
      make("div", {}, make("dt", {}, ...keys.map((key) => make("kbd", {}, key))), make("dd", {}, what)),
    ),
  );
  byId("keys-open").addEventListener("click", () => byIdDialog().showModal());
  document.addEventListener("keydown", obeyKey);
}
