import { defineConfig } from "vite";

export default defineConfig({
  // The pages work in any folder of any server.
  base: "./",
  build: {
    target: "es2022",
    assetsInlineLimit: 0,
    reportCompressedSize: false,
    // The same page for all languages, for English and for German.
    rollupOptions: { input: ["index.html", "en/index.html", "de/index.html"] },
  },
  worker: { format: "es" },
});
