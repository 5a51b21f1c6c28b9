// Tests of live runs: dragging, pushing, sliders, several clients, reconnection, refusals.
import assert from "node:assert/strict";
import { after, afterEach, beforeEach, test } from "node:test";
import { closeBrowser, drawn, listenToNotices, openPage, PAGE, picture, projection, ready, until } from "./browser.mjs";
import { liveScene, nodes, pose, tension_n, VERSION, worldPoint } from "./fixture.mjs";
import { MockServer } from "./mock_server.mjs";

let server;
const pages = [];

async function open(options) {
  const page = await openPage(server.url, options);
  pages.push(page);
  return page;
}

beforeEach(async () => {
  server = await new MockServer(PAGE, { mode: "live" }).start();
});
afterEach(async () => {
  for (const page of pages.splice(0)) await page.context().close();
  await server.stop();
});
after(closeBrowser);

const camera = (page) => page.evaluate(() => window.taut.view.camera.position.toArray());

/** Returns the position of a node on the page. */
async function nodeOnPage(page, index) {
  const project = await projection(page);
  const box = await page.locator(".view").boundingBox();
  const at = project(worldPoint(nodes[index].body, nodes[index].position_m, server.time_s));
  return { x: box.x + at.x, y: box.y + at.y, depth: at.depth, project, box };
}

test("DraggingANodePullsItAndTheTensionAnswers", async () => {
  const page = await open();
  const before = await camera(page);
  const from = await nodeOnPage(page, 1);
  await page.mouse.move(from.x, from.y);
  await page.waitForFunction(() => document.querySelector(".tip").textContent === "node rod_0.high");
  await page.mouse.down();
  await page.mouse.move(from.x + 60, from.y - 40, { steps: 4 });
  await until(() => {
    const last = server.of("drag").at(-1);
    if (!last) return false;
    const { x, y } = from.project(last.target_m);
    return Math.abs(x + from.box.x - from.x - 60) < 1 && Math.abs(y + from.box.y - from.y + 40) < 1;
  }, "the target is under the mouse");
  const target = server.of("drag").at(-1);
  assert.equal(target.node, "rod_0.high");
  assert.ok(Math.abs(from.project(target.target_m).depth - from.depth) < 1e-3, "the target stays as far away as the node");
  await page.waitForFunction(() => window.taut.view.world.forces.pushes.object.children[0].count === 1);
  await page.waitForFunction(() => window.taut.app.frame.value.cables[0] > 6);
  // the label shows the force in the displayed frame [N]
  const at = worldPoint(nodes[1].body, nodes[1].position_m, server.time_s);
  const force_n = 200 * Math.hypot(...server.of("drag").at(-1).target_m.map((value, k) => value - at[k]));
  await page.waitForFunction((wanted) => Math.abs(parseFloat(document.querySelector(".grip").textContent) - wanted) < 0.01 * wanted, force_n);
  assert.match(await page.locator(".grip").innerText(), /^\d+(\.\d+)? N$/);
  const label = await page.locator(".grip").boundingBox();
  assert.ok(Math.hypot(label.x - from.x - 60, label.y - from.y + 40) < 40, "it is beside the mouse");
  await drawn(page);
  await picture(page, "drag");
  await page.mouse.up();
  assert.equal(await page.locator(".grip").isVisible(), false);
  await until(() => server.of("drop").length === 1, "the drop");
  await page.waitForFunction(() => window.taut.view.world.forces.pushes.object.children[0].count === 0);
  await page.waitForFunction(() => document.querySelectorAll(".events i").length === 1);
  (await camera(page)).forEach((value, k) => assert.ok(Math.abs(value - before[k]) < 1e-9, "the view does not turn meanwhile"));
  assert.deepEqual(page.complaints, []);
});

test("DraggingBesideTheRobotTurnsTheView", async () => {
  const page = await open();
  const before = await camera(page);
  const box = await page.locator(".view").boundingBox();
  await page.mouse.move(box.x + box.width - 60, box.y + 30);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width - 160, box.y + 60, { steps: 4 });
  await page.mouse.up();
  await page.waitForFunction((old) => window.taut.view.camera.position.toArray().some((value, k) => Math.abs(value - old[k]) > 0.05), before);
  assert.equal(server.of("drag").length, 0);
});

test("AClickShowsTheNumbersOfACableAndPlotsIt", async () => {
  const page = await open();
  const ends = [await nodeOnPage(page, 1), await nodeOnPage(page, 3)]; // top_0
  await page.mouse.click((ends[0].x + ends[1].x) / 2, (ends[0].y + ends[1].y) / 2);
  await page.waitForFunction(() => document.querySelector(".inspector .name").textContent === "cable top_0");
  const rows = Object.fromEntries(await page.locator(".inspector tr").evaluateAll((list) => list.map((row) => [...row.cells].map((cell) => cell.textContent))));
  assert.equal(rows["tension"], "16 N");
  assert.equal(rows["rest length"], "0.25000 m");
  assert.equal(rows["stiffness"], "300 N/m");
  assert.equal(rows["between"], "rod_0 → rod_1");
  await page.waitForSelector('[data-figure="own:cable:top_0:length"] .uplot');
  await page.keyboard.press("Escape");
  await page.waitForFunction(() => document.querySelector(".inspector").hidden);
});

test("KeysPauseStepAndReset", async () => {
  const page = await open();
  await page.keyboard.press(" ");
  await until(() => server.of("resume").length === 1 && server.time_s > 0.1, "it runs");
  await page.keyboard.press(" ");
  await until(() => server.of("pause").length === 1, "it is paused");
  await page.keyboard.press("ArrowRight");
  await until(() => server.of("step").length === 1, "a step");
  await page.keyboard.press("r");
  await until(() => server.of("reset").length === 1, "a reset");
});

test("WhatIsAmissStandsThereUntilItIsMended", async () => {
  const page = await open();
  const notice = () => page.locator(".notice:visible").allInnerTexts();
  const tell = (more) => server.tell({ type: "scene", scene: { ...server.liveScene(), ...more } });
  const shows = (text) => page.waitForFunction((wanted) => window.taut.app.scene.value.notice === wanted, text);
  tell({ notice: "recording stopped at t = 1 s" });
  await shows("recording stopped at t = 1 s");
  assert.match((await notice()).join(), /recording stopped/);
  tell({ notice: "recording resumed at t = 2 s" });
  await shows("recording resumed at t = 2 s");
  assert.match((await notice()).join(), /recording resumed/);
  tell({});
  await shows(undefined);
  assert.deepEqual(await notice(), []);
});

test("WithoutWebGlARunIsPlottedAndDriven", async () => {
  const page = await open({ width: 1280, height: 760, webgl: false });
  await page.waitForFunction(() => document.querySelector(".view .instead")?.textContent.includes("this browser has no WebGL"));
  await page.locator("body").press(" ");
  await until(() => server.of("resume").length === 1 && server.time_s > 0.1, "it runs");
  await page.waitForFunction(() => Number(document.querySelector(".timeline").dataset.time) > 0.1);
  await page.waitForSelector('[data-figure="contacts"] .uplot', { state: "attached" });
  await page.keyboard.press("f");
  await page.keyboard.press("n");
  await page.waitForFunction(() => document.querySelector(".inspector .name").textContent === "cable bottom_0");
  assert.deepEqual(page.complaints.filter((text) => !/WebGL/.test(text)), []);
  await picture(page, "live-flat");
});

test("APageThatComesLateShowsWhatWentBefore", async () => {
  server.time_s = 8;
  const page = await open({ width: 1280, height: 760 });
  const shown = (...range) => page.evaluate((asked) => new Promise((resolve) => window.taut.store.want("cable/top_1/tension_n", 0, ...asked, (points) => resolve(points))), range);
  // Two requests for the same channel besides the page's plots: one of the whole span, one of a part at finer
  // resolution.
  const ranges = [[0, 8, 777], [2, 3, 333]];
  for (const range of ranges) {
    await until(async () => (await shown(...range)).t.length > 100, "the time before");
    const { t, first } = await shown(...range);
    assert.ok(t[0] <= range[0] && t.at(-1) >= range[1], "up to what lies around it");
    t.forEach((time_s, i) => {
      assert.ok(i === 0 || time_s > t[i - 1], "times rise where the two parts meet");
      assert.ok(Math.abs(first[i] - tension_n(4, time_s)) < 1e-9);
    });
  }
  const questions = () => server.of("want_series").filter(({ points }) => [777, 333].includes(points)).length;
  assert.equal(questions(), 2);
  await page.evaluate(() => {
    window.shown = 0;
    window.taut.app.frame.watch(() => ++window.shown);
  });
  for (let i = 0; i < 5; ++i) for (const range of ranges) await shown(...range);
  await page.waitForFunction(() => window.shown > 5);
  for (const range of ranges) await shown(...range);
  assert.equal(questions(), 2, "what has been answered is not asked for again");
});

test("ALiveRunIsLookedBackAt", async () => {
  server.time_s = 8;
  const page = await open({ width: 1280, height: 760 });
  await page.evaluate(() => window.taut.app.seek(3));
  await page.waitForFunction(() => document.querySelector(".timeline").dataset.time === "3");
  assert.equal(await page.locator(".factor").innerText(), "looking back");
  const place = await page.evaluate(() => window.taut.view.world.bodies.object.children[1].position.toArray());
  place.forEach((value, k) => assert.ok(Math.abs(value - pose(1, 3).position_m[k]) < 1e-9));
  await drawn(page);
  await picture(page, "look-back");
  const before = await page.evaluate(() => window.taut.store.history.get("cable/top_1/tension_n").t.at(-1));
  assert.equal(before, 8, "what was is no news");
  await page.getByRole("button", { name: "back to the present" }).click();
  await page.waitForFunction(() => document.querySelector(".timeline").dataset.time === "8");
  assert.equal(await page.getByRole("button", { name: "back to the present" }).isVisible(), false);
  await page.keyboard.press("Home");
  await page.waitForFunction(() => document.querySelector(".timeline").dataset.time === "0");
  await page.keyboard.press("End");
  await page.waitForFunction(() => document.querySelector(".timeline").dataset.time === "8");
});

test("LiveControlsSendWhatTheyShow", async () => {
  const page = await open({ width: 1280, height: 760 });
  await page.keyboard.press("c");
  await page.getByLabel("friction_scale [], exact").fill("0.5");
  await page.keyboard.press("Enter");
  await until(() => server.of("set_parameter").length > 0, "a parameter");
  assert.deepEqual(server.of("set_parameter").map(({ name, value }) => ({ name, value })), [{ name: "friction_scale", value: 0.5 }]);
  await page.getByLabel("cable", { exact: true }).selectOption("side_1");
  await page.getByLabel("tension T₀ [N], exact").fill("21");
  await page.keyboard.press("Enter");
  await page.getByLabel("gain K [N/m]", { exact: true }).focus();
  await page.keyboard.press("ArrowRight");
  await until(() => server.of("set_gain").length > 0, "a gain");
  assert.deepEqual(server.of("set_setpoint").map(({ cable, value }) => ({ cable, value })), [{ cable: "side_1", value: 21 }]);
  const { cable, gain, value } = server.of("set_gain")[0];
  assert.equal(`${cable} ${gain} ${value > 100}`, "side_1 position_gain_n_per_m true");
  await page.getByLabel("node to push").selectOption("rod_2.high");
  await page.getByLabel("direction").selectOption("up +z");
  await page.getByLabel("force [N]").fill("12");
  await page.getByLabel("duration [s]").fill("3");
  await page.getByRole("button", { name: "push the node" }).click();
  await until(() => server.of("push").length === 1, "a push");
  const { node, force_n, duration_s } = server.of("push")[0];
  assert.deepEqual({ node, force_n, duration_s }, { node: "rod_2.high", force_n: [0, 0, 12], duration_s: 3 });
  await page.waitForFunction(() => window.taut.view.world.forces.pushes.object.children[0].count === 1);
  await page.getByLabel("force [N]").fill("-5");
  await page.getByRole("button", { name: "push the node" }).click();
  await page.waitForFunction(() => document.querySelector('[aria-label="force [N]"]').validity.rangeUnderflow);
  assert.equal(server.of("push").length, 1, "a force below zero is not sent");
  await drawn(page);
  await picture(page, "controls");
});

test("ASliderShowsItsWholeNameAndItsRange", async () => {
  const page = await open();
  await page.keyboard.press("c");
  const shown = await page.locator(".controls .slider").evaluateAll((sliders) => sliders.map((each) => {
    const name = each.querySelector(".name");
    const { min, max } = each.querySelector("input[type=range]");
    return { name: name.textContent, cut: name.scrollWidth > name.clientWidth, ends: [...each.querySelectorAll(".end")].map(({ textContent }) => Number(textContent.replace("−", "-"))), min: Number(min), max: Number(max) };
  }));
  for (const { name, min, max } of liveScene.parameters) {
    const found = shown.find((each) => each.name === name);
    assert.deepEqual(found, { name, cut: false, ends: [min, max], min, max });
  }
  assert.ok(shown.length >= 6 && shown.every(({ cut }) => !cut));
});

test("AChangedParameterLeavesViewSelectionAndSlidersAlone", async () => {
  const page = await open();
  await page.keyboard.press("n");
  await page.keyboard.press("c");
  await page.evaluate(() => (window.world = window.taut.view.world));
  const slider = page.getByLabel("friction_scale []", { exact: true });
  await slider.focus();
  for (let i = 1; i <= 3; ++i) {
    await page.keyboard.press("ArrowRight");
    await page.waitForFunction((value) => window.taut.app.tuning.value.parameters[0].value === value, 1 + 0.004 * i);
  }
  assert.ok(await slider.evaluate((element) => element === document.activeElement), "the slider keeps the focus");
  assert.ok(await page.evaluate(() => window.world === window.taut.view.world), "the scene is not built again");
  assert.equal(await page.locator(".inspector .name").innerText(), "cable bottom_0");
});

test("APageOutlivesItsServer", async () => {
  const page = await open();
  const { port } = server;
  await server.stop();
  await page.waitForFunction(() => document.querySelector(".link").dataset.state === "lost");
  assert.match(await page.locator(".link").innerText(), /connection lost/);
  server = await new MockServer(PAGE, { mode: "live" }).start(port);
  server.time_s = 7;
  await page.waitForFunction(() => document.querySelector(".link").dataset.state === "open" && Number(document.querySelector(".timeline").dataset.time) === 7);
  await page.keyboard.press(" ");
  await until(() => server.of("resume").length === 1, "commands arrive again");
});

test("OneDrivesOthersWatchUntilTheyTakeOver", async () => {
  const first = await open();
  await first.keyboard.press("ArrowRight"); // one step only: two pages that draw continuously would occupy the machine
  await first.waitForFunction(() => document.querySelector(".driver").textContent === "you drive");
  const second = await open();
  await second.waitForFunction(() => document.querySelector(".driver").textContent === "viewer 1 drives, you watch");
  const said = await listenToNotices(second);
  await second.keyboard.press("ArrowRight");
  await said(/^viewer 1 drives$/);
  await second.getByRole("button", { name: /take control; all others/ }).click();
  await first.waitForFunction(() => document.querySelector(".driver").textContent === "viewer 2 drives, you watch");
  await second.waitForFunction(() => document.querySelector(".driver").textContent === "you drive");
});

test("ALinkToWatchOffersNothingToDriveWith", async () => {
  await server.stop();
  server = await new MockServer(PAGE, { mode: "live", hello: { watch_only: true } }).start();
  const page = await open();
  await page.waitForFunction(() => document.querySelector(".driver").textContent === "you watch");
  assert.equal(await page.getByRole("button", { name: /take control; all others/ }).isVisible(), false);
  assert.equal(await page.getByRole("button", { name: /live controls/ }).isVisible(), false);
  server.tell({ type: "driver", id: 7 });
  await page.waitForFunction(() => document.querySelector(".driver").textContent === "viewer 7 drives, you watch");
  assert.equal(await page.getByRole("button", { name: /take control; all others/ }).isVisible(), false);
});

test("AServerOfAnotherVersionIsRefused", async () => {
  await server.stop();
  server = await new MockServer(PAGE, { mode: "live", hello: { version: 99 } }).start();
  const page = await open({ wait: false });
  await page.waitForFunction(() => document.querySelector(".failure pre")?.textContent);
  assert.ok((await page.locator(".failure pre").innerText()).includes(`version ${VERSION} of the protocol, the server version 99`));
});

test("HelpNamesEveryKeyAndThemesChange", async () => {
  const page = await open();
  await page.keyboard.press("?");
  await page.waitForFunction(() => document.querySelector("dialog.help").open);
  const shown = await page.locator("dialog.help").innerText();
  for (const key of ["space", "→", "home", "R", "esc"]) assert.ok(shown.includes(key), key);
  await picture(page, "help");
  await page.keyboard.press("Escape");
  await page.waitForFunction(() => !document.querySelector("dialog.help").open);
  await page.keyboard.press("t");
  await page.waitForFunction(() => document.documentElement.dataset.theme === "dark");
  await page.reload();
  await ready(page);
  assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), "dark");
});
