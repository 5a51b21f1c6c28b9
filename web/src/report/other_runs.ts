// Comparison with other runs in a report: differences of each run, and the tensions of all. A difference is
// the other run minus this one, as in `taut compare RUN THIS`.
import type { Report } from "../protocol";
import { runName, signed, swatch, thisRunName } from "../runs";
import { el, number, SCROLLS } from "../util";
import { section } from "./page";

interface Extreme { value: number | null; time_s: number | null }
interface Statistics { mean: number | null }
interface Channel {
  name: string;
  rmse: number | null;
  max_error: Extreme;
  max_a: Extreme;
  max_b: Extreme;
  phases: Record<string, { a: Statistics; b: Statistics }>;
}
/** Result of `taut compare --json` for a run (a) and this one (b). */
interface Comparison {
  rows: number;
  from_s: number;
  to_s: number;
  unit_conflicts: string[];
  phases: { name: string; from_s: number; to_s: number }[];
  channels: Channel[];
}

const TENSION = /^cable\/(.*)\/tension_n$/;
const POSITION = /^body\/(.*)\/position_[xyz]_m$/;
const DIGITS = 4;

export function otherRunsSection(report: Report): HTMLElement[] {
  const comparisons = report.comparisons as Comparison[];
  if (comparisons.length === 0) return [];
  const phases = new Map(comparisons.flatMap(({ phases: all }) => all.map((phase) => [phase.name, phase] as const)));
  const tables = [
    tensionTable(report, "Largest tension, whole run", ({ max_a, max_b }) => [max_a.value, max_b.value]),
    ...[...phases.values()].map(({ name, from_s, to_s }) => tensionTable(report, `Mean tension, ${name} (${from_s}–${to_s} s)`,
      ({ phases: of }) => [of[name]?.a.mean ?? null, of[name]?.b.mean ?? null])),
  ];
  return [section("Comparison with other runs", el("p", {}, "Differences: other run minus this run."), apartTable(report), ...tables.flat())];
}

/** Returns a table with one row per run: its differences from this one. */
function apartTable(report: Report): HTMLElement {
  const head = el("tr", {}, ...["run", "time range", "largest tension difference", "RMSE of that cable", "largest position difference"].map((text) => el("th", { scope: "col" }, text)));
  const rows = (report.comparisons as Comparison[]).map((comparison, k) => {
    const name = el("th", { scope: "row" }, swatch(k + 1), runName(report.scene.compared[k]!));
    if (comparison.rows === 0) return el("tr", {}, name, el("td", { colspan: 4 }, "no common time range, or no common channels with the same unit"));
    const tension = farthest(comparison, TENSION);
    const position = farthest(comparison, POSITION);
    return el("tr", {}, name, ...[
      `${number(comparison.from_s, DIGITS)}–${number(comparison.to_s, DIGITS)} s, ${comparison.rows} rows`,
      where(tension, TENSION, "N"), tension?.rmse === null || !tension ? "–" : `${number(tension.rmse, DIGITS)} N`, where(position, POSITION, "m"),
    ].map((text) => el("td", {}, text)));
  });
  return el("div.scroll", SCROLLS, el("table.numbers.apart", {}, el("thead", {}, head), el("tbody", {}, ...rows)));
}

/** Returns the channel with the largest difference among those whose names match. */
function farthest({ channels }: Comparison, names: RegExp): Channel | undefined {
  const size = ({ max_error }: Channel) => Math.abs(max_error.value ?? 0);
  return channels.filter(({ name, max_error }) => names.test(name) && max_error.value !== null)
    .reduce<Channel | undefined>((most, each) => (most === undefined || size(each) > size(most) ? each : most), undefined);
}

function where(channel: Channel | undefined, names: RegExp, unit: string): string {
  if (!channel) return "–";
  const { value, time_s } = channel.max_error;
  if (value === 0) return `0 ${unit}`;
  const of = names === TENSION ? names.exec(channel.name)![1]! : channel.name.split("/").slice(1).join(" ").replace(/_m$/, "").replace(/ position_/, " ");
  return `${signed(number(value ?? NaN, DIGITS))} ${unit}, ${of}, at ${number(time_s ?? NaN, DIGITS)} s`;
}

/** Returns a table with one row per cable: this run, then each other run and its difference. */
function tensionTable(report: Report, title: string, pick: (channel: Channel) => [number | null, number | null]): HTMLElement[] {
  const comparisons = report.comparisons as Comparison[];
  const cables = [...new Set(comparisons.flatMap(({ channels }) => channels.flatMap(({ name }) => TENSION.exec(name)?.[1] ?? [])))];
  const picked = comparisons.map(({ channels }) => new Map(cables.map((cable) => {
    const found = channels.find(({ name }) => name === `cable/${cable}/tension_n`);
    return [cable, found ? pick(found) : ([null, null] as const)];
  })));
  // a phase that no run reached
  if (!picked.some((of) => [...of.values()].some(([a, b]) => a !== null || b !== null))) return [];
  const names = report.scene.compared.map(runName);
  const head = el("thead", {},
    el("tr", {}, el("th", { scope: "col", rowspan: 2 }, "cable"), el("th", { scope: "col", rowspan: 2 }, swatch(0), thisRunName(report.scene)),
      ...names.map((name, k) => el("th.wide", { scope: "colgroup", colspan: 2 }, swatch(k + 1), name))),
    el("tr", {}, ...names.flatMap(() => [el("th", { scope: "col" }, "N"), el("th", { scope: "col" }, "difference")])));
  const rows = cables.map((cable) => {
    const pairs = picked.map((of) => of.get(cable)!);
    const own_n = pairs.find(([, b]) => b !== null)?.[1] ?? NaN;
    return el("tr", {}, el("th", { scope: "row" }, cable), el("td", {}, number(own_n, DIGITS)),
      ...pairs.flatMap(([a, b]) => [number(a ?? NaN, DIGITS), a === null || b === null ? "–" : signed(number(a - b, DIGITS))].map((text) => el("td", {}, text))));
  });
  return [el("h3", {}, title), el("div.scroll", SCROLLS, el("table.numbers", {}, head, el("tbody", {}, ...rows)))];
}
