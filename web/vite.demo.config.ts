// The demo (docs/browser.md): a folder for any static file server, at any address. script/wasm adds the core
// and the shipped files.
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
