// Comparison with reference values that the experiment lists.
import type { Report } from "../protocol";
import { el, number, SCROLLS } from "../util";
import { section } from "./page";

interface Reference {
  source: string;
  quantity: string;
  statistic: string;
  phase: string | null;
  cables: { name: string; reference_n: number; ours_n: number | null }[];
}

/** Returns a table for each source: one row per cable, three columns for each quantity of the source. */
export function referenceSection(report: Report): HTMLElement[] {
  const references = (report.summary as { references?: Reference[] } | null)?.references ?? [];
  const sources = [...new Set(references.map(({ source }) => source))];
  if (sources.length === 0) return [];
  return [section("Comparison with references", ...sources.flatMap((source) => [
    el("h3", {}, `This run and ${source}`),
    el("div.scroll", SCROLLS, sourceTable(references.filter((each) => each.source === source))),
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
