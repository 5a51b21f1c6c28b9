// Tests of the rendering: pixels of rods and cables against an independent projection.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { closeBrowser, drawn, openPage, PAGE, picture, projection, untilTime, viewPixels } from "./browser.mjs";
import { CABLE_COUNT, cables, nodes, SLACK, tension_n, worldPoint } from "./fixture.mjs";
import { MockServer } from "./mock_server.mjs";

const CLEAR_PX = 12; // rods and cables are narrower
const SCALE_N = 40; // the largest tension of the fixture is 38.4 N
const GROUND = { light: 210, dark: 50 }; // brightness, of 255
let server;

before(async () => {
  server = await new MockServer(PAGE, { mode: "replay" }).start();
});
after(async () => {
  await closeBrowser();
  await server.stop();
});

const difference = (a, b) => Math.max(...a.map((value, k) => Math.abs(value - b[k])));
const between = (a, b, part) => a.map((value, k) => value + part * (b[k] - value));
const brightness = (colour) => (colour[0] + colour[1] + colour[2]) / 3;

/**
 * Returns the share of points along a line, without points near other objects, whose pixel or a neighbor
 * passes.
 */
function along(project, image, line, others, passes) {
  let [hits, seen] = [0, 0];
  for (let part = 0.08; part < 0.93; part += 0.02) {
    const { x, y } = project(between(...line, part));
    if (others.some((other) => awayFrom(x, y, ...other.map(project)) < CLEAR_PX)) continue;
    ++seen;
    const near = [-1, 0, 1].flatMap((dx) => [-1, 0, 1].map((dy) => image.colour(x + dx, y + dy)));
    if (near.some(passes)) ++hits;
  }
  assert.ok(seen >= 6, `only ${seen} points are free to be seen`);
  return hits / seen;
}

function awayFrom(x, y, a, b) {
  const [dx, dy] = [b.x - a.x, b.y - a.y];
  const part = Math.min(Math.max(((x - a.x) * dx + (y - a.y) * dy) / (dx * dx + dy * dy), 0), 1);
  return Math.hypot(x - a.x - part * dx, y - a.y - part * dy);
}

/** Returns all rods and cables but one. */
function othersThan(kind, index, time_s) {
  const rods = [0, 1, 2].filter((i) => kind !== "rod" || i !== index).map((i) => rodEnds(i, time_s));
  const lines = cables.map((_, i) => i).filter((i) => kind !== "cable" || i !== index).map((i) => cableEnds(i, time_s));
  return [...rods, ...lines];
}

function rodEnds(i, time_s) {
  return [2 * i, 2 * i + 1].map((node) => worldPoint(i, nodes[node].position_m, time_s));
}

function cableEnds(i, time_s) {
  return cables[i].attachments.map(({ body, position_m }) => worldPoint(body, position_m, time_s));
}

async function sceneAt(t, theme, time_s) {
  const page = await openPage(server.url, { theme });
  t.after(() => page.context().close());
  await page.keyboard.press("a"); // hides the arrows, which would cover the measured pixels
  await page.evaluate((wanted) => window.taut.app.seek(wanted), time_s);
  await untilTime(page, time_s);
  await page.waitForFunction((scale) => window.taut.view.world.cables.scale_n === scale, SCALE_N);
  await page.evaluate(() => {
    // a view with little occlusion
    const { camera, target } = window.taut.view;
    camera.position.copy(target).add(camera.position.clone().set(1.03, 0.28, 0.43));
    document.querySelector(".legend").hidden = true;
  });
  await drawn(page);
  return { page, project: await projection(page), image: await viewPixels(page) };
}

for (const theme of ["light", "dark"]) {
  test(`RodsAreWhereTheirBodiesAre (${theme})`, async (t) => {
    for (const time_s of [0, 4, 8]) {
      const { page, project, image } = await sceneAt(t, theme, time_s);
      // gray, or red under compression
      const isRod = (colour) => (colour[0] - colour[1] > 30 && colour[0] - colour[2] > 30) ||
        ((theme === "light" ? brightness(colour) < 110 : brightness(colour) > 75) && Math.max(...colour) - Math.min(...colour) < 45);
      for (let i = 0; i < 3; ++i) {
        const share = along(project, image, rodEnds(i, time_s), othersThan("rod", i, time_s), isRod);
        assert.ok(share > 0.9, `rod ${i} at ${time_s} s: ${share} of its axis is drawn`);
      }
      // the ground is visible elsewhere
      const { x, y } = project([0.05 * time_s - 0.25, 0.4, 0]);
      const free = image.colour(x, y);
      assert.ok(Math.abs(brightness(free) - GROUND[theme]) < 40 && !isRod(free), `ground is ${free}`);
      await page.context().close(); // the driver must leave before the next client can drive
    }
  });

  test(`CablesHaveTheColourOfTheirTension (${theme})`, async (t) => {
    const time_s = 4;
    const { page, project, image } = await sceneAt(t, theme, time_s);
    const expected = await page.evaluate(() => window.taut.view.world.cables.object.children.map((line) => line.material.color.getHex()));
    for (let i = 0; i < CABLE_COUNT; ++i) {
      const wanted = [expected[i] >> 16, (expected[i] >> 8) & 255, expected[i] & 255];
      const share = along(project, image, cableEnds(i, time_s), othersThan("cable", i, time_s), (colour) => difference(colour, wanted) < 40);
      if (i === SLACK) assert.ok(share > 0.25 && share < 0.9, `slack cable ${i} is dashed: ${share} of it is drawn`);
      else assert.ok(share > 0.8, `cable ${i}: ${share} of it is drawn in ${wanted}`);
    }
  });
}

/** Returns pixels per meter at a point, with a projection computed independently of the page's camera. */
async function scaleAt(page, project, point) {
  const { height, fov } = await page.evaluate(() => ({ height: window.taut.view.canvas.clientHeight, fov: window.taut.view.camera.fov }));
  return height / 2 / Math.tan((fov * Math.PI) / 360) / project(point).depth;
}

const widthsOf = (page) => page.evaluate(() => window.taut.view.world.cables.object.children.map(({ material }) => ({ width: material.linewidth, dashed: material.dashed })));
const STRUT_M = 0.016; // diameter of the fixture's rods

test("ColourAndWidthRiseWithTension", async (t) => {
  const { page, project } = await sceneAt(t, "light", 4);
  const lines = await widthsOf(page);
  for (let i = 0; i < CABLE_COUNT; ++i) {
    assert.equal(lines[i].dashed, i === SLACK);
    if (i === SLACK) continue;
    // widths are in meters: from 14 % to 50 % of the strut's diameter
    const width = STRUT_M * (0.14 + (0.36 * tension_n(i, 4)) / SCALE_N) * (await scaleAt(page, project, between(...cableEnds(i, 4), 0.5)));
    assert.ok(Math.abs(lines[i].width - Math.max(width, 1.25)) < 0.02, `cable ${i}: ${lines[i].width} px, not ${width}`);
  }
  const legend = await page.locator(".legend .marks").first().innerText();
  assert.deepEqual(legend.split(/\s*N\s*/).filter((part) => part !== "").map(Number), [0, 20, 40]);
});

test("ACableIsNeverThickerThanAStrut", async (t) => {
  const { page } = await sceneAt(t, "light", 4);
  for (const far of [1, 3, 10, 30]) {
    await page.evaluate((factor) => {
      const { camera, target, view } = { ...window.taut.view, view: window.taut.view, camera: window.taut.view.camera, target: window.taut.view.target };
      camera.position.copy(target).add(camera.position.clone().set(1.03, 0.28, 0.43).multiplyScalar(factor));
      view.invalidate();
    }, far);
    await drawn(page);
    const project = await projection(page);
    for (const [i, { width }] of (await widthsOf(page)).entries()) {
      const strut_px = STRUT_M * (await scaleAt(page, project, between(...cableEnds(i, 4), 0.5)));
      assert.ok(width <= Math.max(strut_px, 0.51), `cable ${i} is ${width} px wide, a strut ${strut_px}, at ${far} times the distance`);
    }
  }
});

/** Returns CIELAB of an sRGB color. */
function lab(colour) {
  const [r, g, b] = colour.map((value) => (value / 255 <= 0.04045 ? value / 255 / 12.92 : ((value / 255 + 0.055) / 1.055) ** 2.4));
  const f = (value) => (value > 0.008856 ? Math.cbrt(value) : 7.787 * value + 16 / 116);
  const [x, y, z] = [(0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505, 0.2126 * r + 0.7152 * g + 0.0722 * b, (0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089].map(f);
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}

for (const theme of ["light", "dark"]) {
  test(`TheScaleOfTensionIsPerceptuallyUniform (${theme})`, async (t) => {
    const page = await openPage(server.url, { theme });
    t.after(() => page.context().close());
    const colours = await page.evaluate(() => {
      const scale = document.querySelector(".legend canvas");
      const { data } = scale.getContext("2d").getImageData(0, scale.height / 2, scale.width, 1);
      return Array.from({ length: 17 }, (_, i) => [...data.slice(4 * Math.round((i * (scale.width - 1)) / 16), 4 * Math.round((i * (scale.width - 1)) / 16) + 3)]);
    });
    const points = colours.map(lab);
    const steps = points.slice(1).map((point, i) => Math.hypot(...point.map((value, k) => value - points[i][k])));
    const rises = points.slice(1).map(([l], i) => l - points[i][0]);
    assert.ok(rises.every((rise) => (theme === "light" ? rise < 0 : rise > 0)), `lightness is monotonic: ${rises}`);
    // a straight line in CIELAB would have equal steps; the old scale's differed by a factor of 4
    assert.ok(Math.max(...steps) < 2.6 * Math.min(...steps), `steps: ${steps}`);
  });
}

test("StrutsAreColouredByTheirCompression", async (t) => {
  const { page } = await sceneAt(t, "light", 4);
  const shown = await page.evaluate(() => ({ force_n: [...window.taut.view.world.compression.force_n], scale_n: window.taut.view.world.compressionScale_n,
    red: window.taut.view.world.bodies.meshes.filter(({ userData }) => userData.kind === "rod").map(({ material }) => material.color.clone().convertLinearToSRGB().r) }));
  for (let i = 0; i < 3; ++i) {
    // half of the axial components of the cables' forces at both ends
    const [low, high] = rodEnds(i, 4);
    const axis = between(low, high, 1).map((value, k) => value - low[k]);
    const length = Math.hypot(...axis);
    let compression_n = 0;
    cables.forEach(({ attachments }, c) => attachments.forEach(({ body, position_m }, end) => {
      if (body !== i) return;
      const [here, there] = [cableEnds(c, 4)[end], cableEnds(c, 4)[1 - end]];
      const pull = there.map((value, k) => value - here[k]);
      const side = Math.hypot(...position_m.map((value, k) => value - nodes[2 * i + 1].position_m[k])) < 1e-9 ? 1 : -1;
      compression_n -= (0.5 * side * tension_n(c, 4) * pull.reduce((sum, value, k) => sum + value * axis[k], 0)) / length / Math.hypot(...pull);
    }));
    assert.ok(Math.abs(shown.force_n[i] - compression_n) < 1e-9, `rod ${i}: ${shown.force_n[i]} N, not ${compression_n}`);
  }
  const most = shown.force_n.indexOf(Math.max(...shown.force_n));
  assert.ok(shown.scale_n >= shown.force_n[most] && shown.red[most] === Math.max(...shown.red), JSON.stringify(shown));
  assert.match(await page.evaluate(() => document.querySelector(".legend").textContent), /strut compression/);
});

test("ContactForcesAreArrowsToScale", async (t) => {
  const page = await openPage(server.url);
  t.after(() => page.context().close());
  await page.evaluate(() => window.taut.app.seek(2));
  await untilTime(page, 2);
  const arrows = await page.evaluate(() => {
    const { forces } = window.taut.view.world;
    const [shafts, heads] = forces.contacts.object.children;
    const length = (mesh, i) => Math.hypot(...mesh.instanceMatrix.array.slice(16 * i + 4, 16 * i + 7));
    return { count: shafts.count, lengths: [0, 1, 2].map((i) => length(shafts, i) + length(heads, i)), m_per_n: forces.reference_m / forces.reference_n };
  });
  assert.equal(arrows.count, 3);
  for (const length of arrows.lengths) assert.ok(Math.abs(length - 4.905 * arrows.m_per_n) < 1e-6);
});

for (const theme of ["light", "dark"]) {
  test(`FromBelowTheRobotIsSeenThroughTheFloor (${theme})`, async (t) => {
    const { page } = await sceneAt(t, theme, 4);
    await page.evaluate(() => {
      const { camera, target } = window.taut.view;
      camera.position.copy(target).add(camera.position.clone().set(-1.065, 0.746, -0.4));
    });
    await drawn(page);
    const [project, image] = [await projection(page), await viewPixels(page)];
    const ground = image.colour(...Object.values(project([0.05 * 4 - 0.25, 0.4, 0])).slice(0, 2));
    for (let i = 0; i < 3; ++i) {
      const share = along(project, image, rodEnds(i, 4), othersThan("rod", i, 4), (colour) => Math.abs(brightness(colour) - brightness(ground)) > 25);
      assert.ok(share > 0.9, `rod ${i}: ${share} of its axis is seen`);
    }
    await picture(page, `below-${theme}`);
  });
}

test("FromAboveTheFloorHidesWhatIsBelow", async (t) => {
  const { page } = await sceneAt(t, "light", 0);
  const floor = () => page.evaluate(() => {
    const { transparent, opacity } = window.taut.view.world.ground.object.children[0].material;
    return { transparent, opacity };
  });
  assert.deepEqual(await floor(), { transparent: false, opacity: 1 });
  await page.evaluate(() => (window.taut.view.camera.position.z = -1));
  await drawn(page);
  assert.equal((await floor()).transparent, true);
  await page.evaluate(() => (window.taut.view.camera.position.z = 1));
  await drawn(page);
  assert.deepEqual(await floor(), { transparent: false, opacity: 1 });
});

test("WhereATraceHasNoContactForcesTheLegendSaysHowToRecordThem", async (t) => {
  const page = await openPage(server.url);
  t.after(() => page.context().close());
  assert.equal(await page.locator(".legend .unrecorded").isVisible(), false);
  assert.match(await page.locator(".legend").innerText(), /➔\s*contact/);
  const without = await new MockServer(PAGE, { mode: "replay", more: { contact_forces: false } }).start();
  t.after(() => without.stop());
  const other = await openPage(without.url);
  assert.equal(await other.locator(".legend .unrecorded").isVisible(), true);
  assert.match(await other.locator(".legend .unrecorded").innerText(), /no contact forces in this trace.*record: \{contacts: 20\}/);
  assert.doesNotMatch(await other.locator(".legend").innerText(), /➔\s*contact/);
  await other.context().close();
});

test("PicturesOfTheScene", async (t) => {
  for (const theme of ["light", "dark"]) {
    const { page } = await sceneAt(t, theme, 4);
    await page.keyboard.press("a");
    await drawn(page);
    const image = await picture(page, `scene-${theme}`);
    assert.ok(image.length > 20_000, "a picture of one colour would be smaller");
    assert.deepEqual(page.complaints, []);
  }
});
