// Legend of the tension plots; lists only existing lines.
import { palette } from "../colours";
import type { Theme } from "../app";
import { el } from "../util";
import { type Figure, ink, type Ink } from "./figure";

/** Returns the labels and inks of all lines of the figures, each once. */
export function linesOf(figures: readonly Figure[]): Map<string, Ink> {
  return new Map(figures.flatMap(({ lines }) => lines.map((line) => [line.label, line.ink] as const)));
}

export class Key {
  readonly element = el("span.key", { "aria-label": "lines" });

  show(figures: readonly Figure[], theme: Theme): void {
    this.element.replaceChildren(...[...linesOf(figures)].map(([label, which]) => {
      const dash = el("i");
      dash.style.background = ink(palette(theme), which);
      return el("span", {}, dash, label);
    }));
  }
}
