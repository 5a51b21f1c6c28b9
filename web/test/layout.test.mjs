// Tests of the page on small and magnified screens: nothing is cut off, nothing overlaps, and all controls
// are reached by the tab key.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { closeBrowser, drawn, openPage, PAGE, picture, writeReport } from "./browser.mjs";
import { reference, report, scene } from "./fixture.mjs";
import { MockServer } from "./mock_server.mjs";

const servers = {};
let folder;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), "taut-layout-"));
  servers.live = await new MockServer(PAGE, { mode: "live" }).start();
  servers.replay = await new MockServer(PAGE, { mode: "replay", compared: [reference] }).start();
  for (const server of Object.values(servers)) server.time_s = 5;
});
after(async () => {
  await closeBrowser();
  for (const server of Object.values(servers)) await server.stop();
  rmSync(folder, { recursive: true });
});

const address = (use) =>
  use === "report" ? writeReport(report({ scene: { ...scene, compared: [reference] } }), folder) : servers[use].url;

/** Returns layout errors as sentences. */
function faults() {
  const found = [];
  const name = (element) => element.getAttribute("aria-label") || element.textContent.trim() || element.className;
  const shown = (element) => element.checkVisibility() && element.getBoundingClientRect().width > 0;
  const width = document.documentElement.clientWidth;
  if (document.documentElement.scrollWidth > width) found.push(`the page is ${document.documentElement.scrollWidth} px wide, the window ${width}`);
  const parts = [...document.querySelectorAll("header.top > *, footer.timeline > *, .toolbar > *, .legend > *, .controls input, .controls button, .controls select")].filter(shown);
  for (const part of parts) {
    const box = part.getBoundingClientRect();
    if (box.left < -0.5 || box.right > width + 0.5) found.push(`${name(part)} goes beyond the window`);
    if (!part.matches("h1, input, select, .track") && part.scrollWidth > part.clientWidth + 1 && part.clientWidth > 0) found.push(`${name(part)} is cut off`);
  }
  for (const bar of document.querySelectorAll("header.top, footer.timeline, .toolbar")) {
    const boxes = [...bar.children].filter(shown).filter((child) => child.textContent.trim() || child.matches("button, select, .track"));
    boxes.forEach((one, i) => boxes.slice(i + 1).forEach((other) => {
      const [a, b] = [one.getBoundingClientRect(), other.getBoundingClientRect()];
      if (Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1 && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 1) {
        found.push(`${name(one)} lies over ${name(other)}`);
      }
    }));
  }
  const legend = document.querySelector(".legend").getBoundingClientRect();
  const view = document.querySelector(".view").getBoundingClientRect();
  if (legend.right > view.right || legend.top < view.top) found.push("the legend goes beyond the view");
  return found;
}

// A window of 1280 x 720 at 125 % equals one of 1024 x 576 with larger pixels; the last is a projector of 800
// x 600.
for (const use of ["live", "replay", "report"]) {
  for (const [what, size] of Object.entries({
    At125Percent: { width: 1024, height: 576, scale: 1.25 },
    OnAProjector: { width: 800, height: 600, scale: 1 },
  })) {
    test(`NothingOf_${use}_IsCutOffOrCovered${what}`, async () => {
      const page = await openPage(address(use), { ...size, theme: what === "OnAProjector" ? "dark" : "light" });
      if (use === "live") {
        await page.keyboard.press("c");
        await page.evaluate(() => window.taut.app.seek(3));
        await page.waitForFunction(() => window.taut.app.looksBack);
      }
      await drawn(page);
      await picture(page, `layout-${use}-${what}`);
      assert.deepEqual(await page.evaluate(faults), []);
      assert.equal(await page.evaluate(() => devicePixelRatio), size.scale);
      await page.context().close();
    });
  }
}

const PHONE = { width: 390, height: 844, touch: true };
const TABLET = { width: 820, height: 1180, touch: true };

/** Returns the positions of covered corners of the robot, with the covering elements. */
function covered() {
  const { view } = window.taut;
  const frame = view.canvas.getBoundingClientRect();
  const found = [];
  for (const node of view.world.scene.nodes) {
    const group = view.world.bodies.object.children[node.body];
    const at = view.toScreen(view.target.clone().fromArray(node.position_m).applyQuaternion(group.quaternion).add(group.position));
    const [x, y] = [frame.left + at.x, frame.top + at.y];
    // a legend lets clicks pass, but covers the robot nevertheless
    for (const part of document.querySelectorAll(".legend, .inspector, .notice, header.top, footer.timeline, .plots, .below")) {
      const box = part.getBoundingClientRect();
      if (part.checkVisibility() && x >= box.left && x <= box.right && y >= box.top && y <= box.bottom) found.push(`${part.className} over ${node.name}`);
    }
  }
  return found;
}

for (const use of ["live", "replay", "report"]) {
  for (const [what, size] of Object.entries({ Phone: PHONE, Tablet: TABLET })) {
    test(`OnA${what}_${use}_IsScrubbedByAFingerAndNothingCoversTheRobot`, async () => {
      const page = await openPage(address(use), { ...size, theme: what === "Phone" ? "dark" : "light" });
      await drawn(page);
      await picture(page, `layout-${use}-${what}`);
      assert.deepEqual(await page.evaluate(faults), []);
      assert.deepEqual(await page.evaluate(covered), []);
      assert.equal(await page.locator(".top h1").evaluate((title) => title.scrollWidth <= title.clientWidth && title.textContent), "turning prism");
      // a touch on the timeline seeks to its position, also while it moves
      await page.evaluate(() => document.querySelector(".view").scrollIntoView()); // in a report there is more above it
      const track = await page.locator(".track input").boundingBox();
      assert.ok(track.width > 0.9 * (size.width - (use === "report" ? 44 : 24)) || what === "Tablet", `the line of time is ${track.width} px wide`);
      assert.ok(track.width > 300 && track.height >= (what === "Phone" ? 44 : 30), `${track.width} x ${track.height}`);
      const { first_s, last_s } = await page.evaluate(() => {
        const input = document.querySelector(".track input");
        return { first_s: Number(input.min), last_s: Number(input.max) };
      });
      const y = track.y + track.height / 2;
      const session = await page.context().newCDPSession(page);
      const touch = (type, share) => session.send("Input.dispatchTouchEvent", {
        type, touchPoints: type === "touchEnd" ? [] : [{ x: track.x + share * track.width, y }],
      });
      const until = (share) => page.waitForFunction(([wanted, within]) =>
        Math.abs(Number(document.querySelector(".timeline").dataset.time) - wanted) <= within, [first_s + share * (last_s - first_s), (5 * (last_s - first_s)) / track.width]);
      await touch("touchStart", 0.5);
      await touch("touchMove", 0.3);
      await until(0.3);
      await touch("touchMove", 0.62);
      await until(0.62);
      await touch("touchEnd");
      // the values of the selection are beside the robot, not above it
      await page.evaluate(() => (window.taut.app.selection.value = { kind: "cable", index: 1 }));
      await drawn(page);
      assert.deepEqual(await page.evaluate(covered), []);
      const small = await page.evaluate(() => [...document.querySelectorAll("header.top button, footer.timeline button, footer.timeline select, .toolbar button:not(.small)")]
        .filter((element) => element.checkVisibility()).map((element) => ({ name: element.ariaLabel, box: element.getBoundingClientRect() }))
        .filter(({ box }) => box.width < 44 || box.height < 44).map(({ name, box }) => `${name}: ${box.width} x ${box.height}`));
      if (what === "Phone") assert.deepEqual(small, []);
      await page.context().close();
    });
  }
}

// Screen readers use the browser's accessibility tree of roles and names.
for (const use of ["live", "replay", "report"]) {
  test(`EveryControlOf_${use}_HasANameAndItsOwn`, async () => {
    const page = await openPage(address(use), { width: 1440, height: 900 });
    if (use === "live") await page.keyboard.press("c");
    await page.keyboard.press("b");
    await page.locator(".channels summary").first().click();
    await page.locator(".channels .group summary").first().click();
    await page.evaluate(() => (window.taut.app.selection.value = { kind: "body", index: 0 }));
    await page.waitForSelector('[data-figure^="own:body:rod_0:position"]');
    const session = await page.context().newCDPSession(page);
    await session.send("Accessibility.enable");
    const { nodes } = await session.send("Accessibility.getFullAXTree");
    const roles = ["button", "slider", "spinbutton", "textbox", "searchbox", "combobox", "checkbox", "DisclosureTriangle", "link", "image", "figure", "Canvas"];
    const controls = nodes.filter(({ ignored, role }) => !ignored && roles.includes(role?.value));
    const said = controls.map(({ role, name }) => `${role.value} ${name?.value ?? ""}`.trim());
    assert.ok(controls.length > 60, `${controls.length} controls`);
    assert.deepEqual(said.filter((text) => !text.includes(" ")), [], "without a name");
    // elements of the same name must have the same function
    const twice = [...new Set(said.filter((text, i) => said.indexOf(text) !== i))];
    assert.deepEqual(twice, []);
    // a symbol is not a name
    assert.deepEqual(said.filter((text) => !/ .*[a-z]{2}/i.test(text)), []);
    await page.context().close();
  });
}

test("TheTabKeyReachesEverythingAndTheFocusIsSeen", async () => {
  const page = await openPage(servers.live.url, { width: 1280, height: 760 });
  await page.keyboard.press("c");
  const expected = await page.evaluate(() => [...document.querySelectorAll("button, select, input, summary, canvas[tabindex]")]
    .filter((element) => element.checkVisibility({ visibilityProperty: true }) && !element.disabled && !element.closest(".tools"))
    .map((element, i) => (element.dataset.reach = String(i))));
  const reached = new Set();
  const unseen = [];
  for (let i = 0; i < 4 * expected.length; ++i) {
    await page.keyboard.press("Tab");
    const { reach, seen, name } = await page.evaluate(() => {
      const element = document.activeElement;
      const { outlineStyle, outlineWidth } = getComputedStyle(element);
      return { reach: element.dataset.reach, seen: outlineStyle !== "none" && outlineWidth !== "0px", name: element.ariaLabel ?? element.tagName };
    });
    if (reach === undefined) continue;
    if (reached.has(reach)) break;
    reached.add(reach);
    if (!seen) unseen.push(name);
  }
  const missed = await page.evaluate((list) => list.map((i) => document.querySelector(`[data-reach="${i}"]`).outerHTML.slice(0, 120)), expected.filter((i) => !reached.has(i)));
  assert.deepEqual(missed, []);
  assert.deepEqual(unseen, []);
  await page.context().close();
});

/** Returns the contrast of two colors as defined by WCAG 2. */
function contrast(a, b) {
  const light = ([r, g, blue]) => {
    const part = (value) => (value / 255 <= 0.04045 ? value / 255 / 12.92 : ((value / 255 + 0.055) / 1.055) ** 2.4);
    return 0.2126 * part(r) + 0.7152 * part(g) + 0.0722 * part(blue);
  };
  const [x, y] = [light(a), light(b)].sort((p, q) => q - p);
  return (x + 0.05) / (y + 0.05);
}

test("TextsStandOutFromTheirGround", async () => {
  for (const theme of ["light", "dark"]) {
    const page = await openPage(servers.replay.url, { theme });
    const pairs = await page.evaluate(() => {
      const style = getComputedStyle(document.documentElement);
      const probe = document.body.appendChild(document.createElement("i"));
      const rgb = (name) => {
        probe.style.color = style.getPropertyValue(name);
        return getComputedStyle(probe).color.match(/\d+/g).slice(0, 3).map(Number);
      };
      return [["--text", "--panel"], ["--text", "--page"], ["--faint", "--panel"], ["--faint", "--page"], ["--warn", "--panel"], ["--on-accent", "--accent"]]
        .map((names) => ({ names, colours: names.map(rgb) }));
    });
    for (const { names, colours } of pairs) {
      const found = contrast(...colours);
      assert.ok(found >= 4.5, `${theme}: ${names.join(" on ")} has a contrast of ${found.toFixed(2)}, less than 4.5`);
    }
    await page.context().close();
  }
});
