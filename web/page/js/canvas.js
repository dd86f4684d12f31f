// @ts-check
// Canvases in the pixels of the screen.

/**
 * The canvas's context in CSS pixels, sized to the screen, and its width and height; `null` while it is not shown.
 * @param {HTMLCanvasElement} canvas
 * @returns {{context: CanvasRenderingContext2D, width: number, height: number} | null}
 */
function prepareCanvas(canvas) {
  const { clientWidth: width, clientHeight: height } = canvas;
  const context = canvas.getContext("2d");
  if (!context || width === 0 || height === 0) return null;
  const density = devicePixelRatio || 1;
  const [columns, rows] = [Math.round(width * density), Math.round(height * density)];
  if (canvas.width !== columns || canvas.height !== rows) [canvas.width, canvas.height] = [columns, rows];
  context.setTransform(density, 0, 0, density, 0, 0);
  context.clearRect(0, 0, width, height);
  return { context, width, height };
}

/** The size of the page's letters, for what is drawn. */
const letterSize = () => parseFloat(getComputedStyle(document.documentElement).fontSize);

/** Tells the style sheets how high the bars above and below are. */
function measureBars() {
  const bars = /** @type {[string, HTMLElement][]} */ ([
    ["--head", /** @type {HTMLElement} */ (document.querySelector(".bar"))],
    ["--foot", byId("verdict")],
  ]);
  const observer = new ResizeObserver(() =>
    bars.forEach(([property, bar]) => document.documentElement.style.setProperty(property, `${bar.offsetHeight}px`)),
  );
  bars.forEach(([, bar]) => observer.observe(bar));
}

/** @type {Map<Element, () => void>} */
const redraws = new Map();
const resizes = new ResizeObserver((entries) => {
  for (const { target } of entries) redraws.get(target)?.();
});

/**
 * Draws whenever the canvas gets another size, and when the theme changes.
 * @param {HTMLCanvasElement} canvas
 * @param {() => void} draw
 */
function drawWhenShown(canvas, draw) {
  redraws.set(canvas, draw);
  resizes.observe(canvas);
  document.addEventListener("themechange", draw);
}

/**
 * The lines between the cells of a grid that begins at the top left, in the ink that is set.
 * @param {CanvasRenderingContext2D} context
 * @param {number} rows
 * @param {number} columns
 * @param {number} cell  The side of a cell.
 */
function drawGrid(context, rows, columns, cell) {
  context.lineWidth = 1;
  context.beginPath();
  for (let line = 0; line <= columns; line++) {
    context.moveTo(line * cell, 0);
    context.lineTo(line * cell, rows * cell);
  }
  for (let line = 0; line <= rows; line++) {
    context.moveTo(0, line * cell);
    context.lineTo(columns * cell, line * cell);
  }
  context.stroke();
}

/** The colour of what is chosen in a picture, in both themes: it stands on pictures, and has a black edge. */
const CHOSEN = "#f0e442";

/**
 * A frame about what is chosen.
 * @param {CanvasRenderingContext2D} context
 * @param {number} x
 * @param {number} y
 * @param {number} width
 * @param {number} height
 */
function drawChosenFrame(context, x, y, width, height) {
  for (const [line, ink] of /** @type {const} */ ([
    [5, "#000c"],
    [2.5, CHOSEN],
  ])) {
    context.strokeStyle = ink;
    context.lineWidth = line;
    context.strokeRect(x, y, width, height);
  }
}

/**
 * A disc for object order, a square for image order: those who cannot tell the colours apart see the form.
 * @param {CanvasRenderingContext2D} context
 * @param {OrderName} order
 * @param {number} x
 * @param {number} y
 * @param {number} radius
 */
function drawMark(context, order, x, y, radius) {
  context.beginPath();
  if (order === "object") context.arc(x, y, radius, 0, 2 * Math.PI);
  else context.rect(x - 0.9 * radius, y - 0.9 * radius, 1.8 * radius, 1.8 * radius);
  context.fill();
}
