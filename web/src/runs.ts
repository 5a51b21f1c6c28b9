// The runs that are shown beside each other: what each is called, and its colour, which is the same in
// plots, in lists and in the 3-D view. Run 0 is the one that is shown; the k-th is compared with it.
import { type Palette, palette } from "./colours";
import type { Theme } from "./app";
import type { ComparedRun, Scene } from "./protocol";
import { el } from "./util";

export const THIS_RUN = "this run";

export function runColour(colours: Palette, run: number): string {
  return run === 0 ? colours.own : colours.runs[(run - 1) % colours.runs.length]!;
}

export function runColourIn(theme: Theme, run: number): string {
  return runColour(palette(theme), run);
}

/** The page's styles know the colours, too, as --run-0 and on. */
export function giveRunColours(theme: Theme): void {
  const { style } = document.documentElement;
  for (let run = 0; run <= palette(theme).runs.length; ++run) style.setProperty(`--run-${run}`, runColourIn(theme, run));
}

/** The colour of a run, beside its name. */
export function swatch(run: number): HTMLElement {
  const dot = el("i.swatch", { "data-run": run });
  dot.style.background = `var(--run-${run})`;
  return dot;
}

/** What a compared run is called; only what says of itself that it was measured is called that. */
export function runName(run: ComparedRun): string {
  return run.measured ? `measured: ${run.name}` : run.name;
}

/** "this run: push_20n (a/trace.h5)"; of a run that is compared with none only the first. */
export function thisRunName(scene: Scene): string {
  return scene.run_name === undefined ? THIS_RUN : `${THIS_RUN}: ${scene.run_name}`;
}

/** A signed number: a difference of two runs. */
export function signed(text: string): string {
  return text.startsWith("−") || /^[0.]*$/.test(text) || text === "–" ? text : `+${text}`;
}
