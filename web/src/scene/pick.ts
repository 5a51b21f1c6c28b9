// What is under the mouse: a node or a cable within some pixels, else a body.
import { type Camera, Raycaster, Vector2, Vector3 } from "three";
import type { Selection } from "../app";
import type { Frame } from "../frame";
import type { Scene } from "../protocol";
import type { Bodies } from "./bodies";
import type { Cables } from "./cables";
import { worldPoint } from "./poses";

const NODE_PX = 9;
const CABLE_PX = 7;

export interface Viewport {
  camera: Camera;
  width_px: number;
  height_px: number;
}

/** Where a point of W is on the screen, in pixels from the top left; z > 1: behind the camera. */
export function project(point: Vector3, view: Viewport, out: Vector3): Vector3 {
  out.copy(point).project(view.camera);
  return out.set(((out.x + 1) / 2) * view.width_px, ((1 - out.y) / 2) * view.height_px, out.z);
}

const a = new Vector3();
const b = new Vector3();
const ray = new Raycaster();

export function pick(
  x_px: number, y_px: number, view: Viewport, scene: Scene, frame: Frame, bodies: Bodies, cables: Cables,
): Selection | null {
  let best: Selection | null = null;
  let nearest_px = NODE_PX;
  scene.nodes.forEach((node, index) => {
    project(worldPoint(frame, node.body, node.position_m, a), view, a);
    const away_px = Math.hypot(a.x - x_px, a.y - y_px);
    if (a.z <= 1 && away_px < nearest_px) {
      nearest_px = away_px;
      best = { kind: "node", index };
    }
  });
  if (best) return best;
  nearest_px = CABLE_PX;
  cables.points.forEach((points, index) => {
    for (let k = 0; k + 1 < points.length; ++k) {
      project(points[k]!, view, a);
      project(points[k + 1]!, view, b);
      if (a.z > 1 || b.z > 1) continue;
      const away_px = distanceToSegment(x_px, y_px, a, b);
      if (away_px < nearest_px) {
        nearest_px = away_px;
        best = { kind: "cable", index };
      }
    }
  });
  if (best) return best;
  ray.setFromCamera(new Vector2((2 * x_px) / view.width_px - 1, 1 - (2 * y_px) / view.height_px), view.camera);
  const hit = ray.intersectObjects(bodies.meshes, false)[0];
  return hit ? { kind: "body", index: hit.object.userData["body"] as number } : null;
}

function distanceToSegment(x: number, y: number, from: Vector3, to: Vector3): number {
  const dx = to.x - from.x;
  const dy = to.y - from.y;
  const length2 = dx * dx + dy * dy;
  const part = length2 === 0 ? 0 : Math.min(Math.max(((x - from.x) * dx + (y - from.y) * dy) / length2, 0), 1);
  return Math.hypot(x - from.x - part * dx, y - from.y - part * dy);
}
