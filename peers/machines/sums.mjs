// Prints the checksums of a module of WebAssembly: node sums.mjs FILE.wasm
import { readFile } from "node:fs/promises";

const module = await WebAssembly.compile(await readFile(process.argv[2]));
// Random numbers of the browser, which the reader of ZIP archives is linked with, are not needed to read.
const imports = {};
for (const { module: from, name, kind } of WebAssembly.Module.imports(module)) {
  imports[from] ??= {};
  if (kind === "function") {
    imports[from][name] = () => {
      throw new Error(`the module calls ${from}.${name}`);
    };
  }
}
const instance = await WebAssembly.instantiate(module, imports);
for (let number = 0; ; number++) {
  const sum = BigInt.asUintN(64, instance.exports.checksum(number));
  if (sum === 0n) break;
  console.log(sum.toString(16).padStart(16, "0"));
}
