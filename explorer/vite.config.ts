import { defineConfig } from "vite";

export default defineConfig({
  // The pages work in any folder of any server.
  base: "./",
  build: { target: "es2022", assetsInlineLimit: 0, reportCompressedSize: false },
  worker: { format: "es" },
});
