// Tests of pages of `taut analyze --page`: load cases, colors, modes, tables to copy, print and accessibility.
// TAUT_COMMAND: the command; without it the tests are skipped.
import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { closeBrowser, drawn, openPage, picture } from "./browser.mjs";
import { options, TAUT, taut } from "./real_server.mjs";

const AXE = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
let folder;
let data;

/** Analyzes a file and opens the page. */
async function opened(name, size = {}) {
  const path = join(folder, `${name.replace(/\W/g, "_")}.html`);
  taut("analyze", name, "--modes", "3", "--page", path);
  data = JSON.parse(/id="taut-report"[^>]*>(.*?)<\/script>/s.exec(readFileSync(path, "utf8"))[1]);
  return openPage(`file://${path}`, { width: 1200, height: 800, ...size });
}
const violations = async (page) => {
  await page.evaluate(AXE);
  const found = await page.evaluate(async () => (await window.axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa"] })).violations);
  return found.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html.slice(0, 120)).join(" | ")}`);
};
/** Positions of all bodies as drawn. */
const places = (page) => page.evaluate(() => window.taut.view.world.bodies.object.children.map((group) => group.position.toArray()));

before(() => (folder = mkdtempSync(join(tmpdir(), "taut-statics-"))));
after(async () => {
  await closeBrowser();
  rmSync(folder, { recursive: true });
});

test("EachLoadCaseIsDrawnDisplacedWithItsForces", options, async (t) => {
  const page = await opened("experiments/dome_snow.yaml");
  t.after(() => page.context().close());
  assert.deepEqual(page.requests.filter((url) => !/^(file|data|blob):/.test(url)), [], "it needs no network");
  for (const [index, name] of ["own_weight", "snow"].entries()) {
    await page.getByLabel("load case", { exact: true }).selectOption(name);
    await drawn(page);
    const { displacement, cables, reactions, loads } = data.cases[index];
    const factor = await page.evaluate(() => window.taut.player.exaggeration.value);
    const shown = await places(page);
    shown.forEach((place, body) => place.forEach((value, k) => {
      const wanted = data.scene.bodies[body].position_m[k] + factor * displacement.translation_m[body][k];
      assert.ok(Math.abs(value - wanted) < 1e-9, `${body}: ${value}, ${wanted}`);
    }));
    const frame = await page.evaluate(() => ({ cables: [...window.taut.view.override.cables], pushes: window.taut.view.override.push_count, contacts: window.taut.view.override.contact_count }));
    assert.deepEqual(frame.cables.filter((_, i) => i % 4 === 0), cables.filter((_, i) => i % 4 === 0));
    assert.deepEqual([frame.pushes, frame.contacts], [loads.length / 4, reactions.length / 6]);
    assert.equal(await page.locator(".results h2").innerText(), `Load case ${name}`);
  }
  assert.deepEqual(page.complaints, []);
  await picture(page, "statics", { fullPage: true });
});

test("ColorsShowUtilizationWhereALimitIsKnownElseForce", options, async (t) => {
  const page = await opened("experiments/dome_snow.yaml");
  t.after(() => page.context().close());
  const shares = () => page.evaluate(() => [...window.taut.view.world.colours.cables]);
  const legend = () => page.locator(".legend").innerText();
  await drawn(page);
  assert.deepEqual(await shares(), data.cases[0].cable_use.map((use) => use ?? NaN));
  assert.match(await legend(), /utilization\s+0\s+50 %\s+100 %/);
  await page.getByLabel("color of members").selectOption("force");
  await drawn(page);
  assert.match(await legend(), /axial force\s+−\d+ kN\s+0\s+\+\d+ kN/);
  const tensions = data.cases[0].cables.filter((_, i) => i % 4 === 0);
  const scale = (await shares()).map((share, i) => tensions[i] / share).filter(Number.isFinite);
  assert.ok(Math.max(...scale) - Math.min(...scale) < 1e-9 * scale[0]);
  assert.ok(scale[0] >= Math.max(...tensions));
  const plain = await opened("models/six_strut.yaml");
  t.after(() => plain.context().close());
  assert.equal(await plain.getByLabel("color of members").inputValue(), "force", "no limit is known");
});

test("AModePlaysWithItsIndexAndFrequencyAndStops", options, async (t) => {
  const page = await opened("models/prism3.yaml");
  t.after(() => page.context().close());
  const { frequency_hz } = data.cases[0].modes[1];
  const second = page.getByRole("button", { name: /^2: / });
  assert.equal(await second.innerText(), `2: ${Number(frequency_hz.toPrecision(3))} Hz`);
  const rest = await places(page);
  await second.click();
  await page.waitForFunction((still) => window.taut.view.world.bodies.object.children.some((group, i) => group.position.toArray().some((value, k) => Math.abs(value - still[i][k]) > 1e-4)), rest);
  assert.equal(await second.getAttribute("aria-pressed"), "true");
  await second.click();
  await drawn(page);
  assert.deepEqual(await places(page), rest);
  await page.getByLabel("load case", { exact: true }).selectOption({ label: "mechanisms" });
  assert.deepEqual(await page.locator(".modes button").allInnerTexts(), data.described[0].modes.map((_, i) => `${i + 1}: mechanism`));
});

test("TablesAreCopiedForSpreadsheets", options, async (t) => {
  const page = await opened("experiments/dome_snow.yaml");
  t.after(() => page.context().close());
  await page.evaluate(() => {
    Object.defineProperty(navigator, "clipboard", { value: { writeText: async (text) => void (window.copied = text) } });
  });
  await page.getByRole("button", { name: "copy: the table Load cases, for a spreadsheet" }).click();
  await page.waitForFunction(() => window.copied !== undefined);
  assert.equal(await page.evaluate(() => window.copied), data.tables[0].rows.map((row) => row.join("\t")).join("\n"));
});

test("APrintedPageHasAPictureOnWhiteAndWholeTables", options, async (t) => {
  const page = await opened("models/prism3.yaml", { theme: "dark" });
  t.after(() => page.context().close());
  await page.evaluate(() => window.dispatchEvent(new Event("beforeprint")));
  await page.emulateMedia({ media: "print" });
  const state = await page.evaluate(() => {
    const image = document.querySelector(".printed");
    const scroll = document.querySelector(".results .scroll");
    return { image: image.naturalWidth > 0 && !image.hidden, theme: window.taut.app.theme.value, canvas: getComputedStyle(window.taut.view.canvas).display,
      cut: scroll.scrollHeight - scroll.clientHeight, buttons: [...document.querySelectorAll("button")].filter((each) => each.offsetParent !== null).length };
  });
  assert.deepEqual(state, { image: true, theme: "light", canvas: "none", cut: 0, buttons: 0 });
  await page.emulateMedia({ media: "screen" });
  await page.evaluate(() => window.dispatchEvent(new Event("afterprint")));
  assert.equal(await page.evaluate(() => window.taut.app.theme.value), "dark");
});

test("ItIsAccessibleAndFitsPhones", options, async (t) => {
  for (const size of [{}, { theme: "dark" }, { width: 390, height: 800, touch: true }]) {
    const page = await opened("experiments/dome_snow.yaml", size);
    t.after(() => page.context().close());
    assert.deepEqual(await violations(page), []);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "nothing is wider than the window");
  }
});

test("WithoutWebGlTheTablesRemain", options, async (t) => {
  const page = await opened("models/prism3.yaml", { webgl: false });
  t.after(() => page.context().close());
  assert.match(await page.locator(".view").innerText(), /No 3-D view/);
  assert.equal(await page.locator(".results table").count(), data.cases[0].tables.length);
  assert.ok(TAUT);
});
