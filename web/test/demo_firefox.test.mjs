// Tests of the demo in Firefox (firefox.mjs), from a static file server.
import assert from "node:assert/strict";
import { existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { WASM } from "./core.mjs";
import { Firefox, options as firefoxOptions } from "./firefox.mjs";
import { serve } from "./static_server.mjs";

const SITE = join(WASM, "site");
const options = firefoxOptions.skip ? firefoxOptions : { skip: existsSync(join(SITE, "index.html")) ? false : "this machine has no demo: script/wasm builds it" };
let firefox, folder, server;
before(async () => {
  if (options.skip) return;
  server = await serve(SITE);
  folder = mkdtempSync(join(tmpdir(), "taut-firefox-"));
  firefox = await new Firefox().start(folder);
});
after(async () => {
  if (!firefox) return;
  await firefox.end();
  await server.close();
  rmSync(folder, { recursive: true, force: true });
});

test("FirefoxRunsTheDemoToTheSameBits", options, async () => {
  await firefox.open(`${server.url}#experiments/drop_six_strut.yaml`);
  await firefox.untilSo('Number(document.querySelector(".view")?.dataset.drawn ?? 0) > 0 && window.taut.view.world !== null');
  await firefox.run('window.taut.app.send({ type: "speed", factor: 0 })');
  const wanted = JSON.parse(readFileSync(join(SITE, "files.json"), "utf8")).hashes["experiments/drop_six_strut.yaml"];
  await firefox.untilSo(`document.querySelectorAll(".bits .same").length === ${wanted.length}`);
  assert.deepEqual(await firefox.run("window.demo.source.state.value.marks"), wanted);
  await firefox.run('(({ project }) => project.write(project.path.value, project.text(project.path.value).replace("duration_s", "duration")))(window.demo)');
  await firefox.untilSo('document.querySelector(".problems .wrong")');
  await firefox.picture("demo");
  assert.deepEqual(firefox.complaints, []);
});
