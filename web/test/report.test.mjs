// The report: one file that opens from disk, asks nobody for anything, and holds what it should.
import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { closeBrowser, openPage, picture, untilTime, writeReport } from "./browser.mjs";
import { pose, reference, report, scene, tension_n } from "./fixture.mjs";

let folder;
let page;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), "taut-report-"));
  page = await openPage(writeReport(report({ scene: { ...scene, reference } }), folder), { width: 1200, height: 800 });
});
after(async () => {
  await closeBrowser();
  rmSync(folder, { recursive: true });
});

test("ItAsksNobodyForAnything", async () => {
  assert.deepEqual(page.requests.filter((url) => !/^(file|data|blob):/.test(url)), []);
  assert.equal(page.requests.filter((url) => url.startsWith("file:")).length, 1);
  assert.deepEqual(page.complaints, []);
});

test("ItSaysWhatWasRunAndWhatCameOut", async () => {
  const text = await page.locator("main.report").innerText();
  for (const part of ["1.2.3", "42", "a machine", "turning prism", "38.4", "bottom_0", "a book"]) assert.ok(text.includes(part), part);
  const beside = page.locator("section", { hasText: "Beside the references" });
  const cells = async (row) => beside.locator("tbody tr").nth(row).locator("th, td").allInnerTexts();
  assert.match(await beside.innerText(), /max tension, whole run \[N\]\s+mean elastic, before \[N\]/);
  assert.deepEqual(await cells(0), ["bottom_0", "5", "4.800", "−4.0 %", "–", "–", "–"]);
  assert.deepEqual(await cells(1), ["top_1", "20", "–", "–", "2", "4", "+100.0 %"]);
  await page.getByText("Inputs as resolved").click();
  assert.match(await page.locator(".inputs").innerText(), /<b>prism<\/b>/, "inputs are text, never markup");
});

test("EveryPlotIsThereBeforeItIsScrolledTo", async () => {
  const small = await openPage(writeReport(report(), folder), { width: 700, height: 300 });
  await small.waitForFunction(() => {
    const charts = [...document.querySelectorAll("figure.chart")];
    return charts.length === 11 && charts.every((chart) => !chart.querySelector(".values").textContent.startsWith("–"));
  });
  await small.context().close();
});

test("ItReplaysWithoutAServer", async () => {
  await page.evaluate(() => window.taut.app.seek(6));
  await untilTime(page, 6, 1e-3);
  const shown = await page.evaluate(() => window.taut.view.world.bodies.object.children.map((group) => group.position.toArray()));
  shown.forEach((place, body) => place.forEach((value, k) => assert.ok(Math.abs(value - pose(body, 6).position_m[k]) < 1e-6)));
  await page.locator(".view canvas").first().focus();
  await page.keyboard.press(" ");
  await page.waitForFunction(() => Number(document.querySelector(".timeline").dataset.time) > 6.2);
  await page.keyboard.press(" ");
});

test("PlotsAreSavedAsSvgPngAndCsv", async () => {
  const chart = page.locator('[data-figure="tension:top_1"]');
  await chart.scrollIntoViewIfNeeded();
  await chart.hover();
  const save = async (name) => {
    const [file] = await Promise.all([page.waitForEvent("download"), chart.getByRole("button", { name: `as ${name}` }).click()]);
    return { name: file.suggestedFilename(), content: readFileSync(await file.path()) };
  };
  const svg = await save("SVG");
  assert.equal(svg.name, "taut-top_1.svg");
  assert.match(svg.content.toString(), /top_1 \[N\]/);
  for (const colour of ["#0072b2", "#d43a00", "#000000"]) assert.ok(svg.content.includes(`stroke="${colour}"`), colour);
  const png = await save("PNG");
  assert.equal(png.content.subarray(1, 4).toString(), "PNG");
  const csv = (await save("CSV")).content.toString().trim().split("\n");
  const names = csv[0].split(",");
  const row = csv.find((line) => line.startsWith("5,")).split(",").map(Number);
  const value = row[names.indexOf("cable/top_1/tension_n")];
  // blocks of two rows: the mean of two neighbours
  assert.ok(Math.abs(value - (tension_n(4, 5) + tension_n(4, 5.02)) / 2) < 1e-9, `${value}`);
  assert.ok(names.includes("reference:cable/top_1/tension_n") && names.includes("cable/top_1/setpoint_n"));
  await picture(page, "report", { fullPage: true });
});

test("ASetPointFarAwayDoesNotFlattenThePlots", async () => {
  const data = report();
  const series = data.series.find(({ channel }) => channel === "cable/top_2/setpoint_n");
  series.max[0] = series.mean[0] = 13000;
  const far = await openPage(writeReport(data, folder));
  const [file] = await Promise.all([far.waitForEvent("download"), far.getByRole("button", { name: "save all tensions as SVG" }).click()]);
  const ticks = [...readFileSync(await file.path(), "utf8").matchAll(/text-anchor="end">(\d+)</g)].map(([, tick]) => Number(tick));
  assert.ok(ticks.length > 20 && Math.max(...ticks) >= 40 && Math.max(...ticks) < 100, ticks.join());
  await far.context().close();
});

for (const [what, data, says] of [
  ["OfAnotherVersion", { ...report(), version: 7 }, /version 7, this page reads version 2/],
  ["CutOff", { ...report(), frame_count: 3 }, /holds \d+ numbers of frames, not 3 times/],
]) {
  test(`AReport${what}SaysSo`, async () => {
    const broken = await openPage(writeReport(data, folder), { wait: false });
    await broken.waitForSelector(".failure pre");
    assert.match(await broken.locator(".failure pre").first().innerText(), says);
    await broken.context().close();
  });
}
