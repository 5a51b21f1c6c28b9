// Recording of the 3D view as a video (WebM) during playback.
import type { App } from "../app";
import type { View } from "../scene/view";
import { button, download } from "../util";

const FRAMES_PER_S = 30;

export function recorder(app: App, view: View): HTMLElement {
  let running: MediaRecorder | null = null;
  const toggle = () => {
    if (running) {
      running.stop();
      return;
    }
    const parts: Blob[] = [];
    running = new MediaRecorder(view.canvas.captureStream(FRAMES_PER_S), { mimeType: "video/webm", videoBitsPerSecond: 8e6 });
    running.ondataavailable = (event) => parts.push(event.data);
    running.onstop = () => {
      running = null;
      made.textContent = "record";
      made.classList.remove("recording");
      download(`taut-${app.hello.value?.title ?? "view"}.webm`, new Blob(parts, { type: "video/webm" }));
    };
    running.start();
    made.textContent = "stop recording";
    made.classList.add("recording");
    view.invalidate();
  };
  const made = button("record", "record the 3-D view as a video (WebM)", toggle, "button.film");
  made.hidden = !view.draws || typeof MediaRecorder === "undefined" || !MediaRecorder.isTypeSupported("video/webm");
  return made;
}
