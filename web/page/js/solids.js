// @ts-check
// Draws triangles and spheres of the stage from far to near. Meshes have thousands of triangles, so those of about one
// depth and one colour become one path.

/** Parts of the depth within which triangles may be drawn in any order. */
const DEPTHS = 160;
/** Steps of light. */
const LIGHTS = 20;

/**
 * @param {CanvasRenderingContext2D} context
 * @param {StageMap} map
 * @param {Outside} outside
 * @param {Observer3} observer
 */
function drawSolids(context, map, outside, observer) {
  const { triangles, colours, spheres } = outside;
  const count = triangles.length / 9;
  const corners = new Float64Array(6 * count);
  const depths = new Float64Array(count);
  const cut = 1.3 * lengthOf(subtract(outside.eye, observer.centre));
  for (let place = 0; place < count; place++) {
    let sum = 0;
    for (let corner = 0; corner < 3; corner++) {
      const depth = map.place(triangles, 9 * place + 3 * corner, corners, 6 * place + 2 * corner);
      sum += depth / 3;
    }
    // A wall between the observer and the camera would hide both.
    depths[place] = sum > cut ? NaN : sum;
  }
  const balls = spheres
    .filter(({ center }) => map.isBefore(center))
    .map((sphere) => ({ sphere, depth: map.depth(sphere.center) }));
  const [far, near] = depthsOf(depths, balls);
  const part = (/** @type {number} */ depth) => Math.floor(((depth - far) / (near - far || 1)) * (DEPTHS - 1));
  const layers = Array.from({ length: DEPTHS }, () => /** @type {Map<string, number[]>} */ (new Map()));
  const light = unit(add(observer.from, scaled(observer.up, 0.6)));
  for (let place = 0; place < count; place++) {
    // What reaches behind the observer has no depth, and is not drawn.
    if (Number.isNaN(depths[place])) continue;
    const ink = inkOf(triangles, colours, place, light);
    const layer = layers[part(depths[place])];
    const same = layer.get(ink);
    if (same) same.push(place);
    else layer.set(ink, [place]);
  }
  context.lineWidth = 0.6;
  layers.forEach((layer, number) => {
    for (const [ink, places] of layer) fillTriangles(context, corners, places, ink, !observer.turns);
    for (const { sphere, depth } of balls) if (part(depth) === number) drawSphere(context, map, sphere);
  });
}

/**
 * @param {Float64Array} depths
 * @param {{depth: number}[]} balls
 * @returns {[number, number]} The farthest and the nearest.
 */
function depthsOf(depths, balls) {
  let [far, near] = [Infinity, -Infinity];
  const take = (/** @type {number} */ depth) => {
    if (depth < far) far = depth;
    if (depth > near) near = depth;
  };
  depths.forEach(take);
  balls.forEach(({ depth }) => take(depth));
  return [far, near];
}

/**
 * The colour of a triangle in the light, in few steps, so that many have the same.
 * @param {Float32Array} triangles
 * @param {ArrayLike<number>} colours
 * @param {number} place
 * @param {Vector} light
 */
function inkOf(triangles, colours, place, light) {
  const at = 9 * place;
  const [ax, ay, az] = [
    triangles[at + 3] - triangles[at],
    triangles[at + 4] - triangles[at + 1],
    triangles[at + 5] - triangles[at + 2],
  ];
  const [bx, by, bz] = [
    triangles[at + 6] - triangles[at],
    triangles[at + 7] - triangles[at + 1],
    triangles[at + 8] - triangles[at + 2],
  ];
  const normal = unit([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx]);
  const lit = 0.45 + (0.55 * Math.round(LIGHTS * Math.abs(dot(normal, light)))) / LIGHTS;
  const channel = (/** @type {number} */ index) => Math.round(colours[3 * place + index] * lit);
  return `rgb(${channel(0)} ${channel(1)} ${channel(2)})`;
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {Float64Array} corners  Six numbers a triangle, on the canvas.
 * @param {number[]} places
 * @param {string} ink
 * @param {boolean} closes  Whether the ground is kept from shining through between neighbours.
 */
function fillTriangles(context, corners, places, ink, closes) {
  context.beginPath();
  for (const place of places) {
    const at = 6 * place;
    context.moveTo(corners[at], corners[at + 1]);
    context.lineTo(corners[at + 2], corners[at + 3]);
    context.lineTo(corners[at + 4], corners[at + 5]);
    context.closePath();
  }
  context.fillStyle = context.strokeStyle = ink;
  context.fill();
  if (closes) context.stroke();
}
