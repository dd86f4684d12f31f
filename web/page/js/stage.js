// @ts-check
// Draws the camera and the scene in 3D, seen from outside. The points come from the engine; here they are only projected.

/**
 * From where the stage is looked at. The observer's rays are parallel: what is parallel in the world is so in the picture, so that
 * one sees whether the camera's rays are, and all of the observer's side can be cut away at one plane.
 * @typedef {object} Observer3
 * @property {Vector} centre  In the middle of the canvas.
 * @property {Vector} from  Of length 1, from the centre to the observer.
 * @property {Vector} up  Of length 1.
 * @property {number} size  The length in the world that a low canvas shows from top to bottom.
 * @property {boolean} [turns]  Whether the observer moves: the picture is then made as quickly as possible.
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
  return { centre: between(eye, target, 0.5), from, up: v, size: 1.4 * size };
}

/**
 * The map from the world to the canvas.
 * @param {Observer3} observer
 * @param {number} width
 * @param {number} height
 */
function stageMap({ centre, from, up, size }, width, height) {
  const right = unit(cross(up, from));
  const above = cross(from, right);
  /** Pixels a length. */
  const scale = Math.min(width * 0.72, height) / size;
  return {
    width,
    height,
    right,
    above,
    scale,
    /** @param {ArrayLike<number>} point @returns {[number, number]} */
    project(point) {
      const offset = subtract(point, centre);
      return [width / 2 + scale * dot(offset, right), height / 2 - scale * dot(offset, above)];
    },
    /** From the centre towards the observer, in lengths of the world. @param {ArrayLike<number>} point */
    depth: (point) => dot(subtract(point, centre), from),
  };
}

/** @typedef {ReturnType<typeof stageMap>} StageMap */

/**
 * Where everything nearer to the observer is cut away: a wall before the camera would hide it. Neither the camera nor what its rays
 * hit is cut off.
 * @param {StageMap} map
 * @param {Outside} outside
 * @param {DrawnRay[]} rays
 * @param {Observer3} observer
 */
function cutOf(map, { eye, corners }, rays, { centre, size }) {
  const ends = rays.filter(({ hit }) => hit).map(({ end }) => end);
  const nearest = Math.max(...[eye, ...corners, ...ends].map(map.depth));
  return Math.max(1.3 * lengthOf(subtract(eye, centre)), nearest + 0.05 * size);
}

/**
 * The scene's surface, and its endless planes.
 * @param {Drawing3} drawing
 * @param {Outside} outside
 * @param {Observer3} observer
 */
function drawObjects(drawing, outside, observer) {
  const { context, map, surface } = drawing;
  if (surface) {
    context.imageSmoothingEnabled = true;
    context.imageSmoothingQuality = drawing.isQuick ? "low" : "high";
    context.drawImage(surface.sheet, 0, 0, map.width, map.height);
  }
  outside.planes.forEach((plane, place) => {
    // Of planes that lie in one another, the first is seen.
    if (!outside.planes.slice(0, place).some((other) => isSamePlane(plane, other))) drawPlane(drawing, plane, observer);
  });
}

/** @param {Outside["planes"][0]} one @param {Outside["planes"][0]} other */
function isSamePlane(one, other) {
  const [n, m] = [unit(one.normal), unit(other.normal)];
  const apart = subtract(one.point, other.point);
  return lengthOf(cross(n, m)) < 1e-6 && Math.abs(dot(apart, m)) <= 1e-6 * lengthOf(apart);
}

/**
 * A part of a plane, as a net of lines on glass: the whole would hide all that is behind it.
 * @param {Drawing3} drawing
 * @param {Outside["planes"][0]} plane
 * @param {Observer3} observer
 */
function drawPlane(drawing, { point, normal, colour: ink }, { centre, size }) {
  const { context } = drawing;
  const n = unit(normal);
  const foot = subtract(centre, scaled(n, dot(subtract(centre, point), n)));
  const side = unit(cross(n, Math.abs(n[0]) < 0.8 ? [1, 0, 0] : [0, 0, 1]));
  const other = cross(n, side);
  const reach = 0.7 * size;
  context.strokeStyle = `rgb(${ink.join(" ")})`;
  const corner = subtract(subtract(foot, scaled(side, reach)), scaled(other, reach));
  fillPane(drawing, corner, scaled(side, 2 * reach), scaled(other, 2 * reach), context.strokeStyle, 0.14);
  context.globalAlpha = 0.55;
  context.lineWidth = 1;
  for (let step = -6; step <= 6; step++) {
    for (const [one, two] of [
      [side, other],
      [other, side],
    ]) {
      const middle = add(foot, scaled(one, (step / 6) * reach));
      strokeLine(drawing, add(middle, scaled(two, -reach)), add(middle, scaled(two, reach)), "left out");
    }
  }
  context.globalAlpha = 1;
}

/**
 * The viewport with its grid, the eye and the frame.
 * @param {Drawing3} drawing
 * @param {Outside} outside
 * @param {{height: number, width: number}} image
 * @param {Pixel | null} pixel
 * @param {number} arrow  The length of the frame's arrows.
 */
function drawCamera(drawing, outside, image, pixel, arrow) {
  const { context, map } = drawing;
  const { eye, u, v, w } = outside;
  const ink = colour("camera");
  drawViewport(drawing, outside, image, pixel, ink);
  if (outside.projection === "perspective") {
    context.strokeStyle = ink;
    context.globalAlpha = 0.5;
    context.lineWidth = 1;
    for (const corner of outside.corners) strokeLine(drawing, eye, corner);
    context.globalAlpha = 1;
  }
  for (const [axis, letter] of /** @type {[Vector, string][]} */ ([
    [u, "u"],
    [v, "v"],
    [w, "w"],
  ]))
    drawArrow(drawing, eye, add(eye, scaled(axis, arrow)), letter, ink);
  drawDot(drawing, eye, 0.38 * letterSize(), ink);
  const [x, y] = map.project(eye);
  label(context, "eye", x - 0.7 * letterSize(), y + 1.2 * letterSize(), ink, "right");
}

/**
 * @param {Drawing3} drawing
 * @param {Outside} outside
 * @param {{height: number, width: number}} image
 * @param {Pixel | null} pixel
 * @param {string} ink
 */
function drawViewport(drawing, outside, image, pixel, ink) {
  const { context, map } = drawing;
  const [topLeft, topRight, bottomRight, bottomLeft] = outside.corners;
  /** A point of the viewport, by its place in the image. @param {number} row @param {number} column */
  const at = (row, column) =>
    between(
      between(topLeft, topRight, column / image.width),
      between(bottomLeft, bottomRight, column / image.width),
      row / image.height,
    );
  fillPane(drawing, topLeft, subtract(topRight, topLeft), subtract(bottomLeft, topLeft), ink, 0.16);
  context.strokeStyle = ink;
  context.globalAlpha = 0.45;
  context.lineWidth = 1;
  const step = gridStep(image);
  for (let row = step; row < image.height; row += step) strokeLine(drawing, at(row, 0), at(row, image.width), "left out");
  for (let column = step; column < image.width; column += step)
    strokeLine(drawing, at(0, column), at(image.height, column), "left out");
  context.globalAlpha = 1;
  context.lineWidth = 2.2;
  strokeLine(drawing, topLeft, topRight);
  strokeLine(drawing, topRight, bottomRight);
  strokeLine(drawing, bottomRight, bottomLeft);
  strokeLine(drawing, bottomLeft, topLeft);
  if (pixel) drawChosen(drawing, at, pixel, step);
  // Above its upper edge, where no ray passes.
  const ends = [map.project(topLeft), map.project(topRight)];
  const [x, y] = ends[0][1] < ends[1][1] ? ends[0] : ends[1];
  label(context, "viewport", x, y - 0.5 * letterSize(), ink, "center");
}

/**
 * A dot on a point: a ring where something lies before it.
 * @param {Drawing3} drawing
 * @param {Vector} point
 * @param {number} radius
 * @param {string} ink
 */
function drawDot(drawing, point, radius, ink) {
  const { context, map } = drawing;
  context.beginPath();
  context.arc(...map.project(point), radius, 0, 2 * Math.PI);
  context.fillStyle = context.strokeStyle = ink;
  context.lineWidth = Math.max(1, 0.3 * radius);
  if (isPointBehind(drawing, point)) context.stroke();
  else context.fill();
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
 * @param {Drawing3} drawing
 * @param {(row: number, column: number) => Vector} at
 * @param {Pixel} pixel
 * @param {number} step
 */
function drawChosen(drawing, at, [row, column], step) {
  const { context, map } = drawing;
  const half = Math.max(0.5, step * 0.25);
  const points = [
    [-1, -1],
    [-1, 1],
    [1, 1],
    [1, -1],
  ].map(([down, right]) => map.project(at(row + 0.5 + down * half, column + 0.5 + right * half)));
  context.beginPath();
  points.forEach((point, index) => context[index ? "lineTo" : "moveTo"](...point));
  context.closePath();
  context.lineWidth = 1;
  context.fillStyle = CHOSEN;
  const behind = isPointBehind(drawing, at(row + 0.5, column + 0.5));
  context.strokeStyle = behind ? CHOSEN : "#000";
  if (!behind) context.fill();
  context.stroke();
}

/**
 * @param {Drawing3} drawing
 * @param {Vector} from
 * @param {Vector} to
 * @param {string} letter
 * @param {string} ink
 */
function drawArrow(drawing, from, to, letter, ink) {
  const { context, map } = drawing;
  const [[x, y], [a, b]] = [map.project(from), map.project(to)];
  const long = Math.hypot(a - x, b - y);
  const head = Math.min(0.55 * letterSize(), long / 2);
  const angle = Math.atan2(b - y, a - x);
  context.strokeStyle = context.fillStyle = ink;
  context.lineWidth = 2.4;
  // Up to the middle of the head, which has a point.
  strokeLine(drawing, from, between(from, to, 1 - (0.8 * head) / (long || 1)));
  context.beginPath();
  context.moveTo(a, b);
  for (const turn of [2.65, -2.65])
    context.lineTo(a + head * Math.cos(angle + turn), b + head * Math.sin(angle + turn));
  context.closePath();
  context.lineWidth = 1;
  if (isPointBehind(drawing, to)) context.stroke();
  else context.fill();
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
 * @param {Drawing3} drawing
 * @param {DrawnRay[]} rays
 * @param {boolean} strong
 */
function drawRays(drawing, rays, strong) {
  const { context, map } = drawing;
  // One ray has the colour of what is looked at; many are quiet, so that what they hit stands out.
  const ink = colour(strong ? "focus" : "bright");
  for (const { origin, end, hit, moving } of rays) {
    context.lineWidth = strong ? 2.6 : 1;
    context.globalAlpha = strong ? 1 : hit || moving ? 0.5 : 0.3;
    context.strokeStyle = ink;
    if (!hit && !moving) {
      // What leaves the scene fades out.
      const fading = context.createLinearGradient(...map.project(origin), ...map.project(end));
      fading.addColorStop(0.3, ink);
      fading.addColorStop(1, "transparent");
      context.strokeStyle = fading;
    }
    strokeLine(drawing, origin, end);
  }
  context.globalAlpha = 1;
  // On a small canvas, many dots would cover what is hit.
  const radius = strong ? 0.32 * letterSize() : clamp(map.width / 280, 1.3, 2.6);
  for (const { end, hit } of rays) if (hit) drawDot(drawing, end, radius, colour("good"));
}
