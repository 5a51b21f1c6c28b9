// State of the demo: the displayed file, and edits of it and of the files that it reads. A link contains
// both.
import { Signal } from "../util";
import type { Checked, Complaint, Files } from "./core";

/** Maximum length of an address: longer than any of the files needs, and within the limits of browsers. */
const MOST_CHARACTERS = 60_000;

export interface Shared {
  path: string;
  edits: Files;
}

export class Project {
  readonly path = new Signal<string>("");
  /** Files of the project, the main file first. */
  readonly files = new Signal<readonly string[]>([]);
  readonly found = new Signal<readonly Complaint[]>([]);
  readonly good = new Signal<boolean>(true);
  /** Increases with every change of a text. */
  readonly version = new Signal<number>(0);
  edits: Files = {};
  /** Whether the displayed run began from changed files. */
  ran = false;

  constructor(readonly shipped: Files) {}

  text(path: string): string {
    return this.edits[path] ?? this.shipped[path] ?? "";
  }

  get edited(): boolean {
    return Object.keys(this.edits).length > 0;
  }

  isEdited(path: string): boolean {
    return this.edits[path] !== undefined;
  }

  write(path: string, text: string): void {
    if (text === this.shipped[path]) delete this.edits[path];
    else this.edits[path] = text;
    this.version.value += 1;
  }

  /** Selects another file, or reloads the same one. */
  choose({ path, edits }: Shared): void {
    this.edits = { ...edits };
    this.files.value = [path];
    this.found.value = [];
    this.path.value = path;
    this.version.value += 1;
  }

  learn(checked: Checked): void {
    this.found.value = checked.found;
    this.good.value = checked.good;
    // with errors the list of files read is incomplete: the previous files stay visible
    const files = checked.files.filter((file) => this.shipped[file] !== undefined || this.isEdited(file));
    const more = checked.found.map(({ file }) => file).filter((file) => file !== "" && this.text(file) !== "");
    const known = files.length > 0 ? files : this.files.value;
    const all = [...new Set([this.path.value, ...known, ...more])];
    if (all.join("\n") !== this.files.value.join("\n")) this.files.value = all;
  }
}

/** Returns the part of an address after #. */
export async function fragmentOf({ path, edits }: Shared): Promise<string> {
  if (Object.keys(edits).length === 0) return `#${path}`;
  const text = JSON.stringify({ path, edits });
  const bytes = await through(new CompressionStream("deflate-raw"), new TextEncoder().encode(text));
  const fragment = `#=${btoa(String.fromCharCode(...bytes)).replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, "")}`;
  if (fragment.length > MOST_CHARACTERS) throw new Error("the texts are too long for a link: download the files instead");
  return fragment;
}

/**
 * Returns the content of a link; null: none. Throws an error with a message if the link is damaged or refers
 * to missing files.
 */
export async function sharedBy(fragment: string, shipped: Files): Promise<Shared | null> {
  if (fragment === "" || fragment === "#") return null;
  if (!fragment.startsWith("#=")) {
    const path = decodeURIComponent(fragment.slice(1));
    if (shipped[path] === undefined) throw new Error(`there is no file "${path}"`);
    return { path, edits: {} };
  }
  let shared: unknown;
  try {
    const packed = atob(fragment.slice(2).replace(/-/g, "+").replace(/_/g, "/"));
    const bytes = await through(new DecompressionStream("deflate-raw"), Uint8Array.from(packed, (c) => c.charCodeAt(0)));
    shared = JSON.parse(new TextDecoder().decode(bytes));
  } catch {
    throw new Error("the link is damaged: a part may be missing");
  }
  const { path, edits } = shared as Partial<Shared>;
  const texts = typeof edits === "object" && edits !== null ? Object.entries(edits) : [];
  if (typeof path !== "string" || texts.some(([name, text]) => shipped[name] === undefined || typeof text !== "string")) {
    throw new Error("the link belongs to another version of this page: it refers to unknown files");
  }
  if (shipped[path] === undefined) throw new Error(`there is no file "${path}"`);
  return { path, edits: edits ?? {} };
}

async function through(stream: CompressionStream | DecompressionStream, bytes: Uint8Array): Promise<Uint8Array> {
  const written = new Blob([bytes as BlobPart]).stream().pipeThrough(stream as ReadableWritablePair<Uint8Array, Uint8Array>);
  return new Uint8Array(await new Response(written).arrayBuffer());
}
