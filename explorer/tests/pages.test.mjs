// The pages in a browser.

import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { accessible, atStep, browser, caption, drawing, lessonsOf, open, serve } from "./browser.mjs";

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

test("the list has every algorithm, finds them, and is accessible", async () => {
  const { page, faults, close } = await open(chromium, `${server.url}#lang=en`);
  await page.waitForSelector(".family li");
  assert.equal(await page.locator(".family li").count(), lessons.length);
  await page.fill("#find", "weiler");
  assert.equal(await page.locator(".family li:visible").count() > 0, true);
  assert.equal(await page.locator(".family li:visible").count() < 5, true);
  await accessible(page, "list");
  assert.deepEqual(faults, []);
  await close();
});

test("every lesson opens, steps to the end and back to the same picture", async () => {
  const { page, faults, close } = await open(chromium, `${server.url}#lang=en`);
  await page.waitForSelector(".family li");
  for (const { name } of lessons) {
    await page.evaluate((name) => (location.hash = `#a=${name}&lang=en`), name);
    await page.waitForFunction((title) => document.title.startsWith(title), lessons.find((own) => own.name === name).title.en);
    await atStep(page, 1);
    const first = await drawing(page);
    await page.keyboard.press("End");
    const steps = await page.evaluate(() => Number(document.querySelector(".place").textContent.split("/")[1]));
    await atStep(page, steps);
    assert.notEqual(await caption(page), "", name);
    await page.keyboard.press("Home");
    await atStep(page, 1);
    assert.equal(await drawing(page), first, name);
    assert.equal(await page.locator(".line.runs").count(), 1, name);
    assert.ok((await page.locator(".idea").count()) > 0, `${name} has no idea`);
  }
  assert.deepEqual(faults, []);
  await close();
});

test("keys step, and the quiz asks before it shows", async () => {
  const { page, faults, close } = await open(chromium, `${server.url}#a=cohen-sutherland&ex=line-eh&lang=en`);
  await atStep(page, 1);
  await page.keyboard.press("ArrowRight");
  await atStep(page, 2);
  await page.keyboard.press("Shift+ArrowRight");
  await atStep(page, 3);
  await page.keyboard.press("ArrowLeft");
  await atStep(page, 2);
  await page.keyboard.press("Home");
  await atStep(page, 1);
  await page.click("#tab-quiz");
  await page.click(".quiz [data-mode=kind]");
  await page.click(".quiz .primary");
  await page.click(".step.next");
  await page.waitForTimeout(100);
  assert.match(await page.textContent(".place"), /^1 /, "the quiz hides the next step");
  // After the codes of EH comes a cut.
  await page.click(".answers button[data-template='1']");
  await atStep(page, 2);
  assert.match(await page.textContent(".verdict"), /Right/);
  await page.click(".answers button:not([data-template='1'])");
  await atStep(page, 3);
  assert.match(await page.textContent(".verdict"), /No/);
  assert.match(await page.textContent(".score"), /1 \/ 2/);
  assert.deepEqual(faults, []);
  await close();
});

test("a dragged vertex changes the run, and a link holds it", async () => {
  const { page, faults, close } = await open(chromium, `${server.url}#a=sutherland-hodgman&lang=de`);
  await atStep(page, 1);
  const before = await caption(page);
  const handle = page.locator(".handle.rings").first();
  const box = await handle.boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 60, y + 20, { steps: 6 });
  await page.mouse.up();
  await page.waitForFunction((before) => document.querySelector(".picture-pane .caption").textContent !== before, before);
  await page.waitForFunction(() => location.hash.includes("in="));
  await page.waitForTimeout(400);
  // Runs for places on the way may end after the button is up.
  const after = await caption(page);
  const other = await open(chromium, page.url());
  await atStep(other.page, 1);
  assert.equal(await caption(other.page), after);
  await other.close();
  // Keys move, add and delete vertices, and undo takes all back.
  const count = () => page.locator(".handle.rings").count();
  const vertices = await count();
  await page.click("#tab-input");
  await page.getByRole("button", { name: "Ecke hinzufügen" }).click();
  await page.waitForFunction((n) => document.querySelectorAll(".handle.rings").length === n, vertices + 1);
  await page.locator(".handle.rings").first().focus();
  await page.keyboard.press("Delete");
  await page.waitForFunction((n) => document.querySelectorAll(".handle.rings").length === n, vertices);
  for (let k = 0; k < 3; k++) await page.getByRole("button", { name: "Rückgängig" }).click();
  await page.waitForFunction((before) => document.querySelector(".picture-pane .caption").textContent === before, before);
  assert.deepEqual(faults, []);
  await close();
});

test("a polygon is drawn anew by clicks, and by keys", async () => {
  const { page, faults, close } = await open(chromium, `${server.url}#a=weiler-atherton&lang=en`);
  await atStep(page, 1);
  const steps = await page.textContent(".place");
  const clip = page.locator(".handle.clip");
  const corners = await clip.count();
  // Two corners of the clip polygon give the scale: a is (0, 10), c is (10, 0).
  const middle = async (index) => clip.nth(index).boundingBox().then(({ x, y, width, height }) => [x + width / 2, y + height / 2]);
  const measured = async () => [await middle(0), await middle(2), await page.locator(".stage").boundingBox()];
  let places = await measured();
  const clickAt = ([x, y]) => {
    const [a, c, stage] = places;
    const [u, v] = [a[0] + (x * (c[0] - a[0])) / 10, a[1] + ((10 - y) * (c[1] - a[1])) / 10];
    return page.locator(".stage").click({ position: { x: u - stage.x, y: v - stage.y } });
  };
  await page.click("[data-sketch=rings]");
  assert.equal(await page.locator(".handle").count(), 0, "handles would take the clicks");
  for (const at of [[2, 2], [14, 5], [2, 8]]) await clickAt(at);
  assert.equal(await page.locator(".sketch circle").count(), 3);
  await accessible(page, "drawing");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => document.querySelectorAll(".handle.rings").length === 3);
  assert.equal(await page.locator(".sketch").count(), 0);
  assert.equal(await page.locator(".handle.clip").count(), corners);
  assert.match(await page.inputValue("#numbers"), /\[2,2\],\[14,5\],\[2,8\]/);
  // A click on the first vertex closes it, too; Escape leaves all as it was.
  places = await measured();
  await page.click("[data-sketch=clip]");
  for (const at of [[1, 1], [9, 1], [9, 9], [1, 1]]) await clickAt(at);
  await page.waitForFunction(() => document.querySelectorAll(".handle.clip").length === 3);
  await page.click("[data-sketch=rings]");
  await clickAt([3, 3]);
  await page.keyboard.press("Escape");
  await page.waitForFunction(() => document.querySelectorAll(".handle.rings").length === 3);
  for (let k = 0; k < 2; k++) await page.keyboard.press("Control+z");
  await page.waitForFunction((steps) => document.querySelector(".place").textContent === steps, steps);
  // By keys: the cross begins in the middle, Enter sets a vertex there.
  await page.click("[data-sketch=rings]");
  await page.locator(".cross.asks").focus();
  for (const way of ["ArrowLeft", "ArrowUp", "ArrowRight"]) {
    await page.keyboard.press("Enter");
    for (let k = 0; k < 20; k++) await page.keyboard.press(way);
  }
  await page.click("[data-sketch=done]");
  await page.waitForFunction(() => document.querySelectorAll(".handle.rings").length === 3);
  assert.deepEqual(faults, []);
  await close();
});

test("each language has an address, whatever the browser prefers", async () => {
  for (const [folder, locale, title, other] of [
    ["de/", "en-US", "Strahlverfolgung", "Ray casting and tracing"],
    ["en/", "de-DE", "Ray casting and tracing", "Strahlverfolgung"],
  ]) {
    const { page, faults, close } = await open(chromium, `${server.url}${folder}`, { locale });
    await page.waitForSelector(".family li");
    await page.locator(".family a", { hasText: title }).first().click();
    await atStep(page, 1);
    assert.ok(page.url().includes(`/${folder}#`), page.url());
    assert.equal(await page.textContent("h1"), title);
    // The other language is one click away, and the icon was found.
    await page.locator(".settings button").first().click();
    await page.waitForFunction((other) => document.querySelector("h1")?.textContent === other, other);
    assert.ok(await page.locator(".brand img").evaluate((image) => image.naturalWidth > 0));
    assert.deepEqual(faults, []);
    await close();
  }
});

test("languages, themes and narrow screens keep everything readable", async () => {
  for (const [width, colorScheme, lang] of [[1280, "light", "en"], [375, "dark", "de"], [320, "light", "de"]]) {
    const { page, faults, close } = await open(chromium, `${server.url}#a=weiler-atherton&lang=${lang}`, { viewport: { width, height: 800 }, colorScheme });
    await atStep(page, 1);
    await accessible(page, `${width} ${colorScheme}`);
    const overflow = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert.ok(overflow <= 0, `${width}: ${overflow} pixels wider than the screen`);
    assert.equal(await page.getAttribute("html", "lang"), lang);
    for (const tab of ["quiz", "exercises", "compare", "share"]) {
      await page.click(`#tab-${tab}`);
      await accessible(page, `${width} ${tab}`);
    }
    assert.deepEqual(faults, []);
    await close();
  }
});

test("algorithms are compared on one input by one scrubber", async () => {
  const { page, faults, close } = await open(chromium, `${server.url}#a=cohen-sutherland&ex=line-eh&lang=en&with=liang-barsky`);
  await atStep(page, 1);
  await page.click("#tab-compare");
  await page.waitForSelector(".card .drawing svg");
  await page.keyboard.press("End");
  await atStep(page, 4);
  await page.waitForFunction(() => /^(\d+) \/ \1 /.test(document.querySelector(".card .caption").textContent));
  assert.match(await page.textContent("#panel-compare table"), /Liang/);
  // The counts can be guessed before they are shown; each new run asks again.
  const steps = await page.locator("#panel-compare tbody tr").first().locator("td").allTextContents().then((all) => all.map(Number));
  assert.notEqual(steps[0], steps[1]);
  await page.click("[data-guess]");
  assert.equal(await page.locator("#panel-compare table").count(), 0);
  await page.locator("#panel-compare .answers button").nth(steps[0] < steps[1] ? 0 : 1).click();
  assert.match(await page.textContent("#panel-compare .verdict"), /Right/);
  assert.equal(await page.locator("#panel-compare table").count(), 1);
  await page.click("#tab-input");
  await page.click(".example[data-name=line-ad]");
  await page.click("#tab-compare");
  await page.waitForSelector("#panel-compare .answers button");
  assert.equal(await page.locator("#panel-compare table").count(), 0);
  await accessible(page, "guess");
  assert.deepEqual(faults, []);
  await close();
});

test("wrong addresses and inputs are answered in words", async () => {
  const { page, faults, close } = await open(chromium, `${server.url}#a=none&lang=en`);
  await page.waitForSelector(".notice");
  assert.match(await page.textContent(".notice"), /no such algorithm: none/);
  await page.evaluate(() => (location.hash = "#a=bresenham&in=%%%&step=99999&lang=en"));
  await page.waitForSelector(".drawing svg");
  assert.match(await page.textContent(".picture-pane .notice"), /cannot be read/);
  await page.click("#tab-input");
  await page.click(".panel details summary");
  await page.fill("#numbers", '{"faces": []}');
  await page.getByRole("button", { name: "Apply" }).click();
  await page.waitForFunction(() => /faces in space/.test(document.querySelector(".picture-pane .notice").textContent));
  assert.deepEqual(faults, []);
  await close();
});

test("a frame in another page reports its step and goes where it is sent", async () => {
  for (const address of ["./#a=bresenham&lang=en&embed=1", "./?embed#a=bresenham&lang=en"]) {
    const { page, faults, close } = await open(chromium, "about:blank");
    const listener = "<script>told = []; addEventListener('message', (event) => told.push(event.data))</script>";
    const body = `${listener}<iframe src="${address}" width="640" height="560"></iframe>`;
    await page.route("**/around.html", (route) => route.fulfill({ body, contentType: "text/html" }));
    await page.goto(`${server.url}around.html`);
    await page.waitForFunction(() => window.told.some(({ step, algorithm }) => step === 1 && algorithm === "bresenham"));
    await page.evaluate(() => document.querySelector("iframe").contentWindow.postMessage({ goto: 3 }, "*"));
    await page.waitForFunction(() => window.told.some(({ step }) => step === 3));
    const inside = page.frameLocator("iframe");
    assert.equal(await inside.locator(".bar, .lower, .side").count(), 0, "the frame has the picture only");
    // What is no number goes nowhere.
    await page.evaluate(() => document.querySelector("iframe").contentWindow.postMessage({ goto: "x" }, "*"));
    await page.waitForTimeout(100);
    assert.match(await inside.locator(".place").textContent(), /^3 \/ /);
    assert.deepEqual(faults, []);
    await close();
  }
});

test("tracks lead through pages that exist", async () => {
  const { page, faults, close } = await open(chromium, `${server.url}#page=tracks&lang=en`);
  await page.waitForSelector(".track-list");
  assert.equal(await page.locator(".track-list").count(), 5);
  const links = await page.locator(".track-list a").evaluateAll((all) => all.map((link) => link.hash));
  const known = new Map(lessons.map((lesson) => [lesson.name, lesson.examples.map((example) => example.name)]));
  for (const link of links) {
    const values = new URLSearchParams(link.slice(1));
    const examples = known.get(values.get("a"));
    assert.ok(examples, link);
    assert.ok(!values.has("ex") || examples.includes(values.get("ex")), link);
  }
  await page.locator(".track-list a").first().click();
  await atStep(page, 1);
  await page.click(".track-bar .nextPage");
  await page.waitForFunction(() => location.hash.includes("at=2"));
  await accessible(page, "track");
  await page.evaluate(() => (location.hash = "#page=teachers&lang=de"));
  await page.waitForSelector(".text-page h2");
  await accessible(page, "teachers");
  assert.deepEqual(faults, []);
  await close();
});

const READERS = new URL("../dist/durer-files.wasm", import.meta.url);

test("a file becomes the input, in the window of the page", { skip: !existsSync(READERS) && "built without readers of files" }, async () => {
  const { page, faults, close } = await open(chromium, `${server.url}#a=sutherland-hodgman&lang=en`);
  await atStep(page, 1);
  const ring = { type: "Polygon", coordinates: [[[0, 0], [12, 1], [9, 9], [4, 3], [0, 0]]] };
  await page.setInputFiles("#file", { name: "own.geojson", mimeType: "application/json", buffer: Buffer.from(JSON.stringify(ring)) });
  await page.waitForFunction(() => document.querySelector(".picture-pane .caption").textContent.includes("edge D (4, 3) → A (0, 0)"));
  await page.setInputFiles("#file", { name: "own.geojson", mimeType: "application/json", buffer: Buffer.from("{") });
  await page.waitForFunction(() => document.querySelector(".picture-pane").textContent.includes("own.geojson"));
  assert.deepEqual(faults, []);
  await close();
});

test("a list or an engine that cannot be loaded is said, and tried again", async () => {
  const { page, close } = await open(chromium, `${server.url}#lang=en`);
  await page.waitForSelector("a[href*=bresenham]");
  for (const file of ["lessons.json", "durer-plane.wasm"]) await page.route(`**/${file}`, (route) => route.abort());
  await page.goto(`${server.url}?again#a=bresenham&lang=en`);
  await page.waitForSelector("[role=alert]");
  await page.unroute("**/lessons.json");
  await page.getByRole("button").click();
  await page.waitForFunction(() => document.querySelector(".picture-pane")?.textContent.includes("could not be loaded"));
  await page.unroute("**/durer-plane.wasm");
  await page.keyboard.press("r");
  await atStep(page, 1);
  await close();
});

test("a trap starts the engine anew", async () => {
  const { page, close } = await open(chromium, `${server.url}#a=bresenham&lang=en`);
  await atStep(page, 1);
  // The engine's file as a module that traps at once.
  const module = Buffer.from(readFileSync(new URL("./trap.wasm.b64", import.meta.url), "utf8"), "base64");
  await page.route("**/durer-plane.wasm", (route) => route.fulfill({ body: module, contentType: "application/wasm" }));
  await page.reload();
  await page.waitForFunction(() => document.querySelector(".picture-pane")?.textContent.includes("was restarted"));
  await page.unroute("**/durer-plane.wasm");
  await page.keyboard.press("r");
  await atStep(page, 1);
  await close();
});
