// Icons of buttons as SVG paths, because fonts differ in the signs that they contain.
const PATHS = {
  play: "M4 2.5v11l9-5.5z",
  pause: "M4 2.5h3v11H4zM9 2.5h3v11H9z",
  start: "M1.5 2.5h2v11h-2zM9 2.5v11L3.5 8zM14.5 2.5v11L9 8z",
  step: "M3 2.5v11L10 8zM11 2.5h2v11h-2z",
  back: "M13 2.5v11L6 8zM3.5 2.5h1.6v11H3.5z",
  theme: "M8 1.5a6.5 6.5 0 1 1 0 13a6.5 6.5 0 0 1 0-13zM8 3v10a5 5 0 0 0 0-10z",
} as const;

export type Icon = keyof typeof PATHS;

export function icon(name: Icon): SVGElement {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  for (const [key, value] of Object.entries({ viewBox: "0 0 16 16", width: "14", height: "14", "aria-hidden": "true" })) {
    svg.setAttribute(key, value);
  }
  const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
  path.setAttribute("d", PATHS[name]);
  path.setAttribute("fill", "currentColor");
  path.setAttribute("fill-rule", "evenodd");
  svg.append(path);
  return svg;
}
