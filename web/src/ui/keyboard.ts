// Keyboard shortcuts, in one table that is also displayed by the help.
import type { App } from "../app";
import { toggleGhosts } from "../scene/runs_list";
import type { View } from "../scene/view";
import { showPath } from "../scene/view_tools";
import { nextSpeed } from "./timeline";

export interface Key {
  keys: string[];
  shown: string;
  does: string;
  /** Whether the key changes the displayed time, which a robot does not allow. */
  time?: true;
  act(event: KeyboardEvent): void;
}

/** Panels that keys show and hide. */
export interface Toggles {
  help(): void;
  controls(): void;
  editor(): void;
  search(): void;
}

export function keysOf(app: App, view: View, toggles: Toggles): Key[] {
  const jump = (seconds: number) => app.seek((app.frame.value?.time_s ?? 0) + seconds);
  const step = (count: number) => (event: KeyboardEvent) => {
    if (event.shiftKey) jump(count);
    else app.send({ type: "step", count });
  };
  const speed = (faster: boolean) => () =>
    app.send({ type: "speed", factor: nextSpeed(app.frame.value?.speed ?? 1, faster) });
  const show = (what: "forces" | "path" | "joints") => () => {
    const part = view.world?.[what];
    if (!part) return;
    if (what === "path") view.world!.path.shown = !view.world!.path.shown;
    part.object.visible = !part.object.visible;
    view.invalidate();
  };
  const scene = () => app.scene.value;
  return [
    { time: true, keys: [" "], shown: "space", does: "play or pause; with a robot: emergency stop", act: () => app.togglePlay() },
    { time: true, keys: ["ArrowRight"], shown: "→", does: "one step forward (with shift: one second)", act: step(1) },
    { time: true, keys: ["ArrowLeft"], shown: "←", does: "one step back (with shift: one second); live: shows the past, undoes nothing", act: step(-1) },
    { time: true, keys: ["Home"], shown: "home", does: "to the start", act: () => app.seek(scene()?.first_s ?? 0) },
    { time: true, keys: ["End"], shown: "end", does: "to the end; live: back to now", act: () => (app.live ? app.goToNow() : app.seek(scene()?.duration_s ?? 0)) },
    { time: true, keys: ["r", "R"], shown: "R", does: "reset: back to the start", act: () => app.goToStart() },
    { time: true, keys: ["["], shown: "[", does: "slower", act: speed(false) },
    { time: true, keys: ["]"], shown: "]", does: "faster", act: speed(true) },
    { keys: ["f", "F"], shown: "F", does: "fit the robot into the view", act: () => view.fit() },
    { keys: ["w", "W"], shown: "W", does: "fit the whole path into the view", act: () => showPath(app, view) },
    { keys: ["v", "V"], shown: "V", does: "the camera follows the robot, or stays still", act: () => {
      view.following.value = !view.following.value;
      app.notice.value = view.following.value ? "the camera follows the robot" : "the camera stays still";
    } },
    { keys: ["a", "A"], shown: "A", does: "arrows of forces on or off", act: show("forces") },
    { keys: ["p", "P"], shown: "P", does: "path of the center of mass on or off", act: show("path") },
    { keys: ["j", "J"], shown: "J", does: "marks of joints on or off", act: show("joints") },
    { keys: ["g", "G"], shown: "G", does: "ghosts of compared runs on or off", act: () => toggleGhosts(view) },
    { keys: ["n", "N"], shown: "N", does: "next cable (with shift: next body): its numbers and plots", act: (event) => {
      const kind = event.shiftKey ? "body" : "cable";
      const list = event.shiftKey ? scene()?.bodies : scene()?.cables;
      if (!list || list.length === 0) return;
      const now = app.selection.value;
      app.selection.value = { kind, index: now?.kind === kind ? (now.index + 1) % list.length : 0 };
    } },
    { keys: ["Escape"], shown: "esc", does: "clear the selection; close this help", act: () => (app.selection.value = null) },
    { keys: ["c", "C"], shown: "C", does: "live controls", act: () => toggles.controls() },
    { keys: ["b", "B"], shown: "B", does: "edit plots: all channels, layouts", act: () => toggles.editor() },
    { keys: ["/"], shown: "/", does: "search the channels of plots", act: () => toggles.search() },
    { keys: ["t", "T"], shown: "T", does: "dark or light", act: () => app.toggleTheme() },
    { keys: ["?", "h", "H"], shown: "?", does: "this help", act: () => toggles.help() },
  ];
}

export function listenToKeys(app: App, keys: readonly Key[]): void {
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const target = event.target as HTMLElement;
    // an open dialog handles escape and its buttons
    if (target.closest("dialog[open]") && event.key !== "?") return;
    const writes = target.closest("input:not([type=range]):not([type=checkbox]), textarea, select");
    if (writes && event.key !== "Escape") return;
    // space belongs to a focused button and arrows to a focused slider
    if (event.key === " " && target.closest("button, summary, input[type=checkbox]")) return;
    if (event.key.startsWith("Arrow") && target.closest("input[type=range]:not(.timeline input)")) return;
    const key = keys.find((each) => each.keys.includes(event.key));
    if (!key || (app.isRobot && key.time)) return;
    event.preventDefault();
    key.act(event);
  });
}
