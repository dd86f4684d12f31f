// @ts-check
// The verdict on the two pictures, as the engine computed it: never from anything else.

/** Names of counts, in words. @type {Record<string, string>} */
const COUNT_NAMES = {
  primitives: "primitives begun", rays: "rays begun", nodes: "box tests", tests: "primitive tests", fragments: "covered samples (fragments)",
  depth_tests: "depth comparisons", judged_coverage: "coverage asked of the exact judge", judged_nearest: "nearness asked of the exact judge", steps: "steps",
};

/** The classes of a difference with their colours, as in all outputs of the program. */
const CLASSES = /** @type {const} */ ([
  ["both_alike", "both alike", "#808080"], ["only_object", "only object order covers", "#E69F00"], ["only_image", "only image order covers", "#0072B2"],
  ["other_primitive", "both cover, other primitives", "#CC79A7"],
]);

function showVerdict() {
  if (!drawn) return;
  const { verdict, object, image } = drawn;
  const match = verdict.idsEqual && verdict.coverageEqual;
  const bar = byId("verdict");
  bar.dataset.match = match ? "yes" : "no";
  /** @type {HTMLElement} */ (bar.querySelector(".sign")).textContent = match ? "=" : "≠";
  const sentence = verdict.sentence ?? (match ? `Both orders see the same at all ${counted(verdict.pixels, "pixel")}.` : `${counted(verdict.differ, "pixel")} of ${grouped(verdict.pixels)} differ.`);
  if (byId("verdict-text").textContent !== sentence) {
    byId("verdict-text").textContent = sentence;
    say(sentence);
  }
  const facts = [`${grouped(verdict.covered)} of ${counted(verdict.pixels, "pixel")} covered`, `${grouped(verdict.differ)} ${verdict.differ === 1 ? "differs" : "differ"}`,
    `object order ${milliseconds(object.ms)}`, `image order ${milliseconds(image.ms)}`];
  byId("verdict-facts").textContent = facts.join("  ·  ");
  const classes = drawn.difference.counts;
  byId("classes").replaceChildren(...CLASSES.map(([key, words, ink]) => {
    const swatch = make("span", { class: "swatch" });
    swatch.style.background = ink;
    return make("li", {}, swatch, words, classes ? make("span", { class: "number" }, grouped(classes[key] ?? 0)) : null);
  }));
  showCounts();
}

/** @param {number} ms */
const milliseconds = (ms) => `${ms < 10 ? ms.toFixed(1) : Math.round(ms)} ms`;

function showCounts() {
  const counts = drawn?.verdict.counts;
  byId("count").hidden = Boolean(counts);
  fillCounts(byId("counts"), counts ? Object.keys({ ...counts.object, ...counts.image }).map((key) => ({ label: key, object: counts.object[key], image: counts.image[key] })) : []);
}

/**
 * A table of counts of both orders.
 * @param {HTMLElement} table
 * @param {{label: string, object?: number | null, image?: number | null}[]} rows
 */
function fillCounts(table, rows) {
  const heading = make("tr", {}, make("td"), make("th", { scope: "col", class: "object" }, make("span", { class: "mark disc" }), "object order"),
    make("th", { scope: "col", class: "image" }, make("span", { class: "mark square" }), "image order"));
  /** @param {number | null | undefined} value */
  const cell = (value) => make("td", {}, value === undefined || value === null ? "–" : grouped(value));
  const body = rows.filter(({ object, image }) => object || image)
    .map(({ label, object, image }) => make("tr", {}, make("th", { scope: "row" }, COUNT_NAMES[label] ?? label.replaceAll("_", " ")), cell(object), cell(image)));
  /** @type {HTMLElement} */ (table.querySelector("tbody")).replaceChildren(...(rows.length ? [heading, ...body] : []));
}

function beginVerdict() {
  onDrawn(showVerdict);
  byId("count").addEventListener("click", countWork);
}
