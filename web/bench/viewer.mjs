// Measurements of the viewer: frames per second in a browser, cost of a client for the simulation, time to
// open a long trace and to scrub it. Run by script/bench_viewer. Prints numbers, without pass or fail.
import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync, readdirSync, readFileSync, rmSync, statSync } from "node:fs";
import { cpus, tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import WebSocket from "ws";
import { closeBrowser, openPage } from "../test/browser.mjs";

const ROOT = fileURLToPath(new URL("../..", import.meta.url));
const TAUT = process.env.TAUT_COMMAND;
const { frame: LAYOUT } = JSON.parse(readFileSync(new URL("../protocol/messages.json", import.meta.url), "utf8"));
const at = (name) => LAYOUT.header.findIndex(([each]) => each === name);
const [TIME, PAUSED] = [at("time_s"), at("paused")];
const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
const say = (what, value) => console.log(`${what.padEnd(72)} ${value}`);
const middle = (list) => [...list].sort((a, b) => a - b)[list.length >> 1];

async function view(...words) {
  const began = performance.now();
  const server = spawn(TAUT, ["view", ...words, "--port", "0"], { cwd: ROOT, stdio: ["ignore", "pipe", "inherit"] });
  const address = await new Promise((resolve) => {
    let said = "";
    server.stdout.on("data", (data) => {
      said += data;
      const found = /http:\/\/localhost:\S+/.exec(said);
      if (found) resolve(found[0]);
    });
  });
  return { address, server, open_ms: performance.now() - began, stop: () => server.kill("SIGINT") };
}

class Client {
  static async open(address) {
    const client = new Client();
    const { host, search } = new URL(address);
    client.socket = new WebSocket(`ws://${host}/ws${search}`);
    client.waiting = [];
    client.socket.on("message", (data, binary) => {
      const message = binary ? new Float64Array(data.buffer.slice(data.byteOffset, data.byteOffset + data.length)) : JSON.parse(data);
      if (binary) client.frame = message;
      client.waiting = client.waiting.filter(({ wanted, resolve }) => !wanted(message) || resolve(message));
    });
    await new Promise((resolve) => client.socket.on("open", resolve));
    return client;
  }
  until(wanted) {
    return new Promise((resolve) => this.waiting.push({ wanted, resolve: (message) => void resolve(message) }));
  }
  untilFrame(wanted) {
    return this.until((message) => message instanceof Float64Array && wanted(message));
  }
  send(message) {
    this.socket.send(JSON.stringify(message));
  }
  close() {
    const closed = new Promise((resolve) => this.socket.on("close", resolve));
    this.socket.close();
    return closed;
  }
}

/** Returns the CPU time of the busiest thread [s], which is the simulation's. */
function threadSeconds(pid) {
  return Math.max(...readdirSync(`/proc/${pid}/task`).map((task) => {
    const fields = readFileSync(`/proc/${pid}/task/${task}/stat`, "utf8").replace(/^.*\) /, "").split(" ");
    return (Number(fields[11]) + Number(fields[12])) / 100;
  }));
}

/** Measures simulated seconds per CPU second of the simulation's thread with so many clients. */
async function rate(address, pid, clients) {
  const now = async () => {
    const client = await Client.open(address);
    const frame = await client.untilFrame(() => true);
    const cpu_s = threadSeconds(pid);
    await client.close();
    return [frame[TIME], cpu_s];
  };
  const watchers = await Promise.all(Array.from({ length: clients }, () => Client.open(address)));
  const [sim0, cpu0] = await now();
  await sleep(4000);
  const [sim1, cpu1] = await now();
  await Promise.all(watchers.map((client) => client.close()));
  return (sim1 - sim0) / (cpu1 - cpu0);
}

async function slowing(words, title) {
  const { address, server, stop } = await view(...words, "--max");
  const first = await Client.open(address);
  await first.untilFrame((frame) => frame[PAUSED] === 1); // the end of the experiment
  first.send({ type: "resume" });
  await first.untilFrame((frame) => frame[PAUSED] === 0);
  await first.close();
  const ratios = [];
  const alone = [];
  for (let round = 0; round < 7; ++round) {
    const pair = [];
    for (const clients of round % 2 ? [1, 0] : [0, 1]) pair[clients] = await rate(address, server.pid, clients);
    alone.push(pair[0]);
    ratios.push(pair[1] / pair[0]);
  }
  stop();
  say(`${title}: simulated seconds a CPU second, nobody looking`, middle(alone).toFixed(1));
  say(`${title}: the same with a client, share (middle of ${ratios.length}: ${ratios.map((x) => x.toFixed(3)).join(" ")})`, middle(ratios).toFixed(3));
}

async function drawing(words, title) {
  const { address, stop } = await view(...words);
  const page = await openPage(address, { width: 1600, height: 900 });
  const session = await page.context().newCDPSession(page);
  await session.send("Performance.enable");
  const metrics = async () => {
    const { metrics: list } = await session.send("Performance.getMetrics");
    return Object.fromEntries(list.map(({ name, value }) => [name, value]));
  };
  await sleep(2000);
  const drawn = () => page.evaluate(() => window.taut.view.frames.drawn);
  const [before, frames, began] = [await metrics(), await drawn(), performance.now()];
  await sleep(10_000);
  const [after, more, ended] = [await metrics(), await drawn(), performance.now()];
  const count = more - frames;
  say(`${title}: frames drawn a second`, ((1000 * count) / (ended - began)).toFixed(1));
  const busy = (name) => ((1000 * (after[name] - before[name])) / ((ended - began) / 1000)).toFixed(0);
  say(`${title}: the page's own thread, plots included [ms a second]`, busy("TaskDuration"));
  say(`${title}: of that JavaScript [ms a second]`, busy("ScriptDuration"));
  const draws = await page.evaluate(() => {
    const { view, app } = window.taut;
    const times = [];
    for (let i = 0; i < 100; ++i) {
      const began_ms = performance.now();
      view.world.update(app.frame.value);
      view.draw();
      times.push(performance.now() - began_ms);
    }
    const { calls, triangles } = view.renderer.info.render;
    return { cost_ms: times.sort((a, b) => a - b)[50], calls, triangles };
  });
  say(`${title}: to move and draw the scene, without the GPU [ms]`, `${draws.cost_ms.toFixed(2)} (${draws.calls} calls, ${draws.triangles} triangles)`);
  await page.context().close();
  stop();
}

async function longTrace(folder) {
  const trace = join(folder, "trace.h5");
  execFileSync(TAUT, ["run", "experiments/stand_still.yaml", "--duration_s", "3600", "--quiet", "--out", folder], { cwd: ROOT });
  say("one hour, 100 Hz: size of the trace [MB]", (statSync(trace).size / 1e6).toFixed(0));
  const { address, open_ms, stop } = await view(trace);
  const client = await Client.open(address);
  const { scene } = await client.until((message) => message.type === "scene");
  say(`one hour: until the server answers, ${scene.channels.length} channels [s]`, (open_ms / 1000).toFixed(2));
  const tensions = scene.channels.map(({ name }) => name).filter((name) => /tension_n|setpoint_n|length_m/.test(name)).slice(0, 36);
  for (const round of ["first time", "again"]) {
    const began = performance.now();
    await Promise.all(tensions.map((channel, id) => {
      client.send({ type: "want_series", id, channel, t0: 0, t1: 3600, points: 600 });
      return client.until((message) => message.type === "series" && message.id === id);
    }));
    say(`one hour: ${tensions.length} channels over all of it, ${round} [ms]`, (performance.now() - began).toFixed(0));
  }
  const jumps = [];
  for (let i = 0; i < 200; ++i) {
    const time_s = ((i * 7919) % 3600000) / 1000;
    const began = performance.now();
    client.send({ type: "seek", time_s });
    await client.untilFrame((frame) => Math.abs(frame[TIME] - time_s) < 0.0101);
    jumps.push(performance.now() - began);
  }
  say("one hour: a jump until the frame is there, middle and worst of 200 [ms]", `${middle(jumps).toFixed(1)}, ${Math.max(...jumps).toFixed(1)}`);
  await client.close();
  const page = await openPage(address, { width: 1600, height: 900 });
  const began = performance.now();
  await page.waitForFunction(() => document.querySelectorAll('[data-figure^="tension:"] .uplot').length === 12);
  say("one hour: the page, from its first picture to twelve plots [ms]", (performance.now() - began).toFixed(0));
  await page.context().close();
  stop();
}

const folder = mkdtempSync(join(tmpdir(), "taut-bench-viewer-"));
const { model } = cpus()[0];
console.log(`${model.trim()}, ${cpus().length} cores, load ${readFileSync("/proc/loadavg", "utf8").split(" ")[0]}; Chromium headless, graphics in software (SwiftShader)`);
try {
  await drawing(["experiments/push_20n.yaml"], "Tetraspine3");
  await drawing(["experiments/push_20n.yaml", "--set", "segments=12"], "Tetraspine12");
  await closeBrowser();
  await slowing(["experiments/push_20n.yaml"], "Tetraspine3");
  await slowing(["experiments/push_20n.yaml", "--set", "segments=12"], "Tetraspine12");
  await longTrace(folder);
} finally {
  await closeBrowser();
  rmSync(folder, { recursive: true });
}
