// @ts-check
// The pixel microscope: the viewing ray derived as on the board, what lies along it, and the edge functions. All numbers are
// those of `bothways pixel`.

let lookedFor = "";

const lookAgain = debounced(60, look);

async function look() {
  if (viewOf(state.chapter) !== "pixel" || !state.camera || !state.pixel) return;
  const [row, column] = state.pixel;
  const radius = Number(inputById("radius").value);
  const wantedFor = JSON.stringify([sceneKey(), state.camera, row, column, radius]);
  if (wantedFor === lookedFor) return;
  lookedFor = wantedFor;
  const { camera } = state;
  try {
    /** @type {PixelReport} */
    const report = await engine.call("pixel", { row, column, camera });
    const { frame } = await engine.call("camera", { camera });
    const near = await engine.call("neighbourhood", { row, column, radius, camera });
    if (wantedFor !== lookedFor) return;
    showRay(report, camera, frame);
    showAlong(report);
    showEdges(report.at[0]);
    showNeighbourhood(near, report);
    /** @type {HTMLElement} */ (document.querySelector("#pixel-prose pre")).textContent = (report.lines ?? []).join(
      "\n",
    );
  } catch (error) {
    lookedFor = "";
    showTrouble(messageOf(error));
  }
}

/** @param {string} symbol @param {...(string | Node)} lines */
const definition = (symbol, ...lines) => [
  make("dt", {}, ...rich(symbol)),
  make("dd", {}, ...lines.map((line) => (typeof line === "string" ? make("span", {}, ...rich(line)) : line))),
];

/**
 * The lecture's formulas with this camera's numbers. The lecture counts from 1, the page from 0.
 * @param {PixelReport} report
 * @param {Camera} camera
 * @param {{u: Vector, v: Vector, w: Vector}} frame
 */
function showRay(report, camera, frame) {
  const [{ x, y, origin_from_eye: origin, direction }] = report.at;
  const [width, height] = report.size;
  const [i, j] = report.pixel.map((place) => place + 1);
  const perspective = camera.projection === "perspective";
  /** @param {string} text */
  const value = (text) => make("span", { class: "value" }, text);
  byId("ray").replaceChildren(
    make(
      "p",
      { class: "quiet" },
      `Pixel (${report.pixel.join(", ")}) of ${height} rows and ${width} columns. The lecture counts from 1, so i = ${i} and j = ${j} in its formulas.`,
    ),
    make(
      "dl",
      { class: "formula" },
      ...definition(
        "x",
        `= vw ((j − ½)/W − ½) = ${stored(camera.vw)} ((${j} − ½)/${width} − ½)`,
        value(`= ${whole(x)}`),
      ),
      ...definition(
        "y",
        `= −vh ((i − ½)/H − ½) = −${stored(camera.vh)} ((${i} − ½)/${height} − ½)`,
        value(`= ${whole(y)}`),
      ),
      ...definition("*u*, *v*, *w*", `= ${[frame.u, frame.v, frame.w].map((axis) => vectorText(axis)).join(", ")}`),
      ...(perspective
        ? [
            ...definition("*p*", "= eye", value(`= ${vectorText(report.eye, 9)}`)),
            ...definition(
              "*d*",
              `= x *u* + y *v* − d *w*, with d = ${stored(camera.d)}`,
              value(`= ${vectorText(direction, 9)}`),
            ),
          ]
        : [
            ...definition("*p*", "= eye + x *u* + y *v*", value(`= ${vectorText(add(report.eye, origin), 9)}`)),
            ...definition("*d*", "= −*w*", value(`= ${vectorText(direction, 9)}`)),
          ]),
      ...definition("*r*(t)", "= *p* + t *d*, with t > 0"),
    ),
    make(
      "p",
      { class: report.agree ? "right" : "wrong" },
      report.agree
        ? `Both orders saw ${report.at[0].object_order.id === null ? "nothing" : `id ${report.at[0].object_order.id}`} here, which is what is nearest.`
        : "The orders did not both see what is nearest.",
    ),
  );
}

/** A size of the camera as it is stored, in 32 bits: with all digits, a calculator gives the same results. @param {number} size */
const stored = (size) => whole(Math.fround(size));

/** All that the ray meets, on an axis of t. @param {PixelReport} report */
function showAlong(report) {
  const [{ covering }] = report.at;
  const holder = byId("along");
  if (covering.length === 0) {
    holder.replaceChildren(make("p", { class: "quiet" }, "The ray meets nothing."));
    return;
  }
  const [width, height, left, right] = [640, 96, 14, 20];
  const most = Math.max(...covering.map(({ t }) => t)) * 1.15;
  /** @param {number} t */
  const at = (t) => left + (t / most) * (width - left - right);
  const letters = { "font-size": 15, fill: "currentColor" };
  const picture = makeSvg(
    "svg",
    {
      viewBox: `0 0 ${width} ${height}`,
      class: "axis",
      role: "img",
      "aria-label": `Along the ray: ${covering.map(({ id, t }) => `id ${id} at t = ${short(t)}`).join(", ")}`,
    },
    makeSvg("line", { x1: at(0), y1: 52, x2: width - 6, y2: 52, stroke: "currentColor", "stroke-width": 1.5 }),
    makeSvg("path", {
      d: `M${width - 14} 46 L${width - 4} 52 L${width - 14} 58`,
      fill: "none",
      stroke: "currentColor",
      "stroke-width": 1.5,
    }),
    makeSvg("circle", { cx: at(0), cy: 52, r: 5, fill: colour("camera") }),
    makeSvg("text", { x: at(0) - 4, y: 80, ...letters }, "t = 0"),
  );
  let taken = -Infinity;
  covering.forEach(({ id, t }, place) => {
    const x = at(t);
    picture.append(
      makeSvg("line", {
        x1: x,
        y1: place === 0 ? 30 : 40,
        x2: x,
        y2: place === 0 ? 74 : 64,
        stroke: place === 0 ? colour("good") : "currentColor",
        "stroke-width": place === 0 ? 4 : 1.5,
      }),
    );
    const text = `id ${id}`;
    if (x - taken > 0) {
      const middle = { "text-anchor": "middle", x: clamp(x, 24, width - 40) };
      picture.append(
        makeSvg("text", { ...middle, y: 22, ...letters, "font-weight": place === 0 ? 650 : 400 }, text),
        makeSvg("text", { ...middle, y: 91, ...letters, "font-size": 13 }, short(t, 4)),
      );
      taken = x + 9.5 * text.length + 8;
    }
  });
  const rows = covering.map(({ id, object, kind, t, behind }, place) =>
    make(
      "tr",
      {},
      make("th", { scope: "row" }, `id ${grouped(id)}`),
      make("td", {}, `${kind}, object ${object}`),
      make("td", {}, `t = ${short(t, 10)}`),
      make("td", { class: place === 0 ? "right" : "quiet" }, place === 0 ? "seen" : String(behind ?? "farther")),
    ),
  );
  holder.replaceChildren(
    picture,
    make(
      "div",
      { class: "edges", role: "region", "aria-label": "Along the ray", tabindex: 0 },
      make("table", {}, make("tbody", {}, ...rows.slice(0, 12))),
    ),
    rows.length > 12 ? make("p", { class: "quiet" }, `and ${rows.length - 12} more`) : make("span"),
  );
}

/** The edge functions of the triangles that cover or touch the sample. @param {SampleReport} sample */
function showEdges({ covering, touching }) {
  const flat = [...covering.filter(({ edges }) => edges), ...touching];
  const holder = byId("edges");
  if (flat.length === 0) {
    holder.replaceChildren(make("p", { class: "quiet" }, "No triangle covers or touches this sample."));
    return;
  }
  const head = make(
    "tr",
    {},
    ...["", "E_ab_", "E_bc_", "E_ca_", "facing F", ""].map((text) =>
      text ? make("th", { scope: "col" }, ...rich(text)) : make("td"),
    ),
  );
  const rows = flat.slice(0, 10).map((triangle) => {
    const covers = covering.includes(triangle);
    return make(
      "tr",
      {},
      make("th", { scope: "row" }, `id ${grouped(triangle.id)}`),
      ...edgeCells(triangle.edges),
      make("td", { class: covers ? "right" : "quiet" }, covers ? "covers" : "only touches"),
    );
  });
  holder.replaceChildren(
    make(
      "p",
      { class: "quiet" },
      "A triangle covers a sample if its edge functions have the sign of its facing F. Where one is 0, the sample is moved infinitely little to the right, and far less down: left and top edges own it.",
    ),
    make(
      "div",
      { class: "edges", role: "region", "aria-label": "Edge functions", tabindex: 0 },
      make("table", {}, make("thead", {}, head), make("tbody", {}, ...rows)),
    ),
  );
}

/**
 * The cells of one triangle: values and signs, and the tie rule where it decides.
 * @param {{values: number[], on_edge: (string | null)[], decided: number[], facing_value: number}} edges
 */
function edgeCells({ values, on_edge: sides, decided, facing_value: facing }) {
  const cells = values.map((value, index) => {
    const side = sides[index];
    if (!side) return signCell(value);
    return make(
      "td",
      {},
      make("span", { class: "tie" }, "0"),
      ` ${side} edge, nudged to `,
      make("span", { class: decided[index] > 0 ? "sign-plus" : "sign-minus" }, decided[index] > 0 ? "+" : "−"),
    );
  });
  return [...cells, signCell(facing)];
}

/** @param {number} number */
const signCell = (number) =>
  make(
    "td",
    {},
    make("span", { class: number > 0 ? "sign-plus" : "sign-minus" }, number > 0 ? "+" : number < 0 ? "−" : ""),
    ` ${short(Math.abs(number))}`,
  );

function showPixelFields() {
  if (!state.pixel || !state.camera) return;
  const [row, column] = state.pixel;
  for (const [id, value, most] of /** @type {const} */ ([
    ["pixel-row", row, state.camera.height - 1],
    ["pixel-column", column, state.camera.width - 1],
  ])) {
    inputById(id).max = String(most);
    if (document.activeElement !== byId(id)) inputById(id).value = String(value);
  }
}

function beginMicroscope() {
  byId("pixel-form").addEventListener("submit", (event) => {
    event.preventDefault();
    change({ pixel: [inputById("pixel-row").valueAsNumber, inputById("pixel-column").valueAsNumber] });
  });
  for (const id of ["pixel-row", "pixel-column"])
    byId(id).addEventListener("change", () => /** @type {HTMLFormElement} */ (byId("pixel-form")).requestSubmit());
  inputById("radius").addEventListener("input", lookAgain);
  watch(["pixel", "camera"], showPixelFields);
  watch(["pixel", "camera", "chapter", "scene"], lookAgain);
}
