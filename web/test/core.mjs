// WebAssembly core in node, as in the demo's worker: web/src/demo/core.ts, compiled on the fly. TAUT_WASM:
// the build folder of script/wasm.
import { existsSync, mkdtempSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { extname, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { transformWithEsbuild } from "vite";

export const ROOT = fileURLToPath(new URL("../..", import.meta.url));
export const WASM = process.env.TAUT_WASM ?? join(ROOT, "build/wasm");
export const CORE = join(WASM, "core/apps/browser");
export const options = { skip: existsSync(join(CORE, "taut_core.wasm")) ? false : "this machine has no demo: script/wasm builds it" };

/** Shipped models, experiments and gaits, by path. */
export const shipped = Object.fromEntries(["models", "experiments", "gaits"].flatMap((folder) =>
  readdirSync(join(ROOT, "share", folder)).filter((name) => [".yaml", ".obj"].includes(extname(name))).sort()
    .map((name) => [`${folder}/${name}`, readFileSync(join(ROOT, "share", folder, name), "utf8")])));

export async function loadCore() {
  const folder = mkdtempSync(join(tmpdir(), "taut-core-"));
  writeFileSync(join(folder, "package.json"), '{"type": "module"}');
  for (const name of ["module", "core"]) {
    const source = join(ROOT, `web/src/demo/${name}.ts`);
    writeFileSync(join(folder, `${name}.js`), (await transformWithEsbuild(readFileSync(source, "utf8"), source)).code);
  }
  const { Core } = await import(pathToFileURL(join(folder, "core.js")));
  const core = await Core.load(pathToFileURL(join(CORE, "taut_core.mjs")).href, { wasmBinary: readFileSync(join(CORE, "taut_core.wasm")) });
  core.give(shipped);
  return core;
}

/** Opens a file and runs it at full speed until it has reached all marks. */
export function runTo(core, path, mark_at_s, edits = {}) {
  const opened = core.open(path, edits, mark_at_s, true);
  if (!opened.good) throw new Error(JSON.stringify(opened.found));
  goOn(core, mark_at_s.length);
  return core.state();
}

export function goOn(core, marks) {
  core.post('{"type": "speed", "factor": 0}');
  core.post('{"type": "resume"}');
  while (core.state().marks.length < marks) core.turn();
  core.post('{"type": "pause"}');
  core.turn();
}
