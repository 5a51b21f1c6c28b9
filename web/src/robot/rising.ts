// Fault counters that increase: a counter that increased only in the past, as at the start, is no alarm.

/** Time for which a counter matters after an increase [s]. */
const RECENT_S = 10;

export class Rising {
  private readonly seen = new Map<string, { count: number; risen_s: number }>();

  /** Returns whether the counter has increased recently. The first known count does not count as an increase. */
  matters(name: string, count: number, time_s: number): boolean {
    const before = this.seen.get(name);
    const risen_s = before === undefined || before.count === count ? (before?.risen_s ?? -Infinity) : time_s;
    this.seen.set(name, { count, risen_s });
    return time_s - risen_s < RECENT_S;
  }
}
