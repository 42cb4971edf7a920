// Checks the sizes of the built pages: what the first view loads, and the engine.

import { readdirSync, readFileSync, statSync } from "node:fs";
import { gzipSync } from "node:zlib";

const folder = process.argv[2] ?? "dist";
const FIRST_VIEW = 300_000;
const ENGINE = 700_000;

const html = readFileSync(`${folder}/index.html`);
const assets = readdirSync(`${folder}/assets`).map((name) => `${folder}/assets/${name}`);
const first = html.length + assets.reduce((sum, name) => sum + statSync(name).size, 0) + statSync(`${folder}/icon.svg`).size;
const engine = gzipSync(readFileSync(`${folder}/durer.wasm`), { level: 9 }).length;

console.log(`first view ${first} bytes (at most ${FIRST_VIEW}), engine ${engine} bytes by gzip (at most ${ENGINE})`);
const external = assets.concat(`${folder}/index.html`).filter((name) => /(?:src|href)="https?:|import\("?https?:/.test(readFileSync(name, "utf8")));
if (external.length > 0) console.error(`these load from other places: ${external.join(", ")}`);
if (first > FIRST_VIEW || engine > ENGINE || external.length > 0) process.exit(1);
