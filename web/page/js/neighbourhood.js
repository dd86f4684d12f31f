// @ts-check
// The pixels about the chosen one, magnified: samples, edges, and which primitive owns each sample.

/**
 * @typedef {object} Neighbourhood
 * @property {{id: number, corners: number[][]}[]} triangles  In raster coordinates: x to the right in columns, y down in rows.
 * @property {{row: number, column: number, id: number | null}[]} samples
 * @property {number} radius
 */

/** @type {{near: Neighbourhood, pixel: Pixel, nearest: number | null, touching: Set<number>} | null} */
let magnified = null;

/** @param {Neighbourhood} near @param {PixelReport} report */
function showNeighbourhood(near, report) {
  const [{ covering, touching }] = report.at;
  magnified = {
    near,
    pixel: report.pixel,
    nearest: covering[0]?.id ?? null,
    touching: new Set([...covering, ...touching].map(({ id }) => id)),
  };
  drawNeighbourhood();
}

function drawNeighbourhood() {
  const prepared = magnified && prepareCanvas(canvasById("neighbourhood"));
  if (!prepared || !magnified) return;
  const { context, width } = prepared;
  const {
    near,
    pixel: [row, column],
    nearest,
    touching,
  } = magnified;
  const cells = 2 * near.radius + 1;
  const cell = width / cells;
  /**
   * @param {number} x
   * @param {number} y
   * @returns {[number, number]}
   */
  const place = (x, y) => [(x - (column - near.radius)) * cell, (y - (row - near.radius)) * cell];
  const sheet = sheets.get("object");
  context.fillStyle = colour("mat");
  context.fillRect(0, 0, width, width);
  if (sheet) {
    context.imageSmoothingEnabled = false;
    context.globalAlpha = 0.55;
    context.drawImage(sheet, ...place(0, 0), sheet.width * cell, sheet.height * cell);
    context.globalAlpha = 1;
  }
  context.strokeStyle = colour("hairline");
  drawGrid(context, cells, cells, cell);
  // Those that the pixel is about are drawn last, and strongly.
  const ordered = [...near.triangles].sort(
    (one, other) => Number(touching.has(one.id)) - Number(touching.has(other.id)),
  );
  for (const { id, corners } of ordered) {
    const strong = touching.has(id);
    context.strokeStyle = id === nearest ? colour("good") : strong ? colour("bright") : colour("quiet");
    context.lineWidth = id === nearest ? 3 : strong ? 2 : 1;
    context.globalAlpha = strong ? 1 : 0.7;
    context.beginPath();
    corners.forEach(([x, y], index) => context[index ? "lineTo" : "moveTo"](...place(x, y)));
    context.closePath();
    context.stroke();
  }
  context.globalAlpha = 1;
  const radius = Math.min(cell * 0.13, 6);
  for (const { row: i, column: j, id } of near.samples) {
    const [x, y] = place(j + 0.5, i + 0.5);
    context.beginPath();
    context.arc(x, y, radius, 0, 2 * Math.PI);
    context.fillStyle = id === null ? colour("ground") : colour("bright");
    context.strokeStyle = id === null ? colour("bright") : colour("ground");
    context.lineWidth = 1.5;
    context.fill();
    context.stroke();
  }
  drawChosenFrame(context, ...place(column, row), cell, cell);
}

function beginNeighbourhood() {
  const canvas = canvasById("neighbourhood");
  drawWhenShown(canvas, drawNeighbourhood);
  canvas.addEventListener("click", (event) => {
    if (!magnified || !state.camera) return;
    const {
      near,
      pixel: [row, column],
    } = magnified;
    const cell = canvas.clientWidth / (2 * near.radius + 1);
    const [down, right] = [
      Math.floor(event.offsetY / cell) - near.radius,
      Math.floor(event.offsetX / cell) - near.radius,
    ];
    const pixel = /** @type {Pixel} */ ([
      clamp(row + down, 0, state.camera.height - 1),
      clamp(column + right, 0, state.camera.width - 1),
    ]);
    change({ pixel });
  });
}
