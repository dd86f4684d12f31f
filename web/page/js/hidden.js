// @ts-check
// Lines and panes in the world, seen from outside: what lies behind the scene's surface is thin and dashed, or left out. The
// engine's picture of the scene says how far that surface is.

/**
 * What the observer sees of the scene.
 * @typedef {object} Surface
 * @property {string} key  What was asked for.
 * @property {object} camera  The observer, as a camera.
 * @property {HTMLCanvasElement} sheet  The picture, transparent where nothing is seen.
 * @property {Float32Array} t  How far it is from the plane that cuts off what is nearer, row after row; infinite where nothing is.
 * @property {number} columns
 * @property {number} rows
 * @property {number} cut  Where that plane is, from the middle towards the observer.
 */

/**
 * @typedef {object} Drawing3
 * @property {CanvasRenderingContext2D} context
 * @property {StageMap} map
 * @property {Surface | null} surface
 * @property {boolean} [isQuick]  Whether it is one of many in a second.
 */

/** Pixels of the canvas by which something may lie behind the surface and still count as on it: its raster is not finer. */
const SLACK = 2;
/** The pixels of a line that are decided together, and how many such parts a line has at most. */
const PART = 2;
const MOST_PARTS = 700;
/** How lines are drawn behind the surface. */
const BEHIND = { dash: [6, 5], thinner: 0.7, paler: 0.7 };

/**
 * Whether the surface lies before a place.
 * @param {Drawing3} drawing
 * @param {number} x  On the canvas.
 * @param {number} y
 * @param {number} depth  Towards the observer, as {@link stageMap} gives it.
 */
function isBehind({ map, surface }, x, y, depth) {
  if (!surface) return false;
  const column = Math.floor((x / map.width) * surface.columns);
  const row = Math.floor((y / map.height) * surface.rows);
  if (column < 0 || row < 0 || column >= surface.columns || row >= surface.rows) return false;
  return surface.t[row * surface.columns + column] < surface.cut - depth - SLACK / map.scale;
}

/** Whether the surface lies before a point of the world. @param {Drawing3} drawing @param {ArrayLike<number>} point */
const isPointBehind = (drawing, point) => isBehind(drawing, ...drawing.map.project(point), drawing.map.depth(point));

/**
 * Strokes a line of the world in the ink that is set.
 * @param {Drawing3} drawing
 * @param {Vector} from
 * @param {Vector} to
 * @param {"dashed" | "left out"} [behind]  What becomes of it behind the surface.
 */
function strokeLine(drawing, from, to, behind = "dashed") {
  const { context, map } = drawing;
  const [a, b] = [map.project(from), map.project(to)];
  const [near, far] = [map.depth(from), map.depth(to)];
  const parts = clamp(Math.ceil(Math.hypot(b[0] - a[0], b[1] - a[1]) / PART), 1, MOST_PARTS);
  /** @param {number} part @returns {[number, number]} */
  const at = (part) => [a[0] + ((b[0] - a[0]) * part) / parts, a[1] + ((b[1] - a[1]) * part) / parts];
  /** @param {number} part */
  const isPartBehind = (part) => isBehind(drawing, ...at(part + 0.5), near + ((far - near) * (part + 0.5)) / parts);
  const [before, dashed] = [new Path2D(), new Path2D()];
  let [begin, was] = [0, isPartBehind(0)];
  for (let part = 1; part <= parts; part++) {
    const is = part < parts && isPartBehind(part);
    if (part < parts && is === was) continue;
    const path = was ? dashed : before;
    path.moveTo(...at(begin));
    path.lineTo(...at(part));
    [begin, was] = [part, is];
  }
  context.stroke(before);
  if (behind === "left out") return;
  context.save();
  context.setLineDash(BEHIND.dash);
  context.lineWidth *= BEHIND.thinner;
  context.globalAlpha *= BEHIND.paler;
  context.stroke(dashed);
  context.restore();
}

/** The part of a pane that lies before the surface, black. */
const paneSheet = document.createElement("canvas");
const BLACK = 0xff000000;

/**
 * Lays a translucent pane over what lies behind it.
 * @param {Drawing3} drawing
 * @param {Vector} corner
 * @param {Vector} across  Its sides.
 * @param {Vector} down
 * @param {string} ink
 * @param {number} opacity
 */
function fillPane(drawing, corner, across, down, ink, opacity) {
  const { context, map } = drawing;
  const [o, a, b] = [corner, add(corner, across), add(corner, down)].map((point) => [...map.project(point), map.depth(point)]);
  const [p, q] = [subtract(a, o), subtract(b, o)];
  const [left, width] = within(o[0], p[0], q[0], map.width);
  const [top, height] = within(o[1], p[1], q[1], map.height);
  const area = p[0] * q[1] - p[1] * q[0];
  // Seen from its edge, it has no area.
  if (width < 1 || height < 1 || Math.abs(area) < 1) return;
  // While the observer turns, four pixels are decided together.
  const cell = drawing.isQuick ? 2 : 1;
  const [columns, rows] = [Math.ceil(width / cell), Math.ceil(height / cell)];
  const mask = new ImageData(columns, rows);
  const pixels = new Uint32Array(mask.data.buffer);
  for (let row = 0; row < rows; row++) {
    const y = top + cell * (row + 0.5);
    for (let column = 0; column < columns; column++) {
      const x = left + cell * (column + 0.5);
      const s = ((x - o[0]) * q[1] - (y - o[1]) * q[0]) / area;
      const r = (p[0] * (y - o[1]) - p[1] * (x - o[0])) / area;
      if (s < 0 || s > 1 || r < 0 || r > 1 || isBehind(drawing, x, y, o[2] + s * p[2] + r * q[2])) continue;
      pixels[row * columns + column] = BLACK;
    }
  }
  [paneSheet.width, paneSheet.height] = [columns, rows];
  const pane = paneSheet.getContext("2d", { willReadFrequently: true });
  if (!pane) return;
  pane.putImageData(mask, 0, 0);
  pane.globalCompositeOperation = "source-in";
  pane.fillStyle = ink;
  pane.fillRect(0, 0, columns, rows);
  context.globalAlpha = opacity;
  context.drawImage(paneSheet, left, top, cell * columns, cell * rows);
  context.globalAlpha = 1;
}

/**
 * Where a parallelogram begins along one side of the canvas, and how much of it is on the canvas, in whole pixels.
 * @param {number} corner
 * @param {number} one  How far its sides go.
 * @param {number} other
 * @param {number} most
 * @returns {[number, number]}
 */
function within(corner, one, other, most) {
  const begin = Math.max(0, Math.floor(corner + Math.min(0, one) + Math.min(0, other)));
  const end = Math.min(Math.ceil(most), Math.ceil(corner + Math.max(0, one) + Math.max(0, other)));
  return [begin, end - begin];
}
