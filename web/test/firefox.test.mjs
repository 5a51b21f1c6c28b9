// The page in Firefox, driven through WebDriver BiDi, which Firefox speaks by itself. It draws 3-D only
// where there is a screen, so it gets one in memory (Debian's packages firefox-esr and xvfb; without
// them there is nothing to test here).
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import WebSocket from "ws";
import { decodePng, PAGE, PICTURES, until, writeReport } from "./browser.mjs";
import { pose, reference, report, tension_n } from "./fixture.mjs";
import { MockServer } from "./mock_server.mjs";

const FIREFOX = process.env.TAUT_FIREFOX ?? "/usr/bin/firefox-esr";
const XVFB = "/usr/bin/Xvfb";
const missing = [FIREFOX, XVFB].filter((path) => !existsSync(path));
const options = { skip: missing.length === 0 ? false : `there is no ${missing.join(", no ")}` };

class Firefox {
  answers = new Map();
  complaints = [];
  next = 1;

  async start(profile) {
    // What a fresh profile fetches from its maker would be noise.
    writeFileSync(join(profile, "user.js"), 'user_pref("remote.active-protocols", 1);\nuser_pref("webgl.force-enabled", true);\n');
    this.screen = spawn(XVFB, ["-displayfd", "1", "-screen", "0", "1400x900x24", "-nolisten", "tcp"], { stdio: ["ignore", "pipe", "ignore"] });
    const display = await new Promise((resolve) => this.screen.stdout.once("data", (data) => resolve(`:${String(data).trim()}`)));
    const env = { ...process.env, HOME: profile, DISPLAY: display, MOZ_ENABLE_WAYLAND: "0", LIBGL_ALWAYS_SOFTWARE: "1" };
    this.process = spawn(FIREFOX, ["--no-remote", "--profile", profile, "--remote-debugging-port", "0"], { env });
    let said = "";
    this.process.stderr.on("data", (data) => (said += data));
    await until(() => /WebDriver BiDi listening on (ws:\S+)/.test(said), "Firefox listens");
    this.socket = new WebSocket(`${/WebDriver BiDi listening on (ws:\S+)/.exec(said)[1]}/session`);
    await new Promise((resolve) => this.socket.on("open", resolve));
    this.socket.on("message", (data) => {
      const message = JSON.parse(data);
      if (message.method === "log.entryAdded" && message.params.level === "error") this.complaints.push(message.params.text);
      this.answers.get(message.id)?.(message);
    });
    await this.ask("session.new", { capabilities: {} });
    await this.ask("session.subscribe", { events: ["log.entryAdded"] });
    this.context = (await this.ask("browsingContext.getTree", {})).contexts[0].context;
    await this.ask("browsingContext.setViewport", { context: this.context, viewport: { width: 1280, height: 760 } });
    return this;
  }

  ask(method, params) {
    const id = this.next++;
    this.socket.send(JSON.stringify({ id, method, params }));
    return new Promise((resolve, reject) => {
      this.answers.set(id, (message) => (message.type === "error" ? reject(new Error(message.message)) : resolve(message.result)));
    });
  }

  open(url) {
    return this.ask("browsingContext.navigate", { context: this.context, url, wait: "complete" });
  }

  /** The value of an expression in the page, which may be a promise. */
  async run(expression) {
    const { result, exceptionDetails } = await this.ask("script.evaluate", {
      expression: `Promise.resolve(${expression}).then(JSON.stringify)`, target: { context: this.context }, awaitPromise: true,
    });
    if (exceptionDetails) throw new Error(exceptionDetails.text);
    return result.type === "string" ? JSON.parse(result.value) : undefined;
  }

  async untilSo(expression) {
    await until(() => this.run(`Boolean(${expression})`), expression);
  }

  async picture(name) {
    const { data } = await this.ask("browsingContext.captureScreenshot", { context: this.context });
    const file = Buffer.from(data, "base64");
    mkdirSync(PICTURES, { recursive: true });
    writeFileSync(join(PICTURES, `firefox-${name}.png`), file);
    return file;
  }

  key(value) {
    return this.ask("input.performActions", {
      context: this.context, actions: [{ type: "key", id: "keys", actions: [{ type: "keyDown", value }, { type: "keyUp", value }] }],
    });
  }
}

let firefox;
let folder;
before(async () => {
  if (options.skip) return;
  folder = mkdtempSync(join(tmpdir(), "taut-firefox-"));
  firefox = await new Firefox().start(folder);
});
after(async () => {
  if (!firefox) return;
  const ended = new Promise((resolve) => firefox.process.on("exit", resolve));
  firefox.process.kill();
  await ended;
  firefox.screen.kill();
  rmSync(folder, { recursive: true, force: true });
});

const DRAWN = 'Number(document.querySelector(".view")?.dataset.drawn ?? 0) > 0 && window.taut.view.world !== null';
const position = (body) => firefox.run(`window.taut.view.world.bodies.object.children[${body}].position.toArray()`);

/** Something of the robot is where the canvas is: dark rods on a light ground. */
async function showsRods(name) {
  const box = await firefox.run('(({ x, y, width, height }) => ({ x, y, width, height }))(document.querySelector(".view canvas").getBoundingClientRect())');
  const { width, channels, bytes } = decodePng(await firefox.picture(name));
  let dark = 0;
  for (let y = Math.ceil(box.y); y < box.y + box.height; ++y) {
    for (let x = Math.ceil(box.x); x < box.x + box.width; ++x) {
      const at = channels * (y * width + x);
      if (bytes[at] + bytes[at + 1] + bytes[at + 2] < 180) ++dark;
    }
  }
  return dark / (box.width * box.height);
}

test("FirefoxReplays", options, async () => {
  const server = await new MockServer(PAGE, { mode: "replay", compared: [reference] }).start();
  await firefox.open(server.url);
  await firefox.untilSo(DRAWN);
  await firefox.run("window.taut.app.seek(6)");
  await firefox.untilSo('document.querySelector(".timeline").dataset.time === "6"');
  (await position(1)).forEach((value, k) => assert.ok(Math.abs(value - pose(1, 6).position_m[k]) < 1e-9));
  await firefox.untilSo(`document.querySelectorAll('[data-figure^="tension:"] .uplot').length === 9`);
  await firefox.untilSo(`!document.querySelector('[data-figure="tension:top_1"] .values').textContent.includes("–")`);
  assert.match(await firefox.run(`document.querySelector('[data-figure="tension:top_1"] .values').textContent`), new RegExp(tension_n(4, 6).toFixed(2)));
  const share = await showsRods("replay");
  assert.ok(share > 0.005 && share < 0.2, `${share} of the view is dark`);
  await firefox.key(" ");
  await firefox.untilSo('Number(document.querySelector(".timeline").dataset.time) > 6.2');
  await server.stop();
  assert.deepEqual(firefox.complaints, []);
});

test("FirefoxDrivesALiveRun", options, async () => {
  const server = await new MockServer(PAGE, { mode: "live" }).start();
  await firefox.open(server.url);
  await firefox.untilSo(DRAWN);
  await firefox.key(" ");
  await until(() => server.of("resume").length === 1, "it runs");
  await firefox.key("c");
  await firefox.untilSo('!document.querySelector(".controls").hidden');
  assert.ok((await showsRods("live")) > 0.005);
  await server.stop();
});

test("FirefoxOpensAReportFromDisk", options, async () => {
  await firefox.open("about:blank");  // the page before, whose server is gone, tries to reach it
  firefox.complaints.length = 0;
  await firefox.open(writeReport(report(), folder));
  await firefox.untilSo(DRAWN);
  await firefox.run("window.taut.app.seek(4)");
  (await position(2)).forEach((value, k) => assert.ok(Math.abs(value - pose(2, 4).position_m[k]) < 1e-9));
  assert.match(await firefox.run('document.querySelector("main.report").innerText'), /a machine/);
  await firefox.picture("report");
  assert.deepEqual(firefox.complaints, []);
});
