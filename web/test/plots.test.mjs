// Tests of plots: search of channels, adding them by mouse and keys, layouts, and the values beside plots.
import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, afterEach, before, beforeEach, test } from "node:test";
import { closeBrowser, listenToNotices, numbersBeside, openPage, PAGE, picture, untilTime } from "./browser.mjs";
import { CABLE_COUNT, cables, pose, reference, scene, setpoint_n, tension_n } from "./fixture.mjs";
import { MockServer } from "./mock_server.mjs";

const TIME_S = 4;
const names = scene.channels.map(({ name }) => name);
let server;
let page;
let folder;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), "taut-plots-"));
  server = await new MockServer(PAGE, { mode: "replay", compared: [reference] }).start();
});
after(async () => {
  await closeBrowser();
  await server.stop();
  rmSync(folder, { recursive: true });
});
beforeEach(async () => {
  // these tests do not use the 3D view, whose drawing is slow without a graphics card
  page = await openPage(server.url, { width: 1280, height: 900, webgl: false });
  await page.waitForSelector("figure.chart .uplot");
  await page.evaluate((time_s) => window.taut.app.seek(time_s), TIME_S);
  await untilTime(page, TIME_S);
});
afterEach(async () => {
  assert.deepEqual(page.complaints.filter((text) => !text.startsWith("THREE.WebGLRenderer")), []);
  await page.context().close();
});

const editor = () => page.locator(".editor");
const press = (name) => editor().getByRole("button", { name }).click();
const NEW_PLOT = "put the chosen channels into a new plot";
const EACH = "put each chosen channel into a separate plot";
const ADD_TO = "add the chosen channels to the plot named next to this button";

async function search(words) {
  if (await editor().isHidden()) await page.keyboard.press("b");
  await editor().getByRole("searchbox").fill(words);
}

const listed = () => page.locator(".channel").evaluateAll((rows) => rows.map(({ dataset }) => dataset.channel));
const choose = (channel) => page.locator(`[data-channel="${channel}"] input`).check();
const figures = () => page.locator("figure.chart").evaluateAll((charts) => charts.map(({ dataset }) => dataset.figure));
const untilFigures = (wanted) => page.waitForFunction((list) =>
  JSON.stringify([...document.querySelectorAll("figure.chart")].map(({ dataset }) => dataset.figure)) === JSON.stringify(list), wanted);
const standard = [...cables.map(({ name }) => `tension:${name}`), "energy", "contacts"];
const shown = (values) => values.map((value) => Number(value.toPrecision(4)));
const position = (body, time_s = TIME_S) => pose(body, time_s).position_m;

/** Adds channels to a new plot, in this order. */
async function plot(...channels) {
  for (const channel of channels) {
    await search(channel);
    await choose(channel);
  }
  await press(NEW_PLOT);
}

test("ASearchFindsTheChannelsThatHaveAllItsWords", async () => {
  for (const [words, fits] of [
    ["rod_1 position", (name) => name.includes("rod_1") && name.includes("position")],
    ["POSITION rod_1", (name) => name.includes("rod_1") && name.includes("position")],
    ["body/*_z_m", (name) => name.startsWith("body/") && name.endsWith("_z_m")],
    ["top tension", (name) => name.includes("top") && name.includes("tension")],
    ["(", () => false],
  ]) {
    await search(words);
    assert.deepEqual(await listed(), names.filter(fits), words);
    assert.equal(await page.locator(".channels [role=status]").first().innerText(), `${names.filter(fits).length} of ${names.length} channels`);
  }
});

test("WithoutASearchAllChannelsAreInGroupsThatOpen", async () => {
  await search("");
  assert.deepEqual(await listed(), []);
  const kinds = await page.locator(".list > details > summary").allInnerTexts();
  assert.deepEqual(kinds, ["cable", "system", "body"].map((kind) => `${kind} ${names.filter((name) => name.startsWith(`${kind}/`)).length}`));
  await page.locator(".list summary", { hasText: "body" }).click();
  await page.locator(".list summary", { hasText: "rod_2" }).click();
  await page.waitForSelector('[data-channel="body/rod_2/position_x_m"]');
  assert.deepEqual(await listed(), names.filter((name) => name.startsWith("body/rod_2/")));
});

test("ChosenChannelsComeIntoANewPlotOfTheirUnit", async () => {
  await plot("body/rod_0/position_x_m", "body/rod_1/position_y_m", "system/kinetic_j");
  await untilFigures([...standard, "2-channels", "system-kinetic"]);
  await page.locator('[data-figure="2-channels"]').scrollIntoViewIfNeeded();
  const [two, one] = await numbersBeside(page, ["2-channels", "system-kinetic"]);
  assert.deepEqual(two.numbers, shown([position(0)[0], position(1)[1]]));
  assert.match(two.text, / m$/);
  assert.deepEqual(one.numbers, shown([0.1 * TIME_S]));
  assert.deepEqual(await page.locator('[data-figure="2-channels"] .lines span').allInnerTexts(), ["rod_0 position x", "rod_1 position y"]);
  await picture(page, "plots-editor");
});

test("KeysAloneDoTheSame", async () => {
  await page.keyboard.press("/");
  await page.keyboard.type("rod_2 position");
  const go = async (name) => {
    for (let i = 0; i < 60; ++i) {
      await page.keyboard.press("Tab");
      if (await page.evaluate((wanted) => (document.activeElement.closest("[data-channel]")?.dataset.channel ?? document.activeElement.ariaLabel ?? "").endsWith(wanted), name)) return;
    }
    assert.fail(`the tab key does not reach ${name}`);
  };
  for (const axis of ["x", "z"]) {
    await go(`body/rod_2/position_${axis}_m`);
    await page.keyboard.press(" ");
  }
  await go(NEW_PLOT);
  await page.keyboard.press("Enter");
  await untilFigures([...standard, "rod_2"]);
  await page.locator('[data-figure="rod_2"]').scrollIntoViewIfNeeded();
  assert.deepEqual((await numbersBeside(page, ["rod_2"]))[0].numbers, shown([position(2)[0], position(2)[2]]));
});

test("AChannelIsDraggedIntoAPlotOfItsUnitOnly", async () => {
  const said = await listenToNotices(page);
  const drag = async (channel, target) => {
    await page.evaluate(() => (document.querySelector(".plots").scrollTop = 0));
    await page.locator(`[data-channel="${channel}"]`).dragTo(page.locator(target));
    await page.mouse.move(5, 5); // away from plots, which would show the values under the mouse
    await page.waitForFunction(() => window.taut.app.cursor_s.value === null);
  };
  await search("top_0 tension");
  await drag("cable/top_0/tension_n", '[data-figure="tension:bottom_0"]');
  await untilFigures(["tension:bottom_1", ...standard.slice(2, CABLE_COUNT), "bottom_0", ...standard.slice(CABLE_COUNT)]);
  const beside = async () => (await numbersBeside(page, ["bottom_0"]))[0].numbers;
  await page.locator('[data-figure="bottom_0"]').scrollIntoViewIfNeeded();
  assert.deepEqual(await beside(), shown([setpoint_n(0), tension_n(0, TIME_S), tension_n(3, TIME_S)]));
  await search("elastic_j");
  await drag("system/elastic_j", '[data-figure="tension:bottom_1"]');
  await said(/^not added: system\/elastic_j is in J, bottom_1 in N$/);
  assert.equal(await page.locator('[data-figure="tension:bottom_1"] .values span').count(), 3);
  // dragging one of several selected channels drags all; on free space they form a new plot
  await search("rod_0 position");
  await choose("body/rod_0/position_z_m");
  await choose("body/rod_0/position_x_m");
  await drag("body/rod_0/position_x_m", ".newplot");
  await page.waitForSelector('[data-figure="rod_0"]');
  await page.locator('[data-figure="rod_0"]').scrollIntoViewIfNeeded();
  assert.deepEqual((await numbersBeside(page, ["rod_0"]))[0].numbers, shown([position(0)[2], position(0)[0]]));
});

test("ChannelsAreAddedToTheNamedPlotAndEachToOneOfItsOwn", async () => {
  await plot("body/rod_0/position_x_m");
  await search("rod_1 position");
  await press("choose all channels found");
  await editor().getByLabel("plot to add to").selectOption("rod_0 position x");
  await press(ADD_TO);
  const target = page.locator('[data-figure="rod_0-position-x"]');
  await target.scrollIntoViewIfNeeded();
  assert.deepEqual((await numbersBeside(page, ["rod_0-position-x"]))[0].numbers, shown([position(0)[0], ...position(1)]));
  await search("rod_2 position");
  await press("choose all channels found");
  await press(EACH);
  await untilFigures([...standard, "rod_0-position-x", ...["x", "y", "z"].map((axis) => `rod_2-position-${axis}`)]);
});

test("APlotOfOneChannelHasWhatItIsComparedWith", async () => {
  await search("");
  await page.getByRole("button", { name: "remove the plot top_1", exact: true }).click();
  await plot("cable/top_1/tension_n");
  await page.locator('[data-figure="tension:top_1"]').scrollIntoViewIfNeeded();
  assert.deepEqual((await numbersBeside(page, ["tension:top_1"]))[0].numbers, shown([tension_n(4, TIME_S) + 1.5, tension_n(4, TIME_S)]));
});

test("APlotIsRenamedMovedAndTakenApartByButtons", async () => {
  await plot("body/rod_0/position_x_m", "body/rod_0/position_y_m");
  await untilFigures([...standard, "rod_0"]);
  await page.locator('[data-figure="rod_0"]').hover();
  await page.getByRole("button", { name: "edit the plot rod_0", exact: true }).click();
  const dialog = page.locator("dialog.plotdialog");
  await dialog.getByLabel("title").fill("first rod");
  await dialog.getByLabel("title").press("Enter");
  await untilFigures([...standard, "first-rod"]);
  await dialog.getByRole("button", { name: "move the plot one place forward" }).click();
  await untilFigures([...standard.slice(0, -1), "first-rod", "contacts"]);
  await dialog.getByRole("button", { name: "remove body/rod_0/position_x_m from the plot" }).click();
  await page.waitForFunction(() => document.querySelectorAll('[data-figure="first-rod"] .values span').length === 1);
  assert.deepEqual((await numbersBeside(page, ["first-rod"]))[0].numbers, shown([position(0)[1]]));
  await dialog.getByRole("button", { name: "remove the plot from the layout" }).click();
  await untilFigures(standard);
  assert.ok(await dialog.isHidden());
});

test("ALayoutIsKeptForItsExperiment", async () => {
  await search("");
  await page.getByRole("button", { name: "remove the plot side_0", exact: true }).click();
  const without = standard.filter((id) => id !== "tension:side_0");
  await untilFigures(without);
  await page.reload();
  await untilFigures(without);
  await search("");
  assert.equal(await editor().getByLabel("layout", { exact: true }).inputValue(), "my layout");
  await editor().getByLabel("name of the layout").fill("no side");
  await press("save these plots in this browser under the name next to this button");
  await page.getByRole("button", { name: "remove the plot energy", exact: true }).click();
  await untilFigures(without.filter((id) => id !== "energy"));
  // each layout keeps its plots, the default is unchanged
  const layout = editor().getByLabel("layout", { exact: true });
  assert.deepEqual(await layout.locator("option").allInnerTexts(), ["default", "my layout", "no side"]);
  await layout.selectOption("my layout");
  await untilFigures(without);
  await layout.selectOption("default");
  await untilFigures(standard);
  await layout.selectOption("no side");
  await page.reload();
  await untilFigures(without.filter((id) => id !== "energy"));
  // layouts belong to one experiment
  await page.evaluate(() => {
    const { app } = window.taut;
    app.hello.value = { ...app.hello.value, title: "another prism" };
  });
  await untilFigures(standard);
  await page.evaluate(() => {
    const { app } = window.taut;
    app.hello.value = { ...app.hello.value, title: "turning prism" };
  });
  await untilFigures(without.filter((id) => id !== "energy"));
  await search("");
  await press("delete the displayed layout");
  await untilFigures(standard);
  assert.deepEqual(await editor().getByLabel("layout", { exact: true }).locator("option").allInnerTexts(), ["default", "my layout"]);
});

test("AFileOfALayoutComesBackAsItWas", async () => {
  const said = await listenToNotices(page);
  await plot("body/rod_0/position_x_m", "body/rod_1/position_x_m");
  await untilFigures([...standard, "position-x"]);
  const [file] = await Promise.all([page.waitForEvent("download"), press("save this layout as a file (JSON)")]);
  const path = join(folder, "layout.json");
  await file.saveAs(path);
  assert.equal(file.suggestedFilename(), "taut-layout-my-layout.json");
  const written = JSON.parse(readFileSync(path, "utf8"));
  assert.equal(written.format, "taut layout");
  assert.equal(written.version, 1);
  assert.deepEqual(written.plots.at(-1), { title: "position x", channels: ["body/rod_0/position_x_m", "body/rod_1/position_x_m"] });
  assert.equal(written.plots.length, CABLE_COUNT + 3);
  await press("delete the displayed layout");
  await untilFigures(standard);
  await page.setInputFiles('input[type="file"]', path);
  await untilFigures([...standard, "position-x"]);
  await page.locator('[data-figure="position-x"]').scrollIntoViewIfNeeded();
  assert.deepEqual((await numbersBeside(page, ["position-x"]))[0].numbers, shown([position(0)[0], position(1)[0]]));
  // an invalid file changes nothing and is reported
  for (const [text, reason] of [
    ["{", /^the file is not JSON: /],
    ["[]", /^the file is not a layout: its "format" is not "taut layout"$/],
    [JSON.stringify({ ...written, version: 2 }), /^the layout has version 2, this page reads version 1$/],
    [JSON.stringify({ ...written, name: " " }), /^the layout has no "name"$/],
    [JSON.stringify({ ...written, plots: {} }), /^"plots" of the layout is not a list of at most 500$/],
    [JSON.stringify({ ...written, plots: [written.plots[0], { title: "a", channels: [] }] }), /^plot 2 of the layout is not /],
  ]) {
    writeFileSync(path, text);
    await page.setInputFiles('input[type="file"]', path);
    await said(reason);
  }
  await untilFigures([...standard, "position-x"]);
  // a channel that this run lacks is named, and its plot is kept for other runs
  writeFileSync(path, JSON.stringify({ ...written, plots: [...written.plots, { title: "far", channels: ["body/moon/position_x_m"] }] }));
  await page.setInputFiles('input[type="file"]', path);
  await page.waitForFunction(() => document.querySelector(".remark").textContent === "not in this run: body/moon/position_x_m");
  await untilFigures([...standard, "position-x"]);
});

test("AZoomAwayFromTheTimeStillGivesItsNumbers", async () => {
  const beside = async () => (await numbersBeside(page, ["tension:top_1"]))[0];
  const at = (time_s) => shown([setpoint_n(4), tension_n(4, time_s) + 1.5, tension_n(4, time_s)]);
  for (const range of [[7, 7.5], [0.5, 1], [9.99, 10], [6, 9]]) {
    await page.evaluate((span) => (window.taut.app.range_s.value = span), range);
    await page.waitForFunction(() => document.querySelector('[data-figure="tension:top_1"] .values').textContent.endsWith("N at 4 s"));
    assert.deepEqual((await beside()).numbers, at(TIME_S), `${range}`);
  }
  // the time also advances outside of the window
  await page.evaluate(() => window.taut.app.seek(2.345));
  await untilTime(page, 2.345);
  await page.waitForFunction(() => document.querySelector('[data-figure="tension:top_1"] .values').textContent.endsWith("N at 2.345 s"));
  assert.deepEqual((await beside()).numbers, at(2.345));
  // in a narrow plot, numbers with their time do not cut the name
  await page.addStyleTag({ content: ".chart { max-width: 130px; }" });
  const cut = await page.locator(".chart .name:visible").evaluateAll((list) => list.filter((each) => each.scrollWidth > each.clientWidth).map(({ textContent }) => textContent));
  assert.deepEqual(cut, []);
  // no label is needed inside
  await page.evaluate(() => window.taut.app.seek(7));
  await untilTime(page, 7);
  await page.waitForFunction(() => document.querySelector('[data-figure="tension:top_1"] .values').textContent.endsWith(" N"));
  assert.deepEqual((await beside()).numbers, at(7));
  assert.equal(reference.measured, false);
});
