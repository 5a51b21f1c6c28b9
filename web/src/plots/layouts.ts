// Layouts: named lists of plots arranged by the user, stored by the browser for each experiment, and files of
// them. Without one, the default applies (default_plots.ts).
import type { App } from "../app";
import { memory, Signal } from "../util";

export const LAYOUT_VERSION = 1;
export const DEFAULT_LAYOUT = "default";
const FIRST_OWN = "my layout";
const MOST_PLOTS = 500; // limit of the plots in a file

/** A plot, defined by its channels, even if a run does not have them. */
export interface PlotSpec {
  title: string;
  channels: string[];
}

interface Kept {
  version: number;
  shown: string;
  layouts: Record<string, PlotSpec[]>;
}

export class Layouts {
  /** The plots to display; null: the default. */
  readonly plots = new Signal<readonly PlotSpec[] | null>(null);
  /** Name of the displayed layout. */
  readonly name = new Signal<string>(DEFAULT_LAYOUT);
  readonly names = new Signal<readonly string[]>([DEFAULT_LAYOUT]);
  private layouts = new Map<string, PlotSpec[]>();
  private key: string | null = null;

  constructor(app: App) {
    app.hello.watch((hello) => {
      if (!hello || this.key === `layouts.${hello.title}`) return;
      this.key = `layouts.${hello.title}`;
      const kept = keptLayouts(memory.get(this.key));
      this.layouts = new Map(Object.entries(kept.layouts));
      this.names.value = [DEFAULT_LAYOUT, ...this.layouts.keys()];
      this.show(kept.shown);
    });
  }

  /** Displays a layout; an unknown name selects the default. */
  show(name: string): void {
    this.name.value = this.layouts.has(name) ? name : DEFAULT_LAYOUT;
    this.plots.value = this.layouts.get(name) ?? null;
    this.keep();
  }

  /** Changes the plots of the displayed layout; changing the default creates a new layout. */
  change(plots: readonly PlotSpec[]): void {
    this.put(this.name.value === DEFAULT_LAYOUT ? this.free(FIRST_OWN) : this.name.value, plots);
  }

  /** Stores a layout under a name, replacing an existing one. */
  put(name: string, plots: readonly PlotSpec[]): void {
    this.layouts.set(name, plots.map(({ title, channels }) => ({ title, channels: [...channels] })));
    this.names.value = [DEFAULT_LAYOUT, ...this.layouts.keys()];
    this.show(name);
  }

  /** Deletes the displayed layout and displays the default. */
  remove(): void {
    this.layouts.delete(this.name.value);
    this.names.value = [DEFAULT_LAYOUT, ...this.layouts.keys()];
    this.show(DEFAULT_LAYOUT);
  }

  /** Imports the output of `layoutFile`; returns an error message, or nothing. */
  import(text: string): string | null {
    const read = readLayoutFile(text);
    if (typeof read === "string") return read;
    this.put(this.free(read.name === DEFAULT_LAYOUT ? FIRST_OWN : read.name), read.plots);
    return null;
  }

  /** Returns the name, with a number appended if it is in use. */
  private free(name: string): string {
    let free = name;
    for (let i = 2; this.layouts.has(free); ++i) free = `${name} ${i}`;
    return free;
  }

  private keep(): void {
    if (this.key === null) return;
    const kept: Kept = { version: LAYOUT_VERSION, shown: this.name.value, layouts: Object.fromEntries(this.layouts) };
    memory.set(this.key, JSON.stringify(kept));
  }
}

/** Parses the layouts stored by this browser; data of another version of the page are ignored. */
function keptLayouts(text: string | null): Kept {
  const none: Kept = { version: LAYOUT_VERSION, shown: DEFAULT_LAYOUT, layouts: {} };
  try {
    const kept = JSON.parse(text ?? "null") as Kept | null;
    if (kept?.version !== LAYOUT_VERSION || typeof kept.layouts !== "object") return none;
    const layouts = Object.entries(kept.layouts).filter(([, plots]) => Array.isArray(plots) && plots.every(isPlot));
    return { ...none, shown: kept.shown, layouts: Object.fromEntries(layouts) };
  } catch {
    return none;
  }
}

export function layoutFile(name: string, plots: readonly PlotSpec[]): string {
  const lines = plots.map(({ title, channels }) => `    ${JSON.stringify({ title, channels })}`);
  return `{\n  "format": "taut layout",\n  "version": ${LAYOUT_VERSION},\n  "name": ${JSON.stringify(name)},\n  "plots": [\n${lines.join(",\n")}\n  ]\n}\n`;
}

/** Returns the layout in a file, or an error message. */
export function readLayoutFile(text: string): { name: string; plots: PlotSpec[] } | string {
  let file: { format?: unknown; version?: unknown; name?: unknown; plots?: unknown };
  try {
    file = JSON.parse(text) as typeof file;
  } catch (error) {
    return `the file is not JSON: ${error instanceof Error ? error.message : String(error)}`;
  }
  if (file?.format !== "taut layout") return 'the file is not a layout: its "format" is not "taut layout"';
  if (file.version !== LAYOUT_VERSION) return `the layout has version ${String(file.version)}, this page reads version ${LAYOUT_VERSION}`;
  if (typeof file.name !== "string" || file.name.trim() === "") return 'the layout has no "name"';
  if (!Array.isArray(file.plots) || file.plots.length > MOST_PLOTS) return `"plots" of the layout is not a list of at most ${MOST_PLOTS}`;
  const bad = file.plots.findIndex((plot) => !isPlot(plot));
  if (bad >= 0) return `plot ${bad + 1} of the layout is not {"title": text, "channels": [names, at least one]}`;
  return { name: file.name.trim(), plots: file.plots as PlotSpec[] };
}

function isPlot(plot: unknown): plot is PlotSpec {
  const { title, channels } = (plot ?? {}) as Partial<PlotSpec>;
  return typeof title === "string" && Array.isArray(channels) && channels.length > 0 && channels.every((name) => typeof name === "string");
}
