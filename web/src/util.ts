// Common helpers: observable values, elements of the page, number formats.

export class Signal<T> {
  private readonly watchers = new Set<(value: T) => void>();
  constructor(private current: T) {}

  get value(): T {
    return this.current;
  }

  set value(next: T) {
    if (Object.is(next, this.current)) return;
    this.current = next;
    for (const watcher of [...this.watchers]) watcher(next);
  }

  /** Calls `watcher` now and at every change, until the returned function is called. */
  watch(watcher: (value: T) => void): () => void {
    this.watchers.add(watcher);
    watcher(this.current);
    return () => this.watchers.delete(watcher);
  }
}

type Attributes = Record<string, string | number | boolean | ((event: never) => void)>;

/** el("button.primary", {onclick: f, "aria-label": "x"}, "text", child). */
export function el<T extends HTMLElement = HTMLElement>(
  spec: string,
  attributes: Attributes = {},
  ...children: (Node | string)[]
): T {
  const [tag, ...classes] = spec.split(".");
  const element = document.createElement(tag || "div");
  if (classes.length > 0) element.className = classes.join(" ");
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") element.addEventListener(name.slice(2), value as EventListener);
    else if (typeof value === "boolean") element.toggleAttribute(name, value);
    else element.setAttribute(name, String(value));
  }
  element.append(...children);
  return element as T;
}

/** Attributes that make the frame of a wide table scrollable by keyboard. */
export const SCROLLS = { tabindex: 0, role: "region", "aria-label": "table, scrollable horizontally" } as const;

/**
 * Returns a button with an accessible label and a tooltip. The label begins with the visible words, by which
 * users of speech input choose it.
 */
export function button(label: string | Node, title: string, onclick: () => void, spec = "button"): HTMLButtonElement {
  const isWord = typeof label === "string" && /[\p{L}\p{N}]/u.test(label);
  const name = isWord && !title.startsWith(label) ? `${label}: ${title}` : title;
  return el<HTMLButtonElement>(spec, { type: "button", title, "aria-label": name, onclick }, label);
}

/** Returns a button that unfolds an element (class open); the caller may create the element later. */
export function foldButton(title: string, spec: string, element: () => HTMLElement): HTMLButtonElement {
  const made = button("⋯", title, () => made.setAttribute("aria-expanded", String(element().classList.toggle("open"))), spec);
  made.setAttribute("aria-expanded", "false");
  return made;
}

/** Formats a number of things: "1 state", "2 states". */
export function counted(count: number, what: string): string {
  return `${count} ${what}${count === 1 ? "" : "s"}`;
}

export function number(value: number, digits = 3): string {
  if (!Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  if (size !== 0 && (size >= 1e5 || size < 1e-3)) return value.toExponential(digits - 1);
  if (Number.isInteger(value)) return String(value).replace("-", "−");
  // the size after rounding: 9.9996 has three digits as "10.0", not "10.00"
  const decimals = size === 0 ? 0 : Math.max(0, digits - 1 - Math.floor(Math.log10(Number(size.toPrecision(digits)))));
  return value.toFixed(Math.min(decimals, 6)).replace("-", "−");
}

/** Formats a unit: "m/s^2" -> "m/s²"; empty for "1". */
export function unitText(unit: string): string {
  return unit === "1" ? "" : unit.replace(/\^2/g, "²").replace(/\^3/g, "³");
}

const UNITS: Record<string, string> = { m: "m", s: "s", kg: "kg", n: "N", j: "J", w: "W", hz: "Hz", rad: "rad", pa: "Pa" };

function unitOfWord(word: string): string {
  const [, written = "", power = ""] = /^([a-z]+)([23]?)$/.exec(word) ?? [];
  return UNITS[written] === undefined ? "" : UNITS[written] + { "": "", 2: "²", 3: "³" }[power as "" | "2" | "3"];
}

/**
 * "max_speed_m_per_s" -> ["max speed", "m/s"]; a unit consists of all words at the end that belong to units,
 * as in UnitOfName (taut/trace.h).
 */
export function nameAndUnit(name: string): [string, string] {
  const words = name.split("_");
  let from = words.length;
  while (from > 1 && (words[from - 1] === "per" || unitOfWord(words[from - 1]!) !== "")) --from;
  const [over, under, ...more] = words.slice(from).join(" ").split(/ ?per ?/).map((part) => part === "" ? [] : part.split(" ").map(unitOfWord));
  if (over!.length === 0 || under?.length === 0 || more.length > 0) return [words.join(" "), ""];
  const below = under === undefined ? "" : under.length > 1 ? `/(${under.join(" ")})` : `/${under[0]}`;
  return [words.slice(0, from).join(" "), over!.join(" ") + below];
}

/** Formats 12.345 s as "0:12.35"; long times include hours. */
export function clock(time_s: number, decimals = 2): string {
  if (!Number.isFinite(time_s)) return "–";
  const scale = 10 ** decimals;
  const total = Math.round(Math.abs(time_s) * scale) / scale;
  const hours = Math.floor(total / 3600);
  const minutes = Math.floor((total % 3600) / 60);
  const seconds = (total % 60).toFixed(decimals).padStart(decimals > 0 ? decimals + 3 : 2, "0");
  const sign = time_s < 0 ? "−" : "";
  return hours > 0
    ? `${sign}${hours}:${String(minutes).padStart(2, "0")}:${seconds}`
    : `${sign}${minutes}:${seconds}`;
}

/** Formats a tick of an axis: short, without zeros at the end. */
export function tickText(value: number): string {
  const rounded = +value.toPrecision(6);
  const size = Math.abs(rounded);
  const text = size !== 0 && (size < 1e-3 || size >= 1e5) ? rounded.toExponential().replace("e+", "e") : String(rounded);
  return text.replace(/-/g, "−");
}

const NICE = [1, 1.5, 2, 3, 4, 5, 6, 8, 10];

/** Returns the smallest of 1, 1.5, 2, 3, ... times a power of ten that is not less than the value. */
export function niceAbove(value: number): number {
  if (!(value > 0) || !Number.isFinite(value)) return 1;
  const power = 10 ** Math.floor(Math.log10(value));
  return (NICE.find((factor) => factor * power >= value * (1 - 1e-9)) ?? 10) * power;
}

/** Returns the index of the last element <= value in an ascending list; -1 if there is none. */
export function lastAtMost(list: ArrayLike<number>, value: number): number {
  let low = 0;
  let high = list.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (list[middle]! <= value) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

export function download(name: string, content: Blob): void {
  const link = el<HTMLAnchorElement>("a", { href: URL.createObjectURL(content), download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** Browser storage between visits, which a page opened from disk may not be allowed to use. */
export const memory = {
  get(key: string): string | null {
    try {
      return localStorage.getItem(`taut.${key}`);
    } catch {
      return null;
    }
  },
  set(key: string, value: string): void {
    try {
      localStorage.setItem(`taut.${key}`, value);
    } catch {
      // without storage, the value is lost
    }
  },
};
