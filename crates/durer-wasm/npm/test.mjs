// Renders a model by the installed package: node test.mjs MODEL PICTURE

import assert from "node:assert";
import { readFileSync, writeFileSync } from "node:fs";
import { methods, render } from "durer";

const [model, picture] = process.argv.slice(2);
const bytes = render(readFileSync(model), { name: model, width: 96, height: 64 });
const header = new DataView(bytes.buffer);
assert.deepStrictEqual([...bytes.subarray(1, 4)], [..."PNG"].map((c) => c.charCodeAt(0)));
assert.deepStrictEqual([header.getUint32(16), header.getUint32(20)], [96, 64]);
assert.ok(methods().some(({ name }) => name === "z-buffer"));
assert.throws(() => render(new Uint8Array([1, 2, 3]), { name: "a.obj" }), /a\.obj/);
assert.throws(() => render(readFileSync(model), { name: model, method: "none" }), /none/);
assert.throws(() => render(readFileSync(model), { name: model, colour: 1 }), /colour/);
writeFileSync(picture, bytes);
