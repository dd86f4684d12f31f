// @ts-check
// Work and cost: live counters, and where the costs of the two orders cross.

/** What the sliders can choose. */
const TRIANGLES = [12, 48, 120, 300, 800, 2000, 5000, 12000, 30000, 80000, 200000];
const IMAGES = [
  [15, 20],
  [30, 40],
  [60, 80],
  [120, 160],
  [240, 320],
  [360, 480],
  [480, 640],
];

/**
 * @typedef {object} Cost
 * @property {{label: string, object: number | null, image: number | null}[]} counts
 * @property {{object: number, image: number}} steps
 * @property {{object: number, image: number}} ms
 * @property {number} triangles  The mesh has about as many as were asked for.
 * @property {number} textbook  Pairs of a triangle and a pixel: the steps of the textbooks.
 */

/** What was measured so far: by image, then by triangles. @type {Map<string, Map<number, Cost>>} */
const costs = new Map();
let measuring = false;

const chosenImage = () => IMAGES[Number(inputById("work-pixels").value)];
const chosenTriangles = () => TRIANGLES[Number(inputById("work-triangles").value)];

/** @param {number[]} image */
function costsOf(image) {
  const key = image.join("x");
  let found = costs.get(key);
  if (!found) costs.set(key, (found = new Map()));
  return found;
}

/** Measures what is chosen, then the rest of the curve, nearest first, until something else is chosen. */
async function measure() {
  showWork();
  if (measuring || viewOf(state.chapter) !== "work") return;
  measuring = true;
  for (;;) {
    if (viewOf(state.chapter) !== "work") break;
    const [image, chosen] = [chosenImage(), chosenTriangles()];
    const known = costsOf(image);
    const next = [...TRIANGLES]
      .sort((one, other) => Math.abs(Math.log(one / chosen)) - Math.abs(Math.log(other / chosen)))
      .find((triangles) => !known.has(triangles));
    if (next === undefined) break;
    try {
      known.set(next, await engine.call("work", { triangles: next, height: image[0], width: image[1] }));
    } catch (error) {
      showTrouble(messageOf(error));
      break;
    }
    showWork();
  }
  measuring = false;
}

function showWork() {
  const [image, chosen] = [chosenImage(), chosenTriangles()];
  outputFor("work-triangles", grouped(costsOf(image).get(chosen)?.triangles ?? chosen));
  outputFor("work-pixels", `${image[1]} × ${image[0]}`);
  const cost = costsOf(image).get(chosen);
  fillCounts(byId("work-counts"), cost ? [...cost.counts, { label: "steps", ...cost.steps }] : []);
  drawChart();
  if (!cost) return;
  const { object, image: ray } = cost.steps;
  const [less, more] = object < ray ? ["Object order", "image order"] : ["Image order", "object order"];
  const text =
    object === ray
      ? "Both orders take equally many steps."
      : `${less} takes fewer steps here: ${grouped(Math.min(object, ray))}, and ${more} ${grouped(Math.max(object, ray))}. ` +
        `The textbooks test every pair: ${grouped(cost.textbook)} steps. ` +
        "A step is counted, so it is the same on every machine; it is no unit of time.";
  byId("chart-text").textContent =
    `${crossingWords(image)}${text} This frame: object order ${milliseconds(cost.ms.object)}, image order ${milliseconds(cost.ms.image)} in this browser.`;
  say(text);
}

/**
 * Between which two measured meshes the orders change places, if they do.
 * @param {number[]} image
 * @returns {[Cost, Cost] | null}
 */
function crossing(image) {
  const known = [...costsOf(image).values()].sort((one, other) => one.triangles - other.triangles);
  for (let place = 1; place < known.length; place++) {
    const [before, behind] = [known[place - 1], known[place]];
    if ((before.steps.object - before.steps.image) * (behind.steps.object - behind.steps.image) < 0)
      return [before, behind];
  }
  return null;
}

/** @param {number[]} image */
function crossingWords(image) {
  const pair = crossing(image);
  return pair
    ? `The orders cross between ${grouped(pair[0].triangles)} and ${grouped(pair[1].triangles)} triangles. `
    : "";
}

/** @param {string} id @param {string} text */
function outputFor(id, text) {
  /** @type {HTMLElement} */ (document.querySelector(`output[for="${id}"]`)).textContent = text;
  inputById(id).setAttribute("aria-valuetext", text);
}

/** Steps against triangles, both on a scale of powers of ten. */
function drawChart() {
  const canvas = canvasById("chart");
  const prepared = canvas.offsetParent && prepareCanvas(canvas);
  if (!prepared) return;
  const { context, width, height } = prepared;
  const known = [...costsOf(chosenImage())].sort(([one], [other]) => one - other);
  const em = letterSize();
  // Where there is room, names stand beside their curves.
  const isWide = width > 34 * em;
  const [left, right, top, bottom] = [6 * em, width - (isWide ? 7.5 : 1.5) * em, 1.6 * em, height - 3 * em];
  const values = known
    .flatMap(([, { steps, textbook }]) => [steps.object, steps.image, textbook])
    .filter((value) => value > 0);
  const least = Math.floor(Math.log10(Math.min(...values, 1e4)));
  const most = Math.ceil(Math.log10(2 * Math.max(...values, 1e5)));
  const [first, last] = [Math.log10(10), Math.log10(1.5 * TRIANGLES[TRIANGLES.length - 1])];
  /** @param {number} triangles */
  const x = (triangles) => left + ((Math.log10(triangles) - first) / (last - first)) * (right - left);
  /** @param {number} steps */
  const y = (steps) => bottom - ((Math.log10(steps) - least) / (most - least || 1)) * (bottom - top);
  context.font = `${0.85 * em}px ${colour("text")}`;
  context.fillStyle = colour("quiet");
  context.strokeStyle = colour("hairline");
  context.lineWidth = 1;
  context.textAlign = "right";
  context.textBaseline = "middle";
  for (let power = least; power <= most; power++) {
    rule(context, left, y(10 ** power), right, y(10 ** power));
    context.fillText(grouped10(power), left - 0.5 * em, y(10 ** power));
  }
  context.textAlign = "center";
  context.textBaseline = "top";
  for (const triangles of isWide ? [100, 1000, 10000, 100000] : [100, 10000]) {
    rule(context, x(triangles), top, x(triangles), bottom);
    context.fillText(grouped(triangles), x(triangles), bottom + 0.4 * em);
  }
  context.fillText("triangles", (left + right) / 2, bottom + 1.6 * em);
  context.textAlign = "left";
  context.textBaseline = "bottom";
  context.fillText("steps", left, top - 0.2 * em);
  context.strokeStyle = colour("bright");
  context.setLineDash([3, 4]);
  rule(context, x(chosenTriangles()), top, x(chosenTriangles()), bottom);
  context.setLineDash([]);
  drawTextbook(
    context,
    known.map(([, { triangles, textbook }]) => [x(triangles), y(textbook)]),
  );
  const pair = crossing(chosenImage());
  if (pair) {
    // The ground between the two measurements.
    context.fillStyle = colour("good");
    context.globalAlpha = 0.16;
    context.fillRect(x(pair[0].triangles), top, x(pair[1].triangles) - x(pair[0].triangles), bottom - top);
    context.globalAlpha = 1;
  }
  const atEnd = known[known.length - 1]?.[1].steps;
  for (const order of /** @type {OrderName[]} */ (["object", "image"])) {
    const isHigher = atEnd ? atEnd[order] >= atEnd[order === "object" ? "image" : "object"] : true;
    drawCurve(
      context,
      order,
      known.map(([, { triangles, steps }]) => [x(triangles), y(Math.max(1, steps[order]))]),
      isHigher,
      isWide,
    );
  }
}

/**
 * Both textbooks take the same steps: every pair.
 * @param {CanvasRenderingContext2D} context
 * @param {number[][]} points
 */
function drawTextbook(context, points) {
  context.strokeStyle = context.fillStyle = colour("quiet");
  context.lineWidth = 1.5;
  context.setLineDash([7, 5]);
  context.beginPath();
  points.forEach(([x, y], index) => context[index ? "lineTo" : "moveTo"](x, y));
  context.stroke();
  context.setLineDash([]);
  const end = points[points.length - 1];
  if (!end) return;
  context.textAlign = "right";
  context.textBaseline = "bottom";
  context.font = `400 ${0.9 * letterSize()}px ${colour("text")}`;
  context.fillText("every pair (textbooks)", end[0], end[1] - 0.4 * letterSize());
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {OrderName} order
 * @param {number[][]} points
 * @param {boolean} isHigher  Its name stands above, or below.
 * @param {boolean} isWide
 */
function drawCurve(context, order, points, isHigher, isWide) {
  context.strokeStyle = context.fillStyle = colour(order);
  context.lineWidth = 2.5;
  context.beginPath();
  points.forEach(([x, y], index) => context[index ? "lineTo" : "moveTo"](x, y));
  context.stroke();
  const em = letterSize();
  for (const [x, y] of points) drawMark(context, order, x, y, 0.32 * em);
  const end = points[points.length - 1];
  if (!end) return;
  context.font = `600 ${0.95 * em}px ${colour("text")}`;
  context.textAlign = isWide ? "left" : "right";
  context.textBaseline = "middle";
  // Near each other, the names keep apart.
  const away = (isWide ? 0.4 : 1.1) * em;
  context.fillText(ORDERS[order][0], end[0] + (isWide ? 0.7 * em : 0), end[1] + (isHigher ? -away : away));
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {number} x
 * @param {number} y
 * @param {number} a
 * @param {number} b
 */
function rule(context, x, y, a, b) {
  context.beginPath();
  context.moveTo(x, y);
  context.lineTo(a, b);
  context.stroke();
}

/** A power of ten in words. @param {number} power */
function grouped10(power) {
  const [words, less] = power < 6 ? ["", 0] : power < 9 ? [" million", 6] : [" billion", 9];
  return `${grouped(10 ** (power - less))}${words}`;
}

function beginWork() {
  inputById("work-triangles").max = String(TRIANGLES.length - 1);
  inputById("work-pixels").max = String(IMAGES.length - 1);
  for (const id of ["work-triangles", "work-pixels"]) byId(id).addEventListener("input", measure);
  drawWhenShown(canvasById("chart"), drawChart);
  watch(["chapter"], measure);
}
