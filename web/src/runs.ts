// Names and colors of compared runs, common to plots, lists and the 3D view. Run 0 is the displayed run; run
// k is compared with it.
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

/** Sets the colors as style properties --run-0, --run-1 ... */
export function giveRunColours(theme: Theme): void {
  const { style } = document.documentElement;
  for (let run = 0; run <= palette(theme).runs.length; ++run) style.setProperty(`--run-${run}`, runColourIn(theme, run));
}

/** Returns the color mark of a run, for use next to its name. */
export function swatch(run: number): HTMLElement {
  const dot = el("i.swatch", { "data-run": run });
  dot.style.background = `var(--run-${run})`;
  return dot;
}

/** Returns the name of a compared run; the word "measured" appears only if its metadata mark it as measured. */
export function runName(run: ComparedRun): string {
  return run.measured ? `measured: ${run.name}` : run.name;
}

/** Returns "this run: push_20n (a/trace.h5)"; without compared runs only the first part. */
export function thisRunName(scene: Scene): string {
  return scene.run_name === undefined ? THIS_RUN : `${THIS_RUN}: ${scene.run_name}`;
}

/** Formats a signed number: a difference of two runs. */
export function signed(text: string): string {
  return text.startsWith("−") || /^[0.]*$/.test(text) || text === "–" ? text : `+${text}`;
}
