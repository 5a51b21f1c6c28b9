// Cables that go round wheels are drawn where the physics has them; how often round, their length says.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { closeBrowser, openPage, PAGE, untilTime } from "./browser.mjs";
import { cables } from "./fixture.mjs";
import { MockServer } from "./mock_server.mjs";

// The fixture's cable 0 has a length of 0.3 m. Its ends hang 0.1 m below the sides of a wheel.
const TURNS = 1;
const R = 0.1 / (Math.PI * (1 + 2 * TURNS));
const CENTER = [0.4, 0.1, 0.5];
const once = 2 * Math.PI - 2 * Math.atan2(R, 0.1); // over the top, from below to below
const place = (x, z) => [CENTER[0] + x, CENTER[1], CENTER[2] + z];
const wheel = (angle_rad) => ({ axis: [0, 1, 0], radius_m: R, angle_rad });
const fixed = (position_m, more = {}) => ({ body: -1, position_m, ...more });
const over = (angle_rad) => [fixed(place(-R, -0.1)), fixed(CENTER, { wheel: wheel(angle_rad) }), fixed(place(R, -0.1))];
// Cable 1, 0.31 m, goes straight past a wheel.
const past = [fixed([0, 0.3, 0.6]), fixed([0.1, 0.3, 0.66], { wheel: wheel(0.1 - Math.PI) }), fixed([0.31, 0.3, 0.6])];
const with_wheels = cables.map((cable, i) => ({ ...cable, attachments: [over(once), past][i] ?? cable.attachments }));
let server;

before(async () => {
  server = await new MockServer(PAGE, { mode: "replay", more: { cables: with_wheels } }).start();
});
after(async () => {
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
