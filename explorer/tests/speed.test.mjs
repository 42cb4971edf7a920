// Budgets of time, bytes and layout, measured in a browser.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { deflateRawSync, gzipSync } from "node:zlib";
import { atStep, browser, caption, lessonsOf, open, serve } from "./browser.mjs";

/** Time in which a frame has to be shown after a key, in milliseconds, and how often a slow lesson is tried: other work of the machine delays some. */
const SOON = 16;
const TRIES = 4;
/** Steps that are measured from the start of a run, and as many from its middle. */
const MEASURED = 4;
/** Median of the time from a seek to any step of a long run to its frame: twenty frames a second. */
const SCRUBBED = 50;
/** Bytes of the first view, the list of lessons by gzip with it; the modules come later. */
const FIRST_VIEW = 300_000;
/** Time to the list and to the first step of a lesson, and the layout shift that Lighthouse calls good. */
const FIRST_STEP = 2_500;
const SHIFT = 0.1;

let server;
let chromium;
let lessons;

before(async () => {
  server = await serve();
  chromium = await browser();
  lessons = await lessonsOf();
});

after(async () => {
  await chromium?.close();
  server?.close();
});

const median = (values) => values.toSorted((a, b) => a - b)[values.length >> 1] ?? 0;
const largest = (values) => Math.max(0, ...values);

/** Returns the times from keys to the frames of the next steps, at the start of a run and in its middle. */
function keysToFrames(page) {
  return page.evaluate(async (measured) => {
    const range = document.querySelector(".scrubber");
    const steps = Number(range.max);
    const press = (key) => document.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
    // A hand takes longer than this from key to key.
    const pause = () => new Promise((resolve) => setTimeout(resolve, 40));
    const times = [];
    for (const start of steps >= 4 * measured ? [0, steps >> 1] : [0]) {
      range.value = String(start);
      range.dispatchEvent(new Event("input"));
      await pause();
      for (let k = 0; k < Math.min(measured, steps); k++) {
        await pause();
        times.push(
          await new Promise((resolve) => {
            const start = performance.now();
            const watch = new MutationObserver(() => {
              watch.disconnect();
              resolve(performance.now() - start);
            });
            watch.observe(document.querySelector(".drawing"), { childList: true });
            press("ArrowRight");
          }),
        );
      }
    }
    return times;
  }, MEASURED);
}

test("a frame is shown soon after a key", async (t) => {
  const { page, faults, close } = await open(chromium, `${server.url}#a=bresenham&lang=en`);
  await atStep(page, 1);
  const slow = [];
  for (const { name, title, examples } of lessons) {
    await page.evaluate((hash) => (location.hash = hash), `#a=${name}&ex=${examples[0].name}&lang=en`);
    await page.waitForFunction((title) => document.title.startsWith(title), title.en);
    await atStep(page, 1);
    const tries = [];
    do tries.push(await keysToFrames(page));
    while (median(tries.at(-1)) > SOON && tries.length < TRIES);
    t.diagnostic(`${name}: median ${median(tries.at(-1)).toFixed(1)} ms, largest ${largest(tries.at(-1)).toFixed(1)} ms`);
    if (Math.min(...tries.map(median)) > SOON) slow.push(`${name}: ${tries.map((times) => median(times).toFixed(1)).join(", ")} ms`);
  }
  assert.deepEqual(slow, []);
  assert.deepEqual(faults, []);
  await close();
});

/** Returns an input of which each face lies before the one before it: every pixel of the square is stored every time. */
function packedFaces(count) {
  const side = 30;
  const face = (_, k) => [[0, 0], [side, 0], [side, side], [0, side]].map(([x, y]) => [x, y, k]);
  return deflateRawSync(JSON.stringify({ faces: Array.from({ length: count }, face) })).toString("base64url");
}

/** Returns the times from seeks to the frames of steps far apart, in an order that does not help: none of them is at hand. */
function seeks(page, steps, round) {
  return page.evaluate(async ([steps, round]) => {
    const range = document.querySelector(".scrubber");
    const times = [];
    for (let k = 1; k <= 60; k++) {
      const step = ((k + 60 * round) * 61_803) % steps;
      const start = performance.now();
      range.value = String(step);
      range.dispatchEvent(new Event("input"));
      await new Promise((resolve) => {
        const watch = new MutationObserver(() => {
          if (!document.querySelector(".place").textContent.startsWith(`${step + 1} /`)) return;
          watch.disconnect();
          resolve();
        });
        watch.observe(document.querySelector(".transport"), { childList: true, subtree: true });
      });
      times.push(performance.now() - start);
    }
    return times;
  }, [steps, round]);
}

test("a long run is shown from its first steps on, and scrubbed", async (t) => {
  const { page, faults, close } = await open(chromium, `${server.url}#a=z-buffer-loop&in=${packedFaces(60)}&lang=en&step=9000`);
  // The first steps are there before the others, and the step of the link is reached when it is.
  await page.waitForFunction(() => document.querySelector(".place")?.textContent === "4001 / 4001");
  await page.waitForFunction(() => /^9000 \/ /.test(document.querySelector(".place").textContent), undefined, { timeout: 120_000 });
  const steps = await page.evaluate(() => Number(document.querySelector(".scrubber").max) + 1);
  assert.ok(steps >= 100_000, `${steps} steps`);
  const before = await caption(page);
  await page.keyboard.press("ArrowRight");
  await atStep(page, 9001);
  assert.notEqual(await caption(page), before);
  // The scrubber goes anywhere, and drops what is not looked at.
  await page.evaluate(() => {
    const range = document.querySelector(".scrubber");
    for (let step = 0; step < 9000; step += 45) {
      range.value = String(step);
      range.dispatchEvent(new Event("input"));
    }
  });
  await atStep(page, 8956);
  const tries = [];
  do tries.push(await seeks(page, steps, tries.length));
  while (median(tries.at(-1)) > SCRUBBED && tries.length < TRIES);
  const times = tries.at(-1).toSorted((a, b) => a - b);
  t.diagnostic(`${steps} steps, seeks: median ${median(times).toFixed(1)} ms, 95 % ${times[Math.floor(times.length * 0.95)].toFixed(1)} ms, largest ${largest(times).toFixed(1)} ms`);
  assert.ok(median(times) <= SCRUBBED, tries.map((times) => `${median(times).toFixed(1)} ms`).join(", "));
  assert.deepEqual(faults, []);
  await close();
});

/** Opens a page and returns the bytes that it loaded, the time until something is there, and how far the layout shifted until then and after steps. */
async function measured(address, ready, options) {
  const { page, faults, close } = await open(chromium, "about:blank", options);
  await page.addInitScript(() => {
    globalThis.shift = 0;
    new PerformanceObserver((list) => list.getEntries().forEach((entry) => (globalThis.shift += entry.hadRecentInput ? 0 : entry.value))).observe({ type: "layout-shift", buffered: true });
  });
  const bodies = [];
  page.on("response", (response) => bodies.push(response.body().then((body) => [new URL(response.url()).pathname.split("/").at(-1), body])));
  await page.goto(`${server.url}?measured#${address}`);
  await page.waitForSelector(ready, { state: "attached" });
  const time = await page.evaluate(() => performance.now());
  // Steps whose captions and tables are of other sizes.
  for (let k = 0; k < 6; k++) {
    await page.evaluate(() => {
      const range = document.querySelector(".scrubber");
      if (!range) return;
      range.value = String(Number(range.value) + 1);
      range.dispatchEvent(new Event("input"));
    });
    await page.waitForTimeout(100);
  }
  const shift = await page.evaluate(() => globalThis.shift);
  const loaded = await Promise.all(bodies);
  assert.deepEqual(faults, []);
  await close();
  return { time, shift, loaded };
}

test("the first view is small, early and still", async (t) => {
  for (const [width, address, ready] of [
    [1280, "lang=en", ".family li"],
    [375, "lang=de", ".family li"],
    [1280, "a=weiler-atherton&lang=en", ".drawing svg"],
    [1280, "a=cohen-sutherland&lang=de", ".drawing svg"],
    [375, "a=weiler-atherton&lang=de", ".drawing svg"],
    [375, "a=edge-table&lang=en", ".drawing svg"],
  ]) {
    const { time, shift, loaded } = await measured(address, ready, { viewport: { width, height: 800 } });
    const bytes = loaded.filter(([name]) => !name.endsWith(".wasm")).reduce((sum, [name, body]) => sum + (name === "lessons.json" ? gzipSync(body).length : body.length), 0);
    t.diagnostic(`${address} at ${width}: ${bytes} bytes, shown after ${time.toFixed(0)} ms, layout shift ${shift.toFixed(3)}`);
    assert.ok(bytes > 50_000 && bytes <= FIRST_VIEW, `${address}: ${bytes} bytes`);
    assert.ok(time <= FIRST_STEP, `${address}: ${time} ms`);
    assert.ok(shift <= SHIFT, `${address} at ${width}: layout shift ${shift}`);
    // A lesson loads the module that has it, and no other one.
    assert.deepEqual(loaded.map(([name]) => name).filter((name) => name.endsWith(".wasm")), address.startsWith("a=") ? ["durer-plane.wasm"] : []);
  }
});
