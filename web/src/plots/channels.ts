// Names of channels, kind/thing/quantity: grouping, search, and labels of lines.
import { nameAndUnit } from "../util";

export interface ChannelName {
  kind: string;
  /** Empty for names of two parts: system/kinetic_j. */
  thing: string;
  quantity: string;
}

export function partsOf(channel: string): ChannelName {
  const parts = channel.split("/");
  const quantity = parts.pop()!;
  return { kind: parts[0] ?? "", thing: parts.slice(1).join("/"), quantity };
}

/** Returns kinds, their things, and their channels; all in order of appearance. */
export function grouped(channels: readonly string[]): Map<string, Map<string, string[]>> {
  const kinds = new Map<string, Map<string, string[]>>();
  for (const channel of channels) {
    const { kind, thing } = partsOf(channel);
    const name = kind === "" ? "other" : kind;
    if (!kinds.has(name)) kinds.set(name, new Map());
    const things = kinds.get(name)!;
    if (!things.has(thing)) things.set(thing, []);
    things.get(thing)!.push(channel);
  }
  return kinds;
}

/** Returns a filter for channels whose names contain every word; `*` in a word stands for any text. */
export function finder(query: string): (channel: string) => boolean {
  const words = query.trim().toLowerCase().split(/\s+/).filter((word) => word !== "");
  const patterns = words.map((word) => new RegExp(word.split("*").map((part) => part.replace(/[.+?^${}()|[\]\\]/g, "\\$&")).join(".*")));
  return (channel) => patterns.every((pattern) => pattern.test(channel.toLowerCase()));
}

/** Returns the shortest distinct labels: the parts that the names do not share. */
export function labelsOf(channels: readonly string[]): string[] {
  const all = channels.map(partsOf);
  const same = (part: keyof ChannelName) => all.every((each) => each[part] === all[0]![part]);
  return all.map(({ kind, thing, quantity }) => {
    const where = thing === "" ? kind : same("kind") ? thing : `${kind} ${thing}`;
    const what = nameAndUnit(quantity)[0];
    if (same("kind") && same("thing")) return what;
    return same("quantity") ? where : `${where} ${what}`;
  });
}

/** Returns the title of a plot of these channels. */
export function titleOf(channels: readonly string[]): string {
  const all = channels.map(partsOf);
  const { kind, thing, quantity } = all[0]!;
  const where = thing === "" ? kind : thing;
  const what = nameAndUnit(quantity)[0];
  if (all.length === 1 && kind === "cable" && quantity === "tension_n") return thing; // the established title of its plot
  if (all.every((each) => each.kind === kind && each.thing === thing)) return all.length === 1 ? `${where} ${what}`.trim() : where;
  return all.every((each) => each.quantity === quantity) ? what : `${all.length} channels`;
}
