// Firefox for tests, driven through WebDriver BiDi, which is built in. It renders 3D only with a screen, so
// it gets a virtual one (Debian's packages firefox-esr and xvfb; without them the tests are skipped).
import { spawn } from "node:child_process";
import { existsSync, mkdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import WebSocket from "ws";
import { PICTURES, until } from "./browser.mjs";

const FIREFOX = process.env.TAUT_FIREFOX ?? "/usr/bin/firefox-esr";
const XVFB = "/usr/bin/Xvfb";
const missing = [FIREFOX, XVFB].filter((path) => !existsSync(path));
export const options = { skip: missing.length === 0 ? false : `there is no ${missing.join(", no ")}` };

export class Firefox {
  answers = new Map();
  complaints = [];
  next = 1;

  async start(profile) {
    // Prevents downloads of a new profile.
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

  /** Returns the value of an expression in the page, which may be a promise. */
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

  async end() {
    const ended = new Promise((resolve) => this.process.on("exit", resolve));
    this.process.kill();
    await ended;
    this.screen.kill();
  }
}
