// @ts-check
// Records of the loops, and what is true after any number of their steps.

/** @typedef {{tests: number, covered: number, comparisons: number, boxes: number}} Tally */

/** A tally is kept for every so many steps, so that none is far away. */
const STRIDE = 4096;

/** The steps of one order with what makes scrubbing immediate. */
class Recording {
  /** @param {Steps} steps @param {number} size  Pixels on each side of the image. */
  constructor(steps, size) {
    this.steps = steps;
    this.size = size;
    /** @type {Uint32Array} Four counts for every `STRIDE` steps. */
    this.tallies = new Uint32Array(4 * (Math.floor(steps.count / STRIDE) + 1));
    const now = { tests: 0, covered: 0, comparisons: 0, boxes: 0 };
    for (let step = 0; step <= steps.count; step++) {
      if (step % STRIDE === 0)
        this.tallies.set([now.tests, now.covered, now.comparisons, now.boxes], (4 * step) / STRIDE);
      if (step < steps.count) count(now, steps.result[step]);
    }
    /** The place of each box among the outlines, by its number. @type {Map<number, number>} */
    this.places = new Map([...steps.outlines.boxes.number].map((number, place) => [number, place]));
  }

  /** The lines that bound what a step tests. @param {number} step @returns {[number, number][][]} */
  outline(step) {
    const { outlines, object, node } = this.steps;
    if (!isOfBox(this.steps, step)) return linesOf(outlines.primitives, object[step]);
    const place = this.places.get(node?.[step] ?? NOTHING);
    return place === undefined ? [] : linesOf(outlines.boxes, place);
  }

  /**
   * The rectangle of pixels that object order asks for the object of a step, those to come included: first row, first
   * column, and those behind the last.
   * @param {number} step
   * @returns {[number, number, number, number]}
   */
  rectangle(step) {
    const { marks, count: all, row, column } = this.steps;
    const next = marks.findIndex((mark) => mark > step);
    const [from, to] = next < 0 ? [marks[marks.length - 1], all] : [marks[next - 1], marks[next]];
    const rectangle = /** @type {[number, number, number, number]} */ ([Infinity, Infinity, 0, 0]);
    for (let asked = from; asked < to; asked++) {
      rectangle[0] = Math.min(rectangle[0], row[asked]);
      rectangle[1] = Math.min(rectangle[1], column[asked]);
      rectangle[2] = Math.max(rectangle[2], row[asked] + 1);
      rectangle[3] = Math.max(rectangle[3], column[asked] + 1);
    }
    return rectangle;
  }

  /** What was counted in the first steps. @param {number} done @returns {Tally} */
  tally(done) {
    const block = Math.floor(done / STRIDE);
    const [tests, covered, comparisons, boxes] = this.tallies.subarray(4 * block, 4 * block + 4);
    const now = { tests, covered, comparisons, boxes };
    for (let step = block * STRIDE; step < done; step++) count(now, this.steps.result[step]);
    return now;
  }

  /**
   * The stored picture after the first steps: pixels and how many are decided for good.
   * @param {number} done
   * @param {Uint8ClampedArray} rgba  Is filled; alpha 0 stands for nothing stored.
   */
  picture(done, rgba) {
    rgba.fill(0);
    const { step, row, column, id, rgb } = this.steps.changes;
    let stored = 0;
    for (let place = 0; place < step.length && step[place] <= done; place++) {
      const at = 4 * (row[place] * this.size + column[place]);
      if (rgba[at + 3] === 0) stored++;
      // What is decided to show nothing is stored, too, in the colour that the engine gives to the background.
      rgba.set([rgb[3 * place], rgb[3 * place + 1], rgb[3 * place + 2], id[place] === NOTHING ? 254 : 255], at);
    }
    return stored;
  }

  /** The first step about a pixel, or `null`. @param {Pixel} pixel */
  firstAt([row, column]) {
    const { count: all, row: rows, column: columns } = this.steps;
    for (let step = 0; step < all; step++) if (rows[step] === row && columns[step] === column) return step;
    return null;
  }
}

/** Whether a step is about a box of the hierarchy. @param {Steps} steps @param {number} step */
const isOfBox = ({ result }, step) => result[step] === RESULT.missed || result[step] === RESULT.entered;

/** The lines of one thing. @param {Lines} all @param {number} place @returns {[number, number][][]} */
function linesOf({ points, lines, ends }, place) {
  const found = [];
  for (let line = place === 0 ? 0 : ends[place - 1]; line < ends[place]; line++) {
    const from = line === 0 ? 0 : lines[line - 1];
    found.push(Array.from({ length: lines[line] - from }, (_, at) => pointOf(points, from + at)));
  }
  return found;
}

/** @param {Float32Array} points @param {number} at @returns {[number, number]} */
const pointOf = (points, at) => [points[2 * at], points[2 * at + 1]];

/** @param {Tally} tally @param {number} result */
function count(tally, result) {
  if (result === RESULT.missed || result === RESULT.entered) {
    tally.boxes++;
    return;
  }
  tally.tests++;
  if (result !== RESULT.none) tally.covered++;
  if (result === RESULT.nearer || result === RESULT.behind) tally.comparisons++;
}

/** A primitive in words. @param {Steps} steps @param {number} id */
const objectWords = (steps, id) => `object ${grouped(id)}${steps.kinds ? `: ${steps.kinds[id] ?? "triangle"}` : ""}`;

/**
 * A step in a sentence.
 * @param {Steps} steps
 * @param {number} step
 */
function stepWords(steps, step) {
  const result = steps.result[step];
  const pixel = `pixel (${steps.row[step]}, ${steps.column[step]})`;
  if (result === RESULT.missed)
    return `The ray of ${pixel} misses box ${grouped(steps.node?.[step] ?? 0)}: all that is in it is skipped.`;
  if (result === RESULT.entered) return `The ray of ${pixel} enters box ${grouped(steps.node?.[step] ?? 0)}.`;
  const subject = objectWords(steps, steps.object[step])
    .replace(/: (.*)/, " ($1)")
    .replace("o", "O");
  if (result === RESULT.none) return `${subject} does not affect ${pixel}.`;
  const t = steps.t && Number.isFinite(steps.t[step]) ? ` at t = ${short(steps.t[step], 4)}` : "";
  const outcome = {
    [RESULT.first]: "the first there, kept",
    [RESULT.nearer]: "nearer, it replaces the one before",
    [RESULT.behind]: "behind the one before",
  }[result];
  return `${subject} affects ${pixel}${t}: ${outcome}.`;
}
