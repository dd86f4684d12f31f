// The page in Debian's Firefox, where it is installed and runs headless: it gives the same ids there.

import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { CHAPTERS, PAGE, require, until } from "./browser.mjs";

const FIREFOX = process.env.FIREFOX ?? "/usr/bin/firefox-esr";
const skip = existsSync(FIREFOX) ? false : "there is no Firefox";

test("it runs in Firefox, from a file", { skip, timeout: 180_000 }, async () => {
  const puppeteer = require("puppeteer-core");
  const browser = await puppeteer.launch({ browser: "firefox", executablePath: FIREFOX, headless: true });
  try {
    const page = await browser.newPage();
    const said = [];
    page.on("console", (message) => said.push(message.text()));
    page.on("pageerror", (error) => said.push(String(error)));
    await page.goto(pathToFileURL(PAGE).href);
    // Puppeteer's own waiting evaluates texts, which the policy of the page refuses.
    await until("the page to be ready", () => page.evaluate(() => document.documentElement.dataset.ready === "yes"), 120);
    const verdict = () => page.evaluate(() => document.getElementById("verdict-text").textContent);
    await until("a verdict", async () => (await verdict()).startsWith("match"), 60);
    for (const chapter of CHAPTERS) {
      await page.evaluate((hash) => void (location.hash = hash), `#chapter=${chapter}`);
      await new Promise((resolve) => setTimeout(resolve, 800));
    }
    // Two more workers record the steps, for the chapter that shows them: on a slow machine it may have been left before its scene
    // was open.
    await page.evaluate(() => void (location.hash = "#chapter=loops"));
    const total = () => page.evaluate(() => document.getElementById("steps-total").textContent);
    await until("a record of the loops", async () => /[1-9]/.test(await total()));
    assert.deepEqual(said, []);
  } finally {
    await browser.close();
  }
});
