// Export of a replay as an animated GIF: the time span of the plots at the selected speed.
import { applyPalette, GIFEncoder, type GifPalette, quantize } from "gifenc";
import type { App } from "../app";
import type { View } from "../scene/view";
import type { SeriesStore } from "../series";
import { button, download } from "../util";

const FRAME_MS = 80;
const MOST_FRAMES = 400;
const WIDEST_PX = 640;
const COLOURS = 256;

export function gifMaker(app: App, store: SeriesStore, view: View): HTMLElement {
  let running = false;
  const made = button("GIF", "save the time range of the plots as an animation (GIF)", () => {
    if (running) running = false;
    else void make();
  }, "button.film");
  app.hello.watch(() => (made.hidden = !app.replay || !view.draws));

  const make = async () => {
    const scene = app.scene.value;
    const frame = app.frame.value;
    if (!scene || !frame) return;
    running = true;
    made.classList.add("recording");
    const before_s = frame.time_s;
    const [from_s, to_s] = app.range_s.value ?? [scene.first_s, scene.duration_s];
    const speed = frame.speed > 0 ? frame.speed : 10;
    const wanted = Math.floor((1000 * (to_s - from_s)) / speed / FRAME_MS) + 1;
    const count = Math.min(Math.max(wanted, 1), MOST_FRAMES);
    const times_s = Array.from({ length: count }, (_, i) => (count === 1 ? from_s : from_s + ((to_s - from_s) * i) / (count - 1)));
    const film = new Film(view);
    app.send({ type: "pause" });
    // one palette for all pictures, from the ends and the middle, against flicker
    for (const i of [0, count >> 1, count - 1]) {
      if (!(await goTo(app, store, times_s[i]!))) running = false;
      film.learn();
    }
    for (let i = 0; i < count && running; ++i) {
      if (!(await goTo(app, store, times_s[i]!))) running = false;
      film.take();
      made.textContent = `stop GIF (${Math.round((100 * i) / count)} %)`;
    }
    if (running) {
      download(`taut-${app.hello.value?.title ?? "view"}.gif`, film.finish());
      if (wanted > MOST_FRAMES) app.notice.value = `limited to ${MOST_FRAMES} pictures: the GIF plays faster than ${speed}×`;
    }
    running = false;
    made.textContent = "GIF";
    made.classList.remove("recording");
    app.seek(before_s);
  };
  return made;
}

class Film {
  private readonly canvas = document.createElement("canvas");
  private readonly context: CanvasRenderingContext2D;
  private readonly encoder = GIFEncoder();
  private readonly learnt: Uint8ClampedArray[] = [];
  private palette: GifPalette | null = null;

  constructor(private readonly view: View) {
    const { width_px, height_px } = view.viewport;
    const scale = Math.min(1, WIDEST_PX / width_px);
    this.canvas.width = Math.round(scale * width_px);
    this.canvas.height = Math.round(scale * height_px);
    this.context = this.canvas.getContext("2d", { willReadFrequently: true })!;
  }

  learn(): void {
    this.learnt.push(this.pixels());
  }

  take(): void {
    this.palette ??= quantize(together(this.learnt), COLOURS);
    const { width, height } = this.canvas;
    this.encoder.writeFrame(applyPalette(this.pixels(), this.palette), width, height, { palette: this.palette, delay: FRAME_MS });
  }

  finish(): Blob {
    this.encoder.finish();
    return new Blob([this.encoder.bytes()], { type: "image/gif" });
  }

  private pixels(): Uint8ClampedArray {
    const { width, height } = this.canvas;
    this.view.draw();
    this.context.drawImage(this.view.canvas, 0, 0, width, height);
    return this.context.getImageData(0, 0, width, height).data;
  }
}

function together(parts: readonly Uint8ClampedArray[]): Uint8ClampedArray {
  const all = new Uint8ClampedArray(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}

/** Displays the row at a time; returns false if this fails: the server is gone, or another client drives. */
export function goTo(app: App, store: SeriesStore, time_s: number): Promise<boolean> {
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
