// Timeline: play, step, speed, and a time bar with phases, which is a scrubber in a replay.
import type { App } from "../app";
import { icon } from "./icons";
import { TrackMarks } from "./track_marks";
import { button, clock, el, foldButton, number } from "../util";

const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 5, 10, 0];

export function timeline(app: App): HTMLElement {
  const play = button(icon("play"), "play or pause (space)", () => app.togglePlay(), "button.play");
  const back = button(icon("start"), "back to the start (R)", () => app.goToStart());
  const stepBack = button(icon("back"), "one step back (left arrow)", () => app.send({ type: "step", count: -1 }));
  const step = button(icon("step"), "one step (right arrow)", () => app.send({ type: "step", count: 1 }));
  const speed = el<HTMLSelectElement>("select", {
    title: "speed: simulated seconds per second ([ and ])", "aria-label": "speed",
    onchange: () => app.send({ type: "speed", factor: Number(speed.value) }),
  }, ...SPEEDS.map((factor) => el("option", { value: factor }, speedText(factor))));
  const now = button("now", "back to the present (end)", () => app.goToNow(), "button.now");
  const time = el("span.time", { "aria-live": "off" });
  const factor = el("span.factor", { title: "real-time factor: simulated over wall-clock time" });
  const marks = new TrackMarks(app, (time_s) => shareOf(time_s));
  const cursor = el("div.cursor");
  const slider = el<HTMLInputElement>("input", {
    type: "range", step: "any", min: 0, max: 1, value: 0, "aria-label": "time",
    oninput: () => app.seek(Number(slider.value)),
  });
  const present = el("div.present", { hidden: true, title: "present time of the run" });
  const track = el("div.track", {}, marks.phases, marks.actions, slider, marks.events, cursor, present, marks.hover);
  // phones show these two and the bar; the others on request
  const fold = foldButton("more playback controls", "button.fold", () => element);
  const element: HTMLElement = el("footer.timeline", {}, back, stepBack, play, step, speed, track, now, time, factor, fold);

  const shareOf = (time_s: number): number => {
    const min = Number(slider.min);
    const max = Number(slider.max);
    return Math.min(Math.max((time_s - min) / (max - min || 1), 0), 1);
  };
  const share = (time_s: number): string => `${(100 * shareOf(time_s)).toFixed(3)}%`;
  const stretch = () => {
    const scene = app.scene.value;
    if (!scene) return;
    const now_s = app.frame.value?.now_s ?? 0;
    slider.min = String(scene.first_s);
    slider.max = String(app.live ? Math.max(scene.duration_s, now_s) : scene.duration_s);
    marks.draw(scene, track.clientWidth);
    marks.drawEvents();
  };
  app.scene.watch(stretch);
  app.hello.watch(() => {
    element.hidden = app.isRobot;
    slider.disabled = !app.seekable;
    stretch();
  });
  app.frame.watch((frame) => {
    if (!frame) return;
    if (app.live && frame.now_s > Number(slider.max)) stretch();
    now.hidden = !app.looksBack;
    present.hidden = !app.looksBack;
    present.style.left = share(frame.now_s);
    slider.value = String(frame.time_s);
    slider.setAttribute("aria-valuetext", `${frame.time_s.toFixed(2)} s`);
    track.style.setProperty("--now", share(frame.time_s));
    const end_s = app.scene.value?.duration_s ?? 0;
    time.textContent = end_s > 0 ? `${clock(frame.time_s)} / ${clock(end_s, 0)}` : clock(frame.time_s);
    const paused = frame.paused !== 0;
    if (element.dataset["paused"] !== String(paused)) play.replaceChildren(icon(paused ? "play" : "pause"));
    element.dataset["paused"] = String(paused);
    element.dataset["time"] = String(frame.time_s);
    factor.textContent = app.looksBack ? "looking back" : paused || !app.live ? "" : `${number(frame.real_time_factor, 2)}× real time`;
    if (document.activeElement !== speed) select(speed, frame.speed);
  });
  app.cursor_s.watch((time_s) => {
    cursor.hidden = time_s === null;
    if (time_s !== null) cursor.style.left = share(time_s);
  });
  app.events.watch(() => marks.drawEvents());
  new ResizeObserver(stretch).observe(track);
  track.addEventListener("pointermove", (event) => {
    const box = track.getBoundingClientRect();
    const min = Number(slider.min);
    const time_s = min + ((event.clientX - box.left) / box.width) * (Number(slider.max) - min);
    marks.point(time_s, box.width);
  });
  track.addEventListener("pointerleave", () => marks.point(null, track.clientWidth));
  return element;
}

function select(list: HTMLSelectElement, factor: number): void {
  let option = [...list.options].find((each) => Number(each.value) === factor);
  if (!option) list.append((option = el<HTMLOptionElement>("option", { value: factor }, speedText(factor))));
  option.selected = true;
}

function speedText(factor: number): string {
  return factor === 0 ? "max" : `${factor}×`;
}

/** Returns the next faster or slower of the available speeds. */
export function nextSpeed(now: number, faster: boolean): number {
  const place = SPEEDS.findIndex((speed) => (now === 0 ? speed === 0 : speed === 0 || speed >= now));
  return SPEEDS[Math.min(Math.max(place + (faster ? 1 : -1), 0), SPEEDS.length - 1)]!;
}
