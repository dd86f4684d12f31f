// @ts-check
// The verdict on the two pictures, as the engine computed it: never from anything else.

/** Names of counts, in words. @type {Record<string, string>} */
const COUNT_NAMES = {
  primitives: "primitives begun",
  rays: "rays begun",
  nodes: "box tests",
  tests: "primitive tests",
  fragments: "covered (fragments)",
  depth_tests: "depth comparisons",
  judged_coverage: "coverage judged exactly",
  judged_nearest: "nearness judged exactly",
  steps: "steps",
};

/** The classes of a difference with their colours, as in all outputs of the program. */
const CLASSES = /** @type {const} */ ([
  ["both_alike", "both alike", "#808080"],
  ["only_object", "only object order", "#E69F00"],
  ["only_image", "only image order", "#0072B2"],
  ["other_primitive", "other primitive", "#CC79A7"],
]);

function showVerdict() {
  if (!drawn) return;
  const { verdict } = drawn;
  const match = verdict.equal;
  const bar = byId("verdict");
  bar.dataset.match = match ? "yes" : "no";
  /** @type {HTMLElement} */ (bar.querySelector(".sign")).textContent = match ? "=" : "≠";
  const sentence = verdict.text;
  if (byId("verdict-text").textContent !== sentence) {
    byId("verdict-text").textContent = sentence;
    say(sentence);
  }
  showFacts();
  showCounts();
}

/** The numbers beside the verdict: ten times a second is as often as anyone reads them. */
const showFacts = seldom(100, () => {
  if (!drawn) return;
  const { verdict, object, image } = drawn;
  const [byObject, byImage] = verdict.covered;
  const covered = byObject === byImage ? grouped(byObject) : `${grouped(byObject)} and ${grouped(byImage)}`;
  const facts = [
    state.scene,
    `covered ${covered} of ${grouped(verdict.pixels)}`,
    `ids differ in ${grouped(verdict.differ)}`,
    `object order ${milliseconds(took(object))}, image order ${milliseconds(took(image))}`,
  ];
  byId("verdict-facts").textContent = facts.join("  ·  ");
  const other = verdict.differ - verdict.onlyObject - verdict.onlyImage;
  showClasses({
    both_alike: byObject - verdict.onlyObject - other,
    only_object: verdict.onlyObject,
    only_image: verdict.onlyImage,
    other_primitive: other,
  });
});

/** The classes with their numbers of pixels. The list is made once: while the camera moves, only numbers change. */
function showClasses(/** @type {Record<string, number>} */ classes) {
  const list = byId("classes");
  if (list.childElementCount === 0) {
    for (const [, words, ink] of CLASSES) {
      const swatch = make("span", { class: "swatch" });
      swatch.style.background = ink;
      list.append(make("li", {}, swatch, words, make("span", { class: "number" })));
    }
  }
  list.querySelectorAll(".number").forEach((number, index) => {
    const text = grouped(classes[CLASSES[index][0]]);
    if (number.textContent !== text) number.textContent = text;
  });
}

/** The numbers that the table of counts was made of. */
let countsShown = "";

/** @param {number} ms */
const milliseconds = (ms) => `${ms < 10 ? ms.toFixed(1) : Math.round(ms)} ms`;

function showCounts() {
  const [object, image] = [drawn?.object.work, drawn?.image.work];
  const numbers = JSON.stringify([object, image]);
  if (countsShown === numbers) return;
  countsShown = numbers;
  const keys = Object.keys({ ...object, ...image }).filter((key) => object?.[key] || image?.[key]);
  byId("count-offer").hidden = keys.length > 0;
  byId("work-done").hidden = keys.length === 0;
  /** @type {HTMLElement} */ (byId("counts").querySelector("thead")).replaceChildren(
    make(
      "tr",
      {},
      make("td"),
      ...keys.map((key) => make("th", { scope: "col" }, COUNT_NAMES[key] ?? key.replaceAll("_", " "))),
    ),
  );
  const rows = /** @type {[OrderName, Record<string, number> | null | undefined][]} */ ([
    ["object", object],
    ["image", image],
  ]).map(([order, work]) =>
    make(
      "tr",
      {},
      make(
        "th",
        { scope: "row", class: order },
        make("span", { class: `mark ${order === "object" ? "disc" : "square"}` }),
        ORDERS[order][0],
      ),
      ...keys.map((key) => make("td", {}, work ? grouped(work[key] ?? 0) : "–")),
    ),
  );
  /** @type {HTMLElement} */ (byId("counts").querySelector("tbody")).replaceChildren(...rows);
}

/**
 * A table of counts of both orders.
 * @param {HTMLElement} table
 * @param {{label: string, object?: number | null, image?: number | null}[]} rows
 */
function fillCounts(table, rows) {
  const heading = make(
    "tr",
    {},
    make("td"),
    make("th", { scope: "col", class: "object" }, make("span", { class: "mark disc" }), "object order"),
    make("th", { scope: "col", class: "image" }, make("span", { class: "mark square" }), "image order"),
  );
  /** @param {number | null | undefined} value */
  const cell = (value) => make("td", {}, value === undefined || value === null ? "–" : grouped(value));
  const body = rows
    .filter(({ object, image }) => object || image)
    .map(({ label, object, image }) =>
      make(
        "tr",
        {},
        make("th", { scope: "row" }, COUNT_NAMES[label] ?? label.replaceAll("_", " ")),
        cell(object),
        cell(image),
      ),
    );
  /** @type {HTMLElement} */ (table.querySelector("tbody")).replaceChildren(...(rows.length ? [heading, ...body] : []));
}

function beginVerdict() {
  onDrawn(showVerdict);
  byId("count").addEventListener("click", countWork);
}
