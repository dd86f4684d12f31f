// @ts-check
// Saves what is shown as PNG: the chapter with its pictures, numbers and words, as it stands on the page.

/** Where an element is left out of the picture: controls say nothing there. */
const NOT_SAVED =
  ".camera, .transport, #chapter-scene, #count-offer, .loop-choices, #pixel-form, .unseen, dialog, [hidden]";

/**
 * A copy of the chapter that needs nothing but itself: canvases have become images.
 * @param {HTMLElement} original
 */
function standAlone(original) {
  const copy = /** @type {HTMLElement} */ (original.cloneNode(true));
  const canvases = original.querySelectorAll("canvas");
  copy.querySelectorAll("canvas").forEach((canvas, index) => {
    const source = canvases[index];
    const image = make("img", { alt: "" });
    if (source.offsetParent !== null && source.width > 0) image.src = source.toDataURL();
    image.style.cssText = `display: block; width: ${source.clientWidth}px; height: ${source.clientHeight}px`;
    canvas.replaceWith(image);
  });
  const fields = original.querySelectorAll("input, select");
  copy.querySelectorAll("input, select").forEach((field, index) => {
    const source = /** @type {HTMLInputElement | HTMLSelectElement} */ (fields[index]);
    if (field instanceof HTMLInputElement && source instanceof HTMLInputElement) {
      field.setAttribute("value", source.value);
      field.toggleAttribute("checked", source.checked);
    } else if (field instanceof HTMLSelectElement)
      [...field.options].forEach((option) => option.toggleAttribute("selected", option.value === source.value));
  });
  copy.querySelectorAll(`${NOT_SAVED}, .still, noscript`).forEach((element) => element.remove());
  return copy;
}

/** The page's style as text. */
const styleText = () => [...document.querySelectorAll("style")].map((style) => style.textContent ?? "").join("\n");

/**
 * The chapter as an image. Browsers draw HTML only within SVG.
 * @returns {Promise<HTMLCanvasElement>}
 */
async function chapterAsPicture() {
  const main = byId("main");
  const verdict = byId("verdict");
  const width = main.clientWidth;
  const root = document.createElement("div");
  root.setAttribute("xmlns", "http://www.w3.org/1999/xhtml");
  const copy = standAlone(main);
  copy.style.border = "0";
  const foot = /** @type {HTMLElement} */ (verdict.cloneNode(true));
  foot.style.position = "static";
  root.append(copy, foot);
  // Its height is known once it is laid out.
  const probe = make("div", { "aria-hidden": "true", inert: true });
  probe.style.cssText = `position: absolute; visibility: hidden; left: 0; top: 0; width: ${width}px`;
  probe.append(root.cloneNode(true));
  document.body.append(probe);
  const height = Math.ceil(probe.getBoundingClientRect().height);
  probe.remove();
  const { theme } = document.documentElement.dataset;
  const size = letterSize();
  const style = `${styleText().replaceAll(':root[data-theme="dark"]', '.page-root[data-theme="dark"]').replaceAll(":root", ".page-root").replaceAll("rem", "em")}
    .page-root { background: var(--ground); color: var(--bright); font: 400 ${size}px/1.45 var(--text); }`;
  root.className = "page-root";
  if (theme) root.dataset.theme = theme;
  root.prepend(make("style", {}, style));
  const body = new XMLSerializer().serializeToString(root);
  const svg = `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}"><foreignObject width="100%" height="100%">${body}</foreignObject></svg>`;
  const image = new Image();
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`;
  await image.decode();
  const sheet = document.createElement("canvas");
  const scale = Math.max(devicePixelRatio, Math.min(2, 3840 / width));
  [sheet.width, sheet.height] = [Math.round(width * scale), Math.round(height * scale)];
  const context = sheet.getContext("2d");
  context?.scale(scale, scale);
  context?.drawImage(image, 0, 0);
  return sheet;
}

/** The canvases of the view side by side, for browsers that do not let a page read what it draws of HTML. */
function canvasesAlone() {
  const shown = [
    .../** @type {NodeListOf<HTMLCanvasElement>} */ (document.querySelectorAll(".view:not([hidden]) .mat > canvas")),
  ].filter((canvas) => canvas.offsetParent !== null && canvas.width > 0);
  const gap = 24;
  const sheet = document.createElement("canvas");
  sheet.width = shown.reduce((sum, canvas) => sum + canvas.width + gap, gap);
  sheet.height = Math.max(0, ...shown.map((canvas) => canvas.height)) + 2 * gap;
  const context = sheet.getContext("2d");
  if (!context) return sheet;
  context.fillStyle = colour("ground");
  context.fillRect(0, 0, sheet.width, sheet.height);
  let x = gap;
  for (const canvas of shown) {
    context.drawImage(canvas, x, gap);
    x += canvas.width + gap;
  }
  return sheet;
}

/** @param {HTMLCanvasElement} sheet @returns {Promise<Blob | null>} */
const asPng = (sheet) => new Promise((resolve) => sheet.toBlob(resolve, "image/png"));

async function saveView() {
  /** @type {Blob | null} */
  let blob = null;
  try {
    blob = await asPng(await chapterAsPicture());
  } catch {
    blob = await asPng(canvasesAlone());
  }
  if (!blob) return;
  const address = URL.createObjectURL(blob);
  const link = make("a", { href: address, download: `${state.scene.replace(/\.[a-z]+$/i, "")}-${state.chapter}.png` });
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
  say(`${link.download} is saved`);
}

function beginSaving() {
  byId("save").addEventListener("click", saveView);
}
