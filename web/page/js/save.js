// @ts-check
// Saves what is shown as PNG: the canvases of the view side by side, on the page's ground, with their names.

/** The canvases of a view that are on the page, with their captions. */
function shownCanvases() {
  const view = document.querySelector(".view:not([hidden])");
  const canvases = /** @type {HTMLCanvasElement[]} */ ([...(view?.querySelectorAll(".mat > canvas") ?? [])]);
  return canvases.filter((canvas) => canvas.offsetParent !== null && canvas.width > 0).map((canvas) => {
    const figure = canvas.closest("figure, .half");
    const title = figure?.querySelector("figcaption b, .half-title b")?.textContent ?? "";
    return { canvas, title };
  });
}

async function saveView() {
  const shown = shownCanvases();
  if (shown.length === 0) return;
  const height = Math.max(...shown.map(({ canvas }) => canvas.height));
  const [gap, line] = [24, 44];
  const width = shown.reduce((sum, { canvas }) => sum + canvas.width + gap, gap);
  const sheet = document.createElement("canvas");
  [sheet.width, sheet.height] = [width, height + line + 3 * gap];
  const context = sheet.getContext("2d");
  if (!context) return;
  context.fillStyle = colour("ground");
  context.fillRect(0, 0, sheet.width, sheet.height);
  let x = gap;
  for (const { canvas, title } of shown) {
    context.fillStyle = colour("bright");
    context.font = `600 22px ${colour("text")}`;
    context.fillText(title, x, gap + 16);
    context.drawImage(canvas, x, gap + line - 14);
    x += canvas.width + gap;
  }
  context.fillStyle = colour("quiet");
  context.font = `400 20px ${colour("text")}`;
  context.fillText(`${chapterOf(state.chapter).title}  ·  ${state.scene}  ·  ${byId("verdict-text").textContent}`, gap, sheet.height - gap);
  sheet.toBlob((blob) => {
    if (!blob) return;
    const link = make("a", { href: URL.createObjectURL(blob), download: `${state.scene}-${state.chapter}.png` });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
    say(`${link.download} is saved`);
  }, "image/png");
}

function beginSaving() {
  byId("save").addEventListener("click", saveView);
}
