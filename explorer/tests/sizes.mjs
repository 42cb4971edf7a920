// Checks the sizes of the built pages: what the first view loads, the list of lessons by gzip with it, and the engines.

import { readdirSync, readFileSync, statSync } from "node:fs";
import { gzipSync } from "node:zlib";

const folder = process.argv[2] ?? "dist";
const FIRST_VIEW = 300_000;
const ENGINE = 700_000;

const html = readFileSync(`${folder}/index.html`);
const assets = readdirSync(`${folder}/assets`).map((name) => `${folder}/assets/${name}`);
const first = html.length + assets.reduce((sum, name) => sum + statSync(name).size, 0) + statSync(`${folder}/icon.svg`).size;
const zipped = (name) => gzipSync(readFileSync(`${folder}/${name}`), { level: 9 }).length;
const list = zipped("lessons.json");
const engines = ["durer-plane.wasm", "durer-space.wasm", "durer-visibility.wasm"].map(zipped);

console.log(`first view ${first} bytes and ${list} of the list by gzip (together at most ${FIRST_VIEW})`);
console.log(`engines ${engines.join(", ")} bytes by gzip (each at most ${ENGINE})`);
const external = assets.concat(`${folder}/index.html`).filter((name) => /(?:src|href)="https?:|import\("?https?:/.test(readFileSync(name, "utf8")));
if (external.length > 0) console.error(`these load from other places: ${external.join(", ")}`);
if (first + list > FIRST_VIEW || Math.max(...engines) > ENGINE || external.length > 0) process.exit(1);
