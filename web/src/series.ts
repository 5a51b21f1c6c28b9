// Channels over time: from the displayed frames of a live run, or from the trace.
import type { App } from "./app";
import { cableState, type Frame, frameOfScene } from "./frame";
import { VALUES } from "./layout";
import { between, joined, NOTHING, type Points, pointsOf, rowsOf, thinned } from "./points";
import type { Scene } from "./protocol";
import { type Row, rowAt, RowReader } from "./rows";
import type { Signal } from "./util";

const LIVE_CAPACITY = 36_000; // ten minutes at 60 frames per second
const ASK_AT_ONCE = 8; // maximum number of pending requests
const GAP_S = 0.05; // a larger gap between frames of a live run is filled by a request
const LATE = 0.02; // permitted lag of an answer about a live run, relative to the displayed span
const ROUNDING_S = 1e-9; // tolerance for times of the same row in different runs
const NO_ROW: Row = { time_s: NaN, value: NaN, every: 1 };
const RANGES = 6; // cached ranges of a channel: one per plot, and previous ones

type Receiver = (points: Points) => void;

interface Question {
  channel: string;
  source: number;
  t0: number;
  t1: number;
  points: number;
  receive: Receiver;
}

/** An answer about a time without frames: before the page was opened, or between its frames. */
interface Past {
  t0: number;
  t1: number;
  /** Number of requested points. */
  asked: number;
  coarse: boolean;
  points: Points;
}

export class SeriesStore {
  private readonly history = new Map<string, Points>();
  /** Cached ranges of each channel, most recently used first. */
  private readonly past = new Map<string, Past[]>();
  private readonly rows = new RowReader((...question) => this.ask(...question));
  private present: { frame: Frame; values: Map<string, number> } | null = null;
  private framesHave: { scene: Scene; names: ReadonlySet<string> } | null = null;
  private run = -1;
  private last_s = -Infinity;
  /** Start of the present sequence of frames without gaps. */
  private dense_s = Infinity;
  private readonly waiting: Question[] = [];
  private readonly asked = new Map<number, Question>();
  private next = 1;

  constructor(private readonly app: App) {
    app.frame.watch((frame) => frame && app.live && this.record(frame));
    app.seriesAnswer.watch((answer) => {
      if (!answer) return;
      const question = this.asked.get(answer.id);
      this.asked.delete(answer.id);
      question?.receive(pointsOf(answer.series));
      this.sendWaiting();
    });
    // A live scene is sent again whenever a slider moves; frames identify the run.
    app.scene.watch(() => app.live || this.forget());
    app.link.watch((link) => link === "lost" && this.forget());
  }

  /**
   * Returns the unit of a channel of the run (source 0) or of compared run k; undefined: there is no such
   * channel.
   */
  unit(channel: string, source: number): string | undefined {
    const scene = this.app.scene.value;
    const channels = source > 0 ? scene?.compared[source - 1]?.channels : scene?.channels;
    return channels?.find(({ name }) => name === channel)?.unit;
  }

  has(channel: string, source: number): boolean {
    return this.unit(channel, source) !== undefined;
  }

  /**
   * Returns the row at a time, or the last before it; null: requested, and `rowsCame` increases when it is
   * available; NaN: a compared run has ended before. `drawn`: the plot's points of the channel around this
   * time.
   */
  row(channel: string, source: number, time_s: number, drawn: Points): Row | null {
    const now = source === 0 ? this.inFrame(channel, time_s) : undefined;
    if (now !== undefined) return { time_s, value: now, every: 1 };
    const compared = this.app.scene.value?.compared[source - 1];
    if (compared && time_s > compared.last_s + ROUNDING_S) return NO_ROW; // the run's last row is out of date
    if (!this.app.live || source !== 0) return this.rows.at(channel, source, time_s, drawn);
    if (!this.isInFrames(channel)) return this.keptRow(channel, time_s, drawn);
    // the later of the rows in frames and on the server
    const own = rowAt(this.history.get(channel) ?? NOTHING, time_s);
    if (time_s >= this.last_s) return own;
    const kept = this.rows.at(channel, source, time_s, NOTHING);
    return kept === null || kept.time_s > own.time_s || Number.isNaN(own.time_s) ? kept : own;
  }

  /**
   * Returns a row of a channel that frames do not contain. While the run advances, the plot's last row is
   * recent enough.
   */
  private keptRow(channel: string, time_s: number, drawn: Points): Row | null {
    const frame = this.app.frame.value;
    const runs = frame !== null && frame.paused === 0 && frame.time_s === time_s;
    return runs && drawn.rows === 1 ? rowAt(drawn, time_s) : this.rows.at(channel, 0, time_s, NOTHING);
  }

  /** Returns whether frames of a live run contain the channel. The server stores all others. */
  private isInFrames(channel: string): boolean {
    const { value: scene } = this.app.scene;
    if (!scene) return false;
    if (this.framesHave?.scene !== scene) this.framesHave = { scene, names: new Set([...frameValues(scene, frameOfScene(scene))].map(([name]) => name)) };
    return this.framesHave.names.has(channel);
  }

  /** Returns the time of the run's row at a time, or of the last before it; NaN if unknown. */
  rowTime(time_s: number): Promise<number> {
    const channel = this.app.scene.value?.channels[0]?.name;
    if (channel === undefined) return Promise.resolve(NaN);
    return new Promise((resolve) => this.ask(channel, 0, time_s, time_s, 10, (points) => resolve(rowAt(points, time_s).time_s)));
  }

  /** Increases when rows arrive that `row` did not have. */
  get rowsCame(): Signal<number> {
    return this.rows.came;
  }

  /** Returns the value in the displayed frame, if it has this time. */
  private inFrame(channel: string, time_s: number): number | undefined {
    const { value: frame } = this.app.frame;
    const { value: scene } = this.app.scene;
    if (!scene || !frame || frame.time_s !== time_s || frame.run < 0) return undefined;
    if (this.present?.frame !== frame) this.present = { frame, values: new Map(frameValues(scene, frame)) };
    return this.present.values.get(channel);
  }

  want(channel: string, source: number, t0: number, t1: number, points: number, receive: Receiver): void {
    if (this.app.live && source === 0 && !this.isInFrames(channel)) {
      const frame = this.app.frame.value;
      const until_s = Math.min(t1, frame?.now_s ?? t1); // the future cannot be requested
      const late_s = frame?.paused === 0 ? LATE * (t1 - t0) : 0;
      receive(thinned(this.kept(channel, t0, until_s, points, late_s), t0, t1, Infinity));
      return;
    }
    if (this.app.live && source === 0) {
      const own = thinned(this.history.get(channel) ?? NOTHING, t0, t1, points);
      const until_s = Math.min(t1, this.dense_s);
      const past = () => between(this.kept(channel, t0, until_s, points, LATE * (until_s - t0)), t0, until_s);
      receive(t0 < this.dense_s ? joined(past(), own) : own);
      return;
    }
    this.ask(channel, source, t0, t1, points, receive);
  }

  private ask(channel: string, source: number, t0: number, t1: number, points: number, receive: Receiver): void {
    this.waiting.push({ channel, source, t0, t1, points: Math.round(Math.min(Math.max(points, 2), 10_000)), receive });
    this.sendWaiting();
  }

  /**
   * Returns the server's data of a live run around a span, as far as received. `late_s`: permitted gap at its
   * end.
   */
  private kept(channel: string, t0: number, t1: number, points: number, late_s: number): Points {
    const ranges = this.past.get(channel) ?? [];
    const span_s = t1 - t0;
    const fits = (past: Past) =>
      past.t0 <= t0 && past.t1 >= t1 - late_s &&
      !(past.coarse && (past.t1 - past.t0 > 3 * span_s || past.asked < points));
    const overlap_s = (past: Past) => Math.min(past.t1, t1) - Math.max(past.t0, t0);
    const past = ranges.find(fits) ??
      // known data are displayed until the answer arrives, so that the plot does not flicker; requested only
      // once
      this.askPast(channel, t0, t1, points, [...ranges].sort((a, b) => overlap_s(b) - overlap_s(a))[0]?.points ?? NOTHING);
    this.past.set(channel, [past, ...ranges.filter((other) => other !== past)].slice(0, RANGES));
    return past.points;
  }

  private askPast(channel: string, t0: number, t1: number, points: number, meanwhile: Points): Past {
    const asked: Past = { t0, t1, asked: points, coarse: false, points: meanwhile };
    this.ask(channel, 0, t0, t1, points, (received) => {
      asked.points = received;
      asked.coarse = received.t.length > points / 3;
    });
    return asked;
  }

  private sendWaiting(): void {
    while (this.asked.size < ASK_AT_ONCE && this.waiting.length > 0) {
      const question = this.waiting.shift()!;
      const id = this.next++;
      const { channel, source, t0, t1, points } = question;
      if (!this.app.send({ type: "want_series", id, channel, source, t0, t1, points })) {
        this.waiting.unshift(question);
        return;
      }
      this.asked.set(id, question);
    }
  }

  private forget(): void {
    this.history.clear();
    this.past.clear();
    this.waiting.length = 0;
    this.asked.clear();
    this.rows.forget();
    this.last_s = -Infinity;
  }

  private record(frame: Frame): void {
    const scene = this.app.scene.value;
    // ignores frames of looking back, and initial states of scenes
    if (!scene || frame.time_s < frame.now_s || frame.run < 0) return;
    if (frame.run !== this.run || frame.time_s < this.last_s) {
      this.run = frame.run;
      this.forget();
    }
    // while paused, and at the start, the last frame of a time is valid
    const again = frame.time_s === this.last_s;
    if (frame.time_s - this.last_s > GAP_S) this.dense_s = frame.time_s;
    this.last_s = frame.time_s;
    const add = (channel: string, value: number) => {
      let points = this.history.get(channel);
      if (!points) this.history.set(channel, (points = rowsOf([], [])));
      if (again && points.t.length > 0) {
        points.t.pop();
        points.first.pop();
      }
      points.t.push(frame.time_s);
      points.first.push(Number.isFinite(value) ? value : null);
      if (points.t.length > 1.2 * LIVE_CAPACITY) {
        points.t.splice(0, points.t.length - LIVE_CAPACITY);
        points.first.splice(0, points.first.length - LIVE_CAPACITY);
      }
    };
    for (const [channel, value] of frameValues(scene, frame)) add(channel, value);
  }
}

/** Returns the values of a frame by channel. */
export function* frameValues(scene: Scene, frame: Frame): Generator<[string, number]> {
  for (let i = 0; i < scene.cables.length; ++i) {
    const name = scene.cables[i]!.name;
    for (const [key, value] of Object.entries(cableState(frame, i))) yield [`cable/${name}/${key}`, value as number];
  }
  for (let i = 0; i < scene.bodies.length; ++i) {
    const name = scene.bodies[i]!.name;
    const at = i * VALUES.bodies;
    yield [`body/${name}/position_x_m`, frame.bodies[at]!];
    yield [`body/${name}/position_y_m`, frame.bodies[at + 1]!];
    yield [`body/${name}/position_z_m`, frame.bodies[at + 2]!];
  }
  for (const [place, name] of scene.values.entries()) yield [name, frame.values[place]!];
  yield ["system/kinetic_j", frame.kinetic_j];
  yield ["system/gravity_j", frame.gravity_j];
  yield ["system/elastic_j", frame.elastic_j];
  yield ["system/contact_count", frame.contact_count];
  yield ["real_time_factor", frame.real_time_factor];
}
