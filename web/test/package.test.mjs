// Tests of the npm package built by script/wasm --npm, installed into an empty folder: in Node.js, in Chromium,
// and its types. TAUT_COMMAND: the command; TAUT_WASM: the build folder of script/wasm.
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { closeBrowser, openPage } from "./browser.mjs";
import { ROOT, shipped, WASM } from "./core.mjs";
import { serve } from "./static_server.mjs";

const TAUT = process.env.TAUT_COMMAND;
const NPM = join(WASM, "npm");
const packed = existsSync(NPM) ? readdirSync(NPM).filter((name) => name.endsWith(".tgz")) : [];
const options = { skip: packed.length > 0 ? false : "this machine has no npm package: script/wasm --npm builds it" };
const PATH = "experiments/push_20n.yaml";
let folder, taut;
before(async () => {
  if (options.skip) return;
  assert.equal(packed.length, 1);
  folder = mkdtempSync(join(tmpdir(), "taut-package-"));
  writeFileSync(join(folder, "package.json"), '{"private": true, "type": "module"}');
  execFileSync("npm", ["install", "--offline", "--no-audit", "--no-fund", join(NPM, packed[0])], { cwd: folder });
  taut = await import(pathToFileURL(join(folder, "node_modules/taut/dist/simulate.js")).href);
  put(shipped);
});
after(async () => {
  await closeBrowser();
  if (folder) rmSync(folder, { recursive: true });
});

function put(files) {
  for (const [path, text] of Object.entries(files)) {
    mkdirSync(dirname(join(folder, path)), { recursive: true });
    writeFileSync(join(folder, path), text);
  }
}

/** Returns the summary of the command's run of a file in `folder`. */
function native(path, ...more) {
  return JSON.parse(execFileSync(TAUT, ["run", path, "--json", "--quiet", "--out", "runs/run", ...more], { cwd: folder, maxBuffer: 1 << 26 }));
}

/** Returns the columns of the command's last trace by name. */
function nativeTrace() {
  execFileSync(TAUT, ["trace", "convert", "runs/run", "--out", "trace.csv", "--quiet"], { cwd: folder });
  const [names, ...rows] = readFileSync(join(folder, "trace.csv"), "utf8").trimEnd().split("\n").map((line) => line.split(","));
  return Object.fromEntries(names.map((name, place) => [name, Float64Array.from(rows, (row) => Number(row[place]))]));
}

function assertSame(run, summary) {
  assert.equal(run.state_hash, summary.state_hash);
  assert.equal(run.simulated_s, summary.simulated_s);
  assert.deepEqual(run.max_tension_n, Object.fromEntries(summary.cables.map(({ name, tension }) => [name, tension.max_n])));
}

test("AProgramThatImportsTautPrintsTheHashOfTheCommand", options, () => {
  const program = `import { simulate } from "taut";\nconsole.log((await simulate("${PATH}", { duration_s: 3 })).state_hash);\n`;
  writeFileSync(join(folder, "program.js"), program);
  const printed = execFileSync(process.execPath, ["program.js"], { cwd: folder, encoding: "utf8" });
  assert.equal(printed.trim(), native(PATH, "--duration_s", "3").state_hash);
});

test("ARunHasTheTraceOfTheCommand", options, async () => {
  const run = await taut.simulate(PATH, { duration_s: 1.5 });
  assertSame(run, native(PATH, "--duration_s", "1.5"));
  assert.deepEqual({ time_s: run.time_s, ...run.trace }, nativeTrace());
  assert.equal(run.units["system/com_x_m"], "m");
  assert.deepEqual(Object.keys(run.units), Object.keys(run.trace));
});

test("ParametersAndFilesChangeARunAndNotTheNextOne", options, async () => {
  const first = await taut.simulate("experiments/hang.yaml");
  assertSame(first, native("experiments/hang.yaml"));
  const other = await taut.simulate("experiments/hang.yaml", { parameters: { hang_m: 1.02 } });
  assertSame(other, native("experiments/hang.yaml", "--set", "hang_m=1.02"));
  assert.notEqual(other.state_hash, first.state_hash);
  const files = { "experiments/mine.yaml": "taut: 1\nkind: experiment\nname: mine\nmodel: ../models/prism3.yaml\nduration_s: 0.5\n" };
  put(files);
  assertSame(await taut.simulate("experiments/mine.yaml", { files }), native("experiments/mine.yaml"));
  await assert.rejects(taut.simulate("experiments/mine.yaml"), taut.SimulateError);
  await assert.rejects(taut.simulate("experiments/hang.yaml", { files: { "experiments/hang.yaml": `${shipped["experiments/hang.yaml"]}\nx: 1\n` } }), taut.SimulateError);
  assert.deepEqual(await taut.simulate("experiments/hang.yaml"), first);
  assert.equal((await taut.shippedFiles())["models/prism3.yaml"], shipped["models/prism3.yaml"]);
});

test("ErrorsAreThoseOfTheCommand", options, async () => {
  const files = { [PATH]: shipped[PATH].replace(/duration_s: .*/, "durations_s: -1") };
  put(files);
  const run = spawnSync(TAUT, ["run", PATH, "--quiet", "--out", "runs/wrong"], { cwd: folder, encoding: "utf8" });
  put({ [PATH]: shipped[PATH] });
  assert.equal(run.status, 3);
  await assert.rejects(taut.simulate(PATH, { files }), (error) => {
    assert.ok(error instanceof taut.SimulateError);
    assert.deepEqual(error.message.split("\n"), run.stderr.trimEnd().split("\n").filter((line) => line.includes("error:")));
    assert.ok(error.found.length > 0);
    return true;
  });
  await assert.rejects(taut.simulate("experiments/nothing.yaml"), taut.SimulateError);
  for (const duration_s of [-1, NaN, Infinity]) await assert.rejects(taut.simulate(PATH, { duration_s }), RangeError);
  await assert.rejects(taut.simulate(PATH, { parameters: { "a\nb": 1 } }), RangeError);
});

test("TypeScriptFindsTheTypes", options, () => {
  writeFileSync(join(folder, "program.ts"), `import { simulate, type Simulated, SimulateError } from "taut";
const run: Simulated = await simulate("${PATH}", { duration_s: 1, parameters: { push_n: 20 } });
const x_m: Float64Array | undefined = run.trace["system/com_x_m"];
const hash: string = run.state_hash;
export const found = (error: SimulateError) => error.found.map(({ file, line }) => [file, line, x_m, hash]);
`);
  const check = (module, resolution) => spawnSync(process.execPath, [join(ROOT, "web/node_modules/typescript/bin/tsc"), "--noEmit", "--strict",
    "--noUncheckedIndexedAccess", "--target", "ES2022", "--module", module, "--moduleResolution", resolution, "program.ts"], { cwd: folder, encoding: "utf8" });
  for (const [module, resolution] of [["NodeNext", "NodeNext"], ["ESNext", "bundler"]]) assert.equal(check(module, resolution).stdout, "");
  const program = readFileSync(join(folder, "program.ts"), "utf8");
  writeFileSync(join(folder, "program.ts"), program.replace("duration_s: 1", "duration: 1"));
  assert.match(check("NodeNext", "NodeNext").stdout, /'duration' does not exist in type 'SimulateOptions'/);
});

test("AWorkerOfAPageRunsToTheSameBits", options, async () => {
  writeFileSync(join(folder, "index.html"), "<!doctype html><title>taut</title><link rel=\"icon\" href=\"data:,\">\n");
  // Workers have no import maps, so the worker names the file.
  writeFileSync(join(folder, "worker.js"), `import { simulate } from "./node_modules/taut/dist/simulate.js";
onmessage = async ({ data }) => postMessage((await simulate(data.path, data.options)).state_hash);
`);
  const server = await serve(folder);
  const page = await openPage(server.url, { wait: false });
  const hash = await page.evaluate((message) => new Promise((resolve, reject) => {
    const worker = new Worker("worker.js", { type: "module" });
    worker.onmessage = ({ data }) => resolve(data);
    worker.onerror = (event) => reject(new Error(event.message));
    worker.postMessage(message);
  }), { path: PATH, options: { duration_s: 2 } });
  assert.equal(hash, native(PATH, "--duration_s", "2").state_hash);
  assert.deepEqual(page.complaints, []);
  await server.close();
});

test("AViteBuildContainsAllFiles", options, async () => {
  writeFileSync(join(folder, "index.html"), `<!doctype html><title>taut</title><link rel="icon" href="data:,"><script type="module" src="./page.js"></script>\n`);
  writeFileSync(join(folder, "page.js"), `import { simulate } from "taut";
simulate("${PATH}", { duration_s: 1 }).then(({ state_hash }) => (document.title = state_hash));
`);
  const { build } = await import("vite");
  await build({ root: folder, base: "./", logLevel: "error", configFile: false, build: { target: "es2022", outDir: "built" } });
  const server = await serve(join(folder, "built"));
  const page = await openPage(server.url, { wait: false });
  await page.waitForFunction(() => document.title !== "taut");
  assert.equal(await page.title(), native(PATH, "--duration_s", "1").state_hash);
  assert.deepEqual(page.complaints, []);
  await server.close();
});

test("ThePackageHasNoDependenciesAndIsSmall", options, () => {
  const about = JSON.parse(readFileSync(join(folder, "node_modules/taut/package.json"), "utf8"));
  assert.equal(about.dependencies, undefined);
  assert.equal(about.version, execFileSync(TAUT, ["--version"], { encoding: "utf8" }).trim().replace("taut ", ""));
  for (const name of ["LICENSE", "NOTICE", "README.md"]) assert.ok(existsSync(join(folder, "node_modules/taut", name)), name);
  assert.ok(statSync(join(NPM, packed[0])).size <= 720_000, `${statSync(join(NPM, packed[0])).size} bytes`);
});
