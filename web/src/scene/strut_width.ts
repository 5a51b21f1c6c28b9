// Width of struts, to which widths of cables and of bars without a known section are relative.
import type { Scene } from "../protocol";

/** Diameter in a robot without rods, relative to the robot's size. */
const WITHOUT_RODS = 0.012;

/** Returns the diameter of the thinnest rod [m]. */
export function thinnestStrut(scene: Scene, size_m: number): number {
  const radii_m = scene.bodies.flatMap(({ shapes }) => shapes.flatMap(({ kind, radius_m }) => (kind === "rod" ? [radius_m!] : [])));
  return radii_m.length > 0 ? 2 * Math.min(...radii_m) : WITHOUT_RODS * size_m;
}
