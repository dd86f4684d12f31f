// @ts-check
// What the page shows, in one place. Whoever changes it calls `change`; whoever shows it calls `watch`.

/**
 * @typedef {object} State
 * @property {string} chapter
 * @property {string} scene  The scene that is open.
 * @property {boolean} byHand  Whether the user chose the scene: a chapter then leaves it alone.
 * @property {boolean} own  Whether the scene is a file of the user's.
 * @property {Opened | null} opened
 * @property {Camera | null} camera
 * @property {Pixel | null} pixel
 * @property {"object" | "image" | "both"} loops
 * @property {"textbook" | "boxes" | "hierarchy"} method
 * @property {number} stepsSize
 * @property {number} step
 * @property {"one" | "row" | "column" | "all"} rays
 * @property {string} objectRule
 * @property {string} imageRule
 * @property {string} question
 * @property {number} seed
 */

/** @type {State} */
const state = {
  chapter: "algorithms",
  scene: "lecture",
  byHand: false,
  own: false,
  opened: null,
  camera: null,
  pixel: null,
  loops: "both",
  method: "textbook",
  stepsSize: 16,
  step: 0,
  rays: "one",
  objectRule: "",
  imageRule: "",
  question: "",
  seed: 1,
};

/** @type {{keys: (keyof State)[], listener: () => void}[]} */
const watchers = [];
/** @type {Set<string>} */
const changed = new Set();

/**
 * Calls the listener after any of these have changed, once for all changes made together.
 * @param {(keyof State)[]} keys
 * @param {() => void} listener
 */
function watch(keys, listener) {
  watchers.push({ keys, listener });
}

/** @param {Partial<State>} patch */
function change(patch) {
  const before = changed.size;
  for (const [key, value] of Object.entries(patch)) {
    if (state[/** @type {keyof State} */ (key)] !== value) changed.add(key);
  }
  Object.assign(state, patch);
  if (before === 0 && changed.size > 0) queueMicrotask(tellWatchers);
}

function tellWatchers() {
  const keys = new Set(changed);
  changed.clear();
  for (const watcher of watchers) {
    if (watcher.keys.some((key) => keys.has(key))) watcher.listener();
  }
}
