// Tests of reports: one file that opens from disk, makes no requests, and has the expected content.
import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { closeBrowser, cursorTo, drawn, numbersBeside, openPage, picture, untilTime, writeReport } from "./browser.mjs";
import { comparedRuns, contactCount, pose, RATE_HZ, reference, report, rowsOf, rowTime, scene, seriesOf, setpoint_n, tension_n, VERSION } from "./fixture.mjs";

let folder;
let page;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), "taut-report-"));
  page = await openPage(writeReport(report({ scene: { ...scene, compared: [reference] } }), folder), { width: 1200, height: 800 });
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

test("ItsLegendFollowsAScaleThatChangesWithoutANewFrame", async () => {
  const scales = () => page.evaluate(() => [document.querySelector(".legend").dataset.maxN, String(window.taut.view.world.cables.scale_n)]);
  const setScale = (scale_n) => page.evaluate((wanted) => {
    const { world } = window.taut.view;
    world.cables.scale_n = wanted; // as soon as the trace's largest tension is known
    world.update(window.taut.app.frame.value);
  }, scale_n);
  await drawn(page);
  const [shown, drawnWith] = await scales();
  assert.equal(shown, drawnWith);
  await setScale(2 * Number(drawnWith));
  await drawn(page);
  assert.deepEqual(await scales(), [String(2 * Number(drawnWith)), String(2 * Number(drawnWith))]);
  await setScale(Number(drawnWith));
});

test("ItSaysWhatWasRunAndWhatCameOut", async () => {
  const text = await page.locator("main.report").innerText();
  for (const part of ["1.2.3", "42", "a machine", "turning prism", "38.4", "bottom_0", "a book"]) assert.ok(text.includes(part), part);
  const beside = page.locator("section", { hasText: "Comparison with references" });
  const cells = async (row) => beside.locator("tbody tr").nth(row).locator("th, td").allInnerTexts();
  assert.match(await beside.innerText(), /max tension, whole run \[N\]\s+mean elastic, before \[N\]/);
  assert.deepEqual(await cells(0), ["bottom_0", "5", "4.800", "−4.0 %", "–", "–", "–"]);
  assert.deepEqual(await cells(1), ["top_1", "20", "–", "–", "2", "4", "+100.0 %"]);
  await page.getByText("Resolved inputs").click();
  assert.match(await page.locator(".inputs").innerText(), /<b>prism<\/b>/, "inputs are text, never markup");
});

test("ARunThatEndsInItsFirstSecondsHasNoTensionsAfterThem", async () => {
  const data = report();
  for (const { tension } of data.summary.cables) tension.max_after_start_n = null;
  data.summary.cables[1].tension.max_after_start_n = 2.5;
  const short = await openPage(writeReport(data, folder));
  const table = short.locator("table.numbers", { hasText: "max after the start" });
  const column = (await table.locator("thead tr").first().locator("th").allInnerTexts()).indexOf("max after the start");
  const cell = (row) => table.locator("tbody tr").nth(row).locator("th, td").nth(column).innerText();
  assert.deepEqual([await cell(0), await cell(1), await cell(2)], ["–", "2.500", "–"]);
});

test("ItBeginsWithWhatWasRunAndEndsWithWhatIsForTheRecord", async () => {
  const titles = await page.locator("main.report h2").allInnerTexts();
  assert.deepEqual(titles, ["Experiment", "Replay", "Results", "Comparison with references", "Plots", "Reproducibility"]);
  const first = await page.locator("main.report section").first().innerText();
  for (const part of ["A prism turns about the vertical.", "prism: 3 bodies, 9 cables, 1.5 kg", "The run is complete, 10 s, without problems."]) assert.ok(first.includes(part), first);
  assert.ok(!/1\.2\.3|a machine/.test(first), "versions and machines come last");
  assert.ok((await page.locator("main.report section").last().innerText()).includes("a machine"));
  assert.ok(!/format.version|status.bits/.test(await page.locator("main.report").innerText()));
});

test("ARunThatWentWrongSaysSoAtOnce", async () => {
  const bad = { ...report().summary, status: "not finite: rod_1 at 3 s", interrupted: true, simulated_s: 3.5, contacts_left_out: 12 };
  const other = await openPage(writeReport(report({ summary: bad }), folder));
  const first = await other.locator("main.report section").first().innerText();
  assert.match(first, /The run was interrupted after 3\.5000 s: not finite: rod_1 at 3 s\. 12 contacts did not fit into the trace\./);
  await other.context().close();
});

test("OtherRunsAreTablesOfWhatTheyDifferBy", async () => {
  const channel = (name, a, b, error) => ({ name, unit: "N", rows: 2001, rmse: 0.5, bias: 0, max_error: error, lag_s: 0, lag_at_limit: false, correlation: 1,
    max_a: { value: a, time_s: 1 }, max_b: { value: b, time_s: 1 }, max_error_percent: 0,
    phases: { before: { a: { mean: a / 2 }, b: { mean: b / 2 } }, after: { a: { mean: null }, b: { mean: null } } } });
  const of = (channels) => ({ format_version: 1, rows: channels.length > 0 ? 2001 : 0, from_s: 0, to_s: 10, resampled: false, unit_conflicts: [], only_here: [],
    phases: [{ name: "before", from_s: 1, to_s: 3 }, { name: "after", from_s: 6, to_s: 9 }], channels });
  const comparisons = [
    of([channel("cable/top_0/tension_n", 24, 20, { value: 4, time_s: 2 }), channel("cable/top_1/tension_n", 18, 20, { value: -2, time_s: 2 }),
      channel("cable/top_1/length_m", 99, 98, { value: 1, time_s: 2 }), channel("body/rod_1/position_z_m", 0.4, 0.3, { value: -0.0125, time_s: 7 })]),
    of([]),
  ];
  const other = await openPage(writeReport(report({ scene: { ...scene, run_name: "prism (this/trace.h5)", compared: comparedRuns.slice(0, 2) }, comparisons }), folder));
  const beside = other.locator("section", { hasText: "Comparison with other runs" });
  const cells = (table, row) => beside.locator("table").nth(table).locator("tbody tr").nth(row).locator("th, td").allInnerTexts();
  assert.deepEqual(await beside.locator("h3").allInnerTexts(), ["Largest tension, whole run", "Mean tension, before (1–3 s)"], "a phase without numbers has no table");
  assert.deepEqual(await cells(0, 0), ["prism (a/trace.h5)", "0–10 s, 2001 rows", "+4 N, top_0, at 2 s", "0.5000 N", "−0.01250 m, rod_1 z, at 7 s"]);
  assert.match((await cells(0, 1))[1], /^no common time range/);
  assert.deepEqual(await cells(1, 0), ["top_0", "20", "24", "+4", "–", "–"]);
  assert.deepEqual(await cells(1, 1), ["top_1", "20", "18", "−2", "–", "–"]);
  assert.deepEqual(await cells(2, 0), ["top_0", "10", "12", "+2", "–", "–"]);
  assert.ok(!/correlation|lag|format/.test(await beside.innerText()), "no rows of raw numbers");
  await other.context().close();
});

test("EveryPlotIsThereBeforeItIsScrolledTo", async () => {
  const small = await openPage(writeReport(report(), folder), { width: 700, height: 300 });
  await small.waitForFunction(() => {
    const charts = [...document.querySelectorAll("figure.chart")];
    return charts.length === 11 && charts.every((chart) => !chart.querySelector(".values").textContent.startsWith("–"));
  });
  await small.context().close();
});

test("WithoutWebGlAllIsThereButThePicture", async () => {
  const flat = await openPage(writeReport(report(), folder), { webgl: false });
  await flat.waitForFunction(() => {
    const charts = [...document.querySelectorAll("figure.chart")];
    return charts.length === 11 && charts.every((chart) => !chart.querySelector(".values").textContent.startsWith("–"));
  });
  assert.match(await flat.locator(".view").innerText(), /No 3-D view: this browser has no WebGL/);
  assert.ok((await flat.locator("main.report").innerText()).includes("a book"), "tables are there");
  assert.deepEqual(await flat.locator("button.film:visible").allInnerTexts(), [], "there is nothing to film");
  assert.equal(await flat.locator(".failure:visible").count(), 0);
  await flat.evaluate(() => window.taut.app.seek(6));
  await flat.waitForFunction(() => document.querySelector(".timeline").dataset.time === "6");
  await cursorTo(flat, 5);
  const [contacts] = await numbersBeside(flat, ["contacts"]);
  assert.equal(contacts.text, String(contactCount(5)));
  assert.deepEqual(flat.complaints.filter((text) => !/WebGL/.test(text)), []);
  await picture(flat, "report-flat", { fullPage: true });
  await flat.context().close();
});

test("ItReplaysWithoutAServer", async () => {
  await page.evaluate(() => window.taut.app.seek(6));
  await untilTime(page, 6);
  const shown = await page.evaluate(() => window.taut.view.world.bodies.object.children.map((group) => group.position.toArray()));
  shown.forEach((place, body) => place.forEach((value, k) => assert.ok(Math.abs(value - pose(body, 6).position_m[k]) < 1e-12)));
  await page.locator(".view canvas").first().focus();
  await page.keyboard.press(" ");
  await page.waitForFunction(() => Number(document.querySelector(".timeline").dataset.time) > 6.2);
  await page.keyboard.press(" ");
});

const TIMES_S = [0, 0.003, 1.2345, 5, 7.777, 9.9999, 10];
const four = (value) => Number(value.toPrecision(4));

test("TheNumbersBesideAPlotAreThoseOfTheRowUnderTheCursor", async (t) => {
  t.after(() => cursorTo(page, null));
  for (const time_s of TIMES_S) {
    await cursorTo(page, time_s);
    const at_s = rowTime(time_s);
    const [contacts, tension] = await numbersBeside(page, ["contacts", "tension:top_1"]);
    assert.equal(contacts.text, String(contactCount(at_s)), `contacts at ${time_s} s`);
    assert.deepEqual(tension.numbers, [setpoint_n(4), tension_n(4, at_s) + 1.5, tension_n(4, at_s)].map(four));
    assert.match(tension.text, / N$/);
  }
});

test("WithoutACursorTheNumbersAreThoseOfTheTimeThatIsShown", async () => {
  await page.evaluate(() => window.taut.app.seek(3.33));
  const shown_s = await page.evaluate(() => window.taut.app.frame.value.time_s);
  const [contacts, tension] = await numbersBeside(page, ["contacts", "tension:top_1"]);
  assert.equal(contacts.text, String(contactCount(shown_s)));
  assert.deepEqual(tension.numbers.slice(1), [tension_n(4, shown_s) + 1.5, tension_n(4, shown_s)].map(four));
});

test("WhatIsDrawnCoarserThanTheRowsSaysSo", async () => {
  const note = page.locator('[data-figure="tension:top_1"] .coarse');
  assert.match(await note.innerText(), /^min to max of 4 rows$/); // 2001 rows, 600 points
  const lines = await page.evaluate(() => new Promise((resolve) => window.taut.store.want("system/contact_count", 0, 0, 10, 600, resolve)));
  lines.t.forEach((time_s, i) => {
    const rows = [0, 1, 2, 3].map((k) => time_s + k / RATE_HZ).filter((each) => each <= 10 + 1e-9).map(contactCount);
    assert.deepEqual([lines.first[i], lines.min[i], lines.max[i]], [rows[0], Math.min(...rows), Math.max(...rows)]);
  });
  await page.evaluate(() => (window.taut.app.range_s.value = [2, 3]));
  await page.waitForFunction(() => document.querySelector('[data-figure="tension:top_1"] .coarse').textContent === "");
  await page.evaluate(() => (window.taut.app.range_s.value = null));
  await page.waitForFunction(() => document.querySelector('[data-figure="tension:top_1"] .coarse').textContent !== "");
});

test("AReportWithoutEveryRowSaysWhichRowANumberIsOf", async () => {
  const long = await openPage(writeReport(report({ scene: { ...scene, compared: [reference] } }, 8), folder));
  await cursorTo(long, 5.033);
  const at_s = 5; // blocks of 8 rows begin every 0.04 s: 5.00, 5.04
  const [contacts, tension] = await numbersBeside(long, ["contacts", "tension:top_1"]);
  assert.match(tension.text, / N at 5 s$/);
  assert.deepEqual(tension.numbers.slice(1), [tension_n(4, at_s) + 1.5, tension_n(4, at_s)].map(four));
  assert.equal(contacts.text.replace(/\s+/g, " "), `${contactCount(at_s)} at 5 s`);
  assert.match(await long.locator('[data-figure="contacts"] .coarse').innerText(), /^min to max of 8 rows$/);
  await long.context().close();
});

test("LinesAreCalledWhatTheyAre", async () => {
  const key = page.locator(".key");
  assert.deepEqual(await key.locator("span").allInnerTexts(), ["set point", "another prism (runs/trace.h5)", "this run"]);
  const free = scene.channels.filter(({ name }) => !name.endsWith("/setpoint_n"));
  const robot = { ...reference, name: "a robot (lab/trial_3.h5)", measured: true,
    channels: reference.channels.map((each) => (each.name === "cable/top_0/tension_n" ? { ...each, unit: "lbf" } : each)) };
  const data = report({ scene: { ...scene, channels: free, compared: [robot] }, rows: [rowsOf(free.map(({ name }) => name), 0, 1), rowsOf(robot.channels.map(({ name }) => name), 1, 1)] });
  const other = await openPage(writeReport(data, folder));
  assert.deepEqual(await other.locator(".key span").allInnerTexts(), ["measured: a robot (lab/trial_3.h5)", "this run"]);
  const [both, one] = await numbersBeside(other, ["tension:top_1", "tension:top_0"]);
  assert.equal(both.numbers.length, 2);
  assert.equal(one.numbers.length, 1, "pounds are not drawn on an axis of newtons");
  await other.context().close();
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
  assert.equal(row[names.indexOf("cable/top_1/tension_n")], tension_n(4, 5));
  assert.ok(names.some((name) => /tension_n:min of [0-9]+ rows/.test(name)), csv[0]);
  assert.ok(names.includes("another prism (runs/trace.h5):cable/top_1/tension_n") && names.includes("cable/top_1/setpoint_n"));
  await picture(page, "report", { fullPage: true });
});

test("AxesFitWhatTheyShow", async () => {
  const names = scene.channels.map(({ name }) => name);
  const first = rowsOf(names, 0, 1, (name, ...where) => {
    const series = seriesOf(name, ...where);
    if (name === "cable/top_2/setpoint_n") series.first[0] = 13000;
    if (name === "system/kinetic_j") series.first = series.first.map((value) => 1e-5 * value);
    if (/gravity|elastic|contact/.test(name)) series.first.fill(0);
    return series;
  });
  const far = await openPage(writeReport(report({ rows: [first] }), folder));
  const ticksOf = async (what) => {
    const save = far.locator(`button[title="save ${what} as SVG"]`);
    const [file] = await Promise.all([far.waitForEvent("download"), save.evaluate((element) => element.click())]);
    return [...readFileSync(await file.path(), "utf8").matchAll(/text-anchor="end">([-−.\de]+)</g)].map(([, tick]) => tick);
  };
  // a far set point does not flatten the plots
  const tensions = (await ticksOf("all tensions")).map(Number);
  assert.ok(tensions.length > 20 && Math.max(...tensions) >= 40 && Math.max(...tensions) < 100, tensions.join());
  assert.deepEqual(await ticksOf("energy"), ["0", "5e−6", "1e−5"]);
  assert.deepEqual(await ticksOf("contacts"), ["0", "0.5", "1"]);
  await far.context().close();
});

for (const [what, data, says] of [
  ["OfAnotherVersion", { ...report(), version: VERSION + 1 }, new RegExp(`version ${VERSION + 1}, this page reads version ${VERSION}`)],
  ["CutOff", { ...report(), frame_count: 3 }, /contains \d+ values of frames, expected 3 times/],
  ["WithTooFewRows", { ...report(), rows: [{ ...report().rows[0], count: 3 }] }, /contains \d+ values of rows, expected \d+/],
]) {
  test(`AReport${what}SaysSo`, async () => {
    const broken = await openPage(writeReport(data, folder), { wait: false });
    await broken.waitForSelector(".failure pre");
    assert.match(await broken.locator(".failure pre").first().innerText(), says);
    await broken.context().close();
  });
}
