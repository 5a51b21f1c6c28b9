// Tests of the demo built by script/wasm, in Chromium, from a static file server. TAUT_WASM: the build
// folder.
import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { closeBrowser, drawn, listenToNotices, openPage, picture, projection } from "./browser.mjs";
import { shipped, WASM } from "./core.mjs";
import { serve } from "./static_server.mjs";

const SITE = join(WASM, "site");
const options = { skip: existsSync(join(SITE, "index.html")) ? false : "this machine has no demo: script/wasm builds it" };
let server;
before(async () => (server = options.skip ? null : await serve(SITE)));
after(async () => {
  await closeBrowser();
  await server?.close();
});

const open = (fragment = "", more = {}) => openPage(server.url + fragment, { width: 1280, height: 800, ...more });
const state = (page) => page.evaluate(() => window.demo.source.state.value);
const text = (page) => page.locator(".demo textarea");
const hashes = () => JSON.parse(readFileSync(join(SITE, "files.json"), "utf8")).hashes;

/** Runs at full speed to the end, where the run pauses. */
async function toTheEnd(page) {
  await page.selectOption(".timeline select", "0");
  await page.waitForFunction(() => window.taut.app.frame.value.time_s >= window.taut.app.scene.value.duration_s && window.taut.app.frame.value.paused);
}

/** Replaces a line of the text by typing. */
async function rewrite(page, line, by) {
  const written = await text(page).inputValue();
  const changed = written.replace(line, by);
  assert.notEqual(changed, written);
  await text(page).fill(changed);
}

test("ItRunsAndFindsTheSameBits", options, async () => {
  const page = await open("#experiments/drop_six_strut.yaml");
  assert.deepEqual(await page.evaluate(() => [window.taut.app.hello.value.mode, window.taut.app.hello.value.title]), ["live", "drop_six_strut"]);
  assert.equal(await text(page).inputValue(), shipped["experiments/drop_six_strut.yaml"]);
  await toTheEnd(page);
  const wanted = hashes()["experiments/drop_six_strut.yaml"];
  assert.equal(wanted.length, 2);
  await page.waitForFunction((count) => document.querySelectorAll(".bits .same").length === count, wanted.length);
  assert.equal(await page.locator(".bits .other").count(), 0);
  const found = await state(page);
  assert.deepEqual(found.marks, wanted);
  assert.equal(found.hash, wanted[1].hash);
  assert.match(await page.locator(".bits code").innerText(), new RegExp(`^taut run experiments/drop_six_strut.yaml --duration_s ${Number(found.time_s.toFixed(9))} --json`));
  await picture(page, "demo-end");
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("ItAsksNoOtherHostAndLiesAnywhere", options, async () => {
  const page = await open();
  assert.ok(page.requests.length > 4);
  for (const request of page.requests) assert.ok(request.startsWith(server.url) || /^(data|blob):/.test(request), request);
  assert.equal((await state(page))?.path ?? "experiments/push_20n.yaml", "experiments/push_20n.yaml");
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("MistakesAreShownWhileOneTypesAndWhatRunsGoesOn", options, async () => {
  const page = await open("#experiments/push_20n.yaml");
  await rewrite(page, /duration_s: .*/, "durations_s: 10");
  await page.waitForFunction(() => document.querySelector(".problems .wrong"));
  const line = shipped["experiments/push_20n.yaml"].split("\n").findIndex((each) => each.startsWith("duration_s")) + 1;
  const place = page.locator(".problems .place", { hasText: `experiments/push_20n.yaml:${line}:1` });
  await place.waitFor();
  assert.match(await page.locator(".problems").innerText(), /durations_s.*did you mean "duration_s"/s);
  assert.ok((await page.locator(".lines .wrong").allInnerTexts()).includes(String(line)));
  assert.match(await page.locator(".verdict").innerText(), /error/);
  const before_s = await page.evaluate(() => window.taut.app.frame.value.time_s);
  await page.waitForFunction((then) => window.taut.app.frame.value.time_s > then, before_s);
  await picture(page, "demo-mistake");
  await place.click();
  assert.equal(await text(page).evaluate((area) => area.value.slice(0, area.selectionStart).split("\n").length), line);
  // an error in the model is also displayed, in its text
  await page.getByRole("button", { name: "restore the shipped texts" }).click();
  await page.locator(".tab", { hasText: "tetraspine3.yaml" }).click();
  await rewrite(page, /^segments: .*|^ {2}segments: .*/m, "  segments: many");
  await page.waitForFunction(() => /models\/tetraspine3\.yaml:\d+:\d+/.test(document.querySelector(".problems")?.textContent ?? ""));
  assert.ok(await page.locator(".tab.wrong.edited", { hasText: "tetraspine3.yaml" }).count());
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("AChangedModelRunsAndALinkHoldsIt", options, async () => {
  const page = await open("#experiments/hang.yaml");
  await rewrite(page, /duration_s: .*/, "duration_s: 0.25");
  await page.keyboard.press("Control+Enter");
  await page.waitForFunction(() => window.taut.app.scene.value?.duration_s === 0.25);
  await page.waitForFunction(() => window.demo.source.state.value?.time_s >= 0.25); // hashes arrive less often than frames
  assert.equal(await page.locator(".bits .same, .bits .other").count(), 0, "another run than the command's of the shipped file");
  const said = await listenToNotices(page);
  await page.getByRole("button", { name: "copy a link to this text with your changes" }).click();
  await said(/link/);
  const link = page.url();
  assert.ok(link.length < 4000, `${link.length} characters`);
  const hash = (await state(page)).hash;
  const other = await openPage(link, { width: 1280, height: 800 });
  assert.match(await text(other).inputValue(), /duration_s: 0.25/);
  await other.waitForFunction(() => window.taut.app.frame.value.time_s >= 0.25);
  await other.waitForFunction((wanted) => window.demo.source.state.value?.hash === wanted, hash);
  for (const each of [page, other]) {
    assert.deepEqual(each.complaints, []);
    await each.context().close();
  }
});

test("ADamagedLinkIsSaidAndSomethingIsShown", options, async () => {
  for (const [fragment, why] of [["#=AAAA", /damaged/], ["#models/nothing.yaml", /no file/], ["#=", /damaged/], ["#%", /./]]) {
    const page = await open(fragment);
    await page.waitForFunction(({ source }) => new RegExp(source).test(document.querySelector(".demo .about").textContent), { source: why.source });
    assert.equal(await page.locator(".demo .bar select").inputValue(), "experiments/push_20n.yaml");
    assert.deepEqual(page.complaints, []);
    await page.context().close();
  }
});

test("AHandPullsANodeAndASliderTunes", options, async () => {
  const page = await open("#models/tetraspine3.yaml");
  assert.equal(await page.evaluate(() => window.taut.app.hello.value.mode), "model");
  await page.locator(".timeline .play").click();
  await drawn(page);
  const project = await projection(page);
  const box = await page.locator(".view > canvas").boundingBox();
  const node = await page.evaluate(() => {
    const { scene, frame } = window.taut.app;
    const { body, position_m: p } = scene.value.nodes[0];
    const [x, y, z, w, a, b, c] = frame.value.bodies.slice(7 * body, 7 * body + 7);
    const t = [b * p[2] - c * p[1], c * p[0] - a * p[2], a * p[1] - b * p[0]].map((each) => 2 * each);
    return [x + p[0] + w * t[0] + b * t[2] - c * t[1], y + p[1] + w * t[1] + c * t[0] - a * t[2], z + p[2] + w * t[2] + a * t[1] - b * t[0]];
  });
  const { x, y } = project(node);
  await page.mouse.move(box.x + x, box.y + y);
  await drawn(page);
  await page.mouse.down();
  await page.mouse.move(box.x + x + 40, box.y + y - 60, { steps: 8 });
  await page.waitForFunction(() => window.demo.source.state.value?.touched === true);
  await page.mouse.up();
  await page.waitForFunction(() => /pulled, pushed or changed|No command/.test(document.querySelector(".bits .why").textContent));
  await page.evaluate(() => window.taut.app.send({ type: "reset" }));
  await page.waitForFunction(() => window.demo.source.state.value?.touched === false);
  await page.keyboard.press("c");
  const slider = page.locator(".controls .slider", { hasText: "friction" }).locator("input[type=number]");
  await slider.fill("0.5");
  await slider.press("Enter");
  await page.waitForFunction(() => window.demo.source.state.value?.touched === true);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("EverythingIsInSightOnAPhone", options, async () => {
  const page = await open("#experiments/push_20n.yaml", { width: 390, height: 844, touch: true });
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390);
  await picture(page, "demo-phone");
  await page.getByRole("button", { name: "show or hide the text of the file" }).click();
  assert.ok((await page.locator(".demo textarea").boundingBox()).height > 200);
  assert.ok((await page.locator(".view").boundingBox()).height > 200);
  await drawn(page);
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390);
  await picture(page, "demo-phone-text");
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});

test("AnotherFileIsChosenAndTheWayBackIsThere", options, async () => {
  const page = await open("#experiments/push_20n.yaml");
  await page.selectOption(".demo .bar select", "models/prism3.yaml");
  await page.waitForFunction(() => window.taut.app.hello.value?.mode === "model" && window.demo.source.state.value?.path === "models/prism3.yaml");
  assert.match(page.url(), /#models\/prism3\.yaml$/);
  await page.goBack();
  await page.waitForFunction(() => window.demo.source.state.value?.path === "experiments/push_20n.yaml");
  assert.equal(await page.locator(".demo .bar select").inputValue(), "experiments/push_20n.yaml");
  assert.deepEqual(page.complaints, []);
  await page.context().close();
});
