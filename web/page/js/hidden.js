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

/** @typedef {{context: CanvasRenderingContext2D, map: StageMap, surface: Surface | null}} Drawing3 */

/** Pixels of the canvas by which something may lie behind the surface and still count as on it: its raster is not finer. */
const SLACK = 2;
/** The pixels of a line that are decided together, and how many such parts a line has at most. */
const PART = 2;
const MOST_PARTS = 700;
/** How lines are drawn behind the surface. */
const BEHIND = { dash: [3, 5], thinner: 0.7, paler: 0.7 };

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
  const [x, y] = map.project(corner);
  const [ax, ay] = subtractFlat(map.project(add(corner, across)), [x, y]);
  const [bx, by] = subtractFlat(map.project(add(corner, down)), [x, y]);
  const [left, top] = [Math.max(0, Math.floor(x + Math.min(0, ax) + Math.min(0, bx))), Math.max(0, Math.floor(y + Math.min(0, ay) + Math.min(0, by)))];
  const right = Math.min(map.width, Math.ceil(x + Math.max(0, ax) + Math.max(0, bx)));
  const bottom = Math.min(map.height, Math.ceil(y + Math.max(0, ay) + Math.max(0, by)));
  const [width, height] = [Math.floor(right - left), Math.floor(bottom - top)];
  const area = ax * by - ay * bx;
  // Seen from its edge, it has no area.
  if (width < 1 || height < 1 || Math.abs(area) < 1) return;
  const depth = map.depth(corner);
  const [deeper, lower] = [map.depth(add(corner, across)) - depth, map.depth(add(corner, down)) - depth];
  const mask = new ImageData(width, height);
  for (let row = 0; row < height; row++) {
    for (let column = 0; column < width; column++) {
      const [dx, dy] = [left + column + 0.5 - x, top + row + 0.5 - y];
      const [s, r] = [(dx * by - dy * bx) / area, (ax * dy - ay * dx) / area];
      if (s < 0 || s > 1 || r < 0 || r > 1) continue;
      if (isBehind(drawing, dx + x, dy + y, depth + s * deeper + r * lower)) continue;
      mask.data[4 * (row * width + column) + 3] = 255;
    }
  }
  [paneSheet.width, paneSheet.height] = [width, height];
  const pane = paneSheet.getContext("2d", { willReadFrequently: true });
  if (!pane) return;
  pane.putImageData(mask, 0, 0);
  pane.globalCompositeOperation = "source-in";
  pane.fillStyle = ink;
  pane.fillRect(0, 0, width, height);
  context.globalAlpha = opacity;
  context.drawImage(paneSheet, left, top, width, height);
  context.globalAlpha = 1;
}

/** @param {[number, number]} a @param {[number, number]} b @returns {[number, number]} */
const subtractFlat = (a, b) => [a[0] - b[0], a[1] - b[1]];
