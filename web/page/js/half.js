// @ts-check
// One order in the view of the steps: its pseudocode with the current line, its picture, its counters.

/** The orders' names, and those by which everybody knows them. */
const ORDERS = /** @type {const} */ ({
  object: ["object order", "rasterization"],
  image: ["image order", "ray tracing"],
});

/** One half of the view. */
class Half {
  /** @param {OrderName} order */
  constructor(order) {
    this.order = order;
    /** @type {Recording | null} */
    this.record = null;
    this.canvas = make("canvas", { role: "img", "aria-label": `The picture of ${ORDERS[order][0]} so far` });
    this.code = make("ol", { class: "pseudo", "aria-label": `Pseudocode of ${ORDERS[order][0]}` });
    this.words = make("p", { class: "words" });
    this.tally = make("dl", { class: "tally" });
    this.progress = make("span", { class: "number" });
    this.sheet = document.createElement("canvas");
    this.root = make(
      "section",
      { class: `half ${order}`, "aria-label": ORDERS[order][0] },
      make(
        "div",
        { class: "half-title" },
        make("span", { class: `mark ${order === "object" ? "disc" : "square"}` }),
        make("b", {}, ORDERS[order][0]),
        make("span", { class: "quiet" }, ORDERS[order][1]),
        this.progress,
      ),
      this.code,
      make("div", { class: "mat" }, this.canvas),
      this.words,
      this.tally,
    );
    this.done = 0;
    /** The colour of what shows nothing, once that is known. @type {ArrayLike<number> | null} */
    this.background = null;
    drawWhenShown(this.canvas, () => this.draw());
    this.canvas.addEventListener("click", (event) => {
      const box = this.canvas.getBoundingClientRect();
      const { size } = this.record ?? { size: 0 };
      const place = /** @type {Pixel} */ (
        [event.clientY - box.top, event.clientX - box.left].map((at, axis) =>
          Math.floor((at / (axis ? box.width : box.height)) * size),
        )
      );
      const step = this.record?.firstAt(place);
      if (step !== null && step !== undefined) change({ step: step + 1 });
    });
  }

  /** @param {Recording | null} record */
  load(record) {
    this.record = record;
    this.code.replaceChildren(
      ...(record?.steps.pseudocode ?? []).map((line, number) =>
        make("li", {}, make("span", {}, "  ".repeat(number % 4) + line), make("span", {})),
      ),
    );
  }

  /** Shows the half after so many steps. @param {number} clock */
  show(clock) {
    if (!this.record) return;
    const { steps } = this.record;
    this.done = Math.min(clock, steps.count);
    const last = this.done > 0 ? this.record.step(this.done - 1) : null;
    const finished = this.done === steps.count;
    const lit = finished ? 4 : last ? lineOf(last) : 0;
    const variables = this.variables(last, lit);
    [...this.code.children].forEach((item, number) => {
      item.classList.toggle("lit", number === lit);
      /** @type {HTMLElement} */ (item.lastElementChild).textContent = variables[number];
    });
    this.words.textContent = last ? stepWords(steps, last) : "Nothing is tested yet.";
    const { tests, covered, comparisons, boxes } = this.record.tally(this.done);
    const rows = [
      [
        "tests",
        `${grouped(tests)} of ${grouped(steps.pairs)}${finished && steps.skipped > 0 ? `, ${grouped(steps.skipped)} skipped` : ""}`,
      ],
      ["covered", grouped(covered)],
      ["compared", grouped(comparisons)],
    ];
    if (state.method === "hierarchy" && this.order === "image") rows.push(["boxes", grouped(boxes)]);
    this.tally.replaceChildren(
      ...rows.map(([label, value]) => make("div", {}, make("dt", {}, label), make("dd", {}, value))),
    );
    this.draw();
  }

  /** The values of the loop variables in each line. @param {Step | null} step @param {number} lit */
  variables(step, lit) {
    if (!this.record || !step) return ["", "", "", "", ""];
    const { steps } = this.record;
    const { node, row, column, result } = step;
    const box = node !== NOTHING;
    const inBox = `box ${grouped(node)}: ${result === RESULT.entered ? "entered" : "missed"}`;
    const object = box ? inBox : objectWords(steps, step.object);
    const pixel = `pixel (${row}, ${column})`;
    const [outer, inner] = this.order === "object" ? [object, pixel] : [pixel, object];
    const affects = box ? "" : result === RESULT.none ? "no" : "yes";
    const keep =
      result === RESULT.first || result === RESULT.nearer
        ? `object ${grouped(step.object)}`
        : result === RESULT.behind
          ? "the one before"
          : "";
    return [outer, inner, affects, keep, lit === 4 ? `done after ${counted(steps.count, "step")}` : ""];
  }

  draw() {
    const { record } = this;
    if (!record || this.canvas.offsetParent === null) return;
    const prepared = prepareCanvas(this.canvas);
    if (!prepared) return;
    const { context, width } = prepared;
    const { size, steps } = record;
    const rgba = new Uint8ClampedArray(4 * size * size);
    const stored = record.picture(this.done, rgba);
    // Object order knows at the end, and of all pixels at once, that nothing nearer will come.
    const [word, known] =
      this.order === "image"
        ? ["decided", stored]
        : this.done === steps.count
          ? ["decided", size * size]
          : ["stored", stored];
    this.progress.textContent = `${word} ${grouped(known)} of ${grouped(size * size)}`;
    if (this.done === steps.count) fillRest(rgba, this.background);
    paintPixels(this.sheet, rgba, size, size);
    const cell = width / size;
    context.fillStyle = colour("empty-other");
    context.fillRect(0, 0, width, width);
    context.fillStyle = colour("empty");
    for (let row = 0; row < size; row++)
      for (let column = row % 2; column < size; column += 2) context.fillRect(column * cell, row * cell, cell, cell);
    context.imageSmoothingEnabled = false;
    context.drawImage(this.sheet, 0, 0, width, width);
    if (cell >= 7) {
      context.strokeStyle = isDark() ? "#ffffff18" : "#00000018";
      drawGrid(context, size, size, cell);
    }
    if (this.done > 0 && this.done < steps.count) this.drawCursor(context, cell, this.done - 1);
  }

  /**
   * The pixels that the inner loop of object order asks for the object: with boxes they are few, and those done have a dot.
   * @param {CanvasRenderingContext2D} context
   * @param {number} cell
   * @param {number} number
   */
  drawAsked(context, cell, number) {
    const { pixels, done } = /** @type {Recording} */ (this.record).asked(number);
    const radius = Math.max(Math.min(cell * 0.09, 4), 1);
    context.beginPath();
    for (const [row, column] of pixels.slice(0, done)) {
      const [x, y] = [(column + 0.5) * cell, (row + 0.5) * cell];
      context.moveTo(x + radius, y);
      context.arc(x, y, radius, 0, 2 * Math.PI);
    }
    context.fillStyle = colour("object");
    context.globalAlpha = 0.8;
    context.fill();
    context.globalAlpha = 1;
    if (state.method === "textbook") return;
    const [rows, columns] = [0, 1].map((axis) => pixels.map((pixel) => pixel[axis]));
    const [top, left] = [Math.min(...rows), Math.min(...columns)];
    const [bottom, right] = [Math.max(...rows) + 1, Math.max(...columns) + 1];
    context.setLineDash([6, 4]);
    const corners = /** @type {[number, number][]} */ ([
      [left, top],
      [right, top],
      [right, bottom],
      [left, bottom],
      [left, top],
    ]);
    drawLines(context, [corners], cell, colour("object"));
    context.setLineDash([]);
  }

  /**
   * The pixel of a step, and the row or the object's pixels that its outer loop is about.
   * @param {CanvasRenderingContext2D} context
   * @param {number} cell
   * @param {number} number
   */
  drawCursor(context, cell, number) {
    const record = /** @type {Recording} */ (this.record);
    const step = record.step(number);
    const [x, y] = [step.column * cell, step.row * cell];
    drawLines(context, record.outline(step), cell, colour(this.order));
    if (this.order === "object") this.drawAsked(context, cell, number);
    const covered = step.result !== RESULT.none && step.result !== RESULT.missed;
    drawChosenFrame(context, x, y, cell, cell);
    context.fillStyle = CHOSEN;
    context.strokeStyle = "#000";
    context.lineWidth = 1;
    const radius = Math.min(cell * 0.22, 9);
    context.beginPath();
    context.arc(x + cell / 2, y + cell / 2, radius, 0, 2 * Math.PI);
    if (covered) context.fill();
    context.stroke();
  }
}

/**
 * Lines over a picture, with a dark edge.
 * @param {CanvasRenderingContext2D} context
 * @param {[number, number][][]} lines  In raster coordinates.
 * @param {number} cell
 * @param {string} ink
 */
function drawLines(context, lines, cell, ink) {
  context.lineJoin = "round";
  context.lineCap = context.getLineDash().length > 0 ? "butt" : "round";
  for (const [width, pen] of /** @type {const} */ ([
    [4.5, "#000a"],
    [2, ink],
  ])) {
    context.strokeStyle = pen;
    context.lineWidth = width;
    context.beginPath();
    for (const line of lines)
      line.forEach(([x, y], index) => context[index ? "lineTo" : "moveTo"](x * cell, y * cell));
    context.stroke();
  }
}

/**
 * At the end, what nothing is stored in shows the background.
 * @param {Uint8ClampedArray} rgba
 * @param {ArrayLike<number> | null} background
 */
function fillRest(rgba, background) {
  if (!background) return;
  for (let at = 0; at < rgba.length; at += 4)
    if (rgba[at + 3] === 0) rgba.set([background[0], background[1], background[2], 254], at);
}

/**
 * The colour that image order gives to a pixel in which it sees nothing.
 * @param {Steps} steps
 * @returns {ArrayLike<number> | null}
 */
function backgroundOf({ changes: { id, rgb } }) {
  const place = id.indexOf(NOTHING);
  return place < 0 ? null : rgb.slice(3 * place, 3 * place + 3);
}
