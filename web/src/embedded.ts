// A report as a source: answers like a server that replays, out of the data inside the page.
import { decodeFrame, type Frame } from "./frame";
import { FRAME, VALUES } from "./layout";
import type { ClientMessage, Report, SeriesData, WantSeriesMessage } from "./protocol";
import { bodyPosition } from "./series";
import type { Listener, Source } from "./source";
import { lastAtMost } from "./util";

export class ReportSource implements Source {
  private readonly values: Float32Array;
  private readonly times_s: Float64Array;
  private listener: Listener | null = null;
  private time_s: number;
  private speed = 1;
  private paused = true;
  private last_ms: number | null = null;

  constructor(private readonly report: Report) {
    this.values = decodeFloats(report.frames_base64);
    if (this.values.length !== report.frame_count * report.frame_values) {
      throw new Error(`the report holds ${this.values.length} numbers of frames, not ${report.frame_count} times ${report.frame_values}`);
    }
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
    // half a frame on, so that rounding to float does not show the frame before
    const rounding_s = 1e-6 * Math.max(1, Math.abs(this.time_s));
    return this.clamp(lastAtMost(this.times_s, this.time_s + rounding_s));
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

  /** Where bodies are is in the frames only. */
  private position(channel: string): SeriesData | undefined {
    const found = bodyPosition(channel, this.report.scene);
    if (!found) return undefined;
    const { frame_values: size, frame_count: count } = this.report;
    const at = FRAME.header.length + found.body * VALUES.bodies + found.axis;
    const mean = Array.from({ length: count }, (_, i) => this.values[i * size + at]!);
    return { channel, source: 0, level: 1, time_s: [...this.times_s], min: mean, max: mean, mean };
  }

  private answer(question: WantSeriesMessage): void {
    const found = this.report.series.find(
      (series) => series.channel === question.channel && series.source === (question.source ?? 0),
    ) ?? this.position(question.channel);
    const reply = found === undefined ? { type: "error" as const, text: `the report has no ${question.channel}` }
      : { type: "series" as const, id: question.id, series: cut(found, question.t0, question.t1) };
    queueMicrotask(() => this.listener?.message(reply));
  }
}

/** The points between two times, and one more at either end so that a line reaches the border. */
function cut(series: SeriesData, t0: number, t1: number): SeriesData {
  const times = series.time_s as number[];
  const from = Math.max(0, lastAtMost(times, t0));
  const to = Math.min(times.length, lastAtMost(times, t1) + 2);
  return {
    ...series,
    time_s: series.time_s.slice(from, to),
    min: series.min.slice(from, to),
    max: series.max.slice(from, to),
    mean: series.mean.slice(from, to),
  };
}

function decodeFloats(base64: string): Float32Array {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return new Float32Array(bytes.buffer);
}
