// Tests of compared runs: names and colors, a ghost for each run with poses, differences.
import assert from "node:assert/strict";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { closeBrowser, cursorTo, drawn, numbersBeside, openPage, PAGE, picture, projection, untilTime, viewPixels, writeReport } from "./browser.mjs";
import { comparedRuns, EARLY_END_S, GHOST_OFFSET_M, nodes, pose, report, scene, setpoint_n, tension_n, worldPoint } from "./fixture.mjs";
import { MockServer } from "./mock_server.mjs";

const NAMES = comparedRuns.map(({ name }) => name);
const GHOSTS = [0, 2, 3]; // compared runs with poses
let folder;
let server;
let page;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), "taut-runs-"));
  server = await new MockServer(PAGE, { mode: "replay", compared: comparedRuns, more: { run_name: "prism (this/trace.h5)" } }).start();
  page = await openPage(server.url, { width: 1280, height: 800 });
});
after(async () => {
  await closeBrowser();
  await server.stop();
  rmSync(folder, { recursive: true });
});

async function goTo(time_s) {
  await page.evaluate((wanted) => window.taut.app.seek(wanted), time_s);
  await untilTime(page, time_s);
}

/** Returns for each compared run whether its ghost is drawn, and the positions of its bodies. */
const ghosts = (of = page) => of.evaluate(() => window.taut.view.world.ghosts.ghosts.map(({ object, groups }) => ({
  drawn: object.visible, bodies: groups.map(({ position, quaternion: { x, y, z, w } }) => [...position.toArray(), w, x, y, z]),
})));

test("EveryRunHasItsNameAndOneColourEverywhere", async () => {
  await page.waitForFunction(() => document.querySelectorAll('[data-figure^="tension:"] .uplot').length === 9);
  assert.deepEqual(await page.locator(".key span").allInnerTexts(), ["set point", ...NAMES, "this run"]);
  assert.deepEqual(await page.locator(".runs .name").allInnerTexts(), ["this run: prism (this/trace.h5)", ...NAMES]);
  const seen = await page.evaluate(() => {
    const rgb = (element) => getComputedStyle(element).backgroundColor.match(/\d+/g).map(Number);
    const { ghosts: all } = window.taut.view.world.ghosts;
    return {
      list: [...document.querySelectorAll(".runs .swatch")].slice(1).map(rgb),
      key: [...document.querySelectorAll(".key i")].slice(1, -1).map(rgb),
      ghosts: all.map(({ skin }) => skin.color.clone().convertLinearToSRGB().toArray().map((part) => Math.round(255 * part))),
    };
  });
  assert.equal(new Set(seen.list.map(String)).size, 4, "colours differ");
  assert.deepEqual(seen.key, seen.list);
  assert.deepEqual(seen.ghosts, seen.list);
});

test("EveryGhostIsWhereItsRunHasIt", async () => {
  for (const time_s of [0, 2.5, EARLY_END_S]) {
    await goTo(time_s);
    const found = await ghosts();
    GHOSTS.forEach((k) => {
      assert.ok(found[k].drawn);
      assert.equal(found[k].bodies.length, comparedRuns[k].bodies.length);
      found[k].bodies.forEach((numbers, body) => {
        const { position_m, orientation } = pose(body, time_s);
        const wanted = [...position_m.map((value, axis) => value + (k + 1) * GHOST_OFFSET_M[axis]), ...orientation];
        numbers.forEach((value, i) => assert.ok(Math.abs(value - wanted[i]) < 1e-12, `${NAMES[k]}, body ${body} at ${time_s} s`));
      });
    });
  }
});

test("AGhostIsSeenInItsColour", async () => {
  await goTo(2);
  await page.evaluate(() => (document.querySelector(".runs").open = false));
  await drawn(page);
  const project = await projection(page);
  const before = await viewPixels(page);
  const ghost = page.locator(".runs input").nth(3);
  await ghost.evaluate((box) => box.click());
  await drawn(page);
  const without = await viewPixels(page);
  await ghost.evaluate((box) => box.click());
  // the rod of the fourth run, away from this run's robot
  const ends = [0, 1].map((node) => worldPoint(0, nodes[node].position_m, 2).map((value, axis) => value + 4 * GHOST_OFFSET_M[axis]));
  let greener = 0;
  for (let part = 0.1; part < 0.9; part += 0.05) {
    const { x, y } = project(ends[0].map((value, k) => value + part * (ends[1][k] - value)));
    const [a, b] = [before.colour(x, y), without.colour(x, y)];
    if (a.reduce((sum, value, k) => sum + Math.abs(value - b[k]), 0) > 40) ++greener;
  }
  assert.ok(greener >= 12, `only ${greener} of 16 points of the rod change with its switch`);
  await page.evaluate(() => (document.querySelector(".runs").open = true));
});

test("EveryGhostHasASwitchAndARunWithoutPosesSaysWhyItHasNone", async () => {
  await goTo(1);
  const switches = page.locator(".runs input");
  assert.deepEqual(await switches.evaluateAll((all) => all.map(({ checked, disabled }) => [checked, disabled])), [[true, false], [false, true], [true, false], [true, false]]);
  assert.match(await page.locator(".runs li").nth(2).innerText(), /no ghost: the trace contains no poses of bodies/);
  await switches.nth(0).uncheck();
  assert.deepEqual((await ghosts()).map((each) => each.drawn), [false, false, true, true]);
  await goTo(1.5);
  assert.deepEqual((await ghosts()).map((each) => each.drawn), [false, false, true, true], "it stays off");
  await page.locator(".view canvas").first().focus();
  await page.keyboard.press("g");
  assert.deepEqual((await ghosts()).map((each) => each.drawn), [true, false, true, true], "all on");
  await page.keyboard.press("g");
  assert.deepEqual((await ghosts()).map((each) => each.drawn), [false, false, false, false], "all off");
  await page.keyboard.press("g");
});

test("ARunThatHasEndedHasNoGhostAndTheListSaysHowFarTheOthersAre", async () => {
  await goTo(EARLY_END_S + 1);
  assert.deepEqual((await ghosts()).map((each) => each.drawn), [true, false, false, true]);
  const away = await page.locator(".runs .away").allInnerTexts();
  const offset_mm = 1000 * Math.hypot(...GHOST_OFFSET_M);
  assert.equal(away[0], `${offset_mm.toFixed(1)} mm away`);
  assert.equal(away[2], `ended at ${EARLY_END_S} s`);
  await goTo(1);
  assert.equal((await page.locator(".runs .away").allInnerTexts())[2], `${(3 * offset_mm).toFixed(0)} mm away`);
});

test("DifferencesAreEachRunLessThisRunAtTheCursor", async (t) => {
  t.after(() => cursorTo(page, null));
  for (const time_s of [0.5, 7.25]) {
    await cursorTo(page, time_s);
    const [{ numbers }] = await numbersBeside(page, ["tension:top_1"]);
    const own_n = tension_n(4, time_s);
    const ended = (source) => comparedRuns[source - 1].last_s < time_s; // then its last row is out of date
    const four = (value) => Number(value.toPrecision(4));
    assert.deepEqual(numbers, [setpoint_n(4), ...[1, 2, 3, 4].map((source) => (ended(source) ? NaN : own_n + 1.5 * source)), own_n].map(four));
    await page.waitForFunction(() => !document.querySelector('[data-figure="tension:top_1"] .differences').textContent.includes("…"));
    const shown = await page.locator('[data-figure="tension:top_1"] .differences span').allInnerTexts();
    assert.deepEqual(shown, ["+1.50", "+3", ended(3) ? "–" : "+4.50", "+6"]);
  }
});

test("WhatIsSelectedIsPlottedOfEveryRun", async () => {
  await page.evaluate(() => (window.taut.app.selection.value = { kind: "cable", index: 4 }));
  const figures = await page.locator('[data-figure^="own:cable:top_1:"]').evaluateAll((all) => all.map(({ dataset }) => dataset.figure));
  assert.ok(figures.includes("own:cable:top_1:tension:tension") && figures.includes("own:cable:top_1:length:rest length"), figures.join());
  const [{ numbers }] = await numbersBeside(page, ["own:cable:top_1:tension:tension"]);
  assert.equal(numbers.length, 5, "four runs and this one");
  await page.evaluate(() => (window.taut.app.selection.value = null));
});

test("AReportHoldsTheGhostsToo", async () => {
  const file = writeReport(report({ scene: { ...scene, compared: comparedRuns } }), folder);
  const other = await openPage(file, { width: 1200, height: 800 });
  await other.evaluate(() => window.taut.app.seek(2));
  await untilTime(other, 2);
  const found = await ghosts(other);
  assert.deepEqual(found.map((each) => each.drawn), [true, false, true, true]);
  const { position_m } = pose(1, 2);
  found[2].bodies[1].slice(0, 3).forEach((value, axis) => assert.ok(Math.abs(value - position_m[axis] - 3 * GHOST_OFFSET_M[axis]) < 1e-12));
  assert.deepEqual(other.complaints, []);
  await other.context().close();
});

test("OnASmallScreenTheListWaitsToBeOpened", async () => {
  const small = await openPage(server.url, { width: 390, height: 844 });
  assert.equal(await small.locator(".runs ul").isVisible(), false);
  await small.locator(".runs summary").click();
  assert.equal(await small.locator(".runs ul").isVisible(), true);
  const [list, view] = [await small.locator(".runs").boundingBox(), await small.locator(".view").boundingBox()];
  assert.ok(list.x >= view.x && list.x + list.width <= view.x + view.width && list.y + list.height <= view.y + view.height);
  await picture(small, "runs-phone");
  await small.context().close();
});

test("PicturesOfRuns", async () => {
  await goTo(2);
  await picture(page, "runs");
  assert.deepEqual(page.complaints, []);
});
