// Data of a trace known before it is played: the path of the center of mass, and the largest tension, so that
// the tension scale stays constant and the camera shows the whole path. In a live run, both grow with time.
import { Vector3 } from "three";
import type { App } from "../app";
import { niceAbove } from "../util";
import { NOTHING, type Points } from "../points";
import type { SeriesStore } from "../series";
import type { View } from "./view";

const POINTS = 5000;

export function foresee(app: App, store: SeriesStore, view: View): void {
  app.scene.watch((scene) => {
    if (!scene || app.live) return;
    const tensions = /^cable\/[^/]*\/(span_\d+_)?tension_n$/;
    for (const { name: channel } of scene.channels) {
      if (!tensions.test(channel) || !store.has(channel, 0)) continue;
      store.want(channel, 0, scene.first_s, scene.duration_s, 2, ({ max }) => {
        if (view.world?.scene !== scene) return;
        const largest_n = Math.max(...max.map((value) => value ?? 0));
        const { cables } = view.world;
        cables.scale_n = niceAbove(Math.max(cables.scale_n, largest_n));
        if (app.frame.value) view.world.update(app.frame.value);
        view.invalidate();
      });
    }
    const channels = ["x", "y", "z"].map((axis) => `system/com_${axis}_m`);
    if (!channels.every((channel) => store.has(channel, 0))) return;
    const parts: Points[] = channels.map(() => NOTHING);
    let missing = channels.length;
    channels.forEach((channel, k) =>
      store.want(channel, 0, scene.first_s, scene.duration_s, POINTS, (points) => {
        parts[k] = points;
        if (--missing > 0 || view.world?.scene !== scene) return;
        const [x, y, z] = parts as [Points, Points, Points];
        view.world.path.set(x.t, x.t.map((_, i) => new Vector3(x.first[i] ?? 0, y.first[i] ?? 0, z.first[i] ?? 0)));
        view.following.value = !view.fitPath(true); // if the path is too long, the camera follows the robot
        view.invalidate();
      }),
    );
  });
}
