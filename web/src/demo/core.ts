// Simulation core in WebAssembly (apps/browser) with its files in an in-memory file system.

import { type Complaint, type CreateModule, type Files, type Module, writeFiles } from "./module.js";
export type { Complaint, Files } from "./module.js";

export interface Checked {
  good: boolean;
  kind: "experiment" | "model" | "";
  /** All files read, the main file first; empty if unknown. */
  files: string[];
  found: Complaint[];
}

export interface Mark {
  time_s: number;
  /** Hash of the state: 16 hexadecimal digits. */
  hash: string;
}

/** State of a run, see apps/browser/demo.h. */
export interface RunState extends Mark {
  path: string;
  touched: boolean;
  set: Record<string, string>;
  marks: Mark[];
}

const SHOWN = "/shown";
const DRAFT = "/draft";

export class Core {
  private shipped: Files = {};
  private readonly edited = new Map<string, Files>();

  private constructor(private readonly module: Module) {}

  /**
   * Loads the core. `url`: of taut_core.mjs, with the .wasm in the same folder. `more`: options for
   * emscripten, for environments without fetch.
   */
  static async load(url: string, more: { wasmBinary?: Uint8Array } = {}): Promise<Core> {
    const { default: create } = (await import(/* @vite-ignore */ url)) as { default: CreateModule };
    return new Core(await create(more));
  }

  /** Sets the shipped files. */
  give(files: Files): void {
    this.shipped = files;
    for (const root of [SHOWN, DRAFT]) writeFiles(this.module, root, files);
    this.module.FS.chdir(SHOWN);
  }

  /** Checks a file with `edits` in place of the shipped or given files, without effect on the run. */
  check(path: string, edits: Files): Checked {
    this.edit(DRAFT, edits);
    this.module.FS.chdir(DRAFT);
    const checked = this.ask("taut_check", path);
    this.module.FS.chdir(SHOWN);
    return JSON.parse(checked) as Checked;
  }

  /** Runs a file. If it has errors, the previous run continues. */
  open(path: string, edits: Files, mark_at_s: readonly number[], paused: boolean): Checked {
    const checked = this.check(path, edits);
    if (!checked.good) return checked;
    this.edit(SHOWN, edits);
    const answer = this.module.ccall("taut_open", "string", ["string", "string", "number"], [path, mark_at_s.join(" "), paused ? 1 : 0]);
    return JSON.parse(answer as string) as Checked;
  }

  /** Sends a message of the viewer's protocol; returns an error message, or an empty string. */
  post(message: string): string {
    return this.ask("taut_post", message);
  }

  /** Advances for some milliseconds; returns the time until the next call [ms]. */
  turn(): number {
    return this.module.ccall("taut_turn", "number", [], []) as number;
  }

  messages(): unknown[] {
    return JSON.parse(this.module.ccall("taut_messages", "string", [], []) as string) as unknown[];
  }

  /** Returns the newest frame; null: none since the last call. */
  frame(): ArrayBuffer | null {
    const at = this.module.ccall("taut_frame", "number", [], []) as number;
    if (at === 0) return null;
    const size = this.module.ccall("taut_frame_size", "number", [], []) as number;
    return this.module.HEAPU8.slice(at, at + size).buffer as ArrayBuffer;
  }

  state(): RunState | null {
    return JSON.parse(this.module.ccall("taut_state", "string", [], []) as string) as RunState | null;
  }

  private ask(name: string, text: string): string {
    return this.module.ccall(name, "string", ["string"], [text]) as string;
  }

  /** Writes the shipped files with these edits. */
  private edit(root: string, edits: Files): void {
    const before = Object.keys(this.edited.get(root) ?? {});
    writeFiles(this.module, root, Object.fromEntries(before.map((path) => [path, this.shipped[path] ?? ""])));
    writeFiles(this.module, root, edits);
    this.edited.set(root, edits);
  }
}
