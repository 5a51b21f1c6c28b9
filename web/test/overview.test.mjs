// Tests of the page's first look: headline numbers, plots of groups, a model without a run, modes, the time
// bar, and accessibility by axe.
import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { closeBrowser, drawn, openPage, PAGE, picture, writeReport } from "./browser.mjs";
import { cables, DURATION_S, report, scene, SPEED_M_PER_S, tension_n } from "./fixture.mjs";
import { MockServer } from "./mock_server.mjs";

const AXE = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const LIMIT_N = 100; // Euler's load of the fixture's rods
const servers = [];
let folder;

/** Starts a server and opens its page. */
async function opened(server, size = {}) {
  servers.push(await new MockServer(PAGE, server).start());
  return openPage(servers.at(-1).url, { groups: true, width: 1280, height: 900, ...size });
}

before(() => (folder = mkdtempSync(join(tmpdir(), "taut-overview-"))));
after(async () => {
  await closeBrowser();
  for (const server of servers) await server.stop();
  rmSync(folder, { recursive: true });
});

const withTags = cables.map((cable, i) => ({ ...cable, tags: i < 6 ? ["outer", String(i % 3)] : ["side"] }));
const withLimits = scene.bodies.map((body) => ({ ...body, shapes: body.shapes.map((shape) => (shape.kind === "rod" ? { ...shape, buckling_n: LIMIT_N } : shape)) }));
const actions = [{ kind: "push", text: "shove: up to 12 N on rod_0.low", from_s: 4, to_s: 5 }];

/** Violations of WCAG 2.1 A and AA. */
async function violations(page) {
  await page.evaluate(AXE);
  const found = await page.evaluate(async () => (await window.axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa"] })).violations);
  return found.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html.slice(0, 120)).join(" | ")}`);
}

test("AReportBeginsWithItsHeadlineNumbers", async (t) => {
  const summary = { ...report().summary, struts: [{ name: "rod_1", axial_least_n: -40, axial_greatest_n: 0 }], overloads: [] };
  const page = await openPage(writeReport(report({ summary, scene: { ...scene, bodies: withLimits, cables: withTags, actions } }), folder), { groups: true, width: 1280, height: 900 });
  t.after(() => page.context().close());
  await page.waitForFunction(() => document.querySelectorAll(".headline > div").length === 6);
  const cards = Object.fromEntries(await page.locator(".headline > div").evaluateAll((list) => list.map((each) => [each.querySelector("dt").textContent, each.querySelector("dd").textContent])));
  // the rows are 5 ms apart; the largest tension is that of side_1 at pi / 2
  const at_s = Math.round((Math.PI / 2) * 200) / 200;
  assert.equal(cards["peak tension"], `${tension_n(7, at_s).toFixed(1)} N side_1 at ${at_s.toFixed(2)} s`);
  assert.equal(cards.distance, `${(SPEED_M_PER_S * DURATION_S).toFixed(3)} m 0° from x`);
  assert.match(cards["net speed"], /^0\.0500 m\/s over 10 s$/);
  assert.equal(cards.status, "complete no problems");
  assert.equal(cards["buckling safety"], "2.50 × lowest: strut rod_1");
  assert.ok(await page.evaluate(() => document.querySelector(".headline").compareDocumentPosition(document.querySelector("main.report h2")) & Node.DOCUMENT_POSITION_FOLLOWING), "above everything else");
  assert.deepEqual(await violations(page), []);
  await picture(page, "overview-report", { fullPage: true });
});

test("ThePeakIsThatOfAllStepsEvenBetweenTheRows", async (t) => {
  const summary = { ...report().summary, system_max_tension_n: 50, system_max_tension_cable: "top_1" };
  const page = await openPage(writeReport(report({ summary }), folder), { groups: true });
  t.after(() => page.context().close());
  await page.waitForFunction(() => document.querySelectorAll(".headline > div").length === 6);
  assert.equal(await page.locator(".headline > div dd").first().innerText(), "50 N\ntop_1 near 1.57 s");
});

test("CablesOfATagShareALargePlotWhoseLinesAreNamedUnderTheMouse", async (t) => {
  const page = await opened({ more: { cables: withTags, actions } });
  t.after(() => page.context().close());
  await page.waitForFunction(() => document.querySelectorAll('[data-figure^="overlay:"] .uplot').length === 2);
  const large = page.locator('[data-figure="overlay:tension: outer"]');
  assert.deepEqual(await page.locator('[data-figure^="overlay:"] .name').allInnerTexts(), ["tension: outer", "tension: side"]);
  assert.equal(await page.locator('[data-figure^="tension:"]').count(), 0, "no small plots");
  const labels = await page.evaluate(() => [...document.querySelectorAll('[data-figure^="overlay:"] .u-label')].length);
  assert.equal(labels, 0, "uPlot draws the labels of axes into its canvas");
  // the mouse on the line of top_1 (index 4) at 5 s
  const place = await large.evaluate((element, wanted) => {
    const over = element.querySelector(".u-over").getBoundingClientRect();
    return { x: over.left + (wanted.time_s / wanted.end_s) * over.width, top: over.top, height: over.height };
  }, { time_s: 5, end_s: DURATION_S });
  let named = "";
  for (let part = 0.02; part < 1 && named !== "top_1"; part += 0.02) {
    await page.mouse.move(place.x, place.top + part * place.height);
    named = await large.evaluate((element) => element.querySelector(".near .marked span")?.textContent ?? "");
  }
  assert.equal(named, "top_1");
  assert.equal(await page.evaluate(() => window.taut.app.hover.value.index), 4, "its cable stands out in the 3-D view");
  const box = await large.locator(".near .marked b").innerText();
  assert.ok(Math.abs(Number(box.replace(" N", "")) - tension_n(4, 5)) < 0.3, box);
  await picture(page, "overview-groups");
  await page.getByLabel("one plot per cable").check();
  await page.waitForFunction(() => document.querySelectorAll('[data-figure^="tension:"]').length === 9);
});

test("TheKeyThatOpensTheChannelListClosesItAgain", async (t) => {
  const page = await opened({});
  t.after(() => page.context().close());
  await page.keyboard.press("b");
  assert.equal(await page.locator(".editor").isVisible(), true);
  await page.keyboard.press("b");
  assert.equal(await page.locator(".editor").isVisible(), false);
  assert.equal(await page.locator(".channels input[type=search]").inputValue(), "");
});

test("TheTimeBarShowsPushesAndTheTimeUnderTheMouse", async (t) => {
  const summary = { status: "ok", overloads: [{ kind: "cable", name: "top_1", limit: "strength", first_time_s: 8 }] };
  const page = await opened({ more: { actions, summary } });
  t.after(() => page.context().close());
  assert.equal(await page.locator(".actions em").innerText(), "shove: up to 12 N on rod_0.low");
  const { x, y, width, height } = await page.locator(".track").boundingBox();
  await page.mouse.move(x + 0.45 * width, y + height / 2);
  assert.match(await page.locator(".hovertime").innerText(), /^4\.5\d s\s+shove: up to 12 N on rod_0\.low$/);
  await page.mouse.move(x + 0.8 * width, y + height / 2);
  assert.match(await page.locator(".hovertime").innerText(), /cable top_1 exceeds its strength/);
  await page.mouse.move(x + 0.8 * width, y - 200);
  assert.equal(await page.locator(".hovertime").isVisible(), false);
});

test("TheCameraShowsTheWholePathAndFollowsOnRequest", async (t) => {
  const page = await opened({});
  t.after(() => page.context().close());
  const inside = () => page.evaluate(() => window.taut.view.world.path.places.filter((_, i) => i % 100 === 0).every((place) => {
    const { x, y } = place.clone().project(window.taut.view.camera);
    return Math.abs(x) < 1 && Math.abs(y) < 1;
  }));
  await page.waitForFunction(() => window.taut.view.world.path.places.length > 1000);
  assert.equal(await page.evaluate(() => window.taut.view.following.value), false);
  assert.ok(await inside());
  await page.getByRole("button", { name: "the camera follows the robot (V)" }).click();
  assert.equal(await page.evaluate(() => window.taut.view.following.value), true);
  await page.keyboard.press("w");
  assert.ok(await inside());
});

const statics = {
  found: true, reason: "", self_stress_states: 1, feasible: true, mechanisms: 1, rigid_motions: 6, cable_tension_n: cables.map(() => 5),
  modes: [16.9, 42].map((frequency_hz) => ({ kind: "elastic", frequency_hz, translation_m: [[0.1, 0, 0], [0, 0.1, 0], [0, 0, 1]], rotation_rad: [[0, 0, 0.1], [0, 0, 0], [0, 0, 0]] })),
};

test("RoundingErrorsOfAPrestressMakeNoRange", async (t) => {
  const near = [10, 9.9999999, 10.0000001, 9.9996, 10, 10];
  const page = await opened({ mode: "model", more: { cables: withTags, statics }, tensions_n: near });
  t.after(() => page.context().close());
  await page.waitForFunction(() => document.querySelectorAll(".model tbody tr").length === 3);
  assert.equal(await page.locator(".model tbody tr").first().locator("td").nth(1).innerText(), "10");
});

test("AModelShowsItsMembersAndModesInsteadOfEmptyPlots", async (t) => {
  const page = await opened({ mode: "model", more: { cables: withTags, bodies: withLimits, statics } });
  t.after(() => page.context().close());
  const server = servers.at(-1);
  await page.waitForFunction(() => document.querySelectorAll(".model tbody tr").length === 3);
  const rows = await page.locator(".model tbody tr").evaluateAll((list) => list.map((row) => [...row.cells].map(({ textContent }) => textContent)));
  assert.deepEqual(rows.map(([name, count]) => [name, count]), [["cables: outer", "6"], ["cables: side", "3"], ["struts", "3"]]);
  assert.equal(rows[0][2], `${tension_n(0, 0)} to ${tension_n(5, 0)}`);
  assert.equal(await page.locator(".plots .grid:visible").count(), 0);
  assert.deepEqual(await page.locator(".statics .headline b").allInnerTexts(), ["1 state", "1", "6"]);
  assert.deepEqual(await page.locator(".statics button").allInnerTexts(), ["1: 16.9 Hz", "2: 42 Hz"]);
  await page.getByRole("button", { name: "play mode 1, 16.9 Hz" }).click();
  assert.equal(await page.locator(".shapebar span").innerText(), "mode 1 of 2 · 16.9 Hz · slowed 34× · amplitude: 8 % of the robot's size");
  const x = () => page.evaluate(() => window.taut.view.world.bodies.object.children[2].position.z);
  const [first, rest] = [await x(), scene.bodies[2].position_m[2]];
  await page.waitForFunction((before) => Math.abs(window.taut.view.world.bodies.object.children[2].position.z - before) > 0.01, first);
  const farthest = await page.evaluate(() => new Promise((resolve) => {
    let most = 0;
    const until = performance.now() + 2500;
    const look = () => {
      most = Math.max(most, window.taut.view.world.bodies.object.children[2].position.z);
      if (performance.now() < until) requestAnimationFrame(look);
      else resolve(most);
    };
    look();
  }));
  const size_m = await page.evaluate(() => window.taut.view.world.size_m);
  assert.ok(farthest - rest <= 0.08 * size_m * 1.001, `${farthest - rest} m, the size is ${size_m} m`);
  await picture(page, "overview-model");
  await page.getByRole("button", { name: "next mode" }).click();
  assert.match(await page.locator(".shapebar span").innerText(), /^mode 2 of 2 · 42 Hz/);
  assert.deepEqual(await violations(page), []);
  await page.getByRole("button", { name: "simulate the robot falling onto the ground" }).click();
  await page.waitForFunction(() => true);
  for (let i = 0; i < 100 && server.of("start").length === 0; ++i) await new Promise((resolve) => setTimeout(resolve, 50));
  assert.deepEqual(server.of("start").map(({ as }) => as), ["dropped"]);
});

const shape = { kind: "mode", number: 1, count: 10, frequency_hz: 16.9, slowdown: 33.8, amplitude: 0.08 };

test("AModePlaysByItselfUnlessMotionIsUnwanted", async (t) => {
  const page = await opened({ more: { shape } });
  const server = servers.at(-1);
  await page.waitForFunction(() => Number(document.querySelector(".timeline").dataset.time) > 0.1);
  assert.equal(await page.locator(".shapebar span").innerText(), "mode 1 of 10 · 16.9 Hz · slowed 34× · amplitude: 8 % of the robot's size");
  assert.match(await page.locator(".legend").innerText(), /strain of cables/);
  await page.getByRole("button", { name: "next mode" }).click();
  for (let i = 0; i < 100 && server.of("open_shape").length === 0; ++i) await new Promise((resolve) => setTimeout(resolve, 50));
  assert.equal(server.of("open_shape")[0].number, 2);
  await page.context().close();
  const still = await opened({ more: { shape } }, { motion: "reduce" });
  t.after(() => still.context().close());
  await drawn(still);
  assert.equal(servers.at(-1).of("resume").length, 0);
});

for (const [what, size, theme] of [["Desktop", { width: 1366, height: 768 }, "light"], ["Phone", { width: 390, height: 844, touch: true }, "dark"]]) {
  test(`AxeFindsNothingInALiveRun (${what})`, async (t) => {
    const page = await opened({ mode: "live" }, { ...size, theme });
    t.after(() => page.context().close());
    await page.waitForFunction(() => document.querySelectorAll(".chart .uplot").length > 0);
    assert.deepEqual(await violations(page), []);
    if (what === "Phone") {
      const { height } = await page.locator(".top").boundingBox();
      assert.ok(height < 60, `the header has one row, not ${height} px`);
      await page.getByRole("button", { name: "more buttons" }).click();
      assert.equal(await page.getByRole("button", { name: "dark or light (T)" }).isVisible(), true);
      await page.getByRole("button", { name: "more playback controls" }).click();
      assert.equal(await page.getByLabel("speed").isVisible(), true);
    }
    await picture(page, `overview-live-${what}`);
  });
}

test("AFigureIsCopiedAsAPicture", async (t) => {
  const page = await opened({});
  t.after(() => page.context().close());
  await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
  await page.waitForFunction(() => document.querySelectorAll('[data-figure="energy"] .uplot').length === 1);
  await page.locator('button[title="copy energy as a picture"]').evaluate((element) => element.click());
  await page.waitForFunction(() => window.taut.app.notice.value !== null);
  assert.equal(await page.evaluate(() => window.taut.app.notice.value), "copied energy");
  assert.deepEqual(await page.evaluate(async () => (await navigator.clipboard.read()).flatMap(({ types }) => types)), ["image/png"]);
});

test("ASavedVideoIsReadableOrThePageTellsThatItIsNotSaved", async (t) => {
  const page = await opened({});
  t.after(() => page.context().close());
  await page.evaluate(() => (window.taut.app.range_s.value = [1, 2]));
  for (const kind of ["WebM", "MP4"]) {
    const made = page.locator("button.film", { hasText: kind });
    if (!(await made.isVisible())) continue; // the browser has no encoder
    await page.evaluate(() => (window.taut.app.notice.value = null));
    const saved = page.waitForEvent("download");
    const refused = page.waitForFunction(() => window.taut.app.notice.value?.startsWith("not saved: ")).then(() => null);
    await made.click();
    const file = await Promise.race([saved, refused]);
    if (file === null) {
      saved.catch(() => {});
      continue;
    }
    refused.catch(() => {});
    const bytes = readFileSync(await file.path());
    const size = await page.evaluate(async ([base64, type]) => {
      const video = document.createElement("video");
      video.src = URL.createObjectURL(new Blob([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], { type }));
      await new Promise((resolve, reject) => {
        video.onloadedmetadata = resolve;
        video.onerror = () => reject(video.error);
      });
      return [video.videoWidth, video.videoHeight];
    }, [bytes.toString("base64"), `video/${kind.toLowerCase()}`]);
    assert.deepEqual(size, [1920, 1080], kind);
  }
});
