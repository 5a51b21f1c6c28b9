// Poses of a robot that vibrates in a mode shape about its described pose.
import { Quaternion, Vector3 } from "three";
import { type Frame, frameOfScene } from "../frame";
import { VALUES } from "../layout";
import type { MotionShape, Scene } from "../protocol";

/** Returns the largest displacement of any node or center of mass, per amplitude [m]. */
export function largestDisplacement(scene: Scene, shape: MotionShape): number {
  const vectors = (list: readonly (readonly number[])[], body: number) => new Vector3(...(list[body] as [number, number, number]));
  const places = [
    ...scene.bodies.map((_, body) => ({ body, arm: new Vector3() })),
    ...scene.nodes.filter(({ body }) => body >= 0).map(({ body, position_m }) => ({ body, arm: new Vector3(...position_m) })),
  ];
  return Math.max(0, ...places.map(({ body, arm }) => vectors(shape.rotation_rad, body).cross(arm).add(vectors(shape.translation_m, body)).length()));
}

/** Returns the frame of the described pose, displaced by `amplitude` times the shape. */
export function swung(scene: Scene, shape: MotionShape, amplitude: number): Frame {
  const frame = frameOfScene(scene);
  scene.bodies.forEach((body, i) => {
    const at = i * VALUES.bodies;
    shape.translation_m[i]!.forEach((part, axis) => (frame.bodies[at + axis]! += amplitude * part));
    const rotation = new Vector3(...shape.rotation_rad[i]!).multiplyScalar(amplitude);
    const angle = rotation.length();
    if (angle === 0) return;
    const [w, x, y, z] = body.orientation;
    const turned = new Quaternion().setFromAxisAngle(rotation.divideScalar(angle), angle).multiply(new Quaternion(x, y, z, w));
    [turned.w, turned.x, turned.y, turned.z].forEach((part, k) => (frame.bodies[at + 3 + k] = part));
  });
  return frame;
}
