// Report as a message source: answers like a replay server, from the data embedded in the page.
import { decodeFrame, type Frame } from "./frame";
import { type Points, rowsOf, thinned } from "./points";
import type { ClientMessage, Report, Rows, WantSeriesMessage } from "./protocol";
import type { Listener, Source } from "./source";
import { lastAtMost } from "./util";

export class ReportSource implements Source {
  private readonly values: Float64Array;
  private readonly times_s: Float64Array;
  private readonly tables: readonly Table[];
  private listener: Listener | null = null;
  private time_s: number;
  private speed = 1;
  private paused = true;
  private last_ms: number | null = null;

  constructor(private readonly report: Report) {
    this.values = decodeFloats(report.frames_base64);
    if (this.values.length !== report.frame_count * report.frame_values) {
      throw new Error(`the report contains ${this.values.length} values of frames, expected ${report.frame_count} times ${report.frame_values}`);
    }
    this.tables = report.rows.map((rows) => new Table(rows));
    this.times_s = Float64Array.from({ length: report.frame_count }, (_, i) => this.values[i * report.frame_values]!);
    this.time_s = report.scene.first_s;
  }

  start(listener: Listener): void {
    this.listener = listener;
    listener.connection("report");
    listener.message({
      type: "hello", version: this.report.version, mode: "replay", title: this.report.title, client: 1, driver: 1,
    });
    listener.message({ type: "scene", scene: this.report.scene });
    this.show();
  }

  send(message: ClientMessage): boolean {
    switch (message.type) {
      case "pause":
        this.paused = true;
        break;
      case "resume":
        if (this.time_s >= this.end_s) this.time_s = this.report.scene.first_s;
        this.paused = false;
        this.last_ms = null;
        requestAnimationFrame((now_ms) => this.tick(now_ms));
        break;
      case "step":
        this.paused = true;
        this.time_s = this.times_s[this.clamp(this.place() + (message.count ?? 1))] ?? this.time_s;
        break;
      case "reset":
        this.time_s = this.report.scene.first_s;
        break;
      case "speed":
        this.speed = message.factor;
        break;
      case "seek":
        this.time_s = Math.min(Math.max(message.time_s, this.report.scene.first_s), this.end_s);
        break;
      case "want_series":
        this.answer(message);
        return true;
      default:
        return false;
    }
    this.show();
    return true;
  }

  private get end_s(): number {
    return this.report.scene.duration_s;
  }

  private clamp(place: number): number {
    return Math.min(Math.max(place, 0), this.report.frame_count - 1);
  }

  private place(): number {
    return this.clamp(lastAtMost(this.times_s, this.time_s));
  }

  private show(): void {
    if (this.report.frame_count === 0) return;
    const size = this.report.frame_values;
    const start = this.place() * size;
    const frame: Frame = decodeFrame(this.values.subarray(start, start + size));
    frame.speed = this.speed;
    frame.paused = this.paused ? 1 : 0;
    frame.driver = 1;
    this.listener?.frame(frame);
  }

  private tick(now_ms: number): void {
    if (this.paused) return;
    if (this.last_ms !== null) {
      const factor = this.speed > 0 ? this.speed : 1000;
      this.time_s += ((now_ms - this.last_ms) / 1000) * factor;
    }
    this.last_ms = now_ms;
    if (this.time_s >= this.end_s) {
      this.time_s = this.end_s;
      this.paused = true;
    }
    this.show();
    requestAnimationFrame((next_ms) => this.tick(next_ms));
  }

  private answer({ id, channel, source = 0, t0, t1, points: most }: WantSeriesMessage): void {
    const all = this.tables.find(({ rows, places }) => rows.source === source && places.has(channel))?.points(channel);
    if (!all) {
      queueMicrotask(() => this.listener?.message({ type: "error", text: `the report has no channel ${channel}` }));
      return;
    }
    const { t, first, min, max, rows: level } = thinned(all, t0, t1, most);
    queueMicrotask(() => this.listener?.message({ type: "series", id, series: { channel, source, level, time_s: t, first, min, max } }));
  }
}

/** The channels of one trace; each is extracted from the numbers on demand. */
class Table {
  readonly places: Map<string, number>;
  private readonly values: Float64Array;
  private readonly t: number[];
  private readonly known = new Map<string, Points>();

  constructor(readonly rows: Rows) {
    this.values = decodeFloats(rows.base64);
    const wanted = rows.count * (1 + rows.channels.length * (rows.level === 1 ? 1 : 3));
    if (this.values.length !== wanted) throw new Error(`the report contains ${this.values.length} values of rows, expected ${wanted}`);
    this.places = new Map(rows.channels.map((name, place) => [name, place]));
    this.t = Array.from(this.values.subarray(0, rows.count));
  }

  points(channel: string): Points {
    let points = this.known.get(channel);
    if (points) return points;
    const { level, count } = this.rows;
    const lists = level === 1 ? 1 : 3;
    const at = count * (1 + lists * this.places.get(channel)!);
    const list = (k: number) => Array.from(this.values.subarray(at + k * count, at + (k + 1) * count), (value) => (Number.isFinite(value) ? value : null));
    const first = list(0);
    points = level === 1 ? rowsOf(this.t, first) : { t: this.t, first, min: list(1), max: list(2), rows: level };
    this.known.set(channel, points);
    return points;
  }
}

function decodeFloats(base64: string): Float64Array {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return new Float64Array(bytes.buffer);
}
