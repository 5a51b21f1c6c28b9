// Tests of replays: playing, scrubbing, stepping, the poses of the trace; plots with the same time.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, beforeEach, test } from "node:test";
import { closeBrowser, cursorTo, drawn, numbersBeside, openPage, PAGE, picture, until, untilTime } from "./browser.mjs";
import { contactCount, DURATION_S, pose, RATE_HZ, reference, rowTime, setpoint_n, tension_n } from "./fixture.mjs";
import { MockServer } from "./mock_server.mjs";

let server;
let page;

before(async () => {
  server = await new MockServer(PAGE, { mode: "replay", compared: [reference] }).start();
  page = await openPage(server.url, { height: 900 }); // plots out of sight are not updated
});
after(async () => {
  await closeBrowser();
  await server.stop();
});
beforeEach(async () => {
  await page.evaluate(() => {
    window.taut.app.send({ type: "pause" });
    window.taut.app.range_s.value = null;
    window.taut.app.seek(0);
  });
  await untilTime(page, 0);
});

const shownTime = () => page.evaluate(() => Number(document.querySelector(".timeline").dataset.time));

test("SpacePlaysAndPauses", async () => {
  await page.keyboard.press(" ");
  await page.waitForFunction(() => Number(document.querySelector(".timeline").dataset.time) > 0.3);
  await page.keyboard.press(" ");
  await page.waitForFunction(() => document.querySelector(".timeline").dataset.paused === "true");
  const stopped_s = await shownTime();
  assert.equal(server.paused, true);
  assert.equal(server.shown_s, stopped_s);
});

test("ScrubbingShowsTheTimeUnderTheMouse", async () => {
  const box = await page.locator(".track").boundingBox();
  for (const share of [0.25, 0.8, 0.5]) {
    await page.mouse.click(box.x + share * box.width, box.y + box.height / 2);
    await untilTime(page, share * DURATION_S, (2 * DURATION_S) / box.width);
  }
  await page.mouse.move(box.x + 0.1 * box.width, box.y + 10);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.6 * box.width, box.y + 10, { steps: 5 });
  await page.mouse.up();
  await untilTime(page, 6, (2 * DURATION_S) / box.width);
});

test("ArrowKeysStepAndJump", async () => {
  await page.locator(".view canvas").first().focus();
  await page.keyboard.press("ArrowRight");
  await untilTime(page, 1 / RATE_HZ);
  await page.keyboard.press("ArrowRight");
  await untilTime(page, 2 / RATE_HZ);
  await page.keyboard.press("ArrowLeft");
  await untilTime(page, 1 / RATE_HZ);
  await page.keyboard.press("Shift+ArrowRight");
  await untilTime(page, 1 + 1 / RATE_HZ);
  await page.keyboard.press("End");
  await untilTime(page, DURATION_S);
  await page.keyboard.press("Home");
  await untilTime(page, 0);
});

test("PosesAreThoseOfTheTrace", async () => {
  for (const time_s of [0, 1.3, 5, 9.98]) {
    await page.evaluate((t) => window.taut.app.seek(t), time_s);
    await untilTime(page, time_s);
    const shown = await page.evaluate(() => {
      const { bodies } = window.taut.view.world;
      return bodies.object.children.map((group) => ({ position_m: group.position.toArray(), q: group.quaternion.toArray() }));
    });
    shown.forEach(({ position_m, q: [x, y, z, w] }, body) => {
      const wanted = pose(body, time_s);
      position_m.forEach((value, k) => assert.ok(Math.abs(value - wanted.position_m[k]) < 1e-12));
      [w, x, y, z].forEach((value, k) => assert.ok(Math.abs(value - wanted.orientation[k]) < 1e-12));
    });
  }
});

test("TheNumbersBesideAPlotAreThoseOfTheRow", async (t) => {
  t.after(() => cursorTo(page, null));
  const tension = async (time_s) => {
    const wanted = [setpoint_n(4), tension_n(4, time_s) + 1.5, tension_n(4, time_s)];
    const [{ numbers }] = await numbersBeside(page, ["tension:top_1"]);
    assert.deepEqual(numbers, wanted.map((value) => Number(value.toPrecision(4))));
  };
  await page.waitForFunction(() => document.querySelectorAll('[data-figure^="tension:"] .uplot').length === 9);
  await page.evaluate(() => window.taut.app.seek(3));
  await untilTime(page, 3);
  await tension(3);
  const titles = await page.locator('[data-figure="tension:top_1"] .values span').evaluateAll((spans) => spans.map(({ title }) => title));
  ["set point", reference.name, "this run"].forEach((label, k) => assert.ok(titles[k].startsWith(`${label}: `) && titles[k].endsWith(" N in the row at 3 s"), titles[k]));
  // drawn points are coarser, with a label
  assert.match(await page.locator('[data-figure="tension:top_1"] .coarse').innerText(), /^min to max of 4 rows$/);
  const times_s = [0.0049, 1.2345, 7.777, 10];
  for (const time_s of times_s) {
    await cursorTo(page, time_s);
    await tension(rowTime(time_s));
  }
  // a moving cursor does not request every row separately
  const asked = server.of("want_series").length;
  for (let i = 0; i < 20; ++i) {
    await cursorTo(page, 5 + i / RATE_HZ);
    await tension(5 + i / RATE_HZ);
  }
  const lines = 9 * 3 + 3;
  assert.ok(server.of("want_series").length - asked <= 2 * lines, `${server.of("want_series").length - asked} questions`);
  await page.locator('[data-figure="contacts"]').scrollIntoViewIfNeeded();
  await drawn(page);
  for (const time_s of times_s) {
    await cursorTo(page, time_s);
    assert.equal((await numbersBeside(page, ["contacts"]))[0].text, String(contactCount(rowTime(time_s))));
  }
  await page.locator('[data-figure="tension:bottom_0"]').scrollIntoViewIfNeeded();
});

test("ACursorInAPlotIsOneInTheTimeline", async () => {
  const plot = page.locator('[data-figure="tension:top_0"] .u-over');
  await plot.waitFor();
  const box = await plot.boundingBox();
  await page.mouse.move(box.x + 0.3 * box.width, box.y + 30);
  await page.waitForFunction((wanted) => Math.abs((window.taut.app.cursor_s.value ?? -1) - wanted) < 0.1, 0.3 * DURATION_S);
  const track = await page.locator(".track").boundingBox();
  const cursor = await page.locator(".track .cursor").boundingBox();
  assert.ok(Math.abs((cursor.x - track.x) / track.width - 0.3) < 0.01);
  await page.mouse.click(box.x + 0.3 * box.width, box.y + 30);
  await untilTime(page, 0.3 * DURATION_S, 0.1);
});

test("DraggingInAPlotZoomsAllAndAsksForFinerData", async () => {
  const plot = page.locator('[data-figure="tension:top_0"] .u-over');
  const box = await plot.boundingBox();
  const asked = server.of("want_series").length;
  await page.mouse.move(box.x + 0.2 * box.width, box.y + 30);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.4 * box.width, box.y + 40, { steps: 4 });
  await page.mouse.up();
  await page.waitForFunction(() => window.taut.app.range_s.value !== null);
  const [t0, t1] = await page.evaluate(() => window.taut.app.range_s.value);
  assert.ok(Math.abs(t0 - 2) < 0.2 && Math.abs(t1 - 4) < 0.2, `${t0} to ${t1}`);
  await page.waitForFunction(() => document.querySelector(".toolbar button:not([hidden])")?.textContent === "zoom out");
  const finer = () => server.of("want_series").slice(asked).filter((question) => question.t0 === t0 && question.t1 === t1);
  await until(() => new Set(finer().map(({ channel }) => channel)).size >= 9, "finer data of nine cables");
  await page.mouse.dblclick(box.x + 0.5 * box.width, box.y + 30);
  await page.waitForFunction(() => window.taut.app.range_s.value === null);
});

test("SpeedIsChosenFromAListOrByKeys", async () => {
  await page.selectOption(".timeline select", "0.25");
  await page.waitForFunction(() => window.taut.app.frame.value.speed === 0.25);
  await page.locator(".view canvas").first().focus();
  await page.keyboard.press("]");
  await page.waitForFunction(() => window.taut.app.frame.value.speed === 0.5);
  await page.keyboard.press("[");
  await page.waitForFunction(() => window.taut.app.frame.value.speed === 0.25);
});

test("NothingIsAskedOfAnyOtherHost", async () => {
  const others = page.requests.filter((url) => new URL(url).host !== `127.0.0.1:${server.port}` && !/^(data|blob):/.test(url));
  assert.deepEqual(others, []);
  assert.deepEqual(page.complaints, []);
  await page.evaluate(() => window.taut.app.seek(4));
  await untilTime(page, 4);
  await picture(page, "replay");
});

test("TheViewIsRecordedAsAVideo", async () => {
  await page.getByRole("button", { name: /^record the 3-D view/ }).click();
  await page.keyboard.press("Escape"); // removes the focus from the button, which space would press
  await page.evaluate(() => window.taut.app.togglePlay());
  await page.waitForFunction(() => Number(document.querySelector(".timeline").dataset.time) > 1);
  const [file] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: /^record the 3-D view/ }).click()]);
  assert.equal(file.suggestedFilename(), "taut-turning prism.webm");
  // the file is a video that the browser plays, with motion
  const video = readFileSync(await file.path()).toString("base64");
  const seen = await page.evaluate(async (base64) => {
    const element = document.createElement("video");
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    element.src = URL.createObjectURL(new Blob([bytes], { type: "video/webm" }));
    element.muted = true;
    await element.play();
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [64, 64];
    const context = canvas.getContext("2d", { willReadFrequently: true });
    const pictures = new Set();
    await new Promise((resolve) => {
      const look = () => {
        context.drawImage(element, 0, 0, 64, 64);
        pictures.add(context.getImageData(0, 0, 64, 64).data.join());
        if (element.ended) resolve();
        else setTimeout(look, 20);
      };
      look();
    });
    return { width: element.videoWidth, pictures: pictures.size };
  }, video);
  assert.ok(seen.width > 300 && seen.pictures > 3, JSON.stringify(seen));
});

test("AReplayIsSavedAsAGif", async () => {
  await page.evaluate(() => {
    window.taut.app.send({ type: "speed", factor: 1 });
    window.taut.app.range_s.value = [2, 4];
  });
  await page.waitForFunction(() => window.taut.app.frame.value.speed === 1);
  const [file] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: /GIF/ }).click()]);
  assert.equal(file.suggestedFilename(), "taut-turning prism.gif");
  const gif = readFileSync(await file.path());
  assert.equal(gif.subarray(0, 6).toString(), "GIF89a");
  const box = await page.locator(".view").boundingBox();
  assert.ok(Math.abs(gif.readUInt16LE(6) - Math.min(640, box.width)) <= 1, "as wide as the view");
  const delays = [];
  for (let at = gif.indexOf("21f904", "hex"); at >= 0; at = gif.indexOf("21f904", at + 8, "hex")) delays.push(gif.readUInt16LE(at + 4));
  assert.deepEqual(delays, new Array(26).fill(8), "two seconds in steps of 80 ms");
  // its last picture equals the display at the end of the span
  const far = await page.evaluate(async (base64) => {
    const decoder = new ImageDecoder({ type: "image/gif", data: Uint8Array.from(atob(base64), (c) => c.charCodeAt(0)) });
    const canvas = document.createElement("canvas");
    const pixels = async (frameIndex) => {
      const { image } = await decoder.decode({ frameIndex });
      [canvas.width, canvas.height] = [image.displayWidth, image.displayHeight];
      const context = canvas.getContext("2d", { willReadFrequently: true });
      context.drawImage(image, 0, 0);
      return context.getImageData(0, 0, canvas.width, canvas.height).data;
    };
    const [first, last] = [await pixels(0), await pixels(25)];
    const { app, view } = window.taut;
    await new Promise((resolve) => {
      app.seek(4);
      const stop = app.frame.watch((frame) => frame.time_s === 4 && (queueMicrotask(() => stop()), resolve()));
    });
    view.draw();
    const context = canvas.getContext("2d", { willReadFrequently: true });
    context.drawImage(view.canvas, 0, 0, canvas.width, canvas.height);
    const now = context.getImageData(0, 0, canvas.width, canvas.height).data;
    const away = (a, b) => a.reduce((sum, value, i) => sum + Math.abs(value - b[i]), 0) / a.length;
    return { last: away(last, now), first: away(first, now) };
  }, gif.toString("base64"));
  assert.ok(far.last < 3 && far.first > 2 * far.last, JSON.stringify(far));
});
