// @ts-check
// Short ways to elements of the page.

/**
 * The element with an id.
 * @template {Element} [T=HTMLElement]
 * @param {string} id
 * @returns {T}
 */
function byId(id) {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no element #${id}`);
  return /** @type {T} */ (/** @type {unknown} */ (found));
}

/** @param {string} id */
const inputById = (id) => /** @type {HTMLInputElement} */ (byId(id));
/** @param {string} id */
const selectById = (id) => /** @type {HTMLSelectElement} */ (byId(id));
/** @param {string} id */
const canvasById = (id) => /** @type {HTMLCanvasElement} */ (byId(id));
/** @param {string} id */
const buttonById = (id) => /** @type {HTMLButtonElement} */ (byId(id));

/**
 * Makes an element; texts among its children become text, never markup.
 * @template {keyof HTMLElementTagNameMap} K
 * @param {K} tag
 * @param {Record<string, string | number | boolean>} [attributes]  `class` and all others; `true` is an empty attribute.
 * @param {...(Node | string | number | null)} children
 * @returns {HTMLElementTagNameMap[K]}
 */
function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (value !== false) element.setAttribute(key, value === true ? "" : String(value));
  }
  element.append(
    ...children.filter((child) => child !== null).map((child) => (child instanceof Node ? child : String(child))),
  );
  return element;
}

/**
 * A text with its signs: `*d*` is a vector, in bold as the lecture writes it, and `_ab_` stands below the line.
 * @param {string} text
 * @returns {(Node | string)[]}
 */
const rich = (text) =>
  text.split(/(\*[^*]+\*|_[^_]+_)/).map((part) => {
    if (/^\*.+\*$/.test(part)) return make("b", { class: "vector" }, part.slice(1, -1));
    return /^_.+_$/.test(part) ? make("sub", {}, part.slice(1, -1)) : part;
  });

/**
 * Makes an element of SVG.
 * @param {string} tag
 * @param {Record<string, string | number>} attributes
 * @param {...(Node | string)} children
 */
function makeSvg(tag, attributes, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, String(value));
  element.append(...children);
  return element;
}

/**
 * The radio buttons of a name tell of every choice.
 * @param {string} name
 * @param {(value: string) => void} listener
 */
function onChoice(name, listener) {
  for (const input of document.querySelectorAll(`input[name="${name}"]`)) {
    input.addEventListener("change", () => listener(/** @type {HTMLInputElement} */ (input).value));
  }
}

/**
 * @param {string} name
 * @param {string} value
 */
function setChoice(name, value) {
  for (const input of document.querySelectorAll(`input[name="${name}"]`)) {
    /** @type {HTMLInputElement} */ (input).checked = /** @type {HTMLInputElement} */ (input).value === value;
  }
}

/** Whether the system asks for less motion. */
const lessMotion = matchMedia("(prefers-reduced-motion: reduce)");

/**
 * Calls a function once things have been quiet for a while.
 * @param {number} milliseconds
 * @param {() => void} call
 */
function debounced(milliseconds, call) {
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  return () => {
    clearTimeout(timer);
    timer = setTimeout(call, milliseconds);
  };
}

/**
 * Calls at once, and then at most once in so many milliseconds. The last call is never lost, only late: it is made when no
 * other one has come for that long, so that between the frames of a dragged picture nothing else is drawn.
 * @param {number} milliseconds
 * @param {() => void} call
 */
function seldom(milliseconds, call) {
  let due = 0;
  const now = () => {
    due = performance.now() + milliseconds;
    call();
  };
  const later = debounced(milliseconds, () => performance.now() >= due && now());
  return () => {
    if (performance.now() >= due) now();
    else later();
  };
}
