// Points of a channel over time: recorded rows, or blocks of rows with first value, minimum and maximum.
import type { SeriesData } from "./protocol";
import { lastAtMost } from "./util";

type Values = (number | null)[]; // null: not a number

/** Each point represents a block of rows; for a single row, first, min and max are the value. */
export interface Points {
  /** Time of the first row of each block [s]. */
  t: number[];
  first: Values;
  min: Values;
  max: Values;
  /** Largest number of rows of a point; 1: all rows are present. */
  rows: number;
}

export const NOTHING: Points = { t: [], first: [], min: [], max: [], rows: 1 };

/** Returns points of single rows. */
export function rowsOf(t: number[], values: Values): Points {
  return { t, first: values, min: values, max: values, rows: 1 };
}

export function pointsOf(series: SeriesData): Points {
  return { t: series.time_s.map((value) => value ?? NaN), first: series.first, min: series.min, max: series.max, rows: series.level };
}

function slice(all: Points, from: number, to: number): Points {
  return { t: all.t.slice(from, to), first: all.first.slice(from, to), min: all.min.slice(from, to), max: all.max.slice(from, to), rows: all.rows };
}

/**
 * Returns at most about `points` points between two times, and one beyond either end, so that lines reach the
 * border.
 */
export function thinned(all: Points, t0: number, t1: number, points: number): Points {
  const from = Math.max(0, lastAtMost(all.t, t0));
  const to = Math.min(all.t.length, lastAtMost(all.t, t1) + 2);
  const block = Math.max(1, Math.ceil((to - from) / points));
  if (block === 1) return slice(all, from, to);
  const thin: Points = { t: [], first: [], min: [], max: [], rows: all.rows * block };
  // blocks begin at multiples of their size, so that a moving picture does not flicker
  for (let start = from - (from % block); start < to; start += block) {
    let [least, greatest] = [Infinity, -Infinity];
    for (let i = start; i < Math.min(start + block, all.t.length); ++i) {
      least = Math.min(least, all.min[i] ?? Infinity);
      greatest = Math.max(greatest, all.max[i] ?? -Infinity);
    }
    thin.t.push(all.t[start]!);
    thin.first.push(all.first[start] ?? null);
    thin.min.push(least <= greatest ? least : null);
    thin.max.push(least <= greatest ? greatest : null);
  }
  return thin;
}

/** Returns the points between two times, and the last point before. */
export function between(all: Points, t0: number, t1: number): Points {
  const to = lastAtMost(all.t, t1) + 1;
  // a point at t1 itself belongs to the next range
  return slice(all, Math.max(0, lastAtMost(all.t, t0)), to > 0 && all.t[to - 1]! >= t1 ? to - 1 : to);
}

/** Appends the points of the second that follow the first. */
export function joined(first: Points, second: Points): Points {
  if (first.t.length === 0) return second;
  const then = slice(second, lastAtMost(second.t, first.t[first.t.length - 1]!) + 1, second.t.length);
  return {
    t: first.t.concat(then.t), first: first.first.concat(then.first), min: first.min.concat(then.min), max: first.max.concat(then.max),
    rows: Math.max(first.rows, then.rows),
  };
}
