// A browser on the built pages, served from a folder below the root, as many servers do.

import { createReadStream, existsSync, readFileSync, statSync } from "node:fs";
import assert from "node:assert/strict";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

const AXE = createRequire(import.meta.url).resolve("axe-core/axe.min.js");
const DIST = fileURLToPath(new URL("../dist", import.meta.url));
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml", ".wasm": "application/wasm" };

export async function serve() {
  const server = createServer((request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url, "http://host").pathname)).replace(/^\/some\/folder\//, "");
    const file = join(DIST, path === "" || path.endsWith("/") ? `${path}index.html` : path);
    if (!file.startsWith(DIST) || !existsSync(file) || !statSync(file).isFile()) return response.writeHead(404).end();
    response.writeHead(200, { "Content-Type": TYPES[extname(file)] ?? "application/octet-stream" });
    createReadStream(file).pipe(response);
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  return { url: `http://127.0.0.1:${server.address().port}/some/folder/`, close: () => server.close() };
}

export function browser() {
  return chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] });
}

/** Opens a page; `faults` collects what a console shows, and what fails to load. */
export async function open(browser, url, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, reducedMotion: "reduce", ...options });
  const page = await context.newPage();
  const faults = [];
  page.on("console", (message) => message.type() === "error" && faults.push(message.text()));
  page.on("pageerror", (error) => faults.push(String(error)));
  page.on("requestfailed", (request) => faults.push(request.url()));
  await page.goto(url);
  return { page, faults, close: () => context.close() };
}

/** Waits until a lesson shows a step, counted from 1. */
export async function atStep(page, step) {
  await page.waitForFunction((step) => document.querySelector(".place")?.textContent.startsWith(`${step} /`) && document.querySelector(".drawing svg") !== null, step);
  await page.waitForTimeout(60);
}

/** Returns all lessons, as the pages list them. */
export function lessonsOf() {
  return JSON.parse(readFileSync(join(DIST, "lessons.json"), "utf8")).families.flatMap((family) => family.lessons);
}

/** Fails where axe-core finds something. */
export async function accessible(page, name) {
  await page.addScriptTag({ path: AXE });
  const { violations } = await page.evaluate(() => globalThis.axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21aa", "best-practice"] }));
  assert.deepEqual(violations.map(({ id, nodes }) => `${name} ${id}: ${nodes[0].html}`), []);
}

export const caption = (page) => page.textContent(".picture-pane .caption");
export const drawing = (page) => page.evaluate(() => document.querySelector(".drawing svg").outerHTML);
