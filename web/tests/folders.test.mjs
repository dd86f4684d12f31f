// Folders that are dropped on the page: real ones in chromium; the ways in which other browsers tell of them, by their words.

import assert from "node:assert/strict";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, test } from "node:test";
import { colours, open, stop, text, until } from "./browser.mjs";
import { FOUR, PAINT, wall, walls } from "./wall.mjs";

after(stop);

/** Two squares with a picture, in folders within a folder, and what lies about there. */
const FOLDER = {
  "wall.toml": walls("meshes/wall.obj", "paint/four.png"),
  "meshes/wall.obj": wall("../paint/wall.mtl"),
  "paint/wall.mtl": PAINT,
  "paint/four.png": FOUR,
  "notes.txt": "?",
  ".hidden/other.toml": "?",
  ".DS_Store": "?",
  "old/wall.toml": "?",
  "old/meshes/wall.obj": "f 1 2 3\n",
  "old/four.png": "?",
};

/** Writes a folder, and gives its path. */
function written(files, name = "scene") {
  const folder = join(mkdtempSync(join(tmpdir(), "bothways-web-")), name);
  mkdirSync(folder);
  for (const [path, content] of Object.entries(files)) {
    mkdirSync(dirname(join(folder, path)), { recursive: true });
    writeFileSync(join(folder, path), content);
  }
  return folder;
}

/** Drops what lies on the disk, as a file manager does. */
async function drop(page, ...files) {
  const session = await page.context().newCDPSession(page);
  const data = { items: [], files, dragOperationsMask: 1 };
  for (const type of ["dragEnter", "dragOver", "drop"]) {
    await session.send("Input.dispatchDragEvent", { type, x: 300, y: 300, data });
  }
  await session.detach();
}

const scene = (page) => page.locator("#scene").inputValue();
const trouble = (page, says) => until(says, async () => (await text(page, "#trouble")).includes(says));

test("a dropped folder opens its scene with all that it names", async () => {
  const { page, said, close } = await open();
  const folder = written(FOLDER);
  await drop(page, folder);
  await until("the scene", async () => (await scene(page)) === "wall.toml");
  await until("its verdict", async () => (await text(page, "#verdict-text")).startsWith("match"));
  assert.equal(await page.locator("#trouble").isVisible(), false, "what nobody names may lie in a folder");
  assert.match(await text(page, "#scene-text"), /2 objects, 4 primitives/);
  await until("the picture's colours", async () => (await colours(page)).every((count) => count > 20));

  // Without its scene, the folder opens as its mesh; and a scene beside a folder finds what lies in that.
  const { "wall.toml": toml, "old/wall.toml": _, "old/meshes/wall.obj": __, ...mesh } = FOLDER;
  const other = written(mesh, "mesh");
  await drop(page, other);
  await until("the mesh", async () => (await scene(page)) === "meshes/wall.obj");
  await drop(page, join(folder, "wall.toml"), join(folder, "meshes"), join(folder, "paint"));
  await until("the scene again", async () => (await scene(page)) === "wall.toml");
  assert.equal(await page.locator("#trouble").isVisible(), false);
  assert.deepEqual(said.console, []);
  await close();
  [folder, other].forEach((one) => rmSync(dirname(one), { recursive: true }));
});

test("what is wrong with a folder is said before anything of it is read", async () => {
  const { page, said, close } = await open();
  const cases = [
    [{}, "scene: there is no file in this folder"],
    [{ "a.txt": "?" }, "scene: a.txt: this page opens meshes"],
    [{ "in/a.toml": "?", "other/b.toml": "?" }, "scene: in/a.toml, other/b.toml: which one?"],
    [{ "wall.toml": "", "in/a.bin": Buffer.alloc(40 << 20), "in/b.bin": Buffer.alloc(40 << 20) },
      "scene: the 3 files have 80 MiB, and this page reads at most 64 MiB"],
    [Object.fromEntries(Array.from({ length: 1001 }, (_, number) => [`${number % 7}/${number}.txt`, ""])),
      "scene: this page looks at 1,000 files at most; drop the scene file and the files that it names instead"],
    [{ [`${"in/".repeat(17)}a.toml`]: "" }, "scene: this page looks into 16 folders within one another at most"],
    [{ "a.toml": "[[object]]\nmesh = 'in/b.obj'\n" }, "a.toml:2:8: \"in/b.obj\" is not among the opened files"],
  ];
  for (const [files, says] of cases) {
    const folder = written(files);
    await drop(page, folder);
    await trouble(page, says);
    assert.equal(await scene(page), "lecture", "what was open stays open");
    rmSync(dirname(folder), { recursive: true });
  }
  assert.deepEqual(said.console, []);
  await close();
});

/** The page's own functions, which need no page. */
function folderFunctions() {
  const script = (name) => readFileSync(new URL(`../page/js/${name}.js`, import.meta.url), "utf8");
  const scripts = ["numbers", "folders"].map(script).join("\n");
  const messageOf = (error) => error.message;
  return new Function("messageOf", `"use strict"; ${scripts}\nreturn { droppedOf, filesIn };`)(messageOf);
}

/** A folder as Firefox and Safari tell of it: in parts. */
function entry(name, content) {
  if (typeof content === "string") {
    return { name, isFile: true, isDirectory: false, file: (found) => found(new File([content], name)) };
  }
  const parts = [...Object.entries(content).map((one) => [entry(...one)]), []];
  return { name, isFile: false, isDirectory: true, createReader: () => ({ readEntries: (found) => found(parts.shift()) }) };
}

test("folders of browsers that know no handles are read by their entries", async () => {
  const { droppedOf, filesIn } = folderFunctions();
  const items = (...entries) =>
    entries.map((one) => ({ kind: "file", webkitGetAsEntry: () => one, getAsFile: () => new File(["?"], one.name) }));
  const paths = async (...entries) => {
    const found = await filesIn(await Promise.all(droppedOf({ items: [{ kind: "string" }, ...items(...entries)] })));
    return found.map(({ path }) => path);
  };
  const folder = entry("scene", { "b.toml": "", in: { "c.obj": "", deep: { "d.png": "" } }, ".git": { e: "" }, "a.txt": "" });
  assert.deepEqual(await paths(folder), ["a.txt", "b.toml", "in/c.obj", "in/deep/d.png"]);
  const beside = entry("in", { "c.obj": "" });
  assert.deepEqual(await paths(beside, entry("f.toml", "")), ["in/c.obj", "f.toml"], "with the folders' own names");
  const broken = { ...entry("gone", {}), createReader: () => ({ readEntries: (_, failed) => failed(new Error("it is gone")) }) };
  await assert.rejects(paths(broken), /gone: it is gone; drop the scene file/);
});
