// The promise of the README: the module in a browser leaves the bytes of the native program, which runs on all threads and at the
// best level of SIMD: pictures, ids, distances and counts of both orders.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { inflateSync } from "node:zlib";
import { PROGRAM, engineIn, open, stop } from "./browser.mjs";

let page, engine, scenes;
before(async () => {
  ({ page } = await open());
  engine = await engineIn(page);
  scenes = await engine.ask("scenes");
});
after(stop);

/** What the program leaves of a scene at this size: for each order its bytes, and the report. */
function native(scene, size) {
  const folder = mkdtempSync(join(tmpdir(), "bothways-web-"));
  try {
    const words = [scene, "--size", size.join("x"), "-o", join(folder, "out"), "--buffers", "npy", "--no-times", "--quiet"];
    const { status } = spawnSync(PROGRAM, words, { stdio: "ignore" });
    assert.equal(status, 0, words.join(" "));
    const read = (name) => readFileSync(join(folder, "out", name));
    const orders = ["object", "image"].map((order) => ({
      picture: rgb(read(`${order}-order.png`)),
      ids: npy(read(`${order}-order.ids.npy`)),
      t: npy(read(`${order}-order.t.npy`)),
    }));
    return { orders, report: JSON.parse(read("report.json")) };
  } finally {
    rmSync(folder, { recursive: true });
  }
}

/** The bytes of the numbers of a NumPy file. */
function npy(bytes) {
  return bytes.subarray(10 + bytes.readUInt16LE(8));
}

/** The bytes of a PNG of red, green and blue with 8 bits each. */
function rgb(bytes) {
  let at = 8;
  const parts = [];
  let width, height;
  while (at < bytes.length) {
    const [length, kind] = [bytes.readUInt32BE(at), bytes.toString("latin1", at + 4, at + 8)];
    const data = bytes.subarray(at + 8, at + 8 + length);
    if (kind === "IHDR") {
      [width, height] = [data.readUInt32BE(0), data.readUInt32BE(4)];
      assert.deepEqual([...data.subarray(8)], [8, 2, 0, 0, 0], "8 bits of red, green and blue");
    }
    if (kind === "IDAT") parts.push(data);
    at += 12 + length;
  }
  const filtered = inflateSync(Buffer.concat(parts));
  const stride = 3 * width;
  const out = Buffer.alloc(stride * height);
  for (let row = 0; row < height; row++) {
    const filter = filtered[row * (stride + 1)];
    for (let column = 0; column < stride; column++) {
      const left = column < 3 ? 0 : out[row * stride + column - 3];
      const up = row === 0 ? 0 : out[(row - 1) * stride + column];
      const corner = column < 3 || row === 0 ? 0 : out[(row - 1) * stride + column - 3];
      const guess = [0, left, up, (left + up) >> 1, paeth(left, up, corner)][filter];
      out[row * stride + column] = filtered[row * (stride + 1) + 1 + column] + guess;
    }
  }
  return out;
}

/** The neighbour that is nearest to the sum of two less the third (PNG specification, "Filter types"). */
function paeth(left, up, corner) {
  const sum = left + up - corner;
  const [a, b, c] = [left, up, corner].map((one) => Math.abs(sum - one));
  if (a <= b && a <= c) return left;
  return b <= c ? up : corner;
}

/** What the module leaves: for each order its bytes as text in base 64, and its counts. */
async function inBrowser(camera) {
  return page.evaluate(async (camera) => {
    const { ok, value, error } = await window.ask("render", { camera, counts: true, distances: true });
    if (!ok) throw new Error(error);
    const packed = (array) => {
      const bytes = new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
      let text = "";
      for (let at = 0; at < bytes.length; at += 8192) text += String.fromCharCode(...bytes.subarray(at, at + 8192));
      return btoa(text);
    };
    return ["object", "image"].map((order) => {
      const { rgba, ids, t, work } = value[order];
      return { rgba: packed(rgba), ids: packed(ids), t: packed(t), work };
    });
  }, camera);
}

/** Red, green and blue without the fourth byte. */
function withoutAlpha(rgba) {
  return Buffer.from(rgba.filter((_, at) => at % 4 !== 3));
}

test("pictures, ids, distances and counts are those of the native program, byte for byte", async () => {
  const size = [161, 90];
  for (const { name } of scenes) {
    const { camera, viewport_stated: stated } = await engine.ask("open", { name });
    const small = { ...camera, width: size[0], height: size[1] };
    // As on the command line, the height of the viewport stays, and its width follows unless the scene states it.
    if (!stated) small.vw = Math.fround((camera.vh * size[0]) / size[1]);
    const { orders, report } = native(name, size);
    const drawn = await inBrowser(small);
    ["object_order", "image_order"].forEach((order, place) => {
      const bytes = (what) => Buffer.from(drawn[place][what], "base64");
      const { picture, ids, t } = orders[place];
      assert.ok(bytes("ids").equals(ids), `${name}, ${order}: ids`);
      assert.ok(bytes("t").equals(t), `${name}, ${order}: distances`);
      assert.ok(withoutAlpha(bytes("rgba")).equals(picture), `${name}, ${order}: picture`);
      const work = report[order].work;
      assert.ok(work && Object.keys(work).length > 0, `${name}, ${order}: counts`);
      assert.deepEqual(drawn[place].work, work, `${name}, ${order}: counts`);
    });
  }
});
