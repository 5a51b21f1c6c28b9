// Counters of faults that rise: a count that has stopped rising, such as of the start, is no alarm.

/** A counter matters this long after it has risen [s]. */
const RECENT_S = 10;

export class Rising {
  private readonly seen = new Map<string, { count: number; risen_s: number }>();

  /** Returns whether the counter has risen of late. The first count says nothing. */
  matters(name: string, count: number, time_s: number): boolean {
    const before = this.seen.get(name);
    const risen_s = before === undefined || before.count === count ? (before?.risen_s ?? -Infinity) : time_s;
    this.seen.set(name, { count, risen_s });
    return time_s - risen_s < RECENT_S;
  }
}
