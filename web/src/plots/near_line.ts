// Lines of an overlay plot near the mouse: the nearest line is emphasized, and a box lists it with its neighbors.
import type uPlot from "uplot";
import { el, number } from "../util";

/** Maximum number of lines in the box. */
const MOST_LISTED = 7;
const REACH_PX = 40;
const WIDTH = { plain: 1.4, marked: 2.6 };
const FADED = 0.25;

export interface PlotLine {
  label: string;
  colour: string;
}

/** Returns the two series of a line, minimum and maximum; series 0 contains the times. */
export const seriesOf = (line: number): [number, number] => [2 * line + 1, 2 * line + 2];

export class NearLine {
  readonly element = el("div.near", { hidden: true, "aria-hidden": "true" });
  private marked = -1;

  constructor(private readonly lines: readonly PlotLine[], private readonly unit: string) {}

  /** Returns the line nearest to the cursor; -1: none is near. Updates the box. */
  find(plot: uPlot): number {
    const { left = -1, top = -1, idx } = plot.cursor;
    this.element.hidden = left < 0 || idx === null || idx === undefined;
    if (this.element.hidden) return -1;
    const there = this.lines.map(({ label, colour }, line) => {
      const [low, high] = seriesOf(line).map((k) => plot.data[k]?.[idx!] ?? NaN) as [number, number];
      const [bottom, up] = [plot.valToPos(low, "y"), plot.valToPos(high, "y")];
      return { line, label, colour, value: high, away_px: top > bottom ? top - bottom : top < up ? up - top : 0 };
    }).filter(({ value }) => Number.isFinite(value)).sort((a, b) => a.away_px - b.away_px);
    const near = there[0] && there[0].away_px < REACH_PX ? there[0].line : -1;
    const listed = there.slice(0, MOST_LISTED).sort((a, b) => b.value - a.value);
    this.element.replaceChildren(...listed.map(({ line, label, colour, value }) => {
      const swatch = el("i");
      swatch.style.background = colour;
      return el(line === near ? "div.marked" : "div", {}, swatch, el("span", {}, label), el("b", {}, `${number(value, 4)} ${this.unit}`));
    }));
    this.element.classList.toggle("left", left > plot.over.clientWidth / 2);
    return near;
  }

  /** Emphasizes a line; -1: none. */
  mark(plot: uPlot, marked: number): void {
    if (marked === this.marked) return;
    this.marked = marked;
    this.lines.forEach((_, line) => {
      for (const k of seriesOf(line)) {
        plot.series[k]!.alpha = marked < 0 || line === marked ? 1 : FADED;
        plot.series[k]!.width = line === marked ? WIDTH.marked : WIDTH.plain;
      }
    });
    plot.redraw(false);
  }
}
