// @ts-check
// Break it: rules of ordinary renderers on either side, and the reason for each pixel that disagrees.

/** @typedef {{name: string, what: string, reproduces: string, scene?: string}} Rule */
/** @type {{object: Rule[], image: Rule[]}} */
let rules = { object: [], image: [] };

/**
 * @typedef {object} Why
 * @property {{reason: string, count: number, colour: [number, number, number]}[]} counts
 * @property {Uint8Array} index  For every pixel: 0 if the orders agree, otherwise its reason's place, counted from 1.
 */
/** @type {(Why & {width: number, height: number}) | null} */
let why = null;
let whyFor = "";

async function listRules() {
  rules = await engine.call("rules");
  for (const order of /** @type {OrderName[]} */ (["object", "image"])) {
    selectById(`${order}-rule`).replaceChildren(
      make("option", { value: "" }, "exact"),
      ...rules[order].map(({ name }) => make("option", { value: name }, name)),
    );
  }
  showRules();
}

function showRules() {
  const texts = [];
  /** @type {string | undefined} */
  let scene;
  for (const order of /** @type {OrderName[]} */ (["object", "image"])) {
    const name = state[`${order}Rule`];
    byId(`${order}-rule-name`).textContent = name || "exact";
    const [kind, number] = name.split(":");
    const rule = rules[order].find((one) => one.name.split(":")[0] === kind);
    selectById(`${order}-rule`).value = rule?.name ?? "";
    const field = inputById(`${order}-rule-number`);
    field.hidden = !rule?.name.includes(":");
    if (document.activeElement !== field) field.value = number ?? rule?.name.split(":")[1] ?? "";
    if (rule) {
      texts.push(`${name}: ${rule.what} It reproduces ${rule.reproduces}.`);
      scene ??= rule.scene;
    }
  }
  byId("rule-text").textContent = texts.join(" ") || "Both orders follow the exact rules.";
  const button = byId("rule-scene");
  button.hidden = !scene || scene === state.scene;
  button.textContent = scene ? `Open ${scene}, where it shows` : "";
  button.dataset.scene = scene ?? "";
}

const askWhy = debounced(120, async () => {
  if (viewOf(state.chapter) !== "break" || !state.camera || !drawn) return;
  const wantedFor = JSON.stringify([sceneKey(), state.camera, rulesNow()]);
  if (wantedFor === whyFor) return;
  whyFor = wantedFor;
  why = null;
  const { objectRule, imageRule } = rulesNow();
  buttonById("finder-ask").hidden = !objectRule && !imageRule;
  byId("finder").textContent = "";
  // Until the reasons are there, the difference stands in their place.
  fillSheet("reasons", drawn.difference.rgba, drawn.width, drawn.height);
  showPictures();
  byId("reasons").replaceChildren(make("li", { class: "quiet" }, "The exact judge looks at each pixel that differs …"));
  try {
    const answer = await engine.call("why", askedPicture());
    if (wantedFor !== whyFor) return;
    why = { ...answer, width: state.camera.width, height: state.camera.height };
    showWhy();
  } catch (error) {
    whyFor = "";
    byId("reasons").replaceChildren(make("li", {}, messageOf(error)));
  }
});

/** What one convention would explain the whole picture? The search takes seconds, so it waits to be asked. */
async function askFinder() {
  const wantedFor = whyFor;
  const holder = byId("finder");
  holder.textContent = "It draws the picture under hundreds of conventions; this takes some seconds …";
  buttonById("finder-ask").disabled = true;
  try {
    const { sentence } = await engine.call("finder", askedPicture());
    if (wantedFor === whyFor) holder.textContent = sentence;
  } catch (error) {
    holder.textContent = messageOf(error);
  }
  buttonById("finder-ask").disabled = false;
}

function showWhy() {
  if (!why || !drawn || drawn.width !== why.width || drawn.height !== why.height) return;
  const rgba = new Uint8ClampedArray(4 * why.index.length);
  const ground = isDark() ? 20 : 46;
  for (let index = 0; index < why.index.length; index++) {
    const reason = why.index[index];
    // What agrees is lit faintly by the picture.
    const lit = ground + 0.14 * drawn.object.rgba[4 * index + 1];
    const ink = reason ? why.counts[reason - 1].colour : [lit, lit, lit];
    rgba.set([...ink, 255], 4 * index);
  }
  fillSheet("reasons", rgba, why.width, why.height);
  showPictures();
  byId("reasons").replaceChildren(
    ...why.counts.map(({ reason, count: pixels, colour: ink }) => {
      const swatch = make("span", { class: "swatch" });
      swatch.style.background = `rgb(${ink.join(" ")})`;
      return make("li", {}, swatch, reason, make("span", { class: "number quiet" }, counted(pixels, "pixel")));
    }),
  );
  touchReason(state.pixel);
}

let touched = "";

/** The sentence for a pixel, when it is touched. @param {Pixel | null} pixel */
async function touchReason(pixel) {
  if (viewOf(state.chapter) !== "break" || !pixel || !why || !state.camera) return;
  const key = `${whyFor} ${pixel}`;
  if (key === touched) return;
  touched = key;
  const holder = byId("reason-text");
  const reason = why.index[pixel[0] * why.width + pixel[1]];
  if (!reason) {
    holder.textContent = seenAt(pixel);
    return;
  }
  holder.textContent = `${seenAt(pixel)}. ${why.counts[reason - 1]?.reason ?? ""}`;
  await lookUpReason(key, pixel);
}

/** One request at a time; of those that come meanwhile the last is asked. @param {string} key @param {Pixel} pixel */
async function lookUpReason(key, [row, column]) {
  if (askingReason || !state.camera) return;
  askingReason = true;
  try {
    const { sentence } = await engine.call("reason", { row, column });
    if (key === touched && sentence) {
      byId("reason-text").textContent = `${seenAt([row, column])}. ${sentence}`;
      say(sentence);
    }
  } catch {
    // The reason's name is shown already.
  }
  askingReason = false;
}
let askingReason = false;

function beginBreaking() {
  for (const order of /** @type {OrderName[]} */ (["object", "image"])) {
    const select = selectById(`${order}-rule`);
    const number = inputById(`${order}-rule-number`);
    select.addEventListener("change", () => change({ [`${order}Rule`]: select.value }));
    // As on the command line: the name, a colon, and the number.
    number.addEventListener("change", () =>
      change({ [`${order}Rule`]: `${select.value.split(":")[0]}:${number.value || 0}` }),
    );
  }
  byId("finder-ask").addEventListener("click", askFinder);
  byId("rule-scene").addEventListener("click", () => {
    const { scene } = byId("rule-scene").dataset;
    if (scene) openScene({ name: scene }).then(() => change({ byHand: false }));
  });
  onDrawn(askWhy);
  watch(["chapter", "objectRule", "imageRule", "scene"], showRules);
  watch(["chapter"], askWhy);
  watch(["pixel"], () => touchReason(state.pixel));
  document.addEventListener("themechange", showWhy);
}
