// How long the page takes until its first picture, and how many frames a second it draws while one drags.
//
//     node web/tests/benchmark.mjs [SCENE ...]
//
// Both orders draw 640 × 480 pixels for every frame, in one worker: on one core. Nothing here is a test: machines differ.

import { engineIn, open, stop } from "./browser.mjs";

const SECONDS = 2;

async function firstPicture() {
  const { page, close } = await open();
  const times = await page.evaluate(() => {
    const [navigation] = performance.getEntriesByType("navigation");
    const paint = performance.getEntriesByName("first-contentful-paint")[0];
    return { paint: paint?.startTime, loaded: navigation.domContentLoadedEventEnd };
  });
  const ready = await page.evaluate(() => performance.now());
  console.log(`first paint (text and a still) ${Math.round(times.paint)} ms, ready at most ${Math.round(ready)} ms after opening`);
  await close();
}

/** Frames that the worker answers, one after another. */
async function worker(scene) {
  const { page, close } = await open();
  const engine = await engineIn(page);
  const { camera, primitives } = await engine.ask("open", { name: scene });
  const times = await page.evaluate(
    async ([camera, seconds]) => {
      const times = [];
      const end = performance.now() + 1000 * seconds;
      for (let frame = 0; performance.now() < end; frame++) {
        const eye = [camera.eye[0] + 0.02 * Math.sin(frame / 9), camera.eye[1], camera.eye[2]];
        const begun = performance.now();
        const answer = await window.ask("render", { camera: { ...camera, eye, height: 480, width: 640 } });
        if (!answer.ok) throw new Error(answer.error);
        times.push(performance.now() - begun);
      }
      return times.sort((one, other) => one - other);
    },
    [camera, SECONDS],
  );
  const [least, median] = [times[0], times[times.length >> 1]];
  console.log(
    `${scene} (${primitives} primitives), worker: median ${median.toFixed(1)} ms, least ${least.toFixed(1)} ms: ` +
      `${(1000 / median).toFixed(0)} to ${(1000 / least).toFixed(0)} frames a second`,
  );
  await close();
}

/** Frames that a reader sees while a pointer drags the picture. */
async function dragging(scene) {
  const { page, close } = await open({ hash: `#chapter=algorithms&scene=${scene}&image=480,640`, width: 1920, height: 1080 });
  await page.waitForTimeout(1500);
  await page.evaluate(() => {
    window.frames_seen = 0;
    const facts = document.getElementById("verdict");
    new MutationObserver(() => window.frames_seen++).observe(facts, { attributes: true, attributeFilter: ["data-match"] });
  });
  const { begun } = await drag(page, "canvas[data-picture=object]");
  const seconds = (Date.now() - begun) / 1000;
  const frames = await page.evaluate(() => window.frames_seen);
  await page.mouse.up();
  console.log(`${scene}, dragging in the page: ${(frames / seconds).toFixed(0)} frames a second`);
  await close();
}

/** Frames of the view from outside that a reader sees while a pointer turns it. */
async function turning(scene) {
  const { page, close } = await open({ hash: `#chapter=projection&scene=${scene}`, width: 1920, height: 1080 });
  await page.waitForTimeout(1500);
  await page.evaluate(() => {
    window.frames_seen = 0;
    const options = { attributes: true, attributeFilter: ["data-observer"] };
    new MutationObserver((changes) => (window.frames_seen += changes.length)).observe(document.getElementById("outside"), options);
  });
  const { begun, box } = await drag(page, "#outside");
  const seconds = (Date.now() - begun) / 1000;
  const frames = await page.evaluate(() => window.frames_seen);
  await page.mouse.up();
  const size = `${Math.round(box.width)} x ${Math.round(box.height)}`;
  console.log(`${scene}, turned from outside on ${size} pixels: ${(frames / seconds).toFixed(0)} frames a second`);
  await close();
}

/** Drags something for some seconds, and leaves the button down. */
async function drag(page, selector) {
  const box = await page.locator(selector).first().boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  const begun = Date.now();
  for (let move = 0; Date.now() - begun < 1000 * SECONDS; move++) {
    await page.mouse.move(x + 100 * Math.sin(move / 30), y + 40 * Math.cos(move / 23));
  }
  return { begun, box };
}

await firstPicture();
for (const scene of process.argv.length > 2 ? process.argv.slice(2) : ["lecture", "canonical"]) {
  await worker(scene);
  await dragging(scene);
  await turning(scene);
}
await stop();
