// Groups of cables with a common tag, one plot each.
import type { Cable } from "../protocol";

export interface CableGroup {
  name: string;
  cables: string[];
}

/** More groups than this are merged: by fewer tags, then into one. */
const MOST_GROUPS = 6;

/** A tag that only distinguishes the copies of a part. */
const POSITION = /^(first|middle|last|\d+)$/;

/**
 * Groups cables by the tags that they share with others; without tags, by the stems of their names. Cables
 * without such a partner form a common group at the end.
 */
export function cableGroups(cables: readonly Pick<Cable, "name" | "tags">[]): CableGroup[] {
  const uses = new Map<string, number>();
  for (const { tags } of cables) for (const tag of tags ?? []) uses.set(tag, (uses.get(tag) ?? 0) + 1);
  const shared = (tags: readonly string[] = []) => tags.filter((tag) => uses.get(tag)! > 1 && !POSITION.test(tag));
  const hasTags = cables.some(({ tags }) => shared(tags).length > 0);
  const stem = (name: string) => name.replace(/[\s_.-]?\d+$/, "");
  const keys = hasTags
    ? [(cable: Pick<Cable, "tags">) => shared(cable.tags).join(" "), (cable: Pick<Cable, "tags">) => shared(cable.tags)[0] ?? ""]
    : [(cable: Pick<Cable, "name">) => stem(cable.name)];
  for (const key of keys) {
    const groups = groupedBy(cables, key);
    if (groups.length <= MOST_GROUPS) return groups;
  }
  return [{ name: "cables", cables: cables.map(({ name }) => name) }];
}

function groupedBy(cables: readonly Pick<Cable, "name" | "tags">[], key: (cable: Pick<Cable, "name" | "tags">) => string): CableGroup[] {
  const groups = new Map<string, string[]>();
  for (const cable of cables) groups.set(key(cable), [...(groups.get(key(cable)) ?? []), cable.name]);
  const large = [...groups].filter(([name, members]) => name !== "" && members.length > 1);
  const inLarge = new Set(large.flatMap(([, members]) => members));
  const rest = cables.map(({ name }) => name).filter((name) => !inLarge.has(name));
  const made = large.map(([name, members]) => ({ name, cables: members }));
  return rest.length > 0 ? [...made, { name: made.length > 0 ? "other cables" : "cables", cables: rest }] : made;
}
