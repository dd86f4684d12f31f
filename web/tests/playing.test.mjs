// What students play with: a vertex to drag, hints, rules to break, sliders, numbers of the camera, and pictures to save.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, test } from "node:test";
import { CHAPTERS, engineIn, open, stop, text, until } from "./browser.mjs";

after(stop);

const [EDGE_ROWS, EDGE_COLUMNS] = [12, 16];

/** On which side of an edge a point lies; a point on it is moved infinitely little to the right, and far less down. */
function side([ax, ay], [bx, by], [x, y]) {
  // All are quarters: nothing is rounded.
  return (bx - ax) * (y - ay) - (by - ay) * (x - ax) || -(by - ay) || bx - ax;
}

/** Whether a triangle owns a sample. */
function owns([a, b, c], point) {
  const sides = [side(a, b, point), side(b, c, point), side(c, a, point)];
  return sides.every((one) => one > 0) || sides.every((one) => one < 0);
}

/** How many samples the first triangle owns alone, the second alone, both, and neither. */
function owners([a, b, c, d]) {
  const counts = [0, 0, 0, 0];
  for (let row = 0; row < EDGE_ROWS; row++) {
    for (let column = 0; column < EDGE_COLUMNS; column++) {
      const point = [column + 0.5, row + 0.5];
      const [first, second] = [owns([a, b, c], point), owns([a, c, d], point)];
      counts[first && second ? 2 : first ? 0 : second ? 1 : 3]++;
    }
  }
  return counts;
}

/** The numbers of a table, row by row. */
const numbers = (page, table) =>
  page
    .locator(`${table} tbody tr`)
    .evaluateAll((rows) => rows.map((row) => [...row.querySelectorAll("td")].map((cell) => Number(cell.textContent.replace(/\D/g, "")))));

test("a dragged vertex leaves every sample of a shared edge one owner", async () => {
  const { page, said, close } = await open({ hash: "#chapter=coverage" });
  const corners = [
    [3.5, 2.5],
    [13.5, 1.5],
    [12.5, 10.5],
    [2.5, 9.5],
  ];
  const box = await page.locator("#own").boundingBox();
  const scale = box.width / EDGE_COLUMNS;
  const at = ([x, y]) => [box.x + x * scale, box.y + y * scale];
  const agrees = async (what) => {
    const expected = owners(corners);
    await until(what, async () => String((await numbers(page, "#owners")).flat()) === String(expected));
    assert.equal(expected[2], 0, what);
  };
  await agrees("the first picture");
  const changes = new Set([String(owners(corners))]);
  // Onto samples, beside them, along rows, columns and a diagonal; none folds one triangle over the other.
  for (const [vertex, ...places] of [
    [2, [11.5, 8.5], [9.5, 8.5], [12.25, 9.75]],
    [0, [4.5, 3.5], [3.5, 1.25], [5.5, 2.5]],
    [1, [13.5, 3.5], [14.75, 2.5]],
    [3, [1.5, 8.5], [3.5, 10.5]],
  ]) {
    await page.mouse.move(...at(corners[vertex]));
    await page.mouse.down();
    for (const place of places) {
      await page.mouse.move(...at(place), { steps: 4 });
      corners[vertex] = place;
      await agrees(`vertex ${vertex + 1} at ${place}`);
      assert.match(await text(page, "#owners-verdict"), /^No sample belongs to both/);
      changes.add(String(owners(corners)));
    }
    await page.mouse.up();
  }
  assert.ok(changes.size > 5, "the owners change");
  assert.deepEqual(said.console, []);
  await close();
});

test("hints come one by one, to the last", async () => {
  const { page, close } = await open();
  const engine = await engineIn(page);
  for (const kind of ["ray", "plane", "eye", "viewport", "distance", "frame"]) {
    await page.evaluate((hash) => (location.hash = hash), `#chapter=problems&question=${kind}&seed=7`);
    const { title, hints } = await engine.ask("question", { kind, seed: 7 });
    await until("the question", async () => (await text(page, "#question-text")).includes(title));
    await until("no hints yet", async () => (await page.locator("#question-hints li").count()) === 0);
    const button = page.locator("#question-hint");
    await until("hints", () => button.isEnabled());
    let given = 0;
    while (await button.isEnabled()) {
      await button.click();
      given++;
      assert.equal(await page.locator("#question-hints li").count(), given, kind);
      assert.ok((await page.locator("#question-hints li").last().innerText()).length > 10, kind);
    }
    assert.deepEqual(await page.locator("#question-hints li").allInnerTexts(), hints, kind);
    assert.ok(given >= 2, `${kind}: ${given} hints`);
  }
  await close();
});

test("a pixel that a rule gets wrong says why when it is touched", async () => {
  const { page, close } = await open({ hash: "#chapter=break&scene=ties" });
  await page.locator("#object-rule").selectOption("corner");
  await until("reasons", async () => (await page.locator("#reasons .swatch").count()) > 0);
  const canvas = page.locator("canvas[data-picture=reasons]");
  // A pixel in the colour of the first reason.
  const place = await canvas.evaluate((element) => {
    const { width, height } = element;
    const { data } = element.getContext("2d").getImageData(0, 0, width, height);
    const ink = getComputedStyle(document.querySelector("#reasons .swatch")).backgroundColor.match(/\d+/g).map(Number);
    for (let index = 0; index < width * height; index++)
      if (ink.every((part, channel) => Math.abs(part - data[4 * index + channel]) < 3))
        return [((index % width) + 0.5) / width, (Math.floor(index / width) + 0.5) / height];
    return null;
  });
  assert.ok(place, "a pixel has the colour of the reason");
  const box = await canvas.boundingBox();
  await page.mouse.click(box.x + place[0] * box.width, box.y + place[1] * box.height);
  await until("the sentence", async () => /Object order is wrong here/.test(await text(page, "#reason-text")));
  await page.locator("#object-rule").selectOption("");
  await until("no reasons", async () => (await page.locator("#reasons .swatch").count()) === 0);
  await close();
});

test("sliders choose what the costs are counted for", async () => {
  const { page, close } = await open({ hash: "#chapter=cost" });
  const slide = (id, value) =>
    page.locator(id).evaluate((slider, value) => {
      slider.value = value;
      slider.dispatchEvent(new Event("input", { bubbles: true }));
    }, value);
  for (const [triangles, pixels, image] of [
    ["1", "1", [40, 30]],
    ["5", "0", [20, 15]],
    ["3", "2", [80, 60]],
  ]) {
    await slide("#work-triangles", triangles);
    await slide("#work-pixels", pixels);
    const size = `${image[0]} × ${image[1]}`;
    await until(size, async () => (await text(page, "output[for=work-pixels]")) === size);
    await until("counts", async () => (await numbers(page, "#work-counts")).length > 0);
    const of = Number((await text(page, "output[for=work-triangles]")).replace(/\D/g, ""));
    // The textbooks test every triangle at every pixel, and image order has a ray for each pixel.
    const pairs = (of * image[0] * image[1]).toLocaleString("en").replaceAll(",", "");
    await until("the pairs", async () => (await text(page, "#chart-text")).replace(/(\d)[\s,.](?=\d)/g, "$1").includes(pairs));
    assert.ok((await numbers(page, "#work-counts")).some((row) => row.includes(image[0] * image[1])), "its rays");
  }
  await close();
});

test("numbers and sliders of the camera are one", async () => {
  const { page, close } = await open({ hash: "#chapter=algorithms&scene=canonical" });
  const total = async () => Number((await text(page, "#verdict")).match(/covered [\d,]+ of ([\d,]+)/)[1].replaceAll(",", ""));
  await page.locator("#image-height").fill("60");
  await page.locator("#image-height").press("Enter");
  await page.locator("#image-width").fill("80");
  await page.locator("#image-width").press("Enter");
  await until("the size of the image", async () => (await total()) === 4800);
  const fields = await page.locator("#camera .dial").all();
  assert.equal(fields.length, 12);
  for (const field of fields) {
    const [number, slider] = [field.locator("input[type=number]"), field.locator("input[type=range]")];
    const before = Number(await number.inputValue());
    await number.fill(String(before + 0.25));
    await number.press("Enter");
    await until(`the slider of ${await number.getAttribute("aria-label")}`, async () => Math.abs(Number(await slider.inputValue()) - before - 0.25) < 1e-6);
    await slider.focus();
    await page.keyboard.press("ArrowRight");
    await until("the number", async () => Math.abs(Number(await number.inputValue()) - Number(await slider.inputValue())) < 1e-4);
    assert.match(await text(page, "#verdict"), /^=?\s*match/);
  }
  await close();
});

test("every chapter is saved as a picture", async () => {
  const { page, close } = await open();
  for (const chapter of CHAPTERS) {
    await page.evaluate((hash) => (location.hash = hash), `#chapter=${chapter}`);
    await page.waitForTimeout(500);
    const [download] = await Promise.all([page.waitForEvent("download"), page.locator("#save").click()]);
    const bytes = readFileSync(await download.path());
    assert.equal(bytes.subarray(1, 4).toString(), "PNG", chapter);
    assert.ok(bytes.readUInt32BE(16) >= 800 && bytes.length > 20_000, `${chapter}: ${bytes.length} bytes`);
    assert.match(download.suggestedFilename(), new RegExp(`${chapter}.*\\.png$`));
  }
  await close();
});
