// Export of a replay as a video (WebM or MP4, 1920 x 1080) by the browser's encoder, which works in real time:
// each picture shows the time that has passed, so that a slow machine makes fewer pictures, never a slower film.
import type { App } from "../app";
import type { View } from "../scene/view";
import type { SeriesStore } from "../series";
import { button, download } from "../util";
import { goTo } from "./gif";

const SIZE = { width: 1920, height: 1080 };
const FRAMES_PER_S = 30;
const BITS_PER_S = 12e6;
const MAX_SPEED = 10; // in place of "max", which has no meaning for a film

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
  let running = false;
  const made = button(kind, `save the time range of the plots as a video (${kind}, 1080p)`, () => {
    if (running) running = false;
    else void make();
  }, "button.film");
  const type = typeOf(kind);
  app.hello.watch(() => (made.hidden = !app.replay || !view.draws || type === undefined));

  const make = async () => {
    const { value: scene } = app.scene;
    const { value: frame } = app.frame;
    if (!scene || !frame) return;
    running = true;
    made.classList.add("recording");
    const before_s = frame.time_s;
    const [from_s, to_s] = app.range_s.value ?? [scene.first_s, scene.duration_s];
    const speed = frame.speed > 0 ? frame.speed : MAX_SPEED;
    const canvas = Object.assign(document.createElement("canvas"), SIZE);
    const context = canvas.getContext("2d", { alpha: false })!;
    app.send({ type: "pause" });
    view.setFilmSize(SIZE);
    const draw = async (time_s: number) => {
      if (!(await goTo(app, store, time_s))) running = false;
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
    for (let time_s = from_s; running && time_s < to_s;) {
      await nextPicture();
      time_s = Math.min(from_s + (speed * (performance.now() - start_ms)) / 1000, to_s);
      await draw(time_s);
      made.textContent = `stop ${kind} (${Math.round((100 * (time_s - from_s)) / (to_s - from_s || 1))} %)`;
    }
    await nextPicture(); // the encoder has the last one
    recorder.stop();
    await ended;
    view.setFilmSize(null);
    if (running) download(`taut-${app.hello.value?.title ?? "view"}.${kind.toLowerCase()}`, new Blob(parts, { type: type!.split(";")[0]! }));
    running = false;
    made.textContent = kind;
    made.classList.remove("recording");
    app.seek(before_s);
  };
  return made;
}

const nextPicture = () => new Promise((resolve) => setTimeout(resolve, 1000 / FRAMES_PER_S));
