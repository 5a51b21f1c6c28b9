// The names of channels: kind/thing/quantity. How they are grouped, searched, and called beside a line.
import { nameAndUnit } from "../util";

export interface ChannelName {
  kind: string;
  /** Empty where there is but one: system/kinetic_j. */
  thing: string;
  quantity: string;
}

export function partsOf(channel: string): ChannelName {
  const parts = channel.split("/");
  const quantity = parts.pop()!;
  return { kind: parts[0] ?? "", thing: parts.slice(1).join("/"), quantity };
}

/** Kinds, in them things, in them channels; all in the order in which they come. */
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

/** Does a channel have every word somewhere in its name? `*` in a word stands for any text. */
export function finder(query: string): (channel: string) => boolean {
  const words = query.trim().toLowerCase().split(/\s+/).filter((word) => word !== "");
  const patterns = words.map((word) => new RegExp(word.split("*").map((part) => part.replace(/[.+?^${}()|[\]\\]/g, "\\$&")).join(".*")));
  return (channel) => patterns.every((pattern) => pattern.test(channel.toLowerCase()));
}

/** As short as it can be beside the others: by what they do not share. */
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

/** What to call a plot of these. */
export function titleOf(channels: readonly string[]): string {
  const all = channels.map(partsOf);
  const { kind, thing, quantity } = all[0]!;
  const where = thing === "" ? kind : thing;
  const what = nameAndUnit(quantity)[0];
  if (all.length === 1 && kind === "cable" && quantity === "tension_n") return thing; // as its plot has always been called
  if (all.every((each) => each.kind === kind && each.thing === thing)) return all.length === 1 ? `${where} ${what}`.trim() : where;
  return all.every((each) => each.quantity === quantity) ? what : `${all.length} channels`;
}
