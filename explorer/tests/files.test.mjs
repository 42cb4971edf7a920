// Files that are opened in a page, and models that are rendered.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync } from "node:fs";
import { mkdtemp, readFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { accessible, atStep, browser, caption, open, serve } from "./browser.mjs";
import * as models from "./models.mjs";

const READERS = { skip: !existsSync(new URL("../dist/durer-files.wasm", import.meta.url)) && "built without readers of files" };
let server;
let chromium;

before(async () => {
  server = await serve();
  chromium = await browser();
});

after(async () => {
  await chromium?.close();
  server?.close();
});

let pages = 0;

/** Opens a file in the page of a lesson and waits for its run; returns the input as the page shows it. */
async function opened(page, lesson, name, buffer) {
  // A page of its own, so that nothing is left of the file before.
  pages += 1;
  await page.waitForSelector("main");
  await page.evaluate((hash) => {
    document.querySelector("main").dataset.old = "";
    location.hash = hash;
  }, `#a=${lesson}&lang=en&page-of-test=${pages}`);
  await page.waitForSelector("main:not([data-old])");
  await atStep(page, 1);
  await page.setInputFiles("#file", { name, mimeType: "", buffer });
  await page.waitForFunction(() => location.hash.includes("in=") || !document.querySelector(".picture-pane .notice").hidden);
  return JSON.parse(await page.inputValue("#numbers"));
}

test("models become faces", READERS, async () => {
  const { page, faults, close } = await open(chromium, `${server.url}#a=depth-sort&lang=en`);
  for (const name of ["obj", "stl", "ply", "glb"]) {
    const { faces } = await opened(page, "depth-sort", `own.${name}`, models[name]);
    assert.equal(faces.length, 4, name);
    assert.ok(faces.every((face) => face.length === 3), name);
    assert.match(await caption(page), /\w/, name);
  }
  // A model that is too large is refused in words, and the page goes on.
  const many = Buffer.from(`${"v 0 0 0\nv 1 0 0\nv 0 1 0\n"}${"f 1 2 3\n".repeat(300)}`);
  await opened(page, "depth-sort", "many.obj", many);
  assert.match(await page.textContent(".picture-pane .notice"), /many\.obj.*200|200.*faces/);
  await page.keyboard.press("ArrowRight");
  await atStep(page, 2);
  assert.deepEqual(faults, []);
  await close();
});

test("pictures and shapes become inputs", READERS, async () => {
  const { page, faults, close } = await open(chromium, `${server.url}#a=naive&lang=en`);
  const { grid } = await opened(page, "naive", "own.png", models.png);
  assert.equal(grid.columns, 7);
  assert.equal(grid.cells.length, 35);
  for (const name of ["svg", "wkt"]) {
    const { figure } = await opened(page, "sutherland-hodgman", `own.${name}`, models[name]);
    assert.equal(figure.rings.length, 1, name);
    assert.equal(figure.rings[0].length, 4, name);
    assert.ok(figure.window, `${name}: the page's window stays`);
  }
  assert.deepEqual(faults, []);
  await close();
});

test("the gallery shows one scene by all methods, with the pixels of the command", READERS, async () => {
  const { page, faults, close } = await open(chromium, `${server.url}#page=gallery&lang=en`);
  await page.setInputFiles("#model", { name: "own.obj", mimeType: "", buffer: models.obj });
  await page.waitForSelector(".picture-card");
  await page.waitForFunction(() => document.querySelector(".notice").hidden, undefined, { timeout: 120_000 });
  const cards = page.locator(".picture-card");
  assert.ok((await cards.count()) > 5);
  await accessible(page, "gallery");
  // One sample in each pixel: the scan-line z-buffer finds what the z-buffer finds.
  const same = cards.filter({ hasText: "Scan-line z-buffer" });
  assert.match(await same.textContent(), /: 0 pixels differ|· 0 pixels differ/);
  // A tetrahedron on 360 × 360 pixels: each method has its own counts, and both z-buffers compare the same pixels.
  const counts = await cards.evaluateAll((cards) => cards.map((card) => Object.fromEntries([...card.querySelectorAll("[data-count]")].map((row) => [row.dataset.count, Number(row.querySelector("td").textContent.replaceAll(",", ""))]))));
  assert.ok(counts.every((of) => Object.keys(of).length > 1));
  const [zBuffer, scanLine] = counts.filter((of) => "depth-comparisons" in of);
  assert.ok(zBuffer["depths-stored"] > 1000 && zBuffer["depths-stored"] <= zBuffer["depth-comparisons"]);
  assert.equal(scanLine["depth-comparisons"], zBuffer["depth-comparisons"]);
  assert.equal(counts.find((of) => "rays" in of).rays, 360 * 360);
  assert.equal(counts.find((of) => "painted" in of).painted, 4);
  if (process.env.DURER) {
    const folder = await mkdtemp(join(tmpdir(), "gallery-"));
    for (let k = 0; k < (await cards.count()); k++) {
      const card = cards.nth(k);
      const bytes = Buffer.from(await card.locator("img").evaluate(async (image) => [...new Uint8Array(await (await fetch(image.src)).arrayBuffer())]));
      const command = await card.locator("[data-command]").getAttribute("data-command");
      execFileSync("sh", ["-c", `cat > own.obj && ${command.replace(/^durer/, '"$DURER"')}`], { cwd: folder, input: models.obj });
      const file = /-o (\S+)/.exec(command)[1];
      assert.ok(bytes.equals(await readFile(join(folder, file))), command);
    }
  }
  assert.deepEqual(faults, []);
  await close();
});
