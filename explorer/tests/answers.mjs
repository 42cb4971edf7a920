// Answers requests of standard input by the module, one a line, and prints a checksum of each answer.

import { readFileSync } from "node:fs";
import { load } from "./engine.mjs";

/** Returns a checksum (FNV-1a), as crates/durer-wasm/examples/answers.rs does. */
function sum(bytes) {
  let hash = 0xcbf29ce484222325n;
  for (const byte of bytes) hash = BigInt.asUintN(64, (hash ^ BigInt(byte)) * 0x100000001b3n);
  return hash.toString(16).padStart(16, "0");
}

const answer = await load(process.argv[2]);
for (const line of readFileSync(0, "utf8").split("\n").filter((line) => line !== "")) {
  const { kind, bytes } = answer(line);
  console.log(`${kind} ${sum(bytes)} ${bytes.length}`);
}
