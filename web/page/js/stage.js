// @ts-check
// Draws the camera and the scene in 3D, seen from outside. The points come from the engine; here they are only projected.

/**
 * From where the stage is looked at.
 * @typedef {object} Observer3
 * @property {Vector} centre
 * @property {Vector} from  Of length 1, from the centre to the observer.
 * @property {Vector} up  Of length 1.
 * @property {number} away
 * @property {boolean} [turns]  Whether the observer moves: the drawing is then made as quickly as possible.
 */

/** @typedef {{origin: Vector, through: Vector, end: Vector, hit: boolean, moving?: boolean, row: number, column: number}} DrawnRay */

/**
 * A place from which the camera and its target are well seen: beside the camera, a little above.
 * @param {Outside} outside
 * @param {Vector} target
 * @returns {Observer3}
 */
function besideCamera(outside, target) {
  const { eye, u, v, w } = outside;
  const size = Math.max(
    lengthOf(subtract(eye, target)),
    ...outside.corners.map((corner) => lengthOf(subtract(corner, eye))),
  );
  const from = unit(add(add(scaled(u, 0.78), scaled(v, 0.42)), scaled(w, 0.46)));
  return { centre: between(eye, target, 0.5), from, up: v, away: 1.75 * size };
}

/**
 * The map from the world to the canvas.
 * @param {Observer3} observer
 * @param {number} width
 * @param {number} height
 */
function stageMap({ centre, from, up, away }, width, height) {
  const right = unit(cross(up, from));
  const above = cross(from, right);
  const focal = 1.25 * Math.min(width * 0.72, height);
  const nearest = away * 0.04;
  /** Right, up, and towards the observer. @param {ArrayLike<number>} point @returns {Vector} */
  const turnedPoint = (point) => {
    const offset = subtract(point, centre);
    return [dot(offset, right), dot(offset, above), dot(offset, from)];
  };
  /** @param {Vector} at @returns {[number, number]} */
  const flat = ([x, y, z]) => {
    const scale = focal / Math.max(nearest, away - z);
    return [width / 2 + x * scale, height / 2 - y * scale];
  };
  /** @param {ArrayLike<number>} point */
  const project = (point) => flat(turnedPoint(point));
  /** The size of a length there, in pixels. @param {ArrayLike<number>} point */
  const scaleAt = (point) => focal / Math.max(nearest, away - turnedPoint(point)[2]);
  /** Whether a point lies before the observer. @param {ArrayLike<number>} point */
  const isBefore = (point) => away - turnedPoint(point)[2] > nearest;
  /**
   * A line as far as it lies before the observer.
   * @param {Vector} a
   * @param {Vector} b
   * @returns {[[number, number], [number, number]] | null}
   */
  const line = (a, b) => {
    let [one, other] = [turnedPoint(a), turnedPoint(b)];
    const limit = away - nearest;
    if (one[2] > limit && other[2] > limit) return null;
    if (one[2] > limit) one = between(other, one, (limit - other[2]) / (one[2] - other[2]));
    if (other[2] > limit) other = between(one, other, (limit - one[2]) / (other[2] - one[2]));
    return [flat(one), flat(other)];
  };
  /**
   * Puts a point onto the canvas: two numbers of `out`. Gives its depth, or NaN where it lies behind the observer.
   * @param {ArrayLike<number>} points
   * @param {number} at
   * @param {Float64Array} out
   * @param {number} to
   */
  const place = (points, at, out, to) => {
    const [x, y, z] = [points[at] - centre[0], points[at + 1] - centre[1], points[at + 2] - centre[2]];
    const depth = x * from[0] + y * from[1] + z * from[2];
    if (away - depth <= nearest) return NaN;
    const scale = focal / (away - depth);
    out[to] = width / 2 + scale * (x * right[0] + y * right[1] + z * right[2]);
    out[to + 1] = height / 2 - scale * (x * above[0] + y * above[1] + z * above[2]);
    return depth;
  };
  return {
    project,
    scaleAt,
    isBefore,
    line,
    place,
    depth: (/** @type {ArrayLike<number>} */ point) => turnedPoint(point)[2],
  };
}

/** @typedef {ReturnType<typeof stageMap>} StageMap */

/**
 * @param {CanvasRenderingContext2D} context
 * @param {StageMap} map
 * @param {Outside} outside
 * @param {Observer3} observer
 */
function drawObjects(context, map, outside, observer) {
  for (const plane of outside.planes) drawPlane(context, map, plane, observer);
  drawSolids(context, map, outside, observer);
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {StageMap} map
 * @param {Outside["spheres"][0]} sphere
 */
function drawSphere(context, map, { center, radius, colour: [red, green, blue] }) {
  const [x, y] = map.project(center);
  const size = radius * map.scaleAt(center);
  const shade = context.createRadialGradient(x - size * 0.35, y - size * 0.4, size * 0.1, x, y, size);
  /** @param {number} by */
  const ink = (by) => `rgb(${[red, green, blue].map((part) => Math.round(part * by)).join(" ")})`;
  shade.addColorStop(0, ink(1));
  shade.addColorStop(1, ink(0.5));
  context.beginPath();
  context.arc(x, y, size, 0, 2 * Math.PI);
  context.fillStyle = shade;
  context.fill();
}

/**
 * A part of a plane, as a net of lines.
 * @param {CanvasRenderingContext2D} context
 * @param {StageMap} map
 * @param {Outside["planes"][0]} plane
 * @param {Observer3} observer
 */
function drawPlane(context, map, { point, normal, colour: ink }, { centre, away }) {
  const n = unit(normal);
  const foot = subtract(centre, scaled(n, dot(subtract(centre, point), n)));
  const side = unit(cross(n, Math.abs(n[0]) < 0.8 ? [1, 0, 0] : [0, 0, 1]));
  const other = cross(n, side);
  const reach = 0.55 * away;
  context.strokeStyle = `rgb(${ink.join(" ")})`;
  context.globalAlpha = 0.55;
  context.lineWidth = 1;
  context.beginPath();
  for (let step = -6; step <= 6; step++) {
    for (const [one, two] of [
      [side, other],
      [other, side],
    ]) {
      const middle = add(foot, scaled(one, (step / 6) * reach));
      const line = map.line(add(middle, scaled(two, -reach)), add(middle, scaled(two, reach)));
      if (!line) continue;
      context.moveTo(...line[0]);
      context.lineTo(...line[1]);
    }
  }
  context.stroke();
  context.globalAlpha = 1;
}

/**
 * The viewport with its grid, the eye and the frame.
 * @param {CanvasRenderingContext2D} context
 * @param {StageMap} map
 * @param {Outside} outside
 * @param {{height: number, width: number}} image
 * @param {Pixel | null} pixel
 * @param {number} arrow  The length of the frame's arrows.
 */
function drawCamera(context, map, outside, image, pixel, arrow) {
  const {
    eye,
    u,
    v,
    w,
    corners: [topLeft, topRight, bottomRight, bottomLeft],
    projection,
  } = outside;
  /** A point of the viewport, by its place in the image. @param {number} row @param {number} column */
  const at = (row, column) =>
    between(
      between(topLeft, topRight, column / image.width),
      between(bottomLeft, bottomRight, column / image.width),
      row / image.height,
    );
  const ink = colour("camera");
  /** @param {Vector} a @param {Vector} b */
  const line = (a, b) => {
    const ends = map.line(a, b);
    if (!ends) return;
    context.moveTo(...ends[0]);
    context.lineTo(...ends[1]);
  };
  if ([topLeft, topRight, bottomRight, bottomLeft].every(map.isBefore)) {
    context.beginPath();
    [topLeft, topRight, bottomRight, bottomLeft].forEach((corner, index) =>
      context[index ? "lineTo" : "moveTo"](...map.project(corner)),
    );
    context.closePath();
    context.fillStyle = ink;
    context.globalAlpha = 0.16;
    context.fill();
    context.globalAlpha = 1;
  }
  context.strokeStyle = ink;
  context.globalAlpha = 0.45;
  context.lineWidth = 1;
  context.beginPath();
  const step = gridStep(image);
  for (let row = step; row < image.height; row += step) line(at(row, 0), at(row, image.width));
  for (let column = step; column < image.width; column += step) line(at(0, column), at(image.height, column));
  context.stroke();
  context.globalAlpha = 1;
  context.lineWidth = 2.2;
  context.beginPath();
  line(topLeft, topRight);
  line(topRight, bottomRight);
  line(bottomRight, bottomLeft);
  line(bottomLeft, topLeft);
  context.stroke();
  if (projection === "perspective") {
    context.globalAlpha = 0.5;
    context.lineWidth = 1;
    context.beginPath();
    for (const corner of outside.corners) line(eye, corner);
    context.stroke();
    context.globalAlpha = 1;
  }
  if (pixel) drawChosen(context, map, at, pixel, step);
  for (const [axis, letter] of /** @type {[Vector, string][]} */ ([
    [u, "u"],
    [v, "v"],
    [w, "w"],
  ]))
    drawArrow(context, map, eye, add(eye, scaled(axis, arrow)), letter, ink);
  if (map.isBefore(eye)) {
    const [x, y] = map.project(eye);
    context.beginPath();
    context.arc(x, y, 0.38 * letterSize(), 0, 2 * Math.PI);
    context.fillStyle = ink;
    context.fill();
    label(context, "eye", x - 0.7 * letterSize(), y + 1.2 * letterSize(), ink, "right");
  }
  // Above its upper edge, where no ray passes.
  const ends = [map.project(topLeft), map.project(topRight)];
  const [x, y] = ends[0][1] < ends[1][1] ? ends[0] : ends[1];
  label(context, "viewport", x, y - 0.5 * letterSize(), ink, "center");
}

/**
 * Pixels between two lines of the grid: all that the eye can still tell apart.
 * @param {{height: number, width: number}} image
 */
const gridStep = ({ height, width }) =>
  [1, 2, 4, 5, 8, 10, 16, 20, 32, 40, 64, 80, 120, 160, 240, 320].find(
    (step) => Math.max(height, width) / step <= 24,
  ) ?? 640;

/**
 * @param {CanvasRenderingContext2D} context
 * @param {StageMap} map
 * @param {(row: number, column: number) => Vector} at
 * @param {Pixel} pixel
 * @param {number} step
 */
function drawChosen(context, map, at, [row, column], step) {
  const half = Math.max(0.5, step * 0.25);
  const points = [
    [-1, -1],
    [-1, 1],
    [1, 1],
    [1, -1],
  ].map(([down, right]) => at(row + 0.5 + down * half, column + 0.5 + right * half));
  if (!points.every(map.isBefore)) return;
  context.beginPath();
  points.forEach((point, index) => context[index ? "lineTo" : "moveTo"](...map.project(point)));
  context.closePath();
  context.fillStyle = CHOSEN;
  context.strokeStyle = "#000";
  context.lineWidth = 1;
  context.fill();
  context.stroke();
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {StageMap} map
 * @param {Vector} from
 * @param {Vector} to
 * @param {string} letter
 * @param {string} ink
 */
function drawArrow(context, map, from, to, letter, ink) {
  const ends = map.line(from, to);
  if (!ends) return;
  const [[x, y], [a, b]] = ends;
  const long = Math.hypot(a - x, b - y);
  const head = Math.min(0.55 * letterSize(), long / 2);
  const angle = Math.atan2(b - y, a - x);
  context.strokeStyle = context.fillStyle = ink;
  context.lineWidth = 2.4;
  context.beginPath();
  context.moveTo(x, y);
  context.lineTo(a - head * 0.8 * Math.cos(angle), b - head * 0.8 * Math.sin(angle));
  context.stroke();
  context.beginPath();
  context.moveTo(a, b);
  for (const turn of [2.65, -2.65])
    context.lineTo(a + head * Math.cos(angle + turn), b + head * Math.sin(angle + turn));
  context.fill();
  if (long > 6)
    label(
      context,
      letter,
      a + letterSize() * 0.8 * Math.cos(angle),
      b + letterSize() * 0.8 * Math.sin(angle) + 0.3 * letterSize(),
      ink,
      "center",
      "italic 600",
    );
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {string} text
 * @param {number} x
 * @param {number} y
 * @param {string} ink
 * @param {CanvasTextAlign} align
 */
function label(context, text, x, y, ink, align, style = "400") {
  context.font = `${style} ${letterSize()}px ${colour("text")}`;
  context.textAlign = align;
  context.textBaseline = "alphabetic";
  context.lineWidth = 4;
  context.lineJoin = "round";
  context.strokeStyle = colour("mat");
  context.strokeText(text, x, y);
  context.fillStyle = ink;
  context.fillText(text, x, y);
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {StageMap} map
 * @param {DrawnRay[]} rays
 * @param {boolean} strong
 */
function drawRays(context, map, rays, strong) {
  // One ray has the colour of what is looked at; many are quiet, so that what they hit stands out.
  context.strokeStyle = colour(strong ? "focus" : "bright");
  context.fillStyle = colour("good");
  context.lineWidth = strong ? 2.6 : 1;
  for (const ray of rays) {
    const line = map.line(ray.origin, ray.end);
    if (!line) continue;
    context.globalAlpha = strong ? 1 : ray.hit || ray.moving ? 0.5 : 0.22;
    // What leaves the scene fades out.
    context.setLineDash(ray.hit || ray.moving ? [] : [5, 4]);
    context.beginPath();
    context.moveTo(...line[0]);
    context.lineTo(...line[1]);
    context.stroke();
  }
  context.setLineDash([]);
  context.globalAlpha = 1;
  for (const ray of rays) {
    if (!ray.hit || !map.isBefore(ray.end)) continue;
    context.beginPath();
    context.arc(...map.project(ray.end), strong ? 0.32 * letterSize() : 2.6, 0, 2 * Math.PI);
    context.fill();
  }
}
