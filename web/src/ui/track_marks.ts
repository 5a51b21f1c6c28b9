// Marks on the time bar: phases, pushes and drags, events; and a label with the time under the mouse and all
// that happens then.
import type { App } from "../app";
import type { Action, EventMessage, Scene } from "../protocol";
import { clock, el, number } from "../util";

/** Largest distance from the mouse at which an event is labeled. */
const REACH_PX = 6;
const LABEL_PX = 7; // approximate width of a letter

interface Overload { kind: string; name: string; limit: string; first_time_s: number }

/** Returns the events of a run: those that the server reported, and members that exceeded a limit. */
export function eventsOf(app: App): { time_s: number; text: string }[] {
  const summary = (app.report?.summary ?? app.scene.value?.summary ?? null) as { overloads?: Overload[] } | null;
  const overloads = (summary?.overloads ?? []).map(({ kind, name, limit, first_time_s }) => ({ time_s: first_time_s, text: `${kind} ${name} exceeds its ${limit}` }));
  return [...app.events.value.map(({ time_s, text }: EventMessage) => ({ time_s, text })), ...overloads];
}

/** Joins pushes and drags that overlap in time: their labels would be drawn over each other. */
function overlapping(actions: readonly Action[]): { from_s: number; to_s: number; members: Action[] }[] {
  const groups: { from_s: number; to_s: number; members: Action[] }[] = [];
  for (const action of [...actions].sort((a, b) => a.from_s - b.from_s)) {
    const last = groups[groups.length - 1];
    if (last && action.from_s < last.to_s) {
      last.members.push(action);
      last.to_s = Math.max(last.to_s, action.to_s);
    } else {
      groups.push({ from_s: action.from_s, to_s: action.to_s, members: [action] });
    }
  }
  return groups;
}

/** Creates the marks inside the bar; `share`: position of a time in the bar, 0 to 1. */
export class TrackMarks {
  readonly phases = el("div.phases");
  readonly actions = el("div.actions");
  readonly events = el("div.events");
  readonly hover = el("div.hovertime", { hidden: true, role: "tooltip" });

  constructor(private readonly app: App, private readonly share: (time_s: number) => number) {}

  /** Draws everything; `width_px`: width of the bar. */
  draw(scene: Scene, width_px: number): void {
    const span = (from_s: number, to_s: number, label: string, spec: string, room: number) => {
      const [from, to] = [this.share(from_s), this.share(to_s)];
      const text = el("em", {}, label);
      // a label may be wider than its span, up to the next one; at the right end it extends to the left
      const fits_px = Math.max(room, to) * width_px - from * width_px;
      const isLast = from * width_px + LABEL_PX * label.length > width_px;
      if (isLast) text.className = "last";
      else text.style.maxWidth = `${Math.max(fits_px - 4, 0)}px`;
      const made = el(spec, { title: `${label}: ${number(from_s, 4)} s to ${number(to_s, 4)} s` }, text);
      made.style.left = `${(100 * from).toFixed(3)}%`;
      made.style.width = `${(100 * (to - from)).toFixed(3)}%`;
      return made;
    };
    const next = (list: readonly { from_s: number }[], i: number) => (list[i + 1] ? this.share(list[i + 1]!.from_s) : 1);
    this.phases.replaceChildren(...scene.phases.map(({ name, from_s, to_s }, i) => span(from_s, to_s, name, "span", next(scene.phases, i))));
    const groups = overlapping(scene.actions ?? []);
    this.actions.replaceChildren(...groups.map(({ from_s, to_s, members }, i) => {
      const [{ kind, text }, others] = [members[0]!, members.length - 1];
      const made = span(from_s, to_s, others > 0 ? `${text}, and ${others} more` : text, `span.${kind}`, next(groups, i));
      made.title = members.map((each) => `${each.text}: ${number(each.from_s, 4)} s to ${number(each.to_s, 4)} s`).join("\n");
      return made;
    }));
  }

  drawEvents(): void {
    this.events.replaceChildren(...eventsOf(this.app).map(({ time_s, text }) => {
      const mark = el("i", { title: `${clock(time_s)} ${text}` });
      mark.style.left = `${(100 * this.share(time_s)).toFixed(3)}%`;
      return mark;
    }));
  }

  /** Shows the label of a time; null: hides it. */
  point(time_s: number | null, width_px: number): void {
    const { value: scene } = this.app.scene;
    this.hover.hidden = time_s === null || scene === null;
    if (time_s === null || !scene) return;
    const during = [...scene.phases.map(({ name, ...span }) => ({ text: name, ...span })), ...(scene.actions ?? [])]
      .filter(({ from_s, to_s }) => time_s >= from_s && time_s <= to_s).map(({ text }) => text);
    const near = eventsOf(this.app).filter((event) => Math.abs(this.share(event.time_s) - this.share(time_s)) * width_px < REACH_PX)
      .map(({ time_s: at_s, text }) => `${clock(at_s)} ${text}`);
    this.hover.replaceChildren(el("b", {}, `${time_s.toFixed(2)} s`), ...[...during, ...near].map((text) => el("div", {}, text)));
    const place = this.share(time_s);
    this.hover.style.left = `${(100 * place).toFixed(3)}%`;
    this.hover.style.transform = `translateX(${-100 * place}%)`;
  }
}
