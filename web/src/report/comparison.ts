// Our numbers beside others: the references that an experiment names, and `taut compare`.
import type { Report } from "../protocol";
import { el, nameAndUnit, number } from "../util";
import { facts, section } from "./page";

interface Reference {
  source: string;
  quantity: string;
  statistic: string;
  phase: string | null;
  cables: { name: string; reference_n: number; ours_n: number | null }[];
}

/** A table for each source: a row a cable, three columns for each thing that the source says. */
export function referenceSection(report: Report): HTMLElement[] {
  const references = (report.summary as { references?: Reference[] } | null)?.references ?? [];
  const sources = [...new Set(references.map(({ source }) => source))];
  if (sources.length === 0) return [];
  return [section("Beside the references", ...sources.flatMap((source) => [
    el("h3", {}, `This run and ${source}`),
    el("div.scroll", {}, sourceTable(references.filter((each) => each.source === source))),
  ]))];
}

function sourceTable(references: Reference[]): HTMLElement {
  const names = [...new Set(references.flatMap(({ cables }) => cables.map(({ name }) => name)))];
  const titles = references.map(({ quantity, statistic, phase }) => `${statistic} ${quantity}, ${phase ?? "whole run"} [N]`);
  const head = el("thead", {},
    el("tr", {}, el("th", { scope: "col", rowspan: 2 }, "cable"), ...titles.map((title) => el("th.wide", { scope: "colgroup", colspan: 3 }, title))),
    el("tr", {}, ...references.flatMap(({ source }) => [source, "this run", "difference"].map((text) => el("th", { scope: "col" }, text)))));
  const rows = names.map((name) => el("tr", {}, el("th", { scope: "row" }, name), ...references.flatMap(({ cables }) => {
    const found = cables.find((cable) => cable.name === name);
    const ours_n = found?.ours_n ?? NaN;
    const theirs_n = found?.reference_n ?? NaN;
    const percent = (100 * (ours_n - theirs_n)) / theirs_n;
    const off = Number.isFinite(percent) ? `${percent < 0 ? "−" : "+"}${Math.abs(percent).toFixed(1)} %` : "–";
    return [number(theirs_n, 4), number(ours_n, 4), off].map((text) => el("td", {}, text));
  })));
  return el("table.numbers", {}, head, el("tbody", {}, ...rows));
}

/** Whatever numbers the comparison holds, as tables: lists of records become rows. */
export function comparisonSection(report: Report): HTMLElement[] {
  const comparison = report.comparison;
  if (!comparison || typeof comparison !== "object") return [];
  const parts: HTMLElement[] = [];
  const plain = Object.entries(comparison).filter(([, value]) => value === null || typeof value !== "object");
  if (plain.length > 0) {
    parts.push(facts(plain.map(([name, value]) => [nameAndUnit(name)[0], text(value, nameAndUnit(name)[1])] as const)));
  }
  for (const [name, value] of Object.entries(comparison)) {
    if (!Array.isArray(value) || value.length === 0 || typeof value[0] !== "object") continue;
    const columns = Object.keys(value[0] as object).filter((key) => typeof (value[0] as Record<string, unknown>)[key] !== "object");
    const head = el("tr", {}, ...columns.map((key) => el("th", { scope: "col" }, [nameAndUnit(key)[0], nameAndUnit(key)[1] && `[${nameAndUnit(key)[1]}]`].join(" "))));
    const rows = (value as Record<string, unknown>[]).map((row) => el("tr", {}, ...columns.map((key) => el("td", {}, text(row[key], "")))));
    parts.push(el("h3", {}, name.replace(/_/g, " ")), el("div.scroll", {}, el("table.numbers", {}, el("thead", {}, head), el("tbody", {}, ...rows))));
  }
  return parts.length > 0 ? [section(`This run (a) and ${report.scene.reference?.name ?? "another"} (b)`, ...parts)] : [];
}

function text(value: unknown, unit: string): string {
  if (typeof value === "number") return `${number(value, 4)} ${unit}`.trim();
  return value === null || value === undefined ? "–" : String(value);
}
