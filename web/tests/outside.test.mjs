// The view from outside: what is nearest to the observer is seen, lines behind it are dashed, and it turns.

import assert from "node:assert/strict";
import { after, test } from "node:test";
import { drop, engineIn, open, stop, text, until } from "./browser.mjs";

after(stop);

/** The observer of the picture that is shown, as a camera. */
const observer = (page) => page.locator("#outside").evaluate((canvas) => JSON.parse(canvas.dataset.observer ?? "null"));

/** The observer, once the picture is the sharp one: nothing has moved for a while. */
async function atRest(page) {
  const shown = async () => JSON.stringify(await observer(page));
  return until("a picture at rest", async () => {
    const before = await shown();
    await page.waitForTimeout(500);
    return before !== "null" && before === (await shown()) && JSON.parse(before);
  });
}

/** The canvas: its size, and the bytes of its pixels. */
async function pixels(page) {
  const { width, height, bytes } = await page.locator("#outside").evaluate((canvas) => {
    const { width, height } = canvas;
    return { width, height, bytes: [...canvas.getContext("2d").getImageData(0, 0, width, height).data] };
  });
  const at = (x, y) => bytes.slice(4 * (Math.floor(y) * width + Math.floor(x)), 4 * (Math.floor(y) * width + Math.floor(x)) + 3);
  return { width, height, at };
}

const dot = (a, b) => a.reduce((sum, part, axis) => sum + part * b[axis], 0);
const plus = (a, b, by = 1) => a.map((part, axis) => part + by * b[axis]);
const cross = (a, b) => [0, 1, 2].map((k) => a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3]);

/** How far a triangle is along a ray; infinite where the ray misses it. */
function distance([a, b, c], origin, direction) {
  const normal = cross(plus(b, a, -1), plus(c, a, -1));
  const t = dot(plus(a, origin, -1), normal) / dot(direction, normal);
  const point = plus(origin, direction, t);
  const sides = [[a, b], [b, c], [c, a]].map(([p, q]) => dot(cross(plus(q, p, -1), plus(point, p, -1)), normal));
  return t > 0 && (sides.every((side) => side > 0) || sides.every((side) => side < 0)) ? t : Infinity;
}

const RED = [[-2, -1.2, 0], [2, -1.2, 0], [0, 2, 0]];
const BLUE = [[0, -1.5, -2], [0, -1.5, 2], [0, 1.8, 0.3]];
/** Stands between the observer and the middle of the rays. */
const WALL = [[0.6, -3, 1], [0.6, -3, 3], [0.6, 5, 2]];
const object = ([a, b, c], color) =>
  `[[object]]\ntriangle = { a = ${JSON.stringify(a)}, b = ${JSON.stringify(b)}, c = ${JSON.stringify(c)} }\nmaterial = "${color}"\n`;
const COLOURS = { red: "#ff0000", blue: "#0000ff", green: "#00ff00" };
const scene = (...objects) =>
  `[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\nimage = [64, 64]\n${Object.entries(COLOURS)
    .map(([name, color]) => `[material.${name}]\ncolor = "${color}"\n`)
    .join("")}${objects.join("")}`;

test("of triangles that cross, each is seen where it is nearer, to the pixel of the lines drawn over it", async () => {
  const { page, said, close } = await open({ hash: "#chapter=projection&rays=one" });
  await drop(page, { "cross.toml": scene(object(RED, "red"), object(BLUE, "blue")) });
  await until("the scene", async () => (await page.locator("#scene").inputValue()) === "cross.toml");
  const { eye, u, v, w, vw, vh } = await atRest(page);
  const { width, height, at } = await pixels(page);
  const seen = (x, y) => {
    const origin = plus(plus(eye, u, vw * (x / width - 0.5)), v, -vh * (y / height - 0.5));
    const [red, blue] = [RED, BLUE].map((triangle) => distance(triangle, origin, w.map((part) => -part)));
    return red === blue ? "nothing" : red < blue ? "red" : "blue";
  };
  const counts = { red: 0, blue: 0, nothing: 0, wrong: 0 };
  for (let y = 3; y < height - 3; y += 2) {
    for (let x = 3; x < width - 3; x += 2) {
      const expected = seen(x + 0.5, y + 0.5);
      // A pixel on an edge has the colours of both sides.
      if ([[-1, -1], [2, -1], [-1, 2], [2, 2]].some(([right, down]) => seen(x + right, y + down) !== expected)) continue;
      const [r, g, b] = at(x, y);
      const shown = r > 2 * g && r > 2 * b ? "red" : b > 2 * r && b > 2 * g ? "blue" : "nothing";
      counts[shown === expected ? expected : "wrong"]++;
    }
  }
  // Only the camera's lines lie over it. By the middles of the triangles, one of them would cover the other everywhere.
  assert.ok(counts.red > 1000 && counts.blue > 500, JSON.stringify(counts));
  assert.ok(counts.wrong < 0.02 * (counts.red + counts.blue), JSON.stringify(counts));
  assert.deepEqual(said.console, []);
  await close();
});

test("what image order sees from there is what is shown", async () => {
  // The planes of `overlap`, which are nets here.
  for (const [name, planes] of [["ties", []], ["overlap", [37, 38]], ["inside", []]]) {
    const { page, close } = await open({ hash: `#chapter=projection&scene=${name}&rays=one` });
    const camera = await atRest(page);
    const engine = await engineIn(page);
    await engine.ask("open", { name });
    const [right, wrong] = await page.locator("#outside").evaluate(
      async (canvas, [camera, planes]) => {
        const { width, height } = canvas;
        const { value } = await window.ask("render", { camera: { ...camera, width, height } });
        const { rgba, ids } = value.image;
        const shown = canvas.getContext("2d").getImageData(0, 0, width, height).data;
        const counts = [0, 0];
        for (let pixel = width + 1; pixel < width * (height - 1) - 1; pixel++) {
          const id = ids[pixel];
          const around = [-width - 1, -width + 1, width - 1, width + 1].map((step) => ids[pixel + step]);
          if (id === 0xffffffff || planes.includes(id) || around.some((other) => other !== id)) continue;
          const apart = [0, 1, 2].map((part) => Math.abs(rgba[4 * pixel + part] - shown[4 * pixel + part]));
          counts[Math.max(...apart) < 24 ? 0 : 1]++;
        }
        return counts;
      },
      [camera, planes],
    );
    assert.ok(right > 1000 && wrong < 0.15 * right, `${name}: ${right} pixels are right, ${wrong} are not`);
    await close();
  }
});

test("a ray is dashed where something lies before it", async () => {
  const { page, close } = await open({ hash: "#chapter=projection&rays=one" });
  await drop(page, { "wall.toml": scene(object(RED, "red"), object(WALL, "green")) });
  await until("the scene", async () => (await page.locator("#scene").inputValue()) === "wall.toml");
  await until("a hit", async () => (await text(page, "#outside-text")).includes("It hits id 0"));
  const { eye, u, v, vw, vh } = await atRest(page);
  const { width, height, at } = await pixels(page);
  const place = (z) => {
    const offset = plus([0, 0, z], eye, -1);
    return [width * (dot(offset, u) / vw + 0.5), height * (0.5 - dot(offset, v) / vh)];
  };
  /** The part of a piece of the ray on which it is drawn: where the canvas is not as it is beside the ray. */
  const drawn = (from, to) => {
    let count = 0;
    for (let part = 0; part < 100; part++) {
      const [x, y] = place(from + ((to - from) * (part + 0.5)) / 100);
      const beside = at(x, y - 9);
      const on = [-3, -2, -1, 0, 1, 2, 3].map((step) => at(x, y + step));
      if (on.some((color) => Math.max(...color.map((c, k) => Math.abs(c - beside[k]))) > 40)) count++;
    }
    return count / 100;
  };
  const [before, behind] = [drawn(2.6, 3.6), drawn(1.3, 2.1)];
  assert.ok(before > 0.97, `before the wall: ${before}`);
  assert.ok(behind > 0.2 && behind < 0.85, `behind the wall: ${behind}`);
  await close();
});

test("it turns by pointer and by keys, turns back, and is sharp at rest", async () => {
  const { page, said, close } = await open({ hash: "#chapter=projection&scene=lecture" });
  const first = await atRest(page);
  const canvas = page.locator("#outside");
  const box = await canvas.boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 120, y + 30, { steps: 8 });
  const turning = await until("a turn", async () => {
    const now = await observer(page);
    return String(now.w) !== String(first.w) && now;
  });
  assert.ok(turning.width <= first.width);
  await page.mouse.up();
  const turned = await atRest(page);
  assert.equal(turned.width, first.width, "as sharp as before");
  await canvas.focus();
  await page.keyboard.press("Shift+ArrowLeft");
  const byKey = await atRest(page);
  assert.notDeepEqual(byKey.w, turned.w);
  // In a lecture room nobody looks for the focus.
  await canvas.blur();
  await page.keyboard.press("Shift+ArrowUp");
  const unfocused = await atRest(page);
  assert.notDeepEqual(unfocused.w, byKey.w);
  await page.mouse.wheel(0, 300);
  assert.ok((await atRest(page)).vw > byKey.vw, "farther away, more is seen");
  await page.locator("#outside-back").click();
  assert.deepEqual((await atRest(page)).w, first.w);
  assert.deepEqual(said.console, []);
  await close();
});

test("perspective becomes parallel over some frames", async () => {
  const { page, close } = await open({ hash: "#chapter=projection&scene=canonical" });
  await atRest(page);
  const picture = () => page.locator("#outside").evaluate((canvas) => canvas.toDataURL());
  // A machine that is busy draws few frames: each is looked at where it is drawn.
  await page.locator("#outside").evaluate((canvas) => {
    window.seen = new Set();
    const look = () => {
      window.seen.add(canvas.toDataURL());
      requestAnimationFrame(look);
    };
    look();
  });
  await page.locator("label", { hasText: "parallel" }).last().click();
  // The first, the last, quick and sharp, and at least one between.
  await until("frames between", () => page.evaluate(() => window.seen.size > 3));
  await atRest(page);
  const rest = await picture();
  await page.waitForTimeout(300);
  assert.equal(await picture(), rest);
  await close();
});
