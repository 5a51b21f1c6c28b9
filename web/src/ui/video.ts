// Export of a replay as a video (WebM or MP4, 1920 x 1080) by the browser's encoder, which works in real time:
// each picture shows the time that has passed, so that a slow machine makes fewer pictures, never a slower film.
import type { App } from "../app";
import type { View } from "../scene/view";
import type { SeriesStore } from "../series";
import { filmMaker } from "./film";

const SIZE = { width: 1920, height: 1080 };
const FRAMES_PER_S = 30;
const BITS_PER_S = 12e6;
const CHECK_MS = 10_000;

type Kind = "WebM" | "MP4";
const TYPES: Record<Kind, readonly string[]> = {
  WebM: ["video/webm;codecs=vp9", "video/webm"],
  MP4: ["video/mp4;codecs=avc1.640028", "video/mp4;codecs=vp9", "video/mp4"],
};

/** Returns the first type that the browser can encode. */
function typeOf(kind: Kind): string | undefined {
  return typeof MediaRecorder === "undefined" ? undefined : TYPES[kind].find((type) => MediaRecorder.isTypeSupported(type));
}

export function videoMakers(app: App, store: SeriesStore, view: View): HTMLElement[] {
  return (Object.keys(TYPES) as Kind[]).map((kind) => videoMaker(app, store, view, kind));
}

function videoMaker(app: App, store: SeriesStore, view: View, kind: Kind): HTMLElement {
  const type = typeOf(kind);
  const title = `save the time range of the plots as a video (${kind}, 1080p)`;
  return filmMaker(app, store, kind, title, () => view.draws && type !== undefined, async (film) => {
    const { from_s, to_s, speed } = film;
    const canvas = Object.assign(document.createElement("canvas"), SIZE);
    const context = canvas.getContext("2d", { alpha: false })!;
    view.setFilmSize(SIZE);
    const draw = async (time_s: number) => {
      await film.goTo(time_s);
      view.draw();
      context.drawImage(view.canvas, 0, 0);
    };
    await draw(from_s);
    const parts: Blob[] = [];
    const recorder = new MediaRecorder(canvas.captureStream(FRAMES_PER_S), { mimeType: type!, videoBitsPerSecond: BITS_PER_S });
    recorder.ondataavailable = (event) => parts.push(event.data);
    const ended = new Promise((resolve) => (recorder.onstop = resolve));
    recorder.start();
    const start_ms = performance.now();
    for (let time_s = from_s; film.running && time_s < to_s;) {
      await nextPicture();
      time_s = Math.min(from_s + (speed * (performance.now() - start_ms)) / 1000, to_s);
      await draw(time_s);
      film.tell((time_s - from_s) / (to_s - from_s || 1));
    }
    await nextPicture(); // the encoder has the last one
    recorder.stop();
    await ended;
    view.setFilmSize(null);
    const file = new Blob(parts, { type: type!.split(";")[0]! });
    if (!film.running || (await isReadable(file))) return file;
    app.notice.value = `not saved: the browser's encoder got too few pictures for ${kind}; save a GIF instead`;
    return null;
  });
}

const nextPicture = () => new Promise((resolve) => setTimeout(resolve, 1000 / FRAMES_PER_S));

/** Returns whether the browser itself can read a film: encoders may leave an empty or broken file behind. */
function isReadable(file: Blob): Promise<boolean> {
  const video = document.createElement("video");
  const url = URL.createObjectURL(file);
  return new Promise<boolean>((resolve) => {
    video.onloadedmetadata = () => resolve(video.videoWidth === SIZE.width);
    video.onerror = () => resolve(false);
    setTimeout(() => resolve(false), CHECK_MS);
    video.src = url;
  }).finally(() => URL.revokeObjectURL(url));
}
