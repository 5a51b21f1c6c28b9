// Export of plots: SVG in print colors, PNG rendered from it, CSV of the displayed data.
import { palette } from "../colours";
import type { Points } from "../points";
import { download, tickText } from "../util";
import { coarseness, type Filled, ink, isDashed, valueRange } from "./figure";
import { linesOf } from "./key";

interface Cell { width: number; height: number; left: number; right: number; top: number; bottom: number }
const SMALL: Cell = { width: 300, height: 170, left: 42, right: 10, top: 22, bottom: 36 };
/** Size of a single figure, for one of two columns of a paper. */
const LARGE: Cell = { width: 600, height: 320, left: 50, right: 12, top: 24, bottom: 38 };
const KEY_PX = 26;

export function exportSvg(filled: Filled[], span: readonly [number, number], name: string): void {
  download(`${fileName(name)}.svg`, new Blob([svg(filled, span)], { type: "image/svg+xml" }));
}

export async function exportPng(filled: Filled[], span: readonly [number, number], name: string): Promise<void> {
  download(`${fileName(name)}.png`, await png(filled, span));
}

/** Copies a picture of the plots to the clipboard. Returns the reason of a failure; null: none. */
export async function copyPng(filled: Filled[], span: readonly [number, number]): Promise<string | null> {
  if (!navigator.clipboard?.write) return "this browser lets pages copy pictures only from localhost, files or https";
  try {
    // the promise itself, because Safari permits copying only within the click
    await navigator.clipboard.write([new ClipboardItem({ "image/png": png(filled, span) })]);
    return null;
  } catch (error) {
    return error instanceof Error ? error.message : String(error);
  }
}

async function png(filled: Filled[], span: readonly [number, number]): Promise<Blob> {
  const text = svg(filled, span);
  const image = new Image();
  const loaded = new Promise<void>((resolve, reject) => {
    image.onload = () => resolve();
    image.onerror = () => reject(new Error("the browser cannot draw the plot"));
  });
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(text)}`;
  await loaded;
  const canvas = document.createElement("canvas");
  canvas.width = 3 * image.width;
  canvas.height = 3 * image.height;
  canvas.getContext("2d")!.drawImage(image, 0, 0, canvas.width, canvas.height);
  return new Promise((resolve, reject) => canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("the browser cannot encode the picture"))), "image/png"));
}

/**
 * Exports the rows at the times of the drawn points; for coarser points also minimum and maximum of the rows
 * up to the next.
 */
export function exportCsv(filled: Filled[], name: string): void {
  download(`${fileName(name)}.csv`, new Blob([csv(filled)], { type: "text/csv" }));
}

export function csv(filled: readonly Filled[]): string {
  const columns = new Map<string, Map<number, number | null>>();
  const add = (label: string, t: number[], values: (number | null)[]) => {
    if (!columns.has(label)) columns.set(label, new Map(t.map((time_s, i) => [time_s, values[i] ?? null])));
  };
  for (const { figure, data } of filled) {
    figure.lines.forEach((line, i) => {
      const points = data[i]!;
      const label = line.source > 0 ? `${columnName(line.label)}:${line.channel}` : line.channel;
      add(label, points.t, points.first);
      if (points.rows > 1) {
        add(`${label}:min of ${points.rows} rows`, points.t, points.min);
        add(`${label}:max of ${points.rows} rows`, points.t, points.max);
      }
    });
  }
  const times = [...new Set([...columns.values()].flatMap((column) => [...column.keys()]))].sort((a, b) => a - b);
  const rows = times.map((time_s) => [time_s, ...[...columns.values()].map((column) => column.get(time_s) ?? "")].join(","));
  return [["time_s", ...columns.keys()].join(","), ...rows, ""].join("\n");
}

/** Removes commas and quotes, which a header line may have only between its columns. */
function columnName(label: string): string {
  return label.replace(/[",\r\n]/g, " ");
}

export function svg(filled: readonly Filled[], span: readonly [number, number]): string {
  const across = Math.min(filled.length, filled.length > 4 ? 3 : 2);
  const CELL = filled.length === 1 ? LARGE : SMALL;
  const down = Math.ceil(filled.length / across);
  const width = across * CELL.width;
  const height = down * CELL.height + KEY_PX;
  const tensions = filled.filter(({ figure }) => figure.group === "tension");
  const shared = tensions.length > 1 ? valueRange(tensions) : null;
  const cells = filled.map((each, i) => {
    const range = shared && each.figure.group === "tension" ? shared : valueRange([each]);
    const place = `translate(${(i % across) * CELL.width} ${Math.floor(i / across) * CELL.height})`;
    return `<g transform="${place}">${cell(each, span, range, CELL)}</g>`;
  });
  return `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}" font-family="sans-serif" font-size="11">
<rect width="100%" height="100%" fill="#fff"/>
${cells.join("\n")}
<g transform="translate(${CELL.left} ${down * CELL.height + 16})">${keyOf(filled)}</g>
</svg>
`;
}

function cell({ figure, data }: Filled, [t0, t1]: readonly [number, number], [y0, y1]: [number, number], CELL: Cell): string {
  const right = CELL.width - CELL.right;
  const bottom = CELL.height - CELL.bottom;
  const x = (t: number) => CELL.left + ((t - t0) / (t1 - t0)) * (right - CELL.left);
  const y = (v: number) => bottom - ((v - y0) / (y1 - y0)) * (bottom - CELL.top);
  const parts = [`<text x="${CELL.left}" y="15" font-weight="600">${escape(figure.title)}${figure.unit ? ` [${escape(figure.unit)}]` : ""}</text>`];
  const coarse = coarseness(data);
  if (coarse) parts.push(`<text x="${right}" y="15" text-anchor="end" font-size="9" fill="#666">${coarse}</text>`);
  for (const tick of ticks(y0, y1, 4)) {
    parts.push(`<path d="M${CELL.left} ${y(tick).toFixed(1)}H${right}" stroke="#ddd"/><text x="${CELL.left - 4}" y="${(y(tick) + 4).toFixed(1)}" text-anchor="end">${tickText(tick)}</text>`);
  }
  for (const tick of ticks(t0, t1, 5)) {
    parts.push(`<path d="M${x(tick).toFixed(1)} ${CELL.top}V${bottom}" stroke="#eee"/><text x="${x(tick).toFixed(1)}" y="${bottom + 14}" text-anchor="middle">${tickText(tick)}</text>`);
  }
  parts.push(`<text x="${(CELL.left + right) / 2}" y="${bottom + 28}" text-anchor="middle">time [s]</text>`);
  parts.push(`<svg x="${CELL.left}" y="${CELL.top}" width="${right - CELL.left}" height="${bottom - CELL.top}" viewBox="${CELL.left} ${CELL.top} ${right - CELL.left} ${bottom - CELL.top}">`);
  figure.lines.forEach((line, i) => {
    const colour = ink(palette("light"), line.ink);
    const points = data[i]!;
    const draw = (values: Points["min"]) => parts.push(`<path d="${path(points.t, values, x, y)}" fill="none" stroke="${colour}" stroke-width="1.2"${isDashed(line.ink) ? ' stroke-dasharray="5 4"' : ""}/>`);
    draw(points.min);
    if (points.rows === 1) return;
    parts.push(`<path d="${band(points, x, y)}" fill="${colour}" fill-opacity="0.38"/>`);
    draw(points.max);
  });
  parts.push(`</svg><path d="M${CELL.left} ${CELL.top}V${bottom}H${right}" fill="none" stroke="#444"/>`);
  return parts.join("");
}

type Scale = (value: number) => number;

function path(t: readonly number[], values: readonly (number | null)[], x: Scale, y: Scale): string {
  let pen = "M";
  let text = "";
  values.forEach((value, i) => {
    if (value === null) return;
    text += `${pen}${x(t[i]!).toFixed(1)} ${y(value).toFixed(1)}`;
    pen = "L";
  });
  return text;
}

function band(points: Points, x: Scale, y: Scale): string {
  const back = path([...points.t].reverse(), [...points.min].reverse(), x, y).replace(/^M/, "L");
  return `${path(points.t, points.max, x, y)}${back}Z`;
}

function keyOf(filled: readonly Filled[]): string {
  let left = 0;
  return [...linesOf(filled.map(({ figure }) => figure))].map(([label, which]) => {
    const text = `<path d="M${left} -4h18" stroke="${ink(palette("light"), which)}" stroke-width="2"/><text x="${left + 23}">${escape(label)}</text>`;
    left += 40 + 6.5 * label.length;
    return text;
  }).join("");
}

/** Returns about `count` round values between two. */
export function ticks(from: number, to: number, count: number): number[] {
  const raw = (to - from) / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = power * ([1, 2, 5, 10].find((factor) => factor * power >= raw * 0.99) ?? 10);
  const found: number[] = [];
  for (let i = Math.ceil(from / step - 1e-9); i * step <= to + 1e-9 * step; ++i) found.push(i * step);
  return found;
}

function escape(text: string): string {
  return text.replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);
}

function fileName(name: string): string {
  return `taut-${name.replace(/[^\w.-]+/g, "-")}`;
}
