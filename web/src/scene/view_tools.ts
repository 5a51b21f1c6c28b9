// Buttons of the camera, in a corner of the 3D view: robot, whole path, follow.
import type { App } from "../app";
import { button, el } from "../util";
import type { View } from "./view";

/** Shows the whole path; the camera then stays. */
export function showPath(app: App, view: View): void {
  if (view.fitPath()) view.following.value = false;
  else app.notice.value = view.world?.path.places.length ? "the path is too long to show the robot in it" : "there is no path yet";
}

export function viewTools(app: App, view: View): HTMLElement {
  const follow = button("follow", "the camera follows the robot (V)", () => (view.following.value = !view.following.value), "button.small");
  view.following.watch((on) => follow.setAttribute("aria-pressed", String(on)));
  const path = button("path", "fit the whole path into the view (W)", () => showPath(app, view), "button.small");
  const robot = button("robot", "fit the robot into the view (F)", () => view.fit(), "button.small");
  return el("div.viewtools", { role: "group", "aria-label": "camera" }, robot, path, follow);
}
