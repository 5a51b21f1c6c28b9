// Panel of all plots: their content, updates and visibility.
import { type App, nameOf, type Selection } from "../app";
import { button, el, memory, Signal } from "../util";
import type { SeriesStore } from "../series";
import { Chart } from "./chart";
import { copyPng, exportCsv, exportPng, exportSvg } from "./export";
import { type Plots, withChannels, withNewPlot, withoutPlot } from "./arrangement";
import { ChannelBrowser, dropTarget } from "./browser";
import { titleOf } from "./channels";
import { DefaultPlots, needsSmallPlots } from "./default_plots";
import { type Figure, figuresOf, fill, type Filled, ownFigures, valueRange } from "./figure";
import { Key } from "./key";
import { layoutBar } from "./layout_bar";
import { Layouts } from "./layouts";
import { PlotDialog } from "./plot_dialog";

const LIVE_SPAN_S = 20;
const LIVE_EVERY_MS = 100;
const POINTS = 600; // points per plot, about two per pixel of its width

export class PlotPanel {
  readonly element = el("section.plots", { "aria-label": "plots" });
  private readonly grids = { own: el("div.grid.wide"), overlay: el("div.grid.large"), tension: el("div.grid"), further: el("div.grid.wide") };
  private readonly layouts: Layouts;
  private readonly defaults: DefaultPlots;
  private readonly browser: ChannelBrowser;
  private readonly dialog = new PlotDialog(() => this.plots, (plots) => this.layouts.change(plots));
  private readonly editor: HTMLElement;
  private readonly remark = el("p.remark", { role: "note", hidden: true });
  /** The plots, without the figures of the selection in the view. */
  private plots: Plots = [];
  private readonly key = new Key();
  /** Increases when plots are added or removed. */
  private readonly shownPlots = new Signal(0);
  private charts: Chart[] = [];
  /** Places of the charts in the layout. */
  private places = new Map<Chart, number>();
  private readonly editButton = button("edit plots", "choose channels and layouts of the plots (B)", () => this.toggleEditor());
  private readonly visible = new Set<Chart>();
  private readonly seen: IntersectionObserver;
  private sameScale = true;
  /** One plot per cable, instead of one per group of cables. */
  private small = memory.get("plots") === "small";
  private wholeRun = false;
  private due = 0;
  private own: { kind: Selection["kind"]; name: string } | null = null;

  constructor(
    private readonly app: App,
    private readonly store: SeriesStore,
  ) {
    this.layouts = new Layouts(app);
    this.defaults = new DefaultPlots(app, store);
    this.browser = new ChannelBrowser(app, {
      toNewPlot: (channels) => this.layouts.change(withNewPlot(this.plots, channels, store)),
      toPlotsOfTheirOwn: (channels) => this.layouts.change([...this.plots, ...channels.map((name) => ({ title: titleOf([name]), channels: [name] }))]),
      toPlot: (place, channels) => this.addTo(place, channels),
      plots: () => this.plots.map(({ title }, place) => ({ place, title })),
    });
    this.editor = this.makeEditor();
    this.element.append(this.toolbar(), this.editor, this.remark, ...Object.values(this.grids), this.dialog.element);
    this.seen = new IntersectionObserver((entries) => {
      for (const entry of entries) {
        const chart = this.charts.find((each) => each.element === entry.target);
        if (!chart) continue;
        if (entry.isIntersecting) this.visible.add(chart);
        else this.visible.delete(chart);
      }
      this.mark(); // the values in the chart may be old, because it was not visible
      this.refresh();
    }, { rootMargin: "1500px 0px" });
    app.scene.watch(() => this.rebuild());
    this.layouts.plots.watch(() => this.arrange());
    app.range_s.watch(() => this.refresh());
    app.theme.watch(() => {
      this.showKey();
      this.charts.forEach((chart) => chart.repaint());
    });
    app.selection.watch((selection) => {
      const scene = app.scene.value;
      if (!scene || !selection) return;
      this.plotOwn(selection.kind, nameOf(scene, selection));
    });
    app.cursor_s.watch(() => this.mark());
    store.rowsCame.watch(() => this.mark());
    app.frame.watch(() => {
      this.mark();
      if (app.live && performance.now() >= this.due) this.refresh();
    });
  }

  private get span(): readonly [number, number] {
    const scene = this.app.scene.value;
    if (this.app.range_s.value) return this.app.range_s.value;
    if (!this.app.live) return scene ? [scene.first_s, Math.max(scene.duration_s, scene.first_s + 1e-3)] : [0, 1];
    const now_s = this.app.frame.value?.now_s ?? 0;
    if (this.wholeRun) return [0, Math.max(now_s, LIVE_SPAN_S)];
    // while looking back, plots include the surrounding time
    const shown_s = this.app.frame.value?.time_s ?? 0;
    const end_s = shown_s < now_s - LIVE_SPAN_S ? shown_s + LIVE_SPAN_S / 2 : now_s;
    return [Math.max(0, end_s - LIVE_SPAN_S), Math.max(end_s, LIVE_SPAN_S)];
  }

  private plotOwn(kind: Selection["kind"], name: string): void {
    if (this.own?.kind === kind && this.own.name === name) return;
    this.own = { kind, name };
    this.drop((chart) => chart.figure.group === "own");
    const scene = this.app.scene.value;
    if (scene) for (const figure of ownFigures(scene, this.store, kind, name)) this.add(figure, null);
    if (this.app.report) this.refresh();
  }

  private rebuild(): void {
    this.own = null;
    this.drop(() => true);
    this.arrange();
  }

  /** Displays the layout, or the default, which may first request the largest tensions. */
  private arrange(): void {
    const { value: scene } = this.app.scene;
    if (!scene) return;
    const { value: arranged } = this.layouts.plots;
    if (arranged) this.showPlots(arranged);
    this.defaults.find(scene, this.small, (plots) => {
      if (this.layouts.plots.value === null && this.app.scene.value === scene) this.showPlots(plots);
    });
  }

  /** Existing plots stay, so that only new data are requested. */
  private showPlots(plots: Plots): void {
    const scene = this.app.scene.value!;
    this.plots = plots;
    const before = this.charts.filter(({ figure }) => figure.group !== "own");
    const places = new Map<Chart, number>();
    for (const { figure, place } of figuresOf(plots, scene, this.store)) {
      const text = JSON.stringify(figure);
      const known = before.find((chart) => !places.has(chart) && JSON.stringify(chart.figure) === text);
      if (known) this.grids[figure.group].append(known.element);
      places.set(known ?? this.add(figure, place), place);
    }
    this.drop((chart) => chart.figure.group !== "own" && !places.has(chart));
    this.places = places;
    // in the order of the layout, also for exports of all plots
    this.charts.sort((a, b) => (places.get(a) ?? Infinity) - (places.get(b) ?? Infinity));
    this.showRemark();
    this.browser.showPlots();
    this.showKey();
    ++this.shownPlots.value;
    this.refresh();
  }

  private showRemark(): void {
    const scene = this.app.scene.value;
    const cables = (scene?.robot?.motors ?? scene?.cables ?? []).length;
    const shown = this.charts.reduce((sum, { figure }) => sum + (figure.group === "tension" ? 1 : figure.group === "overlay" ? figure.lines.length : 0), 0);
    const absent = [...new Set(this.plots.flatMap(({ channels }) => channels))].filter((name) => !this.store.has(name, 0) && !this.store.has(name, 1));
    const isDefault = this.layouts.plots.value === null;
    const when = this.app.live ? "when the page was opened" : "of the run";
    this.remark.textContent = absent.length > 0 ? `not in this run: ${absent.slice(0, 4).join(", ")}${absent.length > 4 ? ` and ${absent.length - 4} more channels of the layout` : ""}`
      : isDefault && shown < cables ? `${shown} of ${cables} cables, those with the largest tensions ${when}; for other channels use "edit plots"`
      : "";
    this.remark.hidden = this.remark.textContent === "";
  }

  private addTo(place: number, channels: readonly string[]): void {
    const plots = withChannels(this.plots, place, channels, this.store);
    if (typeof plots === "string") this.app.notice.value = `not added: ${plots}`;
    else this.layouts.change(plots);
  }

  /** Shows or hides all channels and the layouts. */
  toggleEditor(): void {
    this.editor.hidden = !this.editor.hidden;
    this.element.classList.toggle("editing", !this.editor.hidden);
    this.editButton.setAttribute("aria-expanded", String(!this.editor.hidden));
    if (this.editor.hidden) return;
    this.editor.scrollIntoView({ block: "nearest" });
    this.editor.focus(); // not the search field, which would receive the key that closes the editor
  }

  searchChannels(): void {
    if (this.editor.hidden) this.toggleEditor();
    this.browser.search.focus();
    this.browser.search.select();
  }

  private makeEditor(): HTMLElement {
    const target = el("div.newplot", {}, "drop channels here for a new plot, or into a plot");
    dropTarget(target, (channels) => this.layouts.change(withNewPlot(this.plots, channels, this.store)));
    return el("section.editor", { "aria-label": "channels and layouts", hidden: true, tabindex: -1 }, layoutBar(this.app, this.layouts, () => this.plots), this.browser.element, target);
  }

  private showKey(): void {
    this.key.show(this.charts.map(({ figure }) => figure).filter(({ group }) => group === "tension"), this.app.theme.value);
  }

  private drop(which: (chart: Chart) => boolean): void {
    for (const chart of this.charts.filter(which)) {
      this.seen.unobserve(chart.element);
      this.visible.delete(chart);
      chart.dispose();
    }
    this.charts = this.charts.filter((chart) => !which(chart));
  }

  /** `place`: place of the plot in the layout; null: not in the layout. */
  private add(figure: Figure, place: number | null): Chart {
    const save = (name: string, write: (filled: Filled[], name: string) => void) =>
      button(name, `save ${figure.title} as ${name}`, () => write([chart.filled], figure.title), "button.small");
    const copy = button("copy", `copy ${figure.title} as a picture`, () => void copyPng([chart.filled], this.span).then((failed) => {
      this.app.notice.value = failed === null ? `copied ${figure.title}` : `not copied: ${failed}`;
    }), "button.small");
    const tools = el("span.tools", {}, copy, save("PNG", (f, n) => void exportPng(f, this.span, n)), save("SVG", (f, n) => exportSvg(f, this.span, n)), save("CSV", exportCsv),
      ...(place === null
        ? [button("keep", `keep ${figure.title} in the layout`, () => this.layouts.change([...this.plots, { title: figure.title, channels: figure.lines.map(({ channel }) => channel) }]), "button.small")]
        : [
            button("edit", `edit the plot ${figure.title}`, () => this.dialog.open(this.places.get(chart)!), "button.small"),
            button("×", `remove the plot ${figure.title}`, () => this.layouts.change(withoutPlot(this.plots, this.places.get(chart)!)), "button.small"),
          ]));
    const chart: Chart = new Chart(this.app, this.store, figure, tools);
    this.charts.push(chart);
    this.grids[figure.group].append(chart.element);
    // a report may be printed, so all data are loaded; otherwise distant plots are not
    if (this.app.report) this.visible.add(chart);
    else this.seen.observe(chart.element);
    if (place !== null) dropTarget(chart.element, (channels) => this.addTo(this.places.get(chart)!, channels));
    return chart;
  }

  private mark(): void {
    for (const chart of this.visible) chart.mark();
  }

  private refresh(): void {
    this.due = performance.now() + LIVE_EVERY_MS;
    const span = this.span;
    for (const chart of this.visible) {
      fill(chart.figure, this.store, span[0], span[1], POINTS, (filled) => {
        if (span !== this.span && !this.app.live && (span[0] !== this.span[0] || span[1] !== this.span[1])) return;
        chart.filled = filled;
        chart.show(filled, span, this.scaleOf(chart));
        if (!this.app.live) this.rescale(chart);
      });
    }
  }

  /** Returns the common scale of the tensions, for comparable heights, unless it is switched off. */
  private scaleOf(chart: Chart): [number, number] | null {
    const { group } = chart.figure;
    if (!this.sameScale || (group !== "tension" && group !== "overlay")) return null;
    return valueRange(this.charts.filter((each) => each.figure.group === group).map((each) => each.filled));
  }

  private rescale(except: Chart): void {
    const { group } = except.figure;
    if ((group !== "tension" && group !== "overlay") || !this.sameScale) return;
    const shared = this.scaleOf(except);
    for (const chart of this.visible) {
      if (chart !== except && chart.figure.group === group && chart.filled.data.some((points) => points.t.length > 0)) {
        chart.show(chart.filled, this.span, shared);
      }
    }
  }

  private toolbar(): HTMLElement {
    const scale = el<HTMLInputElement>("input", { type: "checkbox", checked: true, onchange: () => {
      this.sameScale = scale.checked;
      this.refresh();
    } });
    const whole = el<HTMLInputElement>("input", { type: "checkbox", onchange: () => {
      this.wholeRun = whole.checked;
      this.refresh();
    } });
    const wholeLabel = el("label", { title: `the whole run, not its last ${LIVE_SPAN_S} s` }, whole, " whole run");
    this.app.hello.watch(() => (wholeLabel.hidden = !this.app.live));
    const isTension = ({ figure }: Chart) => figure.group === "tension" || figure.group === "overlay";
    const all = (which: "tension" | "all") => this.charts.filter((chart) => which === "all" || isTension(chart)).map((chart) => chart.filled);
    const small = el<HTMLInputElement>("input", { type: "checkbox", checked: this.small, onchange: () => {
      this.small = small.checked;
      memory.set("plots", this.small ? "small" : "groups");
      this.arrange();
    } });
    const smallLabel = el("label", { title: "one small plot per cable, instead of one plot per group of cables" }, small, " one plot per cable");
    const scaleLabel = el("label", { title: "the same scale for all tensions" }, scale, " same scale");
    const fitBar = () => {
      const { value: scene } = this.app.scene;
      smallLabel.hidden = scene === null || this.layouts.plots.value !== null || needsSmallPlots(scene);
      scaleLabel.hidden = this.charts.filter(isTension).length < 2;
      this.key.element.hidden = !this.charts.some(({ figure }) => figure.group === "tension");
    };
    this.shownPlots.watch(fitBar);
    const zoomOut = button("zoom out", "show the whole time range (double click in a plot)", () => (this.app.range_s.value = null));
    this.app.range_s.watch((range) => (zoomOut.hidden = range === null));
    return el("div.toolbar", {},
      this.key.element,
      smallLabel, scaleLabel,
      wholeLabel, zoomOut,
      el("span.spring"),
      this.editButton,
      el("span.save", {}, "save all:",
      button("PNG", "save all tensions as PNG", () => void exportPng(all("tension"), this.span, "tensions"), "button.small"),
      button("SVG", "save all tensions as SVG", () => exportSvg(all("tension"), this.span, "tensions"), "button.small"),
      button("CSV", "save the displayed data as CSV", () => exportCsv(all("all"), "plots"), "button.small")));
  }
}
