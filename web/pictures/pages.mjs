// Pictures of the viewer for docs/images/; run by script/pictures.
//
//   node web/pictures/pages.mjs RUNS FOLDER     uses the traces in RUNS; writes to FOLDER
// Environment: TAUT_COMMAND, and the variables of test/browser.mjs.
import { join } from "node:path";
import { closeBrowser, drawn, openPage, untilTime } from "../test/browser.mjs";
import { stop, view } from "../test/real_server.mjs";

const [runs, folder] = process.argv.slice(2);
const trace = (name) => join(runs, name, "trace.h5");
const size = { width: 1440, height: 810 };
const send = (page, ...messages) => page.evaluate((list) => list.forEach((each) => window.taut.app.send(each)), messages);

/** Opens the page of `taut view` with these arguments and calls `act` with it. */
async function shown(words, options, act) {
  const address = await view("--port", "0", ...words);
  const page = await openPage(address, { ...size, ...options });
  await act(page);
  await page.context().close();
  await stop();
}

async function take(page, name) {
  await drawn(page);
  await page.waitForFunction(() => ![...document.querySelectorAll(".values")].some((each) => each.textContent.includes("…")));
  await page.screenshot({ path: join(folder, name) });
}

/** Exports the page's GIF, of the 3D view alone. */
async function film(page, name, { speed, from_s, to_s }) {
  await page.addStyleTag({ content: `
    header, .plots, .timeline, .below-view, .view > :not(canvas) { display: none !important; }
    main.split { display: block !important; } .view { width: 560px !important; height: 280px !important; }` });
  await drawn(page);
  await page.keyboard.press("f");
  await send(page, { type: "speed", factor: speed });
  await page.waitForFunction((wanted) => window.taut.app.frame.value.speed === wanted, speed);
  await page.evaluate((range) => (window.taut.app.range_s.value = range), [from_s, to_s]);
  const download = page.waitForEvent("download");
  await page.locator("button.film", { hasText: "GIF" }).first().evaluate((button) => button.click());
  await (await download).saveAs(join(folder, name));
}

async function replays() {
  await shown([trace("push_20n"), "--compare", trace("push_20n_ntrt")], {}, async (page) => {
    await send(page, { type: "seek", time_s: 37 });
    await untilTime(page, 37);
    await take(page, "viewer_replay.png");
  });
  await shown([trace("wall")], {}, async (page) => {
    await send(page, { type: "seek", time_s: 30 });
    await untilTime(page, 30);
    await page.keyboard.press("f");
    await take(page, "wall.png");
    await film(page, "wall.gif", { speed: 15, from_s: 0, to_s: 60 });
  });
}

/** The robot of docs/tutorial.md, as `taut new robot my_robot` makes it. */
async function model() {
  await shown(["share/robots/six_bar"], { width: 1100, height: 700 }, async (page) => {
    await page.locator("text=First modes").waitFor();
    await take(page, "viewer_model.png");
  });
}

async function live() {
  await shown(["experiments/push_20n.yaml", "--max"], { theme: "dark" }, async (page) => {
    await page.waitForFunction(() => window.taut.app.frame.value?.now_s >= 48);
    await send(page, { type: "seek", time_s: 38 });
    await untilTime(page, 38, 0.02);
    await page.locator("label", { hasText: "whole run" }).click();
    await take(page, "viewer_live_dark.png");
  });
}

/** Pulls a node sideways and up, holds it and releases it, by commands, so that every run is the same. */
async function drag() {
  const record = join(runs, "drag");
  await shown(["experiments/stand_still.yaml", "--paused", "--out", record], {}, async (page) => {
    const node = await page.evaluate(() => {
      const { nodes } = window.taut.app.scene.value;
      const place = nodes.reduce((best, _, i) => (window.taut.view.nodeAt(i).x > window.taut.view.nodeAt(best).x ? i : best), 0);
      return { name: nodes[place].name, at: window.taut.view.nodeAt(place).toArray() };
    });
    const commands = [{ type: "step", count: 500 }];
    for (let i = 1; i <= 100; ++i) {
      const part = Math.min(1, i / 50);
      const target_m = [node.at[0], node.at[1] + 0.35 * part, node.at[2] + 0.25 * part];
      commands.push({ type: "drag", node: node.name, target_m }, { type: "step", count: 30 });
    }
    await send(page, ...commands);
    await page.waitForFunction(() => window.taut.app.frame.value.now_s >= 3.499);
    await page.keyboard.press("f");
    await take(page, "viewer_drag.png");
    await send(page, { type: "drop" }, ...Array.from({ length: 3 }, () => ({ type: "step", count: 1000 })));
    await page.waitForFunction(() => window.taut.app.frame.value.now_s >= 6.499);
  });
  await shown([join(record, "trace.h5")], {}, (page) => film(page, "drag.gif", { speed: 1, from_s: 0.4, to_s: 5.4 }));
}

/** Starts the virtual robot, which needs an idle processor: on a busy one delays appear as red alarms. */
async function dashboard() {
  await shown(["--robot", "virtual"], {}, async (page) => {
    const state = (wanted) => page.waitForFunction((text) => document.querySelector(".robotbar .state").textContent === text, wanted);
    await send(page, { type: "robot_mode", mode: "arm" });
    await state("armed");
    await send(page, { type: "robot_mode", mode: "impedance" });
    await state("impedance");
    await page.waitForFunction(() => window.taut.app.frame.value.time_s > 12);
    await page.screenshot({ path: join(folder, "dashboard.png") }); // its numbers change continuously
  });
}

await replays();
await model();
await live();
await drag();
await dashboard();
await closeBrowser();
