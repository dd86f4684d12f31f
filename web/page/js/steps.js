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
