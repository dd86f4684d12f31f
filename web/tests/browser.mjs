// A browser with the page open, and what it says.
//
// PAGE is the file of the page, PROGRAM the program `bothways`, which knows what is right.

import { execFileSync, spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

/** The packages lie where the tests are started: they are never part of the repository. */
export const require = createRequire(join(process.cwd(), "package.json"));
export const { chromium } = require("playwright-core");

export const PAGE = resolve(process.env.PAGE ?? "out/lecture.html");
export const PROGRAM = resolve(process.env.PROGRAM ?? "target/debug/bothways");
export const CHAPTERS = ["algorithms", "loops", "ray", "coverage", "projection", "break", "quiz", "problems", "cost"];

let browser;

/** Starts Debian's chromium, once. */
export async function start() {
  browser ??= await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    // Root has no sandbox.
    args: ["--no-sandbox"],
  });
  return browser;
}

export async function stop() {
  await browser?.close();
  browser = undefined;
}

/**
 * Opens the page from its file, and waits until it is ready. `said` collects what the console said, and every request.
 * @param {{file?: string, hash?: string, width?: number, height?: number, scheme?: "light" | "dark"}} [options]
 */
export async function open({ file = PAGE, hash = "", width = 1440, height = 900, scheme = "light" } = {}) {
  const context = await (await start()).newContext({ viewport: { width, height }, colorScheme: scheme });
  const page = await context.newPage();
  const said = { console: [], requests: [] };
  page.on("console", (message) => said.console.push(`${message.type()}: ${message.text()}`));
  page.on("pageerror", (error) => said.console.push(`error: ${error}`));
  page.on("request", (request) => said.requests.push(request.url()));
  await page.goto(pathToFileURL(file).href + hash);
  await page.waitForSelector("html[data-ready]", { timeout: 60_000 });
  return { page, said, close: () => context.close() };
}

/**
 * Shows another chapter of an open page, and waits until it has drawn it.
 * @param {import("playwright-core").Page} page
 */
export async function turnTo(page, chapter) {
  await page.evaluate((hash) => (location.hash = hash), `#chapter=${chapter}`);
  await page.locator(`#chapters a[data-chapter=${chapter}][aria-current=page]`).waitFor({ state: "attached" });
  await page.waitForTimeout(500);
}

/** The text of a data block of the page. */
function block(html, id) {
  return html.split(`id="${id}">`)[1].split("</script>")[0];
}

/**
 * A worker of the page's own parts, in a browser, to ask it without the page: `ask(call, arguments)`.
 * @param {import("playwright-core").Page} page
 */
export async function engineIn(page) {
  const html = readFileSync(PAGE, "utf8");
  const parts = { worker: block(html, "bothways-worker"), module: block(html, "bothways-module") };
  await page.evaluate(async ({ worker: script, module }) => {
    const worker = new Worker(URL.createObjectURL(new Blob([script], { type: "text/javascript" })));
    const waiting = new Map();
    worker.addEventListener("message", ({ data }) => {
      if (!data.progress) waiting.get(data.id)(data);
    });
    let last = 0;
    window.ask = (call, args = {}) =>
      new Promise((resolve) => {
        waiting.set(++last, resolve);
        worker.postMessage({ ...args, call, id: last });
      });
    const started = await window.ask("start", { module });
    if (!started.ok) throw new Error(started.error);
  }, parts);
  return {
    /** The value of an answer. Typed arrays become plain ones; pictures are left out, as they are long. */
    async ask(call, args) {
      const answer = await page.evaluate(
        async ([call, args]) => {
          /** Bytes as text: as JSON, a million numbers take seconds. */
          const packed = (array) => {
            const bytes = new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
            let text = "";
            for (let at = 0; at < bytes.length; at += 8192) text += String.fromCharCode(...bytes.subarray(at, at + 8192));
            return { array: array.constructor.name, bytes: btoa(text) };
          };
          const plain = (value) => {
            if (ArrayBuffer.isView(value)) return packed(value);
            if (value === null || typeof value !== "object" || Array.isArray(value)) return value;
            const entries = Object.entries(value).filter(([key]) => key !== "rgba");
            return Object.fromEntries(entries.map(([key, one]) => [key, plain(one)]));
          };
          return plain(await window.ask(call, args));
        },
        [call, args],
      );
      if (!answer.ok) throw new Error(answer.error);
      return unpacked(answer.value);
    },
  };
}

/** The plain arrays of numbers in an answer. */
function unpacked(value) {
  if (value === null || typeof value !== "object" || Array.isArray(value)) return value;
  if (typeof value.bytes === "string" && typeof value.array === "string") {
    const { buffer, byteOffset, byteLength } = Buffer.from(value.bytes, "base64");
    return [...new globalThis[value.array](buffer.slice(byteOffset, byteOffset + byteLength))];
  }
  return Object.fromEntries(Object.entries(value).map(([key, one]) => [key, unpacked(one)]));
}

/** What the program prints as JSON. */
export function program(...words) {
  if (!existsSync(PROGRAM)) throw new Error(`there is no program ${PROGRAM}: build it first, or set PROGRAM`);
  const text = execFileSync(PROGRAM, [...words], { encoding: "utf8", maxBuffer: 1 << 28 });
  return JSON.parse(text);
}

/** The ids that the program sees in a scene, in object order and in image order. */
export function programIds(scene, ...options) {
  const folder = mkdtempSync(join(tmpdir(), "bothways-web-"));
  try {
    const words = [scene, "-o", join(folder, "out"), "--buffers", "npy", "--no-times", "--quiet", ...options];
    // 1 says that the orders differ, as they may by ordinary rules.
    const { status } = spawnSync(PROGRAM, words, { stdio: "ignore" });
    if (status !== 0 && status !== 1) throw new Error(`${words.join(" ")}: exit code ${status}`);
    return ["object", "image"].map((order) => npy(readFileSync(join(folder, "out", `${order}-order.ids.npy`))));
  } finally {
    rmSync(folder, { recursive: true });
  }
}

/** The 32-bit numbers of a NumPy file. */
function npy(bytes) {
  const begin = 10 + bytes.readUInt16LE(8);
  const numbers = bytes.subarray(begin);
  return Array.from({ length: numbers.length / 4 }, (_, index) => numbers.readUInt32LE(4 * index));
}

/** Asks again and again until something holds. */
export async function until(what, holds, seconds = 30) {
  const end = Date.now() + 1000 * seconds;
  for (;;) {
    const value = await holds();
    if (value) return value;
    if (Date.now() > end) throw new Error(`it never came to be: ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}

/** The text of an element as it is shown. */
export const text = (page, selector) => page.locator(selector).first().innerText();

/** How many pixels of the picture in object order are red, green and blue. */
export const colours = (page) =>
  page.evaluate(() => {
    const canvas = document.querySelector("canvas[data-picture=object]");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    const counts = [0, 0, 0];
    for (let at = 0; at < data.length; at += 4) {
      const [r, g, b] = data.subarray(at, at + 3);
      if (r > 150 && g + b < 100) counts[0]++;
      if (g > 150 && r + b < 100) counts[1]++;
      if (b > 150 && r + g < 100) counts[2]++;
    }
    return counts;
  });

/** Drops files on the page together: the content of each by its name, as text, as bytes, or as the number of bytes. */
export async function drop(page, files) {
  await page.evaluate((files) => {
    const transfer = new DataTransfer();
    for (const [name, content] of Object.entries(files)) {
      const part = typeof content === "string" ? content : new Uint8Array(content);
      transfer.items.add(new File([part], name));
    }
    document.body.dispatchEvent(new DragEvent("drop", { dataTransfer: transfer, bubbles: true, cancelable: true }));
  }, files);
}
