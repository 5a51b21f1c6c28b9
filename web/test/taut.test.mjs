// The page with the real server: what is seen is what taut simulates and what its traces hold.
// TAUT_COMMAND names the command; without it there is nothing to test here.
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { after, afterEach, before, test } from "node:test";
import { closeBrowser, drawn, openPage, PAGE, picture, projection, untilTime } from "./browser.mjs";

const TAUT = process.env.TAUT_COMMAND;
const ROOT = fileURLToPath(new URL("../..", import.meta.url));
const options = { skip: TAUT ? false : "TAUT_COMMAND is not set" };
let folder;
let server = null;

/** Starts `taut view`; answers its address. */
async function view(...words) {
  server = spawn(TAUT, ["view", ...words], { cwd: ROOT, env: { ...process.env, TAUT_WEB: dirname(PAGE) } });
  let said = "";
  return new Promise((resolve, reject) => {
    const hear = (data) => {
      said += data;
      const address = /http:\/\/\S+/.exec(said)?.[0];
      if (address) resolve(address);
    };
    server.stdout.on("data", hear);
    server.stderr.on("data", hear);
    server.on("exit", () => reject(new Error(`taut view ended: ${said}`)));
  });
}

async function stop() {
  if (!server) return;
  const ended = new Promise((resolve) => server.on("exit", resolve));
  server.kill("SIGINT");
  await ended;
  server = null;
}

before(() => {
  folder = mkdtempSync(join(tmpdir(), "taut-view-"));
  if (!TAUT) return;
  execFileSync(TAUT, ["run", "experiments/push_20n.yaml", "--csv", "--quiet", "--out", folder], { cwd: ROOT });
});
afterEach(stop);
after(async () => {
  await closeBrowser();
  rmSync(folder, { recursive: true });
});

test("ATraceIsReplayedToThePosesOfTheFile", options, async (t) => {
  const page = await openPage(await view(join(folder, "trace.h5"), "--port", "0"), { width: 1280, height: 760 });
  t.after(() => page.context().close());
  const [head, ...rows] = readFileSync(join(folder, "trace.csv"), "utf8").trim().split("\n").map((line) => line.split(","));
  for (const time_s of [0, 20, 37, 60]) {
    await page.evaluate((wanted) => window.taut.app.seek(wanted), time_s);
    await untilTime(page, time_s, 1e-9);
    const row = rows.find((each) => Number(each[0]) === time_s);
    const value = (name) => Number(row[head.indexOf(name)]);
    const shown = await page.evaluate(() => window.taut.app.scene.value.bodies.map(({ name }, i) => ({ name, group: window.taut.view.world.bodies.object.children[i] }))
      .map(({ name, group }) => ({ name, p: group.position.toArray(), q: group.quaternion.toArray() })));
    assert.equal(shown.length, 3);
    for (const { name, p, q: [x, y, z, w] } of shown) {
      ["x", "y", "z"].forEach((axis, k) => assert.ok(Math.abs(p[k] - value(`body/${name}/position_${axis}_m`)) < 1e-9));
      Object.entries({ w, x, y, z }).forEach(([axis, part]) => assert.ok(Math.abs(part - value(`body/${name}/orientation_${axis}`)) < 1e-9));
    }
  }
  await page.evaluate(() => window.taut.app.seek(37));
  await untilTime(page, 37, 1e-9);
  await page.waitForFunction(() => document.querySelectorAll('[data-figure^="tension:"] .uplot').length === 12);
  await drawn(page);
  await picture(page, "push-replay");
  assert.deepEqual(page.requests.filter((url) => !["localhost", "127.0.0.1"].includes(new URL(url).hostname) && !/^(data|blob):/.test(url)), []);
  assert.deepEqual(page.complaints, []);
});

test("ANodeIsDraggedAndTheTensionAnswers", options, async (t) => {
  const page = await openPage(await view("models/tetraspine3.yaml", "--settled", "--port", "0"), { wait: true });
  t.after(() => page.context().close());
  const mode = await page.evaluate(() => window.taut.app.hello.value.mode);
  assert.equal(mode, "model");
  // alone and paused it stands still; once resumed it follows the hand
  const tip = await page.evaluate(() => window.taut.app.scene.value.nodes.at(-1).name);
  await page.evaluate((node) => window.taut.app.send({ type: "drag", node, target_m: [1, 1, 1] }), tip);
  await page.getByRole("button", { name: "play or pause" }).click();
  await page.waitForFunction(() => window.taut.app.frame.value.time_s > 0.2 && window.taut.app.frame.value.kinetic_j > 0.01);
  await page.context().close();
  await stop();
  const live = await openPage(await view("experiments/stand_still.yaml", "--port", "0"));
  t.after(() => live.context().close());
  await live.waitForFunction(() => window.taut.app.live && window.taut.app.frame.value.time_s > 0.2);
  const node = await live.evaluate(() => {
    const { scene } = window.taut.app;
    return scene.value.nodes.findIndex(({ name }) => /tip|high|top/.test(name));
  });
  const at = await live.evaluate((index) => window.taut.view.nodeAt(index).toArray(), node);
  const { x, y } = (await projection(live))(at);
  const box = await live.locator(".view").boundingBox();
  const before = await live.evaluate(() => Array.from(window.taut.app.frame.value.cables).filter((_, k) => k % 4 === 0));
  await live.mouse.move(box.x + x, box.y + y);
  await live.mouse.down();
  await live.mouse.move(box.x + x + 50, box.y + y - 60, { steps: 5 });
  await live.waitForFunction(() => window.taut.app.frame.value.pushes.length > 0);
  await live.waitForFunction((old) => Array.from(window.taut.app.frame.value.cables)
    .filter((_, k) => k % 4 === 0).some((tension, i) => Math.abs(tension - old[i]) > 0.5), before);
  await live.mouse.up();
  await live.waitForFunction(() => window.taut.app.frame.value.pushes.length === 0);
  assert.deepEqual(live.complaints, []);
});

test("APageOutlivesTheRealServer", options, async (t) => {
  const address = await view("experiments/hang.yaml", "--paused", "--port", "0");
  const page = await openPage(address);
  t.after(() => page.context().close());
  await page.keyboard.press("ArrowRight");
  await page.waitForFunction(() => window.taut.app.frame.value.time_s === 0.001);
  const ended = new Promise((resolve) => server.on("exit", resolve));
  server.kill("SIGKILL");
  await ended;
  await page.waitForFunction(() => document.querySelector(".link").dataset.state === "lost");
  await view("experiments/stand_still.yaml", "--paused", "--port", new URL(address).port);
  await page.waitForFunction(() => document.querySelector(".link").dataset.state === "open" && window.taut.app.scene.value.bodies.length === 3);
  await page.waitForFunction(() => window.taut.app.frame.value.time_s === 0 && window.taut.view.world.scene.bodies.length === 3);
  await page.keyboard.press("ArrowRight");
  await page.waitForFunction(() => window.taut.app.frame.value.time_s === 0.001);
  assert.deepEqual(page.complaints.filter((text) => !/WebSocket|ERR_CONNECTION/.test(text)), []);
});

test("TwoPagesOfTheRealServerDriveOneAtATime", options, async (t) => {
  const address = await view("experiments/hang.yaml", "--paused", "--port", "0");
  const [first, second] = [await openPage(address), await openPage(address)];
  t.after(() => Promise.all([first, second].map((page) => page.context().close())));
  const driver = (page, text) => page.waitForFunction((wanted) => document.querySelector(".driver").textContent === wanted, text);
  await first.keyboard.press("ArrowRight");
  await driver(first, "you drive");
  await driver(second, "viewer 1 drives, you watch");
  await second.keyboard.press("ArrowRight");
  await second.waitForFunction(() => /drives; take control first/.test(document.querySelector(".notice span").textContent));
  assert.equal(await first.evaluate(() => window.taut.app.frame.value.time_s), 0.001);
  await second.getByRole("button", { name: /drive from now on/ }).click();
  await driver(first, "viewer 2 drives, you watch");
  await second.locator(".view canvas").first().focus();
  await second.keyboard.press("ArrowRight");
  await first.waitForFunction(() => window.taut.app.frame.value.time_s === 0.002);
  await second.context().close();
  await driver(first, "");
});

test("AReportOpensFromDiskAndAsksNobody", options, async (t) => {
  const file = join(folder, "report.html");
  execFileSync(TAUT, ["report", join(folder, "trace.h5"), "--out", file], { cwd: ROOT, env: { ...process.env, TAUT_WEB: dirname(PAGE) } });
  const page = await openPage(`file://${file}`, { width: 1200, height: 800 });
  t.after(() => page.context().close());
  await page.evaluate(() => window.taut.app.seek(37));
  await untilTime(page, 37, 0.05);
  assert.equal(await page.evaluate(() => window.taut.view.world.forces.pushes.object.children[0].count), 3, "the three pushes act");
  const text = await page.locator("main.report").innerText();
  for (const part of ["push_20n", "inner_top_1", "ok"]) assert.ok(text.includes(part), part);
  assert.deepEqual(page.requests.filter((url) => !/^(file|data|blob):/.test(url)), []);
  await drawn(page);
  await picture(page, "push-report", { fullPage: true });
});
