// Single rows of channels, exactly as recorded, for the values beside plots, whose points may be coarser.
// Some rows around the displayed one are fetched at a time.
import type { Points } from "./points";
import { lastAtMost, Signal } from "./util";

const AROUND = 32; // number of rows on either side

export interface Row {
  /** Time of the row [s]; NaN: there is no row. */
  time_s: number;
  value: number;
  /** 1: every row is available; n: only every n-th. */
  every: number;
}

/** Rows around a displayed one. */
interface Near {
  t0: number;
  t1: number;
  points: Points;
}

type Ask = (channel: string, source: number, t0: number, t1: number, points: number, receive: (points: Points) => void) => void;

export class RowReader {
  /** Increases when rows arrive that `at` did not have. */
  readonly came = new Signal(0);
  private readonly near = new Map<string, Near>();
  private readonly asked = new Set<string>();
  private telling = false;

  constructor(private readonly ask: Ask) {}

  /**
   * Returns the row at a time, or the last before it; null: requested. `drawn`: the plot's points of the
   * channel.
   */
  at(channel: string, source: number, time_s: number, drawn: Points): Row | null {
    if (drawn.rows === 1 && drawn.t[0]! <= time_s && time_s < drawn.t[drawn.t.length - 1]!) return rowAt(drawn, time_s);
    const key = `${source}:${channel}`;
    const near = this.near.get(key);
    const inside = near !== undefined && near.t0 <= time_s && time_s <= near.t1;
    const alone = inside && near.t0 === near.t1;
    if (inside && (near.points.rows === 1 || alone)) return rowAt(near.points, time_s);
    if (this.asked.has(key)) return null;
    this.asked.add(key);
    // if rows are denser than the plot's points suggest, their number exceeds the limit: then only one row is requested
    const around_s = inside ? 0 : AROUND * distanceOfRows(drawn, time_s);
    const [t0, t1] = [time_s - around_s, time_s + around_s];
    this.ask(channel, source, t0, t1, 4 * AROUND, (points) => {
      this.near.set(key, { t0, t1, points });
      this.asked.delete(key);
      this.tell();
    });
    return null;
  }

  /** Discards all rows; later answers to earlier requests are ignored. */
  forget(): void {
    this.near.clear();
    this.asked.clear();
  }

  /** Merges the notifications of many rows into one per picture. */
  private tell(): void {
    if (this.telling) return;
    this.telling = true;
    requestAnimationFrame(() => {
      this.telling = false;
      ++this.came.value;
    });
  }
}

/** Returns the last row at or before a time. */
export function rowAt(points: Points, time_s: number): Row {
  const at = lastAtMost(points.t, time_s);
  return { time_s: points.t[at] ?? NaN, value: points.first[at] ?? NaN, every: points.rows };
}

/** Estimates the distance of rows from points of blocks; 0 if unknown. */
function distanceOfRows({ t, rows }: Points, time_s: number): number {
  const at = Math.min(Math.max(lastAtMost(t, time_s), 0), t.length - 2);
  return at < 0 ? 0 : (t[at + 1]! - t[at]!) / rows;
}
