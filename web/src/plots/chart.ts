// One plot on the screen (uPlot), with the values under the cursor.
import uPlot from "uplot";
import type { App } from "../app";
import { palette } from "../colours";
import { NOTHING, type Points } from "../points";
import type { SeriesStore } from "../series";
import { el, number, tickText } from "../util";
import { Differences } from "./differences";
import { coarseness, type Figure, type Filled, ink, isDashed, valueRange } from "./figure";

const SYNC = "taut";
const DIGITS = 4; // significant digits of a value beside a plot
const AWAY = 0.01; // relative to the window: a row farther from the displayed time is labeled with its time

export class Chart {
  readonly element: HTMLElement;
  filled: Filled;
  private plot: uPlot | null = null;
  /** Until then its span is meaningless. */
  private isFilled = false;
  private readonly place: HTMLElement;
  private readonly key = el("div.lines");
  private readonly values = el("span.values");
  private readonly differences: Differences;
  private readonly now = el("div.now");
  private readonly coarse = el("div.coarse");
  private shared: [number, number] | null = null;
  private span: readonly [number, number] = [0, 1];

  constructor(
    private readonly app: App,
    private readonly store: SeriesStore,
    readonly figure: Figure,
    tools: HTMLElement,
  ) {
    this.filled = { figure, data: figure.lines.map(() => NOTHING) };
    this.differences = new Differences(figure);
    this.place = el("div.canvas", { role: "img", "aria-label": `${figure.title} over time` });
    this.key.hidden = figure.group === "tension" || figure.lines.length < 2;
    this.element = el("figure.chart", { "data-figure": figure.id, "aria-label": figure.title },
      el("figcaption", {}, el("span.name", { title: figure.title }, figure.title), this.values, tools), this.differences.element, this.key, this.place);
    this.showKey();
    new ResizeObserver(() => this.resize()).observe(this.place);
  }

  get range(): [number, number] {
    return valueRange([this.filled]);
  }

  /** Displays points between two times; `shared`: common range of values of several plots, if any. */
  show(filled: Filled, span: readonly [number, number], shared: [number, number] | null): void {
    this.isFilled = true;
    this.draw(filled, span, shared);
  }

  private draw(filled: Filled, span: readonly [number, number], shared: [number, number] | null): void {
    this.filled = filled;
    this.shared = shared;
    this.span = span;
    this.coarse.textContent = coarseness(filled.data);
    if (this.place.clientWidth === 0) return;
    const data = aligned(filled.data);
    if (this.plot) this.plot.setData(data);
    else this.plot = this.make(data);
    this.mark();
  }

  /** Updates the line at the present time, and the values of the row under the cursor or at that time. */
  mark(): void {
    const plot = this.plot;
    const frame = this.app.frame.value;
    if (!plot || !frame) return;
    const inside = frame.time_s >= this.span[0] && frame.time_s <= this.span[1];
    this.now.hidden = !inside;
    if (inside) this.now.style.transform = `translateX(${plot.valToPos(frame.time_s, "x")}px)`;
    const time_s = this.app.cursor_s.value ?? frame.time_s;
    const colours = palette(this.app.theme.value);
    const { unit } = this.figure;
    // a time outside the window, or a row well before the time, is labeled, to distinguish it from the drawn
    // data
    let away_s = inside || !this.isFilled || this.app.cursor_s.value !== null ? NaN : time_s;
    const rows = this.figure.lines.map((line, i) => this.store.row(line.channel, line.source, time_s, this.filled.data[i]!));
    this.differences.show(rows, this.app.theme.value);
    const texts = this.figure.lines.map((line, i) => {
      const row = rows[i]!;
      if (row && this.isFilled && (row.every > 1 || time_s - row.time_s > AWAY * (this.span[1] - this.span[0]))) away_s = row.time_s;
      const title = row && Number.isNaN(row.time_s) ? `${line.label}: no row at this time` : row ? `${line.label}: ${row.value} ${unit} in the row at ${row.time_s} s` : line.label;
      const shown = el("span", { title }, row ? number(row.value, DIGITS) : "…");
      shown.style.color = ink(colours, line.ink);
      return shown;
    });
    const where = Number.isNaN(away_s) ? "" : ` at ${tickText(away_s)} s`;
    this.values.replaceChildren(...texts.flatMap((text) => [text, " "]), unit + where);
  }

  /** Redraws after a change of colors. */
  repaint(): void {
    this.plot?.destroy();
    this.plot = null;
    this.showKey();
    this.draw(this.filled, this.span, this.shared);
  }

  dispose(): void {
    if (this.plot?.over.matches(":hover")) this.app.cursor_s.value = null; // a removed element receives no mouseleave
    this.plot?.destroy();
    this.plot = null;
    this.element.remove();
  }

  /** Displays the legend; tension plots share one in the bar above. */
  private showKey(): void {
    this.key.replaceChildren(...this.figure.lines.map((line) => {
      const dash = el(isDashed(line.ink) ? "i.dashed" : "i");
      dash.style.color = ink(palette(this.app.theme.value), line.ink);
      return el("span", {}, dash, line.label);
    }));
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.place;
    if (width === 0 || height === 0) return;
    if (this.plot) this.plot.setSize({ width, height });
    else this.draw(this.filled, this.span, this.shared);
    this.mark();
  }

  private make(data: uPlot.AlignedData): uPlot {
    const colours = palette(this.app.theme.value);
    const axis: uPlot.Axis = {
      stroke: colours.text, font: "11px system-ui, sans-serif", ticks: { show: false },
      grid: { stroke: colours.grid, width: 1 }, gap: 3,
    };
    const series: uPlot.Series[] = [{}];
    const bands: uPlot.Band[] = [];
    for (const line of this.figure.lines) {
      const stroke = ink(colours, line.ink);
      const at = series.length;
      // minima and maxima; if points are single rows, both form the same line
      for (let k = 0; k < 2; ++k) series.push({ label: line.label, stroke, width: 1.4, points: { show: false }, ...(isDashed(line.ink) ? { dash: [5, 4] } : {}) });
      bands.push({ series: [at + 1, at], fill: `${stroke}60` });
    }
    const options: uPlot.Options = {
      width: this.place.clientWidth, height: this.place.clientHeight,
      padding: [6, 8, 0, 0],
      legend: { show: false },
      series, bands,
      axes: [
        { ...axis, size: 20, space: 44, values: (_, ticks) => ticks.map(tickText) },
        { ...axis, size: 38, space: 22, values: (_, ticks) => ticks.map(tickText) },
      ],
      scales: {
        x: { time: false, range: () => [this.span[0], this.span[1]] },
        y: { range: () => this.shared ?? this.range },
      },
      cursor: {
        sync: { key: SYNC }, y: false, points: { show: false },
        drag: { x: true, y: false, setScale: false },
        bind: { dblclick: () => () => ((this.app.range_s.value = null), null) },
      },
      hooks: {
        setCursor: [(plot) => this.point(plot)],
        setSelect: [(plot) => this.select(plot)],
      },
    };
    const plot = new uPlot(options, data, this.place);
    plot.over.append(this.now, this.coarse);
    plot.ctx.canvas.setAttribute("aria-hidden", "true"); // the surrounding element has the label
    plot.over.addEventListener("click", () => {
      const left = plot.cursor.left ?? -1;
      if (left >= 0 && plot.select.width === 0) this.app.seek(plot.posToVal(left, "x"));
    });
    plot.over.addEventListener("mouseleave", () => (this.app.cursor_s.value = null));
    return plot;
  }

  private point(plot: uPlot): void {
    // of the plots that share the cursor, only the plot under the mouse sets the time
    if (plot.cursor.event === undefined || plot.cursor.event === null) return;
    const left = plot.cursor.left ?? -1;
    this.app.cursor_s.value = left >= 0 ? plot.posToVal(left, "x") : null;
  }

  private select(plot: uPlot): void {
    const { left, width } = plot.select;
    if (width < 5) return;
    this.app.range_s.value = [plot.posToVal(left, "x"), plot.posToVal(left + width, "x")];
    plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
  }
}

/** uPlot requires one list of times for all lines; two recordings have two. */
function aligned(data: readonly Points[]): uPlot.AlignedData {
  const tables = data
    .filter((points) => points.t.length > 0)
    .map((points) => [points.t, points.min, points.max] as uPlot.AlignedData);
  if (tables.length === 0) return [[], ...data.flatMap(() => [[], []])] as unknown as uPlot.AlignedData;
  const joined = tables.length === 1 ? tables[0]! : uPlot.join(tables);
  let next = 1;
  const lists: (number | null | undefined)[][] = [joined[0] as number[]];
  for (const points of data) {
    for (let i = 0; i < 2; ++i) {
      lists.push(points.t.length > 0 ? (joined[next++] as number[]) : new Array<null>(joined[0].length).fill(null));
    }
  }
  return lists as uPlot.AlignedData;
}
