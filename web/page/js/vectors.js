// @ts-check
// Vectors of three numbers, for turning cameras by hand and for drawing the view from outside. What a pixel sees is never
// computed here: that is the engine's.

/**
 * @param {ArrayLike<number>} a
 * @param {ArrayLike<number>} b
 * @returns {Vector}
 */
const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
/**
 * @param {ArrayLike<number>} a
 * @param {ArrayLike<number>} b
 * @returns {Vector}
 */
const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
/**
 * @param {ArrayLike<number>} a
 * @param {number} by
 * @returns {Vector}
 */
const scaled = (a, by) => [a[0] * by, a[1] * by, a[2] * by];
/** @param {ArrayLike<number>} a @param {ArrayLike<number>} b */
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
/**
 * @param {ArrayLike<number>} a
 * @param {ArrayLike<number>} b
 * @returns {Vector}
 */
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
/** @param {ArrayLike<number>} a */
const lengthOf = (a) => Math.hypot(a[0], a[1], a[2]);
/** @param {ArrayLike<number>} a @returns {Vector} */
const unit = (a) => scaled(a, 1 / (lengthOf(a) || 1));
/**
 * @param {ArrayLike<number>} a
 * @param {ArrayLike<number>} b
 * @param {number} part
 * @returns {Vector}
 */
const between = (a, b, part) => add(a, scaled(subtract(b, a), part));

/**
 * Turns a vector about an axis of length 1 (the formula of Rodrigues).
 * @param {ArrayLike<number>} vector
 * @param {ArrayLike<number>} axis
 * @param {number} angle  In radians.
 * @returns {Vector}
 */
function turned(vector, axis, angle) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return add(add(scaled(vector, c), scaled(cross(axis, vector), s)), scaled(axis, dot(axis, vector) * (1 - c)));
}
