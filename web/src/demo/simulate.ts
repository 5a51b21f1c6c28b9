// Entry of the npm package (docs/browser.md): runs of experiments in JavaScript.
import type { Complaint, Files, Module } from "./module.js";
import { writeFiles } from "./module.js";
import createModule from "./taut_simulate.mjs";

export type { Complaint, Files } from "./module.js";

export interface SimulateOptions {
  /** Duration [s]; by default the experiment's. */
  duration_s?: number;
  /** Parameters of the files, as with `taut run --set NAME=VALUE`. */
  parameters?: Record<string, number | string>;
  /** Files that are read instead of the shipped files of the same path, or in addition to them. */
  files?: Files;
}

/** Result of a run. */
export interface Simulated {
  /** Name of the experiment. */
  experiment: string;
  /** Time at the end of the run [s]. */
  simulated_s: number;
  /** Hash of the final state: 16 hexadecimal digits, as in the summary of `taut run`. */
  state_hash: string;
  /** Problems such as overloaded members; empty if there are none. */
  status: string;
  /** Largest tension of each cable [N], over every step. */
  max_tension_n: Record<string, number>;
  warnings: Complaint[];
  /** Times of the recorded rows [s]. */
  time_s: Float64Array;
  /** Recorded rows of each channel, such as `trace["system/com_x_m"]`. */
  trace: Record<string, Float64Array>;
  /** Unit of each channel. */
  units: Record<string, string>;
}

/** An experiment has errors. */
export class SimulateError extends Error {
  override readonly name = "SimulateError";

  /** `found`: all errors and warnings. */
  constructor(readonly found: readonly Complaint[]) {
    super(found.filter(({ error }) => error).map(lineOf).join("\n"));
  }
}

interface Answer extends Omit<Simulated, "warnings" | "time_s" | "trace" | "units"> {
  good: boolean;
  found: Complaint[];
  channels: { name: string; unit: string }[];
  rows: number;
}

interface Loaded {
  module: Module;
  shipped: Files;
}

const ROOT = "/taut";
let loading: Promise<Loaded> | null = null;

/**
 * Runs an experiment from start to end and returns its trace. Throws a SimulateError if the files have
 * errors or the run fails. The run occupies the calling thread; in a page, call it in a worker.
 */
export async function simulate(path: string, options: SimulateOptions = {}): Promise<Simulated> {
  const { duration_s, parameters = {}, files = {} } = options;
  if (duration_s !== undefined && !(duration_s >= 0 && duration_s < Infinity)) throw new RangeError(`duration_s is ${duration_s} (expected 0 or more)`);
  const { module, shipped } = await load();
  writeFiles(module, ROOT, files);
  try {
    const answer = JSON.parse(module.ccall("taut_simulate", "string", ["string", "string", "number"], [path, linesOf(parameters), duration_s ?? NaN]) as string) as Answer;
    if (!answer.good) throw new SimulateError(answer.found);
    return resultOf(answer, module);
  } catch (error) {
    if (error instanceof WebAssembly.RuntimeError) loading = null; // its memory may be damaged: the next run loads another
    throw error;
  } finally {
    restore(module, files, shipped);
  }
}

/** Returns the texts of the shipped models, experiments and gaits. */
export async function shippedFiles(): Promise<Files> {
  return { ...(await load()).shipped };
}

function load(): Promise<Loaded> {
  loading ??= start().catch((error: unknown) => {
    loading = null;
    throw error;
  });
  return loading;
}

async function start(): Promise<Loaded> {
  // Bundlers recognize addresses in this form.
  const wasmBinary = await read(new URL("./taut_simulate.wasm", import.meta.url));
  const text = await read(new URL("./files.json", import.meta.url));
  const shipped = JSON.parse(new TextDecoder().decode(text)) as Files;
  const module = await createModule({ wasmBinary });
  writeFiles(module, ROOT, shipped);
  module.FS.chdir(ROOT);
  return { module, shipped };
}

async function read(url: URL): Promise<Uint8Array> {
  if (url.protocol === "file:") {
    const name: string = "node:fs/promises"; // bundlers must not look for it
    const { readFile } = (await import(/* @vite-ignore */ /* webpackIgnore: true */ name)) as { readFile(url: URL): Promise<Uint8Array> };
    return readFile(url);
  }
  const answer = await fetch(url);
  if (!answer.ok) throw new Error(`${url.href}: ${answer.status} ${answer.statusText}`);
  return new Uint8Array(await answer.arrayBuffer());
}

function linesOf(parameters: Record<string, number | string>): string {
  return Object.entries(parameters).map(([name, value]) => {
    if (/[=\n]/.test(name) || /\n/.test(String(value))) throw new RangeError(`parameter ${JSON.stringify(name)} contains "=" or a line break`);
    return `${name}=${value}\n`;
  }).join("");
}

function resultOf({ good, found, channels, rows, ...summary }: Answer, module: Module): Simulated {
  const at = module.ccall("taut_rows", "number", [], []) as number;
  const width = channels.length + 1;
  const values = new Float64Array(module.HEAPU8.buffer, at, rows * width);
  const column = (place: number) => Float64Array.from({ length: rows }, (_, row) => values[row * width + place] as number);
  return {
    ...summary,
    warnings: found,
    time_s: column(0),
    trace: Object.fromEntries(channels.map(({ name }, place) => [name, column(place + 1)])),
    units: Object.fromEntries(channels.map(({ name, unit }) => [name, unit])),
  };
}

function restore(module: Module, files: Files, shipped: Files): void {
  for (const path of Object.keys(files)) {
    const text = shipped[path];
    if (text === undefined) module.FS.unlink(`${ROOT}/${path}`);
    else writeFiles(module, ROOT, { [path]: text });
  }
}

function lineOf({ file, line, column, error, what, hint }: Complaint): string {
  const place = [file, ...[line, column].filter((part) => part > 0)].join(":");
  return `${place === "" ? "" : `${place}: `}${error ? "error" : "warning"}: ${what}${hint === "" ? "" : ` (${hint})`}`;
}
