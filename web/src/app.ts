// Central state of the page, as signals. Parts of the page watch the signals and never each other.
import { frameOfScene, type Frame } from "./frame";
import type { ClientMessage, EventMessage, GainAnswerMessage, HelloMessage, Report, RobotStatus, Scene, SeriesMessage, ServerMessage } from "./protocol";
import { PROTOCOL_VERSION } from "./protocol";
import type { Connection, Source } from "./source";
import { memory, Signal } from "./util";

export type Selection = { kind: "cable" | "body" | "node" | "joint"; index: number };
export type Theme = "dark" | "light";

export class App {
  readonly hello = new Signal<HelloMessage | null>(null);
  readonly scene = new Signal<Scene | null>(null);
  /** The latest scene; its parameters and controls may change during a run. */
  readonly tuning = new Signal<Scene | null>(null);
  readonly frame = new Signal<Frame | null>(null);
  readonly link = new Signal<Connection>("connecting");
  readonly driver = new Signal<number>(0);
  readonly selection = new Signal<Selection | null>(null);
  readonly hover = new Signal<Selection | null>(null);
  /** The time under the cursor in a plot or the timeline [s]. */
  readonly cursor_s = new Signal<number | null>(null);
  /** The time span of the plots; null: all, or the recent past. */
  readonly range_s = new Signal<readonly [number, number] | null>(null);
  readonly theme = new Signal<Theme>(startTheme());
  /** Reason why there is nothing to display. */
  readonly failure = new Signal<string | null>(null);
  readonly notice = new Signal<string | null>(null);
  readonly events = new Signal<readonly EventMessage[]>([]);
  readonly seriesAnswer = new Signal<SeriesMessage | null>(null);

  /** Status of a robot with motor boards. */
  readonly robot = new Signal<RobotStatus | null>(null);
  readonly gainAnswer = new Signal<GainAnswerMessage | null>(null);

  constructor(
    private readonly source: Source,
    readonly report: Report | null,
  ) {
    this.theme.watch((theme) => (document.documentElement.dataset.theme = theme));
  }

  start(): void {
    this.source.start({
      connection: (state) => (this.link.value = state),
      message: (message) => this.receive(message),
      frame: (frame) => {
        if (this.fits(frame)) this.frame.value = frame;
      },
    });
  }

  send(message: ClientMessage): boolean {
    const sent = this.source.send(message);
    if (!sent && message.type !== "want_series") this.notice.value = "not connected: the command was not sent";
    return sent;
  }

  /** Whether the session has a present: a live run of an experiment or a model, a user's program, a robot. */
  get live(): boolean {
    return this.movable || this.isRobot || this.hello.value?.mode === "program";
  }

  /** Whether motor boards are driven: pausing is impossible then, and space stops the motors. */
  get isRobot(): boolean {
    return this.hello.value?.mode === "robot";
  }

  /** Whether users can drag, tune and reset the robots. */
  get movable(): boolean {
    return ["live", "model"].includes(this.hello.value?.mode ?? "");
  }

  get replay(): boolean {
    return this.hello.value?.mode === "replay";
  }

  /** Whether the displayed time can be changed. */
  get seekable(): boolean {
    return this.replay || (this.live && !this.isRobot);
  }

  /** Whether a past moment of a live run is displayed. */
  get looksBack(): boolean {
    const frame = this.frame.value;
    return this.live && frame !== null && frame.time_s < frame.now_s;
  }

  /** Returns to the present of a live run. */
  goToNow(): void {
    this.seek(Number.MAX_VALUE);
  }

  /** Whether the page's link permits watching only. */
  get watches(): boolean {
    return this.hello.value?.watch_only === true;
  }

  get drives(): boolean {
    return !this.watches && (this.driver.value === 0 || this.driver.value === this.hello.value?.client);
  }

  togglePlay(): void {
    this.send({ type: this.frame.value?.paused ? "resume" : "pause" });
  }

  seek(time_s: number): void {
    if (this.seekable) this.send({ type: "seek", time_s });
  }

  /** Returns to the start. A program's data can be displayed again, but not recomputed. */
  goToStart(): void {
    if (this.hello.value?.mode === "program") this.seek(-Number.MAX_VALUE);
    else this.send({ type: "reset" });
  }

  toggleTheme(): void {
    this.theme.value = this.theme.value === "dark" ? "light" : "dark";
    memory.set("theme", this.theme.value);
  }

  private receive(message: ServerMessage): void {
    switch (message.type) {
      case "hello":
        if (message.version !== PROTOCOL_VERSION) {
          this.failure.value = `This page uses version ${PROTOCOL_VERSION} of the protocol, the server version ${message.version}. Reload the page; if the problem persists, the server belongs to another version of taut.`;
          return;
        }
        this.failure.value = null;
        this.driver.value = message.driver;
        this.hello.value = message;
        break;
      case "scene":
        this.receiveScene(message.scene);
        break;
      case "series":
        this.seriesAnswer.value = message;
        break;
      case "event":
        this.events.value = [...this.events.value.slice(-199), message];
        break;
      case "error":
        this.notice.value = message.text;
        break;
      case "robot":
        this.robot.value = message.status;
        break;
      case "gain_answer":
        this.gainAnswer.value = message;
        break;
      case "driver":
        this.driver.value = message.id;
        break;
    }
  }

  /** A changed parameter causes a new scene; if the scene looks the same, the 3D view is not rebuilt. */
  private receiveScene(scene: Scene): void {
    const before = this.scene.value;
    if (before === null || looks(before) !== looks(scene)) {
      if (before === null || names(before) !== names(scene)) {
        this.selection.value = null;
        this.hover.value = null;
      }
      this.scene.value = scene;
      if (this.frame.value === null || !this.fits(this.frame.value)) this.frame.value = frameOfScene(scene);
    }
    this.tuning.value = scene;
    if (scene.notice !== undefined) this.notice.value = scene.notice;
    else if (before?.notice !== undefined && this.notice.value === before.notice) this.notice.value = null; // the defect has been fixed
  }

  /** A frame of the previous scene may still arrive after the scene has changed. */
  private fits(frame: Frame): boolean {
    const scene = this.scene.value;
    if (scene === null) return false;
    const ghosts = scene.compared.reduce((sum, { bodies }) => sum + bodies.length, 0);
    return frame.body_count === scene.bodies.length && frame.cable_count === scene.cables.length &&
      frame.value_count === scene.values.length && frame.ghost_count === ghosts;
  }
}

/** Returns the name of a selection; empty: it does not exist. */
export function nameOf(scene: Scene, { kind, index }: Selection): string {
  const list = { cable: scene.cables, body: scene.bodies, node: scene.nodes, joint: scene.joints }[kind];
  return list[index]?.name ?? "";
}

function looks({ bodies, nodes, cables, joints, terrain, channels, phases, duration_s, compared, contact_forces, notice, shape, summary }: Scene): string {
  return JSON.stringify([bodies, nodes, cables, joints, terrain, channels, phases, duration_s, compared, contact_forces, notice, shape, summary]);
}

function names({ bodies, nodes, cables, joints }: Scene): string {
  return JSON.stringify([bodies, nodes, cables, joints].map((list) => list.map(({ name }) => name)));
}

function startTheme(): Theme {
  const kept = memory.get("theme");
  if (kept === "dark" || kept === "light") return kept;
  return matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
}
