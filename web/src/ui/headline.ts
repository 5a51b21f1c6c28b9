// Headline numbers of a run: peak tension, distance, net speed, energy, status, buckling safety. Computed from the rows, so
// that a report, a replay and a live run show the same; energy of motors, status and limits from the summary.
import type { App } from "../app";
import { TENSION } from "../plots/figure";
import type { Points } from "../points";
import type { Scene } from "../protocol";
import type { SeriesStore } from "../series";
import { el, number } from "../util";
import { largestUse, type StrutUse } from "../report/limits";

const POINTS = 600;
const FINE = 10_000;
const LIVE_EVERY_MS = 1000;
const DIGITS = 3;
const SAME = 1e-6; // relative rounding of tensions in traces

export interface RunSummary {
  system_max_tension_n?: number;
  system_max_tension_cable?: string;
  status?: string;
  interrupted?: boolean;
  cables?: { actuator?: { energy_j?: number } }[];
  struts?: StrutUse[];
  overloads?: unknown[];
}

/** One number: label, value, detail. */
type Card = { label: string; value: string; detail: string; bad?: boolean; good?: boolean };

export function headline(app: App, store: SeriesStore): HTMLElement {
  const element = el("dl.headline", { "aria-label": "headline numbers", hidden: true });
  const cards = new Map<string, Card>();
  let due = 0;
  const show = (card: Card | null, key: string) => {
    if (card) cards.set(key, card);
    else cards.delete(key);
    const order = ["peak", "distance", "speed", "energy", "status", "safety"];
    element.replaceChildren(...order.flatMap((each) => cards.get(each) ?? []).map(({ label, value, detail, bad, good }) =>
      el(bad ? "div.bad" : good ? "div.good" : "div", {}, el("dt", {}, label), el("dd", {}, el("b", {}, value), ...(detail === "" ? [] : [" ", el("span", {}, detail)])))));
    element.hidden = cards.size === 0;
  };
  const compute = (scene: Scene, to_s: number) => {
    const current = () => app.scene.value === scene;
    motionOf(store, scene, to_s, (distance, speed) => {
      if (!current()) return;
      show(distance, "distance");
      show(speed, "speed");
    });
    const summary = (app.report?.summary ?? scene.summary ?? null) as RunSummary | null;
    peakOf(store, scene, to_s, summary, (peak) => current() && show(peak, "peak"));
    energyOf(store, scene, to_s, summary, (energy) => current() && show(energy, "energy"));
    show(statusOf(app, summary), "status");
    show(safetyOf(scene, summary), "safety");
  };
  const wanted = (scene: Scene | null): scene is Scene => scene !== null && scene.shape === undefined && app.hello.value !== null && (app.replay || app.report !== null || app.hello.value.mode === "live");
  app.scene.watch((scene) => {
    cards.clear();
    element.hidden = true;
    if (wanted(scene) && !app.live) compute(scene, scene.duration_s);
  });
  app.frame.watch((frame) => {
    const { value: scene } = app.scene;
    if (!frame || !wanted(scene) || !app.live || performance.now() < due) return;
    due = performance.now() + LIVE_EVERY_MS;
    compute(scene, frame.now_s);
  });
  return element;
}

/** Returns the largest known value; -Infinity: there is none. */
const largest = (values: readonly (number | null)[]) => values.reduce<number>((most, value) => (value !== null && value > most ? value : most), -Infinity);

/**
 * Finds the largest tension of all cables: first in blocks of rows, then in the rows of the largest block. The
 * summary contains the largest tension of all steps, which may lie between two rows.
 */
function peakOf(store: SeriesStore, scene: Scene, to_s: number, summary: RunSummary | null, done: (card: Card) => void): void {
  const { system_max_tension_n: most_n, system_max_tension_cable: most } = summary ?? {};
  const known = most_n !== undefined && most !== undefined ? { most_n, channel: `cable/${most}/tension_n` } : null;
  const channels = scene.channels.map(({ name }) => name).filter((name) => (known ? name === known.channel : TENSION.test(name)));
  let missing = channels.length;
  let peak_n = -Infinity;
  let block: { channel: string; from_s: number; to_s: number } | null = null;
  const say = (at_s: number) => {
    const isRow = !known || known.most_n <= peak_n * (1 + SAME);
    done({ label: "peak tension", value: `${number(known?.most_n ?? peak_n, DIGITS)} N`, detail: `${TENSION.exec(block!.channel)![1]} ${isRow ? "at" : "near"} ${number(at_s, DIGITS)} s` });
  };
  for (const channel of channels) {
    store.want(channel, 0, scene.first_s, to_s, POINTS, (points) => {
      const greatest_n = largest(points.max);
      if (greatest_n > peak_n) {
        const i = points.max.indexOf(greatest_n);
        peak_n = greatest_n;
        block = { channel, from_s: points.t[i]!, to_s: points.t[i + 1] ?? to_s };
      }
      if (--missing > 0 || !block) return;
      const { from_s } = block;
      store.want(block.channel, 0, block.from_s, block.to_s, FINE, (rows) => {
        const i = rows.max.indexOf(peak_n);
        say(i < 0 ? from_s : rows.t[i]!);
      });
    });
  }
}

/** Horizontal displacement of the center of mass, and this displacement divided by the time. */
function motionOf(store: SeriesStore, scene: Scene, to_s: number, done: (distance: Card, speed: Card) => void): void {
  const channels = ["x", "y"].map((axis) => `system/com_${axis}_m`);
  if (!channels.every((name) => store.has(name, 0))) return;
  const parts: Points[] = [];
  channels.forEach((channel, k) => store.want(channel, 0, scene.first_s, to_s, FINE, (points) => {
    parts[k] = points;
    const [x, y] = parts;
    if (!x || !y || x.first.length === 0 || x.first.length !== y.first.length) return;
    const last = x.first.length - 1;
    const [dx, dy] = [(x.first[last] ?? NaN) - (x.first[0] ?? NaN), (y.first[last] ?? NaN) - (y.first[0] ?? NaN)];
    const distance_m = Math.hypot(dx, dy);
    const span_s = x.t[last]! - x.t[0]!;
    const heading = distance_m > 0 ? `${number(Math.round((Math.atan2(dy, dx) * 180) / Math.PI))}° from x` : "";
    done({ label: "distance", value: `${number(distance_m, DIGITS)} m`, detail: heading },
      { label: "net speed", value: `${number(span_s > 0 ? distance_m / span_s : NaN, DIGITS)} m/s`, detail: `over ${number(span_s, DIGITS)} s` });
  }));
}

function energyOf(store: SeriesStore, scene: Scene, to_s: number, summary: RunSummary | null, done: (card: Card | null) => void): void {
  const motors_j = (summary?.cables ?? []).reduce((sum, { actuator }) => sum + (actuator?.energy_j ?? 0), 0);
  if (motors_j > 0) {
    done({ label: "motor energy", value: `${number(motors_j, DIGITS)} J`, detail: "" });
    return;
  }
  if (!store.has("system/kinetic_j", 0)) return;
  store.want("system/kinetic_j", 0, scene.first_s, to_s, POINTS, ({ max }) => {
    const most_j = largest(max);
    done(Number.isFinite(most_j) ? { label: "peak kinetic energy", value: `${number(most_j, DIGITS)} J`, detail: "" } : null);
  });
}

function statusOf(app: App, summary: RunSummary | null): Card | null {
  if (app.live) return null; // the bar below shows it
  if (!summary) return { label: "status", value: "unknown", detail: "no summary" };
  if (summary.interrupted) return { label: "status", value: "interrupted", detail: summary.status === "ok" ? "" : String(summary.status), bad: true };
  return summary.status === "ok" ? { label: "status", value: "complete", detail: "no problems", good: true } : { label: "status", value: "failed", detail: String(summary.status), bad: true };
}

function safetyOf(scene: Scene, summary: RunSummary | null): Card | null {
  if (!summary) return null;
  const over = summary.overloads?.length ?? 0;
  if (over > 0) return { label: "safety", value: `${over} overloaded`, detail: over === 1 ? "member" : "members", bad: true };
  const use = largestUse(scene, summary.struts ?? []);
  return use ? { label: "buckling safety", value: `${number(1 / use.share, DIGITS)} ×`, detail: `lowest: strut ${use.name}`, good: true }
    : { label: "buckling safety", value: "–", detail: "no Euler load known" };
}
