// Share links: the part of an address after # contains the displayed file and the edited texts. Anybody can
// write a link, so every part of it is checked.
import type { Files } from "./core";

/** Maximum length of an address: longer than any of the files needs, and within the limits of browsers. */
const MOST_CHARACTERS = 60_000;
/** Maximum size of the unpacked texts; a few packed bytes could become gigabytes. */
const MOST_BYTES = 4_000_000;

const DAMAGED = "the link is damaged: a part may be missing";

export interface Shared {
  path: string;
  edits: Files;
}

/** Returns the part of an address after #. */
export async function fragmentOf({ path, edits }: Shared): Promise<string> {
  if (Object.keys(edits).length === 0) return `#${path}`;
  const bytes = new TextEncoder().encode(JSON.stringify({ path, edits }));
  const fragment = `#=${base64Of(await through(new CompressionStream("deflate-raw"), bytes))}`;
  if (fragment.length > MOST_CHARACTERS || bytes.length > MOST_BYTES) {
    throw new Error("the texts are too long for a link: download the files instead");
  }
  return fragment;
}

/**
 * Returns the content of a link; null: none. Throws an error with a message if the link is damaged, too long, or
 * refers to missing files.
 */
export async function sharedBy(fragment: string, shipped: Files): Promise<Shared | null> {
  if (fragment === "" || fragment === "#") return null;
  if (fragment.length > MOST_CHARACTERS) throw new Error(`the link is longer than ${MOST_CHARACTERS} characters`);
  const known = (name: string) => Object.prototype.hasOwnProperty.call(shipped, name);
  if (!fragment.startsWith("#=")) {
    const path = decoded(fragment.slice(1));
    if (!known(path)) throw new Error(`there is no file "${path}"`);
    return { path, edits: {} };
  }
  let shared: unknown;
  try {
    const packed = atob(fragment.slice(2).replace(/-/g, "+").replace(/_/g, "/"));
    const bytes = await through(new DecompressionStream("deflate-raw"), Uint8Array.from(packed, (c) => c.charCodeAt(0)));
    shared = JSON.parse(new TextDecoder().decode(bytes));
  } catch (error) {
    throw error instanceof TooLarge ? error : new Error(DAMAGED);
  }
  if (!isObject(shared)) throw new Error(DAMAGED);
  const { path, edits } = shared as Partial<Shared>;
  const texts = isObject(edits) ? Object.entries(edits) : [];
  if (typeof path !== "string" || texts.some(([name, text]) => !known(name) || typeof text !== "string")) {
    throw new Error("the link belongs to another version of this page: it refers to unknown files");
  }
  if (!known(path)) throw new Error(`there is no file "${path}"`);
  return { path, edits: Object.fromEntries(texts) };
}

class TooLarge extends Error {}

const isObject = (value: unknown): value is object => typeof value === "object" && value !== null;

function decoded(text: string): string {
  try {
    return decodeURIComponent(text);
  } catch {
    throw new Error(DAMAGED);
  }
}

/** Encodes in pieces: a function has a maximum number of arguments. */
function base64Of(bytes: Uint8Array): string {
  const PIECE = 8192;
  let text = "";
  for (let at = 0; at < bytes.length; at += PIECE) text += String.fromCharCode(...bytes.subarray(at, at + PIECE));
  return btoa(text).replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, "");
}

/** Packs or unpacks. Throws `TooLarge` before more than `MOST_BYTES` are in memory. */
async function through(stream: CompressionStream | DecompressionStream, bytes: Uint8Array): Promise<Uint8Array> {
  const written = new Blob([bytes as BlobPart]).stream().pipeThrough(stream as ReadableWritablePair<Uint8Array, Uint8Array>);
  const parts: Uint8Array[] = [];
  const reader = written.getReader();
  for (let size = 0; ; ) {
    const { done, value } = await reader.read();
    if (done) break;
    parts.push(value);
    if ((size += value.length) > MOST_BYTES) {
      await reader.cancel();
      throw new TooLarge(`the link unpacks to more than ${MOST_BYTES / 1e6} MB`);
    }
  }
  return new Uint8Array(await new Blob(parts as BlobPart[]).arrayBuffer());
}
