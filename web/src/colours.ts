// Colors distinguishable with color vision deficiency (Okabe and Ito), for both themes, and the color scale
// of tension, whose lightness is monotonic, so that it is readable in gray, too.
import type { Theme } from "./app";

export interface Palette {
  background: string;
  horizon: string;
  ground: string;
  gridMinor: string;
  gridMajor: string;
  text: string;
  rod: string;
  sphere: string;
  box: string;
  hull: string;
  joint: string;
  slack: string;
  contact: string;
  push: string;
  path: string;
  selected: string;
  /** plots: set point, the run */
  setpoint: string;
  own: string;
  /** compared runs, also as ghosts */
  runs: readonly string[];
  grid: string;
  further: readonly string[];
}

const LIGHT: Palette = {
  background: "#dfe7ee", horizon: "#eef2f5", ground: "#e9ecee", gridMinor: "#cfd5da", gridMajor: "#9aa5ae",
  text: "#1c232b", rod: "#39414b", sphere: "#5c6773", box: "#8b97a3", hull: "#8b97a3", joint: "#a0771f", slack: "#6d7781",
  contact: "#009e73", push: "#d55e00", path: "#0072b2", selected: "#e69f00",
  setpoint: "#0072b2", own: "#000000", grid: "#00000018",
  runs: ["#d43a00", "#008a63", "#9a3fb5", "#a87200", "#d6337c", "#66741f", "#7d4b2c"],
  further: ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"],
};

const DARK: Palette = {
  background: "#10151b", horizon: "#1a222b", ground: "#1d252e", gridMinor: "#2b3641", gridMajor: "#51606f",
  text: "#e3e8ed", rod: "#b4bfca", sphere: "#8fa0b0", box: "#64748b", hull: "#64748b", joint: "#b98d3e", slack: "#8c98a4",
  contact: "#2bd4a4", push: "#ff8c42", path: "#56b4e9", selected: "#f0c541",
  setpoint: "#56b4e9", own: "#f2f4f6", grid: "#ffffff1c",
  runs: ["#ff7a45", "#2bd4a4", "#c58cff", "#f0c541", "#ff8fc0", "#b5cc5a", "#d0a37c"],
  further: ["#56b4e9", "#ff8c42", "#2bd4a4", "#e39cc4", "#f0c541", "#8fb8ff"],
};

export function palette(theme: Theme): Palette {
  return theme === "dark" ? DARK : LIGHT;
}

type Rgb = readonly [number, number, number];

// On a light background high values are dark, on a dark background bright.
const SCALES: Record<Theme, readonly Rgb[]> = {
  light: [[86, 180, 233], [56, 130, 205], [90, 70, 190], [140, 30, 140], [150, 0, 60]],
  dark: [[70, 110, 210], [150, 95, 215], [225, 100, 170], [250, 150, 95], [253, 231, 110]],
};

/** Returns the color of a tension, given relative to the end of the scale; components from 0 to 1. */
export function tensionColour(share: number, theme: Theme): Rgb {
  const scale = SCALES[theme];
  const place = Math.min(Math.max(share, 0), 1) * (scale.length - 1);
  const from = scale[Math.floor(place)]!;
  const to = scale[Math.min(Math.floor(place) + 1, scale.length - 1)]!;
  const part = place - Math.floor(place);
  return [0, 1, 2].map((i) => (from[i]! + part * (to[i]! - from[i]!)) / 255) as unknown as Rgb;
}

export function css(colour: Rgb): string {
  return `rgb(${colour.map((value) => Math.round(255 * value)).join(" ")})`;
}
