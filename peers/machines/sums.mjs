// Prints the checksums of a module of WebAssembly: node sums.mjs FILE.wasm
import { readFile } from "node:fs/promises";

const { instance } = await WebAssembly.instantiate(await readFile(process.argv[2]), {});
for (let number = 0; ; number++) {
  const sum = BigInt.asUintN(64, instance.exports.checksum(number));
  if (sum === 0n) break;
  console.log(sum.toString(16).padStart(16, "0"));
}
