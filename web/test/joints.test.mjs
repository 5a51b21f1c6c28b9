// Tests of the marks of joints: position, shape by kind, and names.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { closeBrowser, drawn, openPage, PAGE, picture, projection, untilTime, viewPixels } from "./browser.mjs";
import { nodes, pose, TURN_RAD_PER_S, worldPoint } from "./fixture.mjs";
import { MockServer } from "./mock_server.mjs";

const AT_S = 4;
const IN_THE_MIDDLE = ["ball", "hinge", "weld"]; // kinds whose mark includes the point itself
const KINDS = ["ball", "hinge", "weld", "prismatic", "cylindrical", "planar", "line", "plane", "distance"];
const minus = (a, b) => a.map((value, k) => value - b[k]);
const length = (a) => Math.hypot(...a);
const unit = (a) => a.map((value) => value / length(a));
const AXIS = unit([0.6, -0.48, 0.64]);
const SLIDE_M = 0.03;

/**
 * Converts a point in W at the start to a body's frame; at the start all bodies have their described pose.
 */
const inBody = (body, point) => (body < 0 ? point : minus(point, pose(body, 0).position_m));
const joint = (name, kind, body_a, body_b, at, to = at) => ({
  name, kind, body_a, body_b, from_m: inBody(body_a, at), to_m: inBody(body_b, to), axis: AXIS,
});
const along = (point, way_m) => point.map((value, k) => value + way_m * AXIS[k]);

// One joint of each kind between two rods in the air, at separate places, and once more as a support. Sliding
// joints have slid.
const places = KINDS.map((_, i) => [0.24, -0.1 + 0.06 * i, 0.42 + 0.06 * (i % 2)]);
const slides = { prismatic: SLIDE_M, cylindrical: SLIDE_M, line: SLIDE_M, distance: SLIDE_M };
const joints = [
  ...KINDS.map((kind, i) => joint(kind, kind, 0, 1, places[i], along(places[i], slides[kind] ?? 0))),
  // at the low end of a rod, inside a ball of 2 cm
  joint("in_a_ball", "ball", 0, 1, worldPoint(0, nodes[0].position_m, 0)),
  ...KINDS.filter((kind) => kind !== "distance").map((kind, i) => joint(`${kind}_support`, kind, -1, 2, [-0.3, -0.3 + 0.1 * i, i % 2 ? 0.15 : 0.35])),
];
let server;

before(async () => {
  server = await new MockServer(PAGE, { mode: "replay", more: { joints } }).start();
});
after(async () => {
  await closeBrowser();
  await server.stop();
});

async function pageAt(t, time_s, options = {}) {
  const page = await openPage(server.url, options);
  t.after(() => page.context().close());
  await page.evaluate((wanted) => window.taut.app.seek(wanted), time_s);
  await untilTime(page, time_s);
  return page;
}

/** Returns position, y axis and size of each part of each mark in W; for distance joints the line. */
const marksOf = (page) => page.evaluate(() => {
  const { joints } = window.taut.view.world;
  joints.object.updateMatrixWorld(true);
  const part = (mesh) => {
    if (!mesh) return null;
    const m = mesh.matrixWorld.elements;
    mesh.geometry.computeBoundingBox();
    return {
      below: mesh.geometry.boundingBox.min.z < -2, above: mesh.geometry.boundingBox.max.z > 2, at: [m[12], m[13], m[14]], y: [m[4], m[5], m[6]], x: [m[0], m[1], m[2]], geometry: mesh.geometry.type };
  };
  return {
    marks: joints.marks.map(({ rail, bead, foot }) => ({ rail: part(rail), bead: part(bead), foot: part(foot) })),
    lines: [...joints.lines.geometry.getAttribute("position").array],
    tubes: [...joints.tubes.instanceMatrix.array],
  };
});
const near = (a, b, what, within = 1e-6) => assert.ok(length(minus(a, b)) < within, `${what}: ${a}, not ${b}`);

/** Rotates a direction of the robot as its bodies: about the vertical. */
const turned = ([x, y, z], time_s) => {
  const angle = TURN_RAD_PER_S * time_s;
  return [x * Math.cos(angle) - y * Math.sin(angle), x * Math.sin(angle) + y * Math.cos(angle), z];
};

test("MarksAreWhereTheBodiesHoldEachOther", async (t) => {
  for (const time_s of [0, AT_S]) {
    const page = await pageAt(t, time_s);
    const { marks, lines, tubes } = await marksOf(page);
    assert.equal(marks.length, joints.length);
    joints.forEach(({ name, kind, body_a, body_b, from_m, to_m }, i) => {
      const what = `${name} at ${time_s} s`;
      const a = body_a < 0 ? from_m : worldPoint(body_a, from_m, time_s);
      const b = worldPoint(body_b, to_m, time_s);
      const { rail, bead, foot } = marks[i];
      const way_m = minus(b, a).reduce((sum, value, k) => sum + value * (body_a < 0 ? AXIS : turned(AXIS, time_s))[k], 0);
      if (bead) near(bead.at, b, what);
      if (rail) {
        const middle = ["prismatic", "cylindrical", "line"].includes(kind);
        near(unit(rail.y), body_a < 0 ? AXIS : turned(AXIS, time_s), `${what}: its axis`);
        near(rail.at, middle ? a.map((value, k) => value + 0.5 * way_m * unit(rail.y)[k]) : a, what);
        const radius_m = length(rail.x);
        if (middle) assert.ok(Math.abs(length(rail.y) - Math.abs(way_m) - 6 * radius_m) < 1e-6, `${what}: it reaches from a to b`);
      }
      if (bead && kind !== "ball" && body_a >= 0) near(unit(bead.y), turned(AXIS, time_s), `${what}: it turns with b`);
      assert.equal(foot !== null, body_a < 0, `${what}: who stands on the ground has a foot`);
      if (foot) {
        near(foot.at, from_m, `${what}: its foot`);
        const hangs = from_m[2] > pose(body_b, 0).position_m[2];
        assert.deepEqual([foot.below, foot.above], [!hangs, hangs], `${what}: it is on the side where the body is not`);
      }
      if (foot && bead) near(unit(bead.y), turned(AXIS, time_s), `${what}: it turns with b, not with the world`);
    });
    const distance = joints[KINDS.indexOf("distance")];
    near(lines.slice(0, 3), worldPoint(0, distance.from_m, time_s), "a line from a");
    near(lines.slice(3, 6), worldPoint(1, distance.to_m, time_s), "a line to b");
    assert.equal(lines.length, 6);
    // the tube, whose y axis is the way from a to b and whose other axes are its diameter
    assert.equal(tubes.length, 16);
    const [from, to] = [worldPoint(0, distance.from_m, time_s), worldPoint(1, distance.to_m, time_s)];
    near(tubes.slice(4, 7), minus(to, from), "the direction and length of a bar");
    near(tubes.slice(12, 15), from.map((value, k) => 0.5 * (value + to[k])), "the middle of a bar");
    assert.ok(length(tubes.slice(0, 3)) > 0.004 && Math.abs(length(tubes.slice(0, 3)) - length(tubes.slice(8, 11))) < 1e-9);
    await page.context().close();
  }
});

test("EachKindHasAMarkOfItsOwn", async (t) => {
  const page = await pageAt(t, 0);
  const { marks } = await marksOf(page);
  const looks = KINDS.map((_, i) => [marks[i].rail?.geometry ?? "", marks[i].bead?.geometry ?? ""].join("+"));
  assert.deepEqual(looks, ["+SphereGeometry", "CylinderGeometry+", "+BoxGeometry", "BoxGeometry+BoxGeometry", "CylinderGeometry+CylinderGeometry",
    "BoxGeometry+BoxGeometry", "CylinderGeometry+SphereGeometry", "CylinderGeometry+SphereGeometry", "+"]);
  // a bar is elongated, a plate flat
  const ratio = ({ rail }) => length(rail.y) / length(rail.x);
  assert.ok(ratio(marks[KINDS.indexOf("prismatic")]) > 5 && Math.abs(ratio(marks[KINDS.indexOf("planar")]) - 1) < 1e-6);
  // a mark in a ball of 2 cm protrudes from it
  assert.ok(length(marks[KINDS.length].bead.x) > 0.02 && length(marks[0].bead.x) < 0.02);
});

for (const theme of ["light", "dark"]) {
  test(`MarksAreSeenAndSwitchedOff (${theme})`, async (t) => {
    const page = await pageAt(t, AT_S, { theme });
    await page.keyboard.press("a");
    await page.evaluate(() => (document.querySelector(".legend").hidden = true));
    await drawn(page);
    await picture(page, `joints-${theme}`);
    const project = await projection(page);
    const [r, g, b] = await page.evaluate(() => window.taut.view.world.joints.marks[0].material.color.getHex()).then((hex) => [hex >> 16, (hex >> 8) & 255, hex & 255]);
    assert.ok(r > g && g > b, "its colour is that of brass");
    const warmth = (image, i) => {
      const { x, y } = project(worldPoint(0, joints[i].from_m, AT_S));
      const colour = image.colour(x, y);
      return colour[0] - colour[2];
    };
    const shown = await viewPixels(page);
    for (const kind of IN_THE_MIDDLE) assert.ok(warmth(shown, KINDS.indexOf(kind)) > 25, `${kind} is seen: ${warmth(shown, KINDS.indexOf(kind))}`);
    await page.keyboard.press("j");
    await drawn(page);
    const hidden = await viewPixels(page);
    for (const kind of IN_THE_MIDDLE) assert.ok(warmth(hidden, KINDS.indexOf(kind)) < 10, `${kind} is not seen any more`);
    await page.keyboard.press("j");
    await drawn(page);
    assert.ok(warmth(await viewPixels(page), 0) > 25);
    assert.deepEqual(page.complaints, []);
  });
}

test("AJointHasANameAndNumbers", async (t) => {
  const page = await pageAt(t, AT_S);
  const project = await projection(page);
  const box = await page.locator(".view > canvas").boundingBox();
  const over = async (i) => {
    const { x, y } = project(worldPoint(0, joints[i].from_m, AT_S));
    await page.mouse.move(box.x + x, box.y + y);
    return page.locator(".tip").innerText();
  };
  assert.equal(await over(KINDS.indexOf("hinge")), "joint hinge");
  assert.equal(await over(KINDS.length), "joint in_a_ball, node rod_0.low");
  await over(KINDS.indexOf("ball"));
  await page.mouse.down();
  await page.mouse.up();
  const numbers = await page.locator(".inspector").innerText();
  assert.match(numbers, /joint ball/);
  assert.match(numbers, /between\s+rod_0 → rod_1/);
  const at = worldPoint(1, joints[0].to_m, AT_S).map((value) => value.toFixed(4).replace("-", "−")).join(", ");
  assert.ok(numbers.includes(at), `${numbers} has ${at}`);
  const lit = await page.evaluate(() => window.taut.view.world.joints.marks.map(({ material }) => material.color.getHex()));
  assert.ok(lit[0] !== lit[1] && lit[1] === lit[2], "it alone is lit up");
  assert.match(await page.locator(".legend").innerText(), /●\s*joint/);
});
