// The channels over time: what frames have shown so far, when live; what the trace holds, when not.
import type { App } from "./app";
import { cableState, type Frame } from "./frame";
import { VALUES } from "./layout";
import type { Scene, SeriesData } from "./protocol";
import { lastAtMost } from "./util";

const LIVE_CAPACITY = 36_000; // ten minutes of 60 frames a second
const ASK_AT_ONCE = 8; // questions on their way at the same time

/** Points of one channel; min and max differ from mean where a point stands for several rows. */
export interface Points {
  t: number[];
  mean: (number | null)[];
  min: (number | null)[];
  max: (number | null)[];
}

export const NOTHING: Points = { t: [], mean: [], min: [], max: [] };

type Receiver = (points: Points) => void;

interface Question {
  channel: string;
  source: number;
  t0: number;
  t1: number;
  points: number;
  receive: Receiver;
}

/** An answer about the time before the page came. */
interface Past {
  t0: number;
  t1: number;
  coarse: boolean;
  points: Points;
}

export class SeriesStore {
  private readonly history = new Map<string, Points>();
  private readonly past = new Map<string, Past>();
  private run = -1;
  private last_s = -Infinity;
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
      this.ask();
    });
    // A live scene comes anew whenever a slider moves; which run it is, frames say.
    app.scene.watch(() => app.live || this.forget());
    app.link.watch((link) => link === "lost" && this.forget());
  }

  /** Names of the channels of the run (source 0) or of what it is compared with (1). */
  has(channel: string, source: number): boolean {
    const { report } = this.app;
    const scene = this.app.scene.value;
    if (!scene) return false;
    if (report) return bodyPosition(channel, scene) !== null || report.series.some((each) => each.channel === channel && each.source === source);
    if (source === 1) return scene.reference?.channels.some((each) => each.name === channel) ?? false;
    return scene.channels.some((each) => each.name === channel);
  }

  want(channel: string, source: number, t0: number, t1: number, points: number, receive: Receiver): void {
    if (this.app.live && source === 0) {
      const own = this.history.get(channel) ?? NOTHING;
      const first_s = own.t[0] ?? Infinity;
      const seen = thinned(own, t0, t1, points);
      receive(t0 < first_s ? joined(this.before(channel, t0, Math.min(t1, first_s), points), seen) : seen);
      return;
    }
    this.put({ channel, source, t0, t1, points, receive });
  }

  private put(question: Question): void {
    this.waiting.push({ ...question, points: Math.round(Math.min(Math.max(question.points, 2), 10_000)) });
    this.ask();
  }

  /** What a live run showed before this page came, as far as the server has answered. */
  private before(channel: string, t0: number, t1: number, points: number): Points {
    const kept = this.past.get(channel);
    const covers = kept !== undefined && kept.t0 <= t0 && kept.t1 >= t1;
    if (!covers || (kept.coarse && kept.t1 - kept.t0 > 3 * (t1 - t0))) {
      // kept until the answer is there, so that the plot does not blink; not asked for twice
      const asked: Past = { t0, t1, coarse: false, points: kept?.points ?? NOTHING };
      this.past.set(channel, asked);
      this.put({ channel, source: 0, t0, t1, points, receive: (received) => {
        asked.points = received;
        asked.coarse = received.t.length > points / 3;
      } });
    }
    const { points: found } = this.past.get(channel)!;
    const from = Math.max(0, lastAtMost(found.t, t0));
    let to = lastAtMost(found.t, t1) + 1;
    if (to > 0 && found.t[to - 1]! >= t1) --to; // the page has that one itself
    return { t: found.t.slice(from, to), mean: found.mean.slice(from, to), min: found.min.slice(from, to), max: found.max.slice(from, to) };
  }

  private ask(): void {
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
    this.last_s = -Infinity;
  }

  private record(frame: Frame): void {
    const scene = this.app.scene.value;
    // a look back is no news, and what the scene says is not yet the run
    if (!scene || frame.time_s < frame.now_s || frame.run < 0) return;
    if (frame.run !== this.run || frame.time_s < this.last_s) {
      this.run = frame.run;
      this.forget();
    }
    // while paused, and at the start, the latest word about a time is the right one
    const again = frame.time_s === this.last_s;
    this.last_s = frame.time_s;
    const add = (channel: string, value: number) => {
      let points = this.history.get(channel);
      if (!points) this.history.set(channel, (points = { t: [], mean: [], min: [], max: [] }));
      if (again && points.t.length > 0) {
        points.t.pop();
        points.mean.pop();
      }
      points.t.push(frame.time_s);
      points.mean.push(Number.isFinite(value) ? value : null);
      if (points.t.length > 1.2 * LIVE_CAPACITY) {
        points.t.splice(0, points.t.length - LIVE_CAPACITY);
        points.mean.splice(0, points.mean.length - LIVE_CAPACITY);
      }
    };
    for (const [channel, value] of frameValues(scene, frame)) add(channel, value);
  }
}

/** What a frame says, by channel. */
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
  yield ["system/kinetic_j", frame.kinetic_j];
  yield ["system/gravity_j", frame.gravity_j];
  yield ["system/elastic_j", frame.elastic_j];
  yield ["system/contact_count", frame.contact_count];
  yield ["real_time_factor", frame.real_time_factor];
}

/** Place of a body and axis of "body/<name>/position_<axis>_m"; null if the channel is another. */
export function bodyPosition(channel: string, scene: Scene): { body: number; axis: number } | null {
  const [, name, axis] = /^body\/(.*)\/position_([xyz])_m$/.exec(channel) ?? [];
  const body = scene.bodies.findIndex((each) => each.name === name);
  return axis === undefined || body < 0 ? null : { body, axis: "xyz".indexOf(axis) };
}

function pointsOf(series: SeriesData): Points {
  return { t: series.time_s.map((value) => value ?? NaN), mean: series.mean, min: series.min, max: series.max };
}

/** At most so many points between two times: least, greatest and mean of equal blocks of rows. */
export function thinned(all: Points, t0: number, t1: number, points: number): Points {
  const from = Math.max(0, lastAtMost(all.t, t0));
  const to = Math.min(all.t.length, lastAtMost(all.t, t1) + 2);
  const block = Math.max(1, Math.ceil((to - from) / points));
  if (block === 1) {
    const mean = all.mean.slice(from, to);
    return { t: all.t.slice(from, to), mean, min: mean, max: mean };
  }
  const thin: Points = { t: [], mean: [], min: [], max: [] };
  // blocks begin at multiples of their size, so that a picture that moves does not flicker
  for (let start = from - (from % block); start < to; start += block) {
    let [least, greatest, sum, count] = [Infinity, -Infinity, 0, 0];
    for (let i = Math.max(start, 0); i < Math.min(start + block, all.t.length); ++i) {
      const value = all.mean[i];
      if (value === null || value === undefined) continue;
      least = Math.min(least, value);
      greatest = Math.max(greatest, value);
      sum += value;
      ++count;
    }
    thin.t.push(all.t[start]!);
    thin.mean.push(count ? sum / count : null);
    thin.min.push(count ? least : null);
    thin.max.push(count ? greatest : null);
  }
  return thin;
}

function joined(first: Points, then: Points): Points {
  if (first.t.length === 0) return then;
  return { t: first.t.concat(then.t), mean: first.mean.concat(then.mean), min: first.min.concat(then.min), max: first.max.concat(then.max) };
}
