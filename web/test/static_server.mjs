// Static file server, as for hosting the demo: below a folder, without headers other than the content type.
import { createServer } from "node:http";
import { readFile } from "node:fs/promises";
import { extname, join, normalize } from "node:path";

const KINDS = { ".html": "text/html", ".js": "text/javascript", ".mjs": "text/javascript", ".css": "text/css", ".json": "application/json", ".wasm": "application/wasm" };
export const BELOW = "/some/where/";

/** Serves a folder; returns {url, close}. */
export async function serve(folder) {
  const server = createServer(async (request, response) => {
    const path = decodeURIComponent(new URL(request.url, "http://x").pathname);
    try {
      if (!path.startsWith(BELOW)) throw new Error("outside");
      const name = normalize(path.slice(BELOW.length)) === "." ? "index.html" : normalize(path.slice(BELOW.length));
      const bytes = await readFile(join(folder, name));
      response.writeHead(200, { "Content-Type": KINDS[extname(name)] ?? "application/octet-stream" }).end(bytes);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  return { url: `http://127.0.0.1:${server.address().port}${BELOW}`, close: () => new Promise((resolve) => server.close(resolve)) };
}
