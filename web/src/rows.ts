// Single rows of channels, exactly as they were recorded, for the numbers beside plots: what plots draw
// may be coarser. A few rows around the one that is looked at are fetched at a time.
import type { Points } from "./points";
import { lastAtMost, Signal } from "./util";

const AROUND = 32; // rows to either side

export interface Row {
  /** NaN: there is none. */
  time_s: number;
  value: number;
  /** 1, or that only every so many-th row is to be had. */
  every: number;
}

/** Rows around one that was looked at. */
interface Near {
  t0: number;
  t1: number;
  points: Points;
}

type Ask = (channel: string, source: number, t0: number, t1: number, points: number, receive: (points: Points) => void) => void;

export class RowReader {
  /** Rises when rows have come that `at` did not have. */
  readonly came = new Signal(0);
  private readonly near = new Map<string, Near>();
  private readonly asked = new Set<string>();
  private telling = false;

  constructor(private readonly ask: Ask) {}

  /** The row at a time, or the last before it; null: it is on its way. `drawn`: what a plot has of the channel. */
  at(channel: string, source: number, time_s: number, drawn: Points): Row | null {
    if (drawn.rows === 1 && drawn.t[0]! <= time_s && time_s < drawn.t[drawn.t.length - 1]!) return rowAt(drawn, time_s);
    const key = `${source}:${channel}`;
    const near = this.near.get(key);
    const inside = near !== undefined && near.t0 <= time_s && time_s <= near.t1;
    const alone = inside && near.t0 === near.t1;
    if (inside && (near.points.rows === 1 || alone)) return rowAt(near.points, time_s);
    if (this.asked.has(key)) return null;
    this.asked.add(key);
    // where rows lie closer than the plot says, so many are not to be had at once: then one alone
    const around_s = inside ? 0 : AROUND * distanceOfRows(drawn, time_s);
    const [t0, t1] = [time_s - around_s, time_s + around_s];
    this.ask(channel, source, t0, t1, 4 * AROUND, (points) => {
      this.near.set(key, { t0, t1, points });
      this.asked.delete(key);
      this.tell();
    });
    return null;
  }

  /** What comes from now on belongs to something else. */
  forget(): void {
    this.near.clear();
    this.asked.clear();
  }

  /** Many come at once; that is told once a picture. */
  private tell(): void {
    if (this.telling) return;
    this.telling = true;
    requestAnimationFrame(() => {
      this.telling = false;
      ++this.came.value;
    });
  }
}

/** The last row at or before a time. */
export function rowAt(points: Points, time_s: number): Row {
  const at = lastAtMost(points.t, time_s);
  return { time_s: points.t[at] ?? NaN, value: points.first[at] ?? NaN, every: points.rows };
}

/** As far as points of blocks tell; 0 where they do not. */
function distanceOfRows({ t, rows }: Points, time_s: number): number {
  const at = Math.min(Math.max(lastAtMost(t, time_s), 0), t.length - 2);
  return at < 0 ? 0 : (t[at + 1]! - t[at]!) / rows;
}
