// Export of a replay as an animated GIF.
import { applyPalette, GIFEncoder, type GifPalette, quantize } from "gifenc";
import type { App } from "../app";
import type { View } from "../scene/view";
import type { SeriesStore } from "../series";
import { filmMaker } from "./film";

const FRAME_MS = 80;
const MOST_FRAMES = 400;
const WIDEST_PX = 640;
const COLOURS = 256;

export function gifMaker(app: App, store: SeriesStore, view: View): HTMLElement {
  return filmMaker(app, store, "GIF", "save the time range of the plots as an animation (GIF)", () => view.draws, async (film) => {
    const { from_s, to_s, speed } = film;
    const wanted = Math.floor((1000 * (to_s - from_s)) / speed / FRAME_MS) + 1;
    const count = Math.min(Math.max(wanted, 1), MOST_FRAMES);
    const times_s = Array.from({ length: count }, (_, i) => (count === 1 ? from_s : from_s + ((to_s - from_s) * i) / (count - 1)));
    const animation = new Animation(view);
    // one palette for all pictures, from the ends and the middle, against flicker
    for (const i of [0, count >> 1, count - 1]) {
      await film.goTo(times_s[i]!);
      animation.learn();
    }
    for (let i = 0; i < count && film.running; ++i) {
      await film.goTo(times_s[i]!);
      animation.take();
      film.tell(i / count);
    }
    if (film.running && wanted > MOST_FRAMES) app.notice.value = `limited to ${MOST_FRAMES} pictures: the GIF plays faster than ${speed}×`;
    return animation.finish();
  });
}

class Animation {
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
