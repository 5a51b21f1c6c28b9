// A button that saves a replay as a film: the time span of the plots at the selected speed, with progress. The
// second click stops it; afterwards the displayed time is as before.
import type { App } from "../app";
import type { SeriesStore } from "../series";
import { button, download } from "../util";

const MAX_SPEED = 10; // in place of "max", which has no meaning for a film

/** A film that is being made. */
export interface Film {
  readonly from_s: number;
  readonly to_s: number;
  readonly speed: number;
  /** Becomes false at the second click, or if the source of the page is gone. */
  readonly running: boolean;
  /** Displays the row at a time. */
  goTo(time_s: number): Promise<void>;
  /** Shows the progress, 0 to 1. */
  tell(share: number): void;
}

/** `kind`: label and file extension. `make` returns the file, or null after it has failed and shown the reason. */
export function filmMaker(app: App, store: SeriesStore, kind: string, title: string, available: () => boolean, make: (film: Film) => Promise<Blob | null>): HTMLElement {
  let running = false;
  const made = button(kind, title, () => {
    if (running) running = false;
    else void save();
  }, "button.film");
  app.hello.watch(() => (made.hidden = !app.replay || !available()));

  const save = async () => {
    const { value: scene } = app.scene;
    const { value: frame } = app.frame;
    if (!scene || !frame) return;
    running = true;
    made.classList.add("recording");
    const before_s = frame.time_s;
    const [from_s, to_s] = app.range_s.value ?? [scene.first_s, scene.duration_s];
    app.send({ type: "pause" });
    const file = await make({
      from_s, to_s, speed: frame.speed > 0 ? frame.speed : MAX_SPEED,
      get running() {
        return running;
      },
      goTo: async (time_s) => {
        if (!(await goTo(app, store, time_s))) running = false;
      },
      tell: (share) => (made.textContent = `stop ${kind} (${Math.round(100 * share)} %)`),
    });
    if (running && file) download(`taut-${app.hello.value?.title ?? "view"}.${kind.toLowerCase()}`, file);
    running = false;
    made.textContent = kind;
    made.classList.remove("recording");
    app.seek(before_s);
  };
  return made;
}

/** Displays the row at a time; returns false if this fails: the server is gone, or another client drives. */
function goTo(app: App, store: SeriesStore, time_s: number): Promise<boolean> {
  app.seek(time_s);
  if (app.report) return Promise.resolve(true); // a report updates at once
  return new Promise((resolve) => {
    let row_s: number | null = null;
    const stops: (() => void)[] = [];
    const look = () => {
      const there = row_s !== null && (Number.isNaN(row_s) || app.frame.value?.time_s === row_s);
      if (!there && app.link.value === "open" && app.drives) return;
      queueMicrotask(() => stops.forEach((stop) => stop()));
      resolve(there);
    };
    stops.push(...[app.frame.watch(look), app.link.watch(look), app.driver.watch(look)]);
    void store.rowTime(time_s).then((found_s) => {
      row_s = found_s;
      look();
    });
  });
}
