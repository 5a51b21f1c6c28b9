// Positions of bodies' points in a frame.
import type { Vector3 } from "three";
import type { Frame } from "../frame";
import { VALUES } from "../layout";
import type { Body, Vec3 } from "../protocol";

/** Poses of the run's bodies, or of a ghost's. */
export type Poses = Pick<Frame, "bodies">;

/** Returns p_WP of a point P fixed in a body; the world is body -1. */
export function worldPoint(frame: Poses, body: number, p: Vec3, out: Vector3): Vector3 {
  if (body < 0) return out.set(p[0], p[1], p[2]);
  const b = frame.bodies;
  const at = body * VALUES.bodies;
  const [w, x, y, z] = [b[at + 3]!, b[at + 4]!, b[at + 5]!, b[at + 6]!];
  // rotated vector: p + 2 q x (q x p + w p)
  const cx = y * p[2] - z * p[1] + w * p[0];
  const cy = z * p[0] - x * p[2] + w * p[1];
  const cz = x * p[1] - y * p[0] + w * p[2];
  return out.set(
    b[at]! + p[0] + 2 * (y * cz - z * cy),
    b[at + 1]! + p[1] + 2 * (z * cx - x * cz),
    b[at + 2]! + p[2] + 2 * (x * cy - y * cx),
  );
}

/** Computes the center of mass of all movable bodies with known mass; returns false if there is none. */
export function centreOfMass(scene: { bodies: readonly Body[] }, frame: Poses, out: Vector3): boolean {
  let mass_kg = 0;
  out.set(0, 0, 0);
  scene.bodies.forEach((body, i) => {
    if (body.fixed || !(body.mass_kg > 0)) return;
    const at = i * VALUES.bodies;
    out.x += body.mass_kg * frame.bodies[at]!;
    out.y += body.mass_kg * frame.bodies[at + 1]!;
    out.z += body.mass_kg * frame.bodies[at + 2]!;
    mass_kg += body.mass_kg;
  });
  if (mass_kg === 0) return false;
  out.divideScalar(mass_kg);
  return true;
}
