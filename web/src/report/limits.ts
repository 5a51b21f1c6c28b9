// Use of the struts' limits: largest compression over Euler's load.
import type { Scene } from "../protocol";

export interface StrutUse {
  name: string;
  axial_least_n?: number;
}

/** Returns Euler's load of a body that is one rod; NaN if unknown. */
export function bucklingLoad(body: Scene["bodies"][number]): number {
  const rods = body.shapes.filter(({ kind }) => kind === "rod");
  return rods.length === 1 ? (rods[0]!.buckling_n ?? NaN) : NaN;
}

/** Returns the strut with the largest compression relative to its Euler load; undefined: no load is known. */
export function largestUse(scene: Scene, struts: readonly StrutUse[]): { name: string; share: number } | undefined {
  const uses = struts.flatMap(({ name, axial_least_n }) => {
    const body = scene.bodies.find((each) => each.name === name);
    const share = body ? -(axial_least_n ?? NaN) / bucklingLoad(body) : NaN;
    return share > 0 ? [{ name, share }] : [];
  });
  return uses.sort((a, b) => b.share - a.share)[0];
}
