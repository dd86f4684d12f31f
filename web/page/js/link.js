// @ts-check
// The state of the page in its address, so that a lecturer links to a moment.

/** The link to what is shown. */
function fragment() {
  const parts = new URLSearchParams();
  parts.set("chapter", state.chapter);
  parts.set("scene", state.scene);
  const { camera, opened, pixel } = state;
  const view = viewOf(state.chapter);
  if (camera && opened && !WITHOUT_SCENE.has(view)) {
    const own = opened.camera;
    for (const key of /** @type {const} */ (["eye", "direction", "up"]))
      if (String(camera[key]) !== String(own[key])) parts.set(key, camera[key].map(tidy).join(","));
    for (const key of /** @type {const} */ (["vw", "vh", "d"]))
      if (camera[key] !== own[key]) parts.set(key, String(camera[key]));
    if (camera.projection !== own.projection) parts.set("projection", camera.projection);
    if (camera.height !== own.height || camera.width !== own.width)
      parts.set("image", `${camera.height},${camera.width}`);
    if (pixel) parts.set("pixel", pixel.join(","));
  }
  if (view === "loops") {
    for (const key of /** @type {const} */ (["loops", "method"])) parts.set(key, state[key]);
    parts.set("size", String(state.stepsSize));
    parts.set("step", String(state.step));
  }
  if (view === "outside") parts.set("rays", state.rays);
  if (view === "break")
    for (const key of /** @type {const} */ (["objectRule", "imageRule"])) if (state[key]) parts.set(key, state[key]);
  if (view === "questions" && state.question) parts.set("question", state.question);
  if (view === "questions" || view === "quiz") parts.set("seed", String(state.seed));
  return `#${parts.toString().replaceAll("%2C", ",").replaceAll("%3A", ":")}`;
}

/** The link that was followed or written last. */
let lastFragment = "";
/** The links that are being followed: their scenes may take a while to open. */
let linksFollowed = 0;

/** Browsers limit how often the address changes, and some refuse it on files: then the address stays as it is. */
const writeLink = debounced(400, () => {
  // A link that was typed a moment ago waits to be followed, or to the end.
  if (location.hash !== lastFragment || linksFollowed > 0) return;
  const now = fragment();
  if (location.hash === now) return;
  try {
    history.replaceState(null, "", now);
  } catch {
    try {
      location.hash = now;
    } catch {
      // The page works without.
    }
  }
  lastFragment = location.hash;
});

/** @param {string | null} text @param {number} length */
function numbersOf(text, length) {
  const numbers = (text ?? "").split(",").map(Number);
  return text && numbers.length === length && numbers.every(Number.isFinite) ? numbers : null;
}

/** What a link says about a file that only the user can open. @type {{scene: string, camera: Partial<Camera>, pixel: Pixel | null} | null} */
let awaited = null;

/** Camera and pixel of the link that waits for this file. @param {string} name */
function awaitedFor(name) {
  if (awaited?.scene !== name) return {};
  const { camera, pixel } = awaited;
  awaited = null;
  return { camera, pixel };
}

/** Follows the link in the address. */
async function followLink() {
  lastFragment = location.hash;
  linksFollowed++;
  try {
    await showLinked(new URLSearchParams(location.hash.slice(1)));
  } finally {
    linksFollowed--;
    writeLink();
  }
}

/** Shows what a link is about. What it does not say, or says wrongly, stays as it is in the chapter. @param {URLSearchParams} parts */
async function showLinked(parts) {
  const chapter = chapterOf(parts.get("chapter") ?? "algorithms");
  /** @type {Partial<State>} */
  const patch = { chapter: chapter.id, step: 0, ...chapter.state };
  const oneOf = (/** @type {string} */ key, /** @type {string[]} */ values) =>
    values.find((value) => value === parts.get(key));
  const loops = oneOf("loops", ["object", "image", "both"]);
  if (loops) patch.loops = /** @type {State["loops"]} */ (loops);
  const method = oneOf("method", ["textbook", "boxes", "hierarchy"]);
  if (method) patch.method = /** @type {State["method"]} */ (method);
  const rays = oneOf("rays", ["one", "row", "column", "all"]);
  if (rays) patch.rays = /** @type {State["rays"]} */ (rays);
  const sizes = [...selectById("steps-size").options].map(({ value }) => value);
  const size = oneOf("size", sizes);
  if (size) patch.stepsSize = Number(size);
  if (/^\d+$/.test(parts.get("step") ?? "")) patch.step = Number(parts.get("step"));
  if (/^\d+$/.test(parts.get("seed") ?? "")) patch.seed = Number(parts.get("seed"));
  if (parts.has("scene") && chapter.view === "break")
    Object.assign(patch, { objectRule: parts.get("objectRule") ?? "", imageRule: parts.get("imageRule") ?? "" });
  if (parts.get("question")) patch.question = parts.get("question") ?? "";
  change(patch);
  /** @type {Partial<Camera>} */
  const camera = {};
  for (const key of /** @type {const} */ (["eye", "direction", "up"])) {
    const vector = numbersOf(parts.get(key), 3);
    if (vector) camera[key] = /** @type {Vector} */ (vector);
  }
  for (const key of /** @type {const} */ (["vw", "vh", "d"])) {
    const [number] = numbersOf(parts.get(key), 1) ?? [];
    if (number !== undefined && number > 0) camera[key] = number;
  }
  const projection = oneOf("projection", ["perspective", "parallel"]);
  if (projection) camera.projection = /** @type {ProjectionName} */ (projection);
  const image = numbersOf(parts.get("image"), 2)?.map((side) => clamp(Math.round(side), 1, 4096));
  if (image) [camera.height, camera.width] = image;
  const scene = parts.get("scene") ?? chapter.scene ?? "lecture";
  const place = numbersOf(parts.get("pixel"), 2)?.map((index) => Math.max(0, Math.round(index)));
  const pixel = /** @type {Pixel | null} */ (place ?? null);
  const isFile = isFileName(scene);
  if (state.own && state.scene === scene && state.opened) {
    const moved = patched(state.opened.camera, camera);
    change({ camera: moved, pixel: pixelWithin(moved, pixel) });
    return;
  }
  const byHand = Boolean(parts.get("scene")) && scene !== chapter.scene;
  if (!isFile && (await openScene({ name: scene }, { camera, pixel, byHand }))) return;
  awaited = { scene, camera, pixel };
  if (!state.opened) await openScene({ name: "lecture" });
  showTrouble(`the link is about the scene ${scene}: open that file, or drop it on this page`);
}

function beginLinks() {
  const followAnother = () => {
    if (location.hash !== lastFragment) followLink();
  };
  watch(/** @type {(keyof State)[]} */ (Object.keys(state)), writeLink);
  addEventListener("hashchange", followAnother);
  followAnother();
  writeLink();
}
