// Picking: the object under the mouse, which is a joint's mark, a node or a cable within some pixels, else a
// body.
import { type Camera, Raycaster, Vector2, Vector3 } from "three";
import type { Selection } from "../app";
import type { Frame } from "../frame";
import type { Scene } from "../protocol";
import type { Bodies } from "./bodies";
import type { Cables } from "./cables";
import type { Joints } from "./joints";
import { worldPoint } from "./poses";

const NODE_PX = 9;
const CABLE_PX = 7;

export interface Viewport {
  camera: Camera;
  width_px: number;
  height_px: number;
}

/** Projects a point in W to the screen, in pixels from the top left; z > 1: behind the camera. */
export function project(point: Vector3, view: Viewport, out: Vector3): Vector3 {
  out.copy(point).project(view.camera);
  return out.set(((out.x + 1) / 2) * view.width_px, ((1 - out.y) / 2) * view.height_px, out.z);
}

const a = new Vector3();
const b = new Vector3();
const ray = new Raycaster();

/** Drawn objects that can be picked. */
export interface Targets {
  scene: Scene;
  bodies: Bodies;
  cables: Cables;
  joints: Joints;
}

/** Returns the nearest node within some pixels; -1: none. */
export function nodeUnder(x_px: number, y_px: number, view: Viewport, scene: Scene, frame: Frame): number {
  let best = -1;
  let nearest_px = NODE_PX;
  scene.nodes.forEach((node, index) => {
    project(worldPoint(frame, node.body, node.position_m, a), view, a);
    const away_px = Math.hypot(a.x - x_px, a.y - y_px);
    if (a.z <= 1 && away_px < nearest_px) {
      nearest_px = away_px;
      best = index;
    }
  });
  return best;
}

/** Returns the object at a position. Marks of joints come first: nodes lie inside of them. */
export function pick(x_px: number, y_px: number, view: Viewport, frame: Frame, { scene, bodies, cables, joints }: Targets): Selection | null {
  ray.setFromCamera(new Vector2((2 * x_px) / view.width_px - 1, 1 - (2 * y_px) / view.height_px), view.camera);
  const [joint, body] = [joints.object.visible ? joints.meshes : [], bodies.meshes].map((meshes) => ray.intersectObjects(meshes, false)[0]);
  if (joint && !(body && body.distance < joint.distance)) return { kind: "joint", index: joint.object.userData["joint"] as number };
  const node = nodeUnder(x_px, y_px, view, scene, frame);
  if (node >= 0) return { kind: "node", index: node };
  let best: Selection | null = null;
  let nearest_px = CABLE_PX;
  const near = (from: Vector3, to: Vector3, selection: Selection) => {
    project(from, view, a);
    project(to, view, b);
    if (a.z > 1 || b.z > 1) return;
    const away_px = distanceToSegment(x_px, y_px, a, b);
    if (away_px >= nearest_px) return;
    nearest_px = away_px;
    best = selection;
  };
  cables.points.forEach((points, index) => {
    for (let k = 0; k + 1 < points.length; ++k) near(points[k]!, points[k + 1]!, { kind: "cable", index });
  });
  if (joints.object.visible) for (const index of joints.distances) near(...joints.points[index]!, { kind: "joint", index });
  if (best) return best;
  return body ? { kind: "body", index: body.object.userData["body"] as number } : null;
}

function distanceToSegment(x: number, y: number, from: Vector3, to: Vector3): number {
  const dx = to.x - from.x;
  const dy = to.y - from.y;
  const length2 = dx * dx + dy * dy;
  const part = length2 === 0 ? 0 : Math.min(Math.max(((x - from.x) * dx + (y - from.y) * dy) / length2, 0), 1);
  return Math.hypot(x - from.x - part * dx, y - from.y - part * dy);
}
