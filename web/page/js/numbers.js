// @ts-check
// Numbers as the page writes them.

/**
 * The shortest decimal number that is the same 32-bit float: cameras are stored as such.
 * @param {number} number
 */
function tidy(number) {
  const stored = Math.fround(number);
  for (let digits = 1; digits < 9; digits++) {
    const shorter = Number(stored.toPrecision(digits));
    if (Math.fround(shorter) === stored) return shorter + 0;
  }
  return Number(stored.toPrecision(9)) + 0;
}

/**
 * With a comma between thousands.
 * @param {number} number
 */
const grouped = (number) => Math.round(number).toLocaleString("en");

/**
 * A number with a few digits, and a true minus sign.
 * @param {number} number
 * @param {number} [digits]
 */
function short(number, digits = 6) {
  if (!Number.isFinite(number)) return String(number);
  const rounded = Number(number.toPrecision(digits)) + 0;
  const text =
    Math.abs(rounded) !== 0 && (Math.abs(rounded) < 1e-4 || Math.abs(rounded) >= 1e9)
      ? rounded.toExponential()
      : String(rounded);
  return text.replaceAll("-", "−");
}

/**
 * A number with all its digits.
 * @param {number} number
 */
const whole = (number) => String(number + 0).replaceAll("-", "−");

/**
 * @param {ArrayLike<number>} vector
 * @param {number} [digits]
 */
const vectorText = (vector, digits = 6) => `(${Array.from(vector, (part) => short(part, digits)).join(", ")})`;

/**
 * "1 test", "2 tests".
 * @param {number} number
 * @param {string} one
 * @param {string} [more]
 */
const counted = (number, one, more = `${one}s`) => `${grouped(number)} ${number === 1 ? one : more}`;

/**
 * @param {number} value
 * @param {number} least
 * @param {number} most
 */
const clamp = (value, least, most) => Math.min(most, Math.max(least, value));

/**
 * The place of the last number that is not greater than a value; −1 if all are.
 * @param {ArrayLike<number>} ascending
 * @param {number} value
 */
function lastUpTo(ascending, value) {
  let [from, to] = [0, ascending.length];
  while (from < to) {
    const middle = (from + to) >> 1;
    if (ascending[middle] <= value) from = middle + 1;
    else to = middle;
  }
  return from - 1;
}
