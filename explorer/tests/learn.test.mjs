// Questions, exercises, copies and own inputs, in a browser.

import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { readFile } from "node:fs/promises";
import { after, before, test } from "node:test";
import { accessible, atStep, browser, caption, drawing, lessonsOf, open, serve } from "./browser.mjs";

const READERS = { skip: !existsSync(new URL("../dist/durer-files.wasm", import.meta.url)) && "built without readers of files" };
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

/** Returns the way from coordinates of the input to places of the page, by two opposite corners of the window. */
async function places(page, low, high) {
  const middle = async (index) => {
    const { x, y, width, height } = await page.locator(`[data-ref="window-0-${index}"]`).boundingBox();
    return [x + width / 2, y + height / 2];
  };
  const [a, b] = [await middle(0), await middle(2)];
  return (at) => at.map((value, k) => a[k] + ((value - low[k]) * (b[k] - a[k])) / (high[k] - low[k]));
}

test("the quiz asks for places in the picture", async () => {
  const { page, faults, close } = await open(chromium, `${server.url}#a=cohen-sutherland&ex=line-eh&lang=en`);
  await atStep(page, 1);
  await page.click("#tab-quiz");
  await page.locator(".stage").scrollIntoViewIfNeeded();
  const placeOf = await places(page, [0, 0], [10, 6]);
  // Nothing moves when the quiz starts but what is below the picture.
  const top = (await page.locator(".stage").boundingBox()).y;
  const clickAt = async (at) => {
    const [x, y] = placeOf(at);
    await page.mouse.click(x, y + (await page.locator(".stage").boundingBox()).y - top);
  };
  await page.click(".quiz .primary");
  await page.waitForFunction(() => document.querySelector(".question").textContent.includes("in the picture"));
  assert.equal(await page.locator(".handle").count(), 0, "handles would take the clicks");
  // EH from (−3, 1.5) to (13, 4) meets the left border x = 0 at y = 1.96875.
  await clickAt([0, 1.97]);
  await atStep(page, 2);
  assert.match(await page.textContent(".verdict"), /Right/);
  await page.waitForFunction(() => document.querySelector(".question").textContent.includes("in the picture"));
  await clickAt([2, 5]);
  await atStep(page, 3);
  assert.match(await page.textContent(".verdict"), /No/);
  assert.match(await page.textContent(".score"), /1 \/ 2/);
  await accessible(page, "quiz");
  // The last step has no place of its own: its kind is asked for.
  await page.waitForSelector(".answers button");
  await page.click(".quiz-bar .quiet");
  assert.ok((await page.locator(".handle").count()) > 0);
  assert.deepEqual(faults, []);
  await close();
});

test("a pixel is answered by keys alone", async () => {
  const { page, faults, close } = await open(chromium, `${server.url}#a=bresenham&lang=de`);
  await atStep(page, 1);
  await page.click("#tab-quiz");
  await page.click(".quiz .primary");
  await page.waitForFunction(() => document.querySelector(".question").textContent.includes("das Pixel"));
  const table = await page.textContent(".state td");
  const [x, y] = table.match(/-?\d+/g).map(Number);
  const cross = page.locator(".cross.asks");
  await cross.focus();
  const at = async () => (await cross.getAttribute("aria-label")).match(/\((.*); (.*)\)/).slice(1).map(Number);
  // The first example rises by one pixel in several columns: the next pixel lies to the right, in one of two rows.
  const [cx, cy] = await at();
  const way = (from, to, more, less) => Array(Math.abs(to - from)).fill(to > from ? more : less);
  for (const key of [...way(cx, x + 1.5, "ArrowRight", "ArrowLeft"), ...way(cy, y + 0.5, "ArrowUp", "ArrowDown")]) await page.keyboard.press(key);
  assert.deepEqual(await at(), [x + 1.5, y + 0.5]);
  await page.keyboard.press("Enter");
  await atStep(page, 2);
  const [, row] = (await page.locator(".state tbody tr").nth(1).locator("td").first().textContent()).match(/-?\d+/g).map(Number);
  assert.match(await page.textContent(".verdict"), row === y ? /Richtig/ : /Nein/);
  assert.deepEqual(faults, []);
  await close();
});

/** Waits until a question is asked, and returns it. */
async function question(page, part) {
  await page.waitForFunction((part) => document.querySelector(".question").textContent.includes(part), part);
}

test("outcodes and decisions are answered by keys, by number", async () => {
  const { page, faults, close } = await open(chromium, `${server.url}#a=cohen-sutherland&ex=line-eh&lang=en`);
  await atStep(page, 1);
  const codes = async () => (await page.locator(".drawing svg text").allTextContents()).filter((text) => /^[01]{4}$/.test(text));
  assert.ok((await codes()).includes("0000"));
  await page.click("#tab-quiz");
  await page.click("[data-mode=number]");
  await page.click(".quiz .primary");
  // E (−3, 1.5) is left of the window, H (13, 4) right of it. Nothing tells: not the caption, the table, or the picture.
  await question(page, "outcode of A");
  assert.deepEqual(await codes(), []);
  for (const hidden of [".picture-pane .caption", ".state-pane .state"]) assert.equal(await page.locator(hidden).isVisible(), false, hidden);
  await page.keyboard.press("4");
  assert.equal(await page.locator(".bit .digit").allTextContents().then((all) => all.join("")), "0001");
  await page.keyboard.press("Enter");
  await question(page, "outcode of B");
  assert.match(await page.textContent(".score"), /1 \/ 1/);
  await accessible(page, "outcode");
  await page.keyboard.press("1");
  await page.keyboard.press("1");
  await page.keyboard.press("3");
  await page.keyboard.press("Enter");
  // Both are right: the step is shown, and the next one is asked for.
  await question(page, "What happens to the line");
  assert.ok(await page.locator(".picture-pane .caption").isVisible());
  assert.match(await page.textContent(".verdict"), /Right.*0001.*0010/);
  assert.ok((await codes()).includes("0000"));
  await atStep(page, 1);
  await page.keyboard.press("3");
  // The line is cut at the left border; what is left begins inside.
  await question(page, "outcode of the new end");
  await page.keyboard.press("4");
  await page.keyboard.press("Enter");
  await atStep(page, 2);
  assert.match(await page.textContent(".verdict"), /No.*code 0000/);
  await question(page, "What happens to the line");
  await page.click("[data-decision=rejected]");
  await atStep(page, 3);
  assert.match(await page.textContent(".verdict"), /No/);
  assert.match(await page.textContent(".score"), /3 \/ 5/);
  assert.deepEqual(faults, []);
  await close();
});

test("a click in a region answers with its outcode, in German", async () => {
  const { page, faults, close } = await open(chromium, `${server.url}#a=cohen-sutherland&ex=line-ad&lang=de`);
  await atStep(page, 1);
  // Corners of the window, from the corner of the picture.
  const [stage, low, high] = await Promise.all([".stage", '[data-ref="window-0-0"]', '[data-ref="window-0-2"]'].map((name) => page.locator(name).boundingBox()));
  await page.click("#tab-quiz");
  await page.click("[data-mode=number]");
  await page.click(".quiz .primary");
  await question(page, "Outcode von A");
  const bits = () => page.locator(".bit .digit").allTextContents().then((all) => all.join(""));
  const clickAt = (x, y) => page.locator(".stage").click({ position: { x: x - stage.x, y: y - stage.y } });
  // Left of the window, at the height of its middle; then above and left of it.
  await clickAt(low.x - 40, (low.y + high.y) / 2);
  assert.equal(await bits(), "0001");
  await clickAt(low.x - 40, high.y - 20);
  assert.equal(await bits(), "1001");
  await clickAt(low.x - 40, (low.y + high.y) / 2);
  await page.click(".check");
  await question(page, "Outcode von B");
  assert.match(await page.textContent(".verdict"), /Richtig/);
  // D (3, 9.5) is above; "oben" is the first bit.
  await page.click('.bit[aria-label="Bit 1: oben"]');
  await page.click(".check");
  await question(page, "Was geschieht jetzt");
  assert.deepEqual(await page.locator(".decisions button").allTextContents(), ["1annehmen", "2ablehnen", "3schneiden"]);
  assert.deepEqual(faults, []);
  await close();
});

test("a link copied while the quiz runs begins with it, in a frame, too", async () => {
  const { page, faults, close } = await open(chromium, `${server.url}#a=cohen-sutherland&ex=line-eh&lang=en`);
  await atStep(page, 1);
  await page.click("#tab-quiz");
  await page.click("[data-mode=kind]");
  await page.click(".quiz .primary");
  await page.waitForFunction(() => location.hash.includes("ask=kind"));
  for (const embed of ["", "&embed=1"]) {
    const other = await open(chromium, page.url() + embed);
    await atStep(other.page, 1);
    await question(other.page, "What happens next?");
    await other.page.click(".answers button[data-template='1']");
    await atStep(other.page, 2);
    assert.match(await other.page.textContent(".verdict"), /Right/);
    assert.deepEqual(other.faults, []);
    await other.close();
  }
  await page.click(".quiz-bar .quiet");
  await page.waitForFunction(() => !location.hash.includes("ask="));
  assert.deepEqual(faults, []);
  await close();
});

test("lessons with programs have bugs to be found", async () => {
  const { page, faults, close } = await open(chromium, `${server.url}#a=bresenham&lang=en`);
  await atStep(page, 1);
  const withBugs = lessons.filter((lesson) => lesson.faults.length > 0);
  assert.ok(withBugs.length >= 5);
  const { faults: bugs, pseudocode } = withBugs.find((lesson) => lesson.name === "bresenham");
  const right = await drawing(page);
  await page.click("#tab-exercises");
  await page.click("[data-bug=bugStart]");
  await page.waitForFunction(() => location.hash.includes("bug="));
  const bug = bugs[Number(/bug=(\d+)/.exec(page.url())[1]) - 1];
  await page.keyboard.press("End");
  const other = bugs.find(({ line }) => line !== bug.line).line;
  await page.locator(".line").nth(other - 1).click();
  assert.match(await page.textContent(".bug-bar .verdict"), new RegExp(`Line ${other} is right`));
  await page.locator(".line").nth(bug.line - 1).click();
  const told = await page.textContent(".bug-bar");
  assert.ok(told.includes("try 2") && told.includes(bug.wrong) && told.includes(pseudocode[bug.line - 1].trim()), told);
  await page.click("[data-bug=bugEnd]");
  await page.waitForFunction(() => !location.hash.includes("bug="));
  await atStep(page, 1);
  assert.equal(await drawing(page), right);
  assert.equal(await page.locator(".bug-bar").isVisible(), false);
  assert.deepEqual(faults, []);
  await close();
});

test("titles and kinds are in German", async () => {
  const { page, faults, close } = await open(chromium, `${server.url}#a=edge-table&lang=de`);
  await atStep(page, 1);
  assert.equal(await page.textContent("h1"), "Kantentabelle und Tabelle der aktiven Kanten");
  const kinds = (await page.textContent(".kinds")).toLowerCase();
  for (const kind of ["tabelle", "eintritt", "aktiv", "strecke", "austritt"]) assert.ok(kinds.includes(kind), kinds);
  assert.deepEqual(faults, []);
  await close();
});

test("narrow screens show one pane at a time, with targets for fingers", async () => {
  const { page, faults, close } = await open(chromium, `${server.url}#a=vatti&lang=en`, { viewport: { width: 375, height: 800 }, hasTouch: true });
  await atStep(page, 1);
  const shown = async () => Promise.all([".code-pane", ".state-pane", ".text-twin"].map((name) => page.locator(name).isVisible()));
  assert.deepEqual(await shown(), [true, false, false]);
  await page.click("[data-pane=state]");
  assert.deepEqual(await shown(), [false, true, false]);
  await page.click("[data-pane=text]");
  assert.deepEqual(await shown(), [false, false, true]);
  await page.waitForFunction(() => document.querySelectorAll(".captions button").length > 3);
  const small = await page.evaluate(() =>
    [...document.querySelectorAll("main button, main select, main .button")].filter((one) => one.offsetHeight > 0 && one.getBoundingClientRect().height < 43.5).map((one) => one.textContent),
  );
  assert.deepEqual(small, []);
  assert.deepEqual(faults, []);
  await close();
});

/** Returns the chunks of a PNG. */
function chunks(png) {
  const found = [];
  for (let at = 8; at < png.length; at += 12 + png.readUInt32BE(at)) found.push(png.toString("latin1", at + 4, at + 8));
  return found;
}

test("a run is saved as an animation, and copied as Python", async () => {
  const { page, faults, close } = await open(chromium, `${server.url}#a=cohen-sutherland&ex=line-eh&lang=en`);
  await atStep(page, 1);
  await page.click("#tab-share");
  const [download] = await Promise.all([page.waitForEvent("download"), page.click("[data-copy=copyApng]")]);
  assert.equal(download.suggestedFilename(), "cohen-sutherland.png");
  const file = await readFile(await download.path());
  const found = chunks(file);
  assert.deepEqual([found[0], found[1], found.at(-1)], ["IHDR", "acTL", "IEND"]);
  assert.equal(found.filter((type) => type === "fcTL").length, 4);
  // The browser takes it as an animation of four pictures.
  const count = await page.evaluate(async (bytes) => {
    const decoder = new ImageDecoder({ data: Uint8Array.from(bytes), type: "image/png" });
    await decoder.tracks.ready;
    await decoder.decode({ frameIndex: 3 });
    return decoder.tracks.selectedTrack.frameCount;
  }, [...file]);
  assert.equal(count, 4);
  await page.click("[data-copy=copyPython]");
  const python = await page.inputValue("#panel-share textarea");
  assert.match(python, /^import durer\n\nsteps = durer\.trace\("cohen-sutherland", example="line-eh"\)\n/);
  assert.deepEqual(faults, []);
  await close();
});

test("a formula gives the curves of the floating horizon", READERS, async () => {
  const { page, faults, close } = await open(chromium, `${server.url}#a=horizon-curves&lang=en`);
  await atStep(page, 1);
  const before = await caption(page);
  await page.fill("#formula", "3 * sinc(2 * r");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => !document.querySelector(".picture-pane .notice").hidden);
  assert.match(await page.textContent(".picture-pane .notice"), /column/);
  await page.fill("#formula", "3 * sinc(2 * r)");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => Number(document.querySelector(".place").textContent.split("/")[1]) > 300);
  assert.notEqual(await caption(page), before);
  assert.deepEqual(faults, []);
  await close();
});
