// Mock server with the viewer's protocol, which moves the robot of fixture.mjs. It records received messages
// for tests.
import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import { WebSocketServer } from "ws";
import { contactsAt, DURATION_S, frameValues, ghostsAt, liveScene, nodes, RATE_HZ, rowTime, scene, seriesOf, VERSION, worldPoint } from "./fixture.mjs";

const FRAME_MS = 20;
const IDLE_TICKS = 12;

export class MockServer {
  received = [];
  time_s = 0;
  paused = true;
  speed = 1;
  past_s = null; // displayed past time
  driver = 0;
  run = 0;
  dragged = null;
  pushed = [];
  parameters = {};
  clients = new Map();
  next = 1;

  /** mode: live, replay; page: the file to serve at "/"; compared, more: entries of a replay's scene. */
  constructor(page, { mode = "replay", compared = [], more = {}, hello = {}, tensions_n = {} } = {}) {
    this.page = page;
    this.mode = mode;
    this.compared = compared;
    this.more = more;
    this.hello = hello;
    this.tensions_n = tensions_n; // by index of the cable, instead of those of the fixture
  }

  async start(port = 0) {
    this.http = createServer((request, response) => {
      const known = new URL(request.url, "http://x").pathname === "/";
      response.writeHead(known ? 200 : 404, { "content-type": "text/html; charset=utf-8" });
      response.end(known ? readFileSync(this.page) : "not found");
    });
    this.sockets = new WebSocketServer({ server: this.http, path: "/ws" });
    this.sockets.on("connection", (socket) => this.welcome(socket));
    await new Promise((resolve) => this.http.listen(port, "127.0.0.1", resolve));
    this.port = this.http.address().port;
    this.url = `http://127.0.0.1:${this.port}/`;
    this.timer = setInterval(() => this.tick(), FRAME_MS);
    return this;
  }

  async stop() {
    clearInterval(this.timer);
    for (const socket of this.clients.values()) socket.terminate();
    this.clients.clear();
    this.http.closeAllConnections?.();
    await new Promise((resolve) => this.http.close(resolve));
  }

  /** Returns the scene with the present parameters. */
  liveScene() {
    return { ...liveScene, parameters: liveScene.parameters.map((each) => ({ ...each, value: this.parameters[each.name] ?? each.value })) };
  }

  /** The displayed time; in a replay the time of a row. */
  get shown_s() {
    return this.mode === "live" ? (this.past_s ?? this.time_s) : rowTime(this.time_s);
  }

  /** Returns the messages of a type, in order. */
  of(type) {
    return this.received.filter((message) => message.type === type);
  }

  send(socket, message) {
    socket.send(JSON.stringify(message));
  }

  tell(message) {
    for (const socket of this.clients.values()) this.send(socket, message);
  }

  welcome(socket) {
    const client = this.next++;
    this.clients.set(client, socket);
    socket.on("close", () => {
      this.clients.delete(client);
      if (this.driver === client) this.tell({ type: "driver", id: (this.driver = 0) });
    });
    this.send(socket, {
      type: "hello", version: VERSION, mode: this.mode, title: "turning prism", client, driver: this.driver,
      ...this.hello,
    });
    const shown = this.mode === "live" ? this.liveScene() : { ...scene, compared: this.compared, ...this.more };
    this.send(socket, { type: "scene", scene: shown });
    socket.on("message", (data) => this.hear(client, socket, JSON.parse(data.toString())));
    this.frame();
  }

  hear(client, socket, message) {
    this.received.push({ ...message, client });
    if (message.type === "want_series") {
      const { id, channel, source = 0, t0, t1, points } = message;
      const last_s = this.mode === "live" ? Math.min(t1, this.time_s) : t1;
      this.send(socket, { type: "series", id, series: seriesOf(channel, source, t0, last_s, points) });
      return;
    }
    if (message.type === "take_control" || this.driver === 0) {
      this.driver = client;
      this.tell({ type: "driver", id: client });
    }
    if (this.driver !== client) {
      this.send(socket, { type: "error", text: `viewer ${this.driver} drives` });
      return;
    }
    this.obey(message);
    this.frame();
  }

  obey(message) {
    const limit = (time_s) => (this.mode === "live" ? time_s : Math.min(Math.max(time_s, 0), DURATION_S));
    switch (message.type) {
      case "pause": this.paused = true; break;
      case "resume": [this.paused, this.past_s] = [false, null]; break;
      case "step": this.paused = true; this.time_s = limit((Math.round(this.time_s * RATE_HZ) + (message.count ?? 1)) / RATE_HZ); break;
      case "reset": this.time_s = 0; this.run += this.mode === "live" ? 1 : 0; break;
      case "speed": this.speed = message.factor; break;
      case "seek":
        if (this.mode !== "live") this.time_s = limit(message.time_s);
        else [this.paused, this.past_s] = [true, message.time_s < this.time_s ? Math.max(message.time_s, 0) : null];
        break;
      case "set_parameter":
        this.parameters = { ...this.parameters, [message.name]: message.value };
        this.tell({ type: "scene", scene: this.liveScene() });
        break;
      case "drag": this.dragged = message; break;
      case "drop":
        this.dragged = null;
        this.tell({ type: "event", time_s: this.time_s, text: "drag ends" });
        break;
      case "push": this.pushed.push({ ...message, until_s: this.time_s + message.duration_s }); break;
    }
  }

  tick() {
    if (!this.paused) this.time_s += (FRAME_MS / 1000) * (this.speed || 10);
    if (this.mode === "replay" && this.time_s >= DURATION_S) [this.time_s, this.paused] = [DURATION_S, true];
    // as the real server, which sends few frames while nothing changes
    this.idle = this.paused ? (this.idle ?? 0) + 1 : 0;
    if (this.idle % IDLE_TICKS <= 1) this.frame();
  }

  frame() {
    const shown_s = this.shown_s;
    const pushes = this.pushed.filter(({ until_s }) => until_s > this.time_s)
      .map(({ node, force_n }) => [nodes.findIndex(({ name }) => name === node), ...force_n]);
    const tensions = { ...this.tensions_n };
    if (this.dragged) {
      const place = nodes.findIndex(({ name }) => name === this.dragged.node);
      const at = worldPoint(nodes[place].body, nodes[place].position_m, this.time_s);
      const force_n = this.dragged.target_m.map((value, k) => liveScene.drag_stiffness_n_per_m * (value - at[k]));
      pushes.push([place, ...force_n]);
      tensions[0] = 5 + Math.hypot(...force_n);
    }
    const values = frameValues(shown_s, {
      header: {
        now_s: this.mode === "live" ? this.time_s : shown_s, paused: this.paused ? 1 : 0, speed: this.speed, driver: this.driver, run: this.run },
      contacts: contactsAt(shown_s), pushes, tension_n: tensions, ghosts: ghostsAt(this.mode === "live" ? [] : this.compared, shown_s),
    });
    const bytes = new Float64Array(values);
    for (const socket of this.clients.values()) if (socket.bufferedAmount < 1e6) socket.send(bytes);
  }
}
