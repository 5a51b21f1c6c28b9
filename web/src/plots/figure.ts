// Figure: content of a plot, lines over time with their channels, for the screen and for export.
import type { Selection } from "../app";
import { hueColour, type Palette } from "../colours";
import { NOTHING, type Points } from "../points";
import type { Scene } from "../protocol";
import type { SeriesStore } from "../series";
import { runColour, runName, THIS_RUN } from "../runs";
import { nameAndUnit, unitText } from "../util";
import { labelsOf } from "./channels";
import type { PlotSpec } from "./layouts";

/** `run k`: the color of a compared run; `hue i/n`: color i of n lines of equal rank. */
export type Ink = "own" | "setpoint" | `run ${number}` | `hue ${number}/${number}` | number;

export interface Line {
  label: string;
  channel: string;
  source: number;
  ink: Ink;
}

export interface Figure {
  id: string;
  title: string;
  unit: string;
  lines: Line[];
  /** overlay: tensions of several cables, one large plot. */
  group: "overlay" | "tension" | "own" | "further";
}

/** A figure with the points of its lines, in their order. */
export interface Filled {
  figure: Figure;
  data: Points[];
}

export function ink(palette: Palette, which: Ink): string {
  if (typeof which === "number") return palette.further[which % palette.further.length]!;
  const [, i, n] = /^hue (\d+)\/(\d+)$/.exec(which) ?? [];
  if (n !== undefined) return hueColour(Number(i) / Number(n), palette.lineLightness);
  return which === "own" || which === "setpoint" ? palette[which] : runColour(palette, Number(which.slice("run ".length)));
}

/** Returns the lines of a channel in every run: the compared ones, then this one, drawn above them. */
function linesOfRuns(scene: Scene, channel: string): Line[] {
  const others = scene.compared.map((run, k): Line => ({ label: runName(run), channel, source: k + 1, ink: `run ${k + 1}` }));
  return [...others, { label: THIS_RUN, channel, source: 0, ink: "own" }];
}

export const TENSION = /^cable\/(.*)\/tension_n$/;

/** Number of colors; they repeat for further lines, which are dashed. */
const INKS = 6;

export function isDashed(which: Ink): boolean {
  return typeof which === "number" && which >= INKS;
}

/** Returns the figures of the plots for which the run has data, and the places of these plots. */
export function figuresOf(plots: readonly PlotSpec[], scene: Scene, store: SeriesStore): { figure: Figure; place: number }[] {
  const taken = new Set<string>();
  return plots.flatMap((plot, place) => {
    const made = figureOf(plot, scene, store);
    if (made.lines.length === 0) return [];
    let id = made.id;
    for (let i = 2; taken.has(id); ++i) id = `${made.id}:${i}`;
    taken.add(id);
    return [{ figure: { ...made, id }, place }];
  });
}

/** Returns the cable if the plot contains only its tension, or tension and set point. */
function cableOf({ channels }: PlotSpec): string | null {
  const cable = /^cable\/(.*)\/tension_n$/.exec(channels.find((name) => name.endsWith("/tension_n")) ?? "")?.[1];
  const own = [`cable/${cable}/tension_n`, `cable/${cable}/setpoint_n`];
  return cable !== undefined && channels.every((name) => own.includes(name)) ? cable : null;
}

/**
 * Returns the figure of a plot. Tensions are drawn as in the paper's Figs. 3-5: set point blue, compared runs
 * red and other colors, this run black. Any other single channel includes the compared runs, too.
 */
function figureOf(plot: PlotSpec, scene: Scene, store: SeriesStore): Figure {
  const cable = cableOf(plot);
  const first = plot.channels.find((channel) => store.has(channel, 0)) ?? plot.channels[0]!;
  const unit = unitText(store.unit(first, 0) ?? "1");
  if (cable !== null) {
    const setpoint: Line = { label: "set point", channel: `cable/${cable}/setpoint_n`, source: 0, ink: "setpoint" };
    const lines = linesOfRuns(scene, `cable/${cable}/tension_n`);
    const wanted = plot.channels.includes(setpoint.channel) ? [setpoint, ...lines] : lines;
    return known({ id: `tension:${cable}`, title: plot.title, unit: "N", group: "tension", lines: wanted }, store);
  }
  const cables = plot.channels.map((channel) => TENSION.exec(channel)?.[1]);
  if (cables.length > 1 && cables.every((name) => name !== undefined)) {
    const lines = cables.map((name, i): Line => ({ label: name!, channel: plot.channels[i]!, source: 0, ink: cables.length > INKS ? `hue ${i}/${cables.length}` : i }));
    return known({ id: `overlay:${plot.title}`, title: plot.title, unit: "N", group: "overlay", lines }, store);
  }
  const id = plot.title.toLowerCase().replace(/[^\p{L}\p{N}_]+/gu, "-");
  const labels = labelsOf(plot.channels);
  const isShared = plot.channels.length === 1 && scene.compared.some((_, k) => store.has(first, k + 1));
  const lines = isShared ? linesOfRuns(scene, first) : plot.channels.map((channel, i): Line => ({ label: labels[i]!, channel, source: 0, ink: i }));
  return known({ id, title: plot.title, unit, group: "further", lines }, store);
}

/** Returns the figures of a cable, body or node, one for each unit. */
export function ownFigures(scene: Scene, store: SeriesStore, kind: Selection["kind"], name: string): Figure[] {
  const figure = (id: string, unit: string, title: string, keys: string[]): Figure => ({
    id: `own:${kind}:${name}:${id}`, title: `${name} ${title}`, unit, group: "own",
    lines: keys.map((key, i) => ({ label: nameAndUnit(key)[0], channel: `${kind}/${name}/${key}`, source: 0, ink: i })),
  });
  const position = figure("position", "m", "position", ["position_x_m", "position_y_m", "position_z_m"]);
  const figures = {
    cable: [
      figure("tension", "N", "tension", ["setpoint_n", "tension_n", "elastic_n"]),
      figure("length", "m", "length", ["length_m", "rest_length_m", "target_rest_length_m"]),
      figure("rate", "m/s", "rate", ["rate_m_per_s"]),
    ],
    body: [
      position,
      figure("velocity", "m/s", "velocity", ["velocity_x_m_per_s", "velocity_y_m_per_s", "velocity_z_m_per_s"]),
      figure("spin", "rad/s", "angular velocity", ["angular_velocity_x_rad_per_s", "angular_velocity_y_rad_per_s", "angular_velocity_z_rad_per_s"]),
    ],
    node: [position],
    joint: [
      figure("angle", "rad", "angle", ["angle_rad"]),
      figure("slide", "m", "position", ["position_m"]),
      figure("force", "N", "force", ["force_x_n", "force_y_n", "force_z_n"]),
      figure("torque", "N m", "torque", ["torque_x_n_m", "torque_y_n_m", "torque_z_n_m"]),
    ],
  }[kind];
  const split = scene.compared.length > 0 ? figures.flatMap((each) => ofEachChannel(scene, each)) : figures;
  return split.map((each) => known(each, store)).filter((each) => each.lines.length > 0);
}

/** When runs are compared, colors distinguish runs: returns one figure per channel. */
function ofEachChannel(scene: Scene, figure: Figure): Figure[] {
  return figure.lines.map(({ label, channel }) => ({
    ...figure, id: `${figure.id}:${label}`, title: figure.lines.length > 1 ? `${figure.title}: ${label}` : figure.title, lines: linesOfRuns(scene, channel),
  }));
}

/** Removes lines of channels that do not exist, or have another unit. */
function known(figure: Figure, store: SeriesStore): Figure {
  const fits = ({ channel, source }: Line) => store.has(channel, source) && unitText(store.unit(channel, source)!) === figure.unit;
  return { ...figure, lines: figure.lines.filter(fits) };
}

/** Describes the points if they are not single rows; else empty. */
export function coarseness(data: readonly Points[]): string {
  const most = Math.max(...data.map(({ rows }) => rows));
  if (most <= 1) return "";
  return `min to max of ${data.every(({ rows }) => rows === most) ? "" : "up to "}${most} rows`;
}

/** Fetches the points of all lines between two times. */
export function fill(figure: Figure, store: SeriesStore, t0: number, t1: number, points: number, done: (filled: Filled) => void): void {
  const data: Points[] = figure.lines.map(() => NOTHING);
  let missing = figure.lines.length;
  figure.lines.forEach((line, i) =>
    store.want(line.channel, line.source, t0, t1, points, (received) => {
      data[i] = received;
      if (--missing === 0) done({ figure, data });
    }),
  );
}

/**
 * Returns the displayed range; it includes zero if the values are close to it. A controller's first set point
 * may be far beyond all tensions and must not flatten them.
 */
export function valueRange(filled: readonly Filled[]): [number, number] {
  const forces = extent(filled, (line) => line.ink !== "setpoint");
  let [least, greatest] = extent(filled, () => true);
  if (forces[0] <= forces[1]) {
    const far = Math.max(forces[1] - forces[0], 0.1 * Math.abs(forces[1]));
    least = Math.max(least, forces[0] - far);
    greatest = Math.min(greatest, forces[1] + far);
  }
  if (least > greatest) return [0, 1];
  if (least > 0 && least < 0.6 * greatest) least = 0;
  const room = 0.05 * (greatest - least) || 0.05 * Math.abs(greatest) || 1;
  return [least === 0 ? 0 : least - room, greatest + room];
}

function extent(filled: readonly Filled[], counts: (line: Line) => boolean): [number, number] {
  let [least, greatest] = [Infinity, -Infinity];
  for (const { figure, data } of filled) {
    data.forEach((points, i) => {
      if (!counts(figure.lines[i]!)) return;
      for (const value of points.min) if (value !== null && value < least) least = value;
      for (const value of points.max) if (value !== null && value > greatest) greatest = value;
    });
  }
  return [least, greatest];
}
