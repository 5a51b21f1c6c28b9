// Tests of the page in Firefox (firefox.mjs).
import assert from "node:assert/strict";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { decodePng, PAGE, until, writeReport } from "./browser.mjs";
import { Firefox, options } from "./firefox.mjs";
import { pose, reference, report, tension_n } from "./fixture.mjs";
import { MockServer } from "./mock_server.mjs";

let firefox;
let folder;
before(async () => {
  if (options.skip) return;
  folder = mkdtempSync(join(tmpdir(), "taut-firefox-"));
  firefox = await new Firefox().start(folder);
});
after(async () => {
  if (!firefox) return;
  await firefox.end();
  rmSync(folder, { recursive: true, force: true });
});

const DRAWN = 'Number(document.querySelector(".view")?.dataset.drawn ?? 0) > 0 && window.taut.view.world !== null';
const position = (body) => firefox.run(`window.taut.view.world.bodies.object.children[${body}].position.toArray()`);

/** Checks that the canvas shows the robot: dark rods on a light ground. */
async function showsRods(name) {
  const box = await firefox.run('(({ x, y, width, height }) => ({ x, y, width, height }))(document.querySelector(".view canvas").getBoundingClientRect())');
  const { width, channels, bytes } = decodePng(await firefox.picture(name));
  let dark = 0;
  for (let y = Math.ceil(box.y); y < box.y + box.height; ++y) {
    for (let x = Math.ceil(box.x); x < box.x + box.width; ++x) {
      const at = channels * (y * width + x);
      if (bytes[at] + bytes[at + 1] + bytes[at + 2] < 180) ++dark;
    }
  }
  return dark / (box.width * box.height);
}

test("FirefoxReplays", options, async () => {
  const server = await new MockServer(PAGE, { mode: "replay", compared: [reference] }).start();
  await firefox.open(server.url);
  await firefox.untilSo(DRAWN);
  await firefox.run("window.taut.app.seek(6)");
  await firefox.untilSo('document.querySelector(".timeline").dataset.time === "6"');
  (await position(1)).forEach((value, k) => assert.ok(Math.abs(value - pose(1, 6).position_m[k]) < 1e-9));
  await firefox.untilSo(`document.querySelectorAll('[data-figure^="tension:"] .uplot').length === 9`);
  await firefox.untilSo(`!document.querySelector('[data-figure="tension:top_1"] .values').textContent.includes("–")`);
  assert.match(await firefox.run(`document.querySelector('[data-figure="tension:top_1"] .values').textContent`), new RegExp(tension_n(4, 6).toFixed(2)));
  const share = await showsRods("replay");
  assert.ok(share > 0.005 && share < 0.2, `${share} of the view is dark`);
  await firefox.key(" ");
  await firefox.untilSo('Number(document.querySelector(".timeline").dataset.time) > 6.2');
  await server.stop();
  assert.deepEqual(firefox.complaints, []);
});

test("FirefoxDrivesALiveRun", options, async () => {
  const server = await new MockServer(PAGE, { mode: "live" }).start();
  await firefox.open(server.url);
  await firefox.untilSo(DRAWN);
  await firefox.key(" ");
  await until(() => server.of("resume").length === 1, "it runs");
  await firefox.key("c");
  await firefox.untilSo('!document.querySelector(".controls").hidden');
  assert.ok((await showsRods("live")) > 0.005);
  await server.stop();
});

test("FirefoxOpensAReportFromDisk", options, async () => {
  await firefox.open("about:blank");  // the previous page tries to reconnect to its closed server
  firefox.complaints.length = 0;
  await firefox.open(writeReport(report(), folder));
  await firefox.untilSo(DRAWN);
  await firefox.run("window.taut.app.seek(4)");
  (await position(2)).forEach((value, k) => assert.ok(Math.abs(value - pose(2, 4).position_m[k]) < 1e-9));
  assert.match(await firefox.run('document.querySelector("main.report").innerText'), /a machine/);
  await firefox.picture("report");
  assert.deepEqual(firefox.complaints, []);
});
