// How the pictures are drawn: all panes show the same place at the same zoom.

// The scale is the number of the screen's pixels along one pixel of the picture.
const SCALES = [1 / 32, 1 / 16, 1 / 8, 1 / 4, 1 / 2, 1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 24, 32, 40, 48, 64, 96, 128];
// From this scale on, lines between the pixels are drawn.
const GRID_SCALE = 12;
// The zoom, and the place [x, y] of the picture in the middle of all panes.
const view = { name: "slider", scale: 1, x: width / 2, y: height / 2, fits: true };
const shown = { divider: 50, side: 0, marks: false, cursor: null };
const pictures = { a: null, b: null, base: null };
// For each pixel, 1 + the number of the first ticked group that it is in, or 0.
const marked = new Uint16Array(width * height);

const panes = [...document.querySelectorAll(".pane")].map((figure) => {
  const canvas = figure.querySelector("canvas");
  return { name: figure.dataset.pane, figure, canvas, context: canvas.getContext("2d") };
});
const visiblePanes = () => panes.filter(({ canvas }) => canvas.clientWidth > 0);

async function readPictures() {
  for (const name of Object.keys(pictures)) {
    const image = byId(`picture-${name}`);
    if (!image.complete) await new Promise((done) => ["load", "error"].forEach((event) => image.addEventListener(event, done)));
    // Of very large pictures some browsers make no bitmap, and still draw them.
    pictures[name] = await createImageBitmap(image).catch(() => image);
  }
}

function markGroups() {
  marked.fill(0);
  for (let number = groups.length - 1; number >= 0; number--) {
    if (!groups[number].shown) continue;
    for (const pixel of groups[number].pixels) marked[pixel] = number + 1;
  }
}

// Opaque colours as the numbers of ImageData; the machines that browsers run on are little-endian.
const palette = groups.map(({ color: [red, green, blue] }) => (0xff000000 | (blue << 16) | (green << 8) | red) >>> 0);

// Where the picture lies in a pane: the place of its corner, and the pixels that are seen of it.
function layout({ canvas }) {
  const left = Math.round(canvas.width / 2 - view.x * view.scale);
  const top = Math.round(canvas.height / 2 - view.y * view.scale);
  const first = (offset) => Math.max(0, Math.floor(-offset / view.scale));
  const end = (offset, room, side) => Math.max(0, Math.min(side, Math.ceil((room - offset) / view.scale)));
  return {
    left,
    top,
    columns: [first(left), end(left, canvas.width, width)],
    rows: [first(top), end(top, canvas.height, height)],
  };
}

// Draws a part of a picture, or of a drawing of the pixels that are seen.
function place(context, image, from, { left, top, columns, rows }) {
  const [across, down] = [columns[1] - columns[0], rows[1] - rows[0]];
  if (across <= 0 || down <= 0) return;
  context.imageSmoothingEnabled = view.scale < 1;
  context.imageSmoothingQuality = "high";
  const [x, y] = [left + columns[0] * view.scale, top + rows[0] * view.scale];
  context.drawImage(image, from[0], from[1], across, down, x, y, across * view.scale, down * view.scale);
}

function drawPicture(pane, name, at, clip = null) {
  const { context, canvas } = pane;
  if (!pictures[name]) return;
  context.save();
  if (clip) {
    context.beginPath();
    context.rect(clip[0] * canvas.width, 0, (clip[1] - clip[0]) * canvas.width, canvas.height);
    context.clip();
  }
  place(context, pictures[name], [at.columns[0], at.rows[0]], at);
  context.restore();
}

const scratch = document.createElement("canvas");

// Fills the scratch canvas with the marked pixels, by a function that writes into its numbers.
function scratched(across, down, fill) {
  scratch.width = across;
  scratch.height = down;
  const context = scratch.getContext("2d");
  const image = context.createImageData(across, down);
  fill(new Uint32Array(image.data.buffer));
  context.putImageData(image, 0, 0);
  return scratch;
}

// Draws the marked pixels in the colours of their groups.
function drawMarks(pane, at) {
  const [across, down] = [at.columns[1] - at.columns[0], at.rows[1] - at.rows[0]];
  if (across <= 0 || down <= 0) return;
  if (view.scale < 1) return drawDots(pane, at);
  const pixels = scratched(across, down, (colors) => {
    for (let row = 0, to = 0; row < down; row++) {
      let from = (at.rows[0] + row) * width + at.columns[0];
      for (let column = 0; column < across; column++, from++, to++) {
        if (marked[from]) colors[to] = palette[marked[from] - 1];
      }
    }
  });
  place(pane.context, pixels, [0, 0], at);
}

// Where several pixels share one of the screen, the marked ones are drawn as dots of a visible size.
function drawDots({ canvas, context }, at) {
  const size = Math.ceil(1.5 * devicePixelRatio);
  const [across, down] = [canvas.width, canvas.height];
  // Of several groups in one place, the first is seen.
  const owners = new Uint16Array(across * down);
  const dots = scratched(across, down, (colors) => {
    for (let row = at.rows[0]; row < at.rows[1]; row++) {
      const top = Math.floor(at.top + row * view.scale);
      for (let column = at.columns[0], from = row * width + column; column < at.columns[1]; column++, from++) {
        if (!marked[from]) continue;
        const left = Math.floor(at.left + column * view.scale);
        for (let y = Math.max(0, top); y < Math.min(down, top + size); y++) {
          for (let x = Math.max(0, left), to = y * across + x; x < Math.min(across, left + size); x++, to++) {
            if (owners[to] && owners[to] <= marked[from]) continue;
            owners[to] = marked[from];
            colors[to] = palette[marked[from] - 1];
          }
        }
      }
    }
  });
  context.drawImage(dots, 0, 0);
}

function drawGrid({ canvas, context }, at) {
  if (view.scale < GRID_SCALE) return;
  context.fillStyle = "rgb(128 128 128 / 45%)";
  const [bottom, right] = [at.top + at.rows[1] * view.scale, at.left + at.columns[1] * view.scale];
  const [top, left] = [at.top + at.rows[0] * view.scale, at.left + at.columns[0] * view.scale];
  for (let y = top; y <= bottom; y += view.scale) context.fillRect(left, y, Math.min(right, canvas.width) - left, 1);
  for (let x = left; x <= right; x += view.scale) context.fillRect(x, top, 1, Math.min(bottom, canvas.height) - top);
}

// A frame around the pixel that the read-out is about.
function drawCursor({ context }, at) {
  if (!shown.cursor) return;
  const [row, column] = shown.cursor;
  const least = 9 * devicePixelRatio;
  const side = Math.max(view.scale, least);
  const x = at.left + (column + 0.5) * view.scale - side / 2;
  const y = at.top + (row + 0.5) * view.scale - side / 2;
  const line = Math.max(1, Math.round(1.5 * devicePixelRatio));
  for (const [color, out] of [["#000", 2.5], ["#fff", 1.25]]) {
    context.strokeStyle = color;
    context.lineWidth = color === "#000" ? 2.6 * line : line;
    const grown = side + 2 * out * line;
    context.strokeRect(x - out * line, y - out * line, grown, grown);
  }
}

function drawPane(pane) {
  const { canvas, context, name } = pane;
  context.clearRect(0, 0, canvas.width, canvas.height);
  const at = layout(pane);
  if (name === "main" && view.name === "slider") {
    drawPicture(pane, "a", at, [0, shown.divider / 100]);
    drawPicture(pane, "b", at, [shown.divider / 100, 1]);
  } else {
    drawPicture(pane, { main: "ab"[shown.side], difference: "base" }[name] ?? name, at);
  }
  if (name === "difference" || shown.marks) drawMarks(pane, at);
  drawGrid(pane, at);
  drawCursor(pane, at);
  // A picture that is wholly seen leaves the finger to the page.
  canvas.style.touchAction = view.fits ? "pan-y" : "none";
}

let isDue = false;

// Draws all panes, once, before the screen shows anything again.
function draw() {
  if (isDue) return;
  isDue = true;
  requestAnimationFrame(() => {
    isDue = false;
    visiblePanes().forEach(drawPane);
  });
}

// The scale at which the whole picture is seen in every pane; a small one grows by a whole factor.
function fittingScale() {
  const fits = visiblePanes().map(({ canvas }) => Math.min(canvas.width / width, canvas.height / height));
  const scale = Math.min(SCALES.at(-1), ...fits);
  return scale >= 1 ? Math.floor(scale) : scale;
}

function scaleText() {
  const { scale } = view;
  if (scale >= 1) return `${scale}×`;
  return `${Number((100 * scale).toPrecision(2))} %`;
}

function fit() {
  Object.assign(view, { scale: fittingScale(), x: width / 2, y: height / 2, fits: true });
  showZoom();
}

function showZoom() {
  byId("zoom").textContent = scaleText();
  byId("zoom-in").disabled = view.scale >= SCALES.at(-1);
  byId("zoom-out").disabled = view.scale <= Math.min(SCALES[0], fittingScale());
  draw();
}

// Zooms by steps, and keeps the place [x, y] of the picture where it is on the screen.
function zoomBy(steps, [x, y] = [view.x, view.y]) {
  const larger = (scale) => SCALES.find((other) => other > scale * 1.0001) ?? scale;
  const smaller = (scale) => SCALES.findLast((other) => other < scale * 0.9999) ?? scale;
  let scale = view.scale;
  for (let step = 0; step < Math.abs(steps); step++) scale = steps > 0 ? larger(scale) : smaller(scale);
  zoomTo(scale, [x, y]);
}

function zoomTo(scale, [x, y]) {
  const factor = view.scale / scale;
  view.fits = false;
  view.scale = scale;
  moveTo(x + (view.x - x) * factor, y + (view.y - y) * factor);
  showZoom();
}

// Moves the middle of all panes to a place of the picture.
function moveTo(x, y) {
  view.x = Math.min(Math.max(x, 0), width);
  view.y = Math.min(Math.max(y, 0), height);
  draw();
}

// The place of the picture, in pixels, under a place of the window.
function placeAt(pane, event) {
  const box = pane.canvas.getBoundingClientRect();
  const at = layout(pane);
  return [
    ((event.clientX - box.left) * (pane.canvas.width / box.width) - at.left) / view.scale,
    ((event.clientY - box.top) * (pane.canvas.height / box.height) - at.top) / view.scale,
  ];
}

// The pixel [row, column] there, or null.
function pixelAt(pane, event) {
  const [x, y] = placeAt(pane, event);
  return x >= 0 && y >= 0 && x < width && y < height ? [Math.floor(y), Math.floor(x)] : null;
}

// As many columns of panes as give the largest pictures.
function arrange() {
  const [box, count] = [document.querySelector(".panes"), visiblePanes().length];
  const caption = 2 * parseFloat(getComputedStyle(box).fontSize);
  let [best, most] = [1, 0];
  for (let columns = 1; columns <= count; columns++) {
    const rows = Math.ceil(count / columns);
    const scale = Math.min(box.clientWidth / columns / width, (box.clientHeight / rows - caption) / height);
    if (scale > most) [best, most] = [columns, scale];
  }
  box.style.setProperty("--columns", best);
}

// Keeps the pixels of canvases those of the screen.
function resize() {
  arrange();
  for (const { canvas } of visiblePanes()) {
    const [across, down] = [canvas.clientWidth, canvas.clientHeight].map((side) => Math.round(side * devicePixelRatio));
    if (canvas.width !== across) canvas.width = across;
    if (canvas.height !== down) canvas.height = down;
  }
  if (view.fits) fit();
  else draw();
}

