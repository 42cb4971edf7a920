// The module in node.

import { readFileSync } from "node:fs";

/** Loads a module; returns a function from the bytes of a request to the kind and the bytes of its answer. */
export async function load(path) {
  const { instance } = await WebAssembly.instantiate(readFileSync(path), {});
  const engine = instance.exports;
  return (request) => {
    const bytes = typeof request === "string" ? new TextEncoder().encode(request) : request;
    const at = engine.durer_request(bytes.length);
    new Uint8Array(engine.memory.buffer, at, bytes.length).set(bytes);
    const kind = engine.durer_answer();
    return { kind, bytes: new Uint8Array(engine.memory.buffer, engine.durer_result(), engine.durer_result_length()).slice() };
  };
}
