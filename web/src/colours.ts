// Colors distinguishable with color vision deficiency (Okabe and Ito), for both themes, and perceptually
// uniform color scales, whose lightness is monotonic, so that they are readable in gray, too.
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
  /** plots: line of the set point; the next: line of the displayed run */
  setpoint: string;
  own: string;
  /** lines and ghosts of the compared runs */
  runs: readonly string[];
  grid: string;
  further: readonly string[];
  /** Lightness (OKLCH) of lines distinguished by hue. */
  lineLightness: number;
}

const LIGHT: Palette = {
  background: "#dfe7ee", horizon: "#eef2f5", ground: "#e9ecee", gridMinor: "#cfd5da", gridMajor: "#9aa5ae",
  text: "#1c232b", rod: "#39414b", sphere: "#5c6773", box: "#8b97a3", hull: "#8b97a3", joint: "#a0771f", slack: "#6d7781",
  contact: "#009e73", push: "#d55e00", path: "#0072b2", selected: "#e69f00",
  setpoint: "#0072b2", own: "#000000", grid: "#00000018",
  runs: ["#d43a00", "#008a63", "#9a3fb5", "#a87200", "#d6337c", "#66741f", "#7d4b2c"],
  further: ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"], lineLightness: 0.58,
};

const DARK: Palette = {
  background: "#10151b", horizon: "#1a222b", ground: "#1d252e", gridMinor: "#2b3641", gridMajor: "#51606f",
  text: "#e3e8ed", rod: "#b4bfca", sphere: "#8fa0b0", box: "#64748b", hull: "#64748b", joint: "#b98d3e", slack: "#8c98a4",
  contact: "#2bd4a4", push: "#ff8c42", path: "#56b4e9", selected: "#f0c541",
  setpoint: "#56b4e9", own: "#f2f4f6", grid: "#ffffff1c",
  runs: ["#ff7a45", "#2bd4a4", "#c58cff", "#f0c541", "#ff8fc0", "#b5cc5a", "#d0a37c"],
  further: ["#56b4e9", "#ff8c42", "#2bd4a4", "#e39cc4", "#f0c541", "#8fb8ff"], lineLightness: 0.76,
};

export function palette(theme: Theme): Palette {
  return theme === "dark" ? DARK : LIGHT;
}

export type Rgb = readonly [number, number, number];
/** Returns the color at a place on a scale. */
export type ColourScale = (share: number, theme: Theme) => Rgb;

// Samples of matplotlib's viridis, whose steps look equal (CAM02-UCS), in steps of 1/16. The bright end is
// left out on a light background, the dark end on a dark one; high tensions have the most contrast.
const VIRIDIS: readonly Rgb[] = [
  [68, 1, 84], [72, 24, 106], [71, 45, 123], [66, 64, 134], [59, 82, 139], [51, 99, 141], [44, 114, 142], [38, 130, 142], [33, 145, 140],
  [31, 160, 136], [40, 174, 128], [63, 188, 115], [94, 201, 98], [132, 212, 75], [173, 220, 48], [216, 226, 25], [253, 231, 37],
];
const SCALES: Record<Theme, readonly Rgb[]> = { light: [...VIRIDIS.slice(0, 14)].reverse(), dark: VIRIDIS.slice(4) };
// Compression of struts: from the neutral color of a strut to a strong red, which viridis does not contain.
const COMPRESSION: Record<Theme, readonly Rgb[]> = {
  light: [[57, 65, 75], [105, 58, 60], [145, 48, 44], [182, 37, 28], [215, 25, 10]],
  dark: [[180, 191, 202], [205, 174, 164], [226, 157, 125], [242, 140, 86], [255, 122, 46]],
};
// Strain of a mode: shorter blue, unchanged neutral, longer orange.
const STRAIN: Record<Theme, readonly Rgb[]> = {
  light: [[0, 84, 159], [78, 132, 178], [140, 146, 152], [201, 128, 76], [196, 78, 0]],
  dark: [[86, 180, 233], [120, 168, 200], [150, 158, 166], [224, 158, 108], [255, 140, 66]],
};

/** Returns the color at a share (0 to 1) of a scale of evenly spaced colors; components from 0 to 1. */
function colourAt(scale: readonly Rgb[], share: number): Rgb {
  const place = Math.min(Math.max(share, 0), 1) * (scale.length - 1);
  const from = scale[Math.floor(place)]!;
  const to = scale[Math.min(Math.floor(place) + 1, scale.length - 1)]!;
  const part = place - Math.floor(place);
  return [0, 1, 2].map((i) => (from[i]! + part * (to[i]! - from[i]!)) / 255) as unknown as Rgb;
}

/** Returns the color of a tension, relative to the end of the scale. */
export const tensionColour = (share: number, theme: Theme): Rgb => colourAt(SCALES[theme], share);
/** Returns the color of a strut's compression, relative to the end of the scale. */
export const compressionColour = (share: number, theme: Theme): Rgb => colourAt(COMPRESSION[theme], share);
/** Returns the color of a member's utilization; above 1, where the member fails, it is red. */
export const useColour: ColourScale = (share, theme) => colourAt(share > 1 ? COMPRESSION[theme].slice(-1) : SCALES[theme], share);
/** Returns the color of an axial force from -1 (compression) to 1 (tension), relative to the largest. */
export const forceColour: ColourScale = (share, theme) => colourAt(STRAIN[theme], 0.5 - 0.5 * share);
/** Returns the color of a strain from -1 to 1, relative to the largest. */
export const strainColour = (share: number, theme: Theme): Rgb => colourAt(STRAIN[theme], 0.5 + 0.5 * share);

const CHROMA = 0.13; // of lines distinguished by hue; larger ones exceed sRGB at some hues

/** Returns a color of the hue wheel (share: 0 to 1) of constant lightness and chroma (OKLCH). */
export function hueColour(share: number, lightness: number): string {
  const angle = 2 * Math.PI * share + 0.5;
  const [a, b] = [CHROMA * Math.cos(angle), CHROMA * Math.sin(angle)];
  const [l, m, s] = [lightness + 0.3963377774 * a + 0.2158037573 * b, lightness - 0.1055613458 * a - 0.0638541728 * b,
    lightness - 0.0894841775 * a - 1.291485548 * b].map((each) => each ** 3) as [number, number, number];
  const linear = [4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s, -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s];
  const channel = (c: number) => {
    const x = Math.min(Math.max(c, 0), 1);
    return Math.round(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055)).toString(16).padStart(2, "0");
  };
  return `#${linear.map(channel).join("")}`;
}

export function css(colour: Rgb): string {
  return `rgb(${colour.map((value) => Math.round(255 * value)).join(" ")})`;
}
