// @ts-check
// Two triangles that share an edge: drag a vertex, and the exact predicates say which of them owns each sample.

/** The raster: rows and columns. */
const EDGE_ROWS = 12;
const EDGE_COLUMNS = 16;

/** The corners, in raster coordinates; the edge from the first to the third is shared. @type {[number, number][]} */
const corners = [
  [3.5, 2.5],
  [13.5, 1.5],
  [12.5, 10.5],
  [2.5, 9.5],
];
let chosenCorner = 0;
/** A sample that lies exactly on an edge of both triangles. @typedef {{row: number, column: number, atEnd: boolean}} EdgeTie */
/** @type {{owners: ArrayLike<number>, ties: EdgeTie[]} | null} */
let owned = null;
let askedFor = "";
let ownUnderWay = false;

/** The side of a pixel of the raster on a canvas of this width. @param {number} width */
const edgeScale = (width) => width / EDGE_COLUMNS;

async function askOwners() {
  const wantedFor = JSON.stringify(corners);
  drawOwners();
  if (wantedFor === askedFor || ownUnderWay || viewOf(state.chapter) !== "edge") return;
  ownUnderWay = true;
  askedFor = wantedFor;
  try {
    owned = await engine.call("own", {
      vertices: corners.map((corner) => [...corner]),
      height: EDGE_ROWS,
      width: EDGE_COLUMNS,
    });
  } catch (error) {
    showTrouble(messageOf(error));
  }
  ownUnderWay = false;
  showOwners();
  if (JSON.stringify(corners) !== askedFor) askOwners();
}

function showOwners() {
  drawOwners();
  if (!owned) return;
  const owners = Array.from(owned.owners);
  const counts = [0, 0, 0, 0];
  for (const owner of owners) counts[owner]++;
  const rows = /** @type {[string, number][]} */ ([
    ["of the first triangle alone", counts[1]],
    ["of the second triangle alone", counts[2]],
    ["of both", counts[3]],
    ["of neither", counts[0]],
  ]);
  /** @type {HTMLElement} */ (byId("owners").querySelector("tbody")).replaceChildren(
    ...rows.map(([label, value]) =>
      make("tr", {}, make("th", { scope: "row" }, label), make("td", {}, grouped(value))),
    ),
  );
  const verdict = byId("owners-verdict");
  const [text, isRight] = ownersText(
    counts[3],
    owned.ties.map(({ row, column, atEnd }) => ({ owner: owners[row * EDGE_COLUMNS + column], atEnd })),
  );
  verdict.textContent = text;
  verdict.className = isRight === null ? "" : isRight ? "right" : "wrong";
  say(text);
}

/**
 * What is true of the samples, in words, and whether it is as it should be: `null` where the triangles overlap.
 * @param {number} both  Samples of both triangles.
 * @param {{owner: number, atEnd: boolean}[]} ties  The samples that lie on edges of both, with their owners.
 * @returns {[string, boolean | null]}
 */
function ownersText(both, ties) {
  if (foldsOver()) {
    return [
      `Both triangles lie on the same side of their shared edge, so they overlap: ${counted(both, "sample")} of both.`,
      null,
    ];
  }
  if (both > 0) return [`${counted(both, "sample")} ${both === 1 ? "belongs" : "belong"} to both.`, false];
  if (ties.length === 0) {
    return [
      "No sample belongs to both, and none lies exactly on the shared edge now: move a vertex to the middle of a pixel.",
      true,
    ];
  }
  const unowned = ties.filter(({ owner }) => owner === 0);
  const within = unowned.filter(({ atEnd }) => !atEnd).length;
  if (within > 0) {
    const text = `${counted(within, "sample")} on the shared edge ${within === 1 ? "belongs" : "belong"} to neither triangle.`;
    return isFlat() ? [`One triangle has no area. ${text}`, null] : [text, false];
  }
  const single = ties.length - unowned.length;
  const none = unowned.length;
  const corner =
    none === 0 ? "" : ` ${counted(none, "sample")} at its end ${none === 1 ? "belongs" : "belong"} to neither.`;
  const lie = `${counted(ties.length, "sample")} ${ties.length === 1 ? "lies" : "lie"} exactly on the shared edge`;
  return [
    `No sample belongs to both. ${lie}: ${single} ${single === 1 ? "has" : "have"} exactly one owner.${corner}`,
    true,
  ];
}

/** On which sides of the shared edge the two other corners lie, as the picture shows it. */
function sidesOfEdge() {
  const [a, b, c, d] = corners;
  return [b, d].map((p) => Math.sign((c[0] - a[0]) * (p[1] - a[1]) - (c[1] - a[1]) * (p[0] - a[0])));
}

const foldsOver = () => sidesOfEdge()[0] * sidesOfEdge()[1] > 0;
const isFlat = () => sidesOfEdge().includes(0);

function drawOwners() {
  const canvas = canvasById("own");
  const prepared = canvas.offsetParent && prepareCanvas(canvas);
  if (!prepared) return;
  const { context, width, height } = prepared;
  const cell = edgeScale(width);
  context.fillStyle = colour("mat");
  context.fillRect(0, 0, width, height);
  const fills = ["", colour("object"), colour("image"), colour("bad")];
  Array.from(owned?.owners ?? []).forEach((owner, index) => {
    if (!owner) return;
    const [row, column] = [Math.floor(index / EDGE_COLUMNS), index % EDGE_COLUMNS];
    context.globalAlpha = 0.3;
    context.fillStyle = fills[owner];
    context.fillRect(column * cell, row * cell, cell, cell);
    context.globalAlpha = 1;
  });
  context.strokeStyle = colour("hairline");
  drawGrid(context, EDGE_ROWS, EDGE_COLUMNS, cell);
  drawSamples(context, cell);
  const [a, b, c, d] = corners.map(([x, y]) => /** @type {[number, number]} */ ([x * cell, y * cell]));
  for (const [ink, points] of /** @type {[string, [number, number][]][]} */ ([
    [colour("object"), [a, b, c]],
    [colour("image"), [a, c, d]],
  ])) {
    context.strokeStyle = ink;
    context.lineWidth = 2.5;
    context.beginPath();
    points.forEach((point, index) => context[index ? "lineTo" : "moveTo"](...point));
    context.closePath();
    context.stroke();
  }
  context.strokeStyle = colour("bright");
  context.lineWidth = 3;
  context.beginPath();
  context.moveTo(...a);
  context.lineTo(...c);
  context.stroke();
  [a, b, c, d].forEach((point, index) => {
    const radius = 0.75 * letterSize();
    context.beginPath();
    context.arc(...point, radius, 0, 2 * Math.PI);
    context.fillStyle = index === chosenCorner ? colour("bright") : colour("ground");
    context.strokeStyle = colour("bright");
    context.lineWidth = 2;
    context.fill();
    context.stroke();
    context.fillStyle = index === chosenCorner ? colour("ground") : colour("bright");
    context.font = `600 ${0.85 * letterSize()}px ${colour("text")}`;
    context.textAlign = "center";
    context.textBaseline = "middle";
    context.fillText(String(index + 1), point[0], point[1] + 1);
  });
}

/**
 * The samples: a disc for the first triangle, a square for the second, a ring for neither.
 * @param {CanvasRenderingContext2D} context
 * @param {number} cell
 */
function drawSamples(context, cell) {
  const ties = new Set((owned?.ties ?? []).map(({ row, column }) => row * EDGE_COLUMNS + column));
  for (let row = 0; row < EDGE_ROWS; row++) {
    for (let column = 0; column < EDGE_COLUMNS; column++) {
      const index = row * EDGE_COLUMNS + column;
      const owner = owned?.owners[index] ?? 0;
      const [x, y] = [(column + 0.5) * cell, (row + 0.5) * cell];
      const radius = Math.max(2.5, cell * 0.1);
      if (ties.has(index)) {
        context.strokeStyle = colour("focus");
        context.lineWidth = 3;
        context.beginPath();
        context.arc(x, y, radius * 2.2, 0, 2 * Math.PI);
        context.stroke();
      }
      context.fillStyle = [colour("quiet"), colour("object"), colour("image"), colour("bad")][owner];
      if (owner === 1 || owner === 3) drawMark(context, "object", x, y, radius);
      else if (owner === 2) drawMark(context, "image", x, y, radius);
      else {
        context.strokeStyle = colour("quiet");
        context.lineWidth = 1;
        context.beginPath();
        context.arc(x, y, radius * 0.7, 0, 2 * Math.PI);
        context.stroke();
      }
    }
  }
}

/** @param {number} x @param {number} y */
function moveCorner(x, y) {
  const grid = inputById("snap").checked ? 4 : 64;
  corners[chosenCorner] = [
    clamp(Math.round(x * grid) / grid, 0, EDGE_COLUMNS),
    clamp(Math.round(y * grid) / grid, 0, EDGE_ROWS),
  ];
  showCorner();
  askOwners();
}

function showCorner() {
  const [x, y] = corners[chosenCorner];
  setChoice("vertex", String(chosenCorner));
  if (document.activeElement !== byId("vertex-x")) inputById("vertex-x").value = String(x);
  if (document.activeElement !== byId("vertex-y")) inputById("vertex-y").value = String(y);
}

function beginSharedEdge() {
  const canvas = canvasById("own");
  /** @type {number | null} */
  let held = null;
  /** @param {PointerEvent} event @returns {[number, number]} */
  const under = (event) => [
    event.offsetX / edgeScale(canvas.clientWidth),
    event.offsetY / edgeScale(canvas.clientWidth),
  ];
  canvas.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || held !== null) return;
    const [x, y] = under(event);
    const far = corners.map(([cx, cy]) => Math.hypot(cx - x, cy - y));
    chosenCorner = far.indexOf(Math.min(...far));
    if (far[chosenCorner] > 1.5) return;
    held = event.pointerId;
    canvas.setPointerCapture(event.pointerId);
    canvas.classList.add("dragged");
    showCorner();
    drawOwners();
  });
  canvas.addEventListener("pointermove", (event) => {
    if (held === event.pointerId) moveCorner(...under(event));
  });
  const release = (/** @type {PointerEvent} */ event) => {
    if (held !== event.pointerId) return;
    held = null;
    canvas.classList.remove("dragged");
  };
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", release);
  canvas.addEventListener("keydown", (event) => {
    const arrows = /** @type {Record<string, [number, number]>} */ ({
      ArrowUp: [0, -1],
      ArrowDown: [0, 1],
      ArrowLeft: [-1, 0],
      ArrowRight: [1, 0],
    });
    const arrow = arrows[event.key];
    const step = inputById("snap").checked ? 0.25 : 1 / 64;
    if (arrow) moveCorner(corners[chosenCorner][0] + arrow[0] * step, corners[chosenCorner][1] + arrow[1] * step);
    else if (/^[1-4]$/.test(event.key)) {
      chosenCorner = Number(event.key) - 1;
      showCorner();
      drawOwners();
    } else return;
    event.preventDefault();
  });
  onChoice("vertex", (value) => {
    chosenCorner = Number(value);
    showCorner();
    drawOwners();
  });
  for (const id of ["vertex-x", "vertex-y"]) {
    byId(id).addEventListener("change", () =>
      moveCorner(inputById("vertex-x").valueAsNumber || 0, inputById("vertex-y").valueAsNumber || 0),
    );
  }
  drawWhenShown(canvas, drawOwners);
  watch(["chapter"], () => requestAnimationFrame(askOwners));
  showCorner();
}
