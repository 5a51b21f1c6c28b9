// summary.json as text and table: end of the run, then the tension of each cable in each phase.
import type { Report } from "../protocol";
import { el, nameAndUnit, number, SCROLLS } from "../util";
import { facts, section } from "./page";

interface Span { mean_n: number; min_n: number; max_n: number }
interface Force { max_n: number; max_after_start_n?: number; phases?: Record<string, Span> }
interface CableSummary { name: string; tension?: Force; actuator?: { max_power_w?: number; energy_j?: number; net_energy_j?: number; max_speed_m_per_s?: number } }
interface Summary extends Record<string, unknown> { cables?: CableSummary[]; phases?: { name: string; from_s: number; to_s: number }[] }
/** Keys that are not remarks: the report shows them elsewhere, or only programs need them. */
const SAID = new Set(["format_version", "status_bits", "status", "interrupted", "simulated_s", "system_max_tension_n",
  "system_max_tension_cable", "contacts_left_out", "taut_version", "experiment", "run"]);

function summaryOf(report: Report): Summary | null {
  const summary = report.summary as Summary | null;
  return summary && typeof summary === "object" ? summary : null;
}

/** Describes the end of the run in a sentence; empty if unknown. */
export function verdict(report: Report): HTMLElement[] {
  const summary = summaryOf(report);
  if (!summary) return [el("p.verdict", {}, report.scene.notice ?? "The trace's folder contains no summary.")];
  const { status, interrupted, simulated_s, contacts_left_out } = summary;
  const bad = status !== "ok" || interrupted === true;
  const time = typeof simulated_s === "number" ? ` ${number(simulated_s, 5)} s` : "";
  const sentences = [bad
    ? `The run ${interrupted === true ? "was interrupted" : "ended"}${time && ` after${time}`}${status === "ok" ? "" : `: ${String(status)}`}.`
    : `The run is complete${time && `,${time}`}, without problems.`];
  if (typeof contacts_left_out === "number" && contacts_left_out > 0) sentences.push(`${number(contacts_left_out)} contacts did not fit into the trace.`);
  return [el(bad ? "p.verdict.bad" : "p.verdict", {}, sentences.join(" "))];
}

export function outcomeSection(report: Report): HTMLElement[] {
  const summary = summaryOf(report);
  if (!summary) return [];
  const { system_max_tension_n: most_n, system_max_tension_cable: cable } = summary;
  const largest = typeof most_n === "number" ? [facts([["largest tension", `${number(most_n, 5)} N${typeof cable === "string" ? ` in ${cable}` : ""}`]])] : [];
  return [section("Results", ...largest, ...cableTable(summary))];
}

/** Returns the remaining entries of the summary about the whole run. */
export function remarksOf(report: Report): [string, string][] {
  return Object.entries(summaryOf(report) ?? {})
    .filter(([name, value]) => !SAID.has(name) && ["string", "number", "boolean"].includes(typeof value))
    .map(([name, value]) => {
      const [label, unit] = nameAndUnit(name);
      return [label, typeof value === "number" ? `${number(value, 5)} ${unit}`.trim() : String(value)];
    });
}

function cableTable({ cables = [], phases = [] }: Summary): HTMLElement[] {
  if (cables.length === 0) return [];
  const head = el("tr", {}, ...["cable", "max", "max after the start", ...phases.map(({ name, from_s, to_s }) => `${name} (${from_s}–${to_s} s)`), "max power", "energy", "net energy"]
    .map((text) => el("th", { scope: "col" }, text)));
  const units = el("tr.units", {}, ...["", "N", "N", ...phases.map(() => "mean N"), "W", "J", "J"].map((text) => el("td", {}, text)));
  const rows = cables.map(({ name, tension, actuator }) => el("tr", {}, el("th", { scope: "row" }, name),
    ...[tension?.max_n, tension?.max_after_start_n, ...phases.map((phase) => tension?.phases?.[phase.name]?.mean_n), actuator?.max_power_w, actuator?.energy_j, actuator?.net_energy_j]
      .map((value) => el("td", {}, number(value ?? NaN, 4)))));
  return [el("h3", {}, "Tensions and motors"), el("div.scroll", SCROLLS, el("table.numbers", {}, el("thead", {}, head, units), el("tbody", {}, ...rows)))];
}
