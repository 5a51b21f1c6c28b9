// Tests of the robot's control page with the virtual robot and the real server: arming, holding, stopping,
// tuning from browsers. TAUT_COMMAND: the command; without it, or without the virtual robot, the tests are
// skipped.
import assert from "node:assert/strict";
import { existsSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { after, afterEach, before, test } from "node:test";
import { closeBrowser, drawn, listenToNotices, openPage, picture, until } from "./browser.mjs";
import { childrenOf, stop, TAUT, view } from "./real_server.mjs";

const HAVE = TAUT && existsSync(join(dirname(TAUT), "taut_virtual_robot"));
const options = { skip: HAVE ? false : "there is no virtual robot (TAUT_COMMAND)" };
let folder;

const state = (page, wanted) => page.waitForFunction((text) => document.querySelector(".robotbar .state").textContent === text, wanted);
const alarm = (page, wanted) => page.waitForFunction((text) => document.querySelector(".alarms").textContent.includes(text), wanted);
const OFF = "motors off";
const press = (page, name) => page.locator(".robotbar").getByText(name, { exact: true }).click();

/**
 * Brings the robot into a state, step by step, and retries after interruptions: six emulated boards and a
 * browser load a busy machine, and boards that receive no command in time report a timeout.
 */
async function bring(page, wanted) {
  await until(async () => {
    const now = await page.locator(".robotbar .state").innerText();
    if (now === wanted) return true;
    const next = now === "armed" || (now !== OFF && now !== "stopped") ? { hold: "2 hold", impedance: "3 run" }[wanted] : await page.locator(".alarms").isHidden() ? "1 arm" : "clear faults";
    await page.evaluate((name) => [...document.querySelectorAll(".robotbar button")].find((each) => each.textContent === name && !each.disabled)?.click(), next);
    await new Promise((resolve) => setTimeout(resolve, 200));
    return false;
  }, `to ${wanted}`);
}

/** Returns the address, once six emulated boards have kept up with the clock during their identification. */
async function served(words) {
  for (let tries = 1; ; ++tries) {
    try {
      return await view("--robot", "virtual", "--port", "0", ...words);
    } catch (error) {
      if (tries === 10 || !/does not answer|not obey/.test(error.message)) throw error;
      await stop();
    }
  }
}

async function dashboard(t, ...words) {
  const address = await served(words);
  const open = async (size) => {
    const page = await openPage(address, { webgl: false, ...size });
    t.after(() => page.context().close());
    return page;
  };
  return open;
}

before(() => {
  folder = mkdtempSync(join(tmpdir(), "taut-robot-"));
  process.env.XDG_RUNTIME_DIR = folder; // separate from other tests' robots
});
afterEach(stop);
after(async () => {
  await closeBrowser();
  rmSync(folder, { recursive: true });
});

test("PowerComesInTwoStepsAndSpaceStopsFromAnyBrowser", options, async (t) => {
  const open = await dashboard(t);
  const page = await open({ width: 1440, height: 900 });
  await state(page, OFF);
  assert.equal(await page.locator(".timeline").isVisible(), false, "a robot has no time to go back to");
  await page.waitForFunction(() => document.querySelector(".posenote").textContent === "true pose of the virtual robot");
  assert.equal(await page.locator(".robotbar").getByText("2 hold").isDisabled(), true);
  const other = await open({ width: 1000, height: 700 });
  await state(other, OFF);
  await bring(page, "hold");
  assert.equal(await other.locator(".robotbar").getByText("2 hold").isDisabled(), true, "who only looks on");
  await until(async () => {
    await bring(page, "impedance");
    return page.evaluate(() => window.taut.app.robot.value.motors.every(({ setpoint_n }) => setpoint_n !== null));
  }, "set points of all motors");
  await page.waitForFunction(() => document.querySelectorAll('[data-figure^="tension:"] .uplot').length === 12);
  await page.waitForFunction(() => window.taut.app.frame.value.time_s > 4);
  await drawn(page);
  assert.deepEqual(await page.locator('.stepper button[aria-current="step"]').allInnerTexts(), ["3 run"]);
  // counts of the start, which have stopped rising, are no alarm
  await page.waitForFunction(() => document.querySelector(".health").dataset.state !== "bad");
  assert.match(await page.locator(".health").innerText(), /^healthy/);
  assert.equal(await page.locator(".robotpanel .bad.idle").count(), 0);
  await picture(page, "robot-desktop");

  // the last pressed button has the focus: space must stop the robot, not press the button again
  await other.keyboard.press("Space");
  await state(page, "stopped");
  await state(other, "stopped");
  await alarm(page, "emergency stop");
  await page.waitForFunction(() => window.taut.app.robot.value.boards.every(({ mode }) => ["stopped", "off"].includes(mode)));
  await picture(page, "robot-stopped");
  await press(page, "clear faults");
  await state(page, OFF);
  await bring(page, "hold");
  await page.locator(".robotbar").getByText("3 run").focus();
  await page.keyboard.press("Space");
  await state(page, "stopped");
  assert.deepEqual(page.complaints.filter((text) => !text.includes("WebGL")), []);
});

test("APhoneHasTheStopInReach", options, async (t) => {
  const open = await dashboard(t);
  const page = await open({ width: 390, height: 844, touch: true, scale: 2, webgl: true });
  await state(page, OFF);
  for (const [width, height] of [[390, 844], [844, 390], [320, 568], [768, 1024]]) {
    await page.setViewportSize({ width, height });
    const box = await page.locator(".robotbar .stop").boundingBox();
    assert.ok(box.x >= 0 && box.x + box.width <= width && box.y >= 0 && box.y + box.height <= height, `${width} x ${height}: ${JSON.stringify(box)}`);
    assert.ok(box.height >= 44 && box.width >= 120, `${width} x ${height}: large enough for a thumb`);
    await drawn(page);
    await picture(page, `robot-${width}x${height}`);
  }
  await page.setViewportSize({ width: 390, height: 844 });
  await page.locator(".robotbar .stop").tap();
  await state(page, "stopped");
  await picture(page, "robot-phone-stopped");
});

test("AGainGoesToTheBoardAndItsAnswerStandsThere", options, async (t) => {
  const open = await dashboard(t);
  const page = await open({ width: 1440, height: 900 });
  await page.waitForFunction(() => window.taut.app.robot.value?.motors.every(({ gains }) => gains.every((value) => value !== null)));
  const gains = page.locator(".robotpanel details", { hasText: "Gains" });
  await gains.locator("summary").click();
  const field = gains.locator('input[aria-label="position gain [N/m]"]');
  await field.fill("123.5");
  await field.press("Enter");
  await page.waitForFunction(() => document.querySelector(".gains .answer").textContent.includes("accepted by the board"));
  await page.waitForFunction(() => window.taut.app.robot.value.motors[0].gains[2] === 123.5);
  await gains.locator("select").selectOption("all cables");
  await field.fill("99");
  await field.press("Enter");
  await page.waitForFunction(() => window.taut.app.robot.value.motors.every(({ gains }) => gains[2] === 99));
  const cable = await page.evaluate(() => window.taut.app.tuning.value.robot.motors[0]);
  await page.evaluate((name) => window.taut.app.send({ type: "robot_gain", cable: name, gain: "position_gain_n_per_m", value: 1e6 }), cable);
  await page.waitForFunction(() => /out of/.test(document.querySelector(".gains .answer").textContent));
  await picture(page, "robot-gains");
});

test("EveryCycleIsRecordedAndALostAdapterIsSeen", options, async (t) => {
  const out = join(folder, "recorded");
  const open = await dashboard(t, "--out", out);
  const page = await open({ width: 1440, height: 900 });
  const said = await listenToNotices(page);
  await page.waitForFunction((path) => document.querySelector(".robotbar .time").textContent.includes(path), out);
  await press(page, "end recording");
  await page.waitForFunction(() => window.taut.app.robot.value.recording === "");
  assert.match(readFileSync(join(out, "events.jsonl"), "utf8"), /time_s/);
  assert.ok(existsSync(join(out, "trace.h5")));
  const [robot] = childrenOf();
  process.kill(robot, "SIGKILL");
  await alarm(page, "is gone");
  await page.evaluate(() => window.taut.app.send({ type: "robot_mode", mode: "arm" }));
  await said(/not armed: the adapter is gone/);
  await picture(page, "robot-lost");
  await until(() => page.evaluate(() => window.taut.app.robot.value.link.connected === false), "the adapter to be gone");
});
