// Changes of a list of plots: adding, removing and moving channels. Each function returns the new list, or
// the reason of a refusal.
import type { SeriesStore } from "../series";
import { unitText } from "../util";
import { titleOf } from "./channels";
import type { PlotSpec } from "./layouts";

export type Plots = readonly PlotSpec[];

/** Adds a plot for the channels of each unit. */
export function withNewPlot(plots: Plots, channels: readonly string[], store: SeriesStore): Plots {
  const units = new Map<string, string[]>();
  for (const channel of channels) {
    const unit = unitOf(channel, store);
    units.set(unit, [...(units.get(unit) ?? []), channel]);
  }
  const added = [...units.values()].map((names) => ({ title: titleOf(names), channels: names }));
  return [...plots, ...added];
}

export function withChannels(plots: Plots, place: number, channels: readonly string[], store: SeriesStore): Plots | string {
  const plot = plots[place];
  if (!plot) return "the plot no longer exists";
  // ignores channels that this run does not have
  const first = plot.channels.find((channel) => store.has(channel, 0));
  const unit = first === undefined ? null : unitOf(first, store);
  const other = channels.find((channel) => unit !== null && unitOf(channel, store) !== unit);
  if (other !== undefined) return `${other} is in ${inWords(unitOf(other, store))}, ${plot.title} in ${inWords(unit!)}`;
  const names = [...new Set([...plot.channels, ...channels])];
  return plots.map((each, i) => (i === place ? { ...each, channels: names } : each));
}

/** Removes a channel; an empty plot is removed, too. */
export function withoutChannel(plots: Plots, place: number, channel: string): Plots {
  return plots
    .map((plot, i) => (i === place ? { ...plot, channels: plot.channels.filter((name) => name !== channel) } : plot))
    .filter(({ channels }) => channels.length > 0);
}

export function withoutPlot(plots: Plots, place: number): Plots {
  return plots.filter((_, i) => i !== place);
}

export function renamed(plots: Plots, place: number, title: string): Plots {
  return plots.map((plot, i) => (i === place ? { ...plot, title } : plot));
}

/** Moves a plot to the place of another, which makes room. */
export function moved(plots: Plots, from: number, to: number): Plots {
  const rest = [...plots];
  const [plot] = rest.splice(from, 1);
  if (!plot) return plots;
  rest.splice(Math.min(Math.max(to, 0), rest.length), 0, plot);
  return rest;
}

function unitOf(channel: string, store: SeriesStore): string {
  return unitText(store.unit(channel, 0) ?? "1");
}

function inWords(unit: string): string {
  return unit === "" ? "no unit" : unit;
}
