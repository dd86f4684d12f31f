// @ts-check
// Records of the loops, and what is true after any number of their steps.

/** @typedef {{tests: number, covered: number, comparisons: number, boxes: number}} Tally  Tests are those of objects. */

/** A tally is kept for every so many steps that found something, so that none is far away. */
const STRIDE = 4096;

/** The stored picture is kept after every so many of its changes, for the same reason. */
const PICTURE_STRIDE = 16384;

/**
 * A step: one test of a pair of an object and a pixel, or of a pixel's ray and a box.
 * @typedef {object} Step
 * @property {number} object  The primitive; `NOTHING` in a test of a box.
 * @property {number} node  The box; `NOTHING` in a test of a primitive.
 * @property {number} row
 * @property {number} column
 * @property {number} result  See `RESULT`.
 * @property {number} t  Where the ray meets the object; not a number if it does not.
 */

/** The steps of one order with what makes scrubbing immediate. */
class Recording {
  /** @param {Steps} steps @param {OrderName} order @param {number} size  Pixels on each side of the image. */
  constructor(steps, order, size) {
    this.steps = steps;
    this.order = order;
    this.size = size;
    const { result } = steps.told;
    /** @type {Uint32Array} Three counts for every `STRIDE` steps that found something. */
    this.tallies = new Uint32Array(3 * (Math.floor(result.length / STRIDE) + 1));
    const now = { covered: 0, comparisons: 0, boxes: 0 };
    for (let told = 0; told <= result.length; told++) {
      if (told % STRIDE === 0) this.tallies.set([now.covered, now.comparisons, now.boxes], (3 * told) / STRIDE);
      if (told < result.length) count(now, result[told]);
    }
    /** The stored picture before every `PICTURE_STRIDE`th change. @type {Uint8ClampedArray[]} */
    this.pictures = [];
    const rgba = new Uint8ClampedArray(4 * size * size);
    for (let place = 0; place <= steps.changes.step.length; place++) {
      if (place % PICTURE_STRIDE === 0) this.pictures.push(rgba.slice());
      if (place < steps.changes.step.length) this.store(place, rgba);
    }
    /** The place of each box among the outlines, by its number. @type {Map<number, number>} */
    this.places = new Map([...steps.outlines.boxes.number].map((number, place) => [number, place]));
  }

  /**
   * A step, by its number from 0. Within a run of the inner loop, object order moves on by one pixel, and image order by one
   * object.
   * @param {number} number
   * @returns {Step}
   */
  step(number) {
    const { runs, told } = this.steps;
    const run = lastUpTo(runs.first, number);
    const along = number - runs.first[run];
    const [byObject, byPixel] = this.order === "object" ? [0, along] : [along, 0];
    const at = lastUpTo(told.step, number);
    const found = at >= 0 && told.step[at] === number;
    return {
      object: runs.object[run] === NOTHING ? NOTHING : runs.object[run] + byObject,
      node: runs.node[run],
      ...this.placeOf(runs.pixel[run] + byPixel),
      result: found ? told.result[at] : RESULT.none,
      t: found ? told.t[at] : NaN,
    };
  }

  /** @param {number} pixel  Counted row by row. */
  placeOf(pixel) {
    return { row: Math.floor(pixel / this.size), column: pixel % this.size };
  }

  /** The number of steps in a run. @param {number} run */
  lengthOf(run) {
    const { first } = this.steps.runs;
    return (run + 1 < first.length ? first[run + 1] : this.steps.count) - first[run];
  }

  /** The lines that bound what a step tests. @param {Step} step @returns {[number, number][][]} */
  outline({ object, node }) {
    const { outlines } = this.steps;
    if (node === NOTHING) return linesOf(outlines.primitives, object);
    const place = this.places.get(node);
    return place === undefined ? [] : linesOf(outlines.boxes, place);
  }

  /**
   * The pixels that object order asks for the object of a step, those to come included, and which of them are asked up to it.
   * @param {number} number
   */
  asked(number) {
    const { marks, runs, count: all } = this.steps;
    const mark = lastUpTo(marks, number);
    const end = mark + 1 < marks.length ? marks[mark + 1] : all;
    /** @type {Pixel[]} */
    const pixels = [];
    for (let run = lastUpTo(runs.first, marks[mark]); run < runs.first.length && runs.first[run] < end; run++)
      for (let along = 0; along < this.lengthOf(run); along++) {
        const { row, column } = this.placeOf(runs.pixel[run] + along);
        pixels.push([row, column]);
      }
    return { pixels, done: number + 1 - marks[mark] };
  }

  /** What was counted in the first steps. @param {number} done @returns {Tally} */
  tally(done) {
    const { step, result } = this.steps.told;
    const end = lastUpTo(step, done - 1) + 1;
    const block = Math.floor(end / STRIDE);
    const [covered, comparisons, boxes] = this.tallies.subarray(3 * block, 3 * block + 3);
    const now = { covered, comparisons, boxes };
    for (let told = block * STRIDE; told < end; told++) count(now, result[told]);
    return { tests: done - now.boxes, ...now };
  }

  /**
   * The stored picture after the first steps: pixels and how many are decided for good.
   * @param {number} done
   * @param {Uint8ClampedArray} rgba  Is filled; alpha 0 stands for nothing stored.
   */
  picture(done, rgba) {
    const end = lastUpTo(this.steps.changes.step, done) + 1;
    const block = Math.floor(end / PICTURE_STRIDE);
    rgba.set(this.pictures[block]);
    for (let place = block * PICTURE_STRIDE; place < end; place++) this.store(place, rgba);
    let stored = 0;
    for (let alpha = 3; alpha < rgba.length; alpha += 4) if (rgba[alpha] !== 0) stored++;
    return stored;
  }

  /** Makes a change of the stored picture. @param {number} place @param {Uint8ClampedArray} rgba */
  store(place, rgba) {
    const { row, column, id, rgb } = this.steps.changes;
    const at = 4 * (row[place] * this.size + column[place]);
    rgba[at] = rgb[3 * place];
    rgba[at + 1] = rgb[3 * place + 1];
    rgba[at + 2] = rgb[3 * place + 2];
    // What is decided to show nothing is stored, too, in the colour that the engine gives to the background.
    rgba[at + 3] = id[place] === NOTHING ? 254 : 255;
  }

  /** The first step about a pixel, or `null`. @param {Pixel} pixel */
  firstAt([row, column]) {
    const { first, pixel } = this.steps.runs;
    const wanted = row * this.size + column;
    for (let run = 0; run < first.length; run++) {
      const along = wanted - pixel[run];
      if (along === 0 || (this.order === "object" && along > 0 && along < this.lengthOf(run))) return first[run] + along;
    }
    return null;
  }
}

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

/** @param {Omit<Tally, "tests">} tally @param {number} result  Of a step that found something. */
function count(tally, result) {
  if (result === RESULT.missed || result === RESULT.entered) {
    tally.boxes++;
    return;
  }
  tally.covered++;
  if (result !== RESULT.first) tally.comparisons++;
}

/** The line of the pseudocode that a step lights: a box, a test, or what is kept. @param {Step} step */
const lineOf = ({ node, result }) => (node !== NOTHING ? 1 : result === RESULT.none ? 2 : 3);

/** A primitive in words. @param {Steps} steps @param {number} id */
const objectWords = (steps, id) => `object ${grouped(id)}${steps.kinds ? `: ${steps.kinds[id] ?? "triangle"}` : ""}`;

/**
 * A step in a sentence.
 * @param {Steps} steps
 * @param {Step} step
 */
function stepWords(steps, { object, node, row, column, result, t }) {
  const pixel = `pixel (${row}, ${column})`;
  if (result === RESULT.missed) return `The ray of ${pixel} misses box ${grouped(node)}: all that is in it is skipped.`;
  if (result === RESULT.entered) return `The ray of ${pixel} enters box ${grouped(node)}.`;
  const subject = objectWords(steps, object)
    .replace(/: (.*)/, " ($1)")
    .replace("o", "O");
  if (result === RESULT.none) return `${subject} does not affect ${pixel}.`;
  const at = Number.isFinite(t) ? ` at t = ${short(t, 4)}` : "";
  const outcome = {
    [RESULT.first]: "the first there, kept",
    [RESULT.nearer]: "nearer, it replaces the one before",
    [RESULT.behind]: "behind the one before",
  }[result];
  return `${subject} affects ${pixel}${at}: ${outcome}.`;
}
