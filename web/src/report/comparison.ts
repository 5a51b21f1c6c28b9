// Our numbers beside others: the values that an experiment names, and `taut compare`.
import type { Report } from "../protocol";
import { el, number } from "../util";
import { facts, section } from "./page";
import { labelled } from "./summary";

export function referenceSection(report: Report): HTMLElement[] {
  const reference = report.scene.reference;
  if (!reference || reference.values.length === 0) return [];
  const rows = reference.values.map(({ quantity, value, unit, source }) => {
    const ours = ourValue(report.summary, quantity);
    const off = Number.isFinite(ours) && value !== 0 ? `${number((100 * (ours - value)) / value, 3)} %` : "–";
    return el("tr", {}, el("th", { scope: "row" }, labelled(quantity)[0]),
      ...[`${number(value, 4)} ${unit}`, `${number(ours, 4)} ${unit}`, off, source].map((text) => el("td", {}, text)));
  });
  const head = el("tr", {}, ...["quantity", reference.name, "this run", "difference", "source"].map((text) => el("th", { scope: "col" }, text)));
  return [section("Beside the reference", el("div.scroll", {}, el("table.numbers", {}, el("thead", {}, head), el("tbody", {}, ...rows))))];
}

/** A key of summary.json, or a cable: its largest tension. */
function ourValue(summary: unknown, quantity: string): number {
  const known = summary as (Record<string, unknown> & { cables?: { name: string; tension?: { max_n?: number } }[] }) | null;
  const value = known?.[quantity] ?? known?.cables?.find(({ name }) => name === quantity)?.tension?.max_n;
  return typeof value === "number" ? value : NaN;
}

/** Whatever numbers the comparison holds, as tables: lists of records become rows. */
export function comparisonSection(report: Report): HTMLElement[] {
  const comparison = report.comparison;
  if (!comparison || typeof comparison !== "object") return [];
  const parts: HTMLElement[] = [];
  const plain = Object.entries(comparison).filter(([, value]) => value === null || typeof value !== "object");
  if (plain.length > 0) {
    parts.push(facts(plain.map(([name, value]) => [labelled(name)[0], text(value, labelled(name)[1])] as const)));
  }
  for (const [name, value] of Object.entries(comparison)) {
    if (!Array.isArray(value) || value.length === 0 || typeof value[0] !== "object") continue;
    const columns = Object.keys(value[0] as object).filter((key) => typeof (value[0] as Record<string, unknown>)[key] !== "object");
    const head = el("tr", {}, ...columns.map((key) => el("th", { scope: "col" }, [labelled(key)[0], labelled(key)[1] && `[${labelled(key)[1]}]`].join(" "))));
    const rows = (value as Record<string, unknown>[]).map((row) => el("tr", {}, ...columns.map((key) => el("td", {}, text(row[key], "")))));
    parts.push(el("h3", {}, name.replace(/_/g, " ")), el("div.scroll", {}, el("table.numbers", {}, el("thead", {}, head), el("tbody", {}, ...rows))));
  }
  return parts.length > 0 ? [section("Comparison", ...parts)] : [];
}

function text(value: unknown, unit: string): string {
  if (typeof value === "number") return `${number(value, 4)} ${unit}`.trim();
  return value === null || value === undefined ? "–" : String(value);
}
