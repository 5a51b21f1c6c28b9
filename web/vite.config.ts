import { defineConfig, type Plugin } from "vite";

// Builds one file with everything: the server sends it at "/", and it is the template of reports, whose data
// go into its <script id="taut-report">. Therefore a report opens from disk, without a server.
function oneFile(): Plugin {
  return {
    name: "taut-one-file",
    enforce: "post",
    generateBundle(_options, bundle) {
      const page = bundle["index.html"];
      if (page?.type !== "asset") throw new Error("index.html was not built");
      let html = String(page.source);
      for (const [name, item] of Object.entries(bundle)) {
        if (item === page) continue;
        if (item.type === "chunk") {
          const code = item.code.replace(/<\/(script)/gi, "<\\/$1").replace(/<!--/g, "<\\!--");
          html = inlined(html, "script", name, () => `<script type="module">${code}</script>`);
        } else {
          html = inlined(html, "link", name, () => `<style>${item.source}</style>`);
        }
        delete bundle[name];
      }
      page.source = html;
      this.emitFile({ type: "asset", fileName: "report.html", source: html });
    },
  };
}

function inlined(html: string, tag: string, name: string, text: () => string): string {
  const close = tag === "script" ? "\\s*</script>" : "";
  const pattern = new RegExp(`<${tag}[^>]*${name.replace(/[.\\/]/g, "\\$&")}"[^>]*>${close}`);
  if (!pattern.test(html)) throw new Error(`index.html does not name ${name}`);
  return html.replace(pattern, text);
}

export default defineConfig({
  base: "./",
  plugins: [oneFile()],
  build: {
    target: "es2021",
    outDir: "dist",
    emptyOutDir: true,
    modulePreload: false,
    cssCodeSplit: false,
    chunkSizeWarningLimit: 2000,
  },
  // `npm run dev`: open its address with the ?token= printed by taut view.
  server: { proxy: { "/ws": { target: "ws://127.0.0.1:8080", ws: true } } },
});
