// Differences between runs, below the values of a plot: each compared run minus this one, of the same
// channel, at the time under the cursor.
import { palette } from "../colours";
import type { Theme } from "../app";
import type { Row } from "../rows";
import { signed } from "../runs";
import { el, number } from "../util";
import { type Figure, ink, type Line } from "./figure";

const DIGITS = 3;

export class Differences {
  readonly element = el("div.differences", { title: "each run minus this run" });
  private readonly lines: readonly Line[];

  constructor(private readonly figure: Figure) {
    this.lines = figure.lines;
    this.element.hidden = this.pairs().length === 0;
  }

  /** `rows`: of the figure's lines, in their order; null: pending. */
  show(rows: readonly (Row | null)[], theme: Theme): void {
    if (this.element.hidden) return;
    const texts = this.pairs().map(([of, own]) => {
      const [a, b] = [rows[of], rows[own]];
      const shown = el("span", {}, a && b ? signed(number(a.value - b.value, DIGITS)) : "…");
      shown.style.color = ink(palette(theme), this.lines[of]!.ink);
      if (a && b && !Number.isNaN(a.time_s)) shown.title = `${this.lines[of]!.label} minus this run: ${a.value - b.value} ${this.figure.unit}; rows at ${a.time_s} s and ${b.time_s} s`;
      return shown;
    });
    this.element.replaceChildren("Δ ", ...texts.flatMap((text) => [text, " "]), this.figure.unit);
  }

  /** Pairs of line indices of a compared run and of this run, of the same channel. */
  private pairs(): [number, number][] {
    return this.lines.flatMap(({ source, channel }, of): [number, number][] => {
      const own = this.lines.findIndex((line) => line.source === 0 && line.channel === channel);
      return source > 0 && own >= 0 ? [[of, own]] : [];
    });
  }
}
