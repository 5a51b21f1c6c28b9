// summary.json as a table: the run as a whole, then the tension of each cable in each phase.
import type { Report } from "../protocol";
import { el, nameAndUnit, number } from "../util";
import { facts, section } from "./page";

interface Span { mean_n: number; min_n: number; max_n: number }
interface Force { max_n: number; max_after_start_n?: number; phases?: Record<string, Span> }
interface CableSummary { name: string; tension?: Force; actuator?: { max_power_w?: number; energy_j?: number; net_energy_j?: number; max_speed_m_per_s?: number } }
/** What says nothing that the rest does not say in words. */
const FOR_PROGRAMS = new Set(["format_version", "status_bits"]);
interface Summary extends Record<string, unknown> { cables?: CableSummary[]; phases?: { name: string; from_s: number; to_s: number }[] }

export function summarySection(report: Report): HTMLElement[] {
  const summary = report.summary as Summary | null;
  if (!summary || typeof summary !== "object") return [];
  const whole = Object.entries(summary).filter(([name, value]) => !FOR_PROGRAMS.has(name) && ["string", "number", "boolean"].includes(typeof value));
  const rows = whole.map(([name, value]) => {
    const [label, unit] = nameAndUnit(name);
    return [label, typeof value === "number" ? `${number(value, 5)} ${unit}` : String(value)] as const;
  });
  return [section("Summary", facts(rows), ...cableTable(summary))];
}

function cableTable({ cables = [], phases = [] }: Summary): HTMLElement[] {
  if (cables.length === 0) return [];
  const head = el("tr", {}, ...["cable", "largest", "after the start", ...phases.map(({ name, from_s, to_s }) => `${name} (${from_s}–${to_s} s)`), "largest power", "energy", "net"]
    .map((text) => el("th", { scope: "col" }, text)));
  const units = el("tr.units", {}, ...["", "N", "N", ...phases.map(() => "mean N"), "W", "J", "J"].map((text) => el("td", {}, text)));
  const rows = cables.map(({ name, tension, actuator }) => el("tr", {}, el("th", { scope: "row" }, name),
    ...[tension?.max_n, tension?.max_after_start_n, ...phases.map((phase) => tension?.phases?.[phase.name]?.mean_n), actuator?.max_power_w, actuator?.energy_j, actuator?.net_energy_j]
      .map((value) => el("td", {}, number(value ?? NaN, 4)))));
  return [el("h3", {}, "Tensions"), el("div.scroll", {}, el("table.numbers", {}, el("thead", {}, head, units), el("tbody", {}, ...rows)))];
}
