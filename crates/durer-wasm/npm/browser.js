import { over } from "./engine.js";

const response = await fetch(new URL("durer.wasm", import.meta.url));
if (!response.ok) throw new Error(`${response.url}: ${response.status} ${response.statusText}`);
// Servers that do not know the type of modules are common: bytes are compiled then.
export const { render, methods } = over(await WebAssembly.compile(await response.arrayBuffer()));
