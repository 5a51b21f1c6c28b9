// Plot on the screen (uPlot) with the values under the cursor. A plot of several tensions emphasizes the line under the
// mouse.
import uPlot from "uplot";
import type { App } from "../app";
import { palette } from "../colours";
import { NOTHING, type Points } from "../points";
import type { SeriesStore } from "../series";
import { el, nameAndUnit, number, tickText } from "../util";
import { partsOf } from "./channels";
import { Differences } from "./differences";
import { coarseness, type Figure, type Filled, ink, isDashed, TENSION, valueRange } from "./figure";
import { NearLine } from "./near_line";

const SYNC = "taut";
const MOST_IN_KEY = 12; // maximum number of lines in the legend; the box at the mouse names the lines, too
const DIGITS = 4; // significant digits of a value beside a plot
const AWAY = 0.01; // share of the window: a row farther from the displayed time is labeled with its time

export class Chart {
  readonly element: HTMLElement;
  filled: Filled;
  private plot: uPlot | null = null;
  /** Whether the chart has data. Until then, its span has no meaning. */
  private isFilled = false;
  private readonly place: HTMLElement;
  private readonly key = el("div.lines");
  private readonly values = el("span.values");
  private readonly differences: Differences;
  private readonly now = el("div.now");
  private stops: (() => void)[] = [];
  private readonly coarse = el("div.coarse");
  private near: NearLine | null = null;
  private shared: [number, number] | null = null;
  private span: readonly [number, number] = [0, 1];
  /** Whether the chart has axis labels. */
  private readonly isLarge: boolean;

  constructor(
    private readonly app: App,
    private readonly store: SeriesStore,
    readonly figure: Figure,
    tools: HTMLElement,
  ) {
    this.filled = { figure, data: figure.lines.map(() => NOTHING) };
    this.differences = new Differences(figure);
    this.isLarge = figure.group !== "tension";
    this.place = el(this.isLarge ? "div.canvas.labeled" : "div.canvas", { role: "img", "aria-label": `${figure.title} over time` });
    this.key.hidden = figure.group === "tension" || figure.lines.length < 2 || figure.lines.length > MOST_IN_KEY;
    this.element = el("figure.chart", { "data-figure": figure.id, "aria-label": figure.title },
      el("figcaption", {}, el("span.name", { title: figure.title }, figure.title), this.values, tools), this.differences.element, this.key, this.place);
    this.showKey();
    new ResizeObserver(() => this.resize()).observe(this.place);
    if (figure.group !== "overlay") return;
    this.stops = [app.hover, app.selection].map((signal) => signal.watch(() => this.markCable()));
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
    if (this.figure.group === "overlay") {
      const known = rows.flatMap((row) => (row && Number.isFinite(row.value) ? [row.value] : []));
      const text = known.length < rows.length ? "…" : `${number(Math.min(...known), DIGITS)} to ${number(Math.max(...known), DIGITS)} ${unit}${where}`;
      this.values.replaceChildren(el("span", { title: "smallest and largest value of all lines" }, text));
      return;
    }
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
    for (const stop of this.stops) stop();
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
    const label: uPlot.Axis = { labelFont: "11px system-ui, sans-serif", labelSize: 15, labelGap: 0 };
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
        { ...axis, size: 20, space: 44, values: (_, ticks) => ticks.map(tickText), ...(this.isLarge ? { ...label, label: "time [s]" } : {}) },
        { ...axis, size: 38, space: 22, values: (_, ticks) => ticks.map(tickText), ...(this.isLarge ? { ...label, label: yLabel(this.figure) } : {}) },
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
    (this.isLarge ? this.place : plot.over).append(this.coarse);
    if (this.figure.group === "overlay") {
      this.near = new NearLine(this.figure.lines.map((line) => ({ label: line.label, colour: ink(colours, line.ink) })), this.figure.unit);
      plot.over.append(this.near.element);
    }
    plot.ctx.canvas.setAttribute("aria-hidden", "true"); // the surrounding element has the label
    plot.over.addEventListener("click", () => {
      const left = plot.cursor.left ?? -1;
      if (left >= 0 && plot.select.width === 0) this.app.seek(plot.posToVal(left, "x"));
      const { hover } = this.app;
      if (this.near && hover.value?.kind === "cable") this.app.selection.value = hover.value;
    });
    plot.over.addEventListener("mouseleave", () => {
      this.app.cursor_s.value = null;
      if (!this.near) return;
      this.near.element.hidden = true;
      this.app.hover.value = null;
    });
    return plot;
  }

  /** Emphasizes the line of the cable under the mouse, or of the selected cable. */
  private markCable(): void {
    const scene = this.app.scene.value;
    const shown = this.app.hover.value ?? this.app.selection.value;
    if (!this.plot || !this.near || !scene) return;
    const name = shown?.kind === "cable" ? scene.cables[shown.index]?.name : undefined;
    this.near.mark(this.plot, this.figure.lines.findIndex(({ channel }) => TENSION.exec(channel)?.[1] === name));
  }

  /** Makes the nearest line's cable the one under the mouse. */
  private hoverLine(plot: uPlot): void {
    const line = this.near!.find(plot);
    const name = line < 0 ? undefined : TENSION.exec(this.figure.lines[line]!.channel)?.[1];
    const index = this.app.scene.value?.cables.findIndex((cable) => cable.name === name) ?? -1;
    if (this.app.hover.value?.index !== index) this.app.hover.value = index < 0 ? null : { kind: "cable", index };
  }

  private point(plot: uPlot): void {
    // of the plots that share the cursor, only the plot under the mouse sets the time
    if (plot.cursor.event === undefined || plot.cursor.event === null) return;
    const left = plot.cursor.left ?? -1;
    if (this.near) this.hoverLine(plot);
    this.app.cursor_s.value = left >= 0 ? plot.posToVal(left, "x") : null;
  }

  private select(plot: uPlot): void {
    const { left, width } = plot.select;
    if (width < 5) return;
    this.app.range_s.value = [plot.posToVal(left, "x"), plot.posToVal(left + width, "x")];
    plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
  }
}

/** Returns the label of the axis of values: quantity and unit. */
function yLabel({ title, unit, lines, group }: Figure): string {
  const quantity = group === "overlay" ? "tension" : lines.length > 0 ? nameAndUnit(partsOf(lines[0]!.channel).quantity)[0] : title;
  const shared = lines.every(({ channel }) => nameAndUnit(partsOf(channel).quantity)[0] === quantity) || group === "overlay";
  const name = shared ? quantity : title;
  return unit === "" ? name : `${name} [${unit}]`;
}

/** Merges the times of all lines: uPlot requires one list, but two recordings have two lists. */
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
