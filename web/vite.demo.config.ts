// The demo (docs/browser.md): a folder of files that any server of files can serve, from any address.
// script/wasm puts the core and the shipped files beside what this makes.
import { defineConfig } from "vite";

export default defineConfig({
  base: "./",
  build: {
    target: "es2022",
    outDir: "dist-demo",
    emptyOutDir: true,
    modulePreload: false,
    chunkSizeWarningLimit: 2000,
    rollupOptions: { input: "demo.html" },
  },
  worker: { format: "es" },
});
