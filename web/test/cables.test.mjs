// Tests that cables around wheels are drawn where the physics has them, with the number of turns from their
// length, and that wrapped cables are drawn over the bends in their channels, each span in the color of its
// tension.
import assert from "node:assert/strict";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, afterEach, before, test } from "node:test";
import { closeBrowser, drawn as shown, openPage, PAGE, picture, untilTime } from "./browser.mjs";
import { cables } from "./fixture.mjs";
import { MockServer } from "./mock_server.mjs";
import { csvOf, options, stop, taut, view } from "./real_server.mjs";

// The fixture's cable 0 has a length of 0.3 m. Its ends hang 0.1 m below the sides of a wheel.
const TURNS = 1;
const R = 0.1 / (Math.PI * (1 + 2 * TURNS));
const CENTER = [0.4, 0.1, 0.5];
const once = 2 * Math.PI - 2 * Math.atan2(R, 0.1); // over the top, from below to below
const place = (x, z) => [CENTER[0] + x, CENTER[1], CENTER[2] + z];
const wheel = (angle_rad) => ({ axis: [0, 1, 0], radius_m: R, angle_rad });
const fixed = (position_m, more = {}) => ({ body: -1, position_m, ...more });
const over = (angle_rad) => [fixed(place(-R, -0.1)), fixed(CENTER, { wheel: wheel(angle_rad) }), fixed(place(R, -0.1))];
// Cable 1, 0.31 m, passes a wheel without contact.
const past = [fixed([0, 0.3, 0.6]), fixed([0.1, 0.3, 0.66], { wheel: wheel(0.1 - Math.PI) }), fixed([0.31, 0.3, 0.6])];
const with_wheels = cables.map((cable, i) => ({ ...cable, attachments: [over(once), past][i] ?? cable.attachments }));
let server;
let folder;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), "taut-cables-"));
  server = await new MockServer(PAGE, { mode: "replay", more: { cables: with_wheels } }).start();
});
afterEach(stop);
after(async () => {
  rmSync(folder, { recursive: true });
  await closeBrowser();
  await server.stop();
});

async function drawn(t, cable) {
  const page = await openPage(server.url);
  t.after(() => page.context().close());
  await page.evaluate((wanted) => window.taut.app.seek(wanted), 4);
  await untilTime(page, 4);
  return page.evaluate((i) => window.taut.view.world.cables.points[i].map(({ x, y, z }) => [x, y, z]), cable);
}
const near = (a, b, within = 1e-6) => assert.ok(Math.hypot(...a.map((v, k) => v - b[k])) < within, `${a}, not ${b}`);

test("ACableGoesRoundItsWheelAsOftenAsItIsLong", async (t) => {
  const points = await drawn(t, 0);
  near(points[0], place(-R, -0.1));
  near(points[1], place(-R, 0));
  near(points.at(-2), place(R, 0));
  near(points.at(-1), place(R, -0.1));
  let turned = 0;
  const arc = points.slice(1, -1).map(([x, y, z]) => {
    assert.ok(Math.abs(y - CENTER[1]) < 1e-6);
    assert.ok(Math.abs(Math.hypot(x - CENTER[0], z - CENTER[2]) - R) < 1e-6, "on the wheel");
    return Math.atan2(x - CENTER[0], z - CENTER[2]);
  });
  arc.forEach((angle, k) => {
    if (k > 0) turned += angle - arc[k - 1] - 2 * Math.PI * Math.round((angle - arc[k - 1]) / (2 * Math.PI));
  });
  assert.ok(Math.abs(turned - Math.PI * (1 + 2 * TURNS)) < 1e-5, `turned by ${turned}`);
});

test("WhatItDoesNotTouchItPassesStraight", async (t) => {
  const points = await drawn(t, 1);
  for (const [, y, z] of points) near([y, z], [0.3, 0.6]);
});

const OVER_WALL = "docs/tutorial_cables/over_wall.yaml";
const AXES = ["x", "y", "z"];

/** Returns the rope over the wall at a time: its first ball, its bends, its last ball. */
function rope(run, time_s) {
  const place = (name) => AXES.map((axis) => run.value(`${name}${axis}_m`, time_s + 1e-9));
  const bends = Array.from({ length: run.value("cable/rope/bends", time_s + 1e-9) }, (_, i) => place(`cable/rope/bend_${i + 1}_`));
  return [place("body/left/position_"), ...bends, place("body/right/position_")];
}

/** Returns the vertices of the drawn lines: of the rope, and of the ghosts' ropes. */
const corners = (page) => page.evaluate(() => {
  const { cables: own, ghosts } = window.taut.view.world;
  const { geometry } = own.lines[0];
  const { array } = geometry.getAttribute("instanceStart").data;
  const triples = (values) => Array.from({ length: values.length / 3 }, (_, k) => Array.from(values.slice(3 * k, 3 * k + 3)));
  return {
    time_s: window.taut.app.frame.value.time_s,
    rope: triples(array.slice(0, 6 * geometry.instanceCount)),
    ghosts: ghosts.ghosts.map(({ lines }) => triples(lines.geometry.getAttribute("position").array.slice(0, 3 * lines.geometry.drawRange.count))),
  };
});

/** Checks each segment of a line between vertices. */
function along(parts, places, what) {
  assert.equal(parts.length, 2 * (places.length - 1), what);
  parts.forEach((corner, k) => near(corner, places[(k + 1) >> 1]));
}

test("ARopeIsDrawnOverTheEdgesThatItLiesOn", options, async (t) => {
  const runs = ["a", "b"].map((name) => join(folder, name));
  taut("run", OVER_WALL, "--duration_s", "1", "--csv", "--quiet", "--out", runs[0]);
  taut("run", OVER_WALL, "--duration_s", "1", "--csv", "--quiet", "--out", runs[1], "--set", "wall_height_m=0.2");
  const [run, other] = runs.map(csvOf);
  const traces = [join(runs[0], "trace.h5"), "--compare", join(runs[1], "trace.h5")];
  const file = join(runs[0], "both.html");
  taut("report", ...traces, "--out", file);
  const report = await openPage(`file://${file}`, { width: 1300, height: 900 });
  const replay = await openPage(await view(...traces, "--port", "0"));
  t.after(() => Promise.all([report, replay].map((page) => page.context().close())));
  for (const page of [report, replay]) {
    const bends = [];
    for (const time_s of [2 / 30, 4 / 30, 0.9]) {
      await page.evaluate((wanted) => window.taut.app.seek(wanted), time_s);
      await untilTime(page, time_s, 0.02); // a report has one frame per 33 ms
      const seen = await corners(page);
      along(seen.rope, rope(run, seen.time_s), `at ${seen.time_s} s`);
      along(seen.ghosts[0], rope(other, seen.time_s), `ghost at ${seen.time_s} s`);
      bends.push([seen.rope.length, seen.ghosts[0].length].map((count) => count / 2 - 1));
    }
    assert.deepEqual(bends, [[0, 0], [2, 0], [2, 2]]);
  }
  await picture(report, "rope-over-wall");
});

test("EachSpanHasTheColourOfItsTension", options, async (t) => {
  const out = join(folder, "friction");
  taut("run", OVER_WALL, "--duration_s", "1", "--csv", "--quiet", "--out", out, "--set", "friction=0.2", "--set", "right_kg=0.3");
  const run = csvOf(out);
  const file = join(folder, "friction.html");
  taut("report", join(out, "trace.h5"), "--out", file);
  const addresses = [
    async () => `file://${file}`,
    () => view(join(out, "trace.h5"), "--port", "0"),
    () => view(OVER_WALL, "--set", "friction=0.2", "--set", "right_kg=0.3", "--paused", "--port", "0"),
  ];
  for (const [i, address] of addresses.entries()) {
    const page = await openPage(await address(), { width: 1300, height: 900 });
    t.after(() => page.context().close());
    if (i === 2) await page.evaluate(() => window.taut.app.send({ type: "step", count: 900 }));
    else await page.evaluate((wanted) => window.taut.app.seek(wanted), 0.9);
    await untilTime(page, 0.9, 0.02);
    await shown(page);
    const seen = await page.evaluate(() => {
      const { cables } = window.taut.view.world;
      const { geometry } = cables.lines[0];
      return {
        time_s: window.taut.app.frame.value.time_s,
        scale_n: cables.scale_n,
        colours: Array.from(geometry.getAttribute("instanceColorStart").data.array.slice(0, 6 * geometry.instanceCount)),
      };
    });
    const tensions = [1, 2, 3].map((span) => run.value(`cable/rope/span_${span}_tension_n`, seen.time_s + 1e-9));
    assert.ok(Number.isNaN(run.value("cable/rope/span_4_tension_n", seen.time_s + 1e-9)));
    assert.ok(tensions[2] > 1.3 * tensions[0] && tensions[1] > tensions[0], `${tensions} N`);
    const expected = await page.evaluate((shares) => shares.map((share) => window.taut.view.world.cables.tensionColour(share).toArray()), tensions.map((n) => n / seen.scale_n));
    assert.equal(seen.colours.length, 18);
    expected.forEach((colour, k) => {
      near(seen.colours.slice(6 * k, 6 * k + 3), colour);
      near(seen.colours.slice(6 * k + 3, 6 * k + 6), colour);
    });
    assert.ok(Math.hypot(...expected[0].map((x, k) => x - expected[2][k])) > 0.01, `${seen.scale_n} N`);
    await picture(page, "rope-with-friction");
    await stop();
  }
});

test("ALiveRopeLiesOnEdgesNowAndInItsPast", options, async (t) => {
  const out = join(folder, "live");
  taut("run", OVER_WALL, "--duration_s", "1", "--csv", "--quiet", "--out", out);
  const run = csvOf(out);
  const page = await openPage(await view(OVER_WALL, "--paused", "--port", "0"));
  t.after(() => page.context().close());
  await page.evaluate(() => window.taut.app.send({ type: "step", count: 900 }));
  for (const [time_s, bends] of [[0.9, 2], [0.3, 2], [0.05, 0]]) {
    if (time_s < 0.9) await page.evaluate((wanted) => window.taut.app.seek(wanted), time_s);
    await page.waitForFunction((wanted) => Math.abs(window.taut.app.frame.value.time_s - wanted) < 1e-6, time_s);
    await shown(page);
    const seen = await corners(page);
    assert.equal(seen.rope.length, 2 * (bends + 1), `at ${time_s} s`);
    along(seen.rope, rope(run, time_s), `at ${time_s} s`);
  }
  const channels = await page.evaluate(() => window.taut.app.scene.value.channels.map(({ name }) => name));
  assert.ok(channels.includes("cable/rope/bends"));
});
