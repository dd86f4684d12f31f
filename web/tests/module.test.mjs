// The module in a browser against the native program, which is the oracle: WebAssembly has one level of SIMD.

import assert from "node:assert/strict";
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

test("what is wrong is said as on the command line", async () => {
  await assert.rejects(engine.ask("open", { name: "tis" }), /there is no built-in scene "tis"; did you mean "ties"\?/);
  await assert.rejects(engine.ask("render", { objectRule: "round" }), /there is no such rule of object order/);
  await assert.rejects(engine.ask("pixel", { row: 9999, column: 0 }), /there is no pixel \(9999, 0\)/);
  await assert.rejects(engine.ask("dance"), /the module does not know/);
});
