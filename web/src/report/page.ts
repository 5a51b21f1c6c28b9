// The report of a run: what was run, what came out, the plots and a replay, in one page that scrolls.
import type { PlotPanel } from "../plots/panel";
import type { Report } from "../protocol";
import type { View } from "../scene/view";
import { el, nameAndUnit } from "../util";
import { comparisonSection, referenceSection } from "./comparison";
import { summarySection } from "./summary";

interface Parts {
  top: HTMLElement;
  view: View;
  plots: PlotPanel;
  timeline: HTMLElement;
  overlays: HTMLElement[];
}

export function reportPage(root: HTMLElement, report: Report, { top, view, plots, timeline, overlays }: Parts): void {
  document.body.classList.add("report");
  root.append(top, el("main.report", {},
    section("Replay", el("div.replay", {}, view.element, timeline)),
    ...summarySection(report),
    ...referenceSection(report),
    ...comparisonSection(report),
    section("Plots", plots.element),
    section("What was run", facts(Object.entries(report.metadata).map(([name, value]) => [nameAndUnit(name)[0], `${value} ${nameAndUnit(name)[1]}`] as const)), inputs(report.inputs)),
  ), ...overlays);
}

export function section(title: string, ...content: HTMLElement[]): HTMLElement {
  return el("section", {}, el("h2", {}, title), ...content);
}

/** Names and values, in two columns where there is room. */
export function facts(rows: readonly (readonly [string, string])[]): HTMLElement {
  return el("dl.facts", {}, ...rows.map(([name, value]) => el("div", {}, el("dt", {}, name), el("dd", {}, value))));
}

function inputs(text: string): HTMLElement {
  if (text === "") return el("p", {}, "The trace does not hold the inputs.");
  return el("details", {}, el("summary", {}, "Inputs as resolved (YAML): run them again with `taut run`"), el("pre.inputs", {}, text));
}
