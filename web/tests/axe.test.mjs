// No serious fault by axe-core: in every chapter, light and dark, on a projector and on a phone.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, test } from "node:test";
import { CHAPTERS, open, require, stop, turnTo } from "./browser.mjs";

after(stop);

const source = readFileSync(require.resolve("axe-core/axe.min.js"), "utf8");

for (const [scheme, width, height] of [["light", 1440, 900], ["dark", 1440, 900], ["light", 390, 844]]) {
  test(`axe-core finds nothing serious: ${scheme}, ${width} x ${height}`, async () => {
    const { page, close } = await open({ scheme, width, height });
    await page.evaluate(source);
    for (const chapter of CHAPTERS) {
      await turnTo(page, chapter);
      const { violations } = await page.evaluate(() => window.axe.run());
      const serious = violations.filter(({ impact }) => impact === "serious" || impact === "critical");
      const told = serious.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html.slice(0, 120)).join(" | ")}`);
      assert.deepEqual(told, [], chapter);
    }
    await close();
  });
}
