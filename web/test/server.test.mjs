// Tests of the real server with its pages: access rights, driving, and behavior after its end.
import assert from "node:assert/strict";
import { after, afterEach, test } from "node:test";
import { closeBrowser, listenToNotices, openPage, ready } from "./browser.mjs";
import { endOf, kill, options, stop, view, viewWithToken } from "./real_server.mjs";

afterEach(stop);
after(closeBrowser);

test("APageOutlivesTheRealServer", options, async (t) => {
  const token = "a-token-that-stays-the-same";
  const address = await viewWithToken(token, "experiments/hang.yaml", "--paused", "--port", "0");
  const { port } = new URL(address);
  const page = await openPage(address);
  t.after(() => page.context().close());
  const link = (state) => page.waitForFunction((wanted) => document.querySelector(".link").dataset.state === wanted, state);
  await page.keyboard.press("ArrowRight");
  await page.waitForFunction(() => window.taut.app.frame.value.time_s === 0.001);
  const ended = endOf();
  kill();
  await ended;
  await link("lost");
  await view("experiments/hang.yaml", "--paused", "--port", port);
  await link("refused");
  await stop();
  await viewWithToken(token, "experiments/stand_still.yaml", "--paused", "--port", port);
  await page.waitForFunction(() => document.querySelector(".link").dataset.state === "open" && window.taut.app.scene.value.bodies.length === 3);
  await page.waitForFunction(() => window.taut.app.frame.value.time_s === 0 && window.taut.view.world.scene.bodies.length === 3);
  await page.keyboard.press("ArrowRight");
  await page.waitForFunction(() => window.taut.app.frame.value.time_s === 0.001);
  assert.deepEqual(page.complaints.filter((text) => !/WebSocket|ERR_CONNECTION|403/.test(text)), []);
});

test("ThePrintedAddressIsAllThatABrowserNeeds", options, async (t) => {
  const address = await view("experiments/hang.yaml", "--paused", "--port", "0");
  const page = await openPage(address);
  t.after(() => page.context().close());
  const steps = async (time_s) => {
    await page.keyboard.press("ArrowRight");
    await page.waitForFunction((wanted) => window.taut.app.frame.value.time_s === wanted, time_s);
  };
  await steps(0.001);
  await page.reload();
  await ready(page);
  await steps(0.002);
  // the cookie alone, as when a user enters the address without its token
  const bare = new URL("/", address).href;
  await page.goto(bare);
  await ready(page);
  await steps(0.003);
  const { status } = await fetch(bare);
  assert.equal(status, 403, "without cookie and token nothing is shown");
});

test("TwoPagesOfTheRealServerDriveOneAtATime", options, async (t) => {
  const address = await view("experiments/hang.yaml", "--paused", "--port", "0");
  const [first, second] = [await openPage(address), await openPage(address)];
  t.after(() => Promise.all([first, second].map((page) => page.context().close())));
  const driver = (page, text) => page.waitForFunction((wanted) => document.querySelector(".driver").textContent === wanted, text);
  await first.keyboard.press("ArrowRight");
  await driver(first, "you drive");
  await driver(second, "viewer 1 drives, you watch");
  const said = await listenToNotices(second);
  await second.keyboard.press("ArrowRight");
  await said(/drives; take control first/);
  assert.equal(await first.evaluate(() => window.taut.app.frame.value.time_s), 0.001);
  await second.getByRole("button", { name: /take control; all others/ }).click();
  await driver(first, "viewer 2 drives, you watch");
  await second.locator(".view canvas").first().focus();
  await second.keyboard.press("ArrowRight");
  await first.waitForFunction(() => window.taut.app.frame.value.time_s === 0.002);
  await second.context().close();
  await driver(first, "");
});
