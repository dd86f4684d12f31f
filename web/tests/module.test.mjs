// The module in a browser against the native program, which is the oracle: WebAssembly has one level of SIMD.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { engineIn, open, program, programIds, stop } from "./browser.mjs";

let opened, engine, scenes;
before(async () => {
  opened = await open();
  engine = await engineIn(opened.page);
  scenes = await engine.ask("scenes");
});
after(stop);

/** Renders a scene in the browser and by the program, and compares the ids of both orders. */
async function sameIds(scene, camera, ...options) {
  const rendered = await engine.ask("render", { camera });
  const expected = programIds(scene, ...options);
  ["object", "image"].forEach((order, place) => {
    const ids = rendered[order].ids;
    assert.equal(ids.length, expected[place].length, `${scene}, ${order} order: the number of pixels`);
    const first = ids.findIndex((id, at) => id !== expected[place][at]);
    assert.equal(first, -1, `${scene} ${options.join(" ")}, ${order} order, differs at ${first}`);
  });
  assert.ok(rendered.verdict.idsEqual);
  assert.deepEqual(await engine.ask("ids"), { object: rendered.object.ids, image: rendered.image.ids });
}

test("all scenes of the program are there", async () => {
  assert.deepEqual(
    scenes.map(({ name }) => name),
    ["lecture", "canonical", "ties", "behind", "slivers", "overlap", "parallel", "inside", "many"],
  );
});

test("ids are those of the native program, in every scene and both orders", async () => {
  for (const { name } of scenes) {
    const { camera } = await engine.ask("open", { name });
    await sameIds(name, camera);
  }
});

test("ids are those of the native program with the other projection, and at an odd size", async () => {
  for (const { name } of scenes) {
    const { camera, viewport_stated: stated } = await engine.ask("open", { name });
    const projection = camera.projection === "parallel" ? "perspective" : "parallel";
    const { camera: other } = await engine.ask("camera", { camera, projection });
    await sameIds(name, other, "--projection", projection);
    // As on the command line, the height of the viewport stays, and its width follows unless the scene states it.
    const odd = { ...camera, width: 77, height: 53 };
    if (!stated) odd.vw = Math.fround((camera.vh * 77) / 53);
    await sameIds(name, odd, "--size", "77x53");
  }
});

test("ordinary rules give the ids of the native program", async () => {
  const cases = [["ties", "inclusive", ""], ["slivers", "snapped:8", "watertight"], ["overlap", "depth24", "moller-trumbore"]];
  for (const [name, objectRule, imageRule] of cases) {
    const { camera } = await engine.ask("open", { name });
    const rendered = await engine.ask("render", { camera, objectRule, imageRule });
    const options = [["--object-rules", objectRule], ["--image-rules", imageRule]].filter(([, rule]) => rule).flat();
    const expected = programIds(name, ...options);
    ["object", "image"].forEach((order, place) => assert.deepEqual(rendered[order].ids, expected[place], `${name} ${order}`));
  }
});

test("a pixel has the numbers of `bothways pixel`", async () => {
  for (const [name, row, column] of [["lecture", 240, 320], ["ties", 20, 30], ["behind", 100, 200], ["parallel", 7, 300]]) {
    await engine.ask("open", { name });
    const { lines, ...report } = await engine.ask("pixel", { row, column });
    assert.deepEqual(report, program("pixel", name, String(row), String(column), "--json"), `${name} (${row}, ${column})`);
    assert.ok(lines[0].startsWith(`${name}: pixel (${row}, ${column}) of `), lines[0]);
  }
});

test("a record of the loops ends in the rendered picture", async () => {
  for (const [name, kind] of [["canonical", "textbook"], ["ties", "boxes"], ["ties", "hierarchy"]]) {
    const { camera } = await engine.ask("open", { name });
    const small = { ...camera, height: 16, width: 16 };
    const { object, image } = await engine.ask("render", { camera: small });
    for (const [order, { ids }] of [["object", object], ["image", image]]) {
      const { changes } = await engine.ask("steps", { camera: small, order, kind });
      const stored = new Array(256).fill(0xffffffff);
      changes.id.forEach((id, place) => (stored[16 * changes.row[place] + changes.column[place]] = id));
      assert.deepEqual(stored, ids, `${name} ${kind} ${order}`);
    }
  }
});

/** The page's own way to read a record: its `Recording`, whose scripts need no page. */
function recordingClass() {
  const script = (name) => readFileSync(new URL(`../page/js/${name}.js`, import.meta.url), "utf8");
  const scripts = ["messages", "numbers", "steps"].map(script).join("\n");
  return new Function(`"use strict"; ${scripts}\nreturn { Recording, NOTHING, RESULT };`)();
}

const { Recording, NOTHING, RESULT } = recordingClass();

/** What is true of the teapot by the textbooks at 64 × 64: tens of millions of steps, of which the page reads any. */
test("the teapot is recorded at 64 × 64 by both textbooks, and every step of it can be read", { timeout: 300_000 }, async () => {
  const { camera, primitives } = await engine.ask("open", { name: "lecture" });
  const small = { ...camera, height: 64, width: 64, vw: camera.vh };
  const pixels = 64 * 64;
  const { ids } = (await engine.ask("render", { camera: small })).object;
  const found = {};
  for (const order of ["object", "image"]) {
    const steps = await engine.ask("steps", { camera: small, order, kind: "textbook" });
    assert.equal(steps.count, primitives * pixels);
    const record = new Recording(steps, order, 64);
    const read = (object, pixel) => record.step(order === "object" ? object * pixels + pixel : pixel * primitives + object);
    // Pairs all over the scene and the picture: those that nobody was told about, too.
    for (let at = 0; at < 4000; at++) {
      const [object, pixel] = [(at * 7919) % primitives, (at * 104729) % pixels];
      const { object: read_, node, row, column } = read(object, pixel);
      assert.deepEqual([read_, node, row, column], [object, NOTHING, Math.floor(pixel / 64), pixel % 64]);
    }
    // What is seen covers its pixel, wherever the loop meets it.
    ids.forEach((id, pixel) => {
      if (id === NOTHING) return;
      const { result, t } = read(id, pixel);
      assert.ok([RESULT.first, RESULT.nearer].includes(result) && t > 0, `${order} ${id} at ${pixel}: ${result}, ${t}`);
    });
    // The tally of each moment is that of its steps, and the last picture is the rendered one.
    const all = record.tally(steps.count);
    assert.deepEqual([all.tests, all.covered], [steps.count, steps.told.step.length]);
    for (const done of [0, 1, 12_345_678, steps.count - 1]) {
      const covered = steps.told.step.filter((step) => step < done).length;
      assert.deepEqual([record.tally(done).tests, record.tally(done).covered], [done, covered]);
    }
    const rgba = new Uint8ClampedArray(4 * pixels);
    record.picture(steps.count, rgba);
    const stored = ids.map((_, pixel) => rgba[4 * pixel + 3] === 255);
    assert.deepEqual(stored, ids.map((id) => id !== NOTHING), `${order}: what is stored at the end`);
    assert.equal(record.picture(0, rgba), 0);
    assert.equal(record.firstAt([1, 3]), order === "object" ? 67 : 67 * primitives);
    found[order] = new Map(steps.told.step.map((step, at) => {
      const { object, row, column } = record.step(step);
      return [`${object} (${row}, ${column})`, steps.told.t[at]];
    }));
  }
  assert.deepEqual([...found.object].sort(), [...found.image].sort(), "the same fragments in both orders");
  // The distances are those of the pixel reports.
  const [row, column] = [30, 33];
  const { at } = await engine.ask("pixel", { camera: small, row, column });
  const covering = at[0].covering.map(({ id, t }) => [`${id} (${row}, ${column})`, Math.fround(t)]);
  assert.ok(covering.length > 1);
  covering.forEach(([pair, t]) => assert.equal(found.object.get(pair), t, pair));
});

test("what would take too long to record is refused with advice", async () => {
  const { camera } = await engine.ask("open", { name: "many" });
  const large = { ...camera, height: 1024, width: 1024 };
  await assert.rejects(engine.ask("steps", { camera: large, order: "object", kind: "textbook" }), /choose a smaller image/);
});

test("what is wrong is said as on the command line", async () => {
  await assert.rejects(engine.ask("open", { name: "tis" }), /there is no built-in scene "tis"; did you mean "ties"\?/);
  await assert.rejects(engine.ask("render", { objectRule: "round" }), /there is no such rule of object order/);
  await assert.rejects(engine.ask("pixel", { row: 9999, column: 0 }), /there is no pixel \(9999, 0\)/);
  await assert.rejects(engine.ask("dance"), /the module does not know/);
});
