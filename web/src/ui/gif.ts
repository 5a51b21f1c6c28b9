// A replay as an animated GIF: of the time that the plots show, at the speed that is set.
import { applyPalette, GIFEncoder, type GifPalette, quantize } from "gifenc";
import type { App } from "../app";
import type { View } from "../scene/view";
import { button, download } from "../util";

const FRAME_MS = 80;
const MOST_FRAMES = 400;
const WIDEST_PX = 640;
const COLOURS = 256;
const PATIENCE_MS = 300;

export function gifMaker(app: App, view: View): HTMLElement {
  let running = false;
  const made = button("GIF", "save what the plots' time shows as an animated picture (GIF)", () => {
    if (running) running = false;
    else void make();
  }, "button.film");
  app.hello.watch(() => (made.hidden = !app.replay));

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
    const near_s = count === 1 ? Infinity : (to_s - from_s) / (count - 1) / 2;
    const film = new Film(view);
    app.send({ type: "pause" });
    // one set of colours for all, from the ends and the middle, so that nothing flickers
    for (const i of [0, count >> 1, count - 1]) {
      await goTo(app, times_s[i]!, near_s);
      film.learn();
    }
    for (let i = 0; i < count && running; ++i) {
      await goTo(app, times_s[i]!, near_s);
      film.take();
      made.textContent = `stop GIF (${Math.round((100 * i) / count)} %)`;
    }
    if (running) {
      download(`taut-${app.hello.value?.title ?? "view"}.gif`, film.finish());
      if (wanted > MOST_FRAMES) app.notice.value = `${MOST_FRAMES} pictures are the most; the GIF plays faster than ${speed}×`;
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

/** Until the frame of that time is there; rows may be farther apart than the pictures of a film. */
function goTo(app: App, time_s: number, near_s: number): Promise<void> {
  return new Promise((resolve) => {
    let timer = 0;
    const stop = app.frame.watch((frame) => {
      if (frame === null || Math.abs(frame.time_s - time_s) > near_s) return;
      clearTimeout(timer);
      queueMicrotask(() => stop());
      resolve();
    });
    timer = window.setTimeout(() => {
      stop();
      resolve();
    }, PATIENCE_MS);
    app.seek(time_s);
  });
}
