// Report of a run, one scrolling page: description, picture, results, comparisons, plots; at the end the
// details needed to repeat the run.
import type { PlotPanel } from "../plots/panel";
import type { Report } from "../protocol";
import type { View } from "../scene/view";
import { el, nameAndUnit } from "../util";
import { referenceSection } from "./references";
import { otherRunsSection } from "./other_runs";
import { outcomeSection, remarksOf, verdict } from "./summary";

interface Parts {
  top: HTMLElement;
  numbers: HTMLElement;
  view: View;
  plots: PlotPanel;
  timeline: HTMLElement;
  overlays: HTMLElement[];
}

export function reportPage(root: HTMLElement, report: Report, { top, numbers, view, plots, timeline, overlays }: Parts): void {
  document.body.classList.add("report");
  root.append(top, el("main.report", {},
    numbers,
    whatWasRun(report),
    section("Replay", el("div.replay", {}, view.element, timeline)),
    ...outcomeSection(report),
    ...referenceSection(report),
    ...otherRunsSection(report),
    section("Plots", plots.element),
    forTheRecord(report),
  ), ...overlays);
}

export function section(title: string, ...content: HTMLElement[]): HTMLElement {
  return el("section", {}, el("h2", {}, title), ...content);
}

/** Formats names and values, in two columns if there is space. */
export function facts(rows: readonly (readonly [string, string])[]): HTMLElement {
  return el("dl.facts", {}, ...rows.map(([name, value]) => el("div", {}, el("dt", {}, name), el("dd", {}, value))));
}

function whatWasRun(report: Report): HTMLElement {
  const lead = report.description === "" ? [] : [el("p.lead", {}, report.description)];
  const known = Object.entries(report.facts);
  const what = known.length > 0 ? facts([["experiment", report.title], ...known]) : el("p", {}, "The trace's folder contains no inputs, so the experiment is unknown.");
  return section("Experiment", ...lead, what, ...verdict(report));
}

function forTheRecord(report: Report): HTMLElement {
  const metadata = Object.entries(report.metadata).map(([name, value]) => [nameAndUnit(name)[0], `${value} ${nameAndUnit(name)[1]}`] as const);
  return section("Reproducibility", facts([...metadata, ...remarksOf(report)]), inputs(report.inputs));
}

function inputs(text: string): HTMLElement {
  if (text === "") return el("p", {}, "The trace's folder contains no inputs.");
  return el("details", {}, el("summary", {}, "Resolved inputs (YAML), to run again with `taut run`"), el("pre.inputs", {}, text));
}
