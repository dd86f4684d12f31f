// The page in Debian's chromium, opened from its file, as a reader uses it.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { CHAPTERS, PAGE, colours, drop, engineIn, open, program, stop, text, turnTo, until } from "./browser.mjs";
import { FOUR, PAINT, wall, walls } from "./wall.mjs";

after(stop);

/** Sets a form control as a reader does. */
async function set(page, selector, value) {
  const field = page.locator(selector);
  await field.fill(String(value));
  await field.press("Enter");
}

test("it opens from a file, asks nobody, and says nothing", async () => {
  const { page, said, close } = await open();
  assert.equal(page.url().slice(0, 7), "file://");
  await until("a verdict", async () => (await text(page, "#verdict-text")).startsWith("match"));
  for (const chapter of CHAPTERS) {
    await page.evaluate((chapter) => (location.hash = `#chapter=${chapter}`), chapter);
    await page.waitForTimeout(800);
  }
  assert.deepEqual(said.console, []);
  assert.deepEqual(said.requests.filter((url) => !/^(file|data|blob):/.test(url)), []);
  await close();
});

test("text and a still picture stand before any script has run", async () => {
  const { page: ready, close: done } = await open();
  const context = await ready.context().browser().newContext({ javaScriptEnabled: false });
  const page = await context.newPage();
  await page.goto(ready.url());
  assert.ok((await text(page, "#chapter-text")).includes("two loops"));
  const [still] = await page.locator("img.still").all();
  assert.ok(await still.isVisible());
  assert.ok((await still.boundingBox()).width > 100);
  await context.close();
  await done();
});

test("steps go to the end and back", async () => {
  for (const method of ["textbook", "hierarchy"]) {
    const { page, close } = await open({ hash: `#chapter=loops&scene=canonical&size=8&method=${method}` });
    const step = async () => Number(await page.locator("#step").inputValue());
    const end = await until("a record", async () => Number((await text(page, "#steps-total")).replace(/\D/g, "")));
    await page.locator("#to-start").click();
    await until("the start", async () => (await step()) === 0);
    const before = await text(page, "#halves");
    await page.locator("#step-on").click();
    await until("one step on", async () => (await step()) === 1);
    await page.locator("#to-end").click();
    await until("the end", async () => (await step()) === end);
    const done = await text(page, "#halves");
    assert.notEqual(done, before);
    await page.locator("#step-back").click();
    await until("one step back", async () => (await step()) === end - 1);
    await page.locator("#to-end").click();
    await until("the end again", async () => (await step()) === end);
    assert.equal(await text(page, "#halves"), done);
    await page.locator("#to-start").click();
    await until("the start again", async () => (await step()) === 0);
    assert.equal(await text(page, "#halves"), before);
    if (method === "textbook") assert.equal(end, 3 * 8 * 8, "three objects at 64 pixels");
    await close();
  }
});

test("millions of steps are recorded while the page answers, and scrubbed at once", { timeout: 300_000 }, async () => {
  const { page, said, close } = await open({ hash: "#chapter=loops&scene=lecture&size=64&step=20000000" });
  await until("progress", () => page.locator("#recording").isVisible());
  // Meanwhile the page's other questions do not wait for the record.
  await page.evaluate(() => (location.hash = "#chapter=ray&scene=lecture&pixel=240,320"));
  await until("a ray", async () => (await text(page, "#ray")).includes("(240, 320)"));
  await page.evaluate(() => (location.hash = "#chapter=loops&scene=lecture&size=64&step=20000000"));
  const end = await until("a record", async () => Number((await text(page, "#steps-total")).replace(/\D/g, "")) > 30_000_000, 240);
  assert.ok(end);
  assert.equal(await page.locator("#recording").isVisible(), false);
  assert.equal(await page.locator("#step").inputValue(), "20000000", "the step of the link has waited for its record");
  const words = [];
  for (const step of [1, 12_345_678, 30_000_000, 12_345_678]) {
    await set(page, "#step", step);
    words.push(await text(page, "#halves"));
  }
  assert.equal(words[1], words[3]);
  assert.equal(new Set(words).size, 3);
  await page.locator("#to-end").click();
  await until("the end", async () => (await text(page, ".half.object")).includes("done after"));
  await page.locator("#to-start").click();
  await until("the start", async () => (await text(page, ".half.object")).includes("Nothing is tested yet"));
  // The other ways of testing come, and the first one comes back, with what is recorded already.
  await page.locator("label", { hasText: "bounding boxes" }).click();
  await until("boxes", async () => (await text(page, "#steps-note")).startsWith("Object order asks only"), 5);
  assert.equal(await page.locator("#recording").isVisible(), false);
  await page.locator("label", { hasText: "every pair" }).click();
  await until("every pair", async () => !(await page.locator("#steps-note").isVisible()), 5);
  assert.equal(await page.locator("#recording").isVisible(), false);
  // What is no longer wanted is given up.
  await page.locator("#steps-size").selectOption("48");
  await until("progress again", () => page.locator("#recording").isVisible());
  await page.locator("#steps-size").selectOption("8");
  await until("a small record", async () => (await text(page, "#steps-total")).length < 12 && page.locator("#halves").isVisible());
  assert.deepEqual(said.console, []);
  await close();
});

test("the microscope shows the numbers of `bothways pixel`", async () => {
  const { page, close } = await open({ hash: "#chapter=ray&scene=canonical&pixel=300,200" });
  const report = program("pixel", "canonical", "300", "200", "--json");
  const [{ x, y, covering }] = report.at;
  const shown = (number) => String(number).replace("-", "\u2212");
  await until("the ray", async () => (await text(page, "#ray")).includes(shown(x)));
  assert.ok((await text(page, "#ray")).includes(shown(y)));
  const along = await text(page, "#along");
  for (const { id, t } of covering) {
    assert.ok(along.includes(`id ${id}`), along);
    assert.ok(along.includes(String(t).slice(0, 6)), `${t}: ${along}`);
  }
  await set(page, "#pixel-row", 100);
  await until("another pixel", async () => (await text(page, "#ray")).includes("(100, 200)"));
  await close();
});

test("a link brings back the moment", async () => {
  const first = await open({ hash: "#chapter=loops&scene=ties&size=8&loops=image&method=textbook" });
  await until("a record", async () => /[1-9]/.test(await text(first.page, "#steps-total")));
  await set(first.page, "#step", 37);
  const hash = await until("the link", async () => {
    const hash = new URL(first.page.url()).hash;
    return hash.includes("step=37") && hash;
  });
  const second = await open({ hash });
  await until("the step", async () => (await second.page.locator("#step").inputValue()) === "37");
  const halves = await text(first.page, "#halves");
  await until("the same words", async () => (await text(second.page, "#halves")) === halves);
  await first.close();
  await second.close();

  const camera = "#chapter=algorithms&scene=lecture&eye=2,3,5&direction=-2,-2,-5&vw=1.5&projection=parallel&pixel=3,4";
  const third = await open({ hash: camera });
  await third.page.waitForTimeout(1500);
  const said = new URLSearchParams(new URL(third.page.url()).hash.slice(1));
  assert.deepEqual([said.get("eye"), said.get("projection"), said.get("pixel")], ["2,3,5", "parallel", "3,4"]);
  await third.close();
});

test("the page does not write over a link that waits to be followed", async () => {
  const { page, close } = await open({ hash: "#chapter=loops&scene=ties&size=8" });
  await until("a record", async () => /[1-9]/.test(await text(page, "#steps-total")));
  await until("the link", async () => new URL(page.url()).hash.includes("step=0"));
  // So it is while a busy page has not come to the event of a link that was typed.
  const typed = "#chapter=loops&scene=canonical&size=8";
  await page.evaluate((hash) => history.replaceState(null, "", hash), typed);
  await set(page, "#step", 5);
  await page.waitForTimeout(1000);
  assert.equal(new URL(page.url()).hash, typed);
  await page.evaluate(() => dispatchEvent(new HashChangeEvent("hashchange")));
  await until("the scene of the link", async () => (await page.locator("#scene").inputValue()) === "canonical");
  await until("the link goes on", async () => new URL(page.url()).hash.includes("step="));
  await close();
});

test("the page does not write over a link whose scene takes long to open", async () => {
  const { page, close } = await open({ hash: "#chapter=algorithms&scene=ties" });
  await until("the link", async () => new URL(page.url()).hash.includes("pixel="));
  // The worker is told to open the scene when it is let go on.
  await page.evaluate(() => {
    const post = Worker.prototype.postMessage;
    const held = new Promise((goOn) => (window.goOn = goOn));
    Worker.prototype.postMessage = async function (message) {
      if (message.call === "open") await held;
      post.call(this, message);
    };
  });
  const typed = "#chapter=ray&scene=canonical&pixel=3,4";
  await page.evaluate((hash) => void (location.hash = hash), typed);
  await page.waitForTimeout(1000);
  assert.equal(new URL(page.url()).hash, typed);
  assert.equal(await page.locator("#scene").inputValue(), "ties");
  await page.evaluate(() => window.goOn());
  await until("the scene of the link", async () => (await page.locator("#scene").inputValue()) === "canonical");
  await set(page, "#pixel-row", 5);
  await until("the link goes on", async () => new URL(page.url()).hash.includes("pixel=5,4"));
  await close();
});

test("a good file is opened; a broken and a huge one are refused with reasons", async () => {
  const { page, said, close } = await open();
  await drop(page, { "small.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n" });
  await until("the scene", async () => (await page.locator("#scene").inputValue()).startsWith("small"));
  await until("its verdict", async () => (await text(page, "#verdict-text")).startsWith("match"));

  const corners = ["0 0 0", "1 0 0", "0 1 0"].map((at) => `vertex ${at}`);
  const facet = ["solid", "facet normal 0 0 1", "outer loop", ...corners, "endloop", "endfacet", "endsolid"];
  await drop(page, { "facet.stl": facet.join("\n") });
  await until("the facet", async () => (await page.locator("#scene").inputValue()).startsWith("facet"));

  await drop(page, { "broken.obj": "v 0 0 0\nv 1 0 O\n" });
  await until("a reason", async () => (await text(page, "#trouble")).includes('broken.obj:2: "O" is not a number'));
  await drop(page, { "scene.toml": "[[object]]\nspere = { center = [0, 0, 0], radius = 1 }\n" });
  await until("a suggestion", async () => (await text(page, "#trouble")).includes('did you mean "sphere"?'));
  await drop(page, { "huge.obj": 80 * 1024 * 1024 });
  await until("the limit", async () => (await text(page, "#trouble")).includes("at most 64 MiB"));
  await drop(page, { "picture.gif": "GIF89a" });
  await until("the kinds", async () => (await text(page, "#trouble")).includes(".obj"));

  // What was open stays open.
  assert.ok((await page.locator("#scene").inputValue()).startsWith("facet"));
  assert.deepEqual(said.console, []);
  await close();
});

/** Two squares, one with the picture and one with another, by a material file and by the scene itself. */
const TOGETHER = {
  "wall.toml": walls("meshes/Wall.obj", "four.png"),
  "wall.obj": wall("wall.mtl"),
  "wall.mtl": PAINT,
  "four.png": [...FOUR],
};

test("a scene is opened with the mesh, the materials and the pictures that are dropped with it", async () => {
  const { page, said, close } = await open();
  await drop(page, TOGETHER);
  await until("the scene", async () => (await page.locator("#scene").inputValue()) === "wall.toml");
  await until("its verdict", async () => (await text(page, "#verdict-text")).startsWith("match"));
  assert.match(await text(page, "#scene-text"), /2 objects, 4 primitives/);
  assert.equal(await page.locator("#trouble").textContent(), "");
  await until("the picture's colours", async () => (await colours(page)).every((count) => count > 20));

  // Without its scene, the mesh is what is opened; what nothing names is said.
  const { "wall.toml": _, ...mesh } = TOGETHER;
  await drop(page, { ...mesh, "notes.txt": "?" });
  await until("the mesh", async () => (await page.locator("#scene").inputValue()) === "wall.obj");
  assert.equal(await text(page, "#trouble"), 'not used, because no opened file names it: "notes.txt"');
  // The button takes several files, too.
  const chosen = Object.entries(TOGETHER).map(([name, content]) => ({
    name,
    mimeType: "application/octet-stream",
    buffer: Buffer.from(content),
  }));
  await page.locator("#file").setInputFiles(chosen);
  await until("the scene again", async () => (await page.locator("#scene").inputValue()) === "wall.toml");
  assert.deepEqual(said.console, []);
  await close();
});

test("a file that comes back with other content is another scene", async () => {
  const { page, close } = await open({ hash: "#chapter=loops&size=8" });
  const scene = (objects) => `[camera]\n${"[[object]]\nplane = { point = [0, 0, -3], normal = [0, 0, 1] }\n".repeat(objects)}`;
  for (const objects of [1, 2]) {
    await drop(page, { "planes.toml": scene(objects) });
    await until(`${objects} objects`, async () => (await text(page, "#steps-total")) === `of ${64 * objects}`);
  }
  await close();
});

test("what is missing of a scene's files, or what was meant, is said", async () => {
  const { page, said, close } = await open();
  const trouble = (says) => until(says, async () => (await text(page, "#trouble")).includes(says));
  const { "wall.toml": scene, "wall.obj": mesh, "wall.mtl": materials } = TOGETHER;
  await drop(page, { "wall.toml": scene.replace("four.png", "Four.PNG") });
  await trouble('"Four.PNG" is not among the opened files; open it together with the file that names it, or drop both together');
  await drop(page, { "wall.toml": scene, "four.png": TOGETHER["four.png"] });
  await trouble('"meshes/Wall.obj" is not among the opened files');
  assert.equal(await page.locator("#scene").inputValue(), "lecture", "what was open stays open");
  await drop(page, { "wall.obj": mesh });
  await trouble('the material file "wall.mtl" was not opened with it (open or drop both together)');
  await drop(page, { "wall.obj": mesh, "wall.mtl": materials });
  await trouble('the picture "four.png" was not opened with it');
  await drop(page, { "a.toml": scene, "b.toml": scene, "wall.obj": mesh });
  await trouble("a.toml, b.toml: which one?");
  await drop(page, { "a.obj": mesh, "b.obj": mesh });
  await trouble("a.obj, b.obj: which one?");
  await drop(page, { "wall.toml": scene, "a.bin": 40 * 1024 * 1024, "b.bin": 40 * 1024 * 1024 });
  await trouble("wall.toml, a.bin, b.bin: the 3 files have 80 MiB, and this page reads at most 64 MiB");
  assert.deepEqual(said.console, []);
  await close();
});

/** The lecture's formulas, once more: what a student computes by hand. */
function worked({ camera, row, column }, plane) {
  const axis = (name, other) => camera[name] ?? other;
  const [u, v, w] = [axis("u", [1, 0, 0]), axis("v", [0, 1, 0]), axis("w", [0, 0, 1])];
  const x = camera.vw * ((column + 0.5) / camera.width - 0.5);
  const y = -camera.vh * ((row + 0.5) / camera.height - 0.5);
  const direction = [0, 1, 2].map((k) => x * u[k] + y * v[k] - camera.d * w[k]);
  if (!plane) return [...camera.eye, ...direction];
  const t = plane.constant / plane.normal.reduce((sum, part, k) => sum + part * direction[k], 0);
  return [t, ...direction.map((part) => t * part)];
}

/** The plane in the words of a question: "x + 2 z = −4". */
function planeIn(words) {
  const [, sum, constant] = words.match(/the plane ([xyz0-9 +]+) = (−?\d+)/);
  const normal = ["x", "y", "z"].map((name) => {
    const term = sum.split("+").map((part) => part.trim()).find((part) => part.endsWith(name));
    return term === undefined ? 0 : Number(term.slice(0, -1) || 1);
  });
  return { normal, constant: Number(constant.replace("−", "-")) };
}

test("every question takes the right answer, and refuses a wrong one", async () => {
  const { page, close } = await open();
  const engine = await engineIn(page);
  for (const kind of ["ray", "plane", "eye", "viewport", "distance", "frame"]) {
    const seed = 11;
    const question = await engine.ask("question", { kind, seed });
    // The page writes what it shows into its address, and may do so before it hears of another.
    await until(`${kind}: the question`, async () => {
      await page.evaluate((hash) => (location.hash = hash), `#chapter=problems&question=${kind}&seed=${seed}`);
      await page.waitForTimeout(500);
      return (await text(page, "#question-text")).includes(question.title);
    });
    const plane = kind === "plane" ? planeIn(question.text.join(" ")) : undefined;
    const numbers = worked(question, plane).map((number) => number.toFixed(6));
    const fields = await page.locator("#question-fields input").all();
    assert.equal(fields.length, numbers.length);
    const submit = async (values) => {
      for (const [place, field] of fields.entries()) await field.fill(values[place]);
      await page.locator("#question-form button[type=submit]").click();
    };
    await submit(numbers.map((number, place) => (place === 3 ? String(Number(number) + 1) : number)));
    await until(`${kind}: a refusal`, async () => (await text(page, "#question-verdict")).startsWith("Not yet"));
    assert.equal(await fields[3].getAttribute("aria-invalid"), "true");
    await submit(numbers);
    await until(`${kind}: a yes`, async () => (await text(page, "#question-verdict")).startsWith("Right"));
    await until(`${kind}: the picture`, () => page.locator("#question-picture").isVisible());
  }
  // What was typed is there when a reader comes back.
  const first = page.locator("#question-fields input").first();
  await first.fill("7/8");
  await page.locator("#chapters a[data-chapter=cost]").click();
  await page.locator("#chapters a[data-chapter=problems]").click();
  await page.waitForTimeout(300);
  assert.equal(await first.inputValue(), "7/8");
  await close();
});

test("the quiz knows its answer", async () => {
  const { page, close } = await open({ hash: "#chapter=quiz&seed=4" });
  const choices = page.locator("input[name=quiz]");
  await until("four choices", async () => (await choices.count()) === 4);
  let right = 0;
  for (let place = 0; place < 4; place++) {
    await choices.nth(place).check();
    await page.locator("#quiz-form button[type=submit]").click();
    await until("a verdict", async () => /^(Right|Not this)/.test(await text(page, "#quiz-answer")));
    right += (await text(page, "#quiz-answer")).startsWith("Right") ? 1 : 0;
    await page.locator("#quiz-answer").evaluate((element) => (element.textContent = ""));
  }
  assert.equal(right, 1);
  await close();
});

test("the keyboard alone reaches every control", async () => {
  const { page, close } = await open();
  for (const chapter of CHAPTERS) {
    await turnTo(page, chapter);
    await page.evaluate(() => {
      for (const control of document.querySelectorAll("[data-reached]")) delete control.dataset.reached;
    });
    // Once around, and no further: of radio buttons, one stands for its group. What is drawn while the focus goes by is reached the
    // next time.
    let missed = ["all"];
    for (let round = 0; round < 3 && missed.length > 0; round++) {
      for (let press = 0; press < 150; press++) {
        await page.keyboard.press("Tab");
        const isInside = await page.evaluate(() => {
          const element = document.activeElement;
          if (!element || element === document.body) return false;
          element.dataset.reached = "yes";
          return true;
        });
        if (!isInside) break;
      }
      missed = await page.evaluate(() => {
        const controls = [...document.querySelectorAll("button, input, select, summary, a[href], [tabindex='0']")];
        const isShown = (one) => one.checkVisibility({ visibilityProperty: true }) && !one.disabled && one.tabIndex >= 0;
        const isInGroup = (one) =>
          one.type === "radio" && document.querySelector(`input[name="${one.name}"][data-reached]`) !== null;
        const missing = controls.filter((one) => isShown(one) && one.dataset.reached !== "yes" && !isInGroup(one));
        return missing.map((one) => one.id || one.outerHTML.slice(0, 80));
      });
    }
    assert.deepEqual(missed, [], chapter);
  }
  await close();
});

test("arrow keys turn the camera, and a key brings it back", async () => {
  const { page, close } = await open();
  const eye = () => new URLSearchParams(new URL(page.url()).hash.slice(1)).get("eye");
  await page.locator("canvas[data-picture=object]").first().focus();
  await page.keyboard.press("Shift+ArrowRight");
  await until("another eye", async () => eye() !== null);
  await page.keyboard.press("0");
  await until("the scene's own eye", async () => eye() === null);
  await close();
});

test("two fingers move the eye, and one turns it", async () => {
  const { page, close } = await open({ hash: "#scene=lecture" });
  const fields = '[data-vector="eye"] input[type="number"]';
  const eye = () => page.locator(fields).evaluateAll((inputs) => inputs.map(({ value }) => Number(value)));
  const box = await page.locator("canvas[data-picture]").first().boundingBox();
  const middle = [box.x + box.width / 2, box.y + box.height / 2];
  const touch = await page.context().newCDPSession(page);
  const send = (type, ...apart) =>
    touch.send("Input.dispatchTouchEvent", {
      type,
      touchPoints: apart.map((x, id) => ({ x: middle[0] + x, y: middle[1], id })),
    });
  const before = await eye();
  assert.equal(before.length, 3);
  await send("touchStart", -20);
  await send("touchStart", -20, 20);
  for (const side of [25, 30, 35, 40]) await send("touchMove", -side, side);
  // The finger that stays turns the camera, and does not choose a pixel.
  await send("touchMove", -40);
  const nearer = await until("a nearer eye", async () => {
    const now = await eye();
    return Math.hypot(...now.map((at, axis) => at - before[axis])) > 1 && now;
  });
  await send("touchMove", 20);
  await until("a turn", async () => (await eye())[0] !== nearer[0]);
  await send("touchEnd");
  await close();
});

test("a module that breaks begins anew with the same scene", async () => {
  // A module that ends by a trap when it is asked about the rules.
  const html = readFileSync(PAGE, "utf8");
  const trap = `{ const call = wasm_bindgen.Module.prototype.call; wasm_bindgen.Module.prototype.call = function (name, ...rest) {
    if (name === "own") throw new WebAssembly.RuntimeError("unreachable");
    return call.call(this, name, ...rest); }; }`;
  const folder = mkdtempSync(join(tmpdir(), "bothways-web-"));
  const broken = join(folder, "broken.html");
  writeFileSync(broken, html.replace("// @ts-check\n// The worker:", `${trap}\n// The worker:`));
  const { page, close } = await open({ file: broken, hash: "#chapter=coverage&scene=ties" });
  await until("a report", async () => (await text(page, "#trouble")).includes("begins anew"));
  await page.evaluate(() => (location.hash = "#chapter=algorithms&scene=ties"));
  await until("a verdict", async () => (await text(page, "#verdict-text")).startsWith("match"));
  await close();
  rmSync(folder, { recursive: true });
});
