import { readFileSync } from "node:fs";
import { over } from "./engine.js";

export const { render, methods } = over(new WebAssembly.Module(readFileSync(new URL("durer.wasm", import.meta.url))));
