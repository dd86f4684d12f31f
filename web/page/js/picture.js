// @ts-check
// The linked pictures: every canvas with `data-picture` shows one of them, with the chosen pixel in it.

/** @typedef {"object" | "image" | "difference" | "reasons"} PictureKind */

/** The pictures in their own pixels, by kind. @type {Map<string, HTMLCanvasElement>} */
const sheets = new Map();
/** @type {Map<HTMLCanvasElement, PictureKind>} */
const pictureCanvases = new Map();

/**
 * Puts pixels into a sheet.
 * @param {string} kind
 * @param {ArrayLike<number>} rgba
 * @param {number} width
 * @param {number} height
 */
function fillSheet(kind, rgba, width, height) {
  let sheet = sheets.get(kind);
  if (!sheet) sheets.set(kind, (sheet = document.createElement("canvas")));
  paintPixels(sheet, rgba, width, height);
}

/**
 * @param {HTMLCanvasElement} canvas
 * @param {ArrayLike<number>} rgba
 * @param {number} width
 * @param {number} height
 */
function paintPixels(canvas, rgba, width, height) {
  if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
  const bytes = /** @type {Uint8ClampedArray<ArrayBuffer>} */ (
    rgba instanceof Uint8ClampedArray ? rgba : Uint8ClampedArray.from(rgba)
  );
  canvas.getContext("2d", { willReadFrequently: true })?.putImageData(new ImageData(bytes, width, height), 0, 0);
}

/**
 * Shows a sheet on a canvas of the page, with the chosen pixel.
 * @param {HTMLCanvasElement} canvas
 * @param {PictureKind} kind
 */
function showPicture(canvas, kind) {
  const sheet = sheets.get(kind);
  if (!sheet || canvas.offsetParent === null) return;
  const prepared = prepareCanvas(canvas);
  if (!prepared) return;
  const { context, width, height } = prepared;
  context.imageSmoothingEnabled = width * devicePixelRatio < 1.5 * sheet.width;
  context.imageSmoothingQuality = "low";
  context.drawImage(sheet, 0, 0, width, height);
  if (state.pixel) frameOf(context, state.pixel, width / sheet.width, height / sheet.height);
}

/**
 * A frame about one pixel, large enough to be seen on a projector.
 * @param {CanvasRenderingContext2D} context
 * @param {Pixel} pixel
 * @param {number} across  The width of a pixel.
 * @param {number} down  Its height.
 */
function frameOf(context, [row, column], across, down) {
  const least = 0.8 * letterSize();
  const [width, height] = [Math.max(across, least), Math.max(down, least)];
  const [x, y] = [(column + 0.5) * across, (row + 0.5) * down];
  drawChosenFrame(context, x - width / 2, y - height / 2, width, height);
}

function showPictures() {
  for (const [canvas, kind] of pictureCanvases) showPicture(canvas, kind);
}

/**
 * The pixel under a pointer.
 * @param {HTMLCanvasElement} canvas
 * @param {{clientX: number, clientY: number}} event
 * @returns {Pixel | null}
 */
function pixelUnder(canvas, { clientX, clientY }) {
  if (!drawn) return null;
  const box = canvas.getBoundingClientRect();
  const row = Math.floor(((clientY - box.top) / box.height) * drawn.height);
  const column = Math.floor(((clientX - box.left) / box.width) * drawn.width);
  return row >= 0 && column >= 0 && row < drawn.height && column < drawn.width ? [row, column] : null;
}

/** @param {number} id */
const seen = (id) => (id === NOTHING ? "nothing" : `id ${grouped(id)}`);

/** What both orders see at a pixel, in words. @param {Pixel} pixel */
function seenAt([row, column]) {
  if (!drawn || row >= drawn.height || column >= drawn.width) return "";
  const index = row * drawn.width + column;
  const [object, image] = [drawn.object.ids?.[index], drawn.image.ids?.[index]];
  if (object === undefined || image === undefined) return `pixel (${row}, ${column})`;
  const place = `pixel (${row}, ${column}): `;
  if (object === image) return `${place}both orders see ${seen(object)}`;
  return `${place}object order sees ${seen(object)}, image order sees ${seen(image)}`;
}

/** @param {Pixel | null} pixel */
function readOut(pixel) {
  if (!pixel) return;
  byId("readout").replaceChildren(seenAt(pixel));
}

/** @param {number} rows @param {number} columns */
function movePixel(rows, columns) {
  if (!state.camera) return;
  const { height, width } = state.camera;
  const [row, column] = state.pixel ?? [0, 0];
  change({ pixel: [clamp(row + rows, 0, height - 1), clamp(column + columns, 0, width - 1)] });
}

function beginPictures() {
  const titles = {
    object: "Object order",
    image: "Image order",
    difference: "Difference",
    reasons: "Pixels that disagree",
  };
  for (const canvas of /** @type {NodeListOf<HTMLCanvasElement>} */ (
    document.querySelectorAll("canvas[data-picture]")
  )) {
    const kind = /** @type {PictureKind} */ (canvas.dataset.picture);
    pictureCanvases.set(canvas, kind);
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "application");
    canvas.setAttribute(
      "aria-label",
      `${titles[kind]}. Arrow keys choose a pixel, with Shift they turn the camera, plus and minus move it.`,
    );
    drawWhenShown(canvas, () => showPicture(canvas, kind));
    steer(canvas);
  }
  onDrawn(() => {
    if (!drawn) return;
    const { width, height } = drawn;
    document.documentElement.style.setProperty("--aspect", String(width / height));
    fillSheet("object", drawn.object.rgba, width, height);
    fillSheet("image", drawn.image.rgba, width, height);
    fillSheet("difference", drawn.difference.rgba, width, height);
    showPictures();
    readOut(state.pixel);
  });
  watch(["pixel"], () => {
    showPictures();
    readOut(state.pixel);
    if (state.pixel) say(seenAt(state.pixel));
  });
  watch(["chapter"], () => requestAnimationFrame(showPictures));
}
