// One plot on the screen (uPlot), with its values under the cursor.
import uPlot from "uplot";
import type { App } from "../app";
import { palette } from "../colours";
import type { Points } from "../series";
import { el, lastAtMost, number, tickText } from "../util";
import { type Figure, type Filled, ink, valueRange } from "./figure";

const SYNC = "taut";

export class Chart {
  readonly element: HTMLElement;
  filled: Filled;
  private plot: uPlot | null = null;
  private readonly place = el("div.canvas");
  private readonly values = el("span.values");
  private readonly now = el("div.now");
  private shared: [number, number] | null = null;
  private span: readonly [number, number] = [0, 1];

  constructor(
    private readonly app: App,
    readonly figure: Figure,
    tools: HTMLElement,
  ) {
    this.filled = { figure, data: figure.lines.map(() => ({ t: [], mean: [], min: [], max: [] })) };
    this.element = el("figure.chart", { "data-figure": figure.id },
      el("figcaption", {}, el("span.name", {}, figure.title), this.values, tools), this.place);
    new ResizeObserver(() => this.resize()).observe(this.place);
  }

  get range(): [number, number] {
    return valueRange([this.filled]);
  }

  /** Shows points between two times; `shared`: the range of values, where plots have one together. */
  show(filled: Filled, span: readonly [number, number], shared: [number, number] | null): void {
    this.filled = filled;
    this.shared = shared;
    this.span = span;
    if (this.place.clientWidth === 0) return;
    const data = aligned(filled.data);
    if (this.plot) this.plot.setData(data);
    else this.plot = this.make(data);
    this.mark();
  }

  /** The line at the present time, and the values under the cursor or at that time. */
  mark(): void {
    const plot = this.plot;
    const frame = this.app.frame.value;
    if (!plot || !frame) return;
    const inside = frame.time_s >= this.span[0] && frame.time_s <= this.span[1];
    this.now.hidden = !inside;
    if (inside) this.now.style.transform = `translateX(${plot.valToPos(frame.time_s, "x")}px)`;
    const time_s = this.app.cursor_s.value ?? frame.time_s;
    const colours = palette(this.app.theme.value);
    const texts = this.figure.lines.map((line, i) => {
      const shown = el("span", { title: line.label }, number(valueAt(this.filled.data[i]!, time_s)));
      shown.style.color = ink(colours, line.ink);
      return shown;
    });
    this.values.replaceChildren(...texts.flatMap((text) => [text, " "]), this.figure.unit);
  }

  /** Colours have changed. */
  repaint(): void {
    this.plot?.destroy();
    this.plot = null;
    this.show(this.filled, this.span, this.shared);
  }

  dispose(): void {
    this.plot?.destroy();
    this.plot = null;
    this.element.remove();
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.place;
    if (width === 0 || height === 0) return;
    if (this.plot) this.plot.setSize({ width, height });
    else this.show(this.filled, this.span, this.shared);
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
      series.push(
        { label: line.label, stroke, width: 1.4, spanGaps: true, points: { show: false } },
        { stroke: "transparent", spanGaps: true, points: { show: false } },
        { stroke: "transparent", spanGaps: true, points: { show: false } },
      );
      bands.push({ series: [at + 2, at + 1], fill: `${stroke}38` });
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
    plot.over.append(this.now);
    plot.over.addEventListener("click", () => {
      const left = plot.cursor.left ?? -1;
      if (left >= 0 && plot.select.width === 0) this.app.seek(plot.posToVal(left, "x"));
    });
    plot.over.addEventListener("mouseleave", () => (this.app.cursor_s.value = null));
    return plot;
  }

  private point(plot: uPlot): void {
    // of the plots that share the cursor only the one under the mouse speaks
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

function valueAt(points: Points, time_s: number): number {
  const at = lastAtMost(points.t, time_s);
  return points.mean[at] ?? NaN;
}

/** uPlot wants one list of times for all lines; two recordings have two. */
function aligned(data: readonly Points[]): uPlot.AlignedData {
  const tables = data
    .filter((points) => points.t.length > 0)
    .map((points) => [points.t, points.mean, points.min, points.max] as uPlot.AlignedData);
  if (tables.length === 0) return [[], ...data.flatMap(() => [[], [], []])] as unknown as uPlot.AlignedData;
  const joined = tables.length === 1 ? tables[0]! : uPlot.join(tables);
  let next = 1;
  const lists: (number | null | undefined)[][] = [joined[0] as number[]];
  for (const points of data) {
    for (let i = 0; i < 3; ++i) {
      lists.push(points.t.length > 0 ? (joined[next++] as number[]) : new Array<null>(joined[0].length).fill(null));
    }
  }
  return lists as uPlot.AlignedData;
}
